/* pilot_lights.c: see pilot_lights.h. */
#include "pilot_lights.h"

#include "base/color.h"
#include "packed/environment_table.h"
#include "packed/focusers.h"
#include "packed/lamp_tree.h"
#include "pilot_shapes.h"
#include "scene/vector.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846

/* ---- lights ---- */

static void add_disc(const BpScene *scene, size_t number, BpPilotAim *aim) {
    const BpDisc *disc = &scene->discs[number];
    BpPilotLight *light = &aim->lights[aim->light_count];
    const double half = 0.5 * disc->half_angle_degrees * PI / 180, sine = sin(half);
    *light = (BpPilotLight){
        .distant = true, .disc = number, .seen = disc->visible_to_camera, .cap = 2 * sine * sine, .share = 1};
    memcpy(light->place, disc->direction, sizeof light->place);
    memcpy(light->radiance, disc->radiance, sizeof light->radiance);
    bp_normalize(light->place);
    if (bp_luminance_of(light->radiance) > 0) ++aim->light_count;
}

/* Texels are brighter than this, in powers of two over the mean, to be a light of their own. */
#define BRIGHT_OCTAVE 3

/* The part of the sphere nearest to a texel. Its light is interpolated between texels. */
typedef struct TexelLight {
    double mean[3];           /* radiance */
    double luminance, square; /* of the luminance, the mean and the mean square */
} TexelLight;

static const float *texel_at(const BpImage *image, int64_t column, int64_t row) {
    const int64_t width = image->width, height = image->height;
    const int64_t y = row < 0 ? 0 : row >= height ? height - 1 : row;
    return image->texels + 3 * (y * width + (column + width) % width);
}

/* False, and nothing else: neither it nor a neighbour is bright. At four by four places of the square, which
 * is exact but for a few percent. */
static bool texel_light(const BpImage *image, size_t texel, TexelLight *light) {
    const int64_t column = (int64_t)(texel % image->width), row = (int64_t)(texel / image->width);
    const double bright = ldexp(image->mean, BRIGHT_OCTAVE);
    bool any = false;
    for (int k = 0; k < 9 && !any; ++k)
        any = bp_luminance(texel_at(image, column + k % 3 - 1, row + k / 3 - 1)) > bright;
    *light = (TexelLight){.luminance = 0};
    if (!any) return false;
    for (int k = 0; k < 16; ++k) {
        const double x = (k % 4 - 1.5) / 4, y = ((double)(k / 4) - 1.5) / 4;
        const int64_t aside = x < 0 ? -1 : 1, below = y < 0 ? -1 : 1;
        const double u = fabs(x), v = fabs(y);
        const float *corner[4] = {texel_at(image, column, row), texel_at(image, column + aside, row),
                                  texel_at(image, column, row + below),
                                  texel_at(image, column + aside, row + below)};
        double radiance[3];
        for (int c = 0; c < 3; ++c) {
            radiance[c] = (1 - v) * ((1 - u) * (double)corner[0][c] + u * (double)corner[1][c]) +
                          v * ((1 - u) * (double)corner[2][c] + u * (double)corner[3][c]);
            light->mean[c] += radiance[c] / 16;
        }
        light->luminance += bp_luminance_of(radiance) / 16;
        light->square += bp_luminance_of(radiance) * bp_luminance_of(radiance) / 16;
    }
    return light->luminance > bright;
}

static int octave_over(const BpImage *image, const TexelLight *light) {
    return ilogb(light->luminance / image->mean);
}

/* The brightest texels of the image around, as distant lights; of too many, every so many-th stands for the
 * others. */
static void add_texels(const BpScene *scene, size_t room, BpPilotAim *aim) {
    const BpImage *image = scene->environment;
    const size_t texels = (size_t)image->width * image->height;
    size_t count_of[64] = {0}, count = 0, seen = 0;
    TexelLight texel;
    for (size_t i = 0; i < texels; ++i) {
        if (!texel_light(image, i, &texel)) continue;
        const int octave = octave_over(image, &texel);
        ++count_of[octave < 63 ? octave : 63];
    }
    int least = 64;
    while (least > BRIGHT_OCTAVE && (count == 0 || count + count_of[least - 1] <= room))
        count += count_of[--least];
    const size_t each = count > room ? (count + room - 1) / room : 1;
    double seam[3], east[3], pole[3];
    bp_environment_frame(scene, seam, east, pole);
    for (size_t i = 0; i < texels && count > 0; ++i) {
        if (!texel_light(image, i, &texel) || octave_over(image, &texel) < least || seen++ % each != 0)
            continue;
        const double row = (double)(i / image->width), column = (double)(i % image->width);
        const double down = PI * (row + 0.5) / image->height, turn = 2 * PI * (column + 0.5) / image->width;
        BpPilotLight *light = &aim->lights[aim->light_count++];
        *light = (BpPilotLight){.distant = true, .disc = SIZE_MAX, .seen = true, .share = (double)each};
        for (int a = 0; a < 3; ++a) {
            light->place[a] = cos(down) * pole[a] + sin(down) * (cos(turn) * seam[a] + sin(turn) * east[a]);
            light->radiance[a] = texel.mean[a] * texel.square / (texel.luminance * texel.luminance);
        }
        /* A light of one radiance that has the same mean, and the same mean square. */
        light->cap =
            PI * sin(down) / image->height / image->width * texel.luminance * texel.luminance / texel.square;
    }
}

/* ---- lamps: spheres and triangles that rays are sent to ---- */

static bool is_lamp(const BpScene *scene, size_t shape, size_t enclosing) {
    return bp_pilot_is_sphere(scene, shape) ? bp_sphere_is_sampled(scene, shape, enclosing)
                                            : bp_luminance_of(bp_pilot_material(scene, shape)->emit) > 0;
}

static double radius_of(const BpScene *scene, size_t shape) {
    double normal[3];
    return bp_pilot_is_triangle(scene, shape)
               ? sqrt(bp_pilot_area(bp_pilot_triangle(scene, shape), normal) / PI)
               : fabs(scene->spheres[shape].radius);
}

/* All lamps, or of more than there is room for some, drawn by systematic sampling in proportion to the square
 * of their power: each stands for its share of them. */
static void add_lamps(const BpScene *scene, size_t room, BpPilotAim *aim) {
    const size_t enclosing = bp_enclosing_lamp(scene);
    double sum = 0, below = 0;
    size_t count = 0;
    for (size_t i = 0; i < bp_scene_shapes(scene); ++i) {
        if (!is_lamp(scene, i, enclosing)) continue;
        const double y = bp_luminance_of(bp_pilot_material(scene, i)->emit), r = radius_of(scene, i);
        sum += y * y * r * r;
        ++count;
    }
    double next = 0.5;
    for (size_t i = 0; i < bp_scene_shapes(scene); ++i) {
        if (!is_lamp(scene, i, enclosing)) continue;
        const BpMaterial *material = bp_pilot_material(scene, i);
        const double y = bp_luminance_of(material->emit), r = radius_of(scene, i);
        const double weight = y * y * r * r / sum * (double)room;
        below += weight;
        if (count > room && below < next) continue;
        BpPilotLight *light = &aim->lights[aim->light_count++];
        *light = (BpPilotLight){
            .seen = true, .disc = SIZE_MAX, .shape = i, .share = count > room && weight < 1 ? 1 / weight : 1};
        light->radius = r;
        memcpy(light->radiance, material->emit, sizeof light->radiance);
        bp_pilot_ball(scene, i, light->place);
        next = floor(below + 0.5) + 0.5;
        if (aim->light_count == BP_PILOT_LIGHTS_MAX) return;
    }
}

static BpStatus find_lights(const BpScene *scene, BpPilotAim *aim, BpError *err) {
    aim->lights = calloc(BP_PILOT_LIGHTS_MAX, sizeof *aim->lights);
    if (aim->lights == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for the lights of a pilot");
    for (size_t i = 0; i < scene->disc_count; ++i) add_disc(scene, i, aim);
    const size_t room = (BP_PILOT_LIGHTS_MAX - aim->light_count) / 2;
    if (scene->environment != NULL && bp_environment_varies(scene->environment)) add_texels(scene, room, aim);
    add_lamps(scene, room, aim);
    return BP_OK;
}

/* ---- pairs ---- */

/* Whether the shape has a lobe that is narrow, and that some light is smaller than such. */
static bool has_narrow_lobe(const BpScene *scene, const BpPilotAim *aim, size_t shape) {
    if (!(bp_pilot_lobe_width(bp_pilot_material(scene, shape)) > 0)) return false;
    double center[3];
    bp_pilot_ball(scene, shape, center);
    for (size_t l = 0; l < aim->light_count; ++l)
        if (bp_pilot_half_angle(&aim->lights[l], center) < BP_PILOT_SMALL) return true;
    return false;
}

static bool is_target(const BpScene *scene, const BpPilotAim *aim, size_t shape) {
    return bp_pilot_is_specular(scene, shape) || has_narrow_lobe(scene, aim, shape);
}

static BpStatus find_targets(const BpScene *scene, BpPilotAim *aim, BpError *err) {
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    size_t capacity = 0;
    for (size_t i = 0; i < bp_scene_shapes(scene); ++i) {
        double center[3];
        const double radius = bp_pilot_ball(scene, i, center);
        for (int a = 0; a < 3; ++a) {
            low[a] = fmin(low[a], center[a] - radius);
            high[a] = fmax(high[a], center[a] + radius);
        }
        if (!is_target(scene, aim, i)) continue;
        if (aim->target_count == capacity) {
            capacity = capacity + capacity / 2 + 64;
            uint32_t *const targets = realloc(aim->targets, capacity * sizeof *targets);
            if (targets == NULL)
                return bp_fail(err, BP_ERR_MEMORY, "out of memory for %zu specular shapes", capacity);
            aim->targets = targets;
        }
        aim->targets[aim->target_count++] = (uint32_t)i;
    }
    for (int a = 0; a < 3 && bp_scene_shapes(scene) > 0; ++a) aim->middle[a] = 0.5 * (low[a] + high[a]);
    aim->reach = bp_scene_shapes(scene) > 0 ? 0.5 * sqrt(bp_distance2(low, high)) : 0;
    return BP_OK;
}

/* The area x solid angle x cosine of all rays from the light to the target, roughly, times the square of what
 * each brings: by so much they add to the variance of a picture. */
static double importance(const BpScene *scene, const BpPilotAim *aim, const BpPilotPair *pair) {
    const BpPilotLight *const light = &aim->lights[pair->light];
    const double y = bp_luminance_of(light->radiance);
    double center[3];
    const double radius = bp_pilot_ball(scene, aim->targets[pair->target], center);
    double extent = 2 * PI * light->cap * PI * radius * radius;
    if (!light->distant) {
        const double away = fmax(bp_distance2(center, light->place), radius * radius);
        extent = PI * light->radius * light->radius * PI * radius * radius / away;
    }
    const double width = bp_pilot_lobe_width(bp_pilot_material(scene, aim->targets[pair->target]));
    if (width > 0) extent *= fmin(1, pow(bp_pilot_half_angle(light, center) / width, 2));
    return light->share * y * y * extent;
}

/* Pairs of all lights with all targets. */
static void pair_all(BpPilotAim *aim) {
    for (uint32_t l = 0; l < aim->light_count; ++l)
        for (uint32_t t = 0; t < aim->target_count; ++t)
            aim->pairs[aim->pair_count++] = (BpPilotPair){.light = l, .target = t, .share = 1};
}

/* As many as there is room for: the targets at random, each light as often as every other. */
static void pair_some(BpPilotAim *aim) {
    BpRandom random = {.state = 1};
    const double all = (double)aim->light_count * (double)aim->target_count;
    for (uint32_t i = 0; i < BP_PILOT_PAIRS_MAX; ++i) {
        const uint32_t t = (uint32_t)(bp_random_next(&random) * (double)aim->target_count);
        aim->pairs[aim->pair_count++] = (BpPilotPair){
            .light = i % (uint32_t)aim->light_count, .target = t, .share = all / BP_PILOT_PAIRS_MAX};
    }
}

/* Half of the paths by importance, so that what matters is well known, half to all pairs alike, so that
 * nothing is missed whose importance was wrong. */
static BpStatus make_pairs(const BpScene *scene, BpPilotAim *aim, BpError *err) {
    const bool all = aim->target_count <= BP_PILOT_PAIRS_MAX / aim->light_count;
    const size_t room = all ? aim->light_count * aim->target_count : BP_PILOT_PAIRS_MAX;
    aim->pairs = malloc(room * sizeof *aim->pairs);
    aim->bounds = malloc(room * sizeof *aim->bounds);
    if (aim->pairs == NULL || aim->bounds == NULL)
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for %zu pairs of lights and shapes", room);
    if (all)
        pair_all(aim);
    else
        pair_some(aim);
    double sum = 0, below = 0;
    for (size_t i = 0; i < room; ++i) {
        BpPilotPair *pair = &aim->pairs[i];
        pair->probability = importance(scene, aim, pair);
        sum += pair->probability;
    }
    for (size_t i = 0; i < room; ++i) {
        BpPilotPair *pair = &aim->pairs[i];
        pair->probability = 0.5 * (sum > 0 ? pair->probability / sum : 1 / (double)room) + 0.5 / (double)room;
        aim->bounds[i] = below;
        below += pair->probability;
    }
    return BP_OK;
}

double bp_pilot_half_angle(const BpPilotLight *light, const double point[3]) {
    if (light->distant) return sqrt(2 * light->cap);
    return light->radius / fmax(sqrt(bp_distance2(light->place, point)), light->radius);
}

bool bp_pilot_is_sampled(const BpScene *scene, const BpPilotLight *light, uint32_t shape, uint32_t vertices) {
    if (!bp_pilot_is_sphere(scene, shape) || vertices > bp_focuser_vertices(scene, shape)) return false;
    if (light->distant) return light->disc != SIZE_MAX && bp_focuses_disc(scene, shape, light->disc);
    return !bp_pilot_is_triangle(scene, light->shape) && bp_focuses_lamp(scene, shape, light->shape);
}

BpStatus bp_pilot_aim(const BpScene *scene, BpPilotAim *aim, BpError *err) {
    *aim = (BpPilotAim){0};
    BpStatus status = find_lights(scene, aim, err);
    if (status == BP_OK && aim->light_count > 0) status = find_targets(scene, aim, err);
    if (status == BP_OK && aim->light_count > 0 && aim->target_count > 0)
        status = make_pairs(scene, aim, err);
    if (status != BP_OK) bp_pilot_aim_clear(aim);
    return status;
}

void bp_pilot_aim_clear(BpPilotAim *aim) {
    free(aim->lights);
    free(aim->targets);
    free(aim->pairs);
    free(aim->bounds);
    *aim = (BpPilotAim){0};
}

/* ---- paths ---- */

/* A point of the unit disk, by rejection: no sine and cosine, which differ between libraries. */
static void disk(BpRandom *random, double point[2]) {
    do {
        point[0] = 2 * bp_random_next(random) - 1;
        point[1] = 2 * bp_random_next(random) - 1;
    } while (point[0] * point[0] + point[1] * point[1] > 1);
}

/* A direction, uniform in the cap around `axis` of 1 - cos `cap`. */
static void in_cap(BpRandom *random, const double axis[3], double cap, double direction[3]) {
    double u[3], v[3], point[2];
    bp_across(axis, u, v);
    disk(random, point);
    const double part = point[0] * point[0] + point[1] * point[1], m = part * cap;
    const double scale = part > 0 ? sqrt(cap * (2 - m)) : 0; /* sine of the angle over the root of `part` */
    for (int a = 0; a < 3; ++a)
        direction[a] = (1 - m) * axis[a] + scale * (point[0] * u[a] + point[1] * v[a]);
    bp_normalize(direction);
}

/* A direction by the cosine around `normal`. */
static void by_cosine(BpRandom *random, const double normal[3], double direction[3]) {
    double u[3], v[3], point[2];
    bp_across(normal, u, v);
    disk(random, point);
    const double up = sqrt(fmax(0, 1 - point[0] * point[0] - point[1] * point[1]));
    for (int a = 0; a < 3; ++a) direction[a] = up * normal[a] + point[0] * u[a] + point[1] * v[a];
    bp_normalize(direction);
}

/* The area x solid angle of the ray that it starts. */
static double start_distant(const BpPilotAim *aim, const BpPilotLight *light, const double center[3],
                            double radius, BpRandom *random, BpPilotStart *start) {
    double toward[3], u[3], v[3], point[2];
    in_cap(random, light->place, light->cap, toward);
    bp_across(toward, u, v);
    disk(random, point);
    const double far = aim->reach + sqrt(bp_distance2(aim->middle, center)) + radius;
    for (int a = 0; a < 3; ++a) {
        start->direction[a] = -toward[a];
        start->origin[a] = center[a] + far * toward[a] + radius * (point[0] * u[a] + point[1] * v[a]);
    }
    return 2 * PI * light->cap * PI * radius * radius;
}

/* A ray that begins so far above the lamp, in radii, does not meet it. */
#define ABOVE 0x1p-10

/* The area x solid angle x cosine of the ray that it starts; 0 where it would begin into the lamp. */
static double start_lamp(const BpPilotLight *light, const double center[3], double radius, BpRandom *random,
                         BpPilotStart *start) {
    double axis[3], normal[3];
    for (int a = 0; a < 3; ++a) axis[a] = center[a] - light->place[a];
    const double away = bp_normalize(axis);
    if (!(away > 0)) axis[0] = 1, axis[1] = axis[2] = 0;
    /* Those of its points see the sphere whose tangent plane does not lie before all of it. */
    const double seeing = fmin(2, 1 + (radius - light->radius) / fmax(away, DBL_MIN));
    in_cap(random, axis, fmax(seeing, 0), normal);
    const double area =
        2 * PI * fmax(seeing, 0) * light->radius * light->radius; /* 0: the sphere is inside */
    for (int a = 0; a < 3; ++a) {
        start->origin[a] = light->place[a] + light->radius * (1 + ABOVE) * normal[a];
        axis[a] = center[a] - start->origin[a];
    }
    const double distance = bp_normalize(axis);
    if (distance <= radius) { /* from inside */
        by_cosine(random, normal, start->direction);
        return area * PI;
    }
    const double sine = radius / distance, cap = sine * sine / (1 + sqrt(fmax(0, 1 - sine * sine)));
    in_cap(random, axis, cap, start->direction);
    return area * 2 * PI * cap * fmax(0, bp_dot(start->direction, normal));
}

/* A point of a triangle, uniform. */
static void in_triangle(BpRandom *random, const BpTriangle *triangle, double point[3]) {
    double u = bp_random_next(random), v = bp_random_next(random);
    if (u + v > 1) {
        u = 1 - u;
        v = 1 - v;
    }
    for (int a = 0; a < 3; ++a)
        point[a] = (1 - u - v) * triangle->vertices[0][a] + u * triangle->vertices[1][a] +
                   v * triangle->vertices[2][a];
}

/* The area x solid angle x cosine of the ray that it starts, from either side of the triangle. */
static double start_triangle(const BpScene *scene, const BpPilotLight *light, const double center[3],
                             double radius, BpRandom *random, BpPilotStart *start) {
    const BpTriangle *const triangle = bp_pilot_triangle(scene, light->shape);
    double normal[3], axis[3];
    const double area = bp_pilot_area(triangle, normal);
    double measure = area * 2 * PI; /* all that leaves it, by the cosine */
    in_triangle(random, triangle, start->origin);
    for (int a = 0; a < 3; ++a) axis[a] = center[a] - start->origin[a];
    const double distance = bp_normalize(axis);
    if (distance <= radius) {
        const double side = bp_random_next(random) < 0.5 ? -1 : 1;
        for (int a = 0; a < 3; ++a) normal[a] *= side;
        by_cosine(random, normal, start->direction);
    } else {
        const double sine = radius / distance, cap = sine * sine / (1 + sqrt(fmax(0, 1 - sine * sine)));
        in_cap(random, axis, cap, start->direction);
        measure = area * 2 * PI * cap * fabs(bp_dot(start->direction, normal));
    }
    for (int a = 0; a < 3; ++a) start->origin[a] += ABOVE * light->radius * start->direction[a];
    return measure;
}

static size_t choose_pair(const BpPilotAim *aim, double number) {
    size_t low = 0, high = aim->pair_count;
    while (high - low > 1) {
        const size_t middle = low + (high - low) / 2;
        if (aim->bounds[middle] <= number)
            low = middle;
        else
            high = middle;
    }
    return low;
}

void bp_pilot_start(const BpScene *scene, const BpPilotAim *aim, size_t count, BpRandom *random,
                    BpPilotStart *start) {
    *start = (BpPilotStart){.pair = (uint32_t)choose_pair(aim, bp_random_next(random))};
    const BpPilotPair *pair = &aim->pairs[start->pair];
    const BpPilotLight *light = &aim->lights[pair->light];
    double center[3];
    const double radius = bp_pilot_ball(scene, aim->targets[pair->target], center);
    const double extent = light->distant ? start_distant(aim, light, center, radius, random, start)
                          : bp_pilot_is_triangle(scene, light->shape)
                              ? start_triangle(scene, light, center, radius, random, start)
                              : start_lamp(light, center, radius, random, start);
    start->measure = extent * light->share * pair->share / (pair->probability * (double)count);
}
