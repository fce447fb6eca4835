/* transfer.c: from linear radiance to bytes; see image.h. */
#include "image.h"

#include "base/color.h"

#include <math.h>

static double encode(double linear, BpTransfer transfer) {
    double encoded = linear;
    switch (transfer) {
    case BP_TRANSFER_GAMMA2:
        encoded = linear > 0 ? sqrt(linear) : 0;
        break;
    case BP_TRANSFER_SRGB:
        encoded = bp_srgb_from_linear(linear);
        break;
    case BP_TRANSFER_LINEAR:
        break;
    }
    return encoded > 0 ? encoded : 0; /* NaN too */
}

uint8_t bp_transfer_byte(double linear, BpTransfer transfer) {
    return (uint8_t)(256 * fmin(encode(linear, transfer), 0.999));
}

uint16_t bp_transfer_word(double linear, BpTransfer transfer) {
    return (uint16_t)(65535 * fmin(encode(linear, transfer), 1) + 0.5);
}

double bp_transfer_inverse(double value, BpTransfer transfer) {
    switch (transfer) {
    case BP_TRANSFER_GAMMA2:
        return value * value;
    case BP_TRANSFER_SRGB:
        return bp_linear_from_srgb(value);
    case BP_TRANSFER_LINEAR:
        break;
    }
    return value;
}
