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

static void print_verdict(FILE *out, const BpVerdict *v) {
    static const char *channels[3] = {"red", "green", "blue"};
    fprintf(out, "%s (a right kernel is rejected with probability %g at most)\n",
            v->agree ? "agree" : "DISAGREE", v->level);
    for (int f = 0; f < BP_FAMILIES; ++f) {
        const BpVerdictTest *test = &v->worst[f];
        fprintf(out, "  %-17s largest |z| %8.2f of %.2f allowed%s: %s",
                bp_verdict_family_name((BpVerdictFamily)f), test->z, test->limit,
                test->z > test->limit ? ", EXCEEDED" : "", channels[test->channel]);
        if (f == BP_FAMILY_BLOCKS || f == BP_FAMILY_BLOCKS_SQUARES)
            fprintf(out, ", block (%u, %u) of %u x %u", test->column, test->row, v->block_columns,
                    v->block_rows);
        fprintf(out, ", %.6g against %.6g%s\n", test->kernel, test->reference,
                test->counted ? " (too few lit samples for means: numbers compared)" : "");
    }
    if (isnan(v->ratio_low))
        fprintf(out, "  brightness        no ratio: the picture is black or its noise too large\n");
    else
        fprintf(
            out,
            "  brightness        kernel / reference %.6f, 95 %% interval %.6f to %.6f: %s within %.1f %%\n",
            v->ratio, v->ratio_low, v->ratio_high, v->equivalent ? "shown equal" : "NOT shown equal",
            100 * BP_VERDICT_MARGIN);
    if (!isnan(v->smallest_bias))
        fprintf(out, "  power             a bias of %.3f %% would have been found with probability %.2g\n",
                100 * v->smallest_bias, BP_VERDICT_POWER);
    fprintf(out, "  sums              the picture is within %.1g of its samples' means, %.1g allowed%s\n",
            v->picture_off, BP_VERDICT_PICTURE_OFF,
            v->picture_off <= BP_VERDICT_PICTURE_OFF ? "" : ", EXCEEDED");
    fprintf(out, "  invalid samples   %llu of the kernel, %llu of the reference; %llu samples in all\n",
            (unsigned long long)v->invalid_kernel, (unsigned long long)v->invalid_reference,
            (unsigned long long)v->samples);
    fprintf(out, "  path length       %.4f and %.4f segments\n", v->segments_kernel, v->segments_reference);
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
