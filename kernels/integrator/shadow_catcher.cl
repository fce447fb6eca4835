/* shadow_catcher.cl: a plane that only camera rays meet, and that shows nothing but shadow.
 *
 * In:    paths at their first segment.   Out: which of them meet the plane, and which meet it in shadow.
 * Knows: the sky's gradient and discs, the closest hit.   Does not know: what a path shows then.
 *
 * The shadow at a point is the share of the light that would reach the plane there from the background, by its
 * irradiance in luminance, and that something keeps away: 1 - lit / unlit. A direction is drawn with a density
 * proportional to that unlit light; the point counts as dark if a ray in that direction meets anything. So no ratio is
 * ever taken, and the mean over samples is the share itself.
 *
 * The density is reached by rejection: a part of the light (the gradient at its brightest, or a disc) is chosen by what it
 * could bring at most, a direction from there, and that is taken with the probability of its light times cosine over
 * what was assumed. After CATCHER_TRIES failures, as where no light reaches the plane, nothing is dark. */
#if EFFECT_SHADOW_CATCHER
#define CATCHER_TRIES 64u

/* The lanes of `moving` whose path is a camera ray that meets the upper side of the plane before `hit`; there `distance` becomes
 * how far it is. */
static vbool meets_catcher(const Scene *scene, const Path *path, const Hit *hit, vbool moving, vreal *distance) {
    const Vec3 up = splat3(scene->sky->catcher);
    const vreal above = dot3(path->origin.high, up) - splat(scene->sky->catcher[3]);
    const vreal down = -dot3(path->direction, up);
    /* Parallel rays begin nearer to the spheres than the camera stands (scene_types.h). */
    const vbool ahead = moving & vbool_of_uint(path->depth == splat_uint(0)) & (down > splat(0)) &
                        (fma(splat(scene->sky->catcher_light[3]), down, above) > splat(0)) &
                        (down * splat(R(0x1p80)) > fabs(above));
    const vreal to_plane = divide(above, choose(ahead, down, splat(1)));
    const vbool behind = vbool_of_refined(hit->t < to_refined(to_plane)) & is_hit(hit);
    const vbool at_catcher = ahead & vbool_not(behind);
    *distance = choose(at_catcher, to_plane, *distance);
    return at_catcher;
}

/* A unit direction, uniform over the cap of a disc. */
static Vec3 direction_in_cap(Vec3 axis, vreal cap, vreal u, vreal v) {
    const vreal m = u * cap;
    const vreal cosine = splat(1) - m, radius = square_root(m * (splat(2) - m));
    vreal sine_turn, cosine_turn;
    sin_cos_turn(v, &sine_turn, &cosine_turn);
    Vec3 s, t;
    basis_across(axis, &s, &t);
    return normalise3(madd3(cosine, axis, madd3(radius * cosine_turn, s, scale3(radius * sine_turn, t))));
}

/* A direction from which light would come to the plane, in the `wanted` lanes; returns those that have one. */
static vbool light_of_catcher(const Scene *scene, SampleKey key, vbool wanted, Vec3 *direction) {
    __global const PackedSky *sky = scene->sky;
    const Vec3 up = splat3(sky->catcher);
    vbool open = wanted;
    *direction = up;
    for (uint i = 0; i < CATCHER_TRIES && any_lane(open); ++i) {
        const vuint first = first_dimension(splat_uint(i));
        vreal u, v;
        sample_2d(key, first + BOUNCE_DIRECTION, &u, &v);
        /* The gradient: by the cosine, as a point of the unit sphere around the tip of the normal. */
        const Vec3 tip = add3(up, sample_sphere(u, v));
        const vbool vanished = dot3(tip, up) < splat(R(8.0) * ROUNDOFF);
        Vec3 candidate = normalise3(choose3(vanished, up, tip));
        const vreal height = fma(splat(R(0.5)), dot3(candidate, splat3(sky->up)), splat(R(0.5)));
        vreal share = fma(height, splat(sky->catcher_light[1]), splat(sky->catcher_light[0]));
#if EFFECT_DISCS
        const vreal part = sample_1d(key, first + BOUNCE_CHOICE);
        vreal below = splat(sky->catcher_light[2]);
        for (uint k = 0; k < disc_count(scene); ++k) {
            __global const real *disc = scene->discs + k * DISC_REALS;
            const vbool chosen = (part >= below) & (splat(disc[DISC_CATCHER]) > splat(0));
            below += splat(disc[DISC_CATCHER]);
            if (!any_lane(chosen & open)) continue;
            const Vec3 there = direction_in_cap(splat3(disc + DISC_DIRECTION), splat(disc[DISC_CAP]), u, v);
            candidate = choose3(chosen, there, candidate);
            share = choose(chosen, dot3(there, up), share);
        }
#endif
        const vbool taken = open & (sample_1d(key, first + BOUNCE_BALL_RADIUS) < share);
        *direction = choose3(taken, candidate, *direction);
        open = open & vbool_not(taken);
    }
    return wanted & vbool_not(open);
}

/* The lanes of `caught`, whose path meets the plane at `distance`, where it lies in shadow. */
ON_CHAINS static vbool lies_in_shadow(const Scene *scene, const Path *path, vbool caught, vreal distance) {
    if (!any_lane(caught)) return vbool_none;
    Ray ray = path_ray(path);
    const vbool lit = light_of_catcher(scene, path->key, caught, &ray.direction);
    if (!any_lane(lit)) return vbool_none;
    ray.origin = point_ahead(path, lit, distance);
    ray.cull_margin = cull_margin_of(&ray.origin);
    ray.own_slot = choose_uint(lit, splat_uint(NO_SLOT), path->own_slot);
    ray.inward = path->inward & vbool_not(lit);
    PIECE(last)
    const Hit hit = intersect_opaque(&scene->geometry, path, &ray, lit, &last);
    return lit & is_hit(&hit);
}
#else
#define meets_catcher(scene, path, hit, moving, distance) vbool_none
#define lies_in_shadow(scene, path, caught, distance) vbool_none
#endif
