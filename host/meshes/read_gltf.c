/* read_gltf.c: glTF 2.0, in JSON or binary; see reader.h.
 *
 * Knows: scenes of nodes, meshes, materials, skins.   Does not know: how numbers lie in buffers
 * (gltf_data.c).
 *
 * What the scene shows at rest is one mesh: each node's triangles where the node has them. Textures, morphs,
 * animations, cameras and lights are left out, with a note. Source: Khronos Group, glTF 2.0 Specification. */
#include "reader.h"

#include "base/format.h"
#include "base/known_file.h"
#include "base/message_text.h"
#include "base/plural.h"
#include "gltf_data.h"
#include "gltf_matrix.h"

#include <stdlib.h>
#include <string.h>

enum { PLACE_SIZE = 96, POINTS_LAST = 3, TRIANGLES = 4, STRIP = 5, FAN = 6, NO_NUMBER = -1 };

typedef struct Node {
    Matrix global;
    bool in_scene;
} Node;

/* The accessors of one primitive; NO_NUMBER: it has none. */
typedef struct Attributes {
    long position, normal, color, coordinates, joints, weights, material;
} Attributes;

/* How a material's base colour lies on its faces: by TEXCOORD_n, scaled, turned, moved. */
typedef struct Map {
    char attribute[24];
    double offset[2], rotation, scale[2];
} Map;

typedef struct Gltf {
    MeshBuilder *builder;
    GltfData data;
    Node *nodes;
    size_t node_count, *order, order_count; /* nodes of the scene, parents before children */
    uint32_t *materials; /* the builder's number of each, and what they multiply colours by */
    double (*base_colors)[3];
    Map *maps;
    size_t material_count;
    bool has_normals, has_colors, has_coordinates;
    size_t no_surfaces, morphs, translucent; /* primitives of points or lines; meshes with weights */
    size_t no_images;                        /* base colours of which the image is not one that is read */
    Attributes last;                         /* whose vertices begin at `first_vertex`, of node `last_node` */
    size_t last_node, first_vertex, vertex_count;
} Gltf;

static size_t length_of(const Gltf *g, const char *list) {
    return json_array_size(json_object_get(g->data.root, list));
}

/* ---- extensions --------------------------------------------------------------------------------------- */

static BpStatus refuse_extension(const Gltf *g, const char *name, BpError *err) {
    char shown[64];
    bp_printable(name, shown, sizeof shown);
    const bool packed =
        strcmp(name, "KHR_draco_mesh_compression") == 0 || strcmp(name, "EXT_meshopt_compression") == 0;
    return gltf_fail(&g->data, "", err, "found the extension %s, which is not read; %s", shown,
                     packed ? "export it without compression"
                            : "export it without this extension, or as PLY or OBJ");
}

/* Those that a file cannot do without must be known. */
static BpStatus check_extensions(const Gltf *g, BpError *err) {
    static const char *const known[] = {
        "KHR_mesh_quantization", "KHR_texture_transform", "KHR_lights_punctual", "EXT_texture_webp",
        "KHR_texture_basisu",    "KHR_xmp_json_ld",       "KHR_technique_webgl", "KHR_techniques_webgl"};
    const json_t *const required = json_object_get(g->data.root, "extensionsRequired");
    size_t i;
    const json_t *item;
    json_array_foreach(required, i, item) {
        const char *const name = json_string_value(item);
        if (name == NULL) return gltf_fail(&g->data, "extensionsRequired", err, "found what is no name");
        bool is_known = strncmp(name, "KHR_materials_", 14) == 0;
        for (size_t k = 0; k < sizeof known / sizeof *known; k++) is_known |= strcmp(name, known[k]) == 0;
        if (!is_known) return refuse_extension(g, name, err);
    }
    return BP_OK;
}

static const json_t *extension_of(const json_t *object, const char *name) {
    return json_object_get(json_object_get(object, "extensions"), name);
}

/* ---- nodes -------------------------------------------------------------------------------------------- */

static BpStatus local_matrix(const Gltf *g, const json_t *node, const char *place, Matrix *local,
                             BpError *err) {
    double move[3] = {0, 0, 0}, turn[4] = {0, 0, 0, 1}, scale[3] = {1, 1, 1};
    if (json_object_get(node, "matrix") != NULL)
        return gltf_numbers(&g->data, node, "matrix", place, local->of, 16, err);
    BP_TRY(gltf_numbers(&g->data, node, "translation", place, move, 3, err));
    BP_TRY(gltf_numbers(&g->data, node, "rotation", place, turn, 4, err));
    BP_TRY(gltf_numbers(&g->data, node, "scale", place, scale, 3, err));
    *local = matrix_of_parts(move, turn, scale);
    return BP_OK;
}

/* Enters a node of the document below a parent: from then on it stands somewhere, and comes next. */
static BpStatus enter_node(Gltf *g, size_t number, const json_t *element, const Matrix *parent,
                           BpError *err) {
    char place[PLACE_SIZE];
    Matrix local;
    snprintf(place, sizeof place, "nodes[%zu]", number);
    if (g->nodes[number].in_scene)
        return gltf_fail(&g->data, place, err, "found it below two nodes, expected one parent");
    if (extension_of(element, "EXT_mesh_gpu_instancing") != NULL)
        return refuse_extension(g, "EXT_mesh_gpu_instancing", err);
    BP_TRY(local_matrix(g, element, place, &local, err));
    g->nodes[number].in_scene = true;
    g->nodes[number].global = matrix_product(parent, &local);
    g->order[g->order_count++] = number;
    return BP_OK;
}

typedef struct Visit {
    size_t node, parent; /* parent: SIZE_MAX for a root */
} Visit;

/* Puts a list of nodes on the stack, the first on top. */
static BpStatus push_nodes(const Gltf *g, const json_t *list, size_t parent, Visit *stack, size_t *used,
                           BpError *err) {
    const size_t count = json_array_size(list);
    /* A node that is named more often than there are nodes is named twice. */
    if (count > g->node_count - *used)
        return gltf_fail(&g->data, "nodes", err, "found one below two nodes, expected one parent");
    for (size_t i = count; i-- > 0;) {
        const json_t *const item = json_array_get(list, i);
        if (!json_is_integer(item) || json_integer_value(item) < 0 ||
            (size_t)json_integer_value(item) >= g->node_count)
            return gltf_fail(&g->data, "nodes", err, "found a child that is none of %zu nodes",
                             g->node_count);
        stack[(*used)++] = (Visit){(size_t)json_integer_value(item), parent};
    }
    return BP_OK;
}

static BpStatus visit_nodes(Gltf *g, const json_t *roots, Visit *stack, BpError *err) {
    static const Matrix identity = MATRIX_IDENTITY;
    size_t used = 0;
    BP_TRY(push_nodes(g, roots, SIZE_MAX, stack, &used, err));
    while (used > 0) {
        const Visit visit = stack[--used];
        json_t *element = NULL;
        const Matrix *const parent = visit.parent != SIZE_MAX ? &g->nodes[visit.parent].global : &identity;
        BP_TRY(gltf_element(&g->data, "nodes", visit.node, &element, err));
        BP_TRY(enter_node(g, visit.node, element, parent, err));
        BP_TRY(push_nodes(g, json_object_get(element, "children"), visit.node, stack, &used, err));
    }
    return BP_OK;
}

/* All nodes without a parent, for files without scenes. Heap. */
static json_t *parentless(const Gltf *g) {
    json_t *const roots = json_array();
    bool *const has_parent = calloc(g->node_count + 1, sizeof *has_parent);
    for (size_t n = 0; n < g->node_count && has_parent != NULL; n++) {
        size_t i;
        const json_t *child;
        const json_t *const children =
            json_object_get(json_array_get(json_object_get(g->data.root, "nodes"), n), "children");
        json_array_foreach(children, i, child) {
            const json_int_t number = json_is_integer(child) ? json_integer_value(child) : -1;
            if (number >= 0 && (size_t)number < g->node_count) has_parent[number] = true;
        }
    }
    for (size_t n = 0; n < g->node_count && has_parent != NULL; n++)
        if (!has_parent[n]) json_array_append_new(roots, json_integer((json_int_t)n));
    free(has_parent);
    return roots;
}

/* Finds the nodes of the scene that the file shows, and where they stand. */
static BpStatus find_nodes(Gltf *g, BpError *err) {
    const size_t scenes = length_of(g, "scenes");
    size_t number = 0;
    bool found = false;
    json_t *scene = NULL, *roots = NULL;
    g->node_count = length_of(g, "nodes");
    BP_TRY(gltf_whole(&g->data, g->data.root, "scene", "", &found, &number, err));
    if (scenes > 0 || found) BP_TRY(gltf_element(&g->data, "scenes", number, &scene, err));
    if (scenes > 1) mesh_note(g->builder->mesh, "scene %zu (from 0) of %zu", number, scenes);
    roots = scene != NULL ? json_incref(json_object_get(scene, "nodes")) : parentless(g);
    g->nodes = calloc(g->node_count + 1, sizeof *g->nodes);
    g->order = calloc(g->node_count + 1, sizeof *g->order);
    Visit *const stack = calloc(g->node_count + 1, sizeof *stack);
    const BpStatus status = g->nodes != NULL && g->order != NULL && stack != NULL
                                ? visit_nodes(g, roots, stack, err)
                                : gltf_fail_memory(err);
    free(stack);
    json_decref(roots);
    return status;
}

/* ---- materials ---------------------------------------------------------------------------------------- */

static double within(double value, double low, double high) {
    return value >= low ? fmin(value, high) : low; /* NaN cannot be written in JSON */
}

/* Names need not be different, nor be there: what another material has been called gets its number. */
static BpStatus name_material(Gltf *g, size_t number, const json_t *element, BpError *err) {
    const char *const own = json_string_value(json_object_get(element, "name"));
    const size_t before = g->builder->mesh->material_count;
    char name[128];
    bp_printable(own != NULL && own[0] != '\0' ? own : "material", name, sizeof name - 24);
    if (own != NULL && own[0] != '\0') {
        BP_TRY(mesh_find_material(g->builder, name, &g->materials[number], err));
        if (g->builder->mesh->material_count > before) return BP_OK;
    }
    const size_t used = strlen(name);
    for (size_t more = number; g->builder->mesh->material_count == before; more += g->material_count) {
        snprintf(name + used, sizeof name - used, " %zu", more);
        BP_TRY(mesh_find_material(g->builder, name, &g->materials[number], err));
    }
    return BP_OK;
}

/* The set of coordinates, and what KHR_texture_transform does to them. */
static BpStatus read_map(const Gltf *g, const json_t *texture, const char *place, Map *map, BpError *err) {
    const json_t *const transform = extension_of(texture, "KHR_texture_transform");
    size_t set = 0;
    bool found = false;
    *map = (Map){.scale = {1, 1}};
    BP_TRY(gltf_whole(&g->data, texture, "texCoord", place, &found, &set, err));
    BP_TRY(gltf_whole(&g->data, transform, "texCoord", place, &found, &set, err));
    BP_TRY(gltf_numbers(&g->data, transform, "offset", place, map->offset, 2, err));
    BP_TRY(gltf_numbers(&g->data, transform, "rotation", place, &map->rotation, 1, err));
    BP_TRY(gltf_numbers(&g->data, transform, "scale", place, map->scale, 2, err));
    snprintf(map->attribute, sizeof map->attribute, "TEXCOORD_%zu", set < 100 ? set : 100);
    return BP_OK;
}

/* The image of a material's base colour: a file beside the document, or one inside of it.
 * Says nothing of what fails. */
static BpStatus read_base_image(Gltf *g, const json_t *texture, const char *place, BpMeshMaterial *material) {
    enum { CLAMP_TO_EDGE = 33071 };
    size_t number = 0, source = 0, sampler = 0, wrap = 0;
    bool found = false, sampled = false;
    json_t *element = NULL;
    GltfImage image;
    if (texture == NULL || length_of(g, "textures") == 0) return BP_OK;
    BP_TRY(gltf_whole(&g->data, texture, "index", place, &found, &number, NULL));
    BP_TRY(gltf_element(&g->data, "textures", number, &element, NULL));
    BP_TRY(gltf_whole(&g->data, element, "sampler", place, &sampled, &sampler, NULL));
    BP_TRY(gltf_whole(&g->data, element, "source", place, &found, &source, NULL));
    if (!found || length_of(g, "images") == 0) { /* in a format that an extension names */
        g->no_images++;
        return BP_OK;
    }
    BP_TRY(gltf_image(&g->data, source, &image, NULL));
    free(material->image_file);
    material->image_file = image.name;
    if (image.length > 0 && bp_is_picture(image.bytes, image.length))
        material->image_inside = (uint32_t)source + 1;
    else if (image.name == NULL)
        g->no_images++;
    free(image.own);
    if (!sampled) return BP_OK;
    BP_TRY(gltf_element(&g->data, "samplers", sampler, &element, NULL));
    BP_TRY(gltf_whole(&g->data, element, "wrapS", place, &found, &wrap, NULL));
    material->image_clamped = wrap == CLAMP_TO_EDGE;
    return BP_OK;
}

static BpStatus read_material(Gltf *g, size_t number, BpError *err) {
    json_t *element = NULL;
    char place[PLACE_SIZE];
    double base[4] = {1, 1, 1, 1}, metallic = 1, roughness = 1, emitted[3] = {0, 0, 0}, strength = 1,
           ior = 1.5, transmission = 0;
    snprintf(place, sizeof place, "materials[%zu]", number);
    BP_TRY(gltf_element(&g->data, "materials", number, &element, err));
    BP_TRY(name_material(g, number, element, err));
    const json_t *const pbr = json_object_get(element, "pbrMetallicRoughness"),
                        *const light = extension_of(element, "KHR_materials_emissive_strength"),
                        *const index = extension_of(element, "KHR_materials_ior"),
                        *const clear = extension_of(element, "KHR_materials_transmission");
    BP_TRY(gltf_numbers(&g->data, pbr, "baseColorFactor", place, base, 4, err));
    BP_TRY(gltf_numbers(&g->data, pbr, "metallicFactor", place, &metallic, 1, err));
    BP_TRY(gltf_numbers(&g->data, pbr, "roughnessFactor", place, &roughness, 1, err));
    BP_TRY(gltf_numbers(&g->data, element, "emissiveFactor", place, emitted, 3, err));
    BP_TRY(gltf_numbers(&g->data, light, "emissiveStrength", place, &strength, 1, err));
    BP_TRY(gltf_numbers(&g->data, index, "ior", place, &ior, 1, err));
    BP_TRY(gltf_numbers(&g->data, clear, "transmissionFactor", place, &transmission, 1, err));
    /* A texture that makes no sense is left out, and the mesh is read. */
    if (read_map(g, json_object_get(pbr, "baseColorTexture"), place, &g->maps[number], NULL) != BP_OK)
        g->maps[number] = (Map){.attribute = "TEXCOORD_0", .scale = {1, 1}};
    BpMeshMaterial *const material = &g->builder->mesh->materials[g->materials[number]];
    const char *const mode = json_string_value(json_object_get(element, "alphaMode"));
    const bool varies = json_object_get(pbr, "metallicRoughnessTexture") != NULL;
    const bool textured = json_object_get(pbr, "baseColorTexture") != NULL;
    for (int c = 0; c < 3; c++) {
        material->kd[c] = g->base_colors[number][c] = within(base[c], 0, 1);
        /* A texture says where it shines, mostly in few places. */
        material->ke[c] =
            json_object_get(element, "emissiveTexture") == NULL ? within(emitted[c] * strength, 0, 1e6) : 0;
    }
    material->has_kd = !textured; /* the factor of a texture is mostly white */
    material->has_ke = true;
    material->has_ni = ior > 0;
    material->ni = ior;
    material->has_d = transmission > 0 || (mode != NULL && strcmp(mode, "BLEND") == 0 && !textured);
    material->d = transmission > 0 ? 1 - within(transmission, 0, 1) : within(base[3], 0, 1);
    material->has_surface = !varies && extension_of(element, "KHR_materials_unlit") == NULL;
    material->metallic = within(metallic, 0, 1);
    material->roughness = within(roughness, 0, 1);
    const BpStatus status = read_base_image(g, json_object_get(pbr, "baseColorTexture"), place, material);
    if (status == BP_ERR_MEMORY) return gltf_fail_memory(err);
    g->no_images += status != BP_OK;
    return BP_OK;
}

/* Those of base colours are offered with their materials. */
static void note_textures(const Gltf *g) {
    char number[32];
    size_t used = 0;
    for (size_t m = 0; m < g->builder->mesh->material_count; m++) {
        const BpMeshMaterial *const material = &g->builder->mesh->materials[m];
        used += material->image_file != NULL || material->image_inside > 0;
    }
    if (g->no_images > 0)
        mesh_note(g->builder->mesh, "%s texture%s of base colours left out, since only PNG and JPEG are read",
                  bp_format_whole(g->no_images, number, sizeof number), bp_plural(g->no_images));
    if (length_of(g, "textures") > used + g->no_images)
        mesh_note(g->builder->mesh, "%s",
                  used + g->no_images > 0 ? "textures of other kinds left out" : "textures left out");
}

static BpStatus read_materials(Gltf *g, BpError *err) {
    g->material_count = length_of(g, "materials");
    g->materials = calloc(g->material_count + 1, sizeof *g->materials);
    g->base_colors = calloc(g->material_count + 1, sizeof *g->base_colors);
    g->maps = calloc(g->material_count + 1, sizeof *g->maps);
    if (g->materials == NULL || g->base_colors == NULL || g->maps == NULL) return gltf_fail_memory(err);
    for (size_t m = 0; m < g->material_count; m++) BP_TRY(read_material(g, m, err));
    note_textures(g);
    return BP_OK;
}

/* ---- vertices ----------------------------------------------------------------------------------------- */

static BpStatus attribute(const Gltf *g, const json_t *primitive, const char *name, const char *place,
                          long *number, BpError *err) {
    size_t value = 0;
    bool found = false;
    BP_TRY(gltf_whole(&g->data, json_object_get(primitive, "attributes"), name, place, &found, &value, err));
    *number = found ? (long)value : NO_NUMBER;
    return BP_OK;
}

static BpStatus attributes_of(const Gltf *g, const json_t *primitive, const char *place, Attributes *of,
                              BpError *err) {
    size_t material = 0;
    bool found = false;
    BP_TRY(attribute(g, primitive, "POSITION", place, &of->position, err));
    BP_TRY(attribute(g, primitive, "NORMAL", place, &of->normal, err));
    BP_TRY(attribute(g, primitive, "COLOR_0", place, &of->color, err));
    BP_TRY(attribute(g, primitive, "JOINTS_0", place, &of->joints, err));
    BP_TRY(attribute(g, primitive, "WEIGHTS_0", place, &of->weights, err));
    BP_TRY(gltf_whole(&g->data, primitive, "material", place, &found, &material, err));
    if (found && material >= g->material_count)
        return gltf_fail(&g->data, place, err, "found material %zu, expected one of %zu", material,
                         g->material_count);
    of->material = found ? (long)material : NO_NUMBER;
    return attribute(g, primitive, found ? g->maps[material].attribute : "TEXCOORD_0", place,
                     &of->coordinates, err);
}

/* Rows of an accessor that may be left out, one for each of `count` vertices. */
static BpStatus vertex_rows(const Gltf *g, long number, size_t components, size_t or_components, size_t count,
                            const char *place, GltfRows *rows, BpError *err) {
    *rows = (GltfRows){0};
    if (number == NO_NUMBER) return BP_OK;
    BP_TRY(gltf_rows(&g->data, (size_t)number, components, or_components, rows, err));
    if (rows->count == count) return BP_OK;
    const size_t found = rows->count;
    free(rows->values);
    *rows = (GltfRows){0};
    return gltf_fail(&g->data, place, err,
                     "found %zu rows of an attribute, expected one for each of %zu vertices", found, count);
}

typedef struct Skin {
    Matrix *joints; /* heap; NULL: the node has no skin */
    size_t count;
} Skin;

/* What a skin's joints do to vertices. */
static BpStatus read_skin(const Gltf *g, size_t number, Skin *skin, BpError *err) {
    json_t *element = NULL;
    char place[PLACE_SIZE];
    size_t inverse = 0;
    bool found = false;
    GltfRows rows = {0};
    snprintf(place, sizeof place, "skins[%zu]", number);
    BP_TRY(gltf_element(&g->data, "skins", number, &element, err));
    const json_t *const joints = json_object_get(element, "joints");
    BP_TRY(gltf_whole(&g->data, element, "inverseBindMatrices", place, &found, &inverse, err));
    if (found) BP_TRY(gltf_rows(&g->data, inverse, 16, 16, &rows, err));
    skin->count = json_array_size(joints);
    skin->joints = calloc(skin->count + 1, sizeof *skin->joints);
    BpStatus status = skin->joints != NULL ? BP_OK : gltf_fail_memory(err);
    for (size_t j = 0; j < skin->count && status == BP_OK; j++) {
        const json_t *const joint = json_array_get(joints, j);
        const json_int_t node = json_integer_value(joint);
        if (!json_is_integer(joint) || node < 0 || (size_t)node >= g->node_count ||
            !g->nodes[node].in_scene || (found && j >= rows.count)) {
            status = gltf_fail(&g->data, place, err,
                               "found joint %zu without a node of the scene, or without a matrix", j);
            break;
        }
        skin->joints[j] = g->nodes[node].global;
        if (found) {
            Matrix bind;
            memcpy(bind.of, &rows.values[j * 16], sizeof bind.of);
            skin->joints[j] = matrix_product(&g->nodes[node].global, &bind);
        }
    }
    free(rows.values);
    return status;
}

/* Where the joints that a vertex hangs on take it. */
static BpStatus skinned(const Gltf *g, const Skin *skin, const double *joints, const double *weights,
                        const char *place, Matrix *sum, BpError *err) {
    double all = 0;
    *sum = (Matrix){0};
    for (int k = 0; k < 4; k++) {
        if (weights[k] == 0) continue;
        if (!(joints[k] >= 0 && joints[k] < (double)skin->count))
            return gltf_fail(&g->data, place, err, "found joint %g, expected one of %zu", joints[k],
                             skin->count);
        matrix_add(&skin->joints[(size_t)joints[k]], weights[k], sum);
        all += weights[k];
    }
    if (all > 0) matrix_scale(1 / all, sum);
    return BP_OK;
}

typedef struct Rows {
    GltfRows positions, normals, colors, coordinates, joints, weights;
} Rows;

static void free_rows(Rows *rows) {
    free(rows->positions.values);
    free(rows->normals.values);
    free(rows->colors.values);
    free(rows->coordinates.values);
    free(rows->joints.values);
    free(rows->weights.values);
}

/* A vertex's colour is its own times that of its material: section 3.7.2.1. */
static BpStatus add_color(Gltf *g, const Rows *rows, size_t vertex, long material, BpError *err) {
    double color[3] = {1, 1, 1};
    if (!g->has_colors) return BP_OK;
    for (size_t c = 0; c < 3; c++) {
        if (rows->colors.values != NULL)
            color[c] = within(rows->colors.values[vertex * rows->colors.components + c], 0, 1);
        if (material != NO_NUMBER) color[c] *= g->base_colors[material][c];
    }
    return mesh_color_vertex(g->builder, color, false, err);
}

/* v of files grows downwards. The turn of KHR_texture_transform is counter-clockwise as files have them, as
 * the Khronos Group's own viewer does it. */
static BpStatus add_coordinates(Gltf *g, const Rows *rows, size_t vertex, long material, BpError *err) {
    if (!g->has_coordinates) return BP_OK;
    if (rows->coordinates.values == NULL) return mesh_add_coordinates(g->builder, NAN, NAN, false, err);
    const double from[2] = {rows->coordinates.values[2 * vertex], rows->coordinates.values[2 * vertex + 1]};
    if (material == NO_NUMBER) return mesh_add_coordinates(g->builder, from[0], 1 - from[1], false, err);
    const Map *const map = &g->maps[material];
    const double u = from[0] * map->scale[0], v = from[1] * map->scale[1];
    const double sine = sin(map->rotation), cosine = cos(map->rotation);
    return mesh_add_coordinates(g->builder, map->offset[0] + cosine * u + sine * v,
                                1 - (map->offset[1] + cosine * v - sine * u), false, err);
}

static BpStatus add_rows(Gltf *g, const Rows *rows, const Attributes *of, const Matrix *global,
                         const Skin *skin, const char *place, BpError *err) {
    Matrix way = *global;
    const bool hangs = skin->joints != NULL && rows->joints.values != NULL && rows->weights.values != NULL;
    for (size_t v = 0; v < rows->positions.count; v++) {
        double position[3], normal[3] = {0, 0, 0};
        if (hangs)
            BP_TRY(skinned(g, skin, rows->joints.values + 4 * v, rows->weights.values + 4 * v, place, &way,
                           err));
        matrix_point(&way, &rows->positions.values[3 * v], position);
        BP_TRY(mesh_add_vertex(g->builder, position, false, err));
        if (g->has_normals) {
            if (rows->normals.values != NULL) matrix_normal(&way, &rows->normals.values[3 * v], normal);
            BP_TRY(mesh_add_normal(g->builder, normal, false, err));
        }
        BP_TRY(add_coordinates(g, rows, v, of->material, err));
        BP_TRY(add_color(g, rows, v, of->material, err));
    }
    return BP_OK;
}

static BpStatus add_vertices(Gltf *g, const Attributes *of, const Matrix *global, const Skin *skin,
                             const char *place, BpError *err) {
    Rows rows = {0};
    if (of->position == NO_NUMBER) return gltf_fail(&g->data, place, err, "found no POSITION, expected one");
    BpStatus status = gltf_rows(&g->data, (size_t)of->position, 3, 3, &rows.positions, err);
    const size_t count = rows.positions.count;
    if (status == BP_OK) status = vertex_rows(g, of->normal, 3, 3, count, place, &rows.normals, err);
    if (status == BP_OK) status = vertex_rows(g, of->color, 3, 4, count, place, &rows.colors, err);
    if (status == BP_OK) status = vertex_rows(g, of->coordinates, 2, 2, count, place, &rows.coordinates, err);
    if (status == BP_OK) status = vertex_rows(g, of->joints, 4, 4, count, place, &rows.joints, err);
    if (status == BP_OK) status = vertex_rows(g, of->weights, 4, 4, count, place, &rows.weights, err);
    g->first_vertex = g->builder->mesh->vertex_count;
    g->vertex_count = count;
    if (status == BP_OK) status = add_rows(g, &rows, of, global, skin, place, err);
    free_rows(&rows);
    return status;
}

/* ---- triangles ---------------------------------------------------------------------------------------- */

static BpStatus add_triangle(Gltf *g, const GltfRows *indices, const size_t corners[3], bool mirrored,
                             uint32_t material, const char *place, BpError *err) {
    for (size_t k = 0; k < 3; k++) {
        const size_t corner = corners[mirrored && k > 0 ? 3 - k : k];
        const double vertex = indices->values != NULL ? indices->values[corner] : (double)corner;
        if (!(vertex >= 0 && vertex < (double)g->vertex_count))
            return gltf_fail(&g->data, place, err,
                             "found vertex %g in triangle %zu (from 0), expected one of %zu", vertex,
                             corners[0], g->vertex_count);
        BP_TRY(mesh_add_corner(g->builder, (uint32_t)(g->first_vertex + (size_t)vertex), err));
    }
    return mesh_end_polygon(g->builder, material, false, err);
}

static bool has_twice(const GltfRows *indices, const size_t corners[3]) {
    if (indices->values == NULL) return false;
    const double a = indices->values[corners[0]], b = indices->values[corners[1]],
                 c = indices->values[corners[2]];
    return a == b || b == c || c == a;
}

/* Section 3.7.2.1: triangles one by one, in strips of which every second one runs the other way, or in fans.
 */
static BpStatus add_triangles(Gltf *g, const GltfRows *indices, size_t count, size_t mode, bool mirrored,
                              uint32_t material, const char *place, BpError *err) {
    const size_t step = mode == TRIANGLES ? 3 : 1;
    if (mode == TRIANGLES && count % 3 != 0)
        return gltf_fail(&g->data, place, err, "found %zu corners of triangles, expected a multiple of three",
                         count);
    for (size_t i = 0; i + 3 <= count; i += step) {
        const size_t odd = mode == STRIP ? i % 2 : 0;
        const size_t corners[3] = {mode == FAN ? 0 : i, i + 1 + odd, i + 2 - odd};
        /* In a strip these only lead from one part to the next. */
        if (mode == STRIP && has_twice(indices, corners)) continue;
        BP_TRY(add_triangle(g, indices, corners, mirrored, material, place, err));
    }
    return BP_OK;
}

/* Whether the material moves coordinates. */
static bool is_moved(const Gltf *g, long material) {
    if (material == NO_NUMBER || !g->has_coordinates) return false;
    const Map *const map = &g->maps[material];
    return map->offset[0] != 0 || map->offset[1] != 0 || map->rotation != 0 || map->scale[0] != 1 ||
           map->scale[1] != 1;
}

static BpStatus add_primitive(Gltf *g, const json_t *primitive, size_t node, const Skin *skin,
                              const char *place, BpError *err) {
    size_t mode = TRIANGLES, accessor = 0;
    bool found = false;
    Attributes of;
    GltfRows indices = {0};
    BP_TRY(gltf_whole(&g->data, primitive, "mode", place, &found, &mode, err));
    if (mode > FAN) return gltf_fail(&g->data, place, err, "found mode %zu, expected 0 to 6", mode);
    if (mode <= POINTS_LAST) {
        g->no_surfaces++;
        return BP_OK;
    }
    if (extension_of(primitive, "KHR_draco_mesh_compression") != NULL)
        return refuse_extension(g, "KHR_draco_mesh_compression", err);
    BP_TRY(attributes_of(g, primitive, place, &of, err));
    /* Primitives of one mesh often share their vertices, which a material changes by its colour, and by what
     * it does to their coordinates. */
    Attributes vertices = of;
    if (!g->has_colors && !is_moved(g, of.material)) vertices.material = NO_NUMBER;
    if (g->last_node != node || memcmp(&vertices, &g->last, sizeof vertices) != 0)
        BP_TRY(add_vertices(g, &of, &g->nodes[node].global, skin, place, err));
    g->last_node = node;
    g->last = vertices;
    BP_TRY(gltf_whole(&g->data, primitive, "indices", place, &found, &accessor, err));
    if (found) BP_TRY(gltf_rows(&g->data, accessor, 1, 1, &indices, err));
    /* A skin's vertices stand where the joints are, so the node does not mirror them. */
    const bool mirrored = skin->joints == NULL && matrix_mirrors(&g->nodes[node].global);
    const BpStatus status =
        add_triangles(g, &indices, found ? indices.count : g->vertex_count, mode, mirrored,
                      of.material != NO_NUMBER ? g->materials[of.material] : BP_MESH_NO_MATERIAL, place, err);
    free(indices.values);
    return status;
}

static bool has_weight(const json_t *weights) {
    size_t i;
    const json_t *weight;
    json_array_foreach(weights, i, weight) {
        if (json_number_value(weight) != 0) return true;
    }
    return false;
}

static BpStatus add_node(Gltf *g, size_t number, BpError *err) {
    json_t *node = NULL, *mesh = NULL;
    char place[PLACE_SIZE];
    size_t of_mesh = 0, of_skin = 0, i;
    bool has_mesh = false, has_skin = false;
    Skin skin = {0};
    const json_t *primitive;
    snprintf(place, sizeof place, "nodes[%zu]", number);
    BP_TRY(gltf_element(&g->data, "nodes", number, &node, err));
    BP_TRY(gltf_whole(&g->data, node, "mesh", place, &has_mesh, &of_mesh, err));
    BP_TRY(gltf_whole(&g->data, node, "skin", place, &has_skin, &of_skin, err));
    if (!has_mesh) return BP_OK;
    BP_TRY(gltf_element(&g->data, "meshes", of_mesh, &mesh, err));
    if (has_weight(json_object_get(node, "weights")) ||
        (json_object_get(node, "weights") == NULL && has_weight(json_object_get(mesh, "weights"))))
        g->morphs++;
    BpStatus status = has_skin ? read_skin(g, of_skin, &skin, err) : BP_OK;
    json_array_foreach(json_object_get(mesh, "primitives"), i, primitive) {
        if (status != BP_OK) break;
        snprintf(place, sizeof place, "meshes[%zu].primitives[%zu]", of_mesh, i);
        status = add_primitive(g, primitive, number, &skin, place, err);
    }
    free(skin.joints);
    return status;
}

/* ---- the whole ---------------------------------------------------------------------------------------- */

/* Whether any primitive of the file has the attribute. */
static bool has_attribute(const Gltf *g, const char *name) {
    size_t i, k;
    const json_t *mesh, *primitive;
    json_array_foreach(json_object_get(g->data.root, "meshes"), i, mesh) {
        json_array_foreach(json_object_get(mesh, "primitives"), k, primitive) {
            if (json_object_get(json_object_get(primitive, "attributes"), name) != NULL) return true;
        }
    }
    return false;
}

static void note_left_out(const Gltf *g) {
    const struct {
        size_t count;
        const char *noun;
    } left_out[] = {
        {g->no_surfaces, "primitive of points or lines"},
        {g->morphs, "morph"},
        {length_of(g, "animations"), "animation"},
        {length_of(g, "cameras"), "camera"},
        {json_array_size(json_object_get(extension_of(g->data.root, "KHR_lights_punctual"), "lights")),
         "light"}};
    for (size_t i = 0; i < sizeof left_out / sizeof *left_out; i++) {
        char number[32];
        if (left_out[i].count == 0) continue;
        if (i == 0)
            mesh_note(g->builder->mesh, "%s primitive%s of points or lines left out",
                      bp_format_whole(left_out[i].count, number, sizeof number),
                      bp_plural(left_out[i].count));
        else
            mesh_note(g->builder->mesh, "%s %s%s left out",
                      bp_format_whole(left_out[i].count, number, sizeof number), left_out[i].noun,
                      bp_plural(left_out[i].count));
    }
}

static BpStatus read_all(Gltf *g, BpError *err) {
    BP_TRY(gltf_read(&g->data, g->builder->input, g->builder->path, err));
    BP_TRY(check_extensions(g, err));
    g->has_normals = has_attribute(g, "NORMAL");
    g->has_colors = has_attribute(g, "COLOR_0");
    g->has_coordinates = has_attribute(g, "TEXCOORD_0");
    /* Shares of light, and linear, whatever the largest is: section 3.7.2.1. */
    g->builder->vertex_colors.range.largest = 1;
    BP_TRY(read_materials(g, err));
    BP_TRY(find_nodes(g, err));
    for (size_t i = 0; i < g->order_count; i++) BP_TRY(add_node(g, g->order[i], err));
    note_left_out(g);
    if (g->builder->polygon_count == 0)
        return gltf_fail(&g->data, "", err, "found no triangles in its scene, expected a mesh");
    return BP_OK;
}

BpStatus mesh_read_gltf(MeshBuilder *builder, BpError *err) {
    Gltf g = {.builder = builder, .last_node = SIZE_MAX};
    const BpStatus status = read_all(&g, err);
    gltf_clear(&g.data);
    free(g.nodes);
    free(g.order);
    free(g.materials);
    free(g.base_colors);
    free(g.maps);
    return status;
}

static BpStatus read_image(Input *input, const char *path, size_t number, unsigned char **bytes,
                           size_t *length, BpError *err) {
    GltfData data;
    GltfImage image = {0};
    BpStatus status = gltf_read(&data, input, path, err);
    if (status == BP_OK) status = gltf_image(&data, number, &image, err);
    if (status == BP_OK && image.bytes == NULL)
        status = gltf_fail(&data, "images", err,
                           "found image %zu in the file \"%.80s\", expected it inside: name that file",
                           number, image.name);
    if (status == BP_OK) {
        *bytes = malloc(image.length + 1);
        *length = image.length;
        status = *bytes != NULL ? BP_OK : gltf_fail_memory(err);
    }
    if (status == BP_OK) memcpy(*bytes, image.bytes, image.length);
    free(image.own);
    free(image.name);
    gltf_clear(&data);
    return status;
}

BpStatus bp_mesh_read_image(FILE *stream, const char *path, size_t number, unsigned char **bytes,
                            size_t *length, BpError *err) {
    Input input = {0};
    *bytes = NULL;
    BpStatus status = input_init(&input, stream, path, err);
    if (status == BP_OK) status = read_image(&input, path, number, bytes, length, err);
    input_clear(&input);
    return status;
}
