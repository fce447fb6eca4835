/* probe.h: runs small kernels of a test inside the product's kernel text, on the default device.
 *
 * Knows: OpenCL, the program's assembly.   Does not know: what is probed. */
#ifndef TESTS_SUPPORT_PROBE_H
#define TESTS_SUPPORT_PROBE_H

#include "opencl/device.h"
#include "opencl/program.h"
#include "packed/effects.h"
#include "support/unit_test.h"

typedef struct Probe {
    BpDevice *device;
    BpProgram *program;
} Probe;

/* Builds the general program, one lane, single precision, with `text` at its end. */
static inline void probe_open_sampler(Probe *probe, BpSampler sampler, const char *text) {
    BpDeviceInfo info;
    BpError err = {0};
    const BpProgramOptions options = {
        .effects = BP_EFFECTS_ALL & ~(1u << BP_EFFECT_MOTION), /* probes make rays and leaves of their own */
        .tree = true,
        .form = BP_KERNEL_SAMPLE,
        .sampler = sampler,
        .tree_width = 8};
    *probe = (Probe){0};
    BpStatus status = bp_device_find(NULL, &info, &err);
    if (status == BP_OK) status = bp_device_open(&info, &probe->device, &err);
    if (status == BP_OK)
        status = bp_program_build(probe->device, &options, "probe", text, &probe->program, &err);
    if (status != BP_OK) fail_msg("%s\n%s", err.message, err.attachment != NULL ? err.attachment : "");
}

/* With independent samples. */
static inline void probe_open(Probe *probe, const char *text) {
    probe_open_sampler(probe, BP_SAMPLER_INDEPENDENT, text);
}

static inline void probe_close(Probe *probe) {
    bp_program_destroy(&probe->program);
    bp_device_close(&probe->device);
}

/* Runs the cases of a test program, an array of CMUnitTest, whose state is a probe of `text`. */
#define probe_run_group(tests, text)                                                                         \
    (probe_group_text = (text), cmocka_run_group_tests(tests, probe_open_group, probe_close_group))
static const char *probe_group_text;
static inline int probe_open_group(void **state) {
    static Probe probe;
    probe_open(&probe, probe_group_text);
    *state = &probe;
    return 0;
}
static inline int probe_close_group(void **state) {
    probe_close(*state);
    return 0;
}

/* Runs kernel `name`(uint first, uint second, __global T *out) with `count` work-items; fills `out`. */
static inline void probe_run(const Probe *probe, const char *name, cl_uint first, cl_uint second,
                             size_t count, void *out, size_t bytes) {
    cl_int code = CL_SUCCESS;
    cl_kernel kernel = clCreateKernel(probe->program->program, name, &code);
    assert_int_equal(code, CL_SUCCESS);
    cl_mem buffer = clCreateBuffer(probe->device->context, CL_MEM_WRITE_ONLY, bytes, NULL, &code);
    assert_int_equal(code, CL_SUCCESS);
    clSetKernelArg(kernel, 0, sizeof first, &first);
    clSetKernelArg(kernel, 1, sizeof second, &second);
    clSetKernelArg(kernel, 2, sizeof buffer, &buffer);
    cl_command_queue queue = probe->device->queue;
    assert_int_equal(clEnqueueNDRangeKernel(queue, kernel, 1, NULL, &count, NULL, 0, NULL, NULL), CL_SUCCESS);
    assert_int_equal(clEnqueueReadBuffer(queue, buffer, CL_TRUE, 0, bytes, out, 0, NULL, NULL), CL_SUCCESS);
    clReleaseMemObject(buffer);
    clReleaseKernel(kernel);
}

#endif
