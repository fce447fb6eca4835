/* effect_costs.h: measures the cost of each effect on a device.
 *
 * In:    a scene, options, a device.   Out: for each kernel that could render it, its time as a ratio to the
 *        specialised one's, with a spread; build times; registers.
 * Knows: the render interface, statistics of ratios.   Does not know: the terminal.
 *
 * Time is what the device spends on tracing: on a CPU the processor time of all cores together, on others by
 * their own clock. All kernels trace the same samples of the same paths, in rounds: each round runs every
 * kernel once, so that disturbances affect all alike. Ratios are formed within a round; the result is the
 * median over rounds. */
#ifndef BP_STUDY_EFFECT_COSTS_H
#define BP_STUDY_EFFECT_COSTS_H

#include "render/render.h"

#define BP_KERNELS_MAX (BP_EFFECT_COUNT + 2)

/* A kernel that renders the scene. */
typedef struct BpKernelCost {
    char name[64];             /* "specialised", "with lens", "general" */
    int forced;                /* the effect that is forced in, or -1 */
    uint32_t bits;             /* what is in it */
    double ratio;              /* median time over the specialised kernel's */
    double low, high;          /* the quartiles of the rounds */
    double samples_per_second; /* of device time (on a CPU: of one core), median over rounds */
    uint64_t registers;        /* of the trace kernel, from the build log; 0: not in it */
    uint64_t private_bytes;    /* 0: not reported by the driver */
    /* From opening the device to the first sample, without the scene's tree, by the wall clock and in
     * processor time of this process; cold: nothing is cached; warm: the driver has cached the kernel. NaN:
     * not measured. */
    double cold_seconds, cold_processor_seconds, warm_seconds, warm_processor_seconds;
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

/* Called before each piece of work with a line that describes it; `context` is passed through. */
typedef void BpCostProgress(const char *what, void *context);

typedef struct BpCostPlan {
    unsigned rounds;      /* 3 .. 101 */
    double round_seconds; /* of tracing, a kernel and round */
    bool builds;          /* measure build times of the specialised and the general kernel */
    bool general_only;    /* nothing but these two kernels */
    BpCostProgress *tell; /* Optional. */
    void *tell_context;
} BpCostPlan;

/* Costs on `device` of the kernels that could render `scene`; options->samples_per_pixel, first_sample and
 * all_effects are ignored. Takes about kernels * rounds * round_seconds, plus the builds. */
BpStatus bp_costs_measure(const BpScene *scene, const BpRenderOptions *options, const BpDeviceInfo *device,
                          const BpCostPlan *plan, BpCosts *costs, BpError *err);

#endif
