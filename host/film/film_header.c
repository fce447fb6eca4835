/* film_header.c: see film_header.h. */
#include "film_header.h"

#include "base/names.h"
#include "base/status.h"

#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#define SAMPLES_END INT64_C(4294967296) /* 2^32, one past the last sample number */
#define TITLE_BYTES_MAX 65536u          /* in the file: a header is at most 1 MiB */

/* ---- making ---- */

/* NULL when out of memory, and so is the header then. */
static json_t *ranges_json(const BpFilm *film) {
    json_t *list = json_array();
    for (size_t i = 0; i < film->range_count && list != NULL; i++) {
        json_t *range =
            json_pack("[I,I]", (json_int_t)film->ranges[i].first, (json_int_t)film->ranges[i].count);
        if (json_array_append_new(list, range) == 0) continue;
        json_decref(list);
        list = NULL;
    }
    return list;
}

/* Bytes of a title that go to the file: whole characters of UTF-8, not too many. */
static size_t title_bytes(const char *title) {
    size_t length = strlen(title);
    if (length <= TITLE_BYTES_MAX) return length;
    length = TITLE_BYTES_MAX;
    while (length > 0 && ((unsigned char)title[length] & 0xc0) == 0x80) length--;
    return length;
}

static json_t *plan_json(const BpFilmPlan *plan) {
    return json_pack("{s:b,s:b,s:I,s:I,s:I,s:I,s:I,s:I,s:f,s:I}", "adaptive", (int)plan->adaptive, "ended",
                     (int)plan->ended, "first_sample", (json_int_t)plan->first_sample, "target",
                     (json_int_t)plan->target, "done", (json_int_t)plan->done, "pass_samples",
                     (json_int_t)plan->pass_samples, "next_pixel", (json_int_t)plan->next_pixel,
                     "samples_max", (json_int_t)plan->samples_max, "error", plan->error, "decision_bytes",
                     (json_int_t)plan->decision_bytes);
}

/* Adds the optional members; false when out of memory. */
static bool add_optional(json_t *header, const BpFilm *film) {
    if (film->job.count > 0 &&
        json_object_set_new(
            header, "job", json_pack("[I,I]", (json_int_t)film->job.first, (json_int_t)film->job.count)) != 0)
        return false;
    return film->plan == NULL || json_object_set_new(header, "plan", plan_json(film->plan)) == 0;
}

char *bp_film_header_make(const BpFilm *film) {
    char hash[32], seed[32];
    snprintf(hash, sizeof hash, "%016" PRIx64, film->scene_hash);
    snprintf(seed, sizeof seed, "%" PRIu64, film->seed);
    const char *title = film->title != NULL ? film->title : "";
    json_t *header =
        json_pack("{s:i,s:s,s:s%,s:I,s:I,s:I,s:i,s:b,s:b,s:b,s:b,s:b,s:b,s:s,s:s,s:I}", "ballpark_film",
                  BP_FILM_VERSION, "byte_order", "little", "title", title, title_bytes(title), "width",
                  (json_int_t)film->width, "height", (json_int_t)film->height, "replicates",
                  (json_int_t)film->replicates, "scale_log2", (int)film->scale_log2, "fine_sums",
                  (int)(film->fine_sums != NULL), "coarse", (int)film->coarse, "aovs",
                  (int)bp_film_has_aovs(film), "pixel_segments", (int)(film->pixel_segments != NULL), "alpha",
                  (int)(film->met != NULL), "unseen", (int)(film->unseen != NULL), "scene_hash", hash, "seed",
                  seed, "max_depth", (json_int_t)film->max_depth);
    json_t *rest =
        json_pack("{s:s,s:o,s:b,s:I,s:I,s:I,s:I}", "transfer", bp_transfer_names[film->transfer], "ranges",
                  ranges_json(film), "partial", (int)film->partial, "segments", (json_int_t)film->segments,
                  "shadow_rays", (json_int_t)film->shadow_rays, "cut_paths",
                  (json_int_t)film->truncated_paths, "invalid_samples", (json_int_t)film->invalid_samples);
    bool whole = true;
#define WRITE(type, member, option, plural)                                                                  \
    whole =                                                                                                  \
        whole && json_object_set_new(header, #member, json_string(bp_##member##_names[film->member])) == 0;
    BP_SETTING_LIST(WRITE)
#undef WRITE
#define WRITE(member, tally, words)                                                                          \
    whole = whole && json_object_set_new(header, #member, json_integer((json_int_t)film->member)) == 0;
    BP_INVALID_LIST(WRITE)
#undef WRITE
    whole = whole && json_object_update(header, rest) == 0 && add_optional(header, film);
    json_decref(rest);
    char *text = whole ? json_dumps(header, JSON_PRESERVE_ORDER) : NULL;
    json_decref(header);
    return text;
}

/* ---- reading ---- */

/* Reads members of the header one after the other, and keeps the first fault. */
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

static bool read_truth(Reader *reader, const char *member) {
    const json_t *value = json_object_get(reader->header, member);
    if (!json_is_boolean(value)) bad_member(reader, member, "true or false");
    return json_is_true(value);
}

static void read_ranges(Reader *reader, BpFilm *film) {
    const json_t *list = json_object_get(reader->header, "ranges");
    const size_t count_of_ranges = json_array_size(list);
    if (!json_is_array(list) || count_of_ranges > BP_SAMPLE_RANGES_MAX) {
        bad_member(reader, "ranges", "a list of at most 10000 [first, count]");
        return;
    }
    struct BpSampleRange *ranges = malloc((count_of_ranges > 0 ? count_of_ranges : 1) * sizeof *ranges);
    if (ranges == NULL) {
        if (reader->status == BP_OK) reader->status = bp_fail(reader->err, BP_ERR_MEMORY, "out of memory");
        return;
    }
    uint64_t end = 0;
    for (size_t i = 0; i < count_of_ranges && reader->status == BP_OK; i++) {
        const json_t *range = json_array_get(list, i);
        const json_t *first = json_array_get(range, 0), *count = json_array_get(range, 1);
        if (json_array_size(range) != 2 || !json_is_integer(first) || !json_is_integer(count) ||
            json_integer_value(first) < 0 || json_integer_value(count) < 1 ||
            (uint64_t)json_integer_value(first) < end) {
            bad_member(reader, "ranges", "a list of [first, count], sorted and disjoint, count at least 1");
            break;
        }
        ranges[i] =
            (struct BpSampleRange){(uint64_t)json_integer_value(first), (uint64_t)json_integer_value(count)};
        end = ranges[i].first + ranges[i].count;
    }
    if (reader->status == BP_OK) {
        const BpStatus status = bp_film_add_ranges(film, ranges, count_of_ranges, reader->err);
        if (status == BP_ERR_MEMORY)
            reader->status = status;
        else if (status != BP_OK)
            bad_member(reader, "ranges", "sample numbers below 2^32, at most 2^24 of them in a replicate");
    }
    free(ranges);
}

/* The part of the header that decides how long the file is. */
static void read_sizes(Reader *reader, BpFilm *sizes, BpFilmParts *parts) {
    const uint64_t version = read_integer(reader, "ballpark_film", 1, INT64_MAX);
    if (version > BP_FILM_VERSION && reader->status == BP_OK)
        reader->status = bp_fail(reader->err, BP_ERR_FILE,
                                 "%s has version %" PRIu64
                                 " of the format, but this program reads version %d: use a newer Ballpark",
                                 reader->name, version, BP_FILM_VERSION);
    static const char *const byte_orders[] = {"little", NULL};
    read_name(reader, "byte_order", byte_orders);
    sizes->width = (uint32_t)read_integer(reader, "width", 1, BP_PICTURE_SIDE_MAX);
    sizes->height = (uint32_t)read_integer(reader, "height", 1, BP_PICTURE_SIDE_MAX);
    sizes->replicates = (uint32_t)read_integer(reader, "replicates", 1, BP_REPLICATES_MAX);
    parts->fine_sums = read_truth(reader, "fine_sums");
    sizes->coarse = read_truth(reader, "coarse");
    parts->aovs = read_truth(reader, "aovs");
    parts->pixel_segments = read_truth(reader, "pixel_segments");
    parts->alpha = read_truth(reader, "alpha");
    parts->unseen = read_truth(reader, "unseen");
    const json_t *plan = json_object_get(reader->header, "plan");
    Reader inner = {plan, reader->name, reader->status, reader->err};
    if (plan != NULL) parts->decision_bytes = read_integer(&inner, "decision_bytes", 0, INT32_MAX);
    reader->status = inner.status;
}

/* The samples of the whole job, if the film is a share of one. */
static void read_job(Reader *reader, BpFilm *film) {
    const json_t *job = json_object_get(reader->header, "job");
    const json_t *first = json_array_get(job, 0), *count = json_array_get(job, 1);
    if (job == NULL) return;
    if (json_array_size(job) != 2 || !json_is_integer(first) || !json_is_integer(count) ||
        json_integer_value(first) < 0 || json_integer_value(count) < 1 ||
        json_integer_value(first) >= SAMPLES_END ||
        json_integer_value(count) > SAMPLES_END - json_integer_value(first)) {
        bad_member(reader, "job", "[first, count] of sample numbers below 2^32");
        return;
    }
    film->job =
        (struct BpSampleRange){(uint64_t)json_integer_value(first), (uint64_t)json_integer_value(count)};
}

/* Whether the plan fits the rest of the film, so that a render that continues from it stays within bounds. */
static bool plan_fits(const BpFilm *film, const BpFilmPlan *plan) {
    const uint64_t pixels = (uint64_t)film->width * film->height;
    if (plan->next_pixel >= pixels || (plan->pass_samples == 0 && plan->next_pixel != 0)) return false;
    if (plan->first_sample + plan->target > SAMPLES_END) return false;
    /* In an adaptive render, `done` counts within a pass, whose length follows from its decisions. */
    return plan->decision_bytes > 0 || plan->done + plan->pass_samples <= plan->target;
}

static void read_plan(Reader *reader, BpFilm *film) {
    const json_t *json = json_object_get(reader->header, "plan");
    if (json == NULL || reader->status != BP_OK) return;
    BpFilmPlan *plan = calloc(1, sizeof *plan);
    if (plan == NULL) {
        reader->status = bp_fail(reader->err, BP_ERR_MEMORY, "out of memory");
        return;
    }
    film->plan = plan;
    Reader inner = {json, reader->name, BP_OK, reader->err};
    plan->adaptive = read_truth(&inner, "adaptive");
    plan->ended = read_truth(&inner, "ended");
    plan->first_sample = read_integer(&inner, "first_sample", 0, SAMPLES_END - 1);
    plan->target = read_integer(&inner, "target", 1, SAMPLES_END);
    plan->done = read_integer(&inner, "done", 0, SAMPLES_END);
    plan->pass_samples = (uint32_t)read_integer(&inner, "pass_samples", 0, UINT32_MAX);
    plan->next_pixel = (uint32_t)read_integer(&inner, "next_pixel", 0, UINT32_MAX);
    plan->samples_max = read_integer(&inner, "samples_max", 0, SAMPLES_END);
    plan->decision_bytes = (size_t)read_integer(&inner, "decision_bytes", 0, INT32_MAX);
    const json_t *error = json_object_get(json, "error");
    plan->error = json_number_value(error);
    if (!json_is_number(error) || !(plan->error >= 0 && plan->error <= 1e9))
        bad_member(&inner, "error", "a number from 0 to 10^9");
    reader->status = inner.status;
    if (inner.status == BP_OK && !plan_fits(film, plan))
        bad_member(reader, "plan", "one that goes with the size of the picture and the samples");
}

static void read_invalid(Reader *reader, BpFilm *film) {
    uint64_t rest = film->invalid_samples = read_integer(reader, "invalid_samples", 0, INT64_MAX);
#define READ(member, tally, words)                                                                           \
    film->member = read_integer(reader, #member, 0, (int64_t)rest);                                          \
    rest -= film->member;
    BP_INVALID_LIST(READ)
#undef READ
    if (rest > 0) bad_member(reader, "invalid_samples", "the sum of their causes");
}

static void read_settings(Reader *reader, BpFilm *film) {
    const json_t *scale = json_object_get(reader->header, "scale_log2");
    if (!json_is_integer(scale) || json_integer_value(scale) < -126 || json_integer_value(scale) > 126)
        bad_member(reader, "scale_log2", "a whole number from -126 to 126");
    else
        film->scale_log2 = (int32_t)json_integer_value(scale);
    film->scene_hash = read_wide(reader, "scene_hash", 16, "a string of up to 16 hexadecimal digits");
    film->seed = read_wide(reader, "seed", 10, "a string of decimal digits, below 2^64");
    film->max_depth = (uint32_t)read_integer(reader, "max_depth", 0, BP_DEPTH_MAX);
#define READ(type, member, option, plural)                                                                   \
    film->member = (type)read_name(reader, #member, bp_##member##_names);
    BP_SETTING_LIST(READ)
#undef READ
    film->transfer = (BpTransfer)read_name(reader, "transfer", bp_transfer_names);
    film->segments = read_integer(reader, "segments", 0, INT64_MAX);
    film->truncated_paths = read_integer(reader, "cut_paths", 0, INT64_MAX);
    read_invalid(reader, film);
    film->shadow_rays = read_integer(reader, "shadow_rays", 0, INT64_MAX);
    film->partial = read_truth(reader, "partial");
    const char *title = json_string_value(json_object_get(reader->header, "title"));
    if (title == NULL) bad_member(reader, "title", "a string");
    read_ranges(reader, film);
    read_job(reader, film);
    read_plan(reader, film);
    if (reader->status != BP_OK) return;
    film->title = strdup(title);
    if (film->title == NULL) reader->status = bp_fail(reader->err, BP_ERR_MEMORY, "out of memory");
}

BpStatus bp_film_header_sizes(const json_t *header, const char *name, BpFilm *sizes, BpFilmParts *parts,
                              BpError *err) {
    if (json_object_get(header, "ballpark_accumulator") != NULL)
        return bp_fail(
            err, BP_ERR_FILE,
            "%s was made by an unreleased Ballpark, and this one cannot read it: render its samples "
            "again",
            name);
    if (json_object_get(header, "ballpark_film") == NULL)
        return bp_fail(err, BP_ERR_FILE, "%s is not a .bpa file: \"ballpark_film\" is missing", name);
    Reader reader = {header, name, BP_OK, err};
    *parts = (BpFilmParts){.fine_sums = false};
    read_sizes(&reader, sizes, parts);
    return reader.status;
}

BpStatus bp_film_header_settings(const json_t *header, const char *name, BpFilm *film, BpError *err) {
    Reader reader = {header, name, BP_OK, err};
    read_settings(&reader, film);
    return reader.status;
}
