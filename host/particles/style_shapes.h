/* style_shapes.h: which particles are drawn as what they are, and how large.
 *
 * In:    particles whose radii are decided.   Out: whether one is a body, its shape, its scale.
 * Knows: what triangles can show.   Does not know: how bodies become triangles (style_bodies.h). */
#ifndef BP_PARTICLES_STYLE_SHAPES_H
#define BP_PARTICLES_STYLE_SHAPES_H

#include "style_job.h"

/* Whether particle `i` is drawn as such: it is no sphere, the style draws shapes, and its triangles are such
 * as a scene may have. Others are spheres. */
bool bp_style_has_body(const BpStyleJob *job, size_t i);

/* Of a particle that is no sphere: its shape, or NULL for an ellipsoid; by what its lengths in the file are
 * multiplied, so that it has its radius. */
const BpParticleShape *bp_style_shape(const BpStyleJob *job, size_t i);
double bp_style_scale(const BpStyleJob *job, size_t i);

#endif
