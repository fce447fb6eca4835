/* series.c: see series.h. */
#include "series.h"

#include "base/plural.h"
#include "base/words.h"
#include "cli/output/result_file.h"
#include "formats/scene_changes.h"
#include "formats/scene_fit.h"
#include "scene/fit.h"
#include "scene/lighting.h"
#include "setup.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static BpStatus check_options(const BpCommandLine *line, BpError *err) {
    const bool frames = bp_option_given(line, BP_OPTION_FRAMES),
               turns = bp_option_given(line, BP_OPTION_TURNTABLE);
    if (!frames && !turns) return BP_OK;
    const char *const series = frames ? "--frames" : "--turntable";
    if (frames && turns)
        return bp_fail(err, BP_ERR_USAGE, "--frames and --turntable do not go together; give one of them");
    if (frames && bp_option_given(line, BP_OPTION_FRAME))
        return bp_fail(err, BP_ERR_USAGE, "--frames and --frame do not go together; give one of them");
    if (strcmp(line->operands[0], "-") == 0)
        return bp_fail(err, BP_ERR_USAGE,
                       "%s: a scene from standard input can be read once only; save it in a file", series);
    if (line->output != NULL && strcmp(line->output, "-") == 0)
        return bp_fail(err, BP_ERR_USAGE,
                       "%s makes several pictures, which cannot all go to standard output; give a name",
                       series);
    if (line->stats != NULL || line->error_map != NULL)
        return bp_fail(err, BP_ERR_USAGE,
                       "%s makes several pictures, and %s is the name of one file; leave it out", series,
                       line->stats != NULL ? "--stats" : "--error-map");
    return BP_OK;
}

/* The frames that --frames selects out of `count`. */
static BpStatus choose_frames(BpSeries *series, uint64_t count, BpError *err) {
    const BpSlice *const slice = &series->line->frames;
    const int64_t all = count < INT64_MAX ? (int64_t)count : INT64_MAX;
    int64_t first = slice->first < 0 ? slice->first + all : slice->first;
    int64_t last = slice->last < 0 ? slice->last + all : slice->last;
    if (first < 0) first = 0;
    if (last > all) last = all;
    if (first >= last)
        return bp_fail(err, BP_ERR_USAGE,
                       "--frames: there is no such frame among the %" PRIu64 " frame%s of %.400s", count,
                       bp_plural(count), series->line->operands[0]);
    series->first_frame = first;
    series->step = slice->step;
    series->count = ((uint64_t)(last - first) + slice->step - 1) / slice->step;
    return BP_OK;
}

static BpSceneChanges changes_of(BpSeries *series, uint64_t number) {
    const BpCommandLine *const line = series->line;
    BpSceneChanges changes = {.fit = line->fit};
    if (bp_option_given(line, BP_OPTION_FRAMES)) changes.film = &series->film;
    changes.has_frame = bp_option_given(line, BP_OPTION_FRAME) || bp_option_given(line, BP_OPTION_FRAMES);
    changes.frame = bp_option_given(line, BP_OPTION_FRAMES)
                        ? series->first_frame + (int64_t)(number * series->step)
                        : line->frame;
    changes.camera = series->has_camera ? &series->camera : NULL;
    changes.has_range = series->has_range;
    memcpy(changes.range, series->range, sizeof changes.range);
    return changes;
}

/* Fails if an entry has selected nothing in any frame, as its first frame alone would. */
static BpStatus check_selections(BpSeries *series, BpError *err) {
    bool missed = false;
    for (size_t k = 0; k < BP_FILM_ENTRIES_MAX; k++)
        missed |= series->film.missed[k] && !series->film.found[k];
    series->film.looking = false;
    if (!missed) return BP_OK;
    BpScene *scene = NULL;
    const BpSceneChanges changes = changes_of(series, 0);
    const BpStatus status =
        bp_setup_load_changed(series->line, series->line->operands[0], &changes, &scene, err);
    bp_scene_destroy(&scene);
    return status;
}

/* Reads all frames once, for a camera that shows every one of them and for the range of values. */
static BpStatus look_ahead(BpSeries *series, BpError *err) {
    BpFitting fitting = {0};
    double range[2] = {INFINITY, -INFINITY};
    BpCamera camera = {0};
    series->film.looking = true;
    for (uint64_t i = 0; i < series->count; i++) {
        BpScene *scene = NULL;
        BpSceneChanges changes = changes_of(series, i);
        changes.cache = &series->cache;
        BP_TRY(bp_setup_load_changed(series->line, series->line->operands[0], &changes, &scene, err));
        BpStatus status = BP_OK;
        if (scene->camera.fit != BP_FIT_NONE) {
            const BpSphere *balls = NULL;
            BpSphere *made = NULL;
            size_t count = 0;
            double direction[3];
            bp_scene_view(scene, direction);
            if (i == 0)
                status = bp_fitting_begin(&scene->camera, direction, scene->camera.margin, &fitting, err);
            if (i == 0) camera = scene->camera;
            if (status == BP_OK) status = bp_scene_fitted(scene, &balls, &count, &made, err);
            if (status == BP_OK) bp_fitting_add(&fitting, balls, count);
            free(made);
        }
        if (scene->has_color_range) {
            range[0] = fmin(range[0], scene->color_range[0]);
            range[1] = fmax(range[1], scene->color_range[1]);
        }
        bp_scene_destroy(&scene);
        BP_TRY(status);
    }
    BP_TRY(check_selections(series, err));
    series->has_range = range[0] <= range[1];
    memcpy(series->range, range, sizeof range);
    if (!fitting.begun) return BP_OK;
    series->has_camera = true;
    series->camera = camera;
    return bp_fitting_end(&fitting, &series->camera, err);
}

BpStatus bp_series_begin(const BpCommandLine *line, BpSeries *series, BpError *err) {
    *series = (BpSeries){.line = line, .count = 1, .step = 1};
    BP_TRY(check_options(line, err));
    if (bp_option_given(line, BP_OPTION_TURNTABLE)) {
        BpSceneChanges changes = changes_of(series, 0);
        changes.turning = line->turntable;
        BP_TRY(bp_setup_load_changed(line, line->operands[0], &changes, &series->scene, err));
        series->count = line->turntable;
        series->camera = series->scene->camera;
        bp_setup_notes(line, series->scene);
    }
    if (!bp_option_given(line, BP_OPTION_FRAMES)) return BP_OK;
    uint64_t count = UINT64_MAX;
    BpScene *scene = NULL;
    const BpSceneChanges counting = {.frame_count = &count, .cache = &series->cache};
    BP_TRY(bp_setup_load_changed(line, line->operands[0], &counting, &scene, err));
    const bool has_particles = scene->has_particles;
    bp_scene_destroy(&scene);
    if (!has_particles)
        return bp_fail(err, BP_ERR_USAGE, "--frames: %.400s has no particles, so it has one frame",
                       line->operands[0]);
    BP_TRY(choose_frames(series, count, err));
    return look_ahead(series, err);
}

void bp_series_end(BpSeries *series) {
    bp_particle_cache_clear(&series->cache);
    bp_scene_destroy(&series->scene);
}

#define ENDINGS(X)                                                                                           \
    X(BP_FORMAT_BPA, ".bpa")                                                                                 \
    X(BP_FORMAT_PNG, ".png")                                                                                 \
    X(BP_FORMAT_PPM, ".ppm")                                                                                 \
    X(BP_FORMAT_PPM_ASCII, ".ppm")                                                                           \
    X(BP_FORMAT_PFM, ".pfm")                                                                                 \
    X(BP_FORMAT_EXR, ".exr") X(BP_FORMAT_PDF, ".pdf") X(BP_FORMAT_SVG, ".svg")
BP_WORDS(BpFormat, static const char *const endings, ENDINGS);

/* name-0012.png of name.png; in a folder, and without --output, named after the scene. */
BpStatus bp_series_line(BpSeries *series, BpCommandLine *line, BpError *err) {
    *line = *series->line;
    if (!bp_option_given(line, BP_OPTION_FRAMES) && !bp_option_given(line, BP_OPTION_TURNTABLE)) return BP_OK;
    const bool has_folder = line->output != NULL && bp_result_is_folder(line->output);
    const bool named = line->output != NULL && !has_folder;
    const char *const folder = has_folder ? line->output : "";
    const char *const joint = has_folder && folder[strlen(folder) - 1] != '/' ? "/" : "";
    const char *name = named ? line->output : line->operands[0];
    const char *const slash = strrchr(name, '/');
    if (!named && slash != NULL) name = slash + 1; /* in the current folder, or the one of --output */
    size_t stem = strlen(name);
    if (!named && stem > 3 && strcmp(name + stem - 3, ".gz") == 0) stem -= 3;
    const size_t base = named && slash != NULL ? (size_t)(slash - name) + 1 : 0;
    size_t dot = stem;
    for (size_t i = stem; i-- > base + 1 && dot == stem;)
        if (name[i] == '.') dot = i;
    const bool has_format = bp_option_given(line, BP_OPTION_FORMAT);
    const char *const ending = named ? name + dot : endings[has_format ? line->format : BP_FORMAT_PNG];
    const uint64_t number = bp_option_given(line, BP_OPTION_TURNTABLE)
                                ? series->next
                                : (uint64_t)series->first_frame + series->next * series->step;
    const uint64_t most = bp_option_given(line, BP_OPTION_TURNTABLE)
                              ? series->count - 1
                              : (uint64_t)series->first_frame + (series->count - 1) * series->step;
    char digits[24];
    const int width = snprintf(digits, sizeof digits, "%" PRIu64, most);
    const int length = snprintf(series->output, sizeof series->output, "%s%s%.*s-%0*" PRIu64 "%s", folder,
                                joint, (int)dot, name, width > 4 ? width : 4, number, ending);
    if (length >= (int)sizeof series->output)
        return bp_fail(err, BP_ERR_FILE, "the path after --output is too long");
    line->output = series->output;
    line->given[BP_OPTION_OUTPUT] = true;
    return BP_OK;
}

BpStatus bp_series_scene(BpSeries *series, const BpScene **scene, BpError *err) {
    const BpCommandLine *const line = series->line;
    const uint64_t number = series->next++;
    *scene = NULL;
    if (bp_option_given(line, BP_OPTION_TURNTABLE)) {
        series->scene->camera = series->camera;
        bp_camera_turn(&series->scene->camera, 360.0 * (double)number / (double)series->count);
        bp_lighting_place(series->scene);
    } else {
        BpSceneChanges changes = changes_of(series, number);
        changes.cache = bp_option_given(line, BP_OPTION_FRAMES) ? &series->cache : NULL;
        bp_scene_destroy(&series->scene);
        BP_TRY(bp_setup_load_changed(line, line->operands[0], &changes, &series->scene, err));
        if (number == 0) bp_setup_notes(line, series->scene);
    }
    if (bp_option_given(line, BP_OPTION_WIDTH)) BP_TRY(bp_scene_set_width(series->scene, line->width, err));
    *scene = series->scene;
    return BP_OK;
}
