/* study.h: studies the cost of accuracy on one scene and device: configurations, their errors and times,
 * advice.
 *
 * In:    a scene, the options that a render of it would have, a device, a time budget.
 * Out:   BpStudyResult; as a table, JSON, CSV or a page.
 * Knows: the render loop, the reference tracer, the options of `ballpark render` for its advice.
 * Does not know: how options are read.
 *
 * The truth is the scene with exact Fresnel and depth 1000, in double with strict arithmetic; for a device
 * without double, the reference tracer's. It is rendered twice with seeds of their own, r1 and r2, and the
 * mean squared error of a picture x is the mean of (x - r1)(x - r2): free of the references' noise.
 *
 * Every configuration is rendered at the same sample counts, taking turns. The effect of a configuration is
 * measured by paired differences: the same seed gives the same random numbers, whatever the precision, depth
 * or Fresnel, so most noise cancels. */
#ifndef BP_STUDY_STUDY_H
#define BP_STUDY_STUDY_H

#include "render/render.h"

#include <jansson.h>
#include <stdio.h>

#define BP_STUDY_WIDTH_DEFAULT 240u
#define BP_STUDY_SECONDS_DEFAULT 60.0
#define BP_STUDY_DEPTH 1000u /* of the truth */
#define BP_STUDY_CONFIGURATIONS_MAX 26
#define BP_STUDY_LEVELS_MIN 2 /* sample counts; without two there is nothing to compare */
#define BP_STUDY_LEVELS_MAX 10
#define BP_STUDY_TARGETS 3

typedef enum BpStudyFresnel {
    BP_STUDY_FRESNEL_SCENE,
    BP_STUDY_FRESNEL_SCHLICK,
    BP_STUDY_FRESNEL_EXACT
} BpStudyFresnel;

/* One way to configure a render. */
typedef struct BpStudyConfiguration {
    const char *axis;  /* "base", "truth", "sampler", "depth", ...; static */
    const char *name;  /* "depth 10"; static */
    char command[128]; /* options of `ballpark render` that select it; "": none are needed */
    BpRenderOptions options;
    BpStudyFresnel fresnel; /* SCENE: as in the scene; else a change of the scene */
} BpStudyConfiguration;

/* A mean and its 95 % interval; NaN: unknown. */
typedef struct BpStudyEstimate {
    double value, low, high;
} BpStudyEstimate;

/* A crop of the picture and its error map (image/error_map.h): 8-bit RGB, `size` bytes of PNG each; owned. */
typedef struct BpStudyPng {
    char *bytes;
    size_t size;
} BpStudyPng;
typedef struct BpStudyCrop {
    BpStudyPng picture, map;
} BpStudyCrop;

/* One configuration at one sample count. Errors are relative to the brightness of the truth. */
typedef struct BpStudyPoint {
    uint64_t samples; /* a pixel */
    /* wall: as lived through; device: kernels by the device's clock; cpu: of all threads of this process.
     * seconds: wall, or on a CPU device cpu / cores if that is less; without disturbances of single rounds
     * (timing.h), so that other load on the machine changes little. */
    double seconds, wall_seconds, device_seconds, cpu_seconds;
    double claimed;        /* NRMSE estimated from the replicates: noise alone */
    double mse, mse_error; /* against the truth, noise and bias; its standard error. It may be negative. */
    double nrmse;          /* its root; NaN where the references are too noisy */
    double
        rel_mse; /* mean of (x - r1)(x - r2) / (r + 0.01)^2 over pixels and channels (pbrt's relative MSE) */
    bool front;  /* no other point is both faster and better */
    BpStudyCrop crop;
} BpStudyPoint;

typedef struct BpStudySeries {
    BpStudyConfiguration configuration;
    BpStudyPoint points[BP_STUDY_LEVELS_MAX];
    size_t count;
    double seconds_per_sample;     /* of one pixel, from the largest count */
    BpStudyEstimate time_ratio;    /* seconds over the base's, from the rounds of the largest count; or NaN */
    BpStudyEstimate bias;          /* of brightness against the truth */
    BpStudyEstimate bias_square;   /* mean squared systematic error of a pixel against the truth */
    BpStudyEstimate change;        /* of brightness against the base */
    BpStudyEstimate change_square; /* mean squared systematic change of a pixel against the base */
    double fit_floor, fit_slope;   /* MSE(N) = floor + slope / N, see bp_study_fit(); NaN: too few counts */
    double efficiency;             /* 1 / (noise^2 x seconds) at the largest count, relative to the base */
} BpStudySeries;

/* The configuration to use for an error. */
typedef struct BpStudyAdvice {
    double target; /* NRMSE */
    bool reachable;
    size_t series;
    double samples;    /* a pixel */
    double seconds;    /* of tracing a picture of the scene's own size, estimated */
    bool extrapolated; /* fewer or more samples than any measured */
} BpStudyAdvice;

typedef struct BpStudyResult {
    const BpScene *scene;             /* of the study's size */
    uint32_t full_width, full_height; /* of the picture that the advice is about */
    BpRenderReport report;            /* of the base; its build log is not valid */
    bool reference_is_kernel;
    uint64_t reference_samples; /* a pixel, of each */
    double reference_error;     /* NRMSE of their mean */
    double brightness;          /* mean luminance of the truth */
    double budget, seconds;
    bool cut_short;                                    /* ended by bp_study_stop() */
    BpStudySeries series[BP_STUDY_CONFIGURATIONS_MAX]; /* 0: the base; 1: the truth where there is double */
    size_t count;
    BpStudyCrop truth;
    uint32_t crop_width, crop_height;
    BpStudyAdvice advice[BP_STUDY_TARGETS];
} BpStudyResult;

/* A study is created and run by functions of ballpark.h. Its result, once it has finished; owned by `study`.
 */
const BpStudyResult *bp_study_result(const BpStudy *study);
bool bp_study_has_finished(const BpStudy *study);

/* ---- results ---- */

const char *bp_study_fresnel_name(BpStudyFresnel fresnel);
/* The relative uncertainty of a ratio of two times: half the widest 95 % interval of time_ratio. NaN where
 * none is known. */
double bp_study_time_scatter(const BpStudyResult *result);
/* Why a study was too short to rely on its advice, with a remedy; "" if it was long enough. Returns `text`.
 */
const char *bp_study_shortness_text(const BpStudyResult *result, char *text, size_t size);
/* One line without a newline: the configuration for this error and its time. */
const char *bp_study_advice_text(const BpStudyResult *result, const BpStudyAdvice *advice, char *text,
                                 size_t size);
/* The table as text, with the marks of base/wrap.h; CSV; the page. False if the stream failed or memory ran
 * out; see errno. */
bool bp_study_print(const BpStudyResult *result, FILE *out);
bool bp_study_print_csv(const BpStudyResult *result, FILE *out);
bool bp_study_print_page(const BpStudyResult *result, FILE *out);
/* The JSON document; NULL when memory ran out. */
json_t *bp_study_json(const BpStudyResult *result);

#endif
