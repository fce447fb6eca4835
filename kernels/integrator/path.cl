/* path.cl: the state of the paths that a work-item follows, in lane code. */

/* The paths that a work-item follows, one a lane. */
typedef struct Paths {
    Point origin;
    Vec3 direction;
    Vec3 throughput, radiance;
    SampleKey key;
    uints depth;   /* ray segments traced */
    uints own_slot;
    masks inward;
    masks alive;
    /* Of the latest segment, for path_log.cl. */
    masks met, entered;
    refineds distance;
} Paths;

/* What the paths meet next. */
typedef struct Meeting {
    refineds t;
    masks met, enters;
    uints slot, sphere;
} Meeting;

/* Not below the distance met so far. */
static reals bound_of(const Meeting *meeting) { return to_real(meeting->t) * (R(1.0) + R(4.0) * ROUNDOFF); }
