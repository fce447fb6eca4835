/* wide.cl: numbers of more than twenty-four bits, and vectors of them, for decisions about triangles and capsules.
 *
 * Out:   Wide: a double where intersections are refined in double, else the unevaluated sum of two reals, which is right to
 *        about 2^-45 of itself; WIDE_ROUNDOFF, in which heights over a plane are taken for 0; WIDE_POINT_ERROR, of a
 *        triangle's edges, which bounds how far a point is off its plane.
 * Knows: lanes.cl, vector.cl.   Does not know: which shapes are decided by it. Read once for each number of lanes.
 *
 * wide_area, x1 y2 - y1 x2, has the sign of the exact value and is exactly negated when its two points change places: the
 * products' errors are kept (M. Cornea, J. Harrison and P. Tang, "Scientific Computing on Itanium-based Systems", 2002;
 * C.-P. Jeannerod, "A radix-independent error analysis of the Cornea-Harrison-Tang method", 2016). Of pairs a value
 * below what their rounding may be is 0, so both sides of an edge have it. */
#if EFFECT_TRIANGLES || EFFECT_CAPSULES
#define Wide LANED(Wide)
#define WideVec LANED(WideVec)
#define wide LANED(wide)
#define wide_difference LANED(wide_difference)
#define wide_add LANED(wide_add)
#define wide_add_real LANED(wide_add_real)
#define wide_multiply LANED(wide_multiply)
#define wide_madd LANED(wide_madd)
#define wide_divide LANED(wide_divide)
#define wide_root LANED(wide_root)
#define wide_area LANED(wide_area)
#define wide_above_0 LANED(wide_above_0)
#define wide_below_0 LANED(wide_below_0)
#define wide_near LANED(wide_near)
#define wide_refined LANED(wide_refined)
#define wide_split LANED(wide_split)
#define wide_unit LANED(wide_unit)
#define wide_from LANED(wide_from)
#define wide_cross LANED(wide_cross)
#define wide_dot LANED(wide_dot)
#define wide_choose LANED(wide_choose)
#define one_norm LANED(one_norm)
#define wide_negative LANED(wide_negative)
#define wide_madd3 LANED(wide_madd3)
#define pair_sum LANED(pair_sum)
#define pair_quick_sum LANED(pair_quick_sum)

#if REFINE_IS_DOUBLE
#undef WIDE_ROUNDOFF
#undef WIDE_POINT_ERROR
#define WIDE_ROUNDOFF R(0x1p-46)
#define WIDE_POINT_ERROR R(0x1p-45)
typedef vrefined Wide;

static Wide wide(vreal x) { return to_refined(x); }
/* a - (high + low) */
static Wide wide_difference(vreal a, vreal high, vreal low) { return to_refined(a) - (to_refined(high) + to_refined(low)); }
static Wide wide_add(Wide a, Wide b) { return a + b; }
static Wide wide_add_real(Wide a, vreal b) { return a + to_refined(b); }
static Wide wide_multiply(Wide a, Wide b) { return a * b; }
static Wide wide_madd(Wide a, Wide b, Wide c) { return fma(a, b, c); }
static Wide wide_divide(Wide a, Wide b) { return divide_refined(a, b); }
#if EFFECT_TRIANGLE_LAMPS || EFFECT_CAPSULES
static Wide wide_root(Wide a) { return square_root_refined(a); }
#endif
FORCE_INLINE static Wide wide_area(Wide x1, Wide y1, Wide x2, Wide y2) {
    const Wide p = x1 * y2, q = y1 * x2;
    return (p - q) + (fma(x1, y2, -p) - fma(y1, x2, -q));
}
#if EFFECT_CAPSULES
static Wide wide_negative(Wide a) { return -a; }
#endif
static vbool wide_above_0(Wide a) { return vbool_of_refined(a > splat_refined(0)); }
static vbool wide_below_0(Wide a) { return vbool_of_refined(a < splat_refined(0)); }
static vreal wide_near(Wide a) { return to_real(a); }
static vrefined wide_refined(Wide a) { return a; }
static Wide wide_choose(vbool mask, Wide a, Wide b) { return choose_refined(mask, a, b); }
static void wide_split(Wide a, vreal *high, vreal *low) {
    *high = to_real(a);
    *low = to_real(a - to_refined(*high));
}
#else
#undef WIDE_ROUNDOFF
#undef WIDE_POINT_ERROR
#define WIDE_ROUNDOFF R(0x1p-40)
#define WIDE_POINT_ERROR R(0x1p-42)
#define WIDE_NOTHING R(0x1p-42)
typedef struct Wide {
    vreal high, low;
} Wide;

/* a + b exactly (D. Knuth, The Art of Computer Programming 2, 4.2.2); the quick one where |a| >= |b| or a is 0. */
static Wide pair_sum(vreal a, vreal b) {
    Wide sum;
    sum.high = a + b;
    const vreal of_b = sum.high - a;
    sum.low = (a - (sum.high - of_b)) + (b - of_b);
    return sum;
}
static Wide pair_quick_sum(vreal a, vreal b) {
    Wide sum;
    sum.high = a + b;
    sum.low = b - (sum.high - a);
    return sum;
}

static Wide wide(vreal x) {
    Wide a;
    a.high = x;
    a.low = splat(0);
    return a;
}
static Wide wide_add(Wide a, Wide b) {
    const Wide high = pair_sum(a.high, b.high), low = pair_sum(a.low, b.low);
    const Wide sum = pair_quick_sum(high.high, high.low + low.high);
    return pair_quick_sum(sum.high, sum.low + low.low);
}
static Wide wide_add_real(Wide a, vreal b) { return wide_add(a, wide(b)); }
static Wide wide_difference(vreal a, vreal high, vreal low) { return wide_add(pair_sum(a, -high), wide(-low)); }
static Wide wide_multiply(Wide a, Wide b) {
    const vreal product = a.high * b.high;
    return pair_quick_sum(product, fma(a.high, b.low, fma(a.low, b.high, fma(a.high, b.high, -product))));
}
static Wide wide_madd(Wide a, Wide b, Wide c) { return wide_add(wide_multiply(a, b), c); }
static Wide wide_divide(Wide a, Wide b) {
    const Wide quotient = wide(divide(a.high, b.high));
    Wide product = wide_multiply(quotient, b);
    product.high = -product.high;
    product.low = -product.low;
    return pair_quick_sum(quotient.high, divide(wide_add(a, product).high, b.high));
}
#if EFFECT_TRIANGLE_LAMPS || EFFECT_CAPSULES
/* One step of Newton's method. */
static Wide wide_root(Wide a) {
    const Wide root = wide(square_root(a.high));
    Wide square = wide_multiply(root, root);
    square.high = -square.high;
    square.low = -square.low;
    const vbool some = root.high > splat(0);
    return pair_quick_sum(root.high, divide(wide_add(a, square).high, choose(some, R(2.0) * root.high, splat(1))));
}
#endif
FORCE_INLINE static Wide wide_area(Wide x1, Wide y1, Wide x2, Wide y2) {
    const Wide p = wide_multiply(x1, y2);
    Wide q = wide_multiply(y1, x2);
    const vreal nothing = WIDE_NOTHING * (fabs(p.high) + fabs(q.high));
    q.high = -q.high;
    q.low = -q.low;
    Wide area = wide_add(p, q);
    const vbool some = fabs(area.high) > nothing;
    area.high = choose(some, area.high, splat(0));
    area.low = choose(some, area.low, splat(0));
    return area;
}
#if EFFECT_CAPSULES
static Wide wide_negative(Wide a) {
    a.high = -a.high;
    a.low = -a.low;
    return a;
}
#endif
static vbool wide_above_0(Wide a) { return a.high > splat(0); }
static vbool wide_below_0(Wide a) { return a.high < splat(0); }
static vreal wide_near(Wide a) { return a.high; }
static vrefined wide_refined(Wide a) { return a.high; }
static Wide wide_choose(vbool mask, Wide a, Wide b) {
    Wide chosen;
    chosen.high = choose(mask, a.high, b.high);
    chosen.low = choose(mask, a.low, b.low);
    return chosen;
}
static void wide_split(Wide a, vreal *high, vreal *low) {
    *high = a.high;
    *low = a.low;
}
#endif

typedef struct WideVec {
    Wide x, y, z;
} WideVec;

static WideVec wide_from(Vec3 from, Vec3 to) {
    WideVec way;
    way.x = wide_difference(to.x, from.x, splat(0));
    way.y = wide_difference(to.y, from.y, splat(0));
    way.z = wide_difference(to.z, from.z, splat(0));
    return way;
}

static WideVec wide_cross(WideVec a, WideVec b) {
    WideVec n;
    n.x = wide_area(a.y, a.z, b.y, b.z);
    n.y = wide_area(a.z, a.x, b.z, b.x);
    n.z = wide_area(a.x, a.y, b.x, b.y);
    return n;
}

static Wide wide_dot(WideVec a, WideVec b) {
    return wide_madd(a.x, b.x, wide_madd(a.y, b.y, wide_multiply(a.z, b.z)));
}

#if EFFECT_CAPSULES
/* s a + b */
static WideVec wide_madd3(Wide s, WideVec a, WideVec b) {
    WideVec sum;
    sum.x = wide_madd(s, a.x, b.x);
    sum.y = wide_madd(s, a.y, b.y);
    sum.z = wide_madd(s, a.z, b.z);
    return sum;
}
#endif

/* |x| + |y| + |z|, at least the length. */
static vreal one_norm(WideVec a) { return fabs(wide_near(a.x)) + fabs(wide_near(a.y)) + fabs(wide_near(a.z)); }

/* Its direction, to within 4 ROUNDOFF of length 1: first without its size, whose square a real may not hold. */
static Vec3 wide_unit(WideVec a) {
    const vreal size = one_norm(a);
    const vbool none = vbool_not(size > splat(0));
    const vreal whole = choose(none, splat(1), size);
    const Vec3 part = vec3(divide(wide_near(a.x), whole), divide(wide_near(a.y), whole), divide(wide_near(a.z), whole));
    const Vec3 unit = normalise3(choose3(none, vec3(splat(0), splat(0), splat(1)), part));
    const vreal excess = fma(unit.x, unit.x, fma(unit.y, unit.y, fma(unit.z, unit.z, splat(-1))));
    return scale3(fma(excess, splat(R(-0.5)), splat(1)), unit);
}
#endif
