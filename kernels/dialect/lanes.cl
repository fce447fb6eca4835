/* lanes.cl: the words of lane code, for the number of lanes that the file before this one has set.
 *
 * In:    LANE_COUNT, and LANED(name), the name that this number of lanes has for something.
 * Out:   types and operations.
 * Knows: real.cl.   Does not know: what the lanes stand for.
 *
 * Lane code is written once, and read for one lane, for the children of a node, and for the paths of a packet. A file
 * that is read more than once opens with `#define f LANED(f)` for each of its names, so that lane code may call f
 * and means the f of its own lanes; code for other lanes is called by its full name: f_one, f_node, f_packet.
 *
 *   vreal vuint vrefined   numbers, one a lane          vbool  a condition, one a lane, as wide as a real
 * A vbool is made by a comparison of vreals, by vbool_of_uint and vbool_of_refined from other comparisons, combined
 * with & | and vbool_not, tested with any_lane, and consumed by choose. `if (any_lane(m)) ...` is a plain branch for one lane
 * and "skip this when no lane wants it" for many. */
#undef vreal
#undef vbool
#undef vuint
#undef vrefined
#undef vbool_none
#undef vbool_all
#undef choose
#undef choose_uint
#undef choose_refined
#undef any_lane
#undef lane_bits
#undef BITS_BELOW
#undef LANE_NUMBERS
#undef vbool_not
#undef vbool_of_uint
#undef vbool_of_refined
#undef to_refined
#undef to_real
#undef splat
#undef splat_uint
#undef splat_refined
#undef uint_to_real
#undef to_uint
#undef real_of_bits
#undef bits_of_real
#undef gather_real
#undef gather_uint
#undef gather_split_real
#undef gather_split_uint
#undef scatter4

#define splat(x) ((vreal)(x))
#define splat_uint(x) ((vuint)(x))
#define splat_refined(x) ((vrefined)(x))

#if LANE_COUNT == 1
/* A vbool is 0 or 1. */
#define vreal real
#define vbool int
#define vuint uint
#define vrefined refined
#define vbool_none 0
#define vbool_all 1
#define choose(mask, a, b) ((mask) ? (a) : (b))
#define choose_uint(mask, a, b) ((mask) ? (a) : (b))
#define choose_refined(mask, a, b) ((mask) ? (a) : (b))
#define any_lane(mask) ((mask) != 0)
#define lane_bits(mask) ((uint)((mask) != 0))
#define BITS_BELOW 0u
#define LANE_NUMBERS 0u
#define vbool_not(mask) (!(mask))
#define vbool_of_uint(mask) (mask)
#define vbool_of_refined(mask) (mask)
#define to_refined(x) ((refined)(x))
#define to_real(x) ((real)(x))
#define uint_to_real(x) ((real)(x))
#define to_uint(x) ((uint)(int)(x))
#define real_of_bits(x) ((real)as_float(x))
#define bits_of_real(x) as_uint(x) /* of a float */
#define gather_real(base, index) ((base)[index])
#define gather_uint(base, index) ((base)[index])
/* From arrays that may come in parts (parts.cl), `offset` elements after `index`. */
#define gather_split_real(base, offset, index) (*place_in(base, (offset) + (index)))
#define gather_split_uint(base, offset, index) (*place_in(base, (offset) + (index)))
#else
/* A vbool is 0 or -1 a lane. */
#define vreal JOIN(REAL, LANE_COUNT)
#define vbool JOIN(REAL_MASK, LANE_COUNT)
#define vuint JOIN(uint, LANE_COUNT)
#define vrefined JOIN(REFINED, LANE_COUNT)
#define vbool_none ((vbool)(0))
#define vbool_all ((vbool)(-1))
#define choose(mask, a, b) ((mask) ? (a) : (b))
#define choose_uint(mask, a, b) (JOIN(convert_int, LANE_COUNT)(mask) ? (a) : (b))
#define choose_refined(mask, a, b) (JOIN(JOIN(convert_, REFINED_MASK), LANE_COUNT)(mask) ? (a) : (b))
#define any_lane(mask) LANED(any_of_lanes)(mask)
#define lane_bits(mask) LANED(bits_of_lanes)(mask)
#define BITS_BELOW (((vuint)(1u) << LANE_NUMBERS) - 1u)
#define vbool_not(mask) (~(mask))
#define vbool_of_uint(mask) JOIN(JOIN(convert_, REAL_MASK), LANE_COUNT)(mask)
#define vbool_of_refined(mask) JOIN(JOIN(convert_, REAL_MASK), LANE_COUNT)(mask)
#define to_refined(x) JOIN(JOIN(convert_, REFINED), LANE_COUNT)(x)
#define to_real(x) JOIN(JOIN(convert_, REAL), LANE_COUNT)(x)
#define to_uint(x) JOIN(convert_uint, LANE_COUNT)(JOIN(convert_int, LANE_COUNT)(x))
#define uint_to_real(x) JOIN(JOIN(convert_, REAL), LANE_COUNT)(x)
#define real_of_bits(x) JOIN(JOIN(convert_, REAL), LANE_COUNT)(JOIN(as_float, LANE_COUNT)(x))
#define bits_of_real(x) JOIN(as_uint, LANE_COUNT)(x)
/* A constant belongs to `base`: what is gathered with one index takes that apart once. Tables have fewer than 2^31 entries,
 * and processors that gather do so faster with signed indices. Elsewhere each index is taken out of its vector, which is
 * faster without a sign to extend. */
#ifdef __AVX512F__
#define gather_2(base, index) (base)[(int)(index).x], (base)[(int)(index).y]
#else
#define gather_2(base, index) (base)[(index).x], (base)[(index).y]
#endif
#define gather_4(base, index) gather_2(base, (index).lo), gather_2(base, (index).hi)
#define gather_8(base, index) gather_4(base, (index).lo), gather_4(base, (index).hi)
#define gather_16(base, index) gather_8(base, (index).lo), gather_8(base, (index).hi)
#define gather_real(base, index) ((vreal)(JOIN(gather_, LANE_COUNT)(base, index)))
#define gather_uint(base, index) ((vuint)(JOIN(gather_, LANE_COUNT)(base, index)))
#ifndef SCENE_PARTS
#define gather_split_real(base, offset, index) gather_real((base) + (offset), index)
#define gather_split_uint(base, offset, index) gather_uint((base) + (offset), index)
#else
#define gather_split_2(base, index) *place_in(base, (index).x), *place_in(base, (index).y)
#define gather_split_4(base, index) gather_split_2(base, (index).lo), gather_split_2(base, (index).hi)
#define gather_split_8(base, index) gather_split_4(base, (index).lo), gather_split_4(base, (index).hi)
#define gather_split_16(base, index) gather_split_8(base, (index).lo), gather_split_8(base, (index).hi)
#define gather_split_real(base, offset, index) ((vreal)(JOIN(gather_split_, LANE_COUNT)(base, (uint)(offset) + (index))))
#define gather_split_uint(base, offset, index) ((vuint)(JOIN(gather_split_, LANE_COUNT)(base, (uint)(offset) + (index))))
#endif
/* Four numbers of each lane to its place among groups of four, the last lane first. */
#define scatter4_1(a, b, c, d, place, base) vstore4((JOIN(REAL, 4))(a, b, c, d), place, base)
#define scatter4_2(a, b, c, d, place, base)                                                                            \
    scatter4_1((a).y, (b).y, (c).y, (d).y, (place).y, base), scatter4_1((a).x, (b).x, (c).x, (d).x, (place).x, base)
#define scatter4_4(a, b, c, d, place, base)                                                                            \
    scatter4_2((a).hi, (b).hi, (c).hi, (d).hi, (place).hi, base), scatter4_2((a).lo, (b).lo, (c).lo, (d).lo, (place).lo, base)
#define scatter4_8(a, b, c, d, place, base)                                                                            \
    scatter4_4((a).hi, (b).hi, (c).hi, (d).hi, (place).hi, base), scatter4_4((a).lo, (b).lo, (c).lo, (d).lo, (place).lo, base)
#define scatter4_16(a, b, c, d, place, base)                                                                           \
    scatter4_8((a).hi, (b).hi, (c).hi, (d).hi, (place).hi, base), scatter4_8((a).lo, (b).lo, (c).lo, (d).lo, (place).lo, base)
#define scatter4(a, b, c, d, place, base) JOIN(scatter4_, LANE_COUNT)(a, b, c, d, place, base)

/* The number of each lane. */
#if LANE_COUNT == 16
#define LANE_NUMBERS ((vuint)(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15))
#elif LANE_COUNT == 8
#define LANE_NUMBERS ((vuint)(0, 1, 2, 3, 4, 5, 6, 7))
#elif LANE_COUNT == 4
#define LANE_NUMBERS ((vuint)(0, 1, 2, 3))
#else
#define LANE_NUMBERS ((vuint)(0, 1))
#endif

/* Bit l: lane l. Some compilers offer the one instruction that their processors have for this (a macro says which
 * processor). Everybody else gathers one bit of each lane's byte by a multiplication: byte l holds bit l, and the
 * product adds them up in its highest byte. */
static uint LANED(bits_of_lanes)(vbool mask) {
#if LANE_COUNT == 16 && !REAL_IS_DOUBLE && defined(__AVX512DQ__)
    return (ushort)__builtin_ia32_cvtd2mask512(mask);
#elif LANE_COUNT == 16 && REAL_IS_DOUBLE && defined(__AVX512DQ__)
    return (uint)(uchar)__builtin_ia32_cvtq2mask512(mask.lo) | (uint)(uchar)__builtin_ia32_cvtq2mask512(mask.hi) << 8;
#elif LANE_COUNT == 8 && !REAL_IS_DOUBLE && defined(__AVX512DQ__) && defined(__AVX512VL__)
    return (uchar)__builtin_ia32_cvtd2mask256(mask);
#elif LANE_COUNT == 16 && !REAL_IS_DOUBLE && defined(__AVX__)
    return (uint)__builtin_ia32_movmskps256(as_float8(mask.lo)) | (uint)__builtin_ia32_movmskps256(as_float8(mask.hi)) << 8;
#elif LANE_COUNT == 8 && !REAL_IS_DOUBLE && defined(__AVX__)
    return (uint)__builtin_ia32_movmskps256(as_float8(mask));
#elif LANE_COUNT == 16 && REAL_IS_DOUBLE && defined(__AVX__)
    return (uint)__builtin_ia32_movmskpd256(as_double4(mask.lo.lo)) |
           (uint)__builtin_ia32_movmskpd256(as_double4(mask.lo.hi)) << 4 |
           (uint)__builtin_ia32_movmskpd256(as_double4(mask.hi.lo)) << 8 |
           (uint)__builtin_ia32_movmskpd256(as_double4(mask.hi.hi)) << 12;
#elif LANE_COUNT == 8 && REAL_IS_DOUBLE && defined(__AVX__)
    return (uint)__builtin_ia32_movmskpd256(as_double4(mask.lo)) |
           (uint)__builtin_ia32_movmskpd256(as_double4(mask.hi)) << 4;
#elif LANE_COUNT == 16 && defined(__SSE2__)
    return (uint)__builtin_ia32_pmovmskb128(convert_char16(mask));
#elif LANE_COUNT == 8 && !REAL_IS_DOUBLE && defined(__SSE2__)
    return (uint)__builtin_ia32_movmskps(as_float4(mask.lo)) | (uint)__builtin_ia32_movmskps(as_float4(mask.hi)) << 4;
#elif LANE_COUNT == 16
    const uchar16 bits = as_uchar16((as_ulong2(convert_char16(mask)) & (ulong2)0x8040201008040201) *
                                    (ulong2)0x0101010101010101);
    return as_uint((uchar4)(bits.s7, bits.sf, 0, 0)); /* side by side before they leave the vector */
#elif LANE_COUNT == 8
    return (uint)(((as_ulong(convert_char8(mask)) & (ulong)0x8040201008040201) * (ulong)0x0101010101010101) >> 56);
#elif LANE_COUNT == 4
    return ((uint)mask.x & 1u) | ((uint)mask.y & 2u) | ((uint)mask.z & 4u) | ((uint)mask.w & 8u);
#else
    return ((uint)mask.x & 1u) | ((uint)mask.y & 2u);
#endif
}

/* Drivers' own any() may ask lane by lane. With AVX-512, a comparison's result is a set of bits already. */
static int LANED(any_of_lanes)(vbool mask) {
#if LANE_COUNT == 16 && defined(__AVX512DQ__)
    return lane_bits(mask) != 0;
#else
#if LANE_COUNT == 16
    const JOIN(REAL_MASK, 8) eight = mask.lo | mask.hi;
    const JOIN(REAL_MASK, 4) four = eight.lo | eight.hi;
#elif LANE_COUNT == 8
    const JOIN(REAL_MASK, 4) four = mask.lo | mask.hi;
#elif LANE_COUNT == 4
    const JOIN(REAL_MASK, 4) four = mask;
#endif
#if LANE_COUNT >= 4
    const JOIN(REAL_MASK, 2) two = four.lo | four.hi;
#else
    const JOIN(REAL_MASK, 2) two = mask;
#endif
    return (two.x | two.y) != 0;
#endif
}
#endif
