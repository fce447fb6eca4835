/* pilot.c: see pilot.h. */
#include "pilot.h"

#include "base/clock.h"
#include "base/status.h"
#include "packed/focusers.h"
#include "pilot_shapes.h"
#include "pilot_state.h"
#include "scene/vector.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846

/* Whether camera rays may miss the light, though its image is in a pixel. */
static bool is_small(const BpCamera *camera, const BpPilotLight *light) {
    const double extent = bp_pilot_pixel_extent(camera);
    const bool parallel = camera->projection == BP_ORTHOGRAPHIC;
    if (light->distant) return light->seen && !parallel && 2 * PI * light->cap < extent;
    const double away2 = bp_distance2(light->place, camera->lookfrom);
    return PI * light->radius * light->radius < (parallel ? extent : extent * away2);
}

bool bp_pilot_is_needed(const BpScene *scene, const BpPilotAim *aim) {
    bool rare = aim->pair_count > 0;
    for (size_t i = 0; i < aim->light_count; ++i) rare = rare || is_small(&scene->camera, &aim->lights[i]);
    return rare;
}

static bool sums_create(size_t squares, size_t ways, BpPilotSums *sums) {
    sums->pixels = squares;
    sums->mean = calloc(squares, sizeof *sums->mean);
    sums->square = calloc(squares, sizeof *sums->square);
    sums->by_way = calloc(ways, sizeof *sums->by_way);
    return sums->mean != NULL && sums->square != NULL && sums->by_way != NULL;
}

static void sums_clear(BpPilotSums *sums) {
    free(sums->mean);
    free(sums->square);
    free(sums->by_way);
}

static void sums_add(BpPilotSums *to, const BpPilotSums *from, size_t ways) {
    for (size_t i = 0; i < to->pixels; ++i) {
        to->mean[i] += from->mean[i];
        to->square[i] += from->square[i];
    }
    for (size_t i = 0; i < ways; ++i) to->by_way[i] += from->by_way[i];
    for (int c = 0; c < 3; ++c) to->square_of[c] += from->square_of[c];
}

static BpStatus pilot_create(const BpScene *scene, const BpPilotAim *aim, uint32_t max_depth, BpPilot *pilot,
                             BpError *err) {
    *pilot =
        (BpPilot){.scene = scene, .max_depth = max_depth, .aim = aim, .plan = bp_pilot_plan(&scene->camera)};
    const size_t squares = (size_t)pilot->plan.width * pilot->plan.height;
    const bool has_sums = sums_create(squares, bp_pilot_ways(scene), &pilot->parts.chance) &&
                          sums_create(squares, bp_pilot_ways(scene), &pilot->parts.focused);
    pilot->hits = calloc(aim->light_count + 1, sizeof *pilot->hits);
    pilot->eyes = malloc(squares * pilot->plan.of_pixel * sizeof *pilot->eyes);
    pilot->ray_room = squares * pilot->plan.of_pixel * 4;
    pilot->rays = malloc(pilot->ray_room * sizeof *pilot->rays);
    pilot->photons = malloc((size_t)BP_PILOT_PHOTONS * BP_PILOT_DEPOSITS * sizeof *pilot->photons);
    if (!has_sums || pilot->hits == NULL || pilot->eyes == NULL || pilot->rays == NULL ||
        pilot->photons == NULL)
        return bp_fail(err, BP_ERR_MEMORY, "no memory for a pilot of %zu pixels", squares);
    return BP_OK;
}

static void pilot_clear(BpPilot *pilot) {
    sums_clear(&pilot->parts.chance);
    sums_clear(&pilot->parts.focused);
    free(pilot->hits);
    free(pilot->eyes);
    free(pilot->rays);
    free(pilot->photons);
}

/* The shapes by way of which most of the noise comes. */
static void report_ways(const BpScene *scene, const BpPilotSums *sums, double total, BpUnseenLight *report) {
    const double *of_material = sums->by_way + scene->sphere_count + 1;
    double most = 0;
    report->direct = sums->by_way[bp_pilot_way_direct(scene)] / total;
    for (size_t m = 0; m < scene->material_count; ++m) {
        report->triangles += of_material[m] / total;
        if (of_material[m] > most) report->triangle_material = m;
        most = fmax(most, of_material[m]);
    }
    for (size_t i = 0; i < scene->sphere_count; ++i) {
        const double part = sums->by_way[i] / total;
        size_t place = report->sphere_count;
        if (!(part > 0)) continue;
        while (place > 0 && report->parts[place - 1] < part) --place;
        if (place == BP_UNSEEN_SPHERES) continue;
        if (report->sphere_count < BP_UNSEEN_SPHERES) ++report->sphere_count;
        for (size_t k = report->sphere_count - 1; k > place; --k) {
            report->parts[k] = report->parts[k - 1];
            report->spheres[k] = report->spheres[k - 1];
        }
        report->parts[place] = part;
        report->spheres[place] = i;
    }
}

static BpStatus give(const BpPilot *pilot, BpUnseen **unseen, BpUnseenLight *report, BpError *err) {
    const BpPilotSums *sums = &pilot->parts.chance;
    const BpCamera *camera = &pilot->scene->camera;
    const BpPilotPlan *plan = &pilot->plan;
    const size_t pixels = (size_t)camera->width * camera->height;
    double total = 0;
    for (size_t i = 0; i < sums->pixels; ++i) {
        report->mean += sums->mean[i] / (double)sums->pixels;
        total += sums->square[i];
    }
    if (!(total > 0)) return BP_OK;
    report->square = total / (double)sums->pixels;
    report->found = report->mean * report->mean / report->square;
    report_ways(pilot->scene, sums, total, report);
    BP_TRY(bp_unseen_create(pixels, unseen, err));
    for (size_t i = 0; i < pixels; ++i) {
        const size_t square = i / camera->width / plan->side * plan->width + i % camera->width / plan->side;
        (*unseen)->pixels[i] = (BpUnseenPixel){(float)sums->mean[square], (float)sums->square[square]};
    }
    for (int c = 0; c < 3; ++c) (*unseen)->tint[c] = (float)(sums->square_of[c] / total);
    return BP_OK;
}

BpStatus bp_pilot_run(BpWorker *worker, const BpScene *scene, const BpPilotAim *aim, uint32_t max_depth,
                      BpCaustics *caustics, BpUnseen **unseen, BpUnseenLight *report, BpError *err) {
    const double start = bp_clock_seconds();
    BpPilot pilot;
    BpPilotFlight flight = {0};
    *unseen = NULL;
    *report = (BpUnseenLight){0};
    BP_TRY(bp_worker_wait_for_all(worker, err));
    BpStatus status = pilot_create(scene, aim, max_depth, &pilot, err);
    if (status == BP_OK) status = bp_pilot_flight_create(worker, scene, &flight, err);
    if (status == BP_OK) status = bp_pilot_trace_eyes(&pilot, &flight, err);
    if (status == BP_OK && pilot.aim->pair_count > 0) status = bp_pilot_trace_photons(&pilot, &flight, err);
    if (status == BP_OK)
        status = bp_pilot_join(scene, pilot.eyes, pilot.eye_count, pilot.photons, pilot.photon_count,
                               max_depth, &pilot.parts, err);
    if (status == BP_OK) {
        bp_pilot_pass(scene, bp_focusers_light_camera(&scene->camera), aim->lights, aim->light_count,
                      pilot.rays, pilot.ray_count, &pilot.parts);
        if (*caustics == BP_CAUSTICS_AUTO)
            *caustics = bp_pilot_focusing_pays(&pilot) ? BP_CAUSTICS_ON : BP_CAUSTICS_OFF;
        if (*caustics == BP_CAUSTICS_OFF)
            sums_add(&pilot.parts.chance, &pilot.parts.focused, bp_pilot_ways(scene));
        status = give(&pilot, unseen, report, err);
    }
    bp_pilot_flight_clear(&flight);
    pilot_clear(&pilot);
    report->seconds = bp_clock_seconds() - start;
    return status;
}
