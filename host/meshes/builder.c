/* builder.c: see builder.h. */
#include "builder.h"

#include "base/color.h"
#include "base/format.h"
#include "base/message_text.h"
#include "base/plural.h"
#include "polygon.h"

#include <inttypes.h>
#include <limits.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

enum { FIRST_CAPACITY = 64, GREY = 152 /* that of particles, in sRGB */ };
/* Of all polygons together. */
#define CORNERS_MAX ((size_t)4 * BP_MESH_COUNT_MAX)

void mesh_note(BpMesh *mesh, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    bp_notes_add(mesh->notes, sizeof mesh->notes, format, arguments);
    va_end(arguments);
}

void mesh_builder_init(MeshBuilder *builder, Input *input, const char *path, BpMesh *mesh) {
    *builder = (MeshBuilder){.input = input, .path = path, .mesh = mesh};
}

void mesh_builder_clear(MeshBuilder *builder) {
    free(builder->vertex_colors.values);
    free(builder->polygon_colors.values);
    free(builder->placeless);
    free(builder->polygons);
    free(builder->corners);
    free(builder->normals);
    free(builder->coordinates);
    free(builder->normal_choices.of_corners);
    free(builder->coordinate_choices.of_corners);
    names_clear(&builder->names);
    *builder = (MeshBuilder){0};
}

BpStatus mesh_make_room(const Input *input, void **array, size_t *capacity, size_t count, size_t size,
                        const char *of_what, BpError *err) {
    if (count < *capacity) return BP_OK;
    const size_t more = *capacity > 0 ? *capacity + *capacity / 2 : FIRST_CAPACITY;
    void *const grown = realloc(*array, more * size);
    if (grown == NULL) {
        const BpStatus status = bp_fail(err, BP_ERR_MEMORY, "out of memory for %zu %s", more, of_what);
        bp_error_at(err, input->name, 0, 0);
        return status;
    }
    *array = grown;
    *capacity = more;
    return BP_OK;
}

#define MAKE_ROOM(builder, array, capacity, count, of_what, err)                                             \
    mesh_make_room((builder)->input, (void **)&(array), &(capacity), (count), sizeof *(array), (of_what),    \
                   (err))

BpStatus mesh_add_vertex(MeshBuilder *builder, const double position[3], bool with_line, BpError *err) {
    static const double nowhere[3] = {0, 0, 0};
    BpMesh *const mesh = builder->mesh;
    const bool placed = mesh_has_place(position);
    for (int a = 0; a < 3 && placed; a++) {
        if (fabs(position[a]) <= BP_MESH_COORDINATE_MAX) continue;
        char found[BP_NUMBER_TEXT_SIZE];
        return input_fail(builder->input, with_line, err,
                          "vertex %zu (from %" PRIu32
                          "): found %s for %c, expected a number of at most 1e100",
                          mesh->vertex_count + builder->first_index, builder->first_index,
                          bp_number_text(position[a], found), "xyz"[a]);
    }
    if (mesh->vertex_count == BP_MESH_COUNT_MAX)
        return input_fail(builder->input, with_line, err, "found more than %u vertices, expected fewer",
                          BP_MESH_COUNT_MAX);
    BP_TRY(
        MAKE_ROOM(builder, mesh->positions, builder->vertex_capacity, mesh->vertex_count, "vertices", err));
    if (!placed) {
        BP_TRY(MAKE_ROOM(builder, builder->placeless, builder->placeless_capacity, builder->placeless_count,
                         "vertices", err));
        builder->placeless[builder->placeless_count++] = (uint32_t)mesh->vertex_count;
    }
    memcpy(mesh->positions[mesh->vertex_count++], placed ? position : nowhere, sizeof *mesh->positions);
    return BP_OK;
}

static BpStatus put_color(const MeshBuilder *builder, MeshColors *colors, const double color[3],
                          BpError *err) {
    BP_TRY(mesh_make_room(builder->input, (void **)&colors->values, &colors->capacity, colors->count,
                          sizeof *colors->values, "colours", err));
    for (int c = 0; c < 3; c++) colors->values[colors->count][c] = (float)color[c];
    colors->count++;
    if (isnan(color[0])) colors->missing++;
    return BP_OK;
}

/* Says of all up to number `count` that have no colour yet that they have none. */
static BpStatus put_missing(const MeshBuilder *builder, MeshColors *colors, size_t count, BpError *err) {
    static const double none[3] = {NAN, NAN, NAN};
    while (colors->count < count) BP_TRY(put_color(builder, colors, none, err));
    return BP_OK;
}

static BpStatus add_color(MeshBuilder *builder, MeshColors *colors, const double color[3], size_t number,
                          const char *of_what, bool with_line, BpError *err) {
    int channel = 0;
    char found[BP_NUMBER_TEXT_SIZE];
    if (isnan(color[0]) || isnan(color[1]) || isnan(color[2]))
        return put_missing(builder, colors, number + 1, err);
    if (!color_range_take(&colors->range, color, number, with_line ? builder->input->line : 0, &channel))
        return input_fail(builder->input, with_line, err,
                          "%s %zu (from %" PRIu32 "): %s: found %s, expected %s", of_what,
                          number + builder->first_index, builder->first_index, bp_color_channels[channel],
                          bp_number_text(color[channel], found), color_range_expected(&colors->range));
    BP_TRY(put_missing(builder, colors, number, err));
    return put_color(builder, colors, color, err);
}

BpStatus mesh_color_vertex(MeshBuilder *builder, const double color[3], bool with_line, BpError *err) {
    return add_color(builder, &builder->vertex_colors, color, builder->mesh->vertex_count - 1, "vertex",
                     with_line, err);
}

BpStatus mesh_color_polygon(MeshBuilder *builder, const double color[3], bool with_line, BpError *err) {
    return add_color(builder, &builder->polygon_colors, color, builder->polygon_count - 1, "face", with_line,
                     err);
}

BpStatus mesh_add_corner(MeshBuilder *builder, uint32_t vertex, BpError *err) {
    if (builder->corner_count == CORNERS_MAX)
        return input_fail(builder->input, false, err, "found more than %zu corners of faces, expected fewer",
                          CORNERS_MAX);
    BP_TRY(MAKE_ROOM(builder, builder->corners, builder->corner_capacity, builder->corner_count, "corners",
                     err));
    builder->corners[builder->corner_count++] = vertex;
    return BP_OK;
}

BpStatus mesh_add_normal(MeshBuilder *builder, const double normal[3], bool with_line, BpError *err) {
    const double length = hypot(hypot(normal[0], normal[1]), normal[2]);
    const bool has_direction = length > 0 && isfinite(length);
    if (builder->normal_count == BP_MESH_COUNT_MAX)
        return input_fail(builder->input, with_line, err, "found more than %u normals, expected fewer",
                          BP_MESH_COUNT_MAX);
    BP_TRY(MAKE_ROOM(builder, builder->normals, builder->normal_capacity, builder->normal_count, "normals",
                     err));
    for (int a = 0; a < 3; a++)
        builder->normals[builder->normal_count][a] = has_direction ? (float)(normal[a] / length) : 0;
    builder->normal_count++;
    return BP_OK;
}

BpStatus mesh_add_coordinates(MeshBuilder *builder, double u, double v, bool with_line, BpError *err) {
    const bool is_place = fabs(u) <= MESH_UV_MAX && fabs(v) <= MESH_UV_MAX;
    if (builder->coordinate_count == BP_MESH_COUNT_MAX)
        return input_fail(builder->input, with_line, err,
                          "found more than %u texture coordinates, expected fewer", BP_MESH_COUNT_MAX);
    BP_TRY(MAKE_ROOM(builder, builder->coordinates, builder->coordinate_capacity, builder->coordinate_count,
                     "texture coordinates", err));
    builder->coordinates[builder->coordinate_count][0] = is_place ? (float)u : NAN;
    builder->coordinates[builder->coordinate_count++][1] = is_place ? (float)v : NAN;
    return BP_OK;
}

static BpStatus choose(const MeshBuilder *builder, MeshChoices *choices, uint32_t number, BpError *err) {
    while (choices->count < builder->corner_count) {
        BP_TRY(MAKE_ROOM(builder, choices->of_corners, choices->capacity, choices->count, "corners", err));
        choices->of_corners[choices->count++] = MESH_NO_NUMBER;
    }
    choices->of_corners[builder->corner_count - 1] = number;
    return BP_OK;
}

BpStatus mesh_choose_normal(MeshBuilder *builder, uint32_t normal, BpError *err) {
    return choose(builder, &builder->normal_choices, normal, err);
}

BpStatus mesh_choose_coordinates(MeshBuilder *builder, uint32_t coordinates, BpError *err) {
    return choose(builder, &builder->coordinate_choices, coordinates, err);
}

BpStatus mesh_end_polygon(MeshBuilder *builder, uint32_t material, bool with_line, BpError *err) {
    const uint64_t line = builder->input->line;
    if (builder->polygon_count == BP_MESH_COUNT_MAX)
        return input_fail(builder->input, with_line, err, "found more than %u faces, expected fewer",
                          BP_MESH_COUNT_MAX);
    BP_TRY(MAKE_ROOM(builder, builder->polygons, builder->polygon_capacity, builder->polygon_count, "faces",
                     err));
    const size_t corners = builder->corner_count - builder->polygon_begin;
    builder->polygons[builder->polygon_count++] = (MeshPolygon){.corner_count = (uint32_t)corners,
                                                                .material = material,
                                                                .line = !with_line          ? 0
                                                                        : line < UINT32_MAX ? (uint32_t)line
                                                                                            : UINT32_MAX};
    builder->polygon_begin = builder->corner_count;
    return BP_OK;
}

BpStatus mesh_find_material(MeshBuilder *builder, const char *name, uint32_t *number, BpError *err) {
    BpMesh *const mesh = builder->mesh;
    uint16_t of_name = 0;
    const uint64_t line = builder->input->line;
    const BpStatus status = names_number(&builder->names, name, &of_name, err);
    if (status != BP_OK) {
        bp_error_at(err, builder->input->name, line < INT_MAX ? (int)line : INT_MAX, 0);
        return status;
    }
    *number = of_name > 0 ? of_name - 1u : BP_MESH_NO_MATERIAL;
    if (of_name == 0 || *number < mesh->material_count) return BP_OK;
    BP_TRY(MAKE_ROOM(builder, mesh->materials, builder->material_capacity, mesh->material_count, "materials",
                     err));
    BpMeshMaterial material = {.name = strdup(name)};
    if (material.name == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for a material's name");
    mesh->materials[mesh->material_count++] = material;
    return BP_OK;
}

/* ---- polygons to triangles ---------------------------------------------------------------------------- */

typedef struct Finish {
    MeshBuilder *builder;
    PolygonCutter cutter;
    size_t face_capacity, material_capacity, color_capacity, normal_capacity, coordinate_capacity;
    bool has_materials, has_colors, has_normals, has_coordinates;
    size_t begin;                    /* of the polygon's corners */
    size_t crossing, first_crossing; /* polygons that cross themselves */
    size_t placeless;                /* polygons that have a vertex without a place */
} Finish;

static BpStatus fail_polygon(const Finish *f, size_t number, BpError *err, const char *text) {
    Input *const input = f->builder->input;
    input->line = f->builder->polygons[number].line;
    return input_fail(input, input->line > 0, err, "face %zu (from %" PRIu32 ") %s",
                      number + f->builder->first_index, f->builder->first_index, text);
}

/* What the corners of a triangle that was cut from a polygon have. */
static void find_chosen(const Finish *f, size_t number, const uint32_t *triangle, const MeshChoices *choices,
                        uint32_t chosen[3]) {
    const MeshBuilder *const b = f->builder;
    const size_t count = b->polygons[number].corner_count;
    for (size_t k = 0, at = 0; k < 3; k++) {
        chosen[k] = triangle[k];
        if (choices->of_corners == NULL) continue;
        /* Triangles go around a polygon as its corners do, so the next one is near. */
        while (b->corners[f->begin + at % count] != triangle[k]) at++;
        const size_t corner = f->begin + at % count;
        chosen[k] = corner < choices->count ? choices->of_corners[corner] : MESH_NO_NUMBER;
    }
}

static BpStatus add_normals(Finish *f, size_t number, const uint32_t *triangle, BpError *err) {
    MeshBuilder *const b = f->builder;
    BpMesh *const mesh = b->mesh;
    uint32_t normals[3];
    BP_TRY(MAKE_ROOM(b, mesh->face_normals, f->normal_capacity, mesh->face_count, "faces", err));
    find_chosen(f, number, triangle, &b->normal_choices, normals);
    for (int k = 0; k < 3; k++)
        for (int a = 0; a < 3; a++)
            mesh->face_normals[mesh->face_count][k][a] =
                normals[k] < b->normal_count ? b->normals[normals[k]][a] : 0;
    return BP_OK;
}

static BpStatus add_coordinates(Finish *f, size_t number, const uint32_t *triangle, BpError *err) {
    MeshBuilder *const b = f->builder;
    BpMesh *const mesh = b->mesh;
    uint32_t chosen[3];
    bool is_missing = false;
    BP_TRY(MAKE_ROOM(b, mesh->face_coordinates, f->coordinate_capacity, mesh->face_count, "faces", err));
    float *const face = mesh->face_coordinates[mesh->face_count];
    find_chosen(f, number, triangle, &b->coordinate_choices, chosen);
    for (int k = 0; k < 3; k++)
        is_missing |= chosen[k] >= b->coordinate_count || isnan(b->coordinates[chosen[k]][0]);
    for (int k = 0; k < 3; k++)
        for (int a = 0; a < 2; a++) face[2 * k + a] = is_missing ? NAN : b->coordinates[chosen[k]][a];
    return BP_OK;
}

static BpStatus add_face(Finish *f, size_t number, const uint32_t *triangle, BpError *err) {
    MeshBuilder *const b = f->builder;
    BpMesh *const mesh = b->mesh;
    const uint32_t material = b->polygons[number].material;
    if (mesh->face_count == BP_MESH_COUNT_MAX)
        return fail_polygon(f, number, err, "makes more triangles than there may be, expected fewer");
    if (f->has_materials) {
        BP_TRY(MAKE_ROOM(b, mesh->face_material, f->material_capacity, mesh->face_count, "faces", err));
        mesh->face_material[mesh->face_count] = material;
        if (material != BP_MESH_NO_MATERIAL) mesh->materials[material].face_count++;
    }
    if (f->has_colors) {
        BP_TRY(MAKE_ROOM(b, mesh->face_colors, f->color_capacity, mesh->face_count, "faces", err));
        memcpy(mesh->face_colors[mesh->face_count], b->polygon_colors.values[number],
               sizeof *mesh->face_colors);
    }
    if (f->has_normals) BP_TRY(add_normals(f, number, triangle, err));
    if (f->has_coordinates) BP_TRY(add_coordinates(f, number, triangle, err));
    BP_TRY(MAKE_ROOM(b, mesh->faces, f->face_capacity, mesh->face_count, "faces", err));
    memcpy(mesh->faces[mesh->face_count++], triangle, sizeof *mesh->faces);
    return BP_OK;
}

static int compare_numbers(const void *a, const void *b) {
    const uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return (x > y) - (x < y);
}

static bool lacks_place(const MeshBuilder *builder, const uint32_t *corners, size_t count) {
    for (size_t i = 0; i < count && builder->placeless_count > 0; i++)
        if (bsearch(&corners[i], builder->placeless, builder->placeless_count, sizeof *corners,
                    compare_numbers) != NULL)
            return true;
    return false;
}

static BpStatus cut(Finish *f, size_t number, const uint32_t *corners, BpError *err) {
    BpMesh *const mesh = f->builder->mesh;
    const size_t count = f->builder->polygons[number].corner_count;
    char text[160];
    f->begin = (size_t)(corners - f->builder->corners);
    for (size_t i = 0; i < count; i++) {
        if (corners[i] < mesh->vertex_count) continue;
        const uint32_t first = f->builder->first_index;
        snprintf(text, sizeof text,
                 "has vertex %" PRIu64 ", expected one of %zu vertices, counted from %" PRIu32,
                 (uint64_t)corners[i] + first, mesh->vertex_count, first);
        return fail_polygon(f, number, err, text);
    }
    if (lacks_place(f->builder, corners, count)) {
        f->placeless++;
        return BP_OK;
    }
    const PolygonResult result = polygon_cut(&f->cutter, (const double(*)[3])mesh->positions, corners, count);
    switch (result) {
    case POLYGON_CUT:
        break;
    case POLYGON_CROSSES:
        if (f->crossing++ == 0) f->first_crossing = number;
        polygon_fan(&f->cutter, (const double(*)[3])mesh->positions, corners, count);
        break;
    case POLYGON_TOO_LARGE:
        snprintf(text, sizeof text, "has %zu corners and is not convex, expected at most %d: cut it up",
                 count, POLYGON_CORNERS_MAX);
        return fail_polygon(f, number, err, text);
    case POLYGON_NO_MEMORY:
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for a face of %zu corners", count);
    }
    mesh->polygons += count > 3;
    mesh->dropped_degenerate += (count > 3 ? count - 2 : 1) - f->cutter.triangle_count;
    for (size_t t = 0; t < f->cutter.triangle_count; t++)
        BP_TRY(add_face(f, number, f->cutter.triangles[t], err));
    return BP_OK;
}

static BpStatus cut_all(Finish *f, BpError *err) {
    const MeshBuilder *const b = f->builder;
    size_t begin = 0;
    for (size_t n = 0; n < b->polygon_count; n++) {
        const uint32_t count = b->polygons[n].corner_count;
        BP_TRY(cut(f, n, count > 0 ? &b->corners[begin] : NULL, err));
        begin += count;
    }
    return BP_OK;
}

/* ---- colours ------------------------------------------------------------------------------------------ */

/* Makes the colours of all `count` linear, and those that are missing grey. If none has a colour, there are
 * no colours. */
static BpStatus finish_colors(const MeshBuilder *builder, MeshColors *colors, size_t count, const char *one,
                              const char *several, BpError *err) {
    const double scale = color_range_scale(&colors->range);
    char missing[32], all[32];
    if (colors->count == colors->missing) return BP_OK;
    BP_TRY(put_missing(builder, colors, count, err));
    if (scale == 0) return color_range_fail(&colors->range, one, builder->input->name, err);
    const char *const note = color_range_note(&colors->range);
    if (note != NULL) mesh_note(builder->mesh, "%s", note);
    color_range_make_linear(scale, colors->values, count);
    if (colors->missing == 0) return BP_OK;
    mesh_note(builder->mesh, "grey for lack of a colour: %s of %s %s",
              bp_format_whole(colors->missing, missing, sizeof missing),
              bp_format_whole(count, all, sizeof all), several);
    for (size_t i = 0; i < count; i++) {
        float *const color = colors->values[i];
        if (isnan(color[0])) color[0] = color[1] = color[2] = (float)bp_linear_from_srgb(GREY / 255.0);
    }
    return BP_OK;
}

BpStatus mesh_finish(MeshBuilder *builder, BpError *err) {
    BpMesh *const mesh = builder->mesh;
    char number[32], faces[32];
    Finish finish = {.builder = builder, .has_materials = mesh->material_count > 0};
    BP_TRY(finish_colors(builder, &builder->vertex_colors, mesh->vertex_count, "vertex", "vertices", err));
    BP_TRY(finish_colors(builder, &builder->polygon_colors, builder->polygon_count, "face", "faces", err));
    finish.has_normals = builder->normal_count > 0;
    finish.has_coordinates = builder->coordinate_count > 0;
    finish.has_colors = builder->polygon_colors.count > builder->polygon_colors.missing;
    if (builder->vertex_colors.count > builder->vertex_colors.missing) {
        mesh->vertex_colors = builder->vertex_colors.values;
        builder->vertex_colors.values = NULL;
    }
    const BpStatus status = cut_all(&finish, err);
    polygon_clear(&finish.cutter);
    if (status != BP_OK) return status;
    if (builder->placeless_count > 0)
        mesh_note(mesh, "%s %s without a place left out, and %s face%s with %s",
                  bp_format_whole(builder->placeless_count, number, sizeof number),
                  builder->placeless_count == 1 ? "vertex" : "vertices",
                  bp_format_whole(finish.placeless, faces, sizeof faces), bp_plural(finish.placeless),
                  builder->placeless_count == 1 ? "it" : "them");
    if (mesh->face_count == 0)
        return input_fail(builder->input, false, err,
                          "found no triangle with an area above 0, expected a mesh: check what was exported");
    if (mesh->dropped_degenerate > 0)
        mesh_note(mesh, "%s triangle%s without area left out",
                  bp_format_whole(mesh->dropped_degenerate, number, sizeof number),
                  bp_plural(mesh->dropped_degenerate));
    if (finish.crossing > 0)
        mesh_note(mesh, "%s face%s cut from %s first corner although %s: face %zu (from %" PRIu32 ")%s",
                  bp_format_whole(finish.crossing, number, sizeof number), bp_plural(finish.crossing),
                  finish.crossing == 1 ? "its" : "their",
                  finish.crossing == 1 ? "it crosses itself" : "they cross themselves",
                  finish.first_crossing + builder->first_index, builder->first_index,
                  finish.crossing == 1 ? "" : " is the first");
    return BP_OK;
}
