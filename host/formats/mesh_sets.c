/* mesh_sets.c: see mesh_sets.h. */
#include "mesh_sets.h"

#include "mesh_triangles.h"
#include "named_file.h"
#include "rows.h"
#include "scene_medium.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char *name_of(const BpMeshSet *set) {
    return set->name != NULL ? set->name : "the mesh";
}

static BpStatus check_set(const BpMeshSet *set, BpError *err) {
    const bool whole = set->vertex_count == 0 || bp_rows_are_numbers(&set->vertex),
               cut = set->triangle_count == 0 || set->triangle != NULL;
    const bool normals = set->normal.data == NULL || bp_rows_are_numbers(&set->normal),
               uv = set->uv.data == NULL || bp_rows_are_numbers(&set->uv);
    if (!whole || !cut || !normals || !uv || (set->color.data != NULL && !bp_rows_are_numbers(&set->color)))
        return bp_fail(err, BP_ERR_USAGE, "%s: found no numbers for %s, expected some", name_of(set),
                       !whole     ? "vertices"
                       : !cut     ? "triangles"
                       : !normals ? "normals"
                       : !uv      ? "texture coordinates"
                                  : "colours");
    if (set->vertex_count > BP_MESH_COUNT_MAX || set->triangle_count > BP_MESH_COUNT_MAX)
        return bp_fail(err, BP_ERR_SCENE, "%s: found more than %u vertices or triangles, expected fewer",
                       name_of(set), BP_MESH_COUNT_MAX);
    return BP_OK;
}

static BpStatus make_room(const BpMeshSet *set, BpMesh *mesh, BpError *err) {
    mesh->positions = malloc((set->vertex_count + 1) * sizeof *mesh->positions);
    mesh->faces = malloc((set->triangle_count + 1) * sizeof *mesh->faces);
    if (set->color.data != NULL)
        mesh->face_colors = malloc((set->triangle_count + 1) * sizeof *mesh->face_colors);
    if (set->normal.data != NULL)
        mesh->face_normals = malloc((set->triangle_count + 1) * sizeof *mesh->face_normals);
    if (set->uv.data != NULL)
        mesh->face_coordinates = malloc((set->triangle_count + 1) * sizeof *mesh->face_coordinates);
    if (mesh->positions != NULL && mesh->faces != NULL &&
        (set->uv.data == NULL || mesh->face_coordinates != NULL) &&
        (set->color.data == NULL || mesh->face_colors != NULL) &&
        (set->normal.data == NULL || mesh->face_normals != NULL))
        return BP_OK;
    return bp_fail(err, BP_ERR_MEMORY, "out of memory for %zu triangles", set->triangle_count);
}

static BpStatus read_vertices(const BpMeshSet *set, BpMesh *mesh, BpError *err) {
    for (size_t v = 0; v < set->vertex_count; v++, mesh->vertex_count++)
        for (int a = 0; a < 3; a++) {
            const double place = bp_rows_number(&set->vertex, v, a);
            if (!(fabs(place) <= BP_VERTEX_MAX))
                return bp_fail(err, BP_ERR_SCENE,
                               "vertex %zu (from 0) of %s: found %g, expected coordinates from -1e9 to 1e9",
                               v, name_of(set), place);
            mesh->positions[v][a] = place;
        }
    return BP_OK;
}

static BpStatus read_normal(const BpMeshSet *set, size_t vertex, float normal[3], BpError *err) {
    for (int a = 0; a < 3; a++) {
        const double part = bp_rows_number(&set->normal, vertex, a);
        if (!(fabs(part) <= BP_VERTEX_MAX))
            return bp_fail(err, BP_ERR_SCENE,
                           "vertex %zu (from 0) of %s: normal: found %g, expected numbers from -1e9 to 1e9",
                           vertex, name_of(set), part);
        normal[a] = (float)part;
    }
    return BP_OK;
}

static BpStatus read_coordinates(const BpMeshSet *set, size_t t, float coordinates[6], BpError *err) {
    const bool of_corners = set->uv_of_corners != 0;
    for (size_t k = 0; k < 3; k++)
        for (int a = 0; a < 2; a++) {
            const size_t row = of_corners ? 3 * t + k : set->triangle[3 * t + k];
            const double value = bp_rows_number(&set->uv, row, a);
            if (!(fabs(value) <= BP_UV_MAX))
                return bp_fail(err, BP_ERR_SCENE,
                               "%s %zu (from 0) of %s: texture coordinates: found %g, expected numbers from "
                               "-1e6 to 1e6",
                               of_corners ? "triangle" : "vertex", of_corners ? t : row, name_of(set), value);
            coordinates[2 * k + (size_t)a] = (float)value;
        }
    return BP_OK;
}

static BpStatus read_triangle(const BpMeshSet *set, size_t t, BpMesh *mesh, BpError *err) {
    const uint32_t *const corners = &set->triangle[3 * t];
    for (int k = 0; k < 3; k++)
        if (corners[k] >= set->vertex_count)
            return bp_fail(
                err, BP_ERR_SCENE,
                "triangle %zu (from 0) of %s: found vertex %u, expected one of %zu, counted from 0", t,
                name_of(set), (unsigned)corners[k], set->vertex_count);
    /* One without area would be left out later, but its edges are not those of a closed mesh. */
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) {
        mesh->dropped_degenerate++;
        return BP_OK;
    }
    if (mesh->face_colors != NULL)
        BP_TRY(bp_rows_color(&set->color, t, "triangle", name_of(set), mesh->face_colors[mesh->face_count],
                             err));
    for (int k = 0; k < 3 && mesh->face_normals != NULL; k++)
        BP_TRY(read_normal(set, corners[k], mesh->face_normals[mesh->face_count][k], err));
    if (mesh->face_coordinates != NULL)
        BP_TRY(read_coordinates(set, t, mesh->face_coordinates[mesh->face_count], err));
    memcpy(mesh->faces[mesh->face_count++], corners, sizeof *mesh->faces);
    return BP_OK;
}

static BpStatus read_set(const BpMeshSet *set, BpMesh *mesh, BpError *err) {
    BP_TRY(check_set(set, err));
    BP_TRY(make_room(set, mesh, err));
    BP_TRY(read_vertices(set, mesh, err));
    for (size_t t = 0; t < set->triangle_count; t++) BP_TRY(read_triangle(set, t, mesh, err));
    return BP_OK;
}

static BpStatus add_set(const BpMeshSet *set, const BpMaterialIndex *index, BpScene *scene, BpError *err) {
    BpMesh mesh = {0};
    BpMeshUse use = {.name = name_of(set),
                     .smooth = set->normal.data != NULL || set->smooth != 0,
                     .placement = bp_placement((const double[3]){1, 1, 1}, (const double[3]){0, 0, 0},
                                               (const double[3]){0, 0, 0})};
    const size_t first = scene->triangle_count;
    BpStatus status = bp_material_of_set(index, set->material, use.name, scene, &use.material, err);
    if (status == BP_OK) status = bp_medium_of_set(set->interior, use.name, scene, &use.interior, err);
    if (status == BP_OK) status = read_set(set, &mesh, err);
    if (status == BP_OK) status = bp_mesh_add_triangles(&mesh, &use, scene, err);
    bp_mesh_clear(&mesh);
    if (status == BP_OK) status = bp_keep_mesh_file(use.name, first, NULL, scene, err);
    if (status == BP_OK) scene->mesh_files[scene->mesh_file_count - 1].in_memory = true;
    return status;
}

BpStatus bp_add_mesh_sets(const BpMaterialIndex *index, const BpShapeSets *shapes, BpScene *scene,
                          BpError *err) {
    for (size_t s = 0; s < shapes->mesh_set_count; s++)
        BP_TRY(add_set(&shapes->meshes[s], index, scene, err));
    return BP_OK;
}
