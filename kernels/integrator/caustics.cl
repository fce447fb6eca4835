/* caustics.cl: the light that lamps bring to a point, or to a camera's pixel, through a ball of glass or off a mirror, by two
 * ways that share the work, as in lamps_direct.cl.
 *
 * A path finds such a lamp by chance, or is led to it: a focuser, a lamp and a point of it are chosen, and every chain
 * through the focuser that ends at that point is traced (after D. Mitchell and P. Hanrahan, "Illumination from Curved
 * Reflectors", 1992; all roots are found, so no probability has to be estimated); or, where these would have densities with poles,
 * a direction out of the lamp's image. Both are weighted by the power heuristic
 * with the density of the direction at the vertex. What a chain brings is computed along the ray as it is traced, and
 * both weights from that ray: a root need not be exact.
 *
 * In:    paths that wait to be lit, or that begin; what paths meet.   Out: paths with that light; the weight of a lamp that is met.
 * Knows: focusers.cl, lamps.cl, scatter.cl, vary_surface.cl, the closest hit.   Does not know: how a path goes on. */
#if SAMPLES_CAUSTICS
static int has_focusers(const Scene *scene) { return scene->focuser_places[0] != NO_SLOT; }

/* Follows what the chain of a path becomes where it meets a sphere in the lanes `met`, before it scatters there; the path
 * still is what it was on its way there, and has the lobe of the vertex that it comes from. */
static void follow_chain(const Scene *scene, Path *path, vbool met, const Hit *hit, const BsdfSample *bsdf_sample) {
    if (!has_focusers(scene)) return;
    const vbool outward = (vbool_not(hit->enters) & bsdf_sample->transmitted) | (hit->enters & vbool_not(bsdf_sample->transmitted));
    vuint chain = splat_uint(CHAIN_NONE);
    vbool begins = met & hit->enters & bsdf_sample->scattered & vbool_of_uint(path->lobe.kind != splat_uint(LOBE_NONE));
    if (any_lane(begins)) begins = begins & is_focuser(scene, hit->slot);
    if (any_lane(begins)) {
        vuint number;
        const vreal probability =
            choose_focuser(scene, &path->origin, &path->lobe, splat(0), &hit->slot, &number);
        const vbool enters = begins & (probability > splat(0));
        if (any_lane(enters)) {
            const Focus focus = focus_along(scene, &path->origin, &path->lobe, path->direction, 1, number, probability);
            path->focus.number = choose_uint(enters, focus.number, path->focus.number);
            path->focus.axis = choose3(enters, focus.axis, path->focus.axis);
            path->focus.distance = choose(enters, focus.distance, path->focus.distance);
            path->focus.sine = choose(enters, focus.sine, path->focus.sine);
            path->focus.ratio = choose(enters, focus.ratio, path->focus.ratio);
            path->focus.every = (enters & focus.every) | (vbool_not(enters) & path->focus.every);
            chain = choose_uint(enters, choose_uint(bsdf_sample->transmitted, splat_uint(1), splat_uint(CHAIN_LEFT)), chain);
        }
    }
    /* Within the ball, from one point of its surface to another. */
    const vbool within = met & vbool_not(hit->enters) & vbool_of_uint(path->chain < splat_uint(CHAIN_LEFT)) &
                         vbool_of_uint(hit->slot == path->own_slot);
    const vuint next = choose_uint(outward, path->chain + splat_uint(CHAIN_LEFT), path->chain + splat_uint(1));
    const vbool goes_on = within & (outward | vbool_of_uint(path->chain < splat_uint(CHORDS_MAX)));
    chain = choose_uint(goes_on, next, chain);
    path->chain = choose_uint(met, chain, path->chain);
}

/* The weight of the radiance of a lamp, in a slot or a disc of the sky, that the path meets in the lanes `hit`. */
static vreal chain_hit_weight(const Scene *scene, const Path *path, vuint lamp, vbool hit) {
    const vbool through = hit & vbool_of_uint(path->chain >= splat_uint(CHAIN_LEFT)) &
                          vbool_of_uint(path->chain != splat_uint(CHAIN_NONE));
    if (!any_lane(through)) return splat(1);
    const vuint place = choose_uint(through, path->focus.number, splat_uint(0)) * FOCUSER_UINTS;
    const vuint first = gather_uint(scene->focuser_places + FOCUSER_FIRST, place);
    const vuint count = gather_uint(scene->focuser_places + FOCUSER_COUNT, place);
    vuint target = first;
    vbool known = vbool_none;
    for (uint k = 0;; ++k) {
        const vbool has = through & vbool_of_uint(splat_uint(k) < count);
        if (!any_lane(has)) break;
        const vuint tried = choose_uint(has, first + splat_uint(k), first);
        const vbool same = has & vbool_of_uint(gather_uint(scene->target_lamps, tried) == lamp);
        target = choose_uint(same, tried, target);
        known = known | same;
    }
    if (!any_lane(known)) return splat(1);
    Focus focus = path->focus;
    focus.number = choose_uint(known, focus.number, splat_uint(0));
    const vuint inside = choose_uint(known, path->chain - splat_uint(CHAIN_LEFT), splat_uint(0));
    const TargetImage image = image_of(scene, focus.number, focus.axis, focus.distance, inside, target, known);
    const vreal ratio = chain_ratio(scene, &focus, &image, inside, target, &path->origin, path->direction);
    return weight_of_hit(known, ratio);
}

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

/* Traces the chain that leaves the vertex along `direction`, in the lanes `active`, and adds what it brings. */
static void trace_chain(const Scene *scene, Path *path, const ChainChoice *choice, const TargetImage *image, Vec3 direction,
                        vuint bounce, vbool active) {
    const Geometry *geometry = &scene->geometry;
    const Focus focus = focus_along(scene, &path->origin, &path->lobe, direction, 0, choice->number, choice->probability);
    active = active & (focus.ratio > splat(0));
    if (!any_lane(active)) return;
    const vuint slot = gather_uint(scene->focuser_places, choice->number * FOCUSER_UINTS + FOCUSER_SLOT);
    Ray ray = path_ray(path);
    ray.direction = direction;
#if EFFECT_ROUGH_DIELECTRIC
    ray.inward = turned_inward(&path->lobe, path->direction, direction, path->inward);
#endif
    Surface surface;
    Sphere sphere = sphere_for_ray(geometry, &ray, slot);
    Vec3 weight = vec3(splat(1), splat(1), splat(1));
    path->lamp_rays += popcount(lane_bits(active));
    for (uint leg = 0; any_lane(active); ++leg) {
        /* What this part of the chain has to meet first. */
        const vbool last = vbool_of_uint(choice->inside + splat_uint(1) == splat_uint(leg));
        Hit expected;
        vrefined t;
        vbool enters, meets;
        if (leg == 0) {
            meets = sphere_intersect(&ray, &sphere, &t, &enters);
            meets = meets & enters;
        } else {
            meets = sphere_exit(&ray, &sphere, &t) & vbool_not(last);
            enters = vbool_none;
        }
        expected.t = t;
        expected.slot = slot;
        expected.enters = enters;
        const vbool arrives = active & last;
        if (any_lane(arrives)) {
            const vbool near = arrives & vbool_not(choice->far);
            vbool shines = arrives & choice->far;
#if SAMPLES_DISCS
            if (any_lane(shines)) {
                const vuint disc = choose_uint(vbool_not(shines), splat_uint(0), choice->lamp.slot - splat_uint(DISC_SLOT)) * DISC_REALS;
                const Vec3 off = subtract3(ray.direction, vec3(gather_real(scene->discs, disc), gather_real(scene->discs + 1u, disc),
                                                               gather_real(scene->discs + 2u, disc)));
                shines = shines & (dot3(off, off) <= gather_real(scene->discs + DISC_CHORD2, disc));
            }
#endif
            vrefined to_lamp = splat_refined(REAL_LARGE);
#if SAMPLES_LAMP_TREE
            if (any_lane(near)) {
                vrefined found;
                vbool from_outside;
                const vbool lit = sphere_intersect(&ray, &choice->lamp.sphere, &found, &from_outside);
                shines = shines | (near & lit & from_outside);
                to_lamp = choose_refined(near, found, to_lamp);
            }
#endif
            meets = (meets & vbool_not(arrives)) | shines;
            expected.t = choose_refined(arrives, to_lamp, expected.t);
            expected.slot = choose_uint(arrives, choice->lamp.slot, expected.slot);
            expected.enters = expected.enters | arrives;
        }
        expected.bound = upper_bound(expected.t);
        active = active & meets;
        if (!any_lane(active)) return;
        const Hit first = intersect_closer(geometry, &ray, active, expected);
        active = active & vbool_of_uint(first.slot == expected.slot) & vbool_of_refined(first.t == expected.t);
        const vbool lit = active & last;
        if (any_lane(lit)) {
            const vreal ratio = chain_ratio(scene, &focus, image, choice->inside, choice->target, &ray.origin, ray.direction);
            const Vec3 radiance = radiance_of_lamp(scene, &ray, &choice->lamp, lit);
            const vreal share = divide(ratio, fma(ratio, ratio, splat(1)));
            const Vec3 light = multiply3(multiply3(throughput_along(path, direction), weight), scale3(share, radiance));
            path->radiance = choose3(lit, add3(path->radiance, light), path->radiance);
            active = active & vbool_not(last);
        }
        if (!any_lane(active)) return;
        Point point;
        Vec3 outward, emitted;
        if (leg == 0) {
            expected.slot = choose_uint(active, slot, splat_uint(0));
            fetch_surface(scene, &ray, &expected, &sphere, &surface, &emitted);
        }
        sphere_surface(&ray, &sphere, slot, expected.t, expected.enters, &point, &outward);
        surface.incoming = ray.direction;
        surface.enters = expected.enters;
        surface.normal = choose3(expected.enters, outward, scale3(splat(-1), outward));
#if EFFECT_TEXTURES
#if MAPPED_TRIANGLES
        const MapPlace place = off_triangles();
#endif
        if (leg == 0) vary_surface(scene, active, slot, &point, WITH_PLACE(&place) outward, &surface, &emitted);
#endif
        if (leg == 0) weight = surface.albedo;
        /* Reflected, but where the chain enters the ball or leaves it. */
        const vreal c = at_most(at_least(-dot3(surface.incoming, surface.normal), splat(0)), splat(1));
        Vec3 onward = normalise3(madd3(splat(2) * c, surface.normal, surface.incoming));
        vbool through = vbool_none;
#if EFFECT_DIELECTRIC
        through = vbool_of_uint((choice->inside > splat_uint(0)) &
                                ((choice->inside == splat_uint(leg)) | (splat_uint(leg) == splat_uint(0))));
        if (any_lane(through & active)) {
            Surface clear = surface;
            clear.variant = splat_uint(FRESNEL_NONE);
#if PILOT
            clear.evenly = 0;
#endif
            const BsdfSample bent = dielectric_sample(&clear, path->key, bounce);
            onward = choose3(through, bent.direction, onward);
            active = active & (bent.transmitted | vbool_not(through));
        }
#endif
        ray.origin = point;
        ray.direction = onward;
        ray.cull_margin = cull_margin_of(&point);
        ray.own_slot = slot;
        ray.inward = (expected.enters & through) | (vbool_not(expected.enters) & vbool_not(through));
    }
}

/* Finds the roots of the chain in `choice`, and adds what they bring. `aim`: the unit direction from the centre of the focuser to a
 * point of the target; `far`: its radius over the distance of that point. `u` and `v`, which have chosen that point, choose a
 * direction instead where the image of the target is near a fold or a ring. */
static void seek_chains(const Scene *scene, Path *path, const ChainChoice *choice, Vec3 aim, vreal far, vreal u, vreal v,
                        vuint bounce, vbool active) {
    const vuint place = choice->number * FOCUSER_REALS;
    /* A chain has a segment more than chords, and one to the lamp. */
    active = active & (gather_real(scene->focusers, place + FOCUSER_CHAINS + choice->inside) > splat(0)) &
             vbool_of_uint(path->depth + choice->inside + splat_uint(2) <= splat_uint(scene->max_depth));
    if (!any_lane(active)) return;
    const vreal radius = gather_real(scene->focusers, place + FOCUSER_RADIUS);
    const vreal inverse_index = divide(splat(1), gather_real(scene->focusers, place + FOCUSER_INDEX));
    const Vec3 to_centre =
        subtract3(subtract3(focuser_centre(scene, choice->number), path->origin.high), path->origin.low);
    const vreal inverse = divide(splat(1), square_root(dot3(to_centre, to_centre)));
    const Vec3 axis = scale3(inverse, to_centre);
    const vreal near = radius * inverse;
    const vreal cosine = dot3(axis, aim);
    const Vec3 off = madd3(-cosine, axis, aim);
    const vreal sine = square_root(dot3(off, off));
    /* Straight ahead or behind, any direction across the axis is as good as another. */
    const Vec3 other = choose3(fabs(axis.x) < splat(R(0.5)), vec3(splat(0), axis.z, -axis.y), vec3(-axis.z, splat(0), axis.x));
    const Vec3 across = normalise3(choose3(sine > splat(0), off, other));
    const vbool straight = vbool_of_uint(choice->inside == splat_uint(1)); /* an odd number of chords */
    const vreal target_cosine = choose(straight, cosine, -cosine);
    /* Only a chain that begins to rise has a maximum above 0. */
    const vbool rises = near + far + splat(2) * uint_to_real(choice->inside) * inverse_index > splat(2);
    const TargetImage image =
        image_of(scene, choice->number, axis, divide(splat(1), inverse), choice->inside, choice->target, active);
    /* From here azimuths count: it must not depend on `u` and `v`, as `across` does. */
    Vec3 to_target = across;
    if (any_lane(image.fold | image.ring)) {
        const vbool beside = dot3(image.across, image.across) > splat(0);
        to_target = choose3(beside, image.across, normalise3(other));
    }
    for (uint piece = 0; piece < 3u; ++piece) {
        const vreal side = splat(piece == 2u ? R(-1.0) : R(1.0));
        const vbool by_point = active & vbool_not(image.ring) & (piece == 2u ? vbool_all : rises & vbool_not(image.fold));
        vbool in_band = vbool_none;
        if (piece == 0u) in_band = image.fold | image.ring;
        if (piece == 1u) in_band = image.ring & (image.ring_to > image.ring_from);
        if (!any_lane(by_point | in_band)) continue;
        vreal sine_in, cosine_in;
        const vbool found = chain_root(near, far, inverse_index, choice->inside, target_cosine, side * sine, piece == 0u, by_point,
                                       &sine_in, &cosine_in);
        const vreal aside = sine_in * near;
        const vreal turned = choose(straight, side, -side) * aside;
        Vec3 direction = normalise3(madd3(cosine_of(aside), axis, scale3(turned, across)));
        if (any_lane(in_band)) {
            const vreal from = piece == 0u ? image.from : image.ring_from, to = piece == 0u ? image.to : image.ring_to;
            direction = choose3(in_band, sample_band(&image, axis, to_target, near, from, to, vbool_not(straight), u, v), direction);
        }
        const vbool tried = found | in_band;
        if (any_lane(tried)) trace_chain(scene, path, choice, &image, direction, bounce, tried);
    }
}

/* Lights the vertices of the lanes `active` through a focuser, each by one point of one lamp and by one of the chains to it, or
 * by `every` chain. */
static void light_through_focuser(const Scene *scene, Path *path, vuint bounce, int every, vbool active) {
    if (!has_focusers(scene)) return;
    const vuint dimension = bounce + splat_uint(DIMENSIONS_OF_CAUSTICS);
    ChainChoice choice;
    choice.probability = choose_focuser(scene, &path->origin, &path->lobe, sample_1d(path->key, dimension + CAUSTIC_FOCUSER), 0,
                                        &choice.number);
    const vuint place = choice.number * FOCUSER_REALS, places = choice.number * FOCUSER_UINTS;
    active = active & (choice.probability > splat(0));
    if (!any_lane(active)) return;

    const vreal by_target = sample_1d(path->key, dimension + CAUSTIC_TARGET);
    const vuint first = gather_uint(scene->focuser_places + FOCUSER_FIRST, places);
    const vuint count = gather_uint(scene->focuser_places + FOCUSER_COUNT, places);
    choice.target = first;
    vreal below = splat(0);
    for (uint k = 0;; ++k) {
        const vbool has = vbool_of_uint(splat_uint(k) < count);
        if (!any_lane(has & active)) break;
        const vuint tried = choose_uint(has, first + splat_uint(k), first);
        const vreal share = gather_real(scene->targets, tried * TARGET_REALS + TARGET_SHARE);
        choice.target = choose_uint(has & (below <= by_target) & (share > splat(0)), tried, choice.target);
        below += choose(has, share, splat(0));
    }
    choice.lamp.slot = gather_uint(scene->target_lamps, choice.target);
    choice.far = vbool_of_uint(choice.lamp.slot >= splat_uint(DISC_SLOT));
    const Ray vertex = path_ray(path);
    choice.lamp.sphere = sphere_for_ray(&scene->geometry, &vertex, choose_uint(choice.far, splat_uint(0), choice.lamp.slot));

    vreal u, v, far;
    sample_2d(path->key, dimension + CAUSTIC_POINT, &u, &v);
    const Vec3 aim = sample_target(scene, &choice, gather_real(scene->focusers, place + FOCUSER_RADIUS), u, v, &far);
    const vreal by_chain = sample_1d(path->key, dimension + CAUSTIC_CHAIN);
    const vreal reflects = gather_real(scene->focusers, place + FOCUSER_CHAINS);
    const vreal passes = gather_real(scene->focusers, place + (FOCUSER_CHAINS + 1u));
    choice.inside = choose_uint(by_chain < reflects, splat_uint(0),
                                choose_uint(by_chain < reflects + passes, splat_uint(1), splat_uint(2)));
    for (uint inside = 0; inside <= (every ? CHORDS_MAX : 0u); ++inside) {
        if (every) choice.inside = splat_uint(inside);
        seek_chains(scene, path, &choice, aim, far, u, v, bounce, active);
    }
}

/* The same for camera rays that have not set out yet, in the lanes `fresh`: to the camera a lamp in a ball of glass or in a
 * mirror is a caustic in a few pixels. */
static void light_camera(const Scene *scene, Path *path, vbool fresh) {
    __global const PackedCamera *camera = scene->camera;
    if (!has_focusers(scene) || camera->right[3] == 0) return;
    vreal x, y;
    sample_2d(path->key, splat_uint(DIMENSION_PIXEL), &x, &y);
    const Vec3 ahead = splat3(camera->ahead);
    const vreal t = divide(dot3(ahead, ahead), dot3(ahead, path->direction));
    const Vec3 middle = madd3(splat(R(0.5)) - x, splat3(camera->right),
                              madd3(splat(R(0.5)) - y, splat3(camera->down), scale3(t, path->direction)));
    const vreal inverse = divide(splat(1), square_root(dot3(middle, middle)));
    Lobe lobe = path->lobe;
    lobe.axis = scale3(inverse, middle);
    lobe.fuzz = at_most(splat(camera->right[3]) * inverse, splat(1));
    lobe.kind = splat_uint(LOBE_PIXEL);
    path->lobe = choose_lobe(fresh, &lobe, &path->lobe);
    light_through_focuser(scene, path, splat_uint(DIMENSION_PIXEL), 1, fresh);
}
#else
#define follow_chain(scene, path, met, hit, bsdf_sample)
#define chain_hit_weight(scene, path, lamp, hit) splat(1)
#define light_camera(scene, path, fresh)
#endif
