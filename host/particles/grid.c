/* grid.c: see grid.h. */
#include "grid.h"

#include "base/team.h"

#include <stdlib.h>
#include <string.h>

static const BpParticleBounds nothing = {
    {INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}, 0};

typedef struct Bounding {
    const BpParticles *particles;
    const bool *shown;
    BpParticleBounds *blocks;
} Bounding;

static void bound_block(void *context, uint32_t block, unsigned worker) {
    (void)worker;
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
    BpTeam *team = bp_team_create(blocks > 1 ? 0 : 1);
    const bool good = bounding.blocks != NULL && team != NULL;
    *bounds = nothing;
    if (good) bp_team_run(team, bound_block, &bounding, blocks);
    for (uint32_t b = 0; b < blocks && good; b++) {
        bounds->count += bounding.blocks[b].count;
        for (int c = 0; c < 3; c++) {
            bounds->low[c] = fmin(bounds->low[c], bounding.blocks[b].low[c]);
            bounds->high[c] = fmax(bounds->high[c], bounding.blocks[b].high[c]);
        }
    }
    bp_team_destroy(&team);
    free(bounding.blocks);
    return good ? BP_OK : bp_fail(err, BP_ERR_MEMORY, "out of memory for %zu particles", particles->count);
}

void bp_particle_grid_lay(BpParticleGrid *grid, const BpParticles *particles, const BpParticleBounds *bounds,
                          double reach) {
    *grid = (BpParticleGrid){.particles = particles, .cell_count = 1};
    if (particles->has_cell && particles->periodic) {
        bp_lattice_init(&grid->lattice, particles->cell_origin, (const double(*)[3])particles->cell, true);
    } else {
        double edges[3][3] = {{0}};
        for (int c = 0; c < 3; c++) edges[c][c] = fmax(bounds->high[c] - bounds->low[c], reach);
        bp_lattice_init(&grid->lattice, bounds->low, (const double(*)[3])edges, false);
    }
    const double(*const inverse)[3] = (const double(*)[3])grid->lattice.inverse;
    double sides[3], cells = 1;
    for (int i = 0; i < 3; i++) {
        /* The distance of the two sides that the i-th edge joins. */
        const double slope = sqrt(inverse[0][i] * inverse[0][i] + inverse[1][i] * inverse[1][i] +
                                  inverse[2][i] * inverse[2][i]);
        sides[i] = fmin(1024, fmax(1, floor(1 / (slope * reach))));
        cells *= sides[i];
    }
    const double room = 4 * (double)particles->count + 64, shrink = cells > room ? cbrt(room / cells) : 1;
    for (int i = 0; i < 3; i++) {
        grid->sides[i] = (int32_t)fmax(1, floor(sides[i] * shrink));
        grid->cell_count *= (size_t)grid->sides[i];
    }
}

BpStatus bp_particle_grid_init(BpParticleGrid *grid, const BpParticles *particles, const bool *shown,
                               double reach, BpError *err) {
    BpParticleBounds bounds;
    BP_TRY(bp_particle_bounds(particles, shown, &bounds, err));
    bp_particle_grid_lay(grid, particles, &bounds, reach);
    grid->first = malloc(grid->cell_count * sizeof *grid->first);
    grid->next = malloc((particles->count + 1) * sizeof *grid->next);
    if (grid->first == NULL || grid->next == NULL) {
        bp_particle_grid_clear(grid);
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for a grid of %zu particles", particles->count);
    }
    for (size_t i = 0; i < grid->cell_count; i++) grid->first[i] = BP_NO_PARTICLE;
    for (size_t i = particles->count; i-- > 0;) {
        if (!shown[i]) continue;
        uint32_t *const head = &grid->first[bp_particle_grid_cell(grid, particles->position[i])];
        grid->next[i] = *head;
        *head = (uint32_t)i;
    }
    return BP_OK;
}

void bp_particle_grid_clear(BpParticleGrid *grid) {
    free(grid->first);
    free(grid->next);
    grid->first = grid->next = NULL;
}

static void cell_of(const BpParticleGrid *grid, const double place[3], int32_t cell[3]) {
    double share[3];
    bp_lattice_shares(&grid->lattice, place, share);
    for (int i = 0; i < 3; i++) {
        const double at = floor(share[i] * grid->sides[i]);
        cell[i] = at < 0 ? 0 : at >= grid->sides[i] ? grid->sides[i] - 1 : (int32_t)at;
    }
}

static size_t cell_number(const BpParticleGrid *grid, int32_t x, int32_t y, int32_t z) {
    return ((size_t)z * (size_t)grid->sides[1] + (size_t)y) * (size_t)grid->sides[0] + (size_t)x;
}

size_t bp_particle_grid_cell(const BpParticleGrid *grid, const double place[3]) {
    int32_t cell[3];
    cell_of(grid, place, cell);
    return cell_number(grid, cell[0], cell[1], cell[2]);
}

size_t bp_particle_grid_around(const BpParticleGrid *grid, const double place[3], size_t cells[27]) {
    int32_t cell[3], list[3][3];
    int counts[3];
    cell_of(grid, place, cell);
    for (int i = 0; i < 3; i++) {
        counts[i] = 0;
        for (int32_t step = -1; step <= 1; step++) {
            int32_t at = cell[i] + step;
            if (grid->lattice.periodic) at = (at + grid->sides[i]) % grid->sides[i];
            bool known = at < 0 || at >= grid->sides[i];
            for (int k = 0; k < counts[i]; k++) known |= list[i][k] == at;
            if (!known) list[i][counts[i]++] = at;
        }
    }
    size_t count = 0;
    for (int z = 0; z < counts[2]; z++)
        for (int y = 0; y < counts[1]; y++)
            for (int x = 0; x < counts[0]; x++)
                cells[count++] = cell_number(grid, list[0][x], list[1][y], list[2][z]);
    return count;
}
