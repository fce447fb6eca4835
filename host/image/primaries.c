/* primaries.c: see primaries.h. */
#include "primaries.h"

#include <math.h>
#include <string.h>

static const BpPrimaries rec709 = {{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}, {0.3127, 0.3290}};
static const BpPrimaries cie_xyz = {{1, 0}, {0, 1}, {0, 0}, {1 / 3.0, 1 / 3.0}};

/* As files round them. */
static bool are_same(const BpPrimaries *a, const BpPrimaries *b) {
    const double *const pairs[4][2] = {
        {a->red, b->red}, {a->green, b->green}, {a->blue, b->blue}, {a->white, b->white}};
    for (int i = 0; i < 4; i++)
        for (int c = 0; c < 2; c++)
            if (!(fabs(pairs[i][0][c] - pairs[i][1][c]) <= 0.0005)) return false;
    return true;
}

static void multiply(double a[3][3], double b[3][3], double out[3][3]) {
    double product[3][3];
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) product[i][k] = a[i][0] * b[0][k] + a[i][1] * b[1][k] + a[i][2] * b[2][k];
    memcpy(out, product, sizeof product);
}

static void transform(double m[3][3], const double v[3], double out[3]) {
    for (int i = 0; i < 3; i++) out[i] = m[i][0] * v[0] + m[i][1] * v[1] + m[i][2] * v[2];
}

static bool invert(double m[3][3], double out[3][3]) {
    double inverse[3][3];
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) {
            const int a = (i + 1) % 3, b = (i + 2) % 3, c = (k + 1) % 3, d = (k + 2) % 3;
            inverse[k][i] = m[a][c] * m[b][d] - m[a][d] * m[b][c];
        }
    const double determinant = m[0][0] * inverse[0][0] + m[0][1] * inverse[1][0] + m[0][2] * inverse[2][0];
    if (!(fabs(determinant) > 1e-9) || !isfinite(determinant)) return false;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) out[i][k] = inverse[i][k] / determinant;
    return true;
}

/* The XYZ of a white of luminance 1. */
static bool white_xyz(const double white[2], double xyz[3]) {
    if (!(white[1] > 0)) return false;
    xyz[0] = white[0] / white[1];
    xyz[1] = 1;
    xyz[2] = (1 - white[0] - white[1]) / white[1];
    return isfinite(xyz[0]) && isfinite(xyz[2]);
}

/* XYZ of linear colours: each primary as strong as makes white of (1, 1, 1). */
static bool to_xyz(const BpPrimaries *from, double out[3][3]) {
    const double *const primaries[] = {from->red, from->green, from->blue};
    double directions[3][3], inverse[3][3], white[3], strengths[3];
    for (int c = 0; c < 3; c++) {
        directions[0][c] = primaries[c][0];
        directions[1][c] = primaries[c][1];
        directions[2][c] = 1 - primaries[c][0] - primaries[c][1];
    }
    if (!white_xyz(from->white, white) || !invert(directions, inverse)) return false;
    transform(inverse, white, strengths);
    for (int i = 0; i < 3; i++)
        for (int c = 0; c < 3; c++) out[i][c] = directions[i][c] * strengths[c];
    return true;
}

/* Adaptation from one white to another: von Kries' rule in the cone space of Bradford. */
static bool adapt(const double from[2], const double to[2], double out[3][3]) {
    double cones[3][3] = {{0.8951, 0.2664, -0.1614}, {-0.7502, 1.7135, 0.0367}, {0.0389, -0.0685, 1.0296}};
    double back[3][3], from_xyz[3], to_white[3], a[3], b[3], scaled[3][3];
    if (!white_xyz(from, from_xyz) || !white_xyz(to, to_white) || !invert(cones, back)) return false;
    transform(cones, from_xyz, a);
    transform(cones, to_white, b);
    for (int i = 0; i < 3; i++) {
        if (!(a[i] > 0)) return false;
        for (int k = 0; k < 3; k++) scaled[i][k] = b[i] / a[i] * cones[i][k];
    }
    multiply(back, scaled, out);
    return true;
}

bool bp_primaries_matrix(const BpPrimaries *from, double matrix[3][3]) {
    double source[3][3], target[3][3], inverse[3][3], adaptation[3][3];
    if (!to_xyz(from, source) || !to_xyz(&rec709, target) || !invert(target, inverse)) return false;
    if (!are_same(from, &cie_xyz)) {
        if (!adapt(from->white, rec709.white, adaptation)) return false;
        multiply(adaptation, source, source);
    }
    multiply(inverse, source, matrix);
    for (int i = 0; i < 9; i++)
        if (!isfinite(matrix[i / 3][i % 3])) return false;
    return true;
}

BpStatus bp_image_convert(const BpImageInput *input, const BpPrimaries *from, const char *source,
                          BpImage *image, BpError *err) {
    double matrix[3][3];
    if (are_same(from, &rec709)) return BP_OK;
    if (!bp_primaries_matrix(from, matrix))
        return bp_image_fail(
            input, err,
            "found primaries that span no colours (%s), expected the places of red, green, blue and "
            "white; correct or remove it",
            source);
    for (size_t i = 0; i < (size_t)image->width * image->height; i++) {
        float *const texel = image->texels + 3 * i;
        const double old[3] = {(double)texel[0], (double)texel[1], (double)texel[2]};
        double converted[3];
        if (!isfinite(old[0]) || !isfinite(old[1]) || !isfinite(old[2])) continue;
        transform(matrix, old, converted);
        for (int c = 0; c < 3; c++) texel[c] = (float)converted[c];
    }
    bp_texels_note(image, "its colours are converted to the primaries of Rec. 709 (%s)", source);
    return BP_OK;
}
