/* test_pilot_lights.c: the paths of a pilot begin at lights and are aimed (host/render/pilot_lights.h): what
 * they stand for comes to the area times solid angle times cosine of all ways from a light to a sphere, known
 * on paper, and what is too much for the lists is left out without bias. */
#include "render/pilot_lights.h"
#include "render/pilot_shapes.h"
#include "support/build_scene.h"
#include "support/unit_test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846

static void assert_near(double found, double expected, double relative, const char *what) {
    if (!(fabs(found - expected) <= relative * fabs(expected)))
        fail_msg("%s: %.10g, expected %.10g", what, found, expected);
}

static uint32_t lamp_of(BuiltScene *built, double radiance) {
    BpMaterial *lamp = NULL;
    const uint32_t index = built_material(built, BP_MATERIAL_DIFFUSE_LIGHT, 0, &lamp);
    for (int c = 0; c < 3; ++c) lamp->emit[c] = radiance;
    return index;
}

static void add_disc(BuiltScene *built, double x, double y, double z, double half_angle) {
    built->scene.discs[built->scene.disc_count++] = (BpDisc){.direction = {x, y, z},
                                                             .half_angle_degrees = half_angle,
                                                             .radiance = {1, 1, 1},
                                                             .visible_to_camera = true};
}

/* Every path from the light flies at the ball that it is aimed at; one without a measure flies nowhere. */
static void assert_aimed(const BpScene *scene, const BpPilotAim *aim, const BpPilotStart *start) {
    const uint32_t number = aim->pairs[start->pair].target;
    double to[3], center[3], along = 0, away2 = 0;
    const double radius = bp_pilot_ball(scene, aim->targets[number], center);
    for (int a = 0; a < 3; ++a) {
        to[a] = center[a] - start->origin[a];
        along += to[a] * start->direction[a];
        away2 += to[a] * to[a];
    }
    assert_near(start->direction[0] * start->direction[0] + start->direction[1] * start->direction[1] +
                    start->direction[2] * start->direction[2],
                1, 1e-12, "the length of a direction");
    const double off2 = away2 - along * along;
    if (!(off2 <= radius * radius * (1 + 1e-9)) || !(along > 0 || away2 <= radius * radius))
        fail_msg("a path passes its sphere: %g of %g off", sqrt(fmax(0, off2)), radius);
}

/* What all paths together stand for, times a function of the pair. */
static double sum_of_starts(const BpScene *scene, size_t count, uint64_t seed, bool squared_radiance) {
    BpPilotAim aim;
    assert_int_equal(bp_pilot_aim(scene, &aim, NULL), BP_OK);
    assert_true(aim.pair_count > 0);
    BpRandom random = {.state = seed};
    double sum = 0;
    for (size_t i = 0; i < count; ++i) {
        BpPilotStart start;
        bp_pilot_start(scene, &aim, count, &random, &start);
        assert_true(start.measure >= 0);
        if (start.measure > 0) assert_aimed(scene, &aim, &start);
        const double y = aim.lights[aim.pairs[start.pair].light].radiance[1];
        sum += start.measure * (squared_radiance ? y * y : 1);
    }
    bp_pilot_aim_clear(&aim);
    return sum;
}

/* ---- discs ---- */

static void discs_and_balls(void **state) {
    (void)state;
    static const double angles[] = {1e-4, 0.27, 5, 60, 90};
    for (size_t i = 0; i < sizeof angles / sizeof angles[0]; ++i) {
        BuiltScene built;
        built_scene_init(&built);
        const uint32_t glass = built_material(&built, BP_MATERIAL_DIELECTRIC, 1, NULL);
        const uint32_t matte = built_material(&built, BP_MATERIAL_LAMBERTIAN, 1, NULL);
        built_sphere(&built, 3, -2, 1, 0.7, glass);
        built_sphere(&built, 0, -100, 0, 97, matte);
        add_disc(&built, 1, 2, -3, angles[i]);
        const double sine = sin(angles[i] * PI / 360), solid_angle = 4 * PI * sine * sine;
        /* One pair: every path stands for the same. */
        assert_near(sum_of_starts(&built.scene, 2000, 3, false), solid_angle * PI * 0.7 * 0.7, 1e-9,
                    "a disc and a ball");
        /* Two discs, two balls: four pairs. */
        built_sphere(&built, -2, 4, 0, 1.3, glass);
        add_disc(&built, -1, 1, 0, 2);
        const double other = sin(PI / 180), all = solid_angle + 4 * PI * other * other;
        assert_near(sum_of_starts(&built.scene, 200000, 4, false), all * PI * (0.7 * 0.7 + 1.3 * 1.3), 0.02,
                    "two discs and two balls");
    }
}

/* Uniform in the cap, and over the disk of the ball; from beyond everything. */
static void starts_are_uniform(void **state) {
    (void)state;
    enum { COUNT = 100000 };
    BuiltScene built;
    built_scene_init(&built);
    built_sphere(&built, 3, -2, 1, 0.5, built_material(&built, BP_MATERIAL_DIELECTRIC, 1, NULL));
    built_sphere(&built, -9, 0, 0, 1, built_material(&built, BP_MATERIAL_LAMBERTIAN, 1, NULL));
    add_disc(&built, 0, 5, 0, 40);
    BpPilotAim aim;
    assert_int_equal(bp_pilot_aim(&built.scene, &aim, NULL), BP_OK);
    BpRandom random = {.state = 5};
    const double cap = 1 - cos(40 * PI / 180);
    double up = 0, up2 = 0, off2 = 0, off4 = 0, side[2] = {0};
    for (int i = 0; i < COUNT; ++i) {
        BpPilotStart start;
        bp_pilot_start(&built.scene, &aim, COUNT, &random, &start);
        const double part = (1 + start.direction[1]) / cap; /* uniform from 0 to 1 */
        double along = 0, away2 = 0, from_matte = 0;
        for (int a = 0; a < 3; ++a) {
            const double to = built.spheres[0].center[a] - start.origin[a];
            along += to * start.direction[a];
            away2 += to * to;
            from_matte += (built.spheres[1].center[a] - start.origin[a]) *
                          (built.spheres[1].center[a] - start.origin[a]);
        }
        assert_true(part >= -1e-12 && part <= 1 + 1e-12);
        assert_true(from_matte > 1);
        const double off = (away2 - along * along) / 0.25; /* uniform from 0 to 1 too */
        up += part / COUNT;
        up2 += part * part / COUNT;
        off2 += off / COUNT;
        off4 += off * off / COUNT;
        side[0] += start.direction[0] / COUNT;
        side[1] += start.direction[2] / COUNT;
    }
    const double sigma = 1 / sqrt(COUNT); /* of none of these is the deviation larger */
    assert_true(fabs(up - 0.5) < 2 * sigma && fabs(up2 - 1.0 / 3) < 2 * sigma);
    assert_true(fabs(off2 - 0.5) < 2 * sigma && fabs(off4 - 1.0 / 3) < 2 * sigma);
    assert_true(fabs(side[0]) < 3 * sigma && fabs(side[1]) < 3 * sigma);
    bp_pilot_aim_clear(&aim);
}

/* ---- lamps ---- */

/* The part of a disk of radius r that a disk of radius s covers, with their centres `away` apart. */
static double common_area(double r, double s, double away) {
    if (away >= r + s) return 0;
    if (away <= fabs(r - s)) return PI * fmin(r, s) * fmin(r, s);
    const double a = acos((away * away + r * r - s * s) / (2 * away * r));
    const double b = acos((away * away + s * s - r * r) / (2 * away * s));
    return r * r * (a - 0.5 * sin(2 * a)) + s * s * (b - 0.5 * sin(2 * b));
}

/* All rays from a sphere of radius r that meet one of radius s, `away` from it, outside of each other: along
 * each direction, the area that both cover as seen along it; or all that leave it, if it is inside. */
static double rays_between(double r, double s, double away) {
    enum { STEPS = 4000 };
    if (away + r <= s) return 4 * PI * r * r * PI;
    double sum = 0;
    const double most = fmin(PI / 2, asin(fmin(1, (r + s) / away)));
    for (int i = 0; i < STEPS; ++i) {
        const double angle = most * (i + 0.5) / STEPS;
        sum += 2 * PI * sin(angle) * common_area(r, s, away * sin(angle)) * most / STEPS;
    }
    return sum;
}

static void lamps_and_balls(void **state) {
    (void)state;
    static const struct {
        double lamp, ball, away;
    } cases[] = {
        {0.1, 1, 50},                       /* far away */
        {0.03, 0.5, 2},                     /* as in a room */
        {0.4, 0.5, 1},                      /* near: ways to its rim begin beyond the lamp's middle */
        {0.01, 1, 1.02},                    /* a point before a wall */
        {5, 0.1, 20},                       /* a large lamp, of which most parts do not see the ball */
        {5, 0.1, 5.5},   {0.2, 0.2, 0.401}, /* they nearly touch */
        {0.1, 1, 1.5},                      /* points that do not face the ball see it */
        {0.2, 1, 0},                        /* a bulb, in the middle of the ball, */
        {0.2, 1, 0.7},                      /* and off it */
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        BuiltScene built;
        built_scene_init(&built);
        const uint32_t glass = built_material(&built, BP_MATERIAL_DIELECTRIC, 1, NULL);
        const double away = cases[i].away / sqrt(14),
                     spread = rays_between(cases[i].lamp, cases[i].ball, cases[i].away);
        built_sphere(&built, 1, 2, 3, cases[i].ball, glass);
        built_sphere(&built, 1 + away, 2 - 2 * away, 3 + 3 * away, cases[i].lamp, lamp_of(&built, 2));
        char what[80];
        snprintf(what, sizeof what, "a lamp of %g, %g from a ball of %g", cases[i].lamp, cases[i].away,
                 cases[i].ball);
        assert_near(sum_of_starts(&built.scene, 400000, 6 + i, false), spread, 0.01, what);
    }
}

/* A lamp on the surface of the ball, half inside: against rays from all of its points, one by one. */
static void lamps_half_inside(void **state) {
    (void)state;
    enum { COUNT = 400000 };
    const double lamp = 0.5, ball = 1, away = 1.1;
    BpRandom random = {.state = 11};
    size_t hits = 0;
    for (int i = 0; i < COUNT; ++i) {
        double normal[3] = {0}, direction[3], other[3] = {0}, dot = 0, along = 0, away2 = 0;
        for (int k = 0; k < 2; ++k) { /* two directions, uniform by their heights */
            double *v = k == 0 ? normal : other;
            v[0] = 2 * bp_random_next(&random) - 1;
            const double turn = 2 * PI * bp_random_next(&random), side = sqrt(1 - v[0] * v[0]);
            v[1] = side * cos(turn);
            v[2] = side * sin(turn);
        }
        for (int a = 0; a < 3; ++a) direction[a] = normal[a] + other[a]; /* by the cosine */
        dot = sqrt(direction[0] * direction[0] + direction[1] * direction[1] + direction[2] * direction[2]);
        for (int a = 0; a < 3; ++a) {
            const double to = (a == 0 ? away : 0) - lamp * normal[a];
            along += to * direction[a] / dot;
            away2 += to * to;
        }
        hits += away2 <= ball * ball || (along > 0 && away2 - along * along <= ball * ball);
    }
    BuiltScene built;
    built_scene_init(&built);
    built_sphere(&built, 0, 0, 0, lamp, lamp_of(&built, 1));
    built_sphere(&built, away, 0, 0, ball, built_material(&built, BP_MATERIAL_DIELECTRIC, 1, NULL));
    assert_near(sum_of_starts(&built.scene, COUNT, 12, false),
                4 * PI * lamp * lamp * PI * (double)hits / COUNT, 0.01, "a lamp half inside");
}

/* ---- triangles ---- */

/* A lamp of one triangle, both of whose sides shine: all ways from it to a ball that its plane does not cut
 * have the area x solid angle x cosine of pi (r / d)^2 times the cosine, summed over its points. */
static void lamps_of_triangles(void **state) {
    (void)state;
    enum { STEPS = 300 };
    static const struct {
        double center[3], radius;
    } balls[] = {{{0.2, 0.3, 5}, 1}, {{0.5, -0.4, -0.6}, 0.5}, {{9, 7, 3}, 0.2}, {{0.3, 0.3, 0.12}, 0.1}};
    const BpTriangle lamp = {.vertices = {{0, 0, 0}, {1.5, 0.5, 0}, {0.2, 1, 0}}};
    double normal[3];
    const double area = bp_pilot_area(&lamp, normal);
    assert_near(area, 0.5 * (1.5 * 1 - 0.5 * 0.2), 1e-12, "the area of a triangle");
    assert_near(normal[2], 1, 1e-12, "its normal");
    for (size_t k = 0; k < sizeof balls / sizeof balls[0]; ++k) {
        BuiltScene built;
        built_scene_init(&built);
        BpTriangle triangle = lamp;
        triangle.material = lamp_of(&built, 1);
        built.scene.triangles = &triangle;
        built.scene.triangle_count = 1;
        const double *c = balls[k].center;
        built_sphere(&built, c[0], c[1], c[2], balls[k].radius,
                     built_material(&built, BP_MATERIAL_DIELECTRIC, 1, NULL));
        double aimed = 0;
        for (int i = 0; i < STEPS; ++i)
            for (int j = 0; j < STEPS; ++j) {
                const double u = (i + 0.5) / STEPS, v = (j + 0.5) / STEPS;
                double d2 = 0;
                if (u + v > 1) continue;
                for (int a = 0; a < 3; ++a) {
                    const double p = u * lamp.vertices[1][a] + v * lamp.vertices[2][a];
                    d2 += (c[a] - p) * (c[a] - p);
                }
                aimed += PI * balls[k].radius * balls[k].radius / d2 * fabs(c[2]) / sqrt(d2);
            }
        aimed *= 2 * area / STEPS / STEPS;
        char what[80];
        snprintf(what, sizeof what, "a lamp of a triangle, and ball %zu", k);
        BpPilotAim aim;
        assert_int_equal(bp_pilot_aim(&built.scene, &aim, NULL), BP_OK);
        assert_int_equal(aim.pair_count, 1);
        BpRandom random = {.state = 30 + k};
        double sum = 0;
        enum { COUNT = 400000 };
        for (int i = 0; i < COUNT; ++i) {
            BpPilotStart start;
            bp_pilot_start(&built.scene, &aim, COUNT, &random, &start);
            if (start.measure > 0) assert_aimed(&built.scene, &aim, &start);
            sum += start.measure;
            if (!(start.origin[2] * start.direction[2] > 0)) fail_msg("a path begins into its lamp");
        }
        assert_near(sum, aimed, 0.02, what);
        bp_pilot_aim_clear(&aim);
    }
}

/* Where the ball holds the triangle, all of its light goes there. And discs are aimed at the ball around a
 * triangle. */
static void triangles_in_balls(void **state) {
    (void)state;
    BuiltScene built;
    built_scene_init(&built);
    BpTriangle triangle = {.vertices = {{0, 0, 0}, {1.5, 0.5, 0}, {0.2, 1, 0}},
                           .material = lamp_of(&built, 1)};
    double normal[3], center[3];
    const double area = bp_pilot_area(&triangle, normal);
    built.scene.triangles = &triangle;
    built.scene.triangle_count = 1;
    built_sphere(&built, 0.5, 0.5, 0.1, 5, built_material(&built, BP_MATERIAL_DIELECTRIC, 1, NULL));
    assert_near(sum_of_starts(&built.scene, 100000, 50, false), 2 * PI * area, 0.01, "inside");
    triangle.material = built_material(&built, BP_MATERIAL_DIELECTRIC, 1, NULL);
    built.scene.sphere_count = 0;
    add_disc(&built, 0.3, -1, 0.4, 5);
    const double radius = bp_pilot_ball(&built.scene, 0, center), sine = sin(2.5 * PI / 180);
    assert_near(radius * radius, 14.0 / 15 * (14.0 / 15), 1e-12, "the ball around a triangle");
    assert_near(sum_of_starts(&built.scene, 1000, 51, false), 4 * PI * sine * sine * PI * radius * radius,
                1e-6, "a disc and a triangle of glass");
}

/* ---- many ---- */

typedef struct Crowd {
    BuiltScene built;
    BpSphere *spheres;
} Crowd;

static Crowd *crowd_create(size_t most) {
    Crowd *crowd = calloc(1, sizeof *crowd);
    assert_non_null(crowd);
    built_scene_init(&crowd->built);
    crowd->spheres = calloc(most, sizeof *crowd->spheres);
    assert_non_null(crowd->spheres);
    crowd->built.scene.spheres = crowd->spheres;
    return crowd;
}

static void crowd_destroy(Crowd *crowd) {
    free(crowd->spheres);
    free(crowd);
}

static void crowd_add(Crowd *crowd, const double center[3], double radius, uint32_t material) {
    crowd->spheres[crowd->built.scene.sphere_count++] =
        (BpSphere){.center = {center[0], center[1], center[2]},
                   .radius = radius,
                   .material = material,
                   .albedo = BP_NO_ALBEDO};
}

/* A thousand lamps of many brightnesses and sizes, all as far from the ball: the squares of what they bring,
 * and the lamps themselves where they are alike. */
static void more_lamps_than_room(void **state) {
    (void)state;
    for (int alike = 0; alike < 2; ++alike) {
        Crowd *crowd = crowd_create(2000);
        BuiltScene *built = &crowd->built;
        const uint32_t glass = built_material(built, BP_MATERIAL_DIELECTRIC, 1, NULL);
        uint32_t lamps[4];
        for (int i = 0; i < 4; ++i) lamps[i] = lamp_of(built, alike ? 3 : 1 << i);
        crowd_add(crowd, (double[3]){0}, 1, glass);
        BpRandom random = {.state = 13};
        double expected = 0, all = 0;
        for (int i = 0; i < 1000; ++i) {
            const double up = 2 * bp_random_next(&random) - 1, turn = 2 * PI * bp_random_next(&random);
            const double side = 100 * sqrt(1 - up * up),
                         place[3] = {side * cos(turn), 100 * up, side * sin(turn)};
            const int kind = (int)(4 * bp_random_next(&random));
            const double radius = alike ? 0.1 : 0.01 + 0.2 * bp_random_next(&random);
            crowd_add(crowd, place, radius, lamps[kind]);
            const double y = alike ? 3 : 1 << kind, between = rays_between(radius, 1, 100);
            expected += y * y * between;
            all += between;
        }
        BpPilotAim aim;
        assert_int_equal(bp_pilot_aim(&built->scene, &aim, NULL), BP_OK);
        assert_in_range(aim.light_count, 64, BP_PILOT_LIGHTS_MAX);
        bp_pilot_aim_clear(&aim);
        assert_near(sum_of_starts(&built->scene, 50000, 14, true), expected, 0.03, "squares of many lamps");
        if (alike) assert_near(sum_of_starts(&built->scene, 50000, 15, false), all, 0.03, "many lamps alike");
        crowd_destroy(crowd);
    }
}

/* More pairs than room: targets are drawn, each pair for its share. */
static void more_pairs_than_room(void **state) {
    (void)state;
    Crowd *crowd = crowd_create(4000);
    BuiltScene *built = &crowd->built;
    const uint32_t glass = built_material(built, BP_MATERIAL_DIELECTRIC, 1, NULL);
    for (int i = 0; i < 32; ++i) add_disc(built, i - 15.5, 20, 3, 0.5 + 0.02 * i);
    BpRandom random = {.state = 16};
    double area = 0, solid_angle = 0;
    for (int i = 0; i < 3000; ++i) {
        const double radius = 0.1 + 0.3 * bp_random_next(&random);
        const double place[3] = {i % 50, 0, i / 50};
        crowd_add(crowd, place, radius, glass);
        area += PI * radius * radius;
    }
    for (int i = 0; i < 32; ++i) {
        const double sine = sin((0.5 + 0.02 * i) * PI / 360);
        solid_angle += 4 * PI * sine * sine;
    }
    BpPilotAim aim;
    assert_int_equal(bp_pilot_aim(&built->scene, &aim, NULL), BP_OK);
    assert_int_equal(aim.pair_count, BP_PILOT_PAIRS_MAX);
    double probability = 0;
    for (size_t i = 0; i < aim.pair_count; ++i) {
        assert_near(aim.bounds[i], probability, 1e-9, "where a pair begins");
        probability += aim.pairs[i].probability;
    }
    assert_near(probability, 1, 1e-9, "the sum of probabilities");
    bp_pilot_aim_clear(&aim);
    assert_near(sum_of_starts(&built->scene, 200000, 17, false), area * solid_angle, 0.02, "many pairs");
    crowd_destroy(crowd);
}

/* The order in which a scene lists its spheres is none of the light's. */
static void the_order_does_not_count(void **state) {
    (void)state;
    BuiltScene one, other;
    for (int reversed = 0; reversed < 2; ++reversed) {
        BuiltScene *built = reversed ? &other : &one;
        built_scene_init(built);
        const uint32_t glass = built_material(built, BP_MATERIAL_DIELECTRIC, 1, NULL),
                       lamp = lamp_of(built, 5);
        for (int k = 0; k < 12; ++k) {
            const int i = reversed ? 11 - k : k;
            built_sphere(built, 3 * i, i % 3, i % 2, 0.1 + 0.05 * i, i % 4 == 0 ? lamp : glass);
        }
    }
    BpPilotAim a, b;
    assert_int_equal(bp_pilot_aim(&one.scene, &a, NULL), BP_OK);
    assert_int_equal(bp_pilot_aim(&other.scene, &b, NULL), BP_OK);
    assert_int_equal(a.pair_count, 27);
    assert_int_equal(b.pair_count, 27);
    for (size_t i = 0; i < a.pair_count; ++i) {
        size_t same = 0;
        for (size_t k = 0; k < b.pair_count; ++k) {
            if (a.lights[a.pairs[i].light].shape + b.lights[b.pairs[k].light].shape != 11 ||
                a.targets[a.pairs[i].target] + b.targets[b.pairs[k].target] != 11)
                continue;
            assert_near(a.pairs[i].probability, b.pairs[k].probability, 1e-12, "the probability of a pair");
            ++same;
        }
        assert_int_equal(same, 1);
    }
    bp_pilot_aim_clear(&a);
    bp_pilot_aim_clear(&b);
}

/* ---- what is a light, and what a target ---- */

static void lights_and_targets(void **state) {
    (void)state;
    BuiltScene built;
    built_scene_init(&built);
    BpMaterial *material = NULL;
    const uint32_t glass = built_material(&built, BP_MATERIAL_DIELECTRIC, 1, NULL);
    const uint32_t mirror = built_material(&built, BP_MATERIAL_METAL, 1, NULL);
    const uint32_t polished = built_material(&built, BP_MATERIAL_METAL, 1, &material);
    material->fuzz = BP_LIT_FUZZ_MIN * 0.99;
    const uint32_t brushed = built_material(&built, BP_MATERIAL_METAL, 1, &material);
    material->fuzz = BP_LIT_FUZZ_MIN;
    const uint32_t coated = built_material(&built, BP_MATERIAL_GLOSSY, 1, NULL);
    const uint32_t fuzzy = built_material(&built, BP_MATERIAL_METAL, 1, &material);
    material->fuzz = 0.8; /* so wide that samples soon find what it sends */
    const uint32_t matte = built_material(&built, BP_MATERIAL_LAMBERTIAN, 1, NULL);
    const uint32_t edge = built_material(&built, BP_MATERIAL_INTERFACE, 1, NULL);
    const uint32_t normals = built_material(&built, BP_MATERIAL_NORMALS, 1, NULL);
    const uint32_t lamp = lamp_of(&built, 1);
    const struct {
        uint32_t material;
        bool specular, target;
    } all[] = {{glass, true, true},     {mirror, true, true},  {polished, true, true}, {brushed, false, true},
               {coated, false, true},   {fuzzy, false, false}, {matte, false, false},  {edge, false, false},
               {normals, false, false}, {lamp, false, false}};
    for (size_t i = 0; i < sizeof all / sizeof all[0]; ++i)
        built_sphere(&built, 3 * (double)i, 0, 0, 1, all[i].material);
    size_t targets = 0;
    for (size_t i = 0; i < sizeof all / sizeof all[0]; ++i) {
        assert_int_equal(bp_pilot_is_specular(&built.scene, i), all[i].specular);
        targets += all[i].target;
    }
    add_disc(&built, 0, 1, 0, 1);
    add_disc(&built, 0, 1, 0, 1); /* a dark one is no light */
    for (int c = 0; c < 3; ++c) built.scene.discs[1].radiance[c] = 0;
    BpPilotAim aim;
    assert_int_equal(bp_pilot_aim(&built.scene, &aim, NULL), BP_OK);
    assert_int_equal(aim.light_count, 2);
    assert_int_equal(aim.target_count, targets);
    assert_int_equal(aim.pair_count, 2 * targets);
    bp_pilot_aim_clear(&aim);
    built.scene.disc_count = 0;
    for (int c = 0; c < 3; ++c) built.materials[lamp].emit[c] = 0;
    assert_int_equal(bp_pilot_aim(&built.scene, &aim, NULL), BP_OK);
    assert_int_equal(aim.pair_count, 0);
    bp_pilot_aim_clear(&aim);
}

/* An image around with a bright patch, between whose texels and the others light falls off evenly: of 3 x 2
 * texels, all squares that have some of it; of 64 x 32, a part
 * of the brightest for all, without the slopes. Light is kept in the mean and in the
 * mean of squares: along a side of n texels, the squares of the values come to n - 1 and 1/3 for each of the
 * two slopes. */
static void bright_texels(void **state) {
    (void)state;
    static const uint32_t patches[2][2] = {{3, 2}, {64, 32}};
    for (int p = 0; p < 2; ++p) {
        BuiltScene built;
        built_scene_init(&built);
        built_sphere(&built, 0, 0, 0, 1, built_material(&built, BP_MATERIAL_DIELECTRIC, 1, NULL));
        BpImage *image = NULL;
        assert_int_equal(bp_texels_create(512, 256, &image, NULL), BP_OK);
        double extent = 0;
        for (uint32_t y = 0; y < 256; ++y)
            for (uint32_t x = 0; x < 512; ++x) {
                /* a quarter to the right of the middle, which is -z: at x; above the horizon */
                const bool bright =
                    x >= 384 && x < 384 + patches[p][0] && y < 100 && y + patches[p][1] >= 100;
                for (int c = 0; c < 3; ++c)
                    image->texels[3 * (y * 512 + x) + (uint32_t)c] = bright ? 1000 : 0;
                if (bright) extent += 2 * PI / 512 * (cos(PI * y / 256) - cos(PI * (y + 1) / 256));
            }
        assert_int_equal(bp_texels_finish(image, 1, "image", NULL), BP_OK);
        built.scene.environment = image;
        for (int c = 0; c < 3; ++c) built.scene.background_bottom[c] = built.scene.background_top[c] = 0;
        BpPilotAim aim;
        assert_int_equal(bp_pilot_aim(&built.scene, &aim, NULL), BP_OK);
        double found = 0, mean = 0, square = 0;
        for (size_t i = 0; i < aim.light_count; ++i) {
            const BpPilotLight *light = &aim.lights[i];
            const double part = 2 * PI * light->cap * light->share;
            found += part;
            mean += part * light->radiance[0];
            square += part * light->radiance[0] * light->radiance[0];
            assert_true(light->distant && light->seen && light->radiance[0] <= 1000 * (1 + 1e-9));
            assert_true(light->place[0] > 0.5 && light->place[1] > 0 && light->place[2] > -0.1);
        }
        const double w = patches[p][0], h = patches[p][1], slopes = (w - 1.0 / 3) * (h - 1.0 / 3) / (w * h);
        assert_near(mean, 1000 * extent, p == 0 ? 0.01 : 0.08, "the light of bright texels");
        assert_near(square, 1e6 * extent * slopes, p == 0 ? 0.02 : 0.08, "the mean square of their light");
        if (p == 0) {
            assert_int_equal(aim.light_count, (3 + 2) * (2 + 2));
            const double down = PI * 98.5 / 256,
                         turn = PI * 0.5 / 256;        /* of the first texel, from x towards z */
            const double *place = aim.lights[6].place; /* behind a row of slopes, and one more */
            assert_near(place[0], sin(down) * cos(turn), 1e-9, "x of a texel");
            assert_near(place[1], cos(down), 1e-9, "y of a texel");
            assert_near(place[2], sin(down) * sin(turn), 1e-9, "z of a texel");
        } else {
            assert_in_range(aim.light_count, 64, BP_PILOT_LIGHTS_MAX);
        }
        bp_pilot_aim_clear(&aim);
        assert_near(sum_of_starts(&built.scene, 20000, 18, false), PI * found, 0.05, "texels and a ball");
        bp_texels_destroy(&image);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(discs_and_balls),
        cmocka_unit_test(starts_are_uniform),
        cmocka_unit_test(lamps_and_balls),
        cmocka_unit_test(lamps_half_inside),
        cmocka_unit_test(lamps_of_triangles),
        cmocka_unit_test(triangles_in_balls),
        cmocka_unit_test(more_lamps_than_room),
        cmocka_unit_test(more_pairs_than_room),
        cmocka_unit_test(the_order_does_not_count),
        cmocka_unit_test(lights_and_targets),
        cmocka_unit_test(bright_texels),
    };
    return cmocka_run_group_tests_name("pilot_lights", tests, NULL, NULL);
}
