/* flight.cl: paths that fly through media: where they are scattered, and what is left of them.
 *
 * In:    paths, and how far it is to the next surface.   Out: paths that have arrived, or that a medium has scattered.
 * Knows: path.cl, exponential.cl, phase.cl, the boundaries of media (scene_types.h).   Does not know: surfaces, the sky.
 *
 * A point lies in one medium: that of the smallest boundary around it. Between two surfaces the medium is one and the same,
 * since every boundary is a surface. Spheres and capsules are asked. Of a body of triangles a path has a bit, which is set
 * where the path comes to the inner side of one of them and cleared where it comes to the outer one: so what happens at an edge,
 * where one triangle or both may be met, leaves it right.
 *
 * Flights are sampled by scattering alone, and absorption is a weight, exp(-absorption * length): so a medium that only
 * absorbs has no noise, and no weight exceeds 1. Where colours scatter differently, a path flies by one of the
 * three, chosen once, and is weighted by the balance heuristic against the other two (A. Wilkie et al., "Hero Wavelength
 * Spectral Sampling", 2014): `likelihood` is the density of all its flights by each colour, over the mean of the three.
 * No weight exceeds 3, and media of one colour have none. */
#if EFFECT_MEDIA
#if MEDIA_IN_BODIES
#define first_boundary(scene) (scene)->boundaries[0]
#else
#define first_boundary(scene) 0
#endif

/* The number of the medium around the origins of rays. */
static vuint medium_around(const Scene *scene, const Ray *ray, WITH_BODIES(vuint bodies) vbool asked) {
    vuint medium = splat_uint(0);
    for (uint entry = first_boundary(scene);; entry += BOUNDARY_UINTS) {
        const uint slot = scene->boundaries[entry], inside_medium = scene->boundaries[entry + 1u];
        if (slot == NO_SLOT) return choose_uint(asked, splat_uint(inside_medium), medium);
#if MEDIA_IN_TRIANGLES
        if (slot >= BODY_SLOT) {
            const vbool within = asked & vbool_of_uint((bodies >> (slot - BODY_SLOT) & 1u) != splat_uint(0));
            medium = choose_uint(within, splat_uint(inside_medium), medium);
            asked = asked & vbool_not(within);
            continue;
        }
#endif
#if MEDIA_IN_CAPSULES
        const Sphere sphere = ball_around_origin(&scene->geometry, ray, splat_uint(slot));
#else
        const Sphere sphere = sphere_for_ray(&scene->geometry, ray, splat_uint(slot));
#endif
        Vec3 to_centre;
        const vreal power = sphere_power(&ray->origin, &sphere, &to_centre);
        const vbool own = vbool_of_uint(ray->own_slot == splat_uint(slot));
        const vbool inside = asked & ((own & ray->inward) | (vbool_not(own) & (power < splat(0))));
        medium = choose_uint(inside, splat_uint(inside_medium), medium);
        asked = asked & vbool_not(inside);
        if (!any_lane(asked)) return medium;
    }
}

#if MEDIA_IN_TRIANGLES
/* The bodies around what leaves the surface in a slot, `inward` or not, and was in `bodies` before. */
static vuint bodies_beyond(const Scene *scene, vuint slot, vbool inward, vbool active, vuint bodies) {
    const vbool leaves = active & is_triangle(&scene->geometry, slot);
    if (!any_lane(leaves)) return bodies;
    const vuint material = gather_split_uint(scene->slot_material, 0, choose_uint(leaves, slot, splat_uint(0)));
    const vuint masks = BODY_HEAD + material * BODY_MASKS;
    const vuint within = gather_uint(scene->boundaries, masks), without = gather_uint(scene->boundaries + 1u, masks);
    const vuint set = choose_uint(inward, within, without), cleared = choose_uint(inward, without, within);
    return choose_uint(leaves, (bodies & ~cleared) | set, bodies);
}

/* Where nothing is met, there is no body around: a path that rounding has put past the last boundary learns that it is out. */
static void find_bodies(const Scene *scene, const Ray *ray, const Hit *hit, vbool asked, Path *path) {
    const vbool from_camera = asked & vbool_of_uint(path->depth == splat_uint(1));
    path->bodies = choose_uint(from_camera, splat_uint(scene->boundaries[1]), path->bodies);
    path->bodies = bodies_beyond(scene, ray->own_slot, ray->inward, asked, path->bodies);
    path->bodies = choose_uint(asked & vbool_not(is_hit(hit)), splat_uint(0), path->bodies);
#if PILOT
    /* A path from a light begins anywhere. It is in the body whose boundary it meets from inside. */
    const vbool leaves_no_shape = asked & is_hit(hit) & vbool_of_uint(ray->own_slot == splat_uint(NO_SLOT));
    path->bodies = bodies_beyond(scene, hit->slot, vbool_not(hit->enters), leaves_no_shape, path->bodies);
#endif
}
#define WITH_HIT(hit) hit,
#else
#define WITH_HIT(hit)
#endif

/* Finds out the media of the paths that may have come into another. */
static void find_media(const Scene *scene, const Ray *ray, WITH_HIT(const Hit *hit) vbool moving, Path *path) {
    const vbool asked = moving & path->unsure;
    if (!any_lane(asked)) return;
#if MEDIA_IN_TRIANGLES
    find_bodies(scene, ray, hit, asked, path);
#endif
    path->medium = choose_uint(asked, medium_around(scene, ray, WITH_BODIES(path->bodies) asked), path->medium);
    path->unsure = path->unsure & vbool_not(asked);
}

static Vec3 medium_colour(const Scene *scene, vuint medium, uint member) {
    const vuint place = medium * MEDIUM_REALS + member;
    return vec3(gather_real(scene->media, place), gather_real(scene->media + 1u, place),
                gather_real(scene->media + 2u, place));
}

/* exp(x) for x that is below 40. */
static vreal exp_below_40(vreal x) {
    const vreal e = exp_minus(fabs(x));
    return choose(x > splat(0), divide(splat(1), choose(x > splat(0), e, splat(1))), e);
}

/* What a medium leaves of light along a straight way. */
static Vec3 transmittance(const Scene *scene, vuint medium, vreal length) {
    const Vec3 extinction =
        add3(medium_colour(scene, medium, MEDIUM_SCATTERING), medium_colour(scene, medium, MEDIUM_ABSORPTION));
    return vec3(exp_minus(extinction.x * length), exp_minus(extinction.y * length), exp_minus(extinction.z * length));
}

/* The lanes `moving` fly to the next surface, `distance` ahead; returns those that are scattered before, at `length`. */
static vbool fly(const Scene *scene, vbool moving, vreal distance, Path *path, vreal *length) {
    /* In clear space nothing is touched: even a weight of 1 is rounded, and lanes must not depend on what others pass. */
    const vuint medium = choose_uint(moving, path->medium, splat_uint(0));
    const vbool inside = moving & vbool_of_uint(medium != splat_uint(0));
    *length = distance;
    if (!any_lane(inside)) return vbool_none;
    const Vec3 scattering = medium_colour(scene, medium, MEDIUM_SCATTERING);
    const Vec3 absorption = medium_colour(scene, medium, MEDIUM_ABSORPTION);
    const vreal colour = uniform(path->key, splat_uint(DIMENSION_FLIGHT_COLOUR)) * R(3.0);
    const vreal by = choose(colour < splat(1), scattering.x, choose(colour < splat(2), scattering.y, scattering.z));
    const vuint first = first_dimension(path->depth - 1u);
    const vbool scatters_ever = by > splat(0);
    const vreal free =
        exponential_length(sample_1d(path->key, first + BOUNCE_FLIGHT), uniform(path->key, first + BOUNCE_FLIGHT_REFILL));
    const vreal until = divide(free, choose(scatters_ever, by, splat(1)));
    const vbool scattered = inside & scatters_ever & (until < distance);
    *length = choose(scattered, until, distance);
    /* The density of this flight by each colour, over that by the path's own. */
    Vec3 density = vec3(exp_below_40((by - scattering.x) * *length), exp_below_40((by - scattering.y) * *length),
                        exp_below_40((by - scattering.z) * *length));
    const Vec3 ratio = scale3(divide(splat(1), choose(scatters_ever, by, splat(1))), scattering);
    density = choose3(scattered, multiply3(density, ratio), density);
    const Vec3 likelihood = multiply3(path->likelihood, density);
    const vreal mean = divide(likelihood.x + likelihood.y + likelihood.z, splat(3));
    const vreal inverse = divide(splat(1), mean);
    const Vec3 left = vec3(exp_minus(absorption.x * *length), exp_minus(absorption.y * *length),
                           exp_minus(absorption.z * *length));
    path->likelihood = choose3(inside, scale3(inverse, likelihood), path->likelihood);
    path->throughput =
        choose3(inside, multiply3(path->throughput, multiply3(scale3(inverse, density), left)), path->throughput);
    return scattered;
}

/* The lanes whose latest segment ended in a medium continue from there. Which medium that is will be looked up again, since it
 * costs little, and rounding may have put the point past a boundary. */
static void scatter_in_medium(const Scene *scene, Path *path) {
    const vbool scattered = path->latest.scattered;
    if (!any_lane(scattered)) return;
    const vuint first = first_dimension(path->depth - 1u);
    const vreal g = gather_real(scene->media, choose_uint(scattered, path->medium, splat_uint(0)) * MEDIUM_REALS + MEDIUM_ANISOTROPY);
    vreal u, v;
    sample_2d(path->key, first + BOUNCE_DIRECTION, &u, &v);
    path->origin = point_ahead(path, scattered, to_real(path->latest.distance));
    path->own_slot = choose_uint(scattered, splat_uint(NO_SLOT), path->own_slot);
    path->inward = path->inward & vbool_not(scattered);
    path_light_in_medium(path, scattered, g, scene->max_depth);
    path->direction = choose3(scattered, phase_direction(path->direction, g, u, v), path->direction);
    path->unsure = path->unsure | scattered;
}

/* Of what a camera ray shows. */
#define seen_through(path, radiance) multiply3((path)->throughput, radiance)
#else
#define WITH_HIT(hit)
#define find_media(scene, ray, moving, path)
#define fly(scene, moving, distance, path, length) vbool_none
#define scatter_in_medium(scene, path)
#define seen_through(path, radiance) (radiance)
#endif
