/* test_shells.c: tests 14 to 19: tiny, nested, coincident and matched dielectrics, through the product's own
 * paths. */
#include "suite.h"

#include "base/status.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define GLASS(name, index)                                                                                   \
    "\"" name "\":{\"type\":\"dielectric\",\"refraction_index\":" index ",\"fresnel\":\"none\"}"

/* Traces paths from `rays`; rows of PATH_REALS. */
static void run_paths(const Lab *lab, const BpScene *scene, double *rays, size_t count, double *paths) {
    lab_unit_rays(lab, count, rays);
    BpWorker *worker = lab_scene(lab, scene);
    const LabArgument arguments[] = {{LAB_REALS, rays, count * RAY_REALS},
                                     {LAB_OUT_REFINED, paths, count * PATH_REALS}};
    lab_run(lab, "probe_paths", count, arguments, 2, worker);
    bp_worker_destroy(&worker);
}

/* Rays from the camera (the origin of packed space) to points of the disk of radius `reach` around `centre`.
 */
static void aim(const double centre[3], double reach, size_t count, uint64_t seed, double *rays) {
    memset(rays, 0, count * RAY_REALS * sizeof *rays);
    for (size_t i = 0; i < count; ++i) {
        double off[3], *direction = rays + i * RAY_REALS + RAY_DIRECTION;
        lab_direction(&seed, off);
        const double along = lab_dot(off, centre) / lab_dot(centre, centre);
        const double size = reach * sqrt(lab_unit(&seed));
        for (int a = 0; a < 3; ++a) off[a] -= along * centre[a];
        const double length = sqrt(lab_dot(off, off));
        for (int a = 0; a < 3; ++a) direction[a] = centre[a] + size * off[a] / length;
        lab_float_unit(direction);
    }
}

/* 14: a glass bead of radius 2e-4: whoever gets in gets out. */
static void tiny_glass(void **state) {
    enum { COUNT = 20000 };
    const double distances[] = {0.1, 13, 1000};
    double *rays = suite_calloc(COUNT * RAY_REALS, sizeof *rays),
           *paths = suite_calloc(COUNT * PATH_REALS, sizeof *paths);
    for (int k = 0; k < 3; ++k) {
        BpScene *scene = suite_scene(
            "{\"format\":1,\"camera\":{\"lookfrom\":[0,0,0],\"lookat\":[0,0,-1]},\"materials\":{" GLASS(
                "glass",
                "1.5") "},\"spheres\":[{\"center\":[%g,%g,%g],\"radius\":2e-4,\"material\":\"glass\"}]}",
            0.3 * distances[k], 0.2 * distances[k], -distances[k]);
        aim(scene->spheres[0].center, 1.98e-4, COUNT, 14, rays);
        run_paths(*state, scene, rays, COUNT, paths);
        size_t entered = 0, left = 0;
        for (size_t i = 0; i < COUNT; ++i) {
            const double *path = paths + i * PATH_REALS;
            if (path[0] != 0) continue;
            ++entered;
            left += path[2] == 0 && path[3] > 0 && path[4] == -1;
        }
        print_message("    at distance %g: %zu rays entered, %zu left\n", distances[k], entered, left);
        assert_true(entered > COUNT * 3 / 4);
        assert_int_equal(left, entered);
        bp_scene_destroy(&scene);
    }
    free(rays);
    free(paths);
}

/* A glass sphere of radius 0.5 around (0, 0, -distance), hollow to `inner`; or solid for inner = 0. */
static BpScene *shell(double distance, double inner) {
    char hole[128] = "";
    if (inner > 0)
        snprintf(hole, sizeof hole, ",{\"center\":[0,0,%.17g],\"radius\":%.17g,\"material\":\"air\"}",
                 -distance, inner);
    return suite_scene(
        "{\"format\":1,\"camera\":{\"lookfrom\":[0,0,0],\"lookat\":[0,0,-1]},\"materials\":{" GLASS(
            "glass", "1.5") "," GLASS("air",
                                      "0.66666666666666663") "},\"spheres\":[{\"center\":[0,0,%.17g],"
                                                             "\"radius\":0.5,\"material\":\"glass\"}%s]}",
        -distance, hole);
}

/* 15: a shell of thickness 1e-4 bends a ray by five thousandths of a degree; were its inside missed, by 21
 * degrees. */
static void shell_deflection(void **state) {
    double ray[RAY_REALS] = {0.25, 0, 0, 0, 0, 0, 0, 0, -1, 0}, path[PATH_REALS];
    const double inner[] = {0.4999, 0}, expected[] = {0.00513, 21.06}, tolerance[] = {1e-3, 1e-2};
    for (int k = 0; k < 2; ++k) {
        BpScene *scene = shell(3, inner[k]);
        run_paths(*state, scene, ray, 1, path);
        const double *direction = path + 2 * PATH_SEGMENTS;
        const double degrees = atan2(direction[0], -direction[2]) * 57.29577951308232;
        print_message("    inner radius %g: %.5f degrees\n", inner[k], degrees);
        assert_true(fabs(fabs(degrees) - expected[k]) <= tolerance[k]);
        bp_scene_destroy(&scene);
    }
}

/* 16: outer, inner, inner, outer, at every gap, near and far. */
static void shell_gap_sweep(void **state) {
    enum { COUNT = 4000 };
    const double gaps[] = {5e-2, 5e-3, 5e-4, 5e-5, 5e-6, 1e-6, 5e-7}, distances[] = {3, 1000};
    double *rays = suite_calloc(COUNT * RAY_REALS, sizeof *rays),
           *paths = suite_calloc(COUNT * PATH_REALS, sizeof *paths);
    size_t wrong_in_all = 0;
    for (size_t d = 0; d < 2; ++d)
        for (size_t g = 0; g < sizeof gaps / sizeof gaps[0]; ++g) {
            BpScene *scene = shell(distances[d], 0.5 - gaps[g]);
            aim(scene->spheres[0].center, 0.8 * (0.5 - gaps[g]), COUNT, 16, rays);
            run_paths(*state, scene, rays, COUNT, paths);
            size_t wrong = 0;
            for (size_t i = 0; i < COUNT; ++i) {
                const double *path = paths + i * PATH_REALS;
                wrong += !(path[0] == 0 && path[2] == 1 && path[4] == 1 && path[6] == 0 && path[8] == -1);
            }
            if (wrong > 0)
                print_message("    gap %g at distance %g: %zu of %d wrong\n", gaps[g], distances[d], wrong,
                              COUNT);
            wrong_in_all += wrong;
            bp_scene_destroy(&scene);
        }
    free(rays);
    free(paths);
    assert_int_equal(wrong_in_all, 0);
}

/* 17: two dielectrics with one surface have no inside: refused, by name, also when only float makes them one.
 * Overlapping, touching and concentric ones are scenes. */
static void coincident_dielectrics(void **state) {
    (void)state;
    static const char *const spheres[] = {
        "{\"center\":[0,0,-3],\"radius\":0.5,\"material\":\"glass\"},{\"center\":[0,0,-3],\"radius\":0.5,"
        "\"material\":\"glass\"}",
        "{\"center\":[0,0,-3],\"radius\":0.5,\"material\":\"glass\"},{\"center\":[0,0,-3],\"radius\":-0."
        "500000001,\"material\":\"glass\"}",
        "{\"center\":[0,0,-3],\"radius\":0.5,\"material\":\"glass\"},{\"center\":[0,0.4,-3],\"radius\":0.5,"
        "\"material\":\"glass\"}",
        "{\"center\":[0,0,-3],\"radius\":0.5,\"material\":\"glass\"},{\"center\":[0,1,-3],\"radius\":0.5,"
        "\"material\":\"glass\"}",
        "{\"center\":[0,0,-3],\"radius\":0.5,\"material\":\"glass\"},{\"center\":[0,0,-3],\"radius\":-0.45,"
        "\"material\":\"glass\"}"};
    for (int k = 0; k < 5; ++k) {
        char text[1024];
        BpScene *scene = NULL;
        BpError err = {0};
        snprintf(text, sizeof text,
                 "{\"format\":1,\"camera\":{},\"materials\":{" GLASS("glass", "1.5") "},\"spheres\":[%s]}",
                 spheres[k]);
        const BpStatus status = bp_scene_parse(text, strlen(text), "test", &scene, &err);
        assert_int_equal(status, k < 2 ? BP_ERR_SCENE : BP_OK);
        if (k < 2) assert_non_null(strstr(err.message, "same centre and radius"));
        bp_scene_destroy(&scene);
        bp_error_clear(&err);
    }
}

static void expect_same_picture(const BpPicture *a, const BpPicture *b, float tolerance) {
    assert_true(a->width == b->width && a->height == b->height);
    for (size_t i = 0; i < (size_t)a->width * a->height * 3; ++i)
        assert_true(fabsf(a->rgb[i] - b->rgb[i]) <= tolerance);
}

/* 18: a sphere turned inside out is a bubble: the same as one of the reciprocal index, to the bit. */
static void bubble_equivalence(void **state) {
    static const char *const inner[] = {"\"radius\":-0.4,\"material\":\"glass\"",
                                        "\"radius\":0.4,\"material\":\"air\""};
    BpPicture pictures[2] = {0};
    for (int k = 0; k < 2; ++k) {
        BpScene *scene = suite_scene(
            "{\"format\":1,\"camera\":{\"image_width\":24,\"vfov\":50,\"lookfrom\":[0,0,2]},\"materials\":{"
            "\"glass\":{\"type\":\"dielectric\",\"refraction_index\":1.5},"
            "\"air\":{\"type\":\"dielectric\",\"refraction_index\":0.66666666666666663}},"
            "\"spheres\":[{\"center\":[0,0,0],\"radius\":0.5,\"material\":\"glass\"},{\"center\":[0,0,0],%s}]"
            "}",
            inner[k]);
        lab_render(*state, scene, 8, 18, &pictures[k], NULL);
        bp_scene_destroy(&scene);
    }
    expect_same_picture(&pictures[0], &pictures[1], 0);
    bp_picture_clear(&pictures[0]);
    bp_picture_clear(&pictures[1]);
}

/* 19: glass of the index of its surroundings cannot be seen. */
static void eta_one_invisible(void **state) {
    static const char *const fresnel[] = {"schlick", "exact", "none", NULL};
    BpPicture empty = {0};
    BpScene *sky =
        suite_scene("{\"format\":1,\"camera\":{\"image_width\":16,\"vfov\":50,\"lookfrom\":[0,0,2]}}");
    lab_render(*state, sky, 8, 19, &empty, NULL);
    bp_scene_destroy(&sky);
    for (int k = 0; fresnel[k] != NULL; ++k) {
        BpPicture picture = {0};
        BpScene *scene = suite_scene(
            "{\"format\":1,\"camera\":{\"image_width\":16,\"vfov\":50,\"lookfrom\":[0,0,2]},\"materials\":{"
            "\"nothing\":{\"type\":\"dielectric\",\"refraction_index\":1,\"fresnel\":\"%s\"}},"
            "\"spheres\":[{\"center\":[0,0,0],\"radius\":0.5,\"material\":\"nothing\"}]}",
            fresnel[k]);
        lab_render(*state, scene, 8, 19, &picture, NULL);
        expect_same_picture(&picture, &empty, 1e-6f);
        bp_scene_destroy(&scene);
        bp_picture_clear(&picture);
    }
    bp_picture_clear(&empty);
}

/* The book's own spheres touch exactly: C with L and R, the wide-angle pair, the large one with the ground.
 * Made of glass that only bends, rays a hundredth beside the contact enter and leave all of them in order;
 * through the contact itself, where leaving one and entering the other are one event, the lower number may
 * win and the other event go missing, but every sphere is met, none twice over, and the path gets out. */
static void book_tangencies(void **state) {
    static const struct {
        const char *spheres;
        double origin[3], direction[3];
        double order[8];
    } cases[] = {
        {"{\"center\":[0,0,-1],\"radius\":0.5,\"material\":\"g\"},{\"center\":[-1,0,-1],\"radius\":0.5,"
         "\"material\":\"g\"},{\"center\":[1,0,-1],\"radius\":0.5,\"material\":\"g\"}",
         {-3, 0, -1},
         {1, 0, 0},
         {1, 1, 0, 0, 2, 2, -1, -1}},
        {"{\"center\":[-0.7071067811865475,0,-1],\"radius\":0.7071067811865476,\"material\":\"g\"},"
         "{\"center\":[0.7071067811865475,0,-1],\"radius\":0.7071067811865476,\"material\":\"g\"}",
         {-3, 0, -1},
         {1, 0, 0},
         {0, 0, 1, 1, -1, -1, -1, -1}},
        {"{\"center\":[0,1,0],\"radius\":1,\"material\":\"g\"},{\"center\":[0,-1000,0],\"radius\":1000,"
         "\"material\":\"g\"}",
         {0, 7, 0},
         {0, -1, 0},
         {0, 0, 1, 1, -1, -1, -1, -1}},
    };
    const double aside[] = {0, 0x1p-30, 1e-6, 0.01};
    for (size_t c = 0; c < sizeof cases / sizeof cases[0]; ++c) {
        BpScene *scene = suite_scene("{\"format\":1,\"camera\":{\"lookfrom\":[0,16,0],\"lookat\":[0,16,-1]},"
                                     "\"materials\":{" GLASS("g", "1.5") "},\"spheres\":[%s]}",
                                     cases[c].spheres);
        double rays[4 * RAY_REALS] = {0}, paths[4 * PATH_REALS];
        for (int i = 0; i < 4; ++i) {
            double *ray = rays + i * RAY_REALS;
            for (int a = 0; a < 3; ++a) {
                ray[RAY_HIGH + a] = cases[c].origin[a];
                ray[RAY_DIRECTION + a] = cases[c].direction[a];
            }
            ray[RAY_HIGH + 1] -= 16;       /* relative to the camera */
            ray[RAY_HIGH + 2] += aside[i]; /* all three run in a plane of constant z */
        }
        run_paths(*state, scene, rays, 4, paths);
        for (int i = 0; i < 4; ++i) {
            int met[3] = {0};
            for (int k = 0; k < 8; ++k) {
                const double sphere = paths[i * PATH_REALS + 2 * k];
                if (sphere >= 0) ++met[(int)sphere];
                if (i == 3) assert_true(sphere == cases[c].order[k]);
            }
            for (int k = 0; k < 3; ++k) {
                int wanted = 0;
                for (int m = 0; m < 8; ++m) wanted += cases[c].order[m] == k;
                assert_true(wanted == 0 ? met[k] == 0 : met[k] == 1 || met[k] == 2);
            }
            assert_true(paths[i * PATH_REALS + 2 * 7] == -1 && paths[i * PATH_REALS + PATH_REALS - 1] == 0);
        }
        bp_scene_destroy(&scene);
    }
}

int run_shells(Lab *lab) {
    const struct CMUnitTest tests[] = {
        HARD_TEST(tiny_glass),         HARD_TEST(shell_deflection),
        HARD_TEST(shell_gap_sweep),    HARD_TEST(coincident_dielectrics),
        HARD_TEST(bubble_equivalence), HARD_TEST(eta_one_invisible),
        HARD_TEST(book_tangencies),
    };
    return cmocka_run_group_tests_name("shells", tests, NULL, NULL);
}
