/* divide_in_c.h: kernels/dialect/divide.cl for one lane, read as C.
 *
 * Out:   divide(a, b), square_root(x), and how far the device is off that they start from: quotient_error and
 *        root_error, in units in the last place.
 * Knows: the words of OpenCL C that the file uses.   Does not know: what is right. */
#ifndef TESTS_OPENCL_DIVIDE_IN_C_H
#define TESTS_OPENCL_DIVIDE_IN_C_H

#include "base/float_bits.h"

#include <float.h>
#include <math.h>
#include <stdint.h>

typedef uint32_t uint;
typedef uint64_t ulong;

#define as_uint(x) bp_float_bits(x)
#define as_float(bits) bp_bits_float(bits)

static int quotient_error, root_error;
typedef union LaneReals {
    float all, of[1];
} LaneReals;
static inline float off_by(float x, int ulps) {
    return as_float(as_uint(x) + (uint32_t)ulps);
}

#define OWN_ROUNDING 1
#define REAL_IS_DOUBLE 0
#define REFINE_IS_DOUBLE 0
#define REAL_MAX FLT_MAX
#define LANE_COUNT 1
#define LANED(name) name##_one
#define vreal float
#define vuint uint
#define vbool int
#define real float
#define splat(x) ((float)(x))
#define splat_uint(x) ((uint)(x))
#define choose(mask, a, b) ((mask) ? (a) : (b))
#define any_lane(mask) ((mask) != 0)
#define vbool_not(mask) (!(mask))
#define vbool_of_uint(mask) (mask)
#define real_of_bits(x) as_float(x)
#define bits_of_real(x) as_uint(x)
#define clz(x) __builtin_clz(x)
#define min(a, b) ((a) < (b) ? (a) : (b))
#define fma fmaf
#define sqrt sqrtf
#define fabs fabsf
#define DEVICE_QUOTIENT(a, b) off_by((a) / (b), quotient_error)
#define DEVICE_ROOT(x) off_by(sqrtf(x), root_error)
#include "dialect/divide.cl"
#undef fma
#undef sqrt
#undef fabs
#undef min

#endif
