/* bits.h: a picture's exact sums as a hash, and how far a picture is from a recorded one.
 *
 * In:    a film; the hash and the linear radiance that were recorded for it.   Out: equal or not, and by how
 * much not.
 * Knows: films.   Does not know: files, devices, who recorded.
 *
 * The hash is of the integer sums behind the picture and of their sample counts, so two pictures have the
 * same hash exactly if every sample added up to the same. Radiance is kept beside it as 32-bit floats, since
 * a hash does not show whether a last digit or the whole picture differs. */
#ifndef BP_CHECK_BITS_H
#define BP_CHECK_BITS_H

#include "film/film.h"

/* 16 hexadecimal digits and a 0. Sums of 0 hash like absent ones. */
void bp_bits_hash(const BpFilm *film, char hash[17]);

/* The pixels' mean radiance, row by row, 8 hexadecimal digits for the bits of each of 3 floats. Heap, NULL:
 * out of memory. */
char *bp_bits_radiance(const BpFilm *film);

typedef enum BpBitsKind {
    BP_BITS_SAME,
    BP_BITS_ROUNDING, /* no pixel is off by more than BP_BITS_ROUNDING_MAX of the mean: other last digits */
    BP_BITS_PATHS,    /* some pixel is, as after paths that went another way: a few of them */
    BP_BITS_PICTURE   /* half of the pixels or more are: another picture */
} BpBitsKind;

#define BP_BITS_ROUNDING_MAX 1e-5

typedef struct BpBitsDifference {
    BpBitsKind kind;
    uint32_t pixels, different; /* in all, and those whose radiance is not the same float */
    double largest; /* |difference| of a pixel's channel over the mean of all; infinite: not finite */
    double mean;    /* of the new picture's luminance over the recorded one's, minus 1 */
} BpBitsDifference;

/* Compares. `hash`, `radiance`: recorded. BP_ERR_FILE: `radiance` is not of the film's size, or no such text.
 */
BpStatus bp_bits_compare(const BpFilm *film, const char *hash, const char *radiance,
                         BpBitsDifference *difference, BpError *err);

#endif
