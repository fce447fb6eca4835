/* accumulator_file.c: see accumulator_file.h. */
#include "accumulator_file.h"

#include "../base/output_file.h"
#include "../base/plural.h"
#include "accumulator_header.h"

#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>

#define HEADER_SIZE_MAX (1u << 20)
#define SUM_MAX                                                                                              \
    ((int64_t)3 << 61) /* 2^24 samples of at most 2^38 come to 2^62; half as much again for rounding */
#define BLOCK 65536    /* numbers converted at a time */

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
    char *header = bp_accumulator_header_make(accumulator);
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
                   "%s is %s: %" PRIu64 " byte%s, where its header (%" PRIu32 " x %" PRIu32
                   " pixels, %" PRIu32 " replicate%s) says %" PRIu64,
                   name, actual < expected ? "truncated" : "too long", actual, bp_plural(actual),
                   sizes->width, sizes->height, sizes->replicates, bp_plural(sizes->replicates), expected);
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
    BP_TRY_GOTO(status, bp_accumulator_header_sizes(header, name, &sizes, err), done);
    BP_TRY_GOTO(status, check_length(in, name, &sizes, header_size, err), done);
    BP_TRY_GOTO(status, bp_accumulator_create(sizes.width, sizes.height, sizes.replicates, &made, err), done);
    BP_TRY_GOTO(status, bp_accumulator_header_settings(header, name, made, err), done);
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
    if (in == NULL) {
        bp_fail(err, BP_ERR_FILE, "cannot read %s: %s; check the path", path, strerror(errno));
        bp_error_at(err, path, 0, 0);
        return BP_ERR_FILE;
    }
    const BpStatus status = bp_accumulator_load_stream(in, path, accumulator, err);
    fclose(in);
    return status;
}
