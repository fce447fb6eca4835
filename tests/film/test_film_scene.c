/* test_film_scene.c: the scale and the hash follow what a scene means (host/film/film.h). */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "film/film.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A scene with one sphere of every kind, built by hand; free its arrays with free_scene(). */
static BpScene make_scene(void) {
    static const BpMaterial materials[] = {
        {.name = NULL, .kind = BP_MATERIAL_LAMBERTIAN, .albedo = {0.5, 0.25, 0.75}},
        {.kind = BP_MATERIAL_METAL, .albedo = {0.8, 0.8, 0.8}, .fuzz = 0.25},
        {.kind = BP_MATERIAL_DIELECTRIC, .refraction_index = 1.5},
        {.kind = BP_MATERIAL_DIFFUSE_LIGHT, .emit = {4, 2, 1}},
        {.kind = BP_MATERIAL_NORMALS},
        {.kind = BP_MATERIAL_LAMBERTIAN, .albedo = {0.1, 0.1, 0.1}}, /* not in use */
    };
    BpScene scene = {.title = NULL,
                     .camera = {.width = 40,
                                .height = 30,
                                .aspect_ratio = 4.0 / 3,
                                .vfov_degrees = 90,
                                .lookat = {0, 0, -1},
                                .vup = {0, 1, 0},
                                .focus_dist = 10,
                                .max_depth = 10,
                                .samples_per_pixel = 10},
                     .background_bottom = {1, 1, 1},
                     .background_top = {0.5, 0.7, 1},
                     .material_count = 6,
                     .sphere_count = 6,
                     .albedo_count = 2};
    scene.materials = malloc(sizeof materials);
    memcpy(scene.materials, materials, sizeof materials);
    scene.spheres = calloc(6, sizeof *scene.spheres);
    scene.albedos = calloc(2, sizeof *scene.albedos);
    scene.albedos[1][1] = 0.625f;
    for (uint32_t i = 0; i < 6; i++)
        scene.spheres[i] = (BpSphere){{i, 0, -2}, 0.5, i < 5 ? i : 0, i < 5 ? BP_NO_ALBEDO : 1};
    return scene;
}

static void free_scene(BpScene *scene) {
    free(scene->materials);
    free(scene->spheres);
    free(scene->albedos);
}

static void bound_and_scale(void **state) {
    (void)state;
    BpScene scene = make_scene();
    assert_true(
        fabs(bp_scene_radiance_bound(&scene, 50, BP_LIGHT_SAMPLING_OFF, BP_CAUSTICS_OFF, BP_ROULETTE_OFF) -
             4) <= 0);
    assert_int_equal(bp_film_scale(&scene, 50, BP_LIGHT_SAMPLING_OFF, BP_CAUSTICS_OFF, BP_ROULETTE_OFF), 36);
    scene.materials[3].emit[0] = 4.5; /* past a power of two, the next one */
    assert_int_equal(bp_film_scale(&scene, 50, BP_LIGHT_SAMPLING_OFF, BP_CAUSTICS_OFF, BP_ROULETTE_OFF), 35);
    scene.materials[3].emit[0] = 0.5; /* now the lamp's green */
    assert_int_equal(bp_film_scale(&scene, 50, BP_LIGHT_SAMPLING_OFF, BP_CAUSTICS_OFF, BP_ROULETTE_OFF), 37);
    scene.materials[3] = scene.materials[4];
    assert_int_equal(bp_film_scale(&scene, 50, BP_LIGHT_SAMPLING_OFF, BP_CAUSTICS_OFF, BP_ROULETTE_OFF),
                     38); /* sky and normals: 1 */
    scene.background_bottom[2] = 3;
    assert_int_equal(bp_film_scale(&scene, 50, BP_LIGHT_SAMPLING_OFF, BP_CAUSTICS_OFF, BP_ROULETTE_OFF), 36);
    free_scene(&scene);
}

static BpDisc disc(double x, double y, double half_angle, double radiance) {
    return (BpDisc){.direction = {x, y, 0},
                    .half_angle_degrees = half_angle,
                    .radiance = {radiance, radiance / 2, 0},
                    .visible_to_camera = true};
}

static double bound_of(const BpScene *scene, BpLightSampling light_sampling) {
    return bp_scene_radiance_bound(scene, 50, light_sampling, BP_CAUSTICS_OFF, BP_ROULETTE_OFF);
}

/* Discs that share a direction add up, with the sky behind them; others do not. */
static void discs_add_up(void **state) {
    (void)state;
    BpScene scene = make_scene();
    scene.discs[0] = disc(1, 0, 10, 100);
    scene.discs[1] = disc(1, 0.2, 10, 1000);
    scene.discs[2] = disc(-3, 0, 10, 500);
    scene.disc_count = 1;
    assert_true(fabs(bound_of(&scene, BP_LIGHT_SAMPLING_OFF) - 101) <= 1e-9);
    scene.disc_count = 3;
    assert_true(fabs(bound_of(&scene, BP_LIGHT_SAMPLING_OFF) - 1101) <= 1e-9);
    scene.discs[2].half_angle_degrees = 90;
    assert_true(fabs(bound_of(&scene, BP_LIGHT_SAMPLING_OFF) - 1101) <= 1e-9);
    scene.discs[1].half_angle_degrees = 90;
    assert_true(fabs(bound_of(&scene, BP_LIGHT_SAMPLING_OFF) - 1601) <= 1e-9);
    scene.discs[0].direction[0] = 1e12; /* of any length */
    assert_true(fabs(bound_of(&scene, BP_LIGHT_SAMPLING_OFF) - 1601) <= 1e-9);
    /* A ray to a disc brings half of its radiance at most, dimmed by the albedo, again at each vertex. */
    const double albedo = 0.75; /* the largest of what is lit */
    double most = 1601, through = albedo;
    for (int vertex = 1; vertex < 50; vertex++, through *= albedo) most += 0.5 * 1000 * through;
    assert_true(bound_of(&scene, BP_LIGHT_SAMPLING_ON) >= most &&
                bound_of(&scene, BP_LIGHT_SAMPLING_ON) <= 1.5 * most);
    assert_true(ldexp(most, bp_film_scale(&scene, 50, BP_LIGHT_SAMPLING_ON, BP_CAUSTICS_OFF,
                                          BP_ROULETTE_OFF)) <= 0x1p38);
    free_scene(&scene);
}

/* Where a surface both emits and scatters, light can come again at every bounce. */
static void emitters_that_scatter_add_up(void **state) {
    (void)state;
    BpScene scene = make_scene();
    scene.materials[0].emit[1] = 4;
    scene.materials[0].albedo[2] = 0.5; /* 1 + 1/2 + 1/4 + ... = 2, but one sphere brings 0.625 itself */
    assert_true(
        fabs(bp_scene_radiance_bound(&scene, 50, BP_LIGHT_SAMPLING_OFF, BP_CAUSTICS_OFF, BP_ROULETTE_OFF) -
             4 / (1 - 0.625)) <= 1e-12);
    scene.spheres[5].albedo = BP_NO_ALBEDO;
    assert_true(
        fabs(bp_scene_radiance_bound(&scene, 50, BP_LIGHT_SAMPLING_OFF, BP_CAUSTICS_OFF, BP_ROULETTE_OFF) -
             8) <= 1e-12);
    scene.materials[5].emit[0] = 100; /* not in use */
    assert_true(
        fabs(bp_scene_radiance_bound(&scene, 50, BP_LIGHT_SAMPLING_OFF, BP_CAUSTICS_OFF, BP_ROULETTE_OFF) -
             8) <= 1e-12);
    scene.materials[2].emit[0] = 1; /* glass passes everything on */
    assert_true(
        fabs(bp_scene_radiance_bound(&scene, 50, BP_LIGHT_SAMPLING_OFF, BP_CAUSTICS_OFF, BP_ROULETTE_OFF) -
             4.0 * 50) <= 0); /* once a segment */
    assert_int_equal(bp_film_scale(&scene, 50, BP_LIGHT_SAMPLING_OFF, BP_CAUSTICS_OFF, BP_ROULETTE_OFF),
                     38 - 8);
    assert_true(
        fabs(bp_scene_radiance_bound(&scene, 1, BP_LIGHT_SAMPLING_OFF, BP_CAUSTICS_OFF, BP_ROULETTE_OFF) -
             4) <= 0);
    assert_true(fabs(bp_scene_radiance_bound(&scene, 0, BP_LIGHT_SAMPLING_OFF, BP_CAUSTICS_OFF,
                                             BP_ROULETTE_OFF)) <= 0);
    assert_true(fabs(bp_scene_radiance_bound(&scene, BP_DEPTH_MAX, BP_LIGHT_SAMPLING_OFF, BP_CAUSTICS_OFF,
                                             BP_ROULETTE_OFF) -
                     4.0 * BP_DEPTH_MAX) <= 0);
    free_scene(&scene);
}

/* The bound holds for the worst path that there is: it meets the brightest emitting scatterer every time. */
static void no_path_is_brighter(void **state) {
    (void)state;
    BpScene scene = make_scene();
    for (int i = 0; i < 100; i++) {
        const double albedo = i / 100.0, emit = 0.3 + i;
        for (int c = 0; c < 3; c++) scene.materials[1].albedo[c] = albedo;
        scene.materials[1].emit[2] = emit;
        double radiance = 0, throughput = 1;
        for (int depth = 0; depth < 50; depth++, throughput *= albedo) radiance += throughput * emit;
        const double bound =
            bp_scene_radiance_bound(&scene, 50, BP_LIGHT_SAMPLING_OFF, BP_CAUSTICS_OFF, BP_ROULETTE_OFF);
        assert_true(radiance <= bound * (1 + 1e-12));
        assert_true(ldexp(bound, bp_film_scale(&scene, 50, BP_LIGHT_SAMPLING_OFF, BP_CAUSTICS_OFF,
                                               BP_ROULETTE_OFF)) <= 0x1p38);
        assert_true(ldexp(bound, bp_film_scale(&scene, 50, BP_LIGHT_SAMPLING_OFF, BP_CAUSTICS_OFF,
                                               BP_ROULETTE_OFF)) > 0x1p37);
    }
    free_scene(&scene);
}

static void extreme_scales_stay_floats(void **state) {
    (void)state;
    BpScene scene = make_scene();
    scene.sphere_count = 0;
    memset(scene.background_bottom, 0, sizeof scene.background_bottom);
    memset(scene.background_top, 0, sizeof scene.background_top);
    assert_int_equal(bp_film_scale(&scene, 50, BP_LIGHT_SAMPLING_OFF, BP_CAUSTICS_OFF, BP_ROULETTE_OFF),
                     38); /* black */
    scene.background_top[0] = 1e-300;
    assert_int_equal(bp_film_scale(&scene, 50, BP_LIGHT_SAMPLING_OFF, BP_CAUSTICS_OFF, BP_ROULETTE_OFF), 126);
    scene.background_top[0] = 1e300;
    assert_int_equal(bp_film_scale(&scene, 50, BP_LIGHT_SAMPLING_OFF, BP_CAUSTICS_OFF, BP_ROULETTE_OFF),
                     -126);
    free_scene(&scene);
}

static void the_hash_keeps_to_the_meaning(void **state) {
    (void)state;
    BpScene scene = make_scene();
    const uint64_t hash = bp_scene_hash(&scene);
    BpScene again = make_scene();
    assert_int_equal(bp_scene_hash(&again), hash);
#define SAME(statement)                                                                                      \
    do {                                                                                                     \
        statement;                                                                                           \
        if (bp_scene_hash(&again) != hash) fail_msg("changes the hash: %s", #statement);                     \
    } while (0)
    char name[] = "a name", title[] = "a title";
    SAME(again.materials[0].name = name);
    SAME(again.title = title);
    SAME(again.camera.samples_per_pixel = 77);
    SAME(again.camera.max_depth = 77);
    SAME(again.camera.aspect_ratio = 1.3333);
    SAME(again.camera.focus_dist = 3); /* a pinhole has no focus */
    SAME(again.transfer = BP_TRANSFER_LINEAR);
    SAME(again.camera.lookfrom[1] = -0.0);
    SAME(again.spheres[2].center[1] = -0.0);
    SAME(again.materials[5].albedo[0] = 0.9);      /* in no sphere */
    SAME(again.materials[2].albedo[0] = 0.9);      /* of glass */
    SAME(again.materials[0].fuzz = 0.9);           /* of a matt sphere */
    SAME(again.spheres[0].radius = -0.5);          /* matt, inside out */
    SAME(again.materials[3].refraction_index = 2); /* of a lamp */
    SAME(again.albedos[0][0] = 0.5f);              /* nobody's colour */
    SAME(again.discs[0].half_angle_degrees = 3);   /* there is no disc */
    /* The same material under another number. */
    SAME((again.materials[5] = again.materials[1], again.spheres[1].material = 5));
    /* A colour of the sphere's own that is the material's. */
    SAME((again.albedos[0][0] = 0.5f, again.albedos[0][1] = 0.25f, again.albedos[0][2] = 0.75f,
          again.spheres[0].albedo = 0));
#undef SAME
    /* A mirror without fuzz has no shape of fuzz. */
    scene.materials[1].fuzz = again.materials[1].fuzz = again.materials[5].fuzz = 0;
    again.materials[5].fuzz_shape = BP_FUZZ_BALL;
    assert_true(bp_scene_hash(&scene) == bp_scene_hash(&again));
    free_scene(&again);
    free_scene(&scene);
}

/* One triangle; of a material in the first variant, of a colour of its own in the second. */
static BpTriangle triangles[2] = {
    {.vertices = {{0, 0, -1}, {1, 0, -1}, {0, 1, -1}}, .material = 5, .albedo = BP_NO_ALBEDO},
    {.vertices = {{0, 0, -1}, {1, 0, -1}, {0, 1, -1}}, .material = 5, .albedo = 1}};

static void the_hash_sees_every_change(void **state) {
    (void)state;
    uint64_t seen[64];
    size_t count = 0;
#define SEEN(statement)                                                                                      \
    do {                                                                                                     \
        BpScene scene = make_scene();                                                                        \
        statement;                                                                                           \
        const uint64_t hash = bp_scene_hash(&scene);                                                         \
        for (size_t i = 0; i < count; i++)                                                                   \
            if (seen[i] == hash) fail_msg("not in the hash, or not apart: %s", #statement);                  \
        seen[count++] = hash;                                                                                \
        free_scene(&scene);                                                                                  \
    } while (0)
    SEEN((void)0);
    SEEN(scene.camera.width = 30);
    SEEN(scene.camera.height = 40);
    SEEN((scene.camera.width = 30, scene.camera.height = 40));
    SEEN(scene.camera.vfov_degrees = 90.00000000000001);
    SEEN(scene.camera.lookfrom[0] = 1);
    SEEN(scene.camera.lookfrom[2] = 1);
    SEEN(scene.camera.lookat[0] = 1);
    SEEN(scene.camera.vup[0] = 1);
    SEEN(scene.camera.lens_radius = 0.1);
    SEEN((scene.camera.lens_radius = 0.1, scene.camera.focus_dist = 9));
    SEEN(scene.camera.pixel_sampling = BP_PIXEL_CENTER);
    SEEN(scene.background_bottom[1] = 0.5);
    SEEN(scene.background_top[1] = 0.5);
    SEEN((scene.triangles = &triangles[0], scene.triangle_count = 1));
    SEEN((scene.triangles = &triangles[1], scene.triangle_count = 1));
    SEEN((scene.triangles = &triangles[0], scene.triangle_count = 1, scene.materials[5].albedo[1] = 0.5));
    SEEN((scene.discs[0] = disc(1, 0, 10, 100), scene.disc_count = 1));
    SEEN((scene.discs[0] = disc(1, 1, 10, 100), scene.disc_count = 1));
    SEEN((scene.discs[0] = disc(1, 0, 11, 100), scene.disc_count = 1));
    SEEN((scene.discs[0] = disc(1, 0, 10, 101), scene.disc_count = 1));
    SEEN((scene.discs[0] = disc(1, 0, 10, 100), scene.disc_count = 1,
          scene.discs[0].visible_to_camera = false));
    SEEN((scene.discs[0] = disc(1, 0, 10, 100), scene.discs[1] = scene.discs[0], scene.disc_count = 2));
    SEEN(scene.sphere_count = 5);
    SEEN(scene.spheres[0].center[1] = 5e-324);
    SEEN(scene.spheres[0].radius = 0.25);
    SEEN(scene.spheres[2].radius = -0.5); /* glass inside out */
    SEEN(scene.spheres[0].material = 5);
    SEEN(scene.spheres[0].material = 4);
    SEEN(scene.spheres[0].albedo = 1);
    SEEN(scene.albedos[1][2] = 0.5f);
    SEEN(scene.materials[0].albedo[0] = 0.25);
    SEEN(scene.materials[0].scatter = BP_SCATTER_HEMISPHERE);
    SEEN(scene.materials[0].emit[0] = 1);
    SEEN(scene.materials[1].fuzz = 0.5);
    SEEN(scene.materials[1].fuzz_shape = BP_FUZZ_BALL);
    SEEN(scene.materials[2].refraction_index = 1.25);
    SEEN(scene.materials[2].fresnel = BP_FRESNEL_EXACT);
    SEEN(scene.materials[2].total_reflection = BP_TOTAL_ABSORB);
    SEEN(scene.materials[3].emit[2] = 2);
    SEEN(scene.materials[4].emit[2] = 2);
    SEEN((scene.spheres[0].center[0] = 1, scene.spheres[1].center[0] = 0)); /* swapped */
#undef SEEN
}

/* A path that goes on by roulette may carry as much as the limit of it, again and again: none brings more
 * than the bound. */
static void roulette_adds_up(void **state) {
    (void)state;
    static const uint32_t depths[] = {1, 8, 9, 50, 1000};
    BpScene scene = make_scene();
    scene.spheres[5].albedo = BP_NO_ALBEDO;
    BpMaterial *shining = &scene.materials[scene.spheres[0].material];
    shining->kind = BP_MATERIAL_LAMBERTIAN;
    for (int c = 0; c < 3; ++c) shining->emit[c] = 4, shining->albedo[c] = 0.5;
    for (size_t i = 0; i < sizeof depths / sizeof *depths; ++i) {
        /* Each segment meets light; from the eighth on, roulette makes a 64th of what is less. */
        double most = 0, carried = 1;
        for (uint32_t segment = 0; segment < depths[i]; ++segment, carried *= 0.5) {
            if (segment >= 8 && carried < 1.0 / 64) carried = 1.0 / 64;
            most += 4 * carried;
        }
        const double off = bp_scene_radiance_bound(&scene, depths[i], BP_LIGHT_SAMPLING_OFF, BP_CAUSTICS_OFF,
                                                   BP_ROULETTE_OFF);
        const double on = bp_scene_radiance_bound(&scene, depths[i], BP_LIGHT_SAMPLING_OFF, BP_CAUSTICS_OFF,
                                                  BP_ROULETTE_ON);
        assert_true(on >= most && on <= most + 0.5);
        assert_true(depths[i] > 8 ? on > off : fabs(on - off) <= 0);
    }
    free_scene(&scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bound_and_scale),
        cmocka_unit_test(discs_add_up),
        cmocka_unit_test(emitters_that_scatter_add_up),
        cmocka_unit_test(roulette_adds_up),
        cmocka_unit_test(no_path_is_brighter),
        cmocka_unit_test(extreme_scales_stay_floats),
        cmocka_unit_test(the_hash_keeps_to_the_meaning),
        cmocka_unit_test(the_hash_sees_every_change),
    };
    return cmocka_run_group_tests_name("film_scene", tests, NULL, NULL);
}
