/* polygon.h: polygons cut into triangles.
 *
 * In:    the corners of a polygon in space.   Out: triangles that cover it once, of the same corners.
 * Knows: convex polygons, ear clipping.   Does not know: files. */
#ifndef BP_MESHES_POLYGON_H
#define BP_MESHES_POLYGON_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* A polygon that is not convex may have so many corners: cutting it takes time by their square. */
enum { POLYGON_CORNERS_MAX = 16384 };

typedef enum PolygonResult {
    POLYGON_CUT,
    POLYGON_CROSSES,   /* it crosses itself in every view along an axis, so it bounds no one area */
    POLYGON_TOO_LARGE, /* not convex, and of more than POLYGON_CORNERS_MAX corners */
    POLYGON_NO_MEMORY
} PolygonResult;

/* Begins zeroed; its memory serves one polygon after the other. */
typedef struct PolygonCutter {
    uint32_t (*triangles)[3]; /* of the last polygon: numbers of vertices, wound as the polygon */
    size_t triangle_count;
    size_t capacity;
    struct PolygonCorner *corners;
    uint32_t *queue, *blockers;
    struct PolygonBox *boxes;
} PolygonCutter;

void polygon_clear(PolygonCutter *cutter);

/* Whether three points lie on one line. Exact as orient() is. */
bool polygon_is_flat(const double a[3], const double b[3], const double c[3]);

/* Cuts the polygon with the corners positions[vertices[0]], ..., in the plane of two axes that is nearest to
 * its own, or if it crosses itself there, in another. A polygon of n corners gets n - 2 triangles; fewer
 * where some would have no area in space, as with corners that are the same vertex, or where the outline
 * turns back on itself. Corners on the line between their neighbours are kept as corners of triangles, so
 * that no edge of a neighbour ends amid an edge. Holes may be joined to the outline by an edge that is walked
 * both ways. */
PolygonResult polygon_cut(PolygonCutter *cutter, const double (*positions)[3], const uint32_t *vertices,
                          size_t count);

/* Cuts the same polygon, of which polygon_cut() has found that it crosses itself, from its first corner. */
void polygon_fan(PolygonCutter *cutter, const double (*positions)[3], const uint32_t *vertices, size_t count);

#endif
