/* pilot_photons.c: the paths of a pilot that come from lights: by way of something specular to rough points.
 *
 * In:    a scene, a device.
 * Out:   the light that comes to rough points, and the measure for which it stands.
 * Knows: what surfaces do to beams of light, and to paths that come the other way.
 * Does not know: where the camera stands. */
#include "pilot_lobes.h"
#include "pilot_pairs.h"
#include "pilot_shapes.h"
#include "pilot_state.h"

#include "packed/reals.h"
#include "scene/vector.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Schlick's reflectance as the book uses it, which is not the same both ways. */
static double schlick(double cosine, double index) {
    const double root = (1 - index) / (1 + index), r0 = root * root;
    const double m = 1 - cosine, m2 = m * m;
    return r0 + (1 - r0) * m2 * m2 * m;
}

/* What passing the surface does to the measure of light: beams narrow as they enter what is dense, and a path
 * that comes the other way takes this turn with another probability than light does. `next`: the segment
 * behind it. */
static double transmitted(const BpScene *scene, const BpPilotSegment *segment, const BpPilotSegment *next) {
    const BpMaterial *material = bp_pilot_material_at(scene, segment);
    double normal[3], outward[3];
    bp_pilot_normal(scene, segment, normal);
    const double before = -bp_dot(segment->direction, normal), behind = -bp_dot(next->direction, normal);
    const bool glass =
        material->kind == BP_MATERIAL_DIELECTRIC || material->kind == BP_MATERIAL_ROUGH_DIELECTRIC;
    if (!glass || behind <= 0) return 1; /* reflected */
    bp_pilot_outward(scene, segment->shape, segment->point, segment->time, outward);
    const double inside = bp_pilot_index_inside(scene, segment->shape);
    const double ratio =
        bp_dot(normal, outward) > 0 ? 1 / inside : inside; /* index before over index behind */
    double measure = ratio * ratio;
    if (material->kind == BP_MATERIAL_DIELECTRIC && material->fresnel == BP_FRESNEL_SCHLICK && ratio != 1) {
        const double light = 1 - schlick(fmin(before, 1), ratio), path = 1 - schlick(fmin(behind, 1), ratio);
        measure *= light > 1e-6 ? path / light : 0;
    }
    return measure;
}

/* What being scattered by a rough surface does to it: nothing where the lobe is the cosine. */
static double scattered(const BpScene *scene, const BpPilotSegment *segment, const BpPilotSegment *next) {
    const BpMaterial *material = bp_pilot_material_at(scene, segment);
    double normal[3], back[3];
    if (material->kind == BP_MATERIAL_ROUGH_DIELECTRIC) return transmitted(scene, segment, next);
    if (material->kind != BP_MATERIAL_METAL && material->scatter == BP_SCATTER_LAMBERTIAN) return 1;
    bp_pilot_normal(scene, segment, normal);
    for (int a = 0; a < 3; ++a) back[a] = -segment->direction[a];
    const double arrives = bp_dot(back, normal), leaves = bp_dot(next->direction, normal);
    if (material->kind == BP_MATERIAL_METAL) return arrives > 0 ? leaves / arrives : 0; /* as in glints() */
    const double drawn = bp_pilot_density(material, normal, next->direction);
    if (!(arrives > 0 && leaves > 0 && drawn > 0)) return 0;
    return bp_pilot_density(material, normal, back) / arrives * leaves / drawn;
}

/* Light that has come straight to a narrow lobe: what a ray to it would bring, over what the light does. */
static double glints(const BpPilot *pilot, const BpPilotLight *light, const BpPilotSegment *segment,
                     const BpPilotSegment *next, double *measure) {
    const BpScene *scene = pilot->scene;
    const BpMaterial *material = bp_pilot_material_at(scene, segment);
    BpPilotTurn turn;
    bp_pilot_turn_at(scene, segment, next->direction, &turn);
    for (int a = 0; a < 3; ++a) turn.to_light[a] = -segment->direction[a];
    bp_normalize(turn.to_light);
    const BpPilotAim *aim = pilot->aim;
    double mean, part = bp_pilot_glint(scene, aim->lights, aim->light_count, light, material, &turn, &mean);
    const double arrives = fabs(bp_dot(turn.to_light, turn.normal));
    const double leaves = bp_dot(turn.leaves, turn.normal);
    *measure *= transmitted(scene, segment, next);
    /* Fuzz has the same density both ways, so it is not reciprocal. */
    if (material->kind == BP_MATERIAL_METAL) *measure *= leaves / arrives;
    /* The picture's path chooses the coat by its reflectance where that path comes from. */
    if (material->kind == BP_MATERIAL_GLOSSY)
        part *= bp_pilot_reflectance(arrives, material->refraction_index) /
                bp_pilot_reflectance(leaves, material->refraction_index);
    if (!(part > 0 && arrives > 0)) return *measure = 0;
    *measure /= part;
    return part;
}

/* Whether rays to lamps find the light that has come so to a rough point. */
static bool is_focused(const BpScene *scene, const BpPilotLight *light, BpPilotMet met,
                       const BpPilotSegment *segment) {
    double back[3];
    for (int a = 0; a < 3; ++a) back[a] = -segment->direction[a];
    bp_normalize(back);
    bp_pilot_met_turn_round(&met);
    return bp_pilot_is_found(scene, light, &met, segment->point, back);
}

/* One path from a light, which counts where it comes to rough points. */
static void follow_photon(BpPilot *pilot, const BpPilotFlight *flight, uint32_t path,
                          const BpPilotStart *start) {
    const BpScene *scene = pilot->scene;
    const BpPilotPair *pair = &pilot->aim->pairs[start->pair];
    const BpPilotLight *light = &pilot->aim->lights[pair->light];
    const uint32_t target = pilot->aim->targets[pair->target];
    double measure = start->measure;
    uint32_t deposits = 0;
    BpPilotMet met = {0}; /* up to the first rough point */
    bool aimed = false, focused = false;
    double part = 1; /* of the light's radiance */
    BpPilotSegment segment, next;
    for (uint32_t s = 0; bp_pilot_segment(flight, path, BP_PILOT_SEGMENTS_MAX, s, &segment) && measure > 0;
         ++s) {
        if ((segment.flags & (PILOT_MET | PILOT_IN_MEDIUM)) != PILOT_MET) return;
        if (!bp_pilot_is_surface(scene, &segment)) continue;
        if (!aimed && segment.shape != target) return;
        const bool rough = bp_pilot_is_rough(scene, &segment), lobe = rough && !aimed;
        aimed = true;
        if (!rough && deposits == 0) bp_pilot_meet(&met, segment.shape);
        if (lobe) {
            met.others = true;
            if (!bp_pilot_segment(flight, path, BP_PILOT_SEGMENTS_MAX, s + 1, &next)) return;
            part = glints(pilot, light, &segment, &next, &measure);
            continue;
        }
        if (rough && deposits == 0) focused = is_focused(scene, light, met, &segment);
        if (rough) {
            BpPilotPhoton *photon = &pilot->photons[pilot->photon_count++];
            double carried[3];
            const double odds = bp_pilot_carried(flight, path, BP_PILOT_SEGMENTS_MAX, s, carried);
            *photon = (BpPilotPhoton){.measure = measure * odds,
                                      .object = bp_pilot_object(scene, segment.shape),
                                      .segments = s + 1,
                                      .through = bp_pilot_way(scene, target),
                                      .focused = focused};
            memcpy(photon->point, segment.point, sizeof photon->point);
            memcpy(photon->direction, segment.direction, sizeof photon->direction);
            bp_pilot_normal(scene, &segment, photon->normal);
            for (int c = 0; c < 3; ++c) photon->radiance[c] = part * light->radiance[c] * carried[c];
            if (++deposits == BP_PILOT_DEPOSITS) return;
        }
        if (!bp_pilot_segment(flight, path, BP_PILOT_SEGMENTS_MAX, s + 1, &next)) return;
        measure *= rough ? scattered(scene, &segment, &next) : transmitted(scene, &segment, &next);
    }
}

static void write_start(const BpPilotFlight *flight, const BpPilotStart *start, size_t path) {
    const bool single = flight->worker->real_size == sizeof(float);
    for (int a = 0; a < 3; ++a) {
        const double place = start->origin[a] - flight->origin[a];
        const double high = single ? (double)(float)place : place;
        const size_t first = path * PILOT_START_REALS + (size_t)a;
        bp_reals_store(flight->start_data, single, first, high);
        bp_reals_store(flight->start_data, single, first + 3, place - high);
        bp_reals_store(flight->start_data, single, first + 6, start->direction[a]);
    }
}

BpStatus bp_pilot_trace_photons(BpPilot *pilot, BpPilotFlight *flight, BpError *err) {
    BpRandom random = {.state = 2};
    BpPilotStart *starts = malloc(flight->batch * sizeof *starts);
    if (starts == NULL) return bp_fail(err, BP_ERR_MEMORY, "no memory for the paths of a pilot");
    BpStatus status = BP_OK;
    for (uint32_t first = 0; first < BP_PILOT_PHOTONS && status == BP_OK; first += flight->batch) {
        const uint32_t left = BP_PILOT_PHOTONS - first, count = left < flight->batch ? left : flight->batch;
        for (uint32_t i = 0; i < count; ++i) {
            bp_pilot_start(pilot->scene, pilot->aim, BP_PILOT_PHOTONS, &random, &starts[i]);
            write_start(flight, &starts[i], i);
            flight->number_data[2 * i] = first + i;
            flight->number_data[2 * i + 1] = UINT32_MAX; /* a sample that no camera path has */
        }
        status = bp_pilot_fly(flight, count, BP_PILOT_SEGMENTS_MAX, false, err);
        for (uint32_t i = 0; i < count && status == BP_OK; ++i) follow_photon(pilot, flight, i, &starts[i]);
    }
    free(starts);
    return status;
}
