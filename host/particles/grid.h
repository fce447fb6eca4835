/* grid.h: particles sorted into the cells of a grid, so that neighbours are sought among few.
 *
 * In:    a frame, which of its particles are shown, how far neighbours may be.
 * Out:   the cell of a place and those around it; the particles in each cell.
 * Knows: lattices (lattice.h), threads.   Does not know: why neighbours are sought. */
#ifndef BP_PARTICLES_GRID_H
#define BP_PARTICLES_GRID_H

#include "lattice.h"

#define BP_NO_PARTICLE UINT32_MAX
/* Lengths from here on have volumes that are not rounded to 0. Along an axis where all particles lie closer
 * than that, they count as being at one place. */
#define BP_PARTICLE_NARROWEST 1e-90

typedef struct BpParticleBounds {
    double low[3], high[3];
    size_t count; /* of those shown */
} BpParticleBounds;

typedef struct BpParticleGrid {
    const BpParticles *particles;
    BpLattice lattice;
    int32_t sides[3];
    int32_t steps[3]; /* so many cells away from a place may its neighbours lie */
    size_t cell_count;
    /* The lists: the first particle of each cell, and the one after each. NULL where none were made. */
    uint32_t *first, *next;
    int32_t (
        *whole)[3]; /* of each particle in a list, as bp_lattice_shares() has it; NULL: nothing repeats */
} BpParticleGrid;

/* A grid of the particles for which shown[i] is true. */
BpStatus bp_particle_bounds(const BpParticles *particles, const bool *shown, BpParticleBounds *bounds,
                            BpError *err);

/* The cells alone. They fill `lattice` along the edges that repeat, and the bounds along the others. */
void bp_particle_grid_lay(BpParticleGrid *grid, const BpParticles *particles, const BpLattice *lattice,
                          const BpParticleBounds *bounds, double reach);

/* The cells in the lattice of the frame's cell, and the lists of those shown, each from low numbers to high
 * ones. Release with bp_particle_grid_clear(). */
BpStatus bp_particle_grid_init(BpParticleGrid *grid, const BpParticles *particles, const bool *shown,
                               double reach, BpError *err);
void bp_particle_grid_clear(BpParticleGrid *grid);

/* The number of the cell that a place lies in; the nearest one, if it lies outside. */
size_t bp_particle_grid_cell(const BpParticleGrid *grid, const double place[3]);

/* A walk through all cells that may hold neighbours nearer than the reach, each in all of its images. In a
 * lattice that is thinner than the reach, a cell comes several times, with other images. */
typedef struct BpGridWalk {
    const BpParticleGrid *grid;
    int32_t whole[3];               /* of the place */
    int32_t low[3], high[3], at[3]; /* cells, counted on across the sides of the lattice */
    size_t cell;
    int32_t image[3]; /* the lattice's edges from where `cell` lies to where it is met */
} BpGridWalk;

void bp_particle_grid_begin(const BpParticleGrid *grid, const double place[3], BpGridWalk *walk);
/* Goes on to the next cell, the first one at first. False: there is none. */
bool bp_particle_grid_next(BpGridWalk *walk);
/* The image in which a particle of the walk's cell is met from the walk's place, by its own `whole`. */
void bp_particle_grid_image(const BpGridWalk *walk, const int32_t whole[3], int32_t image[3]);

#endif
