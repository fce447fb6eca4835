/* test_effects_builds.c: only another set of effects or another acceleration builds another kernel; values,
 * camera, size, seed and samples build nothing.
 *
 * Counted are the programs (equal keys: the same source and options) and, on PoCL, what its compiler leaves
 * in an empty cache. */
#include "effects_scenes.h"
#include "render/render.h"

#include <ftw.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static unsigned compiled; /* for nftw, which hands nothing through */

static int count_compiled(const char *path, const struct stat *about, int type, struct FTW *where) {
    (void)about, (void)where;
    const size_t length = strlen(path);
    if (type == FTW_F && length > 3 && strcmp(path + length - 3, ".so") == 0) ++compiled;
    return 0;
}

static unsigned count_in_cache(void) {
    compiled = 0;
    nftw(getenv("POCL_CACHE_DIR"), count_compiled, 16, FTW_PHYS);
    return compiled;
}

/* Renders all of it; the program's key. */
static uint64_t render(const BpScene *scene, const BpDeviceInfo *device, const BpRenderOptions *options) {
    BpRender *made = NULL;
    BpError err = {0};
    BpProgress progress = {0};
    BpRenderReport report;
    if (bp_render_create(scene, options, device, 1, &made, &err) != BP_OK) fail_msg("%s", err.message);
    do {
        if (bp_render_step(made, &progress, &err) != BP_OK) fail_msg("%s", err.message);
    } while (!progress.finished);
    bp_render_report(made, &report);
    bp_render_destroy(&made);
    return report.program_key;
}

typedef void Change(EffectsScene *made, BpRenderOptions *options);

static void colours(EffectsScene *made, BpRenderOptions *options) {
    (void)options;
    for (size_t m = 0; m < made->scene.material_count; ++m) made->materials[m].albedo[1] *= 0.5;
    made->scene.background_top[0] = 0.25;
}
static void kinds_of_scatter(EffectsScene *made, BpRenderOptions *options) {
    (void)options;
    for (size_t m = 0; m < made->scene.material_count; ++m) {
        BpMaterial *material = &made->materials[m];
        material->scatter = BP_SCATTER_HEMISPHERE;
        material->fuzz = 0.9;
        material->fuzz_shape = BP_FUZZ_BALL;
        material->refraction_index = 2.4;
        material->fresnel = BP_FRESNEL_EXACT;
        material->total_reflection = BP_TOTAL_ABSORB;
    }
}
static void camera(EffectsScene *made, BpRenderOptions *options) {
    (void)options;
    BpCamera *view = &made->scene.camera;
    view->lookfrom[0] = 1, view->lookfrom[1] = 2, view->lookfrom[2] = 3;
    view->vfov_degrees = 20;
    view->lens_radius = 0.5;
    view->focus_dist = 7;
    view->pixel_sampling = view->pixel_sampling == BP_PIXEL_SQUARE ? BP_PIXEL_CENTER : BP_PIXEL_SQUARE;
}
static void size(EffectsScene *made, BpRenderOptions *options) {
    (void)options;
    made->scene.camera.width = 57;
    made->scene.camera.height = 33;
}
static void spheres(EffectsScene *made, BpRenderOptions *options) {
    (void)options;
    made->scene.sphere_count -= 3;
    made->spheres[1].radius = 0.01;
    made->spheres[2].center[0] = 1000;
}
static void seed_and_samples(EffectsScene *made, BpRenderOptions *options) {
    (void)made;
    options->seed = 0x123456789abcdef0u;
    options->samples_per_pixel = 3;
    options->first_sample = 1000;
    options->replicates = 2;
}
static void depth(EffectsScene *made, BpRenderOptions *options) {
    (void)made;
    options->max_depth = 3;
}

static void constant_sky(EffectsScene *made, BpRenderOptions *options) {
    (void)options;
    BpScene *scene = &made->scene;
    memcpy(scene->background_top, scene->background_bottom, sizeof scene->background_top);
}

static void without_lens(EffectsScene *made, BpRenderOptions *options) {
    (void)options;
    made->scene.camera.lens_radius = 0;
}
static void without_metal(EffectsScene *made, BpRenderOptions *options) {
    (void)options;
    for (size_t i = 0; i < made->scene.sphere_count; ++i)
        if (made->materials[made->spheres[i].material].kind == BP_MATERIAL_METAL)
            made->spheres[i].material = 0;
}

static void without_discs(EffectsScene *made, BpRenderOptions *options) {
    (void)options;
    made->scene.disc_count = 0;
}
static void other_discs(EffectsScene *made, BpRenderOptions *options) {
    (void)options;
    made->scene.disc_count = 1;
    made->scene.discs[0].direction[0] = -1;
    made->scene.discs[0].half_angle_degrees = 45;
    made->scene.discs[0].visible_to_camera = false;
}

static void a_list(EffectsScene *made, BpRenderOptions *options) {
    (void)made;
    options->force_list = true;
}

static void only_other_effects_build(void **state) {
    const BpDeviceInfo *device = *state;
    static const struct {
        const char *name;
        Change *change;
        bool builds;
    } changes[] = {
        {"colours", colours, false},
        {"kinds of scatter", kinds_of_scatter, false},
        {"camera", camera, false},
        {"size", size, false},
        {"spheres", spheres, false},
        {"seed and samples", seed_and_samples, false},
        {"depth", depth, false},
        {"constant sky", constant_sky, false},
        {"without lens", without_lens, true},
        {"without metal", without_metal, true},
        {"a list", a_list, true},
        {"other discs", other_discs, false},
        {"without discs", without_discs, true},
    };
    const bool pocl = strcmp(device->platform, "Portable Computing Language") == 0;
    const uint32_t bits = EFFECT_BIT(LAMBERTIAN) | EFFECT_BIT(METAL) | EFFECT_BIT(DIELECTRIC) |
                          EFFECT_BIT(EMISSION) | EFFECT_BIT(LENS) | EFFECT_BIT(DISCS);
    static EffectsScene made;
    BpRenderOptions options;
    effects_scene(&made, bits, true);
    bp_render_defaults(&made.scene, &options);
    const uint64_t key = render(&made.scene, device, &options);
    unsigned in_cache = count_in_cache();
    if (pocl) assert_true(in_cache > 0); /* the cache is looked at where the compiler leaves its work */
    for (size_t i = 0; i < sizeof changes / sizeof changes[0]; ++i) {
        effects_scene(&made, bits, true);
        bp_render_defaults(&made.scene, &options);
        changes[i].change(&made, &options);
        const uint64_t other = render(&made.scene, device, &options);
        if ((other != key) != changes[i].builds)
            fail_msg("%s: %s program", changes[i].name, changes[i].builds ? "the same" : "another");
        const unsigned now = count_in_cache();
        if (pocl && (now != in_cache) != changes[i].builds)
            fail_msg("%s: %u kernels were compiled", changes[i].name, now - in_cache);
        in_cache = now;
    }
}

static int remove_entry(const char *path, const struct stat *about, int type, struct FTW *where) {
    (void)about, (void)type, (void)where;
    return remove(path);
}

int main(void) {
    BpDeviceInfo device;
    BpError err = {0};
    char cache[] = "/tmp/ballpark-builds-XXXXXX";
    /* Before the driver is loaded: it reads this once. */
    if (mkdtemp(cache) == NULL || setenv("POCL_CACHE_DIR", cache, 1) != 0) return 1;
    int failed = 77;
    if (bp_device_find(getenv("BALLPARK_TEST_DEVICE"), &device, &err) == BP_OK) {
        const struct CMUnitTest tests[] = {cmocka_unit_test_prestate(only_other_effects_build, &device)};
        failed = cmocka_run_group_tests(tests, NULL, NULL);
    } else {
        fprintf(stderr, "skipped: %s\n", err.message);
    }
    nftw(cache, remove_entry, 16, FTW_DEPTH | FTW_PHYS);
    return failed;
}
