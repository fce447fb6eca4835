/* film.h: the sums from which a picture and its standard errors are computed.
 *
 * In:    fixed-point replicate sums, as the kernel `accumulate` writes them.
 * Out:   means, standard errors, NRMSE; the exact sum of two films.
 * Knows: arithmetic, and of a scene how bright it can be and what distinguishes it from others.
 * Does not know: OpenCL, how films are stored (film_file.h).
 *
 * Sample s of a pixel belongs to replicate s mod K. Sums are integers, so they do not depend on the
 * order of addition and cannot drift. A channel x of a sample is y = x * 2^scale_log2 steps, at most 2^38.
 * Its whole part goes to `sums`. That is right to 2^-21 of y where y is at least 2^21; so where a channel of
 * the sample is smaller than that (and not 0), the fractions of its channels go to `fine_sums`, in steps that
 * are 2^38 times finer. Every sample down to 2^-18 of a step is kept to within a millionth of itself, however
 * bright the lamp for which the scale must leave room. bp_film_scale() chooses the scale so that 2^24 samples
 * of one replicate overflow neither sum. */
#ifndef BP_FILM_FILM_H
#define BP_FILM_FILM_H

#include "base/names.h"
#include "scene/scene.h"
#include "unseen.h"

#include "aov_list.h"

#define BP_REPLICATES_DEFAULT 4u /* chosen by measurement: docs/ACCURACY.md */
#define BP_REPLICATES_MAX 64u
#define BP_REPLICATE_SAMPLES_MAX (1u << 24)
#define BP_FINE_BITS 38 /* a fine step is 2^-38 steps */
#define BP_SAMPLE_RANGES_MAX 10000u
/* What rounding to steps may cost a picture, relative to its mean; see bp_film_rounding(). */
#define BP_ROUNDING_MAX 1e-6

/* The samples [first, first + count). */
struct BpSampleRange {
    uint64_t first, count;
};

/* Why samples are left out of the sums. X(member of BpFilm, BpFilmInfo and BpRenderReport, tally of the
 * kernels, in words). The causes add up to `invalid_samples`. */
#define BP_INVALID_LIST(X)                                                                                   \
    X(not_finite_samples, TALLY_NOT_FINITE, "not finite")                                                    \
    X(negative_samples, TALLY_NEGATIVE, "negative")                                                          \
    X(out_of_range_samples, TALLY_OUT_OF_RANGE, "brighter than the sums can hold")

#define BP_FILM_AOV(place, member, floats, mean, channels) float *member;

/* Where a render stood when its film was read, so that another can continue from there (render.h). */
typedef struct BpFilmPlan {
    bool adaptive;
    uint64_t first_sample; /* of every pixel, absolute */
    uint64_t target;       /* samples per pixel that the render is on its way to; adaptive: their mean */
    uint64_t done;         /* samples per pixel of the passes that are done, as schedule.h counts them */
    uint32_t pass_samples, next_pixel; /* of the pass under way; 0: none is */
    uint64_t samples_max;              /* where it stops: at so many samples, or */
    double error;                      /* at this NRMSE; 0: no such rule */
    bool ended;                        /* it has stopped there: only adaptive renders keep a plan then */
    uint8_t *decisions;                /* Optional. Heap: what adaptive sampling has decided (adaptive.h) */
    size_t decision_bytes;
} BpFilmPlan;

struct BpFilm {
    uint32_t width, height;
    uint32_t replicates; /* K */
    int32_t scale_log2;
    /* The inputs of the samples; two films merge only when all of these are equal. */
    uint64_t scene_hash; /* of everything that can change radiance */
    uint64_t seed;
    uint32_t max_depth;
    BP_SETTING_LIST(BP_SETTING_MEMBER)
    BpTransfer transfer; /* of the scene, for the picture made from a merged file */
    /* The sample numbers that every pixel was meant to get, sorted and disjoint. */
    struct BpSampleRange *ranges;
    size_t range_count;
    bool partial;       /* interrupted: some pixels have fewer samples than the ranges */
    bool coarse;        /* some sample was so dim that a fine step may be over a millionth of it */
    char *title;        /* Optional. The scene's title, to be shown; owned, not compared by a merge. */
    int64_t *sums;      /* width * height * K * 3, index ((pixel * K) + k) * 3 + channel */
    int64_t *fine_sums; /* Optional. Of the same shape, in steps 2^38 times finer; NULL: all are 0 */
    uint32_t *counts;   /* width * height * K: valid samples */
    uint64_t segments, truncated_paths, invalid_samples, shadow_rays;    /* totals over the picture */
    uint64_t not_finite_samples, negative_samples, out_of_range_samples; /* of the invalid ones */
    uint64_t *pixel_segments; /* Optional. Of each pixel, for adaptive sampling; not merged. */
    uint64_t *met; /* Optional. Of each pixel: valid samples whose camera ray met something; a scene without a
                      backdrop needs it, and the picture's alpha is its share of all */
    /* Optional, all or none: what each pixel shows first, as in BpPicture. They follow from scene and
     * seed and not from the samples of the film (render/aovs.h), so films of other samples have the same. */
    AOV_LIST(BP_FILM_AOV)
    BpUnseen *unseen; /* Optional. What the samples find by chance; it too follows from the scene alone */
    /* The samples of the whole job of which this film is a share; a count of 0: it is not a share. */
    struct BpSampleRange job;
    BpFilmPlan *plan; /* Optional. Not merged: a merged film belongs to no single render */
};

/* ---- what of a scene the sums depend on (film_scene.c) ---- */

/* The scale for a scene traced to `max_depth` segments: 38 - ceil(log2(bound)) with
 * bp_scene_radiance_bound(), within +-126 so that 2^scale is a float. A sample is then at most 2^38 steps,
 * and 2^24 of them are at most 2^62. */
int32_t bp_film_scale(const BpScene *scene, uint32_t max_depth, BpLightSampling light_sampling,
                      BpCaustics caustics, BpRoulette roulette);
/* An upper bound of the radiance that one path of at most `max_depth` segments can carry: the brightest of
 * sky and lamps, times min(1 / (1 - a), max_depth), where a is the largest albedo of a material that both
 * emits and scatters: 1 + a + a^2 + ... with as many terms as the path has segments. With
 * BP_LIGHT_SAMPLING_ON, each vertex but the last adds half the light of a lamp at most, times what has been
 * scattered so far; with BP_CAUSTICS_ON, up to three times as much more, for the ways through a focuser.
 * With BP_ROULETTE_ON, a path that goes on may carry ROULETTE_LIMIT at each segment from ROULETTE_SEGMENTS
 * on. Where a lobe weighs more than its albedo (the list of scene/material.h), all that times its largest
 * weight for each vertex. 0 for a black scene. */
double bp_scene_radiance_bound(const BpScene *scene, uint32_t max_depth, BpLightSampling light_sampling,
                               BpCaustics caustics, BpRoulette roulette);
/* A hash of the meaning of the scene: camera, sky, spheres in their order, each with the members of its
 * material. Names, unused materials, members without effect (the fuzz of glass) and the sign of zero change
 * nothing; nor do sample counts and depth, which the film keeps apart. */
uint64_t bp_scene_hash(const BpScene *scene);

/* ---- the sums (film.c) ---- */

/* Zeroed except for the three sizes. 1 <= replicates <= BP_REPLICATES_MAX; sides up to BP_PICTURE_SIDE_MAX.
 * BP_ERR_LIMIT or BP_ERR_MEMORY. */
BpStatus bp_film_create(uint32_t width, uint32_t height, uint32_t replicates, BpFilm **film, BpError *err);

/* Records that every pixel gets the samples [first, first + count), count > 0; adjoining ranges are joined.
 * BP_ERR_USAGE for an overlap or samples past 2^32; BP_ERR_LIMIT when a replicate would get more than
 * BP_REPLICATE_SAMPLES_MAX samples, past which 64 bits could overflow. Unchanged on failure. */
BpStatus bp_film_add_range(BpFilm *film, uint64_t first, uint64_t count, BpError *err);
/* The same for `count` ranges, sorted and disjoint, at once. BP_ERR_LIMIT also if the result had more than
 * BP_SAMPLE_RANGES_MAX separate ranges. */
BpStatus bp_film_add_ranges(BpFilm *film, const struct BpSampleRange *ranges, size_t count, BpError *err);

/* Two films can be merged only if scene, size and options are equal. BP_ERR_USAGE names those that differ. */
BpStatus bp_film_check_same(const BpFilm *a, const BpFilm *b, BpError *err);

/* Gives `film` fine sums, all 0, unless it has them. BP_ERR_MEMORY. */
BpStatus bp_film_add_fine_sums(BpFilm *film, BpError *err);

/* Gives `film` counts of the rays that met something, all 0, unless it has them. BP_ERR_MEMORY. */
BpStatus bp_film_add_met(BpFilm *film, BpError *err);

static inline bool bp_film_has_aovs(const BpFilm *film) {
    return film->depth != NULL;
}
/* Gives `film` depth, normal and albedo, all 0, unless it has them. BP_ERR_MEMORY. */
BpStatus bp_film_add_aovs(BpFilm *film, BpError *err);

void bp_film_drop_aovs(BpFilm *film);
/* Both have them, and the same size. */
void bp_film_copy_aovs(const BpFilm *from, BpFilm *to);
/* Copies them from or to a picture of the same size, replacing its own. BP_ERR_MEMORY. */
BpStatus bp_film_take_aovs(BpFilm *film, const BpPicture *picture, BpError *err);
BpStatus bp_film_give_aovs(const BpFilm *film, BpPicture *picture, BpError *err);

/* Adds the sums, counts and totals of `from`, which has the same size, scale and number of replicates, and
 * no more samples than the sums hold; not its ranges. BP_ERR_MEMORY, and the film is as it was. */
BpStatus bp_film_add_sums(BpFilm *film, const BpFilm *from, BpError *err);

/* Accepts NULL. */
void bp_film_plan_destroy(BpFilmPlan **plan);

/* The sum of radiance of one channel of one replicate; `index` as in `sums`. */
double bp_film_sum(const BpFilm *film, size_t index);

/* Samples of every pixel that the ranges name for `replicate`, and in all. */
uint64_t bp_film_expected(const BpFilm *film, uint32_t replicate);
uint64_t bp_film_range_total(const BpFilm *film);

/* ---- estimates (film_estimate.c) ----
 *
 * Replicates may hold unequal counts n_k (a range that K does not divide, an interrupted run). With replicate
 * means m_k of variance s^2 / n_k and N = sum n_k, the mean is m = sum n_k m_k / N, and
 *     s^2 = sum n_k (m_k - m)^2 / (K' - 1),    standard error of m = sqrt(s^2 / N),
 * over the K' replicates that have samples: the mean square between groups of a one-way layout (Scheffe, The
 * Analysis of Variance, 1959, ch. 3), unbiased since E sum n_k (m_k - m)^2 = K' s^2 - s^2. For equal counts
 * it is the variance of the replicate means over K. With low-discrepancy samples the variance of m_k falls
 * faster than 1 / n_k, and s^2 is exact for equal counts only. */

/* bp_film_nrmse() of ballpark.h: NRMSE = sqrt(mean over pixels of squared standard error of luminance) / mean
 * luminance, Rec. 709 weights. The luminance's error comes from the luminances of the replicates, so that
 * correlated channels count right. NaN when the mean is 0 or a pixel has fewer than two replicates. */

/* Squared standard error of one pixel's luminance, by the same formula and with its unseen light; NaN with
 * fewer than two replicates. `weights`: of this film (bp_unseen_weigh). */
double bp_film_squared_error(const BpFilm *film, const BpUnseenWeights *weights, size_t pixel);
/* All estimates of a picture, from one pass over its pixels. */
typedef struct BpFilmClaim {
    double luminance;   /* the mean, with light that samples may not have found yet */
    double nrmse;       /* as bp_film_nrmse() */
    double unseen_part; /* as bp_film_unseen_part() */
} BpFilmClaim;

BpFilmClaim bp_film_claim(const BpFilm *film);
/* Why samples are left out, in words: " (2 not finite, 1 negative)"; "" without any. */
enum { BP_INVALID_TEXT_SIZE = 192 };
const char *bp_film_invalid_causes(const BpFilm *film, char text[BP_INVALID_TEXT_SIZE]);
/* BP_ERR_LIMIT when most samples were left out: the others are then no evidence about the scene. */
BpStatus bp_film_check_valid(const BpFilm *film, BpError *err);
/* The fewest and the most valid samples that a pixel has, and the mean. */
void bp_film_sample_counts(const BpFilm *film, uint64_t *least, uint64_t *most, double *mean);
/* An upper bound of the relative change of the picture's mean luminance that is due to rounding samples to
 * steps. At most BP_ROUNDING_MAX unless samples were `coarse` and nothing brighter is seen; infinite for a
 * picture that is black because of it. */
double bp_film_rounding(const BpFilm *film);
/* Mean of linear pixel values over the picture (pixels without samples count as 0). */
void bp_film_mean(const BpFilm *film, double mean[3]);

#endif
