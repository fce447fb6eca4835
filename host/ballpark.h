/* ballpark.h: the public face of libballpark, a path tracer for spheres on any OpenCL device.
 *
 * The straight line: load a scene, open a render of it on a list of devices, step until content, read the
 * picture, destroy.
 *
 *     BpScene *scene = NULL; BpRender *render = NULL; BpError err = {0};
 *     bp_scene_load("cover.json", &scene, &err);
 *     bp_render_create(scene, NULL, NULL, &render, &err);
 *     do bp_render_step(render, &progress, &err); while (!progress.finished);
 *     bp_render_read(render, &picture, &err);
 *
 * General rules, stated once:
 * - Fallible functions return BpStatus and take `BpError *err` last; `err` may be NULL. Begin with a zeroed
 *   BpError and end with bp_error_clear().
 * - `_create` and `_load` give a heap object that the caller owns; `_destroy` takes its address, frees it and
 *   sets it to NULL; it accepts a NULL object. `_clear` releases what a caller-owned struct holds.
 * - Strings are UTF-8 and copied; nothing keeps a caller's pointer beyond the call unless it says so.
 * - A handle is used by one thread at a time; different handles may be used by different threads.
 * - Colours are linear RGB radiance. Lengths are the scene's own unit. Angles are degrees where named so. */
#ifndef BALLPARK_H
#define BALLPARK_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---- status and errors ------------------------------------------------------------------------------- */

/* name, exit code of the command line program, text */
#define BP_STATUS_LIST(X)                                                                                    \
    X(BP_OK, 0, "done")                                                                                      \
    X(BP_ERR_FILE, 1, "file error")                                                                          \
    X(BP_ERR_MEMORY, 1, "out of memory")                                                                     \
    X(BP_ERR_DEVICE, 1, "device error")                                                                      \
    X(BP_ERR_BUILD, 1, "kernel build error")                                                                 \
    X(BP_ERR_LIMIT, 1, "limit exceeded")                                                                     \
    X(BP_ERR_USAGE, 2, "bad command line")                                                                   \
    X(BP_ERR_SCENE, 2, "bad scene")                                                                          \
    X(BP_ERR_DISAGREE, 3, "kernel and reference disagree")                                                   \
    X(BP_ERR_INTERRUPTED, 130, "interrupted")

typedef enum BpStatus {
#define BP_STATUS_ENUM(name, exit_code, text) name,
    BP_STATUS_LIST(BP_STATUS_ENUM)
#undef BP_STATUS_ENUM
} BpStatus;

/* The story of a failure. Zero it before first use. */
typedef struct BpError {
    BpStatus code;
    char message[1024]; /* what happened, where, and the remedy */
    char file[512];     /* the file at fault, or "" */
    int line, column;   /* from 1; 0 when unknown */
    char *attachment;   /* Optional. A long text, such as a whole build log. */
} BpError;

const char *bp_status_name(BpStatus status);
int bp_status_exit_code(BpStatus status);
void bp_error_clear(BpError *err);

/* "0.1.0 (commit abcdef1)"; static. */
const char *bp_version(void);

/* ---- scenes ------------------------------------------------------------------------------------------ */

typedef struct BpScene BpScene;

typedef enum BpTransfer { BP_TRANSFER_GAMMA2, BP_TRANSFER_SRGB, BP_TRANSFER_LINEAR } BpTransfer;

/* Reads and validates a scene document (docs: scenes/README.md). Errors name file:line:column. */
BpStatus bp_scene_load(const char *path, BpScene **scene, BpError *err);

/* The same from memory; `name` stands in messages where a path would, and relative files of the scene
 * (clouds) are looked up beside it. */
BpStatus bp_scene_parse(const char *text, size_t length, const char *name, BpScene **scene, BpError *err);

void bp_scene_destroy(BpScene **scene);

/* Overrides the picture's width in pixels; the height follows from the scene's aspect ratio. */
BpStatus bp_scene_set_width(BpScene *scene, uint32_t width, BpError *err);

/* What the document says; valid while the scene lives. */
typedef struct BpSceneInfo {
    const char *title, *source; /* "" where the document has none */
    uint32_t width, height, samples_per_pixel, max_depth;
    size_t spheres, materials;
    BpTransfer transfer;
} BpSceneInfo;
void bp_scene_info(const BpScene *scene, BpSceneInfo *info);

/* An effect that the kernel can simulate, and whether a scene calls for it. */
#define BP_EFFECTS_MAX 8
typedef struct BpEffectInfo {
    const char *name, *description; /* static: "lens", "a lens with an aperture: defocus blur" */
    bool simulated;
    char reason[160]; /* why it is in or out, for a person */
} BpEffectInfo;

/* Fills `list` and returns the number of effects; the same ones in the same order for every scene. */
size_t bp_scene_effects(const BpScene *scene, BpEffectInfo list[BP_EFFECTS_MAX]);

/* ---- devices ----------------------------------------------------------------------------------------- */

typedef enum BpDeviceType { BP_DEVICE_CPU, BP_DEVICE_GPU, BP_DEVICE_OTHER } BpDeviceType;

typedef struct BpDeviceInfo {
    unsigned number; /* what --device takes; counts over all platforms, from 0 */
    BpDeviceType type;
    char platform[128], name[256], vendor[128], version[128], driver[128];
    unsigned compute_units;
    unsigned float_lanes; /* of its vector instructions, as the driver says; 1: it has none, or hides them */
    uint64_t memory_bytes, largest_allocation_bytes;
    bool has_double, has_compiler, available;
    char refusal[128]; /* what the device lacks, so that it cannot render; "": nothing */
} BpDeviceInfo;

/* Every device of every platform. Free *list with free(). No platform or no device at all is not an error:
 * *count is 0. */
BpStatus bp_devices_list(BpDeviceInfo **list, size_t *count, BpError *err);

/* The device that `text` means: its number; "gpu" or "cpu" (the first); a part of its name, vendor, version
 * or platform (any case); or for NULL or "" the default: a GPU if there is one, else a CPU. A device that
 * cannot render is passed over; asked for by number, it is refused with what it lacks. A text that fits
 * different devices is an error. Every error lists what there is, or what to install. */
BpStatus bp_device_find(const char *text, BpDeviceInfo *device, BpError *err);

/* ---- rendering --------------------------------------------------------------------------------------- */

typedef enum BpPrecision { BP_PRECISION_SINGLE, BP_PRECISION_DOUBLE } BpPrecision;
typedef enum BpMath { BP_MATH_STRICT, BP_MATH_FAST } BpMath;
typedef enum BpNumerics { BP_NUMERICS_ROBUST, BP_NUMERICS_PLAIN } BpNumerics;
typedef enum BpSampler { BP_SAMPLER_INDEPENDENT, BP_SAMPLER_SOBOL } BpSampler;
typedef enum BpKernelForm { BP_KERNEL_AUTO, BP_KERNEL_SAMPLE, BP_KERNEL_PACKET } BpKernelForm;

/* Start from bp_render_defaults(), which takes samples and depth from the scene. */
typedef struct BpRenderOptions {
    uint64_t samples_per_pixel; /* 1 .. 2^32 - first_sample */
    uint64_t first_sample;      /* absolute number of the first sample of every pixel */
    uint32_t max_depth;         /* ray segments; 0 is black */
    uint64_t seed;
    BpPrecision precision;
    BpMath math;
    BpNumerics numerics;
    BpSampler sampler;
    BpKernelForm kernel;
    bool all_effects;       /* build the general kernel instead of the specialised one */
    uint32_t extra_effects; /* bit e: simulate effect e of bp_scene_effects() although nothing calls for it */
    bool adaptive;          /* samples_per_pixel is a mean: pixels get samples where the error is */
    bool features;          /* bp_render_features() will be asked */
    bool force;             /* render even on a device that fails its self-test */
    uint32_t replicates;    /* K of the error estimate; 0: the default; 1: no estimate */
    /* For tests and tuning; 0 means: choose. None of these changes a picture. */
    uint32_t chunk_samples;  /* samples in one dispatch */
    uint32_t local_size;     /* work-items in a work-group; at most 64 in the sample form */
    uint32_t tree_width;     /* children of a tree node: 2, 4, 8 or 16 */
    uint32_t packet_lanes;   /* paths that a work-item of the packet form follows at a time: 8 or 16 */
    bool force_list;         /* no tree, however many spheres */
    bool force_tree;         /* a tree, however few */
    bool force_float_refine; /* error-free float transforms even where the device has double */
    uint64_t build_mark;     /* written into the kernel as an unused type: a new one makes every cache miss */
} BpRenderOptions;

void bp_render_defaults(const BpScene *scene, BpRenderOptions *options);

typedef struct BpRender BpRender;

typedef struct BpProgress {
    uint64_t samples_done, samples_total; /* pixel samples */
    uint64_t segments;                    /* ray segments traced */
    double trace_seconds;                 /* spent tracing, by the wall clock */
    bool finished;
} BpProgress;

/* Opens a render. `devices`: Optional, `device_count` of them; none means the default device. The scene must
 * outlive the render. Builds the kernel, so this can take a second. */
BpStatus bp_render_create(const BpScene *scene, const BpRenderOptions *options, const BpDeviceInfo *devices,
                          size_t device_count, BpRender **render, BpError *err);

/* Traces for about 0.2 s and returns. `progress`: Optional. */
BpStatus bp_render_step(BpRender *render, BpProgress *progress, BpError *err);

void bp_render_destroy(BpRender **render);

/* ---- pictures ---------------------------------------------------------------------------------------- */

/* Linear radiance, row 0 at the top, 3 floats a pixel. */
typedef struct BpPicture {
    uint32_t width, height;
    float *rgb;        /* width * height * 3 */
    float *error;      /* standard error of each channel's mean, same shape; NaN where unknown */
    uint64_t *samples; /* valid samples of each pixel */
    /* Optional, see bp_render_features(): of what each pixel shows first, averaged over camera rays. */
    float *depth; /* along the view direction from the camera, mean of the rays that met something; +Inf: none
                     did */
    float *normal; /* 3 a pixel; unit, facing the camera, in the scene's axes; a ray that met nothing counts
                      as 0 */
    float *albedo; /* 3 a pixel; share of light scattered: the colour, 1 for glass, 0 for lamps and for
                      nothing */
} BpPicture;

/* Reads the picture as it stands, during or after the render; the caller clears it. */
BpStatus bp_render_read(BpRender *render, BpPicture *picture, BpError *err);
/* Adds depth, normal and albedo to a picture that bp_render_read() filled, for a render that was created with
 * options.features: from the camera rays of the first 16 samples of each pixel (fewer in a shorter render),
 * by the first device. BP_ERR_USAGE without options.features. */
BpStatus bp_render_features(BpRender *render, BpPicture *picture, BpError *err);
void bp_picture_clear(BpPicture *picture);

typedef enum BpFormat {
    BP_FORMAT_PNG,
    BP_FORMAT_PPM,
    BP_FORMAT_PPM_ASCII,
    BP_FORMAT_PFM,
    BP_FORMAT_EXR,
    BP_FORMAT_BPA
} BpFormat;

/* Writes atomically: a temporary file beside `path`, renamed when whole. */
BpStatus bp_picture_write(const BpPicture *picture, const char *path, BpFormat format, BpTransfer transfer,
                          BpError *err);

#ifdef __cplusplus
}
#endif
#endif
