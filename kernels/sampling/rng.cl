/* rng.cl: random numbers as a pure function of (seed, pixel, sample, dimension).
 *
 * In:    a key, a dimension.   Out: 32 random bits, or a number in [0, 1).
 * Knows: lanes.cl.   Does not know: what the numbers are for.
 *
 * Nothing is carried along, so neither chunks, nor devices, nor effects that are absent shift a number.
 *
 * Dimensions, by purpose. An effect that is absent leaves its places unused:
 *   0, 1  position in the pixel        2, 3  position on the lens        4  time
 *   5     the colour by which a path flies through media                                    6..15  kept
 *   16 + 16 b + k, for bounce b:
 *     k = 0, 1     direction of scattering
 *     k = 2, 3, 4  radius in a ball (fuzz and the cosine-cubed lobe)
 *     k = 5        choice between reflection and refraction
 *     k = 6        Russian roulette
 *     k = 7        the low bits of a lamp's choice; for level l of the tree of lamps, 2^24 l further on
 *     k = 8, 9     which lamp, and the direction to it
 *     k = 10       the low bits of the choice among the discs of the sky, the image around and the tree of lamps
 *     k = 11, 12   the low bits of the choice of a row of that image, and of a texel in the row
 *     k = 13, 14   a flight through a medium, and its low bits
 *     k = 15       whether the surfaces of the segment that ends there let the path straight on; its low bits, 2^24 further on
 *     Directions that are drawn by rejection: k = 0, 1, 2 and REJECTION_FIRST further on, REJECTION_STRIDE more for each try
 *     Rays through balls of glass and off mirrors have DIMENSIONS_OF_CAUSTICS more: k = 0, 1 the point of the lamp, 2 the
 *     ball or mirror, 3 the chain through it, 4 the lamp; those to the camera have them from DIMENSIONS_OF_CAUSTICS on
 *   A camera ray that meets the shadow catcher ends there, and the places of bounce b are those of try b to find light:
 *   k = 0, 1 the direction, 2 whether it is taken, 5 the gradient or which disc; for b = 1 k = 15 whether surfaces let the light on */
#define DIMENSION_PIXEL 0u
#define DIMENSION_LENS 2u
#define DIMENSION_TIME 4u
#define DIMENSION_FLIGHT_COLOUR 5u
#define DIMENSION_BOUNCE 16u
#define DIMENSIONS_PER_BOUNCE 16u
#define BOUNCE_DIRECTION 0u
#define BOUNCE_BALL_RADIUS 2u
#define BOUNCE_CHOICE 5u
#define BOUNCE_ROULETTE 6u
#define BOUNCE_LAMP_REFILL 7u
#define LAMP_REFILL_STRIDE 0x1000000u
#define BOUNCE_LAMP 8u
#define BOUNCE_DISC_REFILL 10u
#define BOUNCE_SKY_ROW 11u
#define BOUNCE_SKY_COLUMN 12u
#define BOUNCE_FLIGHT 13u
#define BOUNCE_FLIGHT_REFILL 14u
#define BOUNCE_OPACITY 15u
#define OPACITY_REFILL 0x1000000u
#define REJECTION_FIRST 0x80000000u
#define REJECTION_STRIDE 0x1000000u
#if SAMPLES_CAUSTICS
#define DIMENSIONS_OF_CAUSTICS 0x10000000u
#define CAUSTIC_POINT 0u
#define CAUSTIC_FOCUSER 2u
#define CAUSTIC_CHAIN 3u
#define CAUSTIC_TARGET 4u
#endif

/* Of bounce b, counted from 0. */
static vuint first_dimension(vuint b) { return b * DIMENSIONS_PER_BOUNCE + DIMENSION_BOUNCE; }

/* What identifies a pixel sample to the generator. */
typedef struct SampleKey {
    vuint a, b;
#if SAMPLER_SOBOL
    vuint index_reversed;         /* of the sample within its replicate, its bits in reverse */
    vuint scramble_a, scramble_b; /* shared by the samples of a pixel's replicate */
#endif
} SampleKey;

/* pcg4d (M. Jarzynski and M. Olano, "Hash Functions for GPU Rendering", JCGT 9(3), 2020): four words in, four
 * well mixed words out; two of them are the key. */
static SampleKey mix_key(uint seed_low, uint seed_high, vuint pixel, vuint sample) {
    vuint x = pixel * 1664525u + 1013904223u;
    vuint y = sample * 1664525u + 1013904223u;
    vuint z = splat_uint(seed_low * 1664525u + 1013904223u);
    vuint w = splat_uint(seed_high * 1664525u + 1013904223u);
    x += y * w;
    y += z * x;
    z += x * y;
    w += y * z;
    x ^= x >> 16;
    y ^= y >> 16;
    z ^= z >> 16;
    w ^= w >> 16;
    x += y * w;
    y += z * x;
    z += x * y;
    w += y * z;
    SampleKey key;
    key.a = x;
    key.b = w;
    return key;
}

/* 32 random bits for one dimension: a Weyl sequence of odd step (2^32 / golden ratio) through a two-round
 * multiply-xorshift finaliser (constants found by C. Wellons, "hash-prospector", 2018), with the key's second
 * word added between the rounds, so that equal first words do not make equal sequences. */
static vuint random_bits(SampleKey key, vuint dimension) {
    vuint x = key.a + dimension * 0x9e3779b9u;
    x ^= x >> 16;
    x *= 0x21f0aaadu;
    x += key.b;
    x ^= x >> 15;
    x *= 0xd35a2d97u;
    x ^= x >> 15;
    return x;
}

/* [0, 1): the 24 upper bits, so 1 cannot appear by rounding. */
static vreal bits_to_unit(vuint bits) { return uint_to_real(bits >> 8) * R(0x1p-24); }

static vreal uniform(SampleKey key, vuint dimension) { return bits_to_unit(random_bits(key, dimension)); }
