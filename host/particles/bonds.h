/* bonds.h: which particles are neighbours, which are bonded, and molecules made whole.
 *
 * In:    a frame.   Out: bonds, distances, moved positions.
 * Knows: covalent radii, periodic cells.   Does not know: how bonds are drawn. */
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

/* Moves the particles of each molecule next to each other, where the cell's sides part them; a molecule that
 * goes on without end (a crystal) stays. *moved: how many particles. */
BpStatus bp_molecules_make_whole(BpParticles *particles, const bool *shown, const BpBonds *bonds,
                                 size_t *moved, BpError *err);

/* The median distance of a particle to its nearest neighbour, from up to 1000 of those shown; 0: there is
 * none. */
BpStatus bp_particles_spacing(const BpParticles *particles, const bool *shown, double *spacing, BpError *err);

#endif
