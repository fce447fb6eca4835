/* calibration.c: see calibration.h. */
#include "calibration.h"

#include "base/hash.h"
#include "base/names.h"
#include "cache_file.h"
#include "cache_folder.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define CHECKSUM "checksum: "

static void identify(const BpDeviceInfo *device, uint64_t kernels, char *to, size_t size) {
    snprintf(to, size,
             "How Ballpark shares out samples on this device.\nplatform: %s\ndevice: %s\nversion: %s\n"
             "driver: %s\nunits: %u\nkernels: %016llx\n",
             device->platform, device->name, device->version, device->driver, device->compute_units,
             (unsigned long long)kernels);
}

/* The last line of a file, which is about all before it. */
static void sign(uint64_t hash, char line[64]) {
    snprintf(line, 64, CHECKSUM "%016llx\n", (unsigned long long)hash);
}

static bool read_outcome(const char *text, const char *identity, BpCalibration *calibration) {
    const size_t length = strlen(identity);
    const char *last = strstr(text, "\n" CHECKSUM);
    char line[64], form[16];
    if (strncmp(text, identity, length) != 0 || last == NULL) return false;
    ++last;
    sign(bp_hash_bytes(BP_HASH_START, text, (size_t)(last - text)), line);
    BpCalibration found = {.form = BP_KERNEL_AUTO};
    if (strcmp(last, line) != 0 || sscanf(text + length, "kernel: %15s\ngroup: %u\nsamples: %u\ngain: %lf\n",
                                          form, &found.local_size, &found.samples_per_item, &found.gain) != 4)
        return false;
    if (strcmp(form, bp_kernel_names[BP_KERNEL_SAMPLE]) == 0) found.form = BP_KERNEL_SAMPLE;
    if (strcmp(form, bp_kernel_names[BP_KERNEL_POOL]) == 0) found.form = BP_KERNEL_POOL;
    if (found.form == BP_KERNEL_AUTO || found.local_size == 0 || found.samples_per_item == 0 ||
        !isfinite(found.gain))
        return false;
    *calibration = found;
    return true;
}

bool bp_calibration_recall(const BpDeviceInfo *device, uint64_t kernels, BpCalibration *calibration) {
    char identity[1024];
    size_t size = 0;
    identify(device, kernels, identity, sizeof identity);
    char *path = bp_cache_file_path("calibration", identity, false);
    char *text = path != NULL ? bp_cache_read(path, &size) : NULL;
    const bool found = text != NULL && strlen(text) == size && read_outcome(text, identity, calibration);
    free(text);
    free(path);
    return found;
}

void bp_calibration_keep(const BpDeviceInfo *device, uint64_t kernels, const BpCalibration *calibration) {
    char identity[1024], outcome[256], line[64];
    identify(device, kernels, identity, sizeof identity);
    snprintf(outcome, sizeof outcome, "kernel: %s\ngroup: %u\nsamples: %u\ngain: %.3f\n",
             bp_kernel_names[calibration->form], calibration->local_size, calibration->samples_per_item,
             calibration->gain);
    sign(bp_hash_text(bp_hash_text(BP_HASH_START, identity), outcome), line);
    const BpCachePart parts[] = {
        {identity, strlen(identity)}, {outcome, strlen(outcome)}, {line, strlen(line)}};
    char *path = bp_cache_file_path("calibration", identity, true);
    if (path != NULL) bp_cache_write(path, parts, sizeof parts / sizeof parts[0]);
    free(path);
}
