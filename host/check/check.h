/* check.h: renders a scene with the kernel and with the reference tracer, and compares the two.
 *
 * In:    a scene, options, a device.   Out: the sums of both, the verdict.
 * Knows: the render loop, the reference.   Does not know: the command line, files.
 *
 * The result depends on scene, samples, seed and device, not on chunks, threads or the machine's load. With a
 * time limit, both sides proceed in rounds, each as long as all before it together, and the last round that
 * was completed in time is judged. The clock then determines the number of samples, but not their values, so
 * the verdict's error rate holds. */
#ifndef BP_CHECK_CHECK_H
#define BP_CHECK_CHECK_H

#include "render/render.h"
#include "verdict.h"

#define BP_CHECK_WIDTH_DEFAULT 64u
#define BP_CHECK_SAMPLES_DEFAULT 1024u

typedef struct BpCheckOptions {
    BpRenderOptions render; /* samples, depth, seed, kernel; the sampler must be the independent one */
    double level;           /* probability of rejecting a correct kernel */
    double margin;          /* "agree" needs brightness shown to be equal within it; a fraction */
    double seconds;         /* limit of time, from bp_check_create() on; 0: none */
    unsigned threads;       /* of the reference; 0: one a processor */
} BpCheckOptions;

typedef struct BpCheck BpCheck;

typedef struct BpCheckProgress {
    bool reference; /* the kernel is done, the reference at work */
    double done;    /* of the present part, 0 .. 1 */
    double seconds; /* spent on the present part */
    bool finished;
} BpCheckProgress;

typedef struct BpCheckResult {
    BpVerdict verdict;
    uint64_t samples_per_pixel; /* judged: as requested, or fewer when time was up */
    bool timed_out;
    BpSums kernel, reference; /* owned by the check */
    uint64_t cut_kernel, cut_reference;
    double kernel_seconds, reference_seconds;
    BpRenderReport report;
} BpCheckResult;

/* The scene must outlive the check, and so must `device`: one that is open already (opencl/device.h). NULL:
 * the default one, which the check opens. Builds the kernel, unless the device has it. BP_ERR_USAGE: fewer
 * than 2 samples, or another sampler. */
struct BpDevice;
BpStatus bp_check_create(const BpScene *scene, const BpCheckOptions *options, struct BpDevice *device,
                         BpCheck **check, BpError *err);
/* Works for about 0.3 s (on a huge scene: one sample of every pixel). `progress`: Optional.
 * BP_ERR_INCONCLUSIVE: the time limit was reached before the first round was complete. */
BpStatus bp_check_step(BpCheck *check, BpCheckProgress *progress, BpError *err);
/* After the last step; valid while the check lives. BP_ERR_USAGE before. */
BpStatus bp_check_result(const BpCheck *check, const BpCheckResult **result, BpError *err);
void bp_check_destroy(BpCheck **check);

/* The kernel's half alone, for tests: runs `render` to its end and adds every sample to `sums` (of the
 * scene's size). `truncated_paths`: Optional, added to. */
BpStatus bp_check_render_kernel(BpRender *render, BpSums *sums, uint64_t *truncated_paths, BpError *err);

#define BP_CHECK_MAP_MOST 4

/* Three pictures side by side, scaled up to a visible size: kernel, reference, and their difference in each
 * pixel in standard errors, blue where the kernel is darker, red where it is brighter, white at 0, full
 * colour from BP_CHECK_MAP_MOST on. A legend stands below. Colours are encoded for display through
 * `transfer`. The caller clears the picture. */
BpStatus bp_check_map(const BpCheckResult *result, BpTransfer transfer, BpPicture *picture, BpError *err);

#endif
