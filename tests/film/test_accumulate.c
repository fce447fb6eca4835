/* test_accumulate.c: the kernel `accumulate`, fed with samples made by the test: invalid ones are found,
 * left out and counted; sums are exact whatever their order; a million equal samples keep their mean, where a
 * float sum does not. */
#define BP_HOST
#include "base/random.h"
#include "opencl/device.h"
#include "opencl/program.h"
#include "packed/effects.h"
#include "scene_types.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define REPLICATES 4u
#define SCALE 37
#define LAMP_ITEMS 3 /* work-items that traced the samples, of which each has counted its rays to lamps */

static BpError err;

typedef struct Accumulator {
    BpDevice *device;
    BpProgram *program;
    cl_kernel kernel;
} Accumulator;

static int open_accumulator(void **state) {
    static Accumulator accumulator;
    BpDeviceInfo info;
    BpProgramOptions options = {.form = BP_KERNEL_SAMPLE, .tree_width = 8, .effects = 0};
    cl_int code = CL_SUCCESS;
    if (bp_device_find(NULL, &info, &err) != BP_OK ||
        bp_device_open(&info, &accumulator.device, &err) != BP_OK ||
        bp_program_build(accumulator.device, &options, NULL, NULL, &accumulator.program, &err) != BP_OK) {
        fprintf(stderr, "%s\n", err.message);
        return -1;
    }
    accumulator.kernel = clCreateKernel(accumulator.program->program, "accumulate", &code);
    *state = &accumulator;
    return code == CL_SUCCESS ? 0 : -1;
}

static int close_accumulator(void **state) {
    Accumulator *accumulator = *state;
    clReleaseKernel(accumulator->kernel);
    bp_program_destroy(&accumulator->program);
    bp_device_close(&accumulator->device);
    return 0;
}

/* What a pixel has, and what the kernel is told. */
typedef struct Pixel {
    cl_long sums[REPLICATES * 3], fine_sums[REPLICATES * 3];
    cl_uint counts[REPLICATES];
    cl_ulong tallies[TALLIES];
} Pixel;

/* Accumulates `count` samples of one pixel, starting at absolute number `first`, into the pixel, which keeps
 * what it held. */
static void accumulate_scaled(const Accumulator *accumulator, const float *samples, cl_uint count,
                              cl_uint first, cl_int scale, Pixel *pixel) {
    cl_context context = accumulator->device->context;
    const cl_mem_flags flags = CL_MEM_READ_WRITE | CL_MEM_COPY_HOST_PTR;
    /* The rays to lamps belong to the first part, so that parts add up. */
    const cl_uint lamp_rays[LAMP_ITEMS] = {first == 0 ? UINT32_MAX : 0, 0, first == 0 ? 1 : 0};
    const size_t sizes[6] = {(size_t)count * 4 * sizeof(float),
                             sizeof pixel->sums,
                             sizeof pixel->fine_sums,
                             sizeof pixel->counts,
                             sizeof pixel->tallies,
                             sizeof lamp_rays};
    void *const data[6] = {
        (void *)(uintptr_t)samples,  pixel->sums, pixel->fine_sums, pixel->counts, pixel->tallies,
        (void *)(uintptr_t)lamp_rays};
    cl_mem buffers[6];
    for (int i = 0; i < 6; ++i) {
        cl_int code = CL_SUCCESS;
        buffers[i] = clCreateBuffer(context, flags, sizes[i], data[i], &code);
        assert_int_equal(code, CL_SUCCESS);
    }
    const cl_uint zero = 0, one = 1, replicates = REPLICATES, items_traced = LAMP_ITEMS;
    const struct {
        size_t size;
        const void *value;
    } arguments[] = {{sizeof(cl_mem), &buffers[0]},
                     {sizeof one, &one},
                     {sizeof count, &count},
                     {sizeof zero, &zero},
                     {sizeof first, &first},
                     {sizeof replicates, &replicates},
                     {sizeof scale, &scale},
                     {sizeof(cl_mem), &buffers[1]},
                     {sizeof(cl_mem), &buffers[2]},
                     {sizeof(cl_mem), &buffers[3]},
                     {sizeof(cl_mem), &buffers[4]},
                     {sizeof(cl_mem), &buffers[5]},
                     {sizeof items_traced, &items_traced}};
    for (cl_uint i = 0; i < sizeof arguments / sizeof arguments[0]; ++i)
        assert_int_equal(clSetKernelArg(accumulator->kernel, i, arguments[i].size, arguments[i].value),
                         CL_SUCCESS);
    const size_t items = 64;
    cl_command_queue queue = accumulator->device->queue;
    assert_int_equal(
        clEnqueueNDRangeKernel(queue, accumulator->kernel, 1, NULL, &items, &items, 0, NULL, NULL),
        CL_SUCCESS);
    for (int i = 1; i < 5; ++i)
        assert_int_equal(clEnqueueReadBuffer(queue, buffers[i], CL_TRUE, 0, sizes[i], data[i], 0, NULL, NULL),
                         CL_SUCCESS);
    for (int i = 0; i < 6; ++i) clReleaseMemObject(buffers[i]);
}

/* The same at SCALE, for samples that need no fine sums. */
static void accumulate(const Accumulator *accumulator, const float *samples, cl_uint count, cl_uint first,
                       cl_long sums[REPLICATES * 3], cl_uint counts[REPLICATES], cl_ulong tallies[TALLIES]) {
    Pixel pixel = {{0}, {0}, {0}, {0}};
    memcpy(pixel.sums, sums, sizeof pixel.sums);
    memcpy(pixel.counts, counts, sizeof pixel.counts);
    memcpy(pixel.tallies, tallies, sizeof pixel.tallies);
    accumulate_scaled(accumulator, samples, count, first, SCALE, &pixel);
    memcpy(sums, pixel.sums, sizeof pixel.sums);
    memcpy(counts, pixel.counts, sizeof pixel.counts);
    memcpy(tallies, pixel.tallies, sizeof pixel.tallies);
}

/* A path whose camera ray met nothing has one segment and a mark; only valid samples count as such. */
static void what_met_nothing_is_counted(void **state) {
    float samples[12][4];
    for (int i = 0; i < 12; ++i) {
        for (int c = 0; c < 3; ++c) samples[i][c] = 0.25f;
        samples[i][3] = 1000000.5f; /* as long as a path can be, and cut */
        if (i % 3 == 0) samples[i][3] = 1.0f + (float)MISSED_MARK;
    }
    for (int careful = 0; careful < 2; ++careful) { /* 0, 3, 6, 9, and of these 3 and 9 are left out */
        if (careful) samples[3][0] = NAN, samples[9][2] = -1, samples[4][1] = INFINITY;
        cl_long sums[REPLICATES * 3] = {0};
        cl_uint counts[REPLICATES] = {0};
        cl_ulong tallies[TALLIES] = {0};
        accumulate(*state, &samples[0][0], 12, 0, sums, counts, tallies);
        assert_int_equal(tallies[TALLY_SEGMENTS], 8 * 1000000 + 4);
        assert_int_equal(tallies[TALLY_CUT], 8);
        assert_int_equal(tallies[TALLY_NOT_FINITE], careful ? 2 : 0);
        assert_int_equal(tallies[TALLY_NEGATIVE], careful ? 1 : 0);
        assert_int_equal(tallies[TALLY_OUT_OF_RANGE], 0);
        assert_int_equal(tallies[TALLY_MISSED], careful ? 2 : 4);
        assert_true(tallies[TALLY_LAMP_RAYS] == (UINT64_C(1) << 32)); /* more than 32 bits hold */
    }
}

static void invalid_samples_are_left_out(void **state) {
    const float tiny = -1e-30f;
    float samples[12][4];
    for (int i = 0; i < 12; ++i) {
        for (int c = 0; c < 3; ++c) samples[i][c] = 0.25f;
        samples[i][3] = 3;
    }
    samples[1][0] = NAN;
    samples[2][1] = INFINITY;
    samples[3][2] = -INFINITY;
    samples[4][0] = tiny;  /* any negative number */
    samples[5][1] = 1e9f;  /* beyond what a path can bring at this scale */
    samples[6][2] = -0.0f; /* a zero: valid */
    samples[7][3] = 50.5f; /* cut by the depth cap: valid */
    cl_long sums[REPLICATES * 3] = {0};
    cl_uint counts[REPLICATES] = {0};
    cl_ulong tallies[TALLIES] = {0};
    accumulate(*state, &samples[0][0], 12, 0, sums, counts, tallies);
    assert_int_equal(tallies[TALLY_SEGMENTS], 11 * 3 + 50);
    assert_int_equal(tallies[TALLY_CUT], 1);
    assert_int_equal(tallies[TALLY_NOT_FINITE], 3);
    assert_int_equal(tallies[TALLY_NEGATIVE], 1);
    assert_int_equal(tallies[TALLY_OUT_OF_RANGE], 1);
    /* replicate k: samples k, k + 4, k + 8 without 1, 2, 3, 4, 5 */
    const cl_uint expected[REPLICATES] = {2, 1, 2, 2};
    const cl_long quarter = (cl_long)1 << (SCALE - 2);
    for (cl_uint k = 0; k < REPLICATES; ++k) {
        assert_int_equal(counts[k], expected[k]);
        for (cl_uint c = 0; c < 3; ++c) {
            const cl_long missing = k == 2 && c == 2 ? 1 : 0; /* sample 6 */
            assert_int_equal(sums[k * 3 + c], quarter * ((cl_long)expected[k] - missing));
        }
    }
}

static void replicate_is_sample_modulo(void **state) {
    float samples[3][4] = {{0.5f, 0, 0, 1}, {0, 0.5f, 0, 1}, {0, 0, 0.5f, 1}};
    cl_long sums[REPLICATES * 3] = {0};
    cl_uint counts[REPLICATES] = {0};
    cl_ulong tallies[TALLIES] = {0};
    accumulate(*state, &samples[0][0], 3, 6, sums, counts, tallies); /* numbers 6, 7, 8 */
    const cl_uint expected[REPLICATES] = {1, 0, 1, 1};
    for (cl_uint k = 0; k < REPLICATES; ++k) assert_int_equal(counts[k], expected[k]);
    const cl_long one_half = (cl_long)1 << (SCALE - 1);
    assert_int_equal(sums[2 * 3 + 0], one_half);
    assert_int_equal(sums[3 * 3 + 1], one_half);
    assert_int_equal(sums[0 * 3 + 2], one_half);
}

static void a_million_equal_samples_keep_their_mean(void **state) {
    const cl_uint count = 1000000;
    float *samples = malloc((size_t)count * 4 * sizeof *samples);
    assert_non_null(samples);
    for (cl_uint i = 0; i < count * 4; ++i) samples[i] = i % 4 == 3u ? 1.0f : 0.1f;
    cl_long sums[REPLICATES * 3] = {0};
    cl_uint counts[REPLICATES] = {0};
    cl_ulong tallies[TALLIES] = {0};
    accumulate(*state, samples, count, 0, sums, counts, tallies);
    double total = 0;
    for (cl_uint k = 0; k < REPLICATES; ++k) total += (double)sums[k * 3];
    const double mean = ldexp(total, -SCALE) / count;
    assert_true(fabs(mean / 0.1 - 1) <= 1e-6);
    /* the control: a float sum drifts */
    volatile float naive = 0;
    for (cl_uint i = 0; i < count; ++i) naive += 0.1f;
    assert_true(fabs((double)naive / count / 0.1 - 1) > 1e-3);
    /* and the order does not matter: in two parts, the later one first */
    const cl_uint part = 333333;
    cl_long parts[REPLICATES * 3] = {0};
    cl_uint part_counts[REPLICATES] = {0};
    cl_ulong part_tallies[TALLIES] = {0};
    accumulate(*state, samples + (size_t)part * 4, count - part, part, parts, part_counts, part_tallies);
    accumulate(*state, samples, part, 0, parts, part_counts, part_tallies);
    assert_memory_equal(sums, parts, sizeof sums);
    assert_memory_equal(counts, part_counts, sizeof counts);
    free(samples);
}

/* Any float between 2^-18 and 2^38 steps is kept to within a millionth of itself, and what the fine sums held
 * before their flag was set is not believed. */
static void dim_samples_are_kept(void **state) {
    enum { COUNT = 4000 };
    static float samples[COUNT][4];
    double expected[REPLICATES * 3] = {0};
    BpRandom random = {7};
    for (size_t i = 0; i < COUNT; ++i)
        for (size_t c = 0; c < 4; ++c) {
            const uint64_t seed = bp_random_bits(&random);
            /* Each replicate has a brightness of its own, so that none hides another's rounding. */
            const int exponent = 1 - 13 * (int)(i % REPLICATES) + (int)(seed >> 60);
            samples[i][c] = c == 3 ? 1 : ldexpf(1 + (float)(seed >> 41) * 0x1p-23f, exponent);
            if (c < 3) expected[i % REPLICATES * 3 + c] += (double)samples[i][c];
        }
    Pixel whole = {{0}, {0}, {0}, {0}}, parts = {{0}, {0}, {0}, {0}};
    for (int i = 0; i < 12; ++i)
        whole.fine_sums[i] = parts.fine_sums[i] = 0x5555555555555555; /* never zeroed */
    accumulate_scaled(*state, &samples[0][0], COUNT, 0, 38 - 17, &whole);
    for (cl_uint k = 0; k < REPLICATES; ++k) {
        assert_int_equal(whole.counts[k] & COUNT_SAMPLES, COUNT / REPLICATES);
        const bool fine = (whole.counts[k] & COUNT_HAS_FINE) != 0;
        assert_int_equal(fine, k > 0); /* the brightest replicate needs none */
        assert_int_equal(whole.counts[k] & COUNT_COARSE, 0);
        for (cl_uint i = 3 * k; i < 3 * k + 3; ++i) {
            const double sum = (double)whole.sums[i] + (fine ? ldexp((double)whole.fine_sums[i], -38) : 0);
            assert_true(fabs(ldexp(sum, -21) / expected[i] - 1) <= 1e-6);
            if (!fine) assert_int_equal(whole.fine_sums[i], 0x5555555555555555);
        }
    }
    for (int cause = TALLY_NOT_FINITE; cause <= TALLY_OUT_OF_RANGE; cause++)
        assert_int_equal(whole.tallies[cause], 0);
    /* In parts, in another order: the same numbers. */
    accumulate_scaled(*state, samples[1001], COUNT - 1001, 1001, 38 - 17, &parts);
    accumulate_scaled(*state, samples[0], 1001, 0, 38 - 17, &parts);
    assert_memory_equal(&whole, &parts, sizeof whole);
}

/* A sample below 2^20 fine steps is marked; a zero is not, nor is an invalid one. */
static void samples_too_dim_are_marked(void **state) {
    const float step = ldexpf(1, -SCALE - 38);
    const float bright[8][4] = {{0, step * 1048576, 0, 1},
                                {NAN, step, 1, 1},
                                {0, 0, 0, 1},
                                {-0.0f, 1, 1, 1},
                                {0, 0, 0, 1},
                                {1, 1, 1, 1},
                                {0, 0, 0, 1},
                                {0, 0, 0, 1}};
    Pixel pixel = {{0}, {0}, {0}, {0}};
    accumulate_scaled(*state, &bright[0][0], 8, 0, SCALE, &pixel);
    assert_int_equal(pixel.counts[0], 2 | COUNT_HAS_FINE);
    assert_int_equal(pixel.fine_sums[1], 1048576);
    assert_int_equal(pixel.counts[1], 1);
    assert_int_equal(pixel.counts[2], 2);
    assert_int_equal(pixel.counts[3], 2);
    assert_int_equal(pixel.tallies[TALLY_NOT_FINITE], 1);
    const float dim[4] = {0, 0, step * 1048575, 1}, lost[4] = {step * 0.25f, 0, 0, 1};
    accumulate_scaled(*state, dim, 1, 0, SCALE, &pixel);
    assert_int_equal(pixel.counts[0], 3 | COUNT_HAS_FINE | COUNT_COARSE);
    accumulate_scaled(*state, lost, 1, 1, SCALE, &pixel);
    assert_int_equal(pixel.counts[1], 2 | COUNT_COARSE); /* nothing of it is left */
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(invalid_samples_are_left_out),
        cmocka_unit_test(what_met_nothing_is_counted),
        cmocka_unit_test(replicate_is_sample_modulo),
        cmocka_unit_test(a_million_equal_samples_keep_their_mean),
        cmocka_unit_test(dim_samples_are_kept),
        cmocka_unit_test(samples_too_dim_are_marked),
    };
    return cmocka_run_group_tests(tests, open_accumulator, close_accumulator);
}
