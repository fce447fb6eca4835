/* lattice.h: the parallelepiped that particles lie in, and the images that it has along the edges that
 * repeat.
 *
 * In:    the edges of a frame's cell, and which of them repeat.   Out: shares of the edges, images, ways.
 * Knows: how to find the shortest edges of a lattice.   Does not know: what ways are for.
 */
#ifndef BP_PARTICLES_LATTICE_H
#define BP_PARTICLES_LATTICE_H

#include "particles.h"

/* Places so many cells away are not wrapped: their images have no number. */
#define BP_LATTICE_WHOLE_MAX 1.0e9

typedef struct BpLattice {
    bool periodic[3];
    double origin[3], edges[3][3], inverse[3][3]; /* share = (place - origin) * inverse */
} BpLattice;

/* The edges are the rows. Those that repeat must be independent, and are replaced by the shortest ones of the
 * same lattice, unless they are these already. In place of the others, which may be of any length, come
 * unit vectors at right angles to all else, unless no edge repeats or all are. */
void bp_lattice_init(BpLattice *lattice, const double origin[3], const double edges[3][3],
                     const bool periodic[3]);
/* The lattice of the frame's cell; without a cell it repeats nowhere. */
void bp_lattice_of(BpLattice *lattice, const BpParticles *particles);

/* Gives the lattice other edges, as they are. */
void bp_lattice_scale(BpLattice *lattice, const double origin[3], const double edges[3][3]);

bool bp_lattice_repeats(const BpLattice *lattice);

/* Where the place lies, in parts of each edge; along those that repeat, from 0 up to 1, and `whole` edges
 * from there. */
void bp_lattice_shares(const BpLattice *lattice, const double place[3], double share[3], int32_t whole[3]);

/* The distance of the two sides that edge `e` joins. */
double bp_lattice_height(const BpLattice *lattice, int e);

/* The way from a to the image of b that lies `image` edges from b. */
void bp_lattice_way(const BpLattice *lattice, const double a[3], const double b[3], const int32_t image[3],
                    double out[3]);

/* The image of b that is nearest to a; b itself, if no other is nearer. */
void bp_lattice_nearest(const BpLattice *lattice, const double a[3], const double b[3], int32_t image[3]);

#endif
