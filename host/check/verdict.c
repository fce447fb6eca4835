/* verdict.c: see verdict.h. */
#include "verdict.h"

#include "base/status.h"
#include "statistics.h"

#include <math.h>

enum { LIT_FEW = 20 };
static const double z_without_noise = 1e6;
/* The part of the level that each family of tests may spend. */
static const double level_share[BP_FAMILIES] = {0.45, 0.45, 0.05, 0.05};
static const double level_share_of_means[BP_FAMILIES] = {0.5, 0.5, 0, 0};

typedef struct Region {
    uint32_t left, top, right, bottom; /* half open */
    uint32_t column, row;
} Region;

/* A mean over a region: of x (moment 1) or of x^2 (moment 2). */
typedef struct Mean {
    double value, variance;
    uint64_t lit, samples;
} Mean;

/* Mean of a pixel's samples and the variance of that mean. */
static void pixel_mean(const BpPixelSums *pixel, int channel, int moment, double *mean, double *variance) {
    const double n = (double)pixel->count;
    *mean = *variance = 0;
    if (pixel->count < 2) return;
    const double sum = moment == 1 ? pixel->sum[channel] : pixel->sum2[channel];
    const double square = moment == 1 ? pixel->sum2[channel] : pixel->sum4[channel];
    *mean = sum / n;
    *variance = fmax(0, square / n - *mean * *mean) / (n - 1);
}

static Mean region_mean(const BpSums *sums, const Region *region, int channel, int moment) {
    const double area = (double)(region->right - region->left) * (region->bottom - region->top);
    Mean result = {0};
    for (uint32_t y = region->top; y < region->bottom; ++y) {
        for (uint32_t x = region->left; x < region->right; ++x) {
            const BpPixelSums *pixel = &sums->pixels[(size_t)y * sums->width + x];
            double mean, variance;
            pixel_mean(pixel, channel, moment, &mean, &variance);
            result.value += mean / area;
            result.variance += variance / (area * area);
            result.lit += pixel->lit[channel];
            result.samples += pixel->count;
        }
    }
    return result;
}

static double rounding(double reference, int moment) {
    return moment * (BP_VERDICT_ROUNDING * fabs(reference) + 1e-7);
}

/* The amount by which the variance of a region's mean may exceed its estimate: three standard errors. If few
 * samples are bright, a mean that is too small mostly has a spread that is too small. That cancels if both
 * sides find light in the same way, but not if one side samples lights. */
static double variance_margin(const BpSums *sums, const Region *region, int channel) {
    const double area = (double)(region->right - region->left) * (region->bottom - region->top);
    double variance = 0;
    for (uint32_t y = region->top; y < region->bottom; ++y) {
        for (uint32_t x = region->left; x < region->right; ++x) {
            const BpPixelSums *pixel = &sums->pixels[(size_t)y * sums->width + x];
            double square, of_square;
            if (pixel->count < 2) continue;
            pixel_mean(pixel, channel, 2, &square, &of_square);
            variance += of_square / pow((double)(pixel->count - 1) * area * area, 2);
        }
    }
    return 3 * sqrt(variance);
}

/* The variance of a mean that may have missed rare, bright light: with the margin, and, if the mean is below
 * the other one, increased by the variance of the missing light. No sample of that light is brighter than
 * `brightest`, so the mean of its squares is at most `brightest` times the missing mean, even if no such
 * sample has been found. */
static double cautious_variance(const Mean *mean, const Mean *other, double margin, double brightest) {
    if (!(other->value > mean->value)) return mean->variance + margin;
    const double lacks = mean->value > 0 ? other->value / mean->value : 1;
    const double missed = brightest * (other->value - mean->value) / (double)mean->samples;
    return (mean->variance + margin) * lacks * lacks + (mean->samples > 0 ? missed : 0);
}

static double z_of_means(const Mean *kernel, const Mean *reference, int moment) {
    const double variance = kernel->variance + reference->variance;
    const double rest = fabs(kernel->value - reference->value) - rounding(reference->value, moment);
    if (rest <= 0) return 0;
    if (!(variance > 0)) return z_without_noise;
    return fmin(rest / sqrt(variance), z_without_noise);
}

/* The z with the two-sided probability of the split of lit samples, given their total. */
static double z_of_counts(const Mean *kernel, const Mean *reference) {
    const uint64_t total = kernel->lit + reference->lit;
    const double share = (double)kernel->samples / (double)(kernel->samples + reference->samples);
    const double p = bp_binomial_two_sided(kernel->lit, total, share);
    return p >= 1 ? 0 : p > 0 ? bp_normal_upper_quantile(p / 2) : z_without_noise;
}

/* Tests one region and remembers it if it is the most suspicious so far. */
static void test_region(const BpSums *kernel, const BpSums *reference, const Region *region, int moment,
                        BpVerdictTest *worst) {
    for (int channel = BP_SUMS_RED; channel <= BP_SUMS_BLUE; ++channel) {
        Mean k = region_mean(kernel, region, channel, moment);
        Mean r = region_mean(reference, region, channel, moment);
        const bool counted = (k.lit < LIT_FEW || r.lit < LIT_FEW) && k.samples > 0 && r.samples > 0;
        const bool comparable = kernel->means_only == reference->means_only;
        if (!comparable) {
            k.variance =
                cautious_variance(&k, &r, variance_margin(kernel, region, channel), kernel->brightest);
            r.variance =
                cautious_variance(&r, &k, variance_margin(reference, region, channel), reference->brightest);
        }
        const double z = !counted ? z_of_means(&k, &r, moment) : comparable ? z_of_counts(&k, &r) : 0;
        if (z > worst->z || (channel == BP_SUMS_RED && region->column == 0 && region->row == 0)) {
            const BpVerdictTest old = *worst;
            *worst = (BpVerdictTest){.limit = old.limit,
                                     .tests = old.tests,
                                     .z = z,
                                     .channel = channel,
                                     .column = region->column,
                                     .row = region->row,
                                     .kernel = k.value,
                                     .reference = r.value,
                                     .counted = counted};
        }
    }
}

static uint32_t at_most(uint32_t value, uint32_t limit) {
    return value < limit ? value : limit;
}

static void begin_family(BpVerdict *verdict, int family, uint32_t tests) {
    const double share = (verdict->means_only ? level_share_of_means : level_share)[family];
    const double level = bp_level_bonferroni(verdict->level * share, tests);
    verdict->worst[family].limit = bp_normal_upper_quantile(level / 2);
    verdict->worst[family].tests = tests;
}

static void test_families(const BpSums *kernel, const BpSums *reference, BpVerdict *verdict) {
    const Region whole = {0, 0, kernel->width, kernel->height, 0, 0};
    verdict->block_columns = at_most(kernel->width, BP_VERDICT_BLOCKS_SIDE);
    verdict->block_rows = at_most(kernel->height, BP_VERDICT_BLOCKS_SIDE);
    const uint32_t blocks = verdict->block_columns * verdict->block_rows;
    for (int moment = 1; moment <= (verdict->means_only ? 1 : 2); ++moment) {
        const int first = moment == 1 ? BP_FAMILY_PICTURE : BP_FAMILY_PICTURE_SQUARES;
        BpVerdictTest *picture = &verdict->worst[first], *worst = &verdict->worst[first + 1];
        begin_family(verdict, first, 3);
        begin_family(verdict, first + 1, 3 * blocks);
        test_region(kernel, reference, &whole, moment, picture);
        for (uint32_t row = 0; row < verdict->block_rows; ++row) {
            for (uint32_t column = 0; column < verdict->block_columns; ++column) {
                const Region block = {column * kernel->width / verdict->block_columns,
                                      row * kernel->height / verdict->block_rows,
                                      (column + 1) * kernel->width / verdict->block_columns,
                                      (row + 1) * kernel->height / verdict->block_rows,
                                      column,
                                      row};
                test_region(kernel, reference, &block, moment, worst);
            }
        }
    }
}

/* The largest distance of one channel's ratio of means from 1, within its 95 % interval. Infinite: unknown.
 */
static double ratio_off(const Mean *kernel, const Mean *reference, double *low, double *high) {
    const double z_95 = bp_normal_upper_quantile(0.025);
    if (!bp_ratio_interval(kernel->value, kernel->variance, reference->value, reference->variance, z_95, low,
                           high)) {
        *low = *high = NAN;
        return INFINITY;
    }
    return fmax(fabs(*low - 1), fabs(*high - 1));
}

/* Ratio, interval, evidence, power: how wrong the kernel could still be. */
static void state_accuracy(const BpSums *kernel, const BpSums *reference, BpVerdict *verdict) {
    const Region whole = {0, 0, kernel->width, kernel->height, 0, 0};
    verdict->smallest_bias = NAN;
    const double shift = bp_z_detectable(verdict->worst[BP_FAMILY_PICTURE].limit, BP_VERDICT_POWER);
    for (int channel = 0; channel < BP_SUMS_CHANNELS; ++channel) {
        const Mean k = region_mean(kernel, &whole, channel, 1),
                   r = region_mean(reference, &whole, channel, 1);
        verdict->mean_kernel[channel] = k.value;
        verdict->mean_reference[channel] = r.value;
        /* A channel that is dark on both sides has nothing to show; luminance is dark where all are. */
        const bool dark = k.lit == 0 && r.lit == 0 && channel != BP_SUMS_LUMINANCE;
        double low, high;
        const double off = ratio_off(&k, &r, &low, &high);
        if (!dark) verdict->shown_within = fmax(verdict->shown_within, off);
        if (channel == BP_SUMS_LUMINANCE) {
            verdict->ratio = r.value > 0 ? k.value / r.value : NAN;
            verdict->ratio_low = low;
            verdict->ratio_high = high;
        } else if (r.value > 0) {
            const double found = shift * sqrt(k.variance + r.variance) + rounding(r.value, 1);
            verdict->smallest_bias = fmin(found / r.value, verdict->smallest_bias); /* fmin passes over NaN */
        }
    }
}

static double count_segments(const BpSums *sums, uint64_t *samples, uint64_t *invalid) {
    double segments = 0;
    uint64_t count = 0;
    for (size_t p = 0; p < (size_t)sums->width * sums->height; ++p) {
        segments += (double)sums->pixels[p].segments;
        count += sums->pixels[p].count;
        *invalid += sums->pixels[p].invalid;
    }
    *samples += count;
    return count > 0 ? segments / (double)count : 0;
}

BpStatus bp_verdict(const BpSums *kernel, const BpSums *reference, double level, double margin,
                    BpVerdict *verdict, BpError *err) {
    if (kernel->width != reference->width || kernel->height != reference->height)
        return bp_fail(err, BP_ERR_USAGE, "cannot compare a picture of %u x %u pixels with one of %u x %u",
                       kernel->width, kernel->height, reference->width, reference->height);
    if (!(level > 0 && level < 1))
        return bp_fail(err, BP_ERR_USAGE, "the level %g is not between 0 and 1", level);
    if (!(margin > 0)) return bp_fail(err, BP_ERR_USAGE, "the margin %g is not above 0", margin);
    for (size_t p = 0; p < (size_t)kernel->width * kernel->height; ++p)
        if (kernel->pixels[p].count + kernel->pixels[p].invalid < 2 ||
            reference->pixels[p].count + reference->pixels[p].invalid < 2)
            return bp_fail(err, BP_ERR_USAGE, "a comparison needs at least 2 samples in every pixel");

    *verdict = (BpVerdict){.level = level, .margin = margin};
    verdict->means_only = kernel->means_only != reference->means_only;
    verdict->segments_kernel = count_segments(kernel, &verdict->samples, &verdict->invalid_kernel);
    verdict->segments_reference = count_segments(reference, &verdict->samples, &verdict->invalid_reference);
    test_families(kernel, reference, verdict);
    state_accuracy(kernel, reference, verdict);
    /* Nothing passes without evidence: the evidence must be shown, and no fault may undo it. */
    verdict->conclusion = verdict->shown_within <= margin ? BP_AGREE : BP_INCONCLUSIVE;
    if (verdict->invalid_kernel > 0 || verdict->invalid_reference > 0) verdict->conclusion = BP_DISAGREE;
    for (int f = 0; f < BP_FAMILIES; ++f)
        if (verdict->worst[f].z > verdict->worst[f].limit) verdict->conclusion = BP_DISAGREE;
    return BP_OK;
}

void bp_verdict_add_picture(BpVerdict *verdict, double picture_off) {
    verdict->picture_off = picture_off;
    if (!(picture_off <= BP_VERDICT_PICTURE_OFF)) verdict->conclusion = BP_DISAGREE;
}

uint64_t bp_verdict_samples_needed(const BpVerdict *verdict, uint64_t samples) {
    if (!isfinite(verdict->shown_within)) return 0;
    /* Intervals shrink with the root of the number of samples. Three times as many leave room for chance. */
    const double needed = 3 * (double)samples * pow(fmax(1, verdict->shown_within / verdict->margin), 2);
    uint64_t power = 1;
    while ((double)power < needed && power < (uint64_t)1 << 62) power *= 2;
    return power;
}

double bp_verdict_pixel_z(const BpPixelSums *kernel, const BpPixelSums *reference) {
    double k, r, variance_k, variance_r;
    pixel_mean(kernel, BP_SUMS_LUMINANCE, 1, &k, &variance_k);
    pixel_mean(reference, BP_SUMS_LUMINANCE, 1, &r, &variance_r);
    const double variance = variance_k + variance_r, rest = fmax(0, fabs(k - r) - rounding(r, 1));
    if (rest <= 0) return 0;
    return copysign(variance > 0 ? fmin(rest / sqrt(variance), z_without_noise) : z_without_noise, k - r);
}
