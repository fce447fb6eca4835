/* test_lamp_tree.c: the balls of the tree of lamps are around their lamps, all of the time; what stands for
 * triangles. */
#define BP_HOST
#include "base/random.h"
#include "base/status.h"
#include "packed/pack.h"
#include "packed/reals.h"
#include "scene_types.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#define LAMPS 100

static double lamp_number(const BpPacked *packed, uint32_t node, uint32_t row, uint32_t child) {
    return bp_reals_load(packed->lamps.lamps, packed->single_precision,
                         (size_t)node * LAMP_NODE_REALS + row * LAMP_WIDTH + child);
}

/* How many lamps stand below a node; all stay in the ball (centre, radius) from when the shutter opens to
 * when it closes. */
static int lamps_in_ball(const BpPacked *packed, uint32_t node, const double ball[4]) {
    const BpTree *tree = &packed->tree;
    int count = 0;
    for (uint32_t child = 0; child < LAMP_WIDTH && lamp_number(packed, node, 4, child) > 0; ++child) {
        const uint32_t word = packed->lamps.lamp_children[(size_t)node * LAMP_WIDTH + child];
        if ((word & CHILD_LEAF) == 0) {
            count += lamps_in_ball(packed, word, ball);
            continue;
        }
        const uint32_t slot = word & ~CHILD_LEAF, lane = slot % tree->width;
        for (int half = 0; half <= 2; ++half) {
            double squares = 0;
            for (uint32_t a = 0; a < 3; ++a) {
                const double motion = bp_reals_load(tree->leaf_motions, packed->single_precision,
                                                    (size_t)(slot - lane) * 3 + a * tree->width + lane);
                const double away = lamp_number(packed, node, a, child) + 0.5 * half * motion - ball[a];
                squares += away * away;
            }
            assert_true(sqrt(squares) + lamp_number(packed, node, 3, child) <= ball[3] * (1 + 1e-6));
        }
        ++count;
    }
    return count;
}

static void balls_hold_lamps_that_move(void **state) {
    (void)state;
    static BpSphere spheres[LAMPS];
    static double ends[LAMPS][3];
    BpMaterial lamp = {.name = (char *)"lamp", .kind = BP_MATERIAL_DIFFUSE_LIGHT, .emit = {1, 1, 1}};
    BpRandom random = {7};
    for (int i = 0; i < LAMPS; ++i) {
        spheres[i] = (BpSphere){.radius = 0.1, .albedo = BP_NO_ALBEDO};
        for (int a = 0; a < 3; ++a) {
            spheres[i].center[a] = 10 * bp_random_next(&random);
            ends[i][a] = spheres[i].center[a] + (i % 3 == 0 ? 0 : i % 3 * bp_random_next(&random));
        }
    }
    BpScene scene = {.materials = &lamp,
                     .material_count = 1,
                     .spheres = spheres,
                     .sphere_count = LAMPS,
                     .center_ends = ends,
                     .moving_count = LAMPS};
    scene.camera = (BpCamera){.width = 4,
                              .height = 4,
                              .aspect_ratio = 1,
                              .vfov_degrees = 90,
                              .lookat = {0, 0, -1},
                              .vup = {0, 1, 0},
                              .focus_dist = 10};
    for (int single = 0; single < 2; ++single) {
        const BpTreeOptions options = {.width = 8, .single_precision = single, .threads = 1};
        const double everywhere[] = {0, 0, 0, 1000};
        BpPacked packed;
        BpError err = {0};
        assert_int_equal(bp_scene_pack(&scene, &options, true, true, &packed, &err), BP_OK);
        assert_int_equal(lamps_in_ball(&packed, 0, everywhere), LAMPS);
        int balls = 0;
        for (uint32_t node = 0; node < packed.lamps.node_count; ++node)
            for (uint32_t child = 0; child < LAMP_WIDTH; ++child) {
                const uint32_t word = packed.lamps.lamp_children[(size_t)node * LAMP_WIDTH + child];
                double ball[4];
                for (uint32_t row = 0; row < 4; ++row) ball[row] = lamp_number(&packed, node, row, child);
                if (lamp_number(&packed, node, 4, child) <= 0 || (word & CHILD_LEAF) != 0) continue;
                assert_true(ball[3] < 0);
                ball[3] = -ball[3];
                assert_true(lamps_in_ball(&packed, word, ball) >= 2);
                ++balls;
            }
        assert_true(balls >= 8);
        bp_packed_clear(&packed);
    }
}

/* A lamp around everything is no lamp that rays are sent to, but paths hit it: so its slot says that. */
static void slots_of_a_lamp_around_everything(void **state) {
    (void)state;
    BpSphere spheres[20];
    BpMaterial lamp = {.name = (char *)"lamp", .kind = BP_MATERIAL_LAMBERTIAN, .emit = {1, 1, 1}};
    BpMaterial materials[] = {lamp, {.name = (char *)"matte", .kind = BP_MATERIAL_LAMBERTIAN}};
    for (uint32_t i = 0; i < 20; ++i)
        spheres[i] = (BpSphere){.center = {0.1 * i, 0, 0},
                                .radius = i == 0 ? 10 : 0.01,
                                .material = i > 0,
                                .albedo = BP_NO_ALBEDO};
    BpScene scene = {.materials = materials, .material_count = 2, .spheres = spheres, .sphere_count = 20};
    scene.camera = (BpCamera){.width = 4,
                              .height = 4,
                              .aspect_ratio = 1,
                              .vfov_degrees = 90,
                              .lookfrom = {0, 0, 20},
                              .vup = {0, 1, 0},
                              .focus_dist = 10};
    const BpTreeOptions options = {.width = 8, .single_precision = true, .threads = 1};
    BpPacked packed;
    BpError err = {0};
    assert_int_equal(bp_scene_pack(&scene, &options, true, true, &packed, &err), BP_OK);
    assert_int_equal(packed.lamps.lamp_count, 0);
    assert_int_equal(packed.lamps.slot_count, packed.tree.leaf_count * packed.tree.width);
    for (uint32_t slot = 0; slot < packed.lamps.slot_count; ++slot)
        assert_int_equal(packed.lamps.slot_lamp[slot], NO_LAMP);
    bp_packed_clear(&packed);
}

/* Of triangles that emit: the ball around the corners' middle, luminance times area over pi; no power, no
 * lamp. */
static void triangles_that_emit(void **state) {
    (void)state;
    BpMaterial materials[] = {{.name = (char *)"lamp", .kind = BP_MATERIAL_DIFFUSE_LIGHT, .emit = {3, 3, 3}},
                              {.name = (char *)"matte", .kind = BP_MATERIAL_LAMBERTIAN}};
    BpTriangle triangles[] = {{.vertices = {{0, 0, -9}, {3, 0, -9}, {0, 6, -9}}},
                              {.vertices = {{0, 0, -7}, {3, 0, -7}, {0, 6, -7}}, .material = 1},
                              {.vertices = {{1e-25, 0, 0}, {2e-25, 0, 0}, {0, 1e-25, 0}}}};
    for (size_t t = 0; t < 3; ++t) triangles[t].albedo = BP_NO_ALBEDO;
    BpScene scene = {
        .materials = materials, .material_count = 2, .triangles = triangles, .triangle_count = 3};
    scene.camera = (BpCamera){.width = 4,
                              .height = 4,
                              .aspect_ratio = 1,
                              .vfov_degrees = 90,
                              .lookat = {0, 0, -1},
                              .vup = {0, 1, 0},
                              .focus_dist = 10};
    const BpTreeOptions options = {.width = 8, .single_precision = true, .threads = 1};
    BpPacked packed;
    BpError err = {0};
    assert_int_equal(bp_scene_pack(&scene, &options, true, true, &packed, &err), BP_OK);
    assert_int_equal(packed.lamps.lamp_count, 1);
    const uint32_t slot = packed.lamps.lamp_children[0] & ~CHILD_LEAF;
    assert_int_equal(packed.tree.slot_sphere[slot], 0);
    for (uint32_t s = 0; s < packed.lamps.slot_count; ++s)
        assert_int_equal(packed.lamps.slot_lamp[s], s == slot ? 0 : NO_LAMP);
    const double expected[5] = {1, 2, -9, -sqrt(1 + 16), 9 / 3.14159265358979323846};
    for (uint32_t row = 0; row < 5; ++row)
        assert_true(fabs(lamp_number(&packed, 0, row, 0) - expected[row]) < 1e-6);
    assert_true(lamp_number(&packed, 0, 4, 1) == 0);
    bp_packed_clear(&packed);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(balls_hold_lamps_that_move),
                                       cmocka_unit_test(slots_of_a_lamp_around_everything),
                                       cmocka_unit_test(triangles_that_emit)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
