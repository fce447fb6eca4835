/* test_scene_documents.c: good scene documents: defaults, every member, every file of scenes/, what is
 * written and made. */
#include "formats/document.h"
#include "formats/named_file.h"
#include "scene/scene.h"

#include <glob.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

static BpScene *parse(const char *text) {
    BpScene *scene = NULL;
    BpError err = {0};
    if (bp_scene_parse(text, strlen(text), "x.json", &scene, &err) != BP_OK)
        fail_msg("%d:%d: %s", err.line, err.column, err.message);
    return scene;
}

static void assert_vector(const double v[3], double x, double y, double z) {
    if (v[0] != x || v[1] != y || v[2] != z)
        fail_msg("found [%g, %g, %g], expected [%g, %g, %g]", v[0], v[1], v[2], x, y, z);
}

static void assert_number(double found, double expected) {
    if (!(found == expected)) fail_msg("found %.17g, expected %.17g", found, expected);
}

/* All that is equal between scenes, to the bit. */
static void assert_same_scene(const BpScene *a, const BpScene *b) {
    const BpCamera *p = &a->camera, *q = &b->camera;
    assert_string_equal(a->title, b->title);
    assert_string_equal(a->source, b->source);
    assert_int_equal(p->width, q->width);
    assert_int_equal(p->height, q->height);
    assert_int_equal(p->samples_per_pixel, q->samples_per_pixel);
    assert_int_equal(p->max_depth, q->max_depth);
    assert_int_equal(p->pixel_sampling, q->pixel_sampling);
    assert_number(p->aspect_ratio, q->aspect_ratio);
    assert_number(p->vfov_degrees, q->vfov_degrees);
    assert_number(p->lens_radius, q->lens_radius);
    assert_number(p->focus_dist, q->focus_dist);
    assert_memory_equal(p->lookfrom, q->lookfrom, sizeof p->lookfrom);
    assert_memory_equal(p->lookat, q->lookat, sizeof p->lookat);
    assert_memory_equal(p->vup, q->vup, sizeof p->vup);
    assert_memory_equal(a->background_bottom, b->background_bottom, sizeof a->background_bottom);
    assert_memory_equal(a->background_top, b->background_top, sizeof a->background_top);
    assert_int_equal(a->disc_count, b->disc_count);
    for (size_t i = 0; i < a->disc_count; i++) {
        const BpDisc *d = &a->discs[i], *e = &b->discs[i];
        assert_memory_equal(d->direction, e->direction, sizeof d->direction);
        assert_number(d->half_angle_degrees, e->half_angle_degrees);
        assert_memory_equal(d->radiance, e->radiance, sizeof d->radiance);
        assert_int_equal(d->visible_to_camera, e->visible_to_camera);
    }
    assert_int_equal(a->transfer, b->transfer);
    assert_int_equal(a->material_count, b->material_count);
    for (size_t i = 0; i < a->material_count; i++) {
        const BpMaterial *m = &a->materials[i], *n = &b->materials[i];
        assert_string_equal(m->name, n->name);
        assert_int_equal(m->kind, n->kind);
        assert_memory_equal(m->albedo, n->albedo, sizeof m->albedo);
        assert_memory_equal(m->emit, n->emit, sizeof m->emit);
        assert_int_equal(m->scatter, n->scatter);
        assert_number(m->fuzz, n->fuzz);
        assert_int_equal(m->fuzz_shape, n->fuzz_shape);
        assert_number(m->refraction_index, n->refraction_index);
        assert_int_equal(m->fresnel, n->fresnel);
        assert_int_equal(m->total_reflection, n->total_reflection);
        assert_true(bp_material_opacity(m) == bp_material_opacity(n));
    }
    assert_int_equal(a->sphere_count, b->sphere_count);
    if (a->sphere_count > 0)
        assert_memory_equal(a->spheres, b->spheres, a->sphere_count * sizeof *a->spheres);
}

static void defaults(void **state) {
    (void)state;
    BpScene *scene = parse("\xef\xbb\xbf { \"camera\": {} }\n");
    const BpCamera *c = &scene->camera;
    assert_int_equal(c->width, 100);
    assert_int_equal(c->height, 100);
    assert_int_equal(c->samples_per_pixel, 10);
    assert_int_equal(c->max_depth, 10);
    assert_number(c->vfov_degrees, 90);
    assert_vector(c->lookfrom, 0, 0, 0);
    assert_vector(c->lookat, 0, 0, -1);
    assert_vector(c->vup, 0, 1, 0);
    assert_number(c->lens_radius, 0);
    assert_number(c->focus_dist, 10);
    assert_int_equal(c->pixel_sampling, BP_PIXEL_SQUARE);
    assert_vector(scene->background_bottom, 1, 1, 1);
    assert_vector(scene->background_top, 0.5, 0.7, 1.0);
    assert_int_equal(scene->disc_count, 0);
    assert_int_equal(scene->transfer, BP_TRANSFER_GAMMA2);
    BpSceneInfo info;
    bp_scene_info(scene, &info);
    assert_string_equal(info.title, "");
    assert_string_equal(info.source, "");
    assert_int_equal(info.spheres, 0);
    assert_int_equal(info.materials, 0);
    assert_int_equal(bp_scene_validate(scene, NULL), BP_OK);
    bp_scene_destroy(&scene);
    assert_null(scene);
    bp_scene_destroy(&scene);
}

static void every_member(void **state) {
    (void)state;
    BpScene *scene = parse(
        "{ \"format\": 1, \"title\": \"caf\xc3\xa9\", \"source\": \"s\",\n"
        "  \"camera\": { \"image_width\": 400.0, \"aspect_ratio\": [16, 9], \"samples_per_pixel\": 7, "
        "\"max_depth\": 0,\n"
        "    \"vfov\": 20, \"lookfrom\": [13,2,3], \"lookat\": [0,0,0], \"vup\": [0,0,1], \"defocus_angle\": "
        "90,\n"
        "    \"focus_dist\": 3, \"pixel_sampling\": \"center\" },\n"
        "  \"background\": [0.1, 0.2, 0.3], \"transfer\": \"srgb\",\n"
        "  \"materials\": {\n"
        "    \"a\": { \"type\": \"lambertian\", \"albedo\": [0, 0.5, 1], \"scatter\": \"hemisphere\", "
        "\"emit\": [1,2,3] },\n"
        "    \"b\": { \"type\": \"metal\", \"albedo\": [1, 1, 1], \"fuzz\": 7, \"fuzz_shape\": \"ball\" },\n"
        "    \"c\": { \"type\": \"dielectric\", \"refraction_index\": 0.5, \"fresnel\": \"exact\",\n"
        "             \"total_reflection\": \"absorb\" },\n"
        "    \"d\": { \"type\": \"diffuse_light\", \"emit\": [4, 0, 0] },\n"
        "    \"e\": { \"type\": \"normals\" },\n"
        "    \"f\": { \"type\": \"lambertian\", \"albedo\": [1, 1, 1] },\n"
        "    \"g\": { \"type\": \"metal\", \"albedo\": [1, 1, 1] },\n"
        "    \"h\": { \"type\": \"dielectric\", \"refraction_index\": 1.5 } },\n"
        "  \"spheres\": [ { \"center\": [1, 2, 3], \"radius\": -4, \"material\": \"h\" },\n"
        "               { \"center\": [1, 2, 3], \"radius\": 4, \"material\": \"a\" } ] }");
    const BpCamera *c = &scene->camera;
    assert_string_equal(scene->title, "caf\xc3\xa9");
    assert_int_equal(c->width, 400);
    assert_int_equal(c->height, 225);
    assert_int_equal(c->samples_per_pixel, 7);
    assert_int_equal(c->max_depth, 0);
    assert_vector(c->vup, 0, 0, 1);
    assert_true(fabs(c->lens_radius - 3) < 1e-14); /* 3 tan 45 */
    assert_int_equal(c->pixel_sampling, BP_PIXEL_CENTER);
    assert_vector(scene->background_bottom, 0.1, 0.2, 0.3);
    assert_vector(scene->background_top, 0.1, 0.2, 0.3);
    assert_int_equal(scene->transfer, BP_TRANSFER_SRGB);
    assert_int_equal(scene->material_count, 8);
    const BpMaterial *m = scene->materials;
    assert_string_equal(m[0].name, "a");
    assert_int_equal(m[0].scatter, BP_SCATTER_HEMISPHERE);
    assert_vector(m[0].emit, 1, 2, 3);
    assert_vector(m[0].albedo, 0, 0.5, 1);
    assert_int_equal(m[1].kind, BP_MATERIAL_METAL);
    assert_number(m[1].fuzz, 1); /* over 1 is as 1 */
    assert_int_equal(m[1].fuzz_shape, BP_FUZZ_BALL);
    assert_int_equal(m[2].kind, BP_MATERIAL_DIELECTRIC);
    assert_number(m[2].refraction_index, 0.5);
    assert_int_equal(m[2].fresnel, BP_FRESNEL_EXACT);
    assert_int_equal(m[2].total_reflection, BP_TOTAL_ABSORB);
    assert_int_equal(m[3].kind, BP_MATERIAL_DIFFUSE_LIGHT);
    assert_vector(m[3].emit, 4, 0, 0);
    assert_int_equal(m[4].kind, BP_MATERIAL_NORMALS);
    assert_int_equal(m[5].scatter, BP_SCATTER_LAMBERTIAN);
    assert_vector(m[5].emit, 0, 0, 0);
    assert_number(m[6].fuzz, 0);
    assert_int_equal(m[6].fuzz_shape, BP_FUZZ_SPHERE);
    assert_int_equal(m[7].fresnel, BP_FRESNEL_SCHLICK);
    assert_int_equal(m[7].total_reflection, BP_TOTAL_REFLECT);
    assert_int_equal(scene->sphere_count, 2);
    assert_vector(scene->spheres[0].center, 1, 2, 3);
    assert_number(scene->spheres[0].radius, -4);
    assert_int_equal(scene->spheres[0].material, 7);
    assert_int_equal(scene->spheres[1].material, 0);
    assert_int_equal(scene->spheres[1].albedo, BP_NO_ALBEDO);
    bp_scene_destroy(&scene);
}

static void heights(void **state) {
    (void)state;
    assert_int_equal(bp_camera_height(400, 16.0 / 9.0), 225);
    assert_int_equal(bp_camera_height(1200, 16.0 / 9.0), 675);
    assert_int_equal(bp_camera_height(1200, 3.0 / 2.0), 800);
    assert_int_equal(bp_camera_height(200, 2), 100);
    assert_int_equal(bp_camera_height(7, 16.0 / 9.0), 3);
    assert_int_equal(bp_camera_height(1, 1000), 1);
    assert_int_equal(bp_camera_height(65535, 1e-300), UINT32_MAX);
    static const double aspects[] = {1e-3, 0.5625, 1, 16.0 / 9.0, 70000};
    static const uint64_t pixels[] = {0, 1, 999, 1000, 480000, UINT32_MAX / 4, UINT32_MAX};
    for (size_t a = 0; a < sizeof aspects / sizeof aspects[0]; ++a)
        for (size_t p = 0; p < sizeof pixels / sizeof pixels[0]; ++p) {
            uint64_t widest = 0;
            for (uint64_t w = 1; w <= BP_PICTURE_SIDE_MAX; ++w)
                if (w * bp_camera_height((uint32_t)w, aspects[a]) <= pixels[p]) widest = w;
            assert_int_equal(bp_camera_width_of(pixels[p], aspects[a]), widest);
        }
    BpScene *scene =
        parse("{ \"camera\": { \"image_width\": 300, \"image_height\": 200, \"aperture\": 3 } }");
    assert_int_equal(scene->camera.height, 200);
    assert_number(scene->camera.lens_radius, 1.5);
    assert_int_equal(bp_scene_set_width(scene, 30, NULL), BP_OK);
    assert_int_equal(scene->camera.height, 20);
    BpError err = {0};
    assert_int_equal(bp_scene_set_width(scene, 0, &err), BP_ERR_USAGE);
    assert_non_null(strstr(err.message, "found 0"));
    assert_int_equal(bp_scene_set_width(scene, 65536, &err), BP_ERR_USAGE);
    assert_int_equal(scene->camera.width, 30);
    bp_error_clear(&err);
    bp_scene_destroy(&scene);
    scene = parse("{ \"camera\": { \"aspect_ratio\": 0.5 } }");
    assert_int_equal(scene->camera.height, 200);
    assert_int_equal(bp_scene_set_width(scene, 60000, NULL), BP_ERR_USAGE); /* 120000 high */
    bp_scene_destroy(&scene);
}

static void overlapping_dielectrics(void **state) {
    (void)state;
    BpScene *scene = parse(
        "{ \"camera\": {}, \"materials\": { \"g\": { \"type\": \"dielectric\", \"refraction_index\": 2 } },"
        "\"spheres\": [ { \"center\": [0,0,-2], \"radius\": 1, \"material\": \"g\" },"
        "{ \"center\": [0,0,-2], \"radius\": -0.99999, \"material\": \"g\" },"
        "{ \"center\": [0,0,-2.00001], \"radius\": 1, \"material\": \"g\" } ] }");
    assert_int_equal(scene->sphere_count, 3);
    bp_scene_destroy(&scene);
}

static void nearest_names(void **state) {
    (void)state;
    static const char *const names[] = {"lookfrom", "lookat", "vfov", "vup"};
    assert_string_equal(bp_nearest_name("lookform", names, 4), "lookfrom");
    assert_string_equal(bp_nearest_name("look_at", names, 4), "lookat");
    assert_string_equal(bp_nearest_name("fov", names, 4), "vfov");
    assert_string_equal(bp_nearest_name("LookFrom", names, 4), "lookfrom");
    assert_string_equal(bp_nearest_name("LOOK_AT", names, 4), "lookat");
    assert_null(bp_nearest_name("transparency", names, 4));
    assert_null(bp_nearest_name("", names, 4));
}

/* ---- written and made --------------------------------------------------------------------------------- */

static void temporary_path(char path[64]) {
    strcpy(path, "/tmp/ballpark-scene-XXXXXX");
    const int descriptor = mkstemp(path);
    assert_true(descriptor >= 0);
    close(descriptor);
}

/* Two kinds of metal have one name: which of them is meant is told by the roughness. */
static void metals(void **state) {
    (void)state;
    BpScene *scene =
        parse("{ \"camera\": {}, \"materials\": {\n"
              "\"a\": { \"type\": \"metal\", \"albedo\": [1, 1, 1], \"fuzz\": 0.5 },\n"
              "\"b\": { \"type\": \"metal\", \"albedo\": [1, 1, 1], \"roughness\": 0.25 },\n"
              "\"c\": { \"type\": \"metal\", \"albedo\": [1, 1, 1], \"roughness\": 0 },\n"
              "\"d\": { \"type\": \"oren_nayar\", \"albedo\": [1, 1, 1], \"roughness\": 1 },\n"
              "\"e\": { \"type\": \"glossy\", \"albedo\": [1, 1, 1] },\n"
              "\"f\": { \"type\": \"glossy\", \"albedo\": [1, 1, 1], \"roughness\": 0.5, "
              "\"refraction_index\": 2 },\n"
              "\"g\": { \"type\": \"dielectric\", \"refraction_index\": 1.4, \"roughness\": 0.5 },\n"
              "\"h\": { \"type\": \"dielectric\", \"refraction_index\": 1.4, \"roughness\": 0 } } }");
    const BpMaterial *m = scene->materials;
    assert_int_equal(m[0].kind, BP_MATERIAL_METAL);
    assert_int_equal(m[1].kind, BP_MATERIAL_ROUGH_METAL);
    assert_number(m[1].roughness, 0.25);
    assert_int_equal(m[2].kind, BP_MATERIAL_METAL); /* a mirror */
    assert_number(m[2].fuzz, 0);
    assert_int_equal(m[3].kind, BP_MATERIAL_OREN_NAYAR);
    assert_number(m[3].roughness, 1);
    assert_int_equal(m[4].kind, BP_MATERIAL_GLOSSY);
    assert_number(m[4].roughness, 0);
    assert_number(m[4].refraction_index, 1.5);
    assert_number(m[5].roughness, 0.5);
    assert_number(m[5].refraction_index, 2);
    assert_int_equal(m[6].kind, BP_MATERIAL_ROUGH_DIELECTRIC);
    assert_number(m[6].roughness, 0.5);
    assert_number(m[6].refraction_index, 1.4);
    assert_int_equal(m[7].kind, BP_MATERIAL_DIELECTRIC); /* the same kernel, and so the same bits */
    assert_int_equal(m[7].fresnel, BP_FRESNEL_EXACT);
    assert_number(m[7].refraction_index, 1.4);
    bp_scene_destroy(&scene);
}

static void assert_written_reads_back(const BpScene *scene, const char *of) {
    char path[64];
    BpScene *copy = NULL;
    BpError err = {0};
    temporary_path(path);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    if (bp_scene_print(scene, file, &err) != BP_OK) fail_msg("%s: %s", of, err.message);
    assert_int_equal(fclose(file), 0);
    if (bp_scene_load(path, &copy, &err) != BP_OK)
        fail_msg("%s: %d:%d %s", of, err.line, err.column, err.message);
    assert_same_scene(scene, copy);
    bp_scene_destroy(&copy);
    unlink(path);
}

static void every_file(void **state) {
    (void)state;
    glob_t found;
    size_t count = 0;
    assert_int_equal(glob(SOURCE_DIR "/scenes/*.json", 0, NULL, &found), 0);
    for (size_t i = 0; i < found.gl_pathc; i++) {
        const char *path = found.gl_pathv[i];
        if (strstr(path, "scene.schema.json") != NULL) continue;
        BpScene *scene = NULL;
        BpError err = {0};
        if (bp_scene_load(path, &scene, &err) != BP_OK)
            fail_msg("%s:%d:%d: %s", path, err.line, err.column, err.message);
        assert_true(scene->title[0] != '\0' && scene->source[0] != '\0'); /* the gallery shows them */
        for (size_t k = 0; k < scene->image_count; k++)                   /* since it is written elsewhere */
            assert_int_equal(bp_image_move(path, "/elsewhere/x.json", scene->images[k], &err), BP_OK);
        assert_written_reads_back(scene, path);
        bp_scene_destroy(&scene);
        count++;
    }
    globfree(&found);
    assert_true(count >= 65);
}

static void discs_of_the_sky(void **state) {
    (void)state;
    BpScene *scene =
        parse("{ \"camera\": {}, \"background\": { \"bottom\": [0, 0, 0], \"discs\": [\n"
              "{ \"direction\": [1, 2, -3], \"half_angle\": 0.25, \"radiance\": [9, 8, 7] },\n"
              "{ \"visible_to_camera\": false, \"radiance\": [0.1, 0, 1e12], \"half_angle\": 90, "
              "\"direction\": [0, 1e-20, 0] } ] } }");
    assert_vector(scene->background_bottom, 0, 0, 0);
    assert_vector(scene->background_top, 0.5, 0.7, 1.0);
    assert_int_equal(scene->disc_count, 2);
    const BpDisc *d = scene->discs;
    assert_vector(d[0].direction, 1, 2, -3);
    assert_number(d[0].half_angle_degrees, 0.25);
    assert_vector(d[0].radiance, 9, 8, 7);
    assert_true(d[0].visible_to_camera);
    assert_vector(d[1].direction, 0, 1e-20, 0);
    assert_number(d[1].half_angle_degrees, 90);
    assert_vector(d[1].radiance, 0.1, 0, 1e12);
    assert_false(d[1].visible_to_camera);
    assert_written_reads_back(scene, "discs");
    /* A scene that was not read is held to the same rules. */
    BpError err = {0};
    scene->discs[1].direction[1] = 0;
    assert_int_equal(bp_scene_validate(scene, &err), BP_ERR_SCENE);
    assert_non_null(strstr(err.message, "background.discs[1].direction: found no direction"));
    bp_error_clear(&err);
    scene->disc_count = BP_DISCS_MAX + 1;
    assert_int_equal(bp_scene_validate(scene, NULL), BP_ERR_LIMIT);
    bp_scene_destroy(&scene);
}

static void every_member_is_written(void **state) {
    (void)state;
    BpScene *scene =
        parse("{ \"title\": \"a \\\"b\\\" \\u001b\", \"camera\": { \"image_width\": 331, \"image_height\": "
              "77, \"aperture\": 0.3,"
              "\"focus_dist\": 0.1, \"vfov\": 33.3, \"pixel_sampling\": \"center\", \"lookfrom\": [-0.0, "
              "1e-7, 1e10] },"
              "\"background\": { \"bottom\": [0,0,0] }, \"transfer\": \"linear\", \"materials\": {"
              "\"m 1\": { \"type\": \"metal\", \"albedo\": [0.1,0.2,0.3], \"fuzz\": 0.1, \"fuzz_shape\": "
              "\"ball\", \"emit\": [1,1,1], \"opacity\": 0.3 },"
              "\"\": { \"type\": \"normals\", \"opacity\": 1 },"
              "\"d\": { \"type\": \"dielectric\", \"refraction_index\": 1.1, \"fresnel\": \"none\", "
              "\"total_reflection\": \"refract\" } },"
              "\"spheres\": [ { \"center\": [0.1,0.2,-0.0], \"radius\": -1e-3, \"material\": \"\" } ] }");
    assert_written_reads_back(scene, "every member");
    bp_scene_destroy(&scene);
}

static void covers(void **state) {
    (void)state;
    static const char *const editions[] = {"1", "3", "3rust", "4"};
    for (uint64_t seed = 0; seed < 20; seed++) {
        for (size_t e = 0; e < 4; e++) {
            BpScene *scene = NULL;
            BpError err = {0};
            if (bp_scene_generate_cover(editions[e], 11, seed, &scene, &err) != BP_OK)
                fail_msg("%s", err.message);
            if (e == 2)
                assert_int_equal(scene->sphere_count, 533);
            else
                assert_in_range(scene->sphere_count, 484, 488);
            for (size_t i = 1; e != 2 && i + 3 < scene->sphere_count; i++) {
                const double *c = scene->spheres[i].center;
                assert_true(hypot(c[0] - 4, c[2]) > 0.9);
            }
            bp_scene_destroy(&scene);
        }
    }
    BpScene *scene = NULL, *file = NULL;
    assert_int_equal(bp_scene_generate_cover("4", 11, 1, &scene, NULL), BP_OK);
    assert_int_equal(bp_scene_load(SOURCE_DIR "/scenes/cover.json", &file, NULL), BP_OK);
    assert_same_scene(scene, file); /* the file is the generator's, on every machine */
    assert_int_equal(file->camera.width, 1200);
    assert_int_equal(file->camera.height, 675);
    bp_scene_destroy(&scene);
    bp_scene_destroy(&file);
    assert_int_equal(bp_scene_generate_cover("4", 0, 1, &scene, NULL), BP_OK);
    assert_int_equal(scene->sphere_count, 4);
    bp_scene_destroy(&scene);
    BpError err = {0};
    assert_int_equal(bp_scene_generate_cover("2", 11, 1, &scene, &err), BP_ERR_USAGE);
    assert_non_null(strstr(err.message, "3rust"));
    assert_int_equal(bp_scene_generate_cover("4", 5001, 1, &scene, &err), BP_ERR_USAGE);
    bp_error_clear(&err);
}

static void many_spheres(void **state) {
    (void)state;
    const size_t count = 100000;
    char *text = malloc(count * 96 + 1000);
    assert_non_null(text);
    size_t used = (size_t)sprintf(text, "{ \"camera\": {}, \"materials\": { \"g\": { \"type\": "
                                        "\"dielectric\", \"refraction_index\": 1.5 } }, \"spheres\": [");
    for (size_t i = 0; i < count; i++)
        used += (size_t)sprintf(text + used,
                                "%s{ \"center\": [%zu, 0, -1], \"radius\": 0.25, \"material\": \"g\" }",
                                i > 0 ? ",\n" : "", i);
    strcpy(text + used, "] }");
    BpScene *scene = parse(text);
    assert_int_equal(scene->sphere_count, count);
    bp_scene_destroy(&scene);
    free(text);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(metals),
        cmocka_unit_test(defaults),
        cmocka_unit_test(every_member),
        cmocka_unit_test(heights),
        cmocka_unit_test(every_file),
        cmocka_unit_test(nearest_names),
        cmocka_unit_test(overlapping_dielectrics),
        cmocka_unit_test(covers),
        cmocka_unit_test(many_spheres),
        cmocka_unit_test(discs_of_the_sky),
        cmocka_unit_test(every_member_is_written),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
