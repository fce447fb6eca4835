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
 * Knows: focusers.cl, chain_trace.cl, caustic_pairs.cl.   Does not know: shadows, how a path goes on. */
#if SAMPLES_CAUSTICS
static int has_focusers(const Scene *scene) { return scene->focuser_places[0] != NO_SLOT; }

/* Follows what the chain of a path becomes where it meets a sphere in the lanes `met`, before it scatters there; the path
 * still is what it was on its way there, and has the lobe of the vertex that it comes from. */
static void follow_chain(const Scene *scene, Path *path, vbool met, const Hit *hit, const BsdfSample *bsdf_sample) {
    if (!has_focusers(scene)) return;
    const vbool outward = (vbool_not(hit->enters) & bsdf_sample->transmitted) | (hit->enters & vbool_not(bsdf_sample->transmitted));
    vuint chain = splat_uint(CHAIN_NONE);
    vbool begins = met & hit->enters & bsdf_sample->scattered & vbool_of_uint(path->lobe.kind != splat_uint(LOBE_NONE));
    vuint number;
    if (any_lane(begins)) begins = begins & is_focuser(scene, hit->slot, &number);
    if (any_lane(begins)) {
        const vreal probability =
            choose_focuser(scene, FOCUSER_POWER, &path->origin, &path->lobe, splat(0), &hit->slot, &number);
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
            begin_pair(scene, enters, &hit->slot, focus.ratio * probability, path);
        }
    }
    /* Within the ball, from one point of its surface to another. */
    const vbool within = met & vbool_not(hit->enters) & vbool_of_uint(path->chain < splat_uint(CHAIN_LEFT)) &
                         vbool_of_uint(hit->slot == path->own_slot);
    const vuint next = choose_uint(outward, path->chain + splat_uint(CHAIN_LEFT), path->chain + splat_uint(1));
    const vbool goes_on = within & (outward | vbool_of_uint(path->chain < splat_uint(CHORDS_MAX)));
    chain = choose_uint(goes_on, next, chain);
    chain = follow_pair(scene, met, hit, bsdf_sample, outward, chain, path);
    path->chain = choose_uint(met, chain, path->chain);
}

/* The weight of the radiance of a lamp, in a slot or a disc of the sky, that the path meets in the lanes `hit`. */
static vreal chain_hit_weight(const Scene *scene, const Path *path, vuint lamp, vbool hit) {
    const vbool through = hit & vbool_of_uint(path->chain >= splat_uint(CHAIN_LEFT)) &
                          vbool_of_uint(path->chain < splat_uint(CHAIN_SECOND));
    const vreal by_pair = pair_hit_weight(scene, path, lamp, hit);
    if (!any_lane(through)) return by_pair;
    vuint target;
    const vbool known = find_target(scene, choose_uint(through, path->focus.number, splat_uint(0)), lamp, through, &target);
    if (!any_lane(known)) return by_pair;
    Focus focus = path->focus;
    focus.number = choose_uint(known, focus.number, splat_uint(0));
    const vuint inside = choose_uint(known, path->chain - splat_uint(CHAIN_LEFT), splat_uint(0));
    const TargetImage image = image_of(scene, focus.number, focus.axis, focus.distance, inside, target, known);
    const vreal ratio = chain_ratio(scene, &focus, &image, inside, target, &path->origin, path->direction);
    return choose(known, weight_of_hit(known, ratio), by_pair);
}

/* Traces the chain that leaves the vertex along `direction`, in the lanes `active`, and adds what it brings. */
ON_CHAINS static void trace_chain(const Scene *scene, Path *path, const ChainChoice *choice, const TargetImage *image, Vec3 direction,
                        vuint bounce, vbool active) {
    const Focus focus = focus_along(scene, &path->origin, &path->lobe, direction, 0, choice->number, choice->probability);
    active = active & (focus.ratio > splat(0));
    if (!any_lane(active)) return;
    Ray ray = chain_ray(path, direction);
    Vec3 weight = vec3(splat(1), splat(1), splat(1));
    path->lamp_rays += popcount(lane_bits(active));
    active = pass_ball(scene, path->key, bounce, choice->number, choice->inside, active, &ray, &weight);
    if (any_lane(active)) active = meet_target(scene, choice, &ray, WITH_LEFT(&weight) active);
    if (!any_lane(active)) return;
    const vreal ratio = chain_ratio(scene, &focus, image, choice->inside, choice->target, &ray.origin, ray.direction);
    add_chain(scene, path, choice, &ray, direction, weight, ratio, active);
}

/* Finds the roots of the chain in `choice`, and adds what they bring. `aim`: the unit direction from the centre of the focuser to a
 * point of the target; `far`: its radius over the distance of that point. `u` and `v`, which have chosen that point, choose a
 * direction instead where the image of the target is near a fold or a ring. */
ON_CHAINS static void seek_chains(const Scene *scene, Path *path, const ChainChoice *choice, Vec3 aim, vreal far, vreal u, vreal v,
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
    active = active & is_sought(scene, choice->number, choice->inside, radius * inverse,
                                target_cone(scene, choice->number, choice->target).largest);
    if (!any_lane(active)) return;
    const ChainPlane plane = chain_plane(axis, aim, radius * inverse, far, choice->inside, inverse_index);
    const TargetImage image =
        image_of(scene, choice->number, axis, divide(splat(1), inverse), choice->inside, choice->target, active);
    /* From here azimuths count: it must not depend on `u` and `v`, as `across` does. */
    Vec3 to_target = plane.across;
    if (any_lane(image.fold | image.ring)) {
        const vbool aside = dot3(image.across, image.across) > splat(0);
        to_target = choose3(aside, image.across, normalise3(beside(axis)));
    }
    for (uint piece = 0; piece < 3u; ++piece) {
        const vreal side = splat(piece == 2u ? R(-1.0) : R(1.0));
        const vbool by_point = active & vbool_not(image.ring) & (piece == 2u ? vbool_all : plane.rises & vbool_not(image.fold));
        vbool in_band = vbool_none;
        if (piece == 0u) in_band = image.fold | image.ring;
        if (piece == 1u) in_band = image.ring & (image.ring_to > image.ring_from);
        if (!any_lane(by_point | in_band)) continue;
        vreal sine_in, cosine_in;
        const vbool found = chain_root(plane.near, far, inverse_index, choice->inside, plane.target_cosine, side * plane.sine,
                                       piece == 0u, by_point, &sine_in, &cosine_in);
        Vec3 direction = plane_direction(&plane, side, sine_in);
        if (any_lane(in_band)) {
            const vreal from = piece == 0u ? image.from : image.ring_from, to = piece == 0u ? image.to : image.ring_to;
            direction = choose3(in_band, sample_band(&image, axis, to_target, plane.near, from, to, vbool_not(plane.straight), u, v), direction);
        }
        const vbool tried = found | in_band;
        if (any_lane(tried)) trace_chain(scene, path, choice, &image, direction, bounce, tried);
    }
}

/* Lights the vertices of the lanes `active` through focusers: through a pair, and through one, each by one point of one lamp and by one of the chains to it, or
 * by `every` chain. */
static void light_through_focuser(const Scene *scene, Path *path, vuint bounce, int every, vbool active) {
    if (!has_focusers(scene)) return;
    light_through_pair(scene, path, bounce, active);
    const vuint dimension = bounce + splat_uint(DIMENSIONS_OF_CAUSTICS);
    ChainChoice choice;
    choice.probability = choose_focuser(scene, FOCUSER_POWER, &path->origin, &path->lobe, sample_1d(path->key, dimension + CAUSTIC_FOCUSER), 0,
                                        &choice.number);
    const vuint place = choice.number * FOCUSER_REALS;
    active = active & (choice.probability > splat(0));
    if (!any_lane(active)) return;

    choose_target(scene, path, sample_1d(path->key, dimension + CAUSTIC_TARGET), active, &choice);
    vreal u, v, far;
    sample_2d(path->key, dimension + CAUSTIC_POINT, &u, &v);
    const Vec3 aim = sample_target(scene, &choice, gather_real(scene->focusers, place + FOCUSER_RADIUS), u, v, &far);
    vreal by_chain = sample_1d(path->key, dimension + CAUSTIC_CHAIN);
    choice.inside = choose_chords(scene, choice.number, &by_chain);
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
