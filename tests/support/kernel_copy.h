/* kernel_copy.h: a copy of kernels/ with texts replaced, which the program then reads.
 *
 * Knows: files, BALLPARK_KERNELS.   Does not know: what the patch does. */
#ifndef TESTS_SUPPORT_KERNEL_COPY_H
#define TESTS_SUPPORT_KERNEL_COPY_H

#include "support/unit_test.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

typedef struct KernelCopy {
    char folder[64];
} KernelCopy;

static inline char *kernel_text(const char *path) {
    FILE *file = fopen(path, "rb");
    if (file == NULL) fail_msg("cannot read %s", path);
    static char text[1 << 18];
    const size_t size = fread(text, 1, sizeof text - 1, file);
    fclose(file);
    text[size] = '\0';
    return text;
}

enum { KERNEL_PATH = 1024 };

static inline void kernel_copy_join(char *path, const char *folder, const char *name) {
    const int length = snprintf(path, KERNEL_PATH, "%s/%s", folder, name);
    assert_in_range(length, 1, KERNEL_PATH - 1);
}

/* Copies the folder `from` and what is in it to `to`, which it makes. */
static inline void kernel_copy_folder(const char *from, const char *to) {
    DIR *folder = opendir(from);
    assert_non_null(folder);
    assert_true(mkdir(to, 0700) == 0 || errno == EEXIST);
    for (struct dirent *entry; (entry = readdir(folder)) != NULL;) {
        char source[KERNEL_PATH], copy[KERNEL_PATH];
        struct stat about;
        if (entry->d_name[0] == '.') continue;
        kernel_copy_join(source, from, entry->d_name);
        kernel_copy_join(copy, to, entry->d_name);
        assert_int_equal(stat(source, &about), 0);
        if (S_ISDIR(about.st_mode)) {
            kernel_copy_folder(source, copy);
            continue;
        }
        FILE *file = fopen(copy, "wb");
        assert_non_null(file);
        fputs(kernel_text(source), file);
        assert_int_equal(fclose(file), 0);
    }
    closedir(folder);
}

static inline void kernel_copy_remove(const char *path) {
    DIR *folder = opendir(path);
    for (struct dirent *entry; folder != NULL && (entry = readdir(folder)) != NULL;) {
        char inner[KERNEL_PATH];
        kernel_copy_join(inner, path, entry->d_name);
        if (strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0) kernel_copy_remove(inner);
    }
    if (folder != NULL) closedir(folder);
    remove(path);
}

/* Replaces `find`, which must stand in the copy's file `name` (its path in kernels/) exactly once. */
static inline void kernel_copy_patch(const KernelCopy *copy, const char *name, const char *find,
                                     const char *replacement) {
    char path[KERNEL_PATH];
    kernel_copy_join(path, copy->folder, name);
    const char *text = kernel_text(path), *place = strstr(text, find);
    if (place == NULL || strstr(place + 1, find) != NULL)
        fail_msg("%s does not hold exactly once: %s", name, find);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    fprintf(file, "%.*s%s%s", (int)(place - text), text, replacement, place + strlen(find));
    assert_int_equal(fclose(file), 0);
}

/* Copies kernels/ with one text replaced, as kernel_copy_patch does, and points BALLPARK_KERNELS there. */
static inline void kernel_copy_open(KernelCopy *copy, const char *name, const char *find,
                                    const char *replacement) {
    snprintf(copy->folder, sizeof copy->folder, "/tmp/ballpark-kernels-XXXXXX");
    assert_non_null(mkdtemp(copy->folder));
    kernel_copy_folder(SOURCE_DIR "/kernels", copy->folder);
    kernel_copy_patch(copy, name, find, replacement);
    setenv("BALLPARK_KERNELS", copy->folder, 1);
}

static inline void kernel_copy_close(KernelCopy *copy) {
    unsetenv("BALLPARK_KERNELS");
    kernel_copy_remove(copy->folder);
}

#endif
