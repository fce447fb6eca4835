/* kernel_copy.h: a copy of kernels/ with one text replaced, which the program then reads.
 *
 * Knows: files, BALLPARK_KERNELS.   Does not know: what the patch does. */
#ifndef TESTS_AGREE_KERNEL_COPY_H
#define TESTS_AGREE_KERNEL_COPY_H

#include "unit_test.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef struct KernelCopy {
    char folder[64];
} KernelCopy;

static inline char *kernel_text(const char *folder, const char *name) {
    char path[1024];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "rb");
    if (file == NULL) fail_msg("cannot read %s", path);
    static char text[1 << 18];
    const size_t size = fread(text, 1, sizeof text - 1, file);
    fclose(file);
    text[size] = '\0';
    return text;
}

/* Copies kernels/ with `find`, which must stand in `name` exactly once, replaced, and points BALLPARK_KERNELS
 * there. */
static inline void kernel_copy_open(KernelCopy *copy, const char *name, const char *find,
                                    const char *replacement) {
    snprintf(copy->folder, sizeof copy->folder, "/tmp/ballpark-kernels-XXXXXX");
    assert_non_null(mkdtemp(copy->folder));
    DIR *folder = opendir(SOURCE_DIR "/kernels");
    assert_non_null(folder);
    for (struct dirent *entry; (entry = readdir(folder)) != NULL;) {
        if (entry->d_name[0] == '.') continue;
        char path[1024];
        char *text = kernel_text(SOURCE_DIR "/kernels", entry->d_name);
        snprintf(path, sizeof path, "%s/%s", copy->folder, entry->d_name);
        FILE *file = fopen(path, "wb");
        assert_non_null(file);
        char *place = strcmp(entry->d_name, name) == 0 ? strstr(text, find) : NULL;
        if (strcmp(entry->d_name, name) == 0 && (place == NULL || strstr(place + 1, find) != NULL))
            fail_msg("%s does not hold exactly once: %s", name, find);
        if (place != NULL)
            fprintf(file, "%.*s%s%s", (int)(place - text), text, replacement, place + strlen(find));
        else
            fputs(text, file);
        assert_int_equal(fclose(file), 0);
    }
    closedir(folder);
    setenv("BALLPARK_KERNELS", copy->folder, 1);
}

static inline void kernel_copy_close(KernelCopy *copy) {
    unsetenv("BALLPARK_KERNELS");
    DIR *folder = opendir(copy->folder);
    assert_non_null(folder);
    for (struct dirent *entry; (entry = readdir(folder)) != NULL;) {
        char path[1024];
        snprintf(path, sizeof path, "%s/%s", copy->folder, entry->d_name);
        if (entry->d_name[0] != '.') unlink(path);
    }
    closedir(folder);
    rmdir(copy->folder);
}

#endif
