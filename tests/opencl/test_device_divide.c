/* test_device_divide.c: the kernels' own quotients and roots on a device, in one lane, in those of a node and
 * in those of a packet, against this processor's. The device is made worse than it is, by 3 units in the last
 * place.
 *
 * test_divide.c takes all the cases that are hard, in C; here are some of them, and those that compilers and
 * vectors could treat differently. */
#include "opencl/program.h"

#include "base/float_bits.h"
#include "base/random.h"
#include "support/device.h"
#include "support/unit_test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { COUNT = 1 << 16, LANES = 16, KINDS = 3 };

static const char start[] = "#define OWN_ROUNDING 1\n#define REAL_IS_DOUBLE 0\n#define REFINE_IS_DOUBLE 0\n"
                            "#define TREE_WIDTH 8\n#define PACKET_LANES 16\n";
static const char *const worse[] = {
    "#define DEVICE_QUOTIENT(a, b) real_of_bits(bits_of_real((a) / (b)) + 3u)\n"
    "#define DEVICE_ROOT(x) real_of_bits(bits_of_real(sqrt(x)) - 3u)\n",
    "#define DEVICE_QUOTIENT(a, b) real_of_bits(bits_of_real((a) / (b)) - 1u)\n"
    "#define DEVICE_ROOT(x) real_of_bits(bits_of_real(sqrt(x)) + 1u)\n",
    "#define DEVICE_QUOTIENT(a, b) real_of_bits(bits_of_real((a) / (b)) + 1u)\n"
    "#define DEVICE_ROOT(x) real_of_bits(bits_of_real(sqrt(x)) - 1u)\n",
};
static const char probe[] =
    "__kernel void probe(__global const float *a, __global const float *b, __global float *quotients,\n"
    "                    __global float *roots) {\n"
    "    const uint first = (uint)get_global_id(0) * 16u, count = (uint)get_global_size(0) * 16u;\n"
    "    for (uint i = first; i < first + 16u; ++i) {\n"
    "        quotients[i] = divide_one(a[i], b[i]);\n"
    "        roots[i] = square_root_one(a[i]);\n"
    "    }\n"
    "    for (uint i = first; i < first + 16u; i += 8u) {\n"
    "        vstore8(divide_node(vload8(0, a + i), vload8(0, b + i)), 0, quotients + count + i);\n"
    "        vstore8(square_root_node(vload8(0, a + i)), 0, roots + count + i);\n"
    "    }\n"
    "    vstore16(divide_packet(vload16(0, a + first), vload16(0, b + first)), 0, quotients + 2 * count + "
    "first);\n"
    "    vstore16(square_root_packet(vload16(0, a + first)), 0, roots + 2 * count + first);\n"
    "}\n";

/* Mantissas that round badly, at random exponents; any bits; quotients around the least normal number, with
 * ties; lanes that are all usual, and such among others. */
static void make_pairs(float *a, float *b) {
    static const uint32_t mantissas[] = {0,         1,         0x400000u, 0x400001u,
                                         0x600000u, 0x7ffffeu, 0x7fffffu, 0x2aaaaau};
    BpRandom random = {7};
    for (size_t i = 0; i < COUNT; ++i) {
        const uint64_t word = bp_random_bits(&random);
        const uint32_t low = (uint32_t)word, high = (uint32_t)(word >> 32);
        switch (i / 64 % 4) {
        case 0:
            a[i] = bp_bits_float((low & 0x807fffffu) | (90u + (low >> 23 & 63u)) << 23);
            b[i] =
                bp_bits_float((high & 0x80000000u) | (90u + (high >> 23 & 63u)) << 23 | mantissas[high & 7u]);
            break;
        case 1:
            a[i] = bp_bits_float(low);
            b[i] = bp_bits_float(high);
            break;
        case 2:
            a[i] = bp_bits_float((low & 0x80000000u) | (low >> 8 & 31u) << 23 | mantissas[low & 7u]);
            b[i] = bp_bits_float((high & 0x80000000u) | (110u + (high >> 8 & 31u)) << 23 |
                                 (high % 3 ? 0 : mantissas[high & 7u]));
            break;
        default:
            a[i] = bp_bits_float((low & 0x007fffffu) | (126u + (low >> 30)) << 23);
            b[i] = bp_bits_float((high & 0x007fffffu) | 127u << 23);
        }
    }
}

static char *assemble(const char *device) {
    static const char *const files[] = {
        "dialect/real.cl",   "dialect/lanes_one.cl",    "dialect/lanes.cl", "dialect/lane_by_lane.cl",
        "dialect/divide.cl", "dialect/lanes_node.cl",   "dialect/lanes.cl", "dialect/lane_by_lane.cl",
        "dialect/divide.cl", "dialect/lanes_packet.cl", "dialect/lanes.cl", "dialect/lane_by_lane.cl",
        "dialect/divide.cl"};
    char *source = malloc(sizeof start + strlen(device));
    assert_non_null(source);
    strcat(strcpy(source, start), device);
    for (size_t f = 0; f <= sizeof files / sizeof files[0]; ++f) {
        char *text = NULL;
        if (f == sizeof files / sizeof files[0])
            text = strdup(probe);
        else
            assert_int_equal(bp_kernel_text(files[f], &text, NULL), BP_OK);
        char *longer = malloc(strlen(source) + strlen(text) + 1);
        assert_non_null(longer);
        strcat(strcpy(longer, source), text);
        free(source);
        free(text);
        source = longer;
    }
    return source;
}

static cl_mem buffer(const BpDevice *device, size_t count, float *from) {
    cl_int code;
    cl_mem made =
        clCreateBuffer(device->context, CL_MEM_READ_WRITE | (from != NULL ? CL_MEM_COPY_HOST_PTR : 0),
                       count * sizeof(float), from, &code);
    assert_int_equal(code, CL_SUCCESS);
    return made;
}

static void compare(const char *what, const float *a, const float *b, const float *found) {
    static const char *const kinds[KINDS] = {"one lane", "a node", "a packet"};
    for (size_t i = 0; i < (size_t)KINDS * COUNT; ++i) {
        const float x = a[i % COUNT], right = b != NULL ? x / b[i % COUNT] : sqrtf(x);
        if (bp_float_bits(found[i]) == bp_float_bits(right) || (isnan(found[i]) && isnan(right))) continue;
        fail_msg("%s in %s: of %a and %a it is %a, not %a", what, kinds[i / COUNT], (double)x,
                 b != NULL ? (double)b[i % COUNT] : 0.0, (double)right, (double)found[i]);
    }
}

static void try_device(BpDevice *device, const char *as_bad) {
    BpError err = {0};
    cl_program program = NULL;
    char *source = assemble(as_bad), *log = NULL;
    float *a = calloc(COUNT, sizeof *a), *b = calloc(COUNT, sizeof *b);
    float *out = calloc((size_t)KINDS * COUNT, sizeof *out);
    assert_true(a != NULL && b != NULL && out != NULL);
    make_pairs(a, b);
    if (bp_device_build(device, source, NULL, &program, &log, &err) != BP_OK)
        fail_msg("%s\n%s", err.message, err.attachment != NULL ? err.attachment : "");
    cl_int code;
    cl_kernel kernel = clCreateKernel(program, "probe", &code);
    assert_int_equal(code, CL_SUCCESS);
    cl_mem buffers[4] = {buffer(device, COUNT, a), buffer(device, COUNT, b),
                         buffer(device, (size_t)KINDS * COUNT, NULL),
                         buffer(device, (size_t)KINDS * COUNT, NULL)};
    for (cl_uint i = 0; i < 4; ++i)
        assert_int_equal(clSetKernelArg(kernel, i, sizeof buffers[i], &buffers[i]), CL_SUCCESS);
    const size_t items = COUNT / LANES;
    assert_int_equal(clEnqueueNDRangeKernel(device->queue, kernel, 1, NULL, &items, NULL, 0, NULL, NULL),
                     CL_SUCCESS);
    for (int i = 2; i < 4; ++i) {
        assert_int_equal(clEnqueueReadBuffer(device->queue, buffers[i], CL_TRUE, 0,
                                             sizeof(float) * KINDS * COUNT, out, 0, NULL, NULL),
                         CL_SUCCESS);
        compare(i == 2 ? "a quotient" : "a root", a, i == 2 ? b : NULL, out);
    }
    for (int i = 0; i < 4; ++i) clReleaseMemObject(buffers[i]);
    clReleaseKernel(kernel);
    clReleaseProgram(program);
    free(source);
    free(log);
    free(a);
    free(b);
    free(out);
}

static void as_this_processor_has_them(void **state) {
    for (size_t i = 0; i < sizeof worse / sizeof worse[0]; ++i) try_device(*state, worse[i]);
}

int main(void) {
    BpDevice *device = NULL;
    const int missing = test_device_open(&device);
    if (missing != 0) return missing;
    cl_device_fp_config config = 0;
    clGetDeviceInfo(device->id, CL_DEVICE_SINGLE_FP_CONFIG, sizeof config, &config, NULL);
    if ((config & CL_FP_DENORM) == 0) {
        fprintf(stderr, "skipped: %s takes subnormal floats for 0\n", device->info.name);
        return 77;
    }
    const struct CMUnitTest tests[] = {cmocka_unit_test_prestate(as_this_processor_has_them, device)};
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    bp_device_close(&device);
    return failed;
}
