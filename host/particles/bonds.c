/* bonds.c: see bonds.h. */
#include "bonds.h"

#include "base/team.h"
#include "elements.h"

#include <stdlib.h>
#include <string.h>

#define NEVER UINT32_MAX

/* Particles are taken by blocks, on all threads. */
enum { BLOCK = 65536 };

typedef struct Bounds {
    double low[3], high[3];
    size_t count; /* of those shown */
} Bounds;

typedef struct Bounding {
    const BpParticles *particles;
    const bool *shown;
    Bounds *blocks;
} Bounding;

static size_t block_end(const BpParticles *p, uint32_t block) {
    const size_t end = ((size_t)block + 1) * BLOCK;
    return end < p->count ? end : p->count;
}

static void bound_block(void *context, uint32_t block, unsigned worker) {
    (void)worker;
    const Bounding *const bounding = context;
    const BpParticles *const p = bounding->particles;
    Bounds bounds = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}, 0};
    for (size_t i = (size_t)block * BLOCK; i < block_end(p, block); i++) {
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

static uint32_t block_count(const BpParticles *p) {
    return (uint32_t)((p->count + BLOCK - 1) / BLOCK);
}

static BpTeam *team_for(const BpParticles *p) {
    return bp_team_create(p->count > BLOCK ? 0 : 1);
}

/* Of all particles that are shown. */
static BpStatus find_bounds(const BpParticles *p, const bool *shown, Bounds *bounds, BpError *err) {
    Bounding bounding = {p, shown, malloc((block_count(p) + 1) * sizeof(Bounds))};
    BpTeam *team = team_for(p);
    const bool good = bounding.blocks != NULL && team != NULL;
    *bounds = (Bounds){{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}, 0};
    if (good) bp_team_run(team, bound_block, &bounding, block_count(p));
    for (uint32_t b = 0; b < block_count(p) && good; b++) {
        bounds->count += bounding.blocks[b].count;
        for (int c = 0; c < 3; c++) {
            bounds->low[c] = fmin(bounds->low[c], bounding.blocks[b].low[c]);
            bounds->high[c] = fmax(bounds->high[c], bounding.blocks[b].high[c]);
        }
    }
    bp_team_destroy(&team);
    free(bounding.blocks);
    return good ? BP_OK : bp_fail(err, BP_ERR_MEMORY, "out of memory for %zu particles", p->count);
}

/* Particles sorted into the cells of a grid; the lists are chains through `next`. */
typedef struct Grid {
    const BpParticles *particles;
    bool periodic;
    double origin[3], edges[3][3], inverse[3][3]; /* share = (place - origin) * inverse */
    int32_t sides[3];
    size_t cell_count;
    uint32_t *first, *next;
} Grid;

static void shares_of(const Grid *grid, const double place[3], double share[3]) {
    for (int i = 0; i < 3; i++) {
        share[i] = 0;
        for (int k = 0; k < 3; k++) share[i] += (place[k] - grid->origin[k]) * grid->inverse[k][i];
    }
}

static void cell_of(const Grid *grid, const double place[3], int32_t cell[3]) {
    double share[3];
    shares_of(grid, place, share);
    for (int i = 0; i < 3; i++) {
        if (grid->periodic) share[i] -= floor(share[i]);
        const double at = floor(share[i] * grid->sides[i]);
        cell[i] = at < 0 ? 0 : at >= grid->sides[i] ? grid->sides[i] - 1 : (int32_t)at;
    }
}

/* The shortest way from a to b in the periodic cell (if it is shorter than half the cell). */
static void way(const Grid *grid, const double a[3], const double b[3], double out[3]) {
    for (int i = 0; i < 3; i++) out[i] = b[i] - a[i];
    if (!grid->periodic) return;
    double share[3];
    for (int i = 0; i < 3; i++) {
        share[i] = 0;
        for (int k = 0; k < 3; k++) share[i] += out[k] * grid->inverse[k][i];
    }
    for (int i = 0; i < 3; i++) {
        const double whole = floor(share[i] + 0.5);
        for (int k = 0; k < 3 && whole != 0; k++) out[k] -= whole * grid->edges[i][k];
    }
}

static void invert(const double m[3][3], double out[3][3]) {
    double determinant = 0;
    for (int i = 0; i < 3; i++)
        determinant +=
            m[0][i] * (m[1][(i + 1) % 3] * m[2][(i + 2) % 3] - m[1][(i + 2) % 3] * m[2][(i + 1) % 3]);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            out[i][k] = (m[(k + 1) % 3][(i + 1) % 3] * m[(k + 2) % 3][(i + 2) % 3] -
                         m[(k + 1) % 3][(i + 2) % 3] * m[(k + 2) % 3][(i + 1) % 3]) /
                        determinant;
}

static void grid_clear(Grid *grid) {
    free(grid->first);
    free(grid->next);
}

static size_t cell_number(const Grid *grid, const int32_t cell[3]) {
    return ((size_t)cell[2] * (size_t)grid->sides[1] + (size_t)cell[1]) * (size_t)grid->sides[0] +
           (size_t)cell[0];
}

/* Cells are at least `reach` wide, so that neighbours nearer than that lie in the cells around. */
static void grid_lay(Grid *grid, const BpParticles *p, const Bounds *bounds, double reach) {
    *grid = (Grid){.particles = p, .periodic = p->has_cell && p->periodic, .cell_count = 1};
    if (grid->periodic) {
        memcpy(grid->origin, p->cell_origin, sizeof grid->origin);
        memcpy(grid->edges, p->cell, sizeof grid->edges);
    } else {
        memcpy(grid->origin, bounds->low, sizeof grid->origin);
        for (int c = 0; c < 3; c++) grid->edges[c][c] = fmax(bounds->high[c] - bounds->low[c], reach);
    }
    invert((const double(*)[3])grid->edges, grid->inverse);
    double sides[3], cells = 1;
    for (int i = 0; i < 3; i++) {
        /* The distance of the two sides that the i-th edge joins. */
        const double slope =
            sqrt(grid->inverse[0][i] * grid->inverse[0][i] + grid->inverse[1][i] * grid->inverse[1][i] +
                 grid->inverse[2][i] * grid->inverse[2][i]);
        sides[i] = fmin(1024, fmax(1, floor(1 / (slope * reach))));
        cells *= sides[i];
    }
    const double room = 4 * (double)p->count + 64, shrink = cells > room ? cbrt(room / cells) : 1;
    for (int i = 0; i < 3; i++) {
        grid->sides[i] = (int32_t)fmax(1, floor(sides[i] * shrink));
        grid->cell_count *= (size_t)grid->sides[i];
    }
}

static BpStatus grid_init(Grid *grid, const BpParticles *p, const bool *shown, double reach, BpError *err) {
    Bounds bounds;
    BP_TRY(find_bounds(p, shown, &bounds, err));
    grid_lay(grid, p, &bounds, reach);
    grid->first = malloc(grid->cell_count * sizeof *grid->first);
    grid->next = malloc((p->count + 1) * sizeof *grid->next);
    if (grid->first == NULL || grid->next == NULL) {
        grid_clear(grid);
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for a grid of %zu particles", p->count);
    }
    for (size_t i = 0; i < grid->cell_count; i++) grid->first[i] = NEVER;
    for (size_t i = p->count; i-- > 0;) {
        int32_t cell[3];
        if (!shown[i]) continue;
        cell_of(grid, p->position[i], cell);
        uint32_t *const head = &grid->first[cell_number(grid, cell)];
        grid->next[i] = *head;
        *head = (uint32_t)i;
    }
    return BP_OK;
}

/* The numbers of the cells around one, itself included; each once. At most 27. */
static size_t cells_around(const Grid *grid, const int32_t cell[3], size_t out[27]) {
    int32_t list[3][3];
    int counts[3];
    for (int i = 0; i < 3; i++) {
        counts[i] = 0;
        for (int32_t step = -1; step <= 1; step++) {
            int32_t at = cell[i] + step;
            if (grid->periodic) at = (at + grid->sides[i]) % grid->sides[i];
            bool known = at < 0 || at >= grid->sides[i];
            for (int k = 0; k < counts[i]; k++) known |= list[i][k] == at;
            if (!known) list[i][counts[i]++] = at;
        }
    }
    size_t count = 0;
    for (int z = 0; z < counts[2]; z++)
        for (int y = 0; y < counts[1]; y++)
            for (int x = 0; x < counts[0]; x++)
                out[count++] = ((size_t)list[2][z] * (size_t)grid->sides[1] + (size_t)list[1][y]) *
                                   (size_t)grid->sides[0] +
                               (size_t)list[0][x];
    return count;
}

static BpStatus add_bond(BpBonds *bonds, uint32_t a, uint32_t b, BpError *err) {
    if (bonds->count == bonds->capacity) {
        const size_t capacity = bonds->capacity > 0 ? 2 * bonds->capacity : 4096;
        void *const grown = realloc(bonds->pair, capacity * sizeof *bonds->pair);
        if (grown == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for %zu bonds", capacity);
        bonds->pair = grown;
        bonds->capacity = capacity;
    }
    bonds->pair[bonds->count][0] = a;
    bonds->pair[bonds->count++][1] = b;
    return BP_OK;
}

static int compare_bonds(const void *a, const void *b) {
    const uint32_t *const one = a, *const other = b;
    if (one[0] != other[0]) return one[0] < other[0] ? -1 : 1;
    return one[1] < other[1] ? -1 : one[1] > other[1];
}

/* Whether the file gives the bond, i < k. */
static bool is_given(const BpBonds *bonds, uint32_t i, uint32_t k) {
    const uint32_t pair[2] = {i, k};
    return bonds->given > 0 &&
           bsearch(pair, bonds->pair, bonds->given, sizeof *bonds->pair, compare_bonds) != NULL;
}

/* The bonds of the file among the particles shown. PDB files list them from both sides, and double bonds
 * twice: these are brought into order, each once. */
static BpStatus take_given(const BpParticles *p, const bool *shown, BpBonds *bonds, BpError *err) {
    for (size_t i = 0; i < p->bond_count; i++) {
        const uint32_t a = p->bonds[i][0], b = p->bonds[i][1];
        const bool turn = p->bonds_partial && a > b;
        if (shown[a] && shown[b] && a != b) BP_TRY(add_bond(bonds, turn ? b : a, turn ? a : b, err));
    }
    bonds->given = bonds->count;
    if (!p->bonds_partial || bonds->count == 0) return BP_OK;
    bonds->given = 0;
    qsort(bonds->pair, bonds->count, sizeof *bonds->pair, compare_bonds);
    for (size_t i = 0; i < bonds->count; i++)
        if (i == 0 || compare_bonds(bonds->pair[i], bonds->pair[bonds->given - 1]) != 0)
            memmove(bonds->pair[bonds->given++], bonds->pair[i], sizeof *bonds->pair);
    bonds->count = bonds->given;
    return BP_OK;
}

/* Finds the bonds of one particle with those of higher numbers. Alternative places of an atom are not bonded
 * to each other; an atom has at most 12 bonds. */
static BpStatus bond_one(const Grid *grid, uint32_t i, BpBonds *bonds, BpError *err) {
    enum { MOST = 12 };
    const BpParticles *const p = grid->particles;
    const uint8_t element = p->tag[i].element;
    int32_t cell[3];
    size_t around[27], found = 0;
    if (element == 0) return BP_OK;
    cell_of(grid, p->position[i], cell);
    const size_t count = cells_around(grid, cell, around);
    for (size_t c = 0; c < count; c++) {
        for (uint32_t k = grid->first[around[c]]; k != NEVER; k = grid->next[k]) {
            const uint8_t other = p->tag[k].element;
            if (k <= i || other == 0 || (element == 1 && other == 1)) continue;
            double d[3];
            way(grid, p->position[i], p->position[k], d);
            const double squared = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
            const double reach =
                ((double)bp_elements[element].covalent + (double)bp_elements[other].covalent + 0.4) *
                p->angstrom;
            const double least = 0.4 * p->angstrom;
            if (squared > reach * reach || squared < least * least || found == MOST) continue;
            found++;
            if (is_given(bonds, i, k)) continue;
            BP_TRY(add_bond(bonds, i, k, err));
        }
    }
    return BP_OK;
}

BpStatus bp_bonds_find(const BpParticles *particles, const bool *shown, BpBonds *bonds, BpError *err) {
    *bonds = (BpBonds){0};
    BpStatus status = take_given(particles, shown, bonds, err);
    const bool find = particles->bond_count == 0 || particles->bonds_partial;
    if (status == BP_OK && find && particles->has_element && particles->angstrom > 0) {
        Grid grid;
        double largest = 0;
        for (size_t i = 0; i < particles->count; i++)
            largest = fmax(largest, (double)bp_elements[particles->tag[i].element].covalent);
        status = grid_init(&grid, particles, shown, (2 * largest + 0.4) * particles->angstrom, err);
        if (status == BP_OK) {
            for (size_t i = 0; i < particles->count && status == BP_OK; i++)
                if (shown[i]) status = bond_one(&grid, (uint32_t)i, bonds, err);
            grid_clear(&grid);
        }
    }
    if (status != BP_OK) {
        free(bonds->pair);
        *bonds = (BpBonds){0};
    }
    return status;
}

/* ---- molecules ------------------------------------------------------------------------------------------
 */

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
static size_t walk_molecule(const Grid *grid, Walk *walk, uint32_t first, bool *endless) {
    const BpParticles *const p = grid->particles;
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
            way(grid, p->position[i], p->position[k], d);
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
                least = fmin(least, sqrt(grid->edges[e][0] * grid->edges[e][0] +
                                         grid->edges[e][1] * grid->edges[e][1] +
                                         grid->edges[e][2] * grid->edges[e][2]));
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
    Grid grid = {.particles = particles, .periodic = true};
    memcpy(grid.origin, particles->cell_origin, sizeof grid.origin);
    memcpy(grid.edges, particles->cell, sizeof grid.edges);
    invert((const double(*)[3])grid.edges, grid.inverse);
    BP_TRY(walk_init(&walk, particles->count, bonds, err));
    for (size_t i = 0; i < particles->count; i++) {
        bool endless = false;
        if (!shown[i] || walk.seen[i]) continue;
        const size_t count = walk_molecule(&grid, &walk, (uint32_t)i, &endless);
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

/* ---- spacing --------------------------------------------------------------------------------------------
 */

static int compare_reals(const void *a, const void *b) {
    const double one = *(const double *)a, other = *(const double *)b;
    return one < other ? -1 : one > other;
}

/* The distances of a thousand particles to their nearest neighbours. Only what lies in the cells around those
 * is kept, so that millions of particles need one pass and hardly any memory. */
typedef struct Sampling {
    Grid grid; /* without its lists */
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
    for (size_t i = (size_t)block * BLOCK; i < block_end(p, block) && !near->failed; i++) {
        int32_t cell[3];
        if (!s->shown[i]) continue;
        cell_of(&s->grid, p->position[i], cell);
        if (!is_marked(s, cell_number(&s->grid, cell))) continue;
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
    for (uint32_t b = 0; b < block_count(s->grid.particles) && s->near != NULL; b++)
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
        int32_t cell[3];
        size_t around[27];
        if (!s->shown[i]) continue;
        cell_of(&s->grid, p->position[i], cell);
        const size_t cells = cells_around(&s->grid, cell, around);
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
    for (uint32_t b = 0; b < block_count(s->grid.particles); b++) {
        if (s->near[b].failed) return false;
        count += s->near[b].count;
    }
    s->first = malloc((marked + 1) * sizeof *s->first);
    s->next = malloc((count + 1) * sizeof *s->next);
    s->particle = malloc((count + 1) * sizeof *s->particle);
    if (s->first == NULL || s->next == NULL || s->particle == NULL) return false;
    for (uint32_t m = 0; m < marked; m++) s->first[m] = NEVER;
    for (uint32_t b = block_count(s->grid.particles), n = 0; b-- > 0;)
        for (uint32_t k = s->near[b].count; k-- > 0; n++) {
            int32_t cell[3];
            s->particle[n] = s->near[b].particles[k];
            cell_of(&s->grid, s->grid.particles->position[s->particle[n]], cell);
            uint32_t *const head = &s->first[place_of(s, cell_number(&s->grid, cell))];
            s->next[n] = *head;
            *head = n;
        }
    return true;
}

/* Needs the grid. */
static BpStatus sampling_fill(Sampling *s, size_t step, BpError *err) {
    const BpParticles *const p = s->grid.particles;
    const size_t words = s->grid.cell_count / 64 + 1;
    BpTeam *team = team_for(p);
    s->marks = calloc(words, sizeof *s->marks);
    s->before = malloc(words * sizeof *s->before);
    s->near = calloc(block_count(p) + 1, sizeof *s->near);
    bool good = team != NULL && s->marks != NULL && s->before != NULL && s->near != NULL;
    if (good) {
        mark_cells(s, step);
        bp_team_run(team, sort_out_block, s, block_count(p));
        good = link_cells(s);
    }
    bp_team_destroy(&team);
    return good ? BP_OK : bp_fail(err, BP_ERR_MEMORY, "out of memory for a grid of %zu particles", p->count);
}

/* The square of the distance to the nearest neighbour; infinite where there is none. */
static double nearest_square(const Sampling *s, size_t i) {
    const BpParticles *const p = s->grid.particles;
    int32_t cell[3];
    size_t around[27];
    double least = INFINITY;
    cell_of(&s->grid, p->position[i], cell);
    const size_t cells = cells_around(&s->grid, cell, around);
    for (size_t c = 0; c < cells; c++) {
        uint32_t n = s->first[place_of(s, around[c])];
        for (size_t looked = 0; n != NEVER && looked < 4096; n = s->next[n], looked++) {
            double d[3];
            way(&s->grid, p->position[i], p->position[s->particle[n]], d);
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
    Bounds bounds;
    size_t found = 0;
    int dimensions = 0;
    *spacing = 0;
    BP_TRY(find_bounds(particles, shown, &bounds, err));
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
    grid_lay(&sampling.grid, particles, &bounds, reach);
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
