/* read_gsd.c: GSD, the binary format of HOOMD-blue (schema hoomd, versions 1 and 2 of the file); see
 * reader.h.
 *
 * The layout is that of the specification (gsd.readthedocs.io, "File layer" and "HOOMD Schema"): a header, an
 * index of chunks, a list of their names. What a frame lacks is frame 0's if that has as many particles, else
 * the schema's default. Chunks are read where they lie, so packed files are unpacked into a temporary one. */
#include "gsd_shapes.h"
#include "reader.h"

#include "base/format.h"
#include "base/message_text.h"
#include "base/plural.h"
#include "quaternion.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define MAGIC UINT64_C(0x65DF65DF65DF65DF)
#define UNPACKED_MAX ((uint64_t)16 << 30)

enum {
    HEADER_BYTES = 256,
    ENTRY_BYTES = 32,
    NAME_BYTES = 64,
    NAMES_MAX = 65535,
    TYPES_MAX = 4096,
    SHAPE_BYTES_MAX = 1 << 20
};

typedef struct Entry {
    uint64_t frame, rows;
    int64_t location;
    uint32_t columns;
    uint16_t id;
    uint8_t type;
} Entry;

typedef struct State {
    FILE *stream, *unpacked; /* unpacked: owned, or NULL */
    uint64_t size;
    Entry *entries; /* in the index's order: by frame */
    size_t entry_count;
    char *names; /* NUL after NUL */
    size_t names_size, name_count;
    uint64_t frame_count;
} State;

void gsd_state_destroy(void *state) {
    State *const s = state;
    if (s == NULL) return;
    if (s->unpacked != NULL) fclose(s->unpacked);
    free(s->entries);
    free(s->names);
    free(s);
}

static uint64_t little(const unsigned char *bytes, size_t size) {
    uint64_t value = 0;
    for (size_t i = 0; i < size; i++) value |= (uint64_t)bytes[i] << 8 * i;
    return value;
}

static size_t type_size(uint8_t type) {
    static const size_t sizes[] = {0, 1, 2, 4, 8, 1, 2, 4, 8, 4, 8};
    return type < sizeof sizes / sizeof *sizes ? sizes[type] : 0;
}

static double decode(const unsigned char *bytes, uint8_t type) {
    const uint64_t bits = little(bytes, type_size(type));
    switch (type) {
    case 5:
        return (double)(int8_t)bits;
    case 6:
        return (double)(int16_t)bits;
    case 7:
        return (double)(int32_t)bits;
    case 8:
        return (double)(int64_t)bits;
    case 9: {
        const uint32_t low = (uint32_t)bits;
        float value = 0;
        memcpy(&value, &low, sizeof value);
        return (double)value;
    }
    case 10: {
        double value = 0;
        memcpy(&value, &bits, sizeof value);
        return value;
    }
    default:
        return (double)bits;
    }
}

static BpStatus read_at(const Input *input, const State *s, uint64_t at, void *bytes, size_t count,
                        BpError *err) {
    if (at > s->size || count > s->size - at)
        return input_fail(input, false, err,
                          "found a place beyond the end of the file (%zu bytes at %" PRIu64 " of %" PRIu64
                          "), expected a whole GSD file; it is cut off or damaged",
                          count, at, s->size);
    const bool found = fseeko(s->stream, (off_t)at, SEEK_SET) == 0;
    if (found && fread(bytes, 1, count, s->stream) == count) return BP_OK;
    if (!found || ferror(s->stream)) {
        const BpStatus status = bp_fail(err, BP_ERR_FILE, "cannot read it: %s", strerror(errno));
        bp_error_at(err, input->name, 0, 0);
        return status;
    }
    return input_fail(input, false, err, "found no more data at byte %" PRIu64 ", expected a whole GSD file",
                      at);
}

/* A packed file into a temporary one, which has no name. */
static BpStatus unpack(Input *input, State *s, BpError *err) {
    s->unpacked = tmpfile();
    if (s->unpacked == NULL)
        return bp_fail(err, BP_ERR_FILE, "cannot make a temporary file to unpack %s", input->name);
    while (input_fill(input, 1)) {
        const size_t here = input->end - input->begin;
        if (input->taken == 0 && (here < 8 || little(input->buffer + input->begin, 8) != MAGIC))
            return input_fail(input, false, err, "found other first bytes, expected those of a GSD file");
        if (input->taken + here > UNPACKED_MAX)
            return input_fail(input, false, err,
                              "found more than %" PRIu64 " GiB when unpacked, expected less; "
                              "unpack it with gunzip",
                              UNPACKED_MAX >> 30);
        if (fwrite(input->buffer + input->begin, 1, here, s->unpacked) != here)
            return bp_fail(err, BP_ERR_FILE, "cannot write a temporary file to unpack %s: is the disk full?",
                           input->name);
        input_take(input, here);
    }
    if (input->failed) return input_fail(input, false, err, "%s", "");
    if (fflush(s->unpacked) != 0)
        return bp_fail(err, BP_ERR_FILE, "cannot write a temporary file to unpack %s: is the disk full?",
                       input->name);
    s->stream = s->unpacked;
    return BP_OK;
}

static BpStatus read_index(const Input *input, State *s, const unsigned char *header, BpError *err) {
    const uint64_t location = little(header + 8, 8), allocated = little(header + 16, 8);
    if (allocated > s->size / ENTRY_BYTES)
        return input_fail(input, false, err,
                          "found an index of %" PRIu64 " entries, expected at most %" PRIu64
                          ", which the file has room "
                          "for",
                          allocated, s->size / ENTRY_BYTES);
    unsigned char *const raw = malloc((size_t)allocated * ENTRY_BYTES + 1);
    s->entries = calloc((size_t)allocated + 1, sizeof *s->entries);
    BpStatus status = raw == NULL || s->entries == NULL
                          ? bp_fail(err, BP_ERR_MEMORY, "out of memory for the index of a GSD file")
                          : read_at(input, s, location, raw, (size_t)allocated * ENTRY_BYTES, err);
    for (uint64_t i = 0; i < allocated && status == BP_OK; i++) {
        const unsigned char *const e = raw + i * ENTRY_BYTES;
        const Entry entry = {.frame = little(e, 8),
                             .rows = little(e + 8, 8),
                             .location = (int64_t)little(e + 16, 8),
                             .columns = (uint32_t)little(e + 24, 4),
                             .id = (uint16_t)little(e + 28, 2),
                             .type = e[30]};
        if (entry.location == 0) break; /* not written yet */
        if (s->entry_count > 0 && entry.frame < s->entries[s->entry_count - 1].frame)
            status =
                input_fail(input, false, err, "found frames out of order in the index, expected rising ones");
        s->entries[s->entry_count++] = entry;
        s->frame_count = entry.frame + 1;
    }
    free(raw);
    if (status == BP_OK && s->frame_count > s->entry_count)
        /* Frames without chunks are allowed, but not more of them than the file could count. */
        s->frame_count = s->frame_count > (uint64_t)1 << 40 ? (uint64_t)1 << 40 : s->frame_count;
    return status;
}

static BpStatus read_names(const Input *input, State *s, const unsigned char *header, BpError *err) {
    const uint64_t location = little(header + 24, 8), allocated = little(header + 32, 8);
    const uint64_t version = little(header + 44, 4);
    if (allocated > s->size / NAME_BYTES)
        return input_fail(input, false, err,
                          "found a list of %" PRIu64 " names, which the file has no room for", allocated);
    const size_t size = (size_t)allocated * NAME_BYTES;
    s->names = calloc(size + 1, 1);
    if (s->names == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for the names of a GSD file");
    BP_TRY(read_at(input, s, location, s->names, size, err));
    s->names_size = size;
    if (version >> 16 >= 2) return BP_OK;
    /* Version 1: 64 bytes a name. They are moved together. */
    size_t used = 0;
    for (uint64_t i = 0; i < allocated; i++) {
        char *const name = s->names + i * NAME_BYTES;
        size_t length = 0;
        while (length < NAME_BYTES - 1 && name[length] != '\0') length++;
        if (length == 0) break;
        memmove(s->names + used, name, length);
        used += length;
        s->names[used++] = '\0';
    }
    memset(s->names + used, 0, size - used);
    return BP_OK;
}

/* The number of a name; -1: the file has no such chunk. */
static int name_number(const State *s, const char *name) {
    size_t at = 0;
    for (int number = 0; at < s->names_size && s->names[at] != '\0' && number < NAMES_MAX; number++) {
        if (strcmp(s->names + at, name) == 0) return number;
        at += strlen(s->names + at) + 1;
    }
    return -1;
}

static const Entry *find_chunk(const State *s, uint64_t frame, const char *name) {
    const int id = name_number(s, name);
    if (id < 0) return NULL;
    size_t low = 0, high = s->entry_count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (s->entries[middle].frame < frame)
            low = middle + 1;
        else
            high = middle;
    }
    for (; low < s->entry_count && s->entries[low].frame == frame; low++)
        if (s->entries[low].id == id) return &s->entries[low];
    return NULL;
}

static BpStatus open_state(BpParticleFile *file, BpError *err) {
    Input *const input = &file->input;
    unsigned char header[HEADER_BYTES];
    if (file->state != NULL) return BP_OK;
    State *const s = calloc(1, sizeof *s);
    if (s == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory");
    file->state = s;
    s->stream = input->stream;
    unsigned char magic[2] = {0};
    if (fseeko(s->stream, 0, SEEK_SET) != 0 || fread(magic, 1, 2, s->stream) != 2)
        return input_fail(input, false, err, "found fewer than 2 bytes, expected a GSD file");
    if (magic[0] == 0x1f && magic[1] == 0x8b) {
        BP_TRY(input_rewind(input, err)); /* both read by one descriptor's place */
        BP_TRY(unpack(input, s, err));
    }
    if (fseeko(s->stream, 0, SEEK_END) != 0 || ftello(s->stream) < 0)
        return bp_fail(err, BP_ERR_FILE, "cannot seek in %s", input->name);
    s->size = (uint64_t)ftello(s->stream);
    BP_TRY(read_at(input, s, 0, header, sizeof header, err));
    if (little(header, 8) != MAGIC)
        return input_fail(input, false, err, "found other first bytes, expected those of a GSD file");
    if (memcmp(header + 112, "hoomd", 6) != 0) /* with the NUL */
        return input_fail(input, false, err, "found another schema, expected hoomd");
    BP_TRY(read_index(input, s, header, err));
    BP_TRY(read_names(input, s, header, err));
    if (s->frame_count == 0) return input_fail(input, false, err, "found no frame, expected one at least");
    return BP_OK;
}

BpStatus gsd_frame_count(BpParticleFile *file, uint64_t *count, BpError *err) {
    BP_TRY(open_state(file, err));
    *count = ((const State *)file->state)->frame_count;
    return BP_OK;
}

/* The chunk of a frame, or frame 0's, held against the shape that it should have. *entry NULL: neither has
 * it. `rows` 0: any number. */
static BpStatus need_chunk(const BpParticleFile *file, const char *name, uint64_t rows, uint32_t columns,
                           const Entry **entry, BpError *err) {
    const State *const s = file->state;
    *entry = find_chunk(s, file->frame, name);
    const bool own = *entry != NULL;
    if (!own) *entry = find_chunk(s, 0, name);
    if (*entry == NULL) return BP_OK;
    const Entry *const e = *entry;
    if (!own && rows > 0 && e->rows != rows) { /* of another number of particles: the default holds */
        *entry = NULL;
        return BP_OK;
    }
    const size_t size = type_size(e->type);
    const bool shape = (columns == 0 || e->columns == columns) && (rows == 0 || e->rows == rows) && size > 0;
    const uint64_t row_size = (uint64_t)size * e->columns;
    if (shape && e->location > 0 && (uint64_t)e->location <= s->size && row_size > 0 &&
        e->rows <= (s->size - (uint64_t)e->location) / row_size)
        return BP_OK;
    return input_fail(&file->input, false, err,
                      "%s: found a chunk of %" PRIu64 " rows of %u numbers of type %u, expected %" PRIu64
                      " rows of %u within the file's %" PRIu64 " bytes",
                      name, e->rows, (unsigned)e->columns, (unsigned)e->type, rows, (unsigned)columns,
                      s->size);
}

/* A stretch of rows of one chunk. */
typedef struct Column {
    const Entry *entry; /* NULL: the default */
    unsigned char *bytes;
    size_t row_size;
    uint64_t first, count; /* the rows in `bytes` */
} Column;

enum { ROWS_AT_ONCE = 8192 };

static BpStatus column_open(const BpParticleFile *file, const char *name, uint64_t rows, uint32_t columns,
                            Column *column, BpError *err) {
    *column = (Column){0};
    if (rows == 0) return BP_OK;
    BP_TRY(need_chunk(file, name, rows, columns, &column->entry, err));
    if (column->entry == NULL) return BP_OK;
    column->row_size = type_size(column->entry->type) * columns;
    column->bytes = malloc(column->row_size * ROWS_AT_ONCE);
    return column->bytes != NULL ? BP_OK : bp_fail(err, BP_ERR_MEMORY, "out of memory for %s", name);
}

static BpStatus column_row(const BpParticleFile *file, Column *column, uint64_t row, double *values,
                           BpError *err) {
    if (column->entry == NULL) return BP_OK;
    if (row >= column->first + column->count || row < column->first) {
        const uint64_t left = column->entry->rows - row;
        column->first = row;
        column->count = left < ROWS_AT_ONCE ? left : ROWS_AT_ONCE;
        BP_TRY(read_at(&file->input, file->state, (uint64_t)column->entry->location + row * column->row_size,
                       column->bytes, (size_t)column->count * column->row_size, err));
    }
    const unsigned char *const bytes = column->bytes + (size_t)(row - column->first) * column->row_size;
    const size_t size = type_size(column->entry->type);
    for (size_t i = 0; i < column->row_size / size; i++)
        values[i] = decode(bytes + i * size, column->entry->type);
    return BP_OK;
}

static BpStatus take_box(BpParticleFile *file, BpError *err) {
    const Entry *entry = NULL;
    Column column = {0};
    double box[6] = {0}, dimensions = 3, one[1];
    BP_TRY(need_chunk(file, "configuration/box", 0, 1, &entry, err));
    if (entry == NULL || entry->rows != 6) return BP_OK;
    BpStatus status = column_open(file, "configuration/box", 6, 1, &column, err);
    for (uint64_t i = 0; i < 6 && status == BP_OK; i++) {
        status = column_row(file, &column, i, one, err);
        box[i] = one[0];
    }
    free(column.bytes);
    BP_TRY(status);
    status = column_open(file, "configuration/dimensions", 1, 1, &column, err);
    if (status == BP_OK) status = column_row(file, &column, 0, &dimensions, err);
    free(column.bytes);
    BP_TRY(status);
    const bool flat = dimensions == 2;
    const double lz = flat && box[2] == 0 ? 1 : box[2];
    const double edges[3][3] = {{box[0], 0, 0}, {box[3] * box[1], box[1], 0}, {box[4] * lz, box[5] * lz, lz}};
    double origin[3];
    for (int i = 0; i < 3; i++) origin[i] = -(edges[0][i] + edges[1][i] + edges[2][i]) / 2;
    if (file->out != NULL) file->out->flat = flat;
    frame_cell(file, origin, edges, (const bool[3]){true, true, !flat});
    return BP_OK;
}

/* Texts of `width` bytes each. */
typedef struct Texts {
    char *text;
    size_t count, width;
} Texts;

/* A chunk of texts of at most `most` bytes; none where neither frame has it. */
static BpStatus take_texts(const BpParticleFile *file, const char *chunk, size_t most, Texts *texts,
                           BpError *err) {
    const Entry *entry = NULL;
    *texts = (Texts){0};
    BP_TRY(need_chunk(file, chunk, 0, 0, &entry, err));
    if (entry == NULL) return BP_OK;
    if (entry->rows > TYPES_MAX || entry->columns > most || type_size(entry->type) != 1)
        return input_fail(&file->input, false, err,
                          "%s: found %" PRIu64 " texts of %u bytes, expected at most %d of at most %zu",
                          chunk, entry->rows, (unsigned)entry->columns, TYPES_MAX, most);
    *texts = (Texts){.width = entry->columns, .count = (size_t)entry->rows};
    texts->text = malloc(texts->count * texts->width + 1);
    if (texts->text == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for %s", chunk);
    return read_at(&file->input, file->state, (uint64_t)entry->location, texts->text,
                   texts->count * texts->width, err);
}

/* What is known of a type. */
typedef struct Kind {
    GsdShape shape;
    uint32_t body;      /* BP_BODY_SPHERE, or that of the shape, which is then the frame's */
    uint64_t particles; /* of this type */
} Kind;

typedef struct Types {
    Texts names; /* there is "A" alone by default */
    Kind *kinds;
    size_t kind_count;
    bool unions;  /* some type is a union of spheres */
    Kind unknown; /* of types without a shape */
} Types;

static void types_clear(Types *types) {
    for (size_t i = 0; i < types->kind_count; i++) gsd_shape_clear(&types->kinds[i].shape);
    free(types->kinds);
    free(types->names.text);
}

static void copy_name(const Texts *names, size_t number, char name[BP_PARTICLE_NAME_SIZE + 1]) {
    snprintf(name, BP_PARTICLE_NAME_SIZE + 1, "%.*s", (int)names->width, names->text + number * names->width);
}

static BpStatus fail_shape(const BpParticleFile *file, const Types *types, size_t number, const char *text,
                           BpError *err) {
    char name[BP_PARTICLE_NAME_SIZE + 1] = "A", shown[64];
    if (number < types->names.count) copy_name(&types->names, number, name);
    bp_printable(name, shown, sizeof shown);
    return input_fail(&file->input, false, err,
                      "particles/type_shapes: shape %zu (from 0), of the type \"%s\": %s", number, shown,
                      text);
}

/* Hands the shape of a type over to the frame. */
static BpStatus keep_body(BpParticleFile *file, const Types *types, Kind *kind, BpError *err) {
    BpParticles *const p = file->out;
    char name[BP_PARTICLE_NAME_SIZE + 1] = "A";
    const size_t number = (size_t)(kind - types->kinds);
    BpParticleShape *const shapes = realloc(p->shapes, (p->shape_count + 1) * sizeof *shapes);
    if (shapes == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for the shapes of types");
    p->shapes = shapes;
    if (number < types->names.count) copy_name(&types->names, number, name);
    kind->shape.body.type = strdup(name);
    if (kind->shape.body.type == NULL)
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for the shapes of types");
    kind->body = BP_BODY_SHAPES + (uint32_t)p->shape_count;
    p->shapes[p->shape_count++] = kind->shape.body;
    kind->shape.body = (BpParticleShape){0};
    return BP_OK;
}

/* The shapes of the types, which HOOMD-blue's hard particles have. */
static BpStatus take_shapes(BpParticleFile *file, Types *types, BpError *err) {
    Texts texts;
    BpStatus status = take_texts(file, "particles/type_shapes", SHAPE_BYTES_MAX, &texts, err);
    if (status == BP_OK) types->kinds = calloc(texts.count + 1, sizeof *types->kinds);
    if (status == BP_OK && types->kinds == NULL)
        status = bp_fail(err, BP_ERR_MEMORY, "out of memory for the shapes of types");
    for (size_t i = 0; i < texts.count && status == BP_OK; i++) {
        Kind *const kind = &types->kinds[types->kind_count++];
        BpError own = {0};
        status = gsd_shape_read(texts.text + i * texts.width, texts.width, &kind->shape, &own);
        types->unions |= kind->shape.sphere_count > 0;
        if (status != BP_OK) status = fail_shape(file, types, i, own.message, err);
        bp_error_clear(&own);
        if (status == BP_OK && kind->shape.has_body) status = keep_body(file, types, kind, err);
    }
    free(texts.text);
    return status;
}

static BpStatus take_types(BpParticleFile *file, Types *types, BpError *err) {
    types->unknown.shape.diameter = NAN;
    BP_TRY(take_texts(file, "particles/types", BP_PARTICLE_NAME_SIZE, &types->names, err));
    return take_shapes(file, types, err);
}

/* Says which shapes are not drawn as they are. */
static void note_shapes(BpParticleFile *file, const Types *types) {
    static const char *const kinds[] = {"sphere union", "other shape"};
    uint64_t unions = 0, spheres = 0;
    char number[32], other[32];
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        uint64_t count = 0;
        for (size_t i = 0; i < types->kind_count; i++)
            if (types->kinds[i].shape.kind != NULL && strcmp(types->kinds[i].shape.kind, kinds[k]) == 0)
                count += types->kinds[i].particles;
        frame_note_shapes(file, count, kinds[k]);
    }
    for (size_t i = 0; i < types->kind_count; i++) {
        if (types->kinds[i].shape.sphere_count <= 1) continue;
        unions += types->kinds[i].particles;
        spheres += types->kinds[i].particles * types->kinds[i].shape.sphere_count;
    }
    if (unions > 0)
        bp_particles_note(file->out, "%s sphere union%s drawn as %s spheres",
                          bp_format_whole(unions, number, sizeof number), bp_plural(unions),
                          bp_format_whole(spheres, other, sizeof other));
}

/* `first`: the number of each particle's first sphere; NULL: its own. */
static BpStatus take_bonds(BpParticleFile *file, uint64_t particles, const uint32_t *first, BpError *err) {
    const Entry *entry = NULL;
    Column column = {0};
    const bool own = find_chunk(file->state, file->frame, "bonds/group") != NULL;
    double count = -1; /* not said */
    BpStatus status = column_open(file, "bonds/N", 1, 1, &column, err);
    if (status == BP_OK) status = column_row(file, &column, 0, &count, err);
    free(column.bytes);
    BP_TRY(status);
    BP_TRY(need_chunk(file, "bonds/group", 0, 2, &entry, err));
    if (entry == NULL || entry->rows == 0 || count == 0) return BP_OK;
    if (!own && count >= 0 && (double)entry->rows != count)
        return BP_OK; /* frame 0's, which had more or fewer */
    status = column_open(file, "bonds/group", entry->rows, 2, &column, err);
    for (uint64_t i = 0; i < entry->rows && status == BP_OK; i++) {
        double pair[2] = {0, 0};
        BP_TRY_GOTO(status, column_row(file, &column, i, pair, err), done);
        if (!(pair[0] >= 0 && pair[0] < (double)particles && pair[1] >= 0 && pair[1] < (double)particles)) {
            if (!own) continue; /* frame 0's, which had more particles */
            status = input_fail(&file->input, false, err,
                                "bond %" PRIu64
                                " (from 0): found a particle that does not exist, expected numbers "
                                "below %" PRIu64,
                                i, particles);
            goto done;
        }
        const uint32_t a = (uint32_t)pair[0], b = (uint32_t)pair[1];
        status = frame_add_bond(file, first != NULL ? first[a] : a, first != NULL ? first[b] : b, err);
    }
done:
    free(column.bytes);
    return status;
}

enum { POSITION, DIAMETER, TYPE, MASS, CHARGE, VELOCITY, ORIENTATION, CHUNK_COUNT };

/* Hands a particle over, as what it is or as the spheres of its shape. */
static BpStatus add_shape(BpParticleFile *file, const Kind *kind, Particle *particle, double *values,
                          BpError *err) {
    const GsdShape *const shape = &kind->shape;
    const double center[3] = {particle->position[0], particle->position[1], particle->position[2]};
    double rotation[3][3];
    memcpy(particle->half_axes, shape->half_axes, sizeof particle->half_axes);
    particle->body = kind->body;
    if (shape->sphere_count == 0) return frame_add(file, particle, false, err);
    quaternion_normalize(particle->orientation);
    quaternion_rotation(particle->orientation, rotation);
    for (size_t i = 0; i < shape->sphere_count; i++) {
        quaternion_turn((const double(*)[3])rotation, shape->sphere[i], particle->position);
        for (int c = 0; c < 3; c++) values[c] = particle->position[c] += center[c];
        particle->radius = shape->sphere[i][3];
        values[3] = 2 * particle->radius;
        BP_TRY(frame_add(file, particle, false, err));
    }
    return BP_OK;
}

static BpStatus take_particles(BpParticleFile *file, uint64_t count, Column *columns, Types *types,
                               uint32_t *first, BpError *err) {
    for (uint64_t i = 0; i < count; i++) {
        double place[3] = {0, 0, 0}, diameter = 1, type = 0;
        Particle particle = PARTICLE_NONE;
        double values[9] = {0, 0, 0, 1, 1, 0, 0, 0, 0};
        char name[BP_PARTICLE_NAME_SIZE + 1] = "A";
        BP_TRY(column_row(file, &columns[POSITION], i, place, err));
        BP_TRY(column_row(file, &columns[DIAMETER], i, &diameter, err));
        BP_TRY(column_row(file, &columns[TYPE], i, &type, err));
        BP_TRY(column_row(file, &columns[MASS], i, &values[4], err));
        BP_TRY(column_row(file, &columns[CHARGE], i, &values[5], err));
        BP_TRY(column_row(file, &columns[VELOCITY], i, &values[6], err));
        BP_TRY(column_row(file, &columns[ORIENTATION], i, particle.orientation, err));
        if (!(type >= 0) || (types->names.count > 0 && !(type < (double)types->names.count)))
            return input_fail(&file->input, false, err,
                              "particle %" PRIu64 " (from 0): found type %.0f, expected one below %zu", i,
                              type, types->names.count);
        if (types->names.count > 0) copy_name(&types->names, (size_t)type, name);
        Kind *const kind = type < (double)types->kind_count ? &types->kinds[(size_t)type] : &types->unknown;
        kind->particles++;
        if (columns[DIAMETER].entry == NULL && !isnan(kind->shape.diameter)) diameter = kind->shape.diameter;
        memcpy(values, place, sizeof place);
        values[3] = diameter;
        memcpy(particle.position, place, sizeof place);
        particle.radius = diameter / 2;
        particle.type = name;
        particle.values = values;
        if (first != NULL) first[i] = (uint32_t)file->added;
        BP_TRY(add_shape(file, kind, &particle, values, err));
    }
    note_shapes(file, types);
    return BP_OK;
}

BpStatus read_gsd(BpParticleFile *file, bool *end, BpError *err) {
    static const char *const names[] = {"x", "y", "z", "diameter", "mass", "charge", "vx", "vy", "vz"};
    static const char *const chunks[CHUNK_COUNT] = {
        "particles/position", "particles/diameter", "particles/typeid",     "particles/mass",
        "particles/charge",   "particles/velocity", "particles/orientation"};
    static const uint32_t widths[CHUNK_COUNT] = {3, 1, 1, 1, 1, 3, 4};
    BP_TRY(open_state(file, err));
    const State *const s = file->state;
    *end = file->frame >= s->frame_count;
    if (*end) return BP_OK;
    Column columns[CHUNK_COUNT] = {{0}}, number = {0};
    Types types = {0};
    uint32_t *first = NULL;
    double count = 0;
    BpStatus status = BP_OK;
    BP_TRY(frame_begin(file, names, 9, err));
    if (file->out == NULL) return BP_OK; /* nothing else has to be passed over */
    file->out->up = 2;
    file->shapes.has_orientations = true; /* by default none is turned */
    BP_TRY_GOTO(status, take_box(file, err), done);
    BP_TRY_GOTO(status, column_open(file, "particles/N", 1, 1, &number, err), done);
    BP_TRY_GOTO(status, column_row(file, &number, 0, &count, err), done);
    if (!(count >= 0 && count <= BP_PARTICLES_MAX && count == floor(count))) {
        status = input_fail(&file->input, false, err,
                            "found %.10g particles in particles/N, expected a whole number up to %u", count,
                            BP_PARTICLES_MAX);
        goto done;
    }
    BP_TRY_GOTO(status, take_types(file, &types, err), done);
    for (int c = 0; c < CHUNK_COUNT; c++)
        if (c != ORIENTATION || types.kind_count > 0)
            BP_TRY_GOTO(status, column_open(file, chunks[c], (uint64_t)count, widths[c], &columns[c], err),
                        done);
    if (count > 0 && columns[POSITION].entry == NULL) {
        status = input_fail(&file->input, false, err,
                            "found no positions in frame %" PRIu64 ", expected them", file->frame);
        goto done;
    }
    if (types.unions && count > 0) { /* there are positions of as many particles in the file */
        first = malloc((size_t)count * sizeof *first);
        if (first == NULL)
            status = bp_fail(err, BP_ERR_MEMORY, "out of memory for %.0f unions of spheres", count);
        if (first == NULL) goto done;
    }
    BP_TRY_GOTO(status, take_particles(file, (uint64_t)count, columns, &types, first, err), done);
    status = take_bonds(file, (uint64_t)count, first, err);
done:
    free(number.bytes);
    for (int c = 0; c < CHUNK_COUNT; c++) free(columns[c].bytes);
    types_clear(&types);
    free(first);
    return status;
}
