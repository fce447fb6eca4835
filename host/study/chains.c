/* chains.c: see chains.h.
 *
 * A ray from the point P to the sphere stays in the plane through P and the centre. In that plane the centre
 * is the origin, P lies at (-distance, 0), and y grows to the side on which the ray meets the sphere. */
#include "chains.h"

#include "base/status.h"
#include "reference/trace.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846
/* Angles that are tried, rings of a lamp and points of a ring. */
enum { ANGLES = 512, RINGS = 24, SECTORS = 24, TRIES = 60 };
#define WIDTH (PI / 2 / ANGLES)
#define STEP 1e-6 /* of an angle, for a slope */

/* What is the same for all points of a lamp. */
typedef struct Search {
    BpScene near;                        /* the spheres that may stand in the way, and those of the chain */
    uint32_t *numbers;                   /* theirs, in the scene */
    const BpSphere *ball, *lamp, *floor; /* in `near`; no lamp: a disc */
    const BpMaterial *material;
    const BpDisc *disc;
    uint32_t chords;
    BpScatter scatter;
    Vec point, normal, centre, axis; /* axis: of length 1, from the point to the centre */
    double radius, distance, index;
} Search;

/* A ray that has passed the sphere: where, and in which direction, of length 1. In the plane: z is 0. */
typedef struct Beam {
    Vec from, onward;
} Beam;

static double incidence_to_angle(const Search *search, double incidence) {
    return asin(search->radius / search->distance * sin(incidence));
}

static Vec reflected(Vec direction, Vec normal) {
    return sub(direction, scale(2 * dot(direction, normal), normal));
}

/* By `ratio`, the index on this side over that beyond. The normal faces the ray. */
static Vec refracted(Vec direction, Vec normal, double ratio) {
    const double cosine = -dot(direction, normal);
    const double beyond = sqrt(fmax(0, 1 - ratio * ratio * (1 - cosine * cosine)));
    return unit(add(scale(ratio, direction), scale(ratio * cosine - beyond, normal)));
}

/* The chain's direction after its hit number `meeting` of the sphere, from 0. */
static Vec onward_at(const Search *search, uint32_t meeting, Vec direction, Vec normal) {
    if (search->chords > 0 && meeting == 0) return refracted(direction, normal, 1 / search->index);
    if (search->chords > 0 && meeting == search->chords) return refracted(direction, normal, search->index);
    return reflected(direction, normal);
}

/* The ray that hits the sphere at an angle of incidence. */
static Beam pass(const Search *search, double incidence) {
    const double angle = incidence_to_angle(search, incidence);
    const double length = search->distance * cos(angle) - search->radius * cos(incidence);
    Beam beam = {{length * cos(angle) - search->distance, length * sin(angle), 0},
                 {cos(angle), sin(angle), 0}};
    beam.onward = onward_at(search, 0, beam.onward, scale(1 / search->radius, beam.from));
    for (uint32_t meeting = 1; meeting <= search->chords; ++meeting) {
        beam.from = add(beam.from, scale(-2 * dot(beam.from, beam.onward), beam.onward));
        beam.onward = onward_at(search, meeting, beam.onward, scale(-1 / search->radius, beam.from));
    }
    return beam;
}

/* By how much the ray passes a point of the plane on the right; or, of a direction, the sine of the angle.
 * *ahead: the ray goes towards it. */
static double offset(const Search *search, const Beam *beam, Vec aim, bool *ahead) {
    const Vec to = search->lamp != NULL ? sub(aim, beam->from) : aim;
    *ahead = dot(beam->onward, to) > 0;
    return cross(beam->onward, to).z;
}

static double offset_at(const Search *search, double incidence, Vec aim, bool *ahead) {
    const Beam beam = pass(search, incidence);
    return offset(search, &beam, aim, ahead);
}

/* The share of light that surfaces pass along the chain at this angle of incidence. */
static double share_of_surfaces(const Search *search, double incidence) {
    const BpMaterial *glass = search->material;
    if (glass->kind == BP_MATERIAL_METAL) return 1;
    const double inside = asin(sin(incidence) / search->index);
    double outer = 0, inner = 0;
    if (glass->fresnel == BP_FRESNEL_SCHLICK) {
        outer = bp_ref_schlick(cos(incidence), 1 / search->index);
        inner = bp_ref_schlick(cos(inside), search->index);
    } else if (glass->fresnel == BP_FRESNEL_EXACT) {
        outer = bp_ref_fresnel(cos(incidence), 1 / search->index);
        inner = bp_ref_fresnel(cos(inside), search->index);
    }
    if (search->chords == 0) return outer;
    return (1 - outer) * (1 - inner) * pow(inner, search->chords - 1.0);
}

/* The density of a lambertian material's directions. */
static double density(BpScatter scatter, double cosine) {
    if (cosine <= 0) return 0;
    if (scatter == BP_SCATTER_HEMISPHERE) return 1 / (2 * PI);
    if (scatter == BP_SCATTER_COSINE_CUBED) return 2 * cosine * cosine * cosine / PI;
    return cosine / PI;
}

/* Of the plane in which y grows along `across`. */
static Vec in_space(const Search *search, Vec across, Vec planar) {
    return add(scale(planar.x, search->axis), scale(planar.y, across));
}

/* Traces the spheres that the chain's rays hit. Returns the radiance of the lamp as weakened by a mirror's
 * colour; *by: the first sphere that is not the chain's, or NULL. */
static Vec trace(const Search *search, Vec direction, const BpSphere **by) {
    const Vec black = {0, 0, 0};
    Vec colour = {1, 1, 1};
    Ray ray = {.origin = search->point, .direction = direction, .leaves = search->floor};
    Hit hit;
    *by = NULL;
    for (uint32_t meeting = 0; meeting <= search->chords; ++meeting) {
        if (!bp_ref_hit(&search->near, &ray, &hit)) return black; /* it grazes the sphere */
        if (hit.sphere != search->ball) {
            *by = hit.sphere;
            return black;
        }
        Vec onward = onward_at(search, meeting, ray.direction, hit.normal);
        if (search->material->kind == BP_MATERIAL_METAL) {
            Random unused = random_stream(0, 0, 0); /* there is no fuzz */
            if (!bp_ref_scatter(&search->near, &ray, &hit, &unused, &onward, &colour)) return black;
        }
        ray = (Ray){.origin = hit.point, .direction = unit(onward), .leaves = search->ball};
    }
    const bool meets = bp_ref_hit(&search->near, &ray, &hit);
    if (search->disc != NULL) {
        if (meets) *by = hit.sphere;
        return meets ? black : mul(colour, vec(search->disc->radiance));
    }
    if (meets && hit.sphere == search->lamp)
        return mul(colour, bp_ref_varied(&search->near, &hit, BP_MEMBER_EMIT, hit.material->emit));
    if (meets) *by = hit.sphere;
    return black;
}

/* The line from there hits the lamp, or would if it were not blocked. */
static bool leads_to_lamp(const Search *search, Vec from, Vec direction) {
    if (search->lamp == NULL) return true; /* its points are directions */
    const Vec to = sub(vec(search->lamp->center), from);
    const double along = dot(to, direction), radius = search->lamp->radius;
    return along > 0 && length2(sub(to, scale(along, direction))) < radius * radius;
}

/* The state of a way while a lamp's points are tried. */
typedef struct Found {
    BpChainWay way;
    bool seen;
    double whole, lost; /* its light if unblocked, without the lamp's radiance; and the blocked part */
} Found;

/* A point of a lamp, or a direction of a disc; and the part of the lamp that it represents: of the plane
 * across `slant`, or of all directions; 0 for the middle, which only aims. */
typedef struct Aim {
    Vec to, slant;
    double measure;
} Aim;

static void put(Vec v, double to[3]) {
    to[0] = v.x;
    to[1] = v.y;
    to[2] = v.z;
}

/* The chain to a point of the lamp that stands `aside` from the axis, by one angle. `slope`: of the offset
 * over the angle; `across`: the direction of y. */
static void take(const Search *search, double incidence, double slope, double aside, Vec across,
                 const Aim *aim, Found *found) {
    const double angle = incidence_to_angle(search, incidence);
    const Vec direction = in_space(search, across, (Vec){cos(angle), sin(angle), 0});
    const Beam beam = pass(search, incidence);
    const Vec leaves = add(search->centre, in_space(search, across, beam.from));
    const Vec onward = in_space(search, across, beam.onward);
    const double chance = density(search->scatter, dot(direction, search->normal));
    const BpSphere *by = NULL;
    if (!(chance > 0) || !leads_to_lamp(search, leaves, onward)) return;
    const Vec radiance = trace(search, direction, &by);
    if (!found->seen) {
        const double length = search->distance * cos(angle) - search->radius * cos(incidence);
        put(direction, found->way.direction);
        put(add(search->point, scale(length, direction)), found->way.at);
        found->way.degrees = incidence * (180 / PI);
        found->way.to_middle = aim->measure == 0;
        found->seen = true;
    }
    if (by != NULL && found->lost == 0) found->way.by = search->numbers[by - search->near.spheres];
    /* The rays of a small solid angle sin(angle) d(angle) d(turn), turned about the axis by d(turn), cross at
     * the lamp an area aside d(turn) |slope| d(incidence). */
    const double turning = search->radius / search->distance * cos(incidence) / cos(angle);
    const double slant = search->lamp != NULL ? fabs(dot(onward, aim->slant)) : 1;
    const double share = chance * share_of_surfaces(search, incidence) * sin(angle) * turning * slant *
                         aim->measure / (aside * fabs(slope));
    if (!isfinite(share)) return; /* seen from the middle of a ring of light */
    found->whole += share;
    if (by != NULL) found->lost += share;
    put(add(vec(found->way.brings), scale(share, radiance)), found->way.brings);
}

/* Where the offset changes its sign between two angles: by false position, where an end that stays counts
 * half each time (the "Illinois" form; Dowell and Jarratt, 1971). */
static double find_root(const Search *search, double low, double high, Vec aim, double at_low,
                        double at_high) {
    bool ahead;
    int stayed = 0;
    double root = low;
    for (int i = 0; i < TRIES && high - low > 1e-15; ++i) {
        root = low - at_low * (high - low) / (at_high - at_low);
        const double off = offset_at(search, root, aim, &ahead);
        if (fabs(off) < 1e-15) break;
        if ((off > 0) == (at_low > 0)) {
            low = root;
            at_low = off;
            if (stayed > 0) at_high /= 2;
            stayed = 1;
        } else {
            high = root;
            at_high = off;
            if (stayed < 0) at_low /= 2;
            stayed = -1;
        }
    }
    return root;
}

/* All chains to a point of the lamp. */
static void try_point(const Search *search, const Beam *beams, const Aim *aim,
                      Found found[BP_CHAIN_WAYS_MAX]) {
    const double along = dot(aim->to, search->axis);
    Vec across = sub(aim->to, scale(along, search->axis));
    const double aside = sqrt(length2(across));
    /* Straight ahead or behind, every plane is as good as another. */
    if (!(aside > 1e-12))
        across = cross(search->axis, fabs(search->axis.x) < 0.5 ? (Vec){1, 0, 0} : (Vec){0, 1, 0});
    across = unit(across);
    for (int side = 1; side >= -1; side -= 2) {
        const Vec planar = {along, side * aside, 0};
        bool ahead;
        double last = 0;
        for (int k = 0; k <= ANGLES; ++k) {
            const double off = offset(search, &beams[k], planar, &ahead), before = last;
            last = off;
            if (k == 0 || (off > 0) == (before > 0)) continue;
            const double root = find_root(search, (k - 1) * WIDTH, k * WIDTH, planar, before, off);
            const double low = fmax(root - STEP, 0), high = fmin(root + STEP, PI / 2);
            const double slope =
                offset_at(search, high, planar, &ahead) - offset_at(search, low, planar, &ahead);
            offset_at(search, root, planar, &ahead);
            if (ahead)
                take(search, root, slope / (high - low), aside, scale(side, across), aim,
                     &found[side + 1 + (off > 0)]);
        }
    }
}

/* The distance of a sphere from the segment between two points, less its radius; where `endless`, of the ray
 * from one to the other. */
static double clearance(const BpSphere *sphere, Vec from, Vec to, bool endless) {
    const Vec along = sub(to, from), there = sub(vec(sphere->center), from);
    double t = fmax(dot(there, along) / length2(along), 0);
    if (!endless) t = fmin(t, 1);
    return sqrt(length2(sub(there, scale(t, along)))) - fabs(sphere->radius);
}

/* Only spheres that may block the way are tested for each ray. */
static BpStatus gather(const BpScene *scene, const BpChainPoint *point, const BpChain *chain, Search *search,
                       BpError *err) {
    const BpSphere *ball = &scene->spheres[chain->sphere];
    const Vec centre = vec(ball->center), from = vec(point->point);
    double wide = fabs(ball->radius);
    Vec to;
    if (chain->disc) {
        to = add(centre, unit(vec(scene->discs[chain->lamp].direction)));
    } else {
        to = vec(scene->spheres[chain->lamp].center);
        wide = fmax(wide, fabs(scene->spheres[chain->lamp].radius));
    }
    /* Rays to a disc spread, so distant spheres are kept. */
    const double spread =
        chain->disc ? tan(fmin(scene->discs[chain->lamp].half_angle_degrees, 80) * (PI / 180)) : 0;
    BpSphere *spheres = malloc(scene->sphere_count * sizeof *spheres);
    search->numbers = malloc(scene->sphere_count * sizeof *search->numbers);
    if (spheres == NULL || search->numbers == NULL) {
        free(spheres);
        free(search->numbers);
        return bp_fail(err, BP_ERR_MEMORY, "no memory for the spheres beside a chain");
    }
    search->near = *scene;
    search->near.spheres = spheres;
    search->near.moving_count = search->near.interior_count = search->near.sphere_count = 0;
    for (size_t i = 0; i < scene->sphere_count; ++i) {
        const BpSphere *sphere = &scene->spheres[i];
        const double away = sqrt(length2(sub(vec(sphere->center), centre)));
        const bool is_chains = i == chain->sphere || i == point->sphere || (!chain->disc && i == chain->lamp);
        if (!is_chains && clearance(sphere, from, centre, false) > fabs(ball->radius) &&
            clearance(sphere, centre, to, chain->disc) > wide + spread * (away + fabs(sphere->radius)))
            continue;
        const size_t here = search->near.sphere_count++;
        spheres[here] = *sphere;
        search->numbers[here] = (uint32_t)i;
        if (i == chain->sphere) search->ball = &spheres[here];
        if (i == point->sphere) search->floor = &spheres[here];
        if (!chain->disc && i == chain->lamp) search->lamp = &spheres[here];
    }
    return BP_OK;
}

/* All points of the lamp, the middle first, then ring by ring. */
static void try_lamp(const Search *search, Found found[BP_CHAIN_WAYS_MAX]) {
    Beam beams[ANGLES + 1];
    for (int k = 0; k <= ANGLES; ++k) beams[k] = pass(search, k * WIDTH);
    Vec middle;
    double extent, measure;
    if (search->lamp != NULL) {
        /* In the plane across the line of the centres; a line that touches both spheres crosses it within
         * this. */
        middle = sub(vec(search->lamp->center), search->centre);
        const double radius = fabs(search->lamp->radius);
        const double sine = (search->radius + radius) / sqrt(length2(middle));
        if (sine >= 1) return;
        extent = radius / sqrt(1 - sine * sine);
        measure = PI * extent * extent;
    } else {
        middle = unit(vec(search->disc->direction));
        extent = 2 * sin(search->disc->half_angle_degrees * (PI / 360)); /* a chord */
        measure = PI * extent * extent;
    }
    const Vec w = unit(middle), other = fabs(w.x) < 0.5 ? (Vec){1, 0, 0} : (Vec){0, 1, 0};
    const Vec s = unit(cross(w, other)), t = cross(w, s);
    Aim aim = {.to = middle, .slant = w};
    try_point(search, beams, &aim, found);
    aim.measure = measure / (RINGS * SECTORS);
    for (int i = 0; i < RINGS * SECTORS; ++i) {
        const int ring = i / SECTORS;
        const double out = extent * sqrt((ring + 0.5) / RINGS);
        const double turn = 2 * PI * (i % SECTORS + 0.25 + 0.5 * (ring % 2)) / SECTORS;
        const Vec aside = add(scale(cos(turn), s), scale(sin(turn), t));
        aim.to = add(middle, scale(out, aside));
        /* Equal areas of a sphere have equal squares of chords from its pole. */
        if (search->lamp == NULL)
            aim.to = add(scale(1 - out * out / 2, w), scale(out * sqrt(1 - out * out / 4), aside));
        try_point(search, beams, &aim, found);
    }
}

static int by_brightness(const void *a, const void *b) {
    const BpChainWay *one = a, *other = b;
    const double x = one->brings[0] + one->brings[1] + one->brings[2];
    const double y = other->brings[0] + other->brings[1] + other->brings[2];
    return (x < y) - (x > y);
}

BpStatus bp_chain_ways(const BpScene *scene, const BpChainPoint *point, const BpChain *chain,
                       BpChainWay ways[BP_CHAIN_WAYS_MAX], size_t *count, BpError *err) {
    const BpSphere *ball = &scene->spheres[chain->sphere];
    const BpMaterial *material = &scene->materials[ball->material];
    Search search = {.material = material,
                     .disc = chain->disc ? &scene->discs[chain->lamp] : NULL,
                     .chords = chain->chords,
                     .scatter = point->scatter,
                     .point = vec(point->point),
                     .normal = vec(point->normal),
                     .centre = vec(ball->center),
                     .radius = fabs(ball->radius),
                     .index = bp_sphere_refraction_index(scene, chain->sphere)};
    Found found[BP_CHAIN_WAYS_MAX] = {0};
    const Vec to = sub(search.centre, search.point);
    *count = 0;
    search.distance = sqrt(length2(to));
    if (!(search.distance > search.radius * (1 + 0x1p-16))) return BP_OK;
    search.axis = scale(1 / search.distance, to);
    BP_TRY(gather(scene, point, chain, &search, err));
    try_lamp(&search, found);
    free(search.near.spheres);
    free(search.numbers);
    for (int f = 0; f < BP_CHAIN_WAYS_MAX; ++f) {
        if (!(found[f].whole > 0)) continue;
        ways[*count] = found[f].way;
        ways[(*count)++].stopped = found[f].lost / found[f].whole;
    }
    qsort(ways, *count, sizeof *ways, by_brightness);
    return BP_OK;
}
