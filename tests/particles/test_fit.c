/* test_fit.c: the camera that is fitted to spheres: none outside the margin, none smaller than it could be.
 *
 * The silhouette of a sphere is checked by its tangents from the camera, in the plane of each axis of the
 * picture; the camera is fitted by planes, so the two share no formula. */
#include "scene/fit.h"
#include "support/unit_test.h"

#include "base/random.h"

#include <math.h>
#include <string.h>

enum { SETS = 50, MOST = 200 };

static double dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double out[3]) {
    for (int i = 0; i < 3; i++) out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

static void unit(double v[3]) {
    const double length = sqrt(dot(v, v));
    for (int i = 0; i < 3; i++) v[i] /= length;
}

/* The bounds of the silhouettes, in halves of the picture's width and height. */
static void silhouette(const BpCamera *camera, const BpSphere *spheres, size_t count, double low[2],
                       double high[2]) {
    double forward[3], right[3], up[3];
    for (int i = 0; i < 3; i++) forward[i] = camera->lookat[i] - camera->lookfrom[i];
    unit(forward);
    cross(forward, camera->vup, right);
    unit(right);
    cross(right, forward, up);
    const double tangent = tan(camera->vfov_degrees * (3.14159265358979323846 / 360));
    const double halves[2] = {tangent * camera->width / camera->height, tangent};
    low[0] = low[1] = INFINITY;
    high[0] = high[1] = -INFINITY;
    for (size_t i = 0; i < count; i++) {
        double c[3];
        for (int k = 0; k < 3; k++) c[k] = spheres[i].center[k] - camera->lookfrom[k];
        const double places[2] = {dot(c, right), dot(c, up)}, depth = dot(c, forward);
        const double radius = fabs(spheres[i].radius);
        if (camera->projection == BP_ORTHOGRAPHIC) {
            assert_true(depth > radius); /* ahead of the plane on which rays begin */
            for (int a = 0; a < 2; a++) {
                const double half = camera->view_height / 2 * (a == 0 ? halves[0] / halves[1] : 1);
                low[a] = fmin(low[a], (places[a] - radius) / half);
                high[a] = fmax(high[a], (places[a] + radius) / half);
            }
            continue;
        }
        for (int a = 0; a < 2; a++) {
            const double distance = hypot(places[a], depth);
            assert_true(distance > fabs(spheres[i].radius));
            const double middle = atan2(places[a], depth), half = asin(fabs(spheres[i].radius) / distance);
            assert_true(fabs(middle) + half < 3.14159265358979323846 / 2);
            low[a] = fmin(low[a], tan(middle - half) / halves[a]);
            high[a] = fmax(high[a], tan(middle + half) / halves[a]);
        }
    }
}

static size_t random_set(BpRandom *random, BpSphere *spheres, double offset) {
    const size_t count = 1 + (size_t)(bp_random_next(random) * MOST) % MOST;
    double size[3];
    for (int c = 0; c < 3; c++) size[c] = pow(10, 2 * bp_random_next(random) - 1);
    for (size_t i = 0; i < count; i++) {
        spheres[i] = (BpSphere){.radius = 0.01 + 0.3 * bp_random_next(random)};
        for (int c = 0; c < 3; c++)
            spheres[i].center[c] = offset + size[c] * (2 * bp_random_next(random) - 1);
    }
    return count;
}

static void random_camera(BpRandom *random, BpCamera *camera, double direction[3]) {
    bp_camera_defaults(camera);
    camera->width = 100 + (uint32_t)(bp_random_next(random) * 900);
    camera->height = 100 + (uint32_t)(bp_random_next(random) * 900);
    camera->vfov_degrees = 1 + 110 * bp_random_next(random);
    if (bp_random_next(random) < 0.4) camera->projection = BP_ORTHOGRAPHIC;
    for (int c = 0; c < 3; c++) {
        direction[c] = 2 * bp_random_next(random) - 1;
        camera->vup[c] = 2 * bp_random_next(random) - 1;
    }
}

static void fills_the_picture(void **state) {
    (void)state;
    BpRandom random = {7};
    BpSphere spheres[MOST];
    for (int set = 0; set < SETS; set++) {
        BpCamera camera;
        double direction[3], low[2], high[2];
        const double margin = set % 3 == 0 ? 0 : BP_FIT_MARGIN;
        const size_t count = random_set(&random, spheres, set % 5 == 0 ? 1e6 : 0);
        random_camera(&random, &camera, direction);
        assert_int_equal(bp_camera_fit(spheres, count, direction, margin, &camera, NULL), BP_OK);
        silhouette(&camera, spheres, count, low, high);
        const double inside = 1 - 2 * margin, rounding = 1e-6;
        bool touches = false;
        for (int a = 0; a < 2; a++) {
            assert_true(low[a] >= -inside - rounding && high[a] <= inside + rounding);
            touches |= low[a] < -inside + rounding && high[a] > inside - rounding;
        }
        assert_true(touches);
        const double width = (high[0] - low[0]) / 2 * camera.width,
                     height = (high[1] - low[1]) / 2 * camera.height;
        assert_true(fmax(width, height) >= 0.85 * fmin(camera.width, camera.height));
    }
}

static void turns_inside_the_picture(void **state) {
    (void)state;
    BpRandom random = {8};
    BpSphere spheres[MOST];
    for (int set = 0; set < SETS; set++) {
        BpCamera camera;
        double direction[3], largest = 0;
        const size_t count = random_set(&random, spheres, 0);
        random_camera(&random, &camera, direction);
        assert_int_equal(bp_camera_fit_turning(spheres, count, direction, BP_FIT_MARGIN, 12, &camera, NULL),
                         BP_OK);
        for (int step = 0; step < 12; step++) {
            BpCamera turned = camera;
            double low[2], high[2];
            bp_camera_turn(&turned, 30.0 * step);
            silhouette(&turned, spheres, count, low, high);
            for (int a = 0; a < 2; a++) largest = fmax(largest, fmax(-low[a], high[a]));
        }
        assert_true(fabs(largest - (1 - 2 * BP_FIT_MARGIN)) < 1e-6);
    }
}

static void looks_along_the_axis_that_is_up(void **state) {
    (void)state;
    const BpSphere spheres[2] = {{.center = {1, 2, 3}, .radius = 1}, {.center = {4, 5, 6}, .radius = 0.5}};
    for (int view = BP_VIEW_THREE_QUARTER; view < BP_VIEW_COUNT; view++) {
        for (int up = 0; up < 3; up++) {
            BpCamera camera;
            double direction[3], low[2], high[2];
            bp_camera_defaults(&camera);
            for (int c = 0; c < 3; c++) camera.vup[c] = c == up;
            bp_view_direction((BpView)view, up, direction);
            assert_int_equal(bp_camera_fit(spheres, 2, direction, 0, &camera, NULL), BP_OK);
            silhouette(&camera, spheres, 2, low, high);
            assert_true(high[0] > 1 - 1e-9 || high[1] > 1 - 1e-9);
        }
    }
    double direction[3];
    bp_view_direction(BP_VIEW_FRONT, 2, direction);
    assert_true(direction[1] == -1);
    bp_view_direction(BP_VIEW_TOP, 2, direction);
    assert_true(direction[2] == 1);
}

static void refuses(void **state) {
    (void)state;
    const BpSphere sphere = {.radius = 1},
                   far[2] = {{.center = {1e12}, .radius = 1}, {.center = {-1e12}, .radius = 1}};
    const double direction[3] = {0, 0, 1}, none[3] = {0, 0, 0};
    BpCamera camera;
    bp_camera_defaults(&camera);
    assert_int_equal(bp_camera_fit(&sphere, 0, direction, 0, &camera, NULL), BP_ERR_SCENE);
    assert_int_equal(bp_camera_fit(&sphere, 1, none, 0, &camera, NULL), BP_ERR_SCENE);
    camera.vfov_degrees = 1;
    assert_int_equal(bp_camera_fit(far, 2, direction, 0, &camera, NULL), BP_ERR_SCENE);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fills_the_picture), cmocka_unit_test(turns_inside_the_picture),
        cmocka_unit_test(looks_along_the_axis_that_is_up), cmocka_unit_test(refuses)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
