/* sampler.cl: the numbers that a path asks for, one or two at a time, independent or low-discrepancy.
 *
 * In:    a sample's key, a dimension (rng.cl's table).   Out: numbers in [0, 1).
 * Knows: rng.cl.   Does not know: what the numbers are for.
 *
 * --sampler sobol: pairs for pixel, lens and the first SOBOL_BOUNCES bounces come from the two-dimensional Sobol
 * sequence, each pair with its own random shuffle of the sample's index and its own Owen scrambling (B. Burley,
 * "Practical Hash-based Owen Scrambling", JCGT 9(4), 2020, with the hash of S. Laine and T. Karras, "Stratified
 * Sampling for Stochastic Transparency", 2011). Each replicate is a sequence of its own, so replicates are
 * independent, and their spread is an honest error bar. */
#if SAMPLER_SOBOL
#define SOBOL_BOUNCES 3u

static vuint reverse_bits(vuint x) {
    x = ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
    x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
    x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
    x = ((x >> 8) & 0x00ff00ffu) | ((x & 0x00ff00ffu) << 8);
    return (x >> 16) | (x << 16);
}

/* A random permutation in which each bit is flipped or not by the bits below it. On reversed bits that is a nested
 * uniform scramble (A. Owen, "Randomly Permuted (t,m,s)-Nets and (t,s)-Sequences", 1995). */
static vuint permute_upwards(vuint x, vuint seed) {
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

/* The second Sobol dimension from the first: Pascal's triangle modulo 2, on bits of place value 1/2, 1/4, ... */
static vuint second_dimension(vuint x) {
    x ^= (x & 0x55555555u) << 1;
    x ^= (x & 0x33333333u) << 2;
    x ^= (x & 0x0f0f0f0fu) << 4;
    x ^= (x & 0x00ff00ffu) << 8;
    x ^= (x & 0x0000ffffu) << 16;
    return x;
}

static SampleKey scramble_key(SampleKey key) {
    SampleKey scramble = key;
    scramble.a = key.scramble_a;
    scramble.b = key.scramble_b;
    return scramble;
}

/* Dimensions of pixel, lens and the first bounces. */
static vbool is_low(vuint dimension) {
#if SAMPLES_CAUSTICS
    dimension &= splat_uint(DIMENSIONS_OF_CAUSTICS - 1u);
#endif
    return vbool_of_uint(dimension < splat_uint(DIMENSION_BOUNCE + SOBOL_BOUNCES * DIMENSIONS_PER_BOUNCE));
}
#endif

/* `replicates`: K; sample s is number s / K of replicate s mod K. */
static SampleKey sample_key(uint seed_low, uint seed_high, vuint pixel, vuint sample, uint replicates) {
    SampleKey key = mix_key(seed_low, seed_high, pixel, sample);
#if SAMPLER_SOBOL
    /* ~replicate: far from the numbers that samples have, so that no scramble is a sample's own key */
    const SampleKey scramble = mix_key(seed_low, seed_high, pixel, ~(sample % replicates));
    key.scramble_a = scramble.a;
    key.scramble_b = scramble.b;
    key.index_reversed = reverse_bits(sample / replicates);
#endif
    return key;
}

static SampleKey choose_key(vbool mask, SampleKey a, SampleKey b) {
    SampleKey chosen;
    chosen.a = choose_uint(mask, a.a, b.a);
    chosen.b = choose_uint(mask, a.b, b.b);
#if SAMPLER_SOBOL
    chosen.index_reversed = choose_uint(mask, a.index_reversed, b.index_reversed);
    chosen.scramble_a = choose_uint(mask, a.scramble_a, b.scramble_a);
    chosen.scramble_b = choose_uint(mask, a.scramble_b, b.scramble_b);
#endif
    return chosen;
}

static vreal sample_1d(SampleKey key, vuint dimension) {
    vreal u = uniform(key, dimension);
#if SAMPLER_SOBOL
    const vbool low = is_low(dimension);
    if (any_lane(low))
        u = choose(low, bits_to_unit(permute_upwards(key.index_reversed, random_bits(scramble_key(key), dimension))),
                   u);
#endif
    return u;
}

/* Two numbers for a pair of dimensions that begins at `dimension`. */
static void sample_2d(SampleKey key, vuint dimension, vreal *u, vreal *v) {
    *u = uniform(key, dimension);
    *v = uniform(key, dimension + 1u);
#if SAMPLER_SOBOL
    const vbool low = is_low(dimension);
    if (any_lane(low)) {
        const SampleKey scramble = scramble_key(key);
        const vuint x = permute_upwards(key.index_reversed, random_bits(scramble, dimension));
        const vuint y =
            reverse_bits(permute_upwards(reverse_bits(second_dimension(x)), random_bits(scramble, dimension + 1u)));
        *u = choose(low, bits_to_unit(x), *u);
        *v = choose(low, bits_to_unit(y), *v);
    }
#endif
}
