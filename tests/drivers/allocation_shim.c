/* allocation_shim.c: loaded before the program (LD_PRELOAD), makes every device one whose largest buffer has
 * PRETEND_ALLOCATION bytes: it says so, and makes no larger one.
 *
 * Knows: real_driver.h, clCreateBuffer.   Does not know: what is put into buffers. */
#define _GNU_SOURCE
#include "real_driver.h"

#include <stdlib.h>

typedef cl_mem Create(cl_context, cl_mem_flags, size_t, void *, cl_int *);

static cl_ulong most(void) {
    const char *const text = getenv("PRETEND_ALLOCATION");
    return text != NULL ? strtoull(text, NULL, 10) : CL_ULONG_MAX;
}

cl_int clGetDeviceInfo(cl_device_id device, cl_device_info what, size_t size, void *to, size_t *size_ret) {
    const cl_int code = real_device_info(device, what, size, to, size_ret);
    if (code != CL_SUCCESS || to == NULL || what != CL_DEVICE_MAX_MEM_ALLOC_SIZE) return code;
    if (*(cl_ulong *)to > most()) *(cl_ulong *)to = most();
    return code;
}

cl_mem clCreateBuffer(cl_context context, cl_mem_flags flags, size_t size, void *data, cl_int *code) {
    void *const next = dlsym(RTLD_NEXT, "clCreateBuffer");
    Create *create;
    *(void **)&create = next;
    if (size <= most()) return create(context, flags, size, data, code);
    if (code != NULL) *code = CL_INVALID_BUFFER_SIZE;
    return NULL;
}
