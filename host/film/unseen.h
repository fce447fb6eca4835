/* unseen.h: light that the samples of a picture find by chance, and may not have found yet.
 *
 * In:    for each pixel, what such light brings to a sample in the mean, and in the mean of squares, from a
 *        pilot that comes from the lights (render/pilot.h); the samples that the pixel has.
 * Out:   how much of its variance belongs to the noise that is claimed for a pixel.
 * Knows: arithmetic.   Does not know: where the light comes from, OpenCL.
 *
 * Light that a sample finds with probability p, and that then brings c, has the variance p c^2 whether it has
 * been found or not; but replicates that have not found it do not show it. So a variance of the pilot's
 * is added until samples have found such light often enough to show it themselves: with the weight EVIDENCE
 * / (EVIDENCE + finds), where `finds` is how many the samples of the whole picture are expected to have made
 * of light as bright as this. The pilot's own uncertainty is about that of EVIDENCE finds. */
#ifndef BP_FILM_UNSEEN_H
#define BP_FILM_UNSEEN_H

#include "base/status.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct BpFilm BpFilm;

#define BP_UNSEEN_EVIDENCE 10.0

/* Luminances. 0: no such light reaches the pixel. */
typedef struct BpUnseenPixel {
    float mean;   /* that it adds to a sample: p c */
    float square; /* the mean of its square: p c^2 */
} BpUnseenPixel;

typedef struct BpUnseen {
    BpUnseenPixel *pixels;
    float tint[3]; /* the mean square of each channel over that of the luminance */
} BpUnseen;

/* Creates one in which everything is 0. BP_ERR_MEMORY. */
BpStatus bp_unseen_create(size_t pixels, BpUnseen **unseen, BpError *err);
BpStatus bp_unseen_copy(const BpUnseen *from, size_t pixels, BpUnseen **unseen, BpError *err);
void bp_unseen_destroy(BpUnseen **unseen); /* NULL-safe */

/* Weights by brightness, in octaves. */
enum { BP_UNSEEN_OCTAVES = 256 };
typedef struct BpUnseenWeights {
    double finds[BP_UNSEEN_OCTAVES]; /* that the samples of the picture are expected to have made */
} BpUnseenWeights;

/* The weights for the samples that a film has now; all 0 if it has no unseen light. */
void bp_unseen_weigh(const BpFilm *film, BpUnseenWeights *weights);
/* The weight of what reaches one pixel; 0 if nothing does. */
double bp_unseen_weight(const BpUnseenWeights *weights, const BpUnseenPixel *pixel);

#endif
