/* render_read.c: what a render has come to: its accumulator, picture and report. See render.h. */
#include "render.h"

#include "../base/status.h"
#include "features.h"
#include "render_state.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

uint64_t bp_render_samples_done(const BpRender *render) {
    if (!render->decides) return render->schedule.done;
    const double pixels = (double)render->scene->camera.width * render->scene->camera.height;
    return (uint64_t)llround((double)bp_adaptive_samples(render->adaptive) / pixels);
}

static BpStatus describe(const BpRender *render, BpAccumulator *accumulator, BpError *err) {
    const BpRenderOptions *options = &render->options;
    accumulator->scale_log2 = bp_accumulator_scale(render->scene, options->max_depth);
    accumulator->scene_hash = bp_scene_hash(render->scene);
    accumulator->seed = options->seed;
    accumulator->max_depth = options->max_depth;
    accumulator->sampler = options->sampler;
    accumulator->precision = options->precision;
    accumulator->math = options->math;
    accumulator->numerics = options->numerics;
    accumulator->transfer = render->scene->transfer;
    if (render->scene->title != NULL) accumulator->title = strdup(render->scene->title);
    /* A pass in progress counts as begun: its samples are taken, though not yet by every pixel. */
    uint64_t begun = render->schedule.done + render->schedule.pass_samples;
    accumulator->partial = render->schedule.pass_samples > 0;
    if (render->decides) {
        const uint64_t pixels = (uint64_t)accumulator->width * accumulator->height;
        begun = bp_adaptive_samples_max(render->adaptive);
        accumulator->partial = bp_adaptive_samples(render->adaptive) != pixels * begun;
    }
    if (begun > 0) BP_TRY(bp_accumulator_add_range(accumulator, options->first_sample, begun, err));
    return BP_OK;
}

BpStatus bp_render_accumulator(BpRender *render, const BpAccumulator **accumulator, BpError *err) {
    if (render->accumulator == NULL) {
        BpAccumulator *read = NULL;
        BpStatus status = bp_accumulator_create(render->scene->camera.width, render->scene->camera.height,
                                                render->options.replicates, &read, err);
        if (status == BP_OK) status = describe(render, read, err);
        if (status == BP_OK && render->adaptive != NULL) {
            const size_t pixels = (size_t)read->width * read->height;
            read->pixel_segments = calloc(pixels, sizeof *read->pixel_segments);
            if (read->pixel_segments == NULL)
                status = bp_fail(err, BP_ERR_MEMORY, "no memory for the path lengths of %zu pixels", pixels);
        }
        for (size_t i = 0; status == BP_OK && i < render->worker_count; ++i)
            status = bp_worker_collect(render->workers[i], read, err);
        if (status != BP_OK) {
            bp_accumulator_destroy(&read);
            return status;
        }
        render->accumulator = read;
    }
    *accumulator = render->accumulator;
    return BP_OK;
}

BpStatus bp_render_read(BpRender *render, BpPicture *picture, BpError *err) {
    const BpAccumulator *accumulator = NULL;
    BP_TRY(bp_render_accumulator(render, &accumulator, err));
    return bp_accumulator_picture(accumulator, picture, err);
}

BpStatus bp_render_features(BpRender *render, BpPicture *picture, BpError *err) {
    const BpRenderOptions *options = &render->options;
    if (!options->features)
        return bp_fail(err, BP_ERR_USAGE,
                       "depth, normals and albedo: the render was created without features");
    const BpCamera *camera = &render->scene->camera;
    if (picture->width != camera->width || picture->height != camera->height)
        return bp_fail(err, BP_ERR_USAGE,
                       "depth, normals and albedo of %" PRIu32 " x %" PRIu32
                       " pixels for a picture of %" PRIu32 " x %" PRIu32 ": read the picture first",
                       camera->width, camera->height, picture->width, picture->height);
    const uint64_t samples = options->samples_per_pixel;
    return bp_features_fill(render->workers[0], camera, (uint32_t)options->first_sample,
                            samples < BP_FEATURE_SAMPLES ? (uint32_t)samples : BP_FEATURE_SAMPLES, picture,
                            err);
}

void bp_render_report(const BpRender *render, BpRenderReport *report) {
    memset(report, 0, sizeof *report);
    const BpWorker *first = render->workers[0];
    report->device = first->device->info;
    report->effects = render->effects;
    report->self_test_seconds = first->self_test_seconds;
    report->kernel = first->samples_per_item > 1 ? BP_KERNEL_PACKET : BP_KERNEL_SAMPLE;
    report->sampler = render->options.sampler;
    report->precision = render->options.precision;
    report->math = render->options.math;
    report->numerics = render->options.numerics;
    report->program_key = first->program->key;
    report->build_log = first->program->log;
    cl_ulong private_bytes = 0;
    if (clGetKernelWorkGroupInfo(first->trace, first->device->id, CL_KERNEL_PRIVATE_MEM_SIZE,
                                 sizeof private_bytes, &private_bytes, NULL) == CL_SUCCESS)
        report->private_bytes = private_bytes;
    report->tree_seconds = render->tree_seconds;
    report->pack_seconds = render->pack_seconds;
    report->trace_seconds = render->trace_seconds - first->first_launch_seconds;
    report->first_launch_seconds = first->first_launch_seconds;
    for (size_t i = 0; i < render->worker_count; ++i) {
        const BpWorker *worker = render->workers[i];
        report->kernel_build_seconds += worker->program->build_seconds;
        report->device_seconds += worker->device_seconds;
        report->fold_seconds += worker->fold_seconds;
        report->scene_bytes += worker->scene_bytes;
        report->device_bytes += worker->scene_bytes + worker->picture_bytes +
                                (uint64_t)worker->samples_capacity * 4 * worker->real_size;
    }
    report->samples = bp_render_pixel_samples(render);
    if (render->accumulator != NULL) {
        report->segments = render->accumulator->segments;
        report->cut_paths = render->accumulator->cut_paths;
        report->invalid_samples = render->accumulator->invalid_samples;
    }
}
