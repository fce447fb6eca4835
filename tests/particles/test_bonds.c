/* test_bonds.c: bonds, molecules made whole and the distance of neighbours, beside all pairs in all images.
 *
 * Cells of all shapes: thin, skewed by far, smaller than the reach of a bond, left-handed, flat; that repeat
 * along all edges, some or none; of particles that lie inside and outside. Knows: covalent radii.   Does not
 * know: files, style. */
#include "particles/bonds.h"
#include "particles/elements.h"
#include "particles/molecules.h"
#include "particles/spacing.h"
#include "support/unit_test.h"

#include "base/random.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CELLS = 300, PARTICLES_MAX = 16 };

/* A frame of random particles, which points to its own arrays. */
typedef struct Case {
    BpParticles p;
    double position[PARTICLES_MAX][3];
    BpParticleTag tag[PARTICLES_MAX];
    bool shown[PARTICLES_MAX];
    double inverse[3][3]; /* of the cell, whose edges that do not repeat are at right angles to the others */
} Case;

static double uniform(BpRandom *random, double low, double high) {
    return low + (high - low) * bp_random_next(random);
}

static size_t choice(BpRandom *random, size_t count) {
    return (size_t)(bp_random_next(random) * (double)count);
}

static double dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static double determinant(const double m[3][3]) {
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
           m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

static void invert(const double m[3][3], double out[3][3]) {
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) {
            const int r1 = (c + 1) % 3, r2 = (c + 2) % 3, c1 = (r + 1) % 3, c2 = (r + 2) % 3;
            out[r][c] = (m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1]) / determinant(m);
        }
}

/* Edges of a random cell: of one of five shapes. */
static void make_cell(BpRandom *random, double least_volume, double cell[3][3]) {
    const size_t shape = choice(random, 5);
    do {
        for (int e = 0; e < 3; e++)
            for (int c = 0; c < 3; c++) {
                const double scale = shape == 0 ? 14 : shape == 1 ? 3 : 6;
                cell[e][c] = shape == 2 && c != e ? 0 : uniform(random, -scale, scale);
            }
        if (shape == 3) /* thin */
            for (int c = 0; c < 3; c++) cell[2][c] *= 0.15;
        if (shape == 4) /* skewed by far */
            for (int c = 0; c < 3; c++) {
                cell[1][c] += 5 * cell[0][c];
                cell[2][c] += 3 * cell[0][c] - 4 * cell[1][c];
            }
        if (choice(random, 2) == 0)
            for (int c = 0; c < 3; c++) cell[0][c] = -cell[0][c]; /* the other hand */
    } while (fabs(determinant((const double(*)[3])cell)) < least_volume);
}

/* The cell with vectors at right angles to all that repeat in place of the others; its inverse gives bounds
 * on images. */
static void invert_cell(Case *test) {
    double own[3][3];
    memcpy(own, test->p.cell, sizeof own);
    for (int e = 0; e < 3; e++) {
        if (test->p.periodic[e]) continue;
        double v[3] = {0.3, -0.7, 0.64};
        v[e] += 2;
        for (int turn = 0; turn < 40; turn++) /* projected again and again, since the others are oblique */
            for (int f = 0; f < 3; f++) {
                if (f == e || (!test->p.periodic[f] && f > e)) continue;
                const double along = dot(v, own[f]) / dot(own[f], own[f]);
                for (int c = 0; c < 3; c++) v[c] -= along * own[f][c];
            }
        memcpy(own[e], v, sizeof v);
    }
    invert((const double(*)[3])own, test->inverse);
}

static void make_case(BpRandom *random, Case *test) {
    static const uint8_t elements[] = {1, 6, 8, 11, 55, 0};
    memset(test, 0, sizeof *test);
    BpParticles *const p = &test->p;
    p->count = 1 + choice(random, PARTICLES_MAX);
    p->position = test->position;
    p->tag = test->tag;
    p->has_cell = p->has_element = true;
    p->angstrom = 1;
    make_cell(random, 3 * (double)p->count, p->cell);
    const size_t edges = choice(random, 8);
    for (int e = 0; e < 3; e++) p->periodic[e] = choice(random, 3) > 0 || (edges >> e & 1) != 0;
    for (int c = 0; c < 3; c++) p->cell_origin[c] = uniform(random, -9, 9);
    const bool flat = choice(random, 6) == 0, outside = choice(random, 2) == 0;
    for (size_t i = 0; i < p->count; i++) {
        test->shown[i] = choice(random, 10) > 0;
        test->tag[i].element = elements[choice(random, sizeof elements)];
        for (int c = 0; c < 3; c++) test->position[i][c] = p->cell_origin[c];
        for (int e = 0; e < 3; e++) {
            const double share = outside ? uniform(random, -2.5, 3) : uniform(random, 0, 1);
            for (int c = 0; c < 3; c++) test->position[i][c] += share * p->cell[e][c];
        }
        if (flat) test->position[i][2] = p->cell_origin[2];
    }
    invert_cell(test);
}

/* How far images of way d have to be sought along edge e, so that none nearer than `reach` is missed. */
static void find_range(const Case *test, const double d[3], double reach, int e, int *low, int *high) {
    *low = *high = 0;
    if (!test->p.periodic[e]) return;
    const double column[3] = {test->inverse[0][e], test->inverse[1][e], test->inverse[2][e]};
    const double share = dot(d, column), width = reach * sqrt(dot(column, column));
    *low = (int)floor(-share - width) - 1;
    *high = (int)ceil(-share + width) + 1;
}

typedef void Visit(void *context, const int image[3], double distance);

/* All images of k nearer to i than `reach`. */
static void all_images(const Case *test, size_t i, size_t k, double reach, Visit *visit, void *context) {
    double d[3], at[3];
    int low[3], high[3], n[3];
    for (int c = 0; c < 3; c++) d[c] = test->position[k][c] - test->position[i][c];
    for (int e = 0; e < 3; e++) find_range(test, d, reach, e, &low[e], &high[e]);
    for (n[0] = low[0]; n[0] <= high[0]; n[0]++)
        for (n[1] = low[1]; n[1] <= high[1]; n[1]++)
            for (n[2] = low[2]; n[2] <= high[2]; n[2]++) {
                for (int c = 0; c < 3; c++)
                    at[c] = d[c] + n[0] * test->p.cell[0][c] + n[1] * test->p.cell[1][c] +
                            n[2] * test->p.cell[2][c];
                const double distance = sqrt(dot(at, at));
                if (distance <= reach) visit(context, n, distance);
            }
}

/* ---- bonds -------------------------------------------------------------------------------------------- */

typedef struct Expected {
    BpBond *bond; /* images count the edges of the cell itself */
    size_t count, capacity;
    uint32_t a, b;
    double least;
} Expected;

static void expect(Expected *expected, const BpBond *bond) {
    if (expected->count == expected->capacity) {
        expected->capacity = 2 * expected->capacity + 256;
        expected->bond = realloc(expected->bond, expected->capacity * sizeof *expected->bond);
        assert_non_null(expected->bond);
    }
    expected->bond[expected->count++] = *bond;
}

static void expect_image(void *context, const int image[3], double distance) {
    Expected *const expected = context;
    const bool back = image[0] < 0 || (image[0] == 0 && (image[1] < 0 || (image[1] == 0 && image[2] <= 0)));
    if (distance < expected->least || (expected->a == expected->b && back)) return;
    const BpBond bond = {expected->a, expected->b, {image[0], image[1], image[2]}};
    expect(expected, &bond);
}

static int compare(const void *a, const void *b) {
    return memcmp(a, b, sizeof(BpBond));
}

/* The bond with its image in edges of the cell, and of the two ways to an image of the same particle the
 * forward one. */
static BpBond in_cell(const Case *test, const BpLattice *lattice, const BpBond *bond) {
    const double nowhere[3] = {0, 0, 0};
    double way[3];
    BpBond out = *bond;
    bp_lattice_way(lattice, nowhere, nowhere, bond->image, way);
    int sign = 0;
    for (int e = 0; e < 3; e++) {
        const double column[3] = {test->inverse[0][e], test->inverse[1][e], test->inverse[2][e]};
        const double share = dot(way, column), whole = floor(share + 0.5);
        assert_true(fabs(share - whole) < 1e-6);
        out.image[e] = (int32_t)whole;
        if (sign == 0) sign = (whole > 0) - (whole < 0);
    }
    for (int e = 0; e < 3 && bond->a == bond->b && sign < 0; e++) out.image[e] = -out.image[e];
    return out;
}

static void check_bonds(const Case *test, size_t *across, size_t *own) {
    BpBonds bonds;
    BpError err;
    Expected expected = {.least = 0.4};
    assert_int_equal(bp_bonds_find(&test->p, test->shown, &bonds, &err), BP_OK);
    assert_false(bonds.crowded);
    for (uint32_t i = 0; i < test->p.count; i++)
        for (uint32_t k = i; k < test->p.count; k++) {
            const uint8_t one = test->tag[i].element, other = test->tag[k].element;
            if (!test->shown[i] || !test->shown[k] || one == 0 || other == 0 || (one == 1 && other == 1))
                continue;
            expected.a = i;
            expected.b = k;
            all_images(test, i, k,
                       (double)bp_elements[one].covalent + (double)bp_elements[other].covalent + 0.4,
                       expect_image, &expected);
        }
    assert_int_equal(bonds.count, expected.count);
    BpBond *const found = calloc(bonds.count + 1, sizeof *found);
    assert_non_null(found);
    for (size_t b = 0; b < bonds.count; b++) {
        found[b] = in_cell(test, &bonds.lattice, &bonds.bond[b]);
        *across += found[b].image[0] != 0 || found[b].image[1] != 0 || found[b].image[2] != 0;
        *own += found[b].a == found[b].b;
    }
    qsort(found, bonds.count, sizeof *found, compare);
    if (expected.count > 0) {
        qsort(expected.bond, expected.count, sizeof *expected.bond, compare);
        assert_memory_equal(found, expected.bond, expected.count * sizeof *found);
    }
    free(found);
    free(expected.bond);
    free(bonds.bond);
}

static void bonds_are_those_of_all_images(void **state) {
    (void)state;
    BpRandom random = {11};
    size_t across = 0, own = 0;
    for (int n = 0; n < CELLS; n++) {
        static Case test;
        make_case(&random, &test);
        check_bonds(&test, &across, &own);
    }
    assert_true(across > 500 && own > 50);
}

/* ---- the distance of neighbours ----------------------------------------------------------------------- */

static void take_least(void *context, const int image[3], double distance) {
    double *const least = context;
    (void)image;
    if (distance > 0 && distance < *least) *least = distance;
}

static int compare_reals(const void *a, const void *b) {
    const double one = *(const double *)a, other = *(const double *)b;
    return one < other ? -1 : one > other;
}

static void spacing_is_that_of_all_images(void **state) {
    (void)state;
    BpRandom random = {12};
    for (int n = 0; n < CELLS; n++) {
        static Case test;
        double nearest[PARTICLES_MAX], spacing, low = INFINITY, high = -INFINITY;
        size_t count = 0;
        BpError err;
        make_case(&random, &test);
        for (size_t i = 0; i < test.p.count; i++) {
            if (!test.shown[i]) continue;
            low = test.position[i][2] < low ? test.position[i][2] : low;
            high = test.position[i][2] > high ? test.position[i][2] : high;
            count++;
        }
        if (low == high && count > 2) { /* two dimensions: edges out of the plane do not count */
            for (int e = 0; e < 3; e++) test.p.periodic[e] &= test.p.cell[e][2] == 0;
            invert_cell(&test);
        }
        count = 0;
        for (size_t i = 0; i < test.p.count; i++) {
            if (!test.shown[i]) continue;
            double least = INFINITY;
            for (double reach = 1; isinf(least) && reach < 1000; reach *= 2)
                for (size_t k = 0; k < test.p.count; k++)
                    if (test.shown[k]) all_images(&test, i, k, reach, take_least, &least);
            nearest[count++] = least;
        }
        qsort(nearest, count, sizeof *nearest, compare_reals);
        const double expected = count > 1 && isfinite(nearest[count / 2]) ? nearest[count / 2] : 0;
        assert_int_equal(bp_particles_spacing(&test.p, test.shown, &spacing, &err), BP_OK);
        assert_true(fabs(spacing - expected) <= 1e-9 * expected);
    }
}

/* Clouds of any extents along each axis, down to numbers whose products are rounded to 0. Along an axis where
 * all particles lie closer than 1e-90, they count as being at one place. */
static void spacing_of_thin_clouds(void **state) {
    (void)state;
    static const double extents[] = {0, 1e-320, 1e-300, 1e-264, 1e-100, 1e-80, 1e-38, 1, 1e12};
    enum { EXTENTS = sizeof extents / sizeof *extents };
    BpRandom random = {15};
    size_t apart = 0;
    for (int n = 0; n < EXTENTS * EXTENTS * EXTENTS; n++) {
        static Case test;
        const double extent[3] = {extents[n % EXTENTS], extents[n / EXTENTS % EXTENTS],
                                  extents[n / EXTENTS / EXTENTS]};
        double nearest[PARTICLES_MAX], spacing;
        bool thin = true;
        BpError err;
        memset(&test, 0, sizeof test);
        test.p.count = 2 + choice(&random, PARTICLES_MAX - 1);
        test.p.position = test.position;
        for (size_t i = 0; i < test.p.count; i++) {
            test.shown[i] = true;
            /* The first two at opposite corners, so that the extents are these. */
            for (int c = 0; c < 3; c++)
                test.position[i][c] = extent[c] * (i < 2 ? (double)i : bp_random_next(&random));
        }
        for (int c = 0; c < 3; c++) thin &= extent[c] < 1e-90;
        for (size_t i = 0; i < test.p.count; i++) {
            nearest[i] = INFINITY;
            for (size_t k = 0; k < test.p.count; k++) {
                const double *const a = test.position[i], *const b = test.position[k];
                const double distance = hypot(hypot(b[0] - a[0], b[1] - a[1]), b[2] - a[2]);
                if (distance > 0 && distance < nearest[i]) nearest[i] = distance;
            }
        }
        qsort(nearest, test.p.count, sizeof *nearest, compare_reals);
        const double expected = thin ? 0 : nearest[test.p.count / 2];
        assert_int_equal(bp_particles_spacing(&test.p, test.shown, &spacing, &err), BP_OK);
        assert_true(fabs(spacing - expected) <= 1e-9 * expected);
        apart += expected > 0;
    }
    assert_true(apart > 500);
}

/* Two points of a hostile PLY file. Along z they lie at one place; the volume of their bounds is 0. */
static void spacing_of_two_points_in_a_plane(void **state) {
    (void)state;
    double position[2][3] = {{9.4e-38, 3.85e-34, 3.9e-264}, {9.1e-41, 5.98e-39, 1.8e-307}}, spacing;
    const bool shown[2] = {true, true};
    const BpParticles p = {.count = 2, .position = position};
    BpError err;
    assert_int_equal(bp_particles_spacing(&p, shown, &spacing, &err), BP_OK);
    assert_true(fabs(spacing - hypot(9.4e-38 - 9.1e-41, 3.85e-34 - 5.98e-39)) < 1e-9 * spacing);
}

/* ---- bonds of the file, and molecules
 * ----------------------------------------------------------------------- */

static void given_bonds_go_to_the_nearest_image(void **state) {
    (void)state;
    BpRandom random = {13};
    for (int n = 0; n < CELLS; n++) {
        static Case test;
        uint32_t pairs[2 * PARTICLES_MAX][2];
        BpBonds bonds;
        BpError err;
        make_case(&random, &test);
        test.p.bonds = pairs;
        for (; test.p.bond_count < 2 * PARTICLES_MAX; test.p.bond_count++)
            for (int side = 0; side < 2; side++)
                pairs[test.p.bond_count][side] = (uint32_t)choice(&random, test.p.count);
        assert_int_equal(bp_bonds_find(&test.p, test.shown, &bonds, &err), BP_OK);
        assert_int_equal(bonds.count, bonds.given);
        for (size_t b = 0; b < bonds.count; b++) {
            const BpBond *const bond = &bonds.bond[b];
            double way[3], least = INFINITY;
            bp_lattice_way(&bonds.lattice, test.position[bond->a], test.position[bond->b], bond->image, way);
            (void)in_cell(&test, &bonds.lattice,
                          bond); /* whole edges, and none of those that do not repeat */
            all_images(&test, bond->a, bond->b, sqrt(dot(way, way)) * (1 + 1e-9), take_least, &least);
            assert_true(fabs(sqrt(dot(way, way)) - least) <= 1e-8 * least);
            for (size_t c = 0; c < b; c++)
                assert_false((bonds.bond[c].a == bond->a && bonds.bond[c].b == bond->b) ||
                             (bonds.bond[c].a == bond->b && bonds.bond[c].b == bond->a));
        }
        /* Every pair that is shown is there. */
        for (size_t g = 0; g < test.p.bond_count; g++) {
            bool there = pairs[g][0] == pairs[g][1] || !test.shown[pairs[g][0]] || !test.shown[pairs[g][1]];
            for (size_t b = 0; b < bonds.count; b++)
                there |= (bonds.bond[b].a == pairs[g][0] && bonds.bond[b].b == pairs[g][1]) ||
                         (bonds.bond[b].a == pairs[g][1] && bonds.bond[b].b == pairs[g][0]);
            assert_true(there);
        }
        free(bonds.bond);
    }
}

/* Chains of carbon atoms that are wrapped into the cell come out in one piece, however thin it is, unless the
 * chain is bonded to its own image. */
static void chains_are_made_whole(void **state) {
    (void)state;
    BpRandom random = {14};
    size_t whole = 0, endless = 0;
    for (int n = 0; n < CELLS; n++) {
        static Case test;
        double before[PARTICLES_MAX][3], way[3];
        BpBonds bonds;
        BpError err;
        size_t moved = 0;
        make_case(&random, &test);
        for (size_t i = 0; i < test.p.count; i++) {
            test.shown[i] = true;
            test.tag[i].element = 6;
            for (int c = 0; c < 3; c++)
                test.position[i][c] =
                    i == 0 ? test.p.cell_origin[c] : test.position[i - 1][c] + uniform(&random, -0.2, 1);
        }
        for (size_t i = 0; i < test.p.count; i++)
            for (int e = 0; e < 3; e++) {
                const double move = (double)choice(&random, 5) - 2;
                for (int c = 0; c < 3 && test.p.periodic[e]; c++)
                    test.position[i][c] += move * test.p.cell[e][c];
            }
        memcpy(before, test.position, sizeof before);
        assert_int_equal(bp_bonds_find(&test.p, test.shown, &bonds, &err), BP_OK);
        assert_int_equal(bp_molecules_make_whole(&test.p, test.shown, &bonds, &moved, &err), BP_OK);
        size_t across = 0, differ = 0;
        for (size_t b = 0; b < bonds.count; b++) {
            bp_lattice_way(&bonds.lattice, test.position[bonds.bond[b].a], test.position[bonds.bond[b].b],
                           bonds.bond[b].image, way);
            assert_true(sqrt(dot(way, way)) <=
                        2 * (double)bp_elements[6].covalent + 0.4 + 1e-9); /* still a bond */
            across +=
                bonds.bond[b].image[0] != 0 || bonds.bond[b].image[1] != 0 || bonds.bond[b].image[2] != 0;
        }
        for (size_t i = 0; i < test.p.count; i++)
            differ += memcmp(before[i], test.position[i], sizeof before[i]) != 0;
        assert_int_equal(differ, moved);
        if (moved > 0) whole++;
        if (moved == 0 && across > 0) endless++;
        free(bonds.bond);
    }
    assert_true(whole > 50 && endless > 50);
}

/* A chain whose first atom is bonded to the last one's image stays; beside it, a molecule is made whole. */
static void endless_chains_stay(void **state) {
    (void)state;
    double position[6][3] = {{0.7, 1, 1}, {2.1, 1, 1}, {3.5, 1, 1}, {0.1, 4, 4}, {3.4, 4, 4}, {0.4, 4.9, 4}};
    BpParticleTag tag[6] = {{.element = 6}, {.element = 6}, {.element = 6},
                            {.element = 8}, {.element = 1}, {.element = 1}};
    const bool shown[6] = {true, true, true, true, true, true};
    BpParticles p = {.count = 6,
                     .position = position,
                     .tag = tag,
                     .angstrom = 1,
                     .has_element = true,
                     .has_cell = true,
                     .periodic = {true, true, true},
                     .cell = {{4.2, 0, 0}, {0, 9, 0}, {0, 0, 9}}};
    BpBonds bonds;
    BpError err;
    size_t moved = 0;
    assert_int_equal(bp_bonds_find(&p, shown, &bonds, &err), BP_OK);
    assert_int_equal(bonds.count, 3 + 2);
    assert_int_equal(bp_molecules_make_whole(&p, shown, &bonds, &moved, &err), BP_OK);
    assert_int_equal(moved, 1);
    assert_true(position[0][0] == 0.7 && position[1][0] == 2.1 && position[2][0] == 3.5);
    assert_true(fabs(position[4][0] + 0.8) < 1e-12);
    free(bonds.bond);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(bonds_are_those_of_all_images),
                                       cmocka_unit_test(spacing_is_that_of_all_images),
                                       cmocka_unit_test(spacing_of_thin_clouds),
                                       cmocka_unit_test(spacing_of_two_points_in_a_plane),
                                       cmocka_unit_test(given_bonds_go_to_the_nearest_image),
                                       cmocka_unit_test(chains_are_made_whole),
                                       cmocka_unit_test(endless_chains_stay)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
