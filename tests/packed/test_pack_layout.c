/* test_pack_layout.c: what the packed buffers hold, entry by entry. */
#define BP_HOST
#include "base/status.h"
#include "packed/pack.h"
#include "packed/reals.h"
#include "scene_types.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static BpScene empty_scene(void) {
    BpScene scene = {0};
    scene.camera = (BpCamera){.width = 400,
                              .height = 225,
                              .aspect_ratio = 16.0 / 9.0,
                              .vfov_degrees = 90,
                              .lookat = {0, 0, -1},
                              .vup = {0, 1, 0},
                              .focus_dist = 10};
    for (int a = 0; a < 3; ++a) scene.background_bottom[a] = 1;
    scene.background_top[0] = 0.5;
    scene.background_top[1] = 0.7;
    scene.background_top[2] = 1;
    return scene;
}

static void pack(const BpScene *scene, bool single, BpPacked *packed) {
    const BpTreeOptions options = {.width = 8, .single_precision = single, .threads = 1};
    BpError err = {0};
    assert_int_equal(bp_scene_pack(scene, &options, true, true, packed, &err), BP_OK);
    assert_int_equal(bp_packed_real_size(packed), single ? 4 : 8);
}

static void assert_vector(const double *v, double x, double y, double z) {
    const double e = 1e-12;
    assert_true(fabs(v[0] - x) < e && fabs(v[1] - y) < e && fabs(v[2] - z) < e && v[3] == 0);
}

/* With half of a pixel's diagonal behind it. */
static void assert_right(const PackedCamera *camera, double pixel) {
    const double right[4] = {camera->right[0], camera->right[1], camera->right[2], 0};
    assert_vector(right, pixel, 0, 0);
    assert_true(fabs(camera->right[3] - pixel / sqrt(2.0)) < 1e-12);
}

/* By hand: 90 degrees at distance 10 is 20 high; pixels are square, so 400 by 225 is 20 * 400 / 225 wide. */
static void camera_along_minus_z(void **state) {
    (void)state;
    BpScene scene = empty_scene();
    scene.camera.lens_radius = 0.25;
    BpPacked packed;
    pack(&scene, false, &packed);
    const PackedCamera *camera = packed.camera;
    const double pixel = 20.0 / 225;
    assert_vector(camera->corner, -200 * pixel, 10, -10);
    assert_right(camera, pixel);
    assert_vector(camera->down, 0, -pixel, 0);
    assert_vector(camera->lens_right, 0.25, 0, 0);
    assert_vector(camera->lens_up, 0, 0.25, 0);
    const PackedSky *sky = packed.sky;
    assert_vector(sky->bottom, 1, 1, 1);
    assert_vector(sky->top, 0.5, 0.7, 1);
    bp_packed_clear(&packed);
}

/* A disc: a unit direction, and what its half angle means, without the bits that 1 - cos loses. */
static void discs(void **state) {
    (void)state;
    for (int single = 0; single < 2; ++single) {
        BpScene scene = empty_scene();
        BpPacked packed;
        scene.disc_count = 3;
        scene.discs[0] = (BpDisc){{0, 3e10, 4e10}, 1e-4, {8, 4, 2}, true};
        scene.discs[1] = (BpDisc){{0, 0, -1e-20}, 90, {1, 1, 1}, false};
        scene.discs[2] = (BpDisc){{1, 0, 0}, 30, {0, 0, 0}, true};
        pack(&scene, single, &packed);
        double v[36];
        for (size_t i = 0; i < 36; ++i) v[i] = bp_reals_load(packed.discs, single, i);
        const double e = single ? 1e-7 : 1e-15, small = 1e-4 * 3.14159265358979323846 / 180;
        const double brightest = 0.2126 * 8 + 0.7152 * 4 + 0.0722 * 2;
        assert_int_equal(packed.disc_count, 3);
        assert_int_equal((int)bp_reals_load(packed.sky, single, 7), 3);
        assert_true(fabs(v[0]) <= e && fabs(v[1] - 0.6) <= e && fabs(v[2] - 0.8) <= e);
        assert_true(fabs(v[3] / (small * small / 2) - 1) <= 1e-11 + 2 * e);
        assert_true(v[4] >= 8 && v[4] <= 8 && v[5] >= 4 && v[5] <= 4 && v[6] >= 2 && v[6] <= 2);
        assert_true(fabs(v[7] / (small * small) - 1) <= 1e-11 + 2 * e); /* its luminance is the unit */
        assert_true(fabs(v[8] / small - 1) <= 1e-11 + 2 * e && v[10] > 0);
        assert_true(fabs(v[9] / (small * small) - 1) <= 1e-11 + 2 * e);
        assert_true(fabs(v[12 + 2] + 1) <= e && fabs(v[12 + 3] - 1) <= e && fabs(v[12 + 9] - 2) <= 2 * e);
        assert_true(fabs(v[12 + 7] - 1 / brightest) <= e && !(v[12 + 10] > 0));
        assert_true(fabs(v[24 + 8] - 0.5) <= e && !(fabs(v[24 + 7]) > 0));
        bp_packed_clear(&packed);
    }
}

/* From (-2,2,1) at the point (0,0,-1), as the book looks at its spheres; far from the origin nothing changes.
 */
static void camera_anywhere(void **state) {
    (void)state;
    for (int far = 0; far < 2; ++far) {
        const double shift = far ? 1048576 : 0;
        BpScene scene = empty_scene();
        const double from[3] = {-2, 2, 1}, at[3] = {0, 0, -1};
        for (int a = 0; a < 3; ++a) {
            scene.camera.lookfrom[a] = from[a] + shift;
            scene.camera.lookat[a] = at[a] + shift;
        }
        scene.camera.vfov_degrees = 20;
        scene.camera.focus_dist = 3.4;
        scene.camera.width = 7; /* 7 x 3: not quite the ideal aspect */
        scene.camera.height = 3;
        BpPacked packed;
        pack(&scene, false, &packed);
        const PackedCamera *camera = packed.camera;
        double middle[3], dot_right_down = 0, dot_right_y = camera->right[1];
        for (int a = 0; a < 3; ++a) {
            middle[a] = camera->corner[a] + 3.5 * camera->right[a] + 1.5 * camera->down[a];
            dot_right_down += camera->right[a] * camera->down[a];
        }
        /* The middle of the picture is focus_dist along the view (2,-2,-2)/sqrt(12). */
        const double along = 3.4 / sqrt(12.0);
        assert_true(fabs(middle[0] - 2 * along) < 1e-12 && fabs(middle[1] + 2 * along) < 1e-12 &&
                    fabs(middle[2] + 2 * along) < 1e-12);
        assert_true(fabs(dot_right_down) < 1e-15 && fabs(dot_right_y) < 1e-15); /* right is level: vup is y */
        assert_true(camera->down[1] < 0);
        /* right is (view x up): from (-2,.,1) towards (0,.,-1), that is (1,0,1) / sqrt 2. */
        assert_true(camera->right[0] > 0 && fabs(camera->right[0] - camera->right[2]) < 1e-15);
        const double pixel = 2 * 3.4 * tan(10 * 3.14159265358979323846 / 180) / 3;
        assert_true(fabs(camera->right[0] * sqrt(2.0) - pixel) < 1e-14);
        bp_packed_clear(&packed);
    }
}

static void extreme_vup(void **state) {
    (void)state;
    const double scales[] = {1e-300, 1e12};
    for (int i = 0; i < 2; ++i) {
        BpScene scene = empty_scene();
        scene.camera.vup[1] = scales[i];
        BpPacked packed;
        pack(&scene, false, &packed);
        assert_right(packed.camera, 20.0 / 225);
        bp_packed_clear(&packed);
    }
}

static void materials_and_looks(void **state) {
    (void)state;
    BpScene scene = empty_scene();
    BpMaterial materials[] = {
        {.kind = BP_MATERIAL_LAMBERTIAN,
         .albedo = {.1, .2, .3},
         .emit = {1, 2, 3},
         .opacity = .3,
         .scatter = BP_SCATTER_HEMISPHERE},
        {.kind = BP_MATERIAL_METAL, .albedo = {.4, .5, .6}, .fuzz = .25, .fuzz_shape = BP_FUZZ_BALL},
        {.kind = BP_MATERIAL_DIELECTRIC,
         .refraction_index = 1.5,
         .fresnel = BP_FRESNEL_EXACT,
         .total_reflection = BP_TOTAL_ABSORB},
        {.kind = BP_MATERIAL_DIFFUSE_LIGHT, .emit = {4, 5, 6}},
        {.kind = BP_MATERIAL_NORMALS},
    };
    float albedos[][3] = {{.1f, .2f, .3f}, {.5f, .6f, .7f}};
    BpSphere spheres[] = {
        {.center = {0, 0, 0}, .radius = 1, .material = 2, .albedo = BP_NO_ALBEDO},
        {.center = {0, 0, 0}, .radius = -.9, .material = 2, .albedo = BP_NO_ALBEDO},
        {.center = {4, 0, 0}, .radius = -.9, .material = 2, .albedo = 0},
        {.center = {8, 0, 0}, .radius = -1, .material = 0, .albedo = 1},
        {.center = {9, 0, 0}, .radius = 1, .material = 1, .albedo = 0},
        {.center = {9, 9, 0}, .radius = -1, .material = 4, .albedo = BP_NO_ALBEDO},
        {.center = {9, 9, 9}, .radius = -1, .material = 1, .albedo = BP_NO_ALBEDO},
    };
    scene.materials = materials;
    scene.material_count = 5;
    scene.spheres = spheres;
    scene.sphere_count = 7;
    scene.albedos = albedos;
    scene.albedo_count = 2;
    BpPacked packed;
    pack(&scene, false, &packed);
    assert_int_equal(packed.material_count, 6);
    const PackedMaterial *numbers = packed.materials;
    const PackedMaterialKind *kinds = (const PackedMaterialKind *)packed.material_kinds;
    const double emits[2][3] = {{1, 2, 3}, {4, 5, 6}};
    assert_memory_equal(numbers[0].emit, emits[0], sizeof emits[0]);
    assert_true(numbers[0].opacity == .3 && numbers[1].opacity == 1 && numbers[5].opacity == 1);
    assert_int_equal(kinds[0].kind, KIND_LAMBERTIAN);
    assert_int_equal(kinds[0].lobe, LOBE_HEMISPHERE);
    assert_true(numbers[1].fuzz == .25);
    assert_int_equal(kinds[1].kind, KIND_METAL);
    assert_int_equal(kinds[1].variant, FUZZ_BALL);
    assert_true(numbers[2].refraction_index == 1.5 && numbers[5].refraction_index == 1 / 1.5);
    for (int m = 2; m <= 5; m += 3) {
        assert_int_equal(kinds[m].kind, KIND_DIELECTRIC);
        assert_int_equal(kinds[m].variant, FRESNEL_EXACT);
        assert_int_equal(kinds[m].total_reflection, TOTAL_ABSORB);
    }
    assert_memory_equal(numbers[3].emit, emits[1], sizeof emits[1]);
    assert_int_equal(kinds[3].kind, KIND_LIGHT);
    assert_int_equal(kinds[4].kind, KIND_NORMALS);
    /* By slot: the material, from inside out where the radius says so, and the colour, the sphere's own if it
     * has one. */
    const struct {
        uint32_t material;
        double albedo[3];
    } expected[7] = {
        {2, {1, 1, 1}}, /* glass scatters all, whatever colour a cloud gives it */
        {5, {1, 1, 1}},
        {5, {1, 1, 1}},
        {0, {(double).5f, (double).6f, (double).7f}},
        {1, {(double).1f, (double).2f, (double).3f}},
        {4, {0, 0, 0}},
        {1, {.4, .5, .6}},
    };
    unsigned seen = 0;
    for (uint32_t s = 0; s < packed.tree.leaf_count * packed.tree.width; ++s) {
        const uint32_t sphere = packed.tree.slot_sphere[s];
        if (sphere == NO_SPHERE) continue;
        assert_int_equal(packed.slot_material[s], expected[sphere].material);
        for (size_t a = 0; a < 3; ++a)
            assert_true(bp_reals_load(packed.slot_albedo, false, ALBEDO_REALS * (size_t)s + a) ==
                        expected[sphere].albedo[a]);
        ++seen;
    }
    assert_int_equal(seen, 7);
    bp_packed_clear(&packed);

    pack(&scene, true, &packed);
    const float *single = packed.materials;
    assert_true(single[0] == 1.f && single[8 * 5 + 5] == (float)(1 / 1.5) && single[8 + 4] == .25f);
    bp_packed_clear(&packed);
}

/* A camera on a sphere, in decimals that no double hits: it leaves the sphere in that slot. Beside a sphere
 * by far less than float resolves it stays on its side. */
static void camera_on_a_sphere(void **state) {
    (void)state;
    BpScene scene = empty_scene();
    BpMaterial material = {.kind = BP_MATERIAL_DIELECTRIC, .refraction_index = 1.5};
    BpSphere spheres[] = {
        {.center = {0, 1, 0}, .radius = .2, .albedo = BP_NO_ALBEDO},
        {.center = {.4, .6, .3}, .radius = -.5, .albedo = BP_NO_ALBEDO},
        {.center = {.1, .2, 4000.3}, .radius = 4000 * (1 + 1e-12), .albedo = BP_NO_ALBEDO},
        {.center = {.1, .2, -4000.3}, .radius = 4000.6 * (1 - 1e-12), .albedo = BP_NO_ALBEDO},
    };
    scene.materials = &material;
    scene.material_count = 1;
    scene.spheres = spheres;
    scene.sphere_count = 4;
    const double from[3] = {.1, .2, .3};
    memcpy(scene.camera.lookfrom, from, sizeof from);
    for (int variant = 0; variant < 4; ++variant) {
        const bool single = variant % 2 != 0, lens = variant >= 2;
        scene.camera.lens_radius = lens ? .1 : 0;
        BpPacked packed;
        pack(&scene, single, &packed);
        uint32_t slot[4] = {0};
        for (uint32_t s = 0; s < packed.tree.leaf_count * packed.tree.width; ++s)
            if (packed.tree.slot_sphere[s] != NO_SPHERE) slot[packed.tree.slot_sphere[s]] = s;
        double camera[28], power[4];
        for (size_t i = 0; i < 28; ++i) camera[i] = bp_reals_load(packed.camera, single, i);
        for (int i = 0; i < 4; ++i) {
            const size_t lane = slot[i] % 8, base = (size_t)(slot[i] - lane) * 4 + lane;
            double x[4];
            for (size_t a = 0; a < 4; ++a) x[a] = bp_reals_load(packed.tree.leaves, single, base + 8 * a);
            power[i] = sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]) / x[3] - 1;
        }
        assert_true(fabs(power[1]) < (single ? 0x1p-23 : 1e-15));
        assert_true(power[2] < -1e-13 && power[3] > 1e-13);
        const double *own = &camera[24], *inward = &camera[20];
        if (lens) {
            assert_true(own[0] == 65535 && own[1] == 65535 && inward[0] == 0);
        } else {
            assert_true(own[0] == slot[1] && own[1] == 0 && own[2] > 0 && own[2] < 1e-6);
            assert_true(fabs(inward[0] - .6) < 1e-7 && fabs(inward[1] - .8) < 1e-7 && fabs(inward[2]) < 1e-7);
        }
        bp_packed_clear(&packed);
    }
}

/* Of a slot, as the kernel finds it. */
static double colour_at(const BpPacked *packed, uint32_t slot, size_t channel) {
    const uint32_t place =
        slot < packed->coloured_slots ? slot : packed->coloured_slots + packed->slot_material[slot];
    assert_true(place < packed->colour_count);
    return bp_reals_load(packed->slot_albedo, packed->single_precision,
                         ALBEDO_REALS * (size_t)place + channel);
}

/* A slot of triangles has a colour only where some triangle brings its own. */
static void colours_of_triangles(void **state) {
    (void)state;
    BpScene scene = empty_scene();
    BpMaterial materials[] = {
        {.kind = BP_MATERIAL_LAMBERTIAN, .albedo = {.25, .5, .75}},
        {.kind = BP_MATERIAL_DIELECTRIC, .refraction_index = 1.5},
        {.kind = BP_MATERIAL_METAL, .albedo = {.5, .125, .875}},
    };
    float albedos[][3] = {{.0625f, .375f, 1}};
    BpSphere sphere = {.center = {0, 0, -9}, .radius = 1, .material = 2, .albedo = 0};
    BpTriangle triangles[40];
    for (int i = 0; i < 40; ++i)
        triangles[i] = (BpTriangle){.vertices = {{i, 0, -5}, {i + 1, 0, -5}, {i, 1, -5}},
                                    .material = (uint32_t)i % 3,
                                    .albedo = BP_NO_ALBEDO};
    scene.materials = materials;
    scene.material_count = 3;
    scene.spheres = &sphere;
    scene.sphere_count = 1;
    scene.triangles = triangles;
    scene.triangle_count = 40;
    scene.albedos = albedos;
    scene.albedo_count = 1;
    const double expected[3][3] = {{.25, .5, .75}, {1, 1, 1}, {.5, .125, .875}};
    for (int own = 0; own < 2; ++own) {
        if (own) triangles[18].albedo = triangles[19].albedo = 0; /* of a matte one and of a glass one */
        BpPacked packed;
        pack(&scene, true, &packed);
        const uint32_t slots = packed.tree.leaf_count * packed.tree.width;
        assert_int_equal(packed.coloured_slots, own ? slots : 8);
        assert_int_equal(packed.colour_count, own ? slots : 8 + packed.material_count);
        unsigned seen = 0;
        for (uint32_t s = 0; s < slots; ++s) {
            const uint32_t shape = packed.tree.slot_sphere[s];
            if (shape == NO_SPHERE) continue;
            const bool coloured = shape == 0 || (own && shape == 19);
            for (size_t a = 0; a < 3; ++a)
                assert_true(colour_at(&packed, s, a) ==
                            (coloured ? (double)albedos[0][a] : expected[(shape - 1) % 3][a]));
            ++seen;
        }
        assert_int_equal(seen, 41);
        bp_packed_clear(&packed);
    }
}

static void nothing_at_all(void **state) {
    (void)state;
    const BpScene scene = empty_scene();
    for (int single = 0; single < 2; ++single) {
        BpPacked packed;
        pack(&scene, single, &packed);
        assert_int_equal(packed.material_count, 1);
        assert_non_null(packed.materials);
        assert_non_null(packed.material_kinds);
        assert_non_null(packed.slot_material);
        assert_non_null(packed.slot_albedo);
        bp_packed_clear(&packed);
        assert_null(packed.materials);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(camera_along_minus_z),
        cmocka_unit_test(camera_anywhere),
        cmocka_unit_test(discs),
        cmocka_unit_test(extreme_vup),
        cmocka_unit_test(materials_and_looks),
        cmocka_unit_test(camera_on_a_sphere),
        cmocka_unit_test(colours_of_triangles),
        cmocka_unit_test(nothing_at_all),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
