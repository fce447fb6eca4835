/* fetch_surface.cl: the sphere, if it is one, and the material at a hit, gathered for all lanes from the packed tables.
 *
 * In:    rays and their hits.   Out: what the materials say; the point, the normal and the direction are the caller's.
 * Knows: scene_types.h, hit.cl, bsdf.cl.   Does not know: paths. */

/* The sphere and the material at each lane's hit; lanes without one get those of slot 0, triangles its sphere. */
static void fetch_surface(const Scene *scene, const Ray *ray, const Hit *hit, WITH_SPHERE(Sphere *sphere) Surface *surface, Vec3 *emitted) {
    const vuint slot = choose_uint(is_hit(hit), hit->slot, splat_uint(0));
#if SPHERES_MET && EFFECT_TRIANGLES
    const vbool flat = is_triangle(&scene->geometry, slot);
    *sphere = sphere_for_ray(&scene->geometry, ray, choose_uint(flat, splat_uint(0), slot));
#elif SPHERES_MET
    *sphere = sphere_for_ray(&scene->geometry, ray, slot);
#endif
    const vuint material = gather_split_uint(scene->slot_material, 0, slot);
#if EFFECT_TRIANGLES
    const vuint colour = choose_uint(vbool_of_uint(slot < splat_uint(scene->coloured_slots)), slot,
                                     scene->coloured_slots + material) * (uint)ALBEDO_REALS;
#else
    const vuint colour = slot * (uint)ALBEDO_REALS;
#endif
    const vuint numbers = material * MATERIAL_REALS;
    const vuint kinds = material * MATERIAL_UINTS;
    surface->albedo = vec3(gather_split_real(scene->slot_albedo, 0, colour), gather_split_real(scene->slot_albedo, 1u, colour),
                           gather_split_real(scene->slot_albedo, 2u, colour));
#if EFFECT_CAPSULES
#if EFFECT_TRIANGLES
    const vbool other_half = sphere->beyond & vbool_not(flat);
#else
    const vbool other_half = sphere->beyond;
#endif
    if (any_lane(other_half)) {
        const vuint capsule = choose_uint(other_half, slot, splat_uint(0));
        surface->albedo = choose3(other_half, other_colour(&scene->geometry, capsule), surface->albedo);
    }
#endif
    surface->kind = gather_uint(scene->material_kinds, kinds);
    *emitted = zero3();
#if SMOOTH_TRIANGLES
    surface->true_normal = zero3();
#endif
#if EFFECT_EMISSION
    *emitted = vec3(gather_real(scene->materials, numbers), gather_real(scene->materials + 1u, numbers),
                    gather_real(scene->materials + 2u, numbers));
#endif
#if EFFECT_LAMBERTIAN
    surface->lobe = gather_uint(scene->material_kinds + MATERIAL_LOBE, kinds);
#endif
#if EFFECT_METAL
    surface->fuzz = gather_real(scene->materials + MATERIAL_FUZZ, numbers);
#endif
#if LOBES_OF_TWO_DIRECTIONS
    surface->roughness = gather_real(scene->materials + MATERIAL_ROUGHNESS, numbers);
#endif
#if EFFECT_METAL || EFFECT_DIELECTRIC
    surface->variant = gather_uint(scene->material_kinds + MATERIAL_VARIANT, kinds);
#endif
#if EFFECT_DIELECTRIC || EFFECT_GLOSSY || EFFECT_ROUGH_DIELECTRIC
    surface->refraction_index = gather_real(scene->materials + MATERIAL_INDEX, numbers);
#endif
#if EFFECT_GLOSSY
    surface->lets_in = gather_real(scene->materials + MATERIAL_LETS_IN, numbers);
#endif
#if EFFECT_DIELECTRIC
    surface->total_reflection = gather_uint(scene->material_kinds + MATERIAL_TOTAL_REFLECTION, kinds);
#endif
}
