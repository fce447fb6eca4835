/* scene_parse.c: see scene_parse.h. */
#include "scene_parse.h"

#include "line_sets.h"
#include "material_index.h"
#include "mesh_sets.h"
#include "scene_background.h"
#include "scene_camera.h"
#include "scene_capsules.h"
#include "scene_faults.h"
#include "scene_figure.h"
#include "scene_fit.h"
#include "scene_material.h"
#include "scene_medium.h"
#include "scene_meshes.h"
#include "scene_particles.h"
#include "scene_points.h"
#include "scene_sets.h"
#include "scene_spheres.h"
#include "scene_texture.h"
#include "scene_triangles.h"

#include "base/names.h"
#include "scene/fit.h"
#include "scene/lighting.h"
#include "scene/material.h"
#include "scene/shadow_catcher.h"

#include <stdlib.h>
#include <string.h>

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

/* Other programs have more shapes. */
static BpStatus refuse_other_shapes(const BpNode *root, BpError *err) {
    static const char *const shapes[] = {"triangle", "quad",      "box",   "cubes",   "mesh",   "planes",
                                         "plane",    "cylinders", "cones", "disks",   "shapes", "primitives",
                                         "polygons", "vertices",  "faces", "objects", "world",  "geometry"};
    for (size_t i = 0; i < BP_COUNT(shapes); i++) {
        const BpNode shape = bp_node_member(root, shapes[i]);
        if (shape.value != NULL)
            return bp_node_fail(
                &shape, BP_PART_NAME, err,
                "unknown member; shapes are written in \"spheres\", \"triangles\", \"quads\", "
                "\"boxes\" and \"capsules\", and files of "
                "them named in \"clouds\", \"particles\" or \"meshes\"");
    }
    return BP_OK;
}

BpStatus bp_parse_scene(const BpNode *root, const BpSceneChanges *changes, BpScene *scene, BpError *err) {
    static const char *const names[] = {
        "format",         "title",     "source",  "camera", "background", "backdrop", "lighting", "transfer",
        "textures",       "materials", "spheres", "clouds", "particles",  "$schema",  "media",    "medium",
        "shadow_catcher", "triangles", "quads",   "boxes",  "meshes",     "capsules", "figure"};
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
    const BpNode meshes = bp_node_member(root, "meshes");
    const BpNode capsules = bp_node_member(root, "capsules");
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
    const BpNode figure = bp_node_member(root, "figure");
    BP_TRY(bp_parse_figure(&figure, scene, err));
    BP_TRY(bp_parse_lighting(root, changes->lighting, scene, err));
    BP_TRY(bp_parse_textures(&textures, changes->flags, scene, err));
    BP_TRY(bp_parse_media(&media, scene, err));
    BP_TRY(bp_parse_medium_name(&medium, scene, &scene->medium, err));
    BP_TRY(parse_materials(&materials, scene, err));
    BpMaterialIndex index = {0};
    BpStatus status = bp_material_index_create(scene, &index, err);
    if (status == BP_OK) status = bp_parse_spheres(&spheres, &index, scene, err);
    if (status == BP_OK) status = bp_parse_triangles(root, &index, scene, err);
    if (status == BP_OK) status = bp_parse_capsules(&capsules, &index, scene, err);
    if (status == BP_OK) status = bp_parse_meshes(&meshes, &index, changes, scene, err);
    if (status == BP_OK) status = bp_parse_clouds(&clouds, &index, changes->flags, scene, err);
    if (status == BP_OK) status = bp_parse_particles(&particles, &index, changes, scene, err);
    if (status == BP_OK) status = bp_add_sphere_sets(&index, &changes->shapes, scene, err);
    if (status == BP_OK) status = bp_add_mesh_sets(&index, &changes->shapes, scene, err);
    if (status == BP_OK) status = bp_add_line_sets(&index, &changes->shapes, scene, err);
    free(index.by_name);
    BP_TRY(status);
    if (changes->fresnel != NULL) BP_TRY(choose_fresnel(changes, scene, err));
    if (changes->fit && scene->camera.fit == BP_FIT_NONE) {
        scene->camera.fit = scene->has_particles ? BP_FIT_PARTICLES : BP_FIT_SCENE;
        scene->camera.view = BP_VIEW_THREE_QUARTER;
        scene->camera.margin = BP_FIT_MARGIN;
    }
    if (changes->frame_count != NULL) return BP_OK;
    if ((changes->flags & BP_PARSE_NO_CLOUDS) == 0) BP_TRY(bp_scene_fit_camera(&camera, changes, scene, err));
    if ((changes->flags & BP_PARSE_MADE) != 0 && scene->lighting == BP_LIGHTING_SKY)
        scene->background_up[scene->up] = 1; /* the world's */
    bp_shadow_catcher_place(scene);
    bp_lighting_place(scene);
    BP_TRY(bp_refuse_faults(root, scene, err));
    return bp_bodies_find(scene, &scene->bodies, err);
}
