/* scene_sets.c: see scene_sets.h. */
#include "scene_sets.h"

#include "named_file.h"
#include "rows.h"
#include "scene_medium.h"

#include "scene/scene_fault.h"

#include <math.h>
#include <string.h>

static const char *name_of(const BpSphereSet *set) {
    return set->name != NULL ? set->name : "the spheres";
}

static BpStatus check_set(const BpSphereSet *set, BpError *err) {
    const BpRows *const all[] = {&set->center, &set->radius, &set->color};
    static const char *const what[] = {"center", "radius", "color"};
    for (size_t i = 0; i < BP_COUNT(all); i++) {
        const bool missing = all[i]->data == NULL && set->count > 0 && all[i] != &set->color;
        if (missing || (all[i]->type != BP_NUMBER_FLOAT && all[i]->type != BP_NUMBER_DOUBLE))
            return bp_fail(err, BP_ERR_USAGE, "%s: %s: found %s, expected numbers", name_of(set), what[i],
                           missing ? "nothing" : "an unknown type of number");
    }
    return BP_OK;
}

static BpStatus read_spheres(const BpSphereSet *set, uint32_t material, bool colored, BpScene *scene,
                             BpError *err) {
    for (size_t i = 0; i < set->count; i++) {
        BpSphere *const sphere = &scene->spheres[scene->sphere_count];
        BpFault fault;
        for (int c = 0; c < 3; c++) sphere->center[c] = bp_rows_number(&set->center, i, c);
        sphere->radius = bp_rows_number(&set->radius, i, 0);
        sphere->material = material;
        sphere->albedo = colored ? (uint32_t)scene->albedo_count : BP_NO_ALBEDO;
        if (bp_sphere_find_fault(sphere, &fault))
            return bp_fail(err, BP_ERR_SCENE, "sphere %zu (from 0) of %s: %s: %s", i, name_of(set),
                           fault.member, fault.text);
        if (colored)
            BP_TRY(bp_rows_color(&set->color, i, "sphere", name_of(set),
                                 scene->albedos[scene->albedo_count++], err));
        scene->sphere_count++;
    }
    return BP_OK;
}

/* Room for all of them at once. */
static BpStatus make_room(const BpShapeSets *shapes, BpScene *scene, BpError *err) {
    size_t count = scene->sphere_count, colors = scene->albedo_count;
    for (size_t s = 0; s < shapes->sphere_set_count; s++) {
        const BpSphereSet *const set = &shapes->spheres[s];
        BP_TRY(check_set(set, err));
        if (set->count > BP_SPHERES_MAX || count > BP_SPHERES_MAX - set->count)
            return bp_fail(err, BP_ERR_SCENE, "%s: found more than %u spheres, expected fewer", name_of(set),
                           BP_SPHERES_MAX);
        count += set->count;
        if (set->color.data != NULL) colors += set->count;
    }
    BpSphere *const spheres = realloc(scene->spheres, (count + 1) * sizeof *spheres);
    if (spheres != NULL) scene->spheres = spheres;
    float(*const albedos)[3] = realloc(scene->albedos, (colors + 1) * sizeof *albedos);
    if (albedos != NULL) scene->albedos = albedos;
    if (spheres == NULL || albedos == NULL)
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for %zu spheres", count);
    return BP_OK;
}

/* In two dimensions, as files of particles are: those in one plane are seen from the front. */
static bool is_flat(const BpSphere *spheres, size_t count) {
    for (size_t i = 1; i < count; i++)
        if (spheres[i].center[2] != spheres[0].center[2]) return false;
    return count > 2;
}

BpStatus bp_add_sphere_sets(const BpMaterialIndex *index, const BpShapeSets *shapes, BpScene *scene,
                            BpError *err) {
    if (shapes->sphere_set_count == 0) return BP_OK;
    const size_t first = scene->sphere_count;
    BP_TRY(make_room(shapes, scene, err));
    for (size_t s = 0; s < shapes->sphere_set_count; s++) {
        const BpSphereSet *const set = &shapes->spheres[s];
        const size_t before = scene->sphere_count;
        uint32_t material = 0, interior = 0;
        BP_TRY(bp_material_of_set(index, set->material, name_of(set), scene, &material, err));
        BP_TRY(bp_medium_of_set(set->interior, name_of(set), scene, &interior, err));
        const bool colored =
            set->color.data != NULL && bp_material_has(scene->materials[material].kind, BP_MEMBER_ALBEDO);
        BP_TRY(bp_keep_point_file(name_of(set), scene->sphere_count, NULL, scene, err));
        scene->point_files[scene->point_file_count - 1].in_memory = true;
        BP_TRY(read_spheres(set, material, colored, scene, err));
        BP_TRY(bp_fill_interiors(interior, before, scene->sphere_count, &scene->interiors,
                                 &scene->interior_count, err));
    }
    scene->has_particles = true;
    scene->flat |= is_flat(scene->spheres + first, scene->sphere_count - first);
    return BP_OK;
}
