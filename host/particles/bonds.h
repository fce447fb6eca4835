/* bonds.h: which particles are bonded.
 *
 * In:    a frame, which of its particles are shown.   Out: pairs of particles.
 * Knows: covalent radii, bonds that files give.   Does not know: how bonds are drawn. */
#ifndef BP_PARTICLES_BONDS_H
#define BP_PARTICLES_BONDS_H

#include "particles.h"

typedef struct BpBonds {
    uint32_t (*pair)[2];
    size_t count, capacity;
    size_t given; /* the first ones: those of the file */
} BpBonds;

/* The bonds among the particles of which shown[i] holds: those that the file gives. Where it gives
 * none, or its format gives only some, also those of atoms nearer than the sum of their covalent radii and
 * 0.4 angstrom (E. Meng, R. Lewis 1991), also across a periodic cell. Release bonds->pair with free(). */
BpStatus bp_bonds_find(const BpParticles *particles, const bool *shown, BpBonds *bonds, BpError *err);

#endif
