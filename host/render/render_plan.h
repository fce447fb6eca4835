/* render_plan.h: from a scene and a user's options to what one device is given.
 *
 * In:    scene, options, device.   Out: a worker's setup and the packed scene.
 * Knows: which arrangement suits which kind of device.   Does not know: when chunks are traced. */
#ifndef BP_RENDER_RENDER_PLAN_H
#define BP_RENDER_RENDER_PLAN_H

#include "worker.h"

/* Whether rays are sent to lamps through balls of glass and off mirrors: BP_CAUSTICS_OFF too where the scene
 * does not call for it; BP_CAUSTICS_AUTO where a pilot decides. */
BpCaustics bp_render_caustics(const BpScene *scene, const BpRenderOptions *options);
/* The same, if the scene's effects are known. */
BpCaustics bp_render_caustics_of(const BpEffects *effects, const BpRenderOptions *options);

/* Whether deep paths may end by roulette: BP_ROULETTE_OFF too where none can come to carry little, or may be
 * that deep. */
BpRoulette bp_render_roulette(const BpScene *scene, const BpRenderOptions *options);
/* The same, if the scene's effects are known. */
BpRoulette bp_render_roulette_of(const BpEffects *effects, const BpRenderOptions *options);

/* Whether lamps are sampled: BP_LIGHT_SAMPLING_OFF too where the scene does not call for it. */
BpLightSampling bp_render_light_sampling(const BpScene *scene, const BpRenderOptions *options);
/* The same where the scene's effects are known, so that its spheres need not be searched again. */
BpLightSampling bp_render_light_sampling_of(const BpEffects *effects, const BpRenderOptions *options);

/* Packs the scene for `device` and says how to run it there; the caller clears `packed`. BP_ERR_DEVICE: the
 * device lacks what the options ask for. `setup` keeps no pointer into anything. */
BpStatus bp_render_plan(const BpScene *scene, const BpRenderOptions *options, const BpDeviceInfo *device,
                        BpWorkerSetup *setup, BpPacked *packed, BpError *err);

#endif
