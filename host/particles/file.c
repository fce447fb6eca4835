/* file.c: which format a file has, and its frames one after the other; see particles.h. */
#include "particles.h"
#include "reader.h"

#include "base/encoding.h"
#include "base/input_file.h"
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
    [BP_PARTICLES_PQR] = {"PQR", read_pdb},
    [BP_PARTICLES_CIF] = {"mmCIF", read_cif},
    [BP_PARTICLES_CRYSTAL] = {"CIF", read_crystal},
    [BP_PARTICLES_POSCAR] = {"POSCAR", read_poscar},
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
    if (strncasecmp(text, "data_", 5) == 0) return BP_PARTICLES_CIF;
    for (size_t i = 0; i < sizeof pdb / sizeof *pdb; i++)
        if (strncasecmp(text, pdb[i], strlen(pdb[i])) == 0) return BP_PARTICLES_PDB;
    return BP_PARTICLES_NONE;
}

static BpParticleFormat format_of_name(const char *name) {
    static const struct {
        const char *ending;
        BpParticleFormat format;
    } endings[] = {{".xyz", BP_PARTICLES_XYZ},         {".extxyz", BP_PARTICLES_XYZ},
                   {".pdb", BP_PARTICLES_PDB},         {".ent", BP_PARTICLES_PDB},
                   {".cif", BP_PARTICLES_CIF},         {".mmcif", BP_PARTICLES_CIF},
                   {".gro", BP_PARTICLES_GRO},         {".dump", BP_PARTICLES_DUMP},
                   {".lammpstrj", BP_PARTICLES_DUMP},  {".lammpsdump", BP_PARTICLES_DUMP},
                   {".data", BP_PARTICLES_DATA},       {".lmp", BP_PARTICLES_DATA},
                   {".lammpsdata", BP_PARTICLES_DATA}, {".gsd", BP_PARTICLES_GSD},
                   {".csv", BP_PARTICLES_CSV},         {".tsv", BP_PARTICLES_CSV},
                   {".ply", BP_PARTICLES_PLY},         {".pqr", BP_PARTICLES_PQR},
                   {".pdbx", BP_PARTICLES_CIF},        {".mcif", BP_PARTICLES_CIF},
                   {".vasp", BP_PARTICLES_POSCAR},     {".poscar", BP_PARTICLES_POSCAR},
                   {".contcar", BP_PARTICLES_POSCAR},  {".xdatcar", BP_PARTICLES_POSCAR}};
    /* Whole names, or their beginnings: POSCAR_relaxed. */
    static const struct {
        const char *name;
        BpParticleFormat format;
    } beginnings[] = {{"data.", BP_PARTICLES_DATA},
                      {"POSCAR", BP_PARTICLES_POSCAR},
                      {"CONTCAR", BP_PARTICLES_POSCAR},
                      {"XDATCAR", BP_PARTICLES_POSCAR}};
    for (size_t i = 0; i < sizeof endings / sizeof *endings; i++)
        if (bp_path_has_ending(name, endings[i].ending)) return endings[i].format;
    const char *const slash = strrchr(name, '/');
    const char *const base = slash != NULL ? slash + 1 : name;
    for (size_t i = 0; i < sizeof beginnings / sizeof *beginnings; i++)
        if (strncmp(base, beginnings[i].name, strlen(beginnings[i].name)) == 0) return beginnings[i].format;
    return BP_PARTICLES_NONE;
}

/* Whether a header counts atoms and has a box, as those of LAMMPS data files do, which may have any name. */
static bool has_data_header(const char *text) {
    const char *const low = strstr(text, "xlo");
    return low != NULL && strncmp(low + 3 + strspn(low + 3, " \t"), "xhi", 3) == 0 &&
           strstr(text, "atoms") != NULL;
}

/* Whether a text begins like a POSCAR file, which may have any name: a title, a scale, three edges, words or
 * whole numbers. */
static bool has_poscar_head(const char *text) {
    static const size_t least[] = {1, 3, 3, 3}, most[] = {3, 3, 3, 3};
    char line[2048], *words[4];
    double value = 0;
    for (int l = 0; l < 5; l++) {
        const size_t length = strcspn(text, "\n");
        if (text[length] == '\0' || (l > 0 && length >= sizeof line)) return false;
        snprintf(line, sizeof line, "%.*s", length < sizeof line ? (int)length : 0, text);
        text += length + 1;
        const size_t count = split_words(line, words, 4);
        if (l == 0) continue;
        if (count < least[l - 1] || count > most[l - 1] || count == 2) return false;
        for (size_t w = 0; w < count; w++)
            if (!word_number(words[w], &value)) return false;
    }
    const size_t length = strcspn(text, "\n");
    snprintf(line, sizeof line, "%.*s", length < sizeof line ? (int)length : 0, text);
    int64_t whole = 0;
    const size_t count = split_words(line, words, 4);
    return count > 0 && (word_whole(words[0], &whole) || !word_number(words[0], &value));
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
    BpParticleFormat format = format_of_beginning(begin, (size_t)length - mark);
    const bool is_pqr =
        format_of_name(name) == BP_PARTICLES_PQR || strstr(text, "PQR file generated by") != NULL;
    if (format == BP_PARTICLES_PDB && is_pqr) format = BP_PARTICLES_PQR; /* their lines begin alike */
    if (format == BP_PARTICLES_NONE) format = format_of_name(name);
    if (format == BP_PARTICLES_NONE && has_data_header(begin)) return BP_PARTICLES_DATA;
    return format == BP_PARTICLES_NONE && has_poscar_head(begin) ? BP_PARTICLES_POSCAR : format;
}

BpStatus bp_particle_file_open(FILE *stream, const char *name, BpParticleFormat format,
                               const char *const *wanted, size_t wanted_count, size_t needed,
                               BpParticleFile **file, BpError *err) {
    BpParticleFile *result = calloc(1, sizeof *result);
    *file = NULL;
    if (result == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for a file of particles");
    result->format = format;
    result->needed = needed;
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
    else if (file->format == BP_PARTICLES_PDB || file->format == BP_PARTICLES_PQR)
        pdb_state_destroy(file->state);
    else if (file->format == BP_PARTICLES_CIF)
        cif_state_destroy(file->state);
    else if (file->format == BP_PARTICLES_CRYSTAL)
        crystal_state_destroy(file->state);
    else if (file->format == BP_PARTICLES_POSCAR)
        poscar_state_destroy(file->state);
    else if (file->format == BP_PARTICLES_CSV)
        csv_state_destroy(file->state);
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

/* Whether the frame that failed is one that is still being written, behind at least one whole frame. */
static bool is_cut(const BpParticleFile *file, BpStatus status) {
    return status == BP_ERR_SCENE && file->frame > 0 && file->input.ended && file->behind != BEHIND_PARTICLES;
}

BpStatus bp_particle_file_next(BpParticleFile *file, BpParticles *particles, bool *end, BpError *err) {
    /* Numbers have a point, whatever the caller's locale. */
    const locale_t point = newlocale(LC_NUMERIC_MASK, "C", (locale_t)0);
    if (point == (locale_t)0) return bp_fail(err, BP_ERR_MEMORY, "out of memory for a locale");
    const locale_t before = uselocale(point);
    BpError fault = {0};
    file->out = particles;
    *end = file->behind == BEHIND_TEXT;
    BpStatus status = *end ? BP_OK : formats[file->format].read(file, end, &fault);
    if (status == BP_OK && !*end) status = frame_end(file, &fault);
    file->out = NULL;
    uselocale(before);
    freelocale(point);
    if (is_cut(file, status)) {
        if (particles != NULL) bp_particles_clear(particles);
        status = BP_OK;
        *end = file->cut = true;
    }
    if (status != BP_OK) {
        bp_fail_with(fault.remedy, err, status, "%s", fault.message);
        bp_error_at(err, fault.file, fault.line, fault.column);
    } else if (*end) {
        file->frame_count = file->frame;
        file->frame_count_known = true;
    } else {
        file->frame++;
    }
    bp_error_clear(&fault);
    return status;
}

static BpStatus go_back(BpParticleFile *file, BpError *err) {
    if (file->format != BP_PARTICLES_GSD) {
        drop_state(file);
        BP_TRY(input_rewind(&file->input, err));
    }
    file->frame = 0;
    file->behind = BEHIND_FRAME_OR_END;
    return BP_OK;
}

BpStatus bp_particle_file_count(BpParticleFile *file, uint64_t *count, BpError *err) {
    if (file->format == BP_PARTICLES_GSD) return gsd_frame_count(file, count, err);
    for (bool end = false; !file->frame_count_known;) BP_TRY(bp_particle_file_next(file, NULL, &end, err));
    *count = file->frame_count;
    return BP_OK;
}

/* Whether something other than blanks stands behind the frame that was read. */
static bool has_more_text(Input *input) {
    for (size_t i = 0; input_fill(input, i + 1); i++)
        if (strchr(" \t\r\n\x1a", input->buffer[input->begin + i]) == NULL) return true;
    return false;
}

/* Whether more frames follow, as far as that can be seen without reading them. */
static bool has_more_frames(BpParticleFile *file) {
    uint64_t count = 0;
    switch (file->format) {
    case BP_PARTICLES_XYZ:
    case BP_PARTICLES_DUMP:
        return file->input.held != NULL && file->behind != BEHIND_TEXT;
    case BP_PARTICLES_GRO:
        return has_more_text(&file->input);
    case BP_PARTICLES_PDB:
    case BP_PARTICLES_PQR:
        return pdb_has_more(file->state, has_more_text(&file->input));
    case BP_PARTICLES_CIF:
        return cif_has_more(file->state);
    case BP_PARTICLES_CRYSTAL:
        return crystal_has_more(file->state);
    case BP_PARTICLES_POSCAR:
        return poscar_has_more(file->state, has_more_text(&file->input));
    case BP_PARTICLES_CSV:
        return csv_has_more(file->state);
    case BP_PARTICLES_GSD:
        return gsd_frame_count(file, &count, NULL) == BP_OK && count > 1;
    case BP_PARTICLES_NONE:
    case BP_PARTICLES_DATA:
    case BP_PARTICLES_PLY:
    case BP_PARTICLES_FORMAT_COUNT:
        break;
    }
    return false;
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
    if (!end) {
        if (file->cut && particles != NULL)
            bp_particles_note(particles, "the last frame is cut short: left out");
        if (number == 0 && particles != NULL && !file->cut && has_more_frames(file))
            bp_particles_note(particles, "the first of several frames");
        return BP_OK;
    }
    count = file->frame_count_known ? file->frame_count : count;
    const BpStatus status =
        bp_fail(err, BP_ERR_SCENE,
                "found %" PRIu64 " frame%s%s, so there is no frame %" PRId64
                "; count from 0, or from the end as -1, -2, ...",
                count, bp_plural(count), file->cut ? " and a part of another" : "", number);
    bp_error_at(err, file->input.name, 0, 0);
    return status;
}
