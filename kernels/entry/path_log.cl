/* path_log.cl: one path, step by step, for a person: the same code as bounce.cl, with a record of each segment.
 *
 * Appended to a program of one lane when someone asks (host/render/path_log.c).
 * In:    the packed scene, a pixel, a sample.   Out: for each segment LOG_REALS numbers, in the order of the enum.
 * Knows: path.cl, bounce.cl, lamps_direct.cl, caustics.cl, roulette.cl.   Does not know: how a person wants to read it. */
enum {
    LOG_ORIGIN,                        /* of the segment, relative to the camera */
    LOG_DIRECTION = LOG_ORIGIN + 3,    /* of the segment */
    LOG_DISTANCE = LOG_DIRECTION + 3,  /* to what it meets */
    LOG_POINT,                         /* where it meets it */
    LOG_THROUGHPUT = LOG_POINT + 3,    /* after the hit */
    LOG_RADIANCE = LOG_THROUGHPUT + 3, /* collected so far */
    LOG_MET = LOG_RADIANCE + 3,        /* 0: the sky, 2: it was scattered by a medium, 3: a shadow on the shadow catcher,
                                          4: the shadow catcher where there is none */
    LOG_ENTERS,                        /* from outside to inside */
    LOG_GOES_ON,
    LOG_INWARD, /* continues inside */
    LOG_LIT,    /* radiance from a lamp to which the vertex sent a ray */
    LOG_LED = LOG_LIT + 3, /* and from one to which it sent rays through a focuser */
    LOG_CHANCE = LOG_LED + 3, /* to go on that roulette gives it after this segment, or 0; negative: it ends */
    LOG_REALS
};

/* `spheres`: for each segment s the numbers of three spheres, or NO_SPHERE: what it met; the lamp that the vertex there
 * was to be lit by, or DISC_SLOT and the number of a disc; what stands first on the way to that lamp, which may be
 * itself; and where it met nothing the set of discs that it saw, one bit each. `steps`: how many segments there were. */
#if EFFECT_DISCS
static uint discs_seen(const Scene *scene, const Path *path) {
    uint seen = 0;
    for (uint i = 0; i < disc_count(scene); ++i) {
        __global const real *disc = scene->discs + i * DISC_REALS;
        if ((disc[DISC_SEEN] > 0 || path->depth > 1) && disc_contains(disc, path->direction)) seen |= 1u << i;
    }
    return seen;
}
#endif

#if EFFECT_ROULETTE
/* Plays roulette as it is played before the next segment. */
static real log_roulette(Path *path, uint max_depth) {
    int played = path->depth < max_depth && is_deep(path);
    const uint chance = roulette_chance(path, &played);
    if (played) play_roulette(path);
    return played ? (real)chance * (path->alive ? R(0x1p-24) : R(-0x1p-24)) : 0;
}
#else
#define log_roulette(path, max_depth) 0
#endif

__kernel VECTORS_WRITTEN void path_log(SCENE_PARAMETERS uint pixel, uint sample, uint capacity, __global real *records,
                                       __global uint *spheres, __global uint *steps) {
    const Scene scene = scene_init(SCENE_ARGUMENTS);
    Path path;
    path_none(&path);
    path_init_from_camera(camera, pixel_center, sample_key(seed_low, seed_high, pixel, sample, replicates),
                          (real)(pixel % width), (real)(pixel / width), 1, &path);
    light_camera(&scene, &path, 1);
    uint step = 0;
    while (path.alive && step < max_depth && step < capacity) {
        __global real *record = records + (size_t)step * LOG_REALS;
        record[LOG_ORIGIN] = path.origin.high.x;
        record[LOG_ORIGIN + 1] = path.origin.high.y;
        record[LOG_ORIGIN + 2] = path.origin.high.z;
        record[LOG_DIRECTION] = path.direction.x;
        record[LOG_DIRECTION + 1] = path.direction.y;
        record[LOG_DIRECTION + 2] = path.direction.z;
        trace_bounce(&scene, &path);
        uint lamp = NO_SPHERE, seen = NO_SPHERE;
        const Vec3 before = path.radiance;
        Vec3 led = before;
#if SAMPLES_LAMPS
#if SAMPLES_CAUSTICS
        /* light_vertices() does this first, too. */
        Path other = path;
        if (path.wants_lamps) light_through_focuser(&scene, &other, first_dimension(path.depth - 1u), 0, 1);
        led = other.radiance;
#endif
        path.lamp_slot = NO_SLOT;
        if (path.wants_lamps) light_vertices(&scene, &path);
        if (path.lamp_slot != NO_SLOT) {
            lamp = path.lamp_slot >= DISC_SLOT ? path.lamp_slot : *place_in(scene.geometry.slot_sphere, path.lamp_slot);
            seen = path.seen_slot >= DISC_SLOT ? path.seen_slot : *place_in(scene.geometry.slot_sphere, path.seen_slot);
        }
#endif
        record[LOG_DISTANCE] = (real)path.latest.distance;
        record[LOG_POINT] = path.origin.high.x;
        record[LOG_POINT + 1] = path.origin.high.y;
        record[LOG_POINT + 2] = path.origin.high.z;
        record[LOG_THROUGHPUT] = path.throughput.x;
        record[LOG_THROUGHPUT + 1] = path.throughput.y;
        record[LOG_THROUGHPUT + 2] = path.throughput.z;
        record[LOG_RADIANCE] = path.radiance.x;
        record[LOG_RADIANCE + 1] = path.radiance.y;
        record[LOG_RADIANCE + 2] = path.radiance.z;
        const Segment *end = &path.latest;
        record[LOG_MET] = end->scattered ? 2 : end->caught ? (end->dark ? 3 : 4) : end->met;
        record[LOG_ENTERS] = end->entered;
        record[LOG_GOES_ON] = path.alive;
        record[LOG_INWARD] = path.inward;
        record[LOG_LIT] = path.radiance.x - led.x;
        record[LOG_LIT + 1] = path.radiance.y - led.y;
        record[LOG_LIT + 2] = path.radiance.z - led.z;
        record[LOG_LED] = led.x - before.x;
        record[LOG_LED + 1] = led.y - before.y;
        record[LOG_LED + 2] = led.z - before.z;
        record[LOG_CHANCE] = log_roulette(&path, max_depth);
        uint discs = 0;
#if EFFECT_DISCS
        if (!end->met) discs = discs_seen(&scene, &path);
#endif
        spheres[4 * step] = end->met ? *place_in(scene.geometry.slot_sphere, path.own_slot) : NO_SPHERE;
        spheres[4 * step + 1] = lamp;
        spheres[4 * step + 2] = seen;
        spheres[4 * step + 3] = discs;
        ++step;
    }
    *steps = step;
}
