/* sky.cl: the radiance of a ray that meets nothing.
 *
 * In:    its unit direction, and of a camera ray its origin.   Out: radiance.
 * Knows: scene_types.h.   Does not know: paths. */
static Vec3 sky_radiance(__global const PackedSky *sky, Vec3 direction) {
    /* fma(a, top - bottom, bottom), so that equal ends give exactly the constant sky. */
    const Vec3 bottom = splat3(sky->bottom), top = splat3(sky->top);
    const vreal height = dot3(direction, splat3(sky->up));
    const Vec3 radiance = madd3(fma(splat(R(0.5)), height, splat(R(0.5))), subtract3(top, bottom), bottom);
    /* A direction is a unit vector except for rounding, and so may lie a little beyond an end that is black. */
    return vec3(at_least(radiance.x, splat(0)), at_least(radiance.y, splat(0)), at_least(radiance.z, splat(0)));
}

static int has_backdrop(__global const PackedSky *sky) { return sky->backdrop_bottom[3] != 0; }

/* What a camera ray shows in its place. */
static Vec3 backdrop_radiance(__global const PackedSky *sky, Vec3 origin, Vec3 direction) {
    const Vec3 bottom = splat3(sky->backdrop_bottom), top = splat3(sky->backdrop_top);
    const Vec3 ahead = splat3(sky->view_ahead), up = splat3(sky->view_up);
    const vreal distance = divide(splat(sky->view_ahead[3]) - dot3(origin, ahead), dot3(direction, ahead));
    const vreal height = fma(distance, dot3(direction, up), dot3(origin, up));
    const vreal share = at_most(at_least(fma(splat(R(0.5)), height, splat(R(0.5))), splat(0)), splat(1));
    return madd3(share, subtract3(top, bottom), bottom);
}
