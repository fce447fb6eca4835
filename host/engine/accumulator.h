/* accumulator.h: the sums from which a picture and its error bar are made.
 *
 * In:    fixed-point replicate sums, as the fold kernel leaves them.
 * Out:   means, standard errors, NRMSE; sums of two runs added exactly.
 * Knows: arithmetic.   Does not know: OpenCL, scenes, file formats (accumulator_file.h does).
 *
 * Sample s of a pixel belongs to replicate s mod K. Radiance x is kept as the integer nearest to
 * x * 2^scale_log2, so sums do not depend on their order and cannot drift. bp_accumulator_scale() chooses the
 * scale so that 2^24 samples of one replicate cannot overflow 64 bits. */
#ifndef BP_ENGINE_ACCUMULATOR_H
#define BP_ENGINE_ACCUMULATOR_H

#include "../scene/scene.h"

#define BP_REPLICATES_DEFAULT 4u
#define BP_REPLICATES_MAX 64u
#define BP_REPLICATE_SAMPLES_MAX (1u << 24)

typedef struct BpAccumulator {
    uint32_t width, height;
    uint32_t replicates; /* K */
    int32_t scale_log2;
    /* What the samples were drawn from; two accumulators merge only when all of these agree. */
    uint64_t scene_hash; /* of everything that can change radiance */
    uint64_t seed;
    uint32_t max_depth;
    uint32_t sampler, precision, math, numerics; /* BpSampler, BpPrecision, BpMath, BpNumerics */
    uint32_t transfer; /* BpTransfer of the scene, for the picture made from a merged file */
    /* Sample ranges [first, first + count) that every pixel was meant to get, sorted, disjoint. */
    struct BpSampleRange { uint64_t first, count; } *ranges;
    size_t range_count;
    bool partial; /* interrupted: some pixels have fewer samples than the ranges say */
    int64_t *sums;    /* width * height * K * 3, index ((pixel * K) + k) * 3 + channel */
    uint32_t *counts; /* width * height * K: valid samples */
    uint64_t segments, cut_paths, invalid_samples; /* totals over the picture */
} BpAccumulator;

/* The scale for a scene: 2^(38 - ceil(log2(bound))), bound >= the largest radiance a path can bring
 * (bp_scene_radiance_bound). */
int32_t bp_accumulator_scale(const BpScene *scene);
/* Largest radiance that one path can carry: the brightest of sky and lamps, times the sum of the geometric
 * series of the largest albedo where a material both emits and scatters. */
double bp_scene_radiance_bound(const BpScene *scene);
/* FNV-1a over the meaning of the scene: camera, sky, materials in use, spheres, colours. */
uint64_t bp_scene_hash(const BpScene *scene);

BpStatus bp_accumulator_create(uint32_t width, uint32_t height, uint32_t replicates, BpAccumulator **accumulator,
                               BpError *err);
void bp_accumulator_destroy(BpAccumulator **accumulator);

/* Adds `from` into `into`: exact. Refused (BP_ERR_USAGE, saying which field differs) unless both come from the
 * same scene and settings and their sample ranges are disjoint. */
BpStatus bp_accumulator_merge(BpAccumulator *into, const BpAccumulator *from, BpError *err);

/* Means, standard errors (from the spread of replicate means, K-1 degrees of freedom) and counts. */
BpStatus bp_accumulator_picture(const BpAccumulator *accumulator, BpPicture *picture, BpError *err);

/* NRMSE = sqrt(mean over pixels of squared standard error of luminance) / mean luminance, Rec. 709 weights.
 * NaN when the mean is 0 or a pixel has fewer than two replicates. */
double bp_accumulator_nrmse(const BpAccumulator *accumulator);
/* Mean of linear pixel values over the picture (pixels without samples count as 0). */
void bp_accumulator_mean(const BpAccumulator *accumulator, double mean[3]);

#endif
