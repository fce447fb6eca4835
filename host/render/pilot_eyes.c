/* pilot_eyes.c: the camera's paths of a pilot: to the first rough point, and past lights.
 *
 * In:    a scene, a device.
 * Out:   the rough points, the rays behind mirrors, glass and narrow lobes, and lights seen directly.
 * Knows: how far apart paths are.   Does not know: what light comes from elsewhere. */
#include "pilot_shapes.h"
#include "pilot_state.h"

#include "base/hash.h"
#include "scene/vector.h"

#include <math.h>
#include <string.h>

#define PI 3.14159265358979323846
#define EYES 32768u /* paths, and how many a pixel has at most */
#define EYES_OF_PIXEL 64u
#define SEGMENTS 8u    /* to the first rough point, or none is found */
#define NEAR_EYES 16.0 /* rough points within the radius of one, in the mean */

double bp_pilot_pixel_extent(const BpCamera *camera) {
    const double side = bp_camera_plane_height(camera) / camera->height;
    const bool parallel = camera->projection == BP_ORTHOGRAPHIC;
    return parallel ? side * side : side * side / (camera->focus_dist * camera->focus_dist);
}

BpPilotPlan bp_pilot_plan(const BpCamera *camera) {
    const uint64_t pixels = (uint64_t)camera->width * camera->height;
    BpPilotPlan plan = {.side = 1};
    while (pixels / ((uint64_t)plan.side * plan.side) > EYES) ++plan.side;
    plan.width = (camera->width + plan.side - 1) / plan.side;
    plan.height = (camera->height + plan.side - 1) / plan.side;
    const uint32_t of_square = EYES / (plan.width * plan.height);
    plan.of_pixel = of_square < 1 ? 1 : of_square > EYES_OF_PIXEL ? EYES_OF_PIXEL : of_square;
    plan.extent = bp_pilot_pixel_extent(camera) * plan.side * plan.side / plan.of_pixel;
    return plan;
}

/* The pixel of one of a square's paths: the one in the middle, or several that lie apart. */
static uint32_t pixel_of(const BpPilotPlan *plan, const BpCamera *camera, uint32_t square, uint32_t path) {
    uint32_t x = square % plan->width * plan->side + (plan->side / 2 + path) % plan->side;
    uint32_t y = square / plan->width * plan->side + (2 * path + 1) * plan->side / (2 * plan->of_pixel);
    if (x >= camera->width) x = camera->width - 1;
    if (y >= camera->height) y = camera->height - 1;
    return y * camera->width + x;
}

/* The probability with which the pixel of a path that passes the light meets it: one that comes within some
 * distance meets it by its share of that. 0: it does not come near, or the light is so large that samples
 * find it. */
static double chance_of(const BpPilotLight *light, const BpPilotSegment *segment, double near,
                        bool parallel) {
    const bool met = (segment->flags & PILOT_MET) != 0;
    double along = 0, off2 = 0;
    if (light->share > 1) return 0;
    if (light->distant) {
        const double near2 = near * near, size2 = 2 * light->cap;
        off2 = bp_distance2(segment->direction, light->place);
        return met || parallel || !light->seen || size2 >= near2 || off2 > near2 ? 0 : size2 / near2;
    }
    for (int a = 0; a < 3; ++a) {
        const double origin = segment->point[a] - (met ? segment->distance * segment->direction[a] : 0);
        along += (light->place[a] - origin) * segment->direction[a];
        off2 += (light->place[a] - origin) * (light->place[a] - origin);
    }
    off2 -= along * along;
    if (!parallel) near *= along;
    const bool hidden = met && segment->shape != light->shape && segment->distance < along;
    if (along <= 0 || hidden || light->radius >= near || off2 > near * near) return 0;
    return light->radius * light->radius / (near * near);
}

static bool meets(const BpPilotLight *light, const BpPilotSegment *segment) {
    const bool met = (segment->flags & PILOT_MET) != 0;
    if (!light->distant) return met && segment->shape == light->shape;
    return !met && light->seen && bp_dot(segment->direction, light->place) > 1 - light->cap;
}

/* Lights by which the path passes before it meets anything, and those that it meets. */
static void pass_directly(BpPilot *pilot, const BpPilotSegment *segment, size_t square) {
    const bool parallel = pilot->scene->camera.projection == BP_ORTHOGRAPHIC;
    const double near = 2 * sqrt(pilot->plan.extent);
    for (size_t i = 0; i < pilot->aim->light_count && pilot->max_depth > 0; ++i) {
        const BpPilotLight *light = &pilot->aim->lights[i];
        const double chance = chance_of(light, segment, near, parallel);
        pilot->hits[i] += meets(light, segment);
        if (chance > 0)
            bp_pilot_add(&pilot->parts.chance, square, light->radiance, chance / pilot->plan.of_pixel,
                         bp_pilot_way_direct(pilot->scene));
    }
}

static void keep_ray(BpPilot *pilot, const BpPilotSegment *segment, const double carried[3], double odds,
                     uint32_t s, size_t square, const BpPilotMet *before, uint64_t way) {
    const bool met = (segment->flags & PILOT_MET) != 0;
    if (s + 1 > pilot->max_depth || pilot->ray_count == pilot->ray_room) return;
    BpPilotRay *ray = &pilot->rays[pilot->ray_count];
    *ray = (BpPilotRay){.number = (uint32_t)pilot->ray_count++,
                        .length = met ? segment->distance : INFINITY,
                        .way = way,
                        .share = odds / pilot->plan.of_pixel,
                        .pixel = (uint32_t)square,
                        .shape = segment->shape,
                        .through = before->shapes[0],
                        .met = *before};
    memcpy(ray->direction, segment->direction, sizeof ray->direction);
    memcpy(ray->carried, carried, sizeof ray->carried);
    for (int a = 0; a < 3; ++a)
        ray->origin[a] = segment->point[a] - (met ? segment->distance * segment->direction[a] : 0);
}

/* At a narrow lobe, the ray that a smooth surface would have sent on; what stands there, that of the lobe
 * meets. */
static void keep_glint(BpPilot *pilot, const BpPilotSegment *segment, const BpPilotSegment *next, uint32_t s,
                       size_t square, uint64_t way) {
    const BpScene *scene = pilot->scene;
    const double back[3] = {-segment->direction[0], -segment->direction[1], -segment->direction[2]};
    BpPilotTurn turn;
    bp_pilot_turn_at(scene, segment, back, &turn);
    const uint32_t refracts = bp_dot(next->direction, turn.normal) < 0;
    if (!bp_pilot_turn_smooth(refracts != 0, &turn)) return;
    BpPilotSegment smooth = *next;
    const bool met = (next->flags & PILOT_MET) != 0;
    memcpy(smooth.direction, turn.to_light, sizeof smooth.direction);
    for (int a = 0; a < 3; ++a)
        smooth.point[a] = segment->point[a] + (met ? next->distance : 0) * turn.to_light[a];
    way =
        bp_hash_bytes(bp_hash_bytes(way, &segment->shape, sizeof segment->shape), &refracts, sizeof refracts);
    const size_t before = pilot->ray_count;
    const BpPilotMet lobe = {.shapes = {segment->shape}}; /* nothing that rays through focusers pass */
    keep_ray(pilot, &smooth, segment->throughput, segment->odds, s + 1, square, &lobe, way);
    if (pilot->ray_count == before) return;
    pilot->rays[before].lobe = true;
    pilot->rays[before].turn = turn;
}

/* How far apart paths are that began beside each other, and how fast that grows along them. */
typedef struct Spread {
    double width, slope;
} Spread;

static Spread first_spread(const BpPilot *pilot) {
    const double side = sqrt(pilot->plan.extent);
    const bool parallel = pilot->scene->camera.projection == BP_ORTHOGRAPHIC;
    const Spread spread = {.width = parallel ? side : 0, .slope = parallel ? 0 : side};
    return spread;
}

/* Behind a surface: what is curved spreads them, or gathers them, which counts as if it spread them too. */
static void spread_at(const BpScene *scene, const BpPilotSegment *segment, const BpPilotSegment *next,
                      const double normal[3], Spread *spread) {
    if (bp_pilot_is_triangle(scene, segment->shape)) return;
    const BpCapsule *const capsule = bp_shape_capsule(scene, segment->shape);
    const double radius = capsule != NULL ? capsule->radius : fabs(scene->spheres[segment->shape].radius);
    const double cosine = fmax(fabs(bp_dot(segment->direction, normal)), 0.2);
    const bool reflected = bp_dot(next->direction, normal) > 0;
    spread->slope += spread->width / (radius * cosine) * (reflected ? 2 : 0.5);
}

static void keep_eye(BpPilot *pilot, const BpPilotSegment *segment, uint32_t s, size_t square, double width) {
    const BpScene *scene = pilot->scene;
    BpPilotEye *eye = &pilot->eyes[pilot->eye_count];
    *eye = (BpPilotEye){.pixel = (uint32_t)square,
                        .share = segment->odds / pilot->plan.of_pixel,
                        .shape = segment->shape,
                        .object = bp_pilot_object(scene, segment->shape),
                        .segments = s + 1};
    memcpy(eye->point, segment->point, sizeof eye->point);
    memcpy(eye->throughput, segment->throughput, sizeof eye->throughput);
    bp_pilot_normal(scene, segment, eye->normal);
    for (int a = 0; a < 3; ++a) eye->outgoing[a] = -segment->direction[a];
    eye->index = bp_pilot_index_behind(scene, segment, eye->normal);
    const double along = bp_dot(segment->direction, eye->normal);
    eye->radius = width * sqrt(NEAR_EYES / PI / fmax(-along, 0.1));
    if (eye->radius > 0 && isfinite(eye->radius)) ++pilot->eye_count;
}

/* One camera path: lights that it passes, and the rough point where it ends. */
static void follow_eye(BpPilot *pilot, const BpPilotFlight *flight, uint32_t path, size_t square) {
    const BpScene *scene = pilot->scene;
    Spread spread = first_spread(pilot);
    BpPilotMet met = {0};
    double begins[3] = {0};
    uint64_t way = BP_HASH_START;
    BpPilotSegment segment, next;
    for (uint32_t s = 0; bp_pilot_segment(flight, path, SEGMENTS, s, &segment); ++s) {
        double carried[3];
        const double odds = bp_pilot_carried(flight, path, SEGMENTS, s, carried);
        if (s == 0) memcpy(begins, segment.direction, sizeof begins);
        const size_t before = pilot->ray_count;
        if (met.count > 0)
            keep_ray(pilot, &segment, carried, odds, s, square, &met, way);
        else if (s == 0)
            pass_directly(pilot, &segment, square);
        if (pilot->ray_count > before) memcpy(pilot->rays[before].begins, begins, sizeof begins);
        if ((segment.flags & (PILOT_MET | PILOT_IN_MEDIUM)) != PILOT_MET) return;
        spread.width += spread.slope * segment.distance;
        if (bp_pilot_is_rough(scene, &segment)) {
            keep_eye(pilot, &segment, s, square, spread.width);
            if (bp_pilot_lobe_width(bp_pilot_material_at(scene, &segment)) > 0 &&
                bp_pilot_segment(flight, path, SEGMENTS, s + 1, &next))
                keep_glint(pilot, &segment, &next, s, square, way);
            return;
        }
        if (!bp_pilot_is_surface(scene, &segment) || !bp_pilot_segment(flight, path, SEGMENTS, s + 1, &next))
            continue;
        bp_pilot_meet(&met, segment.shape);
        double normal[3];
        bp_pilot_normal(scene, &segment, normal);
        spread_at(scene, &segment, &next, normal, &spread);
        const uint32_t turn[2] = {segment.shape, bp_dot(next.direction, normal) > 0};
        way = bp_hash_bytes(way, turn, sizeof turn);
    }
}

BpStatus bp_pilot_trace_eyes(BpPilot *pilot, BpPilotFlight *flight, BpError *err) {
    const BpPilotPlan *plan = &pilot->plan;
    const uint32_t total = plan->width * plan->height * plan->of_pixel;
    for (uint32_t first = 0; first < total; first += flight->batch) {
        const uint32_t count = total - first < flight->batch ? total - first : flight->batch;
        for (uint32_t i = 0; i < count; ++i) {
            flight->number_data[2 * i] = pixel_of(plan, &pilot->scene->camera, (first + i) / plan->of_pixel,
                                                  (first + i) % plan->of_pixel);
            flight->number_data[2 * i + 1] = (first + i) % plan->of_pixel;
        }
        BP_TRY(bp_pilot_fly(flight, count, SEGMENTS, true, err));
        for (uint32_t i = 0; i < count; ++i) follow_eye(pilot, flight, i, (first + i) / plan->of_pixel);
    }
    return BP_OK;
}
