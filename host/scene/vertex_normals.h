/* vertex_normals.h: the normals that smooth triangles show at their vertices.
 *
 * In:    directions of files; vertices and faces.   Out: unit normals.
 * Does not know: where meshes come from, how a normal between vertices is found. */
#ifndef BP_SCENE_VERTEX_NORMALS_H
#define BP_SCENE_VERTEX_NORMALS_H

#include "base/status.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The unit vector along `direction`, or `direction` itself where it is one already, but for rounding to
 * float; zeros, and false, where it has no direction. */
bool bp_unit_normal(const double direction[3], float normal[3]);

/* The normal at each corner of each face: the mean of the normals of all faces that have that vertex, each by
 * its angle there (G. Thuermer and C. Wuethrich, "Computing Vertex Normals from Polygonal Facets", 1998).
 * Zeros where they cancel each other. A vertex that several faces should not be smooth across is listed as
 * often as there are sides. BP_ERR_MEMORY. */
BpStatus bp_vertex_normals(const double (*positions)[3], size_t vertex_count, const uint32_t (*faces)[3],
                           size_t face_count, float (*normals)[3][3], BpError *err);

#endif
