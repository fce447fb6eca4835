/* test_lamp_same.c: with lamps sampled, a picture still depends on scene, seed and samples alone.
 *
 * The tree of lamps has a width and an order of its own, whatever the tree of spheres looks like. So list or
 * tree, the widths of trees and packets, work-groups and chunks change no bit of the film, no ray segment,
 * and no ray to a lamp. */
#include "support/load_scene.h"
#include "support/open_render.h"
#include "support/unit_test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static BpError err;

/* The film's sums, fine sums and counts, in one block of memory that the caller frees; how many ray segments
 * there were, and rays to lamps. */
static char *render(const BpScene *scene, const BpRenderOptions *options, size_t *size, uint64_t rays[2]) {
    BpRender *made = NULL;
    BpProgress progress = {0};
    const BpFilm *film = NULL;
    if (open_render_on_device(scene, options, &made, &err) != BP_OK) fail_msg("%s", err.message);
    while (!progress.finished)
        if (bp_render_step(made, &progress, &err) != BP_OK) fail_msg("%s", err.message);
    if (bp_render_read_film(made, &film, &err) != BP_OK) fail_msg("%s", err.message);
    assert_int_equal(film->invalid_samples, 0);
    const size_t cells = (size_t)film->width * film->height * film->replicates;
    const size_t sums = cells * 3 * sizeof *film->sums;
    *size = sums + (film->fine_sums != NULL ? sums : 0) + cells * sizeof *film->counts;
    rays[0] = film->segments;
    rays[1] = film->shadow_rays;
    char *copy = malloc(*size), *end = copy;
    assert_non_null(copy);
    memcpy(end, film->sums, sums);
    end += sums;
    if (film->fine_sums != NULL) {
        memcpy(end, film->fine_sums, sums);
        end += sums;
    }
    memcpy(end, film->counts, cells * sizeof *film->counts);
    bp_render_destroy(&made);
    return copy;
}

typedef struct Variation {
    const char *what;
    BpKernelForm kernel;
    bool list, tree;
    uint32_t tree_width, packet_lanes, local_size, chunk_samples;
} Variation;

static const Variation variations[] = {
    {.what = "a list, one path at a time", .kernel = BP_KERNEL_SAMPLE, .list = true},
    {.what = "a tree, one path at a time", .kernel = BP_KERNEL_SAMPLE, .tree = true},
    {.what = "a list, packets", .kernel = BP_KERNEL_PACKET, .list = true},
    {.what = "a tree, packets", .kernel = BP_KERNEL_PACKET, .tree = true},
    {.what = "two-wide nodes", .kernel = BP_KERNEL_SAMPLE, .tree = true, .tree_width = 2},
    {.what = "eight-wide nodes", .kernel = BP_KERNEL_SAMPLE, .tree = true, .tree_width = 8},
    {.what = "four-wide nodes, eight lanes",
     .kernel = BP_KERNEL_PACKET,
     .tree = true,
     .tree_width = 4,
     .packet_lanes = 8},
    {.what = "sixteen-wide nodes, sixteen lanes",
     .kernel = BP_KERNEL_PACKET,
     .tree = true,
     .tree_width = 16,
     .packet_lanes = 16},
    {.what = "a pool, a tree", .kernel = BP_KERNEL_POOL, .tree = true},
    {.what = "a pool, chunks of 7 samples", .kernel = BP_KERNEL_POOL, .chunk_samples = 7},
    {.what = "work-groups of 8", .kernel = BP_KERNEL_SAMPLE, .local_size = 8},
    {.what = "chunks of 7 samples", .kernel = BP_KERNEL_PACKET, .chunk_samples = 7},
};

/* The first `count` variations. */
static void check_scene(const char *name, size_t count) {
    BpScene *scene = load_scene(name, 24);
    BpRenderOptions options;
    bp_render_defaults(scene, &options);
    options.samples_per_pixel = 6;
    options.sampler = BP_SAMPLER_SOBOL;
    size_t size, other_size;
    uint64_t rays[2], other_rays[2];
    char *expected = render(scene, &options, &size, rays);
    assert_true(rays[1] > 0);
    for (size_t i = 0; i < count; ++i) {
        const Variation *v = &variations[i];
        BpRenderOptions varied = options;
        varied.kernel = v->kernel;
        varied.force_list = v->list;
        varied.force_tree = v->tree;
        varied.tree_width = v->tree_width;
        varied.packet_lanes = v->packet_lanes;
        varied.local_size = v->local_size;
        varied.chunk_samples = v->chunk_samples;
        char *found = render(scene, &varied, &other_size, other_rays);
        if (size != other_size || memcmp(expected, found, size) != 0)
            fail_msg("%s: another picture with %s", name, v->what);
        if (memcmp(rays, other_rays, sizeof rays) != 0) fail_msg("%s: other rays with %s", name, v->what);
        free(found);
    }
    /* The seed, and leaving the lamps to chance, do change it. */
    options.seed = 1;
    char *found = render(scene, &options, &other_size, other_rays);
    assert_true(size != other_size || memcmp(expected, found, size) != 0);
    free(found);
    options.seed = 0;
    options.light_sampling = BP_LIGHT_SAMPLING_OFF;
    found = render(scene, &options, &other_size, other_rays);
    assert_true(size != other_size || memcmp(expected, found, size) != 0);
    assert_int_equal(rays[0], other_rays[0]);
    assert_int_equal(other_rays[1], 0);
    free(found);
    free(expected);
    bp_scene_destroy(&scene);
}

static void a_few_lamps(void **state) {
    (void)state;
    check_scene("scenes/lamps.json", 4);
}

static void lamps_in_a_crowd(void **state) {
    (void)state;
    check_scene("tests/agree/scenes/crowd.json", sizeof variations / sizeof variations[0]);
}

static void discs_of_the_sky(void **state) {
    (void)state;
    check_scene("tests/agree/scenes/discs.json",
                4); /* widths are the tree's business, which knows no discs */
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_few_lamps), cmocka_unit_test(lamps_in_a_crowd),
                                       cmocka_unit_test(discs_of_the_sky)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
