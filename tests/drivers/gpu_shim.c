/* gpu_shim.c: loaded before the program (LD_PRELOAD), makes every device a GPU: it says that it is one, that
 * its registers hold one number, and that it has no double. So the program uses what it uses on GPUs. With
 * PRETEND_ROUGH in the environment it denies that quotients and roots are rounded correctly, and with
 * PRETEND_ROUGH=only says nothing else.
 *
 * Knows: real_driver.h.   Does not know: what the answers are for. */
#define _GNU_SOURCE
#include "real_driver.h"

#include <stdlib.h>
#include <string.h>

cl_int clGetDeviceInfo(cl_device_id device, cl_device_info what, size_t size, void *to, size_t *size_ret) {
    const cl_int code = real_device_info(device, what, size, to, size_ret);
    if (code != CL_SUCCESS || to == NULL) return code;
    const char *const rough = getenv("PRETEND_ROUGH");
    if (rough != NULL && what == CL_DEVICE_SINGLE_FP_CONFIG)
        *(cl_device_fp_config *)to &= ~(cl_device_fp_config)CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT;
    if (rough != NULL && strcmp(rough, "only") == 0) return code;
    if (what == CL_DEVICE_TYPE) *(cl_device_type *)to = CL_DEVICE_TYPE_GPU;
    if (what == CL_DEVICE_NATIVE_VECTOR_WIDTH_FLOAT) *(cl_uint *)to = 1;
    if (what == CL_DEVICE_DOUBLE_FP_CONFIG) *(cl_device_fp_config *)to = 0;
    return code;
}
