/* geodesic.h: the unit sphere as triangles, from which ellipsoids are made.
 *
 * In:    a fineness.   Out: a closed mesh that has the sphere's volume, and how far it is off.
 * Does not know: what becomes of it. */
#ifndef BP_PARTICLES_GEODESIC_H
#define BP_PARTICLES_GEODESIC_H

#include "base/status.h"

#include <stddef.h>
#include <stdint.h>

/* The edges of an icosahedron are cut into so many parts at most. */
enum { GEODESIC_PARTS_MAX = 24 };
/* Of n parts. */
#define GEODESIC_TRIANGLES(n) ((size_t)20 * (n) * (n))
#define GEODESIC_VERTICES(n) ((size_t)10 * (n) * (n) + 2)

typedef struct Geodesic {
    double (*vertices)[3]; /* all at one distance from the centre */
    size_t vertex_count;
    uint32_t (*triangles)[3]; /* counter-clockwise, seen from outside */
    size_t triangle_count;
    double error; /* the surface lies between the spheres of radius 1 - error and 1 + error */
} Geodesic;

/* Parts from 1 to GEODESIC_PARTS_MAX. BP_ERR_MEMORY is the only error. */
BpStatus geodesic_create(unsigned parts, Geodesic *geodesic, BpError *err);
void geodesic_clear(Geodesic *geodesic);

#endif
