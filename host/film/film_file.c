/* film_file.c: see film_file.h. */
#include "film_file.h"

#include "base/json_memory.h"
#include "base/known_file.h"
#include "base/output_file.h"
#include "base/plural.h"
#include "film_header.h"
#include "film_stream.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>

#define HEADER_SIZE_MAX (1u << 20)
#define SUM_MAX                                                                                              \
    ((int64_t)3 << 61) /* 2^24 samples of at most 2^38 come to 2^62; half as much again for rounding */

#define UNSEEN_FLOATS (sizeof(BpUnseenPixel) / sizeof(float))

static size_t cell_count(const BpFilm *film) {
    return (size_t)film->width * film->height * film->replicates;
}

/* ---- saving ---- */

BpStatus bp_film_write_stream(const BpFilm *film, FILE *out, BpError *err) {
    BpFilmSink sink;
    BpStatus status = bp_film_sink_init(out, &sink, err);
    char *header = status == BP_OK ? bp_film_header_make(film) : NULL;
    if (status == BP_OK && (header == NULL || bp_json_memory_failed())) /* or the header may lack a part */
        status = bp_fail(err, BP_ERR_MEMORY, "out of memory for writing the .bpa file");
    if (status == BP_OK) {
        const size_t pixels = (size_t)film->width * film->height, cells = cell_count(film);
        bp_film_sink_bytes(&sink, header, strlen(header));
        bp_film_sink_bytes(&sink, "\n", 1);
        bp_film_sink_numbers(&sink, film->sums, 8, 3 * cells);
        if (film->fine_sums != NULL) bp_film_sink_numbers(&sink, film->fine_sums, 8, 3 * cells);
        bp_film_sink_numbers(&sink, film->counts, 4, cells);
#define WRITE(place, member, floats, mean, channels)                                                         \
    if (film->member != NULL) bp_film_sink_numbers(&sink, film->member, 4, (floats)*pixels);
        AOV_LIST(WRITE)
#undef WRITE
        if (film->pixel_segments != NULL) bp_film_sink_numbers(&sink, film->pixel_segments, 8, pixels);
        if (film->met != NULL) bp_film_sink_numbers(&sink, film->met, 8, pixels);
        if (film->unseen != NULL) {
            bp_film_sink_numbers(&sink, film->unseen->pixels, 4, UNSEEN_FLOATS * pixels);
            bp_film_sink_numbers(&sink, film->unseen->tint, 4, 3);
        }
        if (film->plan != NULL)
            bp_film_sink_numbers(&sink, film->plan->decisions, 1, film->plan->decision_bytes);
        status = bp_film_sink_end(&sink, err);
    }
    free(header);
    bp_film_sink_clear(&sink);
    return status;
}

static BpStatus print_film(const void *film, FILE *out, BpError *err) {
    return bp_film_write_stream(film, out, err);
}

BpStatus bp_film_write(const BpFilm *film, const char *path, BpError *err) {
    return bp_output_write(path, false, print_film, film, err);
}

/* ---- loading ---- */

/* A file being read. */
typedef struct Loader {
    FILE *in;
    const char *name;
    BpFilmParts parts;
    size_t header_size;
    uLong header_checksum;
    uint64_t body_size; /* bytes between header and checksum */
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
    BpKnownFile known = {.kind = BP_FILE_SUMS};
    bp_known_file("", text, length, &known); /* by what it is: a film may have any name */
    if (ferror(loader->in))
        status = bp_fail(err, BP_ERR_FILE, "reading %s failed: %s", loader->name, strerror(errno));
    else if (known.kind != BP_FILE_SUMS)
        status = bp_fail(err, BP_ERR_FILE,
                         "%s: found %s, expected a .bpa file, as `ballpark render -o FILE.bpa` writes",
                         loader->name, known.what);
    else if (c != '\n')
        status = bp_fail(err, BP_ERR_FILE, "%s is not a .bpa file: it does not begin with a line of JSON",
                         loader->name);
    else if ((*header = bp_json_load(text, length, JSON_REJECT_DUPLICATES, &json_error, &no_memory)) == NULL)
        status = no_memory ? bp_fail(err, BP_ERR_MEMORY, "out of memory for the header of %s", loader->name)
                           : bp_fail(err, BP_ERR_FILE,
                                     "%s is not a .bpa file: its first line is not JSON: %s (column %d)",
                                     loader->name, json_error.text, json_error.column);
    loader->header_checksum =
        crc32_z(crc32_z(crc32_z(0, NULL, 0), (const uint8_t *)text, length), (const uint8_t *)"\n", 1);
    loader->header_size = length + 1;
    free(text);
    return status;
}

static uint64_t body_bytes(const Loader *loader, const BpFilm *sizes) {
    const BpFilmParts *parts = &loader->parts;
    /* At most 2^16 * 2^16 * 2^6 * 52 bytes and a little: far below 2^64. */
    const uint64_t pixels = (uint64_t)sizes->width * sizes->height;
    const uint64_t cell_size = (parts->fine_sums ? 2 : 1) * 3 * 8 + 4;
    return pixels * sizes->replicates * cell_size + pixels * (parts->aovs ? AOV_MET * sizeof(float) : 0) +
           pixels * (parts->pixel_segments ? 8 : 0) + pixels * (parts->alpha ? 8 : 0) +
           (parts->unseen ? pixels * sizeof(BpUnseenPixel) + 3 * sizeof(float) : 0) + parts->decision_bytes;
}

/* Whether a file of this length can hold so many numbers; before anything is allocated. */
static BpStatus check_length(Loader *loader, const BpFilm *sizes, BpError *err) {
    FILE *in = loader->in;
    if (fseeko(in, 0, SEEK_END) != 0)
        return bp_fail(err, BP_ERR_FILE, "%s is a pipe or a device: a .bpa file must be a regular file",
                       loader->name);
    const off_t length = ftello(in);
    if (length < 0 || fseeko(in, (off_t)loader->header_size, SEEK_SET) != 0)
        return bp_fail(err, BP_ERR_FILE, "reading %s failed: %s", loader->name, strerror(errno));
    const uint64_t around = loader->header_size + BP_FILM_CHECKSUM_BYTES;
    const uint64_t numbers = body_bytes(loader, sizes), actual = (uint64_t)length;
    loader->body_size = actual > around ? actual - around : 0;
    if (numbers <= bp_film_unpacked_max(loader->body_size)) return BP_OK;
    return bp_fail(err, BP_ERR_FILE,
                   "%s is truncated: %" PRIu64 " byte%s, but its header (%" PRIu32 " x %" PRIu32
                   " pixels, %" PRIu32 " replicate%s) says %" PRIu64
                   ", more than these bytes can be unpacked to",
                   loader->name, actual, bp_plural(actual), sizes->width, sizes->height, sizes->replicates,
                   bp_plural(sizes->replicates), around + numbers);
}

static BpStatus read_sums(BpFilmSource *source, const BpFilm *film, int64_t *sums, BpError *err) {
    const size_t count = 3 * cell_count(film);
    BP_TRY(bp_film_source_numbers(source, sums, 8, count, err));
    for (size_t i = 0; i < count; i++)
        if (sums[i] < 0 || sums[i] > SUM_MAX)
            return bp_fail(err, BP_ERR_FILE, "%s is damaged: the sum of pixel %zu is %s", source->name,
                           i / 3 / film->replicates,
                           sums[i] < 0 ? "negative" : "larger than a render can make it");
    return BP_OK;
}

static bool cell_is_empty(const BpFilm *film, size_t cell) {
    for (size_t i = 3 * cell; i < 3 * cell + 3; i++)
        if (film->sums[i] != 0 || (film->fine_sums != NULL && film->fine_sums[i] != 0)) return false;
    return true;
}

static BpStatus read_counts(BpFilmSource *source, BpFilm *film, BpError *err) {
    const size_t count = cell_count(film);
    BP_TRY(bp_film_source_numbers(source, film->counts, 4, count, err));
    uint64_t expected[BP_REPLICATES_MAX];
    for (uint32_t k = 0; k < film->replicates; k++) expected[k] = bp_film_expected(film, k);
    for (size_t i = 0; i < count; i++) {
        const uint32_t samples = film->counts[i];
        if (samples > expected[i % film->replicates] || (samples == 0 && !cell_is_empty(film, i)))
            return bp_fail(err, BP_ERR_FILE,
                           "%s is damaged: pixel %zu holds %" PRIu32
                           " samples in replicate %zu, which contradicts its %s",
                           source->name, i / film->replicates, samples, i % film->replicates,
                           samples == 0 ? "sums" : "sample ranges");
    }
    return BP_OK;
}

/* A mean over the rays that hit something is infinite if none did. */
#define IS_GOOD_MET(value) ((value) > -INFINITY)
#define IS_GOOD_ALL(value) isfinite(value)

static BpStatus read_aovs(BpFilmSource *source, BpFilm *film, BpError *err) {
    const size_t pixels = (size_t)film->width * film->height;
    BP_TRY(bp_film_add_aovs(film, err));
#define READ(place, member, floats, mean, channels)                                                          \
    BP_TRY(bp_film_source_numbers(source, film->member, 4, (floats)*pixels, err));                           \
    for (size_t i = 0; i < (floats)*pixels; i++)                                                             \
        if (!IS_GOOD_##mean(film->member[i]))                                                                \
            return bp_fail(err, BP_ERR_FILE, "%s is damaged: the " #member " of pixel %zu is not a number",  \
                           source->name, i / (floats));
    AOV_LIST(READ)
#undef READ
    return BP_OK;
}

static BpStatus read_pixel_segments(BpFilmSource *source, BpFilm *film, BpError *err) {
    const size_t pixels = (size_t)film->width * film->height;
    film->pixel_segments = calloc(pixels, sizeof *film->pixel_segments);
    if (film->pixel_segments == NULL)
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for the path lengths of %zu pixels", pixels);
    return bp_film_source_numbers(source, film->pixel_segments, 8, pixels, err);
}

static BpStatus read_met(BpFilmSource *source, BpFilm *film, BpError *err) {
    const size_t pixels = (size_t)film->width * film->height;
    BP_TRY(bp_film_add_met(film, err));
    BP_TRY(bp_film_source_numbers(source, film->met, 8, pixels, err));
    for (size_t i = 0; i < pixels; i++) {
        uint64_t samples = 0;
        for (size_t k = 0; k < film->replicates; k++) samples += film->counts[i * film->replicates + k];
        if (film->met[i] > samples)
            return bp_fail(err, BP_ERR_FILE, "%s is damaged: the alpha of pixel %zu is above 1", source->name,
                           i);
    }
    return BP_OK;
}

static BpStatus read_unseen(BpFilmSource *source, BpFilm *film, BpError *err) {
    const size_t pixels = (size_t)film->width * film->height;
    BP_TRY(bp_unseen_create(pixels, &film->unseen, err));
    BP_TRY(bp_film_source_numbers(source, film->unseen->pixels, 4, UNSEEN_FLOATS * pixels, err));
    BP_TRY(bp_film_source_numbers(source, film->unseen->tint, 4, 3, err));
    for (size_t i = 0; i < pixels; i++) {
        const BpUnseenPixel *pixel = &film->unseen->pixels[i];
        if (!(pixel->mean >= 0 && pixel->square >= 0 && isfinite(pixel->mean) && isfinite(pixel->square)))
            return bp_fail(err, BP_ERR_FILE, "%s is damaged: the unseen light of pixel %zu is not a radiance",
                           source->name, i);
    }
    for (int c = 0; c < 3; c++)
        if (!(film->unseen->tint[c] >= 0 && isfinite(film->unseen->tint[c])))
            return bp_fail(err, BP_ERR_FILE, "%s is damaged: the colour of the unseen light is none",
                           source->name);
    return BP_OK;
}

static BpStatus read_decisions(BpFilmSource *source, BpFilm *film, BpError *err) {
    const size_t size = film->plan->decision_bytes;
    film->plan->decisions = malloc(size);
    if (film->plan->decisions == NULL)
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for the decisions of adaptive sampling");
    return bp_film_source_numbers(source, film->plan->decisions, 1, size, err);
}

/* Everything after the header. */
static BpStatus read_numbers(const BpFilmParts *parts, BpFilmSource *source, BpFilm *film, BpError *err) {
    if (parts->fine_sums) BP_TRY(bp_film_add_fine_sums(film, err));
    BP_TRY(read_sums(source, film, film->sums, err));
    if (parts->fine_sums) BP_TRY(read_sums(source, film, film->fine_sums, err));
    BP_TRY(read_counts(source, film, err));
    if (parts->aovs) BP_TRY(read_aovs(source, film, err));
    if (parts->pixel_segments) BP_TRY(read_pixel_segments(source, film, err));
    if (parts->alpha) BP_TRY(read_met(source, film, err));
    if (parts->unseen) BP_TRY(read_unseen(source, film, err));
    if (parts->decision_bytes > 0) BP_TRY(read_decisions(source, film, err));
    return bp_film_source_end(source, err);
}

/* Invalid numbers mostly come from damage. So if the checksum at the end of the file is wrong, the error
 * reports that instead. */
static BpStatus read_body(const Loader *loader, BpFilm *film, BpError *err) {
    BpFilmSource source;
    BpStatus status = bp_film_source_init(loader->in, loader->name, loader->header_checksum,
                                          loader->body_size, &source, err);
    if (status == BP_OK) status = read_numbers(&loader->parts, &source, film, err);
    if (status == BP_OK || status == BP_ERR_FILE) {
        BpError damage = {0};
        const BpStatus verified = bp_film_source_verify(&source, &damage);
        if (verified != BP_OK) status = bp_fail(err, verified, "%s", damage.message);
        bp_error_clear(&damage);
    }
    bp_film_source_clear(&source);
    return status;
}

BpStatus bp_film_read_stream(FILE *in, const char *name, BpFilm **film, BpError *err) {
    *film = NULL;
    json_t *header = NULL;
    BpFilm *made = NULL;
    BpFilm sizes = {.width = 0};
    Loader loader = {.in = in, .name = name};
    BpStatus status = read_header(&loader, &header, err);
    if (status != BP_OK) goto done;
    BP_TRY_GOTO(status, bp_film_header_sizes(header, name, &sizes, &loader.parts, err), done);
    BP_TRY_GOTO(status, check_length(&loader, &sizes, err), done);
    BP_TRY_GOTO(status, bp_film_create(sizes.width, sizes.height, sizes.replicates, &made, err), done);
    made->coarse = sizes.coarse;
    BP_TRY_GOTO(status, bp_film_header_settings(header, name, made, err), done);
    BP_TRY_GOTO(status, read_body(&loader, made, err), done);
    *film = made;
    made = NULL;
done:
    if (status != BP_OK) bp_error_at(err, name, 0, 0);
    json_decref(header);
    bp_film_destroy(&made);
    return status;
}

static BpStatus open_file(const char *path, FILE **in, BpError *err) {
    *in = fopen(path, "rb");
    if (*in != NULL) return BP_OK;
    bp_fail(err, BP_ERR_FILE, "cannot read %s: %s; check the path", path, strerror(errno));
    bp_error_at(err, path, 0, 0);
    return BP_ERR_FILE;
}

BpStatus bp_film_read_header(const char *path, BpFilm **film, BpError *err) {
    *film = NULL;
    json_t *header = NULL;
    BpFilmParts parts;
    Loader loader = {.name = path};
    BpStatus status = open_file(path, &loader.in, err);
    if (status != BP_OK) return status;
    BpFilm *made = calloc(1, sizeof *made);
    if (made == NULL) status = bp_fail(err, BP_ERR_MEMORY, "out of memory for the header of %s", path);
    if (status == BP_OK) status = read_header(&loader, &header, err);
    if (status == BP_OK) status = bp_film_header_sizes(header, path, made, &parts, err);
    if (status == BP_OK) status = bp_film_header_settings(header, path, made, err);
    if (status != BP_OK) bp_error_at(err, path, 0, 0);
    json_decref(header);
    fclose(loader.in);
    if (status == BP_OK)
        *film = made;
    else
        bp_film_destroy(&made);
    return status;
}

BpStatus bp_film_read(const char *path, BpFilm **film, BpError *err) {
    FILE *in = NULL;
    *film = NULL;
    BP_TRY(open_file(path, &in, err));
    const BpStatus status = bp_film_read_stream(in, path, film, err);
    fclose(in);
    return status;
}
