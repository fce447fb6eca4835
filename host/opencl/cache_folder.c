/* cache_folder.c: see cache_folder.h. */
#include "cache_folder.h"

#include "base/hash.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

char *bp_cache_folder(const char *below, bool make) {
    const char *base = getenv("XDG_CACHE_HOME"), *home = "";
    /* The specification has relative paths ignored. */
    if (base == NULL || base[0] != '/') {
        base = getenv("HOME");
        home = "/.cache";
    }
    if (base == NULL || base[0] != '/') return NULL;
    const char *const parts[] = {base, home, "/ballpark", below};
    const size_t size = strlen(base) + strlen(home) + strlen("/ballpark") + strlen(below) + 1;
    char *folder = calloc(1, size);
    if (folder == NULL) return NULL;
    for (int part = 0; part < 4; ++part) {
        const size_t used = strlen(folder);
        snprintf(folder + used, size - used, "%s", parts[part]);
        /* The base itself may be missing too, but not its parent. */
        if (make && (part > 0 || home[0] == '\0') && parts[part][0] != '\0') mkdir(folder, 0700);
    }
    return folder;
}

char *bp_cache_file_path(const char *kind, const char *identity, bool make) {
    char *folder = bp_cache_folder("", make);
    if (folder == NULL) return NULL;
    const size_t size = strlen(folder) + strlen(kind) + sizeof "/-0123456789abcdef.txt";
    char *path = malloc(size);
    if (path != NULL)
        snprintf(path, size, "%s/%s-%016llx.txt", folder, kind,
                 (unsigned long long)bp_hash_text(BP_HASH_START, identity));
    free(folder);
    return path;
}
