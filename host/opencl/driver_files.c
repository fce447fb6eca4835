/* driver_files.c: see driver_files.h. */
#include "driver_files.h"

#include <dirent.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define VENDORS_DEFAULT "/etc/OpenCL/vendors"

static bool ends_with(const char *text, const char *end) {
    const size_t length = strlen(text), tail = strlen(end);
    return length >= tail && strcmp(text + length - tail, end) == 0;
}

static bool is_folder(const char *path) {
    struct stat found;
    return stat(path, &found) == 0 && S_ISDIR(found.st_mode);
}

static void add_driver(BpDriverFiles *drivers, const char *folder, const char *name) {
    if (drivers->count == BP_DRIVERS_MAX) return;
    const int length = snprintf(drivers->files[drivers->count], sizeof drivers->files[0], "%s%s%s", folder,
                                folder[0] != '\0' ? "/" : "", name);
    if (length > 0 && (size_t)length < sizeof drivers->files[0]) ++drivers->count;
}

static int by_name(const void *a, const void *b) {
    return strcmp(a, b);
}

void bp_driver_files_find(BpDriverFiles *drivers) {
    const char *vendors = getenv(BP_DRIVER_VENDORS), *path = getenv("OPENCL_VENDOR_PATH");
    const char *default_path = path != NULL && path[0] != '\0' ? path : VENDORS_DEFAULT;
    const bool named = vendors != NULL && vendors[0] != '\0' && !is_folder(vendors);
    const char *folder = vendors != NULL && vendors[0] != '\0' ? vendors : default_path;
    drivers->count = 0;
    snprintf(drivers->place, sizeof drivers->place, "%s", folder);
    if (named) { /* one file, or a library */
        char beside[512];
        snprintf(beside, sizeof beside, "%s/%s", default_path, vendors);
        const bool there = strchr(vendors, '/') == NULL && access(beside, R_OK) == 0;
        add_driver(drivers, "", there ? beside : vendors);
        return;
    }
    DIR *open = opendir(folder);
    if (open == NULL) return;
    for (const struct dirent *entry = readdir(open); entry != NULL; entry = readdir(open))
        if (ends_with(entry->d_name, ".icd")) add_driver(drivers, folder, entry->d_name);
    closedir(open);
    qsort(drivers->files, drivers->count, sizeof drivers->files[0], by_name);
}

void bp_driver_files_library(const char *file, char library[256]) {
    library[0] = '\0';
    FILE *in = ends_with(file, ".icd") ? fopen(file, "r") : NULL;
    if (in == NULL || fgets(library, 256, in) == NULL) snprintf(library, 256, "%s", in == NULL ? file : "");
    library[strcspn(library, "\r\n")] = '\0';
    if (in != NULL) fclose(in);
}
