/* render.h: the render loop behind ballpark.h, and what the program, `check` and the tests need in addition.
 *
 * In:    Scene, options, devices.   Out: a film; a report of times and counts.
 * Knows: OpenCL, packed buffers, chunks.   Does not know: files, stop rules, the terminal. */
#ifndef BP_RENDER_RENDER_H
#define BP_RENDER_RENDER_H

#include "film/film.h"
#include "opencl/calibration.h"
#include "packed/acceleration.h"
#include "packed/effects.h"

typedef struct BpRenderReport {
    BpDeviceInfo device;
    BpEffects effects;
    BpAcceleration acceleration;
    BpKernelForm kernel; /* the form that was built */
    BP_SETTING_LIST(BP_SETTING_MEMBER)
    uint64_t program_key; /* equal keys: the same program, nothing was built anew */
    uint64_t
        private_bytes; /* of one work-item of the trace kernel, as the driver reports it; 0: it does not */
    const char *build_log; /* valid while the render lives */
    double tree_seconds, pack_seconds, kernel_build_seconds;
    BpCalibration calibration;   /* of the first device; form BP_KERNEL_AUTO: none decided */
    double calibration_seconds;  /* of trials on all devices; 0: what they found was remembered */
    double self_test_seconds;    /* of the device's first use; 0 once it has passed */
    double first_launch_seconds; /* of the first, tiny chunk: drivers may compile once more there */
    double trace_seconds;        /* wall clock spent in steps, without the first launch */
    double device_seconds;       /* kernel time by the device's own clock: trace and accumulate */
    double accumulate_seconds;   /* of device_seconds, those of accumulate */
    uint64_t device_bytes;       /* allocated on the device: scene and picture */
    uint64_t scene_bytes;        /* of these, the scene */
    uint64_t resumed_samples;    /* of `samples`, those that were there before */
    uint64_t samples, segments, truncated_paths, invalid_samples, shadow_rays;
    uint64_t not_finite_samples, negative_samples, out_of_range_samples; /* of the invalid ones */
} BpRenderReport;

void bp_render_report(const BpRender *render, BpRenderReport *report);

/* Of BP_CAUSTICS_AUTO in the options makes what a render of them does. */
BpStatus bp_render_choose_caustics(const BpScene *scene, BpRenderOptions *options, const BpDeviceInfo *device,
                                   BpError *err);

/* bp_render_create() on devices that are open already (opencl/device.h) and stay open: what one render has
 * built, the next need not build again. They must outlive the render. device_count >= 1. */
struct BpDevice;
BpStatus bp_render_create_on(const BpScene *scene, const BpRenderOptions *options,
                             struct BpDevice *const *devices, size_t device_count, BpRender **render,
                             BpError *err);

/* Makes the render one of several, by the processes of the communicator, all of the same scene and options.
 * From then on all of them make the same calls: a step is a round of samples of which each traces a part, and
 * the film that is read is the sum of all of them on rank 0, and other ranks get no usable film. Before the
 * first step and before bp_render_resume(). The communicator must outlive the render. */
struct BpComm;
void bp_render_join(BpRender *render, struct BpComm *comm);

/* The film as it stands, read from the device; owned by the render, valid until the next step. */
BpStatus bp_render_read_film(BpRender *render, const BpFilm **film, BpError *err);

/* The same as it goes to a file: with what another render needs to continue from it, unless this one is
 * finished, and with depth, normal and albedo if the options have `features`. */
BpStatus bp_render_read_whole_film(BpRender *render, const BpFilm **film, BpError *err);

/* The sums of this process alone, whatever others have, to be destroyed by the caller; and the pixel samples
 * in it. */
BpStatus bp_render_read_own_film(BpRender *render, BpFilm **film, uint64_t *pixel_samples, BpError *err);

/* Whether a sample has been handed out yet. */
bool bp_render_has_begun(const BpRender *render);

/* bp_render_step() with one chunk: for tests that stop amid a pass. */
BpStatus bp_render_step_chunk(BpRender *render, BpProgress *progress, BpError *err);

/* One chunk of raw samples. */
typedef struct BpSampleBlock {
    uint32_t first_pixel, pixel_count;
    uint64_t first_sample; /* absolute */
    uint32_t samples;      /* a pixel */
    /* (pixel * samples + sample) * 4: r, g, b, and the number of ray segments, plus 1/2 for a path that the
     * depth cap cut. Single precision whatever the kernel's. */
    float *values;
} BpSampleBlock;

/* Runs one chunk and hands out its raw samples (they are accumulated in the film as well): for tests and
 * `check`. One device only. *finished: there was nothing left to do, and the block is empty. The caller
 * clears the block with bp_sample_block_clear(). */
BpStatus bp_render_step_samples(BpRender *render, BpSampleBlock *block, bool *finished, BpError *err);
void bp_sample_block_clear(BpSampleBlock *block);

#endif
