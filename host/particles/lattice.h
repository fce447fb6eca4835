/* lattice.h: the parallelepiped that particles lie in, and the shortest ways across its sides.
 *
 * In:    the edges of a frame's cell, or any others.   Out: a place as shares of the edges, ways.
 * Knows: whether the cell repeats.   Does not know: particles' lists, what ways are needed for. */
#ifndef BP_PARTICLES_LATTICE_H
#define BP_PARTICLES_LATTICE_H

#include "particles.h"

typedef struct BpLattice {
    bool periodic;
    double origin[3], edges[3][3], inverse[3][3]; /* share = (place - origin) * inverse */
} BpLattice;

/* The edges are the rows; they span a volume. */
void bp_lattice_init(BpLattice *lattice, const double origin[3], const double edges[3][3], bool periodic);

/* Where the place lies, in parts of each edge; from 0 up to 1 if the cell repeats. */
void bp_lattice_shares(const BpLattice *lattice, const double place[3], double share[3]);

/* The shortest way from a to b in the periodic cell (if it is shorter than half the cell). */
void bp_lattice_way(const BpLattice *lattice, const double a[3], const double b[3], double out[3]);

#endif
