/* build_shim.c: loaded before the program (LD_PRELOAD), notes each kernel build: a byte more in the file that
 * BUILD_LOG names. The first BUILD_FAILURES builds (none without it) fail as a driver's do that was
 * disturbed.
 *
 * Knows: clBuildProgram.   Does not know: what is built. */
#define _GNU_SOURCE
#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>

typedef cl_int Build(cl_program, cl_uint, const cl_device_id *, const char *,
                     void(CL_CALLBACK *)(cl_program, void *), void *);

cl_int clBuildProgram(cl_program program, cl_uint count, const cl_device_id *devices, const char *options,
                      void(CL_CALLBACK *notify)(cl_program, void *), void *user_data) {
    static int seen;
    const char *const path = getenv("BUILD_LOG"), *const failures = getenv("BUILD_FAILURES");
    FILE *const log = path != NULL ? fopen(path, "a") : NULL;
    if (log != NULL) {
        fputc('b', log);
        fclose(log);
    }
    if (failures != NULL && seen++ < atoi(failures)) return CL_BUILD_PROGRAM_FAILURE;
    void *const next = dlsym(RTLD_NEXT, "clBuildProgram");
    Build *build;
    *(void **)&build = next;
    return build(program, count, devices, options, notify, user_data);
}
