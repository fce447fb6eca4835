/* focusers.cl: balls of glass and mirrors that lead light on to other surfaces: which one is tried from a point, and the
 * ways through or off it.
 *
 * In:    a point and the lobe there, random numbers; a direction to a focuser.   Out: a focuser and the probability of
 *        choosing it; the angles of incidence by which light from a target reaches the point; densities of directions.
 * Knows: PackedFocuser, PackedTarget and PackedCamera (scene_types.h), the interface of shape/, the lobes' densities.   Does not know:
 *        paths, shadows, how rays are traced.
 *
 * A chain goes from a vertex to a focuser, `inside` it along so many chords (0: a reflection off its outside; 1: through
 * it; 2: through it, with a reflection inside), and on to a target. It stays in the plane of vertex, centre and target,
 * and all its lines pass the centre at one distance b, since refraction and reflection at a sphere keep it. With
 * sin(i) = b / radius and sin(r) = sin(i) / index, and with D and E, the distances of vertex and target from the centre,
 * the chain has turned about the centre, beyond a straight line and whole half turns, by the angle
 *
 *   W(i) = asin(b / D) + asin(b / E) - 2 i + 2 inside r
 *
 * which must be beta or -beta, where beta is the angle between the target and the vertex's axis through the centre; from
 * the other side of the axis for an even number of chords. Its slope
 *
 *   g(i) = b' / sqrt(D^2 - b^2) + b' / sqrt(E^2 - b^2) - 2 + 2 inside cos(i) / (index cos(r)),   b' = radius cos(i)
 *
 * falls all the way from i = 0 to 90 degrees, since each ratio of roots falls as b grows (D, E and index times radius
 * exceed the radius). So W is concave: it rises to one maximum and falls from there to its end. There are three
 * pieces with a root at most: the rise and the fall at beta, and the fall at -beta. From the outer end of its piece,
 * Newton's method comes closer to the root with every step, without passing it, and says by the sign of the slope that
 * there is none. W need not be known, but only sin(W - beta) and cos(W - beta), so there is no arc sine; within a piece
 * the difference is less than half a turn, if 4 asin(1 / index) is (the host leaves out other chains). Three chords turn by more, so
 * they are sought only where W stays below half a turn for every point of the target (is_sought).
 *
 * A direction that follows from a point of the target has a density with a pole where two chains merge (a fold) and where the
 * target stands behind the middle of the ball and is seen as a ring: there a few samples in a million would carry much of the
 * light, and pictures would be noisier than their samples know. So a direction is drawn from around the image of the whole
 * target there, whose extent follows from the roots for its edges (image_of). */
#if SAMPLES_CAUSTICS
#define CHORDS_MAX 3u
#define STEPS_MAX 32u
#if REAL_IS_DOUBLE
#define CLOSE_STEP 0x1p-26
#else
#define CLOSE_STEP 0x1p-12f
#endif
#define CHAIN_RATIO_MAX R(1e15) /* as in lamps_direct.cl */

/* What a focuser may bring to a lobe at a point. `power`: the place of the light that it leads on, per steradian as it were. */
static vreal focuser_importance(__global const real *focuser, uint power, const Point *point, const Lobe *lobe) {
    const Vec3 to_centre = subtract3(splat3(focuser + FOCUSER_CENTRE), point->high);
    const vreal radius = splat(focuser[FOCUSER_RADIUS]);
    const vreal distance2 = at_least(dot3(to_centre, to_centre), splat(R(1e-30)));
    const vreal inverse = divide(splat(1), square_root(distance2));
    const vreal z = dot3(to_centre, lobe->axis) * inverse;
    const vreal sine = at_most(radius * inverse, splat(1));
    const vreal cosine = cone_cosine(lobe, z, sine);
    const vbool outside = distance2 > radius * radius * R(0x1.0001p0);
    return choose(outside, focuser[power] * cosine * inverse * inverse, splat(0));
}

/* What the chain of a path is: how many chords it has passed inside the ball, and more than that when it has left the ball, or
 * gone on to a second one. */
#define CHAIN_LEFT 8u
#define CHAIN_SECOND 16u
#define CHAIN_NONE 0xffu

/* The way from a vertex to a focuser. */
typedef struct Focus {
    vuint number;   /* of the focuser */
    Vec3 axis;      /* unit, from the vertex to its centre */
    vreal distance; /* of its centre from the vertex */
    vreal sine;     /* of the angle of incidence */
    vreal ratio;    /* the density of the direction in the lobe, over the probability of choosing the focuser */
    vbool every;    /* each chain through it is tried, not one that is chosen */
} Focus;

/* The lanes whose slot is a focuser's, and which one's it is. */
static vbool is_focuser(const Scene *scene, vuint slot, vuint *number) {
    vbool known = vbool_none;
    *number = splat_uint(0);
    for (uint i = 0; scene->focuser_places[i * FOCUSER_UINTS] != NO_SLOT; ++i) {
        const vbool same = vbool_of_uint(slot == splat_uint(scene->focuser_places[i * FOCUSER_UINTS]));
        *number = choose_uint(same, splat_uint(i), *number);
        known = known | same;
    }
    return known;
}

/* The focuser that each lane chooses by a number in [0, 1), and its probability; or, where `slots` is given, the one in
 * the lane's slot. Probability 0: there is none. */
static vreal choose_focuser(const Scene *scene, uint power, const Point *point, const Lobe *lobe, vreal number,
                            const vuint *slots, vuint *chosen_number) {
    vreal sum = splat(0), chosen = splat(0), below = splat(0);
    for (uint i = 0; scene->focuser_places[i * FOCUSER_UINTS] != NO_SLOT; ++i)
        sum += focuser_importance(scene->focusers + i * FOCUSER_REALS, power, point, lobe);
    const vreal target = number * sum;
    *chosen_number = splat_uint(0);
    for (uint i = 0; scene->focuser_places[i * FOCUSER_UINTS] != NO_SLOT; ++i) {
        const vreal importance = focuser_importance(scene->focusers + i * FOCUSER_REALS, power, point, lobe);
        vbool taken = (below <= target) & (importance > splat(0));
        if (slots != 0) taken = vbool_of_uint(*slots == splat_uint(scene->focuser_places[i * FOCUSER_UINTS]));
        *chosen_number = choose_uint(taken, splat_uint(i), *chosen_number);
        chosen = choose(taken, importance, chosen);
        below += importance;
    }
    return choose(chosen > splat(0), divide(chosen, sum), splat(0));
}

static Vec3 focuser_centre(const Scene *scene, vuint number) {
    const vuint place = number * FOCUSER_REALS + FOCUSER_CENTRE;
    return vec3(gather_real(scene->focusers, place), gather_real(scene->focusers + 1u, place),
                gather_real(scene->focusers + 2u, place));
}

#if SAMPLES_PAIRS
/* What focuser `i` brings of its light to one other, as that one's FOCUSER_PAIR_POWER counts it; 0 to itself and to what it touches. */
static vreal pair_power(const Scene *scene, uint i, Vec3 centre, vreal radius) {
    __global const real *focuser = scene->focusers + i * FOCUSER_REALS;
    const Vec3 between = subtract3(splat3(focuser + FOCUSER_CENTRE), centre);
    const vreal apart = radius + focuser[FOCUSER_RADIUS], distance2 = dot3(between, between);
    const vbool beyond = distance2 > apart * apart * R(0x1.01p0);
    return choose(beyond, divide(splat(focuser[FOCUSER_POWER]), choose(beyond, distance2, splat(1))), splat(0));
}
#endif

static Vec3 target_centre(const Scene *scene, vuint target) {
    const vuint place = target * TARGET_REALS + TARGET_CENTRE;
    return vec3(gather_real(scene->targets, place), gather_real(scene->targets + 1u, place),
                gather_real(scene->targets + 2u, place));
}

/* The target of a focuser that is the lamp, in the lanes `wanted`. Returns those that have one. */
static vbool find_target(const Scene *scene, vuint number, vuint lamp, vbool wanted, vuint *target) {
    const vuint place = number * FOCUSER_UINTS;
    const vuint first = gather_uint(scene->focuser_places + FOCUSER_FIRST, place);
    const vuint count = gather_uint(scene->focuser_places + FOCUSER_COUNT, place);
    vbool known = vbool_none;
    *target = first;
    for (uint k = 0;; ++k) {
        const vbool has = wanted & vbool_of_uint(splat_uint(k) < count);
        if (!any_lane(has)) break;
        const vuint tried = choose_uint(has, first + splat_uint(k), first);
        const vbool same = has & vbool_of_uint(gather_uint(scene->target_lamps, tried) == lamp);
        *target = choose_uint(same, tried, *target);
        known = known | same;
    }
    return known;
}

static vreal cosine_of(vreal sine) { return square_root(at_least((splat(1) - sine) * (splat(1) + sine), splat(0))); }

/* The density per steradian of camera rays, which are as many through each part of a pixel as of the plane in focus. `drawn`: the
 * direction goes through the pixel. */
static vreal pixel_pdf(__global const PackedCamera *camera, const Lobe *lobe, Vec3 direction, int drawn) {
    const Vec3 ahead = splat3(camera->ahead), right = splat3(camera->right), down = splat3(camera->down);
    const vreal square = dot3(ahead, ahead), along = dot3(ahead, direction);
    const vbool front = along > splat(0);
    const vreal t = divide(square, choose(front, along, splat(1)));
    const vreal to_middle = divide(square, dot3(ahead, lobe->axis));
    const Vec3 off = subtract3(scale3(t, direction), scale3(to_middle, lobe->axis));
    const vreal width2 = dot3(right, right), height2 = dot3(down, down);
    const vreal x = dot3(off, right), y = dot3(off, down), half_width = splat(R(0.5)) * width2, half_height = splat(R(0.5)) * height2;
    vbool inside = front;
    if (!drawn) inside = front & (x >= -half_width) & (x < half_width) & (y >= -half_height) & (y < half_height);
    const vreal density = divide(t * t * square_root(square), choose(front, along, splat(1)) * square_root(width2 * height2));
    return choose(inside, density, splat(0));
}

/* As folded_pdf, at the camera too. */
static vreal vertex_pdf(const Scene *scene, const Lobe *lobe, Vec3 direction, int drawn) {
    vreal density = folded_pdf(lobe, direction, drawn);
    const vbool pixel = vbool_of_uint(lobe->kind == splat_uint(LOBE_PIXEL));
    if (any_lane(pixel)) density = choose(pixel, pixel_pdf(scene->camera, lobe, direction, drawn), density);
    return density;
}

/* Along a unit direction, which meets the focuser. `drawn`: it was drawn from the lobe. */
static Focus focus_along(const Scene *scene, const Point *point, const Lobe *lobe, Vec3 direction, int drawn, vuint number,
                         vreal probability) {
    Focus focus;
    const Vec3 to_centre = subtract3(subtract3(focuser_centre(scene, number), point->high), point->low);
    const Vec3 across = madd3(-dot3(to_centre, direction), direction, to_centre);
    const vreal radius = gather_real(scene->focusers, number * FOCUSER_REALS + FOCUSER_RADIUS);
    const vreal sine = divide(square_root(dot3(across, across)), radius);
    focus.number = number;
    focus.every = vbool_of_uint(lobe->kind == splat_uint(LOBE_PIXEL));
    focus.distance = square_root(dot3(to_centre, to_centre));
    focus.axis = scale3(divide(splat(1), focus.distance), to_centre);
    /* Where rounding has it that the ray passes beside the ball, or through its middle, the formulas still hold. */
    focus.sine = at_least(at_most(sine, splat(R(1.0) - R(0x1p-22))), splat(R(0x1p-40)));
    focus.ratio = divide(vertex_pdf(scene, lobe, direction, drawn), choose(probability > splat(0), probability, splat(1)));
    return focus;
}

/* Some vector across a unit one: straight ahead or behind, any direction across the axis is as good as another. */
static Vec3 beside(Vec3 axis) {
    return choose3(fabs(axis.x) < splat(R(0.5)), vec3(splat(0), axis.z, -axis.y), vec3(-axis.z, splat(0), axis.x));
}

/* A number of the complex plane, and products by the rules for them: angles add up. */
typedef struct Turn {
    vreal cosine, sine;
} Turn;

static Turn turn_by_sine(vreal sine) {
    Turn turn;
    turn.cosine = cosine_of(sine);
    turn.sine = sine;
    return turn;
}

static Turn turn_on(Turn a, Turn b) {
    Turn turn;
    turn.cosine = fma(a.cosine, b.cosine, -(a.sine * b.sine));
    turn.sine = fma(a.sine, b.cosine, a.cosine * b.sine);
    return turn;
}

static Turn turn_back(Turn a, Turn b) {
    b.sine = -b.sine;
    return turn_on(a, b);
}

/* W(i), as a turn, and the cosine of refraction. `near` and `far`: the radius over the distances of vertex and target. */
static Turn chain_turn(vreal sine, vreal cosine, vreal near, vreal far, vreal inverse_index, vuint inside, Turn *from,
                       Turn *to, vreal *refracted) {
    Turn incidence;
    incidence.cosine = cosine;
    incidence.sine = sine;
    *from = turn_by_sine(sine * near);
    *to = turn_by_sine(sine * far);
    const Turn refraction = turn_by_sine(sine * inverse_index);
    *refracted = refraction.cosine;
    Turn turn = turn_back(turn_back(turn_on(*from, *to), incidence), incidence);
    const Turn chord = turn_on(refraction, refraction);
    for (uint k = 0; k < CHORDS_MAX; ++k) {
        const vbool has = vbool_of_uint(inside > splat_uint(k));
        const Turn more = turn_on(turn, chord);
        turn.cosine = choose(has, more.cosine, turn.cosine);
        turn.sine = choose(has, more.sine, turn.sine);
    }
    return turn;
}

/* The root of one piece: the rise, or the fall, at an angle whose cosine and sine are given. Returns the lanes of `active`
 * that have one. `steps_max`, `close_step`: after so many steps, or one that is as short, it is close enough. */
static vbool chain_root_within(vreal near, vreal far, vreal inverse_index, vuint inside, vreal cosine_target, vreal sine_target,
                               int rising, uint steps_max, real close_step, vbool active, vreal *sine_found, vreal *cosine_found) {
    const vreal chords = splat(2) * uint_to_real(inside) * inverse_index;
    Turn target, at;
    target.cosine = cosine_target;
    target.sine = sine_target;
    at.cosine = splat(rising ? R(1.0) : R(0.0));
    at.sine = splat(rising ? R(0.0) : R(1.0));
    vbool searching = active, found = vbool_none;
    for (uint step = 0; step < steps_max && any_lane(searching); ++step) {
        Turn from, to;
        vreal refracted;
        const Turn off = turn_back(chain_turn(at.sine, at.cosine, near, far, inverse_index, inside, &from, &to, &refracted), target);
        const vreal slope = fma(at.cosine, divide(near, from.cosine) + divide(far, to.cosine) + divide(chords, refracted),
                                splat(-2));
        const vbool ahead = off.cosine > splat(0);
        const vbool here = ahead & (fabs(off.sine) < splat(R(4.0) * ROUNDOFF));
        const vbool before = off.sine < splat(0);
        const vbool sloped = rising ? slope > splat(0) : slope < splat(0);
        /* Beyond a root by more than rounding: of a piece that has none. */
        const vbool beyond = vbool_not(before) & vbool_not(ahead & (off.sine < splat(R(0x1p-18))));
        const vbool lost = vbool_not(here) & (beyond | vbool_not(sloped));
        /* A sine is less than its angle, and 1 less than an obtuse one: the step does not pass the root. */
        const vreal rest = choose(ahead, -off.sine, splat(1));
        const vreal tangent = divide(R(0.5) * rest, choose(sloped, slope, splat(rising ? R(1.0) : R(-1.0))));
        /* Turns by 2 atan(tangent), no more than 2 tangent. */
        const vreal inverse = divide(splat(1), fma(tangent, tangent, splat(1)));
        Turn by;
        by.cosine = fma(-tangent, tangent, splat(1)) * inverse;
        by.sine = splat(2) * tangent * inverse;
        const Turn next = turn_on(at, by);
        const vbool arrived = here | (vbool_not(before) & vbool_not(beyond));
        /* What the step leaves of the difference is of the order of its square. */
        const vbool close = fabs(tangent) < splat(close_step);
        const vbool moves = searching & vbool_not(arrived) & vbool_not(lost);
        found = found | (searching & vbool_not(lost) & (arrived | close));
        at.cosine = choose(moves, next.cosine, at.cosine);
        at.sine = choose(moves, next.sine, at.sine);
        const vbool left = (at.sine < splat(0)) | (at.cosine < splat(0));
        searching = moves & vbool_not(close) & vbool_not(left);
        /* What has not arrived after so many steps is as close to the maximum as rounding lets it come. */
        if (step == steps_max - 1u) found = found | searching;
    }
    const vreal length = fma(at.sine, at.sine, at.cosine * at.cosine);
    const vreal shorten = fma(length, splat(R(-0.5)), splat(R(1.5)));
    *sine_found = at.sine * shorten;
    *cosine_found = at.cosine * shorten;
    return found & active & (at.sine >= splat(0)) & (at.cosine >= splat(0));
}

/* The same, as close as rounding allows. */
static vbool chain_root(vreal near, vreal far, vreal inverse_index, vuint inside, vreal cosine_target, vreal sine_target,
                        int rising, vbool active, vreal *sine_found, vreal *cosine_found) {
    return chain_root_within(near, far, inverse_index, inside, cosine_target, sine_target, rising, STEPS_MAX, CLOSE_STEP, active,
                             sine_found, cosine_found);
}

/* An odd number of chords: where the chain turns by nothing, it goes straight on. */
static vbool is_straight(vuint inside) { return vbool_of_uint((inside & splat_uint(1)) == splat_uint(1)); }

/* The plane in which a chain lies, and where in it the target is. */
typedef struct ChainPlane {
    Vec3 axis, across;   /* unit: from the vertex to the centre, and from there aside to the target */
    vreal near, far;     /* the radius over the distances of vertex and target */
    vreal sine;          /* of the angle between axis and target */
    vreal target_cosine; /* of the angle to be turned */
    vbool straight;      /* an odd number of chords */
    vbool rises;         /* only a chain that begins to rise has a maximum above 0 */
} ChainPlane;

/* `aim`: the unit direction from the centre to the target. */
static ChainPlane chain_plane(Vec3 axis, Vec3 aim, vreal near, vreal far, vuint inside, vreal inverse_index) {
    ChainPlane plane;
    const vreal cosine = dot3(axis, aim);
    const Vec3 off = madd3(-cosine, axis, aim);
    plane.axis = axis;
    plane.near = near;
    plane.far = far;
    plane.sine = square_root(dot3(off, off));
    plane.across = normalise3(choose3(plane.sine > splat(0), off, beside(axis)));
    plane.straight = is_straight(inside);
    plane.target_cosine = choose(plane.straight, cosine, -cosine);
    plane.rises = near + far + splat(2) * uint_to_real(inside) * inverse_index > splat(2);
    return plane;
}

/* The direction from the vertex with this sine of incidence, to one side. */
static Vec3 plane_direction(const ChainPlane *plane, vreal side, vreal sine) {
    const vreal aside = sine * plane->near;
    const vreal turned = choose(plane->straight, side, -side) * aside;
    return normalise3(madd3(cosine_of(aside), plane->axis, scale3(turned, plane->across)));
}

/* The probability with which a path that meets the focuser at this angle takes the chain: of reflection and refraction as
 * dielectric.cl chooses between them. */
static vreal chain_probability(const Scene *scene, vuint number, vreal sine, vuint inside) {
    vreal outer = splat(1), inner = splat(0);
#if EFFECT_DIELECTRIC
    const vuint variant = gather_uint(scene->focuser_places, number * FOCUSER_UINTS + FOCUSER_VARIANT);
    const vbool glass = vbool_of_uint(variant != splat_uint(FOCUSER_MIRROR));
    const vreal n = gather_real(scene->focusers, number * FOCUSER_REALS + FOCUSER_INDEX);
    const vreal inverse = divide(splat(1), n);
    const vreal c = cosine_of(sine), t = cosine_of(sine * inverse);
    const vbool exact = vbool_of_uint(variant == splat_uint(FRESNEL_EXACT));
    const vbool none = vbool_of_uint(variant == splat_uint(FRESNEL_NONE));
    vreal first = choose(exact, fresnel_exact(c, n, t), fresnel_schlick(c, inverse));
    inner = choose(exact, fresnel_exact(t, inverse, c), fresnel_schlick(t, n));
    first = choose(none, splat(0), first);
    inner = choose(none | vbool_not(glass), splat(0), inner);
    outer = choose(glass, first, outer);
#endif
    const vreal through = (splat(1) - outer) * (splat(1) - inner);
    vreal reflected = splat(1);
    for (uint k = 1; k < CHORDS_MAX; ++k) reflected *= choose(vbool_of_uint(inside > splat_uint(k)), inner, splat(1));
    return choose(vbool_of_uint(inside == splat_uint(0)), outer, through * reflected);
}

/* The lanes in which a chain of so many chords is sought. `near` and `far`: the radius over the distances of vertex and target; the asin of both
 * together, and what refraction adds at most, must be less than half a turn. */
static vbool is_sought(const Scene *scene, vuint number, vuint inside, vreal near, vreal far) {
    const vreal most = gather_real(scene->focusers, number * FOCUSER_REALS + FOCUSER_TURN);
    const Turn both = turn_on(turn_by_sine(at_most(near, splat(1))), turn_by_sine(at_most(far, splat(1))));
    return vbool_of_uint(inside < splat_uint(CHORDS_MAX)) | (both.cosine > most);
}

/* How a target lies, seen from the centre of a focuser, and the radius of the focuser over the distances of its points. */
typedef struct TargetCone {
    Vec3 axis;            /* unit */
    Turn spread;          /* its half angle */
    vreal least, largest; /* 0 for a disc */
} TargetCone;

static TargetCone target_cone(const Scene *scene, vuint number, vuint target) {
    TargetCone cone;
    const vreal extent = gather_real(scene->targets, target * TARGET_REALS + TARGET_EXTENT);
    const vbool far = vbool_of_uint(gather_uint(scene->target_lamps, target) >= splat_uint(DISC_SLOT));
    const Vec3 aimed = target_centre(scene, target);
    const Vec3 ahead = choose3(far, aimed, subtract3(aimed, focuser_centre(scene, number)));
    const vreal inverse = divide(splat(1), square_root(dot3(ahead, ahead)));
    const vreal tangent = extent * inverse;
    const vreal cosine = divide(splat(1), square_root(fma(tangent, tangent, splat(1))));
    cone.axis = scale3(inverse, ahead);
    cone.spread.cosine = choose(far, splat(1) - extent, cosine);
    cone.spread.sine = choose(far, square_root(extent * (splat(2) - extent)), tangent * cosine);
    cone.largest = choose(far, splat(0), gather_real(scene->focusers, number * FOCUSER_REALS + FOCUSER_RADIUS) * inverse);
    cone.least = cone.largest * cone.spread.cosine;
    return cone;
}

/* Directions from a vertex, around the axis through a ball of glass, that hold the image of a whole target: bands of the angle of
 * incidence, given by their sines. */
typedef struct TargetImage {
    vbool fold, ring;         /* neither: it is far from where densities have poles */
    Vec3 across;              /* unit, from the axis to the target; 0 if that is on the axis */
    vreal from, to;           /* the band that the fold or the middle of the ball is in */
    vreal ring_from, ring_to; /* the other band; empty: there is none */
    vreal tangent;            /* of a fold: it goes by twice the angle of this tangent to both sides of the target's plane */
} TargetImage;

#define BAND_SLACK R(0x1p-18) /* by which bands are wider than their roots, which are rounded */

static TargetImage no_image(void) {
    TargetImage image;
    image.fold = image.ring = vbool_none;
    image.across = zero3();
    image.from = image.to = image.ring_from = image.ring_to = image.tangent = splat(0);
    return image;
}

/* The part of a vector across a unit axis: its length, which for a unit vector is the sine of the angle, and its unit direction, or 0. */
static vreal across_axis(Vec3 axis, Vec3 direction, Vec3 *across) {
    const Vec3 off = madd3(-dot3(axis, direction), axis, direction);
    const vreal sine = square_root(dot3(off, off));
    *across = scale3(divide(splat(1), choose(sine > splat(0), sine, splat(1))), off);
    return sine;
}

#if EFFECT_DIELECTRIC
/* Where two chains to the target merge and disappear (a fold of W, at its maximum), or where the target stands behind the middle
 * of the ball and is seen as a ring, a direction that is drawn by a point of the target has a density with a pole. There, it
 * is drawn from the image of the whole target. The target's points lie around the vertex's axis at angles from beta - spread to
 * beta + spread; `largest` and `least` make W as large and as small as it may be for any of them. */
static TargetImage image_of(const Scene *scene, vuint number, Vec3 axis, vreal distance, vuint inside, vuint target, vbool active) {
    TargetImage image = no_image();
    const vuint place = number * FOCUSER_REALS;
    const vreal inverse_index = divide(splat(1), gather_real(scene->focusers, place + FOCUSER_INDEX));
    const vreal near = divide(gather_real(scene->focusers, place + FOCUSER_RADIUS), distance);
    const TargetCone cone = target_cone(scene, number, target);
    active = active & (near + cone.largest + splat(2) * uint_to_real(inside) * inverse_index > splat(2));
    if (!any_lane(active)) return image;
    Turn beta;
    beta.cosine = dot3(axis, cone.axis);
    beta.cosine = choose(is_straight(inside), beta.cosine, -beta.cosine);
    beta.sine = across_axis(axis, cone.axis, &image.across);
    const vbool ring = active & (beta.sine < cone.spread.sine) & (beta.cosine > splat(0));
    const Turn low = turn_back(beta, cone.spread), high = turn_on(beta, cone.spread);
    vreal rise_low, rise_high, fall_low, fall_high, cosine;
    const vbool above = active & vbool_not(chain_root(near, cone.least, inverse_index, inside, high.cosine, high.sine, 1, active,
                                                      &rise_high, &cosine));
    const vbool begins = chain_root(near, cone.largest, inverse_index, inside, low.cosine, low.sine, 1,
                                    above & vbool_not(ring), &rise_low, &cosine);
    image.ring = ring;
    image.fold = begins;
    const vbool banded = ring | begins;
    if (!any_lane(banded)) return image;
    const vbool low_found =
        chain_root(near, cone.largest, inverse_index, inside, choose(ring, high.cosine, low.cosine),
                   choose(ring, -high.sine, low.sine), 0, banded, &fall_low, &cosine);
    fall_low = choose(low_found, fall_low, splat(1));
    const vbool apart = ring & vbool_not(above);
    if (any_lane(apart)) {
        const vbool high_found =
            chain_root(near, cone.least, inverse_index, inside, high.cosine, high.sine, 0, apart, &fall_high, &cosine);
        image.ring_from = choose(apart, choose(high_found, fall_high, splat(1)) * (splat(1) - BAND_SLACK), splat(0));
        image.ring_to = choose(apart, at_most(fall_low * (splat(1) + BAND_SLACK), splat(1)), splat(0));
    }
    image.from = choose(begins, rise_low * (splat(1) - BAND_SLACK), splat(0));
    image.to = at_most(choose(apart, rise_high, fall_low) * (splat(1) + BAND_SLACK), splat(1));
    const vreal sine = at_most(divide(cone.spread.sine, choose(begins, beta.sine, splat(1))), splat(1));
    image.tangent = divide(sine, splat(1) + cosine_of(sine)) * (splat(1) + BAND_SLACK);
    return image;
}
#else
#define image_of(scene, number, axis, distance, inside, target, active) no_image()
#endif

/* 1 - cos of the angle from the axis to the direction of an incidence; and by how much that grows through a band. */
static vreal less_by(vreal sine) { return divide(sine * sine, splat(1) + cosine_of(sine)); }

static vreal band_height(vreal near, vreal from, vreal to) {
    return divide((to - from) * (to + from) * near * near, cosine_of(from * near) + cosine_of(to * near));
}

/* A direction in a band of the image, from two numbers in [0, 1). `flipped`: the target is on the other side of the axis. */
static Vec3 sample_band(const TargetImage *image, Vec3 axis, Vec3 across, vreal near, vreal from, vreal to, vbool flipped, vreal u,
                        vreal v) {
    const vreal less = fma(u, band_height(near, from, to), less_by(from * near));
    const vreal aside = square_root(less * (splat(2) - less));
    const vreal x = fma(splat(2), v, splat(-1)) * image->tangent;
    const vreal inverse = divide(splat(1), fma(x, x, splat(1)));
    vreal sine, cosine;
    sin_cos_turn(v, &sine, &cosine);
    sine = choose(image->ring, sine, splat(2) * x * inverse);
    cosine = choose(image->ring, cosine, fma(-x, x, splat(1)) * inverse);
    const Vec3 other = vec3(fma(axis.y, across.z, -(axis.z * across.y)), fma(axis.z, across.x, -(axis.x * across.z)),
                            fma(axis.x, across.y, -(axis.y * across.x)));
    const vreal turned = choose(flipped, -aside, aside);
    return normalise3(madd3(splat(1) - less, axis, scale3(turned, madd3(cosine, across, scale3(sine, other)))));
}

/* The density per steradian of sample_band, of the direction with this incidence, by which a line is led along `onward`, a vector
 * from the ball to the target. 0: it is in no band. */
static vreal band_density(const Focus *focus, const TargetImage *image, vreal near, Vec3 onward) {
    const vbool first = (focus->sine >= image->from) & (focus->sine <= image->to);
    const vbool second = vbool_not(first) & (focus->sine >= image->ring_from) & (focus->sine <= image->ring_to);
    const vreal height = band_height(near, choose(first, image->from, image->ring_from), choose(first, image->to, image->ring_to));
    Vec3 led;
    across_axis(focus->axis, onward, &led);
    const Vec3 apart = subtract3(led, image->across), together = add3(led, image->across);
    const vreal x2 = divide(dot3(apart, apart), at_least(dot3(together, together), splat(R(1e-20))));
    const vreal t = image->tangent;
    vreal around = divide(splat(1) + x2, splat(4) * choose(t > splat(0), t, splat(1)));
    around = choose(image->ring, splat(R(0.5) * PI_INVERSE), choose(x2 <= t * t, around, splat(0)));
    return choose((first | second) & (height > splat(0)), divide(around, choose(height > splat(0), height, splat(1))), splat(0));
}

/* The density with which a path goes this chain by chance, over that with which it is drawn as one to the target.
 * `origin` and `direction`: of its last line, which meets the lamp. */
static vreal chain_ratio(const Scene *scene, const Focus *focus, const TargetImage *image, vuint inside, vuint target,
                         const Point *origin, Vec3 direction) {
    const vuint place = focus->number * FOCUSER_REALS;
    const vreal radius = gather_real(scene->focusers, place + FOCUSER_RADIUS);
    const vreal inverse_index = divide(splat(1), gather_real(scene->focusers, place + FOCUSER_INDEX));
    vreal share = gather_real(scene->focusers, place + FOCUSER_CHAINS + inside);
    share = choose(focus->every & (share > splat(0)), splat(1), share);
    const vuint aim = target * TARGET_REALS;
    const vreal extent = gather_real(scene->targets, aim + TARGET_EXTENT);
    const vbool far = vbool_of_uint(gather_uint(scene->target_lamps, target) >= splat_uint(DISC_SLOT));
    /* Where the line crosses the plane of the target. */
    const Vec3 centre = focuser_centre(scene, focus->number), aimed = target_centre(scene, target);
    const Vec3 axis = subtract3(aimed, centre);
    const vreal along = dot3(direction, axis);
    const vreal length = dot3(subtract3(aimed, origin->high), axis);
    const vreal t = divide(length, choose(far | vbool_not(along > splat(0)), splat(1), along));
    const Vec3 crossing = subtract3(madd3(t, direction, origin->high), centre);
    const vreal near = divide(radius, focus->distance);
    const vreal inverse_distance = divide(splat(1), square_root(choose(far, splat(1), dot3(crossing, crossing))));
    const vreal beyond = choose(far, splat(0), radius * inverse_distance);
    const vreal cosine = cosine_of(focus->sine);
    Turn from, to;
    vreal refracted;
    const Turn turn = chain_turn(focus->sine, cosine, near, beyond, inverse_index, inside, &from, &to, &refracted);
    /* Lengths in radii: from the vertex and to the target, where the line passes the centre. */
    const vreal before = divide(from.cosine, near);
    const vreal after = divide(to.cosine, choose(far, splat(1), beyond));
    const vreal power =
        divide(splat(2), cosine) - divide(splat(2) * uint_to_real(inside) * inverse_index, refracted);
    const vreal bending = fma(-power, before, splat(1));
    const vreal spread_across = divide(fabs(turn.sine), focus->sine * near);
    const vreal solid_angle = spread_across * fabs(bending);
    const vreal area = divide(spread_across * fabs(fma(after, bending, before)), choose(far, splat(1), beyond)) * radius * radius;
    const vreal axis_length = square_root(dot3(axis, axis));
    const vreal slant = choose(far | vbool_not(along > splat(0)), splat(1), divide(along, axis_length));
    const vreal pi_inverse = splat(PI_INVERSE);
    vreal directed = pi_inverse * choose(far, divide(solid_angle, splat(2) * extent), divide(area, extent * extent * slant));
    const vbool banded = image->ring | (image->fold & (turn.sine > splat(0)));
    if (any_lane(banded))
        directed = choose(banded, band_density(focus, image, near, choose3(far, direction, crossing)), directed);
    vreal density = share * gather_real(scene->targets, aim + TARGET_SHARE) * directed;
    density = choose(is_sought(scene, focus->number, inside, near, target_cone(scene, focus->number, target).largest), density, splat(0));
    const vreal ratio = divide(focus->ratio * chain_probability(scene, focus->number, focus->sine, inside), choose(density > splat(0), density, splat(1)));
    return choose(density > splat(0), at_most(ratio, splat(CHAIN_RATIO_MAX)), splat(CHAIN_RATIO_MAX));
}
#endif
