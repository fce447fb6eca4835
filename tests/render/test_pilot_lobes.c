/* test_pilot_lobes.c: what narrow lobes do to the light of small lamps (host/render/pilot_lobes.h): densities
 * against the kernels', and what a path finds against paths that are drawn. */
#include "base/random.h"
#include "render/pilot_lobes.h"
#include "support/build_scene.h"
#include "support/probe.h"

#include <math.h>
#include <string.h>

#define PI 3.14159265358979323846

static void assert_near(double found, double expected, double relative, const char *what) {
    if (!(fabs(found - expected) <= relative * fabs(expected)))
        fail_msg("%s: %.17g, expected %.17g", what, found, expected);
}

/* ---- densities ---- */

enum { LOBES = 7, TO = 8, FROM = 64, AROUND = 4, DIRECTIONS = TO * FROM * AROUND };

static const char probe_text[] =
    "__kernel void densities(uint first, uint second, __global float *out) {\n"
    "    const uint i = get_global_id(0), number = i / 2048u;\n"
    "    const float roughness[7] = {0.0f, 0.0f, 0.3f, 0.6f, 0.3f, 0.3f, 0.6f}, turns[8] = {1, 0, 0.6f, "
    "0.8f, 0, -1, -0.8f, 0.6f};\n"
    "    const float up = ((float)(i % 8u) + 0.5f) / 8.0f, c = 1.0f - ((float)(i / 8u % 64u) + 0.5f) / "
    "32.0f;\n"
    "    const uint turn = i / 512u % 4u;\n"
    "    Lobe lobe;\n"
    "    lobe.normal = vec3(splat(0), splat(0), splat(1));\n"
    "    lobe.outgoing = vec3(splat(sqrt(1.0f - up * up)), splat(0), splat(up));\n"
    "    lobe.axis = number < 2u ? vec3(splat(-sqrt(1.0f - up * up)), splat(0), splat(up)) : lobe.normal;\n"
    "    lobe.fuzz = splat(number < 2u ? 0.5f : roughness[number] * roughness[number]);\n"
    "    lobe.kind = splat_uint(number == 0u ? LOBE_FUZZ_SPHERE : number == 1u ? LOBE_FUZZ_BALL : number < "
    "4u ? LOBE_ROUGH_METAL : "
    "LOBE_ROUGH_DIELECTRIC);\n"
    "    lobe.refraction_index = splat(number == 4u ? 1.5f : 1.0f / 1.5f);\n"
    "    const float s = sqrt(1.0f - c * c);\n"
    "    const Vec3 direction = vec3(splat(s * turns[2u * turn]), splat(s * turns[2u * turn + 1u]), "
    "splat(c));\n"
    "    out[i] = number < 2u ? metal_pdf(&lobe, direction, 0) : number < 4u ? rough_metal_pdf(&lobe, "
    "direction) : "
    "rough_dielectric_pdf(&lobe, direction);\n"
    "}\n";

static BpMaterial lobe_of(int number) {
    BpMaterial material = {.kind = number < 2   ? BP_MATERIAL_METAL
                                   : number < 4 ? BP_MATERIAL_ROUGH_METAL
                                                : BP_MATERIAL_ROUGH_DIELECTRIC};
    material.fuzz = 0.5;
    material.fuzz_shape = number == 0 ? BP_FUZZ_SPHERE : BP_FUZZ_BALL;
    static const double roughness[LOBES] = {0, 0, 0.3, 0.6, 0.3, 0.3, 0.6};
    material.roughness = roughness[number];
    material.refraction_index = 1.5;
    return material;
}

static void densities_are_the_kernels(void **state) {
    (void)state;
    static const double turns[AROUND][2] = {{1, 0}, {0.6, 0.8}, {0, -1}, {-0.8, 0.6}};
    static float found[LOBES * DIRECTIONS];
    Probe probe;
    probe_open(&probe, probe_text);
    probe_run(&probe, "densities", 0, 0, LOBES * DIRECTIONS, found, sizeof found);
    probe_close(&probe);
    size_t above = 0, below = 0;
    for (int i = 0; i < LOBES * DIRECTIONS; ++i) {
        const int lobe = i / DIRECTIONS, turn = i / (TO * FROM) % AROUND;
        const double up = (i % TO + 0.5) / TO, c = 1 - (i / TO % FROM + 0.5) / (FROM / 2);
        const double s = sqrt(1 - c * c);
        const BpMaterial material = lobe_of(lobe);
        const BpPilotTurn turned = {.normal = {0, 0, 1},
                                    .leaves = {sqrt(1 - up * up), 0, up},
                                    .to_light = {s * turns[turn][0], s * turns[turn][1], c},
                                    .index = lobe == 4 ? 1.5 : 1 / 1.5};
        const double density = bp_pilot_lobe_density(&material, &turned);
        /* What lies below metal is absorbed; nothing asks for it. */
        if (c < 0 && material.kind != BP_MATERIAL_ROUGH_DIELECTRIC) continue;
        above += density > 0 && c > 0;
        below += density > 0 && c < 0;
        if (!(fabs((double)found[i] - density) <= 2e-4 * density + 1e-5))
            fail_msg("lobe %d, direction %d: %.9g, the kernel's %.9g", lobe, i % DIRECTIONS, density,
                     (double)found[i]);
    }
    assert_true(above > 4000 && below > 400);
}

/* ---- what a path finds ---- */

static BpPilotLight sun(double half_angle) {
    const double sine = sin(0.5 * half_angle);
    return (BpPilotLight){
        .distant = true, .place = {0, 0, 1}, .cap = 2 * sine * sine, .radiance = {1, 1, 1}, .share = 1};
}

/* A surface that mirrors the sun straight up. */
static BpPilotTurn upright(void) {
    return (BpPilotTurn){.normal = {0, 0, 1}, .leaves = {0, 0, 1}, .to_light = {0, 0, 1}, .index = 1.5};
}

/* Both ways to the light by the power heuristic, drawn: its mean of squares over its mean. */
static void glints_are_those_of_paths(void **state) {
    (void)state;
    enum { DRAWN = 400000, CASES = 8 };
    static const BpScene scene = {0};
    BpRandom random = {.state = 5};
    for (int i = 0; i < CASES; ++i) {
        BpMaterial material = {.kind = BP_MATERIAL_ROUGH_METAL, .roughness = 0.4};
        const BpPilotTurn turn = upright();
        const double half_angle = 0.02 + 0.02 * i;
        BpPilotLight lights[2] = {sun(half_angle), sun(half_angle)};
        lights[1].radiance[0] = lights[1].radiance[1] = lights[1].radiance[2] = 3;
        const size_t count = i % 2 == 0 ? 1 : 2;
        const double chosen = count == 1 ? 1 : 0.25;
        double mean;
        const double glint = bp_pilot_glint(&scene, lights, count, &lights[0], &material, &turn, &mean);
        const double solid_angle = 2 * PI * lights[0].cap;
        /* GGX upright: D / 4 */
        const double density = 1 / (4 * PI * pow(material.roughness, 4)),
                     ratio = density * solid_angle / chosen;
        double sum = 0, squares = 0;
        assert_near(mean, density * solid_angle, 1e-9, "the mean");
        for (int n = 0; n < DRAWN; ++n) {
            const bool sent = bp_random_next(&random) < chosen,
                       meets = bp_random_next(&random) < density * solid_angle;
            const double light = (sent ? ratio : 0) + (meets ? ratio * ratio : 0);
            sum += light / (1 + ratio * ratio);
            squares += light * light / ((1 + ratio * ratio) * (1 + ratio * ratio));
        }
        assert_near(sum / DRAWN, mean, 0.02, "the mean of what is drawn");
        assert_near(glint, squares / sum, 0.02, "the mean of squares over the mean");
    }
}

/* A lamp that the cone of fuzzy metal does not touch is not chosen. */
static void fuzz_chooses_what_it_sees(void **state) {
    (void)state;
    static const BpScene scene = {0};
    const BpMaterial material = {.kind = BP_MATERIAL_METAL, .fuzz = 0.1};
    const BpPilotTurn turn = upright();
    BpPilotLight lights[2] = {sun(0.01), sun(0.01)};
    double mean, alone;
    lights[1].place[0] = 1;
    bp_pilot_glint(&scene, lights, 1, &lights[0], &material, &turn, &alone);
    const double one = bp_pilot_glint(&scene, lights, 1, &lights[0], &material, &turn, &mean);
    const double two = bp_pilot_glint(&scene, lights, 2, &lights[0], &material, &turn, &mean);
    assert_near(two, one, 1e-12, "a light that the lobe does not see");
    lights[1].place[0] = 0;
    assert_near(bp_pilot_glint(&scene, lights, 2, &lights[0], &material, &turn, &mean), 2 * one, 0.01,
                "a light of two that are alike");
}

/* Over all directions of a mirror: the mean is the light's solid angle, since a lobe comes to one; and the
 * squares by rings as fine as the pole of fuzz needs. */
static void glints_around(void **state) {
    (void)state;
    enum { STEPS = 400000 };
    static const BpScene scene = {0};
    static const double widths[] = {0.02, 0.1, 0.4};
    for (int i = 0; i < 6; ++i) {
        const bool fuzzy = i < 3;
        const double width = widths[i % 3], alpha = width / 2;
        const BpMaterial material = {.kind = fuzzy ? BP_MATERIAL_METAL : BP_MATERIAL_ROUGH_METAL,
                                     .fuzz = width,
                                     .roughness = sqrt(alpha)};
        const BpPilotLight light = sun(0.004);
        const double solid_angle = 2 * PI * light.cap;
        const BpPilotTurn turn = upright();
        double mean, expected = 0, squares = 0;
        const double glint = bp_pilot_glint_around(&scene, &light, 1, &light, &material, &turn, &mean);
        for (int n = 0; n < STEPS; ++n) {
            /* Rings of equal growth: of fuzz toward the rim, of facets from the middle. */
            const double high = exp(-16.0 * n / STEPS), low = exp(-16.0 * (n + 1) / STEPS),
                         x = 0.5 * (high + low);
            double area, density;
            if (fuzzy) { /* sin^2 = f^2 (1 - x^2), h = f x */
                const double sine2 = width * width * (1 - x * x), cosine2 = 1 - sine2;
                area = 2 * PI * width * width * x * (high - low);
                density = (cosine2 + width * width * x * x) / (2 * PI * width * width * x);
            } else { /* the angle t, in parts of its most */
                const double t = x * 4 * width, tangent = tan(t / 2), most = 4 * width;
                if (sin(t) >= 1 || t > PI / 2) continue;
                const double c2 = 1 / (1 + tangent * tangent), spread = alpha * alpha * c2 + 1 - c2;
                area = 2 * PI * sin(t) * most * (high - low);
                density = alpha * alpha / (4 * PI * spread * spread);
            }
            const double r = density * solid_angle, whole = 1 + r * r;
            expected += area * r;
            squares += area * r * r * (1 + 2 * r * r + r * r * r) / (whole * whole);
        }
        assert_near(mean, expected, 0.06, "the mean");
        /* The rings grow by a quarter. */
        assert_near(glint * mean, squares, 0.1, "the mean of squares");
        assert_near(mean, solid_angle, fuzzy ? 0.12 : 0.2, "a lobe that comes to one");
    }
}

/* By the laws of reflection and refraction. */
static void smooth_turns(void **state) {
    (void)state;
    BpPilotTurn turn = {.normal = {0, 0, 1}, .leaves = {0.6, 0, 0.8}, .index = 1.5};
    assert_true(bp_pilot_turn_smooth(false, &turn));
    assert_near(turn.to_light[0], -0.6, 1e-12, "reflected");
    assert_near(turn.to_light[2], 0.8, 1e-12, "reflected");
    assert_true(bp_pilot_turn_smooth(true, &turn));
    assert_near(turn.to_light[0], -0.4, 1e-12, "refracted");
    assert_near(turn.to_light[2], -sqrt(1 - 0.16), 1e-12, "refracted");
    turn.index = 0.5;
    assert_false(bp_pilot_turn_smooth(true, &turn));
    assert_near(bp_pilot_reflectance(1, 1.5), 0.04, 1e-12, "upright");
    assert_near(bp_pilot_reflectance(0.3, 0.9), 1, 1e-12, "total");
}

/* Of spheres, triangles and discs. */
static void solid_angles(void **state) {
    (void)state;
    BuiltScene built;
    built_scene_init(&built);
    BpTriangle triangle = {.vertices = {{-0.01, 0, 5}, {0.02, 0, 5}, {0, 0.01, 5}}};
    built_sphere(&built, 0, 0, 2, 1, built_material(&built, BP_MATERIAL_LAMBERTIAN, 1, NULL));
    built.scene.triangles = &triangle;
    built.scene.triangle_count = 1;
    const double here[3] = {0};
    const BpPilotLight disc = sun(0.1), ball = {.shape = 0, .place = {0, 0, 2}, .radius = 1};
    const BpPilotLight flat = {.shape = 1, .place = {0, 0, 5}, .radius = sqrt(0.00015 / PI)};
    assert_near(bp_pilot_solid_angle(&built.scene, &disc, here), 2 * PI * (1 - cos(0.1)), 1e-9, "a disc");
    assert_near(bp_pilot_solid_angle(&built.scene, &ball, here), 2 * PI * (1 - sqrt(0.75)), 1e-9, "a sphere");
    assert_near(bp_pilot_solid_angle(&built.scene, &flat, here), 0.00015 / 25, 1e-4, "a triangle");
    const double aside[3] = {5, 0, 0};
    assert_near(bp_pilot_solid_angle(&built.scene, &flat, aside), 0.00015 / 50 * sqrt(0.5), 1e-2, "tilted");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(densities_are_the_kernels),
        cmocka_unit_test(glints_are_those_of_paths),
        cmocka_unit_test(fuzz_chooses_what_it_sees),
        cmocka_unit_test(glints_around),
        cmocka_unit_test(smooth_turns),
        cmocka_unit_test(solid_angles),
    };
    return cmocka_run_group_tests_name("pilot_lobes", tests, NULL, NULL);
}
