/* bits.h: hashes a picture's exact sums, and compares a picture with a recorded one.
 *
 * In:    a film; the hash and the linear radiance that were recorded for it.   Out: equal or not, and the
 * difference.
 * Knows: films.   Does not know: files, devices, who recorded them.
 *
 * The hash is of the integer sums behind the picture and of their sample counts, so two pictures have the
 * same hash exactly if all their sums are equal. Radiance is kept beside it as 32-bit floats, since a hash
 * does not show whether a last digit or the whole picture differs. */
#ifndef BP_CHECK_BITS_H
#define BP_CHECK_BITS_H

#include "film/film.h"

/* 16 hexadecimal digits and a 0. Fine sums of 0 hash like absent ones. */
void bp_bits_hash(const BpFilm *film, char hash[17]);

/* The pixels' mean radiance, row by row, 8 hexadecimal digits for the bits of each of 3 floats. Heap, NULL:
 * out of memory. */
char *bp_bits_radiance(const BpFilm *film);

typedef enum BpBitsKind {
    BP_BITS_SAME,
    BP_BITS_ROUNDING, /* no pixel is off by more than BP_BITS_ROUNDING_MAX of the mean: other last digits */
    BP_BITS_PATHS,    /* a few pixels are, as if some paths went another way */
    BP_BITS_PICTURE   /* at least half of the pixels are: another picture */
} BpBitsKind;

#define BP_BITS_ROUNDING_MAX 1e-5

typedef struct BpBitsDifference {
    BpBitsKind kind;
    uint32_t pixels, different; /* in all, and those whose radiance is not the same float */
    double largest; /* |difference| of a pixel's channel over the mean of all; infinite: not finite */
    double mean;    /* of the new picture's luminance over the recorded one's, minus 1 */
} BpBitsDifference;

/* Compares. `hash`, `radiance`: recorded. BP_ERR_FILE: `radiance` is malformed or has another size than the
 * film. */
BpStatus bp_bits_compare(const BpFilm *film, const char *hash, const char *radiance,
                         BpBitsDifference *difference, BpError *err);

#endif
