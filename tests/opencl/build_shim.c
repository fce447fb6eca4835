/* build_shim.c: loaded before the program (LD_PRELOAD), notes each kernel build: a line more in the file that
 * BUILD_LOG names, a number that stands for source and options. The first BUILD_FAILURES builds (none without
 * it) fail as a driver's do that was disturbed.
 *
 * Knows: clBuildProgram.   Does not know: what is built. */
#define _GNU_SOURCE
#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>
#include <dlfcn.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

/* FNV-1a (G. Fowler, L. Noll, P. Vo, 1991). */
static uint64_t add_text(uint64_t hash, const char *text) {
    for (; text != NULL && *text != '\0'; ++text) hash = (hash ^ (unsigned char)*text) * 0x100000001b3u;
    return hash;
}

static uint64_t number_of(cl_program program, const char *options) {
    size_t size = 0;
    clGetProgramInfo(program, CL_PROGRAM_SOURCE, 0, NULL, &size);
    char *const source = calloc(size + 1, 1);
    if (source != NULL) clGetProgramInfo(program, CL_PROGRAM_SOURCE, size, source, NULL);
    const uint64_t hash = add_text(add_text(0xcbf29ce484222325u, source), options);
    free(source);
    return hash;
}

typedef cl_int Build(cl_program, cl_uint, const cl_device_id *, const char *,
                     void(CL_CALLBACK *)(cl_program, void *), void *);

cl_int clBuildProgram(cl_program program, cl_uint count, const cl_device_id *devices, const char *options,
                      void(CL_CALLBACK *notify)(cl_program, void *), void *user_data) {
    static int seen;
    const char *const path = getenv("BUILD_LOG"), *const failures = getenv("BUILD_FAILURES");
    FILE *const log = path != NULL ? fopen(path, "a") : NULL;
    if (log != NULL) {
        fprintf(log, "%016llx\n", (unsigned long long)number_of(program, options));
        fclose(log);
    }
    if (failures != NULL && seen++ < atoi(failures)) return CL_BUILD_PROGRAM_FAILURE;
    void *const next = dlsym(RTLD_NEXT, "clBuildProgram");
    Build *build;
    *(void **)&build = next;
    return build(program, count, devices, options, notify, user_data);
}
