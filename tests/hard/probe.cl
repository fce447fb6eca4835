/* probe.cl: kernels that hand arrays to the product's own functions; appended to a program of one lane.
 *
 * In:    numbers that the host made.   Out: what the functions say, unchanged, in refined precision.
 * `count` items; the host rounds the number of work-items up. Layouts are those of lab.h. */
#define PROBE_ITEM                                                                                                     \
    const uint item = (uint)get_global_id(0);                                                                          \
    if (item >= count) return;

/* Of a geometry of spheres alone, in a program that knows triangles, and perhaps normals and coordinates at their vertices. */
#if SMOOTH_TRIANGLES && MAPPED_TRIANGLES
#define NO_TRIANGLES(leaf_count) 0, 0, 0, leaf_count, 0, 0,
#elif SHARES_KNOWN
#define NO_TRIANGLES(leaf_count) 0, 0, leaf_count, 0,
#elif EFFECT_TRIANGLES
#define NO_TRIANGLES(leaf_count) 0, leaf_count,
#else
#define NO_TRIANGLES(leaf_count)
#endif

/* Nor are there axes. Only programs for scenes know capsules, and these do not run the kernels that have leaves of their own. */
#if EFFECT_CAPSULES
#define NO_CAPSULES 0,
#else
#define NO_CAPSULES
#endif

enum { PROBE_RAY_REALS = 10, PROBE_HIT_REALS = 8, PROBE_POINT_REALS = 10 };

/* `own`: 0 for a ray from free space, 1 for one that leaves the sphere of `slot` outward, 2 inward. */
static Ray probe_ray(__global const real *in, uint own, uint slot) {
    Ray ray;
    ray.origin.high = vec3(in[0], in[1], in[2]);
    ray.origin.low = vec3(in[3], in[4], in[5]);
    ray.origin.error = in[9];
    ray.direction = vec3(in[6], in[7], in[8]);
    ray.cull_margin = cull_margin_of(&ray.origin);
    ray.own_slot = own != 0 ? slot : NO_SLOT;
    ray.inward = own == 2;
#if EFFECT_OPACITY
    ray.passes = 0;
#endif
    return ray;
}

/* Each ray against a leaf of its own, whose sphere `item % TREE_WIDTH` is the one that counts. `boxes` is an empty
 * root. Out: t, hit, enters, and the roots without filter or choice: near, far, meets, middle; slot. */
__kernel void probe_leaf(uint count, __global const real *rays, __global const uint *own, __global const real *leaves,
                         __global const real *boxes, __global const uint *children, __global const uint *slot_sphere,
                         __global refined *out) {
    PROBE_ITEM
    __global const real *leaf = leaves + (size_t)item * 4 * TREE_WIDTH;
    const uint lane = item % TREE_WIDTH;
    Geometry geometry;
    geometry_init(boxes, children, leaf, leaf, slot_sphere, NO_CAPSULES NO_TRIANGLES(1) 1, 1, &geometry);
    const Ray ray = probe_ray(rays + (size_t)item * PROBE_RAY_REALS, own[item], lane);
    const Hit hit = intersect_closest(&geometry, &ray, 1);
    __global refined *row = out + (size_t)item * PROBE_HIT_REALS;
    row[0] = hit.t;
    row[1] = hit.slot != NO_SLOT;
    row[2] = hit.enters;
#ifdef Roots /* sphere_robust.cl alone has them */
    const Sphere sphere = load_sphere(&geometry, lane);
    const Roots roots = sphere_roots(&ray, &sphere);
    row[3] = roots.near;
    row[4] = roots.far;
    row[5] = roots.meets != 0;
    row[6] = roots.middle;
#else
    row[3] = row[4] = row[5] = row[6] = 0;
#endif
    row[7] = hit.slot == NO_SLOT ? -1 : (refined)hit.slot;
}

/* The point where a ray of probe_leaf met its sphere (hits: probe_leaf's rows). Out: high, low, error, normal. */
__kernel void probe_point(uint count, __global const real *rays, __global const real *spheres,
                          __global const refined *hits, __global refined *out) {
    PROBE_ITEM
    const Ray ray = probe_ray(rays + (size_t)item * PROBE_RAY_REALS, 0, 0);
    __global const real *numbers = spheres + (size_t)item * 4;
    __global const refined *hit = hits + (size_t)item * PROBE_HIT_REALS;
    Sphere sphere;
    sphere.centre = vec3(numbers[0], numbers[1], numbers[2]);
    sphere.radius = numbers[3];
    Point point;
    Vec3 normal;
    sphere_surface(&ray, &sphere, 0, hit[0], hit[2] != 0, &point, &normal);
    __global refined *row = out + (size_t)item * PROBE_POINT_REALS;
    row[0] = point.high.x;
    row[1] = point.high.y;
    row[2] = point.high.z;
    row[3] = point.low.x;
    row[4] = point.low.y;
    row[5] = point.low.z;
    row[6] = point.error;
    row[7] = normal.x;
    row[8] = normal.y;
    row[9] = normal.z;
}

/* One sample of a BSDF. In: incoming, normal, index, fuzz, albedo. choices: enters, kind, lobe, variant, total_reflection,
 * sample. Out: direction, scattered, transmitted, the random direction and ball radius that the sample has. */
__kernel void probe_scatter(uint count, __global const real *in, __global const uint *choices, uint seed,
                            __global refined *out) {
    PROBE_ITEM
    __global const real *numbers = in + (size_t)item * 8;
    __global const uint *words = choices + (size_t)item * 6;
    Surface surface;
    surface.incoming = vec3(numbers[0], numbers[1], numbers[2]);
    surface.normal = vec3(numbers[3], numbers[4], numbers[5]);
    surface.refraction_index = numbers[6];
    surface.fuzz = numbers[7];
    surface.albedo = vec3(1, 1, 1);
    surface.enters = words[0] != 0;
    surface.kind = words[1];
    surface.lobe = words[2];
    surface.variant = words[3];
    surface.total_reflection = words[4];
    const SampleKey key = sample_key(seed, 0, 0, words[5], 4);
    const BsdfSample sample = scatter(&surface, key, DIMENSION_BOUNCE);
    const Vec3 offset = random_direction(key, DIMENSION_BOUNCE);
    __global refined *row = out + (size_t)item * 8;
    row[0] = sample.direction.x;
    row[1] = sample.direction.y;
    row[2] = sample.direction.z;
    row[3] = sample.scattered != 0;
    row[4] = sample.transmitted != 0;
    row[5] = offset.x;
    row[6] = offset.y;
    row[7] = offset.z;
}

/* In: cosine, index. Out: exact reflectance, Schlick's. */
__kernel void probe_fresnel(uint count, __global const real *in, __global refined *out) {
    PROBE_ITEM
    const real c = in[2 * item], n = in[2 * item + 1], ratio = R(1.0) / n;
    const real transmitted2 = fma(-ratio * ratio, (R(1.0) - c) * (R(1.0) + c), R(1.0));
    out[2 * item] = transmitted2 < 0 ? R(1.0) : fresnel_exact(c, n, sqrt(transmitted2));
    out[2 * item + 1] = fresnel_schlick(c, ratio);
}

/* In: u, v. Out: sine and cosine of v turns, the disk's x, y, the sphere's x, y, z, the ball's radius. */
__kernel void probe_maps(uint count, __global const real *in, __global refined *out) {
    PROBE_ITEM
    const real u = in[2 * item], v = in[2 * item + 1];
    real sine, cosine, x, y;
    sin_cos_turn(v, &sine, &cosine);
    sample_disk(u, v, &x, &y);
    const Vec3 sphere = sample_sphere(u, v);
    __global refined *row = out + (size_t)item * 8;
    row[0] = sine;
    row[1] = cosine;
    row[2] = x;
    row[3] = y;
    row[4] = sphere.x;
    row[5] = sphere.y;
    row[6] = sphere.z;
    row[7] = sample_ball_radius(u, v, v);
}

/* In: bits. Out: the uniform number made of them; number 0 of pixel `item`, sample 0. */
__kernel void probe_random(uint count, __global const uint *bits, uint seed, __global refined *out) {
    PROBE_ITEM
    out[2 * item] = bits_to_unit(bits[item]);
    out[2 * item + 1] = uniform(sample_key(seed, 0, item, 0, 4), DIMENSION_PIXEL);
}

/* In: column, row. Out: origin, direction. */
__kernel void probe_camera(uint count, __global const PackedCamera *camera, __global const real *in,
                           __global refined *out) {
    PROBE_ITEM
    Vec3 origin, direction;
    camera_ray(camera, 1, sample_key(1, 0, item, 0, 4), in[2 * item], in[2 * item + 1], &origin, &direction);
    __global refined *row = out + (size_t)item * 6;
    row[0] = origin.x;
    row[1] = origin.y;
    row[2] = origin.z;
    row[3] = direction.x;
    row[4] = direction.y;
    row[5] = direction.z;
}

/* In: three numbers. Out: normalise3 of them, their length's square after it. */
__kernel void probe_normalise(uint count, __global const real *in, __global refined *out) {
    PROBE_ITEM
    const Vec3 a = normalise3(vec3(in[3 * item], in[3 * item + 1], in[3 * item + 2]));
    out[3 * item] = a.x;
    out[3 * item + 1] = a.y;
    out[3 * item + 2] = a.z;
}

/* The boxes of node `item` against its ray. Out: the byte of each lane, as one number a lane. */
__kernel void probe_boxes(uint count, __global const real *rays, __global const real *boxes, __global uint *out) {
    PROBE_ITEM
    Geometry geometry;
    geometry_init(boxes, 0, 0, 0, 0, NO_CAPSULES NO_TRIANGLES(0) 0, 0, &geometry);
    const Ray ray = probe_ray(rays + (size_t)item * PROBE_RAY_REALS, 0, 0);
    const BoxRay box = box_ray(&ray);
    vreal_node entry;
    child_mask met = test_node(&geometry, &box, item, REAL_LARGE, &entry);
    for (uint lane = 0; lane < TREE_WIDTH; ++lane) {
        out[(size_t)item * TREE_WIDTH + lane] = 0;
    }
    while (met != 0) {
        const uint lane = lowest_bit(met);
        met = without_lowest_bit(met);
        out[(size_t)item * TREE_WIDTH + lane] = 1;
    }
}

/* The tree against all leaves one by one. Out: t and sphere of both (-1: none), and intersect_any. */
__kernel void probe_tree(uint count, __global const real *rays, __global const real *boxes,
                         __global const uint *children, __global const real *leaves, __global const uint *slot_sphere,
                         uint first_leaves, uint leaf_count, __global refined *out) {
    PROBE_ITEM
    Geometry geometry;
    geometry_init(boxes, children, leaves, leaves, slot_sphere, NO_CAPSULES NO_TRIANGLES(leaf_count) first_leaves, leaf_count, &geometry);
    const Ray ray = probe_ray(rays + (size_t)item * PROBE_RAY_REALS, 0, 0);
    const Hit tree = intersect_closest(&geometry, &ray, 1);
    Hit list = no_hit(REAL_LARGE);
    for (uint slot = 0; slot < leaf_count * TREE_WIDTH; ++slot)
        if (slot_sphere[slot] != NO_SPHERE) {
            const Sphere sphere = load_sphere(&geometry, slot);
            intersect_sphere(&geometry, &ray, 1, &sphere, slot, &list);
        }
    __global refined *row = out + (size_t)item * 5;
    row[0] = tree.t;
    row[1] = tree.slot == NO_SLOT ? -1 : (refined)slot_sphere[tree.slot];
    row[2] = list.t;
    row[3] = list.slot == NO_SLOT ? -1 : (refined)slot_sphere[list.slot];
    row[4] = intersect_any(&geometry, &ray, REAL_LARGE);
}

/* Arithmetic that the compiler must leave alone. In: a, b, zero. Out: see test_sums.c. */
__kernel void probe_arithmetic(uint count, __global const real *in, __global real *out) {
    PROBE_ITEM
    const real a = in[3 * item], b = in[3 * item + 1], zero = in[3 * item + 2];
    const real nan_value = zero / zero;
    __global real *row = out + (size_t)item * 8;
    row[0] = !(nan_value >= 0) && nan_value != nan_value;
    const real sum = a + b;
    row[1] = (a - (sum - (sum - a))) + (b - (sum - a));
    const real product = a * b;
    row[2] = a * b - product;
    row[3] = fma(a, b, -product);
    row[4] = a / b;
    row[5] = sqrt(fabs(a));
    row[6] = R(1.0) / sqrt(fabs(a));
    row[7] = sum;
}

/* Path from given rays, refracted or reflected as the scene's materials say. Out: for each segment the sphere met
 * (-1: none) and its distance; after PROBE_PATH_SEGMENTS of them the last direction, and whether it lives. */
enum { PROBE_PATH_SEGMENTS = 12 };
__kernel void probe_paths(SCENE_PARAMETERS uint count, __global const real *rays, __global refined *out) {
    PROBE_ITEM
    const Scene scene = scene_init(SCENE_ARGUMENTS);
    __global const real *in = rays + (size_t)item * PROBE_RAY_REALS;
    Path path;
    path_none(&path);
#if SAMPLES_LAMPS
    path.lobe.kind = LOBE_NONE;
#endif
    path.origin.high = vec3(in[0], in[1], in[2]);
    path.origin.low = vec3(in[3], in[4], in[5]);
    path.origin.error = in[9];
    path.direction = vec3(in[6], in[7], in[8]);
    path.throughput = vec3(1, 1, 1);
    path.radiance = zero3();
    path.key = sample_key(seed_low, seed_high, item, 0, replicates);
    path.depth = 0;
    path.own_slot = NO_SLOT;
    path.inward = 0;
    path.alive = 1;
    __global refined *row = out + (size_t)item * (2 * PROBE_PATH_SEGMENTS + 4);
    for (uint segment = 0; segment < PROBE_PATH_SEGMENTS; ++segment) {
        const int alive = path.alive;
        if (alive) trace_bounce(&scene, &path);
#if SAMPLES_LAMPS
        path.wants_lamps = vbool_none;
#endif
        row[2 * segment] = alive && path.latest.met ? (refined)slot_sphere[path.own_slot] : -1;
        row[2 * segment + 1] = alive && path.latest.met ? path.latest.distance : 0;
    }
    row[2 * PROBE_PATH_SEGMENTS] = path.direction.x;
    row[2 * PROBE_PATH_SEGMENTS + 1] = path.direction.y;
    row[2 * PROBE_PATH_SEGMENTS + 2] = path.direction.z;
    row[2 * PROBE_PATH_SEGMENTS + 3] = path.alive;
}

/* Rays through a scene, which leave what they meet in a direction of their own. Out: the index of what was met (-1: none),
 * from outside, the distance; the same of what is met then; the point where the ray turns, high and low, its error, and
 * the outward normal there. */
enum { PROBE_TURN_REALS = 16 };
__kernel void probe_turns(SCENE_PARAMETERS uint count, __global const real *rays, __global const real *directions,
                          __global refined *out) {
    PROBE_ITEM
    const Scene scene = scene_init(SCENE_ARGUMENTS);
    __global refined *row = out + (size_t)item * PROBE_TURN_REALS;
    for (uint i = 0; i < PROBE_TURN_REALS; ++i) row[i] = -1;
    Ray ray = probe_ray(rays + (size_t)item * PROBE_RAY_REALS, 0, 0);
#if EFFECT_MOTION
    ray.time = 0;
#endif
    const Hit hit = intersect_closest(&scene.geometry, &ray, 1);
    if (hit.slot == NO_SLOT) return;
    row[0] = (refined)slot_sphere[hit.slot];
    row[1] = hit.enters;
    row[2] = hit.t;
#if EFFECT_TRIANGLES
    Point point;
    Vec3 outward;
    int inward = 0; /* a sphere is left to either side */
#ifdef Roots
    if (!is_triangle(&scene.geometry, hit.slot)) {
        const Sphere sphere = sphere_for_ray(&scene.geometry, &ray, hit.slot);
        sphere_surface(&ray, &sphere, hit.slot, hit.t, hit.enters, &point, &outward);
        inward = dot3(vec3(directions[3 * item], directions[3 * item + 1], directions[3 * item + 2]), outward) < 0;
    }
#endif
#if SHARES_KNOWN
    Shares shares;
#endif
    surface_of_triangle(&scene.geometry, &ray, &hit, 1, WITH_SHARES(&shares) &point, &outward);
    Ray next = ray;
    next.origin = point;
    next.cull_margin = cull_margin_of(&point);
    next.direction = vec3(directions[3 * item], directions[3 * item + 1], directions[3 * item + 2]);
    next.own_slot = hit.slot;
    next.inward = inward;
    const Hit then = intersect_closest(&scene.geometry, &next, 1);
    if (then.slot != NO_SLOT) {
        row[3] = (refined)slot_sphere[then.slot];
        row[4] = then.enters;
        row[5] = then.t;
    }
    row[6] = point.high.x;
    row[7] = point.high.y;
    row[8] = point.high.z;
    row[9] = point.low.x;
    row[10] = point.low.y;
    row[11] = point.low.z;
    row[12] = point.error;
    row[13] = outward.x;
    row[14] = outward.y;
    row[15] = outward.z;
#endif
}

#if EFFECT_CAPSULES
/* Rays, each at one capsule of a scene alone, by its number. Out: the distance, and whether it is met. */
__kernel void probe_capsules(SCENE_PARAMETERS uint count, __global const real *rays, __global const uint *numbers, __global refined *out) {
    PROBE_ITEM
    const Scene scene = scene_init(SCENE_ARGUMENTS);
    const Ray ray = probe_ray(rays + (size_t)item * PROBE_RAY_REALS, 0, 0);
    Hit hit = no_hit(REAL_LARGE);
    for (uint slot = 0; slot < scene.geometry.leaf_count * TREE_WIDTH; ++slot) {
        if (slot_sphere[slot] != numbers[item]) continue;
        const Sphere sphere = sphere_for_ray(&scene.geometry, &ray, slot);
        intersect_sphere(&scene.geometry, &ray, 1, &sphere, slot, &hit);
    }
    out[2 * item] = hit.t;
    out[2 * item + 1] = hit.slot != NO_SLOT;
}
#endif

#if SAMPLES_TRIANGLES
/* A triangle from a point (high, low, and two numbers): whether it is sampled, its solid angle over 2 pi, a direction to it. */
__kernel void probe_solid_angle(uint count, __global const real *points, __global const real *triangles,
                                __global refined *out) {
    PROBE_ITEM
    __global const real *in = points + (size_t)item * 8, *v = triangles + (size_t)item * 9;
    __global refined *row = out + (size_t)item * 5;
    Point point;
    point.high = vec3(in[0], in[1], in[2]);
    point.low = vec3(in[3], in[4], in[5]);
    point.error = 0;
    Triangle triangle;
    triangle.a = vec3(v[0], v[1], v[2]);
    triangle.b = vec3(v[3], v[4], v[5]);
    triangle.c = vec3(v[6], v[7], v[8]);
    LampCone cone;
    row[0] = triangle_view(&point, &triangle, &cone.view) != 0;
    cone.cap = triangle_cap(&cone.view);
    row[1] = cone.cap;
    const Vec3 direction = sample_triangle(&cone, in[6], in[7]);
    row[2] = direction.x;
    row[3] = direction.y;
    row[4] = direction.z;
}
#endif
