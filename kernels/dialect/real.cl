/* real.cl: the numbers that every other kernel file is written in.
 *
 * Out:   real, refined, their constants, JOIN, FORCE_INLINE, ON_CHAINS, VECTORS_WRITTEN, READ_AHEAD.   Does not know: lanes (lanes.cl).
 *
 * The program's first lines (host/opencl/program.c) define:
 *   REAL_IS_DOUBLE    0 or 1: what `real` is
 *   REFINE_IS_DOUBLE  0 or 1: whether intersections are refined in double (always 1 with REAL_IS_DOUBLE)
 *   OWN_ROUNDING      0 or 1: quotients and roots of floats are rounded by divide.cl, not by the device
 *   TREE_WIDTH        2, 4, 8 or 16: lanes of a tree node and of a leaf
 *   PACKET_LANES      8 or 16: paths that a work-item of the packet form follows at a time
 *   SAMPLES_PER_ITEM  pixel samples that it traces in all
 *   GROUP_MAX         work-items in a work-group of the sample form, at most
 *   EFFECT_...        0 or 1, one for each effect
 *   FOCUSER_PAIRS     0 or 1: light may come by way of two balls of glass or mirrors in turn
 *   TRIANGLES_ALONE   0 or 1: there are no spheres, no media, and no part of the sky that rays are sent to
 *   ACCELERATION_TREE 0 or 1: spheres are found through a tree, or are a list
 *
 * Rounding is part of the product: no contraction of a*b+c unless fma() is written. */
#pragma OPENCL FP_CONTRACT OFF

/* Clang warns where functions pass vectors that are wider than the processor's, since other compilers may pass them
 * in another way. None are called here, and PoCL would write the number of warnings to the user's terminal. */
#ifdef __clang__
#pragma clang diagnostic ignored "-Wpsabi"
#endif

#if REAL_IS_DOUBLE || REFINE_IS_DOUBLE
#pragma OPENCL EXTENSION cl_khr_fp64 : enable
#endif

#define JOIN_(a, b) a##b
#define JOIN(a, b) JOIN_(a, b)

#if REAL_IS_DOUBLE
#define REAL double
#define REAL_MASK long
/* The distance between 1 and the next larger real, halved: the unit roundoff u. */
#define ROUNDOFF 0x1p-53
#define REAL_LARGE 1e300
#define REAL_MAX DBL_MAX
#define R(literal) literal
#else
#define REAL float
#define REAL_MASK int
#define ROUNDOFF 0x1p-24f
#define REAL_LARGE 1e38f
#define REAL_MAX FLT_MAX
#define R(literal) literal##f
#endif
typedef REAL real;
typedef JOIN(REAL, 4) real4;

#if REFINE_IS_DOUBLE
#define REFINED double
#define REFINED_MASK long
#else
#define REFINED REAL
#define REFINED_MASK REAL_MASK
#endif
typedef REFINED refined;

/* There is code for spheres. */
#define SPHERES_MET (!TRIANGLES_ALONE)
#if SPHERES_MET
#define WITH_SPHERE(sphere) sphere,
#else
#define WITH_SPHERE(sphere)
#endif
/* Triangles may have normals and texture coordinates at their vertices. Where a ray meets one is then known by its shares of two
 * vertices. */
#define SMOOTH_TRIANGLES (EFFECT_TRIANGLES && EFFECT_SMOOTH_NORMALS)
#define MAPPED_TRIANGLES (EFFECT_TRIANGLES && EFFECT_TEXTURES && EFFECT_TEXTURE_COORDINATES)
#define SHARES_KNOWN (SMOOTH_TRIANGLES || MAPPED_TRIANGLES)
#if SHARES_KNOWN
#define WITH_SHARES(shares) shares,
#else
#define WITH_SHARES(shares)
#endif
/* Lamps are sampled where the scene has any, at surfaces that scatter into many directions and in media. They are
 * spheres and triangles, in a tree, discs in the sky, and an image around the scene. */
#define IS_LIT (EFFECT_LAMBERTIAN || EFFECT_METAL || EFFECT_MEDIA || EFFECT_OREN_NAYAR || EFFECT_ROUGH_METAL || \
                EFFECT_GLOSSY || EFFECT_ROUGH_DIELECTRIC)
#define SAMPLES_LAMP_TREE (EFFECT_LAMPS && EFFECT_EMISSION && IS_LIT)
#define SAMPLES_TRIANGLES (SAMPLES_LAMP_TREE && EFFECT_TRIANGLES && EFFECT_TRIANGLE_LAMPS)
#define SAMPLES_DISCS (EFFECT_LAMPS && EFFECT_DISCS && IS_LIT)
#define SAMPLES_ENVIRONMENT (EFFECT_LAMPS && EFFECT_ENVIRONMENT && IS_LIT)
#define SAMPLES_SKY (SAMPLES_DISCS || SAMPLES_ENVIRONMENT)
#define SAMPLES_LAMPS (SAMPLES_LAMP_TREE || SAMPLES_SKY)
/* Light that such lamps send through balls of glass and off mirrors is sampled too. */
#define SAMPLES_CAUSTICS (EFFECT_CAUSTICS && (SAMPLES_LAMP_TREE || SAMPLES_DISCS) && (EFFECT_METAL || EFFECT_DIELECTRIC))
/* And what two of them lead on, one after the other. */
#define SAMPLES_PAIRS (SAMPLES_CAUSTICS && FOCUSER_PAIRS)
/* Some lobes depend on the direction that light leaves in, and not on the angle to an axis alone. */
#define LOBES_OF_TWO_DIRECTIONS (EFFECT_OREN_NAYAR || EFFECT_ROUGH_METAL || EFFECT_GLOSSY || EFFECT_ROUGH_DIELECTRIC)
/* The weight of some lobes depends on the direction that they draw, so rays to lamps have weights of their own. */
#define WEIGHTED_LOBES (SAMPLES_LAMPS && (EFFECT_ROUGH_METAL || EFFECT_GLOSSY || EFFECT_ROUGH_DIELECTRIC))
/* Triangles and capsules are boundaries of media, too: a path knows the bodies of triangles that it is in by bits. */
#define MEDIA_IN_BODIES (EFFECT_MEDIA && EFFECT_BODY_MEDIA)
#define MEDIA_IN_TRIANGLES (MEDIA_IN_BODIES && EFFECT_TRIANGLES)
#define MEDIA_IN_CAPSULES (MEDIA_IN_BODIES && EFFECT_CAPSULES)
/* Rays go straight through triangles, or nearly so: through those of glass. */
#define GLASS_TRIANGLES (EFFECT_DIELECTRIC && EFFECT_TRIANGLES)
#define PASSES_TRIANGLES (MEDIA_IN_TRIANGLES || GLASS_TRIANGLES || (EFFECT_OPACITY && EFFECT_TRIANGLES))
#if MEDIA_IN_TRIANGLES
#define WITH_BODIES(bodies) bodies,
#else
#define WITH_BODIES(bodies)
#endif
/* Rays to lamps pass the boundaries of media, and so do the paths that are weighted against them. */
#define LAMPS_THROUGH_MEDIA (SAMPLES_LAMPS && EFFECT_MEDIA)
/* And surfaces that let a share of paths on. */
#define LAMPS_THROUGH (SAMPLES_LAMPS && (EFFECT_MEDIA || EFFECT_OPACITY))

/* Some compilers leave parts of a ray's search functions of their own, and pass the ray, or two dozen vectors, through
 * memory. Where nothing is optimised, nothing is inlined either: Oclgrind cannot run what the inliner leaves behind. */
#ifdef __OPTIMIZE__
#define FORCE_INLINE __attribute__((always_inline))
#else
#define FORCE_INLINE
#endif

/* PoCL 3.1 goes through every chain of calls in a kernel, and a function more on the chains doubles them: seconds for a kernel of
 * many effects, where the optimiser does not shorten the chains. Tests that compile without it define SHORT_CHAINS, and the
 * functions that most chains have in common, called from one place or a few, become parts of their callers. */
#ifdef SHORT_CHAINS
#define ON_CHAINS __attribute__((always_inline))
#else
#define ON_CHAINS
#endif

/* Asks the memory for the line of a cache that contains an address, which need not exist. The language's own prefetch()
 * does nothing in PoCL, so this is the compiler's own, where it has one for a processor. Elsewhere nothing is read ahead. */
#define READ_AHEAD(address)
#if defined(__has_builtin) && (defined(__x86_64__) || defined(__aarch64__))
#if __has_builtin(__builtin_prefetch)
#undef READ_AHEAD
#define READ_AHEAD(address) __builtin_prefetch((const void *)(size_t)(address))
#endif
#endif
#define LINE_BYTES 64u

/* Says of a kernel that its vectors are as wide as they are meant to be. Intel's driver for processors otherwise spreads
 * work-items over lanes as well, which takes its compiler ten times as long and makes no kernel of ours faster. */
#define VECTORS_WRITTEN __attribute__((vec_type_hint(float16)))
