/* winding.h: how often triangles wind around a point, exactly.
 *
 * In:    triangles relative to the point, as a device gets them.   Out: a whole number.
 * Knows: exact sums and products.   Does not know: which triangles belong together.
 *
 * A closed surface is crossed outward once more than inward by every ray from a point inside. Here that ray
 * runs along x, and a vertex or an edge in its way counts as if the point lay a little aside, for all
 * triangles alike. */
#ifndef BP_PACKED_WINDING_H
#define BP_PACKED_WINDING_H

/* How the triangle crosses the positive x axis: 1 outward (its vertices run counter-clockwise seen from
 * there), -1 inward, 0 not at all. The sum over a closed surface is its winding number around the origin: 0
 * outside. Exact, unless a product of three coordinates is below 1e-290. */
int bp_axis_crossing(const double a[3], const double b[3], const double c[3]);

#endif
