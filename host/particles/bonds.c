/* bonds.c: see bonds.h. */
#include "bonds.h"

#include "elements.h"
#include "grid.h"

#include <stdlib.h>
#include <string.h>

/* Beyond these, coordinates have another unit than their format says, or atoms lie in each other. */
#define IMAGES_MAX 1.0e5 /* cells that may hold neighbours of one atom */
#define TESTS_MAX                                                                                            \
    ((uint64_t)1 << 33) /* pairs that are looked at; many, if one atom lies far from all others */
enum {
    TESTS_AN_ATOM = 4096, /* in addition; where there are 0.1 atoms a cubic angstrom, 500 are needed */
    BONDS_AN_ATOM = 32,   /* twice as many as crystals have */
    BONDS_MORE = 4096     /* in addition, for small files */
};

static BpStatus add_bond(BpBonds *bonds, const BpBond *bond, BpError *err) {
    if (bonds->count == bonds->capacity) {
        const size_t capacity = bonds->capacity > 0 ? 2 * bonds->capacity : 4096;
        void *const grown = realloc(bonds->bond, capacity * sizeof *bonds->bond);
        if (grown == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for %zu bonds", capacity);
        bonds->bond = grown;
        bonds->capacity = capacity;
    }
    bonds->bond[bonds->count++] = *bond;
    return BP_OK;
}

static int compare_bonds(const void *a, const void *b) {
    const BpBond *const one = a, *const other = b;
    if (one->a != other->a) return one->a < other->a ? -1 : 1;
    if (one->b != other->b) return one->b < other->b ? -1 : 1;
    for (int i = 0; i < 3; i++)
        if (one->image[i] != other->image[i]) return one->image[i] < other->image[i] ? -1 : 1;
    return 0;
}

/* Whether the file gives the bond, a <= b; the given ones are in order. */
static bool is_given(const BpBonds *bonds, const BpBond *bond) {
    return bonds->given > 0 &&
           bsearch(bond, bonds->bond, bonds->given, sizeof *bonds->bond, compare_bonds) != NULL;
}

/* Whether bond i comes after bond i - 1, and all begin at the lower number: then none comes twice. */
static bool rises(const BpBonds *bonds) {
    for (size_t i = 0; i < bonds->count; i++)
        if (bonds->bond[i].a > bonds->bond[i].b ||
            (i > 0 && compare_bonds(&bonds->bond[i - 1], &bonds->bond[i]) >= 0))
            return false;
    return true;
}

/* A given bond from its lower number, and its place in the list. */
typedef struct Listed {
    BpBond bond;
    size_t place;
} Listed;

static int compare_listed(const void *a, const void *b) {
    const Listed *const one = a, *const other = b;
    const int order = compare_bonds(&one->bond, &other->bond);
    return order != 0 ? order : one->place < other->place ? -1 : one->place > other->place;
}

/* Leaves the first of bonds that are equal, whichever of their ends comes first. Ordered: in order, from the
 * lower numbers; else as they stood. */
static BpStatus drop_doubles(BpBonds *bonds, bool ordered, BpError *err) {
    if (rises(bonds)) return BP_OK;
    Listed *const list = malloc((bonds->count + 1) * sizeof *list);
    bool *const again = calloc(bonds->count + 1, sizeof *again);
    size_t kept = 0;
    const bool good = list != NULL && again != NULL;
    for (size_t i = 0; i < bonds->count && good; i++) {
        BpBond bond = bonds->bond[i];
        if (bond.a > bond.b) {
            bond = (BpBond){bond.b, bond.a, {0}};
            for (int c = 0; c < 3; c++) bond.image[c] = -bonds->bond[i].image[c];
        }
        list[i] = (Listed){bond, i};
    }
    if (good) qsort(list, bonds->count, sizeof *list, compare_listed);
    for (size_t i = 1; i < bonds->count && good; i++)
        again[ordered ? i : list[i].place] = compare_bonds(&list[i - 1].bond, &list[i].bond) == 0;
    for (size_t i = 0; i < bonds->count && good; i++)
        if (!again[i]) bonds->bond[kept++] = ordered ? list[i].bond : bonds->bond[i];
    bonds->count = kept;
    free(list);
    free(again);
    return good ? BP_OK : bp_fail(err, BP_ERR_MEMORY, "out of memory for the bonds of a file");
}

/* The bonds of the file among the particles shown. PDB files list them from both sides, and double bonds
 * twice: these are brought into order. */
static BpStatus take_given(const BpParticles *p, const bool *shown, BpBonds *bonds, BpError *err) {
    for (size_t i = 0; i < p->bond_count; i++) {
        BpBond bond = {p->bonds[i][0], p->bonds[i][1], {0, 0, 0}};
        if (!shown[bond.a] || !shown[bond.b] || bond.a == bond.b) continue;
        if (bp_lattice_repeats(&bonds->lattice))
            bp_lattice_nearest(&bonds->lattice, p->position[bond.a], p->position[bond.b], bond.image);
        BP_TRY(add_bond(bonds, &bond, err));
    }
    BP_TRY(drop_doubles(bonds, p->bonds_partial, err));
    bonds->given = bonds->count;
    return BP_OK;
}

/* Of the two ways between an atom and its image, one. */
static bool is_forward(const int32_t image[3]) {
    for (int i = 0; i < 3; i++)
        if (image[i] != 0) return image[i] > 0;
    return false;
}

static bool is_in_reach(const BpParticleGrid *grid, const BpBond *bond) {
    const BpParticles *const p = grid->particles;
    const double radii = (double)bp_elements[p->tag[bond->a].element].covalent +
                         (double)bp_elements[p->tag[bond->b].element].covalent;
    const double reach = (radii + 0.4) * p->angstrom, least = 0.4 * p->angstrom;
    double d[3];
    bp_lattice_way(&grid->lattice, p->position[bond->a], p->position[bond->b], bond->image, d);
    const double squared = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
    return squared <= reach * reach && squared >= least * least;
}

/* Finds the bonds of one particle with those of higher numbers, and with images of itself. Alternative places
 * of an atom are not bonded to each other. *tests: goes up by the pairs that were looked at. */
static BpStatus bond_one(const BpParticleGrid *grid, uint32_t i, BpBonds *bonds, uint64_t *tests,
                         BpError *err) {
    const BpParticles *const p = grid->particles;
    const uint8_t element = p->tag[i].element;
    BpGridWalk walk;
    if (element == 0) return BP_OK;
    bp_particle_grid_begin(grid, p->position[i], &walk);
    while (bp_particle_grid_next(&walk)) {
        for (uint32_t k = grid->first[walk.cell]; k != BP_NO_PARTICLE; k = grid->next[k]) {
            ++*tests;
            if (k < i) continue;
            const uint8_t other = p->tag[k].element;
            if (other == 0 || (element == 1 && other == 1)) continue;
            BpBond bond = {i, k, {0, 0, 0}};
            if (grid->whole != NULL) bp_particle_grid_image(&walk, grid->whole[k], bond.image);
            if (k == i && !is_forward(bond.image)) continue;
            if (is_in_reach(grid, &bond) && !is_given(bonds, &bond)) BP_TRY(add_bond(bonds, &bond, err));
        }
    }
    return BP_OK;
}

static bool is_too_thin(const BpParticleGrid *grid) {
    double cells = 1;
    for (int i = 0; i < 3; i++)
        if (grid->lattice.periodic[i]) cells *= 2.0 * grid->steps[i] + 1;
    return cells > IMAGES_MAX;
}

static BpStatus find_by_distance(const BpParticles *particles, const bool *shown, BpBonds *bonds,
                                 BpError *err) {
    BpParticleGrid grid;
    double largest = 0;
    uint64_t tests = 0, atoms = 0;
    BpStatus status = BP_OK;
    for (size_t i = 0; i < particles->count; i++)
        largest = fmax(largest, (double)bp_elements[particles->tag[i].element].covalent);
    BP_TRY(bp_particle_grid_init(&grid, particles, shown, (2 * largest + 0.4) * particles->angstrom, err));
    bonds->crowded = is_too_thin(&grid);
    for (size_t i = 0; i < particles->count && status == BP_OK && !bonds->crowded; i++) {
        if (!shown[i]) continue;
        atoms++;
        status = bond_one(&grid, (uint32_t)i, bonds, &tests, err);
        bonds->crowded = tests > TESTS_MAX + TESTS_AN_ATOM * atoms ||
                         bonds->count - bonds->given > BONDS_AN_ATOM * atoms + BONDS_MORE;
    }
    bp_particle_grid_clear(&grid);
    if (bonds->crowded) bonds->count = bonds->given;
    return status;
}

BpStatus bp_bonds_find(const BpParticles *particles, const bool *shown, BpBonds *bonds, BpError *err) {
    *bonds = (BpBonds){0};
    bp_lattice_of(&bonds->lattice, particles);
    BpStatus status = take_given(particles, shown, bonds, err);
    const bool find = particles->bond_count == 0 || particles->bonds_partial;
    if (status == BP_OK && find && particles->has_element && particles->angstrom > 0)
        status = find_by_distance(particles, shown, bonds, err);
    if (status != BP_OK) {
        free(bonds->bond);
        *bonds = (BpBonds){0};
    }
    return status;
}
