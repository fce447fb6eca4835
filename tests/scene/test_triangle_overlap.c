/* test_triangle_overlap.c: the one triangle among thousands that lies on another is found, wherever it is,
 * and triangles that only meet are no overlap. */
#include "scene/triangle_overlap.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 40, SHEETS = 3, COUNT = SHEETS * SIDE * SIDE * 2 };

typedef struct Field {
    BpTriangle triangles[COUNT + 1];
    bool marks[COUNT + 1];
} Field;

static uint64_t state_of_chance = 1;

static size_t chance(size_t below) {
    state_of_chance = state_of_chance * 6364136223846793005u + 1442695040888963407u;
    return (size_t)(state_of_chance >> 33) % below;
}

/* On a sheet that bends, lies in a plane, or stands upright. Eighths and their products are exact. */
static void place(int sheet, double u, double v, double at[3]) {
    const double flat[3] = {u, 0, v}, upright[3] = {u, v, 100},
                 bent[3] = {u, 40 + u * u / 64 + v * v / 32, v};
    memcpy(at, sheet == 0 ? flat : sheet == 1 ? upright : bent, sizeof flat);
}

static Field *make_field(void) {
    Field *const field = calloc(1, sizeof *field);
    size_t count = 0;
    for (int sheet = 0; sheet < SHEETS; sheet++)
        for (int i = 0; i < SIDE; i++)
            for (int j = 0; j < SIDE; j++)
                for (int half = 0; half < 2; half++) {
                    BpTriangle *t = &field->triangles[count++];
                    place(sheet, i, j, t->vertices[0]);
                    place(sheet, i + (half == 0), j + 1, t->vertices[1]);
                    place(sheet, i + 1, j + (half == 1), t->vertices[2]);
                }
    return field;
}

static void sheets_do_not_overlap(void **state) {
    (void)state;
    Field *const field = make_field();
    BpOverlap overlap;
    memset(field->marks, true, sizeof field->marks);
    assert_int_equal(bp_find_overlap(field->triangles, field->marks, COUNT, &overlap, NULL), BP_OK);
    assert_false(overlap.found);
    free(field);
}

/* A small triangle in the middle of another, in its plane, or a copy of it, or one that is a little off. */
static void one_is_found(void **state) {
    (void)state;
    Field *const field = make_field();
    for (int trial = 0; trial < 120; trial++) {
        const size_t below = chance(COUNT);
        const BpTriangle *under = &field->triangles[below];
        const double shares[3][3] = {{0.5, 0.25, 0.25}, {0.25, 0.5, 0.25}, {0.25, 0.25, 0.5}};
        BpTriangle *const above = &field->triangles[COUNT];
        *above = *under;
        for (int k = 0; k < 3 && trial % 3 != 0; k++)
            for (int a = 0; a < 3; a++)
                above->vertices[k][a] = shares[k][0] * under->vertices[0][a] +
                                        shares[k][1] * under->vertices[1][a] +
                                        shares[k][2] * under->vertices[2][a];
        if (trial % 3 == 2) /* not in the plane */
            for (int k = 0; k < 3; k++)
                for (int a = 0; a < 3; a++) above->vertices[k][a] += 1e-6;
        memset(field->marks, false, sizeof field->marks);
        field->marks[trial % 2 == 0 ? below : COUNT] = true;
        BpOverlap overlap;
        assert_int_equal(bp_find_overlap(field->triangles, field->marks, COUNT + 1, &overlap, NULL), BP_OK);
        assert_int_equal(overlap.found, trial % 3 != 2);
        if (!overlap.found) continue;
        assert_int_equal(overlap.one, below);
        assert_int_equal(overlap.other, COUNT);
        /* Nothing that matters has part in it. */
        memset(field->marks, false, sizeof field->marks);
        field->marks[(below + COUNT / 2) % COUNT] = true;
        assert_int_equal(bp_find_overlap(field->triangles, field->marks, COUNT + 1, &overlap, NULL), BP_OK);
        assert_false(overlap.found);
    }
    free(field);
}

/* A fan, of which every triangle meets every other, and which no halving takes apart. */
static void a_fan(void **state) {
    (void)state;
    enum { BLADES = 500 };
    BpTriangle fan[BLADES + 1];
    bool marks[BLADES + 1];
    memset(fan, 0, sizeof fan);
    memset(marks, true, sizeof marks);
    for (int i = 0; i < BLADES; i++)
        for (int k = 1; k < 3; k++) {
            const double angle = (i + k) * 6.283185307179586 / BLADES;
            fan[i].vertices[k][0] = cos(angle);
            fan[i].vertices[k][1] = sin(angle);
        }
    BpOverlap overlap;
    assert_int_equal(bp_find_overlap(fan, marks, BLADES, &overlap, NULL), BP_OK);
    assert_false(overlap.found);
    fan[BLADES] = fan[77];
    fan[BLADES].vertices[2][0] = fan[80].vertices[2][0];
    fan[BLADES].vertices[2][1] = fan[80].vertices[2][1];
    assert_int_equal(bp_find_overlap(fan, marks, BLADES + 1, &overlap, NULL), BP_OK);
    assert_true(overlap.found);
    assert_int_equal(overlap.other, BLADES);
    assert_in_range(overlap.one, 77, 80);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sheets_do_not_overlap),
        cmocka_unit_test(one_is_found),
        cmocka_unit_test(a_fan),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
