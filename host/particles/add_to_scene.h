/* add_to_scene.h: particles to a scene, as a style has them.
 *
 * In:    a frame, a style.   Out: spheres and triangles with colours, added to a scene; what was decided, as
 * a line. Knows: the order of decisions: what is shown, bonds, whole molecules, radii, colours, spheres,
 * bodies. Does not know: how files are read. */
#ifndef BP_PARTICLES_ADD_TO_SCENE_H
#define BP_PARTICLES_ADD_TO_SCENE_H

#include "particles.h"
#include "scene/scene.h"
#include "style.h"

/* Adds the particles as spheres of `material`, or as triangles where they have other shapes, whose faces have
 * been cut, each with a colour of its own, and bonds and cell where the style has them; the frame was read
 * with the columns of the style. Moves molecules in `particles` together. `summary` (Optional, of `size`
 * bytes): what is shown, and every guess. `range`: Optional; the values at the ends of the colormap. Fails if
 * nothing is left to show. */
BpStatus bp_particles_add_to_scene(BpParticles *particles, const BpParticleStyle *style, bool may_miss,
                                   uint32_t material, BpScene *scene, char *summary, size_t size,
                                   double range[2], BpError *err);

#endif
