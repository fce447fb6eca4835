/* self_test_memory.c: which devices have passed; see self_test.h.
 *
 * In:    a device's description.   Out: a small text file in the user's cache.
 * Knows: what an outcome depends on.   Does not know: where caches live, what is tested.
 *
 * The file's name is a hash of everything that could change the outcome, and its text is all of that in
 * words: a file that holds other words, for whatever reason, is no memory. */
#include "base/hash.h"
#include "base/output_file.h"
#include "cache_folder.h"
#include "program.h"
#include "self_test.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

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

/* Whether the file can be used: opening anything but a regular file may block. */
static bool is_regular_or_absent(const char *path) {
    struct stat state;
    return stat(path, &state) == 0 ? S_ISREG(state.st_mode) : errno == ENOENT;
}

static bool remembered(const char *path, const char *identity) {
    char text[1024] = "";
    struct stat state;
    const int file = open(path, O_RDONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK);
    if (file < 0) return false;
    ssize_t length = -1;
    if (fstat(file, &state) == 0 && S_ISREG(state.st_mode)) length = read(file, text, sizeof text);
    close(file);
    return length >= 0 && (size_t)length == strlen(identity) && memcmp(text, identity, (size_t)length) == 0;
}

BpStatus bp_self_test_once(BpDevice *device, bool *ran, BpError *err) {
    BpStatus status = BP_OK;
    char identity[1024];
    identify(device, identity, sizeof identity);
    char *path = bp_cache_file_path("self-test", identity, true);
    if (path != NULL && !is_regular_or_absent(path)) {
        free(path);
        path = NULL;
    }
    const bool passed_before = path != NULL && remembered(path, identity);
    if (ran != NULL) *ran = !passed_before;
    if (!passed_before) {
        status = bp_self_test_run(device, NULL, err);
        BpOutputFile file;
        /* A cache that cannot be written only costs the test again. */
        if (status == BP_OK && path != NULL && bp_output_open(path, &file, NULL) == BP_OK) {
            if (fputs(identity, file.stream) >= 0)
                bp_output_commit(&file, NULL);
            else
                bp_output_discard(&file);
        }
    }
    free(path);
    return status;
}
