/* spacing.h: how far apart particles lie.
 *
 * In:    a frame, which of its particles are shown.   Out: the median distance of nearest neighbours.
 * Knows: grids, threads.   Does not know: what radius particles get from it. */
#ifndef BP_PARTICLES_SPACING_H
#define BP_PARTICLES_SPACING_H

#include "particles.h"

/* The median distance of a particle to its nearest neighbour, from up to 1000 of those shown; 0: there is
 * none, or one particle alone. In a cell that repeats, images are neighbours too, a particle's own as well,
 * except those above and below particles that all lie at one z. Particles in the same place do not count as
 * neighbours. */
BpStatus bp_particles_spacing(const BpParticles *particles, const bool *shown, double *spacing, BpError *err);

#endif
