/* bench_scenes.c: see bench_scenes.h.
 *
 * cover      the fourth edition's cover: every material, a lens
 * diffuse    the same spheres, metal and glass made matte: short paths, no choices
 * glass      the same spheres, all glass but for the ground: long paths that part
 * field-N    N matte spheres of their own colours in a cube, seen from outside; alike at any N, so that the
 *            figures show what the number of spheres costs */
#include "bench_scenes.h"

#include "base/output_file.h"
#include "formats/field.h"
#include "scene/scene.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { GRID = 11, SEED = 1, WIDTH = 400, SAMPLES = 64 };

static const char field_document[] =
    "{\n"
    "  \"format\": 1,\n"
    "  \"title\": \"bench: %s\",\n"
    "  \"camera\": { \"image_width\": 400, \"aspect_ratio\": [16, 9], \"samples_per_pixel\": 64,\n"
    "              \"max_depth\": 50, \"vfov\": 26, \"lookfrom\": [30, 18, 26] },\n"
    "  \"materials\": { \"clay\": { \"type\": \"lambertian\", \"albedo\": [0.7, 0.6, 0.5] } },\n"
    "  \"clouds\": [ { \"file\": \"%s.ply\", \"material\": \"clay\" } ]\n"
    "}\n";

const char *const bp_bench_scene_names[] = {"cover", "diffuse", "glass", "field-1e4", "field-1e6", NULL};

/* The number of spheres of a field; 0: not a field. */
static uint64_t field_count(const char *name) {
    if (strncmp(name, "field-", 6) != 0 || name[6] < '1' || name[6] > '9') return 0;
    char *end = NULL;
    const double count = strtod(name + 6, &end);
    return *end == '\0' && count >= 1 && count <= BP_SPHERES_MAX ? (uint64_t)count : 0;
}

bool bp_bench_scene_known(const char *name) {
    return strcmp(name, "cover") == 0 || strcmp(name, "diffuse") == 0 || strcmp(name, "glass") == 0 ||
           field_count(name) != 0;
}

static BpStatus join(const char *folder, const char *name, const char *ending, char *path, size_t size,
                     BpError *err) {
    const int length = snprintf(path, size, "%s/%s%s", folder, name, ending);
    if (length > 0 && (size_t)length < size) return BP_OK;
    return bp_fail(err, BP_ERR_FILE, "the name of the folder %.80s... is too long", folder);
}

static void make_matte(BpMaterial *material) {
    if (material->kind == BP_MATERIAL_DIELECTRIC)
        for (int k = 0; k < 3; ++k) material->albedo[k] = 0.9;
    material->kind = BP_MATERIAL_LAMBERTIAN;
    material->scatter = BP_SCATTER_LAMBERTIAN;
}

static void make_glass(BpMaterial *material) {
    material->kind = BP_MATERIAL_DIELECTRIC;
    material->refraction_index = 1.5;
    material->fresnel = BP_FRESNEL_SCHLICK;
    material->total_reflection = BP_TOTAL_REFLECT;
}

static BpStatus write_cover(const char *name, const char *path, BpError *err) {
    BpScene *scene = NULL;
    BP_TRY(bp_scene_generate_cover("4", GRID, SEED, &scene, err));
    BpStatus status = bp_scene_set_width(scene, WIDTH, err);
    if (status != BP_OK) goto done;
    scene->camera.samples_per_pixel = SAMPLES;
    const uint32_t ground = scene->spheres[0].material;
    for (uint32_t m = 0; m < scene->material_count; ++m) {
        if (strcmp(name, "diffuse") == 0) make_matte(&scene->materials[m]);
        if (strcmp(name, "glass") == 0 && m != ground) make_glass(&scene->materials[m]);
    }
    status = bp_scene_write(scene, path, err);
done:
    bp_scene_destroy(&scene);
    return status;
}

static BpStatus write_field(const char *name, const char *folder, const char *path, BpError *err) {
    char cloud[4096];
    BP_TRY(join(folder, name, ".ply", cloud, sizeof cloud, err));
    if (access(cloud, R_OK) == 0 && access(path, R_OK) == 0) return BP_OK;
    BP_TRY(bp_field_write_ply(field_count(name), SEED, cloud, err));
    BpOutputFile file;
    BP_TRY(bp_output_open(path, &file, err));
    if (fprintf(file.stream, field_document, name, name) < 0) {
        const BpStatus status = bp_output_fail(err, "write", path, errno);
        bp_output_discard(&file);
        return status;
    }
    return bp_output_commit(&file, err);
}

BpStatus bp_bench_scene_write(const char *name, const char *folder, char *path, size_t path_size,
                              BpError *err) {
    BP_TRY(join(folder, name, ".json", path, path_size, err));
    return field_count(name) != 0 ? write_field(name, folder, path, err) : write_cover(name, path, err);
}
