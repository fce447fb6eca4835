/* color_range.h: what the numbers mean that a file gives as colours.
 *
 * In:    red, green and blue as a file has them, of all its points.   Out: linear shares of light.
 * Knows: the ranges that programs write: shares from 0 to 1, bytes, and 16 bits.   Does not know: which
 * formats there are.
 *
 * One rule holds for all formats. Bytes are what the type says (uchar of PLY), or else the largest number of
 * the file decides: up to 1, they are linear shares; up to 255, they are 8-bit sRGB; up to 65535, 16-bit
 * sRGB. A largest number between 1 and 2 would be nearly black as a byte and too bright as a share, and is
 * refused. */
#ifndef BP_PARTICLES_COLOR_RANGE_H
#define BP_PARTICLES_COLOR_RANGE_H

#include "base/status.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Begins as zero. */
typedef struct ColorRange {
    bool bytes;     /* the type says so */
    bool ambiguous; /* the type tells nothing: color_range_note() always has a note */
    double largest;
    uint64_t point, line; /* where that stands; line 0: the file has none */
    int channel;
} ColorRange;

extern const char *const bp_color_channels[3];

/* Takes a point's colour. False if one of its numbers can be no colour at all: *channel says which. */
bool color_range_take(ColorRange *range, const double color[3], uint64_t point, uint64_t line, int *channel);
/* A description of what color_range_take() expected. */
const char *color_range_expected(const ColorRange *range);
/* The number that stands for all light: 1, 255 or 65535; 0 where the largest number cannot be told. */
double color_range_scale(const ColorRange *range);
/* Fails because it is unknown which number stands for all light. `what`: what a point is called; `name`: the
 * file. */
BpStatus color_range_fail(const ColorRange *range, const char *what, const char *name, BpError *err);
/* What was assumed, as text; NULL where the type left no choice. */
const char *color_range_note(const ColorRange *range);
/* Makes numbers of that scale linear shares from 0 to 1, in place. Colours whose red is NaN are none. */
void color_range_make_linear(double scale, float (*color)[3], size_t count);

#endif
