/* builder.h: how every format's reader hands a mesh over.
 *
 * In:    vertices and polygons, in a file's order.   Out: a mesh of triangles.
 * Knows: what all formats share.   Does not know: which formats there are.
 *
 * A polygon may name vertices that follow it: all are cut once the file has been read. */
#ifndef BP_MESHES_BUILDER_H
#define BP_MESHES_BUILDER_H

#include "mesh.h"

#include "particles/color_range.h"
#include "particles/input.h"
#include "particles/names.h"

#include <math.h>

#define MESH_NO_NUMBER UINT32_MAX
/* Of texture coordinates, either way: those beyond are missing. */
#define MESH_UV_MAX 1.0e6

typedef struct MeshPolygon {
    uint32_t corner_count, material; /* BP_MESH_NO_MATERIAL: none */
    uint32_t line;                   /* 0: it stands in no line */
} MeshPolygon;

/* Colours of vertices or of polygons. Begins as zero. */
typedef struct MeshColors {
    float (*values)[3]; /* as in the file; red is NaN where there is none */
    size_t count, capacity, missing;
    ColorRange range;
} MeshColors;

/* Which of a file's normals, or of its texture coordinates, the first corners have, or MESH_NO_NUMBER; those
 * behind have none. Without any, each vertex has what is of its own number. */
typedef struct MeshChoices {
    uint32_t *of_corners;
    size_t count, capacity;
} MeshChoices;

typedef struct MeshBuilder {
    Input *input;
    BpMesh *mesh;
    const char *path;     /* of the file; others are sought beside it */
    uint32_t first_index; /* which number the file gives to its first vertex: 0, or 1 in OBJ */
    size_t vertex_capacity;
    uint32_t *placeless; /* the vertices of which a coordinate is NaN, rising */
    size_t placeless_count, placeless_capacity;
    MeshColors vertex_colors, polygon_colors;
    MeshPolygon *polygons;
    size_t polygon_count, polygon_capacity;
    uint32_t *corners; /* of all polygons, one after the other */
    size_t corner_count, corner_capacity,
        polygon_begin;   /* where the corners of the polygon being made begin */
    float (*normals)[3]; /* of vertices, or as many as a file lists */
    size_t normal_count, normal_capacity;
    float (*coordinates)[2]; /* the same of texture coordinates; NaN: missing */
    size_t coordinate_count, coordinate_capacity;
    MeshChoices normal_choices, coordinate_choices;
    BpNames names; /* of materials: number n is material n - 1 */
    size_t material_capacity;
} MeshBuilder;

void mesh_builder_init(MeshBuilder *builder, Input *input, const char *path, BpMesh *mesh);
void mesh_builder_clear(MeshBuilder *builder);

/* Makes room for one more in an array of the heap. `of_what`: "vertices". */
BpStatus mesh_make_room(const Input *input, void **array, size_t *capacity, size_t count, size_t size,
                        const char *of_what, BpError *err);

static inline bool mesh_has_place(const double position[3]) {
    return !isnan(position[0]) && !isnan(position[1]) && !isnan(position[2]);
}
/* Adds a vertex. One of which a coordinate is NaN has no place, and faces that have it are left out: depth
 * cameras write such vertices where they see nothing. Fails on what is infinite or too large. with_line: the
 * error names the line last taken. */
BpStatus mesh_add_vertex(MeshBuilder *builder, const double position[3], bool with_line, BpError *err);
/* The colour of the vertex, or of the polygon, that was added last: numbers of any scale (color_range.h), or
 * NaN for a colour that is missing. */
BpStatus mesh_color_vertex(MeshBuilder *builder, const double color[3], bool with_line, BpError *err);
BpStatus mesh_color_polygon(MeshBuilder *builder, const double color[3], bool with_line, BpError *err);
/* Adds a corner to the polygon that is being made: a vertex, counted from 0. */
BpStatus mesh_add_corner(MeshBuilder *builder, uint32_t vertex, BpError *err);
/* Adds a normal, of any length; one that has no direction, or is not finite, is missing. */
BpStatus mesh_add_normal(MeshBuilder *builder, const double normal[3], bool with_line, BpError *err);
/* The normal of the corner that was added last, counted from 0; it may follow, and if it does not, it is
 * missing. */
BpStatus mesh_choose_normal(MeshBuilder *builder, uint32_t normal, BpError *err);
/* The same of texture coordinates, u and v, which grows upwards. */
BpStatus mesh_add_coordinates(MeshBuilder *builder, double u, double v, bool with_line, BpError *err);
BpStatus mesh_choose_coordinates(MeshBuilder *builder, uint32_t coordinates, BpError *err);
/* Ends it. */
BpStatus mesh_end_polygon(MeshBuilder *builder, uint32_t material, bool with_line, BpError *err);
/* The number of the material of that name, which is added where it is new; "" has BP_MESH_NO_MATERIAL. */
BpStatus mesh_find_material(MeshBuilder *builder, const char *name, uint32_t *number, BpError *err);

/* After all of a file: cuts the polygons, and makes the colours linear and those that are missing grey. Fails
 * on vertices that do not exist, on polygons that cannot be cut, and if there is no triangle. */
BpStatus mesh_finish(MeshBuilder *builder, BpError *err);

/* Adds to the notes what is not there yet. */
void mesh_note(BpMesh *mesh, const char *format, ...) BP_PRINTF_LIKE(2, 3);

#endif
