/* mesh_summary.c: what is read from files of meshes, as one line of JSON for each; for the tests in Python.
 *
 * mesh_summary [--whole] FILE...     --whole: all vertices, faces, materials and colours
 *
 * A file that is refused gives {"error": the message, "code": its status}. */
#include "meshes/mesh.h"

#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

static void print_text(const char *text) {
    putchar('"');
    for (; *text != '\0'; text++) {
        if (*text == '"' || *text == '\\')
            printf("\\%c", *text);
        else if ((unsigned char)*text < ' ')
            printf("\\u%04x", (unsigned)*text);
        else
            putchar(*text);
    }
    putchar('"');
}

static double area_of(const BpMesh *mesh) {
    double area = 0;
    for (size_t f = 0; f < mesh->face_count; f++) {
        const double *const p = mesh->positions[mesh->faces[f][0]], *const q =
                                                                        mesh->positions[mesh->faces[f][1]];
        const double *const r = mesh->positions[mesh->faces[f][2]];
        double square = 0;
        for (int a = 0; a < 3; a++) {
            const int b = (a + 1) % 3, c = (a + 2) % 3;
            const double n = (q[b] - p[b]) * (r[c] - p[c]) - (q[c] - p[c]) * (r[b] - p[b]);
            square += n * n;
        }
        area += sqrt(square) / 2;
    }
    return area;
}

static void print_colors(const char *name, const float (*colors)[3], size_t count) {
    printf(", \"%s\": [", name);
    for (size_t i = 0; i < count; i++)
        printf("%s[%.9g, %.9g, %.9g]", i > 0 ? ", " : "", (double)colors[i][0], (double)colors[i][1],
               (double)colors[i][2]);
    printf("]");
}

static void print_whole(const BpMesh *mesh) {
    printf(", \"positions\": [");
    for (size_t i = 0; i < mesh->vertex_count; i++)
        printf("%s[%.17g, %.17g, %.17g]", i > 0 ? ", " : "", mesh->positions[i][0], mesh->positions[i][1],
               mesh->positions[i][2]);
    printf("], \"faces\": [");
    for (size_t i = 0; i < mesh->face_count; i++)
        printf("%s[%" PRIu32 ", %" PRIu32 ", %" PRIu32 "]", i > 0 ? ", " : "", mesh->faces[i][0],
               mesh->faces[i][1], mesh->faces[i][2]);
    printf("]");
    if (mesh->face_material != NULL) {
        printf(", \"face_material\": [");
        for (size_t i = 0; i < mesh->face_count; i++)
            printf("%s%" PRId64, i > 0 ? ", " : "",
                   mesh->face_material[i] == BP_MESH_NO_MATERIAL ? -1 : (int64_t)mesh->face_material[i]);
        printf("]");
    }
    if (mesh->vertex_colors != NULL)
        print_colors("vertex_colors", (const float(*)[3])mesh->vertex_colors, mesh->vertex_count);
    if (mesh->face_colors != NULL)
        print_colors("face_colors", (const float(*)[3])mesh->face_colors, mesh->face_count);
    if (mesh->face_normals != NULL)
        print_colors("corner_normals", (const float(*)[3])mesh->face_normals, 3 * mesh->face_count);
    if (mesh->face_coordinates != NULL) printf(", \"uvs\": [");
    for (size_t i = 0; i < 3 * mesh->face_count && mesh->face_coordinates != NULL; i++) {
        const float *const uv = &mesh->face_coordinates[i / 3][2 * (i % 3)];
        printf(isnan(uv[0]) ? "%snull" : "%s[%.9g, %.9g]", i > 0 ? ", " : "", (double)uv[0], (double)uv[1]);
    }
    if (mesh->face_coordinates != NULL) printf("]");
}

static void print_materials(const BpMesh *mesh) {
    printf(", \"materials\": [");
    for (size_t i = 0; i < mesh->material_count; i++) {
        const BpMeshMaterial *const m = &mesh->materials[i];
        printf("%s{\"name\": ", i > 0 ? ", " : "");
        print_text(m->name);
        printf(", \"faces\": %zu", m->face_count);
        if (m->has_kd) printf(", \"kd\": [%.17g, %.17g, %.17g]", m->kd[0], m->kd[1], m->kd[2]);
        if (m->has_ke) printf(", \"ke\": [%.17g, %.17g, %.17g]", m->ke[0], m->ke[1], m->ke[2]);
        if (m->has_ni) printf(", \"ni\": %.17g", m->ni);
        if (m->has_d) printf(", \"d\": %.17g", m->d);
        if (m->has_surface) printf(", \"metallic\": %.17g, \"roughness\": %.17g", m->metallic, m->roughness);
        printf("}");
    }
    printf("]");
}

static int print_file(const char *path, bool whole) {
    BpMesh mesh;
    BpMeshEdge edge;
    BpError err = {0};
    const clock_t start = clock();
    const bool is_file = bp_mesh_is_file(path);
    BpStatus status = bp_mesh_read(path, &mesh, &err);
    const double seconds = (double)(clock() - start) / CLOCKS_PER_SEC;
    if (status == BP_OK) status = bp_mesh_find_open_edge(&mesh, &edge, &err);
    printf("{\"mesh\": %s, ", is_file ? "true" : "false");
    if (status != BP_OK) {
        printf("\"code\": %d, \"line\": %d, \"error\": ", (int)status, err.line);
        print_text(err.message);
    } else {
        printf("\"vertices\": %zu, \"triangles\": %zu, \"area\": %.17g, \"polygons\": %zu, \"dropped\": %zu, "
               "\"welded\": %zu, \"edge\": {\"fault\": %d, \"vertices\": [%" PRIu32 ", %" PRIu32
               "], \"face\": %" PRIu32 "}, \"seconds\": %.4f, \"edge_seconds\": %.4f, \"notes\": ",
               mesh.vertex_count, mesh.face_count, area_of(&mesh), mesh.polygons, mesh.dropped_degenerate,
               mesh.welded, (int)edge.fault, edge.vertices[0], edge.vertices[1], edge.face, seconds,
               (double)(clock() - start) / CLOCKS_PER_SEC - seconds);
        print_text(mesh.notes);
        print_materials(&mesh);
        if (whole) print_whole(&mesh);
        bp_mesh_clear(&mesh);
    }
    printf("}\n");
    bp_error_clear(&err);
    return 0;
}

int main(int argument_count, char **arguments) {
    const bool whole = argument_count > 1 && strcmp(arguments[1], "--whole") == 0;
    for (int i = whole ? 2 : 1; i < argument_count; i++) print_file(arguments[i], whole);
    return 0;
}
