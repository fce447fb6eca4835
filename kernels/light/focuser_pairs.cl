/* focuser_pairs.cl: light that two balls of glass or mirrors lead on, one after the other.
 *
 * In:    a point, two focusers, how light passes each, a target.   Out: directions from the point along which light from the target
 *        comes that way; densities of directions.
 * Knows: focusers.cl.   Does not know: paths, shadows.
 *
 * A chain through two balls lies in no plane, so its direction has two unknowns. Newton's method finds it: a line is followed through both
 * balls together with its derivatives, and the direction is turned until it ends at the target (as the manifold walks of W. Jakob and
 * S. Marschner do, "Manifold Exploration", 2012, and those of J. Hanika, M. Droske and L. Fascione, "Manifold Next Event
 * Estimation", 2015, with the vertices in its place). It begins where chains through the first ball lead to the middle of the second one, all of
 * which are known, and if none of them leads on, by the rim of the first.
 *
 * Nothing says that this finds all chains, but it always finds the same: what begins with a point, two balls and a target ends with
 * the same directions. So where a path has met the target by chance, the same is sought once more, and what is not found then
 * counts as found by chance alone. No probability of finding a chain has to be estimated. */
#if SAMPLES_PAIRS
#define PAIR_TRIALS 8u
#define PAIR_ROOTS 5u
#define SEED_STEPS 8u
#define SEED_CLOSE R(0x1p-6)
#define PAIR_CLOSE R(0x1p-11) /* a step, in radii of the first ball */
#define PAIR_HITS R(0.25)      /* by what it may miss its end before that step, in sizes of the target */
#define PAIR_SAME R(0x1p-9)   /* directions closer to one another are one */
#define PAIR_SHORTEST R(0x1p-4) /* by which a step that leads nowhere is shortened at most */
#define PAIR_RIM R(0.995)
#define GRAZING_MIN R(0x1p-10) /* cosines below are of lines that rounding may lead past the ball */

/* One of the two focusers. */
typedef struct Ball {
    vuint number, inside; /* chords */
    vreal radius, index, inverse_index;
} Ball;

typedef struct Pair {
    Ball balls[2];  /* from the vertex on */
    vreal density;  /* of a direction from the vertex, over the probability of choosing the pair */
    Vec3 to_first;  /* from the vertex to the centre of the first */
    Vec3 between;   /* from there to the centre of the second */
} Pair;

static Ball make_ball(const Scene *scene, vuint number, vuint inside) {
    Ball ball;
    ball.number = number;
    ball.inside = inside;
    ball.radius = gather_real(scene->focusers, number * FOCUSER_REALS + FOCUSER_RADIUS);
    ball.index = gather_real(scene->focusers, number * FOCUSER_REALS + FOCUSER_INDEX);
    ball.inverse_index = divide(splat(1), ball.index);
    return ball;
}

static Pair make_pair(const Scene *scene, Ball first, Ball second, Vec3 to_first) {
    Pair pair;
    pair.balls[0] = first;
    pair.balls[1] = second;
    pair.to_first = to_first;
    pair.between = subtract3(focuser_centre(scene, second.number), focuser_centre(scene, first.number));
    return pair;
}

/* A line with its derivatives by two angles at its beginning. */
typedef struct Beam {
    Vec3 origin; /* from the centre of the ball that it has left */
    Vec3 direction;
    Vec3 moves[2], turns[2];
} Beam;

/* Turns a line where it meets a ball in the lanes `active`, from `within` or without. Returns those of them in which it does. */
static vbool beam_meet(Beam *beam, vreal radius, vreal ratio, int within, vbool refracts, vbool active, vreal *sine) {
    const vreal along = dot3(beam->origin, beam->direction);
    const Vec3 aside = madd3(-along, beam->direction, beam->origin);
    const vreal inverse = divide(splat(1), radius);
    const vreal b = square_root(dot3(aside, aside)) * inverse;
    const vreal c = cosine_of(b);
    const vreal bent2 = fma(-ratio * ratio, b * b, splat(1));
    vbool met = active & (b < splat(1)) & (c > splat(GRAZING_MIN)) & (vbool_not(refracts) | (bent2 > splat(0)));
    if (!within) met = met & (along < splat(0));
    if (!any_lane(met)) return met;
    const vreal half_chord = choose(met, c, splat(1)) * radius;
    const vreal t = (within ? half_chord : -half_chord) - along;
    const vreal bent = square_root(choose(met & refracts, bent2, splat(1)));
    const Vec3 point = madd3(within ? half_chord : -half_chord, beam->direction, aside);
    const vreal outward = within ? -inverse : inverse;
    const Vec3 normal = scale3(outward, point), before = beam->direction;
    const vreal cosine = choose(met, c, splat(1));
    const vreal kept = choose(refracts, ratio, splat(1));
    const vreal added = choose(refracts, fma(ratio, cosine, -bent), splat(2) * cosine);
    const vreal added_slope = choose(refracts, ratio * (splat(1) - divide(ratio * cosine, bent)), splat(2));
    *sine = choose(met, b, *sine);
    beam->origin = choose3(met, point, beam->origin);
    beam->direction = choose3(met, madd3(added, normal, scale3(kept, before)), before);
    for (int k = 0; k < 2; ++k) {
        const Vec3 there = madd3(t, beam->turns[k], beam->moves[k]);
        const Vec3 moves = madd3(divide(dot3(normal, there), cosine), before, there);
        const Vec3 leans = scale3(outward, moves);
        const vreal grows = -added_slope * (dot3(beam->turns[k], normal) + dot3(before, leans));
        const Vec3 turns = madd3(kept, beam->turns[k], madd3(grows, normal, scale3(added, leans)));
        beam->moves[k] = choose3(met, moves, beam->moves[k]);
        beam->turns[k] = choose3(met, turns, beam->turns[k]);
    }
    return met;
}

/* Leads a line that begins so from a vertex through the first ball, or one that has left that through the second, in the lanes
 * `active`, and returns those in which it comes through. `sine`: of incidence. */
static vbool beam_pass(const Ball *ball, vbool active, Beam *beam, vreal *sine) {
    vreal within;
    *sine = splat(0);
    active = beam_meet(beam, ball->radius, ball->inverse_index, 0, vbool_of_uint(ball->inside > splat_uint(0)), active, sine);
    for (uint chord = 1; chord <= CHORDS_MAX; ++chord) {
        const vbool here = active & vbool_of_uint(splat_uint(chord) <= ball->inside);
        if (!any_lane(here)) break;
        const vbool turned = beam_meet(beam, ball->radius, ball->index, 1, vbool_of_uint(ball->inside == splat_uint(chord)), here, &within);
        active = active & (turned | vbool_not(here));
    }
    return active;
}

static vbool beam_start(const Pair *pair, Vec3 direction, vbool active, Beam *beam, vreal *sine) {
    beam->origin = scale3(splat(-1), pair->to_first);
    beam->direction = direction;
    beam->moves[0] = beam->moves[1] = zero3();
    basis_across(direction, &beam->turns[0], &beam->turns[1]);
    return beam_pass(&pair->balls[0], active, beam, sine);
}

/* Through both balls. */
static vbool beam_through(const Pair *pair, Vec3 direction, vbool active, Beam *beam, vreal sines[2]) {
    active = beam_start(pair, direction, active, beam, &sines[0]);
    beam->origin = subtract3(beam->origin, pair->between);
    return beam_pass(&pair->balls[1], active, beam, &sines[1]);
}

/* What a chain is to end at: a direction, or a point seen from the centre of the second ball. */
typedef struct PairEnd {
    Vec3 aim;
    vbool far;   /* it is a direction */
    vreal size;  /* of the target, in radians, seen from the second ball */
    vreal slant; /* the cosine by which lines come to the plane of a point */
} PairEnd;

/* By how far a line misses its end, in radians, and how that shrinks as it turns; the distance of the end. False: the end is behind. */
static vbool beam_miss(const Beam *beam, const PairEnd *end, Vec3 *miss, Vec3 slopes[2], vreal *distance) {
    const Vec3 way = subtract3(end->aim, beam->origin);
    const vreal ahead = dot3(way, beam->direction);
    const vbool before = end->far | (ahead > splat(0));
    *distance = choose(end->far | vbool_not(before), splat(1), ahead);
    const vreal inverse = divide(splat(1), *distance);
    *miss = choose3(end->far, subtract3(end->aim, beam->direction), scale3(inverse, madd3(-ahead, beam->direction, way)));
    for (int k = 0; k < 2; ++k)
        slopes[k] = choose3(end->far, beam->turns[k], scale3(inverse, madd3(*distance, beam->turns[k], beam->moves[k])));
    return before;
}

/* a . (b x c) */
static vreal triple(Vec3 a, Vec3 b, Vec3 c) {
    return fma(a.x, fma(b.y, c.z, -(b.z * c.y)), fma(a.y, fma(b.z, c.x, -(b.x * c.z)), a.z * fma(b.x, c.y, -(b.y * c.x))));
}

/* Turns a direction, in the lanes `active`, until its line ends where it should. Returns the lanes in which it does. */
static vbool turn_to_end(const Pair *pair, const PairEnd *end, vreal near, vbool active, Vec3 *direction) {
    Vec3 best = *direction, tried = *direction, step = zero3();
    vreal least = splat(REAL_LARGE), shortened = splat(1);
    vbool found = vbool_none;
    for (uint trial = 0; trial < PAIR_TRIALS && any_lane(active); ++trial) {
        Beam beam;
        Vec3 miss, slopes[2], s, t;
        vreal sines[2], distance;
        vbool good = beam_through(pair, tried, active, &beam, sines);
        good = good & beam_miss(&beam, end, &miss, slopes, &distance);
        const vreal off = dot3(miss, miss);
        good = good & (off < least);
        const vreal area = triple(beam.direction, slopes[0], slopes[1]);
        good = good & (fabs(area) > splat(R(1e-20)));
        const vreal inverse = divide(splat(1), choose(good, area, splat(1)));
        basis_across(tried, &s, &t);
        const Vec3 onward = madd3(triple(beam.direction, miss, slopes[1]) * inverse, s,
                                  scale3(triple(beam.direction, slopes[0], miss) * inverse, t));
        const vreal length = square_root(dot3(onward, onward));
        const vreal limit = R(0.5) * near;
        const Vec3 limited = scale3(choose(length > limit, divide(limit, choose(length > limit, length, splat(1))), splat(1)), onward);
        least = choose(good, off, least);
        best = choose3(good, tried, best);
        step = choose3(good, limited, scale3(splat(R(0.5)), step));
        shortened = choose(good, splat(1), shortened * R(0.5));
        tried = choose3(active, normalise3(add3(best, step)), tried);
        const vreal near_end = PAIR_HITS * end->size;
        found = found | (good & (length < PAIR_CLOSE * near) & (off < near_end * near_end));
        active = active & vbool_not(found) & (shortened > splat(PAIR_SHORTEST)) & (least < splat(REAL_LARGE));
    }
    *direction = tried;
    return found;
}

/* The plane of a chain through one ball; both vectors begin at, or end at, its centre. */
static ChainPlane plane_of(const Ball *ball, Vec3 from_vertex, Vec3 to_target, vbool far) {
    const vreal near = divide(splat(1), square_root(dot3(from_vertex, from_vertex)));
    const vreal onward = divide(splat(1), square_root(dot3(to_target, to_target)));
    return chain_plane(scale3(near, from_vertex), scale3(onward, to_target), ball->radius * near,
                       choose(far, splat(0), ball->radius * onward), ball->inside, ball->inverse_index);
}

/* The direction of one piece of such a chain, in the lanes that are returned. */
static vbool plane_root(const Ball *ball, const ChainPlane *plane, uint piece, vbool active, Vec3 *direction) {
    vreal sine, cosine;
    const vreal side = splat(piece < 2u ? R(1.0) : R(-1.0));
    const vbool found =
        chain_root_within(plane->near, plane->far, ball->inverse_index, ball->inside, plane->target_cosine, side * plane->sine, piece == 0u,
                          SEED_STEPS, SEED_CLOSE, active & (piece == 2u ? vbool_all : plane->rises), &sine, &cosine);
    *direction = plane_direction(plane, side, choose(found, sine, splat(R(0.5))));
    return found;
}

/* Directions, as many as each lane has, each once. */
typedef struct Directions {
    Vec3 direction[PAIR_ROOTS];
    vbool found[PAIR_ROOTS];
} Directions;

static void add_direction(Directions *directions, Vec3 direction, vbool found) {
    for (uint k = 0; k < PAIR_ROOTS; ++k) {
        const vbool here = found & vbool_not(directions->found[k]);
        directions->direction[k] = choose3(here, direction, directions->direction[k]);
        directions->found[k] = directions->found[k] | here;
        found = found & vbool_not(here);
    }
}

/* Where Newton's method begins: behind each chain through the first ball to the middle of the second, for each way on from there to the end, the
 * chain through the first ball to where that way enters the second. */
static void add_beginnings(const Pair *pair, const PairEnd *end, uint piece, Vec3 direction, vbool active, Directions *beginnings) {
    const Ball *first = &pair->balls[0], *second = &pair->balls[1];
    Beam beam;
    vreal sine;
    vbool on = beam_start(pair, direction, active, &beam, &sine);
    const Vec3 start = subtract3(beam.origin, pair->between);
    on = on & (dot3(start, start) > second->radius * second->radius);
    vbool none = active;
    if (any_lane(on)) {
        const Vec3 to_second = choose3(on, scale3(splat(-1), start), pair->between);
        const ChainPlane plane = plane_of(second, to_second, end->aim, end->far);
        for (uint other = 0; other < 3u; ++other) {
            Vec3 onward;
            const vbool goes = plane_root(second, &plane, other, on, &onward);
            if (!any_lane(goes)) continue;
            const vreal along = dot3(to_second, onward);
            const Vec3 aside = madd3(along, onward, scale3(splat(-1), to_second));
            const vreal half_chord = square_root(at_least(fma(second->radius, second->radius, -dot3(aside, aside)), splat(0)));
            const Vec3 entry = add3(madd3(-half_chord, onward, aside), pair->between);
            const ChainPlane again = plane_of(first, pair->to_first, entry, vbool_none);
            Vec3 better;
            const vbool found = plane_root(first, &again, piece < 3u ? piece : 2u, goes, &better);
            add_direction(beginnings, better, found);
            none = none & vbool_not(found);
        }
    }
    add_direction(beginnings, direction, none);
}

static Directions no_directions(void) {
    Directions none;
    for (uint k = 0; k < PAIR_ROOTS; ++k) {
        none.direction[k] = zero3();
        none.found[k] = vbool_none;
    }
    return none;
}

/* The directions that are found. */
static Directions pair_roots(const Pair *pair, const PairEnd *end, vbool active) {
    Directions beginnings = no_directions(), roots = no_directions();
    const Ball *first = &pair->balls[0];
    const ChainPlane plane = plane_of(first, pair->to_first, pair->between, vbool_none);
    for (uint piece = 0; piece < 3u; ++piece) {
        Vec3 direction;
        const vbool leads = plane_root(first, &plane, piece, active, &direction);
        if (any_lane(leads)) add_beginnings(pair, end, piece, direction, leads, &beginnings);
    }
    const vbool none = active & vbool_not(beginnings.found[0]);
    if (any_lane(none)) add_beginnings(pair, end, 3u, plane_direction(&plane, splat(-1), splat(PAIR_RIM)), none, &beginnings);
    const vreal same = PAIR_SAME * plane.near;
    for (uint k = 0; k < PAIR_ROOTS; ++k) {
        if (!any_lane(beginnings.found[k])) break;
        Vec3 direction = beginnings.direction[k];
        vbool found = turn_to_end(pair, end, plane.near, beginnings.found[k], &direction);
        for (uint other = 0; other < PAIR_ROOTS; ++other) {
            const Vec3 apart = subtract3(direction, roots.direction[other]);
            found = found & (vbool_not(roots.found[other]) | (dot3(apart, apart) > same * same));
        }
        add_direction(&roots, direction, found);
    }
    return roots;
}

/* The probability with which a chain to the light that a ball brings on from one other is sought by way of that one, of all others. */
static vreal pair_share(const Scene *scene, vuint first, vuint second) {
    const Vec3 centre = focuser_centre(scene, first);
    const vreal radius = gather_real(scene->focusers, first * FOCUSER_REALS + FOCUSER_RADIUS);
    vreal sum = splat(0), chosen = splat(0);
    for (uint i = 0; scene->focuser_places[i * FOCUSER_UINTS] != NO_SLOT; ++i) {
        const vreal leads = pair_power(scene, i, centre, radius);
        sum += leads;
        chosen = choose(vbool_of_uint(second == splat_uint(i)), leads, chosen);
    }
    return divide(chosen, choose(sum > splat(0), sum, splat(1)));
}

/* `axis`: from the centre of the second ball to the target. */
static vreal target_size(const Scene *scene, vuint target, Vec3 axis, vbool far) {
    const vreal extent = gather_real(scene->targets, target * TARGET_REALS + TARGET_EXTENT);
    return choose(far, square_root(splat(2) * extent), divide(extent, square_root(dot3(axis, axis))));
}

/* Where a line that has come through both balls ends: its direction, or the point in the plane of the target. False: that is behind. */
static vbool beam_end(const Scene *scene, const Pair *pair, const Beam *beam, vuint target, PairEnd *end) {
    end->far = vbool_of_uint(gather_uint(scene->target_lamps, target) >= splat_uint(DISC_SLOT));
    const Vec3 axis = subtract3(target_centre(scene, target), focuser_centre(scene, pair->balls[1].number));
    const vreal along = dot3(beam->direction, axis);
    const vbool ahead = vbool_not(end->far) & (along > splat(0));
    const vreal t = divide(dot3(subtract3(axis, beam->origin), axis), choose(ahead, along, splat(1)));
    end->aim = choose3(end->far, beam->direction, madd3(t, beam->direction, beam->origin));
    end->size = target_size(scene, target, axis, end->far);
    end->slant = choose(ahead, divide(choose(ahead, along, splat(1)), square_root(choose(ahead, dot3(axis, axis), splat(1)))), splat(1));
    return end->far | ahead;
}

/* The density with which a path goes along `direction` by chance and on by the chain, over that with which it is drawn as one to the target. */
static vreal pair_ratio(const Scene *scene, const Pair *pair, vuint target, Vec3 direction, vbool active) {
    Beam beam;
    PairEnd end;
    Vec3 miss, slopes[2];
    vreal sines[2], distance;
    active = beam_through(pair, direction, active, &beam, sines);
    active = active & beam_end(scene, pair, &beam, target, &end);
    active = active & beam_miss(&beam, &end, &miss, slopes, &distance);
    if (!any_lane(active)) return splat(CHAIN_RATIO_MAX);
    const vreal extent = gather_real(scene->targets, target * TARGET_REALS + TARGET_EXTENT);
    const vreal spread = fabs(triple(beam.direction, slopes[0], slopes[1])) * distance * distance;
    const vreal directed = splat(PI_INVERSE) * divide(spread, choose(end.far, splat(2) * extent, extent * extent * end.slant));
    vreal density = directed * gather_real(scene->targets, target * TARGET_REALS + TARGET_SHARE), chance = pair->density;
    for (uint ball = 0; ball < 2u; ++ball) {
        const vuint number = pair->balls[ball].number, inside = pair->balls[ball].inside;
        density *= gather_real(scene->focusers, number * FOCUSER_REALS + FOCUSER_CHAINS + inside);
        chance *= chain_probability(scene, number, sines[ball], inside);
    }
    const vbool drawn = active & (density > splat(0));
    return choose(drawn, at_most(divide(chance, choose(drawn, density, splat(1))), splat(CHAIN_RATIO_MAX)), splat(CHAIN_RATIO_MAX));
}
#endif
