/* turns.h: what rays meet among spheres, triangles and capsules, and what they meet next when they leave it.
 *
 * In:    spheres, triangles, rays, the directions in which they leave.   Out: TURN_REALS numbers a ray.
 * Knows: lab.h, and where a line passes a triangle or a capsule in 113 bits.   Does not know: which triangles
 * and rays matter. */
#ifndef TESTS_HARD_TURNS_H
#define TESTS_HARD_TURNS_H

#include "lab.h"
#include "oracle.h"

#include "scene/scene.h"

/* probe.cl has the same numbers. A triangle is its place in the list, after all spheres, -1: none. */
enum { TURN_REALS = 16, TURN_MET = 0, TURN_OUTSIDE, TURN_T, TURN_NEXT, TURN_NEXT_OUTSIDE, TURN_NEXT_T };
enum { TURN_HIGH = 6, TURN_LOW = 9, TURN_ERROR = 12 };

/* A worker for these shapes, which the caller keeps, seen from the origin. */
BpWorker *turns_worker(const Lab *lab, const BpSphere *spheres, size_t sphere_count,
                       const BpTriangle *triangles, size_t count);
/* The same for capsules alone, which it numbers from 0. */
BpWorker *turns_capsules(const Lab *lab, const BpCapsule *capsules, size_t count);
/* A ray from a place towards a point. `fine`: its numbers are doubles, else pairs of floats. */
void turns_aim(bool fine, double *ray, const double from[3], const double to[3]);
/* `directions`: 3 floats a ray, of any length near 1. */
void turns_run(const Lab *lab, BpWorker *worker, size_t rays_count, const double *rays,
               const double *directions, double *out);

/* Whether the line passes the triangle, but for edge functions within `tiny` of 0; these, the distance in
 * lengths of d, and the side that it comes from. */
bool turns_passes(const BpTriangle *triangle, const Wide origin[3], const Wide d[3], Wide tiny, Wide w[3],
                  Wide *t, bool *outside);

/* Where a line is inside a capsule whose radius is `scale` times as large, in lengths of d. */
typedef struct TurnsStretch {
    bool meets;
    Wide from, to;
} TurnsStretch;
TurnsStretch turns_through(const BpCapsule *capsule, const Wide origin[3], const Wide d[3], double scale);

#endif
