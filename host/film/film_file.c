/* film_file.c: see film_file.h. */
#include "film_file.h"

#include "base/json_memory.h"
#include "base/output_file.h"
#include "base/plural.h"
#include "film_header.h"

#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>
#include <zlib.h>

#define HEADER_SIZE_MAX (1u << 20)
#define CHECKSUM_SIZE 4 /* zlib's CRC-32 */
#define SUM_MAX                                                                                              \
    ((int64_t)3 << 61) /* 2^24 samples of at most 2^38 come to 2^62; half as much again for rounding */
#define BLOCK 65536    /* numbers converted at a time */

static size_t cell_count(const BpFilm *film) {
    return (size_t)film->width * film->height * film->replicates;
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

/* A stream, and the checksum of what was written to it. */
typedef struct Writer {
    FILE *out;
    uint8_t *buffer; /* of 8 * BLOCK bytes */
    uLong checksum;
} Writer;

static void put(Writer *writer, const void *bytes, size_t size) {
    writer->checksum = crc32_z(writer->checksum, bytes, size);
    fwrite(bytes, 1, size, writer->out);
}

static void write_sums(Writer *writer, const int64_t *sums, size_t count) {
    for (size_t done = 0; done < count && !ferror(writer->out); done += BLOCK) {
        const size_t block = count - done < BLOCK ? count - done : BLOCK;
        for (size_t i = 0; i < block; i++) store_little(writer->buffer + 8 * i, (uint64_t)sums[done + i], 8);
        put(writer, writer->buffer, 8 * block);
    }
}

static void write_counts(Writer *writer, const uint32_t *counts, size_t count) {
    for (size_t done = 0; done < count && !ferror(writer->out); done += BLOCK) {
        const size_t block = count - done < BLOCK ? count - done : BLOCK;
        for (size_t i = 0; i < block; i++) store_little(writer->buffer + 4 * i, counts[done + i], 4);
        put(writer, writer->buffer, 4 * block);
    }
}

BpStatus bp_film_write_stream(const BpFilm *film, FILE *out, BpError *err) {
    BpStatus status = BP_OK;
    Writer writer = {out, malloc(8 * BLOCK), crc32_z(0, NULL, 0)};
    char *header = bp_film_header_make(film);
    if (writer.buffer == NULL || header == NULL ||
        bp_json_memory_failed()) { /* or the header may lack a part */
        status = bp_fail(err, BP_ERR_MEMORY, "out of memory for writing the .bpa file");
    } else {
        const size_t cells = cell_count(film);
        put(&writer, header, strlen(header));
        put(&writer, "\n", 1);
        write_sums(&writer, film->sums, 3 * cells);
        if (film->fine_sums != NULL) write_sums(&writer, film->fine_sums, 3 * cells);
        write_counts(&writer, film->counts, cells);
        store_little(writer.buffer, writer.checksum, CHECKSUM_SIZE);
        fwrite(writer.buffer, 1, CHECKSUM_SIZE, out);
        const int failed_before = ferror(out) ? errno : 0;
        if (fflush(out) != 0 || failed_before != 0)
            status = bp_fail(err, BP_ERR_FILE, "writing the .bpa file failed: %s",
                             strerror(failed_before != 0 ? failed_before : errno));
    }
    free(header);
    free(writer.buffer);
    return status;
}

BpStatus bp_film_write(const BpFilm *film, const char *path, BpError *err) {
    BpOutputFile file;
    BP_TRY(bp_output_open(path, &file, err));
    const BpStatus status = bp_film_write_stream(film, file.stream, err);
    if (status == BP_OK) return bp_output_commit(&file, err);
    bp_output_discard(&file);
    if (err != NULL) bp_fail(err, status, "cannot write %s: %s", path, err->message);
    bp_error_at(err, path, 0, 0);
    return status;
}

/* ---- loading ---- */

/* A file being read, and the checksum of what was read of it. */
typedef struct Loader {
    FILE *in;
    const char *name;
    uint8_t *buffer; /* of 8 * BLOCK bytes */
    uLong checksum;
    bool fine_sums;
    size_t header_size;
} Loader;

/* Reads the header line, at most HEADER_SIZE_MAX bytes with its newline. */
static BpStatus read_header(Loader *loader, json_t **header, BpError *err) {
    char *text = malloc(HEADER_SIZE_MAX);
    if (text == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for the header of %s", loader->name);
    size_t length = 0;
    int c = EOF;
    while (length < HEADER_SIZE_MAX && (c = getc(loader->in)) != EOF && c != '\n') text[length++] = (char)c;
    json_error_t json_error;
    bool no_memory = false;
    BpStatus status = BP_OK;
    if (ferror(loader->in))
        status = bp_fail(err, BP_ERR_FILE, "reading %s failed: %s", loader->name, strerror(errno));
    else if (c != '\n')
        status = bp_fail(err, BP_ERR_FILE, "%s is not a .bpa file: it does not begin with a line of JSON",
                         loader->name);
    else if ((*header = bp_json_load(text, length, JSON_REJECT_DUPLICATES, &json_error, &no_memory)) == NULL)
        status = no_memory ? bp_fail(err, BP_ERR_MEMORY, "out of memory for the header of %s", loader->name)
                           : bp_fail(err, BP_ERR_FILE,
                                     "%s is not a .bpa file: its first line is not JSON: %s (column %d)",
                                     loader->name, json_error.text, json_error.column);
    loader->checksum =
        crc32_z(crc32_z(crc32_z(0, NULL, 0), (const uint8_t *)text, length), (const uint8_t *)"\n", 1);
    loader->header_size = length + 1;
    free(text);
    return status;
}

/* Whether the file is as long as sums and counts of `sizes` need; before anything is allocated. */
static BpStatus check_length(Loader *loader, const BpFilm *sizes, BpError *err) {
    FILE *in = loader->in;
    if (fseeko(in, 0, SEEK_END) != 0)
        return bp_fail(err, BP_ERR_FILE, "%s is a pipe or a device: a .bpa file must be a regular file",
                       loader->name);
    const off_t length = ftello(in);
    if (length < 0 || fseeko(in, (off_t)loader->header_size, SEEK_SET) != 0)
        return bp_fail(err, BP_ERR_FILE, "reading %s failed: %s", loader->name, strerror(errno));
    /* At most 2^16 * 2^16 * 2^6 * 52 bytes: far below 2^64. */
    const uint64_t cell_size = (loader->fine_sums ? 2 : 1) * 3 * 8 + 4;
    const uint64_t expected = loader->header_size + (uint64_t)cell_count(sizes) * cell_size +
                              (sizes->unverified ? 0 : CHECKSUM_SIZE);
    const uint64_t actual = (uint64_t)length;
    if (actual == expected) return BP_OK;
    return bp_fail(err, BP_ERR_FILE,
                   "%s is %s: %" PRIu64 " byte%s, but its header (%" PRIu32 " x %" PRIu32 " pixels, %" PRIu32
                   " replicate%s) says %" PRIu64,
                   loader->name, actual < expected ? "truncated" : "too long", actual, bp_plural(actual),
                   sizes->width, sizes->height, sizes->replicates, bp_plural(sizes->replicates), expected);
}

static BpStatus get(Loader *loader, size_t size, BpError *err) {
    if (fread(loader->buffer, 1, size, loader->in) != size)
        return bp_fail(err, BP_ERR_FILE, "reading %s failed: %s", loader->name,
                       ferror(loader->in) ? strerror(errno) : "the file ends too early");
    return BP_OK;
}

static BpStatus read_sums(Loader *loader, const BpFilm *film, int64_t *sums, BpError *err) {
    const size_t count = 3 * cell_count(film);
    for (size_t done = 0; done < count; done += BLOCK) {
        const size_t block = count - done < BLOCK ? count - done : BLOCK;
        BP_TRY(get(loader, 8 * block, err));
        loader->checksum = crc32_z(loader->checksum, loader->buffer, 8 * block);
        for (size_t i = 0; i < block; i++) {
            const uint64_t sum = load_little(loader->buffer + 8 * i, 8);
            if (sum > (uint64_t)SUM_MAX)
                return bp_fail(err, BP_ERR_FILE, "%s is damaged: the sum of pixel %zu is %s", loader->name,
                               (done + i) / 3 / film->replicates,
                               sum >> 63 != 0 ? "negative" : "larger than a render can make it");
            sums[done + i] = (int64_t)sum;
        }
    }
    return BP_OK;
}

static bool cell_is_empty(const BpFilm *film, size_t cell) {
    for (size_t i = 3 * cell; i < 3 * cell + 3; i++)
        if (film->sums[i] != 0 || (film->fine_sums != NULL && film->fine_sums[i] != 0)) return false;
    return true;
}

static BpStatus read_counts(Loader *loader, BpFilm *film, BpError *err) {
    const size_t count = cell_count(film);
    for (size_t done = 0; done < count; done += BLOCK) {
        const size_t block = count - done < BLOCK ? count - done : BLOCK;
        BP_TRY(get(loader, 4 * block, err));
        loader->checksum = crc32_z(loader->checksum, loader->buffer, 4 * block);
        for (size_t i = 0; i < block; i++)
            film->counts[done + i] = (uint32_t)load_little(loader->buffer + 4 * i, 4);
    }
    uint64_t expected[BP_REPLICATES_MAX];
    for (uint32_t k = 0; k < film->replicates; k++) expected[k] = bp_film_expected(film, k);
    for (size_t i = 0; i < count; i++) {
        const uint32_t samples = film->counts[i];
        if (samples > expected[i % film->replicates] || (samples == 0 && !cell_is_empty(film, i)))
            return bp_fail(err, BP_ERR_FILE,
                           "%s is damaged: pixel %zu holds %" PRIu32
                           " samples in replicate %zu, which contradicts its %s",
                           loader->name, i / film->replicates, samples, i % film->replicates,
                           samples == 0 ? "sums" : "sample ranges");
    }
    return BP_OK;
}

static BpStatus check_checksum(Loader *loader, BpError *err) {
    BP_TRY(get(loader, CHECKSUM_SIZE, err));
    const uint64_t expected = load_little(loader->buffer, CHECKSUM_SIZE);
    if (expected == loader->checksum) return BP_OK;
    return bp_fail(err, BP_ERR_FILE,
                   "%s is damaged: its checksum is %08" PRIx64 ", but its content has %08" PRIx64
                   "; copy it again, or render its samples again",
                   loader->name, expected, (uint64_t)loader->checksum);
}

/* Everything after the header, into a film of the right size. */
static BpStatus read_body(Loader *loader, const json_t *header, BpFilm *film, BpError *err) {
    BP_TRY(bp_film_header_settings(header, loader->name, film, err));
    if (loader->fine_sums) BP_TRY(bp_film_add_fine_sums(film, err));
    BP_TRY(read_sums(loader, film, film->sums, err));
    if (loader->fine_sums) BP_TRY(read_sums(loader, film, film->fine_sums, err));
    BP_TRY(read_counts(loader, film, err));
    return film->unverified ? BP_OK : check_checksum(loader, err);
}

BpStatus bp_film_read_stream(FILE *in, const char *name, BpFilm **film, BpError *err) {
    *film = NULL;
    json_t *header = NULL;
    BpFilm *made = NULL;
    BpFilm sizes = {.width = 0};
    Loader loader = {.in = in, .name = name};
    BpStatus status = read_header(&loader, &header, err);
    if (status != BP_OK) goto done;
    BP_TRY_GOTO(status, bp_film_header_sizes(header, name, &sizes, &loader.fine_sums, err), done);
    BP_TRY_GOTO(status, check_length(&loader, &sizes, err), done);
    BP_TRY_GOTO(status, bp_film_create(sizes.width, sizes.height, sizes.replicates, &made, err), done);
    made->unverified = sizes.unverified;
    made->coarse = sizes.coarse;
    loader.buffer = malloc(8 * BLOCK);
    if (loader.buffer == NULL) {
        status = bp_fail(err, BP_ERR_MEMORY, "out of memory for reading %s", name);
        goto done;
    }
    BP_TRY_GOTO(status, read_body(&loader, header, made, err), done);
    *film = made;
    made = NULL;
done:
    if (status != BP_OK) bp_error_at(err, name, 0, 0);
    free(loader.buffer);
    json_decref(header);
    bp_film_destroy(&made);
    return status;
}

BpStatus bp_film_read(const char *path, BpFilm **film, BpError *err) {
    *film = NULL;
    FILE *in = fopen(path, "rb");
    if (in == NULL) {
        bp_fail(err, BP_ERR_FILE, "cannot read %s: %s; check the path", path, strerror(errno));
        bp_error_at(err, path, 0, 0);
        return BP_ERR_FILE;
    }
    const BpStatus status = bp_film_read_stream(in, path, film, err);
    fclose(in);
    return status;
}
