/* focusers.c: see focusers.h. */
#ifndef BP_HOST
#define BP_HOST
#endif
#include "focusers.h"

#include "base/color.h"
#include "base/plural.h"
#include "base/status.h"
#include "lamp_tree.h"
#include "reals.h"
#include "scene/material.h"
#include "scene_types.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846

/* By how much of its angle, seen from the focuser, a target is aimed at as if it were larger: what rounding
 * may displace a ray by. Targets that fill less than SMALLEST are not aimed at. */
#define BEYOND 0x1p-18
#define SMALLEST 0x1p-17

/* Lights whose angular radius, seen from the focuser, has a larger sine are found by chance in so many
 * samples that rays to them cost more than the noise that they take away (docs/LIGHTS.md). */
#define LARGEST 0.25

/* Balls count as touching where the square of their distance is no larger than that of their radii by this.
 */
#define TOUCHING (1 + 0x1p-8)

/* No chain of a mirror has to do with its index, but the formulas want one above 1. */
#define MIRROR_INDEX 2

/* Up to this index, a chain with a reflection inside turns by more than Newton's method can tell
 * (light/focusers.cl): asin(1 / index) must be at most a quarter of half a turn. */
#define INSIDE_INDEX_MIN 1.42

static bool is_mirror(const BpScene *scene, size_t i) {
    const BpMaterial *material = &scene->materials[scene->spheres[i].material];
    return material->kind == BP_MATERIAL_METAL && !(material->fuzz > 0);
}

/* Glass whose index is nearly that of its outside bends nothing: it does not focus. Nor does, for rays to
 * lamps, what lets a share of light straight on. */
static bool is_focuser(const BpScene *scene, size_t i) {
    const BpMaterial *material = &scene->materials[scene->spheres[i].material];
    return bp_material_opacity(material) == 1 && !bp_shape_emits(scene, i) &&
           (is_mirror(scene, i) || bp_sphere_refraction_index(scene, i) > 1.001);
}

static double distance(const double a[3], const double b[3]) {
    return hypot(hypot(a[0] - b[0], a[1] - b[1]), a[2] - b[2]);
}

/* What a focuser catches of a lamp's light: its radiance times the squared sine of half the angle that it
 * fills; 0 if it is no target. */
static double caught_of_lamp(const BpScene *scene, size_t focuser, size_t lamp) {
    const BpSphere *a = &scene->spheres[focuser], *b = &scene->spheres[lamp];
    const double apart = distance(a->center, b->center), radius = fabs(b->radius);
    if (!((fabs(a->radius) + radius) * (1 + 0x1p-10) < apart) ||
        !(radius > SMALLEST * apart && radius <= LARGEST * apart))
        return 0;
    return bp_luminance_of(scene->materials[b->material].emit) * (radius / apart) * (radius / apart);
}

static double caught_of_disc(const BpDisc *disc) {
    const double half = disc->half_angle_degrees * (PI / 180);
    return half > SMALLEST && sin(half) <= LARGEST ? bp_luminance_of(disc->radiance) * sin(half) * sin(half)
                                                   : 0;
}

/* The spheres that focus and those that are lamps, in the scene's order; more than there is room for are
 * counted only. */
typedef struct Found {
    size_t focuser_count, lamp_count, disc_count;
    size_t focusers[BP_FOCUSERS_MAX], lamps[BP_FOCUSER_LAMPS_MAX];
} Found;

static void find_all(const BpScene *scene, Found *found) {
    const size_t enclosing = bp_enclosing_lamp(scene);
    *found = (Found){0};
    for (size_t i = 0; i < scene->sphere_count; ++i) {
        if (bp_sphere_is_sampled(scene, i, enclosing)) {
            if (found->lamp_count < BP_FOCUSER_LAMPS_MAX) found->lamps[found->lamp_count] = i;
            ++found->lamp_count;
        } else if (is_focuser(scene, i)) {
            if (found->focuser_count < BP_FOCUSERS_MAX) found->focusers[found->focuser_count] = i;
            ++found->focuser_count;
        }
    }
    for (size_t d = 0; d < scene->disc_count; ++d) found->disc_count += caught_of_disc(&scene->discs[d]) > 0;
}

bool bp_focuses_lamp(const BpScene *scene, size_t sphere, size_t lamp) {
    return is_focuser(scene, sphere) && caught_of_lamp(scene, sphere, lamp) > 0;
}

bool bp_focuses_disc(const BpScene *scene, size_t sphere, size_t disc) {
    return is_focuser(scene, sphere) && caught_of_disc(&scene->discs[disc]) > 0;
}

/* It focuses one of the lamps or discs. */
static bool has_target(const BpScene *scene, const Found *found, size_t focuser) {
    if (found->disc_count > 0) return true;
    for (size_t l = 0; l < found->lamp_count; ++l)
        if (caught_of_lamp(scene, focuser, found->lamps[l]) > 0) return true;
    return false;
}

/* What the second brings to the first, where `caught` is what it catches; 0 if they touch. The kernel says
 * the same (pair_power in focusers.cl). */
static double led_on(const BpScene *scene, size_t first, size_t second, double caught) {
    const BpSphere *a = &scene->spheres[first], *b = &scene->spheres[second];
    const double apart = distance(a->center, b->center), radii = fabs(a->radius) + fabs(b->radius);
    return apart * apart > radii * radii * TOUCHING ? caught / (apart * apart) : 0;
}

bool bp_focuses_pair(const BpScene *scene, size_t first, size_t second) {
    return is_focuser(scene, first) && is_focuser(scene, second) && led_on(scene, first, second, 1) > 0;
}

bool bp_focusers_pair(const BpScene *scene) {
    Found found;
    find_all(scene, &found);
    if (found.focuser_count > BP_FOCUSERS_MAX || found.lamp_count > BP_FOCUSER_LAMPS_MAX) return false;
    for (size_t a = 0; a < found.focuser_count; ++a)
        for (size_t b = 0; b < found.focuser_count; ++b)
            if (has_target(scene, &found, found.focusers[a]) &&
                has_target(scene, &found, found.focusers[b]) &&
                bp_focuses_pair(scene, found.focusers[a], found.focusers[b]))
                return true;
    return false;
}

bool bp_focusers_light_camera(const BpCamera *camera) {
    return camera->projection == BP_PERSPECTIVE && camera->pixel_sampling == BP_PIXEL_SQUARE;
}

uint32_t bp_focuser_vertices(const BpScene *scene, size_t sphere) {
    return is_mirror(scene, sphere)                                       ? 1
           : bp_sphere_refraction_index(scene, sphere) > INSIDE_INDEX_MIN ? 4
                                                                          : 2;
}

static bool has_motion(const BpScene *scene) {
    for (size_t i = 0; i < scene->moving_count; ++i)
        if (bp_sphere_moves(scene, i)) return true;
    return false;
}

bool bp_focusers_explain(const BpScene *scene, size_t size, char *reason) {
    Found found;
    find_all(scene, &found);
    const size_t count = found.focuser_count, lights = found.lamp_count + found.disc_count;
    if (count == 0) {
        snprintf(reason, size, "no ball of glass and no mirror among the spheres");
    } else if (count > BP_FOCUSERS_MAX) {
        snprintf(reason, size, "%zu balls of glass and mirrors; up to %d are tried", count, BP_FOCUSERS_MAX);
    } else if (found.lamp_count > BP_FOCUSER_LAMPS_MAX) {
        snprintf(reason, size, "%zu lamps; through glass and off mirrors, up to %d are tried",
                 found.lamp_count, BP_FOCUSER_LAMPS_MAX);
    } else if (bp_scene_has_media(scene)) {
        snprintf(reason, size, "left to chance where there are media");
    } else if (has_motion(scene)) {
        snprintf(reason, size, "left to chance where spheres move");
    } else if (scene->triangle_count > 0) {
        snprintf(reason, size, "left to chance where there are triangles");
    } else if (scene->capsule_count > 0) {
        snprintf(reason, size, "left to chance where there are capsules");
    } else {
        size_t pairs = 0;
        for (size_t f = 0; f < count; ++f) {
            pairs += found.disc_count;
            for (size_t l = 0; l < found.lamp_count; ++l)
                pairs += caught_of_lamp(scene, found.focusers[f], found.lamps[l]) > 0;
        }
        if (pairs == 0)
            snprintf(reason, size, "no lamp and no disc is small, seen from a ball of glass or a mirror");
        else
            snprintf(reason, size, "where they pay: %zu ball%s of glass or mirror%s, %zu light%s", count,
                     bp_plural(count), bp_plural(count), lights, bp_plural(lights));
        return pairs > 0;
    }
    return false;
}

/* As reals of the device's precision. NULL: out of memory. */
static void *narrow(const double *values, size_t count, bool single) {
    void *array = malloc(count * (single ? sizeof(float) : sizeof(double)));
    for (size_t i = 0; i < count && array != NULL; ++i) bp_reals_store(array, single, i, values[i]);
    return array;
}

static uint32_t slot_of(const BpTree *tree, size_t sphere) {
    const size_t slots = (size_t)tree->leaf_count * tree->width;
    for (size_t slot = 0; slot < slots; ++slot)
        if (tree->slot_sphere[slot] == sphere) return (uint32_t)slot;
    return NO_SLOT;
}

/* How often each chain is tried, by its chords. Little light is reflected off glass, and less inside, but it
 * is spread widely, so it would be seen as noise if it were found too rarely. */
static void set_chains(const BpMaterial *material, double index, double chains[4]) {
    if (material->kind == BP_MATERIAL_METAL) {
        chains[0] = 1;
    } else if (material->fresnel == BP_FRESNEL_NONE) {
        chains[1] = 1;
    } else {
        chains[2] = index > INSIDE_INDEX_MIN ? 0.125 : 0;
        chains[3] = chains[2] / 2;
        chains[0] = 0.25;
        chains[1] = 1 - chains[0] - chains[2] - chains[3];
    }
}

/* cos of what is left of half a turn beside the most that three chords turn by: 6 r - 2 i where 3 cos(i) is
 * index times cos(r). */
static double turn_left(double index) {
    const double sine = sqrt(fmax(0, 9 - index * index) / 8);
    return -cos(6 * asin(fmin(1, sine / index)) - 2 * asin(fmin(1, sine)));
}

/* The targets of a focuser, appended, and their shares of the light that it catches, which is returned. */
static double add_targets(const BpScene *scene, const Found *found, size_t focuser, const double origin[3],
                          const BpTree *tree, PackedTarget *targets, uint32_t *lamps, uint32_t *count) {
    const BpSphere *ball = &scene->spheres[focuser];
    const uint32_t first = *count;
    double sum = 0;
    for (size_t l = 0; l < found->lamp_count; ++l) {
        const double caught = caught_of_lamp(scene, focuser, found->lamps[l]);
        const BpSphere *lamp = &scene->spheres[found->lamps[l]];
        if (!(caught > 0)) continue;
        /* A line that touches both leaves the line of their centres by no more than this sine. */
        const double apart = distance(ball->center, lamp->center);
        const double sine = (fabs(ball->radius) + fabs(lamp->radius)) / apart;
        PackedTarget *target = &targets[*count];
        *target = (PackedTarget){.share = caught};
        for (int a = 0; a < 3; ++a) target->centre[a] = lamp->center[a] - origin[a];
        target->extent = fabs(lamp->radius) / sqrt((1 - sine) * (1 + sine)) + BEYOND * apart;
        lamps[*count] = slot_of(tree, found->lamps[l]);
        sum += caught;
        ++*count;
    }
    for (size_t d = 0; d < scene->disc_count; ++d) {
        const BpDisc *disc = &scene->discs[d];
        const double caught = caught_of_disc(disc);
        if (!(caught > 0)) continue;
        const double half = fmin(disc->half_angle_degrees * (PI / 180) + BEYOND, PI), s = sin(half / 2);
        const double zero[3] = {0, 0, 0}, length = distance(disc->direction, zero);
        PackedTarget *target = &targets[*count];
        *target = (PackedTarget){.share = caught, .extent = 2 * s * s};
        for (int a = 0; a < 3; ++a) target->centre[a] = disc->direction[a] / length;
        lamps[*count] = DISC_SLOT + (uint32_t)d;
        sum += caught;
        ++*count;
    }
    for (uint32_t t = first; t < *count; ++t) targets[t].share /= sum;
    return sum;
}

BpStatus bp_focusers_build(const BpScene *scene, const double origin[3], const BpTree *tree, bool wanted,
                           BpFocusers *focusers, BpError *err) {
    char reason[160];
    Found found = {0};
    *focusers = (BpFocusers){0};
    if (wanted && bp_focusers_explain(scene, sizeof reason, reason)) find_all(scene, &found);
    const size_t most = found.focuser_count * (found.lamp_count + scene->disc_count) + 1;
    PackedFocuser table[BP_FOCUSERS_MAX + 1];
    PackedTarget *targets = calloc(most, sizeof *targets);
    focusers->target_lamps = calloc(most, sizeof *focusers->target_lamps);
    focusers->focuser_places = calloc(BP_FOCUSERS_MAX + 1, sizeof(PackedFocuserPlace));
    memset(table, 0, sizeof table);
    bool complete = targets != NULL && focusers->target_lamps != NULL && focusers->focuser_places != NULL;
    size_t numbers[BP_FOCUSERS_MAX];
    uint32_t count = 0, target_count = 0;
    double brightest = 0;
    for (size_t f = 0; f < found.focuser_count && complete; ++f) {
        const size_t i = found.focusers[f];
        const BpSphere *sphere = &scene->spheres[i];
        const BpMaterial *material = &scene->materials[sphere->material];
        const uint32_t first = target_count;
        const double caught =
            add_targets(scene, &found, i, origin, tree, targets, focusers->target_lamps, &target_count);
        if (target_count == first) continue;
        PackedFocuser *focuser = &table[count];
        for (int a = 0; a < 3; ++a) focuser->centre[a] = sphere->center[a] - origin[a];
        focuser->radius = fabs(sphere->radius);
        focuser->power = caught * sphere->radius * sphere->radius;
        focuser->refraction_index = is_mirror(scene, i) ? MIRROR_INDEX : bp_sphere_refraction_index(scene, i);
        set_chains(material, focuser->refraction_index, focuser->chains);
        focuser->turn = turn_left(focuser->refraction_index) + BEYOND;
        brightest = fmax(brightest, focuser->power);
        const uint32_t variant =
            is_mirror(scene, i) ? FOCUSER_MIRROR : bp_member_choice(material, BP_MEMBER_FRESNEL);
        const PackedFocuserPlace place = {slot_of(tree, i), variant, first, target_count - first};
        memcpy(focusers->focuser_places + FOCUSER_UINTS * count, &place, sizeof place);
        numbers[count] = i;
        ++count;
    }
    for (uint32_t f = 0; f < count; ++f) table[f].power /= brightest; /* only shares matter */
    for (uint32_t a = 0; a < count; ++a)
        for (uint32_t b = 0; b < count; ++b)
            table[a].pair_power +=
                table[a].radius * table[a].radius * led_on(scene, numbers[a], numbers[b], table[b].power);
    if (complete) {
        focusers->focuser_places[FOCUSER_UINTS * count + FOCUSER_SLOT] = NO_SLOT;
        focusers->focuser_count = count + 1;
        focusers->target_count = target_count + 1;
        const size_t reals = (size_t)focusers->focuser_count * FOCUSER_REALS;
        const size_t target_reals = (size_t)focusers->target_count * TARGET_REALS;
        focusers->focusers = narrow((const double *)table, reals, tree->single_precision);
        focusers->targets = narrow((const double *)targets, target_reals, tree->single_precision);
        complete = focusers->focusers != NULL && focusers->targets != NULL;
    }
    free(targets);
    if (complete) return BP_OK;
    bp_focusers_clear(focusers);
    return bp_fail(err, BP_ERR_MEMORY, "no memory for the table of focusers");
}

void bp_focusers_clear(BpFocusers *focusers) {
    free(focusers->focusers);
    free(focusers->focuser_places);
    free(focusers->targets);
    free(focusers->target_lamps);
    *focusers = (BpFocusers){0};
}
