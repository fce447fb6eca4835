/* disorder.h: which atoms of a crystal stand in place of others, and so are not shown.
 *
 * In:    a frame's atoms, what its file says of their sites.   Out: flags of the frame's particles.
 * Knows: occupancies, disorder groups, covalent radii.   Does not know: how files write them.
 *
 * Of the groups of an assembly the one of the largest mean occupancy is shown, unless groups could be there
 * together. Then, of atoms that cannot be there together, the one of the largest occupancy is shown: those
 * nearer than DISORDER_SAME; those whose occupancies share one place and that are nearer than half the sum of
 * their covalent radii; and those of a group that is disordered about a symmetry element (its number is
 * negative), within the length of a bond of another image of it. */
#ifndef BP_PARTICLES_DISORDER_H
#define BP_PARTICLES_DISORDER_H

#include "cif_block.h"

/* No two atoms of a crystal are so near: the images of a site that are lie on one special position. In
 * angstrom; gemmi has the same. */
#define DISORDER_SAME 0.4

/* Of which site and operation a particle is. */
typedef struct CellAtom {
    uint32_t site;
    uint16_t operation;
} CellAtom;

/* `atom`: of each particle. */
BpStatus disorder_mark(BpParticles *particles, const CifBlock *block, const CellAtom *atom, BpError *err);

#endif
