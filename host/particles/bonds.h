/* bonds.h: which particles are bonded, and in which of their images.
 *
 * In:    a frame, which of its particles are shown.   Out: pairs of particles.
 * Knows: covalent radii, bonds that files give.   Does not know: how bonds are drawn. */
#ifndef BP_PARTICLES_BONDS_H
#define BP_PARTICLES_BONDS_H

#include "lattice.h"

/* Particle a where it is, and b `image` edges of the lattice from where it is: 0 0 0 is b itself. */
typedef struct BpBond {
    uint32_t a, b;
    int32_t image[3];
} BpBond;

typedef struct BpBonds {
    BpLattice lattice; /* of the frame's cell */
    BpBond *bond;      /* each once */
    size_t count, capacity;
    size_t given; /* the first ones: those of the file */
    bool crowded; /* so many are near each other that no bonds were sought by distance */
} BpBonds;

/* The bonds among the particles of which shown[i] holds: those that the file gives, each to the nearest
 * image. Where it gives none, or its format gives only some, also those of atoms nearer than the sum of their
 * covalent radii and 0.4 angstrom (E. Meng, R. Lewis 1991), in all images of a cell that repeats; an atom
 * may be bonded to images of its own. Release bonds->bond with free(). */
BpStatus bp_bonds_find(const BpParticles *particles, const bool *shown, BpBonds *bonds, BpError *err);

#endif
