/* file.c: which format a file has, and its frames one after the other; see particles.h. */
#include "particles.h"
#include "reader.h"

#include "base/encoding.h"
#include "base/message_text.h"
#include "base/plural.h"

#include <inttypes.h>
#include <locale.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>
#include <zlib.h>

static const struct {
    const char *name;
    ReadFrame *read;
} formats[BP_PARTICLES_FORMAT_COUNT] = {
    [BP_PARTICLES_NONE] = {"", NULL},
    [BP_PARTICLES_XYZ] = {"XYZ", read_xyz},
    [BP_PARTICLES_PDB] = {"PDB", read_pdb},
    [BP_PARTICLES_CIF] = {"mmCIF", read_cif},
    [BP_PARTICLES_GRO] = {"GRO", read_gro},
    [BP_PARTICLES_DUMP] = {"LAMMPS dump", read_dump},
    [BP_PARTICLES_DATA] = {"LAMMPS data", read_data},
    [BP_PARTICLES_GSD] = {"GSD", read_gsd},
    [BP_PARTICLES_CSV] = {"CSV", read_csv},
    [BP_PARTICLES_PLY] = {"PLY", read_ply},
};

const char *bp_particle_format_name(BpParticleFormat format) {
    return formats[format].name;
}

static BpParticleFormat format_of_beginning(const char *text, size_t length) {
    static const unsigned char gsd[8] = {0xdf, 0x65, 0xdf, 0x65, 0xdf, 0x65, 0xdf, 0x65};
    static const char *const pdb[] = {"HEADER    ", "CRYST1 ", "ATOM      ",
                                      "HETATM",     "REMARK ", "MODEL     "};
    if (length >= 8 && memcmp(text, gsd, 8) == 0) return BP_PARTICLES_GSD;
    if (strncmp(text, "ply", 3) == 0 && text[3] != '\0' && strchr(" \t\r\n", text[3]) != NULL)
        return BP_PARTICLES_PLY;
    if (strncmp(text, "ITEM: ", 6) == 0) return BP_PARTICLES_DUMP;
    if (strncmp(text, "data_", 5) == 0) return BP_PARTICLES_CIF;
    for (size_t i = 0; i < sizeof pdb / sizeof *pdb; i++)
        if (strncmp(text, pdb[i], strlen(pdb[i])) == 0) return BP_PARTICLES_PDB;
    return BP_PARTICLES_NONE;
}

static BpParticleFormat format_of_name(const char *name) {
    static const struct {
        const char *ending;
        BpParticleFormat format;
    } endings[] = {
        {".xyz", BP_PARTICLES_XYZ},         {".extxyz", BP_PARTICLES_XYZ}, {".pdb", BP_PARTICLES_PDB},
        {".ent", BP_PARTICLES_PDB},         {".cif", BP_PARTICLES_CIF},    {".mmcif", BP_PARTICLES_CIF},
        {".gro", BP_PARTICLES_GRO},         {".dump", BP_PARTICLES_DUMP},  {".lammpstrj", BP_PARTICLES_DUMP},
        {".lammpsdump", BP_PARTICLES_DUMP}, {".data", BP_PARTICLES_DATA},  {".lmp", BP_PARTICLES_DATA},
        {".lammpsdata", BP_PARTICLES_DATA}, {".gsd", BP_PARTICLES_GSD},    {".csv", BP_PARTICLES_CSV},
        {".tsv", BP_PARTICLES_CSV},         {".ply", BP_PARTICLES_PLY}};
    size_t length = strlen(name);
    if (length > 3 && strcasecmp(name + length - 3, ".gz") == 0) length -= 3;
    for (size_t i = 0; i < sizeof endings / sizeof *endings; i++) {
        const size_t size = strlen(endings[i].ending);
        if (length > size && strncasecmp(name + length - size, endings[i].ending, size) == 0)
            return endings[i].format;
    }
    const char *const slash = strrchr(name, '/');
    return strncmp(slash != NULL ? slash + 1 : name, "data.", 5) == 0 ? BP_PARTICLES_DATA : BP_PARTICLES_NONE;
}

BpParticleFormat bp_particle_format_find(const char *name, FILE *stream) {
    enum { BEGINNING = 4096 };
    char text[BEGINNING + 1];
    const int descriptor = dup(fileno(stream));
    int length = 0;
    gzFile gz = NULL;
    if (descriptor >= 0 && lseek(descriptor, 0, SEEK_SET) == 0) gz = gzdopen(descriptor, "rb");
    if (gz != NULL) {
        length = gzread(gz, text, BEGINNING);
        gzclose(gz);
    } else if (descriptor >= 0) {
        close(descriptor);
    }
    rewind(stream);
    if (length < 0) length = 0;
    text[length] = '\0';
    const size_t mark = bp_text_mark(text, (size_t)length);
    const char *const begin = text + mark;
    if (begin[strspn(begin, " \t\r\n")] == '{')
        return BP_PARTICLES_NONE; /* a scene document, whatever its name */
    const BpParticleFormat format = format_of_beginning(begin, (size_t)length - mark);
    return format != BP_PARTICLES_NONE ? format : format_of_name(name);
}

BpStatus bp_particle_file_open(FILE *stream, const char *name, BpParticleFormat format,
                               const char *const *wanted, size_t wanted_count, BpParticleFile **file,
                               BpError *err) {
    BpParticleFile *result = calloc(1, sizeof *result);
    *file = NULL;
    if (result == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for a file of particles");
    result->format = format;
    for (size_t i = 0; i < wanted_count && i < BP_PARTICLE_WANTED_MAX; i++)
        snprintf(result->wanted[result->wanted_count++], sizeof result->wanted[0], "%s", wanted[i]);
    const BpStatus status = input_init(&result->input, stream, name, err);
    if (status != BP_OK) {
        bp_particle_file_close(&result);
        return status;
    }
    *file = result;
    return BP_OK;
}

static void drop_state(BpParticleFile *file) {
    if (file->format == BP_PARTICLES_GSD)
        gsd_state_destroy(file->state);
    else if (file->format == BP_PARTICLES_PDB)
        pdb_state_destroy(file->state);
    else
        free(file->state);
    file->state = NULL;
}

void bp_particle_file_close(BpParticleFile **file) {
    if (file == NULL || *file == NULL) return;
    drop_state(*file);
    input_clear(&(*file)->input);
    free((*file)->gone);
    free(*file);
    *file = NULL;
}

BpStatus bp_particle_file_next(BpParticleFile *file, BpParticles *particles, bool *end, BpError *err) {
    /* Numbers have a point, whatever the caller's locale. */
    const locale_t point = newlocale(LC_NUMERIC_MASK, "C", (locale_t)0);
    if (point == (locale_t)0) return bp_fail(err, BP_ERR_MEMORY, "out of memory for a locale");
    const locale_t before = uselocale(point);
    file->out = particles;
    *end = false;
    BpStatus status = formats[file->format].read(file, end, err);
    if (status == BP_OK && !*end) status = frame_end(file, err);
    file->out = NULL;
    uselocale(before);
    freelocale(point);
    if (status == BP_OK && !*end) file->frame++;
    if (status == BP_OK && *end) {
        file->frame_count = file->frame;
        file->frame_count_known = true;
    }
    return status;
}

static BpStatus go_back(BpParticleFile *file, BpError *err) {
    if (file->format != BP_PARTICLES_GSD) {
        drop_state(file);
        BP_TRY(input_rewind(&file->input, err));
    }
    file->frame = 0;
    return BP_OK;
}

BpStatus bp_particle_file_count(BpParticleFile *file, uint64_t *count, BpError *err) {
    if (file->format == BP_PARTICLES_GSD) return gsd_frame_count(file, count, err);
    for (bool end = false; !file->frame_count_known;) BP_TRY(bp_particle_file_next(file, NULL, &end, err));
    *count = file->frame_count;
    return BP_OK;
}

BpStatus bp_particle_file_frame(BpParticleFile *file, int64_t number, BpParticles *particles, BpError *err) {
    uint64_t count = 0, wanted = (uint64_t)number;
    bool end = false;
    if (number < 0 || file->format == BP_PARTICLES_GSD) {
        BP_TRY(bp_particle_file_count(file, &count, err));
        if (number < 0) wanted = count - (uint64_t)-number;
        end = number < 0 ? (uint64_t)-number > count : wanted >= count;
        if (!end && file->format == BP_PARTICLES_GSD) file->frame = wanted;
    }
    if (!end && (file->frame > wanted || file->frame_count_known)) BP_TRY(go_back(file, err));
    if (!end && file->format == BP_PARTICLES_GSD) file->frame = wanted;
    while (!end && file->frame < wanted) BP_TRY(bp_particle_file_next(file, NULL, &end, err));
    if (!end) BP_TRY(bp_particle_file_next(file, particles, &end, err));
    if (!end) return BP_OK;
    count = file->frame_count_known ? file->frame_count : count;
    const BpStatus status = bp_fail(err, BP_ERR_SCENE,
                                    "found %" PRIu64 " frame%s, so there is no frame %" PRId64
                                    "; count from 0, or from the end as -1, -2, ...",
                                    count, bp_plural(count), number);
    bp_error_at(err, file->input.name, 0, 0);
    return status;
}
