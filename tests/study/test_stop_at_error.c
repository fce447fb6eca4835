/* test_stop_at_error.c: a render that is told to stop at an error stops there, over 64 seeds, without bias.
 *
 * The root mean square over seeds of the true NRMSE lies between 0.90 and 1.05 of the target, or every render
 * stopped at the minimum count; the count foretold at a tenth of the way or later lies within 25 % of the
 * actual one; the mean over all seeds of the picture's brightness is that of the reference. */
#include "seeds.h"

#include "render/stop_rule.h"

#define SEEDS 64
#define TARGET 0.01
#define SCENE "cover"
#ifdef NIGHTLY
#define WIDTH 48u
#define REFERENCE_SAMPLES (1u << 17)
#else
#define WIDTH 18u
#define REFERENCE_SAMPLES (1u << 15)
#endif

typedef struct Case {
    BpScene *scene;
    BpPicture references[2];
} Case;

typedef struct Stopped {
    BpPicture picture;
    double samples;
    double foretold; /* the first guess from a tenth of the way or later, over the actual count; 0: none */
} Stopped;

static void render_until(const BpScene *scene, const BpStopRule *rule, BpSampler sampler, uint64_t seed,
                         Stopped *stopped) {
    BpRenderOptions options;
    BpRender *render = NULL;
    BpStopState state = {.samples = bp_stop_first(rule)};
    double at[64], guess[64];
    int looks = 0;
    BpError err = {0};
    bp_render_defaults(scene, &options);
    options.sampler = sampler;
    options.seed = seed;
    options.samples_per_pixel = bp_stop_first(rule);
    options.adaptive = rule->adaptive;
    must(open_render_on_device(scene, &options, &render, &err), &err);
    for (;;) {
        const BpFilm *film = finish_render(render);
        uint64_t next = 0;
        state.nrmse = bp_film_nrmse(film);
        const BpStopReason reason = bp_stop_decide(rule, &state, &next);
        if (reason != BP_STOP_NOT_YET) {
            assert_int_equal(reason, BP_STOP_ERROR);
            must(bp_film_picture(film, &stopped->picture, &err), &err);
            break;
        }
        assert_true(looks < 64);
        at[looks] = (double)state.samples;
        guess[looks++] = bp_stop_expected(rule, &state);
        must(bp_render_extend(render, next, &err), &err);
        state.samples = next;
    }
    stopped->samples = (double)state.samples;
    stopped->foretold = 0;
    for (int i = looks - 1; i >= 0; i--)
        if (at[i] >= 0.1 * stopped->samples) stopped->foretold = guess[i] / stopped->samples;
    bp_render_destroy(&render);
}

static void check_sampler(const Case *test, BpSampler sampler, bool adaptive) {
    const BpScene *scene = test->scene;
    const BpPicture r1 = test->references[0], r2 = test->references[1];
    const size_t pixels = (size_t)r1.width * r1.height;
    BpStopRule rule;
    bp_stop_rule_init(&rule, TARGET, 0, 1u << 24, pixels);
    rule.adaptive = adaptive;
    double truth = 0, square = 0, mean = 0, mean_square = 0, samples = 0, foretold_worst = 0;
    int at_minimum = 0, foretold = 0, missed = 0;
    for (size_t p = 0; p < pixels; p++)
        truth += 0.5 * (luminance(r1.rgb + 3 * p) + luminance(r2.rgb + 3 * p)) / (double)pixels;
    for (int s = 0; s < SEEDS; s++) {
        Stopped stopped;
        render_until(scene, &rule, sampler, (uint64_t)s, &stopped);
        double brightness = 0, error = 0;
        for (size_t p = 0; p < pixels; p++) {
            const double y = luminance(stopped.picture.rgb + 3 * p);
            brightness += y / (double)pixels;
            error += (y - luminance(r1.rgb + 3 * p)) * (y - luminance(r2.rgb + 3 * p)) / (double)pixels;
        }
        square += error / (truth * truth) / SEEDS;
        mean += brightness / SEEDS;
        mean_square += brightness * brightness / SEEDS;
        samples += stopped.samples / SEEDS;
        at_minimum += stopped.samples <= (double)bp_stop_first(&rule);
        if (stopped.foretold > 0) {
            foretold++;
            missed += fabs(stopped.foretold - 1) > 0.25;
            foretold_worst = fmax(foretold_worst, fabs(stopped.foretold - 1));
        }
        bp_picture_clear(&stopped.picture);
    }
    const double nrmse = sqrt(square), standard = sqrt((mean_square - mean * mean) / (SEEDS - 1));
    const double z = (mean - truth) / standard;
    print_message(
        "%s, %s: told %.1f %%, true RMS %.3f %%, after %.0f samples per pixel on average, %d of %d at the "
        "minimum; foretold within %.0f %% (%d looks); brightness off by %.1f standard errors of %.4f %%\n",
        SCENE,
        adaptive                      ? "adaptive"
        : sampler == BP_SAMPLER_SOBOL ? "sobol"
                                      : "independent",
        100 * TARGET, 100 * nrmse, samples, at_minimum, SEEDS, 100 * foretold_worst, foretold, z,
        100 * standard / truth);
    /* Adaptive sampling doubles whole tiles, of which so small a picture has two: its steps are coarse. */
    if (at_minimum < SEEDS) assert_true(nrmse >= (adaptive ? 0.80 : 0.90) * TARGET);
    assert_true(nrmse <= 1.05 * TARGET);
    assert_true(20 * missed <= foretold);
    assert_true(fabs(z) <= 4.5);
}

static void test_independent(void **state) {
    check_sampler(*state, BP_SAMPLER_INDEPENDENT, false);
}

static void test_sobol(void **state) {
    check_sampler(*state, BP_SAMPLER_SOBOL, false);
}

static void test_adaptive(void **state) {
    check_sampler(*state, BP_SAMPLER_SOBOL, true);
}

static int set_up(void **state) {
    static Case test;
    test.scene = book_scene(SCENE, WIDTH);
    for (uint64_t r = 0; r < 2; r++)
        test.references[r] = make_picture(test.scene, BP_SAMPLER_SOBOL, 1001 + r, REFERENCE_SAMPLES);
    *state = &test;
    return 0;
}

static int tear_down(void **state) {
    Case *test = *state;
    for (int r = 0; r < 2; r++) bp_picture_clear(&test->references[r]);
    bp_scene_destroy(&test->scene);
    return 0;
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_independent),
        cmocka_unit_test(test_sobol),
        cmocka_unit_test(test_adaptive),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
