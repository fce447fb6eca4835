/* read_ply.c: PLY files with faces; see reader.h.
 *
 * Knows: which properties are corners, colours and texture coordinates, strips of triangles.   Does not know:
 * how headers and rows are written (particles/ply_rows.h), how polygons are cut. */
#include "reader.h"

#include "particles/column_names.h"
#include "particles/ply_rows.h"

#include "base/message_text.h"

#include <inttypes.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct Ply {
    MeshBuilder *builder;
    Input *input;
    PlyHeader header;
    size_t face;      /* the element of the faces */
    PlyList list;     /* of their corners */
    PlyList texcoord; /* of u and v at these, behind the other, if the file has them */
    int face_color[3], normal[3], coordinates[2]; /* places; the first is -1 where there are none */
    double values[PLY_PROPERTIES_MAX];
    bool with_line;
} Ply;

static const PlyProperty *face_property(const Ply *ply, size_t place) {
    return &ply->header.properties[ply->header.elements[ply->face].first + place];
}

static BpStatus find_corners(Ply *ply, BpError *err) {
    const PlyElement *const element = &ply->header.elements[ply->face];
    bool is_found = false;
    for (size_t i = 0; i < element->property_count; i++) {
        const PlyProperty *const property = face_property(ply, i);
        if (strcmp(property->name, "vertex_indices") != 0 && strcmp(property->name, "vertex_index") != 0)
            continue;
        ply->input->line = property->line;
        if (property->count_type == PLY_NONE || !ply_is_integer(property->type) || is_found)
            return input_fail(ply->input, true, err, "found %s %s, expected one list of an integer type",
                              property->name, is_found ? "a second time" : "of another type");
        ply->list.place = i;
        is_found = true;
    }
    if (is_found) return BP_OK;
    return input_fail(
        ply->input, true, err,
        "found faces without a list vertex_indices (or vertex_index), expected one: their corners");
}

/* The colours of faces, where all three are there and of one type. */
static void find_face_colors(Ply *ply) {
    const PlyElement *const element = &ply->header.elements[ply->face];
    const char *names[PLY_PROPERTIES_MAX];
    int *const color = ply->face_color;
    for (size_t i = 0; i < element->property_count; i++)
        names[i] = face_property(ply, i)->count_type == PLY_NONE ? face_property(ply, i)->name : "";
    const bool is_found = column_find_color(names, element->property_count, color);
    const PlyType type = is_found ? face_property(ply, (size_t)color[0])->type : PLY_NONE;
    if (!is_found || face_property(ply, (size_t)color[1])->type != type ||
        face_property(ply, (size_t)color[2])->type != type) {
        color[0] = -1;
        return;
    }
    ply->builder->polygon_colors.range =
        (ColorRange){.bytes = type == PLY_UINT8, .ambiguous = ply_is_integer(type)};
}

static BpStatus find_faces(Ply *ply, BpError *err) {
    size_t found = 0;
    for (size_t i = 0; i < ply->header.element_count; i++) {
        if (!ply->header.elements[i].faces) continue;
        ply->face = i;
        found++;
    }
    if (found > 1)
        return input_fail(ply->input, true, err,
                          "found the faces (face or tristrips) a second time, expected them once");
    if (found == 0 || ply->header.elements[ply->face].count == 0)
        return input_fail(
            ply->input, true, err,
            "found no faces, expected a mesh; points alone are read as particles or as a cloud");
    return BP_OK;
}

static void find_normals(Ply *ply) {
    const PlyElement *const element = &ply->header.elements[ply->header.vertex];
    int found = 0;
    for (size_t i = 0; i < element->property_count; i++) {
        const PlyProperty *const property = ply_property(&ply->header, (int)i);
        for (int a = 0; a < 3; a++)
            if (property->count_type == PLY_NONE &&
                strcmp(property->name, (const char *const[]){"nx", "ny", "nz"}[a]) == 0) {
                ply->normal[a] = (int)i;
                found++;
            }
    }
    if (found != 3) ply->normal[0] = -1;
}

/* u and v: of vertices, by the names that programs give them, or in a list of faces, a pair for each corner.
 */
static void find_coordinates(Ply *ply) {
    static const char *const names[][2] = {{"s", "t"}, {"u", "v"}, {"texture_u", "texture_v"}};
    const PlyElement *const vertex = &ply->header.elements[ply->header.vertex];
    for (size_t n = 0; n < sizeof names / sizeof *names; n++) {
        int places[2] = {-1, -1};
        for (size_t i = 0; i < vertex->property_count; i++) {
            const PlyProperty *const property = ply_property(&ply->header, (int)i);
            for (int a = 0; a < 2 && property->count_type == PLY_NONE; a++)
                if (strcmp(property->name, names[n][a]) == 0) places[a] = (int)i;
        }
        if (places[0] >= 0 && places[1] >= 0 && ply->coordinates[0] < 0)
            memcpy(ply->coordinates, places, sizeof places);
    }
    for (size_t i = 0; i < ply->header.elements[ply->face].property_count; i++) {
        const PlyProperty *const property = face_property(ply, i);
        if (property->count_type == PLY_NONE || strcmp(property->name, "texcoord") != 0) continue;
        ply->texcoord.place = i;
        ply->list.next = &ply->texcoord;
        ply->coordinates[0] = -1;
    }
}

static BpStatus read_vertices(Ply *ply, BpError *err) {
    const PlyHeader *const header = &ply->header;
    double position[3], color[3];
    for (uint64_t row = 0; row < header->elements[header->vertex].count; row++) {
        BP_TRY(ply_take_row(ply->input, header, header->vertex, row, ply->values, NULL, err));
        for (int a = 0; a < 3; a++) position[a] = ply->values[header->place[a]];
        BP_TRY(mesh_add_vertex(ply->builder, position, ply->with_line, err));
        if (ply->normal[0] >= 0) {
            for (int a = 0; a < 3; a++) position[a] = ply->values[ply->normal[a]];
            BP_TRY(mesh_add_normal(ply->builder, position, ply->with_line, err));
        }
        if (ply->coordinates[0] >= 0)
            BP_TRY(mesh_add_coordinates(ply->builder, ply->values[ply->coordinates[0]],
                                        ply->values[ply->coordinates[1]], ply->with_line, err));
        if (header->color[0] < 0) continue;
        for (int c = 0; c < 3; c++) color[c] = ply->values[header->color[c]];
        BP_TRY(mesh_color_vertex(ply->builder, color, ply->with_line, err));
    }
    return BP_OK;
}

static BpStatus fail_corner(const Ply *ply, uint64_t row, double vertex, BpError *err) {
    char found[BP_NUMBER_TEXT_SIZE];
    return input_fail(ply->input, ply->with_line, err,
                      "%s %" PRIu64 " (from 0): found vertex %s, expected one of %" PRIu64
                      " vertices, counted from 0",
                      ply->header.elements[ply->face].strips ? "strip" : "face", row,
                      isnan(vertex) ? "nan" : bp_number_text(vertex, found),
                      ply->header.elements[ply->header.vertex].count);
}

static bool is_vertex(const Ply *ply, double vertex) {
    const uint64_t vertices = ply->header.elements[ply->header.vertex].count;
    return vertex >= 0 && vertex < (double)vertices && vertex < UINT32_MAX && vertex == floor(vertex);
}

static BpStatus end_polygon(const Ply *ply, BpError *err) {
    double color[3];
    BP_TRY(mesh_end_polygon(ply->builder, BP_MESH_NO_MATERIAL, ply->with_line, err));
    if (ply->face_color[0] < 0) return BP_OK;
    for (int c = 0; c < 3; c++) color[c] = ply->values[ply->face_color[c]];
    return mesh_color_polygon(ply->builder, color, ply->with_line, err);
}

static BpStatus add_face(const Ply *ply, uint64_t row, BpError *err) {
    const bool has_pairs = ply->list.next != NULL && ply->texcoord.count == 2 * ply->list.count;
    for (size_t i = 0; i < ply->list.count; i++) {
        const double vertex = ply->list.items[i];
        if (!is_vertex(ply, vertex)) return fail_corner(ply, row, vertex, err);
        BP_TRY(mesh_add_corner(ply->builder, (uint32_t)vertex, err));
        if (!has_pairs) continue;
        const size_t number = ply->builder->coordinate_count;
        BP_TRY(mesh_add_coordinates(ply->builder, ply->texcoord.items[2 * i], ply->texcoord.items[2 * i + 1],
                                    ply->with_line, err));
        BP_TRY(mesh_choose_coordinates(ply->builder, (uint32_t)number, err));
    }
    return end_polygon(ply, err);
}

/* A strip has a triangle for each vertex from its third; every second one runs the other way around. -1 ends
 * a strip, and another begins behind it. Triangles with a vertex twice only lead from one part to the next.
 */
static BpStatus add_strip(const Ply *ply, uint64_t row, BpError *err) {
    const double *const items = ply->list.items;
    size_t begin = 0;
    for (size_t i = 0; i < ply->list.count; i++) {
        if (items[i] == -1) {
            begin = i + 1;
            continue;
        }
        if (!is_vertex(ply, items[i])) return fail_corner(ply, row, items[i], err);
        if (i < begin + 2) continue;
        const bool is_odd = (i - begin) % 2 == 1;
        const double corners[3] = {items[i - 2 + is_odd], items[i - 1 - is_odd], items[i]};
        if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) continue;
        for (int c = 0; c < 3; c++) BP_TRY(mesh_add_corner(ply->builder, (uint32_t)corners[c], err));
        BP_TRY(end_polygon(ply, err));
    }
    return BP_OK;
}

static BpStatus read_faces(Ply *ply, BpError *err) {
    const PlyElement *const element = &ply->header.elements[ply->face];
    for (uint64_t row = 0; row < element->count; row++) {
        BP_TRY(ply_take_row(ply->input, &ply->header, ply->face, row, ply->values, &ply->list, err));
        BP_TRY(element->strips ? add_strip(ply, row, err) : add_face(ply, row, err));
    }
    return BP_OK;
}

/* A property of vertices or faces that seems to hold colours in another form, where neither has any. */
static const char *unread_color(const Ply *ply) {
    if (ply->header.color[0] >= 0 || ply->face_color[0] >= 0) return NULL;
    for (int of_faces = 0; of_faces < 2; of_faces++) {
        const PlyElement *const element = &ply->header.elements[of_faces ? ply->face : ply->header.vertex];
        const char *names[PLY_PROPERTIES_MAX];
        for (size_t i = 0; i < element->property_count; i++)
            names[i] = ply->header.properties[element->first + i].name;
        const char *const found = column_single_color(names, element->property_count);
        if (found != NULL) return found;
    }
    return NULL;
}

/* Notes what belongs to surfaces and is not read. */
static void note_left_out(const Ply *ply) {
    BpMesh *const mesh = ply->builder->mesh;
    bool has_material = false;
    for (size_t i = 0; i < ply->header.elements[ply->face].property_count; i++) {
        const char *const name = face_property(ply, i)->name;
        has_material |= strcmp(name, "material_index") == 0 || strcmp(name, "material_indices") == 0;
    }
    const char *const unread = unread_color(ply);
    if (unread != NULL) {
        char shown[64];
        bp_printable(unread, shown, sizeof shown);
        mesh_note(mesh, "no colours from \"%s\", since red, green and blue must be properties", shown);
    }
    if (has_material) mesh_note(mesh, "materials of faces, by their numbers, left out");
}

static BpStatus read_all(Ply *ply, BpError *err) {
    BP_TRY(ply_read_header(ply->input, &ply->header, err));
    BP_TRY(find_faces(ply, err));
    ply->with_line = ply->header.form == PLY_ASCII;
    const uint64_t line = ply->input->line;
    BP_TRY(find_corners(ply, err));
    ply->input->line = line;
    find_face_colors(ply);
    find_normals(ply);
    find_coordinates(ply);
    if (ply->header.color[0] >= 0) ply->builder->vertex_colors.range = ply_color_range(&ply->header);
    for (size_t i = 0; i < ply->header.element_count; i++) {
        if (i == ply->header.vertex)
            BP_TRY(read_vertices(ply, err));
        else if (i == ply->face)
            BP_TRY(read_faces(ply, err));
        else
            BP_TRY(ply_pass_element(ply->input, &ply->header, i, err));
    }
    note_left_out(ply);
    return ply_expect_end(ply->input, &ply->header, err);
}

BpStatus mesh_read_ply(MeshBuilder *builder, BpError *err) {
    Ply *const ply = calloc(1, sizeof *ply);
    if (ply == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory");
    ply->builder = builder;
    ply->input = builder->input;
    ply->coordinates[0] = -1;
    const BpStatus status = read_all(ply, err);
    free(ply->list.items);
    free(ply->texcoord.items);
    free(ply);
    return status;
}

bool mesh_ply_has_faces(Input *input) {
    PlyHeader *const header = malloc(sizeof *header);
    bool has_faces = false;
    if (header != NULL && ply_read_header(input, header, NULL) == BP_OK)
        for (size_t i = 0; i < header->element_count; i++)
            has_faces |= header->elements[i].faces && header->elements[i].count > 0;
    free(header);
    return has_faces;
}
