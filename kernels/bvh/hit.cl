/* hit.cl: the closest hit so far, and its update by one sphere or triangle.
 *
 * In:    rays, spheres, triangles.   Out: the hit of least (distance, index), where spheres come before triangles, so list
 *        and tree, and any order of visits, agree to the bit.
 * Knows: the interface of shape/, geometry.cl.   Does not know: nodes, what materials do with light that they stop. Read for one lane and for packets. */
#define Hit LANED(Hit)
#define no_hit LANED(no_hit)
#define is_hit LANED(is_hit)
#define upper_bound LANED(upper_bound)
#define keep_closer LANED(keep_closer)
#define load_sphere LANED(load_sphere)
#define centre_at LANED(centre_at)
#define sphere_for_ray LANED(sphere_for_ray)
#define ball_around_origin LANED(ball_around_origin)
#define intersect_sphere LANED(intersect_sphere)
#define intersect_own_sphere LANED(intersect_own_sphere)
#define is_triangle LANED(is_triangle)
#define other_colour LANED(other_colour)
#define load_triangle LANED(load_triangle)
#define load_normals LANED(load_normals)
#define load_triangle_if LANED(load_triangle_if)
#define shear_at_triangles LANED(shear_at_triangles)
#define intersect_triangle LANED(intersect_triangle)
#define is_behind LANED(is_behind)
#define goes_straight LANED(goes_straight)
#define let_through LANED(let_through)
#define enter_together LANED(enter_together)
#define intersect_left_triangle LANED(intersect_left_triangle)
#define intersect_triangle_beside_sphere LANED(intersect_triangle_beside_sphere)
#define surface_of_triangle LANED(surface_of_triangle)

typedef struct Hit {
    vrefined t;
    vuint slot;   /* NO_SLOT: nothing was hit */
    vbool enters; /* from outside to inside */
    vreal bound;  /* not below t: what prunes */
} Hit;

/* t rounded up to a real. */
static vreal upper_bound(vrefined t) { return to_real(t) * (R(1.0) + R(4.0) * ROUNDOFF); }

/* Nothing hit yet, within `limit`. */
static Hit no_hit(refined limit) {
    Hit hit;
    hit.t = splat_refined(limit);
    hit.slot = splat_uint(NO_SLOT);
    hit.enters = vbool_none;
    hit.bound = upper_bound(hit.t);
    return hit;
}

static vbool is_hit(const Hit *hit) { return vbool_of_uint(hit->slot != splat_uint(NO_SLOT)); }

FORCE_INLINE static void keep_closer(const Geometry *geometry, vbool found, vrefined t, vuint slot, vbool enters,
                                     Hit *hit) {
    vbool closer = found & vbool_of_refined(t < hit->t);
    const vbool tie = found & vbool_of_refined(t == hit->t) & is_hit(hit);
    if (any_lane(tie)) {
        /* Only lanes of a tie have two spheres: others may stand for a disc of the sky. */
        const vuint one = choose_uint(tie, slot, splat_uint(0)), other = choose_uint(tie, hit->slot, splat_uint(0));
        closer = closer | (tie & vbool_of_uint(gather_split_uint(geometry->slot_sphere, 0, one) <
                                               gather_split_uint(geometry->slot_sphere, 0, other)));
    }
    hit->t = choose_refined(closer, t, hit->t);
    hit->slot = choose_uint(closer, slot, hit->slot);
    hit->enters = (closer & enters) | (vbool_not(closer) & hit->enters);
    hit->bound = choose(closer, upper_bound(t), hit->bound);
}

#if SPHERES_MET
static Sphere load_sphere(const Geometry *geometry, vuint slot) {
    const vuint lane = slot % TREE_WIDTH;
    const vuint place = (slot - lane) * 4u + lane;
    Sphere sphere;
    sphere.centre = vec3(gather_split_real(geometry->leaves, 0, place),
                         gather_split_real(geometry->leaves, TREE_WIDTH, place),
                         gather_split_real(geometry->leaves, 2 * TREE_WIDTH, place));
    sphere.radius = gather_split_real(geometry->leaves, 3 * TREE_WIDTH, place);
#if EFFECT_CAPSULES
    const vuint axis = (slot - lane) * 6u + lane;
    sphere.axis = vec3(gather_split_real(geometry->leaf_axes, 0, axis), gather_split_real(geometry->leaf_axes, TREE_WIDTH, axis),
                       gather_split_real(geometry->leaf_axes, 2 * TREE_WIDTH, axis));
#endif
    return sphere;
}

#if EFFECT_CAPSULES
/* The colour of a capsule's half by its other end. */
static Vec3 other_colour(const Geometry *geometry, vuint slot) {
    const vuint lane = slot % TREE_WIDTH;
    const vuint place = (slot - lane) * 6u + lane;
    return vec3(gather_split_real(geometry->leaf_axes, 3 * TREE_WIDTH, place),
                gather_split_real(geometry->leaf_axes, 4 * TREE_WIDTH, place),
                gather_split_real(geometry->leaf_axes, 5 * TREE_WIDTH, place));
}
#endif

#if EFFECT_MOTION
/* Where the centre of the sphere in a slot is at a time, from where it is when the shutter opens. */
static Vec3 centre_at(const Geometry *geometry, vuint slot, vreal time, Vec3 first) {
    const vuint lane = slot % TREE_WIDTH;
    const vuint place = (slot - lane) * 3u + lane;
    const Vec3 motion = vec3(gather_split_real(geometry->leaf_motions, 0, place),
                             gather_split_real(geometry->leaf_motions, TREE_WIDTH, place),
                             gather_split_real(geometry->leaf_motions, 2 * TREE_WIDTH, place));
    return madd3(time, motion, first);
}
#endif

/* The sphere in a slot where a ray meets it: one that moves stands where it is at the ray's time, and of a capsule it is the
 * ball on its axis. */
static Sphere sphere_for_ray(const Geometry *geometry, const Ray *ray, vuint slot) {
    Sphere sphere = load_sphere(geometry, slot);
#if EFFECT_MOTION
    sphere.centre = centre_at(geometry, slot, ray->time, sphere.centre);
#endif
#if EFFECT_CAPSULES
    choose_ball(ray, vbool_of_uint(slot == ray->own_slot), &sphere);
#endif
    return sphere;
}

#if MEDIA_IN_CAPSULES
/* The same, and of a capsule the ball on its axis that is closest to where the ray begins. */
static Sphere ball_around_origin(const Geometry *geometry, const Ray *ray, vuint slot) {
    Sphere sphere = load_sphere(geometry, slot);
#if EFFECT_MOTION
    sphere.centre = centre_at(geometry, slot, ray->time, sphere.centre);
#endif
    ball_at_origin(ray, &sphere);
    return sphere;
}
#endif
#endif

#if EFFECT_TRIANGLES
/* Of slots, and of what stands for one: the last ones, from the first that holds triangles. */
static vbool is_triangle(const Geometry *geometry, vuint slot) {
    const uint first = geometry->first_triangles * TREE_WIDTH;
    return vbool_of_uint(slot - first < splat_uint(geometry->leaf_count * TREE_WIDTH - first));
}

static Triangle load_triangle(const Geometry *geometry, vuint slot) {
    const vuint lane = slot % TREE_WIDTH;
    const vuint place = (slot - lane - geometry->first_triangles * TREE_WIDTH) * 9u + lane;
    Triangle triangle;
    triangle.a = vec3(gather_split_real(geometry->triangles, 0, place), gather_split_real(geometry->triangles, TREE_WIDTH, place),
                      gather_split_real(geometry->triangles, 2 * TREE_WIDTH, place));
    triangle.b = vec3(gather_split_real(geometry->triangles, 3 * TREE_WIDTH, place),
                      gather_split_real(geometry->triangles, 4 * TREE_WIDTH, place),
                      gather_split_real(geometry->triangles, 5 * TREE_WIDTH, place));
    triangle.c = vec3(gather_split_real(geometry->triangles, 6 * TREE_WIDTH, place),
                      gather_split_real(geometry->triangles, 7 * TREE_WIDTH, place),
                      gather_split_real(geometry->triangles, 8 * TREE_WIDTH, place));
    return triangle;
}

#if SMOOTH_TRIANGLES
/* The normals at its vertices, in a scene where a triangle is smooth. */
static Triangle load_normals(const Geometry *geometry, vuint slot) {
    const vuint lane = slot % TREE_WIDTH, leaf = slot / TREE_WIDTH - geometry->first_triangles;
    const vuint place = leaf * (9u * TREE_WIDTH) + lane;
    vreal of[9];
    for (uint i = 0; i < 9u; ++i) of[i] = gather_split_real(geometry->triangle_normals, i * TREE_WIDTH, place);
    Triangle normals;
    normals.a = vec3(of[0], of[1], of[2]);
    normals.b = vec3(of[3], of[4], of[5]);
    normals.c = vec3(of[6], of[7], of[8]);
    return normals;
}
#endif

/* The triangle in a slot, in the lanes `wanted`; in others the first. */
static Triangle load_triangle_if(const Geometry *geometry, vbool wanted, vuint slot) {
    return load_triangle(geometry, choose_uint(wanted, slot, splat_uint(geometry->first_triangles * TREE_WIDTH)));
}

/* What triangles need of a ray, once a ray. */
static Shear shear_at_triangles(const Geometry *geometry, const Ray *ray) {
    Shear shear = shear_of(ray);
    const vbool leaves = is_triangle(geometry, ray->own_slot);
    if (any_lane(leaves)) {
        const Triangle left = load_triangle_if(geometry, leaves, ray->own_slot);
        shear.doubt = choose(leaves, doubt_of(ray, &left), shear.doubt);
    }
#if SPHERES_MET && ROBUST_SHAPES
    const vbool leaves_sphere = vbool_of_uint(ray->own_slot != splat_uint(NO_SLOT)) & vbool_not(leaves);
    shear.doubt = choose(leaves_sphere, splat(0), shear.doubt);
#endif
    return shear;
}

#if ROBUST_SHAPES
#if SPHERES_MET
static void intersect_triangle_beside_sphere(const Geometry *geometry, const Ray *ray, const Shear *shear, vbool doubtful,
                                             const Triangle *triangle, vuint slot, Hit *hit) {
    vrefined t;
    vbool enters;
#if EFFECT_CAPSULES
    Sphere left = load_sphere(geometry, choose_uint(doubtful, ray->own_slot, splat_uint(0)));
#if EFFECT_MOTION
    left.centre = centre_at(geometry, choose_uint(doubtful, ray->own_slot, splat_uint(0)), ray->time, left.centre);
#endif
    ball_at_origin(ray, &left);
#else
    const Sphere left = sphere_for_ray(geometry, ray, choose_uint(doubtful, ray->own_slot, splat_uint(0)));
#endif
    const vbool found = triangle_beside_sphere(ray, shear, triangle, left.centre, left.radius, &t, &enters) & doubtful;
    keep_closer(geometry, found, t, slot, enters, hit);
}
#endif

#if PASSES_TRIANGLES
/* The lanes whose rays may go straight through the triangle that they leave, or nearly so. */
static vbool goes_straight(const Geometry *geometry, const Ray *ray, vbool asked) {
    vbool straight = vbool_none;
#if EFFECT_OPACITY
    straight = straight | ray->passes;
#endif
#if MEDIA_IN_TRIANGLES
    straight = straight | vbool_of_uint(splat_uint(geometry->bodies) != splat_uint(0));
#endif
#if GLASS_TRIANGLES
    if (geometry->material_kinds != 0 && any_lane(asked)) {
        const vuint material = gather_split_uint(geometry->slot_material, 0, choose_uint(asked, ray->own_slot, splat_uint(0)));
        straight = straight | vbool_of_uint(gather_uint(geometry->material_kinds, material * MATERIAL_UINTS) == splat_uint(KIND_DIELECTRIC));
    }
#endif
    return asked & straight;
}

/* Where triangles meet in a vertex, each may lie before the next around a saddle, and a ray that goes straight through all of
 * them would go round and round. So of those that it passes the same way, where it stands, it meets only what comes behind the
 * one that it leaves in the order of their numbers. Of those at one distance the first has been met first. */
static vbool is_behind(const Geometry *geometry, const Ray *ray, const Triangle *left, vuint slot, vbool enters, vrefined t, vbool found) {
    const vbool at_once = goes_straight(geometry, ray, found & vbool_not(vbool_of_refined(t > splat_refined(0))));
    if (!any_lane(at_once)) return vbool_all;
    WideVec d;
    d.x = wide(ray->direction.x);
    d.y = wide(ray->direction.y);
    d.z = wide(ray->direction.z);
    const vbool inward = wide_below_0(wide_dot(d, wide_cross(wide_from(left->a, left->b), wide_from(left->a, left->c))));
    const vbool same_way = (inward & enters) | (vbool_not(inward) & vbool_not(enters));
    const vuint own = choose_uint(at_once, ray->own_slot, slot);
    const vbool before = vbool_of_uint(gather_split_uint(geometry->slot_sphere, 0, slot) < gather_split_uint(geometry->slot_sphere, 0, own));
    return vbool_not(at_once & same_way & before);
}
#endif

/* Decides about candidates of which triangle_decide is doubtful. */
static void intersect_left_triangle(const Geometry *geometry, const Ray *ray, const Shear *shear, vbool doubtful,
                                    const Triangle *triangle, vuint slot, Hit *hit) {
    vrefined t;
    vbool enters;
#if SPHERES_MET
    const vbool beside_sphere = doubtful & vbool_not(is_triangle(geometry, ray->own_slot));
    if (any_lane(beside_sphere))
        intersect_triangle_beside_sphere(geometry, ray, shear, beside_sphere, triangle, slot, hit);
    doubtful = doubtful & vbool_not(beside_sphere);
#endif
    const Triangle left = load_triangle_if(geometry, doubtful, ray->own_slot);
    const vbool found = triangle_intersect(ray, shear, triangle, &left, doubtful, &t, &enters) & doubtful;
#if PASSES_TRIANGLES
    keep_closer(geometry, found & is_behind(geometry, ray, &left, slot, enters, t, found), t, slot, enters, hit);
#else
    keep_closer(geometry, found, t, slot, enters, hit);
#endif
}
#endif

/* Decides about a candidate. */
FORCE_INLINE ON_CHAINS static void intersect_triangle(const Geometry *geometry, const Ray *ray, const Shear *shear, vbool active,
                                            const Triangle *triangle, vuint slot, Hit *hit) {
    vrefined t;
    vbool enters, doubtful;
    const Triangle turned = turn_triangle(shear, triangle);
    const vbool found = triangle_decide(shear, &turned, &t, &enters, &doubtful) & active;
    keep_closer(geometry, found & vbool_not(doubtful), t, slot, enters, hit);
#if ROBUST_SHAPES
    doubtful = doubtful & active;
    if (any_lane(doubtful)) intersect_left_triangle(geometry, ray, shear, doubtful, triangle, slot, hit);
#endif
}

/* The point that was met, where it is a triangle's, and the outward unit normal of its plane. */
static void surface_of_triangle(const Geometry *geometry, const Ray *ray, const Hit *hit, vbool met, WITH_SHARES(Shares *shares)
                                Point *point, Vec3 *normal) {
    const vbool wanted = met & is_triangle(geometry, hit->slot);
    if (!any_lane(wanted)) return;
    const Triangle triangle = load_triangle_if(geometry, wanted, hit->slot);
    Point place;
    Vec3 outward;
    triangle_surface(ray, &triangle, WITH_SHARES(shares) &place, &outward);
    point->high = choose3(wanted, place.high, point->high);
    point->low = choose3(wanted, place.low, point->low);
    point->error = choose(wanted, place.error, point->error);
    *normal = choose3(wanted, outward, *normal);
}
#endif

#if EFFECT_OPACITY
/* The share of paths that a surface lets straight on. */
static vreal let_through(const Geometry *geometry, vuint slot) {
    const vuint material = gather_split_uint(geometry->slot_material, 0, slot);
    return splat(1) - gather_real(geometry->materials + MATERIAL_OPACITY, material * MATERIAL_REALS);
}
#endif

#if SPHERES_MET
#if EFFECT_OPACITY
/* Of surfaces that lie in one another and let rays on, one counts: the ray that has passed it into its inside is inside the others
 * too, and meets them as if it had passed them. Otherwise it would pass each of them, where it stands, again and again. */
static void enter_together(const Geometry *geometry, const Ray *ray, const Sphere *sphere, vuint slot, vbool found, vrefined *t,
                           vbool *enters) {
    vbool together = found & *enters & ray->passes;
    if (!any_lane(together)) return;
    Vec3 to_centre;
    const vreal power = sphere_power(&ray->origin, sphere, &to_centre);
    together = together & (power <= splat(2) * sphere->radius * ray->origin.error);
    if (!any_lane(together)) return;
    together = together & (let_through(geometry, choose_uint(together, slot, splat_uint(0))) > splat(0));
    Ray leaving = *ray;
    leaving.own_slot = choose_uint(together, slot, ray->own_slot);
    const Sphere left = sphere_for_ray(geometry, &leaving, slot);
    vrefined end;
    together = together & sphere_exit(&leaving, &left, &end);
    *t = choose_refined(together, end, *t);
    *enters = *enters & vbool_not(together);
}
#endif

/* Decides about a candidate. */
FORCE_INLINE static void intersect_sphere(const Geometry *geometry, const Ray *ray, vbool active, const Sphere *sphere,
                                          vuint slot, Hit *hit) {
    vrefined t;
    vbool enters;
    const vbool found = sphere_intersect(ray, sphere, &t, &enters) & active;
#if EFFECT_OPACITY
    enter_together(geometry, ray, sphere, slot, found, &t, &enters);
#endif
    keep_closer(geometry, found, t, slot, enters, hit);
}

/* The sphere being left, met again from inside. */
FORCE_INLINE static void intersect_own_sphere(const Geometry *geometry, const Ray *ray, vbool active, Hit *hit) {
#if EFFECT_TRIANGLES
    const vbool inward = active & ray->inward & vbool_not(is_triangle(geometry, ray->own_slot));
#else
    const vbool inward = active & ray->inward;
#endif
    if (!any_lane(inward)) return;
    const vuint slot = choose_uint(inward, ray->own_slot, splat_uint(0));
    const Sphere sphere = sphere_for_ray(geometry, ray, slot);
    vrefined t;
    const vbool found = sphere_exit(ray, &sphere, &t) & inward;
    keep_closer(geometry, found, t, slot, vbool_none, hit);
}
#endif
