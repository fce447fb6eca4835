/* test_device_build.c: opening and building on whatever real device is there; skipped without one.
 *
 * test_device_build [TIMES]: how often a part of a processor is opened, used and closed, for what is rare. */
#include "support/device.h"

#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static void builds_and_runs(void **state) {
    BpDevice *device = *state;
    static const char source[] =
        "#line 1 \"seven.cl\"\n__kernel void seven(__global uint *out) { out[0] = 7u; }\n";
    cl_program program = NULL;
    char *log = NULL;
    BpError err = {0};
    cl_int code;
    cl_uint seven = 0;
    if (bp_device_build(device, source, NULL, &program, &log, &err) != BP_OK) fail_msg("%s", err.message);
    assert_non_null(log);
    cl_kernel kernel = clCreateKernel(program, "seven", &code);
    assert_int_equal(code, CL_SUCCESS);
    cl_mem out = clCreateBuffer(device->context, CL_MEM_WRITE_ONLY, sizeof seven, NULL, &code);
    assert_int_equal(code, CL_SUCCESS);
    assert_int_equal(clSetKernelArg(kernel, 0, sizeof out, &out), CL_SUCCESS);
    const size_t one = 1;
    assert_int_equal(clEnqueueNDRangeKernel(device->queue, kernel, 1, NULL, &one, NULL, 0, NULL, NULL),
                     CL_SUCCESS);
    assert_int_equal(clEnqueueReadBuffer(device->queue, out, CL_TRUE, 0, sizeof seven, &seven, 0, NULL, NULL),
                     CL_SUCCESS);
    assert_int_equal(seven, 7);
    clReleaseMemObject(out);
    clReleaseKernel(kernel);
    clReleaseProgram(program);
    free(log);
}

/* What a driver's thread still reads when the device is closed must be there: freed memory is overwritten at
 * once, so that a read of it crashes. The kernel takes a millisecond: a thread that has worked for long is
 * the one that the system interrupts in the middle of its clean-up when another wakes; threads that keep the
 * cores busy make that likely. */
static void *keep_busy(void *stop) {
    while (!atomic_load((atomic_bool *)stop)) {
    }
    return NULL;
}

static int times = 10;

static void part_is_closed_safely(void **state) {
    BpDevice *whole = *state;
    static const char source[] = "#line 1 \"long.cl\"\n__kernel void work(__global uint *out) {\n"
                                 "    uint x = out[0];\n"
                                 "    for (uint i = 0u; i < 300000u; ++i) x = x * 1664525u + (x >> 16);\n"
                                 "    out[0] = x;\n}\n";
    if (whole->info.type != BP_DEVICE_CPU || whole->info.compute_units < 2) {
        printf("skipped: no processor that can be divided\n");
        skip();
    }
    pthread_t busy[4];
    atomic_bool stop = false;
    for (size_t b = 0; b < 4; ++b) assert_int_equal(pthread_create(&busy[b], NULL, keep_busy, &stop), 0);
    for (int i = 0; i < times; ++i) {
        BpDevice *device = NULL;
        cl_program program = NULL;
        cl_int code;
        const size_t one = 1;
        void *memory[512];
        assert_int_equal(bp_device_open_part(&whole->info, 1, &device, NULL), BP_OK);
        assert_int_equal(bp_device_build(device, source, NULL, &program, NULL, NULL), BP_OK);
        cl_kernel kernel = clCreateKernel(program, "work", &code);
        assert_int_equal(code, CL_SUCCESS);
        cl_mem out = clCreateBuffer(device->context, CL_MEM_READ_WRITE, sizeof(cl_uint), NULL, &code);
        assert_int_equal(code, CL_SUCCESS);
        assert_int_equal(clSetKernelArg(kernel, 0, sizeof out, &out), CL_SUCCESS);
        assert_int_equal(clEnqueueNDRangeKernel(device->queue, kernel, 1, NULL, &one, NULL, 0, NULL, NULL),
                         CL_SUCCESS);
        assert_int_equal(clFinish(device->queue), CL_SUCCESS);
        clReleaseMemObject(out);
        clReleaseKernel(kernel);
        clReleaseProgram(program);
        bp_device_close(&device);
        for (size_t m = 0; m < 512; ++m) {
            memory[m] = malloc(8 * m + 8);
            assert_non_null(memory[m]);
            memset(memory[m], 0x11, 8 * m + 8);
        }
        for (size_t m = 0; m < 512; ++m) free(memory[m]);
    }
    atomic_store(&stop, true);
    for (size_t b = 0; b < 4; ++b) pthread_join(busy[b], NULL);
}

static void names_the_place_of_an_error(void **state) {
    BpDevice *device = *state;
    static const char source[] = "#line 1 \"fine.cl\"\nfloat fine(float x) { return x; }\n"
                                 "#line 1 \"broken.cl\"\n__kernel void broken(__global float *out) {\n"
                                 "    out[0] = nothing_like_this;\n}\n";
    cl_program program = NULL;
    char *log = NULL;
    BpError err = {0};
    assert_int_equal(bp_device_build(device, source, NULL, &program, &log, &err), BP_ERR_BUILD);
    assert_null(program);
    assert_null(log);
    assert_non_null(err.attachment);
    assert_non_null(strstr(err.attachment, "nothing_like_this"));
    assert_string_equal(err.file, "broken.cl");
    assert_int_equal(err.line, 2);
    assert_int_equal(err.column, 14);
    assert_non_null(strstr(err.message, "nothing_like_this"));
    bp_error_clear(&err);
    /* A device survives a failed build, and a caller that wants no story. */
    assert_int_equal(bp_device_build(device, source, NULL, &program, NULL, NULL), BP_ERR_BUILD);
}

static void bad_options_are_a_build_error(void **state) {
    BpDevice *device = *state;
    cl_program program = NULL;
    BpError err = {0};
    const BpStatus status =
        bp_device_build(device, "__kernel void nothing(void) {}\n", "-no-such-option", &program, NULL, &err);
    if (status == BP_OK) {
        clReleaseProgram(program);
        printf("skipped: this driver takes options that it does not know\n");
        skip();
    }
    assert_true(status == BP_ERR_BUILD || status == BP_ERR_DEVICE);
    assert_true(err.message[0] != '\0');
    bp_error_clear(&err);
}

int main(int argc, char **argv) {
    BpDevice *device = NULL;
    if (argc > 1) times = atoi(argv[1]);
    const int missing = test_device_open(&device);
    if (missing != 0) return missing;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_prestate(builds_and_runs, device),
        cmocka_unit_test_prestate(part_is_closed_safely, device),
        cmocka_unit_test_prestate(names_the_place_of_an_error, device),
        cmocka_unit_test_prestate(bad_options_are_a_build_error, device),
    };
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    bp_device_close(&device);
    return failed;
}
