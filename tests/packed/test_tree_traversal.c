/* test_tree_traversal.c: a plain walk over the packed tree finds what testing every sphere finds, to the bit.
 */
#define BP_HOST
#include "base/status.h"
#include "packed/reals.h"
#include "packed/tree.h"
#include "scene_types.h"
#include "support/tree_scenes.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

typedef struct Ray {
    double origin[3], direction[3];
} Ray;

typedef struct Hit {
    double t;
    uint32_t sphere;
} Hit;

static double lane_value(const BpTree *tree, const void *array, size_t base, uint32_t row, uint32_t lane) {
    return bp_reals_load(array, tree->single_precision, base + row * tree->width + lane);
}

/* The closest hit is the least (t, index). */
static void test_slot(const BpTree *tree, uint32_t leaf, uint32_t lane, const Ray *ray, Hit *hit) {
    const uint32_t index = tree->slot_sphere[(size_t)leaf * tree->width + lane];
    if (index == NO_SPHERE) return;
    const size_t base = (size_t)leaf * LEAF_REALS(tree->width);
    const double r = lane_value(tree, tree->leaves, base, 3, lane);
    double a = 0, h = 0, c = -r * r;
    for (uint32_t i = 0; i < 3; ++i) {
        const double oc = lane_value(tree, tree->leaves, base, i, lane) - ray->origin[i];
        a += ray->direction[i] * ray->direction[i];
        h += oc * ray->direction[i];
        c += oc * oc;
    }
    const double discriminant = h * h - a * c;
    if (discriminant < 0) return;
    double t = (h - sqrt(discriminant)) / a;
    if (t <= 0) t = (h + sqrt(discriminant)) / a;
    if (t > 0 && (t < hit->t || (t == hit->t && index < hit->sphere))) *hit = (Hit){t, index};
}

static Hit brute_force(const BpTree *tree, const Ray *ray) {
    Hit hit = {INFINITY, NO_SPHERE};
    for (uint32_t leaf = 0; leaf < tree->leaf_count; ++leaf)
        for (uint32_t lane = 0; lane < tree->width; ++lane) test_slot(tree, leaf, lane, ray, &hit);
    return hit;
}

static Hit walk(const BpTree *tree, const Ray *ray, unsigned long *visits) {
    Hit hit = {INFINITY, NO_SPHERE};
    uint32_t stack[TREE_DEPTH_MAX * 7 + 1], top = 0;
    for (uint32_t leaf = 0; leaf < tree->first_leaves; ++leaf)
        for (uint32_t lane = 0; lane < tree->width; ++lane) test_slot(tree, leaf, lane, ray, &hit);
    if (tree->node_count > 0) stack[top++] = 0;
    while (top > 0) {
        const uint32_t word = stack[--top];
        ++*visits;
        if (word & CHILD_LEAF) {
            for (uint32_t lane = 0; lane < tree->width; ++lane)
                test_slot(tree, word & ~CHILD_LEAF, lane, ray, &hit);
            continue;
        }
        const size_t base = (size_t)word * NODE_REALS(tree->width);
        for (uint32_t lane = 0; lane < tree->width; ++lane) {
            double near = 0, far = hit.t;
            for (uint32_t a = 0; a < 3; ++a) {
                const double inverse = 1 / ray->direction[a];
                double t0 = (lane_value(tree, tree->node_boxes, base, a, lane) - ray->origin[a]) * inverse;
                double t1 =
                    (lane_value(tree, tree->node_boxes, base, 3 + a, lane) - ray->origin[a]) * inverse;
                if (inverse < 0) {
                    const double swap = t0;
                    t0 = t1;
                    t1 = swap;
                }
                assert_false(isnan(t0) || isnan(t1));
                /* Wider than the rounding of this test and of test_slot, which is relative to the distances.
                 */
                t0 -= fabs(t0) * 1e-9 + 1e-9;
                t1 += fabs(t1) * 1e-9 + 1e-9;
                if (t0 > near) near = t0;
                if (t1 < far) far = t1;
            }
            if (near <= far) stack[top++] = tree->children[(size_t)word * tree->width + lane];
        }
    }
    return hit;
}

static void walk_equals_brute_force(void **state) {
    (void)state;
    const double view[3] = {0.5, 1, -2};
    uint64_t random = 7;
    for (int shape = 0; shape < SHAPE_COUNT; ++shape)
        for (uint32_t width = 2; width <= 8; width *= 2)
            for (int single = 0; single < 2; ++single) {
                const uint32_t count = 2000;
                BpScene scene = make_spheres(shape, count, 8);
                const BpTreeOptions options = {.width = width, .single_precision = single, .threads = 1};
                BpTree tree;
                assert_int_equal(bp_tree_build(&scene, view, &options, &tree, NULL), BP_OK);
                unsigned long visits = 0, hits = 0;
                const int rays = 300;
                for (int i = 0; i < rays; ++i) {
                    /* From beside one sphere towards another, so that many hit. */
                    Ray ray;
                    const BpSphere *from = &scene.spheres[random_bits(&random) % count];
                    const BpSphere *to = &scene.spheres[random_bits(&random) % count];
                    for (int a = 0; a < 3; ++a) {
                        ray.origin[a] = from->center[a] - view[a] + random_unit(&random);
                        ray.direction[a] = to->center[a] - view[a] - ray.origin[a];
                        ray.direction[a] += fabs(to->radius) * (random_unit(&random) - 0.5);
                    }
                    const Hit a = brute_force(&tree, &ray), b = walk(&tree, &ray, &visits);
                    assert_true(a.t == b.t && a.sphere == b.sphere);
                    hits += a.sphere != NO_SPHERE;
                }
                assert_true(hits > (unsigned long)rays / 10);
                /* A walk that visits everything would pass too. (All alike: nothing can be left out.) */
                if (shape == SHAPE_FIELD) assert_true(visits < (unsigned long)rays * tree.leaf_count / 2);
                bp_tree_clear(&tree);
                free(scene.spheres);
            }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(walk_equals_brute_force)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
