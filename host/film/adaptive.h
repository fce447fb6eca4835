/* adaptive.h: adaptive sampling: decides how many samples each pixel gets.
 *
 * In:    the film between passes; a mean number of samples to reach.
 * Out:   passes, each a list of pixels and the range of samples that all of them get.
 * Knows: counts and errors of pixels.   Does not know: OpenCL, clocks.
 *
 * The picture is cut into tiles of about 8 x 8 pixels, and each tile like a chessboard into a black and a
 * white half. All pixels of a half have the same number of samples, BP_ADAPTIVE_FIRST times a power of two
 * (which suits the Sobol sequence), and a pass doubles some. For a mean of n samples, the first quarter
 * (rounded down to such a count, at least BP_ADAPTIVE_FIRST) goes to every pixel; the errors found in it
 * decide about the rest: the half is doubled whose squared error would fall most for the ray segments it
 * takes (they stand for time), until the mean is reached.
 *
 * No bias: a half's count is decided by errors and segments of halves of the other colour, in samples of the
 * first quarter only, whose number depends on no sample. So whether a pixel gets more samples does not depend
 * on the values of its own samples, and its mean stays unbiased. (Deciding by a pixel's own samples makes
 * pictures darker: pixels that have not yet found the light would stop.) */
#ifndef BP_FILM_ADAPTIVE_H
#define BP_FILM_ADAPTIVE_H

#include "film.h"

#define BP_ADAPTIVE_FIRST 16u /* samples that every pixel has before any decision */
/* The smallest mean of an adaptive render: below it there is next to nothing to decide. */
#define BP_ADAPTIVE_MEAN_MIN (2 * BP_ADAPTIVE_FIRST)

typedef struct BpAdaptive BpAdaptive;

typedef struct BpAdaptivePass {
    const uint32_t *pixels; /* valid until the next call */
    uint32_t pixel_count;
    uint64_t first, count; /* samples of each, counted from the first of the render */
} BpAdaptivePass;

/* For a picture of width x height pixels, all of which will have BP_ADAPTIVE_FIRST samples at the first
 * bp_adaptive_next(). `samples_max`: the most that one pixel may get. BP_ERR_MEMORY. */
BpStatus bp_adaptive_create(uint32_t width, uint32_t height, uint64_t samples_max, BpAdaptive **adaptive,
                            BpError *err);
void bp_adaptive_destroy(BpAdaptive **adaptive);

/* The next pass on the way to a mean of `samples` a pixel, at least BP_ADAPTIVE_FIRST and not below those of
 * earlier calls; false when it has been reached, as nearly as doublings allow, never above except for counts
 * that earlier calls have led to. `film` holds all samples of all passes so far. *pass is valid only
 * when true. */
BpStatus bp_adaptive_next(BpAdaptive *adaptive, const BpFilm *film, uint64_t samples, bool *more,
                          BpAdaptivePass *pass, BpError *err);

/* The pass under way; false: none is. */
bool bp_adaptive_pass(BpAdaptive *adaptive, BpAdaptivePass *pass);

/* Serialises the decisions so far, for a file; free *bytes. It takes a bp_adaptive_next() to have something
 * to save. BP_ERR_MEMORY. */
BpStatus bp_adaptive_save(const BpAdaptive *adaptive, uint8_t **bytes, size_t *size, BpError *err);
/* Restores them into one of the same size, whose own decisions are forgotten: it continues as the saved one
 * would have. BP_ERR_FILE: the state is invalid; then, and after BP_ERR_MEMORY, destroy it. */
BpStatus bp_adaptive_restore(BpAdaptive *adaptive, const uint8_t *bytes, size_t size, BpError *err);

/* Samples of all pixels together in the passes that bp_adaptive_next() has seen done; and the most of a
 * pixel, the pass under way included. */
uint64_t bp_adaptive_samples(const BpAdaptive *adaptive);
uint64_t bp_adaptive_samples_max(const BpAdaptive *adaptive);

#endif
