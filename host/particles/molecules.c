/* molecules.c: see molecules.h. */
#include "molecules.h"

#include "lattice.h"

#include <stdlib.h>
#include <string.h>

typedef struct Walk {
    uint32_t *start, *neighbour, *queue; /* neighbours of i: neighbour[start[i] .. start[i + 1]) */
    double (*place)[3];
    bool *seen;
} Walk;

static void walk_clear(Walk *walk) {
    free(walk->start);
    free(walk->neighbour);
    free(walk->queue);
    free(walk->place);
    free(walk->seen);
}

static BpStatus walk_init(Walk *walk, size_t count, const BpBonds *bonds, BpError *err) {
    *walk = (Walk){.start = calloc(count + 2, sizeof *walk->start),
                   .neighbour = malloc((2 * bonds->count + 1) * sizeof *walk->neighbour),
                   .queue = malloc((count + 1) * sizeof *walk->queue),
                   .place = malloc((count + 1) * sizeof *walk->place),
                   .seen = calloc(count + 1, sizeof *walk->seen)};
    if (walk->start == NULL || walk->neighbour == NULL || walk->queue == NULL || walk->place == NULL ||
        walk->seen == NULL) {
        walk_clear(walk);
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for the molecules of %zu particles", count);
    }
    for (size_t b = 0; b < bonds->count; b++)
        for (int side = 0; side < 2; side++) walk->start[bonds->pair[b][side] + 2]++;
    for (size_t i = 2; i < count + 2; i++) walk->start[i] += walk->start[i - 1];
    for (size_t b = 0; b < bonds->count; b++)
        for (int side = 0; side < 2; side++)
            walk->neighbour[walk->start[bonds->pair[b][side] + 1]++] = bonds->pair[b][1 - side];
    return BP_OK;
}

/* The molecule of `first`, placed atom by atom. Returns how many particles it has, which are in the queue;
 * *endless: two ways lead to different places. */
static size_t walk_molecule(const BpParticles *p, const BpLattice *lattice, Walk *walk, uint32_t first,
                            bool *endless) {
    size_t count = 1;
    *endless = false;
    walk->queue[0] = first;
    walk->seen[first] = true;
    memcpy(walk->place[first], p->position[first], sizeof walk->place[0]);
    for (size_t q = 0; q < count; q++) {
        const uint32_t i = walk->queue[q];
        for (uint32_t n = walk->start[i]; n < walk->start[i + 1]; n++) {
            const uint32_t k = walk->neighbour[n];
            double d[3], off = 0;
            bp_lattice_way(lattice, p->position[i], p->position[k], d);
            for (int c = 0; c < 3; c++) d[c] += walk->place[i][c];
            if (!walk->seen[k]) {
                walk->seen[k] = true;
                memcpy(walk->place[k], d, sizeof d);
                walk->queue[count++] = k;
                continue;
            }
            for (int c = 0; c < 3; c++) off = fmax(off, fabs(walk->place[k][c] - d[c]));
            double least = INFINITY; /* another place is one cell away at least */
            for (int e = 0; e < 3; e++)
                least = fmin(least, sqrt(lattice->edges[e][0] * lattice->edges[e][0] +
                                         lattice->edges[e][1] * lattice->edges[e][1] +
                                         lattice->edges[e][2] * lattice->edges[e][2]));
            *endless |= off > 0.25 * least;
        }
    }
    return count;
}

BpStatus bp_molecules_make_whole(BpParticles *particles, const bool *shown, const BpBonds *bonds,
                                 size_t *moved, BpError *err) {
    *moved = 0;
    if (!particles->has_cell || !particles->periodic || bonds->count == 0) return BP_OK;
    Walk walk;
    BpLattice lattice;
    bp_lattice_init(&lattice, particles->cell_origin, (const double(*)[3])particles->cell, true);
    BP_TRY(walk_init(&walk, particles->count, bonds, err));
    for (size_t i = 0; i < particles->count; i++) {
        bool endless = false;
        if (!shown[i] || walk.seen[i]) continue;
        const size_t count = walk_molecule(particles, &lattice, &walk, (uint32_t)i, &endless);
        for (size_t q = 0; q < count && !endless; q++) {
            double *const place = particles->position[walk.queue[q]];
            const double *const better = walk.place[walk.queue[q]];
            double off = 0;
            for (int c = 0; c < 3; c++) off = fmax(off, fabs(place[c] - better[c]) / (1 + fabs(place[c])));
            if (off < 1e-9) continue;
            memcpy(place, better, sizeof walk.place[0]);
            ++*moved;
        }
    }
    walk_clear(&walk);
    return BP_OK;
}
