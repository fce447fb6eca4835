/* verdict_text.c: a verdict for people; see verdict.h. */
#include "verdict.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

const char *bp_verdict_family_name(BpVerdictFamily family) {
    switch (family) {
    case BP_FAMILY_PICTURE:
        return "picture";
    case BP_FAMILY_BLOCKS:
        return "blocks";
    case BP_FAMILY_PICTURE_SQUARES:
        return "picture, squares";
    case BP_FAMILY_BLOCKS_SQUARES:
        return "blocks, squares";
    case BP_FAMILIES:
        break;
    }
    return "";
}

const char *bp_conclusion_name(BpConclusion conclusion) {
    return conclusion == BP_AGREE ? "agree" : conclusion == BP_DISAGREE ? "disagree" : "inconclusive";
}

static void print_brightness(FILE *out, const BpVerdict *v) {
    if (isnan(v->ratio_low))
        fprintf(out, "  brightness        no ratio: the picture is black or too noisy\n");
    else
        fprintf(out, "  brightness        kernel / reference %.6f, 95 %% interval %.6f to %.6f\n", v->ratio,
                v->ratio_low, v->ratio_high);
    const char *asked = v->shown_within <= v->margin ? "" : ", NOT ENOUGH";
    if (isfinite(v->shown_within))
        fprintf(out, "  evidence          every channel is equally bright within %.3g %%, %.3g %% needed%s\n",
                100 * v->shown_within, 100 * v->margin, asked);
    else
        fprintf(out, "  evidence          none that every channel is equally bright within %.3g %%%s\n",
                100 * v->margin, asked);
}

static void print_verdict(FILE *out, const BpVerdict *v) {
    static const char *channels[3] = {"red", "green", "blue"};
    fprintf(out, "%s (at most 1 false alarm in %.0f)\n",
            v->conclusion == BP_AGREE      ? "agree"
            : v->conclusion == BP_DISAGREE ? "DISAGREE"
                                           : "INCONCLUSIVE",
            1 / v->level);
    for (int f = 0; f < BP_FAMILIES; ++f) {
        const BpVerdictTest *test = &v->worst[f];
        if (test->tests == 0) continue;
        fprintf(out, "  %-17s |z| %.2f of %.2f allowed%s: %s, kernel %.4g, reference %.4g",
                bp_verdict_family_name((BpVerdictFamily)f), test->z, test->limit,
                test->z > test->limit ? ", EXCEEDED" : "", channels[test->channel], test->kernel,
                test->reference);
        if (f == BP_FAMILY_BLOCKS || f == BP_FAMILY_BLOCKS_SQUARES)
            fprintf(out, ", block %u,%u", test->column, test->row);
        fputs(test->counted
                  ? v->means_only
                        ? "\n                    (too few lit samples to compare anything)\n"
                        : "\n                    (too few lit samples to compare means: counts compared)\n"
                  : "\n",
              out);
    }
    print_brightness(out, v);
    if (!isnan(v->smallest_bias))
        fprintf(out, "  power             would detect a bias of %.3f %% with probability %.2g\n",
                100 * v->smallest_bias, BP_VERDICT_POWER);
    fprintf(out, "  sums              the picture differs by %.1g from its samples' means, %.1g allowed%s\n",
            v->picture_off, BP_VERDICT_PICTURE_OFF,
            v->picture_off <= BP_VERDICT_PICTURE_OFF ? "" : ", EXCEEDED");
    fprintf(out, "  invalid samples   %llu in the kernel, %llu in the reference, of %llu samples\n",
            (unsigned long long)v->invalid_kernel, (unsigned long long)v->invalid_reference,
            (unsigned long long)v->samples);
    fprintf(out, "  path length       kernel %.4f, reference %.4f segments\n", v->segments_kernel,
            v->segments_reference);
}

char *bp_verdict_text(const BpVerdict *verdict) {
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    if (out == NULL) return NULL;
    print_verdict(out, verdict);
    if (fclose(out) != 0) {
        free(text);
        return NULL;
    }
    return text;
}
