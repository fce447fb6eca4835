/* patterns.cl: marble, wood and other patterns of noise, as shares of two colours.
 *
 * In:    a point, a texture of noise.   Out: a colour.
 * Knows: noise.cl, lattice.cl, sin_cos_turn (warps.cl), PackedTexture (scene_types.h).   Does not know: what the colour is for. */
#if EFFECT_TEXTURES && EFFECT_NOISE
/* Of a and b and c, the one whose number `axis` is. */
static vreal by_axis(vuint axis, vreal a, vreal b, vreal c) {
    return choose(vbool_of_uint(axis == splat_uint(0)), a, choose(vbool_of_uint(axis == splat_uint(1)), b, c));
}

/* How many waves lie between the origin's plane and the point, along the axis, except for a whole number. */
static vreal waves_along(const Scene *scene, vuint numbers, vuint axis, const Point *point) {
    vuint cell;
    vreal waves;
    lattice_axis(0, by_axis(axis, point->high.x, point->high.y, point->high.z),
                 by_axis(axis, point->low.x, point->low.y, point->low.z),
                 gather_real(scene->textures + TEXTURE_WAVE, numbers),
                 gather_real(scene->textures + TEXTURE_WAVE_LOW, numbers),
                 gather_real(scene->textures + TEXTURE_WAVE_REST, numbers), splat_uint(0), &cell, &waves);
    return waves;
}

/* From the axis through the origin to the point, along one coordinate. */
static vrefined from_origin(const Scene *scene, vuint place, vreal high, vreal low) {
    const vreal centre = gather_real(scene->textures, place);
    const vreal centre_low = gather_real(scene->textures + (TEXTURE_CENTRE_LOW - TEXTURE_CENTRE), place);
    return (to_refined(high) - to_refined(centre)) + (to_refined(low) - to_refined(centre_low));
}

/* How many waves lie between the axis and the point, except for a whole number. */
static vreal waves_around(const Scene *scene, vuint numbers, vuint axis, const Point *point) {
    const vuint place = numbers + TEXTURE_CENTRE;
    vrefined x = from_origin(scene, place, point->high.x, point->low.x);
    vrefined y = from_origin(scene, place + 1u, point->high.y, point->low.y);
    vrefined z = from_origin(scene, place + 2u, point->high.z, point->low.z);
    x = choose_refined(vbool_of_uint(axis == splat_uint(0)), splat_refined(0), x);
    y = choose_refined(vbool_of_uint(axis == splat_uint(1)), splat_refined(0), y);
    z = choose_refined(vbool_of_uint(axis == splat_uint(2)), splat_refined(0), z);
    const vrefined wave = to_refined(gather_real(scene->textures + TEXTURE_WAVE, numbers)) +
                          to_refined(gather_real(scene->textures + TEXTURE_WAVE_LOW, numbers));
    const vrefined waves = square_root_refined(fma(x, x, fma(y, y, z * z))) * wave;
    return to_real(waves - floor(waves));
}

/* The share of the second colour. */
static vreal pattern_share(const Scene *scene, vuint numbers, vuint kinds, const Point *point, vuint pattern,
                           vbool active) {
    const LatticePlace place = lattice_place(scene, numbers, kinds, 0, point);
    const vuint octaves = choose_uint(active, gather_uint(scene->texture_kinds + TEXTURE_OCTAVES, kinds), splat_uint(0));
    const vreal noise = octaves_of_noise(place, octaves, gather_uint(scene->texture_kinds + TEXTURE_SEED, kinds));
    const vbool marble = vbool_of_uint(pattern == splat_uint(PATTERN_MARBLE));
    const vbool wood = vbool_of_uint(pattern == splat_uint(PATTERN_WOOD));
    const vbool rough = marble | vbool_of_uint(pattern == splat_uint(PATTERN_TURBULENCE));
    const vreal height = choose(rough, fabs(noise), noise);
    vreal share = choose(rough, height, fma(splat(R(0.5)), height, splat(R(0.5))));
    if (any_lane(active & (marble | wood))) {
        const vuint axis = gather_uint(scene->texture_kinds + TEXTURE_AXIS, kinds);
        vreal waves = splat(0), sine, cosine;
        if (any_lane(active & marble)) waves = waves_along(scene, numbers, axis, point);
        if (any_lane(active & wood)) waves = choose(wood, waves_around(scene, numbers, axis, point), waves);
        waves = fma(gather_real(scene->textures + TEXTURE_DISTORTION, numbers), height, waves);
        sin_cos_turn(at_most(at_least(waves - floor(waves), splat(0)), splat(1)), &sine, &cosine);
        share = choose(marble | wood, fma(splat(R(0.5)), sine, splat(R(0.5))), share);
    }
    return at_most(at_least(share, splat(0)), splat(1));
}

/* Of the texture that begins at `numbers` and `kinds` in its tables; `active`: these lanes want it. */
static Vec3 pattern_colour(const Scene *scene, vuint numbers, vuint kinds, const Point *point, vuint pattern,
                           vbool active) {
    const vreal share = pattern_share(scene, numbers, kinds, point, pattern, active);
    const Vec3 first = vec3(gather_real(scene->textures + TEXTURE_FIRST, numbers),
                            gather_real(scene->textures + (TEXTURE_FIRST + 1u), numbers),
                            gather_real(scene->textures + (TEXTURE_FIRST + 2u), numbers));
    const Vec3 second = vec3(gather_real(scene->textures + TEXTURE_SECOND, numbers),
                             gather_real(scene->textures + (TEXTURE_SECOND + 1u), numbers),
                             gather_real(scene->textures + (TEXTURE_SECOND + 2u), numbers));
    return madd3(share, subtract3(second, first), first);
}
#endif
