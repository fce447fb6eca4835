/* module.c: see module.h. */
#include "module.h"

#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Without a folder, the bare name: then the loader searches, and reports a failure. */
static void find(const BpModuleName *name, char *path, size_t size) {
    static const char *const folders[] = {"", BALLPARK_MODULE_FOLDER "/"};
    const char *named = getenv(name->variable);
    char program[3500];
    snprintf(path, size, "%s", name->file);
    if (named != NULL && named[0] != '\0') {
        snprintf(path, size, "%s", named);
        return;
    }
    const ssize_t length = readlink("/proc/self/exe", program, sizeof program - 1);
    if (length < 0) return;
    program[length] = '\0';
    char *slash = strrchr(program, '/');
    if (slash != NULL) slash[1] = '\0';
    for (size_t f = 0; f < sizeof folders / sizeof folders[0]; ++f) {
        char candidate[4096];
        snprintf(candidate, sizeof candidate, "%s%s%s", program, folders[f], name->file);
        if (access(candidate, R_OK) != 0) continue;
        snprintf(path, size, "%s", candidate);
        return;
    }
}

BpStatus bp_module_load(const BpModuleName *name, const void **interface, BpError *err) {
    char path[4096];
    uint32_t version = 0;
    find(name, path, sizeof path);
    void *module = dlopen(path, RTLD_NOW | (name->is_global ? RTLD_GLOBAL : RTLD_LOCAL));
    if (module == NULL) {
        const BpStatus status =
            bp_fail(err, BP_ERR_USAGE, "%.300s cannot be loaded: %.400s", path, dlerror());
        (void)dlerror(); /* the C library frees the text at the next call */
        return status;
    }
    const void *found = dlsym(module, name->symbol);
    if (found != NULL) memcpy(&version, found, sizeof version);
    if (version != name->version)
        return bp_fail(err, BP_ERR_USAGE, "%.300s is not a module of this version of Ballpark", path);
    *interface = found;
    return BP_OK;
}
