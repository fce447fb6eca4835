/* sky.cl: the radiance of a ray that meets nothing.
 *
 * In:    a unit direction.   Out: radiance.   Knows: scene_types.h.   Does not know: paths. */
static Vec3 sky_radiance(__global const PackedSky *sky, Vec3 direction) {
    /* fma(a, top - bottom, bottom), so that equal ends give exactly the constant sky. */
    const Vec3 bottom = splat3(sky->bottom), top = splat3(sky->top);
    return madd3(fma(splat(R(0.5)), direction.y, splat(R(0.5))), subtract3(top, bottom), bottom);
}
