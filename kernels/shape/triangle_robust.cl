/* triangle_robust.cl: where a ray meets a triangle, with decisions that no two triangles of a mesh contradict each other in.
 *
 * In:    a ray whose origin is the unevaluated sum high + low, a triangle as it is stored.
 * Out:   shear_of               the ray's shear, which the tests below work in
 *        doubt_of               what is known of the triangle that it leaves before it meets another
 *        triangle_is_candidate  may the ray meet the triangle before `bound`? Quick; what it rules out is surely not met.
 *        triangle_decide        does the ray meet it, at which distance, and from outside (the side from which its
 *                               vertices run counter-clockwise) or inside? Or is that for the next to decide?
 *        triangle_intersect     the same, for every triangle
 *        triangle_beside_sphere the same, for a ray that leaves a sphere
 *        triangle_surface       the point that was met, as an origin for the next ray, and the outward unit normal; for
 *                               triangles with normals or coordinates at their vertices the point's shares of these
 *        triangle_between       by these shares, a number between those at the vertices
 *        triangle_view          what a point sees of it, for rays to a triangle that emits
 * Knows: ray.cl, wide.cl.   Does not know: trees, materials. Read once for each number of lanes.
 *
 * The ray is sheared to the axis along which it is longest, x and y of each vertex then lie in a plane, in which the ray
 * is the origin (S. Woop, C. Benthin and I. Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013). A vertex is
 * sheared by a function of itself and the ray, so triangles that share it see it at the same place; and an edge function
 * has the exact sign of the products that it is made of, so the two triangles of an edge see the ray on opposite sides
 * of it. A closed mesh therefore has no cracks. docs/NUMERICS.md has the bounds.
 *
 * Leaving a triangle has no least distance. A plane is not met again, so the triangle that is left is not met. For others
 * that the origin, or what is met, may lie in the plane of, the two triangles decide, since their vertices are exact:
 * - the side to which the ray leaves is the sign of d.n of the triangle that is left. A triangle without a vertex
 *   strictly on that side is not met;
 * - where the triangle that is left lies on one closed side of the other's plane, the ray meets that only from there,
 *   and a distance that rounding made negative is 0; where it lies in that plane, never;
 * - of an edge that both share, the edge function is d.n of the one that is left, times what is known to be positive.
 * A sphere that is left, and lies on one side of the plane of a triangle that it touches, stands for the second of these. */
#if EFFECT_TRIANGLES
#undef OWN_SHAPE_IS_MET
#undef ROBUST_SHAPES
#define OWN_SHAPE_IS_MET 0
#define ROBUST_SHAPES 1
#define Triangle LANED(Triangle)
#define Shares LANED(Shares)
#define triangle_between LANED(triangle_between)
#define Shear LANED(Shear)
#define Edges LANED(Edges)
#define turn3 LANED(turn3)
#define turn_triangle LANED(turn_triangle)
#define shear_of LANED(shear_of)
#define doubt_of LANED(doubt_of)
#define edges_of LANED(edges_of)
#define edges_hold LANED(edges_hold)
#define edges_moment LANED(edges_moment)
#define edges_distance LANED(edges_distance)
#define from_outside LANED(from_outside)
#define area_bound LANED(area_bound)
#define triangle_is_candidate LANED(triangle_is_candidate)
#define triangle_decide LANED(triangle_decide)
#define triangle_intersect LANED(triangle_intersect)
#define triangle_beside_sphere LANED(triangle_beside_sphere)
#define holds_foot LANED(holds_foot)
#define triangle_surface LANED(triangle_surface)
#define same_place LANED(same_place)
#define is_vertex_of LANED(is_vertex_of)
#define add_side LANED(add_side)
#define sides_of LANED(sides_of)
#define know_edge LANED(know_edge)
#define Sides LANED(Sides)
#define TriangleView LANED(TriangleView)
#define triangle_view LANED(triangle_view)
#define way_from LANED(way_from)

typedef struct Triangle {
    Vec3 a, b, c;
} Triangle;

#if SHARES_KNOWN
/* Of a point of a triangle: at least 0, at most 1 together; vertex a has the rest. */
typedef struct Shares {
    vreal b, c;
#if MAPPED_TRIANGLES
    Wide of_b, of_c;
#endif
} Shares;
#endif

/* `along`: of an axis, one third of all rays each; of equal components the later. */
typedef struct Shear {
    vbool along_x, along_y; /* else along z */
    Vec3 direction;         /* turned, so that it is longest along z */
    Vec3 origin, low;       /* turned */
    Vec3 slope;             /* what is added to x and y for each step along -z, and 1 / direction.z */
    vreal margin, error;    /* of the ray and of its origin */
    vreal doubt;            /* doubt_of, 0 where a sphere is left, below 0 where nothing is */
} Shear;

/* Turns a vector so that the axis that the ray runs along is z: by one or two places, which keeps its handedness. */
static Vec3 turn3(const Shear *shear, Vec3 v) {
    const vbool x = shear->along_x, y = shear->along_y;
    return vec3(choose(x, v.y, choose(y, v.z, v.x)), choose(x, v.z, choose(y, v.x, v.y)),
                choose(x, v.x, choose(y, v.y, v.z)));
}

static Triangle turn_triangle(const Shear *shear, const Triangle *triangle) {
    Triangle turned;
    turned.a = turn3(shear, triangle->a);
    turned.b = turn3(shear, triangle->b);
    turned.c = turn3(shear, triangle->c);
    return turned;
}

/* Of a ray that leaves nothing. */
static Shear shear_of(const Ray *ray) {
    const Vec3 d = ray->direction;
    const vreal x = fabs(d.x), y = fabs(d.y), z = fabs(d.z);
    Shear shear;
    shear.along_x = (x > y) & (x > z);
    shear.along_y = vbool_not(x > y) & (y > z);
    shear.direction = turn3(&shear, d);
    shear.origin = turn3(&shear, ray->origin.high);
    shear.low = turn3(&shear, ray->origin.low);
    shear.slope.z = divide(splat(1), shear.direction.z);
    shear.slope.x = shear.direction.x * shear.slope.z;
    shear.slope.y = shear.direction.y * shear.slope.z;
    shear.margin = ray->cull_margin;
    shear.error = ray->origin.error;
    shear.doubt = splat(-1);
    return shear;
}

/* In `real`, of a triangle that is turned. With R the largest |x| and |y| of sheared vertices and Z the largest |z|, a
 * sheared vertex errs by less than delta = 8 u (R + Z) + 2 margin (u = ROUNDOFF), an edge function by less than
 * 6 delta (R + delta), a vertex's distance by less than 2 delta. */
FORCE_INLINE static vbool triangle_is_candidate(const Shear *shear, vreal bound, const Triangle *turned) {
    const Vec3 a = subtract3(turned->a, shear->origin), b = subtract3(turned->b, shear->origin),
               c = subtract3(turned->c, shear->origin);
    const vreal ax = loose_fma(-shear->slope.x, a.z, a.x), ay = loose_fma(-shear->slope.y, a.z, a.y);
    const vreal bx = loose_fma(-shear->slope.x, b.z, b.x), by = loose_fma(-shear->slope.y, b.z, b.y);
    const vreal cx = loose_fma(-shear->slope.x, c.z, c.x), cy = loose_fma(-shear->slope.y, c.z, c.y);
    const vreal across = larger(larger(larger(fabs(ax), fabs(ay)), larger(fabs(bx), fabs(by))), larger(fabs(cx), fabs(cy)));
    const vreal along = larger(larger(fabs(a.z), fabs(b.z)), fabs(c.z));
    const vreal delta = loose_fma(splat(R(8.0) * ROUNDOFF), across + along, R(2.0) * shear->margin);
    const vreal margin = R(6.0) * delta * (across + delta);
    const vreal u = loose_fma(bx, cy, -(by * cx)), v = loose_fma(cx, ay, -(cy * ax)), w = loose_fma(ax, by, -(ay * bx));
    const vreal ta = a.z * shear->slope.z, tb = b.z * shear->slope.z, tc = c.z * shear->slope.z;
    const vbool right = smaller(smaller(u, v), w) >= -margin, left = larger(larger(u, v), w) <= margin;
    const vbool ahead = larger(larger(ta, tb), tc) >= R(-2.0) * delta;
    const vbool near = smaller(smaller(ta, tb), tc) <= bound + R(2.0) * delta;
    return (right | left) & ahead & near;
}

/* ---- the decision ---- */

/* Edge functions of the sheared triangle, each named by the vertex that its edge does not touch, and the vertices' z. */
typedef struct Edges {
    Wide a, b, c;
    Wide az, bz, cz;
    Wide slope; /* direction.z */
} Edges;

FORCE_INLINE static Edges edges_of(const Shear *shear, const Triangle *turned) {
    const Vec3 high = shear->origin, low = shear->low, a = turned->a, b = turned->b, c = turned->c;
    Edges edges;
    edges.slope = wide(shear->direction.z);
    const Wide x = wide_divide(wide(-shear->direction.x), edges.slope), y = wide_divide(wide(-shear->direction.y), edges.slope);
    edges.az = wide_difference(a.z, high.z, low.z);
    edges.bz = wide_difference(b.z, high.z, low.z);
    edges.cz = wide_difference(c.z, high.z, low.z);
    const Wide ax = wide_madd(x, edges.az, wide_difference(a.x, high.x, low.x));
    const Wide ay = wide_madd(y, edges.az, wide_difference(a.y, high.y, low.y));
    const Wide bx = wide_madd(x, edges.bz, wide_difference(b.x, high.x, low.x));
    const Wide by = wide_madd(y, edges.bz, wide_difference(b.y, high.y, low.y));
    const Wide cx = wide_madd(x, edges.cz, wide_difference(c.x, high.x, low.x));
    const Wide cy = wide_madd(y, edges.cz, wide_difference(c.y, high.y, low.y));
    edges.a = wide_area(bx, by, cx, cy);
    edges.b = wide_area(cx, cy, ax, ay);
    edges.c = wide_area(ax, ay, bx, by);
    return edges;
}

/* Whether the triangle holds the ray, and the sum of the three: 0 for a triangle that is seen from its edge. */
FORCE_INLINE static vbool edges_hold(const Edges *edges, Wide *sum) {
    const vbool below = wide_below_0(edges->a) | wide_below_0(edges->b) | wide_below_0(edges->c);
    const vbool above = wide_above_0(edges->a) | wide_above_0(edges->b) | wide_above_0(edges->c);
    *sum = wide_add(wide_add(edges->a, edges->b), edges->c);
    return vbool_not(below & above) & (wide_below_0(*sum) | wide_above_0(*sum));
}

/* To the triangle's plane: along z, times the sum. */
FORCE_INLINE static Wide edges_moment(const Edges *edges) {
    return wide_madd(edges->a, edges->az, wide_madd(edges->b, edges->bz, wide_multiply(edges->c, edges->cz)));
}

FORCE_INLINE static Wide edges_distance(const Edges *edges, Wide moment, Wide sum) {
    return wide_divide(wide_divide(moment, sum), edges->slope);
}

/* Whether the ray meets a triangle, whose sum of edge functions this is, from outside. */
static vbool from_outside(const Shear *shear, Wide sum) {
    const vreal z = shear->direction.z;
    return (wide_below_0(sum) & (z > splat(0))) | (wide_above_0(sum) & (z < splat(0)));
}

/* At least the 1-norm of the cross product of two edges, 2 * (1 + 8u) of it at most where they are at right angles. */
static vreal area_bound(const Triangle *triangle) {
    const Vec3 b = subtract3(triangle->b, triangle->a), c = subtract3(triangle->c, triangle->a);
    return R(2.0) * (fabs(b.x) + fabs(b.y) + fabs(b.z)) * (fabs(c.x) + fabs(c.y) + fabs(c.z));
}

/* Of a triangle that is turned. `doubtful`: the ray leaves a triangle or a sphere, and the origin or what is met may lie in the
 * other's plane; the rest then means nothing. The moment is the distance times d.n, so it is compared with what |n| may be. */
FORCE_INLINE static vbool triangle_decide(const Shear *shear, const Triangle *turned, vrefined *t, vbool *enters,
                                          vbool *doubtful) {
    const Edges edges = edges_of(shear, turned);
    Wide sum;
    const vbool held = edges_hold(&edges, &sum);
    const Wide moment = edges_moment(&edges), distance = edges_distance(&edges, moment, sum);
    const vbool at_once = vbool_not(fabs(wide_near(moment)) > shear->error * area_bound(turned));
    const vbool beside = vbool_not(fabs(wide_near(distance)) > shear->doubt);
    *doubtful = (shear->doubt >= splat(0)) & (at_once | beside);
    *t = wide_refined(distance);
    *enters = from_outside(shear, sum);
    return held & wide_above_0(distance);
}

/* ---- what is left ---- */

static vbool same_place(Vec3 a, Vec3 b) { return (a.x == b.x) & (a.y == b.y) & (a.z == b.z); }

static vbool is_vertex_of(const Triangle *triangle, Vec3 vertex) {
    return same_place(triangle->a, vertex) | same_place(triangle->b, vertex) | same_place(triangle->c, vertex);
}

/* On which sides of a plane vertices lie. */
typedef struct Sides {
    vbool above, below;
} Sides;

static void add_side(const Triangle *plane, WideVec normal, Vec3 vertex, Sides *sides) {
    const WideVec way = wide_from(plane->a, vertex);
    const vreal height = wide_near(wide_dot(way, normal));
    const vreal rounding = WIDE_ROUNDOFF * one_norm(way) * one_norm(normal);
    const vbool other = vbool_not(is_vertex_of(plane, vertex));
    sides->above = sides->above | (other & (height > rounding));
    sides->below = sides->below | (other & (height < -rounding));
}

static Sides sides_of(const Triangle *plane, WideVec normal, const Triangle *triangle) {
    Sides sides;
    sides.above = sides.below = vbool_none;
    add_side(plane, normal, triangle->a, &sides);
    add_side(plane, normal, triangle->b, &sides);
    add_side(plane, normal, triangle->c, &sides);
    return sides;
}

/* Replaces the edge function of the edge from p to q where the triangle that is left has that edge too. The origin lies in
 * that triangle, so the sign is that of d.n there, over direction.z; only signs are asked for. */
static void know_edge(Vec3 p, Vec3 q, const Triangle *left, Wide leans, vreal slope, vbool asked, Wide *edge) {
    const vbool pa = same_place(p, left->a), pb = same_place(p, left->b), pc = same_place(p, left->c);
    const vbool qa = same_place(q, left->a), qb = same_place(q, left->b), qc = same_place(q, left->c);
    const vbool along = asked & ((pa & qb) | (pb & qc) | (pc & qa));
    const vbool against = asked & ((pb & qa) | (pc & qb) | (pa & qc));
    *edge = wide_choose(along | against, wide_multiply(leans, wide(choose(along, slope, -slope))), *edge);
}

/* Up to which distance the origin of a ray that leaves a triangle may lie in its plane: `beside` below holds for no other.
 * d.n in `real` errs by less than 8 u of the product of the edges' 1-norms. */
static vreal doubt_of(const Ray *ray, const Triangle *left) {
    const Vec3 b = subtract3(left->b, left->a), c = subtract3(left->c, left->a), d = ray->direction;
    const vreal area = area_bound(left);
    const vreal x = fma(b.y, c.z, -(b.z * c.y)), y = fma(b.z, c.x, -(b.x * c.z)), z = fma(b.x, c.y, -(b.y * c.x));
    const vreal leans = fabs(fma(d.x, x, fma(d.y, y, d.z * z))) - R(16.0) * ROUNDOFF * area;
    const vbool some = leans > splat(0);
    return choose(some, ray->origin.error * divide(area, choose(some, leans, splat(1))), splat(REAL_MAX));
}

/* `left`: the triangle that is left in the lanes of `leaves`. */
FORCE_INLINE static vbool triangle_intersect(const Ray *ray, const Shear *shear, const Triangle *triangle, const Triangle *left,
                                             vbool leaves, vrefined *t, vbool *enters) {
    const Triangle turned = turn_triangle(shear, triangle);
    Edges edges = edges_of(shear, &turned);
    Wide sum;
    vbool held = edges_hold(&edges, &sum);
    const Wide distance = edges_distance(&edges, edges_moment(&edges), sum);
    vbool ahead = wide_above_0(distance);
    *t = wide_refined(distance);
    if (any_lane(leaves)) {
        WideVec d;
        d.x = wide(ray->direction.x);
        d.y = wide(ray->direction.y);
        d.z = wide(ray->direction.z);
        const WideVec left_normal = wide_cross(wide_from(left->a, left->b), wide_from(left->a, left->c));
        const WideVec normal = wide_cross(wide_from(triangle->a, triangle->b), wide_from(triangle->a, triangle->c));
        const Wide leans = wide_dot(d, left_normal), meets = wide_dot(d, normal);
        const vreal far = wide_near(distance), error = ray->origin.error;
        const vbool at_once = leaves & (fabs(far * wide_near(meets)) <= error * one_norm(normal));
        const vbool beside = leaves & (fabs(far * wide_near(leans)) <= error * one_norm(left_normal));
        const vbool asked = at_once | beside;
        if (any_lane(asked)) {
            know_edge(triangle->b, triangle->c, left, leans, shear->direction.z, asked, &edges.a);
            know_edge(triangle->c, triangle->a, left, leans, shear->direction.z, asked, &edges.b);
            know_edge(triangle->a, triangle->b, left, leans, shear->direction.z, asked, &edges.c);
            held = edges_hold(&edges, &sum);
            const Sides there = sides_of(left, left_normal, triangle), here = sides_of(triangle, normal, left);
            const vbool ruled = at_once | (beside & ahead);
            const vbool reached = (wide_above_0(leans) & there.above) | (wide_below_0(leans) & there.below);
            const vbool from_above = here.above & vbool_not(here.below) & wide_below_0(meets);
            const vbool from_below = here.below & vbool_not(here.above) & wide_above_0(meets);
            const vbool across = here.above & here.below & ahead;
            ahead = (ruled & reached & (from_above | from_below | across)) | (vbool_not(ruled) & ahead);
            *t = choose_refined(ruled & vbool_of_refined(*t < splat_refined(0)), splat_refined(0), *t);
        }
    }
    *enters = from_outside(shear, sum);
    return held & ahead;
}

#if SPHERES_MET
/* Whether a triangle holds the foot of a point: of the ray's origin, along about its normal. */
static vbool holds_foot(const Ray *ray, const Triangle *triangle, Vec3 normal) {
    Ray fall = *ray;
    fall.direction = normal;
    const Shear shear = shear_of(&fall);
    const Triangle turned = turn_triangle(&shear, triangle);
    const Edges edges = edges_of(&shear, &turned);
    Wide sum;
    return edges_hold(&edges, &sum);
}

/* For a ray that leaves a sphere. Where the origin lies in the triangle's plane, but for its error, and the sphere on one side of
 * that, the ray meets the triangle only from there. A distance that rounding made negative is 0, and then the place is that of
 * the origin, for a line that grazes the plane meets it elsewhere. A sphere whose numbers were rounded may dip into the plane
 * that it rests on: by 2^-19 of its radius it counts as on one side. */
static vbool triangle_beside_sphere(const Ray *ray, const Shear *shear, const Triangle *triangle, Vec3 centre, vreal radius,
                                    vrefined *t, vbool *enters) {
    const Triangle turned = turn_triangle(shear, triangle);
    const Edges edges = edges_of(shear, &turned);
    Wide sum;
    const vbool held = edges_hold(&edges, &sum);
    const Wide distance = edges_distance(&edges, edges_moment(&edges), sum);
    WideVec d;
    d.x = wide(ray->direction.x);
    d.y = wide(ray->direction.y);
    d.z = wide(ray->direction.z);
    const WideVec normal = wide_cross(wide_from(triangle->a, triangle->b), wide_from(triangle->a, triangle->c));
    const WideVec way = wide_from(triangle->a, centre);
    const Vec3 unit = wide_unit(normal);
    const vreal length = fma(wide_near(normal.x), unit.x, fma(wide_near(normal.y), unit.y, wide_near(normal.z) * unit.z));
    const vreal height = wide_near(wide_dot(way, normal)), meets = wide_near(wide_dot(d, normal)), error = ray->origin.error;
    const vreal rounding = WIDE_ROUNDOFF * one_norm(way) * one_norm(normal);
    const vbool at_once = fabs(wide_near(distance) * meets) <= error * one_norm(normal);
    const vbool ruled = at_once & (fabs(height) + rounding >= length * (radius * (R(1.0) - R(0x1p-19)) - error));
    const vbool reached = ((height > splat(0)) & (meets < splat(0))) | ((height < splat(0)) & (meets > splat(0)));
    const vbool ahead = held & wide_above_0(distance);
    *t = choose_refined(wide_above_0(distance), wide_refined(distance), splat_refined(0));
    *enters = meets < splat(0);
    return (vbool_not(ruled) & ahead) | (ruled & reached & (ahead | holds_foot(ray, triangle, unit)));
}
#endif

/* From the triangle's vertices, not along the ray: off the plane only by rounding, whatever the ray's length. */
FORCE_INLINE static void triangle_surface(const Ray *ray, const Triangle *triangle, WITH_SHARES(Shares *shares) Point *point,
                                          Vec3 *normal) {
    const Shear shear = shear_of(ray);
    const Triangle turned = turn_triangle(&shear, triangle);
    const Edges edges = edges_of(&shear, &turned);
    Wide sum;
    edges_hold(&edges, &sum);
    const vbool flat = vbool_not(wide_below_0(sum) | wide_above_0(sum)); /* not met */
    const Wide whole = wide_choose(flat, wide(splat(1)), sum);
    /* An edge that the rules above moved would have a share below 0. Wide, since a share of more than 1 in all lies outside. */
    const Wide b = wide_divide(edges.b, whole), c = wide_divide(edges.c, whole), nothing = wide(splat(0));
    const Wide some_b = wide_choose(wide_below_0(b), nothing, b), some_c = wide_choose(wide_below_0(c), nothing, c);
    const Wide both = wide_add(some_b, some_c), one = wide(splat(1));
    const Wide over = wide_choose(wide_above_0(wide_add_real(both, splat(-1))), both, one);
    const Wide of_b = wide_divide(some_b, over), of_c = wide_divide(some_c, over);
    const WideVec to_b = wide_from(triangle->a, triangle->b), to_c = wide_from(triangle->a, triangle->c);
    wide_split(wide_add_real(wide_madd(of_b, to_b.x, wide_multiply(of_c, to_c.x)), triangle->a.x), &point->high.x, &point->low.x);
    wide_split(wide_add_real(wide_madd(of_b, to_b.y, wide_multiply(of_c, to_c.y)), triangle->a.y), &point->high.y, &point->low.y);
    wide_split(wide_add_real(wide_madd(of_b, to_b.z, wide_multiply(of_c, to_c.z)), triangle->a.z), &point->high.z, &point->low.z);
    const vreal size = fabs(point->high.x) + fabs(point->high.y) + fabs(point->high.z);
    point->error = fma(one_norm(to_b) + one_norm(to_c), splat(WIDE_POINT_ERROR), size * R(0x1p-45));
    *normal = wide_unit(wide_cross(to_b, to_c));
#if SHARES_KNOWN
    shares->b = wide_near(of_b);
    shares->c = wide_near(of_c);
#endif
#if MAPPED_TRIANGLES
    shares->of_b = of_b;
    shares->of_c = of_c;
#endif
}

#if MAPPED_TRIANGLES
/* A number between those at the vertices, as a whole one and a rest from 0 to 1. Wide, since a triangle may span so many whole
 * numbers that a real beside them holds no rest. */
static void triangle_between(const Shares *shares, vreal a, vreal b, vreal c, vreal *whole, vreal *rest) {
    const Wide by_b = wide_difference(b, a, splat(0)), by_c = wide_difference(c, a, splat(0));
    const Wide number = wide_madd(shares->of_b, by_b, wide_madd(shares->of_c, by_c, wide(a)));
    const vreal nearest = floor(wide_near(number)), above = wide_near(wide_add_real(number, -nearest));
    const vbool rounded_up = above < splat(0);
    *whole = choose(rounded_up, nearest - splat(1), nearest);
    *rest = choose(rounded_up, above + splat(1), above);
}
#endif

#if EFFECT_TRIANGLE_LAMPS
#undef TRIANGLE_FLAT
#undef TRIANGLE_BESIDE
#undef TRIANGLE_SEEN_MIN
#define TRIANGLE_FLAT R(0x1p-16)   /* the sine below which a triangle is seen from its edge */
#define TRIANGLE_BESIDE R(0x1p-16) /* below it nothing is left of the sum, so the point lies at an edge */
#define TRIANGLE_SEEN_MIN R(0x1p-100)
/* A triangle seen from a point: `a`, `b` and `c`, unit vectors to its vertices; `height`, |a.(b x c)|; `turn`, a.c + b.c; `base`,
 * 1 + a.b; `sum`, of both, which may be far less than either. The tangent of half its solid angle is height / sum
 * (A. van Oosterom and J. Strackee, "The Solid Angle of a Plane Triangle", 1983). */
typedef struct TriangleView {
    Vec3 a, b, c;
    vreal height, turn, base, sum;
} TriangleView;

static WideVec way_from(const Point *point, Vec3 to) {
    WideVec way;
    way.x = wide_difference(to.x, point->high.x, point->low.x);
    way.y = wide_difference(to.y, point->high.y, point->low.y);
    way.z = wide_difference(to.z, point->high.z, point->low.z);
    return way;
}

/* False where rays are not sent to the triangle: the point lies in its plane or on it, as far as can be told, or beside an edge,
 * or sees too little of it for a real. The volume is that of the edges, so nothing cancels however small the triangle. */
static vbool triangle_view(const Point *point, const Triangle *triangle, TriangleView *view) {
    const WideVec a = way_from(point, triangle->a), b = way_from(point, triangle->b), c = way_from(point, triangle->c);
    const WideVec normal = wide_cross(wide_from(triangle->a, triangle->b), wide_from(triangle->a, triangle->c));
    const Wide volume = wide_dot(a, normal);
    const Wide to_a = wide_root(wide_dot(a, a)), to_b = wide_root(wide_dot(b, b)), to_c = wide_root(wide_dot(c, c));
    const Wide inverse = wide_divide(wide(splat(1)), wide_multiply(to_a, wide_multiply(to_b, to_c)));
    const Wide ab = wide_multiply(wide_multiply(wide_dot(a, b), to_c), inverse);
    const Wide around = wide_madd(wide_dot(a, c), to_b, wide_multiply(wide_dot(b, c), to_a));
    view->a = scale3(divide(splat(1), wide_near(to_a)), vec3(wide_near(a.x), wide_near(a.y), wide_near(a.z)));
    view->b = scale3(divide(splat(1), wide_near(to_b)), vec3(wide_near(b.x), wide_near(b.y), wide_near(b.z)));
    view->c = scale3(divide(splat(1), wide_near(to_c)), vec3(wide_near(c.x), wide_near(c.y), wide_near(c.z)));
    view->height = fabs(wide_near(wide_multiply(volume, inverse)));
    view->turn = wide_near(wide_multiply(around, inverse));
    view->base = wide_near(wide_add_real(ab, splat(1)));
    const vreal off = fma(wide_near(to_a), splat(TRIANGLE_FLAT), R(4.0) * point->error);
    view->sum = wide_near(wide_add_real(wide_add(ab, wide_multiply(around, inverse)), splat(1)));
    const vbool aslant = fabs(wide_near(volume)) > off * one_norm(normal), seen = view->height > splat(TRIANGLE_SEEN_MIN);
    const vbool apart = fma(view->height, view->height, view->sum * view->sum) > splat(TRIANGLE_BESIDE * TRIANGLE_BESIDE);
    return aslant & seen & apart;
}
#endif
#endif
