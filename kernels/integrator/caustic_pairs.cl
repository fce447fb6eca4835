/* caustic_pairs.cl: the light that lamps bring to a point through two balls of glass or off two mirrors, one after the other, by
 * two ways that share the work, as in caustics.cl.
 *
 * In:    paths that wait to be lit; what paths meet.   Out: paths with that light; the weight of a lamp that is met.
 * Knows: focuser_pairs.cl, chain_trace.cl.   Does not know: how chains through one ball are sought, how a path goes on.
 *
 * A pair, a lamp, a point of it and the number of chords are chosen by the numbers that choose a chain through one ball. */
#if SAMPLES_PAIRS
/* A chain has begun in the lanes `enters`; `density`: of its direction at the vertex. */
static void begin_pair(const Scene *scene, vbool enters, const vuint *slot, vreal density, Path *path) {
    vuint number;
    const vreal probability = choose_focuser(scene, FOCUSER_PAIR_POWER, &path->origin, &path->lobe, splat(0), slot, &number);
    const vbool sought = probability > splat(0);
    const vreal ratio = choose(sought, divide(density, choose(sought, probability, splat(1))), splat(0));
    path->chain_begins = choose3(enters, path->direction, path->chain_begins);
    path->pair_density = choose(enters, ratio, path->pair_density);
}

/* What the chain of a path becomes at a second ball, where it has left one and where it is within the second; elsewhere `chain`. */
static vuint follow_pair(const Scene *scene, vbool met, const Hit *hit, const BsdfSample *bsdf_sample, vbool outward, vuint chain,
                         Path *path) {
    const vbool left = vbool_of_uint(path->chain >= splat_uint(CHAIN_LEFT)) & vbool_of_uint(path->chain < splat_uint(CHAIN_SECOND));
    vbool begins = met & hit->enters & bsdf_sample->scattered & left & (path->pair_density > splat(0));
    vuint second;
    if (any_lane(begins)) begins = begins & is_focuser(scene, hit->slot, &second);
    if (any_lane(begins)) {
        const vreal share = pair_share(scene, choose_uint(begins, path->focus.number, splat_uint(0)), second);
        begins = begins & (share > splat(0));
        path->second = choose_uint(begins, second, path->second);
        path->first_chords = choose_uint(begins, path->chain - splat_uint(CHAIN_LEFT), path->first_chords);
        path->pair_density = choose(begins, divide(path->pair_density, choose(begins, share, splat(1))), path->pair_density);
        const vuint first = choose_uint(bsdf_sample->transmitted, splat_uint(CHAIN_SECOND + 1u), splat_uint(CHAIN_SECOND + CHAIN_LEFT));
        chain = choose_uint(begins, first, chain);
    }
    const vbool within = met & vbool_not(hit->enters) & vbool_of_uint(path->chain >= splat_uint(CHAIN_SECOND)) &
                         vbool_of_uint(path->chain < splat_uint(CHAIN_SECOND + CHAIN_LEFT)) & vbool_of_uint(hit->slot == path->own_slot);
    const vuint next = choose_uint(outward, path->chain + splat_uint(CHAIN_LEFT), path->chain + splat_uint(1));
    const vbool goes_on = within & (outward | vbool_of_uint(path->chain < splat_uint(CHAIN_SECOND + CHORDS_MAX)));
    return choose_uint(goes_on, next, chain);
}

/* The weight of the radiance of a lamp that the path meets in the lanes `hit`, by way of two balls; elsewhere 1. The end that is
 * sought is that of the line that led here, as Newton's method follows it. */
static vreal pair_hit_weight(const Scene *scene, const Path *path, vuint lamp, vbool hit) {
    const vbool through = hit & vbool_of_uint(path->chain >= splat_uint(CHAIN_SECOND + CHAIN_LEFT)) &
                          vbool_of_uint(path->chain != splat_uint(CHAIN_NONE));
    if (!any_lane(through)) return splat(1);
    const vuint second = choose_uint(through, path->second, splat_uint(0));
    vuint target;
    vbool known = find_target(scene, second, lamp, through, &target);
    if (!any_lane(known)) return splat(1);
    const vuint last = choose_uint(known, path->chain - splat_uint(CHAIN_SECOND + CHAIN_LEFT), splat_uint(0));
    Pair pair = make_pair(scene, make_ball(scene, choose_uint(known, path->focus.number, splat_uint(0)),
                                           choose_uint(known, path->first_chords, splat_uint(0))),
                          make_ball(scene, second, last), scale3(path->focus.distance, path->focus.axis));
    pair.density = path->pair_density;
    Beam beam;
    PairEnd end;
    vreal sines[2];
    known = beam_through(&pair, path->chain_begins, known, &beam, sines);
    known = known & beam_end(scene, &pair, &beam, target, &end);
    if (!any_lane(known)) return splat(1);
    const Directions roots = pair_roots(&pair, &end, known);
    const vreal same = divide(PAIR_SAME * pair.balls[0].radius, choose(known, path->focus.distance, splat(1)));
    vbool found = vbool_none;
    for (uint k = 0; k < PAIR_ROOTS; ++k) {
        const Vec3 apart = subtract3(roots.direction[k], path->chain_begins);
        found = found | (roots.found[k] & (dot3(apart, apart) <= same * same));
    }
    found = found & known;
    if (!any_lane(found)) return splat(1);
    return weight_of_hit(found, pair_ratio(scene, &pair, target, path->chain_begins, found));
}

/* The second focuser behind a first one, by a number in [0, 1), which becomes another one, and its probability. */
static vuint choose_second(const Scene *scene, vuint first, vreal *u, vreal *probability) {
    const Vec3 centre = focuser_centre(scene, first);
    const vreal radius = gather_real(scene->focusers, first * FOCUSER_REALS + FOCUSER_RADIUS);
    vuint chosen = splat_uint(0);
    vreal sum = splat(0), from = splat(0), below = splat(0), leads = splat(0);
    for (uint i = 0; scene->focuser_places[i * FOCUSER_UINTS] != NO_SLOT; ++i) sum += pair_power(scene, i, centre, radius);
    for (uint i = 0; scene->focuser_places[i * FOCUSER_UINTS] != NO_SLOT; ++i) {
        const vreal power = pair_power(scene, i, centre, radius);
        const vbool taken = (below <= *u * sum) & (power > splat(0));
        chosen = choose_uint(taken, splat_uint(i), chosen);
        from = choose(taken, below, from);
        leads = choose(taken, power, leads);
        below += power;
    }
    const vbool any = leads > splat(0);
    *u = at_least(at_most(divide(fma(*u, sum, -from), choose(any, leads, splat(1))), splat(R(1.0) - ROUNDOFF)), splat(0));
    *probability = divide(leads, choose(any, sum, splat(1)));
    return chosen;
}

/* Lights the vertices of the lanes `active` by way of one pair, by one point of one lamp. */
static void light_through_pair(const Scene *scene, Path *path, vuint bounce, vbool active) {
    const vuint dimension = bounce + splat_uint(DIMENSIONS_OF_CAUSTICS);
    vuint first;
    vreal probability = choose_focuser(scene, FOCUSER_PAIR_POWER, &path->origin, &path->lobe,
                                       sample_1d(path->key, dimension + CAUSTIC_FOCUSER), 0, &first);
    active = active & (probability > splat(0));
    if (!any_lane(active)) return;
    vreal share, by_target = sample_1d(path->key, dimension + CAUSTIC_TARGET);
    ChainChoice choice;
    choice.number = choose_second(scene, first, &by_target, &share);
    choice.probability = probability * share;
    vreal by_chain = sample_1d(path->key, dimension + CAUSTIC_CHAIN);
    const vuint first_chords = choose_chords(scene, first, &by_chain);
    choice.inside = choose_chords(scene, choice.number, &by_chain);
    /* A segment to each ball, one for each chord, and one to the lamp. */
    active = active & (share > splat(0)) &
             vbool_of_uint(path->depth + first_chords + choice.inside + splat_uint(3) <= splat_uint(scene->max_depth));
    if (!any_lane(active)) return;
    choose_target(scene, path, by_target, active, &choice);
    Pair pair = make_pair(scene, make_ball(scene, first, first_chords), make_ball(scene, choice.number, choice.inside),
                          subtract3(subtract3(focuser_centre(scene, first), path->origin.high), path->origin.low));
    vreal u, v, far;
    sample_2d(path->key, dimension + CAUSTIC_POINT, &u, &v);
    const vreal radius = pair.balls[1].radius;
    const Vec3 aim = sample_target(scene, &choice, radius, u, v, &far);
    PairEnd end;
    end.far = choice.far;
    end.size = target_size(scene, choice.target, subtract3(target_centre(scene, choice.target), focuser_centre(scene, choice.number)), end.far);
    end.aim = scale3(choose(end.far, splat(1), divide(radius, choose(end.far, splat(1), far))), aim);
    const Directions roots = pair_roots(&pair, &end, active);
    for (uint k = 0; k < PAIR_ROOTS; ++k) {
        const Vec3 direction = roots.direction[k];
        vbool lit = active & roots.found[k];
        if (!any_lane(lit)) continue;
        pair.density = divide(vertex_pdf(scene, &path->lobe, direction, 0), choose(lit, choice.probability, splat(1)));
        lit = lit & (pair.density > splat(0));
        if (!any_lane(lit)) continue;
        Ray ray = chain_ray(path, direction);
        Vec3 weight = vec3(splat(1), splat(1), splat(1));
        path->lamp_rays += popcount(lane_bits(lit));
        for (uint ball = 0; ball < 2u && any_lane(lit); ++ball)
            lit = pass_ball(scene, path->key, bounce, pair.balls[ball].number, pair.balls[ball].inside, lit, &ray, &weight);
        if (any_lane(lit)) lit = meet_target(scene, &choice, &ray, WITH_LEFT(&weight) lit);
        if (!any_lane(lit)) continue;
        const vreal ratio = pair_ratio(scene, &pair, choice.target, direction, lit);
        add_chain(scene, path, &choice, &ray, direction, weight, ratio, lit);
    }
}
#elif SAMPLES_CAUSTICS
#define begin_pair(scene, enters, slot, density, path)
#define follow_pair(scene, met, hit, bsdf_sample, outward, chain, path) (chain)
#define pair_hit_weight(scene, path, lamp, hit) splat(1)
#define light_through_pair(scene, path, bounce, active)
#endif
