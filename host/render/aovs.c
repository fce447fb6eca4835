/* aovs.c: see aovs.h. */
#include "aovs.h"

#include "base/status.h"

#include "aov_list.h"
#include "opencl/forked.h"

#include <math.h>
#include <stdlib.h>

/* Places of the arguments that follow the scene's. */
enum {
    ARGUMENT_FIRST_PIXEL,
    ARGUMENT_PIXEL_COUNT,
    ARGUMENT_FIRST_SAMPLE,
    ARGUMENT_SAMPLES,
    ARGUMENT_FORWARD,
    ARGUMENT_OUT = ARGUMENT_FORWARD + 3
};

#define BATCH_PIXELS 65536u /* of one dispatch: about a million rays, short of every watchdog */
#define LOCAL_SIZE 64u

static void view_direction(const BpCamera *camera, cl_float forward[3]) {
    double direction[3], length = 0;
    for (int a = 0; a < 3; ++a) {
        direction[a] = camera->lookat[a] - camera->lookfrom[a];
        length = hypot(length, direction[a]);
    }
    for (int a = 0; a < 3; ++a) forward[a] = (cl_float)(direction[a] / length);
}

/* The number by which a sum is divided for its mean. An AOV over the rays that MET something is +Inf if none
 * did. */
#define MEAN_OVER_ALL(sum) ((sum) / (float)BP_AOV_SAMPLES)
#define MEAN_OVER_MET(sum) (met > 0 ? (sum) / met : INFINITY)

/* Sums over a pixel's rays to its values. */
static void store_pixel(const cl_float *sums, size_t pixel, BpPicture *picture) {
    const float met = sums[AOV_MET];
#define STORE(place, member, floats, mean, channels)                                                         \
    for (size_t a = 0; a < (floats); ++a)                                                                    \
        picture->member[(floats)*pixel + a] = MEAN_OVER_##mean(sums[AOV_##place + a]);
    AOV_LIST(STORE)
#undef STORE
}

static BpStatus set_arguments(BpWorker *worker, cl_kernel kernel, const BpCamera *camera, cl_mem out,
                              BpError *err) {
    const cl_uint first_sample = 0, samples = BP_AOV_SAMPLES;
    cl_float forward[3];
    view_direction(camera, forward);
    BP_TRY(bp_worker_bind_scene(worker, kernel, err));
    cl_int code = clSetKernelArg(kernel, worker->scene_arguments + ARGUMENT_FIRST_SAMPLE, sizeof(cl_uint),
                                 &first_sample);
    if (code == CL_SUCCESS)
        code = clSetKernelArg(kernel, worker->scene_arguments + ARGUMENT_SAMPLES, sizeof(cl_uint), &samples);
    for (cl_uint a = 0; a < 3 && code == CL_SUCCESS; ++a)
        code = clSetKernelArg(kernel, worker->scene_arguments + ARGUMENT_FORWARD + a, sizeof(cl_float),
                              &forward[a]);
    if (code == CL_SUCCESS)
        code = clSetKernelArg(kernel, worker->scene_arguments + ARGUMENT_OUT, sizeof(cl_mem), &out);
    return code == CL_SUCCESS ? BP_OK : bp_cl_fail(err, code, "clSetKernelArg(aovs)", worker->device);
}

/* `sums`: room for a batch. */
static BpStatus run_batch(BpWorker *worker, cl_kernel kernel, size_t local, cl_mem out, cl_uint first,
                          cl_uint count, cl_float *sums, BpError *err) {
    cl_command_queue queue = worker->device->queue;
    const size_t global = (count + local - 1) / local * local;
    cl_int code =
        clSetKernelArg(kernel, worker->scene_arguments + ARGUMENT_FIRST_PIXEL, sizeof first, &first);
    if (code == CL_SUCCESS)
        code = clSetKernelArg(kernel, worker->scene_arguments + ARGUMENT_PIXEL_COUNT, sizeof count, &count);
    if (code == CL_SUCCESS)
        code = clEnqueueNDRangeKernel(queue, kernel, 1, NULL, &global, &local, 0, NULL, NULL);
    if (code == CL_SUCCESS)
        code = clEnqueueReadBuffer(queue, out, CL_TRUE, 0, count * AOV_FLOATS * sizeof *sums, sums, 0, NULL,
                                   NULL);
    return code == CL_SUCCESS ? BP_OK
                              : bp_cl_fail(err, code, "computing depth, normals and albedo", worker->device);
}

static void drop_layers(BpPicture *picture) {
#define DROP(place, member, floats, mean, channels)                                                          \
    free(picture->member);                                                                                   \
    picture->member = NULL;
    AOV_LIST(DROP)
#undef DROP
}

static bool make_layers(BpPicture *picture, size_t pixels) {
    bool made = true;
#define MAKE(place, member, floats, mean, channels)                                                          \
    picture->member = malloc(pixels * (floats) * sizeof(float));                                             \
    made = made && picture->member != NULL;
    AOV_LIST(MAKE)
#undef MAKE
    return made;
}

BpStatus bp_aovs_fill(BpWorker *worker, const BpScene *scene, BpPicture *picture, BpError *err) {
    double origin[3];
    const double moved = bp_camera_origin(scene, origin); /* depths count from lookfrom */
    const uint32_t pixels = worker->pixels, batch = pixels < BATCH_PIXELS ? pixels : BATCH_PIXELS;
    BpStatus status = BP_OK;
    cl_int code = CL_SUCCESS;
    cl_mem out = NULL;
    BP_TRY(bp_drivers_use(err));
    size_t local = LOCAL_SIZE, most = 0;
    cl_float *sums = malloc((size_t)batch * AOV_FLOATS * sizeof *sums);
    cl_kernel kernel = clCreateKernel(worker->program->program, "aovs", &code);
    if (code != CL_SUCCESS) {
        status = bp_cl_fail(err, code, "clCreateKernel(aovs)", worker->device);
        goto cleanup;
    }
    drop_layers(picture);
    if (!make_layers(picture, pixels) || sums == NULL) {
        status = bp_fail(err, BP_ERR_MEMORY, "no memory for depth, normals and albedo of %u pixels", pixels);
        goto cleanup;
    }
    out = clCreateBuffer(worker->device->context, CL_MEM_WRITE_ONLY,
                         (size_t)batch * AOV_FLOATS * sizeof *sums, NULL, &code);
    if (code == CL_SUCCESS)
        code = clGetKernelWorkGroupInfo(kernel, worker->device->id, CL_KERNEL_WORK_GROUP_SIZE, sizeof most,
                                        &most, NULL);
    if (code != CL_SUCCESS) {
        status = bp_cl_fail(err, code, "preparing depth, normals and albedo", worker->device);
        goto cleanup;
    }
    if (local > most) local = most;
    BP_TRY_GOTO(status, set_arguments(worker, kernel, &scene->camera, out, err), cleanup);
    for (uint32_t first = 0; first < pixels; first += batch) {
        const uint32_t count = pixels - first < batch ? pixels - first : batch;
        BP_TRY_GOTO(status, run_batch(worker, kernel, local, out, first, count, sums, err), cleanup);
        for (uint32_t i = 0; i < count; ++i)
            store_pixel(sums + (size_t)i * AOV_FLOATS, (size_t)first + i, picture);
        for (uint32_t i = 0; i < count && moved > 0; ++i)
            picture->depth[first + i] = (float)((double)picture->depth[first + i] + moved);
    }

cleanup:
    if (status != BP_OK) drop_layers(picture);
    if (kernel != NULL) clReleaseKernel(kernel);
    if (out != NULL) clReleaseMemObject(out);
    free(sums);
    return status;
}
