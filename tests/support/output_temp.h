/* output_temp.h: a folder for the files of a test, and what is needed to look into them. */
#ifndef TESTS_SUPPORT_OUTPUT_TEMP_H
#define TESTS_SUPPORT_OUTPUT_TEMP_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* A new empty folder; its path goes to `folder`. */
static inline void temp_make(char folder[64]) {
    strcpy(folder, "/tmp/ballpark-test-XXXXXX");
    assert_non_null(mkdtemp(folder));
}

/* FOLDER/NAME in a buffer of the caller's. */
static inline const char *temp_path(char path[512], const char *folder, const char *name) {
    snprintf(path, 512, "%s/%s", folder, name);
    return path;
}

/* How many files and folders there are in `folder`. */
static inline int temp_count(const char *folder) {
    DIR *dir = opendir(folder);
    assert_non_null(dir);
    int count = 0;
    for (struct dirent *entry; (entry = readdir(dir)) != NULL;)
        count += strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0;
    closedir(dir);
    return count;
}

/* Removes `folder` and the files (no folders) in it. */
static inline void temp_remove(const char *folder) {
    DIR *dir = opendir(folder);
    assert_non_null(dir);
    for (struct dirent *entry; (entry = readdir(dir)) != NULL;) {
        char path[512];
        snprintf(path, sizeof path, "%s/%.400s", folder, entry->d_name);
        if (entry->d_name[0] != '.' || strlen(entry->d_name) > 2) remove(path);
    }
    closedir(dir);
    assert_int_equal(rmdir(folder), 0);
}

static inline void temp_write(const char *path, const void *bytes, size_t size) {
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

/* The whole file, ended by a 0 that *size does not count; free() it. */
static inline uint8_t *temp_read(const char *path, size_t *size) {
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    assert_int_equal(fseek(file, 0, SEEK_END), 0);
    const long length = ftell(file);
    rewind(file);
    uint8_t *bytes = malloc((size_t)length + 1);
    assert_non_null(bytes);
    assert_int_equal(fread(bytes, 1, (size_t)length, file), length);
    bytes[length] = 0;
    fclose(file);
    if (size != NULL) *size = (size_t)length;
    return bytes;
}

static inline void temp_assert_text(const char *path, const char *text) {
    uint8_t *bytes = temp_read(path, NULL);
    assert_string_equal((char *)bytes, text);
    free(bytes);
}

#endif
