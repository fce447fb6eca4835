/* self_test_memory.c: remembers the devices that have passed; see self_test.h.
 *
 * In:    a device's description.   Out: a small text file in the user's cache.
 * Knows: what an outcome depends on.   Does not know: where caches are stored, what is tested.
 *
 * The file's name is a hash of everything that could change the outcome, and its text has all of that in
 * words: a file with other text is ignored. */
#include "base/hash.h"
#include "cache_file.h"
#include "cache_folder.h"
#include "program.h"
#include "self_test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Everything that the outcome depends on. */
static void identify(const BpDevice *opened, char *to, size_t size) {
    const BpDeviceInfo *device = &opened->info;
    uint64_t sources = BP_HASH_START;
    for (int f = 0; f < BP_SELF_TEST_FILES; ++f) {
        char *text = NULL;
        if (bp_kernel_text(bp_self_test_files[f], &text, NULL) == BP_OK)
            sources = bp_hash_text(sources, text);
        free(text);
    }
    char *options = bp_device_build_options(opened, NULL);
    snprintf(to, size,
             "This device passed Ballpark's self-test.\nplatform: %s\ndevice: %s\nversion: %s\ndriver: %s\n"
             "double: %s\noptions: %s\nballpark: %s\ntest: %016llx\n",
             device->platform, device->name, device->version, device->driver,
             device->has_double ? "yes" : "no", options != NULL ? options : "", bp_version(),
             (unsigned long long)sources);
    free(options);
}

char *bp_self_test_memory_path(const BpDevice *device) {
    char identity[1024];
    identify(device, identity, sizeof identity);
    return bp_cache_file_path("self-test", identity, false);
}

BpStatus bp_self_test_once(BpDevice *device, bool *ran, BpError *err) {
    BpStatus status = BP_OK;
    char identity[1024];
    size_t size = 0;
    identify(device, identity, sizeof identity);
    char *path = bp_cache_file_path("self-test", identity, true);
    char *text = path != NULL ? bp_cache_read(path, &size) : NULL;
    const bool passed_before = text != NULL && size == strlen(identity) && memcmp(text, identity, size) == 0;
    if (ran != NULL) *ran = !passed_before;
    if (!passed_before) status = bp_self_test_run(device, NULL, err);
    /* If the cache cannot be written, the test merely runs again. */
    if (!passed_before && status == BP_OK && path != NULL)
        bp_cache_write(path, &(BpCachePart){identity, strlen(identity)}, 1);
    free(text);
    free(path);
    return status;
}
