/* lamps_direct.cl: the light that lamps bring to a point directly, by two ways that share the work.
 *
 * A path finds a lamp by chance, or is led to one: a lamp is chosen and a ray sent to it (next-event estimation). Both
 * are weighted by the power heuristic (E. Veach, "Robust Monte Carlo Methods for Light Transport Simulation", 1997,
 * 9.2.4), so that for each length of a path the weights of its two ways add up to 1. Both follow from the ratio of the two
 * densities, and so does what a ray to a lamp brings, with the lobe's own weight in its direction.
 *
 * In:    paths that wait to be lit, or a lamp that a path has hit.   Out: paths with that light, or the weight of the hit.
 * Knows: lamps.cl, triangle_lamps.cl, discs.cl, fold.cl, vary_surface.cl, flight.cl, the closest hit.   Does not know: how a path continues.
 *
 * A ray to a lamp passes the boundaries of media as a path does: each begins another of its segments, of which it has no more
 * than the path. So both ways still have the same lengths. */
#if SAMPLES_LAMPS
#define RATIO_MAX R(1e15) /* its square is a float, and one more or less is none */

/* The density of `direction` in the lobe over that with which it is drawn as one to the lamp. */
static vreal density_ratio(const Lobe *lobe, Vec3 direction, int drawn, vreal cap, vreal probability) {
    const vreal solid_angle = divide(splat(2), splat(PI_INVERSE)) * cap;
    return at_most(divide(folded_pdf(lobe, direction, drawn) * solid_angle, probability), splat(RATIO_MAX));
}

/* The weight of the radiance of a lamp that a path has hit, where rays are sent to it too. */
static vreal weight_of_hit(vbool shared, vreal ratio) {
    const vreal square = ratio * ratio;
    return choose(shared, divide(square, splat(1) + square), splat(1));
}

/* What is left to the path of light that comes to its vertex along `direction`. If the lobe weighs all directions alike, that is
 * its throughput already. */
#if WEIGHTED_LOBES
static Vec3 throughput_along(const Path *path, Vec3 direction) {
    const vbool weighted = is_weighted(&path->lobe);
    if (!any_lane(weighted)) return path->throughput;
    return choose3(weighted, multiply3(path->arrived, folded_weight(&path->lobe, direction)), path->throughput);
}
#else
#define throughput_along(path, direction) (path)->throughput
#endif

#if SAMPLES_LAMP_TREE
/* The weight of the radiance of a lamp in `slot` that the path has hit; `hit`: these lanes have, a sphere from outside. */
static vreal lamp_hit_weight(const Scene *scene, const Path *path, vuint slot, WITH_SPHERE(const Sphere *sphere) vbool hit) {
    vbool shared = hit & is_lit_lobe(&path->lobe) & vbool_of_uint(vertex_slot_of(path) != slot);
    if (!any_lane(shared)) return splat(1);
#if SAMPLES_TRIANGLES
#if !SPHERES_MET
    const Sphere *const sphere = 0;
#endif
    LampCone cone = lamp_cone(vertex_of(path), sphere);
    see_triangle(scene, vertex_of(path), slot, shared, &cone);
#else
    const LampCone cone = lamp_cone(vertex_of(path), sphere);
#endif
    shared = shared & cone.outside;
    const vreal probability =
        lamp_probability(scene, vertex_of(path), &path->lobe, path_time(path), path->lamp_sum, slot, shared);
    shared = shared & (probability > splat(0));
    const vreal ratio = density_ratio(&path->lobe, path->direction, 1, cone.cap, choose(shared, probability, splat(1)));
    return weight_of_hit(shared, ratio);
}

static Vec3 radiance_of_sphere(const Scene *scene, vuint slot) {
    const vuint numbers = gather_split_uint(scene->slot_material, 0, slot) * MATERIAL_REALS;
    return vec3(gather_real(scene->materials + MATERIAL_EMIT, numbers),
                gather_real(scene->materials + (MATERIAL_EMIT + 1u), numbers),
                gather_real(scene->materials + (MATERIAL_EMIT + 2u), numbers));
}
#endif

#if SPHERES_MET
/* How far along its ray a lamp is. A direction that rounding has put past a tiny one stands for one that meets it. */
static vrefined distance_to_lamp(const Ray *ray, const LampChoice *choice, const LampCone *cone) {
    vrefined t;
    vbool enters;
    const vbool met = sphere_intersect(ray, &choice->sphere, &t, &enters);
    return choose_refined(met, t, to_refined(cone_distance(cone, choice->sphere.radius, choice->rest)));
}
#endif

/* What a ray to the lamp meets first. Of a triangle that is decided at once. No point of the lamp that can be seen is nearer than distance - radius, nor
 * farther than where a tangent touches: what is met before the one hides the lamp, what is not met before the other
 * does not, and only in between the lamp's own root along the rounded direction has to tell, by the rule for ties. */
ON_CHAINS static Hit first_seen(const Scene *scene, const Ray *ray, const LampChoice *choice, const LampCone *cone,
                      vbool active) {
    const Geometry *geometry = &scene->geometry;
    Hit lamp;
    const vreal slack = cone->distance * R(0x1p-18);
    lamp.t = to_refined(cone->tangent + slack);
#if SAMPLES_TRIANGLES
    const vbool flat = active & is_triangle(geometry, choice->slot);
    if (any_lane(flat)) lamp.t = choose_refined(flat, distance_to_triangle(geometry, ray, choice->slot, flat), lamp.t);
#endif
    lamp.slot = choice->slot;
    lamp.enters = vbool_all;
    lamp.bound = upper_bound(lamp.t);
    Hit first = intersect_closer(geometry, ray, active, lamp);
#if SAMPLES_LAMP_TREE && SPHERES_MET /* nothing is close to a lamp at infinity */
#if SAMPLES_TRIANGLES
    const vbool other = active & vbool_not(flat) & vbool_of_uint(first.slot != choice->slot);
#else
    const vbool other = active & vbool_of_uint(first.slot != choice->slot);
#endif
    const vbool close =
        other & vbool_of_refined(first.t >= to_refined(cone->distance - choice->sphere.radius - slack));
    if (any_lane(close))
        keep_closer(geometry, close, distance_to_lamp(ray, choice, cone), choice->slot, vbool_all, &first);
#endif
    return first;
}

#if LAMPS_THROUGH
#if LAMPS_THROUGH_MEDIA
/* The lanes whose ray to a lamp has met the boundary of a medium. */
static vbool meets_boundary(const Scene *scene, const Hit *hit, vuint lamp, vbool active) {
    const vbool other = active & vbool_of_uint(hit->slot != lamp);
    if (!any_lane(other)) return vbool_none;
    const vuint material = gather_split_uint(scene->slot_material, 0, choose_uint(other, hit->slot, splat_uint(0)));
    return other & vbool_of_uint(gather_uint(scene->material_kinds, material * MATERIAL_UINTS) == splat_uint(KIND_INTERFACE));
}
#endif

/* A ray to a lamp behind the boundaries that it has passed. */
typedef struct LampWay {
    vbool passed; /* one or more */
#if LAMPS_THROUGH_MEDIA
    vuint medium; /* behind them */
#endif
#if MEDIA_IN_TRIANGLES
    vuint bodies; /* around what is behind them */
#endif
    Vec3 left;    /* of light, by the media and surfaces up to there */
} LampWay;

/* Takes rays that have met a boundary, or a surface that lets light on, to what they meet next, and so on. Where a ray begins anew, the lamp is sought from
 * there, as it is for a path: `cone` is what it fills there, of the direction alone, so choice->rest is that of a tangent. */
static LampWay pass_boundaries(const Scene *scene, const Path *path, vbool active, LampChoice *choice, LampCone *cone, Ray *ray,
                               Hit *hit) {
    LampWay way;
    way.passed = vbool_none;
#if LAMPS_THROUGH_MEDIA
    way.medium = path->medium; /* a surface that reflects lies in the medium that the path has come through */
#endif
    way.left = vec3(splat(1), splat(1), splat(1));
#if MEDIA_IN_TRIANGLES
    way.bodies = path->bodies;
#endif
#if EFFECT_ROUGH_DIELECTRIC && LAMPS_THROUGH_MEDIA
    const vbool through = active & is_rough_dielectric(&path->lobe) & (dot3(ray->direction, TRUE_NORMAL(path->lobe.)) < splat(0));
#if MEDIA_IN_TRIANGLES
    way.bodies = bodies_beyond(scene, ray->own_slot, ray->inward, through, way.bodies);
#endif
    if (any_lane(through)) way.medium = choose_uint(through, medium_around(scene, ray, WITH_BODIES(way.bodies) through), way.medium);
#endif
#if !EFFECT_OPACITY
    if (scene->boundaries[first_boundary(scene)] == NO_SLOT) return way;
#endif
    const vbool far = vbool_of_uint(choice->slot >= splat_uint(DISC_SLOT));
#if LAMPS_THROUGH_MEDIA
    vuint segments = path->depth + 1u;
#endif
    for (;;) {
#if EFFECT_OPACITY
        const vbool other = active & vbool_of_uint(hit->slot != choice->slot);
        if (!any_lane(other)) return way;
        const vreal share = let_through(&scene->geometry, choose_uint(other, hit->slot, splat_uint(0)));
        const vbool thin = other & (share > splat(0)) & (way.left.x + way.left.y + way.left.z > splat(LEFT_MIN));
        way.left = choose3(thin, scale3(share, way.left), way.left);
#endif
#if LAMPS_THROUGH_MEDIA
        active = meets_boundary(scene, hit, choice->slot, active) & vbool_of_uint(segments < splat_uint(scene->max_depth));
#endif
#if EFFECT_OPACITY && LAMPS_THROUGH_MEDIA
        segments = choose_uint(active, segments + 1u, segments);
        active = active | thin;
        if (!any_lane(active)) return way;
#elif EFFECT_OPACITY
        active = thin;
        if (!any_lane(active)) return way;
#else
        if (!any_lane(active)) return way;
        segments += splat_uint(1);
#endif
        way.passed = way.passed | active;
        const vuint slot = choose_uint(active, hit->slot, splat_uint(0));
#if LAMPS_THROUGH_MEDIA
        const Vec3 left = transmittance(scene, choose_uint(active, way.medium, splat_uint(0)), to_real(hit->t));
        way.left = choose3(active, multiply3(way.left, left), way.left);
#endif
#if EFFECT_OPACITY
        go_behind(&scene->geometry, hit, active, ray);
#else
#if MEDIA_IN_TRIANGLES
        const vbool round = vbool_not(is_triangle(&scene->geometry, slot));
        const Sphere boundary = sphere_for_ray(&scene->geometry, ray, choose_uint(round, slot, splat_uint(0)));
#else
        const Sphere boundary = sphere_for_ray(&scene->geometry, ray, slot);
#endif
        Point point;
        Vec3 outward;
        sphere_surface(ray, &boundary, slot, hit->t, hit->enters, &point, &outward);
#if MEDIA_IN_TRIANGLES
#if SHARES_KNOWN
        Shares shares;
#endif
        surface_of_triangle(&scene->geometry, ray, hit, active, WITH_SHARES(&shares) &point, &outward);
#endif
        ray->origin.high = choose3(active, point.high, ray->origin.high);
        ray->origin.low = choose3(active, point.low, ray->origin.low);
        ray->origin.error = choose(active, point.error, ray->origin.error);
        ray->cull_margin = cull_margin_of(&ray->origin);
        ray->own_slot = choose_uint(active, slot, ray->own_slot);
        ray->inward = (active & hit->enters) | (vbool_not(active) & ray->inward);
#endif
#if MEDIA_IN_TRIANGLES
        way.bodies = bodies_beyond(scene, ray->own_slot, ray->inward, active, way.bodies);
#endif
#if LAMPS_THROUGH_MEDIA
        way.medium = choose_uint(active, medium_around(scene, ray, WITH_BODIES(way.bodies) active), way.medium);
#endif
#if SPHERES_MET
        const LampCone from_here = lamp_cone(&ray->origin, &choice->sphere);
        const vbool near = active & vbool_not(far);
        cone->distance = choose(near, from_here.distance, cone->distance);
        cone->power = choose(near, from_here.power, cone->power);
        cone->tangent = choose(near, from_here.tangent, cone->tangent);
        cone->cap = choose(near, from_here.cap, cone->cap);
        choice->rest = choose(near, splat(1), choice->rest);
#endif
        const Hit next = first_seen(scene, ray, choice, cone, active);
        hit->t = choose_refined(active, next.t, hit->t);
        hit->slot = choose_uint(active, next.slot, hit->slot);
        hit->enters = (active & next.enters) | (vbool_not(active) & hit->enters);
    }
}
#endif

#if SAMPLES_LAMP_TREE && EFFECT_TEXTURES
/* What the lamp in a slot sends along the ray that was sent to it, in the lanes `visible`: light that varies depends on where the
 * ray meets the lamp, or passes it where rounding has put it past a tiny one. */
static Vec3 radiance_along(const Scene *scene, const Ray *ray, const Sphere *sphere, vuint slot, vbool visible) {
#if SPHERES_MET
    vrefined t;
    vbool enters;
    Point point;
    Vec3 outward;
    sphere_intersect(ray, sphere, &t, &enters);
    sphere_surface(ray, sphere, slot, t, vbool_all, &point, &outward);
#else
    Point point = ray->origin;
    Vec3 outward = ray->direction;
#endif
#if SAMPLES_TRIANGLES
    Hit hit;
    hit.slot = slot;
#if SHARES_KNOWN
    Shares shares;
#endif
    surface_of_triangle(&scene->geometry, ray, &hit, visible, WITH_SHARES(&shares) &point, &outward);
#endif
#if MAPPED_TRIANGLES && SAMPLES_TRIANGLES
    const MapPlace place = triangle_map(scene, slot, visible, &shares);
#elif MAPPED_TRIANGLES
    const MapPlace place = off_triangles();
#endif
    return vary_radiance(scene, slot, &point, WITH_PLACE(&place) outward, visible, radiance_of_sphere(scene, slot));
}
#elif SAMPLES_LAMP_TREE
#define radiance_along(scene, ray, sphere, slot, visible) radiance_of_sphere(scene, slot)
#endif

/* Of a sphere in a slot, of a disc or of the image around, along the ray to it, in the lanes `visible`. */
static Vec3 radiance_of_lamp(const Scene *scene, const Ray *ray, const LampChoice *choice, vbool visible) {
    const vuint slot = choice->slot;
#if !SAMPLES_SKY
    return SEEN_OF_LAMP(scene, slot, radiance_along(scene, ray, &choice->sphere, slot, visible));
#else
    vbool disc = vbool_of_uint(slot >= splat_uint(DISC_SLOT));
    Vec3 radiance = zero3();
#if SAMPLES_LAMP_TREE
    radiance = SEEN_OF_LAMP(scene, choose_uint(disc, splat_uint(0), slot),
                            radiance_along(scene, ray, &choice->sphere, choose_uint(disc, splat_uint(0), slot),
                              visible & vbool_not(disc)));
#endif
    if (!any_lane(disc)) return radiance;
#if SAMPLES_ENVIRONMENT
    const vbool around = disc & vbool_of_uint(slot == splat_uint(IMAGE_SLOT));
    if (any_lane(around)) radiance = choose3(around, environment_radiance(scene, ray->direction), radiance);
    disc = disc & vbool_not(around);
#endif
#if SAMPLES_DISCS
    const vuint place = choose_uint(disc, slot - splat_uint(DISC_SLOT), splat_uint(0)) * DISC_REALS + DISC_RADIANCE;
    return choose3(disc,
                   vec3(gather_real(scene->discs, place), gather_real(scene->discs + 1u, place),
                        gather_real(scene->discs + 2u, place)),
                   radiance);
#else
    return radiance;
#endif
#endif
}

/* A lamp for the vertex of each `active` path, by the number `u`, and its cone; `v` leads on to a texel of an image. */
static LampChoice choose_light(const Scene *scene, const Path *path, vuint bounce, vreal u, vreal v, vbool active,
                               LampCone *cone) {
    const Point *point = &path->origin;
    const Lobe *lobe = &path->lobe;
    LampChoice choice;
#if SAMPLES_SKY
    DiscChoice disc = choose_disc(scene, point, lobe, path_time(path), path->key, bounce, u);
#if SAMPLES_ENVIRONMENT
    choose_texel(scene, path->key, bounce, v, active, &disc);
#endif
    active = active & vbool_not(disc.chosen);
    u = disc.rest;
#endif
#if SAMPLES_LAMP_TREE
    choice = choose_lamp(scene, point, lobe, path_time(path), path->key, bounce, u, active);
    *cone = lamp_cone(point, &choice.sphere);
#if SAMPLES_TRIANGLES
    see_triangle(scene, point, choice.slot, active, cone);
#endif
#else
    choice.slot = splat_uint(0);
    choice.sphere.centre = zero3();
    choice.sphere.radius = splat(0);
#if EFFECT_CAPSULES
    be_sphere(&choice.sphere);
#endif
    choice.probability = choice.rest = splat(0);
    cone->axis = disc.direction;
    cone->distance = cone->power = cone->tangent = splat(REAL_LARGE);
    cone->cap = splat(0);
    cone->outside = vbool_none;
#endif
#if SAMPLES_SKY
    take_disc(&disc, &choice, cone);
#endif
    return choice;
}

#if SAMPLES_CAUSTICS
static void light_through_focuser(const Scene *scene, Path *path, vuint bounce, int every, vbool active); /* caustics.cl */
#endif

/* One path at a time, a processor is faster when this step is a function of its own: within the loop over bounces, which it
 * interrupts at every other vertex, it takes registers from both. Packets are not, and on a GPU a call costs more. */
#if LANE_COUNT == 1 && defined(__OPTIMIZE__) && (defined(__x86_64__) || defined(__aarch64__))
#define LIGHT_STEP __attribute__((noinline)) static
#else
#define LIGHT_STEP static
#endif

/* Lights the vertices that want it: a ray to a lamp for each, which leaves as the path does. */
LIGHT_STEP void light_vertices(const Scene *scene, Path *path) {
    const Lobe *lobe = &path->lobe;
    const vuint bounce = first_dimension(path->depth - 1u);
    vbool active = path->wants_lamps;
    path->wants_lamps = vbool_none;
#if SAMPLES_CAUSTICS
    light_through_focuser(scene, path, bounce, 0, active);
#endif
    vreal u, v;
    sample_2d(path->key, bounce + BOUNCE_LAMP, &u, &v);
    LampCone cone;
    LampChoice choice = choose_light(scene, path, bounce, u, v, active, &cone);
    path->lamp_sum = choose(active, choice.sum, path->lamp_sum);
    active = active & (choice.probability > splat(0)) & cone.outside & vbool_of_uint(choice.slot != path->own_slot);
    Ray ray = path_ray(path);
#if SPHERES_MET
    ray.direction = sample_cone(&cone, choice.rest, v);
#endif
#if SAMPLES_TRIANGLES
    const vbool flat = active & is_triangle(&scene->geometry, choice.slot);
    if (any_lane(flat)) ray.direction = choose3(flat, sample_triangle(&cone, choice.rest, v), ray.direction);
#endif
#if EFFECT_ROUGH_DIELECTRIC
    ray.inward = turned_inward(lobe, path->direction, ray.direction, path->inward);
#endif
    const vreal ratio =
        density_ratio(lobe, ray.direction, 0, cone.cap, choose(active, choice.probability, splat(1)));
    active = active & (ratio > splat(0));
    path->lamp_slot = choose_uint(active, choice.slot, splat_uint(NO_SLOT));
    if (!any_lane(active)) return;

    path->lamp_rays += popcount(lane_bits(active));
    Hit hit = first_seen(scene, &ray, &choice, &cone, active);
#if LAMPS_THROUGH
    const LampWay way = pass_boundaries(scene, path, active, &choice, &cone, &ray, &hit);
#endif
    path->seen_slot = hit.slot;
    const vbool visible = active & vbool_of_uint(hit.slot == choice.slot);
    if (!any_lane(visible)) return;
    const vreal weight = divide(ratio, fma(ratio, ratio, splat(1)));
    Vec3 light = multiply3(throughput_along(path, ray.direction), scale3(weight, radiance_of_lamp(scene, &ray, &choice, visible)));
#if LAMPS_THROUGH_MEDIA
    const vuint medium = choose_uint(visible, way.medium, splat_uint(0));
    if (any_lane(vbool_of_uint(medium != splat_uint(0)))) {
        vreal length = cone_distance(&cone, choice.sphere.radius, choice.rest);
        if (any_lane(way.passed)) length = choose(way.passed, to_real(distance_to_lamp(&ray, &choice, &cone)), length);
#if SAMPLES_TRIANGLES
        length = choose(flat, to_real(hit.t), length);
#endif
        const vbool far = vbool_of_uint(choice.slot >= splat_uint(DISC_SLOT));
        light = multiply3(light, transmittance(scene, medium, choose(far, splat(REAL_LARGE), length)));
    }
#endif
#if LAMPS_THROUGH
    if (any_lane(way.passed)) light = multiply3(light, way.left);
#endif
    path->radiance = choose3(visible, add3(path->radiance, light), path->radiance);
}
#endif
