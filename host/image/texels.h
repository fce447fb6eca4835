/* texels.h: an image of a scene: a grid of linear colours.
 *
 * In:    the contents of a file.   Out: texels that are colours or radiances, their bound, a hash of all.
 * Knows: what a texel may be.   Does not know: how files are read, how an image is looked up.
 *
 * A negative value, which resampling creates beside bright texels, becomes 0, since nothing emits or reflects
 * less; the image's notes have their number.
 *
 * Texels are floats, since files hold no more: pack and the reference tracer read the same numbers. */
#ifndef BP_IMAGE_TEXELS_H
#define BP_IMAGE_TEXELS_H

#include "base/status.h"

#include <stdbool.h>
#include <stdint.h>

#define BP_IMAGE_SIDE_MAX 65535u
#define BP_IMAGE_TEXELS_MAX ((uint64_t)1 << 27) /* of all images of a scene together: 16384 by 8192 */
#define BP_IMAGES_MAX 1024u
#define BP_IMAGE_SCALE_MAX 1.0e12
#define BP_RADIANCE_MAX 1.0e12 /* of a texel, and of any other light */

enum { BP_IMAGE_NOTES_SIZE = 512 };

/* The encoding of light in the numbers of a file. */
typedef enum BpEncoding {
    BP_ENCODING_OF_FORMAT, /* the format's own: PNG and JPEG are sRGB, others are linear */
    BP_ENCODING_SRGB,
    BP_ENCODING_LINEAR
} BpEncoding;

typedef struct BpImage {
    char *file;      /* as the scene names it */
    uint32_t inside; /* which image of a glTF file it is, counted from 1; 0: the file is the image */
    BpEncoding encoding;
    double scale; /* that the texels have been multiplied by */
    uint32_t width, height;
    float *texels;   /* red, green, blue of each; rows from the top, from the left */
    double bound[3]; /* the largest values */
    double mean;     /* of the luminance over a sphere that the image covers by longitude and latitude */
    double spread;   /* the standard deviation of the luminance over that sphere, over its mean */
    bool is_gray;    /* red, green and blue are equal everywhere */
    uint64_t hash;
    char notes[BP_IMAGE_NOTES_SIZE]; /* what was ignored, changed or guessed, for people; "" */
} BpImage;

/* Black texels. BP_ERR_MEMORY. */
BpStatus bp_texels_create(uint32_t width, uint32_t height, BpImage **image, BpError *err);
void bp_texels_destroy(BpImage **image); /* NULL-safe */

/* Adds to the image's notes. */
void bp_texels_note(BpImage *image, const char *format, ...) BP_PRINTF_LIKE(2, 3);
/* Notes that alpha is left out, where that matters: of so many texels. */
void bp_texels_note_alpha(BpImage *image, size_t transparent);

/* Multiplies the texels by `scale`, sets negative ones to 0, and computes bound, mean and spread. Fails with
 * BP_ERR_SCENE, naming its place, for a texel that is not finite or above 1e12; `path` is the file that it
 * stands in. */
BpStatus bp_texels_finish(BpImage *image, double scale, const char *path, BpError *err);

#endif
