/* test_failing_calls.c: a render of which one call fails, of OpenCL or for memory, ends with an error that
 * has a message, or with the same film as without. Every call in turn, so the linker puts the functions below
 * before those of the driver and of the C library (-Wl,--wrap). Where a failure is not noticed, the film
 * differs; where something is freed twice, not at all, or before the device is done with it, the sanitizers
 * see it. */
#include "film/film_file.h"
#include "render/path_log.h"
#include "render/render.h"
#include "support/device.h"
#include "support/unit_test.h"

#include <stdatomic.h>
#include <string.h>

/* Calls are counted from 0 while `armed`; the one with the number `fails_at` fails. */
static atomic_bool armed;
static atomic_long calls;
static long fails_at;

static bool fails(void) {
    return armed && atomic_fetch_add(&calls, 1) == fails_at;
}

static bool count_opencl, count_memory;

/* ---- the calls ---------------------------------------------------------------------------------------- */

#define FAILING(name, parameters, arguments)                                                                 \
    cl_int __real_##name parameters;                                                                         \
    cl_int __wrap_##name parameters;                                                                         \
    cl_int __wrap_##name parameters {                                                                        \
        return count_opencl && fails() ? CL_OUT_OF_RESOURCES : __real_##name arguments;                      \
    }
FAILING(clSetKernelArg, (cl_kernel kernel, cl_uint index, size_t size, const void *value),
        (kernel, index, size, value))
FAILING(clEnqueueFillBuffer,
        (cl_command_queue queue, cl_mem buffer, const void *pattern, size_t pattern_size, size_t offset,
         size_t size, cl_uint count, const cl_event *list, cl_event *event),
        (queue, buffer, pattern, pattern_size, offset, size, count, list, event))
FAILING(clEnqueueNDRangeKernel,
        (cl_command_queue queue, cl_kernel kernel, cl_uint dimensions, const size_t *offset,
         const size_t *global, const size_t *local, cl_uint count, const cl_event *list, cl_event *event),
        (queue, kernel, dimensions, offset, global, local, count, list, event))
FAILING(clEnqueueReadBuffer,
        (cl_command_queue queue, cl_mem buffer, cl_bool blocking, size_t offset, size_t size, void *to,
         cl_uint count, const cl_event *list, cl_event *event),
        (queue, buffer, blocking, offset, size, to, count, list, event))
FAILING(clEnqueueWriteBuffer,
        (cl_command_queue queue, cl_mem buffer, cl_bool blocking, size_t offset, size_t size,
         const void *from, cl_uint count, const cl_event *list, cl_event *event),
        (queue, buffer, blocking, offset, size, from, count, list, event))
FAILING(clFlush, (cl_command_queue queue), (queue))
FAILING(clGetEventInfo, (cl_event event, cl_event_info what, size_t size, void *to, size_t *size_ret),
        (event, what, size, to, size_ret))
FAILING(clGetEventProfilingInfo,
        (cl_event event, cl_profiling_info what, size_t size, void *to, size_t *size_ret),
        (event, what, size, to, size_ret))
FAILING(clGetKernelWorkGroupInfo,
        (cl_kernel kernel, cl_device_id device, cl_kernel_work_group_info what, size_t size, void *to,
         size_t *size_ret),
        (kernel, device, what, size, to, size_ret))

/* What waits does so before it fails: the driver must not use what is then given back. */
#define FAILING_LATE(name, parameters, arguments)                                                            \
    cl_int __real_##name parameters;                                                                         \
    cl_int __wrap_##name parameters;                                                                         \
    cl_int __wrap_##name parameters {                                                                        \
        const cl_int code = __real_##name arguments;                                                         \
        return count_opencl && fails() ? CL_OUT_OF_RESOURCES : code;                                         \
    }
FAILING_LATE(clFinish, (cl_command_queue queue), (queue))
FAILING_LATE(clWaitForEvents, (cl_uint count, const cl_event *list), (count, list))

cl_mem __real_clCreateBuffer(cl_context, cl_mem_flags, size_t, void *, cl_int *);
cl_mem __wrap_clCreateBuffer(cl_context context, cl_mem_flags flags, size_t size, void *host, cl_int *code);
cl_mem __wrap_clCreateBuffer(cl_context context, cl_mem_flags flags, size_t size, void *host, cl_int *code) {
    if (!count_opencl || !fails()) return __real_clCreateBuffer(context, flags, size, host, code);
    *code = CL_MEM_OBJECT_ALLOCATION_FAILURE;
    return NULL;
}

cl_kernel __real_clCreateKernel(cl_program, const char *, cl_int *);
cl_kernel __wrap_clCreateKernel(cl_program program, const char *name, cl_int *code);
cl_kernel __wrap_clCreateKernel(cl_program program, const char *name, cl_int *code) {
    if (!count_opencl || !fails()) return __real_clCreateKernel(program, name, code);
    *code = CL_OUT_OF_HOST_MEMORY;
    return NULL;
}

void *__real_malloc(size_t);
void *__wrap_malloc(size_t size);
void *__wrap_malloc(size_t size) {
    return count_memory && fails() ? NULL : __real_malloc(size);
}
void *__real_calloc(size_t, size_t);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_calloc(size_t count, size_t size) {
    return count_memory && fails() ? NULL : __real_calloc(count, size);
}
void *__real_realloc(void *, size_t);
void *__wrap_realloc(void *old, size_t size);
void *__wrap_realloc(void *old, size_t size) {
    return count_memory && fails() ? NULL : __real_realloc(old, size);
}

/* ---- what is tried ------------------------------------------------------------------------------------ */

typedef struct Job {
    BpDevice *device;
    BpScene *scene;
    BpRenderOptions options;
} Job;

typedef struct Bytes {
    char *data;
    size_t size;
} Bytes;

typedef BpStatus Attempt(const Job *job, Bytes *bytes, BpError *err);

/* Adaptive, so that chunks take their pixels from a list, with depth, normals and albedo. */
static BpStatus render_film(const Job *job, Bytes *bytes, BpError *err) {
    BpRender *render = NULL;
    const BpFilm *film = NULL;
    BpProgress progress = {0};
    BpStatus status = bp_render_create_on(job->scene, &job->options, &job->device, 1, &render, err);
    while (status == BP_OK && !progress.finished) status = bp_render_step(render, &progress, err);
    if (status == BP_OK) status = bp_render_read_whole_film(render, &film, err);
    if (status == BP_OK) {
        FILE *out = open_memstream(&bytes->data, &bytes->size);
        status = bp_film_write_stream(film, out, err);
        fclose(out);
    }
    bp_render_destroy(&render);
    return status;
}

/* Raw samples, as `check` takes them. */
static BpStatus render_samples(const Job *job, Bytes *bytes, BpError *err) {
    BpRender *render = NULL;
    BpRenderOptions options = job->options;
    bool finished = false;
    options.adaptive = options.features = false;
    options.samples_only = true;
    options.samples_per_pixel = 2;
    BpStatus status = bp_render_create_on(job->scene, &options, &job->device, 1, &render, err);
    FILE *out = open_memstream(&bytes->data, &bytes->size);
    while (status == BP_OK && !finished) {
        BpSampleBlock block = {0};
        status = bp_render_step_samples(render, &block, &finished, err);
        if (status == BP_OK && !finished)
            fwrite(block.values, 4 * sizeof *block.values, (size_t)block.pixel_count * block.samples, out);
        bp_sample_block_clear(&block);
    }
    fclose(out);
    bp_render_destroy(&render);
    return status;
}

static BpStatus log_path(const Job *job, Bytes *bytes, BpError *err) {
    BpPathLog path = {0};
    BpRenderOptions options = job->options;
    options.adaptive = options.features = false;
    const BpStatus status = bp_path_log(job->scene, &options, &job->device->info, 8, 5, 3, &path, err);
    if (status == BP_OK) {
        bytes->size = path.count * sizeof *path.steps;
        bytes->data = malloc(bytes->size + 1);
        assert_non_null(bytes->data);
        memcpy(bytes->data, path.steps, bytes->size);
    }
    bp_path_log_clear(&path);
    return status;
}

/* Lets the call with this number fail; none, if it is negative. How many there were. */
static long try_with(Attempt *attempt, const Job *job, long number, BpStatus *status, Bytes *bytes,
                     BpError *err) {
    *bytes = (Bytes){0};
    calls = 0;
    fails_at = number;
    armed = true;
    *status = attempt(job, bytes, err);
    armed = false;
    return calls;
}

/* `most`: numbers of calls to try, at equal distances; `least`: failures that there must be. */
static void each_fails(Attempt *attempt, const Job *job, long most, long least) {
    Bytes wanted, bytes;
    BpStatus status;
    BpError err = {0};
    try_with(attempt, job, -1, &status, &wanted, &err); /* what only the first time has: caches, drivers */
    free(wanted.data);
    const long count = try_with(attempt, job, -1, &status, &wanted, &err);
    if (status != BP_OK) fail_msg("%s", err.message);
    assert_true(wanted.size > 0);
    long failed = 0, tried = 0;
    for (long number = 0; number < count; number += count / most + 1, ++tried) {
        try_with(attempt, job, number, &status, &bytes, &err);
        if (status == BP_OK) {
            if (bytes.size != wanted.size || memcmp(bytes.data, wanted.data, wanted.size) != 0)
                fail_msg("call %ld of %ld failed, and the result is another one", number, count);
        } else {
            ++failed;
            if (count_memory && status != BP_ERR_MEMORY) fail_msg("call %ld: %s", number, err.message);
            assert_true(status == BP_ERR_MEMORY || status == BP_ERR_DEVICE);
            assert_true(strlen(err.message) > 10);
        }
        free(bytes.data);
        bp_error_clear(&err);
    }
    print_message("%ld calls, %ld tried, %ld of them errors\n", count, tried, failed);
    assert_true(failed >= least);
    try_with(attempt, job, -1, &status, &bytes, &err); /* nothing is left behind */
    assert_int_equal(status, BP_OK);
    assert_int_equal(bytes.size, wanted.size);
    assert_memory_equal(bytes.data, wanted.data, wanted.size);
    free(bytes.data);
    free(wanted.data);
}

static void opencl(void **state) {
    count_opencl = true;
    each_fails(render_film, *state, 300, 100);
    each_fails(render_samples, *state, 30, 10);
    each_fails(log_path, *state, 40, 20);
    count_opencl = false;
}

static void memory(void **state) {
    count_memory = true;
    each_fails(render_film, *state, 120, 40);
    each_fails(render_samples, *state, 30, 10);
    count_memory = false;
}

int main(void) {
    static Job job;
    BpError err = {0};
    const int missing = test_device_open(&job.device);
    if (missing != 0) return missing;
    if (bp_scene_load(SOURCE_DIR "/tests/agree/scenes/caustics-mirror.json", &job.scene, &err) != BP_OK ||
        bp_scene_set_width(job.scene, 10, &err) != BP_OK) {
        fprintf(stderr, "%s\n", err.message);
        return 1;
    }
    bp_render_defaults(job.scene, &job.options);
    job.options.samples_per_pixel = 16;
    job.options.adaptive = job.options.features = true;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_prestate(opencl, &job),
        cmocka_unit_test_prestate(memory, &job),
    };
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    bp_scene_destroy(&job.scene);
    bp_device_close(&job.device);
    return failed;
}
