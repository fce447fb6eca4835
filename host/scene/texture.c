/* texture.c: see texture.h. */
#include "texture.h"

#include "base/words.h"
#include "image/texels.h"
#include "vector.h"

#include <math.h>

#define PI 3.14159265358979323846

const char *const bp_texture_type_names[] = {
#define NAME(identifier, name, effect, has, mapping) name,
    BP_TEXTURE_LIST(NAME)
#undef NAME
};
const BpTextureTraits bp_texture_types[] = {
#define TRAITS(identifier, name, effect, has, mapping) {has, mapping},
    BP_TEXTURE_LIST(TRAITS)
#undef TRAITS
};
const size_t bp_texture_type_count = sizeof bp_texture_type_names / sizeof bp_texture_type_names[0];
#define MAPPING_WORDS(X) X(BP_MAPPING_SOLID, "solid") X(BP_MAPPING_SURFACE, "surface")
BP_WORDS(BpMapping, const char *const bp_mapping_names, MAPPING_WORDS);
const size_t bp_mapping_count = sizeof bp_mapping_names / sizeof bp_mapping_names[0];
#define PATTERN_WORDS(X)                                                                                     \
    X(BP_PATTERN_PERLIN, "perlin")                                                                           \
    X(BP_PATTERN_TURBULENCE, "turbulence") X(BP_PATTERN_MARBLE, "marble") X(BP_PATTERN_WOOD, "wood")
BP_WORDS(BpPattern, const char *const bp_pattern_names, PATTERN_WORDS);
const size_t bp_pattern_count = sizeof bp_pattern_names / sizeof bp_pattern_names[0];
#define WRAP_WORDS(X) X(BP_WRAP_REPEAT, "repeat") X(BP_WRAP_CLAMP, "clamp")
BP_WORDS(BpWrap, const char *const bp_wrap_names, WRAP_WORDS);
const size_t bp_wrap_count = sizeof bp_wrap_names / sizeof bp_wrap_names[0];
const char *const bp_axis_names[] = {"x", "y", "z"};
const size_t bp_axis_count = sizeof bp_axis_names / sizeof bp_axis_names[0];

void bp_texture_defaults(BpTexture *texture) {
    *texture =
        (BpTexture){.size = 1, .up = {0, 1, 0}, .repeat = {1, 1}, .octaves = 1, .axis = 2, .period = 1};
}

typedef struct PatternDefaults {
    uint32_t octaves;
    double distortion;
} PatternDefaults;

#define PATTERN_DEFAULTS(X)                                                                                  \
    X(BP_PATTERN_PERLIN, BP_BRACED(1, 0))                                                                    \
    X(BP_PATTERN_TURBULENCE, BP_BRACED(7, 0))                                                                \
    X(BP_PATTERN_MARBLE, BP_BRACED(7, 1.6)) X(BP_PATTERN_WOOD, BP_BRACED(2, 0.3))
BP_WORDS(BpPattern, static const PatternDefaults pattern_defaults, PATTERN_DEFAULTS);

void bp_texture_pattern_defaults(BpTexture *texture) {
    texture->octaves = pattern_defaults[texture->pattern].octaves;
    texture->distortion = pattern_defaults[texture->pattern].distortion;
    texture->period = texture->size;
}

bool bp_texture_has_waves(const BpTexture *texture) {
    return bp_texture_has(texture, BP_TEXTURE_PATTERN) &&
           (texture->pattern == BP_PATTERN_MARBLE || texture->pattern == BP_PATTERN_WOOD);
}

/* `v` turned about the unit vector `axis` by the angle of which these are the cosine and the sine (O.
 * Rodrigues, 1840). */
static void rotate(double v[3], const double axis[3], double cosine, double sine) {
    double across[3];
    bp_cross(axis, v, across);
    const double along = bp_dot(axis, v) * (1 - cosine);
    for (int i = 0; i < 3; i++) v[i] = v[i] * cosine + across[i] * sine + axis[i] * along;
}

void bp_texture_frame(const BpTexture *texture, double seam[3], double east[3], double pole[3]) {
    static const double minus_x[3] = {-1, 0, 0}, y[3] = {0, 1, 0}, z[3] = {0, 0, 1};
    double axis[3], length = 0;
    memcpy(seam, minus_x, sizeof minus_x);
    memcpy(east, z, sizeof z);
    for (int i = 0; i < 3; i++) length = hypot(length, texture->up[i]);
    for (int i = 0; i < 3; i++) pole[i] = texture->up[i] / length;
    bp_cross(y, pole, axis);
    const double sine = hypot(axis[0], axis[2]);
    if (sine > 0) {
        for (int i = 0; i < 3; i++) axis[i] /= sine;
        rotate(seam, axis, pole[1], sine);
        rotate(east, axis, pole[1], sine);
    } else if (pole[1] < 0) { /* half a turn about x */
        east[2] = -1;
    }
    const double turn = texture->turn_degrees * (PI / 180);
    rotate(seam, pole, cos(turn), sin(turn));
    rotate(east, pole, cos(turn), sin(turn));
}

void bp_texture_bound(const BpTexture *texture, double bound[3]) {
    if (bp_texture_has(texture, BP_TEXTURE_FILE)) {
        memcpy(bound, texture->image->bound, sizeof texture->image->bound);
        return;
    }
    for (int c = 0; c < 3; c++) bound[c] = fmax(texture->colors[0][c], texture->colors[1][c]);
}

bool bp_texture_is_number(const BpTexture *texture) {
    bool equal = true;
    if (bp_texture_has(texture, BP_TEXTURE_FILE)) return texture->image->is_gray;
    for (int i = 0; i < 2; i++)
        for (int c = 1; c < 3; c++) equal = equal && texture->colors[i][c] == texture->colors[i][0];
    return equal;
}
