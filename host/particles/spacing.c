/* spacing.c: see spacing.h. */
#include "spacing.h"

#include "base/team.h"
#include "grid.h"

#include <stdlib.h>

static int compare_reals(const void *a, const void *b) {
    const double one = *(const double *)a, other = *(const double *)b;
    return one < other ? -1 : one > other;
}

/* The distances of a thousand particles to their nearest neighbours. Only what lies in the cells around those
 * is kept, so that millions of particles need one pass and hardly any memory. */
typedef struct Sampling {
    BpParticleGrid grid; /* without its lists */
    const bool *shown;
    uint64_t *marks;  /* one bit a cell: a sample may have neighbours there */
    uint32_t *before; /* how many cells are marked before each word of marks */
    struct Near {
        uint32_t *particles;
        uint32_t count, capacity;
        bool failed;
    } * near;                          /* of each block: the particles in marked cells */
    uint32_t *first, *next, *particle; /* the list of each marked cell, in the particles' order */
} Sampling;

static bool is_marked(const Sampling *s, size_t cell) {
    return (s->marks[cell / 64] >> cell % 64 & 1) != 0;
}

/* The place of a marked cell among the marked ones. */
static uint32_t place_of(const Sampling *s, size_t cell) {
    uint32_t place = s->before[cell / 64];
    for (uint64_t bits = s->marks[cell / 64] & (((uint64_t)1 << cell % 64) - 1); bits != 0; bits &= bits - 1)
        place++;
    return place;
}

static void sort_out_block(void *context, uint32_t block, unsigned worker) {
    (void)worker;
    const Sampling *const s = context;
    const BpParticles *const p = s->grid.particles;
    struct Near *const near = &s->near[block];
    for (size_t i = bp_block_begin(block); i < bp_block_end(block, p->count) && !near->failed; i++) {
        if (!s->shown[i] || !is_marked(s, bp_particle_grid_cell(&s->grid, p->position[i]))) continue;
        if (near->count == near->capacity) {
            const uint32_t capacity = near->capacity > 0 ? 2 * near->capacity : 256;
            uint32_t *const grown = realloc(near->particles, capacity * sizeof *grown);
            near->failed = grown == NULL;
            if (near->failed) return;
            near->particles = grown;
            near->capacity = capacity;
        }
        near->particles[near->count++] = (uint32_t)i;
    }
}

static void sampling_clear(Sampling *s) {
    for (uint32_t b = 0; b < bp_block_count(s->grid.particles->count) && s->near != NULL; b++)
        free(s->near[b].particles);
    free(s->near);
    free(s->marks);
    free(s->before);
    free(s->first);
    free(s->next);
    free(s->particle);
}

/* Marks the cells around every `step`-th particle. */
static void mark_cells(Sampling *s, size_t step) {
    const BpParticles *const p = s->grid.particles;
    for (size_t i = 0; i < p->count; i += step) {
        size_t around[27];
        if (!s->shown[i]) continue;
        const size_t cells = bp_particle_grid_around(&s->grid, p->position[i], around);
        for (size_t c = 0; c < cells; c++) s->marks[around[c] / 64] |= (uint64_t)1 << around[c] % 64;
    }
}

/* Links what the blocks found into the lists of the marked cells. False: out of memory. */
static bool link_cells(Sampling *s) {
    const size_t words = s->grid.cell_count / 64 + 1;
    size_t count = 0;
    uint32_t marked = 0;
    for (size_t w = 0; w < words; w++) {
        s->before[w] = marked;
        for (uint64_t bits = s->marks[w]; bits != 0; bits &= bits - 1) marked++;
    }
    for (uint32_t b = 0; b < bp_block_count(s->grid.particles->count); b++) {
        if (s->near[b].failed) return false;
        count += s->near[b].count;
    }
    s->first = malloc((marked + 1) * sizeof *s->first);
    s->next = malloc((count + 1) * sizeof *s->next);
    s->particle = malloc((count + 1) * sizeof *s->particle);
    if (s->first == NULL || s->next == NULL || s->particle == NULL) return false;
    for (uint32_t m = 0; m < marked; m++) s->first[m] = BP_NO_PARTICLE;
    for (uint32_t b = bp_block_count(s->grid.particles->count), n = 0; b-- > 0;)
        for (uint32_t k = s->near[b].count; k-- > 0; n++) {
            s->particle[n] = s->near[b].particles[k];
            const double *const place = s->grid.particles->position[s->particle[n]];
            uint32_t *const head = &s->first[place_of(s, bp_particle_grid_cell(&s->grid, place))];
            s->next[n] = *head;
            *head = n;
        }
    return true;
}

/* Needs the grid. */
static BpStatus sampling_fill(Sampling *s, size_t step, BpError *err) {
    const BpParticles *const p = s->grid.particles;
    const size_t words = s->grid.cell_count / 64 + 1;
    BpTeam *team = bp_team_create(bp_block_count(p->count) > 1 ? 0 : 1);
    s->marks = calloc(words, sizeof *s->marks);
    s->before = malloc(words * sizeof *s->before);
    s->near = calloc((size_t)bp_block_count(p->count) + 1, sizeof *s->near);
    bool good = team != NULL && s->marks != NULL && s->before != NULL && s->near != NULL;
    if (good) {
        mark_cells(s, step);
        bp_team_run(team, sort_out_block, s, bp_block_count(p->count));
        good = link_cells(s);
    }
    bp_team_destroy(&team);
    return good ? BP_OK : bp_fail(err, BP_ERR_MEMORY, "out of memory for a grid of %zu particles", p->count);
}

/* The square of the distance to the nearest neighbour; infinite where there is none. */
static double nearest_square(const Sampling *s, size_t i) {
    const BpParticles *const p = s->grid.particles;
    size_t around[27];
    double least = INFINITY;
    const size_t cells = bp_particle_grid_around(&s->grid, p->position[i], around);
    for (size_t c = 0; c < cells; c++) {
        uint32_t n = s->first[place_of(s, around[c])];
        for (size_t looked = 0; n != BP_NO_PARTICLE && looked < 4096; n = s->next[n], looked++) {
            double d[3];
            bp_lattice_way(&s->grid.lattice, p->position[i], p->position[s->particle[n]], d);
            const double squared = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
            if (s->particle[n] != i && squared > 0) least = fmin(least, squared);
        }
    }
    return least;
}

BpStatus bp_particles_spacing(const BpParticles *particles, const bool *shown, double *spacing,
                              BpError *err) {
    enum { MOST = 1000 };
    double nearest[MOST], volume = 1;
    BpParticleBounds bounds;
    size_t found = 0;
    int dimensions = 0;
    *spacing = 0;
    BP_TRY(bp_particle_bounds(particles, shown, &bounds, err));
    if (bounds.count < 2) return BP_OK;
    for (int c = 0; c < 3; c++) {
        if (!(bounds.high[c] > bounds.low[c])) continue;
        volume *= bounds.high[c] - bounds.low[c];
        dimensions++;
    }
    if (dimensions == 0) return BP_OK;
    /* About eight particles a cell. If the nearest neighbour is further away than that, what is found is near
     * enough. */
    const double reach = 2 * pow(volume / (double)bounds.count, 1.0 / dimensions);
    const size_t step = particles->count / MOST + 1;
    Sampling sampling = {.shown = shown};
    bp_particle_grid_lay(&sampling.grid, particles, &bounds, reach);
    const BpStatus status = sampling_fill(&sampling, step, err);
    for (size_t i = 0; i < particles->count && status == BP_OK; i += step) {
        if (!shown[i]) continue;
        const double square = nearest_square(&sampling, i);
        if (isfinite(square)) nearest[found++] = sqrt(square);
    }
    sampling_clear(&sampling);
    if (status != BP_OK) return status;
    if (found == 0) {
        *spacing = reach / 2;
        return BP_OK;
    }
    qsort(nearest, found, sizeof *nearest, compare_reals);
    *spacing = nearest[found / 2];
    return BP_OK;
}
