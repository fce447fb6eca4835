/* child_mask.cl: which of the TREE_WIDTH lanes of a node or leaf, as the low bits of one integer.
 *
 * A set is made by a comparison of wides, and taken apart lane by lane, lowest first. */
typedef uint child_mask;

/* Some compilers offer the one instruction that their processors have for this (a macro says which processor).
 * Everybody else gathers one bit of each lane's byte by a multiplication. */
#if TREE_WIDTH == 16 && !REAL_IS_DOUBLE && defined(__AVX512DQ__)
static child_mask child_mask_of(int16 mask) { return (ushort)__builtin_ia32_cvtd2mask512(mask); }
#elif TREE_WIDTH == 16 && REAL_IS_DOUBLE && defined(__AVX512DQ__)
static child_mask child_mask_of(long16 mask) {
    return (child_mask)(uchar)__builtin_ia32_cvtq2mask512(mask.lo) |
           (child_mask)(uchar)__builtin_ia32_cvtq2mask512(mask.hi) << 8;
}
#elif TREE_WIDTH == 8 && !REAL_IS_DOUBLE && defined(__AVX512DQ__) && defined(__AVX512VL__)
static child_mask child_mask_of(int8 mask) { return (uchar)__builtin_ia32_cvtd2mask256(mask); }
#elif TREE_WIDTH == 8 && !REAL_IS_DOUBLE && defined(__AVX__)
static child_mask child_mask_of(int8 mask) { return (child_mask)__builtin_ia32_movmskps256(as_float8(mask)); }
#elif TREE_WIDTH >= 8
/* Byte l holds bit l; the product adds them up in its highest byte. */
static child_mask bits_of_bytes(ulong bytes) {
    return (child_mask)(((bytes & (ulong)0x8040201008040201) * (ulong)0x0101010101010101) >> 56);
}
#if TREE_WIDTH == 16
static child_mask child_mask_of(JOIN(REAL_MASK, 16) mask) {
    const ulong2 bytes = as_ulong2(convert_char16(mask));
    return bits_of_bytes(bytes.x) | bits_of_bytes(bytes.y) << 8;
}
#else
static child_mask child_mask_of(JOIN(REAL_MASK, 8) mask) { return bits_of_bytes(as_ulong(convert_char8(mask))); }
#endif
#elif TREE_WIDTH == 4
static child_mask child_mask_of(JOIN(REAL_MASK, 4) mask) {
    return ((child_mask)mask.x & 1u) | ((child_mask)mask.y & 2u) | ((child_mask)mask.z & 4u) | ((child_mask)mask.w & 8u);
}
#else
static child_mask child_mask_of(JOIN(REAL_MASK, 2) mask) {
    return ((child_mask)mask.x & 1u) | ((child_mask)mask.y & 2u);
}
#endif

/* The lowest lane of a set: the number of zeros below the lowest bit, 32 for the empty set. Compilers know this form
 * and have an instruction for it. */
static uint lowest_bit(child_mask set) { return popcount(~set & (set - 1u)); }
static child_mask without_lowest_bit(child_mask set) { return set & (set - 1u); }
static child_mask without_bit(child_mask set, uint lane) { return set & ~((child_mask)1 << lane); }

/* `inside` for the lanes of the set, `outside` for the others. */
static wide choose_children(child_mask set, wide inside, real outside) {
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
static real least_of_children(wide x) {
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
