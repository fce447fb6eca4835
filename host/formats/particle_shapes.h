/* particle_shapes.h: the faces of particles' shapes, cut into triangles.
 *
 * In:    a frame whose shapes have polygons.   Out: their triangles, and whether these are closed.
 * Knows: how polygons are cut (meshes/).   Does not know: how particles look. */
#ifndef BP_FORMATS_PARTICLE_SHAPES_H
#define BP_FORMATS_PARTICLE_SHAPES_H

#include "particles/particles.h"

/* Polygons need not be convex. Fails with BP_ERR_SCENE, and the type's name, on one that crosses itself, and
 * on a shape without a triangle. */
BpStatus bp_cut_particle_shapes(BpParticles *particles, BpError *err);

#endif
