/* triangle_lamps.cl: triangles that emit, as a point sees them: the solid angle, and a direction to one.
 *
 * In:    a point, a triangle, random numbers.   Out: what stands for its cone in lamps.cl; a direction.
 * Knows: lamps.cl, the interface of shape/.   Does not know: how a lamp is chosen, shadows.
 *
 * Directions are uniform in the solid angle (C. Peters, "BRDF Importance Sampling for Polygonal Lights", 2021, section 5), which
 * is cut from vertex b: first the triangle a, b, x is given its share of the solid angle, with x between a and c, then a place
 * between b and x. Everything is written with differences of unit vectors, so small triangles keep their shape. */
#if SAMPLES_TRIANGLES
#define TRIANGLE_DIVISOR_MIN R(0x1p-60)

/* The solid angle over 2 pi. */
static vreal triangle_cap(const TriangleView *view) {
    const vreal turn = turn_of(view->sum, view->height);
    return turn + turn;
}

/* Gives the cone of the lanes whose lamp is a triangle what that fills. */
static void see_triangle(const Scene *scene, const Point *point, vuint slot, vbool asked, LampCone *cone) {
    const vbool flat = asked & is_triangle(&scene->geometry, slot);
    if (!any_lane(flat)) return;
    const Triangle triangle = load_triangle_if(&scene->geometry, flat, slot);
    const vbool seen = triangle_view(point, &triangle, &cone->view);
    cone->cap = choose(flat, triangle_cap(&cone->view), cone->cap);
    cone->outside = (flat & seen) | (vbool_not(flat) & cone->outside);
}

/* A unit direction, uniform in the triangle for u and v uniform in [0, 1). */
static Vec3 sample_triangle(const LampCone *cone, vreal u, vreal v) {
    const TriangleView *view = &cone->view;
    vreal sine, cosine;
    sin_cos_turn(R(0.5) * u * cone->cap, &sine, &cosine);
    /* The middle between a and x lies along (1 - share) a + share c. */
    const vreal of_c = view->base * sine, of_a = fma(view->height, cosine, -(view->turn * sine)), all = of_a + of_c;
    const vbool some = all > splat(0);
    const vreal inverse = divide(splat(1), choose(some, all, splat(1)));
    const vreal share = at_most(choose(some, of_c * inverse, splat(R(0.5))), splat(R(0.5)));
    const vreal more_of_a = at_least(choose(some, (of_a - of_c) * inverse, splat(0)), splat(0));
    const Vec3 beside_b = add3(view->a, view->b);
    /* From a to x by small steps; where a and c are far apart, by the sum of both, which may be short. */
    const Vec3 side = subtract3(view->c, view->a), sum = add3(view->c, view->a);
    const vreal side2 = dot3(side, side);
    const vreal middle2 = at_least(fma(-side2 * share, splat(1) - share, splat(1)), splat(R(0.25)));
    const Vec3 way = madd3(fma(-share * side2, splat(R(0.5)), splat(1)), side, scale3(side2 * (R(0.5) - share), view->a));
    const Vec3 step = scale3(divide(share + share, middle2), way);
    const Vec3 middle = madd3(more_of_a, view->a, scale3(share, sum));
    const vreal length2 = at_least(dot3(middle, middle), splat(TRIANGLE_DIVISOR_MIN));
    const Vec3 mirrored = scale3(divide(R(2.0) * dot3(view->a, middle), length2), middle);
    const vbool opposite = side2 > splat(2);
    const Vec3 from_b = choose3(opposite, subtract3(mirrored, beside_b), add3(subtract3(view->a, view->b), step));
    const Vec3 from_behind_b = choose3(opposite, subtract3(mirrored, subtract3(view->a, view->b)), add3(beside_b, step));
    /* 1 - cos and 1 + cos of the angle from b to x, each from the shorter of the two ways to x. */
    const vreal near = R(0.5) * dot3(from_b, from_b), far = R(0.5) * dot3(from_behind_b, from_behind_b);
    const vbool behind = near > splat(1);
    const vreal cap = choose(behind, splat(2) - far, near), rest = at_least(choose(behind, far, splat(2) - near), splat(TRIANGLE_DIVISOR_MIN));
    const vreal part = v * cap, along = square_root(v * divide(splat(2) - part, rest));
    return normalise3(madd3(splat(1) - part + along * choose(behind, -far, near), view->b,
                            scale3(along, choose3(behind, from_behind_b, from_b))));
}

/* How far along its ray the triangle in a slot is. A direction that rounding has put past an edge stands for one that meets it, in
 * front of whatever shares the edge. */
static vrefined distance_to_triangle(const Geometry *geometry, const Ray *ray, vuint slot, vbool flat) {
    const Triangle triangle = load_triangle_if(geometry, flat, slot);
    const Shear shear = shear_at_triangles(geometry, ray);
    Hit hit = no_hit(REAL_LARGE);
    intersect_triangle(geometry, ray, &shear, flat, &triangle, slot, &hit);
    const Vec3 a = subtract3(triangle.a, ray->origin.high), b = subtract3(triangle.b, ray->origin.high),
               c = subtract3(triangle.c, ray->origin.high);
    const vreal nearest = square_root(smaller(dot3(a, a), smaller(dot3(b, b), dot3(c, c))));
    return choose_refined(is_hit(&hit), hit.t, to_refined(nearest * (R(1.0) - R(0x1p-18))));
}
#endif
