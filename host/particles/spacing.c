/* spacing.c: see spacing.h. */
#include "spacing.h"

#include "base/thread_pool.h"
#include "grid.h"

#include <stdlib.h>
#include <string.h>

static int compare_reals(const void *a, const void *b) {
    const double one = *(const double *)a, other = *(const double *)b;
    return one < other ? -1 : one > other;
}

enum { SAMPLES_MAX = 1000 };

/* The distances of a thousand particles to their nearest neighbours. Only what lies in the cells around those
 * is kept, so that millions of particles need one pass and hardly any memory. */
typedef struct Sampling {
    BpParticleGrid grid; /* without its lists */
    const bool *shown;
    uint32_t sample[SAMPLES_MAX];
    size_t sample_count;
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

static void sort_out_block(void *context, uint32_t block, unsigned thread) {
    (void)thread;
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

static void sampling_clear(Sampling *s) { /* the samples stay */
    for (uint32_t b = 0; b < bp_block_count(s->grid.particles->count) && s->near != NULL; b++)
        free(s->near[b].particles);
    free(s->near);
    free(s->marks);
    free(s->before);
    free(s->first);
    free(s->next);
    free(s->particle);
    s->near = NULL;
    s->marks = NULL;
    s->before = s->first = s->next = s->particle = NULL;
}

/* Marks the cells around the samples. */
static void mark_cells(Sampling *s) {
    for (size_t n = 0; n < s->sample_count; n++) {
        BpGridWalk walk;
        bp_particle_grid_begin(&s->grid, s->grid.particles->position[s->sample[n]], &walk);
        while (bp_particle_grid_next(&walk)) s->marks[walk.cell / 64] |= (uint64_t)1 << walk.cell % 64;
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
static BpStatus sampling_fill(Sampling *s, BpError *err) {
    const BpParticles *const p = s->grid.particles;
    const size_t words = s->grid.cell_count / 64 + 1;
    BpThreadPool *pool = bp_thread_pool_create(bp_block_count(p->count) > 1 ? 0 : 1);
    s->marks = calloc(words, sizeof *s->marks);
    s->before = malloc(words * sizeof *s->before);
    s->near = calloc((size_t)bp_block_count(p->count) + 1, sizeof *s->near);
    bool good = pool != NULL && s->marks != NULL && s->before != NULL && s->near != NULL;
    if (good) {
        mark_cells(s);
        bp_parallel_for(pool, sort_out_block, s, bp_block_count(p->count));
        good = link_cells(s);
    }
    bp_thread_pool_destroy(&pool);
    return good ? BP_OK : bp_fail(err, BP_ERR_MEMORY, "out of memory for a grid of %zu particles", p->count);
}

/* The distance to the nearest neighbour, if that is within the grid's reach, else that or a greater one;
 * infinite where there is none. */
static double nearest_of(const Sampling *s, uint32_t i) {
    const BpParticles *const p = s->grid.particles;
    BpGridWalk walk;
    double least = INFINITY;
    bp_particle_grid_begin(&s->grid, p->position[i], &walk);
    while (bp_particle_grid_next(&walk)) {
        uint32_t n = s->first[place_of(s, walk.cell)];
        for (size_t looked = 0; n != BP_NO_PARTICLE && looked < 4096; n = s->next[n], looked++) {
            double d[3], share[3];
            int32_t whole[3] = {0, 0, 0}, image[3];
            const double *const place = p->position[s->particle[n]];
            if (bp_lattice_repeats(&s->grid.lattice))
                bp_lattice_shares(&s->grid.lattice, place, share, whole);
            bp_particle_grid_image(&walk, whole, image);
            bp_lattice_way(&s->grid.lattice, p->position[i], place, image, d);
            const double squared = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
            if (squared > 0) least = fmin(least, squared);
        }
    }
    return sqrt(least);
}

/* Every n-th of those shown, so that there are up to SAMPLES_MAX. */
static void choose_samples(Sampling *s, const BpParticles *particles, size_t shown_count) {
    const size_t step = shown_count / SAMPLES_MAX + 1;
    size_t seen = 0;
    for (size_t i = 0; i < particles->count; i++)
        if (s->shown[i] && seen++ % step == 0) s->sample[s->sample_count++] = (uint32_t)i;
}

/* The edges of the cell along which images are neighbours. */
static void choose_lattice(const BpParticles *particles, const BpParticleBounds *bounds, BpLattice *lattice) {
    BpParticles own = {.periodic = {false}};
    memcpy(own.periodic, particles->periodic, sizeof own.periodic);
    memcpy(own.cell_origin, particles->cell_origin, sizeof own.cell_origin);
    memcpy(own.cell, particles->cell, sizeof own.cell);
    /* Simulations in two dimensions have a cell of any height. */
    if (bounds->count > 2 && bounds->low[2] == bounds->high[2])
        for (int e = 0; e < 3; e++) own.periodic[e] &= particles->cell[e][2] == 0;
    bp_lattice_of(lattice, &own);
}

/* About eight particles a cell of the grid; and no more than the distance of a particle to its own image. */
static double first_reach(const BpParticleBounds *bounds, const BpLattice *lattice) {
    double volume = 1, shortest = INFINITY;
    int dimensions = 0;
    for (int c = 0; c < 3; c++) {
        if (!(bounds->high[c] - bounds->low[c] > BP_PARTICLE_NARROWEST)) continue;
        volume *= bounds->high[c] - bounds->low[c];
        dimensions++;
    }
    for (int e = 0; e < 3; e++) {
        const double *const edge = lattice->edges[e];
        if (lattice->periodic[e])
            shortest = fmin(shortest, sqrt(edge[0] * edge[0] + edge[1] * edge[1] + edge[2] * edge[2]));
    }
    const double reach =
        dimensions > 0 ? 2 * pow(volume / (double)bounds->count, 1.0 / dimensions) : INFINITY;
    return fmin(reach, shortest * (1 + 1e-6));
}

/* The median for one reach; infinite: it is beyond that. */
static BpStatus median_within(Sampling *s, const BpParticles *particles, const BpLattice *lattice,
                              const BpParticleBounds *bounds, double reach, double *median, BpError *err) {
    double nearest[SAMPLES_MAX];
    bp_particle_grid_lay(&s->grid, particles, lattice, bounds, reach);
    const BpStatus status = sampling_fill(s, err);
    for (size_t n = 0; n < s->sample_count && status == BP_OK; n++) nearest[n] = nearest_of(s, s->sample[n]);
    sampling_clear(s);
    BP_TRY(status);
    qsort(nearest, s->sample_count, sizeof *nearest, compare_reals);
    *median = nearest[s->sample_count / 2];
    if (*median > reach) *median = INFINITY;
    return BP_OK;
}

BpStatus bp_particles_spacing(const BpParticles *particles, const bool *shown, double *spacing,
                              BpError *err) {
    BpParticleBounds bounds;
    BpLattice lattice;
    Sampling sampling = {.shown = shown};
    double farthest = 0, median = INFINITY;
    *spacing = 0;
    BP_TRY(bp_particle_bounds(particles, shown, &bounds, err));
    if (bounds.count < 2) return BP_OK; /* one alone has images of its own, but these are not seen */
    choose_lattice(particles, &bounds, &lattice);
    choose_samples(&sampling, particles, bounds.count);
    for (int c = 0; c < 3; c++) farthest += bounds.high[c] - bounds.low[c];
    double reach = first_reach(&bounds, &lattice);
    /* Particles in clusters have a nearest neighbour sooner, others later than if they filled their bounds.
     */
    for (; isfinite(reach) && isinf(median); reach *= 4) {
        BP_TRY(median_within(&sampling, particles, &lattice, &bounds, reach, &median, err));
        if (reach > 1.001 * farthest) break;
    }
    *spacing = isfinite(median) ? median : 0;
    return BP_OK;
}
