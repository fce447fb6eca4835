/* dump_kernels.c: writes the assembled kernel source of every kind of program into a folder.
 *
 * In:    a folder.   Out: one .cl file a variant; its name ends in _fp64.cl where the program needs double.
 * Knows: program.h.  Does not know: any device; what checks the files (test_kernels_syntax.py).
 *
 * All combinations of all choices would be 256 * 256 programs. Written are: every combination of the other
 * choices with every effect, and every set of effects, with a list and with a tree, with one of those
 * combinations, a different one in turn: so each set of effects and each combination is there. */
#include "opencl/program.h"
#include "packed/effects.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { COMBINATIONS = 4 * 2 * 2 * 2 * 2 * 2 * 2 };

/* Combination number `c` in mixed radix; effects are left 0. */
static BpProgramOptions combination(unsigned c) {
    static const uint32_t widths[4] = {2, 4, 8, 16};
    BpProgramOptions options = {0};
    options.tree_width = widths[c % 4];
    c /= 4;
    options.precision = c & 1 ? BP_PRECISION_DOUBLE : BP_PRECISION_SINGLE;
    options.math = c & 2 ? BP_MATH_FAST : BP_MATH_STRICT;
    options.numerics = c & 4 ? BP_NUMERICS_PLAIN : BP_NUMERICS_ROBUST;
    options.sampler = c & 8 ? BP_SAMPLER_SOBOL : BP_SAMPLER_INDEPENDENT;
    options.form = c & 16 ? BP_KERNEL_PACKET : BP_KERNEL_SAMPLE;
    options.double_refine = (c & 32) != 0;
    /* No combinations of their own: they go with no other choice, and half of all have each. */
    options.pixel_list = (c & 1) != ((c >> 3 & 1) != (c >> 4 & 1));
    options.tree = (c >> 2 & 1) != (c >> 5 & 1);
    options.packet_lanes = (c >> 1 & 1) != (c >> 5 & 1) ? 16 : 8;
    return options;
}

static BpStatus dump(const char *folder, const BpProgramOptions *options, BpError *err) {
    const bool needs_double = options->precision == BP_PRECISION_DOUBLE || options->double_refine;
    char *source = NULL;
    char path[4096];
    FILE *file = NULL;
    BpStatus status = BP_OK;
    snprintf(path, sizeof path, "%s/e%02x_t%d_w%u_l%u_p%d_m%d_n%d_s%d_k%d_r%d%s.cl", folder,
             (unsigned)options->effects, (int)options->tree, (unsigned)options->tree_width,
             (unsigned)options->packet_lanes, (int)options->precision, (int)options->math,
             (int)options->numerics, (int)options->sampler, (int)options->form, (int)options->double_refine,
             needs_double ? "_fp64" : "");
    BP_TRY_GOTO(status,
                bp_program_source(options, "entry/aovs.cl", bp_kernel_file("entry/aovs.cl"), &source, err),
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
    BpError err = {0};
    BpStatus status = BP_OK;
    if (argc != 2) return fprintf(stderr, "usage: dump_kernels FOLDER\n"), 2;
    for (unsigned c = 0; status == BP_OK && c < COMBINATIONS; ++c) {
        BpProgramOptions options = combination(c);
        options.effects = BP_EFFECTS_ALL;
        status = dump(argv[1], &options, &err);
    }
    for (uint32_t set = 0; status == BP_OK && set < 2 * BP_EFFECTS_ALL; ++set) {
        /* 35 and 256 have no common divisor: neighbours differ in most choices, and all of them turn up. */
        BpProgramOptions options = combination(set * 35u % COMBINATIONS);
        options.effects = set / 2;
        options.tree = set % 2 == 1;
        status = dump(argv[1], &options, &err);
    }
    if (status != BP_OK) fprintf(stderr, "dump_kernels: %s\n", err.message);
    bp_error_clear(&err);
    return status == BP_OK ? 0 : 1;
}
