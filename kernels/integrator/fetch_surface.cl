/* fetch_surface.cl: the sphere and the material at a hit, gathered for all lanes from the packed tables. */

/* The packed structs as the gathers see them: arrays of their only type. */
#define MATERIAL_UINTS ((uint)(sizeof(PackedMaterialKind) / sizeof(uint)))
#define MATERIAL_REALS ((uint)(sizeof(PackedMaterial) / sizeof(real)))

/* The sphere and the material at each lane's slot; lanes that met nothing get those of slot 0. */
static void look_up(const Scene *scene, const Meeting *meeting, Vec3 *centre, reals *radius, Surface *surface,
                    Vec3 *emitted) {
    const uints slot = choose_uint(meeting->met, meeting->slot, splat_uint(0));
    const uints lane = slot % TREE_WIDTH;
    const uints place = (slot - lane) * 4u + lane;
    *centre = vec3(gather_reals(scene->geometry.leaves, place),
                   gather_reals(scene->geometry.leaves, place + (uint)TREE_WIDTH),
                   gather_reals(scene->geometry.leaves, place + (uint)(2 * TREE_WIDTH)));
    *radius = gather_reals(scene->geometry.leaves, place + (uint)(3 * TREE_WIDTH));
    const uints material = gather_uints(scene->slot_material, slot);
    const uints colour = slot * (uint)ALBEDO_REALS;
    const uints numbers = material * MATERIAL_REALS;
    const uints kinds = material * MATERIAL_UINTS;
    surface->albedo = vec3(gather_reals(scene->slot_albedo, colour), gather_reals(scene->slot_albedo, colour + 1u),
                           gather_reals(scene->slot_albedo, colour + 2u));
    surface->kind = gather_uints(scene->kinds, kinds);
    *emitted = zero3();
#if EFFECT_EMISSION
    *emitted = vec3(gather_reals(scene->materials, numbers), gather_reals(scene->materials, numbers + 1u),
                    gather_reals(scene->materials, numbers + 2u));
#endif
#if EFFECT_LAMBERTIAN
    surface->lobe = gather_uints(scene->kinds, kinds + MATERIAL_LOBE);
#endif
#if EFFECT_METAL
    surface->fuzz = gather_reals(scene->materials, numbers + MATERIAL_FUZZ);
#endif
#if EFFECT_METAL || EFFECT_DIELECTRIC
    surface->variant = gather_uints(scene->kinds, kinds + MATERIAL_VARIANT);
#endif
#if EFFECT_DIELECTRIC
    surface->refraction_index = gather_reals(scene->materials, numbers + MATERIAL_INDEX);
    surface->total_reflection = gather_uints(scene->kinds, kinds + MATERIAL_TOTAL_REFLECTION);
#endif
}
