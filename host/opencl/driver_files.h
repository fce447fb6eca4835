/* driver_files.h: the files by which the OpenCL loader finds its drivers.
 *
 * In:    OCL_ICD_VENDORS, OPENCL_VENDOR_PATH, folders of .icd files.   Out: the files, and what each names.
 * Knows: where loaders look: ocl-icd (libOpenCL(7)), and Khronos', which accepts folders only.
 * Does not know: what the drivers do. */
#ifndef BP_OPENCL_DRIVER_FILES_H
#define BP_OPENCL_DRIVER_FILES_H

#include <stddef.h>

#define BP_DRIVER_VENDORS "OCL_ICD_VENDORS"

enum { BP_DRIVERS_MAX = 64 };

typedef struct BpDriverFiles {
    char files[BP_DRIVERS_MAX][512];
    size_t count;
    char place[512]; /* where they were looked for */
} BpDriverFiles;

void bp_driver_files_find(BpDriverFiles *drivers);

/* The library that the file names on its first line; if `file` is a library, `file` itself. "": none, so the
 * loader finds no driver there either. */
void bp_driver_files_library(const char *file, char library[256]);

#endif
