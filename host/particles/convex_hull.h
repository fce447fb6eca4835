/* convex_hull.h: the convex hull of points in space.
 *
 * In:    points.   Out: triangles of them, closed and counter-clockwise, seen from outside.
 * Does not know: whose corners they are. */
#ifndef BP_PARTICLES_CONVEX_HULL_H
#define BP_PARTICLES_CONVEX_HULL_H

#include "base/status.h"

#include <stddef.h>
#include <stdint.h>

/* Finding it takes time by the square of the number of points. */
enum { CONVEX_HULL_POINTS_MAX = 1024 };

/* The hull of at most CONVEX_HULL_POINTS_MAX points, of which every decision is exact (base/orient.h): points
 * inside and on faces are left out, and where faces have more corners than three, it is cut. *faces is the
 * caller's to free; *count 0: the points lie in one plane. BP_ERR_MEMORY is the only error. */
BpStatus convex_hull(const double (*points)[3], size_t point_count, uint32_t (**faces)[3], size_t *count,
                     BpError *err);

#endif
