/* colormap.c: see colormap.h.
 *
 * viridis and plasma: N. Smith and S. van der Walt 2015, dedicated to the public domain (CC0). cividis: J.
 * Nunez, C. Anderton and R. Renslow 2018 (PLoS ONE 13(7), e0199239), CC0. Of each every 16th colour is
 * tabulated; between them the 8-bit values are interpolated, which is within 3 % of the whole table.
 * coolwarm is computed: K. Moreland, "Diverging Color Maps for Scientific Visualization", 2009. */
#include "colormap.h"

#include "base/color.h"

#include <math.h>

enum { STOPS = 33 };

const char *const bp_colormap_names[BP_MAP_COUNT] = {"viridis", "plasma", "cividis", "coolwarm"};

static const unsigned char tables[][STOPS][3] = {
    {{68, 1, 84},    {71, 13, 96},   {72, 24, 106},  {72, 35, 116},  {71, 45, 123},  {69, 55, 129},
     {66, 64, 134},  {62, 73, 137},  {59, 82, 139},  {55, 91, 141},  {51, 99, 141},  {47, 107, 142},
     {44, 114, 142}, {41, 122, 142}, {38, 130, 142}, {35, 137, 142}, {33, 145, 140}, {31, 152, 139},
     {31, 160, 136}, {34, 167, 133}, {40, 174, 128}, {50, 182, 122}, {63, 188, 115}, {78, 195, 107},
     {94, 201, 98},  {112, 207, 87}, {132, 212, 75}, {152, 216, 62}, {173, 220, 48}, {194, 223, 35},
     {216, 226, 25}, {236, 229, 27}, {253, 231, 37}},
    {{13, 8, 135},   {34, 6, 144},   {49, 5, 151},   {63, 4, 156},   {76, 2, 161},   {89, 1, 165},
     {102, 0, 167},  {114, 1, 168},  {126, 3, 168},  {138, 9, 165},  {149, 17, 161}, {160, 26, 156},
     {170, 35, 149}, {179, 44, 142}, {188, 53, 135}, {196, 62, 127}, {204, 71, 120}, {211, 81, 113},
     {218, 90, 106}, {224, 99, 99},  {230, 108, 92}, {235, 118, 85}, {240, 128, 78}, {245, 139, 71},
     {248, 149, 64}, {251, 161, 57}, {253, 172, 51}, {254, 184, 44}, {253, 197, 39}, {252, 210, 37},
     {248, 223, 37}, {244, 237, 39}, {240, 249, 33}},
    {{0, 34, 78},     {0, 40, 91},     {0, 46, 106},    {5, 51, 113},    {26, 56, 111},   {39, 62, 110},
     {50, 67, 109},   {59, 73, 108},   {67, 78, 108},   {75, 84, 108},   {83, 90, 109},   {90, 95, 110},
     {97, 101, 111},  {104, 106, 113}, {111, 112, 115}, {118, 118, 118}, {125, 124, 120}, {132, 130, 121},
     {140, 136, 120}, {147, 142, 120}, {155, 148, 118}, {163, 154, 116}, {171, 160, 114}, {180, 167, 111},
     {188, 174, 108}, {196, 180, 104}, {205, 187, 99},  {213, 194, 94},  {222, 201, 88},  {231, 209, 80},
     {240, 216, 70},  {249, 224, 58},  {254, 232, 56}},
};

/* Moreland's Msh: lightness M, saturation s and hue h as polar coordinates of CIE L*a*b*; the two ends meet
 * in white (equation 4 and figure 8 of the paper; the hues of the ends are turned away from the middle by its
 * spin). */
static void coolwarm(double share, double color[3]) {
    static const double white[3] = {0.95047, 1.0, 1.08883},
                        matrix[3][3] = {{3.2404542, -1.5371385, -0.4985314},
                                        {-0.9692660, 1.8760108, 0.0415560},
                                        {0.0556434, -0.2040259, 1.0572252}};
    /* (59, 76, 192) and (180, 4, 38) in Msh, and the grey between them. */
    const double end_m = 80, end_s = 1.08, middle_m = 88, spin = 0.56120312;
    const double hue = share < 0.5 ? -1.1 : 0.5, turned = share < 0.5 ? -1.1 - spin : 0.5 + spin;
    const double t = fabs(2 * share - 1); /* 1 at the ends */
    const double m = t * end_m + (1 - t) * middle_m, s = t * end_s, h = t * hue + (1 - t) * turned;
    const double l = m * cos(s), a = m * sin(s) * cos(h), b = m * sin(s) * sin(h);
    double xyz[3];
    const double f[3] = {(l + 16) / 116 + a / 500, (l + 16) / 116, (l + 16) / 116 - b / 200};
    for (int i = 0; i < 3; i++) {
        const double cube = f[i] * f[i] * f[i];
        xyz[i] = white[i] * (cube > 0.008856 ? cube : (f[i] - 16.0 / 116) / 7.787);
    }
    for (int i = 0; i < 3; i++)
        color[i] = fmin(1, fmax(0, matrix[i][0] * xyz[0] + matrix[i][1] * xyz[1] + matrix[i][2] * xyz[2]));
}

void bp_colormap_color(BpColormap map, double share, double color[3]) {
    share = share > 0 ? fmin(share, 1) : 0;
    if (map == BP_MAP_COOLWARM) {
        coolwarm(share, color);
        return;
    }
    const double place = share * (STOPS - 1);
    const int below = (int)fmin(place, STOPS - 2);
    for (int c = 0; c < 3; c++) {
        const double low = tables[map][below][c], high = tables[map][below + 1][c];
        color[c] = bp_linear_from_srgb((low + (high - low) * (place - below)) / 255);
    }
}
