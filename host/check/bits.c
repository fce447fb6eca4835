/* bits.c: see bits.h. */
#include "bits.h"

#include "base/color.h"
#include "base/status.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { DIGITS = 8 }; /* of a float */

/* FNV-1a (Fowler, Noll and Vo 1991) over the bytes of a word, the least significant first. */
static uint64_t mix(uint64_t hash, uint64_t word) {
    for (int byte = 0; byte < 8; ++byte, word >>= 8) hash = (hash ^ (word & 0xffu)) * 0x100000001b3u;
    return hash;
}

void bp_bits_hash(const BpFilm *film, char hash[17]) {
    const size_t cells = (size_t)film->width * film->height * film->replicates;
    uint64_t mixed = mix(mix(0xcbf29ce484222325u, film->width), film->height);
    for (size_t i = 0; i < 3 * cells; ++i) {
        mixed = mix(mixed, (uint64_t)film->sums[i]);
        mixed = mix(mixed, film->fine_sums != NULL ? (uint64_t)film->fine_sums[i] : 0);
    }
    for (size_t i = 0; i < cells; ++i) mixed = mix(mixed, film->counts[i]);
    snprintf(hash, 17, "%016" PRIx64, mixed);
}

/* A pixel's mean; NaN where it has no sample. */
static float mean_of(const BpFilm *film, size_t pixel, size_t channel) {
    double sum = 0;
    uint64_t count = 0;
    for (size_t cell = pixel * film->replicates; cell < (pixel + 1) * film->replicates; ++cell) {
        sum += bp_film_sum(film, 3 * cell + channel);
        count += film->counts[cell];
    }
    return (float)(sum / (double)count);
}

char *bp_bits_radiance(const BpFilm *film) {
    const size_t pixels = (size_t)film->width * film->height;
    char *text = malloc(pixels * 3 * DIGITS + 1);
    if (text == NULL) return NULL;
    for (size_t i = 0; i < pixels * 3; ++i) {
        const float mean = mean_of(film, i / 3, i % 3);
        uint32_t bits;
        memcpy(&bits, &mean, sizeof bits);
        snprintf(text + i * DIGITS, DIGITS + 1, "%08" PRIx32, bits);
    }
    return text;
}

static bool read_float(const char *digits, float *value) {
    char copy[DIGITS + 1] = "", *end;
    memcpy(copy, digits, DIGITS);
    if (strspn(copy, "0123456789abcdef") != DIGITS) return false;
    const uint32_t bits = (uint32_t)strtoul(copy, &end, 16);
    memcpy(value, &bits, sizeof *value);
    return true;
}

static double magnitude(const float *recorded, size_t count) {
    double sum = 0;
    for (size_t i = 0; i < count; ++i) sum += fabs((double)recorded[i]);
    return sum / (double)count;
}

static void measure(const BpFilm *film, const float *recorded, BpBitsDifference *difference) {
    const size_t pixels = (size_t)film->width * film->height;
    const double scale = magnitude(recorded, 3 * pixels);
    double sum_new = 0, sum_old = 0;
    uint32_t far = 0;
    for (size_t p = 0; p < pixels; ++p) {
        double off = 0;
        for (size_t c = 0; c < 3; ++c) {
            const double now = (double)mean_of(film, p, c), old = (double)recorded[3 * p + c];
            sum_new += bp_luminance_weights[c] * now;
            sum_old += bp_luminance_weights[c] * old;
            const double apart = fabs(now - old);
            if (now == old) continue;
            off = fmax(off, isfinite(apart) && scale > 0 ? apart / scale : INFINITY);
        }
        difference->different += off > 0;
        far += off > BP_BITS_ROUNDING_MAX;
        difference->largest = fmax(difference->largest, off);
    }
    difference->mean = sum_old > 0 ? sum_new / sum_old - 1 : NAN;
    difference->kind = far == 0 ? BP_BITS_ROUNDING : 2 * far < pixels ? BP_BITS_PATHS : BP_BITS_PICTURE;
}

BpStatus bp_bits_compare(const BpFilm *film, const char *hash, const char *radiance,
                         BpBitsDifference *difference, BpError *err) {
    const size_t pixels = (size_t)film->width * film->height;
    char own[17];
    *difference = (BpBitsDifference){.kind = BP_BITS_SAME, .pixels = (uint32_t)pixels};
    bp_bits_hash(film, own);
    if (strcmp(own, hash) == 0) return BP_OK;
    float *recorded = calloc(3 * pixels, sizeof *recorded);
    if (recorded == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for a recorded picture");
    bool good = strlen(radiance) == 3 * pixels * DIGITS;
    for (size_t i = 0; i < 3 * pixels && good; ++i) good = read_float(radiance + i * DIGITS, &recorded[i]);
    if (good) measure(film, recorded, difference);
    free(recorded);
    return good ? BP_OK
                : bp_fail(err, BP_ERR_FILE,
                          "the recorded radiance is not of %u x %u pixels in hexadecimal digits", film->width,
                          film->height);
}
