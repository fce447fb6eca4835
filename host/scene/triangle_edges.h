/* triangle_edges.h: the edges of triangles that light passes through, side by side where they are the same.
 *
 * In:    a scene.   Out: edges in order.
 * Knows: vertices that are the same to the bit.   Does not know: what is asked of edges. */
#ifndef BP_SCENE_TRIANGLE_EDGES_H
#define BP_SCENE_TRIANGLE_EDGES_H

#include "scene.h"

typedef struct BpTriangleEdge {
    double ends[2][3]; /* in order */
    int way;           /* 1: its triangle runs from the first to the second, or -1 */
    uint32_t triangle, material, interior;
} BpTriangleEdge;

typedef struct BpTriangleEdges {
    BpTriangleEdge *list;
    size_t count;
} BpTriangleEdges;

/* Those of the listed triangles, quads and boxes whose material lets light in. BP_ERR_MEMORY. Free with
 * bp_triangle_edges_clear(). */
BpStatus bp_triangle_edges(const BpScene *scene, BpTriangleEdges *edges, BpError *err);
void bp_triangle_edges_clear(BpTriangleEdges *edges);

/* Whether two have the same ends, material and interior. Such edges follow each other. */
bool bp_same_edge(const BpTriangleEdge *a, const BpTriangleEdge *b);

#endif
