/* vector.cl: points, directions and colours in lane code, structure of arrays.
 *
 * Knows: lanes.cl.   Does not know: what the vectors mean. Read once for each number of lanes. */
#define Vec3 LANED(Vec3)
#define vec3 LANED(vec3)
#define splat3 LANED(splat3)
#define zero3 LANED(zero3)
#define add3 LANED(add3)
#define subtract3 LANED(subtract3)
#define multiply3 LANED(multiply3)
#define scale3 LANED(scale3)
#define madd3 LANED(madd3)
#define dot3 LANED(dot3)
#define loose_madd3 LANED(loose_madd3)
#define loose_dot3 LANED(loose_dot3)
#define choose3 LANED(choose3)
#define normalise3 LANED(normalise3)
#define at_least LANED(at_least)
#define at_most LANED(at_most)
#define larger LANED(larger)
#define smaller LANED(smaller)

typedef struct Vec3 {
    vreal x, y, z;
} Vec3;

static Vec3 vec3(vreal x, vreal y, vreal z) {
    Vec3 v;
    v.x = x;
    v.y = y;
    v.z = z;
    return v;
}
static Vec3 splat3(__global const real *v) { return vec3(splat(v[0]), splat(v[1]), splat(v[2])); }
static Vec3 zero3(void) { return vec3(splat(0), splat(0), splat(0)); }
static Vec3 add3(Vec3 a, Vec3 b) { return vec3(a.x + b.x, a.y + b.y, a.z + b.z); }
static Vec3 subtract3(Vec3 a, Vec3 b) { return vec3(a.x - b.x, a.y - b.y, a.z - b.z); }
static Vec3 multiply3(Vec3 a, Vec3 b) { return vec3(a.x * b.x, a.y * b.y, a.z * b.z); }
static Vec3 scale3(vreal s, Vec3 a) { return vec3(s * a.x, s * a.y, s * a.z); }
/* s * a + b */
static Vec3 madd3(vreal s, Vec3 a, Vec3 b) { return vec3(fma(s, a.x, b.x), fma(s, a.y, b.y), fma(s, a.z, b.z)); }
static vreal dot3(Vec3 a, Vec3 b) { return fma(a.x, b.x, fma(a.y, b.y, a.z * b.z)); }
/* The same by loose_fma (fused.cl). */
static Vec3 loose_madd3(vreal s, Vec3 a, Vec3 b) {
    return vec3(loose_fma(s, a.x, b.x), loose_fma(s, a.y, b.y), loose_fma(s, a.z, b.z));
}
static vreal loose_dot3(Vec3 a, Vec3 b) { return loose_fma(a.x, b.x, loose_fma(a.y, b.y, a.z * b.z)); }
static Vec3 choose3(vbool mask, Vec3 a, Vec3 b) {
    return vec3(choose(mask, a.x, b.x), choose(mask, a.y, b.y), choose(mask, a.z, b.z));
}
/* Of unit length to within 4 ROUNDOFF. `a` must not be zero. */
static Vec3 normalise3(Vec3 a) { return scale3(divide(splat(1), square_root(dot3(a, a))), a); }
/* Ternaries rather than fmax: a NaN in `a` passes through and is found, and it is faster. */
static vreal at_least(vreal a, vreal floor_value) { return choose(a < floor_value, floor_value, a); }
static vreal at_most(vreal a, vreal ceiling) { return choose(a > ceiling, ceiling, a); }
static vreal larger(vreal a, vreal b) { return choose(a > b, a, b); }
static vreal smaller(vreal a, vreal b) { return choose(a < b, a, b); }
