/* self_test.c: the known answers, and the comparison; see self_test.h. */
#include "self_test.h"

#include "base/float_bits.h"
#include "base/random.h"
#include "program.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define ITEMS 512u

/* name, allowed error in units in the last place of a float (0: every bit), needs double, meaning of a
 * failure */
#define COLUMN_LIST(X)                                                                                       \
    X(INTEGERS, 0.0, false, "32-bit integer arithmetic")                                                     \
    X(LONGS, 0.0, false, "64-bit integer arithmetic")                                                        \
    X(FIXED_POINT, 0.0, false, "conversion of floats to 64-bit integers")                                    \
    X(WALK, 0.0, false, "a loop with a private array")                                                       \
    X(UNIT, 0.0, false, "uniform numbers from random bits")                                                  \
    X(SUM, 0.0, false, "rounding of a + b")                                                                  \
    X(PRODUCT, 0.0, false, "rounding of a * b")                                                              \
    X(CONTRACTION, 0.0, false, "a * b - c is fused although FP_CONTRACT is off, that is")                    \
    X(CONTRACTION_LANES, 0.0, false, "a * b - c in vectors is fused although FP_CONTRACT is off, that is")   \
    X(FMA, 0.0, false, "fma(a, b, c)")                                                                       \
    X(FMA_RESIDUE, 0.0, false, "the exact error of a product by fma")                                        \
    X(DIVIDE, 2.5, false, "a / b within 2.5 units in the last place")                                        \
    X(SQRT, 3.0, false, "sqrt(a) within 3 units in the last place")                                          \
    X(ROUNDED_DIVIDE, 0.0, false, "rounding of a / b")                                                       \
    X(ROUNDED_SQRT, 0.0, false, "rounding of sqrt(a)")                                                       \
    X(SUM_RESIDUE, 0.0, false, "the exact error of a sum")                                                   \
    X(SPECIAL, 0.0, false, "NaN and infinities")                                                             \
    X(NAN_BITS, 0.0, false, "the bits of a NaN")                                                             \
    X(LANES, 0.0, false, "comparing and choosing in vectors of eight")                                       \
    X(DOUBLE_FMA, 0.0, true, "the exact error of a product of doubles by fma")                               \
    X(DOUBLE_DIVIDE, 0.0, true, "rounding of x / y in double")                                               \
    X(DOUBLE_SQRT, 0.0, true, "rounding of sqrt(x) in double")                                               \
    X(DOUBLE_CONTRACTION, 0.0, true, "x * y - z in double is fused although FP_CONTRACT is off, that is")

typedef enum Column {
#define COLUMN_ENUM(name, ulps, needs_double, text) COLUMN_##name,
    COLUMN_LIST(COLUMN_ENUM)
#undef COLUMN_ENUM
        COLUMN_COUNT
} Column;

static const struct {
    const char *name, *text;
    double ulps;
    bool needs_double;
} columns[] = {
#define COLUMN_ENTRY(name, ulps, needs_double, text) {#name, text, ulps, needs_double},
    COLUMN_LIST(COLUMN_ENTRY)
#undef COLUMN_ENTRY
};

typedef struct Inputs {
    uint32_t uints[ITEMS * 2];
    float floats[ITEMS * 5 + 8]; /* a, b, c, 0, a NaN; eight more for the last vector load */
} Inputs;

static uint32_t folded_double_bits(double x) {
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return (uint32_t)bits ^ (uint32_t)(bits >> 32);
}

/* A quiet NaN that carries some of `word`. */
static uint32_t nan_bits(uint32_t word) {
    return 0x7fc00000u | (word & 0x003fffffu);
}

/* Numbers of both signs whose magnitudes spread over 2^-16 .. 2^15, so that sums, products, residues and
 * their squares are all normal numbers: a device may flush others. */
static void make_inputs(Inputs *in) {
    BpRandom random = {1};
    memset(in, 0, sizeof *in);
    for (uint32_t i = 0; i < ITEMS * 5; ++i) {
        const uint32_t bits = (uint32_t)(bp_random_bits(&random) >> 32);
        if (i < ITEMS * 2) {
            in->uints[i] = bits;
        } else {
            const uint32_t j = i - ITEMS * 2;
            const uint32_t exponent = 111u + (bits >> 23 & 31u);
            in->floats[j / 3 * 5 + j % 3] = bp_bits_float((bits & 0x807fffffu) | exponent << 23);
        }
    }
    for (uint32_t item = 0; item < ITEMS; ++item)
        in->floats[item * 5 + 4] = bp_bits_float(nan_bits(in->uints[item]));
}

static uint32_t walk(uint32_t seed) {
    uint32_t stack[32], top = 0, digest = seed;
    stack[top++] = 1u;
    while (top > 0) {
        const uint32_t node = stack[--top];
        digest = (digest ^ node) * 0x01000193u;
        if (node >= 64u) continue;
        if ((digest >> 20 & 3u) != 0u) stack[top++] = node * 2u + 1u;
        if ((digest >> 22 & 3u) != 0u) stack[top++] = node * 2u;
    }
    return digest;
}

static uint32_t vector_lanes(const float *values, float limit) {
    uint32_t bits = 0;
    for (uint32_t lane = 0; lane < 8; ++lane)
        if (values[lane] < limit) bits |= 1u << lane;
    const uint32_t first = values[0] < limit ? bp_float_bits(values[0]) : 0u;
    const uint32_t last = values[7] < limit ? bp_float_bits(values[7]) : 0u;
    return bits ^ first ^ (last >> 1);
}

static uint32_t count_ones(uint32_t bits) {
    uint32_t count = 0;
    for (; bits != 0; bits &= bits - 1) ++count;
    return count;
}

/* The answers of a correct device; `exact` if a column allows an error. */
static void expect(const Inputs *in, uint32_t item, uint32_t row[COLUMN_COUNT], double exact[COLUMN_COUNT]) {
    const uint32_t m = in->uints[2 * item], n = in->uints[2 * item + 1];
    const float *floats = in->floats + 5 * item;
    const float a = floats[0], b = floats[1], c = floats[2];
    const uint64_t product = (uint64_t)m * n, wide = product + ((uint64_t)n << 32);
    row[COLUMN_INTEGERS] = (m * n + (m << 7)) ^ (n >> 9) ^ ((uint32_t)(product >> 32) - count_ones(m));
    row[COLUMN_LONGS] = (uint32_t)(wide >> 32) ^ (uint32_t)wide;
    row[COLUMN_FIXED_POINT] = (uint32_t)(uint64_t)llrint((double)(a * 65536.0f)) ^
                              (uint32_t)((uint64_t)(int64_t)(c * 16777216.0f) >> 32);
    row[COLUMN_WALK] = walk(m);
    row[COLUMN_UNIT] = bp_float_bits((float)(m >> 8) * 0x1p-24f);
    row[COLUMN_SUM] = bp_float_bits(a + b);
    row[COLUMN_PRODUCT] = bp_float_bits(a * b);
    row[COLUMN_CONTRACTION] = 0;
    row[COLUMN_CONTRACTION_LANES] = 0;
    row[COLUMN_FMA] = bp_float_bits(fmaf(a, b, c));
    row[COLUMN_FMA_RESIDUE] = bp_float_bits((float)((double)a * (double)b - (double)(a * b)));
    exact[COLUMN_DIVIDE] = (double)a / (double)b;
    exact[COLUMN_SQRT] = sqrt(fabs((double)a));
    /* Rounding the double quotient or root once more gives the float's own (S. Figueroa, "When is double
     * rounding innocuous?", SIGNUM Newsletter 30(3), 1995). */
    row[COLUMN_ROUNDED_DIVIDE] = bp_float_bits((float)exact[COLUMN_DIVIDE]);
    row[COLUMN_ROUNDED_SQRT] = bp_float_bits((float)exact[COLUMN_SQRT]);
    const float sum = a + b, b_part = sum - a, a_part = sum - b_part;
    row[COLUMN_SUM_RESIDUE] = bp_float_bits((a - a_part) + (b - b_part));
    row[COLUMN_SPECIAL] = 0x7f;
    row[COLUMN_NAN_BITS] = nan_bits(in->uints[item]);
    row[COLUMN_LANES] = vector_lanes(floats, c);
    const double x = (double)a / 3.0, y = (double)b * 1.1;
    row[COLUMN_DOUBLE_FMA] = folded_double_bits(fma(x, y, -(x * y)));
    row[COLUMN_DOUBLE_DIVIDE] = folded_double_bits(x / y);
    row[COLUMN_DOUBLE_SQRT] = folded_double_bits(sqrt(fabs(x)));
    row[COLUMN_DOUBLE_CONTRACTION] = 0;
}

static bool within(float got, double exact, double ulps) {
    if (!isfinite(got)) return false;
    const double unit = ldexp(1.0, ilogb(exact) - 23);
    return fabs((double)got - exact) <= ulps * unit;
}

/* Compares all rows; *failures counts the wrong columns, `story` describes the first of them. */
static void compare(const Inputs *in, const uint32_t *rows, bool has_double, unsigned *failures, char *story,
                    size_t size) {
    bool wrong[COLUMN_COUNT] = {false};
    *failures = 0;
    for (uint32_t item = 0; item < ITEMS; ++item) {
        uint32_t row[COLUMN_COUNT] = {0};
        double exact[COLUMN_COUNT] = {0};
        expect(in, item, row, exact);
        for (int column = 0; column < COLUMN_COUNT; ++column) {
            if (wrong[column] || (columns[column].needs_double && !has_double)) continue;
            const uint32_t got = rows[item * COLUMN_COUNT + (uint32_t)column];
            if (columns[column].ulps > 0) row[column] = bp_float_bits((float)exact[column]);
            const bool right = columns[column].ulps > 0
                                   ? within(bp_bits_float(got), exact[column], columns[column].ulps)
                                   : got == row[column];
            if (right) continue;
            wrong[column] = true;
            if ((*failures)++ > 0) continue;
            snprintf(story, size, "%s (case %u: 0x%08x, not 0x%08x)", columns[column].text, (unsigned)item,
                     (unsigned)got, (unsigned)row[column]);
        }
    }
}

const char *const bp_self_test_files[BP_SELF_TEST_FILES] = {
    "dialect/real.cl",         "dialect/fused.cl",  "dialect/lanes_one.cl", "dialect/lanes.cl",
    "dialect/lane_by_lane.cl", "dialect/divide.cl", "entry/self_test.cl"};

/* The test's own program: the kernels' dialect and self_test.cl, and nothing else, so that it builds fast,
 * and also where the whole kernel does not build. The caller frees *source. */
static BpStatus assemble(const BpDevice *device, const char *kernel_text, char **source, BpError *err) {
    size_t size = 0;
    BpStatus status = BP_OK;
    FILE *out = open_memstream(source, &size);
    if (out == NULL) return bp_fail(err, BP_ERR_MEMORY, "no memory for the self-test");
    fprintf(out,
            "#define REAL_IS_DOUBLE 0\n#define REFINE_IS_DOUBLE %d\n#define OWN_ROUNDING %d\n"
            "#define TREE_WIDTH 8\n#define ROW_COLUMNS %du\n",
            device->info.has_double, !bp_device_rounds_quotients(device->id), COLUMN_COUNT);
    for (int column = 0; column < COLUMN_COUNT; ++column)
        fprintf(out, "#define COLUMN_%s %du\n", columns[column].name, column);
    const int own = kernel_text != NULL ? BP_SELF_TEST_FILES - 1 : BP_SELF_TEST_FILES;
    for (int f = 0; f < own && status == BP_OK; ++f)
        status = bp_kernel_print(bp_self_test_files[f], out, err);
    if (kernel_text != NULL)
        fprintf(out, "#line 1 \"%s\"\n%s", bp_self_test_files[BP_SELF_TEST_FILES - 1], kernel_text);
    return bp_kernel_close(out, status, source, err);
}

/* Runs the built kernel over `in`. */
static BpStatus launch(BpDevice *device, cl_program program, const Inputs *in, uint32_t *rows,
                       size_t rows_size, BpError *err) {
    BpStatus status = BP_OK;
    cl_mem buffers[3] = {NULL};
    const size_t sizes[3] = {sizeof in->uints, sizeof in->floats, rows_size};
    const void *contents[3] = {in->uints, in->floats, rows};
    cl_int code;
    const char *call = "clCreateKernel(self_test)";
    cl_kernel kernel = clCreateKernel(program, "self_test", &code);
    for (cl_uint i = 0; i < 3 && code == CL_SUCCESS; ++i) {
        call = "clCreateBuffer";
        /* The host's copy of the results is 0, so an answer that is never written is wrong. */
        buffers[i] = clCreateBuffer(device->context, CL_MEM_READ_WRITE | CL_MEM_COPY_HOST_PTR, sizes[i],
                                    (void *)(uintptr_t)contents[i], &code);
        if (code == CL_SUCCESS) {
            call = "clSetKernelArg";
            code = clSetKernelArg(kernel, i, sizeof buffers[i], &buffers[i]);
        }
    }
    if (code == CL_SUCCESS) {
        const size_t items = ITEMS;
        call = "clEnqueueNDRangeKernel(self_test)";
        code = clEnqueueNDRangeKernel(device->queue, kernel, 1, NULL, &items, NULL, 0, NULL, NULL);
    }
    if (code == CL_SUCCESS) {
        call = "clEnqueueReadBuffer";
        code = clEnqueueReadBuffer(device->queue, buffers[2], CL_TRUE, 0, sizes[2], rows, 0, NULL, NULL);
    }
    if (code != CL_SUCCESS) status = bp_cl_fail(err, code, call, device);
    for (int i = 0; i < 3; ++i)
        if (buffers[i] != NULL) clReleaseMemObject(buffers[i]);
    if (kernel != NULL) clReleaseKernel(kernel);
    return status;
}

BpStatus bp_self_test_run(BpDevice *device, const char *kernel_text, BpError *err) {
    BpStatus status;
    char *source = NULL, story[256] = "";
    Inputs *in = malloc(sizeof *in);
    const size_t rows_size = ITEMS * COLUMN_COUNT * sizeof(uint32_t);
    uint32_t *rows = calloc(1, rows_size);
    cl_program program = NULL;
    unsigned failures;

    if (in == NULL || rows == NULL) {
        status = bp_fail(err, BP_ERR_MEMORY, "no memory for the self-test");
        goto cleanup;
    }
    make_inputs(in);
    BP_TRY_GOTO(status, assemble(device, kernel_text, &source, err), cleanup);
    BP_TRY_GOTO(status, bp_device_build(device, source, NULL, &program, NULL, err), cleanup);
    BP_TRY_GOTO(status, launch(device, program, in, rows, rows_size, err), cleanup);
    compare(in, rows, device->info.has_double, &failures, story, sizeof story);
    if (failures > 0)
        status =
            bp_fail_with(BP_REMEDY_OR_OTHER_DEVICE, err, BP_ERR_DEVICE,
                         "device %u (%s, driver %s) failed its self-test, so its pictures could be wrong: %s "
                         "is wrong%s; use another version of the driver",
                         device->info.number, device->info.name, device->info.driver, story,
                         failures > 1 ? ", and more" : "");

cleanup:
    if (program != NULL) clReleaseProgram(program);
    free(source);
    free(in);
    free(rows);
    return status;
}
