/* disorder.c: see disorder.h. */
#include "disorder.h"

#include "elements.h"
#include "grid.h"
#include "scene/vector.h"

#include <stdlib.h>
#include <string.h>

#define BOND_REACH 0.4    /* beyond the covalent radii, as bonds.h has it */
#define FULL 1.05         /* the largest sum of occupancies that may be those of one place */
#define IMAGES_MAX 1000.0 /* cells to be looked at around a place */

/* ---- groups -------------------------------------------------------------------------------------------- */

typedef struct Group {
    uint16_t assembly, group;
    uint32_t first; /* its first site */
    size_t count;
    double sum; /* of occupancies */
    bool shown;
} Group;

static int compare_groups(const void *a, const void *b) {
    const Group *const one = a, *const other = b;
    if (one->assembly != other->assembly) return one->assembly < other->assembly ? -1 : 1;
    if (one->group != other->group) return one->group < other->group ? -1 : 1;
    return one->first < other->first ? -1 : one->first > other->first;
}

static bool has_group(const CifBlock *block, size_t site) {
    const uint16_t group = block->site[site].group;
    return group != 0 && strcmp(block->names.text[group], "0") != 0;
}

static double mean_of(const Group *group) {
    return group->sum / (double)group->count;
}

/* Chooses among the groups of one assembly. */
static void choose(Group *begin, const Group *end) {
    const Group *best = begin;
    for (const Group *group = begin; group < end; group++) {
        const double more = mean_of(group) - mean_of(best);
        if (more > 1e-9 || (more > -1e-9 && group->first < best->first)) best = group;
    }
    for (Group *group = begin; group < end; group++)
        group->shown = group == best || mean_of(group) + mean_of(best) > FULL;
}

/* Each group once, in order. */
static size_t join_groups(Group *groups, size_t count) {
    size_t kept = 0;
    qsort(groups, count, sizeof *groups, compare_groups);
    for (size_t i = 0; i < count; i++) {
        Group *const last = &groups[kept > 0 ? kept - 1 : 0];
        if (kept > 0 && last->assembly == groups[i].assembly && last->group == groups[i].group) {
            last->sum += groups[i].sum;
            last->count++;
        } else {
            groups[kept++] = groups[i];
        }
    }
    return kept;
}

static BpStatus mark_groups(BpParticles *p, const CifBlock *block, const CellAtom *atom, BpError *err) {
    size_t count = 0;
    Group *const groups = malloc((block->site_count + 1) * sizeof *groups);
    if (groups == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for disorder groups");
    for (size_t s = 0; s < block->site_count; s++) {
        const CifSite *const site = &block->site[s];
        if (has_group(block, s))
            groups[count++] = (Group){site->assembly, site->group, (uint32_t)s, 1, site->occupancy, false};
    }
    count = join_groups(groups, count);
    for (size_t begin = 0, end = 0; begin < count; begin = end) {
        while (end < count && groups[end].assembly == groups[begin].assembly) end++;
        choose(&groups[begin], &groups[end]);
    }
    for (size_t i = 0; i < p->count && count > 0; i++) {
        const CifSite *const site = &block->site[atom[i].site];
        size_t low = 0, high = count;
        if (!has_group(block, atom[i].site)) continue;
        while (high - low > 1) {
            const size_t middle = low + (high - low) / 2;
            const bool before =
                groups[middle].assembly < site->assembly ||
                (groups[middle].assembly == site->assembly && groups[middle].group <= site->group);
            if (before)
                low = middle;
            else
                high = middle;
        }
        if (!groups[low].shown) p->tag[i].flags |= BP_PARTICLE_ALTERNATIVE;
    }
    free(groups);
    return BP_OK;
}

/* ---- atoms -----------------------------------------------------------------------------------------------
 */

/* In the order in which atoms are chosen. */
typedef struct Turn {
    double occupancy;
    uint32_t particle, site;
    uint16_t operation;
} Turn;

static int compare_turns(const void *a, const void *b) {
    const Turn *const one = a, *const other = b;
    if (one->occupancy > other->occupancy || one->occupancy < other->occupancy)
        return one->occupancy > other->occupancy ? -1 : 1;
    if (one->operation != other->operation) return one->operation < other->operation ? -1 : 1;
    return one->site < other->site ? -1 : one->site > other->site;
}

/* Whether both are of a group that lies about a symmetry element, in images of two operations. */
static bool are_images(const CifBlock *block, const CellAtom *a, const CellAtom *b) {
    const CifSite *const one = &block->site[a->site], *const other = &block->site[b->site];
    return one->group == other->group && one->assembly == other->assembly &&
           block->names.count > one->group && block->names.text[one->group][0] == '-' &&
           a->operation != b->operation;
}

/* The distance from which on two atoms may be there together. */
static double least_distance(const BpParticles *p, const CifBlock *block, const CellAtom *atom, uint32_t a,
                             uint32_t b) {
    const double radii =
        (double)bp_elements[p->tag[a].element].covalent + (double)bp_elements[p->tag[b].element].covalent;
    if (are_images(block, &atom[a], &atom[b])) return radii + BOND_REACH;
    const double occupancy = block->site[atom[a].site].occupancy + block->site[atom[b].site].occupancy;
    return occupancy <= FULL ? fmax(radii / 2, DISORDER_SAME) : DISORDER_SAME;
}

/* Whether an atom that is shown, and so is in the grid, excludes this one. */
static bool is_excluded(const BpParticleGrid *grid, const CifBlock *block, const CellAtom *atom, uint32_t i) {
    const BpParticles *const p = grid->particles;
    BpGridWalk walk;
    bp_particle_grid_begin(grid, p->position[i], &walk);
    while (bp_particle_grid_next(&walk))
        for (uint32_t k = grid->first[walk.cell]; k != BP_NO_PARTICLE; k = grid->next[k]) {
            int32_t image[3];
            double way[3];
            bp_particle_grid_image(&walk, grid->whole[k], image);
            bp_lattice_way(&grid->lattice, p->position[i], p->position[k], image, way);
            const double least = least_distance(p, block, atom, i, k);
            if (bp_dot(way, way) < least * least) return true;
        }
    return false;
}

static bool is_too_thin(const BpParticleGrid *grid) {
    double cells = 1;
    for (int i = 0; i < 3; i++) cells *= 2.0 * grid->steps[i] + 1;
    return cells > IMAGES_MAX;
}

/* Goes through the atoms, and fills the grid with those that are shown. */
static void mark_atoms(BpParticles *p, BpParticleGrid *grid, const CifBlock *block, const CellAtom *atom,
                       const Turn *turns, size_t count) {
    for (size_t c = 0; c < grid->cell_count; c++) grid->first[c] = BP_NO_PARTICLE;
    for (size_t t = 0; t < count; t++) {
        const uint32_t i = turns[t].particle;
        if (is_excluded(grid, block, atom, i)) {
            p->tag[i].flags |= BP_PARTICLE_ALTERNATIVE;
            continue;
        }
        uint32_t *const head = &grid->first[bp_particle_grid_cell(grid, p->position[i])];
        grid->next[i] = *head;
        *head = i;
    }
}

/* How far apart atoms may be that exclude each other. */
static double find_reach(const BpParticles *p, const CifBlock *block, const CellAtom *atom) {
    double reach = DISORDER_SAME;
    for (size_t i = 0; i < p->count; i++) {
        const CifSite *const site = &block->site[atom[i].site];
        const double radius = (double)bp_elements[p->tag[i].element].covalent;
        const bool negative = site->group != 0 && block->names.text[site->group][0] == '-';
        if (site->occupancy < 1) reach = fmax(reach, radius);
        if (negative) reach = fmax(reach, 2 * radius + BOND_REACH);
    }
    return reach;
}

BpStatus disorder_mark(BpParticles *particles, const CifBlock *block, const CellAtom *atom, BpError *err) {
    BpParticles *const p = particles;
    BpParticleGrid grid;
    BP_TRY(mark_groups(p, block, atom, err));
    bool *const tried = calloc(p->count + 1, sizeof *tried);
    Turn *const turns = malloc((p->count + 1) * sizeof *turns);
    size_t count = 0;
    BpStatus status = BP_OK;
    if (tried == NULL || turns == NULL)
        status = bp_fail(err, BP_ERR_MEMORY, "out of memory for the places of %zu atoms", p->count);
    for (size_t i = 0; i < p->count && status == BP_OK; i++) {
        tried[i] = (p->tag[i].flags & (BP_PARTICLE_ALTERNATIVE | BP_PARTICLE_DUMMY)) == 0;
        if (!tried[i]) continue;
        const CellAtom *const own = &atom[i];
        turns[count++] = (Turn){block->site[own->site].occupancy, (uint32_t)i, own->site, own->operation};
    }
    if (status == BP_OK) status = bp_particle_grid_init(&grid, p, tried, find_reach(p, block, atom), err);
    if (status == BP_OK) {
        qsort(turns, count, sizeof *turns, compare_turns);
        if (!is_too_thin(&grid)) mark_atoms(p, &grid, block, atom, turns, count);
        bp_particle_grid_clear(&grid);
    }
    free(tried);
    free(turns);
    return status;
}
