/* narrow_vectors.c: loaded before the program (LD_PRELOAD), makes every device one whose vectors have at most
 * NARROW_VECTORS floats. PoCL asks the processor, whatever POCL_KERNELLIB_NAME says.
 *
 * In:    NARROW_VECTORS, a number.   Knows: real_driver.h.   Does not know: what the answers are for. */
#define _GNU_SOURCE
#include "real_driver.h"

#include <stdlib.h>

cl_int clGetDeviceInfo(cl_device_id device, cl_device_info what, size_t size, void *to, size_t *size_ret) {
    const cl_int code = real_device_info(device, what, size, to, size_ret);
    const char *const text = getenv("NARROW_VECTORS");
    if (code != CL_SUCCESS || to == NULL || text == NULL || what != CL_DEVICE_NATIVE_VECTOR_WIDTH_FLOAT)
        return code;
    const cl_uint most = (cl_uint)strtoul(text, NULL, 10);
    if (*(cl_uint *)to > most) *(cl_uint *)to = most;
    return code;
}
