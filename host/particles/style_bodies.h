/* style_bodies.h: particles that are no spheres, as triangles and capsules of a scene.
 *
 * In:    particles whose radii and colours are decided.   Out: triangles, smooth ones of ellipsoids;
 * capsules. Knows: how fine ellipsoids are cut.   Does not know: how shapes are read, who cut their faces. */
#ifndef BP_PARTICLES_STYLE_BODIES_H
#define BP_PARTICLES_STYLE_BODIES_H

#include "style_job.h"

/* All that are shown and are drawn as such (style_shapes.h), each as large as its radius says. BP_ERR_SCENE:
 * too many triangles, or a material with an inside on a shape that is not closed. */
BpStatus bp_style_put_bodies(BpStyleJob *job, BpError *err);

#endif
