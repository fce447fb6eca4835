/* test_crystals.c: where the atoms of crystals are, as worked out from their Wyckoff positions: small files,
 * one for each fault that would be silent. test_crystal_files.py has many more, beside other readers. */
#include "particles/particles.h"
#include "support/unit_test.h"

#include <math.h>
#include <string.h>

#define CUBE                                                                                                 \
    "_cell_length_a 5\n_cell_length_b 6\n_cell_length_c 7\n_cell_angle_alpha 90\n_cell_angle_beta 90\n"      \
    "_cell_angle_gamma 90\n"
#define HEXAGONAL                                                                                            \
    "_cell_length_a 6\n_cell_length_b 6\n_cell_length_c 7\n_cell_angle_alpha 90\n_cell_angle_beta 90\n"      \
    "_cell_angle_gamma 120\n"
#define SITES                                                                                                \
    "loop_\n_atom_site_label\n_atom_site_type_symbol\n_atom_site_fract_x\n_atom_site_fract_y\n"              \
    "_atom_site_fract_z\n_atom_site_occupancy\n_atom_site_disorder_group\n"
#define OPERATIONS "loop_\n_symmetry_equiv_pos_as_xyz\n"
#define POSCAR_EDGES "2 0 0\n0.5 2.5 0\n0 0 3\nNa\n1\n"

/* The first frame of a file of that text. */
static void read_text(const char *text, BpParticleFormat format, BpParticles *particles) {
    FILE *const stream = tmpfile();
    BpParticleFile *file = NULL;
    BpError err = {0};
    bool end = false;
    assert_non_null(stream);
    assert_int_equal(fwrite(text, 1, strlen(text), stream), strlen(text));
    assert_int_equal(fflush(stream), 0);
    *particles = (BpParticles){0};
    assert_int_equal(bp_particle_file_open(stream, "a", format, NULL, 0, 0, &file, &err), BP_OK);
    const BpStatus status = bp_particle_file_next(file, particles, &end, &err);
    if (status != BP_OK) fail_msg("%s", err.message);
    bp_particle_file_close(&file);
    fclose(stream);
}

/* Exactly these places, in this order. */
static void expect_places(const char *text, BpParticleFormat format, size_t count, const double places[][3]) {
    BpParticles particles;
    read_text(text, format, &particles);
    assert_int_equal(particles.count, count);
    for (size_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++) assert_true(fabs(particles.position[i][k] - places[i][k]) < 3e-4);
    bp_particles_clear(&particles);
}

/* How many atoms are there, and how many of these stand in place of others. */
static void expect_counts(const char *text, size_t count, size_t hidden) {
    BpParticles particles;
    size_t found = 0;
    read_text(text, BP_PARTICLES_CRYSTAL, &particles);
    for (size_t i = 0; i < particles.count; i++)
        found += (particles.tag[i].flags & BP_PARTICLE_ALTERNATIVE) != 0;
    assert_int_equal(particles.count, count);
    assert_int_equal(found, hidden);
    bp_particles_clear(&particles);
}

static void operations_repeat_sites(void **state) {
    (void)state;
    expect_places("data_x\n" CUBE OPERATIONS "x,y,z\n1/2-x,-y,z+1/2\n" SITES "C1 C 0.1 0.2 0.3 1 .\n",
                  BP_PARTICLES_CRYSTAL, 2, (const double[][3]){{0.5, 1.2, 2.1}, {2, 4.8, 5.6}});
    expect_places("data_x\n" CUBE OPERATIONS "x,y,z\nx-y,x,z\n" SITES "C1 C 0.3 0.1 0 1 .\n",
                  BP_PARTICLES_CRYSTAL, 2, (const double[][3]){{1.5, 0.6, 0}, {1, 1.8, 0}});
}

static void thirds_are_thirds(void **state) {
    (void)state;
    expect_places("data_x\n" CUBE OPERATIONS "x,y,z\nx,y,z+1/3\nx,y,z+0.667\n" SITES "C1 C 0 0 0 1 .\n",
                  BP_PARTICLES_CRYSTAL, 3, (const double[][3]){{0, 0, 0}, {0, 0, 7.0 / 3}, {0, 0, 14.0 / 3}});
    /* 0.6666 and a third are the origin. */
    expect_places("data_x\n" CUBE OPERATIONS "x,y,z\nx,y,z+1/3\n" SITES "C1 C 0 0 0.6666 1 .\n",
                  BP_PARTICLES_CRYSTAL, 2, (const double[][3]){{0, 0, 4.6662}, {0, 0, -0.00047}});
}

static void special_places_are_one_atom(void **state) {
    (void)state;
    expect_counts("data_x\n" HEXAGONAL OPERATIONS "x,y,z\n-y,x-y,z\n-x+y,-x,z\n" SITES
                  "C1 C 0.333 0.667 0 1 .\n",
                  1, 0);
    expect_counts("data_x\n" HEXAGONAL OPERATIONS "x,y,z\n-y,x-y,z\n-x+y,-x,z\n" SITES "C1 C 0.4 0.6 0 1 .\n",
                  3, 0);
    expect_counts("data_x\n" CUBE OPERATIONS "x,y,z\n-x,y,z\n" SITES "C1 C 0.99 0 0 1 .\n", 1, 0);
}

static void cells_lie_along_x(void **state) {
    (void)state;
    expect_places("data_x\n" HEXAGONAL OPERATIONS "x,y,z\n" SITES "C1 C 0.5 0.5 0.5 1 .\n",
                  BP_PARTICLES_CRYSTAL, 1, (const double[][3]){{1.5, 2.598076, 3.5}});
}

static void disorder_hides(void **state) {
    (void)state;
    expect_counts("data_x\n" CUBE OPERATIONS "x,y,z\n" SITES "Fe1 Fe 0 0 0 0.4 .\nNi1 Ni 0 0 0 0.6 .\n", 2,
                  1);
    expect_counts("data_x\n" CUBE OPERATIONS "x,y,z\n" SITES "O1 O 0 0 0 0.5 .\nO2 O 0.12 0 0 0.5 .\n", 2, 1);
    expect_counts("data_x\n" CUBE OPERATIONS "x,y,z\n" SITES "O1 O 0 0 0 1 .\nO2 O 0.12 0 0 1 .\n", 2, 0);
    expect_counts("data_x\n" CUBE OPERATIONS "x,y,z\n" SITES
                  "O1 O 0 0 0 0.4 1\nO2 O 0.5 0 0 0.6 2\nO3 O 0 0.5 0 0.4 1\n",
                  3, 2);
    expect_counts("data_x\n" CUBE OPERATIONS "x,y,z\n-x,y,z\n" SITES "C1 C 0.13 0 0 0.5 -1\n", 2, 1);
    expect_counts("data_x\n" CUBE OPERATIONS "x,y,z\n-x,y,z\n" SITES "C1 C 0.13 0 0 0.5 .\n", 2, 0);
}

static void scales_of_vasp(void **state) {
    (void)state;
    expect_places("a\n2\n" POSCAR_EDGES "Direct\n0.5 0.5 0.5\n", BP_PARTICLES_POSCAR, 1,
                  (const double[][3]){{2.5, 2.5, 3}});
    expect_places("a\n-120\n" POSCAR_EDGES "Direct\n0.5 0.5 0.5\n", BP_PARTICLES_POSCAR, 1,
                  (const double[][3]){{2.5, 2.5, 3}});
    expect_places("a\n1 2 3\n" POSCAR_EDGES "Direct\n0.5 0.5 0.5\n", BP_PARTICLES_POSCAR, 1,
                  (const double[][3]){{1.25, 2.5, 4.5}});
    expect_places("a\n2\n" POSCAR_EDGES "S\nKart\n0.5 0.25 -1 T T F\n", BP_PARTICLES_POSCAR, 1,
                  (const double[][3]){{1, 0.5, -2}});
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(operations_repeat_sites),
                                       cmocka_unit_test(thirds_are_thirds),
                                       cmocka_unit_test(special_places_are_one_atom),
                                       cmocka_unit_test(cells_lie_along_x),
                                       cmocka_unit_test(disorder_hides),
                                       cmocka_unit_test(scales_of_vasp)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
