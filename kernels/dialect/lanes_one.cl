/* lanes_one.cl: from here on, until lanes_packet.cl, lane code means one lane: `vreal` is a real, a mask is 0 or 1.
 *
 * Lane code is written once, for one lane or for many: a mask is made by a comparison, combined with & | and
 * vbool_not, asked by any_lane, and spent by choose. `if (any_lane(m)) ...` is a plain branch for one lane and
 * "skip when no lane wants it" for many. LANED(f) is f's name for this number of lanes. */
#define LANE_COUNT 1

/* Some compilers leave parts of a ray's search functions of their own, and pass the ray through memory. Where nothing is
 * optimised, nothing is inlined either: Oclgrind cannot run what the inliner leaves behind. */
#ifdef __OPTIMIZE__
#define FORCE_INLINE __attribute__((always_inline))
#else
#define FORCE_INLINE
#endif

#define LANED(name) JOIN(name, _one)
#define vreal real
#define vbool int
#define vuint uint
#define vrefined refined
#define choose(mask, a, b) ((mask) ? (a) : (b))
#define choose_uint(mask, a, b) ((mask) ? (a) : (b))
#define choose_refined(mask, a, b) ((mask) ? (a) : (b))
#define any_lane(mask) ((mask) != 0)
#define lane_bits(mask) ((uint)((mask) != 0))
#define BITS_BELOW 0u
#define vbool_not(mask) (!(mask))
#define vbool_of_uint(mask) (mask)
#define vbool_of_refined(mask) (mask)
#define to_refined(x) ((refined)(x))
#define to_real(x) ((real)(x))
#define splat(x) ((real)(x))
#define splat_uint(x) ((uint)(x))
#define splat_refined(x) ((refined)(x))
#define load_lanes(array) ((array)[0])
#define store_lanes(x, array) ((array)[0] = (x))
#define uint_to_real(x) ((real)(x))
#define to_uint(x) ((uint)(int)(x))
#define gather_real(base, index) ((base)[index])
#define gather_uint(base, index) ((base)[index])
