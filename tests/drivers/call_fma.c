/* call_fma.c: a kernel of one line that calls a library function, on the first device that the loader finds.
 *
 * Exit code 0: it gave the right number. 1: it gave a wrong one, or an OpenCL function failed, which is
 * named. A driver that crashes ends the program by a signal: Mesa 25.2.8 as Ubuntu 24.04 has it does so for
 * fma, ldexp and sin.
 *
 * Knows: OpenCL.   Does not know: Ballpark, so that what fails here is the driver's fault. */
#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>
#include <stdio.h>

static const char *const source =
    "__kernel void call_fma(__global float *x) { x[3] = fma(x[0], x[1], x[2]); }\n";

static cl_int failed(const char *what, cl_int code) {
    if (code != CL_SUCCESS) fprintf(stderr, "%s: error %d\n", what, code);
    return code;
}

int main(void) {
    cl_platform_id platform = NULL;
    cl_device_id device = NULL;
    cl_int code = CL_SUCCESS;
    float numbers[4] = {3.0f, 5.0f, 7.0f, 0.0f};
    const size_t one = 1;
    if (failed("clGetPlatformIDs", clGetPlatformIDs(1, &platform, NULL)) ||
        failed("clGetDeviceIDs", clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, 1, &device, NULL)))
        return 1;
    cl_context context = clCreateContext(NULL, 1, &device, NULL, NULL, &code);
    if (failed("clCreateContext", code)) return 1;
    cl_command_queue queue = clCreateCommandQueue(context, device, 0, &code);
    if (failed("clCreateCommandQueue", code)) return 1;
    cl_program program = clCreateProgramWithSource(context, 1, (const char **)&source, NULL, &code);
    if (failed("clCreateProgramWithSource", code) ||
        failed("clBuildProgram", clBuildProgram(program, 1, &device, "", NULL, NULL)))
        return 1;
    cl_kernel kernel = clCreateKernel(program, "call_fma", &code);
    if (failed("clCreateKernel", code)) return 1;
    cl_mem memory =
        clCreateBuffer(context, CL_MEM_READ_WRITE | CL_MEM_COPY_HOST_PTR, sizeof numbers, numbers, &code);
    if (failed("clCreateBuffer", code) ||
        failed("clSetKernelArg", clSetKernelArg(kernel, 0, sizeof memory, &memory)) ||
        failed("clEnqueueNDRangeKernel",
               clEnqueueNDRangeKernel(queue, kernel, 1, NULL, &one, NULL, 0, NULL, NULL)) ||
        failed("clEnqueueReadBuffer",
               clEnqueueReadBuffer(queue, memory, CL_TRUE, 0, sizeof numbers, numbers, 0, NULL, NULL)))
        return 1;
    clReleaseMemObject(memory);
    clReleaseKernel(kernel);
    clReleaseProgram(program);
    clReleaseCommandQueue(queue);
    clReleaseContext(context);
    printf("fma(3, 5, 7) = %g\n", (double)numbers[3]);
    return numbers[3] >= 22.0f && numbers[3] <= 22.0f ? 0 : 1;
}
