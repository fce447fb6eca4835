/* within.c: see within.h. */
#include "within.h"

#include "base/thread_pool.h"
#include "grid.h"
#include "scene/vector.h"

#include <stdlib.h>
#include <string.h>

typedef struct Search {
    BpParticleGrid grid;
    double squared; /* of the reach */
    const bool *of;
    bool *within;
} Search;

static bool has_near(const Search *search, size_t i) {
    static const int32_t nowhere[3] = {0, 0, 0};
    const BpParticleGrid *const grid = &search->grid;
    const BpParticles *const p = grid->particles;
    BpGridWalk walk;
    bp_particle_grid_begin(grid, p->position[i], &walk);
    while (bp_particle_grid_next(&walk)) {
        for (uint32_t k = grid->first[walk.cell]; k != BP_NO_PARTICLE; k = grid->next[k]) {
            int32_t image[3];
            double way[3];
            bp_particle_grid_image(&walk, grid->whole != NULL ? grid->whole[k] : nowhere, image);
            bp_lattice_way(&grid->lattice, p->position[i], p->position[k], image, way);
            if (bp_dot(way, way) <= search->squared) return true;
        }
    }
    return false;
}

static void search_block(void *context, uint32_t block, unsigned thread) {
    (void)thread;
    const Search *const search = context;
    for (size_t i = bp_block_begin(block); i < bp_block_end(block, search->grid.particles->count); i++)
        search->within[i] = search->of[i] || has_near(search, i);
}

/* No two particles, each in its image nearest to the other, are further apart. */
static BpStatus farthest(const BpParticles *p, const bool *all, double *distance, BpError *err) {
    BpLattice lattice;
    BpParticleBounds bounds;
    bp_lattice_of(&lattice, p);
    BP_TRY(bp_particle_bounds(p, all, &bounds, err));
    double way[3], half = 0;
    for (int c = 0; c < 3; c++) way[c] = bounds.high[c] - bounds.low[c];
    for (int e = 0; e < 3; e++) half += sqrt(bp_dot(lattice.edges[e], lattice.edges[e])) / 2;
    *distance = sqrt(bp_dot(way, way));
    if (lattice.periodic[0] && lattice.periodic[1] && lattice.periodic[2]) *distance = fmin(*distance, half);
    return BP_OK;
}

/* A particle's nearest image lies less than two edges away, so in thin cells no farther ones are looked at.
 */
static void shorten_walk(BpParticleGrid *grid) {
    for (int e = 0; e < 3; e++) {
        const int32_t most = 2 * grid->sides[e] + 1;
        if (grid->lattice.periodic[e] && grid->steps[e] > most) grid->steps[e] = most;
    }
}

BpStatus bp_particles_within(const BpParticles *particles, double reach, const bool *of, bool *within,
                             BpError *err) {
    const size_t count = particles->count;
    Search search = {.squared = reach * reach, .of = of, .within = within};
    bool any = false;
    double distance = 0;
    for (size_t i = 0; i < count; i++) any |= of[i];
    memset(within, any, count);
    if (!any) return BP_OK;
    bool *const all = malloc(count);
    if (all == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for %zu particles", count);
    memset(all, true, count);
    const BpStatus status = farthest(particles, all, &distance, err);
    free(all);
    BP_TRY(status);
    if (reach > 1.001 * distance) return BP_OK; /* all of them */
    BP_TRY(bp_particle_grid_init(&search.grid, particles, of, reach, err));
    shorten_walk(&search.grid);
    BpThreadPool *pool = bp_thread_pool_create(bp_block_count(count) > 1 ? 0 : 1);
    if (pool != NULL) bp_parallel_for(pool, search_block, &search, bp_block_count(count));
    bp_particle_grid_clear(&search.grid);
    if (pool == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for %zu particles", count);
    bp_thread_pool_destroy(&pool);
    return BP_OK;
}
