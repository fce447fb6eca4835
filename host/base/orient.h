/* orient.h: on which side of a line or a plane a point lies.
 *
 * In:    three points of a plane, or four of space.   Out: the exact sign.
 * Does not know: what the points belong to. */
#ifndef BP_BASE_ORIENT_H
#define BP_BASE_ORIENT_H

/* 1: c lies to the left of the line from a to b; -1: to the right; 0: on it, or a equals b. Exact for finite
 * numbers of which no product overflows, and no product but 0 is below 1e-290. */
int orient(const double a[2], const double b[2], const double c[2]);

/* 1: d lies on the side of the plane through a, b and c from which they run counter-clockwise; -1: on the
 * other; 0: in it, or a, b and c are on one line. Exact for finite numbers of which no product of three
 * overflows, and no such product but 0 is below 1e-240. */
int orient3(const double a[3], const double b[3], const double c[3], const double d[3]);

#endif
