/* test_adaptive_unbiased.c: samples that go where the error is give the same picture with less noise, and say
 * so honestly.
 *
 * Over 48 seeds of three balls of metal and matte: no bias in any block, the claimed error is the actual one,
 * and both are below those of as many samples spread evenly. Where nothing is to be decided, the result is
 * the even one bit for bit; and neither chunks, the kernel's form nor the number of devices change a bit. */
#include "seeds.h"

#include <string.h>

#define SCENE "v4-13-metal"
#define SEEDS 48
#define WIDTH 48u
#define SAMPLES 64u
#define BLOCK 8u

static BpRender *open_adaptive(const BpScene *scene, const BpRenderOptions *wanted) {
    BpRenderOptions options = *wanted;
    BpRender *render = NULL;
    BpError err = {0};
    options.adaptive = true;
    must(open_render_on_device(scene, &options, &render, &err), &err);
    return render;
}

typedef struct Errors {
    double actual, claimed; /* mean squares over pixels and seeds */
} Errors;

static void add_errors(const BpFilm *film, const BpPicture *x, const BpPicture references[2],
                       Errors *errors) {
    const size_t pixels = (size_t)x->width * x->height;
    BpUnseenWeights weights;
    bp_unseen_weigh(film, &weights);
    for (size_t p = 0; p < pixels; p++) {
        const double y = luminance(x->rgb + 3 * p);
        errors->actual += (y - luminance(references[0].rgb + 3 * p)) *
                          (y - luminance(references[1].rgb + 3 * p)) / (double)pixels / SEEDS;
        errors->claimed += bp_film_squared_error(film, &weights, p) / (double)pixels / SEEDS;
    }
}

/* Adds luminances of blocks, less those of the even picture with the same seed: free of a reference's noise,
 * and of much of their own, as the two have samples in common. */
static void add_blocks(const BpPicture *x, const BpPicture *even, double *sum, double *square) {
    const uint32_t across = (x->width + BLOCK - 1) / BLOCK, down = (x->height + BLOCK - 1) / BLOCK;
    for (uint32_t b = 0; b < across * down; b++) {
        double difference = 0;
        for (uint32_t y = b / across * BLOCK; y < (b / across + 1) * BLOCK && y < x->height; y++)
            for (uint32_t i = b % across * BLOCK; i < (b % across + 1) * BLOCK && i < x->width; i++) {
                const size_t p = 3 * ((size_t)y * x->width + i);
                difference += luminance(x->rgb + p) - luminance(even->rgb + p);
            }
        sum[b] += difference;
        square[b] += difference * difference;
    }
}

static void honest_and_better(void **state) {
    (void)state;
    BpScene *scene = book_scene(SCENE, WIDTH);
    BpPicture references[2];
    for (uint64_t r = 0; r < 2; r++)
        references[r] = make_picture(scene, BP_SAMPLER_SOBOL, 1001 + r, 32 * SAMPLES);
    BpRenderOptions options;
    bp_render_defaults(scene, &options);
    options.sampler = BP_SAMPLER_SOBOL;
    options.samples_per_pixel = SAMPLES;
    Errors adaptive = {0}, even = {0};
    double sum[64] = {0}, square[64] = {0};
    BpError err = {0};
    for (options.seed = 0; options.seed < SEEDS; options.seed++) {
        BpPicture pictures[2];
        for (int a = 0; a < 2; a++) {
            BpRender *render = a == 1 ? open_adaptive(scene, &options)
                                      : open_render(scene, BP_SAMPLER_SOBOL, options.seed, SAMPLES);
            const BpFilm *film = finish_render(render);
            must(bp_film_picture(film, &pictures[a], &err), &err);
            add_errors(film, &pictures[a], references, a == 1 ? &adaptive : &even);
            bp_render_destroy(&render);
        }
        add_blocks(&pictures[1], &pictures[0], sum, square);
        for (int a = 0; a < 2; a++) bp_picture_clear(&pictures[a]);
    }
    const uint32_t blocks =
        (references[0].width + BLOCK - 1) / BLOCK * ((references[0].height + BLOCK - 1) / BLOCK);
    assert_in_range(blocks, 4, 64);
    double worst = 0, all = 0, all_square = 0;
    for (uint32_t b = 0; b < blocks; b++) {
        const double mean = sum[b] / SEEDS, variance = (square[b] / SEEDS - mean * mean) / (SEEDS - 1);
        worst = fmax(worst, fabs(mean) / sqrt(variance));
        all += mean;
        all_square += variance;
    }
    print_message(
        SCENE
        ", %u samples per pixel: actual over claimed error %.3f; variance of even sampling over that of "
        "adaptive %.2f; bias of the picture %.1f standard errors, of the worst of %u blocks %.1f\n",
        SAMPLES, sqrt(adaptive.actual / adaptive.claimed), even.actual / adaptive.actual,
        all / sqrt(all_square), blocks, worst);
    assert_true(fabs(sqrt(adaptive.actual / adaptive.claimed) - 1) < 0.1);
    assert_true(1.1 * adaptive.actual < even.actual);
    assert_true(fabs(all) < 4.5 * sqrt(all_square));
    assert_true(worst < 4.5);
    for (int r = 0; r < 2; r++) bp_picture_clear(&references[r]);
    bp_scene_destroy(&scene);
}

static void assert_same_sums(BpRender *one, BpRender *other) {
    const BpFilm *a = finish_render(one), *b = finish_render(other);
    const size_t cells = (size_t)a->width * a->height * a->replicates;
    assert_memory_equal(a->sums, b->sums, cells * 3 * sizeof *a->sums);
    assert_memory_equal(a->counts, b->counts, cells * sizeof *a->counts);
    assert_int_equal(a->range_count, b->range_count);
    assert_memory_equal(a->ranges, b->ranges, a->range_count * sizeof *a->ranges);
    assert_int_equal(a->partial, b->partial);
    assert_true(a->segments == b->segments);
    bp_render_destroy(&one);
    bp_render_destroy(&other);
}

static void arrangement_changes_nothing(void **state) {
    (void)state;
    BpScene *scene = book_scene(SCENE, WIDTH);
    BpRenderOptions options;
    bp_render_defaults(scene, &options);
    options.samples_per_pixel = 70;
    BpRenderOptions other = options;
    other.chunk_samples = 777;
    assert_same_sums(open_adaptive(scene, &options), open_adaptive(scene, &other));
    options.kernel = BP_KERNEL_SAMPLE;
    other = options;
    other.kernel = BP_KERNEL_PACKET;
    assert_same_sums(open_adaptive(scene, &options), open_adaptive(scene, &other));

    BpDeviceInfo devices[2]; /* one device twice is two to the render */
    BpRender *both = NULL;
    BpError err = {0};
    must(bp_device_find(NULL, &devices[0], &err), &err);
    devices[1] = devices[0];
    other.adaptive = true;
    other.chunk_samples = 3000;
    must(bp_render_create(scene, &other, devices, 2, &both, &err), &err);
    assert_same_sums(open_adaptive(scene, &options), both);
    bp_scene_destroy(&scene);
}

/* A black picture has equal errors everywhere: every pixel gets the mean, as in an even render. */
static void equal_errors_are_even(void **state) {
    (void)state;
    BpScene *scene = book_scene(SCENE, WIDTH);
    BpRenderOptions options;
    for (int c = 0; c < 3; c++) scene->background_bottom[c] = scene->background_top[c] = 0;
    bp_render_defaults(scene, &options);
    options.samples_per_pixel = 64;
    assert_same_sums(open_adaptive(scene, &options), open_render(scene, options.sampler, options.seed, 64));
    bp_scene_destroy(&scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(honest_and_better),
        cmocka_unit_test(arrangement_changes_nothing),
        cmocka_unit_test(equal_errors_are_even),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
