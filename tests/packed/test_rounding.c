/* test_rounding.c: scenes that single precision cannot hold are named, others are not. */
#include "packed/rounding.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static BpRoundingWarnings limits_of(const char *camera, const char *spheres, BpPrecision precision) {
    char text[1024];
    BpScene *scene = NULL;
    BpError err = {0};
    BpRoundingWarnings limits;
    snprintf(
        text, sizeof text,
        "{\"format\":1,\"camera\":{%s},\"materials\":{\"m\":{\"type\":\"lambertian\",\"albedo\":[1,1,1]},"
        "\"g\":{\"type\":\"dielectric\",\"refraction_index\":1.5}},\"spheres\":[%s]}",
        camera, spheres);
    if (bp_scene_parse(text, strlen(text), "test", &scene, &err) != BP_OK) fail_msg("%s", err.message);
    bp_rounding_warnings(scene, precision, &limits);
    bp_scene_destroy(&scene);
    return limits;
}

static void off_its_place(void **state) {
    (void)state;
    const char *far = "{\"center\":[100000.003,0,0],\"radius\":0.01,\"material\":\"m\"}";
    const BpRoundingWarnings warned = limits_of("", far, BP_PRECISION_SINGLE);
    assert_int_equal(warned.count, 1);
    assert_non_null(strstr(warned.text[0], "spheres[0] (radius 0.01) is displaced by"));
    assert_string_equal(warned.remedy[0], "a camera closer to it");
    assert_int_equal(limits_of("", far, BP_PRECISION_DOUBLE).count, 0);
    /* Seen from nearby all is well: what counts is the distance from the camera. */
    assert_int_equal(limits_of("\"lookfrom\":[100000.0,0,1]", far, BP_PRECISION_SINGLE).count, 0);
}

/* 100000.003 becomes 100000, 0.003 away. */
static void off_their_vertices(void **state) {
    (void)state;
    const char *small = "],\"triangles\":[{\"material\":\"m\",\"vertices\":"
                        "[[100000.003,0,0],[100000.003,0.2,0],[100000.003,0,1]]}",
               *large = "],\"triangles\":[{\"material\":\"m\",\"vertices\":"
                        "[[100000.003,0,0],[100000.003,0.4,0],[100000.003,0,1]]}",
               *lens = "\"focus_dist\":10,\"aperture\":1e10";
    const BpRoundingWarnings warned = limits_of("", small, BP_PRECISION_SINGLE);
    assert_int_equal(warned.count, 1);
    assert_string_equal(warned.text[0],
                        "a vertex of triangles[0] is displaced by 0.015 of the shortest edge in "
                        "single precision");
    assert_string_equal(warned.remedy[0], "a camera closer to it");
    assert_int_equal(limits_of("", large, BP_PRECISION_SINGLE).count, 0);
    assert_int_equal(limits_of("", small, BP_PRECISION_DOUBLE).count, 0);
    assert_int_equal(limits_of("\"lookfrom\":[100000.0,0,1]", small, BP_PRECISION_SINGLE).count, 0);
    assert_int_equal(limits_of(lens, large, BP_PRECISION_SINGLE).count, 1); /* no sphere is needed for that */
}

/* The lens at which a tenth of a pixel is passed: 100 pixels are 20 high at 10, and 0.02 is 2^-24 of 335544.
 */
static void large_lens(void **state) {
    (void)state;
    const char *ball = "{\"center\":[0,0,-10],\"radius\":3,\"material\":\"m\"}";
    const char *large = "\"image_width\":300,\"image_height\":100,\"focus_dist\":10,\"aperture\":672000",
               *fine = "\"image_width\":300,\"image_height\":100,\"focus_dist\":10,\"aperture\":671000",
               *huge = "\"focus_dist\":10,\"aperture\":1e10", *far = "\"focus_dist\":1e10,\"aperture\":1e10";
    const BpRoundingWarnings warned = limits_of(large, ball, BP_PRECISION_SINGLE);
    assert_int_equal(warned.count, 1);
    assert_non_null(strstr(warned.text[0], "the lens (radius 336000)"));
    assert_string_equal(warned.remedy[0], "a smaller aperture");
    assert_int_equal(limits_of(fine, ball, BP_PRECISION_SINGLE).count, 0);
    assert_int_equal(limits_of(huge, ball, BP_PRECISION_SINGLE).count, 1);
    assert_int_equal(limits_of(huge, ball, BP_PRECISION_DOUBLE).count, 0);
    assert_int_equal(limits_of(far, ball, BP_PRECISION_SINGLE).count, 0);
}

static void off_its_neighbours(void **state) {
    (void)state;
    const char *ground = "{\"center\":[0,-1000000.01,0],\"radius\":1000000,\"material\":\"m\"},"
                         "{\"center\":[0,0.2,0],\"radius\":0.2,\"material\":\"m\"}";
    const BpRoundingWarnings warned = limits_of("\"lookfrom\":[0,1,5]", ground, BP_PRECISION_SINGLE);
    assert_int_equal(warned.count, 1);
    assert_non_null(strstr(warned.text[0], "the surface of spheres[0] (radius 1e+06)"));
    assert_non_null(strstr(warned.text[0], "of spheres[1] (0.2)"));
    const char *book = "{\"center\":[0,-1000,0],\"radius\":1000,\"material\":\"m\"},"
                       "{\"center\":[0,0.2,0],\"radius\":0.2,\"material\":\"m\"}";
    assert_int_equal(limits_of("\"lookfrom\":[13,2,3]", book, BP_PRECISION_SINGLE).count, 0);
}

/* A bead of 2e-4 on the book's ground: which camera sees it decides how the ground's centre is rounded. */
static void beads_on_the_ground(void **state) {
    (void)state;
    const char *bead = "{\"center\":[0,-1000,0],\"radius\":1000,\"material\":\"m\"},"
                       "{\"center\":[0,0.0002,0],\"radius\":0.0002,\"material\":\"g\"}";
    static const char *const cameras[] = {
        "\"lookfrom\":[0,0.0004,0.0016]", "\"lookfrom\":[0,0.000411,0.0016]",
        "\"lookfrom\":[0,0.00048,0.0016]", "\"lookfrom\":[0,0.00055,0.0016]"};
    for (size_t i = 0; i < sizeof cameras / sizeof *cameras; ++i) {
        const double y = strtod(strstr(cameras[i], ",") + 1, NULL), down = -1000 - y;
        volatile float rounded = (float)down;
        const double part = fabs((double)rounded - down) / 0.0002;
        const BpRoundingWarnings warned = limits_of(cameras[i], bead, BP_PRECISION_SINGLE);
        assert_int_equal(warned.count, part > 0.02);
        if (warned.count == 0) continue;
        assert_non_null(strstr(warned.text[0], "the surface of spheres[0] (radius 1000) is displaced by"));
        assert_non_null(strstr(warned.text[0], "of the radius of spheres[1] (0.0002)"));
        assert_int_equal(strncmp(warned.remedy[0], "a radius below ", 15), 0);
        assert_int_equal(limits_of(cameras[i], bead, BP_PRECISION_DOUBLE).count, 0);
    }
    /* Where float has the numbers exactly, nothing moves, and nothing is said. */
    assert_int_equal(limits_of("\"lookfrom\":[0,0.00048828125,0.0016]", bead, BP_PRECISION_SINGLE).count, 0);
}

static void thin_walls(void **state) {
    (void)state;
    const char *thin = "{\"center\":[0,0,-3],\"radius\":0.5,\"material\":\"g\"},"
                       "{\"center\":[0,0,-3],\"radius\":-0.49999915,\"material\":\"g\"}";
    const char *thick = "{\"center\":[0,0,-3],\"radius\":0.5,\"material\":\"g\"},"
                        "{\"center\":[0,0,-3],\"radius\":-0.45,\"material\":\"g\"}";
    const BpRoundingWarnings warned = limits_of("", thin, BP_PRECISION_SINGLE);
    assert_int_equal(warned.count, 1);
    assert_non_null(strstr(warned.text[0], "the wall between spheres[1]"));
    assert_int_equal(limits_of("", thick, BP_PRECISION_SINGLE).count, 0);
    assert_int_equal(limits_of("", "", BP_PRECISION_SINGLE).count, 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(off_its_place),       cmocka_unit_test(off_their_vertices),
        cmocka_unit_test(large_lens),          cmocka_unit_test(off_its_neighbours),
        cmocka_unit_test(beads_on_the_ground), cmocka_unit_test(thin_walls)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
