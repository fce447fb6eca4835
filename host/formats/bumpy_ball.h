/* bumpy_ball.h: a closed mesh of any size, for measurements: a ball with bumps.
 *
 * In:    how many triangles.   Out: the entries of a scene's "triangles", as text.
 * Knows: how a sphere is divided.  Does not know: scenes. */
#ifndef BP_FORMATS_BUMPY_BALL_H
#define BP_FORMATS_BUMPY_BALL_H

#include "base/status.h"

#include <stdio.h>

#define BP_BALL_TRIANGLES_MAX 20971520u

/* Whether a ball can have so many triangles: 20 * 4^k, up to BP_BALL_TRIANGLES_MAX. */
bool bp_ball_has(uint64_t triangles);

/* Writes the triangles of a ball around the origin, about 1 in radius, separated by commas, each as an object
 * with "vertices" and "material". Each side of an icosahedron is divided in four, again and again, and each
 * vertex is then moved along its direction, by a fifth of it at most. Vertices are floats, and triangles that
 * share one give the same digits. BP_ERR_USAGE for a number that it cannot have. */
BpStatus bp_ball_print(uint64_t triangles, const char *material, FILE *stream, BpError *err);

#endif
