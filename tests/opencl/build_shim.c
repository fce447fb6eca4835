/* build_shim.c: loaded before the program (LD_PRELOAD), notes each kernel build: a line more in the file that
 * BUILD_LOG names. The first BUILD_FAILURES builds (none without it) fail as a driver's do that was
 * disturbed.
 *
 * Knows: clBuildProgram, the line of a program that says how many paths a packet has.
 * Does not know: what else is built. */
#define _GNU_SOURCE
#define CL_TARGET_OPENCL_VERSION 120
#include "base/hash.h"

#include <CL/cl.h>
#include <dlfcn.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A line: a number that stands for source and options, and how many paths a packet has (0: it is none). */
static void note(FILE *log, cl_program program, const char *options) {
    static const char lanes[] = "#define PACKET_LANES ";
    size_t size = 0;
    clGetProgramInfo(program, CL_PROGRAM_SOURCE, 0, NULL, &size);
    char *const source = calloc(size + 1, 1);
    if (source == NULL) return;
    clGetProgramInfo(program, CL_PROGRAM_SOURCE, size, source, NULL);
    const char *const found = strstr(source, lanes);
    const uint64_t number = bp_hash_text(bp_hash_text(BP_HASH_START, source), options != NULL ? options : "");
    fprintf(log, "%016llx %d\n", (unsigned long long)number,
            found != NULL ? atoi(found + sizeof lanes - 1) : 0);
    free(source);
}

typedef cl_int Build(cl_program, cl_uint, const cl_device_id *, const char *,
                     void(CL_CALLBACK *)(cl_program, void *), void *);

cl_int clBuildProgram(cl_program program, cl_uint count, const cl_device_id *devices, const char *options,
                      void(CL_CALLBACK *notify)(cl_program, void *), void *user_data) {
    static int seen;
    const char *const path = getenv("BUILD_LOG"), *const failures = getenv("BUILD_FAILURES");
    FILE *const log = path != NULL ? fopen(path, "a") : NULL;
    if (log != NULL) {
        note(log, program, options);
        fclose(log);
    }
    if (failures != NULL && seen++ < atoi(failures)) return CL_BUILD_PROGRAM_FAILURE;
    void *const next = dlsym(RTLD_NEXT, "clBuildProgram");
    Build *build;
    *(void **)&build = next;
    return build(program, count, devices, options, notify, user_data);
}
