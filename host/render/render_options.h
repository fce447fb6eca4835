/* render_options.h: the options of a render, and which of them can be.
 *
 * In:    a scene, options.   Out: the options that a scene has by itself; an error for those that cannot be.
 * Knows: limits of sums, sample numbers and kernels.   Does not know: how they are used (render_plan.h),
 * OpenCL. */
#ifndef BP_RENDER_RENDER_OPTIONS_H
#define BP_RENDER_RENDER_OPTIONS_H

#include "ballpark.h"

/* BP_ERR_USAGE or BP_ERR_LIMIT, with the option and what it may be. */
BpStatus bp_render_options_check(const BpScene *scene, const BpRenderOptions *options, BpError *err);

#endif
