/* depth_cues.h: draws outlines where the depth jumps, and fading by depth, over a picture.
 *
 * In:    a picture with depth and normals.   Out: the picture, changed; its errors stay those of the render.
 * Knows: pixels.   Does not know: scenes, where the depth comes from. */
#ifndef BP_IMAGE_DEPTH_CUES_H
#define BP_IMAGE_DEPTH_CUES_H

#include "base/status.h"

typedef struct BpDepthCues {
    double outlines; /* width of the lines in pixels; 0: none */
    double fog;      /* share by which the farthest surface fades, 0 to 1; the nearest does not */
    /* The colours to which distant things fade, at the lower and the upper edge of the picture. A picture
     * with alpha fades to transparency instead. */
    double bottom[3], top[3];
} BpDepthCues;

/* Draws over rgb and alpha. Lines are black, surround the nearer surface, and fade with it. BP_ERR_USAGE: the
 * picture has no depth; BP_ERR_MEMORY: it is unchanged. */
BpStatus bp_depth_cues_draw(BpPicture *picture, const BpDepthCues *cues, BpError *err);

#endif
