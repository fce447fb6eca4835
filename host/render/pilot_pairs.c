/* pilot_pairs.c: see pilot_pairs.h. */
#include "pilot_pairs.h"

#include "packed/focusers.h"
#include "pilot_shapes.h"
#include "scene/material.h"
#include "scene/vector.h"

#include <math.h>

#define PI 3.14159265358979323846
/* As in kernels/light/focuser_pairs.cl. */
enum { TRIALS = 8, ROOTS = 5 };
#define CLOSE 0x1p-11
#define HITS 0.25
#define SAME 0x1p-9
#define SHORTEST 0x1p-4
#define RIM 0.995
#define GRAZING_MIN 0x1p-10
#define ANGLES 128 /* among which roots of chains through one ball are looked for */

typedef struct Ball {
    double radius, index;
    uint32_t chords;
} Ball;

typedef struct Search {
    Ball balls[2];
    double to_first[3], between[3];
    double to_light[3]; /* from the centre of the second, or the direction to it */
    double size;        /* of the light, in radians */
    bool distant;
} Search;

/* A line with its derivatives by two angles at its beginning; it begins at the centre of the ball that it has
 * left. */
typedef struct Beam {
    double origin[3], direction[3], moves[2][3], turns[2][3];
} Beam;

static void add_scaled(double s, const double a[3], double to[3]) {
    for (int i = 0; i < 3; ++i) to[i] += s * a[i];
}

static double triple(const double a[3], const double b[3], const double c[3]) {
    double across[3];
    bp_cross(b, c, across);
    return bp_dot(a, across);
}

/* Turns a line where it meets a ball. False: it does not, or nothing is refracted. */
static bool meet(Beam *beam, double radius, double ratio, bool within, bool refracts) {
    double aside[3], point[3], normal[3], before[3];
    const double along = bp_dot(beam->origin, beam->direction);
    for (int a = 0; a < 3; ++a) aside[a] = beam->origin[a] - along * beam->direction[a];
    const double b = bp_length(aside) / radius, c = sqrt(fmax(0, (1 - b) * (1 + b)));
    const double bent2 = 1 - ratio * ratio * b * b;
    if (!(b < 1 && c > GRAZING_MIN) || (refracts && !(bent2 > 0)) || (!within && !(along < 0))) return false;
    const double half = (within ? c : -c) * radius, outward = within ? -1 / radius : 1 / radius;
    const double bent = sqrt(fmax(bent2, 0)), kept = refracts ? ratio : 1;
    const double added = refracts ? ratio * c - bent : 2 * c;
    const double added_slope = refracts ? ratio * (1 - ratio * c / bent) : 2;
    for (int a = 0; a < 3; ++a) {
        point[a] = half * beam->direction[a] + aside[a];
        normal[a] = outward * point[a];
        before[a] = beam->direction[a];
        beam->direction[a] = kept * before[a] + added * normal[a];
        beam->origin[a] = point[a];
    }
    for (int k = 0; k < 2; ++k) {
        double leans[3];
        add_scaled(half - along, beam->turns[k], beam->moves[k]);
        add_scaled(bp_dot(normal, beam->moves[k]) / c, before, beam->moves[k]);
        for (int a = 0; a < 3; ++a) leans[a] = outward * beam->moves[k][a];
        const double grows = -added_slope * (bp_dot(beam->turns[k], normal) + bp_dot(before, leans));
        for (int a = 0; a < 3; ++a)
            beam->turns[k][a] = kept * beam->turns[k][a] + grows * normal[a] + added * leans[a];
    }
    return true;
}

static bool pass_ball(const Ball *ball, Beam *beam) {
    if (!meet(beam, ball->radius, 1 / ball->index, false, ball->chords > 0)) return false;
    for (uint32_t chord = 1; chord <= ball->chords; ++chord)
        if (!meet(beam, ball->radius, ball->index, true, chord == ball->chords)) return false;
    return true;
}

/* A line from the point, behind the first ball; its origin is seen from the middle of the second. */
static bool begin(const Search *search, const double direction[3], Beam *beam) {
    *beam = (Beam){0};
    memcpy(beam->direction, direction, sizeof beam->direction);
    add_scaled(-1, search->to_first, beam->origin);
    bp_across(direction, beam->turns[0], beam->turns[1]);
    const bool passes = pass_ball(&search->balls[0], beam);
    add_scaled(-1, search->between, beam->origin);
    return passes;
}

static bool through(const Search *search, const double direction[3], Beam *beam) {
    return begin(search, direction, beam) && pass_ball(&search->balls[1], beam);
}

/* Where the line ends: its direction, or where it crosses the plane of the lamp. */
static bool end_of(const Search *search, const Beam *beam, double end[3]) {
    memcpy(end, search->distant ? beam->direction : beam->origin, sizeof beam->direction);
    if (search->distant) return true;
    const double along = bp_dot(beam->direction, search->to_light);
    if (!(along > 0)) return false;
    const double length = bp_dot(search->to_light, search->to_light) - bp_dot(beam->origin, search->to_light);
    add_scaled(length / along, beam->direction, end);
    return true;
}

/* By how far a line misses its end, in radians, and how that shrinks as it turns. */
static bool miss_of(const Search *search, const Beam *beam, const double end[3], double miss[3],
                    double slopes[2][3]) {
    double way[3];
    bp_way(beam->origin, end, way);
    const double ahead = search->distant ? 1 : bp_dot(way, beam->direction);
    if (!(ahead > 0)) return false;
    for (int a = 0; a < 3; ++a) {
        miss[a] = search->distant ? end[a] - beam->direction[a] : way[a] / ahead - beam->direction[a];
        for (int k = 0; k < 2; ++k)
            slopes[k][a] = beam->turns[k][a] + (search->distant ? 0 : beam->moves[k][a] / ahead);
    }
    return true;
}

static bool turn_to_end(const Search *search, const double end[3], double near, double direction[3]) {
    double best[3], step[3] = {0}, least = INFINITY, shortened = 1;
    memcpy(best, direction, sizeof best);
    for (int trial = 0; trial < TRIALS; ++trial) {
        Beam beam;
        double miss[3], slopes[2][3], s[3], t[3], length = 0;
        bool good = through(search, direction, &beam) && miss_of(search, &beam, end, miss, slopes) &&
                    bp_dot(miss, miss) < least;
        const double area = good ? triple(beam.direction, slopes[0], slopes[1]) : 0;
        good = good && fabs(area) > 1e-20;
        if (good) {
            least = bp_dot(miss, miss);
            bp_across(direction, s, t);
            memset(step, 0, sizeof step);
            add_scaled(triple(beam.direction, miss, slopes[1]) / area, s, step);
            add_scaled(triple(beam.direction, slopes[0], miss) / area, t, step);
            length = bp_length(step);
            memcpy(best, direction, sizeof best);
        }
        const double shorter = good ? fmin(1, 0.5 * near / length) : 0.5;
        shortened = good ? 1 : shortened * 0.5;
        for (int a = 0; a < 3; ++a) {
            step[a] *= shorter;
            direction[a] = best[a] + step[a];
        }
        bp_normalize(direction);
        if (good && length < CLOSE * near && sqrt(least) < HITS * search->size) return true;
        if (!(shortened > SHORTEST) || isinf(least)) return false;
    }
    return false;
}

/* By how far a chain through the first ball has turned about its centre at an angle of incidence, in excess
 * of `wanted` (W in kernels/light/focusers.cl). */
static double turned(const Ball *ball, double near, double far, double incidence, double wanted) {
    const double b = sin(incidence);
    return asin(fmin(1, b * near)) + asin(fmin(1, b * far)) - 2 * incidence +
           2 * ball->chords * asin(fmin(1, b / ball->index)) - wanted;
}

/* The first angle of incidence at which the chain has turned so; on a rise, or on a fall. */
static bool root_of(const Ball *ball, double near, double far, double wanted, bool rising,
                    double *incidence) {
    double last = turned(ball, near, far, 0, wanted);
    for (int k = 1; k <= ANGLES; ++k) {
        const double next = turned(ball, near, far, PI / 2 * k / ANGLES, wanted);
        if (rising ? last < 0 && next >= 0 : last > 0 && next <= 0) {
            double low = PI / 2 * (k - 1) / ANGLES, high = PI / 2 * k / ANGLES;
            for (int halving = 0; halving < 40; ++halving) {
                const double middle = (low + high) / 2;
                const bool before = (turned(ball, near, far, middle, wanted) < 0) == rising;
                low = before ? middle : low;
                high = before ? high : middle;
            }
            *incidence = low;
            return true;
        }
        last = next;
    }
    return false;
}

/* The plane of a chain through one ball. */
typedef struct Plane {
    double axis[3], aside[3], near, far, angle; /* to be turned */
    bool straight;
} Plane;

/* `to_target`: from the centre, or a direction if `distant`. */
static Plane plane_of(const Ball *ball, const double to_centre[3], const double to_target[3], bool distant) {
    Plane plane = {.straight = ball->chords % 2 == 1};
    double aim[3];
    memcpy(plane.axis, to_centre, sizeof plane.axis);
    memcpy(aim, to_target, sizeof aim);
    plane.near = ball->radius / bp_normalize(plane.axis);
    plane.far = ball->radius / bp_normalize(aim);
    if (distant) plane.far = 0;
    const double cosine = bp_dot(plane.axis, aim);
    memcpy(plane.aside, aim, sizeof plane.aside);
    add_scaled(-cosine, plane.axis, plane.aside);
    plane.angle = atan2(bp_normalize(plane.aside), plane.straight ? cosine : -cosine);
    return plane;
}

static void plane_direction(const Plane *plane, double side, double sine, double direction[3]) {
    const double off = sine * plane->near;
    memset(direction, 0, 3 * sizeof *direction);
    add_scaled(sqrt(fmax(0, 1 - off * off)), plane->axis, direction);
    add_scaled((plane->straight ? side : -side) * off, plane->aside, direction);
    bp_normalize(direction);
}

static bool plane_root(const Ball *ball, const Plane *plane, int piece, double direction[3]) {
    double incidence;
    const double side = piece < 2 ? 1 : -1;
    if (!root_of(ball, plane->near, plane->far, side * plane->angle, piece == 0, &incidence)) return false;
    plane_direction(plane, side, sin(incidence), direction);
    return true;
}

/* Where Newton's method begins. */
typedef struct Beginnings {
    size_t count;
    double directions[ROOTS][3];
} Beginnings;

static void add_beginning(Beginnings *beginnings, const double direction[3]) {
    if (beginnings->count == ROOTS) return;
    memcpy(beginnings->directions[beginnings->count++], direction, 3 * sizeof *direction);
}

static void add_beginnings(const Search *search, const double end[3], int piece, const double direction[3],
                           Beginnings *beginnings) {
    const Ball *first = &search->balls[0], *second = &search->balls[1];
    const size_t before = beginnings->count;
    Beam beam;
    if (begin(search, direction, &beam) && bp_length(beam.origin) > second->radius) {
        const double to_second[3] = {-beam.origin[0], -beam.origin[1], -beam.origin[2]};
        const Plane plane = plane_of(second, to_second, end, search->distant);
        for (int other = 0; other < 3; ++other) {
            double onward[3], entry[3], better[3];
            if (!plane_root(second, &plane, other, onward)) continue;
            const double along = bp_dot(to_second, onward);
            for (int a = 0; a < 3; ++a) entry[a] = along * onward[a] - to_second[a];
            const double square = second->radius * second->radius - bp_dot(entry, entry);
            add_scaled(-sqrt(fmax(0, square)), onward, entry);
            add_scaled(1, search->between, entry);
            const Plane again = plane_of(first, search->to_first, entry, false);
            if (plane_root(first, &again, piece < 3 ? piece : 2, better)) add_beginning(beginnings, better);
        }
    }
    if (beginnings->count == before) add_beginning(beginnings, direction);
}

/* Whether Newton's method comes to the chain's own direction from one of its beginnings. */
static bool comes_to(const Search *search, const double end[3], const double wanted[3]) {
    const Ball *first = &search->balls[0];
    const Plane plane = plane_of(first, search->to_first, search->between, false);
    Beginnings beginnings = {0};
    double direction[3];
    for (int piece = 0; piece < 3; ++piece)
        if (plane_root(first, &plane, piece, direction))
            add_beginnings(search, end, piece, direction, &beginnings);
    if (beginnings.count == 0) {
        plane_direction(&plane, -1, RIM, direction);
        add_beginnings(search, end, 3, direction, &beginnings);
    }
    const double same = SAME * plane.near;
    for (size_t k = 0; k < beginnings.count; ++k)
        if (turn_to_end(search, end, plane.near, beginnings.directions[k]) &&
            bp_distance2(beginnings.directions[k], wanted) <= same * same)
            return true;
    return false;
}

/* Of two spheres, from the point on. */
static bool finds(const BpScene *scene, const BpPilotLight *light, const BpPilotMet *met,
                  const double point[3], const double direction[3]) {
    Search search = {.distant = light->distant};
    const BpSphere *spheres[2];
    Beam beam;
    double end[3];
    for (int i = 0; i < 2; ++i) {
        spheres[i] = &scene->spheres[met->shapes[i]];
        const bool glass = scene->materials[spheres[i]->material].kind == BP_MATERIAL_DIELECTRIC;
        search.balls[i] = (Ball){.radius = fabs(spheres[i]->radius),
                                 .index = glass ? bp_sphere_refraction_index(scene, met->shapes[i]) : 2,
                                 .chords = met->vertices[i] - 1};
    }
    bp_way(point, spheres[0]->center, search.to_first);
    bp_way(spheres[0]->center, spheres[1]->center, search.between);
    if (light->distant)
        memcpy(search.to_light, light->place, sizeof search.to_light);
    else
        bp_way(spheres[1]->center, light->place, search.to_light);
    search.size = light->distant ? sqrt(2 * light->cap) : light->radius / bp_length(search.to_light);
    return through(&search, direction, &beam) && end_of(&search, &beam, end) &&
           comes_to(&search, end, direction);
}

void bp_pilot_meet(BpPilotMet *met, uint32_t shape) {
    if (met->count == 0 || (met->count == 1 && met->shapes[0] != shape)) met->shapes[met->count++] = shape;
    if (met->shapes[met->count - 1] == shape)
        ++met->vertices[met->count - 1];
    else
        met->others = true;
}

void bp_pilot_met_turn_round(BpPilotMet *met) {
    if (met->count < 2) return;
    const BpPilotMet other = *met;
    for (int i = 0; i < 2; ++i) {
        met->shapes[i] = other.shapes[1 - i];
        met->vertices[i] = other.vertices[1 - i];
    }
}

bool bp_pilot_is_found(const BpScene *scene, const BpPilotLight *light, const BpPilotMet *met,
                       const double point[3], const double direction[3]) {
    if (met->others || met->count == 0) return false;
    const uint32_t last = met->count - 1;
    if (!bp_pilot_is_sampled(scene, light, met->shapes[last], met->vertices[last])) return false;
    if (met->count == 1) return true;
    return bp_pilot_is_sampled(scene, light, met->shapes[0], met->vertices[0]) &&
           bp_focuses_pair(scene, met->shapes[0], met->shapes[1]) &&
           finds(scene, light, met, point, direction);
}
