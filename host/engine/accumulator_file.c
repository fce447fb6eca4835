/* accumulator_file.c: see accumulator_file.h. */
#include "accumulator_file.h"

#include "../base/output_file.h"

#include <errno.h>
#include <inttypes.h>
#include <jansson.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>

#define FORMAT_VERSION 1
#define HEADER_SIZE_MAX (1u << 20)
#define RANGES_MAX 10000u
#define SUM_MAX                                                                                              \
    ((int64_t)3 << 61) /* 2^24 samples of at most 2^38 come to 2^62; half as much again for rounding */
#define BLOCK 65536    /* numbers converted at a time */

/* Names instead of numbers, so that a file outlives a change of the enumerations. In their order. */
static const char *const sampler_names[] = {"independent", "sobol", NULL};
static const char *const precision_names[] = {"single", "double", NULL};
static const char *const math_names[] = {"strict", "fast", NULL};
static const char *const numerics_names[] = {"robust", "plain", NULL};
static const char *const transfer_names[] = {"gamma2", "srgb", "linear", NULL};

static size_t cell_count(const BpAccumulator *accumulator) {
    return (size_t)accumulator->width * accumulator->height * accumulator->replicates;
}

/* ---- numbers as little-endian bytes ---- */

static void store_little(uint8_t *bytes, uint64_t value, size_t size) {
    for (size_t i = 0; i < size; i++) bytes[i] = (uint8_t)(value >> (8 * i));
}

static uint64_t load_little(const uint8_t *bytes, size_t size) {
    uint64_t value = 0;
    for (size_t i = 0; i < size; i++) value |= (uint64_t)bytes[i] << (8 * i);
    return value;
}

/* ---- saving ---- */

static json_t *ranges_json(const BpAccumulator *accumulator) {
    json_t *list = json_array();
    for (size_t i = 0; i < accumulator->range_count; i++) {
        if (accumulator->ranges[i].count == 0)
            continue; /* a render that was stopped before its first sample */
        json_array_append_new(list, json_pack("[I,I]", (json_int_t)accumulator->ranges[i].first,
                                              (json_int_t)accumulator->ranges[i].count));
    }
    return list;
}

/* The header line without its newline; NULL when out of memory. */
static char *make_header(const BpAccumulator *accumulator) {
    char hash[32], seed[32];
    snprintf(hash, sizeof hash, "%016" PRIx64, accumulator->scene_hash);
    snprintf(seed, sizeof seed, "%" PRIu64, accumulator->seed);
    json_t *header = json_pack(
        "{s:i,s:s,s:s,s:I,s:I,s:I,s:i,s:s,s:s,s:I,s:s,s:s,s:s,s:s,s:s,s:o,s:b,s:I,s:I,s:I}",
        "ballpark_accumulator", FORMAT_VERSION, "byte_order", "little", "title",
        accumulator->title != NULL ? accumulator->title : "", "width", (json_int_t)accumulator->width,
        "height", (json_int_t)accumulator->height, "replicates", (json_int_t)accumulator->replicates,
        "scale_log2", (int)accumulator->scale_log2, "scene_hash", hash, "seed", seed, "max_depth",
        (json_int_t)accumulator->max_depth, "sampler", sampler_names[accumulator->sampler], "precision",
        precision_names[accumulator->precision], "math", math_names[accumulator->math], "numerics",
        numerics_names[accumulator->numerics], "transfer", transfer_names[accumulator->transfer], "ranges",
        ranges_json(accumulator), "partial", (int)accumulator->partial, "segments",
        (json_int_t)accumulator->segments, "cut_paths", (json_int_t)accumulator->cut_paths, "invalid_samples",
        (json_int_t)accumulator->invalid_samples);
    char *text = header != NULL ? json_dumps(header, JSON_PRESERVE_ORDER) : NULL;
    json_decref(header);
    return text;
}

static void write_sums(const BpAccumulator *accumulator, uint8_t *buffer, FILE *out) {
    const size_t count = 3 * cell_count(accumulator);
    for (size_t done = 0; done < count && !ferror(out); done += BLOCK) {
        const size_t block = count - done < BLOCK ? count - done : BLOCK;
        for (size_t i = 0; i < block; i++)
            store_little(buffer + 8 * i, (uint64_t)accumulator->sums[done + i], 8);
        fwrite(buffer, 8, block, out);
    }
}

static void write_counts(const BpAccumulator *accumulator, uint8_t *buffer, FILE *out) {
    const size_t count = cell_count(accumulator);
    for (size_t done = 0; done < count && !ferror(out); done += BLOCK) {
        const size_t block = count - done < BLOCK ? count - done : BLOCK;
        for (size_t i = 0; i < block; i++) store_little(buffer + 4 * i, accumulator->counts[done + i], 4);
        fwrite(buffer, 4, block, out);
    }
}

BpStatus bp_accumulator_save_stream(const BpAccumulator *accumulator, FILE *out, BpError *err) {
    BpStatus status = BP_OK;
    uint8_t *buffer = malloc(8 * BLOCK);
    char *header = make_header(accumulator);
    if (buffer == NULL || header == NULL) {
        status = bp_fail(err, BP_ERR_MEMORY, "out of memory for writing the accumulator");
    } else {
        fprintf(out, "%s\n", header);
        write_sums(accumulator, buffer, out);
        write_counts(accumulator, buffer, out);
        const int failed_before = ferror(out) ? errno : 0;
        if (fflush(out) != 0 || failed_before != 0)
            status = bp_fail(err, BP_ERR_FILE, "writing the accumulator failed: %s",
                             strerror(failed_before != 0 ? failed_before : errno));
    }
    free(header);
    free(buffer);
    return status;
}

BpStatus bp_accumulator_save(const BpAccumulator *accumulator, const char *path, BpError *err) {
    BpOutputFile file;
    BP_TRY(bp_output_open(path, &file, err));
    const BpStatus status = bp_accumulator_save_stream(accumulator, file.stream, err);
    if (status == BP_OK) return bp_output_commit(&file, err);
    bp_output_discard(&file);
    if (err != NULL) bp_fail(err, status, "cannot write %s: %s", path, err->message);
    bp_error_at(err, path, 0, 0);
    return status;
}

/* ---- loading ---- */

/* Reads members of the header one after the other; the first fault stays. */
typedef struct Reader {
    const json_t *header;
    const char *name; /* of the file */
    BpStatus status;
    BpError *err;
} Reader;

static void bad_member(Reader *reader, const char *member, const char *expected) {
    if (reader->status != BP_OK) return;
    reader->status = bp_fail(reader->err, BP_ERR_FILE, "%s: \"%s\" in the header should be %s", reader->name,
                             member, expected);
}

static uint64_t read_integer(Reader *reader, const char *member, int64_t least, int64_t most) {
    const json_t *value = json_object_get(reader->header, member);
    char expected[96];
    snprintf(expected, sizeof expected, "a whole number from %" PRId64 " to %" PRId64, least, most);
    if (!json_is_integer(value) || json_integer_value(value) < least || json_integer_value(value) > most) {
        bad_member(reader, member, expected);
        return (uint64_t)least;
    }
    return (uint64_t)json_integer_value(value);
}

static uint32_t read_name(Reader *reader, const char *member, const char *const *names) {
    const char *value = json_string_value(json_object_get(reader->header, member));
    for (uint32_t i = 0; value != NULL && names[i] != NULL; i++)
        if (strcmp(value, names[i]) == 0) return i;
    char expected[96] = "";
    for (size_t i = 0; names[i] != NULL; i++)
        snprintf(expected + strlen(expected), sizeof expected - strlen(expected), "%s\"%s\"",
                 i > 0 ? " or " : "", names[i]);
    bad_member(reader, member, expected);
    return 0;
}

/* A string of digits that is a number of 64 bits. */
static uint64_t read_wide(Reader *reader, const char *member, int base, const char *expected) {
    const char *value = json_string_value(json_object_get(reader->header, member));
    const char *digits = base == 16 ? "0123456789abcdef" : "0123456789";
    char *end = NULL;
    errno = 0;
    if (value != NULL && value[0] != '\0' && strspn(value, digits) == strlen(value)) {
        const uint64_t number = strtoull(value, &end, base);
        if (errno == 0) return number;
    }
    bad_member(reader, member, expected);
    return 0;
}

static void read_ranges(Reader *reader, BpAccumulator *accumulator) {
    const json_t *list = json_object_get(reader->header, "ranges");
    if (!json_is_array(list) || json_array_size(list) > RANGES_MAX) {
        bad_member(reader, "ranges", "a list of at most 10000 [first, count]");
        return;
    }
    uint64_t end = 0;
    for (size_t i = 0; i < json_array_size(list) && reader->status == BP_OK; i++) {
        const json_t *range = json_array_get(list, i);
        const json_t *first = json_array_get(range, 0), *count = json_array_get(range, 1);
        if (json_array_size(range) != 2 || !json_is_integer(first) || !json_is_integer(count) ||
            json_integer_value(first) < 0 || json_integer_value(count) < 1 ||
            (uint64_t)json_integer_value(first) < end) {
            bad_member(reader, "ranges", "a list of [first, count], sorted and disjoint, count at least 1");
            return;
        }
        end = (uint64_t)json_integer_value(first) + (uint64_t)json_integer_value(count);
        const BpStatus status = bp_accumulator_add_range(accumulator, (uint64_t)json_integer_value(first),
                                                         (uint64_t)json_integer_value(count), reader->err);
        if (status == BP_ERR_MEMORY)
            reader->status = status;
        else if (status != BP_OK)
            bad_member(reader, "ranges", "sample numbers below 2^32, at most 2^24 of them in a replicate");
    }
}

/* The part of the header that decides how long the file is. */
static void read_sizes(Reader *reader, BpAccumulator *sizes) {
    read_integer(reader, "ballpark_accumulator", FORMAT_VERSION, FORMAT_VERSION);
    static const char *const byte_orders[] = {"little", NULL};
    read_name(reader, "byte_order", byte_orders);
    sizes->width = (uint32_t)read_integer(reader, "width", 1, BP_PICTURE_SIDE_MAX);
    sizes->height = (uint32_t)read_integer(reader, "height", 1, BP_PICTURE_SIDE_MAX);
    sizes->replicates = (uint32_t)read_integer(reader, "replicates", 1, BP_REPLICATES_MAX);
}

static void read_settings(Reader *reader, BpAccumulator *accumulator) {
    const json_t *scale = json_object_get(reader->header, "scale_log2");
    if (!json_is_integer(scale) || json_integer_value(scale) < -126 || json_integer_value(scale) > 126)
        bad_member(reader, "scale_log2", "a whole number from -126 to 126");
    else
        accumulator->scale_log2 = (int32_t)json_integer_value(scale);
    accumulator->scene_hash = read_wide(reader, "scene_hash", 16, "a string of up to 16 hexadecimal digits");
    accumulator->seed = read_wide(reader, "seed", 10, "a string of decimal digits, below 2^64");
    accumulator->max_depth = (uint32_t)read_integer(reader, "max_depth", 0, BP_DEPTH_MAX);
    accumulator->sampler = read_name(reader, "sampler", sampler_names);
    accumulator->precision = read_name(reader, "precision", precision_names);
    accumulator->math = read_name(reader, "math", math_names);
    accumulator->numerics = read_name(reader, "numerics", numerics_names);
    accumulator->transfer = read_name(reader, "transfer", transfer_names);
    accumulator->segments = read_integer(reader, "segments", 0, INT64_MAX);
    accumulator->cut_paths = read_integer(reader, "cut_paths", 0, INT64_MAX);
    accumulator->invalid_samples = read_integer(reader, "invalid_samples", 0, INT64_MAX);
    const json_t *partial = json_object_get(reader->header, "partial");
    if (!json_is_boolean(partial)) bad_member(reader, "partial", "true or false");
    accumulator->partial = json_is_true(partial);
    const char *title = json_string_value(json_object_get(reader->header, "title"));
    if (title == NULL) bad_member(reader, "title", "a string");
    read_ranges(reader, accumulator);
    if (reader->status != BP_OK) return;
    accumulator->title = strdup(title);
    if (accumulator->title == NULL) reader->status = bp_fail(reader->err, BP_ERR_MEMORY, "out of memory");
}

/* Reads the header line, at most HEADER_SIZE_MAX bytes with its newline; its size goes to *size. */
static BpStatus read_header(FILE *in, const char *name, json_t **header, size_t *size, BpError *err) {
    char *text = malloc(HEADER_SIZE_MAX);
    if (text == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for the header of %s", name);
    size_t length = 0;
    int c = EOF;
    while (length < HEADER_SIZE_MAX && (c = getc(in)) != EOF && c != '\n') text[length++] = (char)c;
    json_error_t json_error;
    BpStatus status = BP_OK;
    if (ferror(in))
        status = bp_fail(err, BP_ERR_FILE, "reading %s failed: %s", name, strerror(errno));
    else if (c != '\n')
        status = bp_fail(err, BP_ERR_FILE, "%s is not an accumulator: it does not begin with a line of JSON",
                         name);
    else if ((*header = json_loadb(text, length, JSON_REJECT_DUPLICATES, &json_error)) == NULL)
        status =
            bp_fail(err, BP_ERR_FILE, "%s is not an accumulator: its first line is no JSON: %s (column %d)",
                    name, json_error.text, json_error.column);
    *size = length + 1;
    free(text);
    return status;
}

/* Whether the file is as long as sums and counts of `sizes` need; before anything is allocated. */
static BpStatus check_length(FILE *in, const char *name, const BpAccumulator *sizes, size_t header_size,
                             BpError *err) {
    if (fseeko(in, 0, SEEK_END) != 0)
        return bp_fail(err, BP_ERR_FILE, "%s is a pipe or a device: accumulators are read from files", name);
    const off_t length = ftello(in);
    if (length < 0 || fseeko(in, (off_t)header_size, SEEK_SET) != 0)
        return bp_fail(err, BP_ERR_FILE, "reading %s failed: %s", name, strerror(errno));
    /* At most 2^16 * 2^16 * 2^6 * 28 bytes: far below 2^64. */
    const uint64_t expected = header_size + (uint64_t)cell_count(sizes) * (3 * 8 + 4);
    const uint64_t actual = (uint64_t)length;
    if (actual == expected) return BP_OK;
    return bp_fail(err, BP_ERR_FILE,
                   "%s is %s: %" PRIu64 " bytes, where its header (%" PRIu32 " x %" PRIu32 " pixels, %" PRIu32
                   " replicates) says %" PRIu64,
                   name, actual < expected ? "truncated" : "too long", actual, sizes->width, sizes->height,
                   sizes->replicates, expected);
}

static BpStatus read_failed(FILE *in, const char *name, BpError *err) {
    return bp_fail(err, BP_ERR_FILE, "reading %s failed: %s", name,
                   ferror(in) ? strerror(errno) : "it ends too early");
}

static BpStatus read_sums(FILE *in, const char *name, BpAccumulator *accumulator, uint8_t *buffer,
                          BpError *err) {
    const size_t count = 3 * cell_count(accumulator);
    for (size_t done = 0; done < count; done += BLOCK) {
        const size_t block = count - done < BLOCK ? count - done : BLOCK;
        if (fread(buffer, 8, block, in) != block) return read_failed(in, name, err);
        for (size_t i = 0; i < block; i++) {
            const uint64_t sum = load_little(buffer + 8 * i, 8);
            if (sum > (uint64_t)SUM_MAX)
                return bp_fail(err, BP_ERR_FILE, "%s is damaged: the sum of pixel %zu is %s", name,
                               (done + i) / 3 / accumulator->replicates,
                               sum >> 63 != 0 ? "negative" : "larger than a render can make it");
            accumulator->sums[done + i] = (int64_t)sum;
        }
    }
    return BP_OK;
}

static BpStatus read_counts(FILE *in, const char *name, BpAccumulator *accumulator, uint8_t *buffer,
                            BpError *err) {
    const size_t count = cell_count(accumulator);
    for (size_t done = 0; done < count; done += BLOCK) {
        const size_t block = count - done < BLOCK ? count - done : BLOCK;
        if (fread(buffer, 4, block, in) != block) return read_failed(in, name, err);
        for (size_t i = 0; i < block; i++)
            accumulator->counts[done + i] = (uint32_t)load_little(buffer + 4 * i, 4);
    }
    uint64_t expected[BP_REPLICATES_MAX];
    for (uint32_t k = 0; k < accumulator->replicates; k++)
        expected[k] = bp_accumulator_expected(accumulator, k);
    for (size_t i = 0; i < count; i++) {
        const int64_t *sums = &accumulator->sums[3 * i];
        const uint32_t samples = accumulator->counts[i];
        if (samples > expected[i % accumulator->replicates] ||
            (samples == 0 && (sums[0] != 0 || sums[1] != 0 || sums[2] != 0)))
            return bp_fail(err, BP_ERR_FILE,
                           "%s is damaged: pixel %zu holds %" PRIu32
                           " samples in replicate %zu, which is at odds "
                           "with its %s",
                           name, i / accumulator->replicates, samples, i % accumulator->replicates,
                           samples == 0 ? "sums" : "sample ranges");
    }
    return BP_OK;
}

BpStatus bp_accumulator_load_stream(FILE *in, const char *name, BpAccumulator **accumulator, BpError *err) {
    *accumulator = NULL;
    json_t *header = NULL;
    uint8_t *buffer = NULL;
    BpAccumulator *made = NULL;
    BpAccumulator sizes = {.width = 0};
    size_t header_size = 0;
    BpStatus status = read_header(in, name, &header, &header_size, err);
    if (status != BP_OK) goto done;
    if (json_object_get(header, "ballpark_accumulator") == NULL) {
        status =
            bp_fail(err, BP_ERR_FILE, "%s is not an accumulator: \"ballpark_accumulator\" is missing", name);
        goto done;
    }
    Reader reader = {header, name, BP_OK, err};
    read_sizes(&reader, &sizes);
    status = reader.status;
    if (status != BP_OK) goto done;
    BP_TRY_GOTO(status, check_length(in, name, &sizes, header_size, err), done);
    BP_TRY_GOTO(status, bp_accumulator_create(sizes.width, sizes.height, sizes.replicates, &made, err), done);
    read_settings(&reader, made);
    status = reader.status;
    if (status != BP_OK) goto done;
    buffer = malloc(8 * BLOCK);
    if (buffer == NULL) {
        status = bp_fail(err, BP_ERR_MEMORY, "out of memory for reading %s", name);
        goto done;
    }
    BP_TRY_GOTO(status, read_sums(in, name, made, buffer, err), done);
    BP_TRY_GOTO(status, read_counts(in, name, made, buffer, err), done);
    *accumulator = made;
    made = NULL;
done:
    if (status != BP_OK) bp_error_at(err, name, 0, 0);
    free(buffer);
    json_decref(header);
    bp_accumulator_destroy(&made);
    return status;
}

BpStatus bp_accumulator_load(const char *path, BpAccumulator **accumulator, BpError *err) {
    *accumulator = NULL;
    FILE *in = fopen(path, "rb");
    if (in == NULL) return bp_output_fail(err, "read", path, errno);
    const BpStatus status = bp_accumulator_load_stream(in, path, accumulator, err);
    fclose(in);
    return status;
}
