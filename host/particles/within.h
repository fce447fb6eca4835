/* within.h: which particles lie near some others.
 *
 * In:    a frame, some of its particles, a distance.   Out: those that are so near.
 * Knows: the grid of neighbours, images in cells that repeat.   Does not know: why they are sought. */
#ifndef BP_PARTICLES_WITHIN_H
#define BP_PARTICLES_WITHIN_H

#include "particles.h"

/* within[i]: whether particle i lies at most `reach` (above 0, in the file's unit) from a particle of `of`,
 * or from an image of it along the edges of the cell that repeat; those of `of` do. BP_ERR_MEMORY. */
BpStatus bp_particles_within(const BpParticles *particles, double reach, const bool *of, bool *within,
                             BpError *err);

#endif
