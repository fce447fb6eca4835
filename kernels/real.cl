/* real.cl: the dialect. Types and a few operations that every other kernel file is written in.
 *
 * The program's first lines (host/engine/program.c) define:
 *   REAL_IS_DOUBLE    0 or 1: what `real` is
 *   REFINE_IS_DOUBLE  0 or 1: whether intersections are refined in double (always 1 with REAL_IS_DOUBLE)
 *   TREE_WIDTH        2, 4 or 8: lanes of a tree node and of a leaf
 *   NUMERICS_ROBUST   1: refine.cl decides; 0: plain.cl
 *   EFFECT_...        0 or 1, one for each effect
 *
 * Rounding is part of the product: no contraction of a*b+c unless fma() is written. */
#pragma OPENCL FP_CONTRACT OFF

#if REAL_IS_DOUBLE || REFINE_IS_DOUBLE
#pragma OPENCL EXTENSION cl_khr_fp64 : enable
#endif

#if REAL_IS_DOUBLE
#define REAL double
#define REAL_MASK long
/* The distance between 1 and the next larger real, halved: the unit roundoff u. */
#define ROUNDOFF 0x1p-53
#define REAL_LARGE 1e300
#define R(literal) literal
#else
#define REAL float
#define REAL_MASK int
#define ROUNDOFF 0x1p-24f
#define REAL_LARGE 1e38f
#define R(literal) literal##f
#endif
typedef REAL real;

#if REFINE_IS_DOUBLE
#define REFINED double
#define REFINED_MASK long
#else
#define REFINED REAL
#define REFINED_MASK REAL_MASK
#endif
typedef REFINED refined;

#define JOIN_(a, b) a##b
#define JOIN(a, b) JOIN_(a, b)

/* ---- one ray against TREE_WIDTH boxes or spheres ---- */

#define WIDE(type) JOIN(type, TREE_WIDTH)
typedef WIDE(REAL) wide;
#define load_wide JOIN(vload, TREE_WIDTH)

/* A comparison of wides as bytes in one integer: byte l is 0xff where lane l is true. On most CPUs this is two
 * instructions, and the lowest lane is one count of trailing zeros away. */
#if TREE_WIDTH == 8
typedef ulong lane_bytes;
#define to_lane_bytes(mask) as_ulong(convert_char8(mask))
#elif TREE_WIDTH == 4
typedef uint lane_bytes;
#define to_lane_bytes(mask) as_uint(convert_char4(mask))
#else
typedef ushort lane_bytes;
#define to_lane_bytes(mask) as_ushort(convert_char2(mask))
#endif
/* The lowest true lane of `bytes` != 0. popcount((b & -b) - 1) counts the zeros below the lowest set bit. */
#define lowest_lane(bytes) ((uint)(popcount((lane_bytes)(((bytes) & (0 - (bytes))) - 1)) >> 3))
#define without_lane(bytes, lane) ((lane_bytes)((bytes) & ~((lane_bytes)0xff << ((lane) * 8))))
