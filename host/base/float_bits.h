/* float_bits.h: a float and its 32 bits. */
#ifndef BP_BASE_FLOAT_BITS_H
#define BP_BASE_FLOAT_BITS_H

#include <stdint.h>
#include <string.h>

/* The bits of any float, a NaN's too. */
static inline uint32_t bp_float_bits(float x) {
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

/* The float that has these bits. */
static inline float bp_bits_float(uint32_t bits) {
    float x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

#endif
