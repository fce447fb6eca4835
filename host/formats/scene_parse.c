/* scene_parse.c: from the text of a scene document to a BpScene; see scene_parse.h.
 *
 * Knows: the grammar's top level, materials by name, spheres. The rest: scene_camera.c, scene_background.c,
 * scene_texture.c, scene_material.c, scene_points.c; ranges: scene_validate.c, whose faults are given their
 * place in the text here. */
#include "scene_parse.h"

#include "base/input_file.h"
#include "particle_document.h"
#include "scene_changes.h"

#include "base/names.h"
#include "particles/particles.h"

#include "scene/fit.h"
#include "scene/lighting.h"
#include "scene/material.h"
#include "scene/scene_fault.h"
#include "scene/shadow_catcher.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static BpStatus parse_materials(const BpNode *node, BpScene *scene, BpError *err) {
    if (node->value != NULL && !json_is_object(node->value))
        return bp_node_wrong(
            node, "an object of named materials: { \"ground\": { \"type\": \"lambertian\", ... } }", err);
    const size_t count = json_object_size(node->value);
    scene->materials = calloc(count + 1, sizeof *scene->materials); /* one for particles */
    if (scene->materials == NULL)
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for %zu materials", count);
    const char *name;
    json_t *value;
    json_object_foreach(node->value, name, value) {
        const BpNode child = bp_node_member(node, name);
        BpMaterial *material = &scene->materials[scene->material_count++];
        BP_TRY(bp_copy_text(name, &material->name, err));
        BP_TRY(bp_parse_material(&child, scene, material, err));
    }
    return BP_OK;
}

/* ---- materials by name --------------------------------------------------------------------------------- */

static int compare_names(const void *a, const void *b) {
    return strcmp((*(const BpMaterial *const *)a)->name, (*(const BpMaterial *const *)b)->name);
}

static BpStatus index_materials(const BpScene *scene, BpMaterialIndex *index, BpError *err) {
    index->count = scene->material_count;
    index->first = scene->materials;
    index->by_name = malloc((index->count > 0 ? index->count : 1) * sizeof(BpMaterial *));
    if (index->by_name == NULL)
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for %zu materials", index->count);
    for (size_t i = 0; i < index->count; i++) index->by_name[i] = &scene->materials[i];
    qsort(index->by_name, index->count, sizeof(BpMaterial *), compare_names);
    return BP_OK;
}

BpStatus bp_missing_material_text(const BpMaterialIndex *index, const char *name,
                                  char out[BP_MISSING_NAME_SIZE], BpError *err) {
    const char **names = malloc((index->count + 1) * sizeof *names);
    if (names == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory");
    for (size_t i = 0; i < index->count; i++) names[i] = index->by_name[i]->name;
    bp_missing_name_text("material", "materials", names, index->count, name, out);
    free(names);
    return BP_OK;
}

uint32_t bp_material_find(const BpMaterialIndex *index, const char *name) {
    size_t low = 0, high = index->count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        const int order = strcmp(name, index->by_name[middle]->name);
        if (order == 0) return (uint32_t)(index->by_name[middle] - index->first);
        if (order < 0)
            high = middle;
        else
            low = middle + 1;
    }
    return UINT32_MAX;
}

BpStatus bp_parse_material_name(const BpNode *node, const BpMaterialIndex *index, uint32_t *material,
                                BpError *err) {
    const char *name = NULL;
    BP_TRY(bp_node_string(node, &name, err));
    const uint32_t found = bp_material_find(index, name);
    if (found == UINT32_MAX) {
        char text[BP_MISSING_NAME_SIZE];
        BP_TRY(bp_missing_material_text(index, name, text, err));
        return bp_node_fail(node, BP_PART_VALUE, err, "%s", text);
    }
    *material = found;
    return BP_OK;
}

/* ---- spheres ------------------------------------------------------------------------------------------- */

static BpStatus parse_sphere(const BpNode *node, const BpMaterialIndex *index, BpSphere *sphere,
                             BpError *err) {
    static const char *const names[] = {"center", "radius", "material", "center_end", "interior"};
    BP_TRY(bp_node_object(node, names, BP_COUNT(names), err));
    BP_TRY(bp_node_require(node, "center", "\"center\": [x, y, z]", err));
    BP_TRY(bp_node_require(node, "radius", "a number such as \"radius\": 0.5", err));
    BP_TRY(bp_node_require(node, "material", "a name from \"materials\"", err));
    const BpNode center = bp_node_member(node, "center");
    const BpNode radius = bp_node_member(node, "radius");
    const BpNode material = bp_node_member(node, "material");
    BP_TRY(bp_node_vector(&center, sphere->center, err));
    BP_TRY(bp_node_number(&radius, &sphere->radius, err));
    sphere->albedo = BP_NO_ALBEDO;
    return bp_parse_material_name(&material, index, &sphere->material, err);
}

/* Where the sphere `index`, of `count` that are listed, is when the shutter closes. */
static BpStatus parse_motion(const BpNode *node, size_t index, size_t count, BpScene *scene, BpError *err) {
    const BpNode end = bp_node_member(node, "center_end");
    if (end.value == NULL && scene->center_ends == NULL) return BP_OK;
    if (scene->center_ends == NULL) {
        scene->center_ends = malloc(count * sizeof *scene->center_ends);
        if (scene->center_ends == NULL)
            return bp_fail(err, BP_ERR_MEMORY, "out of memory for %zu motions", count);
        for (size_t i = 0; i < index; i++)
            memcpy(scene->center_ends[i], scene->spheres[i].center, sizeof scene->center_ends[i]);
    }
    memcpy(scene->center_ends[index], scene->spheres[index].center, sizeof scene->center_ends[index]);
    return bp_node_vector(&end, scene->center_ends[index], err);
}

/* What fills the sphere `index`, of `count` that are listed. */
static BpStatus parse_interior(const BpNode *node, size_t index, size_t count, BpScene *scene, BpError *err) {
    const BpNode interior = bp_node_member(node, "interior");
    if (interior.value == NULL) return BP_OK;
    if (scene->interiors == NULL) {
        scene->interiors = calloc(count, sizeof *scene->interiors);
        if (scene->interiors == NULL)
            return bp_fail(err, BP_ERR_MEMORY, "out of memory for %zu interiors", count);
    }
    return bp_parse_medium_name(&interior, scene, &scene->interiors[index], err);
}

static BpStatus parse_spheres(const BpNode *node, const BpMaterialIndex *index, BpScene *scene,
                              BpError *err) {
    BP_TRY(bp_node_list(
        node, "a list of spheres: [ { \"center\": [0, 0, -1], \"radius\": 0.5, \"material\": ... } ]", err));
    const size_t count = json_array_size(node->value);
    if (count == 0) return BP_OK;
    if (count > BP_SPHERES_MAX)
        return bp_node_fail(node, BP_PART_VALUE, err, "found %zu spheres, expected at most %u", count,
                            BP_SPHERES_MAX);
    scene->spheres = malloc(count * sizeof *scene->spheres);
    if (scene->spheres == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for %zu spheres", count);
    for (size_t i = 0; i < count; i++) {
        const BpNode element = bp_node_element(node, i);
        if (!json_is_object(element.value))
            return bp_node_wrong(&element,
                                 "an object: { \"center\": ..., \"radius\": ..., \"material\": ... }", err);
        BP_TRY(parse_sphere(&element, index, &scene->spheres[i], err));
        BP_TRY(parse_motion(&element, i, count, scene, err));
        BP_TRY(parse_interior(&element, i, count, scene, err));
    }
    scene->sphere_count = count;
    if (scene->center_ends != NULL) scene->moving_count = count;
    if (scene->interiors != NULL) scene->interior_count = count;
    return BP_OK;
}

/* ---- locating faults in the document ------------------------------------------------------------------ */

/* The member of `object` that is at fault, or the object where the member is absent (a default). */
static BpStatus fail_member(const BpNode *object, const char *member, const char *text, BpError *err) {
    const BpNode node = bp_node_member(object, member);
    if (node.value != NULL) return bp_node_fail(&node, BP_PART_VALUE, err, "%s", text);
    return bp_node_fail(object, BP_PART_VALUE, err, "%s: %s", member, text);
}

static BpStatus refuse_faults(const BpNode *root, const BpScene *scene, BpError *err) {
    BpFault fault;
    BP_TRY(bp_scene_find_fault(scene, &fault, err));
    const BpNode camera = bp_node_member(root, "camera");
    const BpNode background = bp_node_member(root, "background");
    const BpNode backdrop = bp_node_member(root, "backdrop");
    const BpNode textures = bp_node_member(root, "textures");
    const BpNode materials = bp_node_member(root, "materials");
    const BpNode spheres = bp_node_member(root, "spheres");
    const BpNode clouds = bp_node_member(root, "clouds");
    const size_t listed = json_array_size(spheres.value); /* the rest came from clouds */
    switch (fault.subject) {
    case BP_FAULT_NONE:
        return BP_OK;
    case BP_FAULT_CAMERA: {
        const char *member = fault.member;
        if (json_object_get(camera.value, member) ==
            NULL) { /* a default; what was written stands beside it */
            if (strcmp(member, "lookat") == 0) member = "lookfrom";
            if (strcmp(member, "aperture") == 0) member = "defocus_angle";
        }
        return fail_member(&camera, member, fault.text, err);
    }
    case BP_FAULT_BACKDROP:
        if (json_is_array(backdrop.value))
            return bp_node_fail(&backdrop, BP_PART_VALUE, err, "%s", fault.text);
        return fail_member(&backdrop, fault.member, fault.text, err);
    case BP_FAULT_BACKGROUND:
        if (json_is_array(background.value))
            return bp_node_fail(&background, BP_PART_VALUE, err, "%s", fault.text);
        return fail_member(&background, fault.member, fault.text, err);
    case BP_FAULT_DISC: {
        const BpNode discs = bp_node_member(&background, "discs");
        const BpNode disc = bp_node_element(&discs, fault.index);
        return fail_member(&disc, fault.member, fault.text, err);
    }
    case BP_FAULT_TEXTURE: {
        const BpNode texture = bp_node_member(&textures, scene->textures[fault.index].name);
        return fail_member(&texture, fault.member, fault.text, err);
    }
    case BP_FAULT_MEDIUM: {
        const BpNode media = bp_node_member(root, "media");
        const BpNode medium = bp_node_member(&media, scene->media[fault.index].name);
        return fail_member(&medium, fault.member, fault.text, err);
    }
    case BP_FAULT_MATERIAL: {
        const BpNode material = bp_node_member(&materials, scene->materials[fault.index].name);
        return fail_member(&material, fault.member, fault.text, err);
    }
    case BP_FAULT_SPHERE: {
        if (fault.index >= listed) break;
        const BpNode sphere = bp_node_element(&spheres, fault.index);
        return fail_member(&sphere, fault.member, fault.text, err);
    }
    case BP_FAULT_COINCIDENT: {
        /* The place of the error: the later of the two spheres that stands in the document itself, or else
         * the cloud that the later one comes from. */
        const size_t written = fault.index < listed ? fault.index : fault.other;
        char a[BP_SPHERE_NAME_SIZE], b[BP_SPHERE_NAME_SIZE];
        size_t cloud = scene->point_file_count;
        while (cloud > 0 && scene->point_files[cloud - 1].first > fault.index) --cloud;
        const BpNode sphere = bp_node_element(&spheres, written);
        if (written >= listed && scene->point_files[cloud - 1].in_memory) break; /* stands in no document */
        const BpNode particles = bp_node_member(root, "particles");
        const size_t place = cloud - (cloud > 0), cloud_count = json_array_size(clouds.value);
        const BpNode entry = place < cloud_count ? bp_node_element(&clouds, place)
                                                 : bp_node_element(&particles, place - cloud_count);
        return bp_node_fail(written < listed ? &sphere : &entry, BP_PART_VALUE, err, "%s and %s: %s",
                            bp_sphere_name(scene, fault.other, a), bp_sphere_name(scene, fault.index, b),
                            fault.text);
    }
    case BP_FAULT_ALBEDO:
        break;
    }
    return bp_scene_validate(scene, err);
}

/* ---- the whole ----------------------------------------------------------------------------------------- */

static BpStatus parse_head(const BpNode *root, BpScene *scene, BpError *err) {
    const BpNode format = bp_node_member(root, "format");
    const BpNode title_node = bp_node_member(root, "title");
    const BpNode source_node = bp_node_member(root, "source");
    const BpNode transfer_node = bp_node_member(root, "transfer");
    const BpNode schema = bp_node_member(root, "$schema"); /* for editors alone */
    const char *ignored = "";
    BP_TRY(bp_node_string(&schema, &ignored, err));
    if (format.value != NULL && !(json_is_number(format.value) && json_number_value(format.value) == 1))
        return bp_node_wrong(&format, "1, the only format that this version reads; a newer one may read it",
                             err);
    const char *title = "", *source = "";
    int transfer = (int)scene->transfer;
    BP_TRY(bp_node_string(&title_node, &title, err));
    BP_TRY(bp_node_string(&source_node, &source, err));
    BP_TRY(bp_node_choice(&transfer_node, bp_transfer_names, BP_TRANSFER_LINEAR + 1, &transfer, err));
    scene->transfer = (BpTransfer)transfer;
    BP_TRY(bp_copy_text(title, &scene->title, err));
    return bp_copy_text(source, &scene->source, err);
}

void bp_scene_view(BpScene *scene, double direction[3]) {
    BpCamera *const camera = &scene->camera;
    const bool asked = camera->fit_vup[0] != 0 || camera->fit_vup[1] != 0 || camera->fit_vup[2] != 0;
    int up = scene->up;
    for (int i = 0; i < 3 && asked; i++)
        if (fabs(camera->fit_vup[i]) > fabs(camera->fit_vup[up])) up = i;
    for (int i = 0; i < 3; i++) camera->vup[i] = asked ? camera->fit_vup[i] : i == up;
    if (scene->flat && !asked && camera->view == BP_VIEW_THREE_QUARTER)
        bp_view_direction(BP_VIEW_FRONT, up, direction); /* two dimensions have one good view */
    else if (camera->view == BP_VIEW_NONE)
        memcpy(direction, camera->view_direction, sizeof camera->view_direction);
    else
        bp_view_direction(camera->view, up, direction);
}

/* All spheres, and those that move once more, where they end. The caller frees them. */
static BpStatus spheres_at_both_ends(const BpScene *scene, BpSphere **spheres, size_t *count, BpError *err) {
    *count = scene->sphere_count + scene->moving_count;
    *spheres = malloc(*count * sizeof **spheres);
    if (*spheres == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for %zu spheres", *count);
    memcpy(*spheres, scene->spheres, scene->sphere_count * sizeof **spheres);
    for (size_t i = 0; i < scene->moving_count; i++) {
        BpSphere *const end = *spheres + scene->sphere_count + i;
        *end = scene->spheres[i];
        memcpy(end->center, scene->center_ends[i], sizeof end->center);
    }
    return BP_OK;
}

static BpStatus fit_camera(const BpNode *node, const BpSceneChanges *changes, BpScene *scene, BpError *err) {
    BpCamera *const camera = &scene->camera;
    const BpNode fit = bp_node_member(node, "fit");
    if (changes->camera != NULL) {
        memcpy(camera->lookfrom, changes->camera->lookfrom, sizeof camera->lookfrom);
        memcpy(camera->lookat, changes->camera->lookat, sizeof camera->lookat);
        memcpy(camera->vup, changes->camera->vup, sizeof camera->vup);
        camera->focus_dist = changes->camera->focus_dist;
        camera->view_height = changes->camera->view_height;
        return BP_OK;
    }
    if (camera->fit == BP_FIT_NONE) return BP_OK;
    const bool all = camera->fit == BP_FIT_SCENE;
    const size_t first = all ? 0 : scene->particle_first;
    double direction[3];
    if (!all && !scene->has_particles)
        return bp_node_fail(&fit, BP_PART_VALUE, err,
                            "found \"particles\", but the scene has none; expected \"scene\", or particles");
    bp_scene_view(scene, direction);
    const BpSphere *spheres = scene->spheres + first;
    size_t count = scene->sphere_count - first;
    BpSphere *both = NULL;
    if (first < scene->moving_count) {
        BP_TRY(spheres_at_both_ends(scene, &both, &count, err));
        spheres = both;
    }
    BpError inner = {0};
    const BpStatus status = changes->turning > 0
                                ? bp_camera_fit_turning(spheres, count, direction, camera->margin,
                                                        changes->turning, camera, &inner)
                                : bp_camera_fit(spheres, count, direction, camera->margin, camera, &inner);
    free(both);
    if (status == BP_OK) return BP_OK;
    bp_node_fail(fit.value != NULL ? &fit : node, BP_PART_VALUE, err, "%s", inner.message);
    bp_error_clear(&inner);
    return status;
}

/* Sets one choice in all materials that have it, whatever each of them says. */
static BpStatus choose_fresnel(const BpSceneChanges *changes, BpScene *scene, BpError *err) {
    const BpMemberInfo *member = &bp_members[BP_MEMBER_FRESNEL];
    unsigned choice = 0;
    size_t found = 0, changed = 0;
    while (choice < member->name_count && strcmp(member->names[choice], changes->fresnel) != 0) choice++;
    if (choice == member->name_count)
        return bp_fail(err, BP_ERR_USAGE, "no such Fresnel formula: %.80s", changes->fresnel);
    for (size_t m = 0; m < scene->material_count; m++) {
        BpMaterial *material = &scene->materials[m];
        if (!bp_material_has(material->kind, BP_MEMBER_FRESNEL)) continue;
        found++;
        if ((unsigned)material->fresnel != choice) changed++;
        bp_member_choose(material, BP_MEMBER_FRESNEL, choice);
    }
    if (changes->fresnel_counts != NULL) {
        changes->fresnel_counts[0] = changed;
        changes->fresnel_counts[1] = found;
    }
    return BP_OK;
}

/* Other programs have more shapes than spheres. */
static BpStatus refuse_other_shapes(const BpNode *root, BpError *err) {
    static const char *const shapes[] = {
        "triangles", "triangle", "quads", "quad",      "boxes", "box",     "cubes",  "meshes",
        "mesh",      "planes",   "plane", "cylinders", "cones", "disks",   "shapes", "primitives",
        "polygons",  "vertices", "faces", "objects",   "world", "geometry"};
    for (size_t i = 0; i < BP_COUNT(shapes); i++) {
        const BpNode shape = bp_node_member(root, shapes[i]);
        if (shape.value != NULL)
            return bp_node_fail(
                &shape, BP_PART_NAME, err,
                "unknown member; only spheres are rendered: write them in \"spheres\", or name "
                "files of them in \"clouds\" or \"particles\"");
    }
    return BP_OK;
}

static BpStatus parse_body(const BpNode *root, const BpSceneChanges *changes, BpScene *scene, BpError *err) {
    static const char *const names[] = {"format",   "title",         "source",    "camera",   "background",
                                        "backdrop", "lighting",      "transfer",  "textures", "materials",
                                        "spheres",  "clouds",        "particles", "$schema",  "media",
                                        "medium",   "shadow_catcher"};
    BP_TRY(refuse_other_shapes(root, err));
    const BpNode former = bp_node_member(root, "light");
    if (former.value != NULL)
        return bp_node_fail(&former, BP_PART_NAME, err, "unknown member; \"light\" is now \"lighting\"");
    BP_TRY(bp_node_object(root, names, BP_COUNT(names), err));
    BP_TRY(bp_node_require(root, "camera", "one, such as \"camera\": { \"image_width\": 400 }", err));
    BP_TRY(parse_head(root, scene, err));
    const BpNode camera = bp_node_member(root, "camera");
    const BpNode background = bp_node_member(root, "background");
    const BpNode backdrop = bp_node_member(root, "backdrop");
    const BpNode textures = bp_node_member(root, "textures");
    const BpNode materials = bp_node_member(root, "materials");
    const BpNode spheres = bp_node_member(root, "spheres");
    const BpNode clouds = bp_node_member(root, "clouds");
    const BpNode particles = bp_node_member(root, "particles");
    const BpNode media = bp_node_member(root, "media");
    const BpNode medium = bp_node_member(root, "medium");
    BP_TRY(bp_parse_camera(&camera, &scene->camera, err));
    if (changes->projection != NULL)
        scene->camera.projection = strcmp(changes->projection, bp_projection_names[BP_PERSPECTIVE]) == 0
                                       ? BP_PERSPECTIVE
                                       : BP_ORTHOGRAPHIC;
    if (scene->camera.projection == BP_PERSPECTIVE) scene->camera.view_height = 0;
    BP_TRY(bp_parse_background(&background, changes->flags, scene, err));
    BP_TRY(bp_parse_backdrop(&backdrop, scene, err));
    const BpNode catcher = bp_node_member(root, "shadow_catcher");
    BP_TRY(bp_parse_shadow_catcher(&catcher, scene, err));
    BP_TRY(bp_parse_lighting(root, changes->lighting, scene, err));
    BP_TRY(bp_parse_textures(&textures, changes->flags, scene, err));
    BP_TRY(bp_parse_media(&media, scene, err));
    BP_TRY(bp_parse_medium_name(&medium, scene, &scene->medium, err));
    BP_TRY(parse_materials(&materials, scene, err));
    BpMaterialIndex index = {0};
    BpStatus status = index_materials(scene, &index, err);
    if (status == BP_OK) status = parse_spheres(&spheres, &index, scene, err);
    if (status == BP_OK) status = bp_parse_clouds(&clouds, &index, changes->flags, scene, err);
    if (status == BP_OK) status = bp_parse_particles(&particles, &index, changes, scene, err);
    if (status == BP_OK) status = bp_add_sphere_sets(&index, changes, scene, err);
    free(index.by_name);
    BP_TRY(status);
    if (changes->fresnel != NULL) BP_TRY(choose_fresnel(changes, scene, err));
    if (changes->fit && scene->camera.fit == BP_FIT_NONE) {
        scene->camera.fit = scene->has_particles ? BP_FIT_PARTICLES : BP_FIT_SCENE;
        scene->camera.view = BP_VIEW_THREE_QUARTER;
        scene->camera.margin = BP_FIT_MARGIN;
    }
    if (changes->frame_count != NULL) return BP_OK;
    if ((changes->flags & BP_PARSE_NO_CLOUDS) == 0) BP_TRY(fit_camera(&camera, changes, scene, err));
    if ((changes->flags & BP_PARSE_MADE) != 0 && scene->lighting == BP_LIGHTING_SKY)
        scene->background_up[scene->up] = 1; /* the world's */
    bp_shadow_catcher_place(scene);
    bp_lighting_place(scene);
    return refuse_faults(root, scene, err);
}

BpStatus bp_scene_parse_changed(const char *text, size_t length, const char *name,
                                const BpSceneChanges *changes, BpScene **scene, BpError *err) {
    BpDocument document = {0};
    BpScene *result = NULL;
    *scene = NULL;
    BpStatus status;
    BP_TRY_GOTO(status, bp_document_open(text, length, name, &document, err), done);
    document.held = changes->held;
    BP_TRY_GOTO(status, bp_document_change(&document, changes->set, changes->set_count, err), done);
    BP_TRY_GOTO(status, bp_scene_create_empty(name, &result, err), done);
    const BpNode root = bp_node_root(&document);
    BP_TRY_GOTO(status, parse_body(&root, changes, result, err), done);
    *scene = result;
    result = NULL;
done:
    bp_scene_destroy(&result);
    bp_document_close(&document);
    return status;
}

BpStatus bp_scene_parse(const char *text, size_t length, const char *name, BpScene **scene, BpError *err) {
    const BpSceneChanges none = {0};
    return bp_scene_parse_changed(text, length, name, &none, scene, err);
}

BpStatus bp_scene_parse_with_spheres(const char *text, size_t length, const char *name,
                                     const BpSphereSet *sets, size_t set_count, BpScene **scene,
                                     BpError *err) {
    const BpSceneChanges changes = {.spheres = sets, .sphere_set_count = set_count};
    return bp_scene_parse_changed(text, length, name, &changes, scene, err);
}

/* A document for a file of particles; *text is NULL for other files. */
static BpStatus make_document(const char *path, char **text, BpError *err) {
    FILE *stream = NULL;
    uint64_t size = 0;
    *text = NULL;
    struct stat state;
    if (stat(path, &state) == 0 && S_ISFIFO(state.st_mode)) return BP_OK; /* what is read from it is gone */
    BP_TRY(bp_file_open(path, false, "a scene document (a JSON file) or a file of particles", &stream, &size,
                        err));
    const BpParticleFormat format = bp_particle_format_find(path, stream);
    fclose(stream);
    return format == BP_PARTICLES_NONE ? BP_OK : bp_particle_document(path, text, err);
}

BpStatus bp_scene_load_changed(const char *path, const BpSceneChanges *changes, BpScene **scene,
                               BpError *err) {
    char *text = NULL;
    size_t length = 0;
    BpSceneChanges made = *changes;
    *scene = NULL;
    BP_TRY(make_document(path, &text, err));
    if (text != NULL) {
        made.flags |= BP_PARSE_MADE;
        length = strlen(text);
    } else {
        BP_TRY(bp_file_read(path, "a scene document (a JSON file)", &text, &length, err));
    }
    const BpStatus status = bp_scene_parse_changed(text, length, path, &made, scene, err);
    free(text);
    return status;
}

BpStatus bp_scene_load(const char *path, BpScene **scene, BpError *err) {
    const BpSceneChanges none = {0};
    return bp_scene_load_changed(path, &none, scene, err);
}
