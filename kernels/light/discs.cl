/* discs.cl: lamps at infinity: discs in the sky, which add their radiance to it in a cone of directions.
 *
 * In:    a direction; a lobe and a random number.   Out: whether the direction lies in a disc; a disc chosen for the lobe, in
 *        place of a lamp of the tree, with its probability and its cone.
 * Knows: PackedDisc (scene_types.h), lamps.cl, bsdf.cl.   Does not know: paths, shadows.
 *
 * A disc's importance is that of a lamp that fills the same cone, from any point: radiance times sin^2 of the half
 * angle times the clipped cosine, its irradiance over pi where it stands above the horizon. The tree of lamps as a whole
 * has the importance of its root's children, so one number chooses among the tree and every disc, each by its share. An image
 * around the scene is one more in that choice. */
#if EFFECT_DISCS
static uint disc_count(const Scene *scene) { return (uint)scene->sky->top[3]; }

/* The distance from the middle of the disc tells what a cosine near 1 does not. */
static vbool disc_contains(__global const real *disc, Vec3 direction) {
    const Vec3 off = subtract3(direction, splat3(disc + DISC_DIRECTION));
    return dot3(off, off) <= splat(disc[DISC_CHORD2]);
}
#endif

#if SAMPLES_DISCS
static vreal disc_importance(__global const real *disc, const Lobe *lobe) {
    const vreal z = dot3(splat3(disc + DISC_DIRECTION), lobe->axis);
    const vreal sine = splat(disc[DISC_SINE]);
    vreal cosine = cone_cosine(lobe, z, sine);
#if EFFECT_MEDIA
    cosine = choose(is_phase(lobe), splat(1), cosine);
#endif
    return cosine * disc[DISC_POWER];
}
#endif

#if SAMPLES_SKY
/* Of the tree of lamps, seen from a point. */
static vreal tree_importance(const Scene *scene, const Point *point, const Lobe *lobe, vreal time) {
#if SAMPLES_LAMP_TREE
    vreal importance[LAMP_WIDTH];
    LampChild children[LAMP_WIDTH];
    uint count;
    return lamp_importances(scene, splat_uint(0), 1, point, lobe, time, importance, children, &count);
#else
    return splat(0);
#endif
}

/* A choice among the discs, the image around and the tree of lamps. */
typedef struct DiscChoice {
    vbool chosen;      /* a disc, or the image; else the tree */
    vuint slot;        /* of the disc: DISC_SLOT and its number; or IMAGE_SLOT */
    vreal probability; /* of what has been chosen */
    vreal sum;         /* of the importance of all */
    vreal rest;        /* what is left of the number that chose: uniform in [0, 1) again */
    Vec3 direction;    /* to the disc */
    vreal cap;         /* of the disc */
} DiscChoice;

/* Chooses by `number`, in [0, 1). Where no disc has anything to bring, the tree gets the number as it is. */
static DiscChoice choose_disc(const Scene *scene, const Point *point, const Lobe *lobe, vreal time, SampleKey key,
                              vuint bounce, vreal number) {
    const vreal tree = tree_importance(scene, point, lobe, time);
    vreal discs = splat(0);
#if SAMPLES_DISCS
    const uint count = disc_count(scene);
    for (uint i = 0; i < count; ++i) discs += disc_importance(scene->discs + i * DISC_REALS, lobe);
#endif
#if SAMPLES_ENVIRONMENT
    discs += environment_importance(scene);
#endif
    DiscChoice choice;
    choice.sum = tree + discs;
    const vreal target = number * choice.sum;
    choice.chosen = (discs > splat(0)) & (target >= tree);
    choice.slot = splat_uint(DISC_SLOT);
    choice.direction = zero3();
    choice.cap = splat(1);
    vreal below = tree, chosen_below = splat(0), chosen = tree;
#if SAMPLES_DISCS
    for (uint i = 0; i < count; ++i) {
        __global const real *disc = scene->discs + i * DISC_REALS;
        const vreal importance = disc_importance(disc, lobe);
        const vbool reached = choice.chosen & (below <= target) & (importance > splat(0));
        choice.slot = choose_uint(reached, splat_uint(DISC_SLOT + i), choice.slot);
        choice.direction = choose3(reached, splat3(disc + DISC_DIRECTION), choice.direction);
        choice.cap = choose(reached, splat(disc[DISC_CAP]), choice.cap);
        chosen = choose(reached, importance, chosen);
        chosen_below = choose(reached, below, chosen_below);
        below += importance;
    }
#endif
#if SAMPLES_ENVIRONMENT
    const vreal image = environment_importance(scene);
    const vbool around = choice.chosen & (below <= target) & (image > splat(0));
    choice.slot = choose_uint(around, splat_uint(IMAGE_SLOT), choice.slot);
    chosen = choose(around, image, chosen);
    chosen_below = choose(around, below, chosen_below);
#endif
    const vbool some = chosen > splat(0);
    const vreal refill = uniform(key, bounce + BOUNCE_DISC_REFILL) * R(0x1p-24);
    const vreal rest = divide(fma(refill, choice.sum, target - chosen_below), choose(some, chosen, splat(1)));
    choice.probability = choose(some, divide(chosen, choice.sum), splat(0));
    choice.rest = choose(discs > splat(0), at_most(at_least(rest, splat(0)), splat(R(1.0) - ROUNDOFF)), number);
    return choice;
}

#if SAMPLES_ENVIRONMENT
/* Gives the choice a direction where it is the image, by the number that is left and `v`, in the `active` lanes. Its texel
 * is a cone of that direction alone. */
static void choose_texel(const Scene *scene, SampleKey key, vuint bounce, vreal v, vbool active, DiscChoice *choice) {
    const vbool around = active & choice->chosen & vbool_of_uint(choice->slot == splat_uint(IMAGE_SLOT));
    if (!any_lane(around)) return;
    Vec3 direction;
    const EnvironmentCell cell = sample_environment(scene, key, bounce, choice->rest, v, &direction);
    choice->direction = choose3(around, direction, choice->direction);
    choice->probability = choose(around, choice->probability * cell.probability, choice->probability);
    choice->cap = choose(around, cell.cap, choice->cap);
    choice->rest = choose(around, splat(0), choice->rest);
}
#endif

#if SAMPLES_DISCS
/* The probability with which choose_disc chooses this disc, when it has found the sum `sum`. */
static vreal disc_probability(__global const real *disc, const Lobe *lobe, vreal sum) {
    const vreal importance = disc_importance(disc, lobe);
    return choose(importance > splat(0), divide(importance, sum), splat(0));
}
#endif

/* Takes a choice among the tree of lamps, made with the number choice.rest, together with that of a disc: where a disc
 * has been chosen, it is the lamp, at a distance that no sphere has. */
static void take_disc(const DiscChoice *disc, LampChoice *lamp, LampCone *cone) {
    const vbool chosen = disc->chosen;
    lamp->slot = choose_uint(chosen, disc->slot, lamp->slot);
    lamp->sphere.radius = choose(chosen, splat(0), lamp->sphere.radius);
    lamp->probability = choose(chosen, disc->probability, lamp->probability * disc->probability);
    lamp->sum = disc->sum;
    lamp->rest = choose(chosen, disc->rest, lamp->rest);
    cone->axis = choose3(chosen, disc->direction, cone->axis);
    cone->distance = choose(chosen, splat(REAL_LARGE), cone->distance);
    cone->power = choose(chosen, splat(REAL_LARGE), cone->power);
    cone->tangent = choose(chosen, splat(REAL_LARGE), cone->tangent);
    cone->cap = choose(chosen, disc->cap, cone->cap);
    cone->outside = cone->outside | chosen;
}
#endif
