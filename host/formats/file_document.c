/* file_document.c: see file_document.h. */
#include "file_document.h"

#include "base/input_file.h"
#include "base/json_memory.h"
#include "base/known_file.h"
#include "mesh_triangles.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *base_name(const char *path) {
    const char *const slash = strrchr(path, '/');
    return slash != NULL ? slash + 1 : path;
}

/* Members that all such documents have. NULL: out of memory, or the name is not UTF-8. */
static json_t *begin(const char *name, const char *fit, const char *lighting) {
    return json_pack("{si, ss, ss, s{si, s[ii], si, si, si, ss, ss, sf}, ss, ss}", "format", 1, "title", name,
                     "source", "made by `ballpark scene`", "camera", "image_width", 800, "aspect_ratio", 4, 3,
                     "samples_per_pixel", 32, "max_depth", 20, "vfov", 30, "fit", fit, "view",
                     "three-quarter", "margin", 0.05, "lighting", lighting, "transfer", "srgb");
}

/* Takes `document`; NULL: it could not be made. */
static BpStatus finish(const char *path, json_t *document, char **text, BpError *err) {
    bool no_memory = false;
    *text = document != NULL ? json_dumps(document, JSON_INDENT(2) | JSON_PRESERVE_ORDER) : NULL;
    json_decref(document);
    if (*text != NULL) return BP_OK;
    char *const quoted = bp_json_quote(base_name(path), &no_memory);
    free(quoted);
    if (no_memory || bp_json_memory_failed())
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for a document");
    const BpStatus status =
        bp_fail(err, BP_ERR_SCENE,
                "found a name%s that is not UTF-8, expected UTF-8, as scene documents are: rename it",
                quoted != NULL ? " of a material" : "");
    bp_error_at(err, path, 0, 0);
    return status;
}

BpStatus bp_particle_document(const char *path, char **text, BpError *err) {
    json_t *document = begin(base_name(path), "particles", "soft");
    json_t *const particles = json_pack("[{ss}]", "file", base_name(path));
    if (document != NULL && json_object_set_new(document, "particles", particles) != 0) {
        json_decref(document);
        document = NULL;
    }
    return finish(path, document, text, err);
}

/* ---- meshes ---- */

/* ---- images of materials ---- */

/* Whether a file beside the mesh is an image that is read, by its first bytes. */
static bool is_image(const char *mesh_path, const char *name) {
    char begin[16], *const path = bp_path_beside(mesh_path, name);
    FILE *stream = NULL;
    uint64_t size = 0;
    bool found = false;
    if (path != NULL && bp_file_open(path, false, "an image", &stream, &size, NULL) == BP_OK) {
        found = bp_is_picture(begin, fread(begin, 1, sizeof begin, stream));
        fclose(stream);
    }
    free(path);
    return found;
}

/* Whether all faces of a material have texture coordinates. */
static bool has_coordinates(const BpMesh *mesh, uint32_t material) {
    for (size_t f = 0; f < mesh->face_count; f++)
        if (mesh->face_material[f] == material &&
            (mesh->face_coordinates == NULL || isnan(mesh->face_coordinates[f][0])))
            return false;
    return true;
}

/* Puts the material's image in place of its albedo, and into `textures`. What both multiply each other by is
 * kept if it is a number. */
static void offer_image(const BpMesh *mesh, uint32_t number, const char *path, json_t *material,
                        json_t *textures, char *note) {
    const BpMeshMaterial *const offer = &mesh->materials[number];
    const bool inside = offer->image_inside > 0;
    if ((offer->image_file == NULL && !inside) || json_object_get(material, "albedo") == NULL) return;
    const char *const why =
        !has_coordinates(mesh, number) ? "not all of its faces have texture coordinates"
        : !inside && !is_image(path, offer->image_file)
            ? "there is no such file that is a PNG, JPEG, OpenEXR, PFM or Radiance picture"
            : NULL;
    if (why != NULL) {
        snprintf(note, BP_DOCUMENT_NOTE_SIZE, "the image %.60s of the material \"%.60s\" is left out: %s",
                 inside ? "inside" : offer->image_file, offer->name, why);
        return;
    }
    const double *const kd = offer->kd;
    json_t *const texture =
        json_pack("{ss, ss}", "type", "image", "file", inside ? base_name(path) : offer->image_file);
    if (texture == NULL) return; /* said by finish() */
    if (inside) json_object_set_new(texture, "image", json_integer((json_int_t)offer->image_inside - 1));
    if (offer->image_clamped) json_object_set_new(texture, "wrap", json_string("clamp"));
    if (inside || !bp_path_has_ending(path, ".obj"))
        if (kd[0] > 0 && kd[0] < 1 && !(kd[1] < kd[0] || kd[1] > kd[0] || kd[2] < kd[0] || kd[2] > kd[0]))
            json_object_set_new(texture, "scale", json_real(kd[0]));
    json_object_set_new(textures, offer->name, texture);
    json_object_set_new(material, "albedo", json_pack("{ss}", "texture", offer->name));
}

/* ---- materials ---- */

static const double clay[3] = {0.6, 0.58, 0.55};

static json_t *matte(const double kd[3], const double ke[3]) {
    json_t *const material = json_pack("{ss, s[fff]}", "type", "lambertian", "albedo", fmin(kd[0], 1),
                                       fmin(kd[1], 1), fmin(kd[2], 1));
    if (material == NULL || !(ke[0] > 0 || ke[1] > 0 || ke[2] > 0)) return material;
    json_object_set_new(material, "emit",
                        json_pack("[fff]", fmin(ke[0], 1e6), fmin(ke[1], 1e6), fmin(ke[2], 1e6)));
    return material;
}

/* The metallic and rough surfaces of glTF: metals, or a base under a coat of index 1.5. */
static json_t *surface(const BpMeshMaterial *offer) {
    const double *const kd = offer->has_kd ? offer->kd : clay;
    json_t *const material =
        json_pack("{ss, s[fff], sf}", "type", offer->metallic >= 0.5 ? "metal" : "glossy", "albedo", kd[0],
                  kd[1], kd[2], "roughness", offer->roughness);
    if (material != NULL && offer->metallic < 0.5 && offer->has_ni && offer->ni > 1)
        json_object_set_new(material, "refraction_index", json_real(fmin(offer->ni, 3)));
    return material;
}

/* What the mesh's material `number` becomes. `note` gets those that are not closed. */
static BpStatus offered(const BpMesh *mesh, uint32_t number, const BpMeshUse *own, json_t **material,
                        char *note, BpError *err) {
    static const double none[3] = {0, 0, 0};
    const BpMeshMaterial *offer = &mesh->materials[number];
    if (offer->has_d && offer->d < 0.5) {
        BpMeshEdge edge;
        BP_TRY(bp_mesh_find_part_edge(mesh, own, number, &edge, err));
        if (edge.fault == BP_MESH_EDGE_GOOD) {
            const bool rough = offer->has_surface && offer->roughness > 0;
            *material = json_pack("{ss, sf}", "type", "dielectric", "refraction_index",
                                  offer->has_ni && offer->ni > 1 ? fmin(offer->ni, rough ? 10 : 100) : 1.5);
            if (rough) json_object_set_new(*material, "roughness", json_real(offer->roughness));
            return BP_OK;
        }
        snprintf(note, BP_DOCUMENT_NOTE_SIZE,
                 "the material \"%.80s\" lets no light in, although its opacity is %g: its faces are not "
                 "closed, as glass must "
                 "be",
                 offer->name, offer->d);
    }
    const bool shines = offer->has_ke && (offer->ke[0] > 0 || offer->ke[1] > 0 || offer->ke[2] > 0);
    *material = offer->has_surface && !shines
                    ? surface(offer)
                    : matte(offer->has_kd ? offer->kd : clay, offer->has_ke ? offer->ke : none);
    return BP_OK;
}

/* The materials that the faces of an OBJ or glTF file use, into `materials` and `mesh`, and their images into
 * `textures`, three objects. */
static BpStatus add_offers(const char *path, json_t *materials, json_t *textures, json_t *entry,
                           bool *all_have_one, char *note, BpError *err) {
    BpMesh mesh;
    BP_TRY(bp_mesh_read(path, &mesh, err));
    BpMeshUse own = {.name = path, .material = UINT32_MAX};
    uint32_t *const numbers = malloc((mesh.material_count + 1) * sizeof *numbers);
    json_t *const names = json_object();
    BpStatus status = numbers != NULL && names != NULL ? BP_OK : bp_fail(err, BP_ERR_MEMORY, "out of memory");
    for (uint32_t m = 0; m < mesh.material_count && numbers != NULL; m++) numbers[m] = m;
    own.materials = numbers;
    size_t with_one = 0;
    for (uint32_t m = 0; m < mesh.material_count && status == BP_OK; m++) {
        json_t *material = NULL;
        if (mesh.materials[m].face_count == 0) continue;
        with_one += mesh.materials[m].face_count;
        status = offered(&mesh, m, &own, &material, note, err);
        if (status == BP_OK) offer_image(&mesh, m, path, material, textures, note);
        if (status == BP_OK &&
            (json_object_set_new(materials, mesh.materials[m].name, material) != 0 ||
             json_object_set_new(names, mesh.materials[m].name, json_string(mesh.materials[m].name)) != 0))
            status = BP_ERR_SCENE; /* said by finish() */
    }
    *all_have_one = with_one > 0 && with_one == mesh.face_count;
    if (status == BP_OK && with_one > 0 && json_object_set(entry, "materials", names) != 0)
        status = BP_ERR_SCENE;
    /* In glTF, flat faces are those without normals. */
    if (status == BP_OK && mesh.face_normals != NULL && !bp_path_has_ending(path, ".obj"))
        json_object_set_new(entry, "smooth", json_true());
    json_decref(names);
    free(numbers);
    bp_mesh_clear(&mesh);
    return status;
}

/* "surface", or what no material of the file is called. */
static void add_clay(json_t *materials, json_t *entry) {
    static const double none[3] = {0, 0, 0};
    char name[32] = "surface";
    for (unsigned i = 2; json_object_get(materials, name) != NULL; i++)
        snprintf(name, sizeof name, "surface %u", i);
    json_object_set_new(materials, name, matte(clay, none));
    json_object_set_new(entry, "material", json_string(name));
}

BpStatus bp_mesh_document(const char *path, char **text, char note[BP_DOCUMENT_NOTE_SIZE], BpError *err) {
    json_t *document = begin(base_name(path), "scene", "studio");
    json_t *const entry = json_pack("{ss}", "file", base_name(path)), *const materials = json_object(),
                  *const textures = json_object();
    bool all_have_one = false,
         whole = document != NULL && entry != NULL && materials != NULL && textures != NULL;
    BpStatus status = BP_OK;
    note[0] = '\0';
    *text = NULL;
    if (whole && (bp_path_has_ending(path, ".obj") || bp_path_has_ending(path, ".gltf") ||
                  bp_path_has_ending(path, ".glb"))) {
        status = add_offers(path, materials, textures, entry, &all_have_one, note, err);
        whole = status == BP_OK;
        if (status != BP_OK && err != NULL && err->message[0] != '\0') goto done;
    }
    if (whole && !all_have_one) add_clay(materials, entry);
    if (whole && bp_path_has_ending(path, ".stl"))
        json_object_set_new(entry, "rotate", json_pack("[iii]", -90, 0, 0));
    if (whole && json_object_size(textures) > 0) whole = json_object_set(document, "textures", textures) == 0;
    whole = whole && json_object_set(document, "materials", materials) == 0 &&
            json_object_set_new(document, "meshes", json_pack("[O]", entry)) == 0 &&
            json_object_set_new(document, "shadow_catcher", json_true()) == 0;
    if (!whole) {
        json_decref(document);
        document = NULL;
    }
    status = finish(path, document, text, err);
    document = NULL;
done:
    json_decref(document);
    json_decref(entry);
    json_decref(materials);
    json_decref(textures);
    return status;
}
