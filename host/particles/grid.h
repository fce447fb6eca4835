/* grid.h: particles sorted into the cells of a grid, so that neighbours are sought among few.
 *
 * In:    a frame, which of its particles are shown, how far neighbours may be.
 * Out:   the cell of a place and those around it; the particles in each cell.
 * Knows: lattices (lattice.h), threads.   Does not know: why neighbours are sought. */
#ifndef BP_PARTICLES_GRID_H
#define BP_PARTICLES_GRID_H

#include "lattice.h"

#define BP_NO_PARTICLE UINT32_MAX

typedef struct BpParticleBounds {
    double low[3], high[3];
    size_t count; /* of those shown */
} BpParticleBounds;

typedef struct BpParticleGrid {
    const BpParticles *particles;
    BpLattice lattice;
    int32_t sides[3];
    size_t cell_count;
    /* The lists: the first particle of each cell, and the one after each. NULL where none were made. */
    uint32_t *first, *next;
} BpParticleGrid;

/* Of the particles of which shown[i] holds. */
BpStatus bp_particle_bounds(const BpParticles *particles, const bool *shown, BpParticleBounds *bounds,
                            BpError *err);

/* The cells alone. They fill the frame's cell if it repeats, else the bounds, and are at least `reach` wide,
 * so that neighbours nearer than that lie in the cells around. */
void bp_particle_grid_lay(BpParticleGrid *grid, const BpParticles *particles, const BpParticleBounds *bounds,
                          double reach);

/* The cells, and the lists of those shown, each from low numbers to high ones. Release with
 * bp_particle_grid_clear(). */
BpStatus bp_particle_grid_init(BpParticleGrid *grid, const BpParticles *particles, const bool *shown,
                               double reach, BpError *err);
void bp_particle_grid_clear(BpParticleGrid *grid);

/* The number of the cell that a place lies in; the nearest one, if it lies outside. */
size_t bp_particle_grid_cell(const BpParticleGrid *grid, const double place[3]);

/* The numbers of that cell and of those around it, each once. Returns how many. */
size_t bp_particle_grid_around(const BpParticleGrid *grid, const double place[3], size_t cells[27]);

#endif
