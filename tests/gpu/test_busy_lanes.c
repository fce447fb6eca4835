/* test_busy_lanes.c: how many lanes of a GPU have a path to follow, by replaying paths in step.
 *
 * In:    the lengths of the paths of a picture, as the kernel traced them here.
 * Out:   for each width of a group that proceeds in step, the share of its lanes that work, in the form of
 * one work-item a sample and in that of a pool: the rows of the table in docs/GPU.md.
 * Knows: how the two forms hand out samples (trace_sample.cl, trace_pool.cl).   Does not know: what a segment
 * costs.
 *
 * A step is a segment of every lane that has one. Within a step, lanes part again, at the nodes of the tree
 * and at materials; of that, nothing is said here. */
#include "opencl/program.h"
#include "render/worker.h"
#include "support/load_scene.h"
#include "support/pixel_samples.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { SAMPLES = 64, WIDTH = 160, LANES_MAX = 64 };

/* Segments of each pixel sample, in the order of a chunk of all of them. */
typedef struct Lengths {
    uint32_t *of;
    size_t count;
} Lengths;

static double mean_length(const Lengths *lengths) {
    double sum = 0;
    for (size_t i = 0; i < lengths->count; ++i) sum += lengths->of[i];
    return sum / (double)lengths->count;
}

/* The share of `width` lanes that work where each follows one path, and a group waits for its longest. */
static double share_of_sample_form(const Lengths *lengths, size_t width) {
    double work = 0, steps = 0;
    for (size_t first = 0; first < lengths->count; first += width) {
        uint32_t longest = 0;
        for (size_t i = first; i < first + width && i < lengths->count; ++i) {
            work += lengths->of[i];
            if (lengths->of[i] > longest) longest = lengths->of[i];
        }
        steps += longest;
    }
    return work / (steps * (double)width);
}

/* The same where the lanes of a work-group take the next of its samples as soon as their path has ended: the
 * groups of `width` lanes in a work-group take their steps in turns, and each is done when none of its lanes
 * has a path. */
static double share_of_pool_form(const Lengths *lengths, size_t width) {
    const size_t share = (size_t)BP_LOCAL_SIZE_SAMPLE * BP_POOL_SAMPLES_PER_ITEM;
    double work = 0, steps = 0;
    for (size_t begin = 0; begin < lengths->count; begin += share) {
        const size_t end = begin + share < lengths->count ? begin + share : lengths->count;
        uint32_t left[BP_LOCAL_SIZE_SAMPLE] = {0};
        size_t next = begin, busy;
        do {
            busy = 0;
            for (size_t group = 0; group < BP_LOCAL_SIZE_SAMPLE; group += width) {
                size_t lanes = 0;
                for (size_t lane = group; lane < group + width; ++lane) {
                    if (left[lane] == 0 && next < end) left[lane] = lengths->of[next++];
                    if (left[lane] == 0) continue;
                    --left[lane];
                    ++lanes;
                }
                work += (double)lanes;
                if (lanes > 0) ++steps;
                busy += lanes;
            }
        } while (busy > 0);
    }
    return work / (steps * (double)width);
}

static Lengths trace(const char *name) {
    char path[64];
    snprintf(path, sizeof path, "scenes/%s.json", name);
    BpScene *scene = load_scene(path, WIDTH);
    BpRenderOptions options;
    bp_render_defaults(scene, &options);
    options.samples_per_pixel = SAMPLES;
    const PixelSamples samples = draw_samples(scene, &options);
    const Lengths lengths = {malloc(samples.count * sizeof *lengths.of), samples.count};
    assert_non_null(lengths.of);
    for (size_t i = 0; i < samples.count; ++i) {
        const float segments = samples.values[4 * i + 3];
        assert_true(segments >= 1 && segments <= (float)options.max_depth + 0.5f);
        lengths.of[i] = (uint32_t)segments;
    }
    free(samples.values);
    bp_scene_destroy(&scene);
    return lengths;
}

/* Lengths whose shares are known. */
static void known_lengths(void **state) {
    (void)state;
    enum { COUNT = 4096 };
    uint32_t of[COUNT];
    const Lengths lengths = {of, COUNT};
    for (size_t i = 0; i < COUNT; ++i) of[i] = 3;
    for (size_t width = 8; width <= LANES_MAX; width *= 2) {
        assert_true(fabs(share_of_sample_form(&lengths, width) - 1) < 1e-12);
        assert_true(fabs(share_of_pool_form(&lengths, width) - 1) < 1e-12);
    }
    /* One path of each 32 is long: the others wait for it, or take 29 more of 1 segment. */
    for (size_t i = 0; i < COUNT; ++i) of[i] = i % 32 == 0 ? 30 : 1;
    assert_true(fabs(share_of_sample_form(&lengths, 32) - 61.0 / (30 * 32)) < 1e-12);
    assert_true(share_of_pool_form(&lengths, 32) > 0.5);
    /* A long path at the end of a share has nothing beside it: 32 steps for all, of which the last has 999
     * behind it. */
    for (size_t i = 0; i < COUNT; ++i) of[i] = i % 1024 == 1023 ? 1000 : 1;
    assert_true(fabs(share_of_pool_form(&lengths, 32) - 2023.0 / ((32 + 999) * 32)) < 1e-12);
}

/* Shares are at least these, and less than 0.03 more: a table of figures that moved is to be made anew. */
typedef struct Bound {
    size_t width;
    double sample, pool;
} Bound;

static void compare(const char *name, const Bound *bounds, size_t count) {
    const Lengths lengths = trace(name);
    print_message("%s: %.2f segments a path\n", name, mean_length(&lengths));
    for (size_t b = 0; b < count; ++b) {
        const double sample = share_of_sample_form(&lengths, bounds[b].width);
        const double pool = share_of_pool_form(&lengths, bounds[b].width);
        print_message("| %s | %zu | %.0f %% | %.0f %% | %.2f |\n", name, bounds[b].width, 100 * sample,
                      100 * pool, pool / sample);
        assert_true(sample >= bounds[b].sample && sample < bounds[b].sample + 0.03);
        assert_true(pool >= bounds[b].pool && pool < bounds[b].pool + 0.03);
    }
    free(lengths.of);
}

static void cover(void **state) {
    (void)state;
    const Bound bounds[] = {{8, 0.575, 0.935}, {16, 0.475, 0.905}, {32, 0.395, 0.875}, {64, 0.325, 0.845}};
    compare("cover", bounds, 4);
}

static void glass(void **state) {
    (void)state;
    const Bound bounds[] = {{8, 0.585, 0.935}, {16, 0.495, 0.915}, {32, 0.415, 0.895}, {64, 0.355, 0.865}};
    compare("v4-18-glass-hollow", bounds, 4);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(known_lengths), cmocka_unit_test(cover),
                                       cmocka_unit_test(glass)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
