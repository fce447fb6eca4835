/* effects_equality.c: for every set of effects that can occur, the specialised kernel's picture is the
 * general one's.
 *
 * On PoCL, bit for bit: sums, counts, segments. Other implementations may round differently in different
 * programs; there the difference is reported, and the pictures must agree within their error.
 *
 * effects_equality FORM [PART OF]: FORM is sample, packet, or one of two halves of both: mixed (packet for
 * sets with an even number of effects, sample for odd) and other (the other way round). PART of OF shares,
 * which can run side by side if each has a kernel cache of its own. */
#include "effects_scenes.h"
#include "engine/render.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct Result {
    int64_t *sums;
    uint32_t *counts;
    size_t values; /* of sums; counts has a third */
    uint64_t segments, cut, invalid;
    uint64_t key;
    double mean[3], nrmse;
} Result;

static bool failed(const BpError *err, const char *what, uint32_t bits) {
    fprintf(stderr, "set 0x%02x, %s: %s\n%s\n", (unsigned)bits, what, err->message,
            err->attachment != NULL ? err->attachment : "");
    return false;
}

static bool render(const BpScene *scene, const BpDeviceInfo *device, const BpRenderOptions *options,
                   uint32_t bits, Result *result) {
    BpRender *made = NULL;
    BpError err = {0};
    BpProgress progress = {0};
    const BpAccumulator *accumulator = NULL;
    BpRenderReport report;
    bool right = false;
    if (bp_render_create(scene, options, device, 1, &made, &err) != BP_OK)
        return failed(&err, "create", bits);
    do {
        if (bp_render_step(made, &progress, &err) != BP_OK) {
            failed(&err, "step", bits);
            goto done;
        }
    } while (!progress.finished);
    if (bp_render_accumulator(made, &accumulator, &err) != BP_OK) {
        failed(&err, "read", bits);
        goto done;
    }
    bp_render_report(made, &report);
    result->values = (size_t)accumulator->width * accumulator->height * accumulator->replicates * 3;
    result->sums = malloc(result->values * sizeof *result->sums);
    result->counts = malloc(result->values / 3 * sizeof *result->counts);
    if (result->sums == NULL || result->counts == NULL) goto done;
    memcpy(result->sums, accumulator->sums, result->values * sizeof *result->sums);
    memcpy(result->counts, accumulator->counts, result->values / 3 * sizeof *result->counts);
    result->segments = accumulator->segments;
    result->cut = accumulator->cut_paths;
    result->invalid = accumulator->invalid_samples;
    result->key = report.program_key;
    result->nrmse = bp_accumulator_nrmse(accumulator);
    bp_accumulator_mean(accumulator, result->mean);
    right = true;

done:
    bp_render_destroy(&made);
    bp_error_clear(&err);
    return right;
}

static void result_clear(Result *result) {
    free(result->sums);
    free(result->counts);
    memset(result, 0, sizeof *result);
}

/* Values that differ, of sums and counts; the totals count as one each. */
static size_t differences(const Result *a, const Result *b) {
    size_t count = (size_t)(a->segments != b->segments) + (size_t)(a->cut != b->cut) +
                   (size_t)(a->invalid != b->invalid);
    if (a->values != b->values) return a->values;
    for (size_t i = 0; i < a->values; ++i) count += a->sums[i] != b->sums[i];
    for (size_t i = 0; i < a->values / 3; ++i) count += a->counts[i] != b->counts[i];
    return count;
}

/* Whether the means agree within `sigmas` of their joint error, each channel. */
static bool agree(const Result *a, const Result *b) {
    for (int c = 0; c < 3; ++c) {
        const double pixels =
            (double)a->values / 12; /* the mean of a picture is that much surer than a pixel */
        const double error = fmax(a->nrmse, b->nrmse) * fmax(a->mean[c], b->mean[c]) / sqrt(pixels);
        if (fabs(a->mean[c] - b->mean[c]) > 5 * error + 1e-5 * fabs(a->mean[c])) return false;
    }
    return true;
}

static void print_set(uint32_t bits) {
    for (int e = 0; e < BP_EFFECT_COUNT; ++e)
        if (bp_effects_has(bits, (BpEffect)e)) fprintf(stderr, " %s", bp_effect_name((BpEffect)e));
    fprintf(stderr, "\n");
}

/* True when set `bits` is all right. *dark counts pictures without light, which would prove nothing. */
static bool check_set(const BpDeviceInfo *device, BpKernelForm form, bool exact, uint32_t bits,
                      unsigned *dark, unsigned *inexact) {
    static EffectsScene made;
    BpEffects effects;
    BpError err = {0};
    BpRenderOptions options;
    Result special = {0}, general = {0};
    bool right = false;
    effects_scene(&made, bits);
    if (bp_scene_validate(&made.scene, &err) != BP_OK) return failed(&err, "scene", bits);
    bp_effects_analyse(&made.scene, &effects);
    if (effects.bits != bits) {
        fprintf(stderr, "set 0x%02x: the scene made for it calls for 0x%02x\n", (unsigned)bits,
                (unsigned)effects.bits);
        return false;
    }
    bp_render_defaults(&made.scene, &options);
    options.kernel = form;
    options.seed = 20 + bits;
    options.sampler = (bits ^ bits >> 3) & 1 ? BP_SAMPLER_SOBOL : BP_SAMPLER_INDEPENDENT;
    if (!render(&made.scene, device, &options, bits, &special)) goto done;
    options.all_effects = true;
    if (!render(&made.scene, device, &options, bits, &general)) goto done;
    if ((special.key == general.key) != (bits == BP_EFFECTS_ALL)) {
        fprintf(stderr, "set 0x%02x: specialised and general kernel are the same program\n", (unsigned)bits);
        goto done;
    }
    if (special.mean[0] + special.mean[1] + special.mean[2] <= 0) ++*dark;
    const size_t different = differences(&special, &general);
    if (different > 0) {
        ++*inexact;
        fprintf(stderr,
                "set 0x%02x: %zu of %zu numbers differ (segments %llu and %llu; means %.9g and %.9g):",
                (unsigned)bits, different, special.values, (unsigned long long)special.segments,
                (unsigned long long)general.segments, special.mean[1], general.mean[1]);
        print_set(bits);
    }
    right =
        special.invalid == 0 && general.invalid == 0 && (exact ? different == 0 : agree(&special, &general));

done:
    result_clear(&special);
    result_clear(&general);
    bp_error_clear(&err);
    return right;
}

/* The kernel form for a set, by FORM; false for a word that is none. */
static bool choose_form(const char *word, uint32_t bits, BpKernelForm *form) {
    bool odd = false;
    for (int e = 0; e < BP_EFFECT_COUNT; ++e) odd ^= bp_effects_has(bits, (BpEffect)e);
    if (strcmp(word, "sample") == 0)
        *form = BP_KERNEL_SAMPLE;
    else if (strcmp(word, "packet") == 0)
        *form = BP_KERNEL_PACKET;
    else if (strcmp(word, "mixed") == 0)
        *form = odd ? BP_KERNEL_SAMPLE : BP_KERNEL_PACKET;
    else if (strcmp(word, "other") == 0)
        *form = odd ? BP_KERNEL_PACKET : BP_KERNEL_SAMPLE;
    else
        return false;
    return true;
}

int main(int argc, char **argv) {
    BpDeviceInfo device;
    BpError err = {0};
    const unsigned part = argc > 3 ? (unsigned)atoi(argv[2]) : 0, of = argc > 3 ? (unsigned)atoi(argv[3]) : 1;
    BpKernelForm form;
    if (argc < 2 || !choose_form(argv[1], 0, &form) || of == 0 || part >= of) {
        fprintf(stderr, "usage: effects_equality sample|packet|mixed|other [PART OF]\n");
        return 2;
    }
    if (bp_device_find(getenv("BALLPARK_TEST_DEVICE"), &device, &err) != BP_OK) {
        fprintf(stderr, "skipped: %s\n", err.message);
        return 77;
    }
    const bool exact = strcmp(device.platform, "Portable Computing Language") == 0;
    unsigned sets = 0, wrong = 0, dark = 0, inexact = 0;
    for (uint32_t bits = 0; bits <= BP_EFFECTS_ALL; ++bits) {
        if (bits % of != part || !effects_can_occur(bits)) continue;
        ++sets;
        choose_form(argv[1], bits, &form);
        if (!check_set(&device, form, exact, bits, &dark, &inexact)) ++wrong;
    }
    printf("%s, %s: %u sets, %u wrong, %u not bit for bit, %u without light\n", device.name, argv[1], sets,
           wrong, inexact, dark);
    return sets > 0 && wrong == 0 && dark == 0 ? 0 : 1;
}
