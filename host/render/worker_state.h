/* worker_state.h: what a worker is made from, and what it has while it works; shared by worker.c, which runs
 * it, worker_buffers.c and worker_read.c.
 *
 * Knows: OpenCL's objects, the numbers of arrays and arguments.   Does not know: when chunks are traced. */
#ifndef BP_RENDER_WORKER_STATE_H
#define BP_RENDER_WORKER_STATE_H

#include "chunk_sizer.h"
#include "opencl/program.h"
#include "packed/effects.h"
#include "packed/pack.h"

/* Returns from the enclosing function, naming `call`, when `code` is a failure. */
#define CL_TRY(worker, code, call)                                                                           \
    do {                                                                                                     \
        const cl_int cl_try_code_ = (code);                                                                  \
        if (cl_try_code_ != CL_SUCCESS) return bp_cl_fail(err, cl_try_code_, call, (worker)->device);        \
    } while (0)

/* Everything a worker needs to know beyond the packed scene. */
typedef struct BpWorkerSetup {
    BpProgramOptions program;
    uint32_t width, height;
    uint32_t replicates;
    int32_t scale_log2;
    uint32_t max_depth;
    uint64_t seed;
    bool pixel_center;
    uint32_t local_size;                 /* 0: choose */
    uint32_t samples_per_item;           /* of the pool form, on average; 0: choose */
    const char *extra_name, *extra_text; /* Optional. A file appended to the program. */
    bool untested;                       /* do without the device's self-test */
    uint64_t build_mark;                 /* 0, or a number that makes the source a new one */
    uint32_t threads;                    /* of a processor that may be used; 0: all */
    BpDevice *device;                    /* Optional. Open already, to be used and not to be closed. */
} BpWorkerSetup;

/* Work-items in a work-group, unless another number is set. */
#define BP_LOCAL_SIZE_SAMPLE 64u
#define BP_LOCAL_SIZE_PACKET 1u

#define BP_WORKER_FLIGHT 2 /* chunks queued at a time */

/* The numbers of arrays and of arguments in the lists of scene_types.h. */
#define BP_COUNT_ARRAY(numbers, element, name, count, what) +1
#define BP_SCENE_NUMBER_MEMBER(name) name,
enum {
    BP_SCENE_ARRAYS = SCENE_ARRAYS_OF_PACK(BP_COUNT_ARRAY) SCENE_ARRAYS_OF_FOCUSERS(BP_COUNT_ARRAY)
        SCENE_ARRAYS_OF_SLOTS(BP_COUNT_ARRAY) SCENE_ARRAYS_OF_LAMPS(BP_COUNT_ARRAY)
            SCENE_ARRAYS_OF_TREE(BP_COUNT_ARRAY) SCENE_ARRAYS_OF_TRIANGLES(BP_COUNT_ARRAY)
                SCENE_ARRAYS_OF_NORMALS(BP_COUNT_ARRAY) SCENE_ARRAYS_OF_COORDINATES(BP_COUNT_ARRAY)
                    SCENE_ARRAYS_OF_CAPSULES(BP_COUNT_ARRAY),
    /* The last, and those before them, one after the other: */
    BP_COORDINATE_ARRAYS = 0 SCENE_ARRAYS_OF_COORDINATES(BP_COUNT_ARRAY),
    BP_NORMAL_ARRAYS = 0 SCENE_ARRAYS_OF_NORMALS(BP_COUNT_ARRAY),
    BP_TRIANGLE_ARRAYS = 0 SCENE_ARRAYS_OF_TRIANGLES(BP_COUNT_ARRAY),
    BP_CAPSULE_ARRAYS = 0 SCENE_ARRAYS_OF_CAPSULES(BP_COUNT_ARRAY),
    BP_SCENE_BUFFERS_MAX = BP_SCENE_ARRAYS * SCENE_PARTS_MAX
};

typedef struct BpWorker {
    BpDevice *device;
    bool owns_device;
    BpProgram *program;
    cl_kernel trace, accumulate;
    BpPacked packed;                            /* where the device uses it in place; else empty */
    cl_mem scene_buffers[BP_SCENE_BUFFERS_MAX]; /* in the order of the lists in scene_types.h, part by part */
    size_t scene_buffer_count;
    uint32_t parts, part_length; /* of arrays that grow with the spheres; length 0: they are whole */
    uint32_t scene_arguments;    /* of kernels that trace, the first ones: these, then the scene's numbers */
    cl_mem sums, fine_sums, counts, tallies, samples;
    cl_mem lamp_rays; /* of each work-item of a chunk; used only if the scene `has_lamps` */
    bool has_lamps;
    bool has_triangles;   /* the kernel knows them, and is given their arrays and numbers */
    bool has_normals;     /* the same of the normals at their vertices */
    bool has_coordinates; /* and of their texture coordinates */
    bool has_capsules;    /* the same of their arrays */
    cl_mem pixel_list;    /* NULL: chunks are ranges of pixels */
    size_t real_size;
    uint32_t SCENE_NUMBERS(BP_SCENE_NUMBER_MEMBER) first_triangles, normal_leaves, coordinate_leaves,
        coloured_slots, pixels;
    BpKernelForm form;
    uint32_t samples_per_item; /* pixel samples of a work-item, on average in the pool form */
    size_t local_size;
    uint32_t samples_capacity,
        samples_limit; /* of the buffer of raw samples; limit: the most it may grow to */
    uint64_t scene_bytes, picture_bytes;
    /* Chunks under way, oldest first. */
    struct BpFlight {
        cl_event trace_start, accumulate_end;
        uint64_t samples;
    } flights[BP_WORKER_FLIGHT];
    int flight_count;
    /* Measured on chunks that are done. */
    double device_seconds, accumulate_seconds;
    BpChunkSizer sizer;
    double first_launch_seconds, self_test_seconds;
    uint64_t samples_done;
} BpWorker;

#endif
