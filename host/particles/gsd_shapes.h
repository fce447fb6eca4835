/* gsd_shapes.h: the shapes of the types of a GSD file, as spheres.
 *
 * In:    the text of a shape (JSON; gsd.readthedocs.io, "Shape Visualization").   Out: one sphere, or those
 * of a union. Knows: the classes of shapes.   Does not know: files, particles. */
#ifndef BP_PARTICLES_GSD_SHAPES_H
#define BP_PARTICLES_GSD_SHAPES_H

#include "base/status.h"

#include <stddef.h>

typedef struct GsdShape {
    const char
        *kind; /* what a sphere stands for ("ellipsoid"; static); NULL: a sphere, or nothing that is known */
    double diameter; /* of a sphere of equal volume for ellipsoids, of one that reaches the farthest corner
                        for others; NaN: none is given */
    double (*sphere)[4]; /* of a union: centres and radii; NULL: it is not one */
    size_t sphere_count;
} GsdShape;

/* Most spheres of a union; with more, it is drawn as the sphere that holds it. */
enum { GSD_UNION_MAX = 256 };

/* Reads `size` bytes of text, which may end in bytes of value 0. Release shape->sphere with free(). Fails
 * with BP_ERR_SCENE and the message alone on text that is not JSON, and on shapes that lack what their class
 * needs. */
BpStatus gsd_shape_read(const char *text, size_t size, GsdShape *shape, BpError *err);

#endif
