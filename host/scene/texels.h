/* texels.h: an image that a scene has read: a grid of colours, linear.
 *
 * In:    what a file held.   Out: texels that are colours or radiances, their bound, a hash of all.
 * Knows: what a texel may be.   Does not know: formats of files, spheres, how an image is looked up.
 *
 * Texels are floats, since files hold no more: pack and the reference tracer read the same numbers. */
#ifndef BP_SCENE_TEXELS_H
#define BP_SCENE_TEXELS_H

#include "base/status.h"

#include <stdbool.h>
#include <stdint.h>

#define BP_IMAGE_SIDE_MAX 65535u
#define BP_IMAGE_TEXELS_MAX ((uint64_t)1 << 27) /* of all images of a scene together: 16384 by 8192 */
#define BP_IMAGES_MAX 1024u
#define BP_IMAGE_SCALE_MAX 1.0e12

/* How the numbers of a file stand for light. */
typedef enum BpEncoding {
    BP_ENCODING_OF_FORMAT, /* as its format has it: PNG as sRGB, others linear */
    BP_ENCODING_SRGB,
    BP_ENCODING_LINEAR
} BpEncoding;

typedef struct BpImage {
    char *file; /* as the scene names it */
    BpEncoding encoding;
    double scale; /* that the texels have been multiplied by */
    uint32_t width, height;
    float *texels;   /* red, green, blue of each; rows from the top, from the left */
    double bound[3]; /* the largest values */
    double mean;     /* of the luminance over a sphere that the image covers by longitude and latitude */
    double spread;   /* the standard deviation of the luminance over that sphere, over its mean */
    bool is_gray;    /* red, green and blue are equal everywhere */
    uint64_t hash;
} BpImage;

/* Black texels. BP_ERR_MEMORY. */
BpStatus bp_texels_create(uint32_t width, uint32_t height, BpImage **image, BpError *err);
void bp_texels_destroy(BpImage **image); /* NULL-safe */

/* Multiplies the texels by `scale`, and finds what follows from them. Fails with BP_ERR_SCENE, naming its
 * place, for a texel that is not a number from 0 to 1e12; `path` is the file that it stands in. */
BpStatus bp_texels_finish(BpImage *image, double scale, const char *path, BpError *err);

#endif
