/* ray.cl: a ray, and the point that it leaves.
 *
 * Knows: vector.cl.   Does not know: spheres, trees. Read once for each number of lanes. */
#define Point LANED(Point)
#define Ray LANED(Ray)
#define cull_margin_of LANED(cull_margin_of)

/* A point known beyond the precision of a real: the unevaluated sum high + low. */
typedef struct Point {
    Vec3 high, low;
    vreal error; /* bound on the distance of high + low from the true place */
} Point;

typedef struct Ray {
    Point origin;
    Vec3 direction;    /* |d| = 1 within 4 ROUNDOFF */
    vreal cull_margin; /* bound on what the rounding of the origin does to a distance: cull_margin_of */
    vuint own_slot;    /* of the shape being left, or NO_SLOT */
    vbool inward;      /* it is left into its inside */
#if EFFECT_OPACITY
    vbool passes; /* it goes straight on from there */
#endif
#if EFFECT_MOTION
    vreal time; /* in [0, 1): from when the shutter opens to when it closes */
#endif
} Ray;

/* How far the rounding of a ray's origin, and its error, can move what sphere_is_candidate computes. */
static vreal cull_margin_of(const Point *origin) {
    return fma(fabs(origin->high.x) + fabs(origin->high.y) + fabs(origin->high.z), splat(R(4.0) * ROUNDOFF),
               origin->error);
}
