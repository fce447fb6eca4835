/* test_render_same.c: a picture depends on scene, seed and samples, and on nothing else.
 *
 * On the default device: chunks, work-group sizes, kernel forms, list or tree, tree widths, first samples and
 * repetition change no bit of the film; the seed changes it. With the argument `every`: nothing but every
 * work-group size, tree width and number of lanes, of which the rest has a few. */
#include "support/load_scene.h"
#include "support/open_render.h"
#include "support/unit_test.h"

#include <stdio.h>
#include <string.h>

static BpError err;

/* Renders and copies the film's sums and counts into a new one that the caller destroys. Without devices, on
 * the one that is open. */
static BpFilm *render_on(const BpScene *scene, const BpRenderOptions *options, const BpDeviceInfo *devices,
                         size_t device_count, uint64_t *segments) {
    BpRender *made = NULL;
    BpProgress progress = {0};
    const BpFilm *read = NULL;
    BpFilm *copy = NULL;
    const BpStatus created = device_count == 0
                                 ? open_render_on_device(scene, options, &made, &err)
                                 : bp_render_create(scene, options, devices, device_count, &made, &err);
    if (created != BP_OK) fail_msg("%s", err.message);
    do {
        if (bp_render_step(made, &progress, &err) != BP_OK) fail_msg("%s", err.message);
    } while (!progress.finished);
    if (bp_render_read_film(made, &read, &err) != BP_OK) fail_msg("%s", err.message);
    assert_int_equal(bp_film_create(read->width, read->height, read->replicates, &copy, &err), BP_OK);
    const size_t cells = (size_t)read->width * read->height * read->replicates;
    memcpy(copy->sums, read->sums, cells * 3 * sizeof *copy->sums);
    memcpy(copy->counts, read->counts, cells * sizeof *copy->counts);
    if (segments != NULL) *segments = read->segments;
    assert_int_equal(read->invalid_samples, 0);
    bp_render_destroy(&made);
    return copy;
}

static BpFilm *render(const BpScene *scene, const BpRenderOptions *options, uint64_t *segments) {
    return render_on(scene, options, NULL, 0, segments);
}

static bool same(const BpFilm *a, const BpFilm *b) {
    const size_t cells = (size_t)a->width * a->height * a->replicates;
    return memcmp(a->sums, b->sums, cells * 3 * sizeof *a->sums) == 0 &&
           memcmp(a->counts, b->counts, cells * sizeof *a->counts) == 0;
}

/* Renders `varied` and checks it against `expected`. */
static void check_same(const BpScene *scene, const BpRenderOptions *varied, const BpFilm *expected,
                       uint64_t expected_segments, const char *what) {
    uint64_t segments = 0;
    BpFilm *found = render(scene, varied, &segments);
    if (!same(expected, found)) fail_msg("another picture with %s", what);
    if (segments != expected_segments) fail_msg("other ray segments with %s", what);
    bp_film_destroy(&found);
}

/* The form of the kernel, the chunks, tree and list: cheap to vary, since little or nothing is compiled anew.
 * Destroys the scene. */
static void check_variations(BpScene *scene, BpSampler sampler) {
    BpRenderOptions options;
    bp_render_defaults(scene, &options);
    options.samples_per_pixel = 6;
    options.sampler = sampler;
    options.kernel = BP_KERNEL_SAMPLE;
    uint64_t segments = 0;
    BpFilm *expected = render(scene, &options, &segments);
    assert_true(segments >= (uint64_t)expected->width * expected->height * 6);

    check_same(scene, &options, expected, segments, "a second run");
    uint64_t anew_segments = 0;
    BpFilm *anew = render_on(scene, &options, &opened_device->info, 1, &anew_segments);
    if (!same(expected, anew) || anew_segments != segments)
        fail_msg("another picture on a device opened anew");
    bp_film_destroy(&anew);
    const BpKernelForm forms[] = {BP_KERNEL_SAMPLE, BP_KERNEL_PACKET, BP_KERNEL_POOL};
    const uint32_t chunks[] = {1, 7, 4096};
    for (size_t f = 0; f < sizeof forms / sizeof forms[0]; ++f) {
        BpRenderOptions varied = options;
        varied.kernel = forms[f];
        check_same(scene, &varied, expected, segments, "another form of the kernel");
        for (size_t i = 0; i < 3; ++i) {
            varied.chunk_samples = chunks[i];
            check_same(scene, &varied, expected, segments, "another chunk size");
        }
    }
    BpRenderOptions varied = options;
    varied.max_depth = 0;
    uint64_t none = 1;
    BpFilm *black = render(scene, &varied, &none);
    assert_int_equal(none, 0);
    for (size_t f = 1; f < sizeof forms / sizeof forms[0]; ++f) {
        varied.kernel = forms[f];
        check_same(scene, &varied, black, 0, "no segment at all");
    }
    bp_film_destroy(&black);
    varied = options;
    varied.force_list = true;
    check_same(scene, &varied, expected, segments, "a list");
    varied.force_list = false;
    varied.force_tree = true;
    varied.kernel = BP_KERNEL_PACKET;
    check_same(scene, &varied, expected, segments, "a tree");

    varied = options;
    varied.seed = 1;
    BpFilm *other = render(scene, &varied, NULL);
    assert_false(same(expected, other));
    bp_film_destroy(&other);
    varied.seed = (uint64_t)1 << 32; /* the upper half of the seed counts too */
    other = render(scene, &varied, NULL);
    assert_false(same(expected, other));
    bp_film_destroy(&other);
    bp_film_destroy(&expected);
    bp_scene_destroy(&scene);
}

/* Each of these is a kernel of its own, so they take turns between the forms, and a few stand for all.
 * Destroys the scene. */
static void check_widths(BpScene *scene, bool every) {
    BpRenderOptions options;
    bp_render_defaults(scene, &options);
    options.samples_per_pixel = 6;
    uint64_t segments = 0;
    BpFilm *expected = render(scene, &options, &segments);
    const struct {
        BpKernelForm form;
        uint32_t local_size, tree_width, packet_lanes;
        const char *what;
        bool is_quick;
    } variations[] = {{BP_KERNEL_SAMPLE, 1, 0, 0, "work-groups of 1", false},
                      {BP_KERNEL_SAMPLE, 8, 0, 0, "work-groups of 8", true},
                      {BP_KERNEL_SAMPLE, 64, 0, 0, "work-groups of 64", false},
                      {BP_KERNEL_POOL, 1, 0, 0, "pools of one work-item", false},
                      {BP_KERNEL_POOL, 8, 2, 0, "pools of 8, two-wide nodes", true},
                      {BP_KERNEL_POOL, 256, 0, 0, "pools of 256", false},
                      {BP_KERNEL_PACKET, 8, 0, 0, "packets in groups of 8", false},
                      {BP_KERNEL_PACKET, 64, 0, 0, "packets in groups of 64", true},
                      {BP_KERNEL_SAMPLE, 0, 2, 0, "two-wide nodes", true},
                      {BP_KERNEL_SAMPLE, 0, 8, 0, "eight-wide nodes", false},
                      {BP_KERNEL_PACKET, 0, 4, 8, "four-wide nodes, eight lanes", true},
                      {BP_KERNEL_PACKET, 0, 8, 16, "eight-wide nodes, sixteen lanes", false},
                      {BP_KERNEL_PACKET, 0, 16, 8, "sixteen-wide nodes, eight lanes", false},
                      {BP_KERNEL_PACKET, 0, 16, 16, "sixteen-wide nodes, sixteen lanes", true}};
    for (size_t i = 0; i < sizeof variations / sizeof variations[0]; ++i) {
        if (!every && !variations[i].is_quick) continue;
        BpRenderOptions varied = options;
        varied.kernel = variations[i].form;
        varied.local_size = variations[i].local_size;
        varied.tree_width = variations[i].tree_width;
        varied.packet_lanes = variations[i].packet_lanes;
        varied.force_tree = variations[i].tree_width != 0;
        check_same(scene, &varied, expected, segments, variations[i].what);
    }
    bp_film_destroy(&expected);
    bp_scene_destroy(&scene);
}

static void work_groups_and_widths_are_the_same(void **state) {
    /* Of its trees, the sixteen-wide one has one batch of leaves to be tried one by one, the eight-wide one
     * has three, and the narrower ones are walked. */
    check_widths(load_scene("scenes/cover.json", 24), *state != NULL);
}

/* Boxes in rows, of glass and matte, on a floor, before a mirror. Every third box stands in the place of the
 * one before, for ties, and is matte as that is. `mixed`: balls between them. */
static BpScene *triangles_scene(bool mixed) {
    enum { ROWS = 4, COLUMNS = 3, BYTES = 8192 };
    static char text[BYTES];
    BpScene *scene = NULL;
    size_t n = (size_t)snprintf(text, BYTES,
                                "{\"format\": 1, \"camera\": {\"image_width\": 24, \"aspect_ratio\": 1.5, "
                                "\"max_depth\": 20, \"vfov\": 50, "
                                "\"lookfrom\": [3, 3, 7], \"lookat\": [0, 0.3, 0]}, \"materials\": {"
                                "\"0\": {\"type\": \"dielectric\", \"refraction_index\": 1.5}, "
                                "\"1\": {\"type\": \"lambertian\", \"albedo\": [0.8, 0.4, 0.2]}, "
                                "\"2\": {\"type\": \"lambertian\", \"albedo\": [0.2, 0.4, 0.8]}, "
                                "\"mirror\": {\"type\": \"metal\", \"albedo\": [0.9, 0.9, 0.9]}}, "
                                "\"triangles\": [{\"vertices\": [[-3, 0, -3.5], [3, 0, -3.5], [0, 4, -3]], "
                                "\"material\": \"mirror\"}], "
                                "\"quads\": [{\"corner\": [-20, -0.01, 20], \"u\": [40, 0, 0], \"v\": [0, 0, "
                                "-40], \"material\": \"1\"}], "
                                "\"boxes\": [");
    for (int i = 0; i < ROWS * COLUMNS; ++i) {
        const int column = i % COLUMNS == 2 ? 1 : i % COLUMNS, row = i / COLUMNS;
        n += (size_t)snprintf(text + n, BYTES - n,
                              "%s{\"corners\": [[0, 0, 0], [0.8, 0.7, 0.6]], \"rotate\": [0, %d, 0], "
                              "\"translate\": [%d, 0, %d], \"material\": \"%d\"}",
                              i == 0 ? "" : ", ", 20 * row, 2 * column - 2, 2 * row - 5, i % COLUMNS);
    }
    n += (size_t)snprintf(text + n, BYTES - n, "]");
    for (int i = 0; mixed && i < ROWS * COLUMNS; ++i)
        n += (size_t)snprintf(
            text + n, BYTES - n, "%s{\"center\": [%g, 0.9, %d], \"radius\": 0.4, \"material\": \"%d\"}",
            i == 0 ? ", \"spheres\": [" : ", ", 1.3 * (i % COLUMNS) - 2, 2 * (i / COLUMNS) - 4, i % COLUMNS);
    n += (size_t)snprintf(text + n, BYTES - n, "%s}", mixed ? "]" : "");
    assert_true(n < BYTES);
    if (bp_scene_parse(text, n, "triangles.json", &scene, &err) != BP_OK) fail_msg("%s", err.message);
    return scene;
}

static void triangles_are_the_same(void **state) {
    (void)state;
    check_variations(triangles_scene(true), BP_SAMPLER_INDEPENDENT);
    check_variations(triangles_scene(false), BP_SAMPLER_SOBOL);
}

static void widths_of_triangles_are_the_same(void **state) {
    const bool every = *state != NULL;
    check_widths(triangles_scene(true), every);
    if (every) check_widths(triangles_scene(false), every);
}

static void cover_is_the_same(void **state) {
    (void)state;
    check_variations(load_scene("scenes/cover.json", 24), BP_SAMPLER_INDEPENDENT);
}

static void hollow_glass_is_the_same(void **state) {
    (void)state;
    check_variations(load_scene("scenes/v4-18-glass-hollow.json", 24), BP_SAMPLER_SOBOL);
}

/* Its tree is walked, sixteen wide. */
static void swarm_is_the_same(void **state) {
    (void)state;
    check_variations(load_scene("tests/agree/scenes/swarm.json", 16), BP_SAMPLER_INDEPENDENT);
}

/* Samples 0..9 equal samples 0..3 plus 4..9: what merging runs rests on. */
static void halves_add_up(void **state) {
    (void)state;
    BpScene *scene = load_scene("scenes/cover.json", 24);
    for (int sampler = 0; sampler < 2; ++sampler) {
        BpRenderOptions options;
        bp_render_defaults(scene, &options);
        options.sampler = sampler == 0 ? BP_SAMPLER_INDEPENDENT : BP_SAMPLER_SOBOL;
        options.samples_per_pixel = 10;
        BpFilm *whole = render(scene, &options, NULL);
        options.samples_per_pixel = 4;
        BpFilm *first = render(scene, &options, NULL);
        options.first_sample = 4;
        options.samples_per_pixel = 6;
        BpFilm *second = render(scene, &options, NULL);
        const size_t cells = (size_t)whole->width * whole->height * whole->replicates;
        for (size_t i = 0; i < cells * 3; ++i) first->sums[i] += second->sums[i];
        for (size_t i = 0; i < cells; ++i) first->counts[i] += second->counts[i];
        assert_true(same(whole, first));
        bp_film_destroy(&whole);
        bp_film_destroy(&first);
        bp_film_destroy(&second);
    }
    bp_scene_destroy(&scene);
}

/* A render that is extended equals one that asked for all samples at once. */
static void extension_adds_up(void **state) {
    (void)state;
    BpScene *scene = load_scene("scenes/cover.json", 24);
    BpRenderOptions options;
    bp_render_defaults(scene, &options);
    options.samples_per_pixel = 9;
    BpFilm *whole = render(scene, &options, NULL);
    options.samples_per_pixel = 2;
    BpRender *made = NULL;
    BpProgress progress = {0};
    const BpFilm *read = NULL;
    assert_int_equal(bp_render_create(scene, &options, NULL, 0, &made, &err), BP_OK);
    do assert_int_equal(bp_render_step(made, &progress, &err), BP_OK);
    while (!progress.finished);
    assert_int_equal(bp_render_read_film(made, &read, &err), BP_OK); /* a look in between changes nothing */
    assert_int_equal(bp_render_extend(made, 1, &err), BP_ERR_USAGE);
    assert_int_equal(bp_render_extend(made, 9, &err), BP_OK);
    do assert_int_equal(bp_render_step(made, &progress, &err), BP_OK);
    while (!progress.finished);
    assert_int_equal(bp_render_samples_done(made), 9);
    assert_int_equal(bp_render_read_film(made, &read, &err), BP_OK);
    assert_true(same(whole, read));
    bp_render_destroy(&made);
    bp_film_destroy(&whole);
    bp_scene_destroy(&scene);
}

/* Three workers share a picture; that all are on one device is nothing they know of. */
static void several_devices_are_the_same(void **state) {
    (void)state;
    BpScene *scene = load_scene("scenes/cover.json", 48);
    BpRenderOptions options;
    bp_render_defaults(scene, &options);
    options.samples_per_pixel = 20;
    uint64_t segments = 0, shared_segments = 0;
    BpFilm *alone = render(scene, &options, &segments);
    BpDeviceInfo devices[3];
    assert_int_equal(bp_device_find(NULL, &devices[0], &err), BP_OK);
    devices[1] = devices[2] = devices[0];
    options.chunk_samples = 500; /* enough chunks for all to get some */
    BpFilm *shared = render_on(scene, &options, devices, 3, &shared_segments);
    assert_true(same(alone, shared));
    assert_int_equal(segments, shared_segments);
    bp_film_destroy(&alone);
    bp_film_destroy(&shared);
    bp_scene_destroy(&scene);
}

/* Paths that the cap cuts are black for what they miss, and counted. */
static void depth_cap_is_black_and_counted(void **state) {
    (void)state;
    BpScene *scene = load_scene("scenes/v4-18-glass-hollow.json", 24);
    BpRenderOptions options;
    bp_render_defaults(scene, &options);
    options.samples_per_pixel = 8;
    double last = -1;
    const uint32_t depths[] = {0, 1, 3, 50};
    for (size_t i = 0; i < 4; ++i) {
        options.max_depth = depths[i];
        BpRender *made = NULL;
        BpProgress progress = {0};
        const BpFilm *read = NULL;
        double mean[3];
        assert_int_equal(bp_render_create(scene, &options, NULL, 0, &made, &err), BP_OK);
        do assert_int_equal(bp_render_step(made, &progress, &err), BP_OK);
        while (!progress.finished);
        assert_int_equal(bp_render_read_film(made, &read, &err), BP_OK);
        bp_film_mean(read, mean);
        const uint64_t samples = (uint64_t)read->width * read->height * 8;
        if (depths[i] == 0) {
            assert_true(mean[0] == 0 && mean[1] == 0 && mean[2] == 0);
            assert_int_equal(read->truncated_paths, samples);
            assert_int_equal(read->segments, 0);
        } else if (depths[i] == 1) {
            assert_int_equal(read->segments, samples);
            assert_true(read->truncated_paths > 0 && read->truncated_paths < samples);
        }
        assert_true(mean[2] > last);
        last = mean[2];
        bp_render_destroy(&made);
    }
    bp_scene_destroy(&scene);
}

int main(int argc, char **argv) {
    bool every = true;
    const struct CMUnitTest all[] = {cmocka_unit_test_prestate(work_groups_and_widths_are_the_same, &every),
                                     cmocka_unit_test_prestate(widths_of_triangles_are_the_same, &every)};
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cover_is_the_same),
        cmocka_unit_test(hollow_glass_is_the_same),
        cmocka_unit_test(swarm_is_the_same),
        cmocka_unit_test(triangles_are_the_same),
        cmocka_unit_test(work_groups_and_widths_are_the_same),
        cmocka_unit_test(widths_of_triangles_are_the_same),
        cmocka_unit_test(several_devices_are_the_same),
        cmocka_unit_test(halves_add_up),
        cmocka_unit_test(extension_adds_up),
        cmocka_unit_test(depth_cap_is_black_and_counted),
    };
    return argc > 1 && strcmp(argv[1], "every") == 0 ? cmocka_run_group_tests(all, NULL, NULL)
                                                     : cmocka_run_group_tests(tests, NULL, NULL);
}
