/* molecules.h: molecules made whole.
 *
 * In:    a frame, and the bonds of its particles.   Out: positions, moved by whole cells.
 * Knows: periodic cells.   Does not know: where bonds come from. */
#ifndef BP_PARTICLES_MOLECULES_H
#define BP_PARTICLES_MOLECULES_H

#include "bonds.h"

/* Moves the particles of each molecule next to each other, where the cell's sides part them, and brings the
 * images of `bonds` in line with that; an infinite molecule (a crystal, a chain that is bonded
 * to its own image) stays. *moved: how many particles. */
BpStatus bp_molecules_make_whole(BpParticles *particles, const bool *shown, BpBonds *bonds, size_t *moved,
                                 BpError *err);

#endif
