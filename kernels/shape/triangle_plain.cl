/* triangle_plain.cl: where a ray meets a triangle, with --numerics plain: the usual test, a least distance, and nothing else
 * (T. Moeller and B. Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", 1997).
 *
 * Neighbours compute different numbers, so rays slip between them, and triangles that are huge, tiny or far lose their
 * places. It stands here as the yardstick of what robustness costs.
 *
 * In and out: the interface of triangle_robust.cl, by which triangles are candidates that are not turned.
 * Knows: ray.cl, PLAIN_T_MIN (sphere_plain.cl).   Does not know: trees, materials. Read once for each number of lanes. */
#if EFFECT_TRIANGLES
#undef OWN_SHAPE_IS_MET
#undef ROBUST_SHAPES
#define OWN_SHAPE_IS_MET 1
#define ROBUST_SHAPES 0
#define Triangle LANED(Triangle)
#define Shear LANED(Shear)
#define turn3 LANED(turn3)
#define turn_triangle LANED(turn_triangle)
#define shear_of LANED(shear_of)
#define doubt_of LANED(doubt_of)
#define cross3 LANED(cross3)
#define triangle_meets LANED(triangle_meets)
#define triangle_is_candidate LANED(triangle_is_candidate)
#define triangle_decide LANED(triangle_decide)
#define triangle_surface LANED(triangle_surface)
#define Shares LANED(Shares)
#define triangle_shares LANED(triangle_shares)
#define triangle_between LANED(triangle_between)
#define TriangleView LANED(TriangleView)
#define triangle_view LANED(triangle_view)

typedef struct Triangle {
    Vec3 a, b, c;
} Triangle;

#if SHARES_KNOWN
typedef struct Shares {
    vreal b, c;
} Shares;
#endif

/* The members of triangle_robust.cl, of which two mean something. */
typedef struct Shear {
    vbool along_x, along_y;
    Vec3 direction, origin, low;
    Vec3 slope; /* the direction */
    vreal margin, error, doubt;
} Shear;

static Vec3 turn3(const Shear *shear, Vec3 v) { return v; }
static Triangle turn_triangle(const Shear *shear, const Triangle *triangle) { return *triangle; }

static Shear shear_of(const Ray *ray) {
    Shear shear;
    shear.along_x = shear.along_y = vbool_none;
    shear.direction = shear.slope = ray->direction;
    shear.origin = ray->origin.high;
    shear.low = zero3();
    shear.margin = shear.error = splat(0);
    shear.doubt = splat(-1);
    return shear;
}

static vreal doubt_of(const Ray *ray, const Triangle *left) { return splat(-1); }

static Vec3 cross3(Vec3 a, Vec3 b) {
    return vec3(fma(a.y, b.z, -(a.z * b.y)), fma(a.z, b.x, -(a.x * b.z)), fma(a.x, b.y, -(a.y * b.x)));
}

FORCE_INLINE static vbool triangle_meets(Vec3 origin, Vec3 direction, const Triangle *triangle, vreal *t, vbool *enters) {
    const Vec3 to_b = subtract3(triangle->b, triangle->a), to_c = subtract3(triangle->c, triangle->a);
    const Vec3 from = subtract3(origin, triangle->a), p = cross3(direction, to_c), q = cross3(from, to_b);
    const vreal determinant = dot3(to_b, p);
    const vbool some = vbool_not(determinant == splat(0));
    const vreal inverse = divide(splat(1), choose(some, determinant, splat(1)));
    const vreal b = dot3(from, p) * inverse, c = dot3(direction, q) * inverse;
    *t = dot3(to_c, q) * inverse;
    *enters = determinant > splat(0);
    return some & (b >= splat(0)) & (c >= splat(0)) & (b + c <= splat(1)) & (*t > splat(PLAIN_T_MIN));
}

FORCE_INLINE static vbool triangle_is_candidate(const Shear *shear, vreal bound, const Triangle *turned) {
    vreal t;
    vbool enters;
    return triangle_meets(shear->origin, shear->slope, turned, &t, &enters) & (t <= bound);
}

FORCE_INLINE static vbool triangle_decide(const Shear *shear, const Triangle *triangle, vrefined *t, vbool *enters,
                                          vbool *doubtful) {
    vreal distance;
    const vbool met = triangle_meets(shear->origin, shear->direction, triangle, &distance, enters);
    *t = to_refined(distance);
    *doubtful = vbool_none;
    return met;
}

#if SHARES_KNOWN
/* By the areas between a point of the triangle and its sides. */
static Shares triangle_shares(const Triangle *triangle, Vec3 point) {
    const Vec3 to_b = subtract3(triangle->b, triangle->a), to_c = subtract3(triangle->c, triangle->a);
    const Vec3 way = subtract3(point, triangle->a), normal = cross3(to_b, to_c);
    const vreal area2 = dot3(normal, normal), all = choose(area2 > splat(0), area2, splat(1));
    Shares shares;
    shares.b = at_most(at_least(divide(dot3(cross3(way, to_c), normal), all), splat(0)), splat(1));
    shares.c = at_most(at_least(divide(dot3(cross3(to_b, way), normal), all), splat(0)), splat(1) - shares.b);
    return shares;
}
#endif

#if MAPPED_TRIANGLES
static void triangle_between(const Shares *shares, vreal a, vreal b, vreal c, vreal *whole, vreal *rest) {
    const vreal number = fma(shares->b, b - a, fma(shares->c, c - a, a));
    *whole = floor(number);
    *rest = number - *whole;
}
#endif

FORCE_INLINE static void triangle_surface(const Ray *ray, const Triangle *triangle, WITH_SHARES(Shares *shares) Point *point,
                                          Vec3 *normal) {
    vreal t;
    vbool enters;
    triangle_meets(ray->origin.high, ray->direction, triangle, &t, &enters);
#if SHARES_KNOWN
    *shares = triangle_shares(triangle, madd3(t, ray->direction, ray->origin.high));
#endif
    point->high = madd3(t, ray->direction, ray->origin.high);
    point->low = zero3();
    point->error = splat(0);
    const Vec3 n = cross3(subtract3(triangle->b, triangle->a), subtract3(triangle->c, triangle->a));
    const vbool none = vbool_not(dot3(n, n) > splat(0));
    *normal = normalise3(choose3(none, vec3(splat(0), splat(0), splat(1)), n));
}

#if EFFECT_TRIANGLE_LAMPS
#undef TRIANGLE_FLAT
#undef TRIANGLE_BESIDE
#undef TRIANGLE_SEEN_MIN
#define TRIANGLE_FLAT R(0x1p-16)
#define TRIANGLE_BESIDE R(0x1p-10)
#define TRIANGLE_SEEN_MIN R(0x1p-100)
typedef struct TriangleView {
    Vec3 a, b, c;
    vreal height, turn, base, sum;
} TriangleView;

static vbool triangle_view(const Point *point, const Triangle *triangle, TriangleView *view) {
    const Vec3 a = subtract3(triangle->a, point->high), b = subtract3(triangle->b, point->high),
               c = subtract3(triangle->c, point->high);
    const Vec3 normal = cross3(subtract3(triangle->b, triangle->a), subtract3(triangle->c, triangle->a));
    const vreal to_a = square_root(dot3(a, a)), to_b = square_root(dot3(b, b)), to_c = square_root(dot3(c, c));
    const vreal volume = fabs(dot3(a, normal)), off = to_a * (fabs(normal.x) + fabs(normal.y) + fabs(normal.z));
    view->a = scale3(divide(splat(1), to_a), a);
    view->b = scale3(divide(splat(1), to_b), b);
    view->c = scale3(divide(splat(1), to_c), c);
    view->height = divide(divide(divide(volume, to_a), to_b), to_c);
    view->turn = dot3(view->c, add3(view->a, view->b));
    view->base = splat(1) + dot3(view->a, view->b);
    view->sum = view->base + view->turn;
    const vbool aslant = volume > TRIANGLE_FLAT * off, seen = view->height > splat(TRIANGLE_SEEN_MIN);
    const vbool apart = view->height + fabs(view->sum) > splat(TRIANGLE_BESIDE);
    return aslant & seen & apart;
}
#endif
#endif
