/* line_sets.c: see line_sets.h. */
#include "line_sets.h"

#include "named_file.h"
#include "rows.h"
#include "scene_medium.h"

#include "scene/capsule_rules.h"
#include "scene/material.h"

#include <stdlib.h>

static const char *name_of(const BpLineSet *set) {
    return set->name != NULL ? set->name : "the lines";
}

static bool is_colored(const BpLineSet *set) {
    return set->color[0].data != NULL || set->color[1].data != NULL;
}

static BpStatus check_set(const BpLineSet *set, BpError *err) {
    const bool points = set->line_count == 0 || bp_rows_are_numbers(&set->point),
               radii = set->line_count == 0 || bp_rows_are_numbers(&set->radius);
    const bool colors =
        !is_colored(set) || (bp_rows_are_numbers(&set->color[0]) && bp_rows_are_numbers(&set->color[1]));
    if (!points || !radii || !colors)
        return bp_fail(err, BP_ERR_USAGE, "%s: found no numbers for %s, expected some", name_of(set),
                       !points  ? "points"
                       : !radii ? "radii"
                                : "the colours of both ends");
    if (set->line_count > BP_SPHERES_MAX)
        return bp_fail(err, BP_ERR_SCENE, "%s: found more than %u lines, expected fewer", name_of(set),
                       BP_SPHERES_MAX);
    if (set->line == NULL && set->point_count != 2 * set->line_count)
        return bp_fail(err, BP_ERR_USAGE, "%s: found %zu points for %zu lines, expected two for each",
                       name_of(set), set->point_count, set->line_count);
    return BP_OK;
}

/* Room for all of them at once. */
static BpStatus make_room(const BpShapeSets *shapes, BpScene *scene, BpError *err) {
    size_t count = scene->capsule_count, colors = scene->albedo_count;
    for (size_t s = 0; s < shapes->line_set_count; s++) {
        const BpLineSet *const set = &shapes->lines[s];
        BP_TRY(check_set(set, err));
        if (count > BP_SPHERES_MAX - set->line_count)
            return bp_fail(err, BP_ERR_SCENE, "%s: found more than %u lines, expected fewer", name_of(set),
                           BP_SPHERES_MAX);
        count += set->line_count;
        if (is_colored(set)) colors += 2 * set->line_count;
    }
    BpCapsule *const capsules = realloc(scene->capsules, (count + 1) * sizeof *capsules);
    if (capsules != NULL) scene->capsules = capsules;
    float(*const albedos)[3] = realloc(scene->albedos, (colors + 1) * sizeof *albedos);
    if (albedos != NULL) scene->albedos = albedos;
    if (capsules == NULL || albedos == NULL)
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for %zu lines", count);
    return BP_OK;
}

static BpStatus read_ends(const BpLineSet *set, size_t i, BpCapsule *capsule, BpError *err) {
    for (size_t k = 0; k < 2; k++) {
        const size_t point = set->line != NULL ? set->line[2 * i + k] : 2 * i + k;
        if (point >= set->point_count)
            return bp_fail(err, BP_ERR_SCENE,
                           "line %zu (from 0) of %s: found point %zu, expected one of %zu, counted from 0", i,
                           name_of(set), point, set->point_count);
        for (int a = 0; a < 3; a++) capsule->ends[k][a] = bp_rows_number(&set->point, point, a);
    }
    return BP_OK;
}

/* One entry for both halves where they have the same colour. */
static BpStatus read_colors(const BpLineSet *set, size_t i, BpScene *scene, BpCapsule *capsule,
                            BpError *err) {
    float(*const halves)[3] = &scene->albedos[scene->albedo_count];
    for (int k = 0; k < 2; k++)
        BP_TRY(bp_rows_color(&set->color[k], i, "line", name_of(set), halves[k], err));
    bool same = true;
    for (int c = 0; c < 3; c++) same = same && halves[0][c] == halves[1][c];
    capsule->albedo[0] = (uint32_t)scene->albedo_count;
    capsule->albedo[1] = capsule->albedo[0] + !same;
    scene->albedo_count += same ? 1 : 2;
    return BP_OK;
}

static BpStatus add_set(const BpLineSet *set, const BpMaterialIndex *index, BpScene *scene, BpError *err) {
    const size_t first = scene->capsule_count;
    uint32_t material = 0, interior = 0;
    BpFault fault;
    BP_TRY(bp_material_of_set(index, set->material, name_of(set), scene, &material, err));
    BP_TRY(bp_medium_of_set(set->interior, name_of(set), scene, &interior, err));
    if (bp_capsule_material_fault(scene, material, &fault))
        return bp_fail(err, BP_ERR_SCENE, "%s: %s: %s", name_of(set), fault.member, fault.text);
    const bool colored =
        is_colored(set) && bp_material_has(scene->materials[material].kind, BP_MEMBER_ALBEDO);
    BP_TRY(bp_keep_line_set(name_of(set), scene->capsule_count, scene, err));
    for (size_t i = 0; i < set->line_count; i++) {
        BpCapsule *const capsule = &scene->capsules[scene->capsule_count];
        *capsule = (BpCapsule){.material = material, .albedo = {BP_NO_ALBEDO, BP_NO_ALBEDO}};
        BP_TRY(read_ends(set, i, capsule, err));
        capsule->radius = bp_rows_number(&set->radius, i, 0);
        if (bp_capsule_place_fault(capsule, &fault))
            return bp_fail(err, BP_ERR_SCENE, "line %zu (from 0) of %s: %s: %s", i, name_of(set),
                           fault.member, fault.text);
        if (colored) BP_TRY(read_colors(set, i, scene, capsule, err));
        scene->capsule_count++;
    }
    return bp_fill_interiors(interior, first, scene->capsule_count, &scene->capsule_interiors,
                             &scene->capsule_interior_count, err);
}

/* As of spheres that a caller hands over: lines in one plane are seen from the front, unless something else
 * that the camera is fitted to stands before it or behind. */
static bool is_flat(const BpScene *scene, size_t first) {
    size_t triangle = 0, end = 0;
    bp_scene_particle_triangles(scene, &triangle, &end);
    const bool beside =
        scene->sphere_count > scene->particle_first || first > scene->listed_capsules || end > triangle;
    if (first == scene->capsule_count) return scene->flat;
    if (beside && !scene->flat) return false;
    const double level = scene->sphere_count > scene->particle_first
                             ? scene->spheres[scene->particle_first].center[2]
                             : scene->capsules[first].ends[0][2];
    for (size_t i = first; i < scene->capsule_count; i++)
        for (int k = 0; k < 2; k++)
            if (scene->capsules[i].ends[k][2] < level || scene->capsules[i].ends[k][2] > level) return false;
    return true;
}

BpStatus bp_add_line_sets(const BpMaterialIndex *index, const BpShapeSets *shapes, BpScene *scene,
                          BpError *err) {
    if (shapes->line_set_count == 0) return BP_OK;
    const size_t first = scene->capsule_count;
    BP_TRY(make_room(shapes, scene, err));
    for (size_t s = 0; s < shapes->line_set_count; s++) BP_TRY(add_set(&shapes->lines[s], index, scene, err));
    scene->has_particles = true;
    scene->flat = is_flat(scene, first);
    return BP_OK;
}
