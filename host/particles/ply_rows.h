/* ply_rows.h: the points of a PLY file, one row after the other, ASCII or binary.
 *
 * In:    an input, a header that was read from it.   Out: the numbers of each point.
 * Knows: how rows are written.   Does not know: what becomes of the points. */
#ifndef BP_PARTICLES_PLY_ROWS_H
#define BP_PARTICLES_PLY_ROWS_H

#include "ply_header.h"

/* The points of a file are read by both: as spheres of a scene's clouds (formats/ply.c), and as particles
 * (read_ply.c). Counts are not trusted: nothing is allocated for them. */

/* Passes over the elements before the points. */
BpStatus ply_begin_points(Input *input, const PlyHeader *header, BpError *err);
/* Reads the next point: values[i] gets its property i, or of a list the length. `row`: its number, from 0.
 * Numbers may be infinite, or NaN where the file has none. */
BpStatus ply_take_point(Input *input, const PlyHeader *header, uint64_t row, double *values, BpError *err);
/* Passes over the elements after the points. Fails unless the file ends there. */
BpStatus ply_end_points(Input *input, const PlyHeader *header, BpError *err);

/* Reads one number of a line, moving *cursor past it. False when there is none. What programs write for
 * missing numbers is NaN, and "inf" a number. */
bool ply_parse_number(char **cursor, double *value);

#endif
