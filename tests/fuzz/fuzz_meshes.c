/* fuzz_meshes.c: any bytes as a file of a mesh, with the ending ENDING, for which it is built: one target for
 * each reader. What follows the first byte of value 0 in a file of text is the MTL file "m".
 *
 * What is accepted is whole: indices that exist, triangles with an area, finite places and colours in range,
 * and its edges can be asked for. */
#include "fuzz.h"
#include "meshes/mesh.h"
#include "meshes/polygon.h"

#include <math.h>
#include <unistd.h>

static char folder[] = "/tmp/ballpark-fuzz-XXXXXX";

static void write_file(const char *path, const uint8_t *data, size_t size) {
    FILE *const file = fopen(path, "wb");
    require(file != NULL && fwrite(data, 1, size, file) == size && fclose(file) == 0);
}

static void check_colors(const float (*colors)[3], size_t count) {
    for (size_t i = 0; colors != NULL && i < count; i++)
        for (int c = 0; c < 3; c++) require(colors[i][c] >= 0 && colors[i][c] <= 1);
}

static void check_materials(const BpMesh *mesh) {
    size_t faces = 0;
    for (size_t i = 0; i < mesh->material_count; i++) {
        const BpMeshMaterial *const m = &mesh->materials[i];
        require(m->name != NULL && m->name[0] != '\0');
        for (int c = 0; c < 3; c++)
            require(isfinite(m->kd[c]) && m->kd[c] >= 0 && isfinite(m->ke[c]) && m->ke[c] >= 0);
        require(!m->has_ni || (isfinite(m->ni) && m->ni > 0));
        require(!m->has_d || (m->d >= 0 && m->d <= 1));
        require(m->image_file == NULL || m->image_inside == 0);
        faces += m->face_count;
    }
    require(faces <= mesh->face_count);
}

static void check_coordinates(const BpMesh *mesh) {
    for (size_t f = 0; f < mesh->face_count && mesh->face_coordinates != NULL; f++)
        for (int k = 0; k < 6; k++) {
            const float number = mesh->face_coordinates[f][k];
            require(isnan(number) == isnan(mesh->face_coordinates[f][0]));
            require(isnan(number) || fabsf(number) <= 1e6f);
        }
}

static void check_mesh(const BpMesh *mesh) {
    check_coordinates(mesh);
    BpMeshEdge edge;
    BpError err = {0};
    require(mesh->face_count > 0);
    for (size_t i = 0; i < mesh->vertex_count; i++)
        for (int a = 0; a < 3; a++) require(fabs(mesh->positions[i][a]) <= BP_MESH_COORDINATE_MAX);
    for (size_t f = 0; f < mesh->face_count; f++) {
        const uint32_t *const face = mesh->faces[f];
        for (int i = 0; i < 3; i++) require(face[i] < mesh->vertex_count);
        require(
            !polygon_is_flat(mesh->positions[face[0]], mesh->positions[face[1]], mesh->positions[face[2]]));
        if (mesh->face_material != NULL)
            require(mesh->face_material[f] < mesh->material_count ||
                    mesh->face_material[f] == BP_MESH_NO_MATERIAL);
    }
    check_colors((const float(*)[3])mesh->vertex_colors, mesh->vertex_count);
    check_colors((const float(*)[3])mesh->face_colors, mesh->face_count);
    check_materials(mesh);
    require(bp_mesh_find_open_edge(mesh, &edge, &err) == BP_OK);
    require(edge.face < mesh->face_count && bp_mesh_edge_fault_text(edge.fault)[0] != '\0');
    if (edge.fault != BP_MESH_EDGE_GOOD)
        require(edge.vertices[0] != edge.vertices[1] && edge.vertices[0] < mesh->vertex_count &&
                edge.vertices[1] < mesh->vertex_count);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    static bool is_ready = false;
    static char path[64], library[64];
    BpMesh mesh;
    BpError err = {0};
    if (!is_ready) {
        require(mkdtemp(folder) != NULL);
        snprintf(path, sizeof path, "%s/x%s", folder, ENDING);
        snprintf(library, sizeof library, "%s/m", folder);
        is_ready = true;
    }
    size_t length = size;
    if (strcmp(ENDING, ".obj") == 0) {
        const uint8_t *const end = size > 0 ? memchr(data, 0, size) : NULL;
        if (end != NULL) length = (size_t)(end - data);
        const size_t skipped = length < size ? length + 1 : length;
        write_file(library, data + skipped, size - skipped);
    }
    write_file(path, data, length);
    const bool is_mesh = bp_mesh_is_file(path);
    const BpStatus status = bp_mesh_read(path, &mesh, &err);
    if (status == BP_OK) {
        require(is_mesh);
        check_mesh(&mesh);
    } else {
        require(err.code == status && err.message[0] != '\0' && mesh.positions == NULL);
    }
    bp_error_clear(&err);
    bp_mesh_clear(&mesh);
    return 0;
}
