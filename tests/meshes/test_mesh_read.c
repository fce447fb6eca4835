/* test_mesh_read.c: small files of meshes, value by value; what known bugs of readers (tests/mutants) would
 * change. Whole files, and those that are refused, are in test_mesh_files.py. */
#include "meshes/mesh.h"
#include "support/unit_test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static char folder[] = "/tmp/ballpark-mesh-XXXXXX";

static void write_file(const char *name, const void *bytes, size_t size, char path[128]) {
    snprintf(path, 128, "%s/%s", folder, name);
    FILE *const file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

static BpMesh read_bytes(const char *name, const void *bytes, size_t size) {
    char path[128];
    BpMesh mesh;
    BpError err = {0};
    write_file(name, bytes, size, path);
    if (bp_mesh_read(path, &mesh, &err) != BP_OK) fail_msg("%s: %s", name, err.message);
    unlink(path);
    return mesh;
}

static BpMesh read_text(const char *name, const char *text) {
    return read_bytes(name, text, strlen(text));
}

static void check_face(const BpMesh *mesh, size_t face, uint32_t a, uint32_t b, uint32_t c) {
    assert_true(face < mesh->face_count);
    assert_int_equal(mesh->faces[face][0], a);
    assert_int_equal(mesh->faces[face][1], b);
    assert_int_equal(mesh->faces[face][2], c);
}

static void check_place(const BpMesh *mesh, size_t vertex, double x, double y, double z) {
    assert_true(vertex < mesh->vertex_count);
    assert_true(mesh->positions[vertex][0] == x && mesh->positions[vertex][1] == y &&
                mesh->positions[vertex][2] == z);
}

static void check_color(const float color[3], double r, double g, double b) {
    assert_true(fabs(color[0] - r) < 1e-6 && fabs(color[1] - g) < 1e-6 && fabs(color[2] - b) < 1e-6);
}

/* Bytes that are put together, in either order. */
typedef struct Bytes {
    unsigned char data[4096];
    size_t size;
    bool is_big;
} Bytes;

static void put_text(Bytes *bytes, const char *text) {
    memcpy(bytes->data + bytes->size, text, strlen(text));
    bytes->size += strlen(text);
}

static void put_whole(Bytes *bytes, uint64_t value, size_t size) {
    for (size_t i = 0; i < size; i++)
        bytes->data[bytes->size + i] = (unsigned char)(value >> 8 * (bytes->is_big ? size - 1 - i : i));
    bytes->size += size;
}

static void put_float(Bytes *bytes, float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    put_whole(bytes, bits, sizeof bits);
}

static void obj_numbers(void **unused) {
    (void)unused;
    BpMesh mesh = read_text("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3/1/2 -2/2/1 -1/1/1\nv 0 0 5\nv 1 0 5\nf "
                                     "1//9 -4 \\\n5\nf 1 2 6\nv 3 3 3\n");
    assert_int_equal(mesh.face_count, 3);
    check_face(&mesh, 0, 0, 1, 2);
    check_face(&mesh, 1, 0, 1, 4);
    check_face(&mesh, 2, 0, 1, 5);
    check_place(&mesh, 4, 1, 0, 5);
    bp_mesh_clear(&mesh);
}

static void obj_materials(void **unused) {
    (void)unused;
    static const char library[] =
        "newmtl b b\nKd 0.5 0.25 1\nKe 2\nTr 0.25\nnewmtl a\nNi 1.5\nd 0.125\nTr 0.5\n";
    char path[128];
    write_file("m.mtl", library, sizeof library - 1, path);
    BpMesh mesh = read_text("a.obj", "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nusemtl a\nf "
                                     "2 3 4\nusemtl b b\nf 1 2 4\nf 1 3 4\n");
    unlink(path);
    assert_int_equal(mesh.material_count, 2);
    const BpMeshMaterial *const b = &mesh.materials[0], *const a = &mesh.materials[1];
    assert_string_equal(b->name, "b b");
    assert_string_equal(a->name, "a");
    assert_true(b->has_kd && b->kd[0] == 0.5 && b->kd[1] == 0.25 && b->kd[2] == 1);
    assert_true(b->has_ke && b->ke[0] == 2 && b->ke[1] == 2 && b->ke[2] == 2);
    assert_true(b->has_d && b->d == 0.75 && !b->has_ni);
    assert_true(a->has_ni && a->ni == 1.5 && a->has_d && a->d == 0.125 && !a->has_kd && !a->has_ke);
    assert_int_equal(mesh.face_material[0], BP_MESH_NO_MATERIAL);
    assert_int_equal(mesh.face_material[1], 1);
    assert_int_equal(mesh.face_material[2], 0);
    assert_int_equal(mesh.face_material[3], 0);
    assert_int_equal(a->face_count, 1);
    assert_int_equal(b->face_count, 2);
    bp_mesh_clear(&mesh);
}

static void ply_lists(void **unused) {
    (void)unused;
    for (int is_big = 0; is_big < 2; is_big++) {
        Bytes file = {.is_big = is_big == 1};
        put_text(&file, "ply\nformat binary_");
        put_text(&file, file.is_big ? "big" : "little");
        put_text(&file,
                 "_endian 1.0\nelement vertex 4\nproperty float x\nproperty list uchar int more\nproperty "
                 "float y\n"
                 "property float z\nelement face 2\nproperty uchar red\nproperty uchar green\nproperty uchar "
                 "blue\n"
                 "property list ushort double uv\nproperty list uint ushort vertex_index\nend_header\n");
        for (uint32_t i = 0; i < 4; i++) {
            put_float(&file, (float)i);
            put_whole(&file, i, 1);
            for (uint32_t k = 0; k < i; k++) put_whole(&file, 0x01020304, 4);
            put_float(&file, (float)(i * i));
            put_float(&file, -0.5f);
        }
        for (uint32_t face = 0; face < 2; face++) {
            put_whole(&file, face == 0 ? 255 : 0, 1);
            put_whole(&file, 51, 1);
            put_whole(&file, 0, 1);
            put_whole(&file, face, 2);
            for (uint32_t k = 0; k < face; k++) put_whole(&file, 0x3ff0000000000000, 8);
            put_whole(&file, 3, 4);
            for (uint32_t k = 0; k < 3; k++) put_whole(&file, face + k, 2);
        }
        BpMesh mesh = read_bytes("a.ply", file.data, file.size);
        assert_int_equal(mesh.vertex_count, 4);
        assert_int_equal(mesh.face_count, 2);
        for (uint32_t i = 0; i < 4; i++) check_place(&mesh, i, i, i * i, -0.5);
        check_face(&mesh, 0, 0, 1, 2);
        check_face(&mesh, 1, 1, 2, 3);
        const double fifth = pow((0.2 + 0.055) / 1.055, 2.4); /* IEC 61966-2-1 */
        check_color(mesh.face_colors[0], 1, fifth, 0);
        check_color(mesh.face_colors[1], 0, fifth, 0);
        assert_null(mesh.vertex_colors);
        bp_mesh_clear(&mesh);
    }
}

/* Two triangles with an edge in common, at x = 0 and at x = -0; a normal that no vertex has. */
static void stl_welds(void **unused) {
    (void)unused;
    static const float at[2][3][3] = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                                      {{1, 0, 0}, {-0.0f, 0, -0.0f}, {0, 0, 1}}};
    Bytes file = {.size = 0};
    put_text(&file, "solid binary");
    file.size = 80;
    put_whole(&file, 2, 4);
    for (int t = 0; t < 2; t++) {
        for (int i = 0; i < 3; i++) put_float(&file, 9);
        for (int i = 0; i < 9; i++) put_float(&file, at[t][i / 3][i % 3]);
        put_whole(&file, 7, 2);
    }
    BpMesh mesh = read_bytes("a.stl", file.data, file.size);
    assert_int_equal(mesh.vertex_count, 4);
    assert_int_equal(mesh.welded, 2);
    check_face(&mesh, 0, 0, 1, 2);
    check_face(&mesh, 1, 1, 0, 3);
    check_place(&mesh, 3, 0, 0, 1);
    bp_mesh_clear(&mesh);
}

/* A strip, mirrored, stretched, turned by 0.28 and 0.96 and moved, of rows with other numbers between them.
 */
static void gltf(void **unused) {
    (void)unused;
    char text[] = "{'asset': {'version': '2.0'}, 'bufferViews': [{'buffer': 0, 'byteOffset': 0, "
                  "'byteLength': 96, 'byteStride': 24}, {'buffer': 0, 'byteOffset': 96, "
                  "'byteLength': 4}, {'buffer': 0, 'byteOffset': 100, 'byteLength': 16}], "
                  "'accessors': [{'bufferView': 0, 'componentType': 5126, 'count': 4, 'type': 'VEC3'}, "
                  "{'bufferView': 0, 'byteOffset': 12, 'componentType': 5126, 'count': 4, "
                  "'type': 'VEC3'}, {'bufferView': 1, 'componentType': 5121, 'count': 4, "
                  "'type': 'SCALAR'}, {'bufferView': 2, 'componentType': 5121, 'count': 4, "
                  "'type': 'VEC4', 'normalized': true}], 'buffers': [{'byteLength': 116, "
                  "'uri': 'data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAIA/AAAAQAA"
                  "AAAAAAADAAACAPwAAAAAAAIA/AAAAAAAAgD8AAAAAAACAPwAAAAAAAIA/AAAAQAAAgD8AAADAAACAPwAAAAA"
                  "AAIA/AAECAwAz//8AM///ADP//wAz//8='}], 'meshes': [{'primitives': [{'attributes': {'PO"
                  "SITION': 0, 'NORMAL': 1, 'COLOR_0': 3}, 'indices': 2, 'mode': 5, 'material': 0}]}], "
                  "'materials': [{'name': 'a', 'pbrMetallicRoughness': {'baseColorFactor': [0.5, 0.5, "
                  "0.5, 1]}}], 'nodes': [{'children': [1], 'rotation': [0, 0, 0.6, 0.8], "
                  "'translation': [10, 0, 0]}, {'mesh': 0, 'scale': [-1, 1, 2], 'translation': [0, 5, "
                  "0]}], 'scenes': [{'nodes': [0]}]}";
    for (char *at = text; *at != '\0'; at++)
        if (*at == '\'') *at = '"';
    BpMesh mesh = read_text("a.gltf", text);
    assert_int_equal(mesh.vertex_count, 4);
    assert_int_equal(mesh.face_count, 2);
    check_face(&mesh, 0, 0, 2, 1);
    check_face(&mesh, 1, 1, 2, 3);
    static const double places[4][3] = {{5.2, 1.4, 0}, {4.64, -0.52, -4}, {4.24, 1.68, 0}, {3.68, -0.24, -4}};
    static const double normal[3] = {-0.25043961, -0.85865009, 0.44721360};
    for (int v = 0; v < 4; v++) {
        for (int a = 0; a < 3; a++) assert_true(fabs(mesh.positions[v][a] - places[v][a]) < 1e-12);
        check_color(mesh.vertex_colors[v], 0, 0.1, 0.5);
    }
    for (int k = 0; k < 3; k++)
        for (int a = 0; a < 3; a++) assert_true(fabs((double)mesh.face_normals[1][k][a] - normal[a]) < 1e-6);
    assert_int_equal(mesh.material_count, 1);
    assert_string_equal(mesh.materials[0].name, "a");
    assert_true(mesh.materials[0].metallic == 1 && mesh.materials[0].roughness == 1);
    bp_mesh_clear(&mesh);
}

static void check_coordinates(const BpMesh *mesh, size_t face, const double expected[6]) {
    assert_non_null(mesh->face_coordinates);
    for (int k = 0; k < 6; k++) assert_true((double)mesh->face_coordinates[face][k] == expected[k]);
}

/* Of one triangle in each format; of another that lacks some they are missing. */
static void coordinates(void **unused) {
    (void)unused;
    static const char obj[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0.25 0.5\nvt 2 -1\nvt 0\nf 1/1 2/2 3/-1\n"
                              "f 3/1 2/2 1/9\nf 3/2 2/1 1\n";
    BpMesh mesh = read_text("a.obj", obj);
    check_coordinates(&mesh, 0, (const double[6]){0.25, 0.5, 2, -1, 0, 0});
    for (int face = 1; face < 3; face++)
        for (int k = 0; k < 6; k++) assert_true(isnan(mesh.face_coordinates[face][k]));
    bp_mesh_clear(&mesh);
    static const char ply[] = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
                              "property float z\nelement face 1\nproperty list uchar float texcoord\n"
                              "property list uchar int vertex_index\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n"
                              "8 0.25 0.5 2 -1 3 4 5 6 4 0 1 2 3\n";
    mesh = read_text("a.ply", ply);
    check_coordinates(&mesh, 0, (const double[6]){0.25, 0.5, 2, -1, 3, 4});
    check_coordinates(&mesh, 1, (const double[6]){0.25, 0.5, 3, 4, 5, 6});
    bp_mesh_clear(&mesh);
    char gltf_text[] =
        "{'asset': {'version': '2.0'}, 'bufferViews': [{'buffer': 0, 'byteLength': 36}, {'buffer': 0, "
        "'byteOffset': 36, 'byteLength': 24}], 'accessors': [{'bufferView': 0, 'componentType': 5126, "
        "'count': 3, 'type': 'VEC3'}, {'bufferView': 1, 'componentType': 5126, 'count': 3, 'type': 'VEC2'}], "
        "'buffers': [{'byteLength': 60, 'uri': 'data:application/octet-stream;base64,"
        "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAACAPgAAAD8AAABAAACAvwAAAAAAAIA/'}], 'meshes': "
        "[{'primitives': [{'attributes': {'POSITION': 0, 'TEXCOORD_0': 1}}]}], 'nodes': [{'mesh': 0}]}";
    for (char *at = gltf_text; *at != '\0'; at++)
        if (*at == '\'') *at = '"';
    mesh = read_text("a.gltf", gltf_text);
    check_coordinates(&mesh, 0, (const double[6]){0.25, 0.5, 2, 2, 0, 0});
    bp_mesh_clear(&mesh);
}

static void off_colors(void **unused) {
    (void)unused;
    BpMesh mesh = read_text(
        "a.off", "CNOFF 3 2\n0\n0 0 1 1 0 0 1 0.5 0.25 1\n1 0 0 1 0 0 0.5 0 0 1 # x\n0 1 0 1 0 0 0 1 0 1\n"
                 "3 0 1 2 0.5 0 0\n3 2 1 0 0 0 0.5 0.25\n");
    check_place(&mesh, 0, 0, 0, 1);
    check_color(mesh.vertex_colors[0], 1, 0.5, 0.25);
    check_color(mesh.vertex_colors[1], 0.5, 0, 0);
    check_color(mesh.face_colors[0], 0.5, 0, 0);
    check_color(mesh.face_colors[1], 0, 0, 0.5);
    check_face(&mesh, 1, 2, 1, 0);
    bp_mesh_clear(&mesh);
}

static BpMeshEdge edge_of(const char *faces) {
    char text[512];
    BpMeshEdge edge;
    BpError err = {0};
    /* A tetrahedron; vertices 5 to 7 lie where 2 to 4 do. */
    snprintf(text, sizeof text, "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 5 5 5\n%s",
             faces);
    BpMesh mesh = read_text("a.obj", text);
    assert_int_equal(bp_mesh_find_open_edge(&mesh, &edge, &err), BP_OK);
    bp_mesh_clear(&mesh);
    return edge;
}

static void edges(void **unused) {
    (void)unused;
    assert_int_equal(edge_of("f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n").fault, BP_MESH_EDGE_GOOD);
    assert_int_equal(edge_of("f 1 3 2\nf 1 2 4\nf 1 4 3\nf 5 6 7\n").fault, BP_MESH_EDGE_GOOD);
    BpMeshEdge edge = edge_of("f 1 3 2\nf 1 2 4\nf 1 4 3\n");
    assert_int_equal(edge.fault, BP_MESH_EDGE_OPEN);
    assert_true(edge.face == 0 && edge.vertices[0] == 2 && edge.vertices[1] == 1);
    edge = edge_of("f 1 3 2\nf 1 2 4\nf 1 3 4\nf 2 3 4\n");
    assert_int_equal(edge.fault, BP_MESH_EDGE_TURNED);
    assert_true(edge.face == 0 && edge.vertices[0] == 0 && edge.vertices[1] == 2);
    edge = edge_of("f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\nf 3 4 8\n");
    assert_int_equal(edge.fault, BP_MESH_EDGE_SHARED);
    assert_true(edge.face == 2 && edge.vertices[0] == 3 && edge.vertices[1] == 2);
}

static void no_area(void **unused) {
    (void)unused;
    BpMesh mesh = read_text(
        "a.off", "OFF 5 5 0\n0 0 0\n1 1 1\n2 2 2\n0 1 0\n0 1 0\n3 0 1 2\n3 0 1 1\n3 0 1 3\n3 0 3 4\n2 0 1\n");
    assert_int_equal(mesh.face_count, 1);
    assert_int_equal(mesh.dropped_degenerate, 4);
    check_face(&mesh, 0, 0, 1, 3);
    bp_mesh_clear(&mesh);
}

static void strips(void **unused) {
    (void)unused;
    static const char head[] = "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\n"
                               "property float z\nelement tristrips 1\nproperty list int int vertex_indices\n"
                               "end_header\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 1\n";
    char text[512];
    snprintf(text, sizeof text, "%s10 0 1 2 3 4 -1 2 3 3 4\n", head);
    BpMesh mesh = read_text("a.ply", text);
    assert_int_equal(mesh.face_count, 3);
    check_face(&mesh, 0, 0, 1, 2);
    check_face(&mesh, 1, 2, 1, 3);
    check_face(&mesh, 2, 2, 3, 4);
    assert_int_equal(mesh.dropped_degenerate, 0);
    bp_mesh_clear(&mesh);
}

/* A square, and a corner above one of its edges: seen from above, the triangle at that edge has no area. */
static void corners_in_no_plane(void **unused) {
    (void)unused;
    BpMesh mesh = read_text("a.obj", "v -1 0 1\nv 1 0 1\nv 1 0 -1\nv -1 0 -1\nv 0 1 -1\nf 1 2 3 4 5\n");
    assert_int_equal(mesh.face_count, 3);
    assert_int_equal(mesh.dropped_degenerate, 0);
    bp_mesh_clear(&mesh);
    /* It crosses itself, seen along x, and along y it does not. */
    mesh = read_text("a.obj", "v 11.424191 227.11412 46.411819\nv 11.773045 227.911987 46.302418\n"
                              "v 11.707062 227.626556 46.342155\nv 11.41707 226.8853 46.168762\nf 1 2 3 4\n");
    assert_int_equal(mesh.face_count, 2);
    assert_string_equal(mesh.notes, "");
    bp_mesh_clear(&mesh);
}

static void colors_that_are_missing(void **unused) {
    (void)unused;
    const double grey = 0.3139887; /* 152 of 255, in sRGB */
    BpMesh mesh =
        read_text("a.obj", "v 0 0 0\nv 1 0 0 1 0 0\nv 0 1 0 0.5 nan 0\nv 1 1 0\nf 1 2 3\nf 2 3 4\n");
    assert_non_null(mesh.vertex_colors);
    check_color(mesh.vertex_colors[0], grey, grey, grey);
    check_color(mesh.vertex_colors[1], 1, 0, 0);
    check_color(mesh.vertex_colors[2], grey, grey, grey);
    check_color(mesh.vertex_colors[3], grey, grey, grey);
    assert_non_null(strstr(mesh.notes, "3 of 4 vertices"));
    bp_mesh_clear(&mesh);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(obj_numbers),
                                       cmocka_unit_test(obj_materials),
                                       cmocka_unit_test(ply_lists),
                                       cmocka_unit_test(stl_welds),
                                       cmocka_unit_test(gltf),
                                       cmocka_unit_test(coordinates),
                                       cmocka_unit_test(off_colors),
                                       cmocka_unit_test(edges),
                                       cmocka_unit_test(no_area),
                                       cmocka_unit_test(strips),
                                       cmocka_unit_test(corners_in_no_plane),
                                       cmocka_unit_test(colors_that_are_missing)};
    if (mkdtemp(folder) == NULL) return 1;
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    rmdir(folder);
    return failed;
}
