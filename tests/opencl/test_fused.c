/* test_fused.c: a * b + c of kernels, where the processor has no instruction for it, against this
 * processor's: in one lane, and in 2, 4, 8 and 16, in both precisions. And that loose_fma rounds both the
 * product and the sum there.
 *
 * PoCL is told to compile for SSE4.1, so any processor of that family will do. */
#include "opencl/program.h"

#include "base/float_bits.h"
#include "base/random.h"
#include "support/device.h"
#include "support/unit_test.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { COUNT = 1 << 16, LANES = 16, KINDS = 6, LOOSE = 5 };

static const char head[] = "#define OWN_ROUNDING 0\n#define REAL_IS_DOUBLE 0\n#define REFINE_IS_DOUBLE 1\n";
/* Written once for each precision. */
static const char probe[] =
    "#define PROBE(type) \\\n"
    "    __kernel void probe_##type(__global const type *a, __global const type *b, \\\n"
    "                               __global const type *c, __global type *out) { \\\n"
    "        const uint first = (uint)get_global_id(0) * 16u, count = (uint)get_global_size(0) * 16u; \\\n"
    "        for (uint i = first; i < first + 16u; ++i) out[i] = fma(a[i], b[i], c[i]); \\\n"
    "        WIDTH(2, 1) WIDTH(4, 2) WIDTH(8, 3) WIDTH(16, 4) \\\n"
    "        for (uint i = first; i < first + 16u; ++i) \\\n"
    "            out[5 * count + i] = loose_fma(a[i], b[i], c[i]); \\\n"
    "    }\n"
    "#define WIDTH(n, kind) \\\n"
    "    for (uint i = first; i < first + 16u; i += n) \\\n"
    "        vstore##n(fma(vload##n(0, a + i), vload##n(0, b + i), vload##n(0, c + i)), 0, \\\n"
    "                  out + kind * count + i);\n"
    "PROBE(float)\n"
    "PROBE(double)\n"
    "__kernel void is_own(__global int *answer) {\n"
    "#ifdef OVERLOADED\n"
    "    *answer = 1;\n"
    "#else\n"
    "    *answer = 0;\n"
    "#endif\n"
    "}\n";

static const char *const kinds[KINDS] = {"one lane", "2 lanes", "4 lanes", "8 lanes", "16 lanes", "loose"};

/* A number of `bits` bits with an exponent of at most `range` in magnitude. */
static double number(BpRandom *random, int bits, int range) {
    const uint64_t word = bp_random_bits(random);
    const double mantissa = (double)(word >> (64 - bits) | 1), sign = word & 1 ? -1 : 1;
    return sign * ldexp(mantissa, (int)(word >> 1 & 0xffff) % (2 * range + 1) - range - bits);
}

/* Sums that cancel, all but for a few last digits; products between two numbers, where the rest decides;
 * results that are subnormal; the usual; any bits. `digits`: 24 or 53, and `least` is the exponent of the
 * least positive number. */
static void make_triple(BpRandom *random, size_t i, int digits, int least, double of[3]) {
    switch (i / 64 % 4) {
    case 0: /* of the usual size, and so small that digits of the product are lost */
        of[0] = number(random, digits, 40);
        of[1] = number(random, digits, 40);
        if (i % 2 == 0) of[0] *= ldexp(1, least * 12 / 25), of[1] *= ldexp(1, least * 12 / 25);
        of[2] = -of[0] * of[1] * (1 + ldexp((double)(bp_random_bits(random) % 9) - 4, -digits));
        break;
    case 1: /* the product has a digit more than fits, or two */
        of[0] = number(random, digits / 2, 0);
        of[1] = number(random, digits - digits / 2 + 1, 0);
        of[2] = i % 8 == 0 ? 0 : number(random, i % 8 < 4 ? 1 : digits, 0) * ldexp(1, -(int)(i % 61) * 2);
        break;
    case 2:
        of[0] = number(random, digits, 0) * ldexp(1, least / 2);
        of[1] = number(random, digits, 0) * ldexp(1, least / 2 + (int)(i % 32));
        of[2] = number(random, digits, 0) * ldexp(1, least + (int)(i % 29));
        break;
    default:
        of[0] = number(random, digits, 9), of[1] = number(random, digits, 9),
        of[2] = number(random, digits, 18);
    }
}

/* What is no usual number, for one triple in 16: infinities, zeros, not a number, the largest. */
static double special(BpRandom *random, double largest) {
    const double of[] = {INFINITY, -INFINITY, 0.0, -0.0, (double)NAN, largest, -largest, 1.0};
    return of[bp_random_bits(random) >> 61];
}

static double double_of_bits(uint64_t bits) {
    double number;
    memcpy(&number, &bits, sizeof number);
    return number;
}

static cl_mem buffer(const BpDevice *device, size_t size, void *from) {
    cl_int code;
    cl_mem made = clCreateBuffer(
        device->context, CL_MEM_READ_WRITE | (from != NULL ? CL_MEM_COPY_HOST_PTR : 0), size, from, &code);
    assert_int_equal(code, CL_SUCCESS);
    return made;
}

/* Runs a kernel of three inputs and an output, which it returns; the caller frees it. */
static void *run(const BpDevice *device, cl_program program, const char *name, size_t size,
                 void *const in[3]) {
    cl_int code;
    cl_kernel kernel = clCreateKernel(program, name, &code);
    assert_int_equal(code, CL_SUCCESS);
    void *out = calloc((size_t)KINDS * COUNT, size);
    assert_non_null(out);
    cl_mem buffers[4];
    for (cl_uint i = 0; i < 4; ++i) {
        buffers[i] = buffer(device, (i < 3 ? 1u : KINDS) * (size_t)COUNT * size, i < 3 ? in[i] : NULL);
        assert_int_equal(clSetKernelArg(kernel, i, sizeof buffers[i], &buffers[i]), CL_SUCCESS);
    }
    const size_t items = COUNT / LANES;
    assert_int_equal(clEnqueueNDRangeKernel(device->queue, kernel, 1, NULL, &items, NULL, 0, NULL, NULL),
                     CL_SUCCESS);
    assert_int_equal(clEnqueueReadBuffer(device->queue, buffers[3], CL_TRUE, 0, (size_t)KINDS * COUNT * size,
                                         out, 0, NULL, NULL),
                     CL_SUCCESS);
    for (int i = 0; i < 4; ++i) clReleaseMemObject(buffers[i]);
    clReleaseKernel(kernel);
    return out;
}

typedef struct Probe {
    BpDevice *device;
    cl_program program;
} Probe;

static void floats(void **state) {
    const Probe *probed = *state;
    BpRandom random = {7};
    float *in[3];
    for (int k = 0; k < 3; ++k) assert_non_null(in[k] = calloc(COUNT, sizeof(float)));
    for (size_t i = 0; i < COUNT; ++i) {
        double of[3];
        make_triple(&random, i, 24, -149, of);
        for (int k = 0; k < 3; ++k)
            in[k][i] = i % 16 == 5   ? bp_bits_float((uint32_t)bp_random_bits(&random))
                       : i % 16 == 6 ? (float)special(&random, (double)FLT_MAX)
                                     : (float)of[k];
    }
    float *out =
        run(probed->device, probed->program, "probe_float", sizeof *out, (void *[]){in[0], in[1], in[2]});
    for (size_t i = 0; i < (size_t)KINDS * COUNT; ++i) {
        const float a = in[0][i % COUNT], b = in[1][i % COUNT], c = in[2][i % COUNT];
        const float right = i / COUNT == LOOSE ? a * b + c : fmaf(a, b, c);
        if (bp_float_bits(out[i]) != bp_float_bits(right) && !(isnan(out[i]) && isnan(right)))
            fail_msg("%s: %a * %a + %a is %a, not %a", kinds[i / COUNT], (double)a, (double)b, (double)c,
                     (double)right, (double)out[i]);
    }
    for (int k = 0; k < 3; ++k) free(in[k]);
    free(out);
}

static void doubles(void **state) {
    const Probe *probed = *state;
    BpRandom random = {8};
    double *in[3];
    for (int k = 0; k < 3; ++k) assert_non_null(in[k] = calloc(COUNT, sizeof(double)));
    for (size_t i = 0; i < COUNT; ++i) {
        double of[3];
        make_triple(&random, i, 53, -1074, of);
        for (int k = 0; k < 3; ++k)
            in[k][i] = i % 16 == 5   ? double_of_bits(bp_random_bits(&random))
                       : i % 16 == 6 ? special(&random, DBL_MAX)
                                     : of[k];
    }
    double *out =
        run(probed->device, probed->program, "probe_double", sizeof *out, (void *[]){in[0], in[1], in[2]});
    for (size_t i = 0; i < (size_t)KINDS * COUNT; ++i) {
        const double a = in[0][i % COUNT], b = in[1][i % COUNT], c = in[2][i % COUNT];
        const double right = i / COUNT == LOOSE ? a * b + c : fma(a, b, c);
        if (memcmp(&out[i], &right, sizeof right) != 0 && !(isnan(out[i]) && isnan(right)))
            fail_msg("%s: %a * %a + %a is %a, not %a", kinds[i / COUNT], a, b, c, right, out[i]);
    }
    for (int k = 0; k < 3; ++k) free(in[k]);
    free(out);
}

static bool is_own(const Probe *probed) {
    cl_int code, answer = 0;
    cl_kernel kernel = clCreateKernel(probed->program, "is_own", &code);
    assert_int_equal(code, CL_SUCCESS);
    cl_mem memory = buffer(probed->device, sizeof answer, &answer);
    const size_t one = 1;
    assert_int_equal(clSetKernelArg(kernel, 0, sizeof memory, &memory), CL_SUCCESS);
    assert_int_equal(
        clEnqueueNDRangeKernel(probed->device->queue, kernel, 1, NULL, &one, NULL, 0, NULL, NULL),
        CL_SUCCESS);
    assert_int_equal(
        clEnqueueReadBuffer(probed->device->queue, memory, CL_TRUE, 0, sizeof answer, &answer, 0, NULL, NULL),
        CL_SUCCESS);
    clReleaseMemObject(memory);
    clReleaseKernel(kernel);
    return answer != 0;
}

int main(void) {
    setenv("POCL_KERNELLIB_NAME", "sse41", 1);
    Probe probed = {0};
    const int missing = test_device_open(&probed.device);
    if (missing != 0) return missing;
    if (!probed.device->info.has_double) {
        fprintf(stderr, "skipped: %s has no double precision\n", probed.device->info.name);
        return 77;
    }
    char *real = NULL, *fused = NULL, *source = NULL;
    BpError err = {0};
    if (bp_kernel_text("dialect/real.cl", &real, &err) != BP_OK ||
        bp_kernel_text("dialect/fused.cl", &fused, &err) != BP_OK)
        return fprintf(stderr, "%s\n", err.message), 1;
    const size_t size = strlen(head) + strlen(real) + strlen(fused) + strlen(probe) + 1;
    if ((source = malloc(size)) == NULL) return 1;
    snprintf(source, size, "%s%s%s%s", head, real, fused, probe);
    if (bp_device_build(probed.device, source, NULL, &probed.program, NULL, &err) != BP_OK)
        return fprintf(stderr, "%s\n%s", err.message, err.attachment != NULL ? err.attachment : ""), 1;
    int failed = 77;
    if (!is_own(&probed))
        fprintf(stderr, "skipped: %s compiles for a processor with a fused multiply-add\n",
                probed.device->info.name);
    else {
        const struct CMUnitTest tests[] = {cmocka_unit_test_prestate(floats, &probed),
                                           cmocka_unit_test_prestate(doubles, &probed)};
        failed = cmocka_run_group_tests(tests, NULL, NULL);
    }
    clReleaseProgram(probed.program);
    bp_device_close(&probed.device);
    free(real);
    free(fused);
    free(source);
    return failed;
}
