/* test_caustic_bound.c: no sample is brighter than the film has room for, with rays by way of spheres.
 *
 * The film's scale follows from a bound on the radiance of one sample (film/film_scene.c). Four samples of a
 * pixel are four replicates of one, so the film's sums are those of single samples. */
#include "film/film.h"
#include "support/load_scene.h"
#include "support/open_render.h"
#include "support/unit_test.h"

#include <math.h>
#include <stdio.h>

static BpError err;

/* The brightest of the samples, over the bound. */
static double brightest(const BpScene *scene, uint64_t first) {
    BpRenderOptions options;
    BpRender *render = NULL;
    BpProgress progress = {0};
    const BpFilm *film = NULL;
    bp_render_defaults(scene, &options);
    options.caustics = BP_CAUSTICS_ON;
    options.sampler = BP_SAMPLER_INDEPENDENT;
    options.samples_per_pixel = 4;
    options.first_sample = first;
    if (open_render_on_device(scene, &options, &render, &err) != BP_OK) fail_msg("%s", err.message);
    while (!progress.finished)
        if (bp_render_step(render, &progress, &err) != BP_OK) fail_msg("%s", err.message);
    if (bp_render_read_film(render, &film, &err) != BP_OK) fail_msg("%s", err.message);
    assert_int_equal(film->invalid_samples, 0);
    assert_int_equal(film->replicates, 4);
    const double bound = bp_scene_radiance_bound(scene, options.max_depth, BP_LIGHT_SAMPLING_ON,
                                                 BP_CAUSTICS_ON, film->roulette);
    assert_int_equal(film->scale_log2, bp_film_scale(scene, options.max_depth, BP_LIGHT_SAMPLING_ON,
                                                     BP_CAUSTICS_ON, film->roulette));
    assert_true(ldexp(bound, film->scale_log2) <= 0x1p38);
    const size_t cells = (size_t)film->width * film->height * film->replicates;
    double most = 0;
    for (size_t i = 0; i < cells; ++i) {
        assert_int_equal(film->counts[i], 1);
        for (size_t c = 0; c < 3; ++c)
            most = fmax(most, ldexp((double)film->sums[3 * i + c], -film->scale_log2) / bound);
    }
    bp_render_destroy(&render);
    return most;
}

/* `least`: so bright is some sample at least, else there was nothing to see; where two balls may light each
 * other, the bound counts five rays more that no vertex gets all of. `limit`: so bright is none. */
static void check(const char *name, double least, double limit) {
    BpScene *scene = load_scene(name, 64);
    double most = 0;
    for (uint64_t i = 0; i < 24; ++i) most = fmax(most, brightest(scene, 4 * i));
    printf("%s: the brightest sample has %.6f of the bound\n", name, most);
    assert_true(most > least);
    assert_true(most <= limit);
    bp_scene_destroy(&scene);
}

static void lamps_as_large_as_they_may_be(void **state) {
    (void)state;
    check("tests/agree/scenes/caustics-glass.json", 0.05, 1);
    check("tests/agree/scenes/caustics-inside.json", 0.05, 1);
    check("tests/agree/scenes/caustics-mirror.json", 0.05, 1);
    check("tests/agree/scenes/caustics-sun.json", 0.03, 1);
}

/* A lamp fills little of what a surface sees, so that samples stay far below the bound, which knows no sizes;
 * a weight that is wrong would show many times more. Of the many lamps, the camera sees some. */
static void small_lamps(void **state) {
    (void)state;
    check("tests/unseen/scenes/lamp-0.03.json", 0.0003, 0.003);
    check("tests/unseen/scenes/lamps-many.json", 0.03, 1);
}

/* Each vertex may be lit by a ray to a lamp and by three by way of a sphere, each with half of its radiance;
 * the camera by nine, three for each of the chains through a sphere. */
static void every_ray_counts(void **state) {
    (void)state;
    BpScene *scene = load_scene("scenes/lamps.json", 64);
    const double lamp = 9, albedo = 0.9; /* the brightest of each */
    const uint32_t depths[] = {2, 3, 10, 50};
    for (size_t i = 0; i < sizeof depths / sizeof depths[0]; ++i) {
        double most = lamp + 9 * 0.5 * lamp, through = albedo;
        for (uint32_t vertex = 1; vertex < depths[i]; ++vertex, through *= albedo)
            most += (0.5 + 3 * 0.5) * lamp * through;
        const double bound =
            bp_scene_radiance_bound(scene, depths[i], BP_LIGHT_SAMPLING_ON, BP_CAUSTICS_ON, BP_ROULETTE_OFF);
        assert_true(bound >= most * (1 - 1e-12) && bound <= 2 * most);
    }
    bp_scene_destroy(&scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(lamps_as_large_as_they_may_be),
                                       cmocka_unit_test(small_lamps), cmocka_unit_test(every_ray_counts)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
