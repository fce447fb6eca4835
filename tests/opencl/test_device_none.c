/* test_device_none.c: a computer without any OpenCL driver is told what to install. */
#include "opencl/device.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static void says_what_to_install(void **state) {
    (void)state;
    BpDeviceInfo *list = NULL, device;
    size_t count = 1;
    BpError err = {0};
    assert_int_equal(bp_devices_list(&list, &count, &err), BP_OK);
    assert_int_equal(count, 0);
    free(list);
    static const char *const texts[] = {NULL, "", "0", "gpu"};
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; ++i) {
        assert_int_equal(bp_device_find(texts[i], &device, &err), BP_ERR_DEVICE);
        assert_non_null(strstr(err.message, "no OpenCL platform"));
        assert_non_null(strstr(err.message, "pocl-opencl-icd"));
        assert_non_null(strstr(err.message, "clinfo"));
    }
    assert_int_equal(bp_device_find(NULL, &device, NULL), BP_ERR_DEVICE);
    bp_error_clear(&err);
}

int main(void) {
    /* An empty folder, read by the loader at the first OpenCL call. */
    if (setenv("OCL_ICD_VENDORS", EMPTY_FOLDER, 1) != 0) return 1;
    const struct CMUnitTest tests[] = {cmocka_unit_test(says_what_to_install)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
