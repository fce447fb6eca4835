/* render_options.c: see render_options.h and ballpark.h. */
#include "render_options.h"

#include "film/film.h"
#include "scene/scene.h"

#include <stdio.h>
#include <string.h>

#define PIXELS_MAX (UINT32_MAX / 4)

void bp_render_defaults(const BpScene *scene, BpRenderOptions *options) {
    memset(options, 0, sizeof *options);
    options->samples_per_pixel = scene->camera.samples_per_pixel;
    options->max_depth = scene->camera.max_depth;
}

BpStatus bp_render_options_check(const BpScene *scene, const BpRenderOptions *options, BpError *err) {
    if (options->samples_per_pixel < 1 || options->first_sample > UINT32_MAX ||
        options->samples_per_pixel > (uint64_t)UINT32_MAX + 1 - options->first_sample)
        return bp_fail(err, BP_ERR_USAGE, "samples %llu to %llu: sample numbers go from 0 to 4294967295",
                       (unsigned long long)options->first_sample,
                       (unsigned long long)(options->first_sample + options->samples_per_pixel - 1));
    if (options->max_depth > BP_DEPTH_MAX)
        return bp_fail(err, BP_ERR_USAGE, "depth %u: at most %u", options->max_depth, BP_DEPTH_MAX);
    if (options->replicates > BP_REPLICATES_MAX)
        return bp_fail(err, BP_ERR_USAGE, "%u replicates: at most %u", options->replicates,
                       BP_REPLICATES_MAX);
    const uint32_t replicates = options->replicates != 0 ? options->replicates : BP_REPLICATES_DEFAULT;
    if (options->samples_per_pixel > (uint64_t)BP_REPLICATE_SAMPLES_MAX * replicates)
        return bp_fail(
            err, BP_ERR_LIMIT,
            "%llu samples per pixel: the sums of %u replicates hold %llu; render in parts and merge them",
            (unsigned long long)options->samples_per_pixel, replicates,
            (unsigned long long)BP_REPLICATE_SAMPLES_MAX * replicates);
    const uint64_t pixels = (uint64_t)scene->camera.width * scene->camera.height;
    if (pixels > PIXELS_MAX) {
        char widest[16];
        snprintf(widest, sizeof widest, "%u", bp_camera_width_of(PIXELS_MAX, scene->camera.aspect_ratio));
        bp_fail(err, BP_ERR_LIMIT, "a picture of %u x %u has %llu pixels, expected at most %u",
                scene->camera.width, scene->camera.height, (unsigned long long)pixels, PIXELS_MAX);
        bp_error_set_remedy(err, BP_REMEDY_WIDTH_AT_MOST, widest);
        return BP_ERR_LIMIT;
    }
    if (options->tree_width != 0 && options->tree_width != 2 && options->tree_width != 4 &&
        options->tree_width != 8 && options->tree_width != 16)
        return bp_fail(err, BP_ERR_USAGE, "tree width %u: 2, 4, 8 or 16", options->tree_width);
    if (options->packet_lanes != 0 && options->packet_lanes != 8 && options->packet_lanes != 16)
        return bp_fail(err, BP_ERR_USAGE, "packet lanes %u: 8 or 16", options->packet_lanes);
    return BP_OK;
}
