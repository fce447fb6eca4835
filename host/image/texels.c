/* texels.c: see texels.h. */
#include "texels.h"

#include "base/color.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846

BpStatus bp_texels_create(uint32_t width, uint32_t height, BpImage **image, BpError *err) {
    *image = calloc(1, sizeof **image);
    /* Zeroed by the system: pages that a damaged file never fills take no memory. */
    float *texels = calloc((size_t)width * height, 3 * sizeof *texels);
    if (*image == NULL || texels == NULL) {
        free(texels);
        free(*image);
        *image = NULL;
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for an image of %u by %u texels", (unsigned)width,
                       (unsigned)height);
    }
    (*image)->width = width;
    (*image)->height = height;
    (*image)->texels = texels;
    (*image)->scale = 1;
    return BP_OK;
}

void bp_texels_destroy(BpImage **image) {
    if (image == NULL || *image == NULL) return;
    free((*image)->file);
    free((*image)->texels);
    free(*image);
    *image = NULL;
}

void bp_texels_note(BpImage *image, const char *format, ...) {
    const size_t used = strlen(image->notes), room = sizeof image->notes - used;
    va_list arguments;
    va_start(arguments, format);
    const int length = snprintf(image->notes + used, room, "%s", used > 0 ? "; " : "");
    if ((size_t)length < room)
        vsnprintf(image->notes + used + length, room - (size_t)length, format, arguments);
    va_end(arguments);
}

void bp_texels_note_alpha(BpImage *image, size_t transparent) {
    if (transparent > 0)
        bp_texels_note(image, "its alpha is left out, though %zu of %zu texels are not opaque", transparent,
                       (size_t)image->width * image->height);
}

static BpStatus refuse_texel(const BpImage *image, size_t place, double scale, const char *path,
                             BpError *err) {
    static const char *const channels[] = {"red", "green", "blue"};
    const size_t texel = place / 3;
    char found[32];
    snprintf(found, sizeof found, "%.6g", (double)image->texels[place]);
    if (isnan(image->texels[place])) memcpy(found, "NaN", sizeof "NaN");
    const BpStatus status =
        bp_fail(err, BP_ERR_SCENE,
                "found %s as the %s of the texel in column %zu of row %zu (from 0, row 0 on top), expected 0 "
                "to %g%s; correct the image",
                found, channels[place % 3], texel % image->width, texel / image->width,
                BP_RADIANCE_MAX / fmax(scale, 1), scale > 1 ? ", since \"scale\" multiplies it" : "");
    bp_error_at(err, path, 0, 0);
    return status;
}

/* Values below 0, and the texels that have them. */
typedef struct Negatives {
    size_t texels;
    double least; /* as the file has it */
} Negatives;

static void note_negatives(const Negatives *negatives, BpImage *image) {
    if (negatives->texels == 0) return;
    bp_texels_note(image, "%zu of %zu texels %s below 0, down to %.3g, which count as 0", negatives->texels,
                   (size_t)image->width * image->height,
                   negatives->texels == 1 ? "has values" : "have values", negatives->least);
}

/* Replaces negative values, and -0, by 0. */
static void raise_negatives(float texel[3], Negatives *negatives) {
    bool found = false;
    for (int c = 0; c < 3; c++) {
        if (!isfinite(texel[c])) continue;
        if (texel[c] < 0) {
            found = true;
            negatives->least = fmin(negatives->least, (double)texel[c]);
        }
        if (!(texel[c] > 0)) texel[c] = 0;
    }
    if (found) negatives->texels++;
}

/* FNV-1a with 32-bit words, as film_scene.c hashes. */
static uint64_t mix(uint64_t hash, uint32_t word) {
    hash = (hash ^ word) * 0x100000001b3u;
    return hash ^ hash >> 32;
}

BpStatus bp_texels_finish(BpImage *image, double scale, const char *path, BpError *err) {
    const size_t width = image->width, height = image->height;
    double sum = 0, squares = 0;
    Negatives negatives = {0};
    image->scale = scale;
    image->is_gray = true;
    image->hash = mix(mix(0xcbf29ce484222325u, image->width), image->height);
    for (size_t row = 0; row < height; row++) {
        double row_sum = 0, row_squares = 0;
        for (size_t i = 3 * row * width; i < 3 * (row + 1) * width; i += 3) {
            float *const texel = image->texels + i;
            raise_negatives(texel, &negatives);
            for (size_t c = 0; c < 3; c++) {
                const double value = (double)texel[c] * scale;
                if (!(value >= 0 && value <= BP_RADIANCE_MAX))
                    return refuse_texel(image, i + c, scale, path, err);
                texel[c] = (float)value;
                image->bound[c] = fmax(image->bound[c], (double)texel[c]);
                uint32_t bits;
                memcpy(&bits, &texel[c], sizeof bits);
                image->hash = mix(image->hash, bits);
            }
            image->is_gray = image->is_gray && texel[0] == texel[1] && texel[0] == texel[2];
            const double luminance = bp_luminance(texel);
            row_sum += luminance;
            row_squares += luminance * luminance;
        }
        /* The share of the sphere that a row covers is a difference of cosines, by this product. */
        const double share = sin(PI * ((double)row + 0.5) / (double)height) * sin(PI / (2 * (double)height));
        sum += row_sum / (double)width * share;
        squares += row_squares / (double)width * share;
    }
    note_negatives(&negatives, image);
    image->mean = sum;
    image->spread = sum > 0 ? sqrt(fmax(squares / (sum * sum) - 1, 0)) : 0;
    return BP_OK;
}
