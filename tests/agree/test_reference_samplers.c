/* test_reference_samplers.c: every direction and point the reference draws, against the law it should follow.
 */
#include "reference/trace.h"
#include "support/build_scene.h"
#include "support/uniformity.h"
#include "support/unit_test.h"

#include <stdio.h>

enum { COUNT = 4000000 };
static const double level = 1e-5;
static double points[COUNT * 3];

static void assert_uniform(const char *what, int dimensions) {
    const double p = uniformity(points, COUNT, dimensions);
    printf("%-28s p = %.4f\n", what, p);
    if (p < level) fail_msg("%s: p = %g", what, p);
}

/* A normal along no axis, and two directions across it. */
static const Vec normal = {0.36, 0.48, 0.8}, across = {0.8, -0.6, 0}, along = {0.48, 0.64, -0.6};

/* Scatters a ray that comes straight down the normal, COUNT times. */
static void scatter_many(const BpMaterial *material, void (*map)(Vec direction, double *point),
                         int dimensions) {
    BuiltScene built;
    built_scene_init(&built);
    const BpSphere sphere = {.radius = 1, .albedo = BP_NO_ALBEDO};
    const Ray ray = {.origin = {0, 0, 0}, .direction = scale(-3, normal)};
    const Hit hit = {.t = 1, .normal = normal, .front_face = true, .sphere = &sphere, .material = material};
    static uint64_t seed = 11; /* a new one for every sample, so that their p-values are independent */
    Random random = random_stream(seed++, 0, 0);
    for (size_t i = 0; i < COUNT; ++i) {
        Vec direction, attenuation;
        assert_true(bp_ref_scatter(&built.scene, &ray, &hit, &random, &direction, &attenuation));
        map(direction, &points[i * (size_t)dimensions]);
    }
}

static void map_lobe(Vec direction, double *point) {
    const Vec d = unit(direction);
    point[0] = dot(d, normal);
    point[1] = turn(dot(d, along), dot(d, across));
}
static void map_cosine_1(Vec direction, double *point) {
    map_lobe(direction, point);
    point[0] = point[0] * point[0]; /* density of the cosine: 2 c */
}
static void map_cosine_3(Vec direction, double *point) {
    map_lobe(direction, point);
    point[0] = pow(point[0], 4); /* 4 c^3 */
}
/* What was added to the mirror direction, which here is the normal, in units of the fuzz. */
static const double fuzz = 0.4;
static void map_fuzz_sphere(Vec direction, double *point) {
    const Vec p = scale(1 / fuzz, sub(direction, normal));
    point[0] = 0.5 * (1 + dot(p, normal));
    point[1] = turn(dot(p, along), dot(p, across));
    if (fabs(length2(p) - 1) > 1e-9) point[0] = -1; /* not on the sphere at all */
}
static void map_fuzz_ball(Vec direction, double *point) {
    const Vec p = scale(1 / fuzz, sub(direction, normal));
    const double r = sqrt(length2(p));
    point[0] = r * r * r;
    point[1] = 0.5 * (1 + dot(p, normal) / r);
    point[2] = turn(dot(p, along), dot(p, across));
}

static void lobes(void **state) {
    (void)state;
    BpMaterial material = {.kind = BP_MATERIAL_LAMBERTIAN, .scatter = BP_SCATTER_LAMBERTIAN};
    scatter_many(&material, map_cosine_1, 2);
    assert_uniform("lambertian", 2);
    material.scatter = BP_SCATTER_COSINE_CUBED;
    scatter_many(&material, map_cosine_3, 2);
    assert_uniform("cosine cubed", 2);
    material.scatter = BP_SCATTER_HEMISPHERE;
    scatter_many(&material, map_lobe, 2);
    assert_uniform("hemisphere", 2);
}

static void fuzzes(void **state) {
    (void)state;
    BpMaterial material = {.kind = BP_MATERIAL_METAL, .fuzz = fuzz, .fuzz_shape = BP_FUZZ_SPHERE};
    scatter_many(&material, map_fuzz_sphere, 2);
    assert_uniform("fuzz on the sphere", 2);
    material.fuzz_shape = BP_FUZZ_BALL;
    scatter_many(&material, map_fuzz_ball, 3);
    assert_uniform("fuzz in the ball", 3);
}

/* Lens and pixel of a camera that looks along -z, its plane in focus at 2: the viewport is 4 x 4. */
static void camera(void **state) {
    (void)state;
    BuiltScene built;
    built_scene_init(&built);
    BpCamera *scene_camera = &built.scene.camera;
    scene_camera->width = scene_camera->height = 4;
    scene_camera->focus_dist = 2;
    scene_camera->pixel_sampling = BP_PIXEL_SQUARE;
    scene_camera->lens_radius = 0.25;
    const Camera prepared = bp_ref_camera(scene_camera);
    double height;
    Random random = random_stream(12, 0, 0);
    for (size_t i = 0; i < COUNT; ++i) {
        const Vec o = bp_ref_camera_ray(&prepared, 1, 2, &random, &height).origin;
        assert_true(o.z == 0);
        points[2 * i] = (o.x * o.x + o.y * o.y) / (0.25 * 0.25);
        points[2 * i + 1] = turn(o.y, o.x);
    }
    assert_uniform("lens", 2);
    for (size_t i = 0; i < COUNT; ++i) {
        const Ray ray = bp_ref_camera_ray(&prepared, 1, 2, &random, &height);
        const Vec target = add(ray.origin, ray.direction); /* on the plane in focus */
        points[2 * i] = target.x + 1;                      /* pixel column 1 spans -1 .. 0 */
        points[2 * i + 1] = -target.y;                     /* row 2 spans 0 .. -1 */
    }
    assert_uniform("pixel", 2);
}

/* Streams: the first two numbers over pixels, over samples and over seeds, and the neighbours' correlation.
 */
static void streams(void **state) {
    (void)state;
    static const char *names[3] = {"streams over pixels", "streams over samples", "streams over seeds"};
    for (int kind = 0; kind < 3; ++kind) {
        double lag = 0, last = 0.5;
        for (uint64_t i = 0; i < COUNT; ++i) {
            Random random = random_stream(kind == 2 ? i : 7, kind == 0 ? i : 7, kind == 1 ? i : 7);
            points[2 * i] = random_real(&random);
            points[2 * i + 1] = random_real(&random);
            lag += (points[2 * i] - 0.5) * (last - 0.5);
            last = points[2 * i];
        }
        assert_uniform(names[kind], 2);
        const double z =
            lag * 12 / sqrt(COUNT); /* the variance of a product of two centred uniforms is 1/144 */
        assert_true(2 * bp_normal_upper(fabs(z)) > level);
    }
}

/* A test that cannot fail proves nothing: a 2 % contamination of a lobe by another one must be found. */
static void contamination(void **state) {
    (void)state;
    BpMaterial material = {.kind = BP_MATERIAL_LAMBERTIAN, .scatter = BP_SCATTER_LAMBERTIAN};
    scatter_many(&material, map_cosine_1, 2);
    for (size_t i = 0; i < COUNT; i += 50) points[2 * i] = sqrt(points[2 * i]); /* now density 4 c^3 */
    assert_true(uniformity(points, COUNT, 2) < level);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lobes),   cmocka_unit_test(fuzzes),        cmocka_unit_test(camera),
        cmocka_unit_test(streams), cmocka_unit_test(contamination),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
