/* test_device_find.c: choosing, refusing, opening and building, against a driver made for the test
 * (fake_icd.c).
 */
#include "opencl/device.h"

#include "base/clock.h"
#include "base/hash.h"
#include "opencl/pocl.h"
#include "opencl/program.h"
#include "opencl/self_test.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

static void assert_contains(const char *text, const char *part) {
    if (strstr(text, part) == NULL) fail_msg("'%s' does not contain '%s'", text, part);
}

static void with(const char *devices) {
    assert_int_equal(setenv("FAKE_DEVICES", devices, 1), 0);
}

/* `text` means device `number`. */
static void expect(const char *devices, const char *text, unsigned number) {
    BpDeviceInfo device;
    BpError err = {0};
    with(devices);
    if (bp_device_find(text, &device, &err) != BP_OK)
        fail_msg("%s, '%s': %s", devices, text != NULL ? text : "(default)", err.message);
    if (device.number != number)
        fail_msg("%s, '%s': device %u, not %u", devices, text != NULL ? text : "(default)", device.number,
                 number);
}

/* `text` is an error whose message contains `part`. */
static void expect_error(const char *devices, const char *text, const char *part) {
    BpDeviceInfo device;
    BpError err = {0};
    with(devices);
    if (bp_device_find(text, &device, &err) == BP_OK)
        fail_msg("%s, '%s': device %u instead of an error", devices, text != NULL ? text : "(default)",
                 device.number);
    assert_int_equal(err.code, BP_ERR_DEVICE);
    assert_contains(err.message, part);
    bp_error_clear(&err);
}

static void lists_every_platform(void **state) {
    (void)state;
    BpDeviceInfo *list = NULL;
    size_t count = 0;
    BpError err = {0};
    with("gpu=Big Card,cpu|accelerator");
    assert_int_equal(bp_devices_list(&list, &count, &err), BP_OK);
    assert_int_equal(count, 3);
    for (unsigned i = 0; i < 3; ++i) assert_int_equal(list[i].number, i);
    assert_string_equal(list[0].name, "Big Card");
    assert_string_equal(list[0].platform, "Fake One");
    assert_string_equal(list[0].driver, "7.5");
    assert_int_equal(list[0].type, BP_DEVICE_GPU);
    assert_true(list[0].has_double && list[0].has_compiler && list[0].available);
    assert_int_equal(list[0].compute_units, 6);
    assert_int_equal(list[0].memory_bytes, 1u << 30);
    assert_int_equal(list[0].largest_allocation_bytes, 1u << 28);
    assert_string_equal(list[0].refusal, "");
    assert_int_equal(list[1].type, BP_DEVICE_CPU);
    assert_string_equal(list[2].platform, "Fake Two");
    assert_int_equal(list[2].type, BP_DEVICE_OTHER);
    assert_false(list[2].has_double);
    free(list);
}

static void tolerates_platforms_without_devices(void **state) {
    (void)state;
    BpDeviceInfo *list = NULL;
    size_t count = 1;
    BpError err = {0};
    with("");
    assert_int_equal(bp_devices_list(&list, &count, &err), BP_OK);
    assert_int_equal(count, 0);
    free(list);
    expect("|gpu", NULL, 0);
    expect_error("", NULL, "Fake One, Fake Two");
    expect_error("", "0", "apt install pocl-opencl-icd");
    expect_error("", NULL, "clinfo");
}

static void prefers_a_gpu_that_can_render(void **state) {
    (void)state;
    expect("cpu,gpu", NULL, 1);
    expect("cpu|gpu", "", 1);
    expect("cpu,old|no-compiler", NULL, 0);
    expect("accelerator,cpu", NULL, 1);
    expect("accelerator", NULL, 0);
    expect_error("old|away", NULL, "1: away (Fake Two, driver 7.5), cannot render: it is not available now");
}

static void prefers_the_most_capable_gpu(void **state) {
    (void)state;
    expect("integrated,small", NULL, 1); /* fewer units, less memory, but its own */
    expect("integrated|small", NULL, 1);
    expect("small|integrated", NULL, 0);
    expect("integrated,cpu", NULL, 0);
    expect("small,large", NULL, 1);
    expect("large,small", NULL, 0);
    expect("roomy,large", NULL, 1); /* of one platform by units and clock */
    expect("roomy|large", NULL, 0); /* of two by memory */
    expect("large|roomy", NULL, 1);
    expect("small,roomy|large", NULL, 1);
    expect("large|roomy,small", NULL, 1);
    expect("small|large", NULL, 1); /* as much memory */
    expect("large,large", NULL, 0);
    expect("large=A|large=B", NULL, 0);
    expect("cpu,integrated,small|large,roomy", "gpu", 3);
    expect("old=Large,small", NULL, 1);
    expect("integrated,large", "integrated", 0); /* who asks for one gets it */
}

static void an_old_pocl_must_know_the_processor(void **state) {
    (void)state;
    assert_true(bp_pocl_is_too_old("3.0-rc2", "pthread-AMD EPYC", "AMD EPYC"));
    assert_true(bp_pocl_is_too_old("1.8", "pthread-Intel(R) Xeon(R) 6", "Intel(R) Xeon(R) 6"));
    assert_true(bp_pocl_is_too_old("3.0", "basic-AMD EPYC", "AMD EPYC"));
    assert_false(bp_pocl_is_too_old("3.0", "pthread-znver3-AMD EPYC", "AMD EPYC"));
    assert_false(bp_pocl_is_too_old("3.1+debian", "pthread-AMD EPYC", "AMD EPYC"));
    assert_false(bp_pocl_is_too_old("5.0", "cpu-AMD EPYC", "AMD EPYC"));
    assert_false(bp_pocl_is_too_old("3.0", "pthread-AMD EPYC", ""));
    assert_false(bp_pocl_is_too_old("3.0", "cpu", "AMD EPYC"));
}

static void numbers_come_first(void **state) {
    (void)state;
    expect("cpu,gpu=Card 0", "0", 0);
    expect("cpu,gpu=Card 7", "1", 1);
    expect("cpu,gpu=Card 4090", "4090", 1);
    expect_error(
        "cpu,gpu=Card 7", "7",
        "no device matches '7'; available: 0: cpu (Fake One, driver 7.5); 1: Card 7 (Fake One, driver 7.5)");
    expect_error("cpu", "-1", "no device matches '-1'");
}

static void parts_of_names_in_any_case(void **state) {
    (void)state;
    expect("cpu=Slow,gpu=Big Card", "bIG", 1);
    expect("cpu=Slow|gpu=Big", "fake two", 1);
    expect("cpu=Slow|nvidia=Big", "cuda", 1); /* in the version */
    expect("cpu=Slow,gpu=Big", "cpu", 0);
    expect("cpu=Slow,gpu=Big,gpu=Bigger", "GPU", 1);
    expect_error("cpu=Slow", "fast", "no device matches 'fast'");
    expect_error("cpu=Slow", "gpu", "no device matches 'gpu'");
    expect_error("cpu=One,cpu=Two", "one,two",
                 "no device matches 'one,two', and only one can be named; available: 0: One");
}

static void versions_of_drivers(void **state) {
    (void)state;
    expect("gpu=Card@535.1,cpu=Slow@3.1+debian", "3.1+debian", 1);
    expect("gpu=Card@535.1,cpu=Slow@3.1+debian", "535", 0);
    expect_error("gpu=Card@535.1", "536", "0: Card (Fake One, driver 535.1)");
    /* Equal devices of two drivers are not one kind. */
    expect_error("gpu=Card@1.0,gpu=Card@2.0", "card",
                 "give a number: 0: Card (Fake One, driver 1.0); 1: Card (Fake One, driver 2.0)");
    expect("gpu=Card@1.0,gpu=Card@2.0", "2.0", 1);
}

static void one_text_for_several_devices(void **state) {
    (void)state;
    expect_error("gpu=Card A,gpu=Card B,cpu=Slow", "card",
                 "matches several devices; give a number: 0: Card A (Fake One, driver 7.5); "
                 "1: Card B (Fake One, driver 7.5)");
    expect("gpu=Card,gpu=Card", "card", 0);               /* equal ones: the first */
    expect_error("gpu=Card|gpu=Card", "card", "several"); /* not equal: another driver */
    expect("gpu=Card XT,gpu=Card", "card", 1);            /* the whole name */
    expect("gpu=Card,gpu=Card XT", "card", 0);
    expect("old=Card,gpu=Card XT", "card", 1); /* one of them cannot render */
    expect("gpu=Card XT,old=Card", "card", 0);
    /* The version of OpenCL is in no list: it counts only where nothing else has the text, and then it is
     * shown. */
    expect("gpu=A@3.0,nvidia=B@4.0", "3.0", 0);
    expect("gpu=A,cpu=B", "1.2 fake", 1);
    expect_error("gpu=A@7.5,nvidia=B@7.5", "opencl 3.0",
                 "several devices; give a number: 0: A (Fake One, driver 7.5, vendor Nobody, version OpenCL "
                 "3.0 fake)");
}

static void refuses_by_what_is_lacking(void **state) {
    (void)state;
    expect_error("old", "0", "it has OpenCL 1.1 (1.2 is needed)");
    expect_error("mute", "0", "does not report its OpenCL version");
    expect_error("big-endian", "0", "not little-endian");
    expect_error("no-compiler", "0", "no compiler");
    expect_error("embedded", "embedded", "`long`");
    expect("embedded-long", "0", 0);
    expect_error("truncating", "0", "does not round to nearest");
    expect_error("no-infinity", "0", "no infinities and NaN");
    expect_error("away", "0", "not available");
}

static void opening(void **state) {
    (void)state;
    BpDeviceInfo info;
    BpDevice *device = NULL;
    BpError err = {0};
    with("cpu,gpu");
    assert_int_equal(bp_device_find("1", &info, &err), BP_OK);
    assert_int_equal(bp_device_open(&info, &device, &err), BP_OK);
    assert_string_equal(device->info.name, "gpu");
    bp_device_close(&device);
    assert_null(device);
    bp_device_close(&device);

    with("cpu"); /* unplugged */
    assert_int_equal(bp_device_open(&info, &device, &err), BP_ERR_DEVICE);
    assert_contains(err.message, "no longer there");
    assert_null(device);
    with("cpu,gpu=other"); /* exchanged */
    assert_int_equal(bp_device_open(&info, &device, &err), BP_ERR_DEVICE);
    with("cpu,old=gpu"); /* the list is asked again, not the caller's copy */
    assert_int_equal(bp_device_open(&info, &device, &err), BP_ERR_DEVICE);
    assert_contains(err.message, "OpenCL 1.1");

    with("full");
    assert_int_equal(bp_device_find("0", &info, &err), BP_OK);
    assert_int_equal(bp_device_open(&info, &device, &err), BP_ERR_MEMORY);
    assert_contains(err.message, "clCreateContext failed with CL_OUT_OF_RESOURCES (-5) on full");
    assert_int_equal(err.remedy, BP_REMEDY_SMALLER_WIDTH_OR_OTHER_DEVICE);
    assert_null(device);
    bp_error_clear(&err);
}

/* The build log for `options` on a device of `kind`, which the fake driver makes of the options. */
static char *build_on(const char *kind, const char *options) {
    BpDeviceInfo info;
    BpDevice *device = NULL;
    cl_program program = NULL;
    char *log = NULL;
    with(kind);
    assert_int_equal(bp_device_find("0", &info, NULL), BP_OK);
    assert_int_equal(bp_device_open(&info, &device, NULL), BP_OK);
    assert_int_equal(bp_device_build(device, "kernel", options, &program, &log, NULL), BP_OK);
    assert_non_null(program);
    clReleaseProgram(program);
    bp_device_close(&device);
    return log;
}

static void build_options(void **state) {
    (void)state;
    static const struct {
        const char *kind, *options, *log;
    } cases[] = {
        {"gpu", NULL, "options: -cl-std=CL1.2"},
        {"gpu", "-w", "options: -cl-std=CL1.2 -w"},
        {"nvidia", "-w", "options: -cl-std=CL1.2 -cl-nv-verbose -w"},
        {"almost-nvidia", "-w", "options: -cl-std=CL1.2 -w"},
        {"rounding", "-w", "options: -cl-std=CL1.2 -cl-fp32-correctly-rounded-divide-sqrt -cl-nv-verbose -w"},
        {"rounding", "-cl-fast-relaxed-math", "options: -cl-std=CL1.2 -cl-nv-verbose -cl-fast-relaxed-math"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        char *log = build_on(cases[i].kind, cases[i].options);
        assert_string_equal(log, cases[i].log);
        free(log);
    }
}

static BpDevice *opened(const char *kind) {
    BpDeviceInfo info;
    BpDevice *device = NULL;
    with(kind);
    assert_int_equal(bp_device_find("0", &info, NULL), BP_OK);
    assert_int_equal(bp_device_open(&info, &device, NULL), BP_OK);
    return device;
}

/* Quotients and roots are rounded by the kernel where the device does not, and rounding matters. */
static void who_rounds(void **state) {
    (void)state;
    static const struct {
        const char *kind;
        BpMath math;
        BpPrecision precision;
        bool own;
    } cases[] = {{"gpu", BP_MATH_STRICT, BP_PRECISION_SINGLE, true},
                 {"gpu", BP_MATH_FAST, BP_PRECISION_SINGLE, false},
                 {"rounding", BP_MATH_STRICT, BP_PRECISION_SINGLE, false}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        BpProgramOptions options = {.tree_width = 4, .math = cases[i].math, .precision = cases[i].precision};
        BpProgram *program = NULL;
        char *source = NULL;
        BpDevice *device = opened(cases[i].kind);
        assert_int_equal(bp_program_build(device, &options, NULL, NULL, &program, NULL), BP_OK);
        options.own_rounding = cases[i].own;
        assert_int_equal(bp_program_source(&options, NULL, NULL, &source, NULL), BP_OK);
        const char *flags = cases[i].math == BP_MATH_FAST ? "-cl-fast-relaxed-math" : "";
        if (program->key != bp_hash_text(bp_hash_text(BP_HASH_START, source), flags))
            fail_msg("%s: another source than with own_rounding = %d", cases[i].kind, cases[i].own);
        assert_contains(source, cases[i].own ? "#define OWN_ROUNDING 1\n" : "#define OWN_ROUNDING 0\n");
        free(source);
        bp_program_destroy(&program);
        bp_device_close(&device);
    }
}

/* Devices that differ in nothing but what their programs are built with have passes of their own. */
static void a_pass_is_of_its_options(void **state) {
    (void)state;
    BpDevice *one = opened("gpu"), *other = opened("rounding");
    setenv("XDG_CACHE_HOME", "/tmp/of-nobody", 1);
    other->info = one->info;
    with("gpu");
    char *options = bp_device_build_options(one, NULL), *path = bp_self_test_memory_path(one);
    assert_string_equal(options, "-cl-std=CL1.2");
    with("rounding");
    char *other_options = bp_device_build_options(other, NULL), *other_path = bp_self_test_memory_path(other);
    assert_string_equal(other_options, "-cl-std=CL1.2 -cl-fp32-correctly-rounded-divide-sqrt -cl-nv-verbose");
    assert_string_not_equal(path, other_path);
    with("gpu");
    char *again = bp_self_test_memory_path(one);
    assert_string_equal(path, again);
    free(again);
    free(options);
    free(other_options);
    free(path);
    free(other_path);
    bp_device_close(&one);
    bp_device_close(&other);
}

/* Builds `source` on the fake CPU, whose driver takes `milliseconds`; whether it was compiled for that, and
 * not taken from the cache. */
static bool compiles(const char *source, const char *milliseconds) {
    BpDeviceInfo info;
    BpDevice *device = NULL;
    cl_program program = NULL;
    setenv("FAKE_COMPILE", milliseconds, 1);
    assert_int_equal(bp_device_find("0", &info, NULL), BP_OK);
    assert_int_equal(bp_device_open(&info, &device, NULL), BP_OK);
    const double start = bp_processor_seconds();
    assert_int_equal(bp_device_build(device, source, NULL, &program, NULL, NULL), BP_OK);
    const double seconds = bp_processor_seconds() - start;
    clReleaseProgram(program);
    bp_device_close(&device);
    setenv("FAKE_COMPILE", "0", 1);
    return seconds >= 0.001 * atof(milliseconds);
}

static void programs_that_took_long_are_kept(void **state) {
    (void)state;
    char folder[] = "/tmp/ballpark-test-XXXXXX", kernels[64], command[128];
    assert_non_null(mkdtemp(folder));
    setenv("XDG_CACHE_HOME", folder, 1);
    snprintf(kernels, sizeof kernels, "%s/ballpark/kernels", folder);
    with("cpu");
    assert_true(compiles("quick", "60"));
    assert_true(compiles("quick", "60")); /* not worth a file */
    assert_int_not_equal(access(kernels, F_OK), 0);
    assert_true(compiles("slow", "300"));
    assert_false(compiles("slow", "300"));
    with("cpu=cpu@8.1"); /* another driver */
    assert_true(compiles("slow", "300"));
    assert_false(compiles("slow", "300"));
    snprintf(command, sizeof command, "rm -r %s", folder);
    assert_int_equal(system(command), 0);
    unsetenv("XDG_CACHE_HOME");
}

static void build_failure_names_the_first_place(void **state) {
    (void)state;
    BpDeviceInfo info;
    BpDevice *device = NULL;
    cl_program program = NULL;
    char *log = NULL;
    BpError err = {0};
    with("gpu");
    assert_int_equal(bp_device_find("0", &info, &err), BP_OK);
    assert_int_equal(bp_device_open(&info, &device, &err), BP_OK);
    assert_int_equal(bp_device_build(device, "#error", "", &program, &log, &err), BP_ERR_BUILD);
    assert_null(program);
    assert_null(log);
    assert_string_equal(err.file, "sphere.cl");
    assert_int_equal(err.line, 31);
    assert_int_equal(err.column, 7);
    assert_contains(err.message, "use of 'x': gone");
    assert_string_equal(err.attachment,
                        "tree.cl:3:1: warning: unused\nsphere.cl:31:7: error: use of 'x': gone\n"
                        "tree.cl:9:9: error: later\n");
    bp_error_clear(&err);
    bp_device_close(&device);
}

static void errors_have_names_and_remedies(void **state) {
    (void)state;
    BpError err = {0};
    assert_string_equal(bp_cl_error_name(CL_SUCCESS), "CL_SUCCESS");
    assert_string_equal(bp_cl_error_name(-5), "CL_OUT_OF_RESOURCES");
    assert_string_equal(bp_cl_error_name(-1001), "CL_PLATFORM_NOT_FOUND_KHR");
    assert_non_null(bp_cl_error_name(-4711));
    assert_int_equal(bp_cl_fail(&err, CL_MEM_OBJECT_ALLOCATION_FAILURE, "clCreateBuffer", NULL),
                     BP_ERR_MEMORY);
    assert_string_equal(err.message,
                        "clCreateBuffer failed with CL_MEM_OBJECT_ALLOCATION_FAILURE (-4): the device's "
                        "memory is full");
    bp_error_add_remedy(&err, BP_INTERFACE_COMMAND_LINE);
    assert_contains(err.message, " is full; use a smaller --width, or another --device");
    assert_int_equal(bp_cl_fail(&err, CL_INVALID_BUFFER_SIZE, "clCreateBuffer", NULL), BP_ERR_LIMIT);
    assert_int_equal(bp_cl_fail(&err, CL_OUT_OF_HOST_MEMORY, "clCreateBuffer", NULL), BP_ERR_MEMORY);
    bp_error_add_remedy(&err, BP_INTERFACE_C);
    assert_contains(err.message, "close other programs, or use a smaller width (bp_scene_set_width())");
    assert_int_equal(bp_cl_fail(&err, CL_INVALID_KERNEL_ARGS, "clEnqueueNDRangeKernel", NULL), BP_ERR_DEVICE);
    assert_contains(err.message, "CL_INVALID_KERNEL_ARGS (-52)");
    bp_error_clear(&err);
}

int main(void) {
    /* Before the first OpenCL call: the loader reads it once. */
    if (setenv("OCL_ICD_VENDORS", FAKE_ICD_FILE, 1) != 0) return 1;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lists_every_platform),
        cmocka_unit_test(tolerates_platforms_without_devices),
        cmocka_unit_test(prefers_a_gpu_that_can_render),
        cmocka_unit_test(prefers_the_most_capable_gpu),
        cmocka_unit_test(an_old_pocl_must_know_the_processor),
        cmocka_unit_test(numbers_come_first),
        cmocka_unit_test(parts_of_names_in_any_case),
        cmocka_unit_test(versions_of_drivers),
        cmocka_unit_test(one_text_for_several_devices),
        cmocka_unit_test(refuses_by_what_is_lacking),
        cmocka_unit_test(opening),
        cmocka_unit_test(build_options),
        cmocka_unit_test(who_rounds),
        cmocka_unit_test(a_pass_is_of_its_options),
        cmocka_unit_test(programs_that_took_long_are_kept),
        cmocka_unit_test(build_failure_names_the_first_place),
        cmocka_unit_test(errors_have_names_and_remedies),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
