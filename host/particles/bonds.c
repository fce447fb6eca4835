/* bonds.c: see bonds.h. */
#include "bonds.h"

#include "elements.h"
#include "grid.h"

#include <stdlib.h>
#include <string.h>

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
static BpStatus bond_one(const BpParticleGrid *grid, uint32_t i, BpBonds *bonds, BpError *err) {
    enum { MOST = 12 };
    const BpParticles *const p = grid->particles;
    const uint8_t element = p->tag[i].element;
    size_t around[27], found = 0;
    if (element == 0) return BP_OK;
    const size_t count = bp_particle_grid_around(grid, p->position[i], around);
    for (size_t c = 0; c < count; c++) {
        for (uint32_t k = grid->first[around[c]]; k != BP_NO_PARTICLE; k = grid->next[k]) {
            const uint8_t other = p->tag[k].element;
            if (k <= i || other == 0 || (element == 1 && other == 1)) continue;
            double d[3];
            bp_lattice_way(&grid->lattice, p->position[i], p->position[k], d);
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
        BpParticleGrid grid;
        double largest = 0;
        for (size_t i = 0; i < particles->count; i++)
            largest = fmax(largest, (double)bp_elements[particles->tag[i].element].covalent);
        status =
            bp_particle_grid_init(&grid, particles, shown, (2 * largest + 0.4) * particles->angstrom, err);
        if (status == BP_OK) {
            for (size_t i = 0; i < particles->count && status == BP_OK; i++)
                if (shown[i]) status = bond_one(&grid, (uint32_t)i, bonds, err);
            bp_particle_grid_clear(&grid);
        }
    }
    if (status != BP_OK) {
        free(bonds->pair);
        *bonds = (BpBonds){0};
    }
    return status;
}
