/* field.h: random fields of spheres, as large as a disk holds.
 *
 * In:    how many, a seed.   Out: a PLY file that a scene's "clouds" can name.
 * Knows: PLY's binary form.  Does not know: scenes. */
#ifndef BP_FORMATS_FIELD_H
#define BP_FORMATS_FIELD_H

#include "base/status.h"

#include <stdio.h>

#define BP_FIELD_HALF_SIDE 10.0 /* the cube is [-10, 10]^3, however many spheres it holds */

/* Writes `count` spheres (1 to BP_SPHERES_MAX), spread evenly over the cube, to a stream as a binary
 * little-endian PLY of float x y z radius and uchar red green blue: 19 bytes a sphere. Radii are 0.1 to 0.4
 * of (volume / count)^(1/3), so that a field of any size looks alike from afar and its spheres cover a like
 * share of space. The order of the draws: x, y, z, radius, red, green, blue, sphere by sphere. The stream
 * need not be able to seek, and the caller closes it. */
BpStatus bp_field_print_ply(uint64_t count, uint64_t seed, FILE *stream, BpError *err);

#endif
