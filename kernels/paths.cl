/* paths.cl: the state of the paths that a work-item follows, in lane code. */

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
    /* Of the latest segment, for follow.cl. */
    masks met, entered;
    refineds distance;
} Paths;
