/* grid.c: see grid.h. */
#include "grid.h"

#include "base/thread_pool.h"

#include <stdlib.h>
#include <string.h>

static const BpParticleBounds nothing = {
    {INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}, 0};

typedef struct Bounding {
    const BpParticles *particles;
    const bool *shown;
    BpParticleBounds *blocks;
} Bounding;

static void bound_block(void *context, uint32_t block, unsigned thread) {
    (void)thread;
    const Bounding *const bounding = context;
    const BpParticles *const p = bounding->particles;
    BpParticleBounds bounds = nothing;
    for (size_t i = bp_block_begin(block); i < bp_block_end(block, p->count); i++) {
        if (!bounding->shown[i]) continue;
        bounds.count++;
        for (int c = 0; c < 3; c++) {
            const double at = p->position[i][c];
            bounds.low[c] = at < bounds.low[c] ? at : bounds.low[c];
            bounds.high[c] = at > bounds.high[c] ? at : bounds.high[c];
        }
    }
    bounding->blocks[block] = bounds;
}

BpStatus bp_particle_bounds(const BpParticles *particles, const bool *shown, BpParticleBounds *bounds,
                            BpError *err) {
    const uint32_t blocks = bp_block_count(particles->count);
    Bounding bounding = {particles, shown, malloc(((size_t)blocks + 1) * sizeof *bounding.blocks)};
    BpThreadPool *pool = bp_thread_pool_create(blocks > 1 ? 0 : 1);
    const bool good = bounding.blocks != NULL && pool != NULL;
    *bounds = nothing;
    if (good) bp_parallel_for(pool, bound_block, &bounding, blocks);
    for (uint32_t b = 0; b < blocks && good; b++) {
        bounds->count += bounding.blocks[b].count;
        for (int c = 0; c < 3; c++) {
            bounds->low[c] = fmin(bounds->low[c], bounding.blocks[b].low[c]);
            bounds->high[c] = fmax(bounds->high[c], bounding.blocks[b].high[c]);
        }
    }
    bp_thread_pool_destroy(&pool);
    free(bounding.blocks);
    return good ? BP_OK : bp_fail(err, BP_ERR_MEMORY, "out of memory for %zu particles", particles->count);
}

/* Where the bounds lie along an edge of the lattice. */
static void extent(const BpLattice *lattice, const BpParticleBounds *bounds, int e, double *low,
                   double *high) {
    *low = INFINITY;
    *high = -INFINITY;
    for (int corner = 0; corner < 8; corner++) {
        double share = 0;
        for (int c = 0; c < 3; c++)
            share += ((corner >> c & 1 ? bounds->high[c] : bounds->low[c]) - lattice->origin[c]) *
                     lattice->inverse[c][e];
        *low = fmin(*low, share);
        *high = fmax(*high, share);
    }
}

/* The lattice, with edges as long as the bounds, or `reach`, where it does not repeat. */
static void fill_bounds(const BpLattice *lattice, const BpParticleBounds *bounds, double reach,
                        BpLattice *out) {
    double origin[3], edges[3][3] = {{0}};
    memcpy(origin, bounds->low, sizeof origin);
    reach = fmax(reach, BP_PARTICLE_NARROWEST);
    for (int c = 0; c < 3; c++) edges[c][c] = fmax(bounds->high[c] - bounds->low[c], reach);
    *out = *lattice;
    if (bp_lattice_repeats(lattice)) {
        memcpy(origin, lattice->origin, sizeof origin);
        memcpy(edges, lattice->edges, sizeof edges);
        for (int e = 0; e < 3; e++) {
            double low, high;
            if (lattice->periodic[e]) continue;
            extent(lattice, bounds, e, &low, &high);
            for (int c = 0; c < 3; c++) {
                origin[c] += low * lattice->edges[e][c];
                edges[e][c] *= fmax(high - low, reach);
            }
        }
    }
    bp_lattice_scale(out, origin, (const double(*)[3])edges);
}

void bp_particle_grid_lay(BpParticleGrid *grid, const BpParticles *particles, const BpLattice *lattice,
                          const BpParticleBounds *bounds, double reach) {
    *grid = (BpParticleGrid){.particles = particles, .cell_count = 1};
    fill_bounds(lattice, bounds, reach, &grid->lattice);
    double sides[3], cells = 1;
    for (int i = 0; i < 3; i++) {
        sides[i] = fmin(1024, fmax(1, floor(bp_lattice_height(&grid->lattice, i) / reach)));
        cells *= sides[i];
    }
    const double room = 4 * (double)particles->count + 64, shrink = cells > room ? cbrt(room / cells) : 1;
    for (int i = 0; i < 3; i++) {
        grid->sides[i] = (int32_t)fmax(1, floor(sides[i] * shrink));
        grid->cell_count *= (size_t)grid->sides[i];
        const double steps = ceil(reach * grid->sides[i] / bp_lattice_height(&grid->lattice, i) - 1e-9);
        grid->steps[i] = (int32_t)fmin(1e6, fmax(1, steps));
    }
}

static void cell_of(const BpParticleGrid *grid, const double place[3], int32_t cell[3], int32_t whole[3]) {
    double share[3];
    bp_lattice_shares(&grid->lattice, place, share, whole);
    for (int i = 0; i < 3; i++) {
        const double at = floor(share[i] * grid->sides[i]);
        cell[i] = at < 0 ? 0 : at >= grid->sides[i] ? grid->sides[i] - 1 : (int32_t)at;
    }
}

static size_t cell_number(const BpParticleGrid *grid, const int32_t cell[3]) {
    return ((size_t)cell[2] * (size_t)grid->sides[1] + (size_t)cell[1]) * (size_t)grid->sides[0] +
           (size_t)cell[0];
}

BpStatus bp_particle_grid_init(BpParticleGrid *grid, const BpParticles *particles, const bool *shown,
                               double reach, BpError *err) {
    BpParticleBounds bounds;
    BpLattice lattice;
    BP_TRY(bp_particle_bounds(particles, shown, &bounds, err));
    bp_lattice_of(&lattice, particles);
    bp_particle_grid_lay(grid, particles, &lattice, &bounds, reach);
    const bool repeats = bp_lattice_repeats(&lattice);
    grid->first = malloc(grid->cell_count * sizeof *grid->first);
    grid->next = malloc((particles->count + 1) * sizeof *grid->next);
    if (repeats) grid->whole = malloc((particles->count + 1) * sizeof *grid->whole);
    if (grid->first == NULL || grid->next == NULL || (repeats && grid->whole == NULL)) {
        bp_particle_grid_clear(grid);
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for a grid of %zu particles", particles->count);
    }
    for (size_t i = 0; i < grid->cell_count; i++) grid->first[i] = BP_NO_PARTICLE;
    for (size_t i = particles->count; i-- > 0;) {
        int32_t cell[3], whole[3];
        if (!shown[i]) continue;
        cell_of(grid, particles->position[i], cell, whole);
        uint32_t *const head = &grid->first[cell_number(grid, cell)];
        grid->next[i] = *head;
        *head = (uint32_t)i;
        if (repeats) memcpy(grid->whole[i], whole, sizeof whole);
    }
    return BP_OK;
}

void bp_particle_grid_clear(BpParticleGrid *grid) {
    free(grid->first);
    free(grid->next);
    free(grid->whole);
    grid->first = grid->next = NULL;
    grid->whole = NULL;
}

size_t bp_particle_grid_cell(const BpParticleGrid *grid, const double place[3]) {
    int32_t cell[3], whole[3];
    cell_of(grid, place, cell, whole);
    return cell_number(grid, cell);
}

/* Notes the cell that the walk is at. */
static void arrive(BpGridWalk *walk) {
    int32_t cell[3];
    for (int i = 0; i < 3; i++) {
        const int32_t at = walk->at[i], sides = walk->grid->sides[i];
        const bool inside = at >= 0 && at < sides;
        walk->image[i] = inside ? 0 : at >= 0 ? at / sides : -((sides - 1 - at) / sides);
        cell[i] = at - walk->image[i] * sides;
    }
    walk->cell = cell_number(walk->grid, cell);
}

void bp_particle_grid_begin(const BpParticleGrid *grid, const double place[3], BpGridWalk *walk) {
    int32_t cell[3];
    *walk = (BpGridWalk){.grid = grid};
    cell_of(grid, place, cell, walk->whole);
    for (int i = 0; i < 3; i++) {
        walk->low[i] = cell[i] - grid->steps[i];
        walk->high[i] = cell[i] + grid->steps[i];
        if (!grid->lattice.periodic[i] && walk->low[i] < 0) walk->low[i] = 0;
        if (!grid->lattice.periodic[i] && walk->high[i] >= grid->sides[i]) walk->high[i] = grid->sides[i] - 1;
        walk->at[i] = walk->low[i];
    }
    walk->at[0]--;
}

bool bp_particle_grid_next(BpGridWalk *walk) {
    walk->at[0]++;
    for (int i = 0; i < 2 && walk->at[i] > walk->high[i]; i++) {
        walk->at[i] = walk->low[i];
        walk->at[i + 1]++;
    }
    if (walk->at[2] > walk->high[2]) return false;
    arrive(walk);
    return true;
}

void bp_particle_grid_image(const BpGridWalk *walk, const int32_t whole[3], int32_t image[3]) {
    for (int i = 0; i < 3; i++) image[i] = walk->image[i] + walk->whole[i] - whole[i];
}
