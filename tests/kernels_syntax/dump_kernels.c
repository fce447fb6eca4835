/* dump_kernels.c: writes the assembled kernel source of every kind of program into a folder.
 *
 * In:    a folder.   Out: one .cl file a variant; its name ends in _fp64.cl where the program needs double.
 * Knows: program.h.  Does not know: any device; what checks the files (test_kernels_syntax.py).
 *
 * All combinations of choices and effects are billions. Written are: with every effect, a covering
 * array of the other choices, so that any three of them come together in some program; and of the sets of
 * effects, with a list and with a tree, a covering array too, and every set that has or lacks one effect at
 * most. These have the other choices of one program of the first kind each, in turn. Programs for triangles
 * alone have every effect that these may have, and all the other choices; they begin with t, all others with
 * e. */
#include "opencl/program.h"
#include "packed/effects.h"
#include "support/covering.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CHOICES = 14, SETS = COVERING_CASES_MAX + 4 * (BP_EFFECT_COUNT + 1) };

static const CoveringRules none = {NULL, 0};

/* Each bit of `c` is a choice; effects are left 0. */
static BpProgramOptions combination(uint32_t c) {
    BpProgramOptions options = {0};
    options.tree_width = 2u << (c & 3u);
    options.precision = c & 4u ? BP_PRECISION_DOUBLE : BP_PRECISION_SINGLE;
    options.math = c & 8u ? BP_MATH_FAST : BP_MATH_STRICT;
    options.numerics = c & 16u ? BP_NUMERICS_PLAIN : BP_NUMERICS_ROBUST;
    options.sampler = c & 32u ? BP_SAMPLER_SOBOL : BP_SAMPLER_INDEPENDENT;
    options.form = c & 64u ? BP_KERNEL_PACKET : c & 4096u ? BP_KERNEL_POOL : BP_KERNEL_SAMPLE;
    options.double_refine = (c & 128u) != 0;
    options.pixel_list = (c & 256u) != 0;
    options.tree = (c & 512u) != 0;
    options.packet_lanes = c & 1024u ? 16 : 8;
    options.own_rounding = (c & 2048u) != 0;
    options.parts = c & 8192u ? 3 : 0;
    options.part_length = 8192;
    return options;
}

/* Effects, and above them the tree: a covering array, and the sets that have or lack one effect at most. */
static size_t list_sets(uint32_t sets[SETS]) {
    size_t count = covering(BP_EFFECT_COUNT + 1, none, sets, 0);
    for (uint32_t tree = 0; tree < 2; ++tree)
        for (int e = -1; e < BP_EFFECT_COUNT; ++e) {
            const uint32_t one = (e >= 0 ? 1u << e : 0) | tree << BP_EFFECT_COUNT;
            const uint32_t both[2] = {one, one ^ BP_EFFECTS_ALL};
            for (int b = 0; b < 2; ++b) {
                size_t i = 0;
                while (i < count && sets[i] != both[b]) ++i;
                if (i == count) sets[count++] = both[b];
            }
        }
    return count;
}

static BpStatus dump(const char *folder, BpProgramOptions options, BpError *err) {
    const bool needs_double = options.precision == BP_PRECISION_DOUBLE || options.double_refine;
    char *source = NULL;
    char path[4096];
    FILE *file = NULL;
    BpStatus status = BP_OK;
    snprintf(path, sizeof path, "%s/%c%02x_t%d_w%u_l%u_p%d_m%d_n%d_s%d_k%d_r%d_x%d_o%d_a%u%s.cl", folder,
             options.triangles_alone ? 't' : 'e', (unsigned)options.effects, (int)options.tree,
             (unsigned)options.tree_width, (unsigned)options.packet_lanes, (int)options.precision,
             (int)options.math, (int)options.numerics, (int)options.sampler, (int)options.form,
             (int)options.double_refine, (int)options.pixel_list, (int)options.own_rounding,
             (unsigned)options.parts, needs_double ? "_fp64" : "");
    options.focuser_pairs = options.effects % 2 == 1; /* half of the sets, as test_effects_source knows */
    BP_TRY_GOTO(status,
                bp_program_source(&options, "entry/aovs.cl", bp_kernel_file("entry/aovs.cl"), &source, err),
                done);
    file = fopen(path, "w");
    if (file == NULL || fputs(source, file) < 0)
        status = bp_fail(err, BP_ERR_FILE, "cannot write '%s'", path);

done:
    if (file != NULL && fclose(file) != 0 && status == BP_OK)
        status = bp_fail(err, BP_ERR_FILE, "cannot write '%s'", path);
    free(source);
    return status;
}

int main(int argc, char **argv) {
    static uint32_t combinations[COVERING_CASES_MAX], sets[SETS];
    BpError err = {0};
    BpStatus status = BP_OK;
    if (argc != 2) return fprintf(stderr, "usage: dump_kernels FOLDER\n"), 2;
    const size_t count = covering(CHOICES, none, combinations, 0), set_count = list_sets(sets);
    for (size_t c = 0; status == BP_OK && c < count; ++c) {
        BpProgramOptions options = combination(combinations[c]);
        options.effects = BP_EFFECTS_ALL;
        status = dump(argv[1], options, &err);
    }
    for (size_t i = 0; status == BP_OK && i < set_count; ++i) {
        BpProgramOptions options = combination(combinations[i % count]);
        options.effects = sets[i] & BP_EFFECTS_ALL;
        options.tree = sets[i] >> BP_EFFECT_COUNT != 0;
        status = dump(argv[1], options, &err);
    }
    for (size_t c = 0; status == BP_OK && c < count; ++c) {
        BpProgramOptions options = combination(combinations[c]);
        options.effects =
            BP_EFFECTS_ALL & ~(1u << BP_EFFECT_LAMPS | 1u << BP_EFFECT_MEDIA | 1u << BP_EFFECT_CAPSULES);
        options.triangles_alone = true;
        status = dump(argv[1], options, &err);
        /* Or rays are sent to triangles, and to nothing else. */
        options.effects =
            BP_EFFECTS_ALL & ~(1u << BP_EFFECT_MEDIA | 1u << BP_EFFECT_DISCS | 1u << BP_EFFECT_ENVIRONMENT |
                               1u << BP_EFFECT_CAUSTICS | 1u << BP_EFFECT_CAPSULES);
        if (status == BP_OK) status = dump(argv[1], options, &err);
    }
    if (status != BP_OK) fprintf(stderr, "dump_kernels: %s\n", err.message);
    bp_error_clear(&err);
    return status == BP_OK ? 0 : 1;
}
