/* test_pilot_same.c: what a pilot finds depends on the scene and its camera, and on nothing else.
 *
 * On the default device: seeds, samples, chunks, work-group sizes, kernel forms, list or tree, tree widths
 * and numbers of lanes change no bit of the unseen light of a film; the scene and the depth of paths do. */
#include "support/load_scene.h"
#include "support/open_render.h"
#include "support/unit_test.h"

#include <math.h>
#include <string.h>

static BpError err;

typedef struct Found {
    BpUnseen *unseen; /* NULL: none */
    BpUnseenLight light;
    double nrmse;
    size_t pixels;
} Found;

static Found find(const BpScene *scene, const BpRenderOptions *options) {
    BpRender *made = NULL;
    BpProgress progress = {0};
    const BpFilm *read = NULL;
    Found found = {0};
    if (open_render_on_device(scene, options, &made, &err) != BP_OK) fail_msg("%s", err.message);
    do {
        if (bp_render_step(made, &progress, &err) != BP_OK) fail_msg("%s", err.message);
    } while (!progress.finished);
    if (bp_render_read_film(made, &read, &err) != BP_OK) fail_msg("%s", err.message);
    if (bp_render_unseen(made, &found.light, &err) != BP_OK) fail_msg("%s", err.message);
    found.pixels = (size_t)read->width * read->height;
    found.nrmse = bp_film_nrmse(read);
    if (read->unseen != NULL)
        assert_int_equal(bp_unseen_copy(read->unseen, found.pixels, &found.unseen, &err), BP_OK);
    bp_render_destroy(&made);
    return found;
}

static bool same(const Found *a, const Found *b) {
    if (a->unseen == NULL || b->unseen == NULL) return a->unseen == b->unseen;
    BpUnseenLight one = a->light, other = b->light;
    one.seconds = other.seconds = 0;
    return memcmp(a->unseen->pixels, b->unseen->pixels, a->pixels * sizeof *a->unseen->pixels) == 0 &&
           memcmp(a->unseen->tint, b->unseen->tint, sizeof a->unseen->tint) == 0 && one.mean == other.mean &&
           one.square == other.square && one.found == other.found && one.direct == other.direct &&
           one.triangles == other.triangles && one.triangle_material == other.triangle_material &&
           one.sphere_count == other.sphere_count &&
           memcmp(one.spheres, other.spheres, one.sphere_count * sizeof *one.spheres) == 0 &&
           memcmp(one.parts, other.parts, one.sphere_count * sizeof *one.parts) == 0;
}

static void check_same(const BpScene *scene, const BpRenderOptions *varied, const Found *expected,
                       bool same_samples, const char *what) {
    Found found = find(scene, varied);
    if (!same(expected, &found)) fail_msg("another pilot with %s", what);
    if (same_samples && !(found.nrmse == expected->nrmse)) fail_msg("another claim with %s", what);
    bp_unseen_destroy(&found.unseen);
}

static void forms_are_the_same(void **state) {
    const bool every = *state != NULL;
    static const char *const names[] = {"sun-0.27", "bulb-off-centre", "lamp-seen", "moving", "triangles"};
    const size_t count = every ? sizeof names / sizeof names[0] : 1;
    for (size_t i = 0; i < count; ++i) {
        char path[128];
        snprintf(path, sizeof path, "tests/unseen/scenes/%s.json", names[i]);
        BpScene *scene = load_scene(path, 32);
        BpRenderOptions options;
        bp_render_defaults(scene, &options);
        options.samples_per_pixel = 8;
        options.kernel = BP_KERNEL_SAMPLE;
        options.caustics = BP_CAUSTICS_OFF;
        Found expected = find(scene, &options);
        assert_non_null(expected.unseen);
        assert_true(expected.light.mean > 0 && expected.light.square > 0 && expected.nrmse > 0);
        double mean = 0, square = 0;
        for (size_t k = 0; k < expected.pixels; ++k) {
            mean += (double)expected.unseen->pixels[k].mean / (double)expected.pixels;
            square += (double)expected.unseen->pixels[k].square / (double)expected.pixels;
        }
        assert_true(fabs(mean / expected.light.mean - 1) < 1e-5 &&
                    fabs(square / expected.light.square - 1) < 1e-5);
        check_same(scene, &options, &expected, true, "a second run");
        BpRenderOptions varied = options;
        varied.seed = 12345;
        check_same(scene, &varied, &expected, false, "another seed");
        varied = options;
        varied.samples_per_pixel = 3;
        varied.first_sample = 100;
        check_same(scene, &varied, &expected, false, "other samples");
        varied = options;
        varied.chunk_samples = 5;
        check_same(scene, &varied, &expected, true, "small chunks");
        varied = options;
        varied.adaptive = true;
        varied.samples_per_pixel = 64;
        check_same(scene, &varied, &expected, false, "adaptive sampling");
        const struct {
            BpKernelForm form;
            uint32_t local_size, tree_width, packet_lanes;
            bool force_tree, is_quick;
            const char *what;
        } variations[] = {{BP_KERNEL_PACKET, 0, 0, 0, false, true, "packets"},
                          {BP_KERNEL_PACKET, 0, 0, 8, false, false, "packets of 8 lanes"},
                          {BP_KERNEL_PACKET, 0, 0, 16, true, true, "packets of 16 lanes in a tree"},
                          {BP_KERNEL_POOL, 0, 0, 0, false, true, "a pool"},
                          {BP_KERNEL_SAMPLE, 1, 0, 0, false, false, "work-groups of 1"},
                          {BP_KERNEL_SAMPLE, 16, 2, 0, true, false, "a tree of width 2"},
                          {BP_KERNEL_POOL, 0, 4, 0, true, false, "a tree of width 4"},
                          {BP_KERNEL_PACKET, 0, 8, 0, true, false, "a tree of width 8"},
                          {BP_KERNEL_SAMPLE, 0, 16, 0, true, true, "a tree of width 16"}};
        for (size_t v = 0; v < sizeof variations / sizeof variations[0]; ++v) {
            if (!every && !variations[v].is_quick) continue;
            varied = options;
            varied.kernel = variations[v].form;
            varied.local_size = variations[v].local_size;
            varied.tree_width = variations[v].tree_width;
            varied.packet_lanes = variations[v].packet_lanes;
            varied.force_tree = variations[v].force_tree;
            check_same(scene, &varied, &expected, true, variations[v].what);
        }
        if (every) { /* rounds otherwise, by a unit in the last place here and there */
            varied = options;
            varied.force_float_refine = true;
            Found found = find(scene, &varied);
            assert_non_null(found.unseen);
            if (!(fabs(found.light.mean / expected.light.mean - 1) < 0.01 &&
                  fabs(found.light.square / expected.light.square - 1) < 0.05))
                fail_msg("%s: another pilot with refinement in float: mean %g and %g, square %g and %g",
                         names[i], expected.light.mean, found.light.mean, expected.light.square,
                         found.light.square);
            bp_unseen_destroy(&found.unseen);
        }
        bp_unseen_destroy(&expected.unseen);
        bp_scene_destroy(&scene);
    }
}

/* A lamp, a mirror, a floor: a path that finds the light has three segments, and one that sees the lamp in
 * the mirror two. With light sampling off, all is found by chance, and nothing is said of it. */
static void depth_and_lamps(void **state) {
    (void)state;
    BpScene *scene = load_scene("tests/unseen/scenes/sun-0.27.json", 32);
    BpRenderOptions options;
    bp_render_defaults(scene, &options);
    options.samples_per_pixel = 4;
    options.caustics = BP_CAUSTICS_OFF;
    double means[6];
    for (uint32_t depth = 0; depth < 6; ++depth) {
        options.max_depth = depth;
        Found found = find(scene, &options);
        means[depth] = found.light.mean;
        assert_int_equal(found.unseen != NULL, found.light.mean > 0);
        bp_unseen_destroy(&found.unseen);
    }
    /* Nothing is seen by paths of no segment, nor by one: the sun itself is not in the picture. */
    assert_true(means[0] <= 0 && means[1] <= 0 && means[2] > 0); /* the sun in the mirror */
    assert_true(means[3] > means[2] * 1.1);                      /* from the floor by the mirror */
    assert_true(means[4] > means[3] * 1.2);                      /* from the floor through the glass */
    assert_true(means[5] >= means[4]);
    options.max_depth = 20;
    options.light_sampling = BP_LIGHT_SAMPLING_OFF;
    Found off = find(scene, &options);
    assert_null(off.unseen);
    assert_true(off.light.mean <= 0 && off.light.square <= 0);
    bp_scene_destroy(&scene);
}

/* Wider pictures see the same light, whatever squares of pixels camera paths stand for: within what chance
 * does to a pilot, some 15 %. */
static void sizes_of_pictures(void **state) {
    (void)state;
    static const uint32_t widths[] = {32, 128, 300, 1000};
    double means[4] = {0}, squares[4] = {0};
    for (size_t i = 0; i < 4; ++i) {
        BpScene *scene = load_scene("tests/unseen/scenes/lamp-0.1.json", widths[i]);
        BpRenderOptions options;
        bp_render_defaults(scene, &options);
        options.samples_per_pixel = 2;
        options.caustics = BP_CAUSTICS_OFF;
        Found found = find(scene, &options);
        assert_non_null(found.unseen);
        means[i] = found.light.mean;
        squares[i] = found.light.square;
        bp_unseen_destroy(&found.unseen);
        bp_scene_destroy(&scene);
    }
    for (size_t i = 1; i < 4; ++i)
        if (!(fabs(means[i] / means[0] - 1) < 0.3 && fabs(squares[i] / squares[0] - 1) < 0.4))
            fail_msg("width %u: a mean of %g, not %g; square %g, not %g", widths[i], means[i], means[0],
                     squares[i], squares[0]);
}

int main(int argc, char **argv) {
    void *every = argc > 1 ? argv[1] : NULL;
    const struct CMUnitTest few[] = {
        cmocka_unit_test(forms_are_the_same),
        cmocka_unit_test(depth_and_lamps),
        cmocka_unit_test(sizes_of_pictures),
    };
    const struct CMUnitTest all[] = {cmocka_unit_test_prestate(forms_are_the_same, every)};
    return every != NULL ? cmocka_run_group_tests(all, NULL, NULL) : cmocka_run_group_tests(few, NULL, NULL);
}
