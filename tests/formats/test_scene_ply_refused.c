/* test_scene_ply_refused.c: bad PLY files, refused with their line or vertex. */
#include "ply_data.h"

#define XYZ "property float x\nproperty float y\nproperty float z\n"
#define HEAD "ply\nformat ascii 1.0\n"

static void refused(void **state) {
    (void)state;
    static const struct {
        const char *text;
        int line;
        const char *says[3];
    } cases[] = {
        {"", 1, {"end of the file"}},
        {"plie\n", 1, {"no PLY file"}},
        {"ply\nformat ascii 2.0\n", 2, {"format"}},
        {"ply\nformat binary 1.0\n", 2, {"binary_little_endian"}},
        {"ply\nelement vertex 1\n" XYZ "end_header\n", 6, {"found no format"}},
        {HEAD "element vertex\n", 3, {"element NAME COUNT"}},
        {HEAD "element vertex -1\n", 3, {"element NAME COUNT"}},
        {HEAD "element vertex 1x\n", 3, {"element NAME COUNT"}},
        {HEAD "element vertex 99999999999999999999\n", 3, {"element NAME COUNT"}},
        {HEAD "element vertex 1\nelement vertex 1\n", 4, {"second time"}},
        {HEAD "property float x\n", 3, {"before any element"}},
        {HEAD "element vertex 1\nproperty flaot x\n", 4, {"\"flaot\"", "did you mean float?"}},
        {HEAD "element vertex 1\nproperty float\n", 4, {"another form"}},
        {HEAD "element vertex 1\nproperty list float int x\n", 4, {"fraction"}},
        {HEAD "element vertex 1\nproperty list int int x\nend_header\n", 4, {"x: found a list"}},
        {HEAD "element vertex 1\nproperty float x\nproperty float x\nend_header\n",
         5,
         {"x: found a second time"}},
        {HEAD "element vertex 1\n" XYZ
              "property ushort red\nproperty uchar green\nproperty uchar blue\nend_header\n",
         10,
         {"of different types"}},
        {HEAD "element vertex 1\nproperty float material\n" XYZ "end_header\n", 4, {"material", "integer"}},
        {HEAD "element vertex 1\nproperty float x\nproperty float y\nend_header\n", 6, {"no property z"}},
        {HEAD "element point 1\n" XYZ "end_header\n", 7, {"no element vertex"}},
        {HEAD "element vertex 1\n" XYZ "property uchar red\nend_header\n", 8, {"all three"}},
        {HEAD "vertex 1\n", 3, {"found \"vertex\""}},
        {HEAD "element vertex 1\n" XYZ, 7, {"end of the file"}},
        {HEAD "element vertex 2\n" XYZ "end_header\n1 2 3\n1 2    \n", 9, {"vertex 1", "expected a number"}},
        {HEAD "element vertex 2\n" XYZ "end_header\n1 2 3\n1 2 3 4\n",
         9,
         {"vertex 1", "more than 3 numbers"}},
        {HEAD "element vertex 2\n" XYZ "end_header\n1 2 3\n1 nine 3\n", 9, {"vertex 1", "nine"}},
        {HEAD "element vertex 2\n" XYZ "end_header\n1 2 3\n1 inf 3\n", 9, {"vertex 1", "inf"}},
        {HEAD "element vertex 2\n" XYZ "end_header\n1 2 3\n1 2 3e12\n", 9, {"vertex 1", "center", "1e12"}},
        {HEAD "element vertex 2\n" XYZ "end_header\n1 2 3\n1 a 3\n", 9, {"vertex 1", "found \"a 3\""}},
        {HEAD "element vertex 2\n" XYZ "end_header\n1 2 3\n", 0, {"truncated", "2"}},
        {HEAD "element vertex 1000000000\n" XYZ "end_header\n1 2 3\n", 0, {"truncated", "1000000000"}},
        {HEAD "element vertex 1\n" XYZ "property float radius\nend_header\n1 2 3 0\n",
         9,
         {"vertex 0", "radius", "found 0"}},
        {HEAD "element vertex 1\n" XYZ
              "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n"
              "1 2 3 1 256 3\n",
         11,
         {"green: found 256", "0 to 255"}},
        {HEAD "element vertex 1\n" XYZ
              "property float red\nproperty float green\nproperty float blue\nend_header\n"
              "1 2 3 1 1 1.5\n",
         11,
         {"blue: found 1.5", "0 to 1"}},
        {HEAD "element vertex 1\n" XYZ "property list char int many\nend_header\n1 2 3 -1\n",
         9,
         {"row 0", "found -1 as the length of a list"}},
        {HEAD "element vertex 2\n" XYZ "property list char int many\nend_header\n1 2 3 0\n1 2 3 nan\n",
         10,
         {"row 1", "found nan"}},
        {HEAD "element vertex 1\n" XYZ "property list char int many\nend_header\n1 2 3 1.5 7 8\n",
         9,
         {"found 1.5", "a whole number"}},
        {HEAD "element vertex 1\n" XYZ "property list char int many\nend_header\n1 2 3 inf 7 8\n",
         9,
         {"vertex 0", "expected a number"}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        BpScene *scene = empty_scene();
        BpError err = {0};
        const BpStatus status = read_bytes(cases[i].text, strlen(cases[i].text), &all_matte, scene, &err);
        if (status != BP_ERR_SCENE || err.line != cases[i].line)
            fail_msg("expected line %d, found %d \"%s\" for\n%s", cases[i].line, err.line, err.message,
                     cases[i].text);
        assert_string_equal(err.file, "points.ply");
        for (int k = 0; k < 3 && cases[i].says[k] != NULL; k++) {
            if (strstr(err.message, cases[i].says[k]) == NULL)
                fail_msg("expected \"%s\" in \"%s\"", cases[i].says[k], err.message);
        }
        assert_int_equal(scene->sphere_count, 0);
        bp_scene_destroy(&scene);
        bp_error_clear(&err);
    }
}

static void refused_by_options(void **state) {
    (void)state;
    static const char text[] = HEAD "element vertex 1\n" XYZ "property int material\nend_header\n1 2 3 2\n";
    static const struct {
        BpPlyOptions options;
        const char *says;
    } cases[] = {
        {{.radius = 0, .material = 0}, "no property radius"},
        {{.radius = 1, .material = BP_PLY_NO_MATERIAL}, "no property material"},
        {{.radius = 1, .material = 0, .materials = two_materials, .material_count = 2}, "material: found 2"}};
    for (size_t i = 0; i < 3; i++) {
        BpScene *scene = empty_scene();
        BpError err = {0};
        assert_int_equal(read_bytes(text, strlen(text), &cases[i].options, scene, &err), BP_ERR_SCENE);
        if (strstr(err.message, cases[i].says) == NULL) fail_msg("\"%s\"", err.message);
        bp_scene_destroy(&scene);
        bp_error_clear(&err);
    }
    /* Without a list of materials the property is passed over. */
    BpScene *scene = accept_text(text, &all_matte);
    assert_int_equal(scene->spheres[0].material, 0);
    bp_scene_destroy(&scene);
}

static void refuse_bytes(const char *bytes, size_t size, int line, const char *says) {
    BpScene *scene = empty_scene();
    BpError err = {0};
    assert_int_equal(read_bytes(bytes, size, &all_matte, scene, &err), BP_ERR_SCENE);
    if (err.line != line || strstr(err.message, says) == NULL)
        fail_msg("line %d: \"%s\", expected \"%s\" in line %d", err.line, err.message, says, line);
    bp_scene_destroy(&scene);
    bp_error_clear(&err);
}

static void bytes_of_value_zero(void **state) {
    (void)state;
    static const char header[] =
        "ply\0 hidden\nformat ascii 1.0\nelement vertex 1\n" XYZ "end_header\n1 2 3\n";
    static const char comment[] =
        "ply\nformat ascii 1.0\ncomment a\0b\nelement vertex 1\n" XYZ "end_header\n1 2 3\n";
    static const char row[] = "ply\nformat ascii 1.0\nelement vertex 1\n" XYZ "end_header\n1 2 3\0 4 5\n";
    static const char end[] = "ply\nformat ascii 1.0\nelement vertex 1\n" XYZ "end_header\n1 2 3\n\0 4\n";
    refuse_bytes(header, sizeof header - 1, 1, "a byte of value 0");
    refuse_bytes(comment, sizeof comment - 1, 3, "a byte of value 0");
    refuse_bytes(row, sizeof row - 1, 8, "a byte of value 0");
    refuse_bytes(end, sizeof end - 1, 9, "a byte of value 0");
}

static void binary_list_of_negative_length(void **state) {
    (void)state;
    char bytes[512];
    size_t n = (size_t)snprintf(bytes, sizeof bytes,
                                "ply\nformat binary_little_endian 1.0\nelement vertex 1\n" XYZ
                                "property list char int many\nend_header\n");
    memset(bytes + n, 0, 12);
    bytes[n + 12] = (char)-1;
    refuse_bytes(bytes, n + 13, 0, "found -1 as the length of a list");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(refused),
        cmocka_unit_test(refused_by_options),
        cmocka_unit_test(bytes_of_value_zero),
        cmocka_unit_test(binary_list_of_negative_length),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
