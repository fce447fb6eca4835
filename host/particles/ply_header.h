/* ply_header.h: the header of a PLY file, and what the properties of its points mean.
 *
 * In:    an input.   Out: elements, properties, which of them are places, radii and colours.
 * Knows: the header's words, names that programs give to colours.   Does not know: how rows are read
 * (ply_rows.h). */
#ifndef BP_PARTICLES_PLY_HEADER_H
#define BP_PARTICLES_PLY_HEADER_H

#include "color_range.h"
#include "input.h"
#include "ply_type.h"

enum { PLY_PROPERTIES_MAX = 256, PLY_ELEMENTS_MAX = 32, PLY_NAME_SIZE = 64 };

typedef enum PlyForm { PLY_ASCII, PLY_LITTLE_ENDIAN, PLY_BIG_ENDIAN } PlyForm;

typedef struct PlyProperty {
    char name[PLY_NAME_SIZE];
    PlyType type, count_type; /* count_type: of a list's length; PLY_NONE: it is one number */
    uint64_t line;
} PlyProperty;

typedef struct PlyElement {
    uint64_t count;
    size_t first, property_count; /* of the header's properties */
    size_t row_size;              /* in bytes, lists taken as empty */
    bool has_list, faces;         /* faces: polygons, or strips of triangles */
    bool strips;
} PlyElement;

typedef struct PlyHeader {
    PlyForm form;
    bool swap; /* the file's byte order is not this machine's */
    PlyElement elements[PLY_ELEMENTS_MAX];
    PlyProperty properties[PLY_PROPERTIES_MAX];
    size_t element_count, property_count;
    size_t vertex; /* the element of the points */
    /* Among the points' properties; -1: none. All three colours are there, of one type, or none. */
    int place[3], radius, color[3];
    double radius_scale; /* 1/2 where the property is a diameter */
} PlyHeader;

/* Reads the header. Fails unless there is an element vertex with x, y and z, each once. */
BpStatus ply_read_header(Input *input, PlyHeader *header, BpError *err);
/* The property of the points with that name, one number; -1: there is none. Fails on lists of that name, and
 * on two of them. */
BpStatus ply_find_property(const Input *input, const PlyHeader *header, const char *name, int *place,
                           BpError *err);
/* A property of the points. */
static inline const PlyProperty *ply_property(const PlyHeader *header, int place) {
    return &header->properties[header->elements[header->vertex].first + (size_t)place];
}
/* The range of the colours' numbers, from their type; the points must have colours. */
ColorRange ply_color_range(const PlyHeader *header);
static inline bool ply_is_integer(PlyType type) {
    return type != PLY_NONE && type < PLY_FLOAT32;
}

#endif
