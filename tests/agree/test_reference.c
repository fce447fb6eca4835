/* test_reference.c: what must hold of the reference exactly. */
#include "reference/reference.h"
#include "reference/trace.h"
#include "support/build_scene.h"
#include "support/unit_test.h"

#include <math.h>
#include <string.h>

/* Something of everything: three materials, a lamp, a lens, a gradient. */
static void mixed_scene(BuiltScene *built) {
    built_scene_init(built);
    BpMaterial *material;
    built_material(built, BP_MATERIAL_LAMBERTIAN, 0.5, NULL);
    built_material(built, BP_MATERIAL_METAL, 0.8, &material);
    material->fuzz = 0.3;
    built_material(built, BP_MATERIAL_DIELECTRIC, 1, NULL);
    built_material(built, BP_MATERIAL_DIFFUSE_LIGHT, 0, &material);
    material->emit[0] = 4;
    built_sphere(built, 0, -100.5, -1, 100, 0);
    built_sphere(built, 0, 0, -1, 0.5, 0);
    built_sphere(built, -1, 0, -1, 0.5, 2);
    built_sphere(built, 1, 0, -1, 0.5, 1);
    built_sphere(built, 0, 2, -1, 0.5, 3);
    built->scene.background_bottom[2] = 0.5;
    BpCamera *camera = &built->scene.camera;
    camera->width = 9;
    camera->height = 7;
    camera->lens_radius = 0.05;
    camera->pixel_sampling = BP_PIXEL_SQUARE;
}

static void render(const BpScene *scene, BpReferenceOptions options, BpSums *sums, uint64_t *cut) {
    if (sums->pixels == NULL)
        assert_int_equal(bp_sums_init(sums, scene->camera.width, scene->camera.height, NULL), BP_OK);
    assert_int_equal(bp_reference_render(scene, &options, sums, cut, NULL), BP_OK);
}

static bool same(const BpSums *a, const BpSums *b) {
    return memcmp(a->pixels, b->pixels, (size_t)a->width * a->height * sizeof *a->pixels) == 0;
}

static void threads_and_parts_change_nothing(void **state) {
    (void)state;
    BuiltScene built;
    mixed_scene(&built);
    BpSums one = {0}, many = {0}, parts = {0}, other = {0};
    render(&built.scene, (BpReferenceOptions){.samples = 40, .seed = 5, .max_depth = 10, .threads = 1}, &one,
           NULL);
    render(&built.scene, (BpReferenceOptions){.samples = 40, .seed = 5, .max_depth = 10, .threads = 7}, &many,
           NULL);
    const uint64_t starts[] = {0, 1, 9, 40};
    for (int i = 0; i < 3; ++i)
        render(
            &built.scene,
            (BpReferenceOptions){
                .first_sample = starts[i], .samples = starts[i + 1] - starts[i], .seed = 5, .max_depth = 10},
            &parts, NULL);
    render(&built.scene, (BpReferenceOptions){.samples = 40, .seed = 6, .max_depth = 10}, &other, NULL);
    assert_true(same(&one, &many));
    assert_true(same(&one, &parts));
    assert_false(same(&one, &other));
    bp_sums_clear(&one);
    bp_sums_clear(&many);
    bp_sums_clear(&parts);
    bp_sums_clear(&other);
}

static void depth(void **state) {
    (void)state;
    BuiltScene built;
    built_scene_init(&built);
    BpMaterial *material;
    built_material(&built, BP_MATERIAL_LAMBERTIAN, 0.5, &material);
    material->emit[1] = 3;
    built_sphere(&built, 0, 0, -3, 1, 0);
    const double expected[3][3] = {{0, 0, 0}, {0, 3, 0}, {0.5, 3.5, 0.5}};
    for (uint32_t max_depth = 0; max_depth < 3; ++max_depth) {
        BpSums sums = {0};
        uint64_t cut = 0;
        render(&built.scene, (BpReferenceOptions){.samples = 8, .seed = 1, .max_depth = max_depth}, &sums,
               &cut);
        for (int c = 0; c < 3; ++c) assert_true(sums.pixels[0].sum[c] == 8 * expected[max_depth][c]);
        assert_int_equal(cut, max_depth < 2 ? 8 : 0);
        assert_int_equal(sums.pixels[0].segments, 8 * max_depth);
        bp_sums_clear(&sums);
    }
}

/* A path as long as the grammar allows, in a mirror furnace. */
static void deep_recursion(void **state) {
    (void)state;
    BuiltScene built;
    built_scene_init(&built);
    built_material(&built, BP_MATERIAL_METAL, 1, NULL);
    built_sphere(&built, 0.2, 0.1, 0, 2, 0);
    BpSums sums = {0};
    uint64_t cut = 0;
    render(&built.scene, (BpReferenceOptions){.samples = 1, .seed = 1, .max_depth = BP_DEPTH_MAX}, &sums,
           &cut);
    assert_int_equal(sums.pixels[0].segments, BP_DEPTH_MAX);
    assert_int_equal(cut, 1);
    bp_sums_clear(&sums);
}

static void invalid_samples_are_left_out(void **state) {
    (void)state;
    BpPixelSums pixel = {0};
    const double bad[4][3] = {{NAN, 0, 0}, {0, INFINITY, 0}, {0, 0, -1e-30}, {0, -INFINITY, 0}};
    for (int i = 0; i < 4; ++i) bp_pixel_sums_add(&pixel, bad[i], 3);
    bp_pixel_sums_add(&pixel, (double[3]){0.5, 0, 2}, 4);
    assert_int_equal(pixel.invalid, 4);
    assert_int_equal(pixel.count, 1);
    assert_int_equal(pixel.segments, 4);
    assert_int_equal(pixel.lit[0], 1);
    assert_int_equal(pixel.lit[1], 0);
    assert_true(pixel.sum[2] == 2 && pixel.sum2[2] == 4 && pixel.sum4[2] == 16);
    assert_true(fabs(pixel.sum[BP_SUMS_LUMINANCE] - (0.5 * 0.2126 + 2 * 0.0722)) < 1e-15);
}

/* Leaves a sphere at every angle: going out it must not meet it again, going in the far side must lie at 2 r
 * cos, down to chords of 1e-6, for spheres small and huge, near and far from the origin. */
static void departure(void **state) {
    (void)state;
    const double radii[] = {1e-4, 1, 1e6}, places[] = {0, 1e3, 1e6};
    Random random = random_stream(3, 0, 0);
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            BuiltScene built;
            built_scene_init(&built);
            built_material(&built, BP_MATERIAL_LAMBERTIAN, 0.5, NULL);
            built_sphere(&built, places[j], -places[j], places[j], radii[i], 0);
            for (int k = 0; k < 1000; ++k) {
                const double r = radii[i], center_error = 4e-16 * places[j];
                const Vec n = random_on_sphere(&random), tangent = unit(cross(n, random_on_sphere(&random)));
                const double cosine = fmin(1, pow(10, random_between(&random, -6, 0)) / (2 * r));
                if (cosine * r < 1e3 * center_error || cosine < 1e-12) continue; /* not representable there */
                const Vec point = add(vec(built.spheres[0].center), scale(r, n));
                const Vec aslant = scale(sqrt((1 - cosine) * (1 + cosine)), tangent);
                Hit hit;
                const Ray out = {
                    .origin = point, .direction = add(aslant, scale(cosine, n)), .leaves = &built.spheres[0]};
                assert_false(bp_ref_hit(&built.scene, &out, &hit));
                const Ray in = {.origin = point,
                                .direction = scale(3, sub(aslant, scale(cosine, n))),
                                .leaves = &built.spheres[0]};
                assert_true(bp_ref_hit(&built.scene, &in, &hit));
                const double chord = 2 * r * cosine;
                const double allowed = 1e-9 + 16 * (center_error + 1e-16 * r) / (cosine * r);
                if (fabs(3 * hit.t - chord) > allowed * chord)
                    fail_msg("r %g at %g: chord %g, found %g", r, places[j], chord, 3 * hit.t);
                assert_false(hit.front_face);
            }
        }
    }
}

/* A sphere of 1e-3 at a distance of 1e5: 1 % inside its rim is met, 1 % outside is missed. */
static void far_small_sphere(void **state) {
    (void)state;
    BuiltScene built;
    built_scene_init(&built);
    built_material(&built, BP_MATERIAL_LAMBERTIAN, 0.5, NULL);
    built_sphere(&built, 0, 0, -1e5, 1e-3, 0);
    for (int k = 0; k < 1000; ++k) {
        const double angle = k * 0.0062831853;
        for (int outside = 0; outside < 2; ++outside) {
            const double b = (outside ? 1.01e-3 : 0.99e-3);
            const Ray ray = {.direction = {b * cos(angle), b * sin(angle), -1e5}};
            Hit hit;
            assert_int_equal(bp_ref_hit(&built.scene, &ray, &hit), !outside);
        }
    }
}

static void colour_of_its_own(void **state) {
    (void)state;
    BuiltScene built;
    built_scene_init(&built);
    float albedos[2][3] = {{0.125f, 0.25f, 0.5f}, {1, 0.75f, 0.0625f}};
    built.scene.albedos = albedos;
    built.scene.albedo_count = 2;
    built_material(&built, BP_MATERIAL_LAMBERTIAN, 0.3, NULL);
    built_sphere(&built, 0, 0, -3, 1, 0);
    built.spheres[0].albedo = 1;
    BpSums sums = {0};
    render(&built.scene, (BpReferenceOptions){.samples = 4, .seed = 1, .max_depth = 3}, &sums, NULL);
    for (int c = 0; c < 3; ++c) assert_true(sums.pixels[0].sum[c] == 4.0 * (double)albedos[1][c]);
    bp_sums_clear(&sums);
}

static void wrong_size_is_refused(void **state) {
    (void)state;
    BuiltScene built;
    built_scene_init(&built);
    BpSums sums = {0};
    BpError err = {0};
    assert_int_equal(bp_sums_init(&sums, 2, 1, NULL), BP_OK);
    assert_int_equal(
        bp_reference_render(&built.scene, &(BpReferenceOptions){.samples = 1}, &sums, NULL, &err),
        BP_ERR_USAGE);
    assert_non_null(strstr(err.message, "2 x 1"));
    bp_error_clear(&err);
    bp_sums_clear(&sums);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(threads_and_parts_change_nothing),
        cmocka_unit_test(depth),
        cmocka_unit_test(deep_recursion),
        cmocka_unit_test(invalid_samples_are_left_out),
        cmocka_unit_test(departure),
        cmocka_unit_test(far_small_sphere),
        cmocka_unit_test(colour_of_its_own),
        cmocka_unit_test(wrong_size_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
