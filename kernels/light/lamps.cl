/* lamps.cl: one lamp for a point, chosen by what it may bring there, and a direction to it.
 *
 * In:    a point, the lobe there, the path's time, random numbers.   Out: a lamp, the probability of choosing it, the cone it
 *        fills.
 * Knows: the tree of lamps (scene_types.h), the interface of shape/, bsdf.cl.   Does not know: paths, shadows.
 *
 * The importance of a lamp is what its whole sphere would bring to a surface that scatters as a lobe does: for a matte
 * one its irradiance over pi, which is radiance times sin^2(sigma) cos(omega), exactly, as long as the lamp stands
 * above the horizon (sigma: half the angle that it fills; omega: from the normal to its centre). A node of the tree
 * stands for its lamps with the ball around them. From the root down, a child is chosen by its share of the
 * importance. A lamp that moves stands where it is at the path's time, and a ball around some is around all of their ways.
 * Any probability is right, even 0, as long as choosing and asking for it compute the same bits: both go through
 * lamp_importances. */
#if SAMPLES_LAMPS
/* A lamp below this share of the squared distance is treated as if it were around the point. */
#define LAMP_POWER_MIN R(0x1p-20)

#if SAMPLES_LAMP_TREE
/* A child of a node: a lamp, or the ball around some. */
typedef struct LampChild {
    Vec3 centre;
    vreal radius; /* negative: a ball around some, or around a triangle */
    vreal power;  /* 0: there is no such child, nor any after it */
} LampChild;

#if EFFECT_MOTION && SPHERES_MET
/* Brings a child to where it is at a time; `word`: its word. */
static void move_child(const Scene *scene, vuint word, vreal time, LampChild *child) {
    const vbool lamp = child->radius > splat(0);
    const vuint slot = choose_uint(lamp, word & ~splat_uint(CHILD_LEAF), splat_uint(0));
    child->centre = choose3(lamp, centre_at(&scene->geometry, slot, time, child->centre), child->centre);
}
#else
#define move_child(scene, word, time, child)
#endif

/* The same child of the root for all lanes, and one for each lane. */
static LampChild load_root_child(const Scene *scene, uint k, vreal time) {
    __global const real *row = place_in(scene->lamps, k); /* all of the root is in the first part */
    LampChild child;
    child.centre = vec3(splat(row[0]), splat(row[LAMP_WIDTH]), splat(row[2 * LAMP_WIDTH]));
    child.radius = splat(row[3 * LAMP_WIDTH]);
    child.power = splat(row[4 * LAMP_WIDTH]);
    move_child(scene, splat_uint(*place_in(scene->lamp_children, k)), time, &child);
    return child;
}

static LampChild load_child(const Scene *scene, vuint node, vuint k, vreal time) {
    const vuint place = node * LAMP_NODE_REALS + k;
    LampChild child;
    child.centre = vec3(gather_split_real(scene->lamps, 0, place), gather_split_real(scene->lamps, LAMP_WIDTH, place),
                        gather_split_real(scene->lamps, 2 * LAMP_WIDTH, place));
    child.radius = gather_split_real(scene->lamps, 3 * LAMP_WIDTH, place);
    child.power = gather_split_real(scene->lamps, 4 * LAMP_WIDTH, place);
    move_child(scene, gather_split_uint(scene->lamp_children, 0, node * LAMP_WIDTH + k), time, &child);
    return child;
}

#endif

#if EFFECT_METAL || SAMPLES_CAUSTICS
/* The cosine of the angle of which this is the sine, or a little less, without a root. */
static vreal cosine_below(vreal sine) {
    const vreal square = sine * sine;
    return fma(square * R(-0.5), square + splat(1), splat(1));
}
#endif

#if SAMPLES_DISCS || SAMPLES_CAUSTICS
/* The cosine by which a lobe sees what fills a cone: `z`, of the cone's middle from the lobe's axis, clipped by the horizon as if
 * the rim met it straight on; `sine`, of half the cone's angle. */
static vreal cone_cosine(const Lobe *lobe, vreal z, vreal sine) {
#if EFFECT_ROUGH_DIELECTRIC
    z = choose(is_rough_dielectric(lobe), splat(1), z);
#endif
    const vreal above = z + sine;
    const vreal cosine = choose(fabs(z) < sine, divide(above * above, splat(4) * sine), at_least(z, splat(0)));
#if EFFECT_METAL || SAMPLES_CAUSTICS
    /* Metal and the camera see what their cone touches. */
    const vreal touching = fma(cosine_below(lobe->fuzz), cosine_below(sine), -lobe->fuzz * sine);
    return choose(is_cone(lobe), choose(z >= touching, splat(1), splat(0)), cosine);
#else
    return cosine;
#endif
}
#endif

#if SAMPLES_LAMP_TREE
/* What a child may bring to a lobe at a point. */
FORCE_INLINE static vreal lamp_importance(const LampChild *child, const Point *point, const Lobe *lobe, vbool fuzzy) {
    const Vec3 to_centre = subtract3(child->centre, point->high);
    const vreal radius = fabs(child->radius);
    const vbool lamp = child->radius > splat(0);
    const vreal distance2 = at_least(dot3(to_centre, to_centre), splat(R(1e-30)));
    const vreal inverse = divide(splat(1), square_root(distance2));
    const vreal z = dot3(to_centre, lobe->axis) * inverse;
    const vreal sine = at_most(radius * inverse, splat(1));
    const vbool around = distance2 <= radius * radius;
    /* The cosine, clipped by the horizon as if the lamp's rim met it straight on. */
    vreal cosine = at_least(z, splat(0));
    const vbool clipped = fabs(z) < sine;
    if (any_lane(clipped)) {
        const vreal above = z + sine;
        cosine = choose(clipped, divide(above * above, splat(4) * sine), cosine);
    }
    vreal spread_inverse = inverse * inverse;
    if (any_lane(vbool_not(lamp))) {
        const vreal half_turn = z + splat(1);
        const vreal from_inside = at_least(half_turn * half_turn * R(0.25), splat(R(0.25)));
        cosine = choose(around, from_inside, cosine);
        const vreal ball = divide(splat(1), fma(radius * radius, splat(R(0.5)), distance2));
        spread_inverse = choose(lamp, spread_inverse, ball);
    }
#if EFFECT_METAL
    /* Metal sees what its cone touches. */
    if (any_lane(fuzzy)) {
        const vreal touching = fma(cosine_below(lobe->fuzz), cosine_below(sine), -lobe->fuzz * sine);
        const vbool touches = (z >= touching) | around;
        cosine = choose(fuzzy, choose(touches, splat(1), splat(0)), cosine);
    }
#endif
#if EFFECT_MEDIA
    cosine = choose(is_phase(lobe), splat(1), cosine); /* media have no horizon */
#endif
#if EFFECT_ROUGH_DIELECTRIC
    cosine = choose(is_rough_dielectric(lobe), splat(1), cosine); /* and light comes from both sides of rough glass */
#endif
    return choose(lamp & around, splat(0), child->power * cosine * spread_inverse);
}

/* The importance of each child of a node, and their sum, always in the same order. `count`: of the children that some
 * lane has. `root`: every lane asks the root. */
FORCE_INLINE static vreal lamp_importances(const Scene *scene, vuint node, int root, const Point *point,
                                           const Lobe *lobe, vreal time, vreal importance[LAMP_WIDTH], LampChild children[LAMP_WIDTH],
                                           uint *count) {
    const vbool fuzzy = is_fuzzy(lobe);
    vreal sum = splat(0);
    uint k = 0;
    for (; k < LAMP_WIDTH; ++k) {
        children[k] = root ? load_root_child(scene, k, time) : load_child(scene, node, splat_uint(k), time);
        if (!any_lane(children[k].power > splat(0))) break;
        importance[k] = lamp_importance(&children[k], point, lobe, fuzzy);
        sum += importance[k];
    }
    *count = k;
    return sum;
}

#endif

#if !SPHERES_MET
/* Around a triangle, or some. */
typedef struct Sphere {
    Vec3 centre;
    vreal radius;
} Sphere;
#endif

/* A lamp, chosen for a point. `sphere`: of a triangle, with a radius below 0, what importance takes it for. */
typedef struct LampChoice {
    vuint slot;
    Sphere sphere;
    vreal probability; /* 0: no lamp has anything to bring */
    vreal sum;         /* of the importance of all lamps */
    vreal rest;        /* what is left of the number that chose: uniform in [0, 1) again */
} LampChoice;

#if SAMPLES_LAMP_TREE
/* Takes a child of `node` in the lanes that are `active`, by the number choice->rest; returns its word. `refill` brings
 * new low bits to what is left of that number. */
FORCE_INLINE static vuint choose_child(const Scene *scene, vuint node, int root, const Point *point, const Lobe *lobe,
                                       vreal time, vreal refill, vbool active, LampChoice *choice) {
    vreal importance[LAMP_WIDTH];
    LampChild children[LAMP_WIDTH];
    uint count;
    const vreal sum = lamp_importances(scene, node, root, point, lobe, time, importance, children, &count);
    const vreal target = choice->rest * sum;
    vreal below = splat(0), chosen_below = splat(0), chosen = splat(0);
    vuint child = splat_uint(0);
    Sphere sphere = choice->sphere;
    for (uint k = 0; k < count; ++k) {
        const vbool reached = (below <= target) & (importance[k] > splat(0));
        child = choose_uint(reached, splat_uint(k), child);
        chosen = choose(reached, importance[k], chosen);
        chosen_below = choose(reached, below, chosen_below);
        sphere.centre = choose3(reached, children[k].centre, sphere.centre);
        sphere.radius = choose(reached, children[k].radius, sphere.radius);
        below += importance[k];
    }
    const vbool some = chosen > splat(0);
    const vreal rest = divide(fma(refill * R(0x1p-24), sum, target - chosen_below), choose(some, chosen, splat(1)));
    const vreal share = choose(some, divide(chosen, sum), splat(0));
    choice->rest = choose(active, at_most(at_least(rest, splat(0)), splat(R(1.0) - ROUNDOFF)), choice->rest);
    choice->probability = choose(active, choice->probability * share, choice->probability);
    choice->sphere.centre = choose3(active, sphere.centre, choice->sphere.centre);
    choice->sphere.radius = choose(active, sphere.radius, choice->sphere.radius);
    if (root) choice->sum = sum;
    return gather_split_uint(scene->lamp_children, 0, node * LAMP_WIDTH + child);
}

/* The lanes that are to descend below the child `word`. */
static vbool goes_deeper(vbool active, vreal probability, vuint word) {
    return active & (probability > splat(0)) & vbool_of_uint((word & splat_uint(CHILD_LEAF)) == splat_uint(0));
}

/* Chooses by `number`, in [0, 1). */
static LampChoice choose_lamp(const Scene *scene, const Point *point, const Lobe *lobe, vreal time, SampleKey key,
                              vuint bounce, vreal number, vbool active) {
    LampChoice choice;
    choice.rest = number;
    choice.sphere.centre = zero3();
    choice.sphere.radius = splat(1);
#if EFFECT_CAPSULES
    be_sphere(&choice.sphere);
#endif
    choice.probability = choose(active, splat(1), splat(0));
    vuint refill = bounce + BOUNCE_LAMP_REFILL;
    vuint word = choose_child(scene, splat_uint(0), 1, point, lobe, time, uniform(key, refill), active, &choice);
    for (;;) {
        const vbool deeper = goes_deeper(active, choice.probability, word);
        if (!any_lane(deeper)) break;
        refill += splat_uint(LAMP_REFILL_STRIDE);
        const vuint node = choose_uint(deeper, word, splat_uint(0));
        const vuint below = choose_child(scene, node, 0, point, lobe, time, uniform(key, refill), deeper, &choice);
        word = choose_uint(deeper, below, word);
    }
    choice.slot = choose_uint(choice.probability > splat(0), word & ~splat_uint(CHILD_LEAF), splat_uint(0));
    return choice;
}

/* The share that choose_child gives to child `k` of a node. */
static vreal share_of_child(const Scene *scene, vuint node, const Point *point, const Lobe *lobe, vreal time, vuint k) {
    vreal importance[LAMP_WIDTH];
    LampChild children[LAMP_WIDTH];
    uint count;
    const vreal sum = lamp_importances(scene, node, 0, point, lobe, time, importance, children, &count);
    vreal chosen = splat(0);
    for (uint i = 0; i < count; ++i) chosen = choose(vbool_of_uint(k == splat_uint(i)), importance[i], chosen);
    return choose(chosen > splat(0), divide(chosen, sum), splat(0));
}

/* The probability with which choose_lamp chooses the lamp in `slot`, when it has found the sum `sum`; 0 if it is not in the
 * tree. */
static vreal lamp_probability(const Scene *scene, const Point *point, const Lobe *lobe, vreal time, vreal sum, vuint slot,
                              vbool active) {
    const uint mask = LAMP_WIDTH - 1u;
    vuint trail = gather_split_uint(scene->slot_lamp, 0, choose_uint(active, slot, splat_uint(0)));
    const vbool known = active & vbool_of_uint(trail != splat_uint(NO_LAMP));
    vuint k = trail & mask;
    const LampChild child = load_child(scene, splat_uint(0), k, time);
    const vreal importance = lamp_importance(&child, point, lobe, is_fuzzy(lobe));
    vreal probability = choose(known & (importance > splat(0)), divide(importance, sum), splat(0));
    vuint word = gather_split_uint(scene->lamp_children, 0, k);
    for (;;) {
        const vbool deeper = goes_deeper(known, probability, word);
        if (!any_lane(deeper)) break;
        trail >>= LAMP_CHILD_BITS;
        k = trail & mask;
        const vuint node = choose_uint(deeper, word, splat_uint(0));
        const vreal share = share_of_child(scene, node, point, lobe, time, k);
        probability = choose(deeper, probability * share, probability);
        word = choose_uint(deeper, gather_split_uint(scene->lamp_children, 0, node * LAMP_WIDTH + k), word);
    }
    return probability;
}

#endif

/* The cone that a lamp fills, seen from a point. */
typedef struct LampCone {
    Vec3 axis;       /* unit, to the centre */
    vreal distance;  /* of the centre */
    vreal power;     /* of the point: distance^2 - radius^2 */
    vreal tangent;   /* the distance at which a ray touches the sphere */
    vreal cap;       /* 1 - cos of half its angle; 2 pi times this is its solid angle */
    vbool outside;   /* the point lies outside, and not too close; else the rest means nothing */
#if SAMPLES_TRIANGLES
    TriangleView view; /* of a triangle, whose cap is its solid angle over 2 pi, and which has none of the first four */
#endif
} LampCone;

#if SPHERES_MET

/* 1 - cos(sigma) as sin^2(sigma) / (1 + cos(sigma)), and cos^2(sigma) as the power's share of the squared distance:
 * nothing cancels, however small or close the lamp. */
FORCE_INLINE static LampCone lamp_cone(const Point *point, const Sphere *lamp) {
    LampCone cone;
    Vec3 to_centre;
    cone.power = sphere_power(point, lamp, &to_centre);
    const vreal distance2 = dot3(to_centre, to_centre);
    cone.distance = square_root(distance2);
    const vreal inverse = divide(splat(1), cone.distance);
    const vreal sine = lamp->radius * inverse;
    const vreal share = cone.power * inverse * inverse;
    cone.outside = share > splat(LAMP_POWER_MIN);
    cone.axis = scale3(inverse, to_centre);
    const vreal cosine = square_root(choose(cone.outside, share, splat(1)));
    cone.tangent = cone.distance * cosine;
    cone.cap = divide(sine * sine, splat(1) + cosine);
    return cone;
}

/* A unit direction, uniform in the cone for u and v uniform in [0, 1). */
static Vec3 sample_cone(const LampCone *cone, vreal u, vreal v) {
    const vreal m = u * cone->cap;
    const vreal cosine = splat(1) - m, sine = square_root(m * (splat(2) - m));
    vreal along, across;
    sin_cos_turn(v, &across, &along);
    along = along * sine;
    across = across * sine;
    const Vec3 w = cone->axis;
    Vec3 s, t;
    basis_across(w, &s, &t);
    const Vec3 direction = madd3(cosine, w, madd3(along, s, scale3(across, t)));
    /* The length is 1 except for rounding: one step of Newton's method stands for a root and a division. */
    return scale3(fma(dot3(direction, direction), splat(R(-0.5)), splat(R(1.5))), direction);
}

/* How far the sphere is along the direction of `u`: the power over the sum of the two distances at which its line meets
 * the sphere, so nothing cancels. */
static vreal cone_distance(const LampCone *cone, vreal radius, vreal u) {
    const vreal k = cone->cap;
    const vreal half_chord =
        radius * square_root(at_least(divide((splat(1) - u) * (splat(2) - k * (splat(1) + u)), splat(2) - k), splat(0)));
    return divide(cone->power, fma(cone->distance, splat(1) - u * k, half_chord));
}
#else
static LampCone lamp_cone(const Point *point, const Sphere *sphere) {
    LampCone cone;
    cone.axis = zero3();
    cone.distance = cone.power = cone.tangent = cone.cap = splat(0);
    cone.outside = vbool_none;
    return cone;
}
#endif
#endif
