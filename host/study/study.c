/* study.c: the order of a study: references, every configuration at every count, results, within the time.
 * See study.h. */
#include "study.h"

#include "base/clock.h"
#include "base/status.h"
#include "base/words.h"
#include "configurations.h"
#include "crop.h"
#include "fit.h"
#include "measure.h"
#include "references.h"
#include "timing.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define REFERENCE_SHARE 0.4 /* of the time */
#define LEVEL_FIRST 4u      /* samples per pixel: one a replicate */
#define LEVEL_FACTOR 4u
#define ROUND_SECONDS 0.005

typedef enum BpStudyPhase {
    BP_STUDY_OPEN_REFERENCES,
    BP_STUDY_REFERENCES,
    BP_STUDY_OPEN_CONFIGURATIONS,
    BP_STUDY_LEVELS,
    BP_STUDY_DONE
} BpStudyPhase;

/* A configuration that is being rendered. */
typedef struct BpStudyRunner {
    BpRender *render;
    double cpu_seconds, wall_seconds, warm_device_seconds;
    double seconds;                     /* of the counts before the present one, undisturbed */
    double rounds[BP_STUDY_ROUNDS_MAX]; /* seconds, of the present count */
    bool done;                          /* with the present round */
} BpStudyRunner;

struct BpStudy {
    BpStudyResult result;
    BpScene variants[3]; /* by BpStudyFresnel; share everything but the materials with the scene */
    BpDeviceInfo device;
    BpStudyPhase phase;
    double start;
    BpReferences references;
    BpStudyRunner runners[BP_STUDY_CONFIGURATIONS_MAX];
    size_t turn;               /* the current configuration */
    uint64_t level;            /* samples per pixel of the current level */
    size_t round, round_count; /* of the present level */
    bool last_level;           /* the present one is */
    BpPicture first;           /* of the base, one sample per pixel */
    double *interest;          /* of every pixel: how much configurations differ there */
    uint32_t crop_left, crop_top;
};

static double elapsed(const BpStudy *study) {
    return bp_clock_seconds() - study->start;
}

static BpStatus make_variants(const BpScene *scene, BpStudy *study, BpError *err) {
    static const BpFresnel fresnel[3] = {
        [BP_STUDY_FRESNEL_SCHLICK] = BP_FRESNEL_SCHLICK, [BP_STUDY_FRESNEL_EXACT] = BP_FRESNEL_EXACT};
    for (int f = 0; f < 3; f++) {
        BpScene *variant = &study->variants[f];
        *variant = *scene;
        variant->materials = malloc((scene->material_count + 1) * sizeof *scene->materials);
        if (variant->materials == NULL) return bp_fail(err, BP_ERR_MEMORY, "no memory for materials");
        if (scene->material_count > 0)
            memcpy(variant->materials, scene->materials, scene->material_count * sizeof *scene->materials);
        for (size_t m = 0; m < scene->material_count && f != BP_STUDY_FRESNEL_SCENE; m++)
            if (variant->materials[m].fresnel != BP_FRESNEL_NONE) variant->materials[m].fresnel = fresnel[f];
    }
    return BP_OK;
}

BpStatus bp_study_create(const BpScene *scene, const BpRenderOptions *base, const BpDeviceInfo *device,
                         uint32_t full_width, uint32_t full_height, double seconds, BpStudy **study,
                         BpError *err) {
    BpRenderOptions defaults;
    BpDeviceInfo found;
    if (!(seconds > 0) || isinf(seconds))
        return bp_fail(err, BP_ERR_USAGE, "a study of %g seconds: expected a time above 0", seconds);
    if (base == NULL) {
        bp_render_defaults(scene, &defaults);
        base = &defaults;
    }
    if (device == NULL) {
        BP_TRY(bp_device_find(NULL, &found, err));
        device = &found;
    }
    BpStudy *made = calloc(1, sizeof *made);
    BpStudyConfiguration configurations[BP_STUDY_CONFIGURATIONS_MAX];
    if (made == NULL) return bp_fail(err, BP_ERR_MEMORY, "no memory for a study");
    made->start = bp_clock_seconds();
    made->device = *device;
    made->result.scene = scene;
    made->result.full_width = full_width > 0 ? full_width : scene->camera.width;
    made->result.full_height = full_height > 0 ? full_height : scene->camera.height;
    made->result.budget = seconds;
    made->result.reference_is_kernel = device->has_double;
    made->result.count = bp_study_configurations(scene, base, device->has_double, configurations);
    for (size_t s = 0; s < made->result.count; s++) made->result.series[s].configuration = configurations[s];
    made->interest = calloc((size_t)scene->camera.width * scene->camera.height, sizeof *made->interest);
    BpStatus status = made->interest != NULL ? BP_OK : bp_fail(err, BP_ERR_MEMORY, "no memory for a study");
    if (status == BP_OK) status = make_variants(scene, made, err);
    if (status == BP_OK)
        *study = made;
    else
        bp_study_destroy(&made);
    return status;
}

void bp_study_destroy(BpStudy **study) {
    if (study == NULL || *study == NULL) return;
    BpStudyResult *result = &(*study)->result;
    bp_references_clear(&(*study)->references);
    for (size_t s = 0; s < result->count; s++) {
        bp_render_destroy(&(*study)->runners[s].render);
        for (size_t p = 0; p < BP_STUDY_LEVELS_MAX; p++)
            bp_study_crop_clear(&result->series[s].points[p].crop);
    }
    bp_study_crop_clear(&result->truth);
    bp_picture_clear(&(*study)->first);
    free((*study)->interest);
    for (int f = 0; f < 3; f++) free((*study)->variants[f].materials);
    free(*study);
    *study = NULL;
}

bool bp_study_has_finished(const BpStudy *study) {
    return study->phase == BP_STUDY_DONE;
}

const BpStudyResult *bp_study_result(const BpStudy *study) {
    return &study->result;
}

/* ---- references -------------------------------------------------------------------------------------- */

static BpStatus open_references(BpStudy *study, BpError *err) {
    const BpRenderOptions *base = &study->result.series[0].configuration.options;
    study->phase = BP_STUDY_REFERENCES;
    return bp_references_open(&study->references, &study->variants[BP_STUDY_FRESNEL_EXACT], base,
                              &study->device, err);
}

static BpStatus step_references(BpStudy *study, BpError *err) {
    BpStudyResult *result = &study->result;
    bool finished = false;
    BP_TRY(bp_references_step(&study->references, REFERENCE_SHARE * result->budget, &finished, err));
    if (!finished) return BP_OK;
    study->phase = BP_STUDY_OPEN_CONFIGURATIONS;
    result->reference_samples = study->references.done[0];
    bp_references_judge(&study->references, &result->brightness, &result->reference_error);
    if (!(result->brightness > 0))
        return bp_fail(err, BP_ERR_SCENE,
                       "%s: the picture is black, so relative errors are undefined; add light to the scene",
                       result->scene->path);
    return BP_OK;
}

/* ---- rounds of a level ---- */

/* Samples per pixel when the level began: those of the last point, or, at first, the one of the warm-up. */
static uint64_t samples_before(const BpStudy *study) {
    const BpStudySeries *base = &study->result.series[0];
    return base->count > 0 ? base->points[base->count - 1].samples : 1;
}

/* Samples per pixel after so many rounds of the level. */
static uint64_t samples_after(const BpStudy *study, size_t rounds) {
    const uint64_t before = samples_before(study);
    return before + (study->level - before) * rounds / study->round_count;
}

/* Earlier samples decide where adaptive ones go, so such a configuration gets a level at once, not round by
 * round. */
static bool goes_at_once(const BpStudy *study, size_t s) {
    return study->result.series[s].configuration.options.adaptive;
}

/* The next round of all configurations; each time, another one goes first. */
static BpStatus begin_round(BpStudy *study, BpError *err) {
    study->turn = (study->result.series[0].count + study->round) % study->result.count;
    for (size_t s = 0; s < study->result.count; s++) {
        BpStudyRunner *runner = &study->runners[s];
        runner->rounds[study->round] = 0;
        if (goes_at_once(study, s) && study->round > 0) continue;
        runner->done = false;
        const size_t rounds = goes_at_once(study, s) ? study->round_count : study->round + 1;
        BP_TRY(bp_render_extend(runner->render, samples_after(study, rounds), err));
    }
    return BP_OK;
}

/* Goes up to `level` samples per pixel, in rounds that last long enough for launches and clocks not to
 * matter. */
static BpStatus begin_level(BpStudy *study, uint64_t level, BpError *err) {
    const uint64_t before = samples_before(study), samples = level - before;
    const double seconds =
        before > 1 ? study->runners[0].seconds / (double)(before - 1) * (double)samples : 0;
    study->level = level;
    study->round = 0;
    study->round_count = (size_t)fmin(fmax(1, seconds / ROUND_SECONDS), BP_STUDY_ROUNDS_MAX);
    if (study->round_count > samples) study->round_count = (size_t)samples;
    return begin_round(study, err);
}

/* Adds the seconds of the level that has ended, and notes the ratios of all configurations to the base. */
static void add_seconds(BpStudy *study) {
    double samples[BP_STUDY_ROUNDS_MAX];
    const double *base = study->runners[0].rounds;
    const size_t count = study->round_count;
    for (size_t r = 0; r < count; r++)
        samples[r] = (double)(samples_after(study, r + 1) - samples_after(study, r));
    const double all = bp_study_round_sum(base, count);
    const double undisturbed = bp_study_round_seconds(base, samples, count);
    for (size_t s = 0; s < study->result.count; s++) {
        BpStudyRunner *runner = &study->runners[s];
        const double own = bp_study_round_sum(runner->rounds, count);
        runner->seconds += all > 0 ? own * undisturbed / all : own; /* disturbed as much as the base */
        study->result.series[s].time_ratio =
            bp_study_round_ratio(runner->rounds, base, goes_at_once(study, s) ? 0 : count);
    }
}

/* ---- points ------------------------------------------------------------------------------------------- */

/* Configuration s has one sample per pixel: records where it differs. */
static BpStatus note_first(BpStudy *study, size_t s, BpError *err) {
    BpPicture picture;
    const BpFilm *film = NULL;
    BP_TRY(bp_render_read_film(study->runners[s].render, &film, err));
    BP_TRY(bp_film_check_valid(film, err));
    BP_TRY(bp_film_picture(film, &picture, err));
    if (s > 0) {
        bp_study_interest_add(study->interest, &picture, &study->first, study->result.brightness);
        bp_picture_clear(&picture);
        return BP_OK;
    }
    study->first = picture;
    bp_study_interest_add(study->interest, &picture, &study->references.pictures[0],
                          study->result.brightness);
    return BP_OK;
}

/* The first sample of every pixel was the warm-up and is not in the times, hence n / (n - 1). */
static void note_times(const BpStudyRunner *runner, BpStudyPoint *point) {
    const double scale = (double)point->samples / (double)(point->samples - 1);
    BpRenderReport report;
    bp_render_report(runner->render, &report);
    point->wall_seconds = scale * runner->wall_seconds;
    point->cpu_seconds = scale * runner->cpu_seconds;
    point->device_seconds = scale * (report.device_seconds - runner->warm_device_seconds);
    point->seconds = scale * runner->seconds;
}

static bool is_truth(const BpStudyResult *result, size_t s) {
    return s == 1 && result->reference_is_kernel;
}

/* Compares with the base and the truth, which have the same counts: the base comes first in each round. */
static BpStatus note_differences(BpStudy *study, size_t s, const BpFilm *sums, const BpPicture *picture,
                                 BpError *err) {
    const BpStudyEstimate unknown = {(double)NAN, (double)NAN, (double)NAN};
    const BpPicture *truths = study->references.pictures;
    const double brightness = study->result.brightness;
    BpStudySeries *series = &study->result.series[s];
    const BpFilm *other = NULL;
    if (s == 0) {
        series->change = series->change_square = series->bias_square = unknown;
        series->bias = bp_study_unpaired(picture, &truths[0], &truths[1], brightness);
        return BP_OK;
    }
    BP_TRY(bp_render_read_film(study->runners[0].render, &other, err));
    BP_TRY(bp_study_paired(sums, other, brightness, &series->change, &series->change_square, err));
    if (is_truth(&study->result, s)) {
        BpStudySeries *base = &study->result.series[0];
        series->bias = bp_study_unpaired(picture, &truths[0], &truths[1], brightness);
        series->bias_square = (BpStudyEstimate){0, 0, 0}; /* by definition */
        return bp_study_paired(other, sums, brightness, &base->bias, &base->bias_square, err);
    }
    if (!study->result.reference_is_kernel) {
        series->bias = bp_study_unpaired(picture, &truths[0], &truths[1], brightness);
        series->bias_square = unknown;
        return BP_OK;
    }
    BP_TRY(bp_render_read_film(study->runners[1].render, &other, err));
    return bp_study_paired(sums, other, brightness, &series->bias, &series->bias_square, err);
}

/* Every configuration has reached the present count: adds the point of s, and how it differs from base and
 * truth. */
static BpStatus note_point(BpStudy *study, size_t s, BpError *err) {
    BpStudySeries *series = &study->result.series[s];
    BpStudyPoint *point = &series->points[series->count++];
    const BpPicture *truths = study->references.pictures;
    const BpFilm *sums = NULL;
    BpPicture picture;
    BpStatus status = BP_OK;
    point->samples = study->level;
    note_times(&study->runners[s], point);
    BP_TRY(bp_render_read_film(study->runners[s].render, &sums, err));
    point->claimed = bp_film_nrmse(sums);
    BP_TRY(bp_film_picture(sums, &picture, err));
    bp_study_errors(&picture, &truths[0], &truths[1], study->result.brightness, point);
    BP_TRY_GOTO(status,
                bp_study_crop(&picture, &truths[0], &truths[1], study->crop_left, study->crop_top,
                              study->result.scene->transfer, &point->crop, err),
                done);
    status = note_differences(study, s, sums, &picture, err);
done:
    bp_picture_clear(&picture);
    return status;
}

/* ---- configurations
 * ---------------------------------------------------------------------------------------- */

static BpStatus trace_to_end(BpRender *render, BpError *err) {
    BpProgress progress = {0};
    while (!progress.finished) BP_TRY(bp_render_step(render, &progress, err));
    return BP_OK;
}

/* Builds the kernel and takes one sample of every pixel, which drivers may use to compile once more. */
static BpStatus open_configuration(BpStudy *study, BpError *err) {
    const size_t s = study->turn;
    const BpStudyConfiguration *configuration = &study->result.series[s].configuration;
    BpStudyRunner *runner = &study->runners[s];
    BpRenderOptions options = configuration->options;
    options.samples_per_pixel = 1;
    options.first_sample = 0;
    BP_TRY(bp_render_create(&study->variants[configuration->fresnel], &options, &study->device, 1,
                            &runner->render, err));
    BP_TRY(trace_to_end(runner->render, err));
    BpRenderReport report;
    bp_render_report(runner->render, &report);
    runner->warm_device_seconds = report.device_seconds;
    BP_TRY(note_first(study, s, err));
    if (s == 0) {
        study->result.report = report;
        study->result.report.build_log = NULL;
    }
    if (++study->turn < study->result.count) return BP_OK;
    bp_study_crop_place(study->interest, study->first.width, study->first.height, &study->crop_left,
                        &study->crop_top);
    study->phase = BP_STUDY_LEVELS;
    return begin_level(study, LEVEL_FIRST, err);
}

/* ---- the end ----------------------------------------------------------------------------------------- */

/* A sample costs the same at every count, so the largest count, with the most rounds, serves for all. */
static void settle_seconds(BpStudyResult *result) {
    for (size_t s = 1; s < result->count; s++) {
        BpStudySeries *series = &result->series[s];
        if (isnan(series->time_ratio.value)) continue;
        for (size_t p = 0; p < series->count; p++)
            series->points[p].seconds = result->series[0].points[p].seconds * series->time_ratio.value;
    }
}

static BpStatus conclude(BpStudy *study, BpError *err) {
    BpStudyResult *result = &study->result;
    const BpCamera *camera = &result->scene->camera;
    const BpPicture *truths = study->references.pictures;
    size_t whole = BP_STUDY_LEVELS_MAX;
    for (size_t s = 0; s < result->count; s++)
        if (result->series[s].count < whole) whole = result->series[s].count;
    for (size_t s = 0; s < result->count; s++) result->series[s].count = whole;
    settle_seconds(result);
    bp_study_summarize(result);
    BP_TRY(bp_study_crop(&truths[0], &truths[0], &truths[1], study->crop_left, study->crop_top,
                         result->scene->transfer, &result->truth, err));
    result->crop_width = camera->width < BP_STUDY_CROP_WIDTH ? camera->width : BP_STUDY_CROP_WIDTH;
    result->crop_height = camera->height < BP_STUDY_CROP_HEIGHT ? camera->height : BP_STUDY_CROP_HEIGHT;
    result->seconds = elapsed(study);
    study->phase = BP_STUDY_DONE;
    return BP_OK;
}

BpStatus bp_study_stop(BpStudy *study, BpError *err) {
    if (study->phase == BP_STUDY_DONE) return BP_OK;
    for (size_t s = 0; s < study->result.count; s++)
        if (study->result.series[s].count < BP_STUDY_LEVELS_MIN)
            return bp_fail(err, BP_ERR_INTERRUPTED,
                           "interrupted before every configuration had two sample counts; there is nothing "
                           "to compare yet");
    study->result.cut_short = true;
    return conclude(study, err);
}

/* Seconds that all configurations together need to come from the present count to `level`. */
static double foretold(const BpStudy *study, uint64_t level) {
    double wall = 0;
    for (size_t s = 0; s < study->result.count; s++) wall += study->runners[s].wall_seconds;
    return wall / (double)(study->level - 1) * (double)(level - study->level);
}

static BpStatus next_level(BpStudy *study, BpError *err) {
    const double left = study->result.budget - elapsed(study);
    const size_t count = study->result.series[0].count;
    uint64_t next = LEVEL_FACTOR * study->level;
    if (study->last_level || count == BP_STUDY_LEVELS_MAX) return conclude(study, err);
    /* There are two counts in any case. Once, if four times the samples do not fit, twice as many may. */
    if (count > 1 && foretold(study, next) > left) {
        next = 2 * study->level;
        if (foretold(study, next) > left) return conclude(study, err);
        study->last_level = true;
    }
    return begin_level(study, next, err);
}

/* The next configuration from `turn` on, in a circle, that is not done with the round; false: all are. One is
 * done before the next begins, for it may have chunks under way until then. */
static bool find_turn(BpStudy *study) {
    for (size_t i = 0; i < study->result.count; i++) {
        const size_t s = (study->turn + i) % study->result.count;
        if (study->runners[s].done) continue;
        study->turn = s;
        return true;
    }
    return false;
}

static BpStatus step_runner(BpStudy *study, BpStudyRunner *runner, BpError *err) {
    const double wall = bp_clock_seconds(), cpu = bp_processor_seconds();
    BpProgress progress;
    BP_TRY(bp_render_step(runner->render, &progress, err));
    const double wall_seconds = bp_clock_seconds() - wall, cpu_seconds = bp_processor_seconds() - cpu;
    runner->wall_seconds += wall_seconds;
    runner->cpu_seconds += cpu_seconds;
    double seconds = wall_seconds;
    if (study->device.type == BP_DEVICE_CPU)
        seconds = fmin(seconds, cpu_seconds / fmax(1, study->device.compute_units));
    runner->rounds[study->round] += seconds;
    runner->done = progress.finished;
    return BP_OK;
}

/* Configurations take turns, round by round; once all have the samples of a level, their points are noted. */
static BpStatus step_levels(BpStudy *study, BpError *err) {
    if (find_turn(study)) return step_runner(study, &study->runners[study->turn], err);
    if (++study->round < study->round_count) return begin_round(study, err);
    add_seconds(study);
    for (size_t s = 0; s < study->result.count; s++) BP_TRY(note_point(study, s, err));
    return next_level(study, err);
}

#define PHASE_WORDS(X)                                                                                       \
    X(BP_STUDY_OPEN_REFERENCES, "opening the references")                                                    \
    X(BP_STUDY_REFERENCES, "rendering the references")                                                       \
    X(BP_STUDY_OPEN_CONFIGURATIONS, "building kernels") X(BP_STUDY_LEVELS, "") X(BP_STUDY_DONE, "done")
BP_WORDS(BpStudyPhase, static const char *const phase_words, PHASE_WORDS);

static void report_progress(const BpStudy *study, BpStudyProgress *progress) {
    const double spent = elapsed(study);
    progress->finished = study->phase == BP_STUDY_DONE;
    progress->seconds_left = progress->finished ? 0 : fmax(0, study->result.budget - spent);
    progress->fraction = progress->finished ? 1 : fmin(0.99, spent / study->result.budget);
    if (study->phase == BP_STUDY_LEVELS || study->phase == BP_STUDY_OPEN_CONFIGURATIONS)
        snprintf(progress->doing, sizeof progress->doing, "%s%s",
                 study->phase == BP_STUDY_LEVELS ? "" : "building: ",
                 study->result.series[study->turn].configuration.name);
    else
        snprintf(progress->doing, sizeof progress->doing, "%s", phase_words[study->phase]);
    if (study->phase == BP_STUDY_LEVELS) {
        const size_t used = strlen(progress->doing);
        snprintf(progress->doing + used, sizeof progress->doing - used, ", %llu samples",
                 (unsigned long long)study->level);
    }
}

BpStatus bp_study_step(BpStudy *study, BpStudyProgress *progress, BpError *err) {
    switch (study->phase) {
    case BP_STUDY_OPEN_REFERENCES:
        BP_TRY(open_references(study, err));
        break;
    case BP_STUDY_REFERENCES:
        BP_TRY(step_references(study, err));
        break;
    case BP_STUDY_OPEN_CONFIGURATIONS:
        BP_TRY(open_configuration(study, err));
        break;
    case BP_STUDY_LEVELS:
        BP_TRY(step_levels(study, err));
        break;
    case BP_STUDY_DONE:
        break;
    }
    if (progress != NULL) report_progress(study, progress);
    return BP_OK;
}
