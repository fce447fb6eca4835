/* test_scene_clouds.c: what is wrong with a file of points is told with the file, the vertex, and the scene
 * that asks for it; files end where their header says. */
#include "formats/scene_load.h"
#include "scene/scene.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#define ASCII(count)                                                                                         \
    "ply\nformat ascii 1.0\nelement vertex " count "\nproperty float x\nproperty float y\nproperty float "   \
    "z\n"
#define BINARY(count)                                                                                        \
    "ply\nformat binary_little_endian 1.0\nelement vertex " count                                            \
    "\nproperty float x\nproperty float y\nproperty float z\n"
#define SCENE(spheres, clouds)                                                                               \
    "{ \"camera\": {}, \"materials\": {\n"                                                                   \
    "\"glass\": { \"type\": \"dielectric\", \"refraction_index\": 1.5 } },\n"                                \
    "\"spheres\": [" spheres "],\n"                                                                          \
    "\"clouds\": [" clouds "] }\n"
#define CLOUD(file) "{ \"file\": \"" file "\", \"radius\": 0.5, \"material\": \"glass\" }"

static void write_file(const char *name, const void *bytes, size_t size) {
    FILE *file = fopen(name, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

static void write_text(const char *name, const char *text) {
    write_file(name, text, strlen(text));
}

/* Loads a scene whose file stands at the place, and whose message has all of `says`. */
static void refuse(const char *text, const char *file, int line, int column, const char *const says[5]) {
    BpScene *scene = NULL;
    BpError err = {0};
    write_text("scene.json", text);
    assert_int_equal(bp_scene_load("scene.json", &scene, &err), BP_ERR_SCENE);
    for (int i = 0; i < 5 && says[i] != NULL; ++i)
        if (strstr(err.message, says[i]) == NULL) fail_msg("expected \"%s\" in \"%s\"", says[i], err.message);
    if (strcmp(err.file, file) != 0 || err.line != line || err.column != column)
        fail_msg("%s:%d:%d: %s", err.file, err.line, err.column, err.message);
    bp_error_clear(&err);
}

static void accept(const char *text, size_t spheres) {
    BpScene *scene = NULL;
    BpError err = {0};
    write_text("scene.json", text);
    if (bp_scene_load("scene.json", &scene, &err) != BP_OK) fail_msg("%s", err.message);
    assert_int_equal(scene->sphere_count, spheres);
    bp_scene_destroy(&scene);
}

static void coincident_vertices_are_named(void **state) {
    (void)state;
    write_text("twice.ply", ASCII("3") "end_header\n1 2 3\n4 5 6\n1 2 3\n");
    write_text("more.ply", ASCII("2") "end_header\n7 8 9\n4 5 6\n");
    refuse(SCENE("", CLOUD("twice.ply")), "scene.json", 4, 12,
           (const char *const[5]){"vertex 0 (from 0) of twice.ply and vertex 2 (from 0) of twice.ply",
                                  "dielectrics", "clouds[0]"});
    write_text("twice.ply", ASCII("3") "end_header\n1 2 3\n4 5 6\n1 2 4\n");
    refuse(SCENE("", CLOUD("more.ply") ", \n" CLOUD("twice.ply")), "scene.json", 5, 1,
           (const char *const[5]){"vertex 1 (from 0) of more.ply and vertex 1 (from 0) of twice.ply",
                                  "clouds[1]"});
    refuse(SCENE("{ \"center\": [0, 0, 5], \"radius\": 1, \"material\": \"glass\" },\n"
                 "{ \"center\": [7, 8, 9], \"radius\": 0.5, \"material\": \"glass\" }",
                 CLOUD("more.ply")),
           "scene.json", 4, 1, (const char *const[5]){"spheres[1] and vertex 0 (from 0) of more.ply"});
}

static void an_infinite_place_is_named(void **state) {
    (void)state;
    write_text("points.ply", ASCII("1") "end_header\n1 inf 3\n");
    refuse(SCENE("", CLOUD("points.ply")), "points.ply", 8, 0,
           (const char *const[5]){"vertex 0 (from 0): y: found inf", "remove or correct the point",
                                  "scene.json:4:22"});
}

/* Loads a scene whose notes are these; the caller destroys it. */
static BpScene *noted(const char *text, const char *notes) {
    BpScene *scene = NULL;
    BpError err = {0};
    write_text("scene.json", text);
    if (bp_scene_load("scene.json", &scene, &err) != BP_OK) fail_msg("%s", err.message);
    assert_string_equal(scene->notes, notes);
    return scene;
}

static void points_without_a_place_are_left_out(void **state) {
    (void)state;
    static const char *const scene = SCENE("", CLOUD("points.ply"));
    static const char note[] = "points.ply: 1 point without a place left out\n";
    static const float places[3][3] = {{1, 2, 3}, {0, 0, NAN}, {7, 8, 9}};
    char bytes[256];
    const char *header = BINARY("3") "end_header\n";
    const size_t n = strlen(header);
    memcpy(bytes, header, n);
    memcpy(bytes + n, places, sizeof places);
    static const char *const texts[] = {"nan nan nan", "1 ******** 3", "1 2 -nan(ind)", "NaN 2 3"};
    const size_t count = sizeof texts / sizeof *texts;
    for (size_t i = 0; i <= count; i++) {
        if (i == count) {
            write_file("points.ply", bytes, n + sizeof places);
        } else {
            char text[256];
            snprintf(text, sizeof text, ASCII("3") "end_header\n1 2 3\n%s\n7 8 9\n", texts[i]);
            write_text("points.ply", text);
        }
        BpScene *found = noted(scene, note);
        assert_int_equal(found->sphere_count, 2);
        for (int c = 0; c < 3; c++) {
            assert_true(found->spheres[0].center[c] == (double)places[0][c]);
            assert_true(found->spheres[1].center[c] == (double)places[2][c]);
        }
        bp_scene_destroy(&found);
    }
}

static void marks_and_encodings(void **state) {
    (void)state;
    static const char *const scene = SCENE("", CLOUD("points.ply"));
    write_text("points.ply", "\xef\xbb\xbf" ASCII("1") "end_header\n1 2 3\n");
    accept(scene, 1);
    write_file("points.ply", "\xff\xfep\0l\0y\0\n\0", 10);
    refuse(scene, "points.ply", 0, 0, (const char *const[5]){"UTF-16", "iconv -f UTF-16 -t UTF-8"});
    write_file("points.ply", "\x1f\x8b\x08\0\0\0\0\0\0\xff\x03\0\0\0\0\0\0\0\0\0", 20);
    refuse(scene, "points.ply", 0, 0, (const char *const[5]){"gzip", "unpack it"});
}

static void what_follows_the_last_element(void **state) {
    (void)state;
    static const char *const scene = SCENE("", CLOUD("points.ply"));
    write_text("points.ply", ASCII("1") "end_header\n1 2 3\n\n 4 5 6\n7 8 9\n");
    refuse(scene, "points.ply", 10, 0,
           (const char *const[5]){"another line after the last element", "counts"});
    write_text("points.ply", ASCII("1") "end_header\n1 2 3\n \t\r\n\n");
    accept(scene, 1);
    write_text("points.ply", ASCII("1") "element face 2\nproperty list uchar int vertex_index\nend_header\n"
                                        "1 2 3\n3 0 0 0\n4 0 0 0 0\n");
    accept(scene, 1);

    char bytes[256];
    const char *header = BINARY("2") "element face 1\nproperty list uchar uchar vertex_index\nend_header\n";
    const size_t n = strlen(header);
    memcpy(bytes, header, n);
    memset(bytes + n, 0, sizeof bytes - n);
    bytes[n + 3] = 0x41; /* x of vertex 0 is 8: the two lie apart */
    bytes[n + 24] = 2;   /* the face has two vertices */
    write_file("points.ply", bytes, n + 27);
    accept(scene, 2);
    write_file("points.ply", bytes, n + 30);
    char at[96];
    snprintf(at, sizeof at, "3 bytes after the last element, from byte %zu on", n + 27);
    refuse(scene, "points.ply", 0, 0, (const char *const[5]){at, "counts in its header", "scene.json:4:22"});
    write_file("points.ply", bytes, n + 26);
    refuse(scene, "points.ply", 0, 0, (const char *const[5]){"truncated", "scene.json:4:22"});
}

static const char *held_points(size_t index, const char **name, size_t *size) {
    static const char *const files[][2] = {{"none.ply", "no points"},
                                           {"held.ply", ASCII("2") "end_header\n1 2 3\n4 5 6\n"}};
    if (index >= sizeof files / sizeof *files) return NULL;
    *name = files[index][0];
    *size = strlen(files[index][1]);
    return files[index][1];
}

/* Of files that a program holds, the one of that name is read, and no file on the disk. */
static void held_files_are_read(void **state) {
    (void)state;
    const BpSceneChanges changes = {.held = held_points};
    const char *const good = SCENE("", CLOUD("held.ply")), *const bad = SCENE("", CLOUD("more.ply"));
    BpScene *scene = NULL;
    BpError err = {0};
    if (bp_scene_parse_changed(good, strlen(good), "scene.json", &changes, &scene, &err) != BP_OK)
        fail_msg("%s", err.message);
    assert_int_equal(scene->sphere_count, 2);
    assert_true(scene->spheres[1].center[2] == 6);
    bp_scene_destroy(&scene);
    write_text("more.ply", ASCII("1") "end_header\n1 2 3\n");
    accept(bad, 1);
    assert_int_equal(bp_scene_parse_changed(bad, strlen(bad), "scene.json", &changes, &scene, &err),
                     BP_ERR_SCENE);
    assert_non_null(strstr(err.message, "\"more.ply\": it is not among the files of this program"));
    bp_error_clear(&err);
}

int main(void) {
    char folder[] = "/tmp/ballpark-clouds-XXXXXX";
    if (mkdtemp(folder) == NULL || chdir(folder) != 0) return 1;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(coincident_vertices_are_named),       cmocka_unit_test(an_infinite_place_is_named),
        cmocka_unit_test(points_without_a_place_are_left_out), cmocka_unit_test(marks_and_encodings),
        cmocka_unit_test(what_follows_the_last_element),       cmocka_unit_test(held_files_are_read)};
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    static const char *const files[] = {"scene.json", "points.ply", "twice.ply", "more.ply"};
    for (size_t i = 0; i < sizeof files / sizeof *files; ++i) unlink(files[i]);
    if (chdir("/") == 0) rmdir(folder);
    return failed;
}
