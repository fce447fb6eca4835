/* noise.cl: gradient noise in a lattice, and its octaves.
 *
 * In:    a place in the lattice.   Out: noise: 0 at the corners of cells, about -1 to 1 within.
 * Knows: lattice.cl.   Does not know: which pattern is made of it.
 *
 * K. Perlin, "Improving Noise", 2002; gradients come from a hash of integers, which is the same with every kind of real
 * (host/scene/texture.h has the definition). The next octave's place follows from this one's exactly: cells and places are
 * doubled, and a whole part is carried over. */
#if EFFECT_TEXTURES && EFFECT_NOISE
/* pcg3d (M. Jarzynski and M. Olano, "Hash Functions for GPU Rendering", JCGT 9(3), 2020), its first word. */
static vuint hash_corner(vuint x, vuint y, vuint z) {
    x = x * 1664525u + 1013904223u;
    y = y * 1664525u + 1013904223u;
    z = z * 1664525u + 1013904223u;
    x += y * z;
    y += z * x;
    z += x * y;
    x ^= x >> 16;
    y ^= y >> 16;
    z ^= z >> 16;
    return x + y * z;
}

/* The scalar product of (x, y, z) with one of the directions to the edges of a cube, by four bits. */
static vreal gradient_dot(vuint bits, vreal x, vreal y, vreal z) {
    const vreal a = choose(vbool_of_uint(bits < splat_uint(8)), x, y);
    const vbool again = vbool_of_uint((bits == splat_uint(12)) | (bits == splat_uint(14)));
    const vreal b = choose(vbool_of_uint(bits < splat_uint(4)), y, choose(again, x, z));
    return choose(vbool_of_uint((bits & splat_uint(1)) != splat_uint(0)), -a, a) +
           choose(vbool_of_uint((bits & splat_uint(2)) != splat_uint(0)), -b, b);
}

/* From 0 to 1 with two derivatives of 0 at both ends. */
static vreal fade(vreal t) { return t * t * t * fma(t, fma(t, splat(6), splat(-15)), splat(10)); }

static vreal gradient_noise(const LatticePlace *place, uint octave, vuint seed) {
    const Vec3 t = place->in_cell;
    const Vec3 far = vec3(fade(t.x), fade(t.y), fade(t.z));
    vreal sum = splat(0);
    for (uint corner = 0; corner < 8u; ++corner) {
        const uint i = corner & 1u, j = corner >> 1 & 1u, k = corner >> 2;
        const uint mask = LATTICE_PERIOD - 1u;
        const vuint hash = hash_corner((place->x + i & mask) + octave * LATTICE_PERIOD, place->y + j & mask,
                                       (place->z + k & mask) + seed * 0x9e3779b9u);
        const vreal weight =
            (i ? far.x : splat(1) - far.x) * (j ? far.y : splat(1) - far.y) * (k ? far.z : splat(1) - far.z);
        const vreal slope = gradient_dot(hash >> 28, t.x - (real)i, t.y - (real)j, t.z - (real)k);
        sum = fma(weight, slope, sum);
    }
    return sum;
}

static void next_octave(vuint *cell, vreal *in_cell) {
    const vreal doubled = *in_cell + *in_cell;
    const vbool carry = doubled >= splat(1);
    *cell = *cell + *cell + choose_uint(carry, splat_uint(1), splat_uint(0));
    *in_cell = choose(carry, doubled - splat(1), doubled);
}

/* The sum of as many octaves as each lane wants, the next one half as large and half as high. */
static vreal octaves_of_noise(LatticePlace place, vuint octaves, vuint seed) {
    vreal sum = splat(0);
    real height = 1;
    for (uint octave = 0;; ++octave) {
        const vbool wanted = vbool_of_uint(octaves > splat_uint(octave));
        if (!any_lane(wanted)) return sum;
        sum = choose(wanted, fma(splat(height), gradient_noise(&place, octave, seed), sum), sum);
        height *= R(0.5);
        next_octave(&place.x, &place.in_cell.x);
        next_octave(&place.y, &place.in_cell.y);
        next_octave(&place.z, &place.in_cell.z);
    }
}
#endif
