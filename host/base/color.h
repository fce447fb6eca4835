/* color.h: luminance and transfer function of Rec. 709 and sRGB colours.
 *
 * Knows: published constants.   Does not know: pictures. */
#ifndef BP_BASE_COLOR_H
#define BP_BASE_COLOR_H

#include <math.h>

/* Luminance of linear red, green, blue (Rec. ITU-R BT.709-6, item 3.2). */
static const double bp_luminance_weights[3] = {0.2126, 0.7152, 0.0722};

static inline double bp_luminance(const float rgb[3]) {
    double sum = 0;
    for (int c = 0; c < 3; c++) sum += bp_luminance_weights[c] * (double)rgb[c];
    return sum;
}

/* The same in double. */
static inline double bp_luminance_of(const double rgb[3]) {
    double sum = 0;
    for (int c = 0; c < 3; c++) sum += bp_luminance_weights[c] * rgb[c];
    return sum;
}

/* The sRGB transfer function and its inverse (IEC 61966-2-1:1999). */
static inline double bp_srgb_from_linear(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * pow(linear, 1 / 2.4) - 0.055;
}

static inline double bp_linear_from_srgb(double encoded) {
    return encoded <= 0.04045 ? encoded / 12.92 : pow((encoded + 0.055) / 1.055, 2.4);
}

/* A table of the linear value of each byte, for converting millions of 8-bit colours. */
static inline void bp_linear_of_bytes(double linear[256]) {
    for (int b = 0; b < 256; b++) linear[b] = bp_linear_from_srgb(b / 255.0);
}

#endif
