/* film.c: making, ranges and merging; see film.h. */
#include "film.h"

#include "base/plural.h"
#include "base/status.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#define SAMPLES_END 4294967296u /* 2^32, one past the last sample number */

BpStatus bp_film_create(uint32_t width, uint32_t height, uint32_t replicates, BpFilm **film, BpError *err) {
    *film = NULL;
    if (width < 1 || height < 1 || width > BP_PICTURE_SIDE_MAX || height > BP_PICTURE_SIDE_MAX)
        return bp_fail(err, BP_ERR_LIMIT, "a picture of %" PRIu32 " x %" PRIu32 " pixels: sides are 1 to %u",
                       width, height, BP_PICTURE_SIDE_MAX);
    if (replicates < 1 || replicates > BP_REPLICATES_MAX)
        return bp_fail(err, BP_ERR_LIMIT, "%" PRIu32 " replicates: there are 1 to %u", replicates,
                       BP_REPLICATES_MAX);
    const size_t cells = (size_t)width * height * replicates;
    BpFilm *made = calloc(1, sizeof *made);
    if (made != NULL) {
        made->width = width;
        made->height = height;
        made->replicates = replicates;
        made->sums = calloc(cells, 3 * sizeof *made->sums);
        made->counts = calloc(cells, sizeof *made->counts);
    }
    if (made == NULL || made->sums == NULL || made->counts == NULL) {
        bp_film_destroy(&made);
        return bp_fail(err, BP_ERR_MEMORY,
                       "out of memory for %" PRIu32 " x %" PRIu32 " pixels of %" PRIu32
                       " replicates (%zu MiB); make the picture smaller",
                       width, height, replicates, cells * 28 >> 20);
    }
    *film = made;
    return BP_OK;
}

void bp_film_destroy(BpFilm **film) {
    if (film == NULL || *film == NULL) return;
    free((*film)->ranges);
    free((*film)->title);
    free((*film)->sums);
    free((*film)->fine_sums);
    free((*film)->counts);
    free((*film)->pixel_segments);
    free((*film)->met);
    bp_film_drop_aovs(*film);
    bp_unseen_destroy(&(*film)->unseen);
    bp_film_plan_destroy(&(*film)->plan);
    free(*film);
    *film = NULL;
}

void bp_film_plan_destroy(BpFilmPlan **plan) {
    if (*plan != NULL) free((*plan)->decisions);
    free(*plan);
    *plan = NULL;
}

BpStatus bp_film_add_fine_sums(BpFilm *film, BpError *err) {
    if (film->fine_sums != NULL) return BP_OK;
    const size_t cells = (size_t)film->width * film->height * film->replicates;
    film->fine_sums = calloc(cells, 3 * sizeof *film->fine_sums);
    if (film->fine_sums != NULL) return BP_OK;
    return bp_fail(err, BP_ERR_MEMORY, "out of memory for the fine sums of %zu pixels (%zu MiB)",
                   cells / film->replicates, cells * 24 >> 20);
}

BpStatus bp_film_add_met(BpFilm *film, BpError *err) {
    const size_t pixels = (size_t)film->width * film->height;
    if (film->met == NULL) film->met = calloc(pixels, sizeof *film->met);
    return film->met != NULL
               ? BP_OK
               : bp_fail(err, BP_ERR_MEMORY, "out of memory for the alpha of %zu pixels", pixels);
}

void bp_film_info(const BpFilm *film, BpFilmInfo *info) {
    *info = (BpFilmInfo){
        .title = film->title != NULL ? film->title : "",
        .width = film->width,
        .height = film->height,
        .samples_per_pixel = bp_film_range_total(film),
        .range_count = film->range_count,
        .partial = film->partial,
        .segments = film->segments,
        .truncated_paths = film->truncated_paths,
        .invalid_samples = film->invalid_samples,
#define GIVE(member, tally, words) .member = film->member,
        BP_INVALID_LIST(GIVE)
#undef GIVE
            .shadow_rays = film->shadow_rays,
        .scene_hash = film->scene_hash,
        .seed = film->seed,
        .max_depth = film->max_depth,
        .replicates = film->replicates,
#define SETTING(type, member, option, plural) .member = film->member,
        BP_SETTING_LIST(SETTING)
#undef SETTING
            .transfer = film->transfer,
    };
    bp_film_sample_counts(film, &info->samples_least, &info->samples_most, &info->samples_mean);
}

bool bp_film_range(const BpFilm *film, size_t index, uint64_t *first, uint64_t *count) {
    if (index >= film->range_count) return false;
    *first = film->ranges[index].first;
    *count = film->ranges[index].count;
    return true;
}

/* ---- ranges of samples ---- */

/* The number of s in [0, end) with s mod K = replicate. */
static uint64_t samples_before(uint64_t end, uint32_t replicates, uint32_t replicate) {
    return end / replicates + (end % replicates > replicate ? 1 : 0);
}

static uint64_t ranges_expected(const struct BpSampleRange *ranges, size_t count, uint32_t replicates,
                                uint32_t replicate) {
    uint64_t total = 0;
    for (size_t i = 0; i < count; i++)
        total += samples_before(ranges[i].first + ranges[i].count, replicates, replicate) -
                 samples_before(ranges[i].first, replicates, replicate);
    return total;
}

uint64_t bp_film_expected(const BpFilm *film, uint32_t replicate) {
    return ranges_expected(film->ranges, film->range_count, film->replicates, replicate);
}

uint64_t bp_film_range_total(const BpFilm *film) {
    uint64_t total = 0;
    for (size_t i = 0; i < film->range_count; i++) total += film->ranges[i].count;
    return total;
}

static BpStatus check_limit(uint64_t samples, BpError *err) {
    if (samples <= BP_REPLICATE_SAMPLES_MAX) return BP_OK;
    return bp_fail(err, BP_ERR_LIMIT,
                   "%" PRIu64 " samples in one replicate of a pixel: the sums are exact up to %u; render "
                   "fewer samples, or use more replicates",
                   samples, BP_REPLICATE_SAMPLES_MAX);
}

/* Adds a range at the end of a sorted list, or to its last range if they adjoin. */
static BpStatus append_range(struct BpSampleRange *list, size_t *count, const struct BpSampleRange *range,
                             BpError *err) {
    struct BpSampleRange *last = *count > 0 ? &list[*count - 1] : NULL;
    if (last == NULL || last->first + last->count < range->first) {
        list[(*count)++] = *range;
        return BP_OK;
    }
    if (last->first + last->count > range->first)
        return bp_fail_with(BP_REMEDY_OTHER_FIRST_SAMPLE, err, BP_ERR_USAGE,
                            "samples %" PRIu64 " to %" PRIu64 " and %" PRIu64 " to %" PRIu64
                            " overlap, so these samples would count twice",
                            last->first, last->first + last->count - 1, range->first,
                            range->first + range->count - 1);
    last->count += range->count;
    return BP_OK;
}

/* The ranges of `film` and those of a sorted list as one sorted list, which the caller frees; refused
 * where they overlap or exceed a limit. The film stays as it is. */
static BpStatus join_ranges(const BpFilm *film, const struct BpSampleRange *more, size_t more_count,
                            struct BpSampleRange **joined, size_t *joined_count, BpError *err) {
    const size_t most = film->range_count + more_count;
    struct BpSampleRange *list = malloc((most > 0 ? most : 1) * sizeof *list);
    if (list == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for %zu sample ranges", most);
    size_t count = 0, a = 0, b = 0;
    BpStatus status = BP_OK;
    while (status == BP_OK && a + b < most) {
        const bool own = b == more_count || (a < film->range_count && film->ranges[a].first <= more[b].first);
        status = append_range(list, &count, own ? &film->ranges[a++] : &more[b++], err);
    }
    if (status == BP_OK && count > BP_SAMPLE_RANGES_MAX)
        status = bp_fail(err, BP_ERR_LIMIT,
                         "%zu separate sample ranges: a film has at most %u; merge neighbours first", count,
                         BP_SAMPLE_RANGES_MAX);
    for (uint32_t k = 0; status == BP_OK && k < film->replicates; k++)
        status = check_limit(ranges_expected(list, count, film->replicates, k), err);
    if (status != BP_OK) {
        free(list);
        return status;
    }
    *joined = list;
    *joined_count = count;
    return BP_OK;
}

BpStatus bp_film_add_ranges(BpFilm *film, const struct BpSampleRange *ranges, size_t count, BpError *err) {
    for (size_t i = 0; i < count; i++)
        if (ranges[i].count < 1 || ranges[i].first >= SAMPLES_END ||
            ranges[i].count > SAMPLES_END - ranges[i].first)
            return bp_fail(err, BP_ERR_USAGE,
                           "%" PRIu64 " sample%s from number %" PRIu64
                           " on: sample numbers are 0 to 2^32 - 1",
                           ranges[i].count, bp_plural(ranges[i].count), ranges[i].first);
    struct BpSampleRange *joined = NULL;
    size_t joined_count = 0;
    BP_TRY(join_ranges(film, ranges, count, &joined, &joined_count, err));
    free(film->ranges);
    film->ranges = joined;
    film->range_count = joined_count;
    return BP_OK;
}

BpStatus bp_film_add_range(BpFilm *film, uint64_t first, uint64_t count, BpError *err) {
    const struct BpSampleRange range = {first, count};
    return bp_film_add_ranges(film, &range, 1, err);
}

/* ---- merging ---- */

BpStatus bp_film_check_same(const BpFilm *a, const BpFilm *b, BpError *err) {
#define BP_SAME(field, remedy, difference)                                                                   \
    if (a->field != b->field)                                                                                \
    return bp_fail_with(remedy, err, BP_ERR_USAGE, difference, (int64_t)a->field, (int64_t)b->field)
#define BP_SAME_SETTING(type, member, option, plural)                                                        \
    if (a->member != b->member) {                                                                            \
        bp_fail(err, BP_ERR_USAGE, plural " differ (%s and %s)", bp_##member##_names[a->member],             \
                bp_##member##_names[b->member]);                                                             \
        bp_error_set_remedy(err, BP_REMEDY_SAME_SETTING, #member);                                           \
        return BP_ERR_USAGE;                                                                                 \
    }
    BP_SAME(width, BP_REMEDY_SAME_WIDTH, "widths differ (%" PRId64 " and %" PRId64 " pixels)");
    BP_SAME(height, BP_REMEDY_NONE, "heights differ (%" PRId64 " and %" PRId64 " pixels)");
    if (a->scene_hash != b->scene_hash)
        return bp_fail(err, BP_ERR_USAGE, "scenes differ (%016" PRIx64 " and %016" PRIx64 ")", a->scene_hash,
                       b->scene_hash);
    if (a->seed != b->seed)
        return bp_fail_with(BP_REMEDY_SAME_SEED, err, BP_ERR_USAGE,
                            "seeds differ (%" PRIu64 " and %" PRIu64 ")", a->seed, b->seed);
    BP_SAME(replicates, BP_REMEDY_NONE, "numbers of replicates differ (%" PRId64 " and %" PRId64 ")");
    BP_SAME(max_depth, BP_REMEDY_SAME_DEPTH, "depths differ (%" PRId64 " and %" PRId64 ")");
    BP_SETTING_LIST(BP_SAME_SETTING)
    /* It follows from all of these, which say more. */
    BP_SAME(scale_log2, BP_REMEDY_NONE, "fixed-point scales differ (2^%" PRId64 " and 2^%" PRId64 ")");
    if (a->transfer != b->transfer)
        return bp_fail(err, BP_ERR_USAGE, "transfer curves differ (%s and %s)",
                       bp_transfer_names[a->transfer], bp_transfer_names[b->transfer]);
#undef BP_SAME
#undef BP_SAME_SETTING
    return BP_OK;
}

/* Whether the two sums of every cell can be added. Those of any real render can. */
static BpStatus check_sums(const BpFilm *into, const BpFilm *from, const int64_t *a, const int64_t *b,
                           BpError *err) {
    const size_t channels = (size_t)into->width * into->height * into->replicates * 3;
    for (size_t i = 0; i < channels; i++)
        if (b[i] > 0 ? a[i] > INT64_MAX - b[i] : a[i] < INT64_MIN - b[i])
            return bp_fail(err, BP_ERR_LIMIT, "the sums of pixel %zu overflow 64 bits: a file is damaged",
                           i / 3 / from->replicates);
    return BP_OK;
}

static bool total_overflows(uint64_t a, uint64_t b) {
    return a > INT64_MAX || b > INT64_MAX - a;
}

BpStatus bp_film_add_sums(BpFilm *film, const BpFilm *from, BpError *err) {
    const size_t cells = (size_t)film->width * film->height * film->replicates;
    if (from->fine_sums != NULL) BP_TRY(bp_film_add_fine_sums(film, err));
    if (from->met != NULL) BP_TRY(bp_film_add_met(film, err));
    for (size_t i = 0; from->met != NULL && i < cells / film->replicates; i++) film->met[i] += from->met[i];
    for (size_t i = 0; i < cells; i++) film->counts[i] += from->counts[i];
    for (size_t i = 0; i < 3 * cells; i++) film->sums[i] += from->sums[i];
    for (size_t i = 0; from->fine_sums != NULL && i < 3 * cells; i++)
        film->fine_sums[i] += from->fine_sums[i];
    film->coarse = film->coarse || from->coarse;
    film->segments += from->segments;
    film->truncated_paths += from->truncated_paths;
    film->invalid_samples += from->invalid_samples;
#define ADD(member, tally, words) film->member += from->member;
    BP_INVALID_LIST(ADD)
#undef ADD
    film->shadow_rays += from->shadow_rays;
    return BP_OK;
}

/* Whether the samples of `a` begin before those of `b`. They have none in common; a film without samples
 * comes last. */
static bool begins_before(const BpFilm *a, const BpFilm *b) {
    return a->range_count > 0 && (b->range_count == 0 || a->ranges[0].first < b->ranges[0].first);
}

/* Whether the film has all samples of the job of which it is a share. */
static bool is_whole_job(const BpFilm *film) {
    return film->range_count == 1 && film->ranges[0].first <= film->job.first &&
           film->ranges[0].first + film->ranges[0].count >= film->job.first + film->job.count;
}

BpStatus bp_film_merge(BpFilm *into, const BpFilm *from, BpError *err) {
    BP_TRY(bp_film_check_same(into, from, err));
    if ((into->met != NULL) != (from->met != NULL))
        return bp_fail(err, BP_ERR_USAGE, "one has an alpha and the other has none: a file is damaged");
    const size_t cells = (size_t)into->width * into->height * into->replicates;
    for (size_t i = 0; i < cells; i++) BP_TRY(check_limit((uint64_t)into->counts[i] + from->counts[i], err));
    BP_TRY(check_sums(into, from, into->sums, from->sums, err));
    if (into->fine_sums != NULL && from->fine_sums != NULL)
        BP_TRY(check_sums(into, from, into->fine_sums, from->fine_sums, err));
    /* A .bpa file holds totals up to 2^63 - 1; no sum of real renders comes near. */
    if (total_overflows(into->segments, from->segments) ||
        total_overflows(into->truncated_paths, from->truncated_paths) ||
        total_overflows(into->invalid_samples, from->invalid_samples) ||
        total_overflows(into->shadow_rays, from->shadow_rays))
        return bp_fail(err, BP_ERR_LIMIT,
                       "the numbers of ray segments, cut paths, invalid samples or rays to lamps overflow 63 "
                       "bits: a file is damaged");
    struct BpSampleRange *joined = NULL;
    size_t joined_count = 0;
    BP_TRY(join_ranges(into, from->ranges, from->range_count, &joined, &joined_count, err));
    /* Films of one scene have the same AOVs and the same unseen light, unless their devices round
     * differently. Then those of the first samples stay, in whatever order films are merged. */
    const bool is_first = begins_before(from, into);
    const bool takes_aovs = bp_film_has_aovs(from) && (!bp_film_has_aovs(into) || is_first);
    const bool takes_unseen = from->unseen != NULL && (into->unseen == NULL || is_first);
    BpUnseen *unseen = NULL;
    BpStatus status = from->fine_sums != NULL ? bp_film_add_fine_sums(into, err) : BP_OK;
    if (status == BP_OK && takes_unseen)
        status = bp_unseen_copy(from->unseen, (size_t)into->width * into->height, &unseen, err);
    if (status == BP_OK && takes_aovs) status = bp_film_add_aovs(into, err);
    if (status != BP_OK) {
        bp_unseen_destroy(&unseen);
        free(joined);
        return status;
    }

    /* Nothing fails from here on: there is room for the fine sums. */
    if (takes_unseen) {
        bp_unseen_destroy(&into->unseen);
        into->unseen = unseen;
    }
    (void)bp_film_add_sums(into, from, NULL);
    free(into->ranges);
    into->ranges = joined;
    into->range_count = joined_count;
    if (takes_aovs) bp_film_copy_aovs(from, into);
    into->partial = into->partial || from->partial;
    if (into->job.first != from->job.first || into->job.count != from->job.count || is_whole_job(into))
        into->job = (struct BpSampleRange){0, 0};
    free(into->pixel_segments);
    into->pixel_segments = NULL;
    bp_film_plan_destroy(&into->plan);
    return BP_OK;
}
