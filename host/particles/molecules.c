/* molecules.c: see molecules.h. */
#include "molecules.h"

#include <stdlib.h>
#include <string.h>

/* A bond as one of its ends has it. */
typedef struct Link {
    uint32_t to;
    int32_t image[3];
} Link;

typedef struct Walk {
    uint32_t *start, *queue; /* the links of i: link[start[i] .. start[i + 1]) */
    Link *link;
    int32_t (*move)[3]; /* by how many edges of the lattice each particle is to move */
    bool *seen;
} Walk;

static void walk_clear(Walk *walk) {
    free(walk->start);
    free(walk->link);
    free(walk->queue);
    free(walk->move);
    free(walk->seen);
}

static BpStatus walk_init(Walk *walk, size_t count, const BpBonds *bonds, BpError *err) {
    *walk = (Walk){.start = calloc(count + 2, sizeof *walk->start),
                   .link = malloc((2 * bonds->count + 1) * sizeof *walk->link),
                   .queue = malloc((count + 1) * sizeof *walk->queue),
                   .move = calloc(count + 1, sizeof *walk->move),
                   .seen = calloc(count + 1, sizeof *walk->seen)};
    if (walk->start == NULL || walk->link == NULL || walk->queue == NULL || walk->move == NULL ||
        walk->seen == NULL) {
        walk_clear(walk);
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for the molecules of %zu particles", count);
    }
    for (size_t b = 0; b < bonds->count; b++) {
        walk->start[bonds->bond[b].a + 2]++;
        walk->start[bonds->bond[b].b + 2]++;
    }
    for (size_t i = 2; i < count + 2; i++) walk->start[i] += walk->start[i - 1];
    for (size_t b = 0; b < bonds->count; b++) {
        const BpBond *const bond = &bonds->bond[b];
        Link *const there = &walk->link[walk->start[bond->a + 1]++];
        *there = (Link){bond->b, {bond->image[0], bond->image[1], bond->image[2]}};
        Link *const back = &walk->link[walk->start[bond->b + 1]++];
        *back = (Link){bond->a, {-bond->image[0], -bond->image[1], -bond->image[2]}};
    }
    return BP_OK;
}

/* The molecule of `first`, atom by atom. Returns how many particles it has, which are in the queue;
 * *endless: two ways lead to different images of a particle. */
static size_t walk_molecule(Walk *walk, uint32_t first, bool *endless) {
    size_t count = 1;
    *endless = false;
    walk->queue[0] = first;
    walk->seen[first] = true;
    for (size_t q = 0; q < count; q++) {
        const uint32_t i = walk->queue[q];
        for (uint32_t n = walk->start[i]; n < walk->start[i + 1]; n++) {
            const Link *const link = &walk->link[n];
            int64_t move[3];
            bool same = true;
            for (int e = 0; e < 3; e++) {
                move[e] = (int64_t)walk->move[i][e] + link->image[e];
                same &= walk->seen[link->to] ? move[e] == walk->move[link->to][e]
                                             : move[e] >= INT32_MIN && move[e] <= INT32_MAX;
            }
            *endless |= !same;
            if (walk->seen[link->to]) continue;
            walk->seen[link->to] = true;
            for (int e = 0; e < 3; e++) walk->move[link->to][e] = same ? (int32_t)move[e] : 0;
            walk->queue[count++] = link->to;
        }
    }
    return count;
}

/* Moves a particle; true: it does move. */
static bool move_particle(const BpLattice *lattice, const int32_t move[3], double place[3]) {
    const double origin[3] = {0, 0, 0};
    double moved[3];
    if (move[0] == 0 && move[1] == 0 && move[2] == 0) return false;
    bp_lattice_way(lattice, origin, place, move, moved);
    memcpy(place, moved, sizeof moved);
    return true;
}

BpStatus bp_molecules_make_whole(BpParticles *particles, const bool *shown, BpBonds *bonds, size_t *moved,
                                 BpError *err) {
    *moved = 0;
    if (!bp_lattice_repeats(&bonds->lattice) || bonds->count == 0) return BP_OK;
    Walk walk;
    BP_TRY(walk_init(&walk, particles->count, bonds, err));
    for (size_t i = 0; i < particles->count; i++) {
        bool endless = false;
        if (!shown[i] || walk.seen[i]) continue;
        const size_t count = walk_molecule(&walk, (uint32_t)i, &endless);
        for (size_t q = 0; q < count; q++) {
            int32_t *const move = walk.move[walk.queue[q]];
            if (endless) memset(move, 0, sizeof walk.move[0]);
            *moved += move_particle(&bonds->lattice, move, particles->position[walk.queue[q]]);
        }
    }
    for (size_t b = 0; b < bonds->count; b++)
        for (int e = 0; e < 3; e++)
            bonds->bond[b].image[e] =
                (int32_t)((int64_t)bonds->bond[b].image[e] + walk.move[bonds->bond[b].a][e] -
                          walk.move[bonds->bond[b].b][e]);
    walk_clear(&walk);
    return BP_OK;
}
