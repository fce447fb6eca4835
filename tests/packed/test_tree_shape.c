/* test_tree_shape.c: what every tree must be, over many scenes, widths and both precisions.
 *
 * The size at which threads have grids of their own takes long, so that case runs only where it is asked for
 * by name (support/one_case.c). */
#define BP_HOST
#include "base/status.h"
#include "packed/reals.h"
#include "packed/tree.h"
#include "packed/tree_write.h"
#include "scene_types.h"
#include "support/tree_scenes.h"

#include <float.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

typedef struct Check {
    const BpScene *scene;
    const double *origin;
    const BpTree *tree;
    uint8_t *leaf_seen, *node_seen;
    uint32_t deepest;
} Check;

static long double box_value(const Check *check, uint32_t node, uint32_t row, uint32_t lane) {
    const uint32_t width = check->tree->width;
    return bp_reals_load(check->tree->node_boxes, check->tree->single_precision,
                         (size_t)node * NODE_REALS(width) + row * width + lane);
}

/* Asserts that lane `lane` of `node` contains the sphere in `slot`, exact and as stored. */
static void assert_contains(const Check *check, uint32_t node, uint32_t lane, size_t slot) {
    const BpTree *tree = check->tree;
    const uint32_t width = tree->width;
    const BpSphere *sphere = &check->scene->spheres[tree->slot_sphere[slot]];
    const size_t leaf = slot / width, leaf_lane = slot % width;
    const size_t base = leaf * LEAF_REALS(width) + leaf_lane;
    const long double r_stored = bp_reals_load(tree->leaves, tree->single_precision, base + 3 * width);
    const long double r = fabsl((long double)sphere->radius);
    for (uint32_t a = 0; a < 3; ++a) {
        const long double c = (long double)sphere->center[a] - (long double)check->origin[a];
        const long double c_stored = bp_reals_load(tree->leaves, tree->single_precision, base + a * width);
        const long double low = box_value(check, node, a, lane), high = box_value(check, node, 3 + a, lane);
        assert_true(low <= c - r && c + r <= high);
        assert_true(low <= c_stored - r_stored && c_stored + r_stored <= high);
    }
}

/* Walks everything below `word`; asserts that it lies in the boxes of all `path_count` ancestors. */
static void walk(Check *check, uint32_t word, uint32_t path_count, uint32_t *path_nodes,
                 uint32_t *path_lanes) {
    const BpTree *tree = check->tree;
    if (word & CHILD_LEAF) {
        const uint32_t leaf = word & ~CHILD_LEAF;
        assert_true(leaf >= tree->first_leaves && leaf < tree->leaf_count);
        assert_int_equal(check->leaf_seen[leaf]++, 0);
        for (uint32_t lane = 0; lane < tree->width; ++lane) {
            const size_t slot = (size_t)leaf * tree->width + lane;
            if (tree->slot_sphere[slot] == NO_SPHERE) continue;
            for (uint32_t p = 0; p < path_count; ++p)
                assert_contains(check, path_nodes[p], path_lanes[p], slot);
        }
        return;
    }
    assert_true(word < tree->node_count);
    assert_int_equal(check->node_seen[word]++, 0);
    assert_true(path_count < TREE_DEPTH_MAX);
    if (path_count + 1 > check->deepest) check->deepest = path_count + 1;
    for (uint32_t lane = 0; lane < tree->width; ++lane) {
        bool empty = false;
        for (uint32_t a = 0; a < 3; ++a) {
            const long double low = box_value(check, word, a, lane),
                              high = box_value(check, word, 3 + a, lane);
            assert_true(fabsl(low) <= 3e30L && fabsl(high) <= 3e30L);
            empty = empty || low > high;
        }
        const uint32_t child = tree->children[(size_t)word * tree->width + lane];
        if (empty) {
            for (uint32_t a = 0; a < 3; ++a)
                assert_true(box_value(check, word, a, lane) > box_value(check, word, 3 + a, lane));
            assert_true(child & CHILD_LEAF);
            continue;
        }
        path_nodes[path_count] = word;
        path_lanes[path_count] = lane;
        walk(check, child, path_count + 1, path_nodes, path_lanes);
    }
}

static void check_slots(const BpScene *scene, const double origin[3], const BpTree *tree) {
    uint8_t *seen = calloc(scene->sphere_count + 1, 1);
    for (size_t slot = 0; slot < (size_t)tree->leaf_count * tree->width; ++slot) {
        const size_t base = slot / tree->width * LEAF_REALS(tree->width) + slot % tree->width;
        const uint32_t index = tree->slot_sphere[slot];
        const double radius = bp_reals_load(tree->leaves, tree->single_precision, base + 3 * tree->width);
        if (index == NO_SPHERE) {
            assert_true(radius == -1);
            continue;
        }
        assert_true(index < scene->sphere_count);
        assert_int_equal(seen[index]++, 0);
        assert_true(radius > 0);
        const double r = fabs(scene->spheres[index].radius);
        assert_true(radius == (tree->single_precision ? fmax((double)(float)r, (double)FLT_MIN) : r));
        for (size_t a = 0; a < 3; ++a) {
            const double c = scene->spheres[index].center[a] - origin[a];
            const double stored = bp_reals_load(tree->leaves, tree->single_precision, base + a * tree->width);
            assert_true(stored == (tree->single_precision ? (double)(float)c : c));
        }
    }
    for (size_t i = 0; i < scene->sphere_count; ++i) assert_int_equal(seen[i], 1);
    free(seen);
}

static void check_tree(const BpScene *scene, const double origin[3], const BpTree *tree) {
    check_slots(scene, origin, tree);
    Check check = {scene, origin, tree, calloc(tree->leaf_count + 1u, 1), calloc(tree->node_count + 1u, 1),
                   0};
    uint32_t nodes[TREE_DEPTH_MAX], lanes[TREE_DEPTH_MAX];
    assert_true(tree->node_count > 0);
    walk(&check, 0, 0, nodes, lanes);
    for (uint32_t i = 0; i < tree->leaf_count; ++i)
        assert_int_equal(check.leaf_seen[i], i >= tree->first_leaves);
    for (uint32_t i = 0; i < tree->node_count; ++i) assert_int_equal(check.node_seen[i], 1);
    assert_int_equal(check.deepest, tree->depth);
    assert_true(tree->depth <= TREE_DEPTH_MAX);
    assert_true(tree->first_leaves <= 1);
    free(check.leaf_seen);
    free(check.node_seen);
}

static void every_shape_and_size(void **state) {
    (void)state;
    const size_t counts[] = {0, 1, 2, 7, 8, 9, 17, 65, 300, 3000};
    const uint32_t widths[] = {2, 4, 8};
    const double origins[2][3] = {{0, 0, 0}, {1e6 + 0.1, -3e5, 12345.678}};
    for (int shape = 0; shape < SHAPE_COUNT; ++shape)
        for (size_t c = 0; c < sizeof counts / sizeof counts[0]; ++c)
            for (int w = 0; w < 3; ++w)
                for (int single = 0; single < 2; ++single)
                    for (int o = 0; o < 2; ++o) {
                        BpScene scene = make_spheres(shape, counts[c], 1);
                        const BpTreeOptions options = {
                            .width = widths[w], .single_precision = single, .threads = 1};
                        BpTree tree;
                        BpError err = {0};
                        assert_int_equal(bp_tree_build(&scene, origins[o], &options, &tree, &err), BP_OK);
                        check_tree(&scene, origins[o], &tree);
                        bp_tree_clear(&tree);
                        free(scene.spheres);
                    }
}

static void check_shape(int shape, size_t count, uint32_t width) {
    const double origin[3] = {3, 2, 1};
    BpScene scene = make_spheres(shape, count, 2);
    const BpTreeOptions options = {.width = width, .single_precision = true};
    BpTree tree;
    assert_int_equal(bp_tree_build(&scene, origin, &options, &tree, NULL), BP_OK);
    check_tree(&scene, origin, &tree);
    bp_tree_clear(&tree);
    free(scene.spheres);
}

static void large_and_degenerate(void **state) {
    (void)state;
    const struct {
        int shape;
        size_t count;
        uint32_t width;
    } cases[] = {{SHAPE_SAME, 100000, 8},   {SHAPE_SAME, 100000, 2},     {SHAPE_POWERS, 100000, 2},
                 {SHAPE_POWERS, 100000, 8}, {SHAPE_CLUSTERS, 200000, 4}, {SHAPE_GRID, 200000, 8},
                 {SHAPE_FIELD, 400000, 8},  {SHAPE_WILD, 300000, 8},     {SHAPE_LINE, 300000, 2}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i)
        check_shape(cases[i].shape, cases[i].count, cases[i].width);
}

/* More than 2^22: threads part their ranges by grids of their own. */
static void grids_of_threads(void **state) {
    (void)state;
    check_shape(SHAPE_FIELD, 6000000, 16);
}

static void assert_same_for_threads(int shape, size_t count) {
    const unsigned threads[] = {1, 2, 5};
    const double origin[3] = {0, 0, 0};
    BpScene scene = make_spheres(shape, count, 3);
    BpTree first = {0};
    for (int t = 0; t < 3; ++t) {
        const BpTreeOptions options = {.width = 8, .single_precision = true, .threads = threads[t]};
        BpTree tree;
        assert_int_equal(bp_tree_build(&scene, origin, &options, &tree, NULL), BP_OK);
        if (t == 0) {
            first = tree;
            continue;
        }
        assert_int_equal(tree.node_count, first.node_count);
        assert_int_equal(tree.leaf_count, first.leaf_count);
        assert_int_equal(tree.first_leaves, first.first_leaves);
        assert_int_equal(tree.depth, first.depth);
        const size_t nodes = tree.node_count, leaves = tree.leaf_count;
        assert_memory_equal(tree.node_boxes, first.node_boxes, nodes * NODE_REALS(8) * sizeof(float));
        assert_memory_equal(tree.children, first.children, nodes * 8 * sizeof(uint32_t));
        assert_memory_equal(tree.leaves, first.leaves, leaves * LEAF_REALS(8) * sizeof(float));
        assert_memory_equal(tree.slot_sphere, first.slot_sphere, leaves * 8 * sizeof(uint32_t));
        bp_tree_clear(&tree);
    }
    bp_tree_clear(&first);
    free(scene.spheres);
}

static void same_for_any_number_of_threads(void **state) {
    (void)state;
    const size_t counts[] = {100, 30000, 200000};
    for (int shape = 0; shape < SHAPE_COUNT; ++shape)
        for (size_t c = 0; c < 3; ++c) assert_same_for_threads(shape, counts[c]);
}

static void lists_keep_the_order(void **state) {
    (void)state;
    const size_t counts[] = {0, 1, 7, 8, 9, 100};
    const double origin[3] = {1, 2, 3};
    for (uint32_t width = 2; width <= 8; width *= 2)
        for (int c = 0; c < 6; ++c) {
            BpScene scene = make_spheres(SHAPE_WILD, counts[c], 4);
            const BpTreeOptions options = {
                .width = width, .single_precision = c % 2 == 0, .list = true, .threads = 1};
            BpTree tree;
            assert_int_equal(bp_tree_build(&scene, origin, &options, &tree, NULL), BP_OK);
            assert_int_equal(tree.node_count, 0);
            assert_int_equal(tree.leaf_count, (counts[c] + width - 1) / width);
            assert_int_equal(tree.first_leaves, tree.leaf_count);
            assert_non_null(tree.node_boxes);
            assert_non_null(tree.children);
            assert_non_null(tree.leaves);
            assert_non_null(tree.slot_sphere);
            for (size_t slot = 0; slot < (size_t)tree.leaf_count * width; ++slot)
                assert_int_equal(tree.slot_sphere[slot], slot < counts[c] ? slot : NO_SPHERE);
            check_slots(&scene, origin, &tree);
            bp_tree_clear(&tree);
            free(scene.spheres);
        }
}

static void huge_spheres_come_first(void **state) {
    (void)state;
    const double origin[3] = {0, 0, 0};
    const BpTreeOptions options = {.width = 8, .single_precision = true, .threads = 1};
    for (int huge = 0; huge < 12; ++huge) {
        BpScene scene = make_spheres(SHAPE_FIELD, 5000, 5);
        for (int i = 0; i < huge; ++i) scene.spheres[17 * i + 3].radius = (i % 2 ? -100.0 : 100.0) - i;
        BpTree tree;
        assert_int_equal(bp_tree_build(&scene, origin, &options, &tree, NULL), BP_OK);
        assert_int_equal(tree.first_leaves, huge > 0);
        uint32_t found = 0;
        for (int lane = 0; lane < 8 && huge > 0; ++lane)
            if (tree.slot_sphere[lane] != NO_SPHERE) {
                assert_true(fabs(scene.spheres[tree.slot_sphere[lane]].radius) > 50);
                ++found;
            }
        assert_int_equal(found, huge < 8 ? huge : 8);
        check_tree(&scene, origin, &tree);
        bp_tree_clear(&tree);
        free(scene.spheres);
    }
}

/* What a tree is worth: full leaves, wide nodes, little memory. */
static void leaves_are_full_and_memory_small(void **state) {
    (void)state;
    const int shapes[] = {SHAPE_FIELD, SHAPE_CLUSTERS, SHAPE_GRID, SHAPE_LINE};
    const double origin[3] = {0, 0, 0};
    for (uint32_t width = 4; width <= 8; width *= 2)
        for (int i = 0; i < 4; ++i) {
            BpScene scene = make_spheres(shapes[i], 100000, 9);
            const BpTreeOptions options = {.width = width, .single_precision = true};
            BpTree tree;
            assert_int_equal(bp_tree_build(&scene, origin, &options, &tree, NULL), BP_OK);
            const double slots = (double)tree.leaf_count * width;
            const double bytes = slots * (4 * sizeof(float) + sizeof(uint32_t)) +
                                 (double)tree.node_count * width * (6 * sizeof(float) + sizeof(uint32_t));
            assert_true((double)scene.sphere_count / slots >= 0.9);
            assert_true((double)(tree.node_count + tree.leaf_count - 1) / tree.node_count >= 0.75 * width);
            assert_true(bytes <= 45.0 * (double)scene.sphere_count);
            bp_tree_clear(&tree);
            free(scene.spheres);
        }
}

static void refusals(void **state) {
    (void)state;
    const double origin[3] = {0, 0, 0};
    BpScene scene = make_spheres(SHAPE_FIELD, 10, 6);
    BpTree tree;
    BpError err = {0};
    const BpTreeOptions three = {.width = 3, .single_precision = true, .threads = 1};
    assert_int_equal(bp_tree_build(&scene, origin, &three, &tree, &err), BP_ERR_LIMIT);
    assert_null(tree.leaves);
    /* Refused by the count alone: the spheres are not looked at. */
    const BpTreeOptions two = {.width = 2, .single_precision = true, .threads = 1};
    scene.sphere_count = (1u << 25) + 1;
    assert_int_equal(bp_tree_build(&scene, origin, &two, &tree, &err), BP_ERR_LIMIT);
    assert_non_null(strstr(err.message, "33554433"));
    scene.sphere_count = BP_SPHERES_MAX + 1ull;
    const BpTreeOptions eight = {.width = 8, .single_precision = true, .list = true, .threads = 1};
    assert_int_equal(bp_tree_build(&scene, origin, &eight, &tree, &err), BP_ERR_LIMIT);
    bp_error_clear(&err);
    free(scene.spheres);
}

/* The last real of the last leaf and node must have an offset of 32 bits, and the first beyond is refused
 * before there is any memory for it. */
static void no_offset_wraps(void **state) {
    (void)state;
    for (uint32_t width = 2; width <= 16; width *= 2) {
        const uint64_t leaves = (UINT64_C(1) << 32) / (4 * width), nodes = (UINT64_C(1) << 32) / (6 * width);
        BpError err = {0};
        assert_true(leaves * LEAF_REALS(width) - 1 <= UINT32_MAX);
        assert_true((leaves + 1) * LEAF_REALS(width) - 1 > UINT32_MAX);
        assert_true(nodes * NODE_REALS(width) - 1 <= UINT32_MAX);
        assert_true((nodes + 1) * NODE_REALS(width) - 1 > UINT32_MAX);
        assert_int_equal(bp_tree_check_size(width, nodes, leaves, &err), BP_OK);
        assert_int_equal(bp_tree_check_size(width, nodes, leaves + 1, &err), BP_ERR_LIMIT);
        assert_int_equal(bp_tree_check_size(width, nodes + 1, leaves, &err), BP_ERR_LIMIT);
        assert_non_null(strstr(err.message, "narrower tree"));
        BpTree tree = {.width = width, .single_precision = true};
        assert_int_equal(bp_tree_allocate(&tree, 1, (uint32_t)(leaves + 1), &err), BP_ERR_LIMIT);
        assert_null(tree.leaves);
        bp_error_clear(&err);
    }
}

int main(void) {
    if (getenv("BALLPARK_TEST_CASE") == NULL) cmocka_set_skip_filter("grids_of_threads");
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_shape_and_size),
        cmocka_unit_test(large_and_degenerate),
        cmocka_unit_test(grids_of_threads),
        cmocka_unit_test(same_for_any_number_of_threads),
        cmocka_unit_test(lists_keep_the_order),
        cmocka_unit_test(huge_spheres_come_first),
        cmocka_unit_test(leaves_are_full_and_memory_small),
        cmocka_unit_test(refusals),
        cmocka_unit_test(no_offset_wraps),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
