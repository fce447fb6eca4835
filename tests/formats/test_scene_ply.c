/* test_scene_ply.c: points from PLY files in every form. */
#include "base/random.h"
#include "formats/field.h"
#include "particles/ply_rows.h"
#include "ply_data.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

static void assert_close(double found, double expected) {
    if (!(fabs(found - expected) <= 1e-7 * fabs(expected)))
        fail_msg("found %.17g, expected %.17g", found, expected);
}

static void ascii_minimal(void **state) {
    (void)state;
    BpScene *scene = accept_text(
        "ply\r\nformat ascii 1.0\r\ncomment made by hand\r\nelement vertex 3\r\nproperty float x\r\n"
        "property double y\r\nproperty int z\r\nend_header\r\n"
        "1 2.5 -3\r\n\r\n  1e-3\t-0.1e2   +7 \r\n12345678901.2345678901234567890 0 0.1e-1",
        &(BpPlyOptions){.radius = -0.5, .material = 1});
    static const double expected[3][3] = {{1, 2.5, -3}, {0.001, -10, 7}, {12345678901.2345678901, 0, 0.01}};
    assert_int_equal(scene->sphere_count, 3);
    assert_int_equal(scene->albedo_count, 0);
    for (int i = 0; i < 3; i++) {
        assert_memory_equal(scene->spheres[i].center, expected[i], sizeof expected[i]);
        assert_true(scene->spheres[i].radius == -0.5);
        assert_int_equal(scene->spheres[i].material, 1);
    }
    bp_scene_destroy(&scene);
}

static void ascii_numbers(void **state) {
    (void)state;
    static const char *const texts[] = {"0",
                                        "-0",
                                        "1.5",
                                        "+2.25e2",
                                        ".5",
                                        "5.",
                                        "0.1",
                                        "1e22",
                                        "1e-22",
                                        "1e23",
                                        "123456789012345678",
                                        "9007199254740993",
                                        "1e-320",
                                        "4.35",
                                        "0.3",
                                        "1.7976931348623157e308",
                                        "3.14159265358979323846",
                                        "2E+3",
                                        "1e-05"};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        char text[64];
        snprintf(text, sizeof text, "  %s 7", texts[i]);
        char *cursor = text;
        double value = -1;
        assert_true(ply_parse_number(&cursor, &value));
        if (!(value == strtod(texts[i], NULL))) fail_msg("%s: %.17g", texts[i], value);
        assert_true(ply_parse_number(&cursor, &value) && value == 7);
        assert_false(ply_parse_number(&cursor, &value));
    }
    static const char *const bad[] = {"",         " ",        "x",     "1x",      "-",    ".",   "1e",
                                      "--1",      "1,5",      "1D",    "1*^",     "1*2",  "1-2", "1-103",
                                      "1.5-1034", "1.5-12.5", "1e5D3", "1.5D--2", "nano", "1.#"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        char text[16];
        double value;
        strcpy(text, bad[i]);
        char *cursor = text;
        if (ply_parse_number(&cursor, &value)) fail_msg("accepted \"%s\"", bad[i]);
    }
    /* As Fortran and Mathematica write exponents. */
    static const char *const others[][2] = {{"1.5D+02", "1.5e2"},
                                            {"-.25d0", "-.25"},
                                            {"1Q-3", "1e-3"},
                                            {"-4.7*^-1", "-0.47"},
                                            {"3*^2", "300"},
                                            {"0.25-103", "0.25e-103"},
                                            {"-1.75+101", "-1.75e101"},
                                            {"0.1234567890123456789012D+01", "1.234567890123456789012"}};
    for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
        char text[64];
        double value = 0;
        snprintf(text, sizeof text, "%s 7", others[i][0]);
        char *cursor = text;
        assert_true(ply_parse_number(&cursor, &value));
        if (!(value == strtod(others[i][1], NULL))) fail_msg("%s: %.17g", others[i][0], value);
        assert_true(ply_parse_number(&cursor, &value) && value == 7);
    }
    static const char *const none[] = {"nan", "-NaN", "nan(ind)", "-1.#IND", "1.#QNAN00", "********"};
    for (size_t i = 0; i < sizeof none / sizeof *none; i++) {
        char text[64];
        double value = 0;
        strcpy(text, none[i]);
        char *cursor = text;
        assert_true(ply_parse_number(&cursor, &value) && isnan(value));
        assert_int_equal(*cursor, '\0');
    }
    /* Against strtod, over numbers of all lengths. */
    BpRandom random = {1};
    for (int i = 0; i < 20000; i++) {
        const uint64_t bits = bp_random_bits(&random);
        char text[64];
        double value;
        snprintf(text, sizeof text, "%s%.*g", bits & 1u ? "" : "-", (int)(bits >> 60) + 3,
                 (double)(bits >> 20) * pow(10, (double)(int)(bits >> 10 & 63u) - 32));
        char *cursor = text;
        assert_true(ply_parse_number(&cursor, &value));
        if (!(value == strtod(text, NULL))) fail_msg("%s: %.17g", text, value);
    }
}

static void ascii_everything(void **state) {
    (void)state;
    BpScene *scene = accept_text(
        "ply\nformat ascii 1.0\nobj_info none\nelement camera 2\nproperty list uchar int a\nproperty float "
        "b\n"
        "element vertex 2\nproperty uchar red\nproperty float x\nproperty float y\nproperty float quality\n"
        "property float z\nproperty list uchar float spare\nproperty uchar green\nproperty uchar blue\n"
        "property float radius\nproperty uchar material\nelement face 1\nproperty list uchar int "
        "vertex_indices\n"
        "end_header\n3 1 2 3 0.5\n0 0.5\n"
        "255 1 2 99 3 2 8 9 0 128 0.25 0\n"
        "0 4 5 99 6 0 10 11 -0.75 1\n3 0 1 1\n",
        &(BpPlyOptions){.material = BP_PLY_NO_MATERIAL, .materials = two_materials, .material_count = 2});
    assert_int_equal(scene->sphere_count, 2);
    const BpSphere *s = scene->spheres;
    assert_true(s[0].center[0] == 1 && s[0].center[1] == 2 && s[0].center[2] == 3 && s[0].radius == 0.25);
    assert_int_equal(s[0].material, 1);
    assert_int_equal(s[0].albedo, BP_NO_ALBEDO); /* glass has none to replace */
    assert_true(s[1].center[0] == 4 && s[1].center[1] == 5 && s[1].center[2] == 6 && s[1].radius == -0.75);
    assert_int_equal(s[1].material, 0);
    assert_int_equal(s[1].albedo, 0);
    assert_int_equal(scene->albedo_count, 1);
    /* IEC 61966-2-1: 10 lies on the straight part, 11 on the curve. */
    assert_true(scene->albedos[0][0] == 0);
    assert_close((double)scene->albedos[0][1], 10 / 255.0 / 12.92);
    assert_close((double)scene->albedos[0][2], pow((11 / 255.0 + 0.055) / 1.055, 2.4));
    bp_scene_destroy(&scene);
}

static void linear_colours(void **state) {
    (void)state;
    BpScene *scene = accept_text(
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
        "property float red\nproperty float green\nproperty float blue\nend_header\n"
        "1 2 3 0 0.5 1\n",
        &all_matte);
    assert_true(scene->albedos[0][0] == 0 && scene->albedos[0][1] == 0.5f && scene->albedos[0][2] == 1);
    assert_true(scene->spheres[0].radius == 0.5);
    bp_scene_destroy(&scene);
}

/* IEC 61966-2-1. */
static double linear(double encoded) {
    return encoded <= 0.04045 ? encoded / 12.92 : pow((encoded + 0.055) / 1.055, 2.4);
}

/* The type tells uchar; of others the largest number of the file decides. */
static void ranges_of_colours(void **state) {
    (void)state;
    static const struct {
        const char *type, *names[3];
        double numbers[6], scale; /* scale 1: linear */
        const char *note;
    } cases[] = {
        {"uchar", {"red", "green", "blue"}, {1, 0, 1, 0, 0, 1}, 255, ""},
        {"uchar", {"diffuse_red", "diffuse_green", "diffuse_blue"}, {255, 128, 10, 11, 3, 0}, 255, ""},
        {"ushort",
         {"r", "g", "b"},
         {65535, 32768, 100, 0, 257, 3000},
         65535,
         "colours read as 16 bits (sRGB)"},
        {"ushort", {"red", "green", "blue"}, {255, 128, 10, 11, 3, 0}, 255, "colours read as bytes (sRGB)"},
        {"int", {"red", "green", "blue"}, {255, 128, 10, 11, 3, 0}, 255, "colours read as bytes (sRGB)"},
        {"uint", {"R", "G", "B"}, {1000, 128, 10, 11, 3, 0}, 65535, "colours read as 16 bits (sRGB)"},
        {"int", {"red", "green", "blue"}, {1, 0, 1, 0, 0, 1}, 1, "colours read as linear shares from 0 to 1"},
        {"float", {"vertex_color_r", "vertex_color_g", "vertex_color_b"}, {1, 0.5, 0.25, 0, 0.125, 1}, 1, ""},
        {"double", {"red", "green", "blue"}, {255, 127.5, 10, 11, 3, 0}, 255, "colours read as bytes (sRGB)"},
        {"float", {"red", "green", "blue"}, {1.000001, 0.5, 0.25, 0, 0.125, 1}, 1, ""}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[512], notes[BP_PLY_NOTES_SIZE];
        const double *const n = cases[i].numbers;
        BpError err = {0};
        const int length = snprintf(
            text, sizeof text,
            "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int a\nelement vertex 2\nproperty "
            "float x\nproperty float y\nproperty float z\nproperty %s %s\nproperty %s %s\nproperty %s "
            "%s\nproperty uchar alpha\nend_header\n3 0 0 0\n1 2 3 %.9g %.9g %.9g 7\n4 5 6 %.9g %.9g %.9g 7\n",
            cases[i].type, cases[i].names[0], cases[i].type, cases[i].names[1], cases[i].type,
            cases[i].names[2], n[0], n[1], n[2], n[3], n[4], n[5]);
        FILE *const stream = tmpfile();
        assert_non_null(stream);
        assert_int_equal(fwrite(text, 1, (size_t)length, stream), length);
        rewind(stream);
        BpScene *scene = empty_scene();
        if (bp_ply_read(stream, (uint64_t)length, "a.ply", &all_matte, scene, notes, &err) != BP_OK)
            fail_msg("case %zu: %s", i, err.message);
        fclose(stream);
        assert_string_equal(notes, cases[i].note);
        assert_int_equal(scene->albedo_count, 2);
        for (int c = 0; c < 6; c++) {
            const double share = n[c] / cases[i].scale;
            assert_close((double)scene->albedos[c / 3][c % 3], share >= 1            ? 1
                                                               : cases[i].scale == 1 ? share
                                                                                     : linear(share));
        }
        bp_scene_destroy(&scene);
    }
}

static size_t put(unsigned char *out, const void *value, size_t size, bool big) {
    const uint16_t one = 1;
    const bool little_here = *(const unsigned char *)&one == 1;
    for (size_t i = 0; i < size; i++)
        out[i] = ((const unsigned char *)value)[big == little_here ? size - 1 - i : i];
    return size;
}

static void binary(void **state) {
    (void)state;
    for (int big = 0; big < 2; big++) {
        for (int lists = 0; lists < 2; lists++) {
            unsigned char bytes[2048];
            size_t n = (size_t)snprintf(
                (char *)bytes, sizeof bytes,
                "ply\nformat binary_%s_endian 1.0\nelement before 3\nproperty short a\n%selement vertex 2\n"
                "property float x\nproperty double y\nproperty short z\n%sproperty float32 radius\nproperty "
                "int material\n"
                "element face 1\nproperty list uchar int i\nend_header\n",
                big ? "big" : "little", lists ? "property list ushort double c\n" : "",
                lists ? "property list int uchar d\n" : "");
            for (int16_t i = 0; i < 3; i++) {
                const uint16_t length = (uint16_t)i;
                n += put(bytes + n, &i, 2, big);
                if (lists) n += put(bytes + n, &length, 2, big);
                for (int k = 0; lists && k < i; k++) n += put(bytes + n, &(double){7}, 8, big);
            }
            for (int i = 0; i < 2; i++) {
                n += put(bytes + n, &(float){1.5f + (float)i}, 4, big);
                n += put(bytes + n, &(double){2.25}, 8, big);
                n += put(bytes + n, &(int16_t){-300}, 2, big);
                if (lists) n += put(bytes + n, &(int32_t){5}, 4, big) + 5;
                n += put(bytes + n, &(float){0.125f}, 4, big);
                n += put(bytes + n, &(int32_t){i}, 4, big);
            }
            bytes[n++] = 1; /* the face */
            n += put(bytes + n, &(int32_t){0}, 4, big);
            const BpPlyOptions options = {
                .material = BP_PLY_NO_MATERIAL, .materials = two_materials, .material_count = 2};
            BpScene *scene = accept(bytes, n, &options);
            assert_int_equal(scene->sphere_count, 2);
            const BpSphere *s = scene->spheres;
            assert_true(s[0].center[0] == 1.5 && s[0].center[1] == 2.25 && s[0].center[2] == -300);
            assert_true(s[1].center[0] == 2.5 && s[1].radius == 0.125);
            assert_int_equal(s[0].material, 1);
            assert_int_equal(s[1].material, 0);
            bp_scene_destroy(&scene);
            /* Cut short anywhere in the rows, it is refused, and the scene stays as it was. */
            for (size_t cut = 1; cut <= 20; cut++) {
                BpError err = {0};
                scene = empty_scene();
                assert_int_equal(read_bytes(bytes, n - cut, &options, scene, &err), BP_ERR_SCENE);
                assert_non_null(strstr(err.message, "truncated"));
                assert_int_equal(scene->sphere_count, 0);
                bp_scene_destroy(&scene);
                bp_error_clear(&err);
            }
        }
    }
}

/* A field on the disk, and the scene beside it that names it. */
static void field_and_cloud(void **state) {
    (void)state;
    char folder[] = "/tmp/ballpark-cloud-XXXXXX", ply[64], json[64];
    assert_non_null(mkdtemp(folder));
    snprintf(ply, sizeof ply, "%s/field.ply", folder);
    snprintf(json, sizeof json, "%s/field.json", folder);
    BpError err = {0};
    FILE *file = fopen(ply, "wb");
    assert_non_null(file);
    assert_int_equal(bp_field_print_ply(100000, 7, file, &err), BP_OK);
    assert_int_equal(fclose(file), 0);
    file = fopen(json, "w");
    assert_non_null(file);
    fputs("{ \"camera\": {}, \"materials\": { \"m\": { \"type\": \"lambertian\", \"albedo\": [1, 1, 1] } },\n"
          "  \"spheres\": [ { \"center\": [0, 0, 0], \"radius\": 100, \"material\": \"m\" } ],\n"
          "  \"clouds\": [ { \"file\": \"field.ply\", \"material\": \"m\" }, { \"file\": \"field.ply\", "
          "\"material\": \"m\" } ] }",
          file);
    fclose(file);
    BpScene *scene = NULL;
    if (bp_scene_load(json, &scene, &err) != BP_OK) fail_msg("%s", err.message);
    assert_int_equal(scene->sphere_count, 200001);
    assert_int_equal(scene->albedo_count, 200000);
    const double spacing = 20 / cbrt(100000);
    double sum[3] = {0};
    for (size_t i = 1; i < scene->sphere_count; i++) {
        const BpSphere *s = &scene->spheres[i];
        assert_int_equal(s->albedo, i - 1);
        assert_true(s->radius >= 0.0999 * spacing && s->radius <= 0.4001 * spacing);
        for (int k = 0; k < 3; k++) {
            assert_true(fabs(s->center[k]) <= BP_FIELD_HALF_SIDE);
            sum[k] += s->center[k];
        }
    }
    /* The mean of 1e5 even draws over [-10, 10] has a standard deviation of 0.018. */
    for (int k = 0; k < 3; k++) assert_true(fabs(sum[k] / 200000) < 0.09);
    assert_int_equal(bp_scene_print(scene, stdout, &err), BP_ERR_SCENE); /* colours of points have no JSON */
    bp_scene_destroy(&scene);
    bp_error_clear(&err);

    /* A fault of the file stands at the file; a pipe is no file, and is not waited for. */
    file = fopen(ply, "w");
    assert_non_null(file);
    fputs("ply\nformat ascii 1.0\nelement vertex 1\n", file);
    fclose(file);
    assert_int_equal(bp_scene_load(json, &scene, &err), BP_ERR_SCENE);
    assert_string_equal(err.file, ply);
    assert_int_equal(err.line, 4);
    unlink(ply);
    assert_int_equal(mkfifo(ply, 0600), 0);
    assert_int_equal(bp_scene_load(json, &scene, &err), BP_ERR_SCENE);
    assert_string_equal(err.file, json);
    assert_int_equal(err.line, 3);
    assert_non_null(strstr(err.message, "found a pipe"));
    bp_error_clear(&err);
    assert_int_equal(bp_field_print_ply(0, 7, stdout, &err), BP_ERR_USAGE);
    assert_int_equal(bp_field_print_ply(BP_SPHERES_MAX + UINT64_C(1), 7, stdout, &err), BP_ERR_USAGE);
    bp_error_clear(&err);
    unlink(ply);
    unlink(json);
    rmdir(folder);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ascii_minimal),     cmocka_unit_test(ascii_numbers),
        cmocka_unit_test(ascii_everything),  cmocka_unit_test(linear_colours),
        cmocka_unit_test(ranges_of_colours), cmocka_unit_test(binary),
        cmocka_unit_test(field_and_cloud),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
