/* pocl_probe.c: see pocl_probe.h. */
#include "pocl_probe.h"

#include "device.h"

#include <stdio.h>
#include <time.h>
#include <unistd.h>

BpStatus bp_pocl_try_kernel(const BpDeviceInfo *info, BpError *err) {
    char source[128];
    BpDevice *device = NULL;
    cl_program program = NULL;
    cl_kernel kernel = NULL;
    cl_mem word = NULL;
    const size_t one = 1;
    BpStatus status = BP_OK;
    snprintf(source, sizeof source, "__kernel void trial(__global uint *word) { *word = %luu; } /* %ld */",
             (unsigned long)time(NULL) & 0xfffffffful, (long)getpid());
    BP_TRY_GOTO(status, bp_device_open(info, &device, err), done);
    BP_TRY_GOTO(status, bp_device_build(device, source, NULL, &program, NULL, err), done);
    cl_int code = CL_SUCCESS;
    kernel = clCreateKernel(program, "trial", &code);
    if (code == CL_SUCCESS)
        word = clCreateBuffer(device->context, CL_MEM_WRITE_ONLY, sizeof(cl_uint), NULL, &code);
    if (code == CL_SUCCESS) code = clSetKernelArg(kernel, 0, sizeof(cl_mem), &word);
    if (code == CL_SUCCESS)
        code = clEnqueueNDRangeKernel(device->queue, kernel, 1, NULL, &one, &one, 0, NULL, NULL);
    if (code == CL_SUCCESS) code = clFinish(device->queue);
    if (code != CL_SUCCESS) status = bp_cl_fail(err, code, "running a first kernel", device);
done:
    if (word != NULL) clReleaseMemObject(word);
    if (kernel != NULL) clReleaseKernel(kernel);
    if (program != NULL) clReleaseProgram(program);
    bp_device_close(&device);
    return status;
}
