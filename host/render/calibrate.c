/* calibrate.c: see calibrate.h. */
#include "calibrate.h"

#include "base/clock.h"
#include "base/hash.h"
#include "base/status.h"
#include "render_plan.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PICTURE_WIDTH 64u
#define ROUNDS 3
#define TRIAL_SECONDS 0.03 /* of a chunk, at least: enough to fill a GPU many times over */
#define GROWTH 4u          /* from one chunk to the next, until it is that long */
#define WORTH 1.03         /* the least gain for which the usual arrangement is left */

/* The first is the usual one. */
static const BpCalibration arrangements[] = {
    {BP_KERNEL_SAMPLE, BP_LOCAL_SIZE_SAMPLE, 1, 1},
    {BP_KERNEL_POOL, BP_LOCAL_SIZE_SAMPLE, BP_POOL_SAMPLES_PER_ITEM, 1},
    {BP_KERNEL_POOL, 128, BP_POOL_SAMPLES_PER_ITEM, 1},
    {BP_KERNEL_POOL, 256, BP_POOL_SAMPLES_PER_ITEM, 1},
    {BP_KERNEL_POOL, BP_LOCAL_SIZE_SAMPLE, 4 * BP_POOL_SAMPLES_PER_ITEM, 1},
};
enum { ARRANGEMENTS = sizeof arrangements / sizeof arrangements[0] };

bool bp_calibrates(const BpDeviceInfo *device, const BpRenderOptions *options) {
    return device->type == BP_DEVICE_GPU && options->kernel == BP_KERNEL_AUTO;
}

static BpStatus make_scene(BpScene **scene, BpError *err) {
    BP_TRY(bp_scene_generate_cover("4", 11, 1, scene, err));
    const BpStatus status = bp_scene_set_width(*scene, PICTURE_WIDTH, err);
    if (status != BP_OK) bp_scene_destroy(scene);
    return status;
}

/* How the scene is traced in this arrangement; the caller clears `packed`. */
static BpStatus plan(const BpScene *scene, const BpDeviceInfo *device, const BpCalibration *arrangement,
                     BpWorkerSetup *setup, BpPacked *packed, BpError *err) {
    BpRenderOptions options;
    bp_render_defaults(scene, &options);
    options.kernel = arrangement->form;
    options.local_size = arrangement->local_size;
    BP_TRY(bp_render_plan(scene, &options, device, setup, packed, err));
    setup->samples_per_item = arrangement->samples_per_item;
    return BP_OK;
}

/* Of the source of all kernels that are tried: another version of them is tried anew. */
static BpStatus hash_kernels(const BpScene *scene, const BpDeviceInfo *device, uint64_t *hash, BpError *err) {
    *hash = BP_HASH_START;
    for (int a = 0; a < ARRANGEMENTS; ++a) {
        BpWorkerSetup setup;
        BpPacked packed;
        char *source = NULL;
        if (a > 0 && arrangements[a].form == arrangements[a - 1].form) continue;
        BP_TRY(plan(scene, device, &arrangements[a], &setup, &packed, err));
        bp_packed_clear(&packed);
        BP_TRY(bp_program_source(&setup.program, NULL, NULL, &source, err));
        *hash = bp_hash_text(*hash, source);
        free(source);
    }
    return BP_OK;
}

bool bp_calibration_known(const BpDeviceInfo *device, BpCalibration *calibration) {
    BpScene *scene = NULL;
    uint64_t kernels = 0;
    const bool known = device->type == BP_DEVICE_GPU && make_scene(&scene, NULL) == BP_OK &&
                       hash_kernels(scene, device, &kernels, NULL) == BP_OK &&
                       bp_calibration_recall(device, kernels, calibration);
    bp_scene_destroy(&scene);
    return known;
}

/* Seconds for a chunk of so many samples per pixel; infinite: the device cannot do that. By the wall clock,
 * since some devices have none of their own (Mesa's llvmpipe). */
static double time_chunk(BpWorker *worker, uint32_t samples) {
    const BpChunk chunk = {.pixel_count = worker->pixels, .samples = samples};
    const double start = bp_clock_seconds();
    if (bp_worker_start(worker, &chunk, NULL) != BP_OK || bp_worker_wait_for_all(worker, NULL) != BP_OK)
        return INFINITY;
    return bp_clock_seconds() - start;
}

/* NULL: the device cannot do this. The arrangement's groups become as small as the kernel's may be there. */
static BpWorker *open_arrangement(const BpScene *scene, BpDevice *device, BpCalibration *arrangement,
                                  bool untested) {
    BpWorkerSetup setup;
    BpPacked packed;
    BpWorker *worker = NULL;
    if (plan(scene, &device->info, arrangement, &setup, &packed, NULL) != BP_OK) return NULL;
    setup.device = device;
    setup.untested = untested;
    if (bp_worker_create(&device->info, &packed, &setup, &worker, NULL) == BP_OK)
        arrangement->local_size = (uint32_t)worker->local_size;
    return worker;
}

/* Whether an arrangement has become one that comes before it. */
static bool is_repeated(const BpCalibration *tried, int number) {
    for (int a = 0; a < number; ++a)
        if (tried[a].form == tried[number].form && tried[a].local_size == tried[number].local_size &&
            tried[a].samples_per_item == tried[number].samples_per_item)
            return true;
    return false;
}

static bool try_all(const BpScene *scene, BpDevice *device, bool untested, BpCalibration *best) {
    BpWorker *workers[ARRANGEMENTS] = {NULL};
    BpCalibration tried[ARRANGEMENTS];
    double fastest[ARRANGEMENTS];
    memcpy(tried, arrangements, sizeof tried);
    workers[0] = open_arrangement(scene, device, &tried[0], untested);
    if (workers[0] == NULL) return false;
    uint32_t samples = 1;
    double seconds = time_chunk(workers[0], samples); /* what a driver does at the first launch */
    while (isfinite(seconds = time_chunk(workers[0], samples)) && seconds < TRIAL_SECONDS &&
           (uint64_t)workers[0]->pixels * samples * GROWTH <= workers[0]->samples_limit)
        samples *= GROWTH;
    for (int a = 0; a < ARRANGEMENTS; ++a) {
        fastest[a] = INFINITY;
        if (a > 0 && isfinite(seconds)) workers[a] = open_arrangement(scene, device, &tried[a], untested);
        if (workers[a] != NULL && is_repeated(tried, a)) bp_worker_destroy(&workers[a]);
        if (workers[a] != NULL) time_chunk(workers[a], samples);
    }
    /* In turns, so that whatever else happens on the machine happens to all. */
    for (int round = 0; round < ROUNDS; ++round)
        for (int a = 0; a < ARRANGEMENTS; ++a)
            if (workers[a] != NULL) fastest[a] = fmin(fastest[a], time_chunk(workers[a], samples));
    int chosen = 0;
    for (int a = 1; a < ARRANGEMENTS; ++a)
        if (fastest[a] < fastest[chosen] && fastest[a] * WORTH < fastest[0]) chosen = a;
    for (int a = 0; a < ARRANGEMENTS; ++a) bp_worker_destroy(&workers[a]);
    *best = tried[chosen];
    best->gain = fastest[0] / fastest[chosen];
    return isfinite(fastest[0]) && isfinite(best->gain);
}

bool bp_calibrate(const BpDeviceInfo *device, BpDevice *open, bool untested, BpCalibration *calibration,
                  double *seconds) {
    BpScene *scene = NULL;
    BpDevice *opened = open;
    uint64_t kernels = 0;
    bool found = false;
    *seconds = 0;
    const double start = bp_clock_seconds();
    if (make_scene(&scene, NULL) != BP_OK || hash_kernels(scene, device, &kernels, NULL) != BP_OK) goto done;
    found = bp_calibration_recall(device, kernels, calibration);
    if (found || (opened == NULL && bp_device_open(device, &opened, NULL) != BP_OK)) goto done;
    found = try_all(scene, opened, untested, calibration);
    if (!found) goto done;
    bp_calibration_keep(device, kernels, calibration);
    *seconds = bp_clock_seconds() - start;

done:
    if (open == NULL) bp_device_close(&opened);
    bp_scene_destroy(&scene);
    return found;
}
