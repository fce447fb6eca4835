/* pocl.c: see pocl.h. */
#include "pocl.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define FOLDER_MAX 1024

/* The folder that PoCL uses (its manual, "Environment variables"): POCL_CACHE_DIR, else one below
 * XDG_CACHE_HOME, else one below HOME. False: none of them is set. */
static bool cache_folder(char folder[FOLDER_MAX]) {
    const char *own = getenv("POCL_CACHE_DIR"), *cache = getenv("XDG_CACHE_HOME"), *home = getenv("HOME");
    if (own != NULL && own[0] != '\0')
        snprintf(folder, FOLDER_MAX, "%s", own);
    else if (cache != NULL && cache[0] != '\0')
        snprintf(folder, FOLDER_MAX, "%s/pocl/kcache", cache);
    else if (home != NULL && home[0] != '\0')
        snprintf(folder, FOLDER_MAX, "%s/.cache/pocl/kcache", home);
    else
        return false;
    return true;
}

/* 0, or the errno of the failure. Permissions are not sufficient: a file system may be read-only or full. */
static int try_writing(const char *folder) {
    char path[FOLDER_MAX + 32];
    snprintf(path, sizeof path, "%s", folder);
    for (char *slash = strchr(path + 1, '/'); slash != NULL; slash = strchr(slash + 1, '/')) {
        *slash = '\0';
        if (mkdir(path, 0777) != 0 && errno != EEXIST) return errno;
        *slash = '/';
    }
    if (mkdir(path, 0777) != 0 && errno != EEXIST) return errno;
    snprintf(path, sizeof path, "%s/ballpark-XXXXXX", folder);
    const int file = mkstemp(path);
    if (file < 0) return errno;
    const int failed = write(file, "", 1) == 1 ? 0 : errno;
    close(file);
    unlink(path);
    return failed;
}

bool bp_pocl_finds_linker(void) {
    const char *folder = getenv("PATH");
    while (folder != NULL && *folder != '\0') {
        char file[FOLDER_MAX];
        const size_t length = strcspn(folder, ":");
        const int written =
            snprintf(file, sizeof file, "%.*s%sld", (int)length, folder, length > 0 ? "/" : "");
        if (written > 0 && (size_t)written < sizeof file && access(file, X_OK) == 0) return true;
        folder += length + (folder[length] == ':');
    }
    return false;
}

bool bp_pocl_cache_fails(char text[512]) {
    char folder[FOLDER_MAX];
    if (!cache_folder(folder)) return false;
    const int failed = try_writing(folder);
    if (failed == 0) return false;
    snprintf(text, 512,
             "PoCL cannot write its folder for compiled kernels, %.256s (%s): make it writable, or set "
             "POCL_CACHE_DIR to a writable folder",
             folder, strerror(failed));
    return true;
}

static bool is_before_3_1(const char *driver) {
    unsigned major, minor;
    return sscanf(driver, "%u.%u", &major, &minor) == 2 && !(major > 3 || (major == 3 && minor > 0));
}

/* A device is called "pthread-PROCESSOR-MODEL", PROCESSOR being the compiler's name for it; where the
 * compiler has none, that part is missing. */
bool bp_pocl_is_too_old(const char *driver, const char *name, const char *model) {
    if (!is_before_3_1(driver)) return false;
    const char *dash = strchr(name, '-');
    const size_t length = strlen(model);
    return dash != NULL && length > 0 && strncmp(dash + 1, model, length) == 0;
}

bool bp_pocl_fails_here(const BpDeviceInfo *info) {
    char line[512], model[256] = "";
    bool has_avx = false; /* without it PoCL's functions use what every processor has */
#if defined __x86_64__
    has_avx = __builtin_cpu_supports("avx");
#endif
    if (!has_avx || strcmp(info->platform, BP_POCL_PLATFORM) != 0 || !is_before_3_1(info->driver))
        return false;
    FILE *file = fopen("/proc/cpuinfo", "r");
    while (file != NULL && model[0] == '\0' && fgets(line, sizeof line, file) != NULL)
        if (sscanf(line, "model name : %255[^\n]", model) != 1) model[0] = '\0';
    if (file != NULL) fclose(file);
    return bp_pocl_is_too_old(info->driver, info->name, model);
}
