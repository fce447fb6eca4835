/* vary_surface.cl: evaluates the textures of a surface at its point.
 *
 * In:    surfaces as fetch_surface leaves them, their points and outward normals, and places on maps.   Out: the same, with their textures.
 * Knows: PackedVariation (scene_types.h), each texture by its one function.   Does not know: paths. */
#if EFFECT_TEXTURES
/* Of the types whose effect is TEXTURES, those before PATTERN_PERLIN, which every scene with textures has. A second one makes
 * this a function that chooses by PATTERN_... */
#define basic_texture checker_colour

/* Of the texture with this number, counted from 1, in the `active` lanes. */
static Vec3 texture_value(const Scene *scene, vuint number, const Point *point, WITH_PLACE(const MapPlace *place) Vec3 outward,
                          vbool active) {
    const vuint index = choose_uint(active, number - splat_uint(1), splat_uint(0));
    const vuint numbers = index * TEXTURE_REALS, kinds = index * TEXTURE_UINTS;
#if EFFECT_NOISE || EFFECT_IMAGES
    const vuint pattern = gather_uint(scene->texture_kinds + TEXTURE_PATTERN, kinds);
    Vec3 value = zero3();
    vbool rest = active;
#if EFFECT_IMAGES
    const vbool image = rest & vbool_of_uint(pattern == splat_uint(PATTERN_IMAGE));
    if (any_lane(image)) value = image_texture(scene, numbers, kinds, WITH_PLACE(place) outward, image);
    rest = rest & vbool_not(image);
#endif
#if EFFECT_NOISE
    const vbool noisy = rest & vbool_of_uint(pattern >= splat_uint(PATTERN_PERLIN));
    if (any_lane(noisy))
        value = choose3(noisy, pattern_colour(scene, numbers, kinds, point, pattern, noisy), value);
    rest = rest & vbool_not(noisy);
#endif
    if (any_lane(rest))
        value = choose3(rest, basic_texture(scene, numbers, kinds, point, WITH_PLACE(place) outward, rest), value);
    return value;
#else
    return basic_texture(scene, numbers, kinds, point, WITH_PLACE(place) outward, active);
#endif
}

/* What the sphere or triangle in `slot` emits at a point, in the `active` lanes: `radiance`, except for materials whose light varies. */
static Vec3 vary_radiance(const Scene *scene, vuint slot, const Point *point, WITH_PLACE(const MapPlace *place) Vec3 outward,
                          vbool active, Vec3 radiance) {
    const vuint material = gather_split_uint(scene->slot_material, 0, slot);
    const vuint number = gather_uint(scene->variations + VARIATION_EMIT, material * VARIATION_UINTS);
    const vbool varies = active & vbool_of_uint(number != splat_uint(0));
    if (!any_lane(varies)) return radiance;
    return choose3(varies, texture_value(scene, number, point, WITH_PLACE(place) outward, varies), radiance);
}

/* For the lanes `met`, each in a slot. One member after the other, in a loop, so that the code of textures is there once. */
static void vary_surface(const Scene *scene, vbool met, vuint slot, const Point *point, WITH_PLACE(const MapPlace *place) Vec3 outward,
                         Surface *surface, Vec3 *emitted) {
    const vuint material = gather_split_uint(scene->slot_material, 0, choose_uint(met, slot, splat_uint(0)));
    for (uint member = 0; member < VARIATIONS; ++member) {
        const vuint number = gather_uint(scene->variations, material * VARIATION_UINTS + member);
        const vbool varies = met & vbool_of_uint(number != splat_uint(0));
        if (!any_lane(varies)) continue;
        const Vec3 value = texture_value(scene, number, point, WITH_PLACE(place) outward, varies);
        if (member == VARIATION_ALBEDO) surface->albedo = choose3(varies, value, surface->albedo);
#if EFFECT_METAL
        if (member == VARIATION_FUZZ) surface->fuzz = choose(varies, at_most(value.x, splat(1)), surface->fuzz);
#endif
        if (member == VARIATION_EMIT) *emitted = choose3(varies, value, *emitted);
    }
}
#else
#define vary_surface(scene, met, slot, point, outward, surface, emitted)
#endif
