/* test_camera_moves.c: cameras that a person moves (host/scene/camera_moves.h). */
#include "support/unit_test.h"

#include "scene/camera_moves.h"

#include <math.h>

static BpCamera camera_at(double x, double y, double z) {
    return (BpCamera){.width = 100,
                      .height = 50,
                      .vfov_degrees = 40,
                      .lookfrom = {x, y, z},
                      .lookat = {1, 2, 3},
                      .vup = {0, 2, 0},
                      .focus_dist = 5,
                      .lens_radius = 0.25,
                      .fit = BP_FIT_SCENE};
}

static double distance(const double a[3], const double b[3]) {
    double sum = 0;
    for (int i = 0; i < 3; ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
    return sqrt(sum);
}

static void near(const double a[3], double x, double y, double z) {
    const double b[3] = {x, y, z};
    assert_true(distance(a, b) < 1e-9);
}

static void orbits(void **state) {
    (void)state;
    BpCamera camera = camera_at(1, 2, 13);
    bp_camera_orbit(&camera, 90, 0); /* from the front to the right */
    near(camera.lookfrom, 11, 2, 3);
    near(camera.lookat, 1, 2, 3);
    assert_int_equal(camera.fit, BP_FIT_NONE);
    bp_camera_orbit(&camera, 0, 30);
    near(camera.lookfrom, 1 + 10 * cos(atan(1) * 4 / 6), 7, 3);
    bp_camera_orbit(&camera, 0, 500); /* not over the pole */
    assert_true(fabs(distance(camera.lookfrom, camera.lookat) - 10) < 1e-9);
    assert_true(camera.lookfrom[1] < 12 && camera.lookfrom[1] > 11.99);
    bp_camera_orbit(&camera, 0, -1000);
    assert_true(camera.lookfrom[1] > -8 && camera.lookfrom[1] < -7.99);
    for (int i = 0; i < 360; ++i) bp_camera_orbit(&camera, 1, 0);
    assert_true(fabs(distance(camera.lookfrom, camera.lookat) - 10) < 1e-9);
}

/* What was at lookat lies where the drag has put it. */
static void pans(void **state) {
    (void)state;
    BpCamera camera = camera_at(1, 2, 13);
    bp_camera_pan(&camera, 0.5, 0.25);
    const double height = 20 * tan(20 * atan(1) * 4 / 180);
    near(camera.lookat, 1 - 0.5 * height, 2 + 0.25 * height, 3);
    near(camera.lookfrom, 1 - 0.5 * height, 2 + 0.25 * height, 13);
    camera = camera_at(1, 2, 13);
    camera.projection = BP_ORTHOGRAPHIC;
    camera.view_height = 8;
    bp_camera_pan(&camera, 0.5, 0.25);
    near(camera.lookat, -3, 4, 3);
}

static void approaches(void **state) {
    (void)state;
    BpCamera camera = camera_at(1, 2, 13);
    camera.view_height = 3;
    bp_camera_approach(&camera, 0.8);
    near(camera.lookfrom, 1, 2, 11);
    assert_true(fabs(camera.view_height - 2.4) < 1e-12);
    assert_true(fabs(camera.focus_dist - 3) < 1e-12);     /* the same plane is sharp */
    assert_true(fabs(camera.lens_radius - 0.15) < 1e-12); /* the cone keeps its angle */
    bp_camera_approach(&camera, 0.5);                     /* the plane in focus would lie behind the camera */
    near(camera.lookfrom, 1, 2, 7);
    assert_true(camera.focus_dist > 0);
    for (int i = 0; i < 1000; ++i) bp_camera_approach(&camera, 0.5);
    assert_true(distance(camera.lookfrom, camera.lookat) > 0);
    for (int i = 0; i < 1000; ++i) bp_camera_approach(&camera, 2);
    assert_true(isfinite(camera.lookfrom[2]) && camera.lookfrom[2] <= 1.1e12);
}

static void lenses(void **state) {
    (void)state;
    BpCamera camera = camera_at(1, 2, 13);
    bp_camera_focus(&camera, 10);
    assert_true(camera.focus_dist == 10 && camera.lens_radius == 0.5);
    bp_camera_focus(&camera, -1);
    assert_true(camera.focus_dist == 10);
    for (int i = 0; i < 100; ++i) bp_camera_widen(&camera, 0.8);
    assert_true(camera.lens_radius == 0);
    bp_camera_widen(&camera, 0.8);
    assert_true(camera.lens_radius == 0);
    bp_camera_widen(&camera, 1.25);
    assert_true(camera.lens_radius > 0);
    for (int i = 0; i < 100; ++i) bp_camera_widen(&camera, 1.25);
    assert_true(camera.lens_radius <= camera.focus_dist);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(orbits), cmocka_unit_test(pans),
                                       cmocka_unit_test(approaches), cmocka_unit_test(lenses)};
    return cmocka_run_group_tests_name("camera_moves", tests, NULL, NULL);
}
