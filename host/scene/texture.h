/* texture.h: a colour, or a number, that varies over surfaces.
 *
 * In:    a texture as its author wrote it.   Out: its frame on a sphere, its largest values.
 * Knows: the grammar's terms.   Does not know: which material has it, how a kernel looks it up.
 *
 * A checker has cells of two colours in turn. Solid, they are cubes of space, and the corner of one is
 * `origin`. Over a surface, they are fields between meridians and parallels of each sphere: the pattern, two
 * fields each way, repeats `repeat[0]` times around and `repeat[1]` times from pole to pole. On a triangle
 * it repeats as often in each unit of the texture coordinates u and v, which go on beyond 0 and 1.
 *
 * Noise is gradient noise (K. Perlin, "Improving Noise", 2002) in the same cubes: n(p), between -1 and 1 and
 * 0 at their corners. Its gradients come from a hash of the corner instead of a table, so it has no period
 * but that of the count of cells, BP_LATTICE_PERIOD. Octave k is n(2^k p) / 2^k, with gradients of its own;
 * s(p) is the sum of all octaves. From a pattern comes a share, which mixes colors[0] and colors[1] and is
 * kept within 0 and 1:
 *
 * - perlin: (1 + s) / 2
 * - turbulence: |s|
 * - marble: (1 + sin(2 pi (a / period + distortion |s|))) / 2, where a is measured along the axis, from the
 *   origin
 * - wood: (1 + sin(2 pi (r / period + distortion s))) / 2, where r is measured from the axis through the
 *   origin
 *
 * The gradient at a corner: x, y, z are its whole numbers modulo BP_LATTICE_PERIOD, as 32 bits; to x is added
 * 2^22 times the octave, to z 0x9e3779b9 times the seed. They are mixed by pcg3d (M. Jarzynski and M. Olano,
 * "Hash Functions for GPU Rendering", 2020), and the upper four bits of the first word, h, choose among the
 * twelve directions to the edges of a cube as Perlin has it: a + b, where a is x for h < 8 and y above, b is
 * y for h < 4, x for 12 and 14, and z for others; a is negative where bit 0 is set, b where bit 1 is.
 *
 * An image covers each sphere by longitude, from its left to its right edge, and latitude, its top at the
 * north pole. It is repeated repeat[0] times in longitude and repeat[1] times in latitude. A clamped image
 * appears only in the first of these places; to the right of it and below, the colours of its edges continue.
 * The middle of a texel has its colour; between the middles of four the colour is bilinear. Beyond the poles
 * and, clamped, beyond the image the nearest texel counts; around, the image is a ring.
 *
 * On a triangle its lower left corner is at u = v = 0 and its upper right one at u = v = 1, if it is not
 * repeated, and it goes on in all directions, as a ring across and upwards. A clamped image appears only in
 * the upper left of its places between 0 and 1. `up` and `turn` mean nothing there. */
#ifndef BP_SCENE_TEXTURE_H
#define BP_SCENE_TEXTURE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct BpImage; /* image/texels.h */

#define BP_TEXTURES_MAX 65536u
#define BP_TEXTURE_REPEAT_MAX 65536u
#define BP_TEXTURE_SIZE_MIN 1.0e-12 /* of a cell, and of a wave; their inverses are floats too */
#define BP_TEXTURE_TURN_MAX 1.0e6   /* degrees */
#define BP_OCTAVES_MAX 12u
#define BP_DISTORTION_MAX 1000.0
#define BP_LATTICE_PERIOD 4194304u /* 2^22 */
#define BP_UV_MAX 1.0e6            /* texture coordinates */
#define BP_COLUMNS_MAX 16777216u   /* 2^24: of an image's texels times its repeats, either way */

typedef enum BpMapping { BP_MAPPING_SOLID, BP_MAPPING_SURFACE } BpMapping;

/* Traits of a type of texture, bits of BpTextureTraits.has. */
enum {
    BP_TEXTURE_COLORS = 1,  /* colors[0] and colors[1], between which its values lie */
    BP_TEXTURE_MAPPING = 2, /* documents choose the mapping; without, it is that of the list */
    BP_TEXTURE_PATTERN = 4, /* a pattern of noise, with octaves and a seed */
    BP_TEXTURE_FILE = 8,    /* an image */
    BP_TEXTURE_TRAITS_END = 16
};

/* X(identifier, name, effect, what it has, mapping): all that is known of a type by its name alone. The
 * effect is the BP_EFFECT_... of packed/effects.h without which its values cannot be computed. */
#define BP_TEXTURE_LIST(X)                                                                                   \
    X(CHECKER, "checker", TEXTURES, BP_TEXTURE_COLORS | BP_TEXTURE_MAPPING, BP_MAPPING_SOLID)                \
    X(NOISE, "noise", NOISE, BP_TEXTURE_COLORS | BP_TEXTURE_PATTERN, BP_MAPPING_SOLID)                       \
    X(IMAGE, "image", IMAGES, BP_TEXTURE_FILE, BP_MAPPING_SURFACE)

typedef enum BpTextureType {
#define BP_TEXTURE_ENUM(identifier, name, effect, has, mapping) BP_TEXTURE_##identifier,
    BP_TEXTURE_LIST(BP_TEXTURE_ENUM)
#undef BP_TEXTURE_ENUM
} BpTextureType;

typedef struct BpTextureTraits {
    unsigned has; /* BP_TEXTURE_COLORS ... */
    BpMapping mapping;
} BpTextureTraits;

typedef enum BpWrap { BP_WRAP_REPEAT, BP_WRAP_CLAMP } BpWrap;
typedef enum BpPattern {
    BP_PATTERN_PERLIN,
    BP_PATTERN_TURBULENCE,
    BP_PATTERN_MARBLE,
    BP_PATTERN_WOOD
} BpPattern;

typedef struct BpTexture {
    char *name; /* first: bp_node_find() */
    BpTextureType type;
    BpMapping mapping;
    double colors[2][3]; /* of even cells, and of odd ones; of noise at 0 and at 1; numbers are colours of
                            three equal parts */
    /* Solid: */
    double size;      /* of a cell, in the scene's unit */
    double origin[3]; /* a corner of the cells */
    /* Over a surface: */
    double up[3];        /* from the south to the north pole, of any length */
    double turn_degrees; /* about `up`, counter-clockwise seen from its tip */
    uint32_t repeat[2];
    /* Image: */
    struct BpImage *image; /* one of the scene's */
    BpWrap wrap;
    /* Noise: */
    BpPattern pattern;
    uint32_t octaves, seed;
    /* Marble and wood: */
    int axis;          /* 0 x, 1 y, 2 z */
    double period;     /* the length of a wave */
    double distortion; /* by how many waves noise of 1 moves them */
} BpTexture;

extern const char *const bp_texture_type_names[];
extern const BpTextureTraits bp_texture_types[];
extern const size_t bp_texture_type_count;
extern const char *const bp_mapping_names[];
extern const size_t bp_mapping_count;
extern const char *const bp_pattern_names[];
extern const size_t bp_pattern_count;
extern const char *const bp_wrap_names[];
extern const size_t bp_wrap_count;
extern const char *const bp_axis_names[];
extern const size_t bp_axis_count;

/* Whether its type has this: one of BP_TEXTURE_COLORS ... */
static inline bool bp_texture_has(const BpTexture *texture, unsigned what) {
    return (bp_texture_types[texture->type].has & what) != 0;
}

/* Sets every optional member to its default, and no name. */
void bp_texture_defaults(BpTexture *texture);
/* Sets the defaults of the pattern: its octaves, its distortion, and a wave as long as a cell. */
void bp_texture_pattern_defaults(BpTexture *texture);
/* Whether the texture has waves. */
bool bp_texture_has_waves(const BpTexture *texture);

/* Unit vectors of a sphere's map: longitude is 0 at `seam`, a quarter at `east`; the north pole is `pole`.
 * With `up` [0, 1, 0] and no turn, the seam is at -x and the quarter at z, as in the second book. Another
 * `up` tilts that the shortest way. */
void bp_texture_frame(const BpTexture *texture, double seam[3], double east[3], double pole[3]);

/* The largest values that it can have. */
void bp_texture_bound(const BpTexture *texture, double bound[3]);

/* Whether its values are numbers: red, green and blue are equal everywhere. */
bool bp_texture_is_number(const BpTexture *texture);

#endif
