/* path_log.cl: one path, step by step, for a person: the same code as bounce.cl, with a record of each segment.
 *
 * Appended to a program of one lane when someone asks (host/engine/follow.c).
 * Out: for each segment FOLLOW_REALS numbers, in the order of the enum. */
enum {
    FOLLOW_ORIGIN,                          /* of the segment, relative to the camera */
    FOLLOW_DIRECTION = FOLLOW_ORIGIN + 3,   /* of the segment */
    FOLLOW_DISTANCE = FOLLOW_DIRECTION + 3, /* to what it meets */
    FOLLOW_POINT,                           /* where it meets it */
    FOLLOW_THROUGHPUT = FOLLOW_POINT + 3,   /* after the meeting */
    FOLLOW_RADIANCE = FOLLOW_THROUGHPUT + 3, /* collected so far */
    FOLLOW_MET = FOLLOW_RADIANCE + 3,       /* 0: the sky */
    FOLLOW_ENTERS,                          /* from outside to inside */
    FOLLOW_GOES_ON,
    FOLLOW_INWARD, /* goes on inside */
    FOLLOW_REALS
};

/* `spheres[s]`: the number of the sphere that segment s met. `steps`: how many segments there were. */
__kernel void follow(SCENE_PARAMETERS, uint pixel, uint sample, uint capacity, __global real *records,
                     __global uint *spheres, __global uint *steps) {
    const Scene scene = begin_scene(SCENE_ARGUMENTS);
    Paths path;
    path.alive = 0;
    path.inward = 0;
    begin_paths(camera, pixel_center, sample_key(seed_low, seed_high, pixel, sample, replicates), (real)(pixel % width),
                (real)(pixel / width), 1, &path);
    uint step = 0;
    while (path.alive && step < max_depth && step < capacity) {
        __global real *record = records + (size_t)step * FOLLOW_REALS;
        record[FOLLOW_ORIGIN] = path.origin.high.x;
        record[FOLLOW_ORIGIN + 1] = path.origin.high.y;
        record[FOLLOW_ORIGIN + 2] = path.origin.high.z;
        record[FOLLOW_DIRECTION] = path.direction.x;
        record[FOLLOW_DIRECTION + 1] = path.direction.y;
        record[FOLLOW_DIRECTION + 2] = path.direction.z;
        advance(&scene, &path);
        record[FOLLOW_DISTANCE] = (real)path.distance;
        record[FOLLOW_POINT] = path.origin.high.x;
        record[FOLLOW_POINT + 1] = path.origin.high.y;
        record[FOLLOW_POINT + 2] = path.origin.high.z;
        record[FOLLOW_THROUGHPUT] = path.throughput.x;
        record[FOLLOW_THROUGHPUT + 1] = path.throughput.y;
        record[FOLLOW_THROUGHPUT + 2] = path.throughput.z;
        record[FOLLOW_RADIANCE] = path.radiance.x;
        record[FOLLOW_RADIANCE + 1] = path.radiance.y;
        record[FOLLOW_RADIANCE + 2] = path.radiance.z;
        record[FOLLOW_MET] = path.met;
        record[FOLLOW_ENTERS] = path.entered;
        record[FOLLOW_GOES_ON] = path.alive;
        record[FOLLOW_INWARD] = path.inward;
        spheres[step] = path.met ? slot_sphere[path.own_slot] : NO_SPHERE;
        ++step;
    }
    *steps = step;
}
