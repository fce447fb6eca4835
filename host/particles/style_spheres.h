/* style_spheres.h: particles as spheres of a scene, and what joins them as capsules.
 *
 * In:    particles whose radii and colours are decided.   Out: spheres and capsules, with colours of their
 * own. Knows: the scene's arrays, threads.   Does not know: how radii and colours are decided. */
#ifndef BP_PARTICLES_STYLE_SPHERES_H
#define BP_PARTICLES_STYLE_SPHERES_H

#include "style_job.h"

/* All particles that are shown, have a radius and are spheres; job->shown is false for those without a radius
 * then. BP_ERR_SCENE: none is shown. */
BpStatus bp_style_put_particles(BpStyleJob *job, BpError *err);

/* The place of a colour among those of the scene, which may be there already; BP_NO_ALBEDO where the material
 * has none. */
BpStatus bp_style_put_color(BpStyleJob *job, const double color[3], uint32_t *albedo, BpError *err);

/* One capsule, in two colours. */
BpStatus bp_style_put_capsule(BpStyleJob *job, const double a[3], const double b[3], double radius,
                              const double color_a[3], const double color_b[3], BpError *err);

#endif
