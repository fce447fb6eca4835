/* explain_measure.h: what each effect costs on a device, measured.
 *
 * In:    a scene, options, a device.   Out: for each kernel that could render it, its time as a ratio to the
 *        specialised one's, with a spread; build times; registers.
 * Knows: the render interface, statistics of ratios.   Does not know: OpenCL, the terminal.
 *
 * Time is what the device spends on tracing: on a CPU the processor time of all cores together, on others by
 * their own clock. All kernels trace the same samples of the same paths, in rounds: each round runs every
 * kernel once, so that what disturbs the computer disturbs all alike. A ratio is formed within a round; the
 * median over rounds counts. */
#ifndef BP_CLI_EXPLAIN_MEASURE_H
#define BP_CLI_EXPLAIN_MEASURE_H

#include "../engine/render.h"

#define BP_KERNELS_MAX (BP_EFFECT_COUNT + 2)

/* A kernel that renders the scene. */
typedef struct BpKernelCost {
    char name[64];             /* "specialised", "with lens", "general" */
    int forced;                /* the effect that is forced in, or -1 */
    uint32_t bits;             /* what is in it */
    double ratio;              /* median time over the specialised kernel's */
    double low, high;          /* the middle half of the rounds lies between */
    double samples_per_second; /* of device time (on a CPU: of one core), median over rounds */
    uint64_t registers;        /* of the trace kernel, where the build log tells; else 0 */
    uint64_t private_bytes;    /* 0: the driver does not tell */
    double cold_seconds;       /* build and first launch with empty caches; NaN: not measured */
    double warm_seconds;       /* the same when the driver has it already; NaN: not measured */
} BpKernelCost;

typedef struct BpCosts {
    BpDeviceInfo device;
    BpKernelForm form;
    uint32_t width, height; /* of the pictures that were rendered */
    uint64_t samples;       /* a kernel and round */
    unsigned rounds;
    size_t kernel_count;
    BpKernelCost kernels[BP_KERNELS_MAX]; /* [0]: specialised; the last: general */
} BpCosts;

/* Called before each piece of work with a line that says what it is; `context` is handed through. */
typedef void BpCostProgress(const char *what, void *context);

/* Takes about `kernel_count` times `rounds` times 0.15 s, plus the builds. `tell`: Optional. */
BpStatus bp_costs_measure(const BpScene *scene, const BpRenderOptions *options, const BpDeviceInfo *device,
                          unsigned rounds, BpCostProgress *tell, void *context, BpCosts *costs, BpError *err);

#endif
