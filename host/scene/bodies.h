/* bodies.h: the bodies that triangles enclose, where light passes in: each is a boundary of media, as a
 * sphere is.
 *
 * In:    a scene whose triangles are in order (triangle_rules.h).   Out: its bodies, and the body of each
 * triangle. Knows: medium.h's rule.   Does not know: how a path finds out which bodies it is in.
 *
 * Triangles, quads and boxes that stand in the scene itself make a body where they hang together by their
 * edges and have one material and one interior. Of a mesh, all triangles of one material are one body. */
#ifndef BP_SCENE_BODIES_H
#define BP_SCENE_BODIES_H

#include "base/status.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

struct BpScene;

#define BP_BODIES_MAX 32u /* a path has a bit for each */
#define BP_NO_BODY UINT32_MAX

typedef struct BpBody {
    size_t first;                /* of its triangles */
    uint32_t material, interior; /* as those of its triangles, into media[] counted from 1 */
    double volume;               /* at least 0 */
    bool inside_out;             /* its triangles run clockwise, seen from outside */
} BpBody;

typedef struct BpBodies {
    BpBody *list; /* in the order of their first triangles */
    size_t count;
    uint32_t *of_triangle; /* for each, into the list, or BP_NO_BODY; NULL where there are none */
} BpBodies;

/* There are none where all of space is clear (bp_scene_has_media). BP_ERR_MEMORY is the only error. Free with
 * bp_bodies_clear(). */
BpStatus bp_bodies_find(const struct BpScene *scene, BpBodies *bodies, BpError *err);
static inline void bp_bodies_clear(BpBodies *bodies) {
    free(bodies->list);
    free(bodies->of_triangle);
    *bodies = (BpBodies){0};
}

/* The body of a triangle, into the scene's own bodies, or BP_NO_BODY. */
uint32_t bp_body_of(const struct BpScene *scene, size_t triangle);

#endif
