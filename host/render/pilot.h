/* pilot.h: looks for light that a picture's samples find by chance only, before they do.
 *
 * In:    a scene, a worker whose program has entry/pilot.cl.
 * Out:   for each pixel, what such light does to its noise.
 * Knows: what a ray to a lamp finds.   Does not know: what is sampled of the picture. So the same scene and
 * camera have the same pilot, whatever the seed, and films of one scene share it.
 *
 * A sample of the picture finds a lamp or a disc by rays to it, where its path stands on a matte surface.
 * What it finds by chance is light that comes to a matte point by way of glass, mirrors, coats and metal that
 * is nearly a mirror, and light that is seen directly or by such ways. If the light is small, that is rare,
 * and as long as it has not happened, the samples' spread does not know of it. A pilot does: some paths from
 * the lights at everything specular, followed to where they are seen; and some camera paths, to see how close
 * they come to lights. */
#ifndef BP_RENDER_PILOT_H
#define BP_RENDER_PILOT_H

#include "pilot_lights.h"
#include "worker.h"

#include "film/unseen.h"

/* Whether the scene has light that a pilot may find, in what bp_pilot_aim() has found. */
bool bp_pilot_is_needed(const BpScene *scene, const BpPilotAim *aim);

/* *caustics: whether rays to lamps go through focusers too; of BP_CAUSTICS_AUTO it makes one of the others.
 * *unseen is NULL if there is none. */
BpStatus bp_pilot_run(BpWorker *worker, const BpScene *scene, const BpPilotAim *aim, uint32_t max_depth,
                      BpCaustics *caustics, BpUnseen **unseen, BpUnseenLight *report, BpError *err);

#endif
