/* test_grid.c: neighbours found by the grid, beside all pairs; lattices that are oblique and repeat, in part,
 * or not.
 *
 * Knows: the lists of the grid, shares and ways.   Does not know: bonds, files. */
#include "particles/grid.h"
#include "support/unit_test.h"

#include "base/random.h"

#include <stdlib.h>
#include <string.h>

enum { COUNT = 300 };

/* The square of the shortest way among the images of b in the cells around. */
static double shortest(const BpParticles *p, const double a[3], const double b[3]) {
    double least = INFINITY;
    int reach[3];
    for (int e = 0; e < 3; e++) reach[e] = p->periodic[e] ? 2 : 0;
    for (int x = -reach[0]; x <= reach[0]; x++)
        for (int y = -reach[1]; y <= reach[1]; y++)
            for (int z = -reach[2]; z <= reach[2]; z++) {
                double square = 0;
                for (int c = 0; c < 3; c++) {
                    const double d = b[c] - a[c] + x * p->cell[0][c] + y * p->cell[1][c] + z * p->cell[2][c];
                    square += d * d;
                }
                if (square < least) least = square; /* GCC 12 for ARM cannot compile fmin() here */
            }
    return least;
}

/* Every pair nearer than `reach`, by the grid as by all pairs; particles that are not shown are in no list.
 */
static void check_pairs(const BpParticles *p, const bool *shown, double reach) {
    static bool near[COUNT][COUNT];
    BpParticleGrid grid;
    BpError err;
    size_t found = 0;
    memset(near, 0, sizeof near);
    assert_int_equal(bp_particle_grid_init(&grid, p, shown, reach, &err), BP_OK);
    for (uint32_t i = 0; i < COUNT; i++) {
        BpGridWalk walk;
        bool own = false;
        bp_particle_grid_begin(&grid, p->position[i], &walk);
        while (bp_particle_grid_next(&walk)) {
            own |= walk.cell == bp_particle_grid_cell(&grid, p->position[i]);
            uint32_t before = 0;
            for (uint32_t k = grid.first[walk.cell]; k != BP_NO_PARTICLE; k = grid.next[k]) {
                const int32_t nowhere[3] = {0, 0, 0};
                double d[3];
                int32_t image[3];
                assert_true(shown[k] && k >= before);
                before = k + 1;
                bp_particle_grid_image(&walk, grid.whole != NULL ? grid.whole[k] : nowhere, image);
                bp_lattice_way(&grid.lattice, p->position[i], p->position[k], image, d);
                const double square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
                if (square >= reach * reach) continue;
                assert_false(near[i][k]);
                near[i][k] = true;
                found++;
            }
        }
        assert_true(own);
    }
    for (uint32_t i = 0; i < COUNT; i++)
        for (uint32_t k = 0; k < COUNT; k++)
            assert_int_equal(near[i][k],
                             shown[k] && shortest(p, p->position[i], p->position[k]) < reach * reach);
    assert_true(found > COUNT); /* not each with itself alone */
    bp_particle_grid_clear(&grid);
}

static void pairs_are_found(void **state) {
    (void)state;
    static const double cells[][3][3] = {{{10, 0, 0}, {0, 8, 0}, {0, 0, 9}},
                                         {{10, 0, 0}, {3, 8, 0}, {-2, 1, 9}},
                                         {{9, 1, -1}, {-1, 10, 2}, {2, 0, 30}}};
    static double position[COUNT][3];
    static bool shown[COUNT];
    BpRandom random = {5};
    for (size_t cell = 0; cell < sizeof cells / sizeof *cells; cell++)
        for (int edges = 0; edges < 8; edges++) { /* which of them repeat */
            BpParticles p = {.count = COUNT,
                             .position = position,
                             .has_cell = true,
                             .periodic = {(edges & 1) != 0, (edges & 2) != 0, (edges & 4) != 0}};
            memcpy(p.cell, cells[cell], sizeof p.cell);
            for (int c = 0; c < 3; c++) p.cell_origin[c] = 5 * bp_random_next(&random) - 20;
            for (size_t i = 0; i < COUNT; i++) {
                shown[i] = bp_random_next(&random) < 0.9;
                memcpy(position[i], p.cell_origin, sizeof position[i]);
                for (int e = 0; e < 3; e++) {
                    const double share = 1.2 * bp_random_next(&random) - 0.1; /* some outside of the cell */
                    for (int c = 0; c < 3; c++) position[i][c] += share * p.cell[e][c];
                }
            }
            check_pairs(&p, shown, 1.1);
            check_pairs(&p, shown, 2.9);
        }
}

/* However thin a cloud is, its grid has a lattice, and every particle a cell that is found from its place. */
static void thin_clouds_have_a_grid(void **state) {
    (void)state;
    static const double extents[] = {0, 1e-320, 1e-264, 1e-100, 1e-60, 1, 1e12};
    enum { EXTENTS = sizeof extents / sizeof *extents };
    for (int n = 0; n < EXTENTS * EXTENTS * EXTENTS * EXTENTS; n++) {
        const double extent[3] = {extents[n % EXTENTS], extents[n / EXTENTS % EXTENTS],
                                  extents[n / (EXTENTS * EXTENTS) % EXTENTS]};
        const double reach = extents[n / (EXTENTS * EXTENTS * EXTENTS)];
        double position[2][3] = {{0}, {extent[0], extent[1], extent[2]}};
        const bool shown[2] = {true, true};
        const BpParticles p = {.count = 2, .position = position};
        BpParticleGrid grid;
        BpError err;
        if (reach == 0) continue;
        assert_int_equal(bp_particle_grid_init(&grid, &p, shown, reach, &err), BP_OK);
        for (int e = 0; e < 3; e++) {
            assert_true(isfinite(bp_lattice_height(&grid.lattice, e)));
            assert_true(bp_lattice_height(&grid.lattice, e) >= extent[e] * (1 - 1e-9));
            assert_true(grid.sides[e] >= 1 && grid.steps[e] >= 1);
        }
        for (int i = 0; i < 2; i++) {
            BpGridWalk walk;
            bool own = false;
            bp_particle_grid_begin(&grid, position[i], &walk);
            while (bp_particle_grid_next(&walk))
                own |= walk.cell == bp_particle_grid_cell(&grid, position[i]);
            assert_true(own);
        }
        bp_particle_grid_clear(&grid);
    }
}

static void bounds_are_of_those_shown(void **state) {
    (void)state;
    enum { MANY = 3 * 16384 + 5 };
    BpParticles p = {.count = MANY, .position = calloc(MANY, sizeof *p.position)};
    bool *shown = calloc(MANY, sizeof *shown);
    BpParticleBounds bounds;
    BpError err;
    BpRandom random = {9};
    assert_true(p.position != NULL && shown != NULL);
    assert_int_equal(bp_particle_bounds(&p, shown, &bounds, &err), BP_OK);
    assert_int_equal(bounds.count, 0);
    for (size_t i = 0; i < MANY; i++) {
        shown[i] = i % 3 != 0;
        for (int c = 0; c < 3; c++) p.position[i][c] = bp_random_next(&random);
    }
    p.position[MANY - 1][0] = -7; /* the last one, in a block of its own */
    p.position[16384][1] = 8;     /* the first of a block */
    p.position[3][2] = 100;       /* not shown */
    assert_true(shown[MANY - 1] && shown[16384] && !shown[3]);
    assert_int_equal(bp_particle_bounds(&p, shown, &bounds, &err), BP_OK);
    assert_int_equal(bounds.count, MANY - (MANY + 2) / 3);
    assert_true(bounds.low[0] == -7 && bounds.high[1] == 8 && bounds.high[2] < 1);
    free(p.position);
    free(shown);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(pairs_are_found),
                                       cmocka_unit_test(thin_clouds_have_a_grid),
                                       cmocka_unit_test(bounds_are_of_those_shown)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
