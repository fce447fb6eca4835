/* test_sums.c: tests 33 to 37: sums that do not drift, invalid samples, and arithmetic left as written. */
#define BP_HOST
#include "suite.h"

#include "scene_types.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SCALE 24

typedef struct Accumulated {
    int64_t sums[4 * 3], fine_sums[4 * 3];
    uint32_t counts[4];
    uint64_t tallies[TALLIES];
} Accumulated;

/* The product's kernel `accumulate` on `count` samples of one pixel, `parts` chunks, 4 replicates. */
static void accumulate(const Lab *lab, const double *samples, uint32_t count, uint32_t parts,
                       Accumulated *accumulated) {
    cl_int code;
    cl_kernel kernel = clCreateKernel(lab->program->program, "accumulate", &code);
    assert_int_equal(code, CL_SUCCESS);
    memset(accumulated, 0, sizeof *accumulated);
    const cl_context context = lab->device->context;
    const cl_mem_flags copy = CL_MEM_READ_WRITE | CL_MEM_COPY_HOST_PTR;
    cl_mem sums = clCreateBuffer(context, copy, sizeof accumulated->sums, accumulated->sums, &code);
    cl_mem fine_sums =
        clCreateBuffer(context, copy, sizeof accumulated->fine_sums, accumulated->fine_sums, &code);
    cl_mem counts = clCreateBuffer(context, copy, sizeof accumulated->counts, accumulated->counts, &code);
    cl_mem tallies = clCreateBuffer(context, copy, sizeof accumulated->tallies, accumulated->tallies, &code);
    for (uint32_t part = 0; part < parts; ++part) {
        const uint32_t first = (uint32_t)((uint64_t)count * part / parts);
        const uint32_t end = (uint32_t)((uint64_t)count * (part + 1) / parts);
        const size_t numbers = (size_t)(end - first) * 4, size = lab->real_double ? 8 : 4;
        char *narrow = suite_calloc(numbers, size);
        for (size_t i = 0; i < numbers; ++i) {
            const double value = samples[(size_t)first * 4 + i];
            const float single = (float)value;
            if (lab->real_double)
                memcpy(narrow + i * 8, &value, 8);
            else
                memcpy(narrow + i * 4, &single, 4);
        }
        cl_mem buffer = clCreateBuffer(context, copy, numbers * size, narrow, &code);
        assert_int_equal(code, CL_SUCCESS);
        const cl_uint words[] = {1, end - first, 0, first, 4}, no_items = 0;
        const cl_int scale = SCALE;
        cl_uint index = 0;
        clSetKernelArg(kernel, index++, sizeof buffer, &buffer);
        for (int i = 0; i < 5; ++i) clSetKernelArg(kernel, index++, sizeof(cl_uint), &words[i]);
        clSetKernelArg(kernel, index++, sizeof scale, &scale);
        clSetKernelArg(kernel, index++, sizeof sums, &sums);
        clSetKernelArg(kernel, index++, sizeof fine_sums, &fine_sums);
        clSetKernelArg(kernel, index++, sizeof counts, &counts);
        clSetKernelArg(kernel, index++, sizeof tallies, &tallies);
        clSetKernelArg(kernel, index++, sizeof counts, &counts); /* no rays to lamps: not read */
        clSetKernelArg(kernel, index++, sizeof no_items, &no_items);
        const size_t one = 1;
        assert_int_equal(
            clEnqueueNDRangeKernel(lab->device->queue, kernel, 1, NULL, &one, &one, 0, NULL, NULL),
            CL_SUCCESS);
        clFinish(lab->device->queue);
        clReleaseMemObject(buffer);
        free(narrow);
    }
    clEnqueueReadBuffer(lab->device->queue, sums, CL_TRUE, 0, sizeof accumulated->sums, accumulated->sums, 0,
                        NULL, NULL);
    clEnqueueReadBuffer(lab->device->queue, fine_sums, CL_TRUE, 0, sizeof accumulated->fine_sums,
                        accumulated->fine_sums, 0, NULL, NULL);
    clEnqueueReadBuffer(lab->device->queue, counts, CL_TRUE, 0, sizeof accumulated->counts,
                        accumulated->counts, 0, NULL, NULL);
    clEnqueueReadBuffer(lab->device->queue, tallies, CL_TRUE, 0, sizeof accumulated->tallies,
                        accumulated->tallies, 0, NULL, NULL);
    clReleaseMemObject(sums);
    clReleaseMemObject(fine_sums);
    clReleaseMemObject(counts);
    clReleaseMemObject(tallies);
    clReleaseKernel(kernel);
}

static double mean_of(const Accumulated *accumulated, int channel) {
    double sum = 0;
    uint32_t count = 0;
    for (int k = 0; k < 4; ++k) {
        sum += (double)accumulated->sums[k * 3 + channel] +
               ldexp((double)accumulated->fine_sums[k * 3 + channel], -FINE_BITS);
        count += accumulated->counts[k] & COUNT_SAMPLES;
    }
    return ldexp(sum, -SCALE) / count;
}

/* 33: a million times 0.1. The naive float sum is off by a percent. */
static void accum_const(void **state) {
    enum { COUNT = 1000000 };
    double *samples = suite_calloc(COUNT * 4, sizeof *samples);
    volatile float naive = 0;
    for (size_t i = 0; i < COUNT; ++i) {
        for (int c = 0; c < 3; ++c) samples[4 * i + (size_t)c] = lab_float(0.1);
        samples[4 * i + 3] = 1;
        naive = naive + 0.1f;
    }
    Accumulated accumulated;
    accumulate(*state, samples, COUNT, 1, &accumulated);
    const double off = fabs(mean_of(&accumulated, 0) / lab_float(0.1) - 1);
    const double naive_off = fabs((double)naive / COUNT / lab_float(0.1) - 1);
    print_message("    mean off by %.2g; naive float %.2g\n", off, naive_off);
    assert_true(off <= 1e-6 && naive_off > 1e-3);
    assert_true(accumulated.tallies[TALLY_SEGMENTS] == COUNT && accumulated.tallies[TALLY_NOT_FINITE] == 0);
    free(samples);
}

/* 34: however the samples are cut into chunks, the sums are the same to the bit. */
static void accum_split(void **state) {
    enum { COUNT = 4099 };
    const uint32_t parts[] = {1, 2, 3, 7, 64, COUNT};
    double *samples = suite_calloc(COUNT * 4, sizeof *samples);
    uint64_t seed = 34;
    Accumulated whole, split;
    for (size_t i = 0; i < COUNT * 4; ++i)
        samples[i] = i % 4 == 3 ? 1 : lab_float(exp(20 * lab_unit(&seed) - 10));
    accumulate(*state, samples, COUNT, 1, &whole);
    for (size_t p = 1; p < sizeof parts / sizeof parts[0]; ++p) {
        accumulate(*state, samples, COUNT, parts[p], &split);
        assert_memory_equal(&whole, &split, sizeof whole);
    }
    free(samples);
}

/* 35: samples that are not light are left out and counted. */
static void nan_quarantine(void **state) {
    const double bad[] = {NAN, INFINITY, -INFINITY, -1e-3, 1e30, -NAN};
    enum { COUNT = 600 };
    double samples[COUNT * 4];
    uint64_t expected = 0;
    for (size_t i = 0; i < COUNT; ++i) {
        for (size_t c = 0; c < 3; ++c) samples[4 * i + c] = 0.5;
        samples[4 * i + 3] = 1;
        if (i % 10 == 3) {
            samples[4 * i + i / 10 % 3] = bad[i / 10 % 6];
            ++expected;
        }
    }
    samples[0] = -0.0; /* is light: none */
    Accumulated accumulated;
    accumulate(*state, samples, COUNT, 3, &accumulated);
    assert_true(accumulated.tallies[TALLY_NOT_FINITE] == expected * 4 / 6);
    assert_true(accumulated.tallies[TALLY_NEGATIVE] == expected / 6);
    assert_true(accumulated.tallies[TALLY_OUT_OF_RANGE] == expected / 6);
    uint32_t count = 0;
    for (int k = 0; k < 4; ++k) count += accumulated.counts[k] & COUNT_SAMPLES;
    assert_true(count == COUNT - expected);
    assert_true(mean_of(&accumulated, 1) == 0.5);
    assert_true(fabs(mean_of(&accumulated, 0) - 0.5 * (count - 1) / count) < 1e-7);
}

enum { ARITHMETIC = 4096 };

static void run_arithmetic(const Lab *lab, double *in, double *out) {
    uint64_t seed = 36;
    for (size_t i = 0; i < ARITHMETIC; ++i) {
        in[3 * i] = lab_float((lab_unit(&seed) - 0.5) * exp2(floor(20 * lab_unit(&seed) - 10)));
        in[3 * i + 1] = lab_float((lab_unit(&seed) + 0.5) * exp2(floor(20 * lab_unit(&seed) - 10)));
        in[3 * i + 2] = 0;
    }
    const LabArgument arguments[] = {{LAB_REALS, in, 3 * ARITHMETIC}, {LAB_OUT_REALS, out, 8 * ARITHMETIC}};
    lab_run(lab, "probe_arithmetic", ARITHMETIC, arguments, 2, NULL);
}

/* 36: NaN is not at least 0, the error of a sum is there, a*b - a*b is 0, and fma is fused. Exact for single
 * precision; in double the sums of floats are mostly exact, so only NaN and a*b - a*b are judged. */
static void build_flags(void **state) {
    const Lab *lab = *state;
    static double in[3 * ARITHMETIC], out[8 * ARITHMETIC];
    run_arithmetic(lab, in, out);
    for (size_t i = 0; i < ARITHMETIC; ++i) {
        const double a = in[3 * i], b = in[3 * i + 1], *row = out + 8 * i;
        assert_true(row[0] == 1);
        assert_true(row[2] == 0);
        if (lab->real_double) continue;
        assert_true(row[1] == a + b - lab_float(a + b));
        assert_true(row[3] == a * b - lab_float(a * b));
    }
}

/* 37: division within 2.5 ulp, square root 3, its reciprocal 5.5, as OpenCL's full profile promises. */
static void math_ulp(void **state) {
    const Lab *lab = *state;
    static double in[3 * ARITHMETIC], out[8 * ARITHMETIC];
    double worst[3] = {0};
    run_arithmetic(lab, in, out);
    for (size_t i = 0; i < ARITHMETIC; ++i) {
        const double a = in[3 * i], b = in[3 * i + 1], *row = out + 8 * i;
        if (a == 0) continue;
        const double right[] = {a / b, sqrt(fabs(a)), 1 / sqrt(fabs(a))};
        for (int k = 0; k < 3; ++k) {
            const double ulp = exp2(floor(log2(fabs(right[k])))) * (lab->real_double ? 0x1p-52 : 0x1p-23);
            worst[k] = fmax(worst[k], fabs(row[4 + k] - right[k]) / ulp);
        }
    }
    print_message("    ulps: division %.2f, square root %.2f, its reciprocal %.2f\n", worst[0], worst[1],
                  worst[2]);
    assert_true(worst[0] <= 2.5 && worst[1] <= 3 && worst[2] <= 5.5);
}

int run_sums(Lab *lab) {
    const struct CMUnitTest tests[] = {HARD_TEST(accum_const), HARD_TEST(accum_split),
                                       HARD_TEST(nan_quarantine), HARD_TEST(build_flags),
                                       HARD_TEST(math_ulp)};
    return cmocka_run_group_tests_name("sums", tests, NULL, NULL);
}
