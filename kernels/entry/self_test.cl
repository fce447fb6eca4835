/* self_test.cl: small sums with known answers, run once on every device before it renders.
 *
 * In:    uints and floats that the host made, so that no compiler can work the answers out beforehand.
 * Out:   one row of bits for each work-item; host/opencl/self_test.c knows what stands in each column and
 *        defines COLUMN_... and ROW_COLUMNS for both sides.
 *
 * Knows: the dialect.   Does not know: which answers are right.
 * Each column is something that the kernels rely on; together they find drivers that contract a*b+c, reassociate,
 * flush what they should not, or forget NaN. */

/* A walk of data-dependent length over an implicit binary tree with a private stack, as the traversal does it. */
static uint walk(uint seed) {
    uint stack[32];
    uint top = 0, digest = seed;
    stack[top++] = 1u;
    while (top > 0) {
        const uint node = stack[--top];
        digest = (digest ^ node) * 0x01000193u;
        if (node >= 64u) continue;
        if ((digest >> 20 & 3u) != 0u) stack[top++] = node * 2u + 1u;
        if ((digest >> 22 & 3u) != 0u) stack[top++] = node * 2u;
    }
    return digest;
}

/* What must be true of NaN and infinities, one bit each; `zero` is 0. */
static uint special_values(float zero) {
    const float one = zero + 1.0f;
    const float nan_value = zero / zero, infinity = one / zero, root = sqrt(-one);
    const float chosen = nan_value < zero ? zero : nan_value;
    uint bits = 0;
    if (!(nan_value >= zero)) bits |= 1u;
    if (nan_value != nan_value) bits |= 2u;
    if ((as_uint(nan_value) & 0x7f800000u) == 0x7f800000u && (as_uint(nan_value) & 0x007fffffu) != 0u) bits |= 4u;
    if (as_uint(infinity) == 0x7f800000u) bits |= 8u;
    if ((as_uint(root) & 0x7f800000u) == 0x7f800000u && (as_uint(root) & 0x007fffffu) != 0u) bits |= 16u;
    if ((as_uint(chosen) & 0x7f800000u) == 0x7f800000u && (as_uint(chosen) & 0x007fffffu) != 0u) bits |= 32u;
    if (infinity > 3e38f && -infinity < -3e38f) bits |= 64u;
    return bits;
}

/* Eight comparisons as the bits of one integer, by the vector types that lane code uses. */
static uint vector_lanes(__global const float *values, float limit) {
    const float8 v = vload8(0, values);
    const int8 below = v < (float8)(limit);
    const float8 chosen = select((float8)(0.0f), v, below);
    const ulong bytes = as_ulong(convert_char8(below));
    uint bits = 0;
    for (uint lane = 0; lane < 8u; ++lane)
        if (((bytes >> (8u * lane)) & 0xffUL) == 0xffUL) bits |= 1u << lane;
    if (any(below) != (bits != 0u)) bits |= 0x100u;
    return bits ^ as_uint(chosen.s0) ^ (as_uint(chosen.s7) >> 1);
}

/* The same as COLUMN_CONTRACTION in vectors: which lanes differ from 0. */
static uint fused_lanes(float8 v, float8 w, float zero) {
    const float8 rounded = as_float8(as_uint8(v * w) ^ (uint8)(as_uint(zero)));
    const int8 fused = ((v * w - rounded) != (float8)(0.0f)) | ((rounded - v * w) != (float8)(0.0f));
    return (uint)(as_ulong(convert_char8(fused)) & 0x8040201008040201UL) |
           (uint)((as_ulong(convert_char8(fused)) & 0x8040201008040201UL) >> 32);
}

__kernel void self_test(__global const uint *uints_in, __global const float *floats_in, __global uint *rows) {
    const uint item = (uint)get_global_id(0);
    __global uint *row = rows + item * ROW_COLUMNS;
    const uint m = uints_in[2u * item], n = uints_in[2u * item + 1u];
    __global const float *floats = floats_in + 5u * item;
    const float a = floats[0], b = floats[1], c = floats[2], zero = floats[3];

    row[COLUMN_INTEGERS] = (m * n + (m << 7)) ^ (n >> 9) ^ (mul_hi(m, n) - popcount(m));
    const ulong wide_product = (ulong)m * (ulong)n + ((ulong)n << 32);
    row[COLUMN_LONGS] = (uint)(wide_product >> 32) ^ (uint)wide_product;
    row[COLUMN_FIXED_POINT] = as_uint2(convert_long_rte(a * 65536.0f)).x ^ as_uint2((long)(c * 16777216.0f)).y;
    row[COLUMN_WALK] = walk(m);

    row[COLUMN_UNIT] = as_uint((float)(m >> 8) * 0x1p-24f);
    row[COLUMN_SUM] = as_uint(a + b);
    row[COLUMN_PRODUCT] = as_uint(a * b);
    /* 0 where a * b is rounded before c is taken away, the product's rounding error where the two are fused. */
    const float rounded = as_float(as_uint(a * b) ^ as_uint(zero));
    row[COLUMN_CONTRACTION] = (as_uint(a * b - rounded) | as_uint(rounded - a * b)) << 1;
    row[COLUMN_CONTRACTION_LANES] = fused_lanes((float8)(a, b, c, a, b, c, a, b), (float8)(b, c, a, a, b, c, b, c), zero);
    row[COLUMN_FMA] = as_uint(fma(a, b, c));
    row[COLUMN_FMA_RESIDUE] = as_uint(fma(a, b, -rounded));
    row[COLUMN_DIVIDE] = as_uint(a / b);
    row[COLUMN_SQRT] = as_uint(sqrt(fabs(a)));
    row[COLUMN_ROUNDED_DIVIDE] = as_uint(divide(a, b));
    row[COLUMN_ROUNDED_SQRT] = as_uint(square_root(fabs(a)));
    /* What a + b loses to rounding (D. Knuth, The Art of Computer Programming 2, 4.2.2). */
    const float sum = a + b, b_part = sum - a, a_part = sum - b_part;
    row[COLUMN_SUM_RESIDUE] = as_uint((a - a_part) + (b - b_part));
    row[COLUMN_SPECIAL] = special_values(zero);
    ((__global float *)row)[COLUMN_NAN_BITS] = floats[4];
    row[COLUMN_LANES] = vector_lanes(floats, c);

#if REFINE_IS_DOUBLE
    const double x = (double)a / 3.0, y = (double)b * 1.1;
    row[COLUMN_DOUBLE_FMA] = as_uint2(fma(x, y, -(x * y))).x ^ as_uint2(fma(x, y, -(x * y))).y;
    row[COLUMN_DOUBLE_DIVIDE] = as_uint2(x / y).x ^ as_uint2(x / y).y;
    row[COLUMN_DOUBLE_SQRT] = as_uint2(sqrt(fabs(x))).x ^ as_uint2(sqrt(fabs(x))).y;
    row[COLUMN_DOUBLE_CONTRACTION] = as_uint((float)(x * y - as_double(as_ulong(x * y) ^ (ulong)as_uint(zero)))) << 1;
#endif
}
