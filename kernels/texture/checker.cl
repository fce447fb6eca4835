/* checker.cl: cells of two colours in turn, in space or over the map of a sphere or a triangle.
 *
 * In:    a point, the outward normal there, a texture.   Out: a colour.
 * Knows: lattice.cl, sphere_map.cl, triangle_map.cl, PackedTexture (scene_types.h).   Does not know: what the colour is for. */
#if EFFECT_TEXTURES
/* The number of a field of `fields` at `place` from 0 to 1, both included. */
static vuint field_at(vreal place, vreal fields) { return to_uint(at_most(floor(place * fields), fields - R(1.0))); }

#if MAPPED_TRIANGLES
static vuint checker_field(const Scene *scene, vuint numbers, const MapPlace *place, Vec3 normal, vbool active) {
    vreal u, v;
    map_place(scene, numbers, place, normal, active, &u, &v);
    const vreal around = gather_real(scene->textures + TEXTURE_FIELDS, numbers);
    const vreal upwards = gather_real(scene->textures + (TEXTURE_FIELDS + 1u), numbers);
    /* A tile has an even number of fields each way, so the next one begins again; beyond a sphere's pole nothing does. */
    const vuint row = choose_uint(place->laid, to_uint(floor(v * upwards)), field_at(v, upwards));
    return to_uint(floor(u * around)) + row;
}
#else
static vuint checker_field(const Scene *scene, vuint numbers, Vec3 normal) {
    vreal axes[9], u, v;
    for (uint i = 0; i < 9; ++i) axes[i] = gather_real(scene->textures + (TEXTURE_AXES + i), numbers);
    sphere_map(normal, vec3(axes[0], axes[1], axes[2]), vec3(axes[3], axes[4], axes[5]),
               vec3(axes[6], axes[7], axes[8]), &u, &v);
    const vreal around = gather_real(scene->textures + TEXTURE_FIELDS, numbers);
    const vreal upwards = gather_real(scene->textures + (TEXTURE_FIELDS + 1u), numbers);
    /* Beyond the seam the first field begins again: u of 1 is u of 0. */
    return to_uint(floor(u * around)) + field_at(v, upwards);
}
#endif

/* Of the texture that begins at `numbers` and `kinds` in its tables; `active`: these lanes want it. */
static Vec3 checker_colour(const Scene *scene, vuint numbers, vuint kinds, const Point *point,
                           WITH_PLACE(const MapPlace *on_map) Vec3 normal, vbool active) {
    const vbool over_surface =
        vbool_of_uint(gather_uint(scene->texture_kinds + TEXTURE_MAPPING, kinds) == splat_uint(MAPPING_SURFACE));
    vuint number = splat_uint(0);
    if (any_lane(active & vbool_not(over_surface))) {
        const LatticePlace place = lattice_place(scene, numbers, kinds, R(1.0) / LATTICE_BESIDE, point);
        number = place.x + place.y + place.z;
    }
#if MAPPED_TRIANGLES
    if (any_lane(active & over_surface))
        number = choose_uint(over_surface, checker_field(scene, numbers, on_map, normal, active & over_surface), number);
#else
    if (any_lane(active & over_surface))
        number = choose_uint(over_surface, checker_field(scene, numbers, normal), number);
#endif
    const vuint colour = numbers + (number & splat_uint(1)) * (TEXTURE_SECOND - TEXTURE_FIRST);
    return vec3(gather_real(scene->textures, colour), gather_real(scene->textures + 1u, colour),
                gather_real(scene->textures + 2u, colour));
}
#endif
