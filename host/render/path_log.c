/* path_log.c: see path_log.h. */
#include "path_log.h"

#include "base/status.h"
#include "render_plan.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Places in a record, as in the enum of kernels/entry/path_log.cl. */
enum {
    FOLLOW_ORIGIN,
    FOLLOW_DIRECTION = FOLLOW_ORIGIN + 3,
    FOLLOW_DISTANCE = FOLLOW_DIRECTION + 3,
    FOLLOW_POINT,
    FOLLOW_THROUGHPUT = FOLLOW_POINT + 3,
    FOLLOW_RADIANCE = FOLLOW_THROUGHPUT + 3,
    FOLLOW_MET = FOLLOW_RADIANCE + 3,
    FOLLOW_ENTERS,
    FOLLOW_GOES_ON,
    FOLLOW_INWARD,
    FOLLOW_LIT,
    FOLLOW_LED = FOLLOW_LIT + 3,
    FOLLOW_CHANCE = FOLLOW_LED + 3,
    FOLLOW_REALS
};

/* Nobody reads more steps than this; of a longer path, these are shown. */
#define STEPS_MAX 10000u

/* What comes back from the device. */
typedef struct Records {
    void *numbers;    /* steps * FOLLOW_REALS reals */
    cl_uint *spheres; /* steps * 4 */
    cl_uint count;
} Records;

static BpStatus run(BpWorker *worker, uint32_t pixel, uint32_t sample, uint32_t capacity, Records *records,
                    BpError *err) {
    const BpDevice *device = worker->device;
    const size_t numbers_size = (size_t)capacity * FOLLOW_REALS * worker->real_size;
    const size_t spheres_size = (size_t)capacity * 4 * sizeof(cl_uint);
    BpStatus status = BP_OK;
    cl_int code = CL_SUCCESS;
    cl_mem buffers[3] = {NULL, NULL, NULL};
    const size_t sizes[3] = {numbers_size, spheres_size, sizeof(cl_uint)};
    const size_t one = 1;
    cl_kernel kernel = clCreateKernel(worker->program->program, "path_log", &code);
    if (code != CL_SUCCESS) return bp_cl_fail(err, code, "clCreateKernel(path_log)", device);
    BP_TRY_GOTO(status, bp_worker_bind_scene(worker, kernel, err), cleanup);
    for (int i = 0; i < 3; ++i) {
        buffers[i] = clCreateBuffer(device->context, CL_MEM_WRITE_ONLY, sizes[i], NULL, &code);
        if (code != CL_SUCCESS) {
            status = bp_cl_fail(err, code, "clCreateBuffer", device);
            goto cleanup;
        }
    }
    cl_uint index = worker->scene_arguments;
    const cl_uint values[3] = {pixel, sample, capacity};
    for (int i = 0; i < 3 && code == CL_SUCCESS; ++i)
        code = clSetKernelArg(kernel, index++, sizeof(cl_uint), &values[i]);
    for (int i = 0; i < 3 && code == CL_SUCCESS; ++i)
        code = clSetKernelArg(kernel, index++, sizeof(cl_mem), &buffers[i]);
    if (code == CL_SUCCESS)
        code = clEnqueueNDRangeKernel(device->queue, kernel, 1, NULL, &one, &one, 0, NULL, NULL);
    void *const targets[3] = {records->numbers, records->spheres, &records->count};
    for (int i = 0; i < 3 && code == CL_SUCCESS; ++i)
        code =
            clEnqueueReadBuffer(device->queue, buffers[i], CL_TRUE, 0, sizes[i], targets[i], 0, NULL, NULL);
    if (code != CL_SUCCESS) status = bp_cl_fail(err, code, "following a path", device);

cleanup:
    for (int i = 0; i < 3; ++i)
        if (buffers[i] != NULL) clReleaseMemObject(buffers[i]);
    clReleaseKernel(kernel);
    return status;
}

static void read_step(const BpScene *scene, const double space[3], const Records *records, bool single,
                      size_t number, BpPathStep *step) {
    double record[FOLLOW_REALS];
    for (size_t i = 0; i < FOLLOW_REALS; ++i) {
        const size_t place = number * FOLLOW_REALS + i;
        record[i] = single ? (double)((const float *)records->numbers)[place]
                           : ((const double *)records->numbers)[place];
    }
    for (int axis = 0; axis < 3; ++axis) {
        step->origin[axis] = record[FOLLOW_ORIGIN + axis] + space[axis];
        step->direction[axis] = record[FOLLOW_DIRECTION + axis];
        step->point[axis] = record[FOLLOW_POINT + axis] + space[axis];
        step->throughput[axis] = record[FOLLOW_THROUGHPUT + axis];
        step->radiance[axis] = record[FOLLOW_RADIANCE + axis];
        step->lit[axis] = record[FOLLOW_LIT + axis];
        step->led[axis] = record[FOLLOW_LED + axis];
    }
    step->scattered = record[FOLLOW_MET] == 2;
    step->caught = record[FOLLOW_MET] > 2;
    step->dark = record[FOLLOW_MET] == 3;
    step->met = record[FOLLOW_MET] == 1;
    step->distance = record[FOLLOW_DISTANCE];
    step->enters = record[FOLLOW_ENTERS] != 0;
    step->goes_on = record[FOLLOW_GOES_ON] != 0;
    step->inward = record[FOLLOW_INWARD] != 0;
    step->chance = fabs(record[FOLLOW_CHANCE]);
    step->ended = record[FOLLOW_CHANCE] < 0;
    const cl_uint *spheres = records->spheres + 4 * number;
    step->sphere = spheres[0];
    step->to_lamp = spheres[1] != NO_SPHERE;
    step->stopped = spheres[2] != spheres[1];
    step->seen = spheres[2];
    step->to_image = spheres[1] == IMAGE_SLOT;
    step->to_disc = step->to_lamp && spheres[1] >= DISC_SLOT && !step->to_image;
    step->lamp = step->to_disc ? spheres[1] - DISC_SLOT : spheres[1];
    step->discs = spheres[3];
    step->material = step->met ? bp_shape_material(scene, step->sphere) : 0;
}

BpStatus bp_path_log(const BpScene *scene, const BpRenderOptions *options, const BpDeviceInfo *device,
                     uint32_t x, uint32_t y, uint32_t sample, BpPathLog *path, BpError *err) {
    memset(path, 0, sizeof *path);
    if (x >= scene->camera.width || y >= scene->camera.height)
        return bp_fail(err, BP_ERR_USAGE, "pixel %u,%u lies outside the picture of %u x %u", x, y,
                       scene->camera.width, scene->camera.height);
    BpRenderOptions wanted = *options;
    wanted.kernel = BP_KERNEL_SAMPLE;
    BpDeviceInfo chosen;
    if (device != NULL)
        chosen = *device;
    else
        BP_TRY(bp_device_find(NULL, &chosen, err));

    BpWorkerSetup setup;
    BpPacked packed;
    BpWorker *worker = NULL;
    Records records = {0};
    char *text = NULL;
    BP_TRY(bp_render_plan(scene, &wanted, &chosen, &setup, &packed, err));
    setup.extra_name = "entry/path_log.cl";
    const bool single_precision = packed.single_precision;
    BpStatus status = bp_kernel_text(setup.extra_name, &text, err);
    setup.extra_text = text;
    if (status == BP_OK) status = bp_worker_create(&chosen, &packed, &setup, &worker, err);
    bp_packed_clear(&packed); /* unless the worker has taken it over */
    if (status != BP_OK) goto cleanup;
    const uint32_t capacity = wanted.max_depth < 1           ? 1
                              : wanted.max_depth < STEPS_MAX ? wanted.max_depth
                                                             : STEPS_MAX;
    records.numbers = calloc((size_t)capacity * FOLLOW_REALS, worker->real_size);
    records.spheres = calloc((size_t)capacity * 4, sizeof *records.spheres);
    path->steps = calloc(capacity, sizeof *path->steps);
    if (records.numbers == NULL || records.spheres == NULL || path->steps == NULL) {
        status = bp_fail(err, BP_ERR_MEMORY, "no memory for a path of %u steps", capacity);
        goto cleanup;
    }
    BP_TRY_GOTO(status, run(worker, y * scene->camera.width + x, sample, capacity, &records, err), cleanup);
    double space[3];
    bp_camera_origin(scene, space);
    for (size_t i = 0; i < records.count; ++i)
        read_step(scene, space, &records, single_precision, i, &path->steps[i]);
    path->count = records.count;
    const BpPathStep *last = path->steps + path->count - 1;
    path->cut = path->count == 0 || (last->goes_on && !last->ended);
    path->device = chosen;

cleanup:
    if (status != BP_OK) bp_path_log_clear(path);
    free(records.numbers);
    free(records.spheres);
    free(text);
    bp_worker_destroy(&worker);
    return status;
}

void bp_path_log_clear(BpPathLog *path) {
    free(path->steps);
    memset(path, 0, sizeof *path);
}
