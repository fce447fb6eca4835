/* test_device_self_test.c: a right device passes, every kind of wrong one is named, and a pass is remembered.
 *
 * Wrong devices are made by breaking the kernel's text in one place: what the host then sees is what a driver
 * with that fault would answer. */
#include "opencl/program.h"
#include "opencl/self_test.h"
#include "support/device.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

/* `text` with the one occurrence of `from` replaced; heap. */
static char *replace(const char *text, const char *from, const char *to) {
    const char *at = strstr(text, from);
    if (at == NULL || strstr(at + 1, from) != NULL)
        fail_msg("'%s' does not stand in the kernel exactly once", from);
    char *changed = malloc(strlen(text) + strlen(to) + 1);
    assert_non_null(changed);
    sprintf(changed, "%.*s%s%s", (int)(at - text), text, to, at + strlen(from));
    return changed;
}

static void a_right_device_passes(void **state) {
    BpError err = {0};
    if (bp_self_test_run(*state, NULL, &err) != BP_OK)
        fail_msg("%s\n%s", err.message, err.attachment ? err.attachment : "");
}

static void every_fault_is_named(void **state) {
    BpDevice *device = *state;
    static const struct {
        const char *from, *to, *named;
        bool needs_double;
    } faults[] = {
        {"mul_hi(m, n) - popcount(m)", "mul_hi(m, n) - popcount(n)", "32-bit integer arithmetic", false},
        {"(ulong)m * (ulong)n", "(ulong)(m * n)", "64-bit integer arithmetic", false},
        {"convert_long_rte(a * 65536.0f)", "(long)convert_int_rte(a * 65536.0f)", "64-bit integers", false},
        {"const uint node = stack[--top]", "const uint node = stack[--top] | (top == 5u)", "private array",
         false},
        {"0x1p-24f", "0x1.000002p-24f", "uniform numbers", false},
        {"as_uint(a + b)", "as_uint(a + b) + (item == 400u)", "rounding of a + b", false},
        {"row[COLUMN_PRODUCT] = as_uint(a * b)", "row[COLUMN_PRODUCT] = as_uint(a * b) ^ 1u",
         "rounding of a * b", false},
        {"as_uint(a * b - rounded)", "as_uint(fma(a, b, -rounded))", "a * b - c is fused although", false},
        {"as_uint(rounded - a * b)", "as_uint(fma(-a, b, rounded))", "a * b - c is fused although", false},
        {"(v * w - rounded)", "fma(v, w, -rounded)", "in vectors is fused although", false},
        {"(rounded - v * w)", "fma(-v, w, rounded)", "in vectors is fused although", false},
        {"as_uint(fma(a, b, c))", "as_uint(a * b + c)", "fma(a, b, c)", false},
        {"as_uint(fma(a, b, -rounded))", "as_uint(a * b - rounded)", "exact error of a product", false},
        {"as_uint(a / b)", "as_uint(a / b) + 4u", "a / b within 2.5", false},
        {"as_uint(sqrt(fabs(a)))", "as_uint(sqrt(fabs(a))) - 4u", "sqrt(a) within 3", false},
        {"(a - a_part) + (b - b_part)", "zero", "exact error of a sum", false},
        {"if (!(nan_value >= zero)) bits |= 1u;", "", "NaN and infinities", false},
        {"floats[4];", "zero;", "bits of a NaN", false},
        {"v < (float8)(limit)", "v < (float8)(0.0f)", "vectors of eight", false},
        {"fma(x, y, -(x * y))).x", "x * y - (x * y)).x", "product of doubles", true},
        {"as_uint2(x / y).x ^", "as_uint2((double)((float)x / (float)y)).x ^", "x / y in double", true},
        {"as_uint2(sqrt(fabs(x))).x ^", "as_uint2((double)sqrt((float)fabs(x))).x ^", "sqrt(x) in double",
         true},
        {"(float)(x * y - as_double", "(float)(fma(x, y, -as_double", NULL, true}, /* completed below */
    };
    const char *text = bp_kernel_file("entry/self_test.cl");
    assert_non_null(text);
    for (size_t i = 0; i < sizeof faults / sizeof faults[0]; ++i) {
        if (faults[i].needs_double && !device->info.has_double) continue;
        BpError err = {0};
        char *broken = replace(text, faults[i].from, faults[i].to);
        const char *named = faults[i].named;
        if (named == NULL) {
            char *completed =
                replace(broken, "(ulong)as_uint(zero)))) << 1", "(ulong)as_uint(zero))))) << 1");
            free(broken);
            broken = completed;
            named = "in double is fused";
        }
        if (bp_self_test_run(device, broken, &err) != BP_ERR_DEVICE)
            fail_msg("'%s' for '%s' is not found: %s", faults[i].to, faults[i].from, err.message);
        if (strstr(err.message, named) == NULL) fail_msg("'%s' does not name '%s'", err.message, named);
        if (strstr(err.message, device->info.name) == NULL ||
            strstr(err.message, device->info.driver) == NULL || err.remedy != BP_REMEDY_OR_OTHER_DEVICE)
            fail_msg("'%s' lacks the device, its driver or the remedy", err.message);
        bp_error_clear(&err);
        free(broken);
    }
}

/* What kernels divide by is rounded correctly, or the device is refused: the bits of pictures rest on that.
 * What the device says itself may be off by a little. */
static void quotients_are_rounded(void **state) {
    BpDevice *device = *state;
    static const struct {
        const char *from, *to, *named;
    } faults[] = {
        {"as_uint(divide(a, b))", "as_uint(divide(a, b)) + (item == 77u)", "rounding of a / b"},
        {"as_uint(divide(a, b))", "as_uint(a * (1.0f / b))", "rounding of a / b"},
        {"as_uint(square_root(fabs(a)))", "as_uint(sqrt(fabs(a))) - (item == 3u)", "rounding of sqrt(a)"},
        {"as_uint(square_root(fabs(a)))", "as_uint(fabs(a) / sqrt(fabs(a)))", "rounding of sqrt(a)"},
        {"as_uint(a / b)", "as_uint(a / b) + 1u", NULL},
        {"as_uint(sqrt(fabs(a)))", "as_uint(sqrt(fabs(a))) - 2u", NULL}};
    for (size_t i = 0; i < sizeof faults / sizeof faults[0]; ++i) {
        BpError err = {0};
        char *broken = replace(bp_kernel_file("entry/self_test.cl"), faults[i].from, faults[i].to);
        const BpStatus status = bp_self_test_run(device, broken, &err);
        if (status != (faults[i].named != NULL ? BP_ERR_DEVICE : BP_OK))
            fail_msg("'%s': %s", faults[i].to, err.message);
        if (faults[i].named != NULL && strstr(err.message, faults[i].named) == NULL)
            fail_msg("'%s' does not name '%s'", err.message, faults[i].named);
        bp_error_clear(&err);
        free(broken);
    }
}

static void what_cannot_be_built_is_a_build_error(void **state) {
    BpError err = {0};
    assert_int_equal(bp_self_test_run(*state, "__kernel void self_test(__global int *x) { x = y; }", &err),
                     BP_ERR_BUILD);
    assert_non_null(err.attachment);
    bp_error_clear(&err);
    assert_int_equal(bp_self_test_run(*state, "__kernel void other(__global int *x) { x[0] = 1; }", &err),
                     BP_ERR_DEVICE);
    assert_non_null(strstr(err.message, "clCreateKernel(self_test) failed with CL_INVALID_KERNEL_NAME"));
    bp_error_clear(&err);
}

/* A kernel that writes nothing is no pass. */
static void silence_is_a_failure(void **state) {
    BpError err = {0};
    assert_int_equal(
        bp_self_test_run(*state,
                         "__kernel void self_test(__global const uint *a, __global const float *b,\n"
                         "                        __global uint *c) {}\n",
                         &err),
        BP_ERR_DEVICE);
    assert_non_null(strstr(err.message, "failed its self-test"));
    assert_non_null(strstr(err.message, "and more"));
    bp_error_clear(&err);
}

static bool runs_now(BpDevice *device) {
    bool ran = false;
    BpError err = {0};
    if (bp_self_test_once(device, &ran, &err) != BP_OK) fail_msg("%s", err.message);
    return ran;
}

static void a_pass_is_remembered(void **state) {
    BpDevice *device = *state;
    char folder[] = "/tmp/ballpark-self-test-XXXXXX";
    assert_non_null(mkdtemp(folder));
    assert_int_equal(setenv("XDG_CACHE_HOME", folder, 1), 0);
    assert_true(runs_now(device));
    assert_false(runs_now(device));
    char *path = bp_self_test_memory_path(device);
    assert_non_null(path);
    assert_int_equal(strncmp(path, folder, strlen(folder)), 0);

    /* Another driver version has a memory of its own. */
    BpDevice other = *device;
    snprintf(other.info.driver, sizeof other.info.driver, "other");
    char *other_path = bp_self_test_memory_path(&other);
    assert_string_not_equal(path, other_path);

    /* A file that says anything else is no memory, and is put right. */
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    fputs("This device passed", file);
    fclose(file);
    assert_true(runs_now(device));
    assert_false(runs_now(device));

    assert_int_equal(unlink(path), 0);
    char below[64];
    snprintf(below, sizeof below, "%s/ballpark", folder);
    assert_int_equal(rmdir(below), 0); /* nothing else was left there */
    assert_int_equal(rmdir(folder), 0);
    free(path);
    free(other_path);
}

/* Whoever opens a pipe waits for its other end: it is no memory, and a file replaces it. A folder stays. */
static void what_is_no_regular_file_is_no_memory(void **state) {
    BpDevice *device = *state;
    char folder[] = "/tmp/ballpark-self-test-XXXXXX", below[64];
    struct stat kind;
    assert_non_null(mkdtemp(folder));
    assert_int_equal(setenv("XDG_CACHE_HOME", folder, 1), 0);
    snprintf(below, sizeof below, "%s/ballpark", folder);
    assert_int_equal(mkdir(below, 0700), 0);
    char *path = bp_self_test_memory_path(device);
    alarm(300); /* only so that a hang is a failure */
    assert_int_equal(mkfifo(path, 0600), 0);
    assert_true(runs_now(device));
    assert_false(runs_now(device));
    assert_int_equal(stat(path, &kind), 0);
    assert_true(S_ISREG(kind.st_mode));
    assert_int_equal(unlink(path), 0);
    assert_int_equal(mkdir(path, 0700), 0);
    assert_true(runs_now(device));
    assert_true(runs_now(device));
    assert_int_equal(rmdir(path), 0);
    alarm(0);
    assert_int_equal(rmdir(below), 0);
    assert_int_equal(rmdir(folder), 0);
    free(path);
}

static void a_cache_that_cannot_be_written_is_tolerated(void **state) {
    BpDevice *device = *state;
    assert_int_equal(setenv("XDG_CACHE_HOME", "/dev/null/nowhere", 1), 0);
    assert_true(runs_now(device));
    assert_true(runs_now(device));
}

static void without_xdg_the_home_counts(void **state) {
    BpDevice *device = *state;
    assert_int_equal(setenv("HOME", "/home/of/nobody", 1), 0);
    static const char *const ignored[] = {"", "relative"};
    for (size_t i = 0; i < 2; ++i) {
        assert_int_equal(setenv("XDG_CACHE_HOME", ignored[i], 1), 0);
        char *path = bp_self_test_memory_path(device);
        assert_non_null(path);
        assert_non_null(strstr(path, "/home/of/nobody/.cache/ballpark/self-test-"));
        free(path);
    }
    assert_int_equal(unsetenv("HOME"), 0);
    assert_null(bp_self_test_memory_path(device));
    assert_true(runs_now(device));
}

int main(void) {
    BpDevice *device = NULL;
    const int missing = test_device_open(&device);
    if (missing != 0) return missing;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_prestate(a_right_device_passes, device),
        cmocka_unit_test_prestate(every_fault_is_named, device),
        cmocka_unit_test_prestate(quotients_are_rounded, device),
        cmocka_unit_test_prestate(what_cannot_be_built_is_a_build_error, device),
        cmocka_unit_test_prestate(silence_is_a_failure, device),
        cmocka_unit_test_prestate(a_pass_is_remembered, device),
        cmocka_unit_test_prestate(what_is_no_regular_file_is_no_memory, device),
        cmocka_unit_test_prestate(a_cache_that_cannot_be_written_is_tolerated, device),
        cmocka_unit_test_prestate(without_xdg_the_home_counts, device),
    };
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    bp_device_close(&device);
    return failed;
}
