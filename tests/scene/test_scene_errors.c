/* test_scene_errors.c: bad scene documents are refused, at the right place, in words that help. */
#include "scene/scene.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

typedef struct Case {
    const char *text;
    int line, column;
    const char *says[4]; /* parts of the message */
} Case;

static void refuse(const char *text, size_t length, int line, int column, const char *const says[4]) {
    BpScene *scene = NULL;
    BpError err = {0};
    const BpStatus status = bp_scene_parse(text, length, "folder/x.json", &scene, &err);
    if (status != BP_ERR_SCENE || err.line != line || err.column != column)
        fail_msg("expected %d:%d, found %d:%d \"%s\" (status %d) for\n%.200s", line, column, err.line,
                 err.column, err.message, (int)status, text);
    assert_null(scene);
    assert_int_equal(err.code, BP_ERR_SCENE);
    assert_int_equal(bp_status_exit_code(status), 2);
    assert_string_equal(err.file, "folder/x.json");
    for (int i = 0; i < 4 && says[i] != NULL; i++) {
        if (strstr(err.message, says[i]) == NULL)
            fail_msg("expected \"%s\" in \"%s\" for\n%.200s", says[i], err.message, text);
    }
    bp_error_clear(&err);
    /* A caller may not care for the story. */
    assert_int_equal(bp_scene_parse(text, length, "x.json", &scene, NULL), BP_ERR_SCENE);
}

static void refuse_all(const Case *cases, size_t count) {
    for (size_t i = 0; i < count; i++)
        refuse(cases[i].text, strlen(cases[i].text), cases[i].line, cases[i].column, cases[i].says);
}
#define REFUSE_ALL(cases) refuse_all(cases, sizeof(cases) / sizeof *(cases))

static void not_json(void **state) {
    (void)state;
    static const Case cases[] = {
        {"", 1, 1, {"empty file", "\"camera\""}},
        {" \n\t ", 1, 1, {"empty file"}},
        {"\xef\xbb\xbf", 1, 1, {"empty file"}},
        {"hello", 1, 1, {"not JSON", "expected a scene, which begins"}},
        {"BZh91AY&SY", 1, 1, {"packed by bzip2", "unpack it first"}},
        {"\x89PNG\r\n\x1a\n", 1, 1, {"a PNG picture", "expected a scene"}},
        {"{\"ballpark_film\": 1}", 1, 1, {"the sums of a render", "`ballpark merge FILE.bpa"}},
        {"\x1f\x8b\x08", 1, 1, {"packed by gzip", "unpack it first"}},
        {"\x01\xcb\x07", 1, 1, {"not text", "docs/PARTICLES.md"}},
        {"[1, 2]", 1, 1, {"found a list", "expected an object"}},
        {"\"camera\"", 1, 1, {"not JSON"}},
        {"{ \"camera\": {", 1, 14, {"found the end of the text", "truncated"}},
        {"{\n\"title\": \"abc", 2, 14, {"found the end of the text"}},
        {"{ \"camera\": {} } }", 1, 18, {"not JSON", "nothing after the closing brace"}},
        {"{ \"camera\": {}, }", 1, 17, {"not JSON", "comma too many"}},
        {"{\n  // the camera\n  \"camera\": {} }", 2, 3, {"not JSON", "no comments"}},
        {"{ \"camera\": { \"vfov\": NaN } }", 1, 23, {"not JSON", "no NaN", "finite number"}},
        {"{ \"camera\": { \"vfov\": Infinity } }", 1, 23, {"not JSON", "no Infinity"}},
        {"{ \"camera\": { \"vfov\": -Infinity } }", 1, 23, {"not JSON", "no Infinity"}},
        {"{ \"camera\": { \"vfov\": 1e400 } }", 1, 23, {"1e400", "1.7e308"}},
        {"{ \"camera\": { \"vfov\": 99999999999999999999 } }",
         1,
         23,
         {"camera.vfov: found 1e+20", "below 180"}},
        {"{ \"camera\": { \"image_width\": 99999999999999999999 } }",
         1,
         30,
         {"camera.image_width: found 1e+20", "from 1 to 65535"}},
        {"{ \"camera\": { \"lookfrom\": [0, -9223372036854775809, 0] } }",
         1,
         27,
         {"lookfrom", "-1e12 to 1e12"}},
        {"{ \"title\": \"caf\xe9\" }", 1, 12, {"0xe9", "UTF-8"}},
        {"{ \"title\": \"a\\u0000b\" }", 1, 12, {"not JSON"}},
    };
    REFUSE_ALL(cases);
}

static void repeated_members(void **state) {
    (void)state;
    static const Case cases[] = {
        {"{ \"camera\": {},\n  \"camera\": {} }", 2, 3, {"camera", "found twice", "remove one"}},
        {"{ \"camera\": { \"vfov\": 20, \"vfov\": 30 } }", 1, 27, {"vfov", "found twice"}},
        {"{ \"camera\": {}, \"materials\": { \"a \\\"b\": {}, \"a \\\"b\": {} } }",
         1,
         45,
         {"a \\\"b", "found twice"}},
    };
    REFUSE_ALL(cases);
}

static void unknown_members(void **state) {
    (void)state;
    static const Case cases[] = {
        {"{ \"camera\": {}, \"sphere\": [] }",
         1,
         17,
         {"sphere:", "unknown member", "did you mean \"spheres\"?"}},
        {"{ \"camera\": {\n  \"vfow\": 20 } }", 2, 3, {"camera.vfow", "did you mean \"vfov\"?"}},
        {"{ \"camera\": { \"lookform\": [0,0,0] } }", 1, 15, {"camera.lookform", "\"lookfrom\""}},
        {"{ \"camera\": { \"quux\": 1 } }", 1, 15, {"camera.quux", "expected one of", "image_width"}},
        {"{ \"camera\": {}, \"background\": { \"botom\": [1,1,1] } }",
         1,
         33,
         {"background.botom", "\"bottom\""}},
        {"{ \"camera\": {}, \"materials\": { \"m\": { \"type\": \"metal\", \"albdeo\": [1,1,1] } } }",
         1,
         56,
         {"materials.m.albdeo", "\"albedo\""}},
        {"{ \"camera\": {}, \"materials\": { \"m\": { \"type\": \"normals\" } },\n"
         "  \"spheres\": [ { \"center\": [0,0,0], \"radius\": 1, \"material\": \"m\" },\n"
         "               { \"centre\": [0,0,0], \"radius\": 1, \"material\": \"m\" } ] }",
         3,
         18,
         {"spheres[1].centre", "\"center\""}},
        {"{ \"camera\": {}, \"clouds\": [ { \"flie\": \"a.ply\" } ] }",
         1,
         31,
         {"clouds[0].flie", "\"file\""}},
    };
    REFUSE_ALL(cases);
}

static void wrong_types(void **state) {
    (void)state;
    static const Case cases[] = {
        {"{ \"camera\": [] }", 1, 13, {"camera: found a list of 0", "expected an object"}},
        {"{ \"camera\": { \"image_width\": \"wide\" } }",
         1,
         30,
         {"the text \"wide\"", "whole number from 1 to 65535"}},
        {"{ \"camera\": { \"image_width\": 10.5 } }", 1, 30, {"found 10.5", "whole number"}},
        {"{ \"camera\": { \"vfov\": true } }", 1, 23, {"camera.vfov: found true, expected a number"}},
        {"{ \"camera\": { \"vfov\": null } }", 1, 23, {"found null"}},
        {"{ \"camera\": { \"lookat\": [1, 2] } }", 1, 25, {"found a list of 2", "three numbers"}},
        {"{ \"camera\": { \"lookat\": [1, \"2\", 3] } }", 1, 29, {"camera.lookat[1]: found the text \"2\""}},
        {"{ \"camera\": { \"aspect_ratio\": [16, 9, 1] } }", 1, 31, {"found a list of 3", "[16, 9]"}},
        {"{ \"camera\": { \"aspect_ratio\": [16, 0] } }", 1, 31, {"above 0"}},
        {"{ \"camera\": { \"aspect_ratio\": -1 } }", 1, 31, {"above 0"}},
        {"{ \"camera\": {}, \"spheres\": {} }", 1, 28, {"spheres: found an object", "expected a list"}},
        {"{ \"camera\": {}, \"spheres\": [1] }", 1, 29, {"spheres[0]: found 1", "expected an object"}},
        {"{ \"camera\": {}, \"materials\": [] }", 1, 30, {"materials: found a list", "named materials"}},
        {"{ \"camera\": {}, \"title\": 5 }", 1, 26, {"title: found 5", "text"}},
        {"{ \"camera\": {}, \"background\": 1 }", 1, 31, {"background: found 1", "one colour"}},
        {"{ \"camera\": {}, \"clouds\": {} }", 1, 27, {"clouds: found an object"}},
        {"{ \"camera\": {}, \"clouds\": [3] }", 1, 28, {"clouds[0]: found 3"}},
        {"{ \"format\": 2, \"camera\": {} }", 1, 13, {"format: found 2, expected 1"}},
        {"{ \"format\": \"1\", \"camera\": {} }", 1, 13, {"format: found the text"}},
        {"{ \"camera\": {}, \"transfer\": \"gama2\" }",
         1,
         29,
         {"\"gama2\"", "\"srgb\"", "did you mean \"gamma2\"?"}},
        {"{ \"camera\": { \"pixel_sampling\": \"centre\" } }",
         1,
         33,
         {"\"centre\"", "did you mean \"center\"?"}},
    };
    REFUSE_ALL(cases);
}

static void bad_cameras(void **state) {
    (void)state;
    static const Case cases[] = {
        {"{ \"title\": \"no camera\" }", 1, 1, {"found no \"camera\""}},
        {"{ \"camera\": { \"image_width\": 0 } }", 1, 30, {"camera.image_width: found 0", "1 to 65535"}},
        {"{ \"camera\": { \"image_width\": 1e9 } }", 1, 30, {"found 1000000000", "1 to 65535"}},
        {"{ \"camera\": { \"image_width\": -5 } }", 1, 30, {"found -5"}},
        {"{ \"camera\": { \"image_height\": 0 } }", 1, 31, {"camera.image_height: found 0"}},
        {"{ \"camera\": { \"image_width\": 65535, \"aspect_ratio\": 1e-3 } }",
         1,
         53,
         {"65535000 pixels high"}},
        {"{ \"camera\": { \"image_height\": 9, \"aspect_ratio\": 1 } }",
         1,
         15,
         {"image_height", "\"aspect_ratio\"", "one"}},
        {"{ \"camera\": { \"vfov\": 0 } }",
         1,
         23,
         {"camera.vfov: found 0, expected degrees above 0 and below 180"}},
        {"{ \"camera\": { \"vfov\": 180 } }", 1, 23, {"found 180"}},
        {"{ \"camera\": { \"vfov\": -20 } }", 1, 23, {"found -20"}},
        {"{ \"camera\": { \"samples_per_pixel\": 0 } }", 1, 36, {"found 0", "1 to 4294967295"}},
        {"{ \"camera\": { \"max_depth\": -1 } }", 1, 28, {"found -1", "0 to 1000000"}},
        {"{ \"camera\": { \"lookfrom\": [1, 2, 3], \"lookat\": [1, 2, 3] } }",
         1,
         48,
         {"lookfrom and lookat"}},
        {"{ \"camera\": { \"lookfrom\": [0, 0.1, 0] }, \"materials\": { \"m\": { \"type\": \"normals\" } },\n"
         "\"spheres\": [ { \"center\": [0, 0.3, 0], \"radius\": 0.2, \"material\": \"m\" },\n"
         "{ \"center\": [0, -0.2, 0], \"radius\": -0.3, \"material\": \"m\" } ] }",
         1,
         27,
         {"camera.lookfrom", "both spheres[0] and spheres[1], expected at most one surface",
          "move the camera"}},
        {"{ \"camera\": { \"lookfrom\": [0, 0, -1] } }", 1, 27, {"camera.lookfrom", "same point"}},
        {"{ \"camera\": { \"vup\": [0, 0, 3] } }", 1, 22, {"camera.vup", "parallel to the view"}},
        {"{ \"camera\": { \"vup\": [0, 0, 0] } }", 1, 22, {"camera.vup", "no direction"}},
        {"{ \"camera\": { \"lookat\": [0, -1, 0] } }", 1, 13, {"vup", "parallel to the view"}},
        {"{ \"camera\": { \"aperture\": 1, \"defocus_angle\": 2 } }",
         1,
         15,
         {"aperture", "\"defocus_angle\"", "remove one"}},
        {"{ \"camera\": { \"aperture\": -1 } }", 1, 27, {"found -1", "diameter"}},
        {"{ \"camera\": { \"defocus_angle\": 180 } }", 1, 32, {"found 180", "below 180"}},
        {"{ \"camera\": { \"defocus_angle\": -1 } }", 1, 32, {"found -1"}},
        {"{ \"camera\": { \"focus_dist\": 1e-16 } }",
         1,
         29,
         {"camera.focus_dist: found 1e-16", "from 1e-15 to 1e12"}},
        {"{ \"camera\": { \"focus_dist\": 1e12, \"vfov\": 179.9 } }",
         1,
         43,
         {"camera.vfov: found 179.9 with a focus_dist of 1000000000000", "choose a smaller"}},
        {"{ \"camera\": { \"focus_dist\": 0 } }", 1, 29, {"camera.focus_dist: found 0", "above 0"}},
        {"{ \"camera\": { \"lookfrom\": [2e12, 0, 0] } }",
         1,
         27,
         {"camera.lookfrom: found 2000000000000", "1e12"}},
        {"{ \"camera\": {}, \"background\": [1, -1, 1] }", 1, 31, {"background: found -1", "from 0"}},
        {"{ \"camera\": {}, \"background\": { \"top\": [1, -1, 1] } }", 1, 40, {"background.top: found -1"}},
    };
    REFUSE_ALL(cases);
}

#define DISC(members) "{ \"camera\": {}, \"background\": { \"discs\": [ {" members "} ] } }"
#define ANY_DISC "{ \"direction\": [0, 1, 0], \"half_angle\": 1, \"radiance\": [1, 1, 1] }"
#define EIGHT_DISCS                                                                                          \
    ANY_DISC "," ANY_DISC "," ANY_DISC "," ANY_DISC "," ANY_DISC "," ANY_DISC "," ANY_DISC "," ANY_DISC

static void bad_discs(void **state) {
    (void)state;
    static const Case cases[] = {
        {"{ \"camera\": {}, \"background\": { \"discs\": {} } }",
         1,
         42,
         {"background.discs: found an object", "a list"}},
        {"{ \"camera\": {}, \"background\": { \"disks\": [] } }", 1, 33, {"background.disks", "\"discs\""}},
        {"{ \"camera\": {}, \"background\": { \"discs\": [ 1 ] } }",
         1,
         44,
         {"discs[0]: found 1", "half_angle"}},
        {DISC(""), 1, 44, {"background.discs[0]: found no \"direction\""}},
        {DISC("\"direction\": [1, 2, 0]"), 1, 44, {"discs[0]: found no \"half_angle\"", "degrees"}},
        {DISC("\"direction\": [1, 2, 0], \"half_angle\": 1"), 1, 44, {"found no \"radiance\""}},
        {DISC("\"direction\": [0, 0, 0], \"half_angle\": 1, \"radiance\": [1, 1, 1]"),
         1,
         58,
         {"background.discs[0].direction: found no direction", "such as"}},
        {DISC("\"direction\": [0, 2e12, 0], \"half_angle\": 1, \"radiance\": [1, 1, 1]"),
         1,
         58,
         {"discs[0].direction: found 2000000000000", "1e12"}},
        {DISC("\"direction\": [0, NaN, 0], \"half_angle\": 1, \"radiance\": [1, 1, 1]"), 1, 62, {"not JSON"}},
        {DISC("\"direction\": [0, 1, 0], \"half_angle\": 0, \"radiance\": [1, 1, 1]"),
         1,
         83,
         {"background.discs[0].half_angle: found 0", "from 0.0001 to 90"}},
        {DISC("\"direction\": [0, 1, 0], \"half_angle\": -1, \"radiance\": [1, 1, 1]"), 1, 83, {"found -1"}},
        {DISC("\"direction\": [0, 1, 0], \"half_angle\": 90.1, \"radiance\": [1, 1, 1]"),
         1,
         83,
         {"found 90.1"}},
        {DISC("\"direction\": [0, 1, 0], \"half_angle\": 1, \"radiance\": [1, -1, 1]"),
         1,
         98,
         {"discs[0].radiance: found -1", "from 0"}},
        {DISC("\"direction\": [0, 1, 0], \"half_angle\": 1, \"radiance\": [1, 1, 1], \"visible_to_camera\": "
              "1"),
         1,
         130,
         {"visible_to_camera: found 1", "true or false"}},
        {"{ \"camera\": {}, \"background\": { \"discs\": [" ANY_DISC
         ",\n{ \"direction\": [0, 1, 0],\n\"half_angle\": "
         "91, \"radiance\": [1, 1, 1] } ] } }",
         3,
         15,
         {"background.discs[1].half_angle: found 91"}},
        {"{ \"camera\": {}, \"background\": { \"discs\": [" EIGHT_DISCS "," EIGHT_DISCS "," EIGHT_DISCS
         "," EIGHT_DISCS "," ANY_DISC "] } }",
         1,
         42,
         {"background.discs: found 33 discs", "at most 32"}},
    };
    REFUSE_ALL(cases);
}

#define MATERIAL(members) "{ \"camera\": {}, \"materials\": { \"m\": { " members " } } }"

static void bad_materials(void **state) {
    (void)state;
    static const Case cases[] = {
        {MATERIAL(""), 1, 37, {"materials.m: found no \"type\"", "\"lambertian\""}},
        {MATERIAL("\"type\": \"lambertain\""), 1, 47, {"\"lambertain\"", "did you mean \"lambertian\"?"}},
        {MATERIAL("\"type\": \"lambertian\""), 1, 37, {"found no \"albedo\""}},
        {MATERIAL("\"type\": \"metal\", \"albedo\": [0.5, 1.5, 0.5]"),
         1,
         66,
         {"m.albedo: found 1.5", "0 to 1"}},
        {MATERIAL("\"type\": \"metal\", \"albedo\": [0.5, -0.5, 0.5]"), 1, 66, {"found -0.5"}},
        {MATERIAL("\"type\": \"metal\", \"albedo\": [1, 1, 1], \"fuzz\": -1"), 1, 85, {"m.fuzz: found -1"}},
        {MATERIAL("\"type\": \"dielectric\""), 1, 37, {"found no \"refraction_index\"", "1.5"}},
        {MATERIAL("\"type\": \"dielectric\", \"refraction_index\": -1.5"),
         1,
         81,
         {"found -1.5", "1.5, an air bubble"}},
        {MATERIAL("\"type\": \"dielectric\", \"refraction_index\": 0"), 1, 81, {"found 0"}},
        {MATERIAL("\"type\": \"diffuse_light\""), 1, 37, {"found no \"emit\""}},
        {MATERIAL("\"type\": \"diffuse_light\", \"emit\": [1, -4, 1]"), 1, 72, {"m.emit: found -4"}},
        {MATERIAL("\"type\": \"normals\", \"emit\": [1, 1e13, 1]"), 1, 66, {"1e12"}},
        {MATERIAL("\"type\": \"lambertian\", \"albedo\": [1, 1, 1], \"fuzz\": 0.5"),
         1,
         82,
         {"m.fuzz", "type \"lambertian\"", "only in \"metal\""}},
        {MATERIAL("\"type\": \"metal\", \"albedo\": [1, 1, 1], \"fresnel\": \"exact\""),
         1,
         77,
         {"m.fresnel", "only in \"dielectric\""}},
        {MATERIAL("\"type\": \"dielectric\", \"refraction_index\": 1.5, \"albedo\": [1, 1, 1]"),
         1,
         86,
         {"m.albedo", "only in \"lambertian\", \"metal\", \"oren_nayar\" and \"glossy\""}},
        {MATERIAL("\"type\": \"metal\", \"albedo\": [1, 1, 1], \"roughness\": 0.5, \"fuzz\": 0.5"),
         1,
         95,
         {"m.fuzz: found beside \"roughness\", expected only one of the two"}},
        {MATERIAL("\"type\": \"metal\", \"albedo\": [1, 1, 1], \"roughness\": 1.5"),
         1,
         90,
         {"m.roughness: found 1.5", "0 to 1"}},
        {MATERIAL("\"type\": \"oren_nayar\", \"albedo\": [1, 1, 1]"), 1, 37, {"found no \"roughness\""}},
        {MATERIAL("\"type\": \"lambertian\", \"albedo\": [1, 1, 1], \"roughness\": 0.5"),
         1,
         82,
         {"m.roughness", "only in \"metal\", \"dielectric\", \"oren_nayar\" and \"glossy\""}},
        {MATERIAL("\"type\": \"dielectric\", \"refraction_index\": 1.5, \"roughness\": 0.5, \"fresnel\": "
                  "\"exact\""),
         1,
         104,
         {"m.fresnel: found beside \"roughness\", expected only one of the two"}},
        {MATERIAL("\"type\": \"dielectric\", \"refraction_index\": 1.5, \"roughness\": 0, "
                  "\"total_reflection\": \"absorb\""),
         1,
         102,
         {"m.total_reflection: found beside \"roughness\""}},
        {MATERIAL("\"type\": \"dielectric\", \"refraction_index\": 11, \"roughness\": 0.5"),
         1,
         81,
         {"m.refraction_index: found 11", "from 0.1 to 10 where the surface is rough"}},
        {MATERIAL("\"type\": \"dielectric\", \"roughness\": 0.5"),
         1,
         61,
         {"m.roughness: found in a material of type"}},
        {MATERIAL("\"type\": \"glossy\", \"albedo\": [1, 1, 1], \"refraction_index\": 0.9"),
         1,
         98,
         {"m.refraction_index: found 0.9", "of a coat over that of the air, from 1 to 10"}},
        {MATERIAL("\"type\": \"glossy\""), 1, 37, {"found no \"albedo\""}},
    };
    REFUSE_ALL(cases);
}

#define SPHERES(list)                                                                                        \
    "{ \"camera\": {}, \"materials\": {\n"                                                                   \
    "\"glass\": { \"type\": \"dielectric\", \"refraction_index\": 1.5 },\n"                                  \
    "\"ground\": { \"type\": \"lambertian\", \"albedo\": [1, 1, 1] } }, \"spheres\": [\n" list "\n] }"

static void bad_spheres(void **state) {
    (void)state;
    static const Case cases[] = {
        {SPHERES("{ \"radius\": 1, \"material\": \"glass\" }"), 4, 1, {"spheres[0]: found no \"center\""}},
        {SPHERES("{ \"center\": [0, 0, 0], \"material\": \"glass\" }"), 4, 1, {"found no \"radius\""}},
        {SPHERES("{ \"center\": [0, 0, 0], \"radius\": 1 }"), 4, 1, {"found no \"material\""}},
        {SPHERES("{ \"center\": [0, 0, 0], \"radius\": 0, \"material\": \"glass\" }"),
         4,
         34,
         {"spheres[0].radius: found 0", "inside out"}},
        {SPHERES("{ \"center\": [0, 0, 0], \"radius\": 1e-300, \"material\": \"glass\" }"),
         4,
         34,
         {"1.2e-38"}},
        {SPHERES("{ \"center\": [0, 0, 0], \"radius\": 2e12, \"material\": \"glass\" }"), 4, 34, {"1e12"}},
        {SPHERES("{ \"center\": [0, -2e12, 0], \"radius\": 1, \"material\": \"glass\" }"),
         4,
         13,
         {"spheres[0].center: found -2000000000000", "1e12"}},
        {SPHERES("{ \"center\": [0, 0, 0], \"radius\": 1, \"material\": \"gruond\" }"),
         4,
         49,
         {"spheres[0].material", "\"gruond\"", "did you mean \"ground\"?"}},
        {SPHERES("{ \"center\": [0, 0, 0], \"radius\": 1, \"material\": 3 }"), 4, 49, {"found 3", "text"}},
        {"{ \"camera\": {}, \"spheres\": [ { \"center\": [0,0,0], \"radius\": 1, \"material\": \"a\" } ] }",
         1,
         76,
         {"\"a\"", "empty or absent"}},
        {SPHERES("{ \"center\": [0, 0, 0], \"radius\": 1, \"material\": \"ground\" },\n"
                 "{ \"center\": [1, 2, 3], \"radius\": 1, \"material\": \"glass\" },\n"
                 "{ \"center\": [1, 2, 3], \"radius\": -1.0000000000001, \"material\": \"glass\" }"),
         6,
         1,
         {"spheres[1] and spheres[2]", "same centre and radius", "remove one"}},
        {SPHERES("{ \"center\": [1, 2, 3], \"radius\": 1, \"material\": \"glass\" },\n"
                 "{ \"center\": [1, 2.0000000001, 3], \"radius\": 1.00000001, \"material\": \"glass\" }"),
         5,
         1,
         {"spheres[0] and spheres[1]"}},
    };
    REFUSE_ALL(cases);
}

static void bad_clouds(void **state) {
    (void)state;
#define CLOUD(members)                                                                                       \
    "{ \"camera\": {}, \"materials\": { \"m\": { \"type\": \"normals\" } }, \"clouds\": [ {\n" members       \
    "\n} ] }"
    static const Case cases[] = {
        {CLOUD("\"material\": \"m\""), 1, 74, {"clouds[0]: found no \"file\""}},
        {CLOUD("\"file\": \"a.ply\""), 1, 74, {"clouds[0]: found no \"material\""}},
        {CLOUD("\"file\": \"a.ply\", \"material\": \"n\""), 2, 30, {"did you mean \"m\"?"}},
        {CLOUD("\"file\": \"a.ply\", \"materials\": []"), 2, 31, {"found a list of 0"}},
        {CLOUD("\"file\": \"a.ply\", \"materials\": [\"m\", \"x\"]"), 2, 37, {"materials[1]", "\"x\""}},
        {CLOUD("\"file\": \"a.ply\", \"material\": \"m\", \"radius\": 0"), 2, 45, {"radius: found 0"}},
        {CLOUD("\"file\": \"none.ply\", \"material\": \"m\""), 2, 9, {"\"folder/none.ply\"", "cannot open"}},
        {CLOUD("\"file\": \"/\", \"material\": \"m\""), 2, 9, {"found a directory", "PLY file"}},
        {CLOUD("\"file\": \"/dev/null\", \"material\": \"m\""), 2, 9, {"found a device", "PLY file"}},
    };
    REFUSE_ALL(cases);
}

static void deep_nesting(void **state) {
    (void)state;
    const size_t length = 200u * 1000u * 1000u;
    char *text = malloc(length);
    assert_non_null(text);
    memset(text, '[', length);
    static const char *const says[4] = {"nested too deeply"};
    refuse(text, length, 1, 2049, says);
    for (size_t i = 0; i + 5 < length && i < 100000; i += 5) memcpy(text + i, "{\"a\":", 5);
    static const char *const says_object[4] = {"nested too deeply"};
    refuse(text, 100000, 1, 2048 * 5 + 1, says_object);
    free(text);
}

static void long_names(void **state) {
    (void)state;
    char text[9000];
    char name[4001];
    memset(name, 'n', sizeof name - 1);
    name[sizeof name - 1] = '\0';
    snprintf(text, sizeof text, "{ \"camera\": {}, \"%s\": 1 }", name);
    static const char *const unknown[4] = {"nnn...", "expected one of"};
    refuse(text, strlen(text), 1, 17, unknown);
    static const char *const escape[4] = {"title?[2J"};
    static const char hostile[] = "{ \"camera\": {}, \"title\\u001b[2J\": 1 }";
    refuse(hostile, strlen(hostile), 1, 17, escape);
}

static void not_a_file(void **state) {
    (void)state;
    static const struct {
        const char *path, *says;
    } cases[] = {
        {"/", "found a directory"}, {"/dev/zero", "found a device"}, {"/no/such/file.json", "cannot open"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        BpScene *scene = NULL;
        BpError err = {0};
        const BpStatus status = bp_scene_load(cases[i].path, &scene, &err);
        assert_int_equal(bp_status_exit_code(status), 2);
        assert_string_equal(err.file, cases[i].path);
        assert_non_null(strstr(err.message, cases[i].says));
        assert_null(scene);
        bp_error_clear(&err);
    }
}

/* A text ends where its bytes end, not at the first that is 0. */
static void bytes_of_value_zero(void **state) {
    (void)state;
    static const char after[] = "{ \"camera\": {} }\n\0 anything";
    static const char within[] = "{ \"camera\": {},\n  \"title\": \"a\0b\" }";
    static const char *const says[4] = {"a byte of value 0", "remove it"};
    refuse(after, sizeof after - 1, 2, 1, says);
    refuse(within, sizeof within - 1, 2, 14, says);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(not_json),         cmocka_unit_test(bytes_of_value_zero),
        cmocka_unit_test(repeated_members), cmocka_unit_test(unknown_members),
        cmocka_unit_test(wrong_types),      cmocka_unit_test(bad_cameras),
        cmocka_unit_test(bad_materials),    cmocka_unit_test(bad_spheres),
        cmocka_unit_test(bad_clouds),       cmocka_unit_test(deep_nesting),
        cmocka_unit_test(long_names),       cmocka_unit_test(not_a_file),
        cmocka_unit_test(bad_discs),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
