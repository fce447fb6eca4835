/* mesh_triangles.c: see mesh_triangles.h. */
#include "mesh_triangles.h"

#include "base/format.h"
#include "base/plural.h"
#include "scene/material.h"
#include "scene/triangle_area.h"
#include "scene/triangle_rules.h"
#include "scene/vertex_normals.h"

#include <stdlib.h>
#include <string.h>

/* Into the scene's materials, or UINT32_MAX. */
static uint32_t material_of(const BpMesh *mesh, const BpMeshUse *use, size_t face) {
    const uint32_t own = mesh->face_material != NULL ? mesh->face_material[face] : BP_MESH_NO_MATERIAL;
    const bool named = own != BP_MESH_NO_MATERIAL && use->materials != NULL;
    return named && use->materials[own] != UINT32_MAX ? use->materials[own] : use->material;
}

static BpStatus check_materials(const BpMesh *mesh, const BpMeshUse *use, BpError *err) {
    for (size_t f = 0; f < mesh->face_count; f++) {
        if (material_of(mesh, use, f) != UINT32_MAX) continue;
        const uint32_t own = mesh->face_material != NULL ? mesh->face_material[f] : BP_MESH_NO_MATERIAL;
        if (own == BP_MESH_NO_MATERIAL)
            return bp_fail(
                err, BP_ERR_SCENE,
                "%s: found triangle %zu (from 0) without a material of its own, expected one, or a "
                "\"material\" for all that have none",
                use->name, f);
        return bp_fail(
            err, BP_ERR_SCENE,
            "%s: found the material \"%.80s\", expected it in \"materials\", or a \"material\" for "
            "all that are not there",
            use->name, mesh->materials[own].name);
    }
    return BP_OK;
}

/* ---- glass is closed ---- */

static BpStatus refuse_edge(const BpMesh *mesh, const BpMeshUse *use, const BpMeshEdge *edge,
                            const char *material, BpError *err) {
    const double *a = mesh->positions[edge->vertices[0]], *b = mesh->positions[edge->vertices[1]];
    return bp_fail(
        err, BP_ERR_SCENE,
        "%s: the material \"%.80s\" lets light in, but the edge from vertex %u to %u (from 0), (%.9g, "
        "%.9g, %.9g) to (%.9g, %.9g, %.9g), is open: %s; expected faces that enclose a body and run "
        "counter-clockwise, seen from outside; close the mesh, MeshLab and pymeshfix can, or give it "
        "another material",
        use->name, material, (unsigned)edge->vertices[0], (unsigned)edge->vertices[1], a[0], a[1], a[2], b[0],
        b[1], b[2], bp_mesh_edge_fault_text(edge->fault));
}

BpStatus bp_mesh_find_part_edge(const BpMesh *mesh, const BpMeshUse *use, uint32_t material, BpMeshEdge *edge,
                                BpError *err) {
    BpMesh part = {.positions = mesh->positions, .vertex_count = mesh->vertex_count};
    part.faces = malloc((mesh->face_count + 1) * sizeof *part.faces);
    if (part.faces == NULL)
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for %zu triangles", mesh->face_count);
    for (size_t f = 0; f < mesh->face_count; f++)
        if (material_of(mesh, use, f) == material)
            memcpy(part.faces[part.face_count++], mesh->faces[f], sizeof *part.faces);
    const BpStatus status = bp_mesh_find_open_edge(&part, edge, err);
    free(part.faces);
    return status;
}

static BpStatus check_glass(const BpMesh *mesh, const BpMeshUse *use, const BpScene *scene, BpError *err) {
    bool *const used = calloc(scene->material_count + 1, sizeof *used);
    if (used == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for a mesh's materials");
    BpStatus status = BP_OK;
    for (size_t f = 0; f < mesh->face_count && status == BP_OK; f++) {
        const uint32_t material = material_of(mesh, use, f);
        if (used[material]) continue;
        used[material] = true;
        if (!bp_material_is(scene->materials[material].kind, BP_HAS_INSIDE)) continue;
        BpMeshEdge edge;
        status = bp_mesh_find_part_edge(mesh, use, material, &edge, err);
        if (status == BP_OK && edge.fault != BP_MESH_EDGE_GOOD)
            status = refuse_edge(mesh, use, &edge, scene->materials[material].name, err);
    }
    free(used);
    return status;
}

/* ---- what fills it ---- */

static bool lets_light_in(const BpScene *scene, uint32_t material) {
    return bp_material_is(scene->materials[material].kind, BP_HAS_INSIDE);
}

static BpStatus check_interior(const BpMesh *mesh, const BpMeshUse *use, const BpScene *scene, BpError *err) {
    bool lets_in = use->interior == 0 || mesh->face_count == 0;
    for (size_t f = 0; f < mesh->face_count && !lets_in; f++)
        lets_in = lets_light_in(scene, material_of(mesh, use, f));
    if (lets_in) return BP_OK;
    return bp_fail(err, BP_ERR_SCENE,
                   "%s: found an interior, but no material of the mesh lets light in, expected one of type "
                   "\"interface\" or \"dielectric\"; change the type, or remove \"interior\"",
                   use->name);
}

/* Of the triangles from `first` on. */
static BpStatus put_interiors(const BpMeshUse *use, size_t first, BpScene *scene, BpError *err) {
    if (use->interior == 0) return BP_OK;
    BP_TRY(bp_make_interiors(scene->triangle_count, &scene->triangle_interiors,
                             &scene->triangle_interior_count, err));
    for (size_t i = first; i < scene->triangle_count; i++)
        if (lets_light_in(scene, scene->triangles[i].material)) scene->triangle_interiors[i] = use->interior;
    return BP_OK;
}

/* ---- triangles ---- */

/* A triangle has one colour: its own, or the mean of its corners'. */
static void put_color(const BpMesh *mesh, size_t face, float albedo[3]) {
    if (mesh->face_colors != NULL) {
        memcpy(albedo, mesh->face_colors[face], sizeof *mesh->face_colors);
        return;
    }
    for (int c = 0; c < 3; c++) {
        double sum = 0;
        for (int k = 0; k < 3; k++) sum += (double)mesh->vertex_colors[mesh->faces[face][k]][c];
        albedo[c] = (float)(sum / 3);
    }
}

static BpStatus make_room(const BpMesh *mesh, const BpMeshUse *use, bool colored, BpScene *scene,
                          BpError *err) {
    if (mesh->face_count > BP_SPHERES_MAX - scene->triangle_count)
        return bp_fail(err, BP_ERR_SCENE, "%s: found %zu triangles more, expected at most %u in a scene",
                       use->name, mesh->face_count, BP_SPHERES_MAX);
    const size_t count = scene->triangle_count + mesh->face_count;
    BpTriangle *const triangles = realloc(scene->triangles, (count + 1) * sizeof *triangles);
    if (triangles == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for %zu triangles", count);
    scene->triangles = triangles;
    if (!colored) return BP_OK;
    float(*const albedos)[3] =
        realloc(scene->albedos, (scene->albedo_count + mesh->face_count + 1) * sizeof *albedos);
    if (albedos == NULL)
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for %zu colours", mesh->face_count);
    scene->albedos = albedos;
    return BP_OK;
}

/* Those of the file where they belong, or those that the faces give. A corner without one has that of its
 * face. */
static BpStatus make_normals(BpMesh *mesh, const BpMeshUse *use, BpScene *scene, BpError *err) {
    if (!use->smooth) return BP_OK;
    BP_TRY(bp_scene_make_normals(scene, scene->triangle_count + mesh->face_count, err));
    if (mesh->face_normals == NULL) {
        mesh->face_normals = calloc(mesh->face_count + 1, sizeof *mesh->face_normals);
        if (mesh->face_normals == NULL)
            return bp_fail(err, BP_ERR_MEMORY, "out of memory for the normals of %zu triangles",
                           mesh->face_count);
        return bp_vertex_normals((const double(*)[3])mesh->positions, mesh->vertex_count,
                                 (const uint32_t(*)[3])mesh->faces, mesh->face_count, mesh->face_normals,
                                 err);
    }
    for (size_t f = 0; f < mesh->face_count; f++)
        for (int k = 0; k < 3; k++) {
            float *const normal = mesh->face_normals[f][k];
            double direction[3] = {(double)normal[0], (double)normal[1], (double)normal[2]};
            bp_place_normal(&use->placement, direction);
            bp_unit_normal(direction, normal);
        }
    return BP_OK;
}

static void put_normals(const BpMesh *mesh, size_t face, bool mirrored, const BpTriangle *triangle,
                        float (*normals)[3]) {
    double area[3];
    bp_triangle_area(triangle, area);
    for (int k = 0; k < 3; k++) {
        const float *const own = mesh->face_normals[face][mirrored && k > 0 ? 3 - k : k];
        memcpy(normals[k], own, sizeof normals[k]);
        if (own[0] == 0 && own[1] == 0 && own[2] == 0) bp_unit_normal(area, normals[k]);
    }
}

/* Where a texture lies on the triangle. */
static void put_coordinates(const BpMesh *mesh, size_t face, bool mirrored, BpScene *scene) {
    float *const at = scene->coordinates[scene->triangle_count];
    if (!bp_material_is_mapped(scene, &scene->materials[scene->triangles[scene->triangle_count].material]))
        return;
    for (int k = 0; k < 3; k++) {
        const float *const own = &mesh->face_coordinates[face][2 * (mirrored && k > 0 ? 3 - k : k)];
        memcpy(&at[2 * k], own, 2 * sizeof *own);
    }
}

/* Whether a texture lies on any of its faces. */
static bool is_mapped(const BpMesh *mesh, const BpMeshUse *use, const BpScene *scene) {
    for (size_t f = 0; f < mesh->face_count && mesh->face_coordinates != NULL; f++)
        if (bp_material_is_mapped(scene, &scene->materials[material_of(mesh, use, f)])) return true;
    return false;
}

/* Returns how many were left out, since they have no area where they stand. */
static size_t add_faces(const BpMesh *mesh, const BpMeshUse *use, bool colored, bool mapped, BpScene *scene,
                        size_t *colors_used) {
    const bool mirrored = bp_placement_mirrors(&use->placement);
    const size_t first = scene->triangle_count;
    for (size_t f = 0; f < mesh->face_count; f++) {
        BpTriangle *const triangle = &scene->triangles[scene->triangle_count];
        for (int k = 0; k < 3; k++)
            memcpy(triangle->vertices[k], mesh->positions[mesh->faces[f][mirrored && k > 0 ? 3 - k : k]],
                   sizeof triangle->vertices[k]);
        if (!bp_triangle_has_area(triangle)) continue;
        triangle->material = material_of(mesh, use, f);
        triangle->albedo = BP_NO_ALBEDO;
        if (colored && bp_material_has(scene->materials[triangle->material].kind, BP_MEMBER_ALBEDO)) {
            put_color(mesh, f, scene->albedos[scene->albedo_count]);
            triangle->albedo = (uint32_t)scene->albedo_count++;
            ++*colors_used;
        }
        if (use->smooth) put_normals(mesh, f, mirrored, triangle, scene->normals[scene->triangle_count]);
        if (mapped) put_coordinates(mesh, f, mirrored, scene);
        scene->triangle_count++;
    }
    return mesh->face_count - (scene->triangle_count - first);
}

static BpStatus add_note(const BpMesh *mesh, const BpMeshUse *use, bool own_normals, bool mapped,
                         size_t left_out, size_t colors_used, BpScene *scene, BpError *err) {
    char text[1024], vertices[32], triangles[32], out[32];
    const size_t added = mesh->face_count - left_out;
    size_t used = (size_t)snprintf(text, sizeof text, "%s vertices, %s triangle%s",
                                   bp_format_whole(mesh->vertex_count, vertices, sizeof vertices),
                                   bp_format_whole(added, triangles, sizeof triangles), bp_plural(added));
    if (left_out > 0)
        used += (size_t)snprintf(text + used, sizeof text - used,
                                 "; %s triangle%s without an area where the mesh stands left out",
                                 bp_format_whole(left_out, out, sizeof out), bp_plural(left_out));
    if (use->smooth)
        used += (size_t)snprintf(text + used, sizeof text - used, "; smooth, by %s",
                                 own_normals ? "its own normals" : "the means of its faces' normals");
    else if (own_normals)
        used += (size_t)snprintf(text + used, sizeof text - used,
                                 "; its normals are left out, \"smooth\": true shows them");
    if (mesh->face_coordinates != NULL && !mapped)
        used += (size_t)snprintf(text + used, sizeof text - used,
                                 "; its texture coordinates are not used, since no texture lies on it");
    if (mesh->face_colors == NULL && mesh->vertex_colors != NULL && colors_used > 0)
        used += (size_t)snprintf(text + used, sizeof text - used,
                                 "; each triangle has the mean of the colours of its vertices");
    if ((mesh->face_colors != NULL || mesh->vertex_colors != NULL) && colors_used < added)
        used += (size_t)snprintf(
            text + used, sizeof text - used,
            "; %s triangle%s without the file's colours, since the material has no albedo",
            bp_format_whole(added - colors_used, out, sizeof out), bp_plural(added - colors_used));
    if (mesh->notes[0] != '\0') snprintf(text + used, sizeof text - used, "; %s", mesh->notes);
    return bp_scene_note(scene, use->name, text, err);
}

BpStatus bp_mesh_add_triangles(BpMesh *mesh, const BpMeshUse *use, BpScene *scene, BpError *err) {
    const bool colored = mesh->face_colors != NULL || mesh->vertex_colors != NULL;
    size_t colors_used = 0;
    BP_TRY(check_materials(mesh, use, err));
    BP_TRY(check_glass(mesh, use, scene, err));
    BP_TRY(check_interior(mesh, use, scene, err));
    BP_TRY(make_room(mesh, use, colored, scene, err));
    for (size_t v = 0; v < mesh->vertex_count; v++) bp_place_point(&use->placement, mesh->positions[v]);
    const bool own = mesh->face_normals != NULL;
    BP_TRY(make_normals(mesh, use, scene, err));
    const bool mapped = is_mapped(mesh, use, scene);
    if (mapped) BP_TRY(bp_scene_make_coordinates(scene, scene->triangle_count + mesh->face_count, err));
    const size_t first = scene->triangle_count;
    const size_t left_out = add_faces(mesh, use, colored, mapped, scene, &colors_used);
    BP_TRY(put_interiors(use, first, scene, err));
    return add_note(mesh, use, own, mapped, left_out, colors_used, scene, err);
}
