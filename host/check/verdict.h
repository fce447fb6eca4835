/* verdict.h: decides whether two sets of samples of a picture have the same expectation.
 *
 * In:    power sums of two renderers (reference/sums.h), drawn independently of each other.
 * Out:   agree, disagree or inconclusive, at a stated error rate; and how large an error could have been
 * missed.
 * Knows: statistics.   Does not know: scenes, devices, who rendered.
 *
 * Tested are the mean of each channel over the whole picture and over up to 8 x 8 blocks, and likewise the
 * mean of squares, which detects a wrong spread. Picture and blocks get 45 % of the level each, their
 * squares, which mostly repeat the means, 5 % each; every family divides its part among its tests
 * (Bonferroni), so that a correct kernel is rejected with probability `level` at most. The whole picture
 * reveals small errors, the blocks local ones; single pixels are not tested, since thousands of tests of one
 * pixel each cannot detect an error of a hundredth of their noise.
 *
 * A difference D of means with variance V counts as z = max(0, |D| - e) / sqrt V, where e is what single
 * precision may cost (BP_VERDICT_ROUNDING). If one side has fewer than 20 samples that are not black, means
 * are not normally distributed: the numbers of such samples are compared instead, exactly (binomial).
 *
 * A difference that is not found does not prove equality: samples may have been too few to find it. So a
 * verdict is "agree" only if nothing is rejected and the brightness of the picture is shown to be equal
 * within a margin, in luminance and in each channel that has light: both ends of the 95 % interval of each
 * ratio lie within 1 -+ margin (two one-sided tests, Schuirmann 1987, at 2.5 % each; all must pass, so none
 * needs a smaller level). Otherwise it is inconclusive, as for a black picture, which shows nothing.
 *
 * If one side samples lights and the other finds them by chance, means are equal, but spreads and numbers of
 * lit samples are not: the means get the whole level, with variances three of their standard errors larger
 * than estimated, and means of too few lit samples are not compared. */
#ifndef BP_CHECK_VERDICT_H
#define BP_CHECK_VERDICT_H

#include "reference/sums.h"

#define BP_VERDICT_LEVEL 1e-4    /* default: one correct kernel in ten thousand is rejected */
#define BP_VERDICT_MARGIN 0.005  /* default: "agree" needs brightness shown to be equal within 0.5 % */
#define BP_VERDICT_POWER 0.9     /* of the smallest bias that would have been found */
#define BP_VERDICT_ROUNDING 2e-5 /* relative; of squares twice that */
#define BP_VERDICT_BLOCKS_SIDE 8u
#define BP_VERDICT_PICTURE_OFF 1e-6 /* error of a pixel that summation may cause; see picture_off */

typedef enum BpConclusion {
    BP_INCONCLUSIVE, /* nothing is rejected, but equality is not shown */
    BP_AGREE,
    BP_DISAGREE
} BpConclusion;

/* "agree", "disagree", "inconclusive"; static. */
const char *bp_conclusion_name(BpConclusion conclusion);

typedef enum BpVerdictFamily {
    BP_FAMILY_PICTURE,         /* 3 tests: channel means of the whole picture */
    BP_FAMILY_BLOCKS,          /* 3 a block */
    BP_FAMILY_PICTURE_SQUARES, /* the same for squares */
    BP_FAMILY_BLOCKS_SQUARES,
    BP_FAMILIES
} BpVerdictFamily;

const char *bp_verdict_family_name(BpVerdictFamily family);

/* The most suspicious test of a family. */
typedef struct BpVerdictTest {
    double limit;             /* |z| above this rejects */
    uint32_t tests;           /* in the family, which share its part of the level */
    double z;                 /* >= 0; 1e6 where there is no noise but a difference */
    int channel;              /* BP_SUMS_RED .. BLUE */
    uint32_t column, row;     /* of the block; 0 for the whole picture */
    double kernel, reference; /* the two means, of x or of x^2 */
    bool counted;             /* compared by numbers of lit samples */
} BpVerdictTest;

typedef struct BpVerdict {
    BpConclusion conclusion;
    double level, margin;
    bool means_only; /* one side alone has rays to lamps: the families of squares are not tested (0 tests) */
    BpVerdictTest worst[BP_FAMILIES];
    uint32_t block_columns, block_rows;
    uint64_t samples;                           /* valid ones, of both sides together */
    uint64_t invalid_kernel, invalid_reference; /* any is a disagreement */
    double mean_kernel[BP_SUMS_CHANNELS], mean_reference[BP_SUMS_CHANNELS];
    double segments_kernel, segments_reference; /* mean ray segments of a path; not judged */
    /* Brightness (luminance) of kernel over reference, with its 95 % interval; NaN for a black picture. */
    double ratio, ratio_low, ratio_high;
    /* The smallest margin within which brightness is shown to be equal, in luminance and in each channel that
     * has light; at most `margin` is the evidence that "agree" needs. Infinite: nothing is shown. */
    double shown_within;
    /* The error of the kernel's picture against the samples that it is made of: the largest |picture - mean
     * of the samples| of a pixel's channel, over the sum of that mean and the channel's mean in the picture.
     * Infinite where a pixel counts other samples as valid. Above BP_VERDICT_PICTURE_OFF it is a
     * disagreement. */
    double picture_off;
    /* A common factor 1 + smallest_bias on the kernel's radiance would have been found with BP_VERDICT_POWER
     * by the means of the whole picture. NaN for a black picture. */
    double smallest_bias;
} BpVerdict;

/* Judges. Both sums must be of the same size, with at least 2 samples in every pixel (a pixel without samples
 * is left out of both). BP_ERR_USAGE otherwise. `level` in (0, 1), `margin` above 0: a fraction. */
BpStatus bp_verdict(const BpSums *kernel, const BpSums *reference, double level, double margin,
                    BpVerdict *verdict, BpError *err);

/* Adds `picture_off` to a verdict of bp_verdict(). */
void bp_verdict_add_picture(BpVerdict *verdict, double picture_off);

/* Samples per pixel that are likely to settle a verdict that was inconclusive with `samples` per pixel; 0 if
 * no number is, since the picture is black. */
uint64_t bp_verdict_samples_needed(const BpVerdict *verdict, uint64_t samples);

/* Signed z of one pixel's luminance: for maps, not for judging. */
double bp_verdict_pixel_z(const BpPixelSums *kernel, const BpPixelSums *reference);

/* One line for each of: verdict, families, brightness, power; ends with a newline. Returns a string that the
 * caller frees, NULL when out of memory. */
char *bp_verdict_text(const BpVerdict *verdict);

#endif
