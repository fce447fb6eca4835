/* test_boxes.c: tests 38 to 40: boxes and the tree. */
#include "suite.h"

#include "oracle.h"
#include "packed/reals.h"
#include "packed/tree.h"
#include "support/tree_scenes.h"

#include <math.h>
#include <string.h>

/* One box a node (lane `node % width`; the others are empty) and one ray each. */
typedef struct Boxes {
    size_t count, width;
    double *rays, *planes; /* planes as scene_types.h has them */
    double *boxes;         /* low, high: 6 an item */
    uint32_t *met;         /* width an item */
} Boxes;

static void boxes_init(const Lab *lab, size_t count, Boxes *boxes) {
    boxes->count = count;
    boxes->width = lab->options.tree_width;
    boxes->rays = suite_calloc(count * RAY_REALS, sizeof(double));
    boxes->planes = suite_calloc(count * 6 * boxes->width, sizeof(double));
    boxes->boxes = suite_calloc(count * 6, sizeof(double));
    boxes->met = suite_calloc(count * boxes->width, sizeof(uint32_t));
}

static void boxes_clear(Boxes *boxes) {
    free(boxes->rays);
    free(boxes->planes);
    free(boxes->boxes);
    free(boxes->met);
}

static void boxes_run(const Lab *lab, Boxes *boxes) {
    for (size_t i = 0; i < boxes->count; ++i)
        for (size_t row = 0; row < 6; ++row)
            for (size_t lane = 0; lane < boxes->width; ++lane)
                boxes->planes[(i * 6 + row) * boxes->width + lane] = lane == i % boxes->width
                                                                         ? boxes->boxes[i * 6 + row]
                                                                     : row < 3 ? 1e30
                                                                               : -1e30;
    const LabArgument arguments[] = {{LAB_REALS, boxes->rays, boxes->count * RAY_REALS},
                                     {LAB_REALS, boxes->planes, boxes->count * 6 * boxes->width},
                                     {LAB_OUT_WORDS, boxes->met, boxes->count * boxes->width}};
    lab_run(lab, "probe_boxes", boxes->count, arguments, 3, NULL);
}

/* Whether the ray meets the box, in 113 bits. */
static bool wide_meets(const double *ray, const double *box) {
    Wide near = 0, far = 1e30;
    for (int a = 0; a < 3; ++a) {
        const Wide origin = (Wide)ray[a] + (Wide)ray[3 + a], d = (Wide)ray[6 + a];
        const Wide low = (Wide)box[a], high = (Wide)box[3 + a];
        if (d == 0) {
            if (origin < low || origin > high) return false;
            continue;
        }
        Wide first = (low - origin) / d, last = (high - origin) / d;
        if (first > last) {
            const Wide swap = first;
            first = last;
            last = swap;
        }
        if (first > near) near = first;
        if (last < far) far = last;
    }
    return near <= far;
}

/* Slabs as they are mostly written, in float. */
static bool naive_meets(const double *ray, const double *box) {
    float near = 0, far = 1e30f;
    for (int a = 0; a < 3; ++a) {
        const float inverse = 1 / (float)ray[6 + a];
        const float t0 = ((float)box[a] - (float)ray[a]) * inverse,
                    t1 = ((float)box[3 + a] - (float)ray[a]) * inverse;
        near = fmaxf(near, fminf(t0, t1));
        far = fminf(far, fmaxf(t0, t1));
    }
    return near <= far;
}

/* 38: rays aimed at edges of boxes: none that meets its box is said to miss it. */
static void slab_edges(void **state) {
    const Lab *lab = *state;
    const double low_part = lab->real_double ? 0x1p-54 : 0x1p-25; /* up to half a unit in the last place */
    enum { COUNT = 250000, ROUNDS = 4 };
    size_t missed = 0, naive_missed = 0, met = 0, needless = 0;
    uint64_t seed = 38;
    Boxes boxes;
    boxes_init(lab, COUNT, &boxes);
    for (int round = 0; round < ROUNDS; ++round) {
        for (size_t i = 0; i < COUNT; ++i) {
            double *ray = boxes.rays + i * RAY_REALS, *box = boxes.boxes + i * 6, from[3];
            const double size = pow(10, 4 * lab_unit(&seed) - 2), far = pow(10, 3 * lab_unit(&seed)) * size;
            lab_direction(&seed, from);
            const int along = (int)(lab_bits(&seed) % 3); /* the axis of the edge aimed at */
            for (int a = 0; a < 3; ++a) {
                const double low = size * (lab_unit(&seed) - 0.5) * 10;
                box[a] = lab_float(low);
                box[3 + a] = lab_float(low + size * (0.1 + lab_unit(&seed)));
                const double u = a == along ? lab_unit(&seed) : (double)(lab_bits(&seed) & 1);
                const double target = box[a] + u * (box[3 + a] - box[a]);
                ray[a] = lab_float(target - far * from[a]);
                ray[3 + a] = lab_float(ray[a] * low_part * (2 * lab_unit(&seed) - 1));
                ray[6 + a] = target - ray[a] - ray[3 + a];
            }
            lab_float_unit(ray + RAY_DIRECTION);
        }
        lab_unit_rays(*state, COUNT, boxes.rays);
        boxes_run(*state, &boxes);
        for (size_t i = 0; i < COUNT; ++i) {
            const double *ray = boxes.rays + i * RAY_REALS, *box = boxes.boxes + i * 6;
            const bool ours = boxes.met[i * boxes.width + i % boxes.width] != 0;
            for (size_t lane = 0; lane < boxes.width; ++lane)
                if (lane != i % boxes.width) assert_true(boxes.met[i * boxes.width + lane] == 0);
            if (!wide_meets(ray, box)) {
                needless += ours;
                continue;
            }
            ++met;
            missed += !ours;
            naive_missed += !naive_meets(ray, box);
        }
    }
    print_message(
        "    %zu meet their box: %zu missed, naive slabs %zu; %zu of the others tested needlessly\n", met,
        missed, naive_missed, needless);
    assert_true(met > COUNT && naive_missed > met / 1000);
    assert_int_equal(missed, 0);
    boxes_clear(&boxes);
}

/* 39: directions with components of +0 and -0, origins in, on and outside the planes of a box around the unit
 * cube's sphere, padded as the tree pads it (host/packed/tree_write.c); what meets the cube must meet the
 * box.
 */
static void slab_zero_dir(void **state) {
    const Lab *lab = *state;
    enum { PLACES = 5, COUNT = 27 * PLACES * PLACES * PLACES };
    const double places[PLACES] = {-1, 0, 0.5, 1, 2};
    Boxes boxes;
    size_t met = 0;
    boxes_init(*state, COUNT, &boxes);
    for (size_t i = 0; i < COUNT; ++i) {
        double *ray = boxes.rays + i * RAY_REALS, *box = boxes.boxes + i * 6;
        size_t code = i;
        for (int a = 0; a < 3; ++a, code /= PLACES) ray[a] = places[code % PLACES];
        for (int a = 0; a < 3; ++a, code /= 3) ray[6 + a] = code % 3 == 0 ? 1.0 : code % 3 == 1 ? 0.0 : -0.0;
        const double length = sqrt(lab_dot(ray + 6, ray + 6));
        if (length > 1) lab_float_unit(ray + RAY_DIRECTION);
        if (length == 0) ray[6] = 1;
        const double pad = lab->real_double ? 0x1p-51 : 0x1p-22;
        for (int a = 0; a < 3; ++a) {
            box[a] = -pad;
            box[3 + a] = 1 + 2 * pad;
        }
    }
    lab_unit_rays(*state, COUNT, boxes.rays);
    boxes_run(*state, &boxes);
    for (size_t i = 0; i < COUNT; ++i) {
        const double cube[] = {0, 0, 0, 1, 1, 1};
        if (!wide_meets(boxes.rays + i * RAY_REALS, cube)) continue;
        ++met;
        assert_true(boxes.met[i * boxes.width + i % boxes.width] != 0);
    }
    assert_true(met > COUNT / 10);
    boxes_clear(&boxes);
}

/* 40: the tree finds the very t and sphere that testing every sphere finds; half of the rays graze. */
static void bvh_equals_brute(void **state) {
    const Lab *lab = *state;
    enum { SPHERES = 1000, COUNT = 20000 };
    size_t hits = 0, different = 0;
    for (int shape = 0; shape < SHAPE_COUNT; ++shape) {
        BpScene scene = make_spheres(shape, SPHERES, 40);
        const double view[3] = {0.5, 1, -2};
        const BpTreeOptions options = {
            .width = lab->options.tree_width, .single_precision = !lab->real_double, .threads = 1};
        BpTree tree;
        assert_int_equal(bp_tree_build(&scene, view, &options, &tree, NULL), BP_OK);
        double *rays = suite_calloc(COUNT * RAY_REALS, sizeof *rays),
               *out = suite_calloc(COUNT * 5, sizeof *out);
        uint64_t seed = 40 + (uint64_t)shape;
        for (size_t i = 0; i < COUNT; ++i) {
            double *ray = rays + i * RAY_REALS, off[3], to[3], side[3];
            const BpSphere *from = &scene.spheres[lab_bits(&seed) % SPHERES];
            const BpSphere *at = &scene.spheres[lab_bits(&seed) % SPHERES];
            lab_direction(&seed, off);
            for (int a = 0; a < 3; ++a) {
                ray[a] = lab_float(from->center[a] - view[a] + 2 * (lab_unit(&seed) - 0.5));
                /* Half of them along an axis or in a plane of two: where spheres touch their boxes. */
                to[a] = at->center[a] - view[a] - ray[a];
            }
            lab_cross(to, off, side);
            const double length = sqrt(lab_dot(side, side)), impact = i % 2 == 0 ? 1 : lab_unit(&seed);
            for (int a = 0; a < 3; ++a)
                ray[6 + a] = to[a] + (length > 0 ? fabs(at->radius) * impact * side[a] / length : 0);
            if (i % 4 == 0 && shape != SHAPE_SAME) {
                /* Along an axis, past the very end of the sphere's other axis. */
                const int axis = (int)(lab_bits(&seed) % 3), other = (axis + 1) % 3;
                for (int a = 0; a < 3; ++a) {
                    const double centre = at->center[a] - view[a];
                    ray[a] = lab_float(a == axis    ? centre - 3
                                       : a == other ? centre + fabs(at->radius) *
                                                                   (1 + 0x1p-22 * (lab_unit(&seed) - 0.5))
                                                    : centre);
                    ray[6 + a] = a == axis;
                }
            }
            if (lab_dot(ray + 6, ray + 6) == 0) ray[6] = 1;
            lab_float_unit(ray + RAY_DIRECTION);
        }
        lab_unit_rays(lab, COUNT, rays);
        const size_t size = lab->real_double ? 8 : 4, width = tree.width;
        const LabArgument arguments[] = {
            {LAB_REALS, rays, COUNT * RAY_REALS},
            {LAB_BYTES, tree.node_boxes, (tree.node_count > 0 ? tree.node_count : 1) * 6 * width * size},
            {LAB_WORDS, tree.children, (tree.node_count > 0 ? tree.node_count : 1) * width},
            {LAB_BYTES, tree.leaves, tree.leaf_count * 4 * width * size},
            {LAB_WORDS, tree.slot_sphere, tree.leaf_count * width},
            {LAB_NUMBER, NULL, tree.first_leaves},
            {LAB_NUMBER, NULL, tree.leaf_count},
            {LAB_OUT_REFINED, out, COUNT * 5}};
        lab_run(lab, "probe_tree", COUNT, arguments, 8, NULL);
        for (size_t i = 0; i < COUNT; ++i) {
            const double *row = out + i * 5;
            hits += row[3] >= 0;
            different += row[0] != row[2] || row[1] != row[3] || (row[4] != 0) != (row[3] >= 0);
        }
        bp_tree_clear(&tree);
        free(scene.spheres);
        free(rays);
        free(out);
    }
    print_message("    %zu hits, %zu differ\n", hits, different);
    assert_true(hits > COUNT);
    assert_int_equal(different, 0);
}

int run_boxes(Lab *lab) {
    const struct CMUnitTest tests[] = {HARD_TEST(slab_edges), HARD_TEST(slab_zero_dir),
                                       HARD_TEST(bvh_equals_brute)};
    return cmocka_run_group_tests_name("boxes", tests, NULL, NULL);
}
