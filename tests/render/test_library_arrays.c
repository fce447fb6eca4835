/* test_library_arrays.c: what ballpark.h promises of spheres from arrays, of pictures in memory, and of how
 * particles look.
 *
 * Only the public header is used, as another program would. */
#include <ballpark.h>

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#define HEAD                                                                                                 \
    "\"camera\": { \"image_width\": 20, \"lookfrom\": [0, 1, 4], \"lookat\": [0, 0, 0], \"vfov\": 40 }, "    \
    "\"materials\": { \"blue\": { \"type\": \"lambertian\", \"albedo\": [0.25, 0.5, 0.75] }, "               \
    "\"glass\": { \"type\": \"dielectric\", \"refraction_index\": 1.5 } }"

static const char listed[] =
    "{ " HEAD ", \"spheres\": [ { \"center\": [0, -100.5, 0], \"radius\": 100, \"material\": \"blue\" },"
    "{ \"center\": [0.5, 0, 0.25], \"radius\": 0.5, \"material\": \"glass\" },"
    "{ \"center\": [-0.5, 0, 0], \"radius\": 0.25, \"material\": \"glass\" } ] }";
static const char ground[] =
    "{ " HEAD ", \"spheres\": [ { \"center\": [0, -100.5, 0], \"radius\": 100, \"material\": \"blue\" } ] }";
static const char empty[] = "{ " HEAD " }";
static const char fitted[] = "{ \"camera\": { \"image_width\": 20, \"fit\": \"particles\" } }";

static const double centers[2][3] = {{0.5, 0, 0.25}, {-0.5, 0, 0}}, radii[2] = {0.5, 0.25};
static BpError err;

static void must(BpStatus status) {
    if (status != BP_OK) fail_msg("%s", err.message);
}

static BpSphereSet make_set(void) {
    return (BpSphereSet){.count = 2,
                         .center = {centers, sizeof centers[0], sizeof(double), BP_NUMBER_DOUBLE},
                         .radius = {radii, sizeof(double), 0, BP_NUMBER_DOUBLE},
                         .material = "glass",
                         .name = "atoms"};
}

static BpScene *parse(const char *document, const BpSphereSet *sets, size_t count) {
    BpScene *scene = NULL;
    must(bp_scene_parse_with_spheres(document, strlen(document), "document", sets, count, &scene, &err));
    return scene;
}

static void draw(const BpScene *scene, BpPicture *picture) {
    BpRender *render = NULL;
    BpRenderOptions options;
    BpProgress progress = {0};
    bp_render_defaults(scene, &options);
    options.samples_per_pixel = 8;
    must(bp_render_create(scene, &options, NULL, 0, &render, &err));
    do must(bp_render_step(render, &progress, &err));
    while (!progress.finished);
    must(bp_render_read(render, picture, &err));
    bp_render_destroy(&render);
}

static void assert_same(BpScene *a, BpScene *b) {
    BpPicture first = {0}, second = {0};
    draw(a, &first);
    draw(b, &second);
    assert_int_equal(first.height, second.height);
    assert_memory_equal(first.rgb, second.rgb, (size_t)first.width * first.height * 3 * sizeof *first.rgb);
    bp_picture_clear(&first);
    bp_picture_clear(&second);
    bp_scene_destroy(&a);
    bp_scene_destroy(&b);
}

/* Doubles in rows, floats with gaps in columns, one radius for all: the same scene as the document's. */
static void test_same_picture_as_listed(void **state) {
    (void)state;
    BpSphereSet set = make_set();
    assert_same(parse(listed, NULL, 0), parse(ground, &set, 1));

    float columns[3][4] = {{0.5f, 9, -0.5f, 9}, {0, 9, 0, 9}, {0.25f, 9, 0, 9}};
    set.center = (BpRows){columns, 2 * sizeof(float), sizeof columns[0], BP_NUMBER_FLOAT};
    assert_same(parse(listed, NULL, 0), parse(ground, &set, 1));

    /* Two sets, the second with the numbers of the first's end. */
    BpSphereSet two[2] = {make_set(), make_set()};
    two[0].count = two[1].count = 1;
    two[1].center.data = &centers[1];
    two[1].radius.data = &radii[1];
    assert_same(parse(listed, NULL, 0), parse(ground, two, 2));
}

static void test_colors(void **state) {
    (void)state;
    static const float red[3] = {0.875f, 0.125f, 0.0625f};
    BpSphereSet set = make_set(), plain = make_set();
    plain.material = "blue";
    set.material = NULL; /* matte; the colour of the one row is that of both spheres */
    set.color = (BpRows){red, 0, sizeof(float), BP_NUMBER_FLOAT};
    BpScene *scene = parse(empty, &set, 1), *other = parse(empty, &plain, 1);
    BpPicture a = {0}, b = {0};
    draw(scene, &a);
    draw(other, &b);
    double ratio[2][2] = {{0}};
    for (size_t p = 0; p < 400; p++)
        for (int c = 0; c < 2; c++) {
            ratio[0][c] += (double)a.rgb[3 * p + 2 * (size_t)c];
            ratio[1][c] += (double)b.rgb[3 * p + 2 * (size_t)c];
        }
    assert_true(ratio[0][0] / ratio[0][1] > 1.1 * ratio[1][0] / ratio[1][1]);
    bp_picture_clear(&a);
    bp_picture_clear(&b);
    bp_scene_destroy(&scene);
    bp_scene_destroy(&other);
    /* Glass has no colour, so one for it changes nothing. */
    set.material = "glass";
    BpSphereSet glass = make_set();
    assert_same(parse(ground, &set, 1), parse(ground, &glass, 1));
}

static void test_fit(void **state) {
    (void)state;
    const BpSphereSet set = make_set();
    BpSphereSet matte = set;
    matte.material = NULL;
    BpScene *scene = parse(fitted, &matte, 1);
    BpCameraInfo camera;
    bp_scene_camera(scene, &camera);
    double distance = 0;
    for (int i = 0; i < 3; i++) distance += pow(camera.lookfrom[i] - camera.lookat[i], 2);
    assert_true(sqrt(distance) > 0.75 && sqrt(distance) < 10);
    assert_true(camera.vfov == 90 && camera.aperture == 0 && camera.focus_dist > 0);
    assert_true(fabs(camera.lookfrom[0] - camera.lookat[0]) > 0.1);
    bp_scene_destroy(&scene);

    /* Spheres in one plane are seen from the front, as files of particles are. */
    static const float plane[4][3] = {{0, 0, 2}, {1, 0, 2}, {0, 1, 2}, {1, 1, 3}};
    matte.center = (BpRows){plane, sizeof plane[0], sizeof(float), BP_NUMBER_FLOAT};
    matte.radius.row_stride = 0;
    for (size_t count = 3; count <= 4; count++) {
        matte.count = count;
        scene = parse(fitted, &matte, 1);
        bp_scene_camera(scene, &camera);
        assert_int_equal(fabs(camera.lookfrom[0] - camera.lookat[0]) < 1e-9, count == 3);
        bp_scene_destroy(&scene);
    }
}

/* Every refusal names the set, the sphere and the remedy. */
static void assert_refused(const char *document, const BpSphereSet *set, BpStatus status, const char *words) {
    BpScene *scene = NULL;
    assert_int_equal(
        bp_scene_parse_with_spheres(document, strlen(document), "document", set, 1, &scene, &err), status);
    assert_null(scene);
    if (strstr(err.message, words) == NULL) fail_msg("\"%s\" lacks \"%s\"", err.message, words);
}

static void test_refused(void **state) {
    (void)state;
    static const double bad[2][3] = {{0.5, 0, 0.25}, {-0.5, NAN, 0}}, zero[2] = {1, 0};
    static const double bright[2][3] = {{0, 0, 1}, {0, 0, 1.5}};
    BpSphereSet set = make_set();
    set.center.data = bad;
    assert_refused(ground, &set, BP_ERR_SCENE, "sphere 1 (from 0) of atoms: center: found");
    set = make_set();
    set.radius.data = zero;
    assert_refused(ground, &set, BP_ERR_SCENE, "sphere 1 (from 0) of atoms: radius: found 0");
    set = make_set();
    set.material = "blue";
    set.color = (BpRows){bright, sizeof bright[0], sizeof(double), BP_NUMBER_DOUBLE};
    assert_refused(ground, &set, BP_ERR_SCENE, "sphere 1 (from 0) of atoms: color: found 1.5");
    set = make_set();
    set.material = "glas";
    assert_refused(ground, &set, BP_ERR_SCENE, "did you mean \"glass\"?");
    assert_refused(fitted, &set, BP_ERR_SCENE, "add it there");
    set = make_set();
    set.radius.data = NULL;
    assert_refused(ground, &set, BP_ERR_USAGE, "atoms: radius: found nothing");
    set = make_set();
    set.center.type = (BpNumberType)7;
    assert_refused(ground, &set, BP_ERR_USAGE, "unknown type");
    set = make_set(); /* two spheres of glass in one place */
    set.center.row_stride = set.radius.row_stride = 0;
    assert_refused(ground, &set, BP_ERR_SCENE, "sphere 1 (from 0) of atoms");
    set.count = SIZE_MAX;
    assert_refused(ground, &set, BP_ERR_SCENE, "expected fewer");
}

static const double corners[4][3] = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
static const uint32_t square[2][3] = {{0, 1, 2}, {0, 2, 3}};

static BpMeshSet make_mesh(void) {
    return (BpMeshSet){.vertex_count = 4,
                       .triangle_count = 2,
                       .vertex = {corners, sizeof corners[0], sizeof(double), BP_NUMBER_DOUBLE},
                       .triangle = &square[0][0],
                       .material = "blue",
                       .name = "square"};
}

static BpStatus parse_mesh(const BpMeshSet *mesh, BpScene **scene) {
    const BpShapeSets shapes = {.meshes = mesh, .mesh_set_count = 1};
    return bp_scene_parse_with_shapes(ground, strlen(ground), "document", &shapes, scene, &err);
}

/* A square is the quad of the document; the columns of another array, and a colour that is the material's,
 * change nothing. */
static void test_mesh(void **state) {
    (void)state;
    static const char quad[] =
        "{ " HEAD
        ", \"spheres\": [ { \"center\": [0, -100.5, 0], \"radius\": 100, \"material\": \"blue\" } ],"
        "\"quads\": [ { \"corner\": [-1, -1, 0], \"u\": [2, 0, 0], \"v\": [0, 2, 0], \"material\": \"blue\" "
        "} ] }";
    static const float columns[3][4] = {{-1, 1, 1, -1}, {-1, -1, 1, 1}, {0, 0, 0, 0}},
                       blue[3] = {0.25f, 0.5f, 0.75f};
    BpScene *scene = NULL;
    BpMeshSet mesh = make_mesh();
    must(parse_mesh(&mesh, &scene));
    assert_same(parse(quad, NULL, 0), scene);
    mesh.vertex = (BpRows){columns, sizeof(float), sizeof columns[0], BP_NUMBER_FLOAT};
    mesh.color = (BpRows){blue, 0, sizeof(float), BP_NUMBER_FLOAT};
    must(parse_mesh(&mesh, &scene));
    BpSceneInfo info;
    bp_scene_info(scene, &info);
    assert_int_equal(info.triangles, 2);
    assert_same(parse(quad, NULL, 0), scene);
}

static void assert_mesh_refused(const BpMeshSet *mesh, BpStatus status, const char *words) {
    BpScene *scene = NULL;
    assert_int_equal(parse_mesh(mesh, &scene), status);
    assert_null(scene);
    if (strstr(err.message, words) == NULL) fail_msg("\"%s\" lacks \"%s\"", err.message, words);
}

static void test_mesh_refused(void **state) {
    (void)state;
    static const uint32_t beyond[2][3] = {{0, 1, 2}, {0, 2, 4}};
    static const double infinite[4][3] = {{-1, -1, 0}, {1, -1, 0}, {1, INFINITY, 0}, {-1, 1, 0}};
    static const float bright[3] = {0, 0, 1.5f};
    BpMeshSet mesh = make_mesh();
    mesh.triangle = &beyond[0][0];
    assert_mesh_refused(&mesh, BP_ERR_SCENE,
                        "triangle 1 (from 0) of square: found vertex 4, expected one of 4");
    mesh = make_mesh();
    mesh.vertex.data = infinite;
    assert_mesh_refused(&mesh, BP_ERR_SCENE, "vertex 2 (from 0) of square: found inf");
    mesh = make_mesh();
    mesh.color = (BpRows){bright, 0, sizeof(float), BP_NUMBER_FLOAT};
    assert_mesh_refused(&mesh, BP_ERR_SCENE, "triangle 0 (from 0) of square: color: found 1.5");
    mesh = make_mesh();
    mesh.material = "glass";
    assert_mesh_refused(&mesh, BP_ERR_SCENE,
                        "square: the material \"glass\" lets light in, but the edge from");
    mesh.material = "glas";
    assert_mesh_refused(&mesh, BP_ERR_SCENE, "did you mean \"glass\"?");
    mesh = make_mesh();
    mesh.triangle = NULL;
    assert_mesh_refused(&mesh, BP_ERR_USAGE, "square: found no numbers for triangles");
    mesh = make_mesh();
    mesh.vertex.type = (BpNumberType)7;
    assert_mesh_refused(&mesh, BP_ERR_USAGE, "square: found no numbers for vertices");
    mesh = make_mesh();
    mesh.triangle_count = SIZE_MAX;
    assert_mesh_refused(&mesh, BP_ERR_SCENE, "expected fewer");
}

/* ---- lines ---- */

static const double joints[3][3] = {{-1, -0.25, 0}, {0, 0.5, 0.25}, {0.75, -0.25, 0}},
                    widths[2] = {0.25, 0.125};
static const uint32_t joined[2][2] = {{0, 1}, {2, 1}};

static BpLineSet make_lines(void) {
    return (BpLineSet){.point_count = 3,
                       .line_count = 2,
                       .point = {joints, sizeof joints[0], sizeof(double), BP_NUMBER_DOUBLE},
                       .line = &joined[0][0],
                       .radius = {widths, sizeof(double), 0, BP_NUMBER_DOUBLE},
                       .material = "blue",
                       .name = "sticks"};
}

static BpStatus parse_lines(const char *document, const BpLineSet *lines, BpScene **scene) {
    const BpShapeSets shapes = {.lines = lines, .line_set_count = 1};
    return bp_scene_parse_with_shapes(document, strlen(document), "document", &shapes, scene, &err);
}

#define STICKS(MEMBERS)                                                                                      \
    "{ " HEAD ", \"spheres\": [ { \"center\": [0, -100.5, 0], \"radius\": 100, \"material\": \"blue\" } ],"  \
    "\"capsules\": [ { \"ends\": [[-1, -0.25, 0], [0, 0.5, 0.25]], \"radius\": 0.25, \"material\": "         \
    "\"blue\"" MEMBERS                                                                                       \
    " }, { \"ends\": [[0.75, -0.25, 0], [0, 0.5, 0.25]], \"radius\": 0.125, \"material\": "                  \
    "\"blue\"" MEMBERS " } ] }"

/* By numbers of points, as pairs of points, from the columns of another array: the capsules of the document.
 */
static void test_lines(void **state) {
    (void)state;
    static const double pairs[4][3] = {{-1, -0.25, 0}, {0, 0.5, 0.25}, {0.75, -0.25, 0}, {0, 0.5, 0.25}};
    static const float columns[3][4] = {
        {-1, 0, 0.75f, 0}, {-0.25f, 0.5f, -0.25f, 0.5f}, {0, 0.25f, 0, 0.25f}};
    static const char sticks[] = STICKS("");
    BpScene *scene = NULL;
    BpLineSet lines = make_lines();
    must(parse_lines(ground, &lines, &scene));
    BpSceneInfo info;
    bp_scene_info(scene, &info);
    assert_int_equal(info.capsules, 2);
    assert_int_equal(info.spheres, 1);
    assert_same(parse(sticks, NULL, 0), scene);
    lines.line = NULL;
    lines.point_count = 4;
    lines.point.data = pairs;
    must(parse_lines(ground, &lines, &scene));
    assert_same(parse(sticks, NULL, 0), scene);
    lines.point = (BpRows){columns, sizeof(float), sizeof columns[0], BP_NUMBER_FLOAT};
    must(parse_lines(ground, &lines, &scene));
    assert_same(parse(sticks, NULL, 0), scene);
}

/* The colours of a document's capsules, of each end its own; glass has none, so one for it changes nothing.
 */
static void test_colors_of_lines(void **state) {
    (void)state;
    static const float first[2][3] = {{0.875f, 0.125f, 0.0625f}, {0.875f, 0.125f, 0.0625f}},
                       second[3] = {0.25f, 0.75f, 0.5f};
    static const char sticks[] = STICKS(", \"colors\": [[0.875, 0.125, 0.0625], [0.25, 0.75, 0.5]]");
    BpScene *scene = NULL, *plain = NULL;
    BpLineSet lines = make_lines();
    lines.color[0] = (BpRows){first, sizeof first[0], sizeof(float), BP_NUMBER_FLOAT};
    lines.color[1] = (BpRows){second, 0, sizeof(float), BP_NUMBER_FLOAT};
    must(parse_lines(ground, &lines, &scene));
    assert_same(parse(sticks, NULL, 0), scene);
    lines.material = "glass";
    must(parse_lines(ground, &lines, &scene));
    lines.color[0].data = lines.color[1].data = NULL;
    must(parse_lines(ground, &lines, &plain));
    assert_same(plain, scene);
}

/* A camera is fitted to all of both ends, with their radii; those in one plane are seen from the front. */
static void test_fit_of_lines(void **state) {
    (void)state;
    static const double balls[4][3] = {{-1, 0, 0}, {3, 0, 0}, {-1, 0, 2}, {3, 0, 2}}, half = 0.5;
    BpLineSet lines = {.point_count = 4,
                       .line_count = 2,
                       .point = {balls, sizeof balls[0], sizeof(double), BP_NUMBER_DOUBLE},
                       .radius = {&half, 0, 0, BP_NUMBER_DOUBLE}};
    const BpSphereSet ends = {
        .count = 4, .center = lines.point, .radius = {&half, 0, 0, BP_NUMBER_DOUBLE}, .name = "balls"};
    BpScene *scene = NULL, *other = parse(fitted, &ends, 1);
    BpCameraInfo camera, expected;
    must(parse_lines(fitted, &lines, &scene));
    bp_scene_camera(scene, &camera);
    bp_scene_camera(other, &expected);
    for (int a = 0; a < 3; a++) {
        assert_true(fabs(camera.lookfrom[a] - expected.lookfrom[a]) < 1e-9);
        assert_true(fabs(camera.lookat[a] - expected.lookat[a]) < 1e-9);
    }
    assert_true(fabs(camera.lookfrom[0] - camera.lookat[0]) > 0.1);
    bp_scene_destroy(&scene);
    bp_scene_destroy(&other);
    lines.line_count = 1;
    lines.point_count = 2;
    must(parse_lines(fitted, &lines, &scene));
    bp_scene_camera(scene, &camera);
    assert_true(fabs(camera.lookfrom[0] - camera.lookat[0]) < 1e-9);
    assert_true(fabs(camera.lookfrom[1] - camera.lookat[1]) < 1e-9);
    bp_scene_destroy(&scene);
}

static void assert_lines_refused(const BpLineSet *lines, BpStatus status, const char *words) {
    BpScene *scene = NULL;
    assert_int_equal(parse_lines(ground, lines, &scene), status);
    assert_null(scene);
    if (strstr(err.message, words) == NULL) fail_msg("\"%s\" lacks \"%s\"", err.message, words);
}

static void test_lines_refused(void **state) {
    (void)state;
    static const uint32_t beyond[2][2] = {{0, 1}, {1, 3}};
    static const double infinite[3][3] = {{-1, -0.25, 0}, {0, 0.5, 0.25}, {0.75, INFINITY, 0}},
                        bad_widths[3][2] = {{0.25, 0}, {0.25, -1}, {0.25, NAN}};
    static const float bright[3] = {0, 0, 1.5f};
    BpLineSet lines = make_lines();
    lines.line = &beyond[0][0];
    assert_lines_refused(&lines, BP_ERR_SCENE, "line 1 (from 0) of sticks: found point 3, expected one of 3");
    lines = make_lines();
    lines.point.data = infinite;
    assert_lines_refused(&lines, BP_ERR_SCENE, "line 1 (from 0) of sticks: ends: found inf");
    for (int i = 0; i < 3; i++) {
        lines = make_lines();
        lines.radius.data = bad_widths[i];
        assert_lines_refused(&lines, BP_ERR_SCENE, "line 1 (from 0) of sticks: radius: found ");
    }
    lines = make_lines();
    lines.color[0] = lines.color[1] = (BpRows){bright, 0, sizeof(float), BP_NUMBER_FLOAT};
    assert_lines_refused(&lines, BP_ERR_SCENE, "line 0 (from 0) of sticks: color: found 1.5");
    lines.color[1].data = NULL;
    assert_lines_refused(&lines, BP_ERR_USAGE, "sticks: found no numbers for the colours of both ends");
    lines = make_lines();
    lines.material = "glas";
    assert_lines_refused(&lines, BP_ERR_SCENE, "sticks: ");
    assert_lines_refused(&lines, BP_ERR_SCENE, "did you mean \"glass\"?");
    lines.material = "glass"; /* two of glass in one place */
    lines.point_count = 1;
    lines.point.row_stride = lines.radius.row_stride = 0;
    static const uint32_t again[2][2] = {{0, 0}, {0, 0}};
    lines.line = &again[0][0];
    assert_lines_refused(&lines, BP_ERR_SCENE,
                         "line 1 (from 0) of sticks: found the surface of line 0 (from 0) of sticks");
    lines = make_lines();
    lines.line = NULL;
    assert_lines_refused(&lines, BP_ERR_USAGE, "sticks: found 3 points for 2 lines, expected two for each");
    lines = make_lines();
    lines.radius.data = NULL;
    assert_lines_refused(&lines, BP_ERR_USAGE, "sticks: found no numbers for radii");
    lines = make_lines();
    lines.point.type = (BpNumberType)7;
    assert_lines_refused(&lines, BP_ERR_USAGE, "sticks: found no numbers for points");
    lines = make_lines();
    lines.line_count = SIZE_MAX;
    assert_lines_refused(&lines, BP_ERR_SCENE, "expected fewer");
}

/* ---- what fills them ---- */

#define FOGGY                                                                                                \
    "{ \"camera\": { \"image_width\": 20, \"lookfrom\": [0, 1, 4], \"lookat\": [0, 0, 0], \"vfov\": 40 }, "  \
    "\"materials\": { \"edge\": { \"type\": \"interface\" }, \"glass\": { \"type\": \"dielectric\", "        \
    "\"refraction_index\": 1.5 } }, \"media\": { \"thin\": { \"scattering\": 0.5 }, "                        \
    "\"thick\": { \"scattering\": [1, 2, 4], \"absorption\": 0.25 } }, "
#define FIRST_SPHERE "\"spheres\": [ { \"center\": [0, -1, 1], \"radius\": 0.25, \"material\": \"glass\" }"
#define FIRST_TRIANGLES "\"boxes\": [ { \"corners\": [[-2, 1, 0], [-1, 2, 1]], \"material\": \"glass\" }"
#define FIRST_CAPSULE                                                                                        \
    "\"capsules\": [ { \"ends\": [[-1, -1, 0], [1, -1, 0]], \"radius\": 0.125, \"material\": \"glass\" }"

/* Spheres, a box and lines from arrays, filled, behind shapes that are not: the picture of the document that
 * lists them. */
static void test_interiors(void **state) {
    (void)state;
    static const char listed_shapes[] = FOGGY FIRST_SPHERE
        ", { \"center\": [0.5, 0, 0.25], \"radius\": 0.5, \"material\": \"edge\", \"interior\": \"thin\" }"
        ", { \"center\": [-0.5, 0, 0], \"radius\": 0.25, \"material\": \"edge\", \"interior\": \"thin\" } "
        "], " FIRST_TRIANGLES ", { \"corners\": [[1, 0, -1], [2, 1, 0]], \"material\": \"edge\", "
        "\"interior\": \"thick\" } ], " FIRST_CAPSULE
        ", { \"ends\": [[-1, -0.25, 0], [0, 0.5, 0.25]], \"radius\": 0.25, \"material\": \"edge\", "
        "\"interior\": \"thick\" }"
        ", { \"ends\": [[0.75, -0.25, 0], [0, 0.5, 0.25]], \"radius\": 0.125, \"material\": \"edge\", "
        "\"interior\": \"thick\" } ] }";
    static const char bare[] = FOGGY FIRST_SPHERE " ], " FIRST_TRIANGLES " ], " FIRST_CAPSULE " ] }";
    static const double box[8][3] = {{1, 0, -1}, {2, 0, -1}, {1, 1, -1}, {2, 1, -1},
                                     {1, 0, 0},  {2, 0, 0},  {1, 1, 0},  {2, 1, 0}};
    static const uint32_t sides[12][3] = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                                          {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
    BpSphereSet spheres = make_set();
    BpMeshSet mesh = {.vertex_count = 8,
                      .triangle_count = 12,
                      .vertex = {box, sizeof box[0], sizeof(double), BP_NUMBER_DOUBLE},
                      .triangle = &sides[0][0],
                      .material = "edge",
                      .interior = "thick"};
    BpLineSet lines = make_lines();
    const BpShapeSets shapes = {.spheres = &spheres,
                                .sphere_set_count = 1,
                                .meshes = &mesh,
                                .mesh_set_count = 1,
                                .lines = &lines,
                                .line_set_count = 1};
    BpScene *scene = NULL;
    spheres.material = lines.material = "edge";
    spheres.interior = "thin";
    lines.interior = "thick";
    must(bp_scene_parse_with_shapes(bare, strlen(bare), "document", &shapes, &scene, &err));
    assert_same(parse(listed_shapes, NULL, 0), scene);
    scene = NULL;
    mesh.interior = "thicc";
    assert_int_equal(bp_scene_parse_with_shapes(bare, strlen(bare), "document", &shapes, &scene, &err),
                     BP_ERR_SCENE);
    assert_null(scene);
    assert_non_null(strstr(err.message, "the mesh: interior: found the medium \"thicc\""));
    assert_non_null(strstr(err.message, "did you mean \"thick\"?"));
}

static void test_picture_in_memory(void **state) {
    (void)state;
    const BpSphereSet set = make_set();
    BpScene *scene = parse(ground, &set, 1);
    BpPicture picture = {0};
    draw(scene, &picture);
    bp_scene_destroy(&scene);
    static const struct {
        BpFormat format;
        const char *name;
    } formats[] = {
        {BP_FORMAT_PNG, "arrays.png"}, {BP_FORMAT_PPM, "arrays.ppm"}, {BP_FORMAT_EXR, "arrays.exr"}};
    char folder[] = "/tmp/ballpark-arrays-XXXXXX", path[64];
    assert_non_null(mkdtemp(folder));
    for (size_t f = 0; f < sizeof formats / sizeof *formats; f++) {
        void *bytes = NULL;
        size_t size = 0;
        must(bp_picture_encode(&picture, formats[f].format, BP_TRANSFER_SRGB, &bytes, &size, &err));
        snprintf(path, sizeof path, "%s/%s", folder, formats[f].name);
        must(bp_picture_write(&picture, path, formats[f].format, BP_TRANSFER_SRGB, &err));
        FILE *file = fopen(path, "rb");
        assert_non_null(file);
        uint8_t *const read = malloc(size + 1);
        assert_int_equal(fread(read, 1, size + 1, file), size);
        assert_memory_equal(read, bytes, size);
        fclose(file);
        unlink(path);
        bp_free(bytes);
        if (formats[f].format == BP_FORMAT_PPM) {
            uint8_t pixels[20 * 20 * 3];
            bp_picture_bytes(&picture, BP_TRANSFER_SRGB, pixels);
            assert_memory_equal(read + size - sizeof pixels, pixels, sizeof pixels);
        }
        free(read);
    }
    rmdir(folder);
    void *bytes = NULL;
    size_t size = 0;
    assert_int_equal(bp_picture_encode(&picture, BP_FORMAT_BPA, BP_TRANSFER_SRGB, &bytes, &size, &err),
                     BP_ERR_USAGE);
    assert_null(bytes);
    bp_picture_clear(&picture);
    bp_error_clear(&err);
}

static void test_looks(void **state) {
    (void)state;
    BpElementInfo info;
    double low[3], high[3];
    assert_true(bp_element_info(6, &info));
    assert_string_equal(info.symbol, "C");
    assert_true(fabs(info.mass - 12.011) < 1e-3 && fabs(info.van_der_waals - 1.7) < 1e-6);
    assert_true(bp_element_info(118, &info) && !bp_element_info(119, &info));
    assert_int_equal(bp_element_of_atom("CA", "CA"), 20);
    assert_int_equal(bp_element_of_atom("CA", "ALA"), 6);
    assert_int_equal(bp_element_of_atom("OW", NULL), 8);
    assert_string_equal(bp_color_map_name(0), "viridis");
    assert_null(bp_color_map_name(99));
    assert_false(bp_color_map("jet", 0, low));
    assert_true(bp_color_map("viridis", 0, low) && bp_color_map("viridis", 1, high));
    assert_true(high[0] > low[0] && high[1] > low[1]);
    bp_type_color(0, low);
    bp_type_color(10, high);
    assert_memory_equal(low, high, sizeof low);
    bp_type_color(1, high);
    assert_memory_not_equal(low, high, sizeof low);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_same_picture_as_listed),
        cmocka_unit_test(test_colors),
        cmocka_unit_test(test_fit),
        cmocka_unit_test(test_refused),
        cmocka_unit_test(test_mesh),
        cmocka_unit_test(test_mesh_refused),
        cmocka_unit_test(test_lines),
        cmocka_unit_test(test_colors_of_lines),
        cmocka_unit_test(test_fit_of_lines),
        cmocka_unit_test(test_lines_refused),
        cmocka_unit_test(test_interiors),
        cmocka_unit_test(test_picture_in_memory),
        cmocka_unit_test(test_looks),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
