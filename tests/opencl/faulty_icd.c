/* faulty_icd.c: an OpenCL driver that does not survive being asked for its platforms.
 *
 * In:    FAULT, from the build: what it does: HANG, CRASH (abort), SEGV, EXIT (ends the process, as if all
 * were well), LEAVE and QUICK (the same by _exit and quick_exit), or LOAD (hangs while it is loaded).   Out:
 * nothing. Knows: the first call that an ICD loader makes. */
#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>
#include <CL/cl_icd.h>

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define EXPORT __attribute__((visibility("default")))
enum { HANG, CRASH, SEGV, EXIT, LEAVE, QUICK, LOAD };

/* No compiler or sanitizer sees that nothing lies there. */
static volatile int *volatile nowhere = (volatile int *)16;

__attribute__((constructor)) static void on_load(void) {
    while (FAULT == LOAD) sleep(1);
}

EXPORT cl_int CL_API_CALL clIcdGetPlatformIDsKHR(cl_uint room, cl_platform_id *ids, cl_uint *count);
cl_int CL_API_CALL clIcdGetPlatformIDsKHR(cl_uint room, cl_platform_id *ids, cl_uint *count) {
    (void)room, (void)ids, (void)count;
    while (FAULT == HANG) sleep(1);
    if (FAULT == EXIT) exit(0);
    if (FAULT == LEAVE) _exit(0);
    if (FAULT == QUICK) quick_exit(0);
    if (FAULT == SEGV) *nowhere = 1;
    abort(); /* which no mask of signals holds off */
    return CL_OUT_OF_HOST_MEMORY;
}

EXPORT void *CL_API_CALL clGetExtensionFunctionAddress(const char *name);
void *CL_API_CALL clGetExtensionFunctionAddress(const char *name) {
    return strcmp(name, "clIcdGetPlatformIDsKHR") == 0 ? (void *)(size_t)clIcdGetPlatformIDsKHR : NULL;
}

/* The loader wants it to be there. */
EXPORT cl_int CL_API_CALL clGetPlatformInfo(cl_platform_id platform, cl_platform_info what, size_t size,
                                            void *to, size_t *size_ret);
cl_int CL_API_CALL clGetPlatformInfo(cl_platform_id platform, cl_platform_info what, size_t size, void *to,
                                     size_t *size_ret) {
    (void)platform, (void)what, (void)size, (void)to, (void)size_ret;
    return CL_INVALID_PLATFORM;
}
