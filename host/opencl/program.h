/* program.h: assembles the kernel's source for one set of choices.
 *
 * In:    which effects, settings and form.   Out: one OpenCL C source text, or a built program.
 * Knows: the files of kernels/ and their order, in one list.   Does not know: scenes, buffers.
 *
 * Every switch is a #define in the first lines of the text, so the text alone decides what is compiled (some
 * drivers' caches ignore -D). Each file is opened by `#line 1 "file"`.
 * BALLPARK_KERNELS=DIR in the environment reads the files from DIR instead of the embedded copies: for work
 * on the kernels without building the host again. */
#ifndef BP_OPENCL_PROGRAM_H
#define BP_OPENCL_PROGRAM_H

#include "base/names.h"
#include "device.h"

#include <stdio.h>

/* The embedded text of one file of kernels/, by its path there ("light/sky.cl"), static; NULL when there is
 * none of that name. */
const char *bp_kernel_file(const char *name);

/* The text of one file of kernels/ as programs get it: embedded, or from BALLPARK_KERNELS. The caller frees
 * *text. BP_ERR_FILE: there is no such file. */
BpStatus bp_kernel_text(const char *name, char **text, BpError *err);

/* The same of one file after the other, at least one, as `extra_text` of a program whose `extra_name` is the
 * first. */
BpStatus bp_kernel_texts(const char *const *names, size_t count, char **text, BpError *err);
/* For a source that is put together in a stream of open_memstream(): prints one such text behind a line that
 * names it; and closes the stream: where `status` is not BP_OK, or memory ran out, *text becomes NULL. */
BpStatus bp_kernel_print(const char *name, FILE *out, BpError *err);
BpStatus bp_kernel_close(FILE *out, BpStatus status, char **text, BpError *err);

/* A work-item of the packet form traces this many pixel samples, as many at a time as it has lanes: enough
 * that the last, partly filled round weighs little, few enough that a small chunk still keeps all cores busy.
 */
#define BP_PACKET_SAMPLES_PER_ITEM 512u
/* A work-item of the pool form has this many pixel samples to trace on average, fewer where there would not
 * be BP_POOL_ITEMS_PER_UNIT work-items for each compute unit: enough to average long paths with others, few
 * enough that no group works alone for long at the end. In a model of lock-step, warps of 32 gained 1.5 with
 * 16. */
#define BP_POOL_SAMPLES_PER_ITEM 16u
#define BP_POOL_ITEMS_PER_UNIT 1024u
/* Work-items in a work-group of the sample form, at most: they share an array of this length. */
#define BP_SAMPLE_GROUP_MAX 64u

typedef struct BpProgramOptions {
    uint32_t effects;     /* bits of effects.h */
    bool tree;            /* spheres are found through a tree; else they are a list */
    bool focuser_pairs;   /* code for light that comes by way of two focusers, if it has any for one */
    bool triangles_alone; /* no code for spheres: there are none, no lamps to send rays to and no media */
    BP_SETTING_LIST(BP_SETTING_MEMBER)
    BpKernelForm form;     /* not BP_KERNEL_AUTO */
    uint32_t tree_width;   /* 2, 4, 8 or 16 */
    uint32_t packet_lanes; /* 8 or 16; of the packet form alone */
    bool pilot;            /* paths can choose as those of a pilot do */
    bool pixel_list;       /* chunks take their pixels from a list */
    uint32_t parts;        /* 2 to SCENE_PARTS_MAX: arrays that grow with the spheres come in so many parts */
    uint32_t part_length;  /* of so many elements each */
    bool double_refine;    /* refine intersections in double; else error-free float transforms */
    bool own_rounding;     /* round quotients and roots of floats by fma; bp_program_build sets it where the
                              device does not round them correctly, unless rounding does not matter */
} BpProgramOptions;

/* The whole source. `extra_name`, `extra_text`: Optional, a file appended at the end (probe kernels of
 * tests). The caller frees *source. BP_ERR_FILE when BALLPARK_KERNELS lacks a file. */
BpStatus bp_program_source(const BpProgramOptions *options, const char *extra_name, const char *extra_text,
                           char **source, BpError *err);

typedef struct BpProgram {
    cl_program program;
    uint64_t key;         /* hash of source and build options: equal keys, equal programs */
    double build_seconds; /* clBuildProgram; the first launch compiles more on some drivers; 0: the device had
                             built the same program before */
    char *log;            /* build log, "" when the driver said nothing */
} BpProgram;

BpStatus bp_program_build(BpDevice *device, const BpProgramOptions *options, const char *extra_name,
                          const char *extra_text, BpProgram **program, BpError *err);
void bp_program_destroy(BpProgram **program);

#endif
