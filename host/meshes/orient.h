/* orient.h: on which side of a line a point lies.
 *
 * In:    three points of a plane.   Out: the exact sign.
 * Does not know: what the points belong to. */
#ifndef BP_MESHES_ORIENT_H
#define BP_MESHES_ORIENT_H

/* 1: c lies to the left of the line from a to b; -1: to the right; 0: on it, or a equals b. Exact for finite
 * numbers of which no product overflows, and no product but 0 is below 1e-290. */
int orient(const double a[2], const double b[2], const double c[2]);

#endif
