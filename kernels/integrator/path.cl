/* path.cl: the state of the paths that a work-item follows, in lane code. */

/* The paths that a work-item follows, one a lane. */
typedef struct Path {
    Point origin;
    Vec3 direction;
    Vec3 throughput, radiance;
    SampleKey key;
    vuint depth;   /* ray segments traced */
    vuint own_slot;
    vbool inward;
    vbool alive;
    /* Of the latest segment, for path_log.cl. */
    vbool met, entered;
    vrefined distance;
} Path;

/* What the paths meet next. */
typedef struct Hit {
    vrefined t;
    vbool met, enters;
    vuint slot, sphere;
} Hit;

/* Not below the distance met so far. */
static vreal bound_of(const Hit *hit) { return to_real(hit->t) * (R(1.0) + R(4.0) * ROUNDOFF); }
