/* texture.h: a colour, or a number, that varies over surfaces.
 *
 * In:    a texture as its author wrote it.   Out: what others ask of it: its frame on a sphere, its largest
 * values. Knows: the grammar's terms.   Does not know: which material has it, how a kernel or the reference
 * looks it up.
 *
 * A checker has cells of two colours in turn. Solid, they are cubes of space, and the corner of one is the
 * origin. Over a surface, they are fields between meridians and parallels of each sphere: the pattern, two
 * fields each way, repeats `repeat[0]` times around and `repeat[1]` times from pole to pole. */
#ifndef BP_SCENE_TEXTURE_H
#define BP_SCENE_TEXTURE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define BP_TEXTURES_MAX 65536u
#define BP_TEXTURE_REPEAT_MAX 65536u
#define BP_TEXTURE_SIZE_MIN 1.0e-12 /* of a cell; its inverse is a float too */
#define BP_TEXTURE_TURN_MAX 1.0e6   /* degrees */

typedef enum BpTextureType { BP_TEXTURE_CHECKER } BpTextureType;
typedef enum BpMapping { BP_MAPPING_SOLID, BP_MAPPING_SURFACE } BpMapping;

typedef struct BpTexture {
    char *name;
    BpTextureType type;
    BpMapping mapping;
    double colors[2][3]; /* of even cells, and of odd ones; numbers are colours of three equal parts */
    double size;         /* solid: of a cell, in the scene's unit */
    /* Over a surface: */
    double up[3];        /* from the south to the north pole, of any length */
    double turn_degrees; /* about `up`, counter-clockwise seen from its tip */
    uint32_t repeat[2];
} BpTexture;

extern const char *const bp_texture_type_names[];
extern const size_t bp_texture_type_count;
extern const char *const bp_mapping_names[];
extern const size_t bp_mapping_count;

/* All that the grammar leaves to choose by default; no name. */
void bp_texture_defaults(BpTexture *texture);

/* Unit vectors of a sphere's map: longitude is 0 at `seam`, a quarter at `east`; the north pole is `pole`.
 * With `up` [0, 1, 0] and no turn, the seam is at -x and the quarter at z, as in the second book. Another
 * `up` tilts that the shortest way. */
void bp_texture_frame(const BpTexture *texture, double seam[3], double east[3], double pole[3]);

/* The largest values that it can have. */
void bp_texture_bound(const BpTexture *texture, double bound[3]);

/* Whether its values are numbers: red, green and blue are equal everywhere. */
bool bp_texture_is_number(const BpTexture *texture);

#endif
