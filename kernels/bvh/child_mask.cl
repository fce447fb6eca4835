/* child_mask.cl: which of the TREE_WIDTH lanes of a node or leaf, as the low bits of one integer.
 *
 * A set is made by a comparison of wides, and taken apart lane by lane, lowest first. */
typedef uint lane_set;

/* Some compilers offer the one instruction that their processors have for this (a macro says which processor).
 * Everybody else gathers one bit of each lane's byte by a multiplication. */
#if TREE_WIDTH == 16 && !REAL_IS_DOUBLE && defined(__AVX512DQ__)
static lane_set to_lane_set(int16 mask) { return (ushort)__builtin_ia32_cvtd2mask512(mask); }
#elif TREE_WIDTH == 16 && REAL_IS_DOUBLE && defined(__AVX512DQ__)
static lane_set to_lane_set(long16 mask) {
    return (lane_set)(uchar)__builtin_ia32_cvtq2mask512(mask.lo) |
           (lane_set)(uchar)__builtin_ia32_cvtq2mask512(mask.hi) << 8;
}
#elif TREE_WIDTH == 8 && !REAL_IS_DOUBLE && defined(__AVX512DQ__) && defined(__AVX512VL__)
static lane_set to_lane_set(int8 mask) { return (uchar)__builtin_ia32_cvtd2mask256(mask); }
#elif TREE_WIDTH == 8 && !REAL_IS_DOUBLE && defined(__AVX__)
static lane_set to_lane_set(int8 mask) { return (lane_set)__builtin_ia32_movmskps256(as_float8(mask)); }
#elif TREE_WIDTH >= 8
/* Byte l holds bit l; the product adds them up in its highest byte. */
static lane_set bits_of_bytes(ulong bytes) {
    return (lane_set)(((bytes & (ulong)0x8040201008040201) * (ulong)0x0101010101010101) >> 56);
}
#if TREE_WIDTH == 16
static lane_set to_lane_set(JOIN(REAL_MASK, 16) mask) {
    const ulong2 bytes = as_ulong2(convert_char16(mask));
    return bits_of_bytes(bytes.x) | bits_of_bytes(bytes.y) << 8;
}
#else
static lane_set to_lane_set(JOIN(REAL_MASK, 8) mask) { return bits_of_bytes(as_ulong(convert_char8(mask))); }
#endif
#elif TREE_WIDTH == 4
static lane_set to_lane_set(JOIN(REAL_MASK, 4) mask) {
    return ((lane_set)mask.x & 1u) | ((lane_set)mask.y & 2u) | ((lane_set)mask.z & 4u) | ((lane_set)mask.w & 8u);
}
#else
static lane_set to_lane_set(JOIN(REAL_MASK, 2) mask) {
    return ((lane_set)mask.x & 1u) | ((lane_set)mask.y & 2u);
}
#endif

/* The lowest lane of a set: the number of zeros below the lowest bit, 32 for the empty set. Compilers know this form
 * and have an instruction for it. */
static uint lowest_lane(lane_set set) { return popcount(~set & (set - 1u)); }
static lane_set without_lowest(lane_set set) { return set & (set - 1u); }
static lane_set without_lane(lane_set set, uint lane) { return set & ~((lane_set)1 << lane); }

/* `inside` for the lanes of the set, `outside` for the others. */
static wide choose_lanes(lane_set set, wide inside, real outside) {
#if TREE_WIDTH == 16
    const WIDE(REAL_MASK) bit = (WIDE(REAL_MASK))(1, 2, 4, 8, 16, 32, 64, 128, 256, 512, 1024, 2048, 4096, 8192, 16384, 32768);
#elif TREE_WIDTH == 8
    const WIDE(REAL_MASK) bit = (WIDE(REAL_MASK))(1, 2, 4, 8, 16, 32, 64, 128);
#elif TREE_WIDTH == 4
    const WIDE(REAL_MASK) bit = (WIDE(REAL_MASK))(1, 2, 4, 8);
#else
    const WIDE(REAL_MASK) bit = (WIDE(REAL_MASK))(1, 2);
#endif
    return ((WIDE(REAL_MASK))(set) & bit) != 0 ? inside : (wide)outside;
}

/* The least of all lanes. */
static real least_lane(wide x) {
#if TREE_WIDTH == 16
    const JOIN(REAL, 8) eight = x.lo < x.hi ? x.lo : x.hi;
    const JOIN(REAL, 4) four = eight.lo < eight.hi ? eight.lo : eight.hi;
#elif TREE_WIDTH == 8
    const JOIN(REAL, 4) four = x.lo < x.hi ? x.lo : x.hi;
#elif TREE_WIDTH == 4
    const JOIN(REAL, 4) four = x;
#endif
#if TREE_WIDTH >= 4
    const JOIN(REAL, 2) two = four.lo < four.hi ? four.lo : four.hi;
#else
    const JOIN(REAL, 2) two = x;
#endif
    return two.x < two.y ? two.x : two.y;
}
