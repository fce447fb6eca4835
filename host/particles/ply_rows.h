/* ply_rows.h: the elements of a PLY file, one row after the other, ASCII or binary.
 *
 * In:    an input, a header that was read from it.   Out: the numbers of each row.
 * Knows: how rows are written.   Does not know: what becomes of points and faces. */
#ifndef BP_PARTICLES_PLY_ROWS_H
#define BP_PARTICLES_PLY_ROWS_H

#include "ply_header.h"

/* A file is read by three: its points as spheres of a scene's clouds (formats/ply.c), and as particles
 * (read_ply.c), and with its faces as a mesh (meshes/read_ply.c). Counts are not trusted: nothing is
 * allocated for them. */

/* The items of one list of a row. Begins with the property's place in its element, and else zeroed; `items`
 * is of the heap. */
typedef struct PlyList {
    size_t place, count, capacity;
    double *items;
    struct PlyList *next; /* Optional: another list of the row */
} PlyList;

/* Reads the next row of an element: values[i] gets its property i, or of a list the length. `row`: its
 * number, from 0. `list`: Optional; it and those behind it get the items of their lists. Numbers may be
 * infinite, or NaN where the file has none. */
BpStatus ply_take_row(Input *input, const PlyHeader *header, size_t element, uint64_t row, double *values,
                      PlyList *list, BpError *err);
/* Passes over an element. */
BpStatus ply_pass_element(Input *input, const PlyHeader *header, size_t element, BpError *err);
/* Fails unless the file ends here, after its last element. */
BpStatus ply_expect_end(Input *input, const PlyHeader *header, BpError *err);

/* Passes over the elements before the points. */
BpStatus ply_begin_points(Input *input, const PlyHeader *header, BpError *err);
/* ply_take_row() of the points, without a list. */
BpStatus ply_take_point(Input *input, const PlyHeader *header, uint64_t row, double *values, BpError *err);
/* Passes over the elements after the points. Fails unless the file ends there. */
BpStatus ply_end_points(Input *input, const PlyHeader *header, BpError *err);

/* Reads one number of a line, moving *cursor past it. False when there is none. What programs write for
 * missing numbers is NaN, and "inf" a number. */
bool ply_parse_number(char **cursor, double *value);

#endif
