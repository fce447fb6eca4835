/* chain_trace.cl: rays along the chains by which light comes through balls of glass and off mirrors.
 *
 * In:    a vertex, a direction from there, the focusers and the lamp that the chain is to pass.   Out: whether nothing stops it; the
 *        path with its light.
 * Knows: focusers.cl, lamps.cl, dielectric.cl, vary_surface.cl, the closest hit.   Does not know: how directions are found. */
#if SAMPLES_CAUSTICS
/* Which chain is tried: from a vertex through a focuser to a target. */
typedef struct ChainChoice {
    vuint number, inside, target;
    vreal probability; /* of the focuser */
    LampChoice lamp;   /* its slot and its sphere */
    vbool far;         /* it is a disc */
} ChainChoice;

/* A point of the target, as a unit direction from the centre of the focuser and the radius of that over its distance, which
 * is 0 for a disc. */
static Vec3 sample_target(const Scene *scene, const ChainChoice *choice, vreal radius, vreal u, vreal v, vreal *far) {
    const Vec3 aimed = target_centre(scene, choice->target);
    const vreal extent = gather_real(scene->targets, choice->target * TARGET_REALS + TARGET_EXTENT);
    const Vec3 axis = choose3(choice->far, aimed, subtract3(aimed, focuser_centre(scene, choice->number)));
    const vreal length = square_root(dot3(axis, axis));
    const Vec3 w = scale3(divide(splat(1), length), axis);
    const vreal m = u * extent;
    const vreal along = choose(choice->far, splat(1) - m, length);
    const vreal aside = choose(choice->far, square_root(m * (splat(2) - m)), extent * square_root(u));
    vreal sine, cosine;
    sin_cos_turn(v, &sine, &cosine);
    Vec3 s, t;
    basis_across(w, &s, &t);
    const Vec3 sampled = madd3(along, w, madd3(aside * cosine, s, scale3(aside * sine, t)));
    const vreal inverse = divide(splat(1), square_root(dot3(sampled, sampled)));
    *far = choose(choice->far, splat(0), radius * inverse);
    return scale3(inverse, sampled);
}

/* A number of chords for a focuser, by a number in [0, 1), which becomes another one. */
static vuint choose_chords(const Scene *scene, vuint number, vreal *u) {
    const vuint place = number * FOCUSER_REALS + FOCUSER_CHAINS;
    vuint chosen = splat_uint(0);
    vreal from = splat(0), below = splat(0), share = splat(1);
    for (uint inside = 0; inside <= CHORDS_MAX; ++inside) {
        const vreal part = gather_real(scene->focusers + inside, place);
        const vbool taken = (below <= *u) & (part > splat(0));
        chosen = choose_uint(taken, splat_uint(inside), chosen);
        from = choose(taken, below, from);
        share = choose(taken, part, share);
        below += part;
    }
    *u = at_most(divide(*u - from, share), splat(R(1.0) - ROUNDOFF));
    return chosen;
}

/* A target of the focuser in `choice`, by a number in [0, 1). */
static void choose_target(const Scene *scene, const Path *path, vreal by_target, vbool active, ChainChoice *choice) {
    const vuint places = choice->number * FOCUSER_UINTS;
    const vuint first = gather_uint(scene->focuser_places + FOCUSER_FIRST, places);
    const vuint count = gather_uint(scene->focuser_places + FOCUSER_COUNT, places);
    choice->target = first;
    vreal below = splat(0);
    for (uint k = 0;; ++k) {
        const vbool has = vbool_of_uint(splat_uint(k) < count);
        if (!any_lane(has & active)) break;
        const vuint tried = choose_uint(has, first + splat_uint(k), first);
        const vreal share = gather_real(scene->targets, tried * TARGET_REALS + TARGET_SHARE);
        choice->target = choose_uint(has & (below <= by_target) & (share > splat(0)), tried, choice->target);
        below += choose(has, share, splat(0));
    }
    choice->lamp.slot = gather_uint(scene->target_lamps, choice->target);
    choice->far = vbool_of_uint(choice->lamp.slot >= splat_uint(DISC_SLOT));
    const Ray vertex = path_ray(path);
    choice->lamp.sphere = sphere_for_ray(&scene->geometry, &vertex, choose_uint(choice->far, splat_uint(0), choice->lamp.slot));
}

/* Leads rays that have left a vertex, or a ball, through the ball or off the mirror of a focuser, in the lanes `active`, by so many chords, and returns
 * those that nothing has stopped. `weight`: what is left of their light. */
static vbool pass_ball(const Scene *scene, SampleKey key, vuint bounce, vuint number, vuint inside, vbool active, Ray *ray,
                       Vec3 *weight) {
    const Geometry *geometry = &scene->geometry;
    const vuint slot = gather_uint(scene->focuser_places, number * FOCUSER_UINTS + FOCUSER_SLOT);
    Sphere sphere = sphere_for_ray(geometry, ray, slot);
    Surface surface;
    for (uint leg = 0; leg <= CHORDS_MAX; ++leg) {
        const vbool here = active & vbool_of_uint(splat_uint(leg) <= inside);
        if (!any_lane(here)) break;
        vrefined t;
        vbool enters = vbool_none, meets;
        if (leg == 0)
            meets = sphere_intersect(ray, &sphere, &t, &enters) & enters;
        else
            meets = sphere_exit(ray, &sphere, &t);
        Hit expected;
        expected.t = t;
        expected.slot = slot;
        expected.enters = enters;
        expected.bound = upper_bound(t);
        active = active & (meets | vbool_not(here));
        vbool on = here & meets;
        if (!any_lane(on)) return active;
#if EFFECT_OPACITY
        const vbool seen = sees_through(geometry, ray, on, &expected, weight);
#else
        const Hit first = intersect_closer(geometry, ray, on, expected);
        const vbool seen = vbool_of_uint(first.slot == slot) & vbool_of_refined(first.t == t);
#endif
        on = on & seen;
        active = active & (seen | vbool_not(here));
        if (!any_lane(on)) return active;
        Point point;
        Vec3 outward, emitted;
        if (leg == 0) {
            expected.slot = choose_uint(on, slot, splat_uint(0));
            fetch_surface(scene, ray, &expected, &sphere, &surface, &emitted);
        }
        sphere_surface(ray, &sphere, slot, t, enters, &point, &outward);
        surface.incoming = ray->direction;
        surface.enters = enters;
        surface.normal = choose3(enters, outward, scale3(splat(-1), outward));
#if EFFECT_TEXTURES
#if MAPPED_TRIANGLES
        const MapPlace place = off_triangles();
#endif
        if (leg == 0) vary_surface(scene, on, slot, &point, WITH_PLACE(&place) outward, &surface, &emitted);
#endif
        if (leg == 0) *weight = choose3(on, multiply3(surface.albedo, *weight), *weight);
        /* Reflected, but where the chain enters the ball or leaves it. */
        const vreal c = at_most(at_least(-dot3(surface.incoming, surface.normal), splat(0)), splat(1));
        Vec3 onward = normalise3(madd3(splat(2) * c, surface.normal, surface.incoming));
        vbool through = vbool_none;
#if EFFECT_DIELECTRIC
        through = vbool_of_uint((inside > splat_uint(0)) & ((inside == splat_uint(leg)) | (splat_uint(leg) == splat_uint(0))));
        if (any_lane(through & on)) {
            Surface clear = surface;
            clear.variant = splat_uint(FRESNEL_NONE);
#if PILOT
            clear.evenly = 0;
#endif
            const BsdfSample bent = dielectric_sample(&clear, key, bounce);
            onward = choose3(through, bent.direction, onward);
            active = active & (bent.transmitted | vbool_not(through) | vbool_not(on));
        }
#endif
        ray->origin.high = choose3(on, point.high, ray->origin.high);
        ray->origin.low = choose3(on, point.low, ray->origin.low);
        ray->origin.error = choose(on, point.error, ray->origin.error);
        ray->direction = choose3(on, onward, ray->direction);
        ray->own_slot = choose_uint(on, slot, ray->own_slot);
        ray->cull_margin = cull_margin_of(&ray->origin);
        const vbool inward = (enters & through) | (vbool_not(enters) & vbool_not(through));
        ray->inward = (on & inward) | (vbool_not(on) & ray->inward);
    }
    return active;
}

/* The lanes of `active` whose ray meets the target, and nothing before it that stops all of it: `weight`, what is left. */
static vbool meet_target(const Scene *scene, const ChainChoice *choice, const Ray *ray, WITH_LEFT(Vec3 *weight) vbool active) {
    const vbool near = active & vbool_not(choice->far);
    vbool shines = active & choice->far;
    Hit expected;
    expected.t = splat_refined(REAL_LARGE);
#if SAMPLES_DISCS
    if (any_lane(shines)) {
        const vuint disc = choose_uint(vbool_not(shines), splat_uint(0), choice->lamp.slot - splat_uint(DISC_SLOT)) * DISC_REALS;
        const Vec3 off = subtract3(ray->direction, vec3(gather_real(scene->discs, disc), gather_real(scene->discs + 1u, disc),
                                                        gather_real(scene->discs + 2u, disc)));
        shines = shines & (dot3(off, off) <= gather_real(scene->discs + DISC_CHORD2, disc));
    }
#endif
#if SAMPLES_LAMP_TREE
    if (any_lane(near)) {
        vrefined found;
        vbool from_outside;
        const vbool lit = sphere_intersect(ray, &choice->lamp.sphere, &found, &from_outside);
        shines = shines | (near & lit & from_outside);
        expected.t = choose_refined(near, found, expected.t);
    }
#endif
    if (!any_lane(shines)) return shines;
    expected.slot = choice->lamp.slot;
    expected.enters = vbool_all;
    expected.bound = upper_bound(expected.t);
#if EFFECT_OPACITY
    return sees_through(&scene->geometry, ray, shines, &expected, weight);
#else
    const Hit first = intersect_closer(&scene->geometry, ray, shines, expected);
    return shines & vbool_of_uint(first.slot == expected.slot) & vbool_of_refined(first.t == expected.t);
#endif
}

/* The ray that begins a chain. */
static Ray chain_ray(const Path *path, Vec3 direction) {
    Ray ray = path_ray(path);
    ray.direction = direction;
#if EFFECT_ROUGH_DIELECTRIC
    ray.inward = turned_inward(&path->lobe, path->direction, direction, path->inward);
#endif
    return ray;
}

/* Adds the light of a chain that has come to its target in the lanes `lit`, by the ratio of its densities. */
static void add_chain(const Scene *scene, Path *path, const ChainChoice *choice, const Ray *ray, Vec3 direction, Vec3 weight,
                      vreal ratio, vbool lit) {
    const Vec3 radiance = radiance_of_lamp(scene, ray, &choice->lamp, lit);
    const vreal share = divide(ratio, fma(ratio, ratio, splat(1)));
    const Vec3 light = multiply3(multiply3(throughput_along(path, direction), weight), scale3(share, radiance));
    path->radiance = choose3(lit, add3(path->radiance, light), path->radiance);
}
#endif
