/* color_range.c: see color_range.h. */
#include "color_range.h"

#include "base/color.h"
#include "base/message_text.h"

#include <inttypes.h>
#include <limits.h>

#define BYTE 255.0
#define WORD 65535.0
/* Shares that rounding put above 1. */
#define SHARE_MAX 1.00001
#define BYTES_MIN 2.0

const char *const bp_color_channels[3] = {"red", "green", "blue"};

bool color_range_take(ColorRange *range, const double color[3], uint64_t point, uint64_t line, int *channel) {
    const double most = range->bytes ? BYTE : WORD;
    for (int c = 0; c < 3; c++) {
        *channel = c;
        if (!(color[c] >= 0 && color[c] <= most)) return false;
        if (color[c] <= range->largest) continue;
        range->largest = color[c];
        range->point = point;
        range->line = line;
        range->channel = c;
    }
    return true;
}

const char *color_range_expected(const ColorRange *range) {
    return range->bytes ? "a byte of a colour, from 0 to 255"
                        : "a colour: a share of light from 0 to 1, a byte (0 to 255) or 16 bits (0 to 65535)";
}

double color_range_scale(const ColorRange *range) {
    if (range->bytes) return BYTE;
    if (range->largest <= SHARE_MAX) return 1;
    if (range->largest < BYTES_MIN) return 0;
    return range->largest <= BYTE ? BYTE : WORD;
}

BpStatus color_range_fail(const ColorRange *range, const char *what, const char *name, BpError *err) {
    char text[BP_NUMBER_TEXT_SIZE];
    const BpStatus status =
        bp_fail(err, BP_ERR_SCENE,
                "%s %" PRIu64 " (from 0): %s: found %s as the largest number of all colours, expected linear "
                "shares of light from 0 to 1, or bytes from 0 to 255",
                what, range->point, bp_color_channels[range->channel], bp_number_text(range->largest, text));
    bp_error_at(err, name, range->line < INT_MAX ? (int)range->line : INT_MAX, 0);
    return status;
}

const char *color_range_note(const ColorRange *range) {
    const double scale = color_range_scale(range);
    if (range->bytes || (scale == 1 && !range->ambiguous)) return NULL;
    return scale == 1      ? "colours read as linear shares from 0 to 1"
           : scale == BYTE ? "colours read as bytes (sRGB)"
                           : "colours read as 16 bits (sRGB)";
}

static float linear_of(double value, double scale, const double linear[256]) {
    if (scale == 1) return value < 1 ? (float)value : 1.0f;
    if (scale == BYTE && value == floor(value)) return (float)linear[(int)value];
    return (float)bp_linear_from_srgb(value / scale);
}

void color_range_make_linear(double scale, float (*color)[3], size_t count) {
    double linear[256];
    bp_linear_of_bytes(linear);
    for (size_t i = 0; i < count; i++)
        for (int c = 0; c < 3 && !isnan(color[i][0]); c++)
            color[i][c] = linear_of((double)color[i][c], scale, linear);
}
