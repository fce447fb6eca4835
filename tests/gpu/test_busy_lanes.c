/* test_busy_lanes.c: how many lanes of a GPU have work, by replaying the paths of a picture in step.
 *
 * In:    for each segment of each path, how many nodes of the tree it tests, as the kernel counts them here.
 * Out:   for each width of a group that proceeds in step, the share of its lanes that work, in the form of
 * one work-item a sample and in that of a pool: the rows of the table in docs/GPU.md.
 * Knows: how the two forms hand out samples (trace_sample.cl, trace_pool.cl), and where they meet: after each
 * segment. Does not know: leaves, what is computed at a hit.
 *
 * It is counted twice. By segments, a step is a segment of every lane that has one. By nodes, a step is a
 * node: lanes whose search has ended wait for the longest search of their group, and then all go on with
 * their next segment. */
#include "opencl/program.h"
#include "render/worker.h"
#include "support/kernel_copy.h"
#include "support/load_scene.h"
#include "support/pixel_samples.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { SAMPLES = 64, WIDTH = 160, LANES_MAX = 64, DEPTH_MAX = 52, AT_ONCE = 4 };

/* The nodes that each segment of each pixel sample tests, in the order of a chunk of all samples; 0 behind a
 * path's end. */
typedef struct Paths {
    uint16_t (*nodes)[DEPTH_MAX];
    size_t count;
} Paths;

static double mean_length(const Paths *paths) {
    double sum = 0;
    for (size_t i = 0; i < paths->count; ++i)
        for (size_t s = 0; s < DEPTH_MAX && paths->nodes[i][s] > 0; ++s) ++sum;
    return sum / (double)paths->count;
}

/* Steps of a group: how many lanes worked in them, and how many there were. */
typedef struct Steps {
    double work, count;
} Steps;

/* One segment of all lanes of a group: lane l tests nodes[l] nodes, and has no path where that is 0. */
static void add_segment(const uint16_t *nodes, size_t width, bool by_nodes, Steps *steps) {
    uint32_t longest = 0;
    for (size_t lane = 0; lane < width; ++lane) {
        const uint32_t cost = by_nodes ? nodes[lane] : nodes[lane] > 0;
        steps->work += cost;
        if (cost > longest) longest = cost;
    }
    steps->count += longest;
}

static double share_of(const Steps *steps, size_t width) {
    return steps->work / (steps->count * (double)width);
}

/* The share of `width` lanes that work where each follows one path, and a group waits for its longest. */
static double share_of_sample_form(const Paths *paths, size_t width, bool by_nodes) {
    Steps steps = {0};
    for (size_t first = 0; first < paths->count; first += width)
        for (size_t s = 0; s < DEPTH_MAX; ++s) {
            uint16_t nodes[LANES_MAX] = {0};
            for (size_t lane = 0; lane < width && first + lane < paths->count; ++lane)
                nodes[lane] = paths->nodes[first + lane][s];
            add_segment(nodes, width, by_nodes, &steps);
        }
    return share_of(&steps, width);
}

/* The same where the lanes of a work-group take the next of its samples as soon as their path has ended: the
 * groups of `width` lanes in a work-group take their segments in turns, and each is done when none of its
 * lanes has a path. */
static double share_of_pool_form(const Paths *paths, size_t width, bool by_nodes) {
    const size_t share = (size_t)BP_LOCAL_SIZE_SAMPLE * BP_POOL_SAMPLES_PER_ITEM;
    Steps steps = {0};
    for (size_t begin = 0; begin < paths->count; begin += share) {
        const size_t end = begin + share < paths->count ? begin + share : paths->count;
        const uint16_t *left[BP_LOCAL_SIZE_SAMPLE] = {
            0}; /* of the path, and 0 behind its end; NULL: none yet */
        const uint16_t *behind[BP_LOCAL_SIZE_SAMPLE] = {0};
        size_t next = begin, busy;
        do {
            busy = 0;
            for (size_t group = 0; group < BP_LOCAL_SIZE_SAMPLE; group += width) {
                uint16_t nodes[LANES_MAX] = {0};
                for (size_t lane = group; lane < group + width; ++lane) {
                    if ((left[lane] == behind[lane] || *left[lane] == 0) && next < end) {
                        left[lane] = paths->nodes[next++];
                        behind[lane] = left[lane] + DEPTH_MAX;
                    }
                    if (left[lane] == behind[lane] || *left[lane] == 0) continue;
                    nodes[lane - group] = *left[lane]++;
                    ++busy;
                }
                add_segment(nodes, width, by_nodes, &steps);
            }
        } while (busy > 0);
    }
    return share_of(&steps, width);
}

/* The kernel of one path each counts the nodes of each segment, with the tree that GPUs get. A picture has
 * room for the last four segments below the depth cap, so it is drawn with one cap after another. */
static void count_nodes(KernelCopy *copy) {
    kernel_copy_open(copy, "bvh/geometry.cl", "#ifdef FLAT_GROUPS_MAX\n    FlatTree flat;",
                     "    uint *nodes;\n#ifdef FLAT_GROUPS_MAX\n    FlatTree flat;");
    kernel_copy_patch(copy, "bvh/traverse_single.cl", "        child_mask met = wanted & test_node",
                      "        ++*geometry->nodes;\n        child_mask met = wanted & test_node");
    kernel_copy_patch(copy, "entry/trace_sample.cl", "    const Scene scene = scene_init(SCENE_ARGUMENTS);",
                      "    Scene scene = scene_init(SCENE_ARGUMENTS);\n    uint nodes;\n    real "
                      "of_segment[4] = {0, 0, 0, 0};\n"
                      "    scene.geometry.nodes = &nodes;");
    kernel_copy_patch(copy, "entry/trace_sample.cl",
                      "    while (path_goes_on(&path, max_depth)) path_go_on(&scene, &path);\n    "
                      "store_sample(&path, item, samples);",
                      "    while (path_goes_on(&path, max_depth)) {\n        const uint number = "
                      "path.depth;\n        nodes = 0;\n"
                      "        path_go_on(&scene, &path);\n        if (number + 4 >= max_depth) "
                      "of_segment[number % 4] = max(nodes, 1u);\n"
                      "    }\n    vstore4(vload4(0, of_segment), item, samples);");
}

static Paths trace(const char *name) {
    char path[64];
    snprintf(path, sizeof path, "scenes/%s.json", name);
    BpScene *scene = load_scene(path, WIDTH);
    BpRenderOptions options;
    bp_render_defaults(scene, &options);
    options.roulette = BP_ROULETTE_OFF; /* which is not played at small depths */
    options.samples_per_pixel = SAMPLES;
    const uint32_t depth = options.max_depth;
    assert_in_range(depth, 1, DEPTH_MAX);
    const PixelSamples lengths = draw_samples(scene, &options);
    Paths paths = {calloc(lengths.count, sizeof *paths.nodes), lengths.count};
    assert_non_null(paths.nodes);
    KernelCopy copy;
    count_nodes(&copy);
    options.kernel = BP_KERNEL_SAMPLE;
    options.tree_width = 4;
    for (uint32_t first = 0; first < depth; first += AT_ONCE) {
        options.max_depth = first + AT_ONCE;
        const PixelSamples samples = draw_samples(scene, &options);
        for (size_t i = 0; i < samples.count; ++i)
            for (uint32_t s = 0; s < AT_ONCE && first + s < depth; ++s)
                paths.nodes[i][first + s] = (uint16_t)samples.values[4 * i + s];
        free(samples.values);
    }
    kernel_copy_close(&copy);
    /* Each segment tests the root, or a list, so what was counted are the segments that there are. */
    for (size_t i = 0; i < paths.count; ++i) {
        const uint32_t segments = (uint32_t)lengths.values[4 * i + 3];
        for (uint32_t s = 0; s < DEPTH_MAX; ++s) assert_true((paths.nodes[i][s] > 0) == (s < segments));
    }
    free(lengths.values);
    bp_scene_destroy(&scene);
    return paths;
}

/* Paths whose shares are known. */
static void known_paths(void **state) {
    (void)state;
    enum { COUNT = 4096 };
    const Paths paths = {calloc(COUNT, sizeof *paths.nodes), COUNT};
    assert_non_null(paths.nodes);
    for (size_t i = 0; i < COUNT; ++i)
        for (size_t s = 0; s < 3; ++s) paths.nodes[i][s] = 5;
    for (size_t width = 8; width <= LANES_MAX; width *= 2)
        for (int by_nodes = 0; by_nodes < 2; ++by_nodes) {
            assert_true(fabs(share_of_sample_form(&paths, width, by_nodes) - 1) < 1e-12);
            assert_true(fabs(share_of_pool_form(&paths, width, by_nodes) - 1) < 1e-12);
        }
    /* One search of each 32 is long: the others wait for it, in either form. */
    for (size_t i = 0; i < COUNT; i += 32)
        for (size_t s = 0; s < 3; ++s) paths.nodes[i][s] = 36;
    assert_true(fabs(share_of_sample_form(&paths, 32, false) - 1) < 1e-12);
    assert_true(fabs(share_of_sample_form(&paths, 32, true) - (31 * 5 + 36) / (36.0 * 32)) < 1e-12);
    assert_true(fabs(share_of_pool_form(&paths, 32, true) - (31 * 5 + 36) / (36.0 * 32)) < 1e-12);
    /* One path of each 32 is long: the others wait for it, or take 29 more of 1 segment. */
    for (size_t i = 0; i < COUNT; ++i)
        for (size_t s = 0; s < DEPTH_MAX; ++s) paths.nodes[i][s] = s < (i % 32 == 0 ? 30 : 1) ? 7 : 0;
    for (int by_nodes = 0; by_nodes < 2; ++by_nodes) {
        assert_true(fabs(share_of_sample_form(&paths, 32, by_nodes) - 61.0 / (30 * 32)) < 1e-12);
        assert_true(share_of_pool_form(&paths, 32, by_nodes) > 0.5);
    }
    /* A long path at the end of a share has nothing beside it: 32 steps for all, of which the last has 49
     * behind it. */
    for (size_t i = 0; i < COUNT; ++i)
        for (size_t s = 0; s < DEPTH_MAX; ++s) paths.nodes[i][s] = s < (i % 1024 == 1023 ? 50 : 1);
    assert_true(fabs(share_of_pool_form(&paths, 32, true) - 1073.0 / ((32 + 49) * 32)) < 1e-12);
    free(paths.nodes);
}

/* Shares are at least these, and less than 0.03 more: a table of figures that moved is to be made anew. */
typedef struct Bound {
    size_t width;
    double sample[2], pool[2]; /* by segments, by nodes */
} Bound;

static void compare(const char *name, const Bound *bounds, size_t count) {
    const Paths paths = trace(name);
    print_message("%s: %.2f segments a path\n", name, mean_length(&paths));
    for (size_t b = 0; b < count; ++b) {
        double sample[2], pool[2];
        for (int by_nodes = 0; by_nodes < 2; ++by_nodes) {
            sample[by_nodes] = share_of_sample_form(&paths, bounds[b].width, by_nodes);
            pool[by_nodes] = share_of_pool_form(&paths, bounds[b].width, by_nodes);
        }
        print_message("| %s | %zu | %.0f %% | %.0f %% | %.2f | %.0f %% | %.0f %% | %.2f |\n", name,
                      bounds[b].width, 100 * sample[0], 100 * pool[0], pool[0] / sample[0], 100 * sample[1],
                      100 * pool[1], pool[1] / sample[1]);
        for (int by_nodes = 0; by_nodes < 2; ++by_nodes) {
            assert_true(sample[by_nodes] >= bounds[b].sample[by_nodes]);
            assert_true(sample[by_nodes] < bounds[b].sample[by_nodes] + 0.03);
            assert_true(pool[by_nodes] >= bounds[b].pool[by_nodes]);
            assert_true(pool[by_nodes] < bounds[b].pool[by_nodes] + 0.03);
        }
    }
    free(paths.nodes);
}

static void cover(void **state) {
    (void)state;
    const Bound bounds[] = {{8, {0.575, 0.485}, {0.935, 0.675}},
                            {16, {0.475, 0.375}, {0.905, 0.595}},
                            {32, {0.395, 0.285}, {0.875, 0.535}},
                            {64, {0.325, 0.225}, {0.845, 0.475}}};
    compare("cover", bounds, 4);
}

static void glass(void **state) {
    (void)state;
    const Bound bounds[] = {{8, {0.585, 0.585}, {0.935, 0.935}},
                            {16, {0.495, 0.495}, {0.915, 0.915}},
                            {32, {0.415, 0.415}, {0.895, 0.895}},
                            {64, {0.355, 0.355}, {0.865, 0.865}}};
    compare("v4-18-glass-hollow", bounds, 4);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(known_paths), cmocka_unit_test(cover),
                                       cmocka_unit_test(glass)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
