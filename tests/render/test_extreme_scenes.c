/* test_extreme_scenes.c: the ends of every member's range. A scene either has a picture, all of whose samples
 * are finite, or is refused by the name of the member. On the default device, in single precision.
 *
 * With the argument `every`: every value; without, every second one of a member, in turn the one half and the
 * other.
 *
 * The sky differs in every direction, so that a ray without a direction cannot pass for one that met nothing.
 */
#include "scene/scene.h"
#include "support/open_render.h"

#include <float.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

/* Every kind of material in view; the members of a case come last, in place of %s. */
#define VIEW "\"image_width\": 8, \"max_depth\": 6"
#define REST                                                                                                 \
    " \"background\": { \"bottom\": [1, 0.9, 0.8], \"top\": [0.5, 0.7, 1] }, \"materials\": {"               \
    " \"matte\": { \"type\": \"lambertian\", \"albedo\": [0.5, 0.6, 0.7], \"emit\": [0.01, 0.01, 0.01] },"   \
    " \"gold\": { \"type\": \"metal\", \"albedo\": [0.8, 0.6, 0.2], \"fuzz\": 0.3, \"emit\": [0.01, 0.01, "  \
    "0.01] },"                                                                                               \
    " \"glass\": { \"type\": \"dielectric\", \"refraction_index\": 1.5 } }"
#define SPHERES                                                                                              \
    "{ \"center\": [-0.5, 0, -1], \"radius\": 0.3, \"material\": \"matte\" },"                               \
    " { \"center\": [0.5, 0, -1], \"radius\": 0.3, \"material\": \"glass\" },"                               \
    " { \"center\": [0, 0.5, -1], \"radius\": 0.2, \"material\": \"gold\" }"
#define CAMERA(members) "{ \"camera\": { " VIEW ", " members " }," REST ", \"spheres\": [ " SPHERES " ] }"
#define SPHERE(members, material)                                                                            \
    "{ \"camera\": { " VIEW " }," REST ", \"spheres\": [ " SPHERES ", { " members                            \
    ", \"material\": \"" material "\" } ] }"
#define MATERIAL(members)                                                                                    \
    "{ \"camera\": { " VIEW " }, \"background\": { \"bottom\": [1, 0.9, 0.8], \"top\": [0.5, 0.7, 1] },"     \
    " \"materials\": { \"m\": { " members " } }, \"spheres\": [ { \"center\": [0, 0, -1], \"radius\": 0.7,"  \
    " \"material\": \"m\" } ] }"
#define SKY(members)                                                                                         \
    "{ \"camera\": { " VIEW " }, \"background\": { " members " }, \"materials\": { \"m\": { \"type\": "      \
    "\"metal\", \"albedo\": [1, 1, 1] } }, \"spheres\": [ { \"center\": [0, 0, -1], \"radius\": 0.7,"        \
    " \"material\": \"m\" } ] }"

/* A document with one number to fill in, and the members whose names a refusal may open with. */
typedef struct Case {
    const char *format, *member, *other;
    bool both_signs;
} Case;

static const Case cases[] = {
    {CAMERA("\"focus_dist\": %s"), "focus_dist", NULL, false},
    {CAMERA("\"aperture\": 0.1, \"focus_dist\": %s"), "focus_dist", NULL, false},
    {CAMERA("\"defocus_angle\": 10, \"focus_dist\": %s"), "focus_dist", NULL, false},
    {CAMERA("\"aperture\": %s"), "aperture", NULL, false},
    {CAMERA("\"defocus_angle\": %s"), "defocus_angle", NULL, false},
    {CAMERA("\"vfov\": %s"), "vfov", NULL, false},
    {CAMERA("\"focus_dist\": 1e12, \"vfov\": %s"), "vfov", NULL, false},
    {CAMERA("\"focus_dist\": 1e-15, \"vfov\": %s"), "vfov", NULL, false},
    {CAMERA("\"aspect_ratio\": %s"), "aspect_ratio", NULL, false},
    {CAMERA("\"lookfrom\": [%s, 0, 0]"), "lookfrom", NULL, true},
    {CAMERA("\"lookfrom\": [0, 0, %s]"), "lookfrom", "lookat", true},
    {CAMERA("\"lookat\": [%s, 0, -1]"), "lookat", NULL, true},
    {CAMERA("\"lookat\": [0, 0, %s]"), "lookat", NULL, true},
    {CAMERA("\"vup\": [0, %s, 0]"), "vup", NULL, true},
    {CAMERA("\"vup\": [0, 1, %s]"), "vup", NULL, true},
    {SPHERE("\"center\": [%s, 0, -1], \"radius\": 0.1", "matte"), "center", NULL, true},
    {SPHERE("\"center\": [0, 0, %s], \"radius\": 0.1", "glass"), "center", NULL, true},
    {SPHERE("\"center\": [0, 0, -1], \"radius\": %s", "matte"), "radius", NULL, true},
    {SPHERE("\"center\": [0, 0, -1], \"radius\": %s", "glass"), "radius", NULL, true},
    {SPHERE("\"center\": [0, 0, -1], \"radius\": %s", "gold"), "radius", NULL, true},
    {MATERIAL("\"type\": \"dielectric\", \"refraction_index\": %s"), "refraction_index", NULL, false},
    {MATERIAL("\"type\": \"dielectric\", \"fresnel\": \"exact\", \"refraction_index\": %s"),
     "refraction_index", NULL, false},
    {MATERIAL("\"type\": \"metal\", \"albedo\": [1, 1, 1], \"fuzz\": %s"), "fuzz", NULL, false},
    {MATERIAL("\"type\": \"metal\", \"albedo\": [%s, 1, 1]"), "albedo", NULL, false},
    {MATERIAL("\"type\": \"lambertian\", \"albedo\": [0.5, %s, 1]"), "albedo", NULL, false},
    {MATERIAL("\"type\": \"diffuse_light\", \"emit\": [0, %s, 1]"), "emit", NULL, false},
    {SKY("\"bottom\": [1, %s, 1]"), "bottom", NULL, false},
    {SKY("\"top\": [1, %s, 1]"), "top", NULL, false},
};

/* Around every limit there is, and beyond all. */
static const char *const values[] = {"0",     "5e-324", "1.2e-38", "1e-30",   "1e-25",
                                     "1e-15", "1e-6",   "1",       "179.9",   "179.99999999999997",
                                     "1e3",   "1e6",    "1e12",    "1.01e12", "1e39"};

static bool every_value;

/* What single precision cannot render is refused, by the member. */
static BpStatus render(const BpScene *scene, const char *text, BpError *err) {
    BpRenderOptions options;
    BpRender *made = NULL;
    BpProgress progress = {0};
    const BpFilm *film = NULL;
    bp_render_defaults(scene, &options);
    options.samples_per_pixel = 4;
    options.all_effects = options.force_tree = true; /* one program for all */
    options.force = true;                            /* the self-test is another test */
    BP_TRY(open_render_on_device(scene, &options, &made, err));
    do {
        if (bp_render_step(made, &progress, err) != BP_OK) fail_msg("%s: %s", err->message, text);
    } while (!progress.finished);
    if (bp_render_read_film(made, &film, err) != BP_OK) fail_msg("%s: %s", err->message, text);
    if (film->invalid_samples != 0)
        fail_msg("%llu invalid samples: %s", (unsigned long long)film->invalid_samples, text);
    double mean[3];
    bp_film_mean(film, mean);
    if (!(mean[0] + mean[1] + mean[2] > 0)) fail_msg("black: %s", text);
    bp_render_destroy(&made);
    return BP_OK;
}

static void render_or_refuse(const Case *c, const char *sign, const char *value, size_t *rendered) {
    char text[2048], number[64];
    BpScene *scene = NULL;
    BpError err = {0};
    snprintf(number, sizeof number, "%s%s", sign, value);
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wformat-nonliteral"
    snprintf(text, sizeof text, c->format, number);
#pragma GCC diagnostic pop
    BpStatus status = bp_scene_parse(text, strlen(text), "x.json", &scene, &err);
    if (status == BP_OK) status = render(scene, text, &err);
    if (status == BP_OK) {
        ++*rendered;
    } else {
        assert_int_equal(status, BP_ERR_SCENE);
        if (strstr(err.message, c->member) == NULL &&
            (c->other == NULL || strstr(err.message, c->other) == NULL))
            fail_msg("\"%s\" does not name %s: %s", err.message, c->member, text);
    }
    bp_scene_destroy(&scene);
    bp_error_clear(&err);
}

static void every_member_at_its_ends(void **state) {
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        size_t rendered = 0;
        for (size_t k = 0; k < sizeof values / sizeof *values; ++k) {
            if (!every_value && (i + k) % 2 != 0) continue;
            render_or_refuse(&cases[i], "", values[k], &rendered);
            if (cases[i].both_signs && (every_value ? k % 2 == 0 : k % 4 < 2))
                render_or_refuse(&cases[i], "-", values[k], &rendered);
        }
        assert_true(rendered > (every_value ? 3 : 1));
    }
}

int main(int argc, char **argv) {
    BpError err = {0};
    BpDeviceInfo device;
    every_value = argc > 1 && strcmp(argv[1], "every") == 0;
    if (bp_device_find(NULL, &device, &err) != BP_OK) {
        fprintf(stderr, "skipped: %s\n", err.message);
        return 77;
    }
    const struct CMUnitTest tests[] = {cmocka_unit_test(every_member_at_its_ends)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
