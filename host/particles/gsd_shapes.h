/* gsd_shapes.h: the shapes of the types of a GSD file.
 *
 * In:    the text of a shape (JSON; gsd.readthedocs.io, "Shape Visualization").   Out: a sphere, an
 * ellipsoid, the spheres of a union, a body with faces, or a capsule. Knows: the classes of shapes.   Does
 * not know: who has them. */
#ifndef BP_PARTICLES_GSD_SHAPES_H
#define BP_PARTICLES_GSD_SHAPES_H

#include "particles.h"

#include <stddef.h>

typedef struct GsdShape {
    const char *kind; /* of one that is drawn as a sphere ("sphere union"; static); NULL: as it is */
    double
        diameter; /* of a sphere, or of one that reaches the farthest point of a union; NaN: none is given */
    double half_axes[3]; /* of an ellipsoid; else 0 */
    double (*sphere)[4]; /* of a union: centres and radii; NULL: it is not one */
    size_t sphere_count;
    bool has_body;
    BpParticleShape body; /* if it has one */
} GsdShape;

/* Most spheres of a union; with more, it is drawn as the sphere that holds it. */
enum { GSD_UNION_MAX = 256 };
/* How thick polygons are, of twice the distance of their farthest corner. */
#define GSD_POLYGON_THICKNESS 0.1

/* Reads `size` bytes of text, which may end in bytes of value 0. Release with gsd_shape_clear(). Fails with
 * BP_ERR_SCENE and the message alone on text that is not JSON, on shapes that lack what their class needs,
 * and on bodies without a volume. */
BpStatus gsd_shape_read(const char *text, size_t size, GsdShape *shape, BpError *err);
void gsd_shape_clear(GsdShape *shape);

#endif
