/* test_calibration.c: what a calibration has found comes back as it was, for the same device and kernels
 * alone, and never from a damaged file. */
#include "opencl/calibration.h"

#include "support/output_temp.h"
#include "support/unit_test.h"

#include <stdlib.h>
#include <string.h>

#define KERNELS 0x123456789abcdef0u
#define FILE_MAX 2048

typedef struct Lab {
    char home[64], path[512]; /* of caches; of the device's file */
    char text[FILE_MAX];
    size_t size;
} Lab;

static const BpDeviceInfo device = {.type = BP_DEVICE_GPU,
                                    .name = "A GPU",
                                    .platform = "A platform",
                                    .version = "1.2",
                                    .driver = "7",
                                    .compute_units = 9};
static const BpCalibration outcome = {BP_KERNEL_POOL, 128, 16, 1.25};

static void write_file(const Lab *lab, const char *bytes, size_t size) {
    FILE *file = fopen(lab->path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

static void clear_home(const char *home) {
    char below[128], path[512];
    struct dirent *entry;
    snprintf(below, sizeof below, "%s/ballpark", home);
    DIR *open = opendir(below);
    while (open != NULL && (entry = readdir(open)) != NULL)
        if (entry->d_name[0] != '.') assert_int_equal(remove(temp_path(path, below, entry->d_name)), 0);
    if (open != NULL) closedir(open);
    rmdir(below);
    assert_int_equal(rmdir(home), 0);
}

static int set_up(void **state) {
    Lab *lab = calloc(1, sizeof *lab);
    char below[128];
    struct dirent *entry;
    assert_non_null(lab);
    temp_make(lab->home);
    setenv("XDG_CACHE_HOME", lab->home, 1);
    bp_calibration_keep(&device, KERNELS, &outcome);
    snprintf(below, sizeof below, "%s/ballpark", lab->home);
    DIR *open = opendir(below);
    assert_non_null(open);
    while ((entry = readdir(open)) != NULL)
        if (strncmp(entry->d_name, "calibration-", 12) == 0) temp_path(lab->path, below, entry->d_name);
    closedir(open);
    FILE *file = fopen(lab->path, "rb");
    assert_non_null(file);
    lab->size = fread(lab->text, 1, sizeof lab->text, file);
    fclose(file);
    assert_in_range(lab->size, 1, FILE_MAX - 1);
    *state = lab;
    return 0;
}

static int tear_down(void **state) {
    Lab *lab = *state;
    clear_home(lab->home);
    free(lab);
    return 0;
}

static bool recalls(const BpDeviceInfo *asked, uint64_t kernels) {
    BpCalibration found = {.form = BP_KERNEL_AUTO};
    const bool known = bp_calibration_recall(asked, kernels, &found);
    if (!known) {
        assert_int_equal(found.form, BP_KERNEL_AUTO);
        return false;
    }
    assert_int_equal(found.form, outcome.form);
    assert_int_equal(found.local_size, outcome.local_size);
    assert_int_equal(found.samples_per_item, outcome.samples_per_item);
    assert_true(found.gain == outcome.gain);
    return true;
}

static void comes_back(void **state) {
    (void)state;
    assert_true(recalls(&device, KERNELS));
}

static void other_devices(void **state) {
    (void)state;
    BpDeviceInfo other = device;
    assert_false(recalls(&device, KERNELS + 1));
    strcpy(other.driver, "8");
    assert_false(recalls(&other, KERNELS));
    other = device;
    strcpy(other.name, "Another GPU");
    assert_false(recalls(&other, KERNELS));
    other = device;
    other.compute_units = 10;
    assert_false(recalls(&other, KERNELS));
}

/* Every byte changed, every length, and more behind. */
static void damaged(void **state) {
    const Lab *lab = *state;
    char bytes[FILE_MAX + 1];
    for (size_t i = 0; i < lab->size; ++i) {
        memcpy(bytes, lab->text, lab->size);
        bytes[i] ^= 1;
        write_file(lab, bytes, lab->size);
        assert_false(recalls(&device, KERNELS));
        write_file(lab, lab->text, i);
        assert_false(recalls(&device, KERNELS));
    }
    memcpy(bytes, lab->text, lab->size);
    bytes[lab->size] = '\n';
    write_file(lab, bytes, lab->size + 1);
    assert_false(recalls(&device, KERNELS));
    bytes[lab->size] = '\0';
    write_file(lab, bytes, lab->size + 1);
    assert_false(recalls(&device, KERNELS));
    write_file(lab, lab->text, lab->size);
    assert_true(recalls(&device, KERNELS));
    /* What is kept anew replaces what was there. */
    write_file(lab, "", 0);
    bp_calibration_keep(&device, KERNELS, &outcome);
    assert_true(recalls(&device, KERNELS));
}

/* Others could have written it. */
static void writable_by_others(void **state) {
    const Lab *lab = *state;
    assert_int_equal(chmod(lab->path, 0666), 0);
    assert_false(recalls(&device, KERNELS));
}

static void no_home(void **state) {
    const Lab *lab = *state;
    char below[128];
    snprintf(below, sizeof below, "%s/file", lab->home);
    FILE *file = fopen(below, "wb");
    assert_non_null(file);
    fclose(file);
    setenv("XDG_CACHE_HOME", below, 1); /* no folder, for root neither */
    bp_calibration_keep(&device, KERNELS, &outcome);
    assert_false(recalls(&device, KERNELS));
    setenv("XDG_CACHE_HOME", lab->home, 1);
    assert_int_equal(remove(below), 0);
    assert_true(recalls(&device, KERNELS));
}

int main(void) {
#define TEST(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)
    const struct CMUnitTest tests[] = {TEST(comes_back), TEST(other_devices), TEST(damaged),
                                       TEST(writable_by_others), TEST(no_home)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
