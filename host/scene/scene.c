/* scene.c: the life of a BpScene, and what the public header says of it; see scene.h and ballpark.h. */
#include "scene.h"
#include "base/escape.h"
#include "base/message_text.h"
#include "base/status.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846

uint32_t bp_camera_height(uint32_t width, double aspect_ratio) {
    /* The 1e-6 forgives the rounding of ratios such as 16.0/9.0. */
    const double height = floor(width / aspect_ratio + 1e-6);
    if (!(height >= 1)) return 1;
    return height >= UINT32_MAX ? UINT32_MAX : (uint32_t)height;
}

uint32_t bp_camera_width_of(uint64_t pixels, double aspect_ratio) {
    uint32_t least = 0, most = BP_PICTURE_SIDE_MAX;
    while (least < most) {
        const uint32_t width = least + (most - least + 1) / 2;
        if ((uint64_t)width * bp_camera_height(width, aspect_ratio) <= pixels)
            least = width;
        else
            most = width - 1;
    }
    return least;
}

void bp_background_up(const BpScene *scene, double up[3]) {
    static const double y[3] = {0, 1, 0};
    const double *const own = scene->background_up;
    const double largest = fmax(fabs(own[0]), fmax(fabs(own[1]), fabs(own[2])));
    double length = 0;
    for (int i = 0; i < 3; i++) up[i] = largest > 0 ? own[i] / largest : y[i];
    for (int i = 0; i < 3; i++) length += up[i] * up[i];
    for (int i = 0; i < 3; i++) up[i] /= sqrt(length);
}

void bp_environment_frame(const BpScene *scene, double seam[3], double east[3], double pole[3]) {
    BpTexture frame = {.turn_degrees = scene->environment_turn};
    bp_background_up(scene, frame.up);
    bp_texture_frame(&frame, east, seam, pole); /* exchanged, since it is seen from inside */
}

double bp_sphere_refraction_index(const BpScene *scene, size_t sphere) {
    const BpMaterial *material = &scene->materials[scene->spheres[sphere].material];
    if (material->kind != BP_MATERIAL_DIELECTRIC) return 0;
    return scene->spheres[sphere].radius < 0 ? 1 / material->refraction_index : material->refraction_index;
}

double bp_camera_plane_height(const BpCamera *camera) {
    const double tangent = tan(camera->vfov_degrees * (PI / 360));
    double distance = 0;
    if (camera->projection == BP_PERSPECTIVE) return 2 * camera->focus_dist * tangent;
    if (camera->view_height > 0) return camera->view_height;
    for (int i = 0; i < 3; i++) distance = hypot(distance, camera->lookat[i] - camera->lookfrom[i]);
    return 2 * distance * tangent;
}

double bp_camera_origin(const BpScene *scene, double origin[3]) {
    const BpCamera *const camera = &scene->camera;
    double ahead[3], length = 0, nearest = INFINITY;
    memcpy(origin, camera->lookfrom, sizeof camera->lookfrom);
    if (camera->projection == BP_PERSPECTIVE) return 0;
    if (bp_scene_medium(scene) != 0) return 0; /* rays fly through it from the camera on */
    for (int i = 0; i < 3; i++) {
        ahead[i] = camera->lookat[i] - camera->lookfrom[i];
        length = hypot(length, ahead[i]);
    }
    for (int i = 0; i < 3; i++) ahead[i] /= length;
    for (size_t s = 0; s < scene->sphere_count; s++) {
        double distance = -fabs(scene->spheres[s].radius);
        for (int i = 0; i < 3; i++) distance += ahead[i] * (scene->spheres[s].center[i] - origin[i]);
        nearest = fmin(nearest, distance);
        if (!bp_sphere_moves(scene, s)) continue;
        const double *end = bp_sphere_end(scene, s);
        for (int i = 0; i < 3; i++) distance += ahead[i] * (end[i] - scene->spheres[s].center[i]);
        nearest = fmin(nearest, distance);
    }
    for (size_t t = 0; t < scene->triangle_count; t++)
        for (int k = 0; k < 3; k++) {
            double distance = 0;
            for (int i = 0; i < 3; i++)
                distance += ahead[i] * (scene->triangles[t].vertices[k][i] - origin[i]);
            nearest = fmin(nearest, distance);
        }
    for (size_t c = 0; c < scene->capsule_count; c++)
        for (int k = 0; k < 2; k++) {
            double distance = -scene->capsules[c].radius;
            for (int i = 0; i < 3; i++) distance += ahead[i] * (scene->capsules[c].ends[k][i] - origin[i]);
            nearest = fmin(nearest, distance);
        }
    const double moved = isfinite(nearest) ? nearest - bp_camera_plane_height(camera) : 0;
    if (!(moved > 0)) return 0;
    for (int i = 0; i < 3; i++) origin[i] += moved * ahead[i];
    return moved;
}

double bp_lens_radius(double defocus_degrees, double focus_dist) {
    return focus_dist * tan(defocus_degrees * (PI / 180) / 2);
}

void bp_camera_defaults(BpCamera *camera) {
    *camera = (BpCamera){.width = 100,
                         .height = 100,
                         .aspect_ratio = 1,
                         .samples_per_pixel = 10,
                         .max_depth = 10,
                         .vfov_degrees = 90,
                         .lookat = {0, 0, -1},
                         .vup = {0, 1, 0},
                         .focus_dist = 10,
                         .pixel_sampling = BP_PIXEL_SQUARE};
}

BpStatus bp_copy_text(const char *text, char **copy, BpError *err) {
    const size_t size = text != NULL ? strlen(text) + 1 : 1;
    free(*copy);
    *copy = malloc(size);
    if (*copy == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for a text of %zu bytes", size);
    memcpy(*copy, text != NULL ? text : "", size);
    return BP_OK;
}

BpStatus bp_scene_create_empty(const char *path, BpScene **scene, BpError *err) {
    BpScene *result = calloc(1, sizeof *result);
    *scene = NULL;
    if (result == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for a scene");
    bp_camera_defaults(&result->camera);
    for (int i = 0; i < 3; i++) {
        static const double bottom[3] = {1, 1, 1}, top[3] = {0.5, 0.7, 1.0}; /* the book's sky */
        result->background_bottom[i] = bottom[i];
        result->background_top[i] = top[i];
    }
    result->transfer = BP_TRANSFER_GAMMA2;
    result->implicit_material = SIZE_MAX;
    result->up = 1;
    BpStatus status = bp_copy_text(path, &result->path, err);
    if (status == BP_OK) status = bp_copy_text("", &result->notes, err);
    if (status == BP_OK) status = bp_copy_text("", &result->title, err);
    if (status == BP_OK) status = bp_copy_text("", &result->source, err);
    if (status != BP_OK) {
        bp_scene_destroy(&result);
        return status;
    }
    *scene = result;
    return BP_OK;
}

static void free_files(BpShapeFile *files, size_t count) {
    for (size_t i = 0; i < count; i++) {
        free(files[i].file);
        free(files[i].entry);
    }
    free(files);
}

void bp_scene_destroy(BpScene **scene) {
    if (scene == NULL || *scene == NULL) return;
    BpScene *s = *scene;
    for (size_t i = 0; i < s->material_count; i++) free(s->materials[i].name);
    free(s->materials);
    for (size_t i = 0; i < s->texture_count; i++) free(s->textures[i].name);
    free(s->textures);
    for (size_t i = 0; i < s->image_count; i++) bp_texels_destroy(&s->images[i]);
    free(s->images);
    free(s->spheres);
    free(s->triangles);
    free(s->normals);
    free(s->coordinates);
    free(s->capsules);
    free(s->center_ends);
    free(s->interiors);
    free(s->triangle_interiors);
    free(s->capsule_interiors);
    bp_bodies_clear(&s->bodies);
    for (size_t i = 0; i < s->medium_count; i++) free(s->media[i].name);
    free(s->media);
    free(s->albedos);
    free_files(s->point_files, s->point_file_count);
    free_files(s->mesh_files, s->mesh_file_count);
    free_files(s->line_sets, s->line_set_count);
    free(s->path);
    free(s->title);
    free(s->source);
    free(s->notes);
    free(s);
    *scene = NULL;
}

BpStatus bp_scene_note(BpScene *scene, const char *file, const char *text, BpError *err) {
    /* Escaped, since the ends of lines are those of notes. */
    const size_t used = strlen(scene->notes), file_size = BP_ESCAPED_SIZE(strlen(file)),
                 text_size = BP_ESCAPED_SIZE(strlen(text));
    char *const notes = realloc(scene->notes, used + file_size + text_size + 3);
    if (notes == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for notes");
    scene->notes = notes;
    char *end = notes + used;
    end += strlen(bp_escape(file, end, file_size));
    memcpy(end, ": ", 2);
    end += 2;
    end += strlen(bp_escape(text, end, text_size));
    memcpy(end, "\n", 2);
    return BP_OK;
}

/* The one that a shape comes from, or NULL. */
static const BpShapeFile *file_of(const BpShapeFile *files, size_t count, size_t shape) {
    const BpShapeFile *found = NULL;
    for (size_t i = 0; i < count && files[i].first <= shape; i++) found = &files[i];
    return found;
}

const char *bp_sphere_name(const BpScene *scene, size_t sphere, char text[BP_SPHERE_NAME_SIZE]) {
    const BpShapeFile *cloud = file_of(scene->point_files, scene->point_file_count, sphere);
    char file[64];
    if (cloud == NULL) {
        snprintf(text, BP_SPHERE_NAME_SIZE, "spheres[%zu]", sphere);
    } else {
        bp_printable(cloud->file, file, sizeof file);
        snprintf(text, BP_SPHERE_NAME_SIZE, "%s %zu (from 0) of %s",
                 cloud->entry != NULL || cloud->in_memory ? "sphere" : "vertex", sphere - cloud->first, file);
    }
    return text;
}

size_t bp_scene_listed_triangles(const BpScene *scene) {
    return scene->mesh_file_count > 0 ? scene->mesh_files[0].first : scene->triangle_count;
}

void bp_scene_particle_triangles(const BpScene *scene, size_t *first, size_t *end) {
    size_t mesh = 0;
    while (mesh < scene->mesh_file_count && !scene->mesh_files[mesh].of_particles) mesh++;
    *first = mesh < scene->mesh_file_count ? scene->mesh_files[mesh].first : scene->triangle_count;
    while (mesh < scene->mesh_file_count && scene->mesh_files[mesh].of_particles) mesh++;
    *end = mesh < scene->mesh_file_count ? scene->mesh_files[mesh].first : scene->triangle_count;
}

const char *bp_triangle_name(const BpScene *scene, size_t triangle, char text[BP_SPHERE_NAME_SIZE]) {
    const size_t of_boxes = scene->box_count * BP_BOX_TRIANGLES,
                 of_quads = scene->quad_count * BP_QUAD_TRIANGLES;
    const size_t listed = bp_scene_listed_triangles(scene) - of_boxes - of_quads;
    const BpShapeFile *mesh = file_of(scene->mesh_files, scene->mesh_file_count, triangle);
    char file[64];
    if (mesh != NULL) {
        bp_printable(mesh->file, file, sizeof file);
        snprintf(text, BP_SPHERE_NAME_SIZE, "triangle %zu (from 0) of %s", triangle - mesh->first, file);
    } else if (triangle < listed)
        snprintf(text, BP_SPHERE_NAME_SIZE, "triangles[%zu]", triangle);
    else if (triangle < listed + of_quads)
        snprintf(text, BP_SPHERE_NAME_SIZE, "quads[%zu]", (triangle - listed) / BP_QUAD_TRIANGLES);
    else
        snprintf(text, BP_SPHERE_NAME_SIZE, "boxes[%zu]", (triangle - listed - of_quads) / BP_BOX_TRIANGLES);
    return text;
}

BpStatus bp_scene_make_normals(BpScene *scene, size_t count, BpError *err) {
    if (count <= scene->normal_count) return BP_OK;
    float(*const normals)[3][3] = realloc(scene->normals, count * sizeof *normals);
    if (normals == NULL)
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for the normals of %zu triangles", count);
    memset(normals + scene->normal_count, 0, (count - scene->normal_count) * sizeof *normals);
    scene->normals = normals;
    scene->normal_count = count;
    return BP_OK;
}

BpStatus bp_scene_make_coordinates(BpScene *scene, size_t count, BpError *err) {
    if (count <= scene->coordinate_count) return BP_OK;
    float(*const coordinates)[6] = realloc(scene->coordinates, count * sizeof *coordinates);
    if (coordinates == NULL)
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for the texture coordinates of %zu triangles",
                       count);
    for (size_t i = scene->coordinate_count; i < count; i++)
        for (int k = 0; k < 6; k++) coordinates[i][k] = NAN;
    scene->coordinates = coordinates;
    scene->coordinate_count = count;
    return BP_OK;
}

bool bp_material_is_mapped(const BpScene *scene, const BpMaterial *material) {
    for (int m = 0; m < BP_MEMBER_COUNT; m++) {
        const uint32_t number = material->texture[m];
        if (number != 0 && scene->textures[number - 1].mapping == BP_MAPPING_SURFACE) return true;
    }
    return false;
}

size_t bp_scene_mapped_triangles(const BpScene *scene) {
    size_t count = 0;
    for (size_t i = 0; i < scene->coordinate_count; i++)
        count += bp_triangle_coordinates(scene, i) != NULL &&
                 bp_material_is_mapped(scene, &scene->materials[scene->triangles[i].material]);
    return count;
}

BpStatus bp_make_interiors(size_t count, uint32_t **interiors, size_t *interior_count, BpError *err) {
    const size_t before = *interior_count;
    if (count <= before) return BP_OK;
    uint32_t *const grown = realloc(*interiors, count * sizeof *grown);
    if (grown == NULL)
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for the interiors of %zu shapes", count);
    memset(grown + before, 0, (count - before) * sizeof *grown);
    *interiors = grown;
    *interior_count = count;
    return BP_OK;
}

const char *bp_capsule_name(const BpScene *scene, size_t capsule, char text[BP_SPHERE_NAME_SIZE]) {
    const size_t listed = scene->listed_capsules;
    const BpShapeFile *set = file_of(scene->line_sets, scene->line_set_count, capsule);
    char name[64];
    if (set != NULL) {
        bp_printable(set->file, name, sizeof name);
        snprintf(text, BP_SPHERE_NAME_SIZE, "line %zu (from 0) of %s", capsule - set->first, name);
    } else if (capsule < listed)
        snprintf(text, BP_SPHERE_NAME_SIZE, "capsules[%zu]", capsule);
    else
        snprintf(text, BP_SPHERE_NAME_SIZE, "capsule %zu (from 0) of the particles", capsule - listed);
    return text;
}

const char *bp_shape_name(const BpScene *scene, size_t shape, char text[BP_SPHERE_NAME_SIZE]) {
    const size_t others = scene->sphere_count + scene->triangle_count;
    if (shape < scene->sphere_count) return bp_sphere_name(scene, shape, text);
    if (shape < others) return bp_triangle_name(scene, shape - scene->sphere_count, text);
    return bp_capsule_name(scene, shape - others, text);
}

size_t bp_scene_emitting_triangles(const BpScene *scene) {
    size_t count = 0;
    for (size_t t = 0; t < scene->triangle_count; t++)
        count += bp_shape_emits(scene, scene->sphere_count + t);
    return count;
}

const char *bp_scene_noun(const BpScene *scene) {
    const size_t all = bp_scene_shapes(scene);
    if (scene->sphere_count == all) return "sphere";
    if (scene->triangle_count == all) return "triangle";
    return scene->capsule_count == all ? "capsule" : "shape";
}

BpStatus bp_scene_set_width(BpScene *scene, uint32_t width, BpError *err) {
    if (width < 1 || width > BP_PICTURE_SIDE_MAX)
        return bp_fail(err, BP_ERR_USAGE, "width: found %u, expected 1 to %u pixels", (unsigned)width,
                       BP_PICTURE_SIDE_MAX);
    const uint32_t height = bp_camera_height(width, scene->camera.aspect_ratio);
    if (height > BP_PICTURE_SIDE_MAX)
        return bp_fail(err, BP_ERR_USAGE,
                       "width: found %u, which makes the picture %u pixels high, expected at most %u",
                       (unsigned)width, (unsigned)height, BP_PICTURE_SIDE_MAX);
    scene->camera.width = width;
    scene->camera.height = height;
    return BP_OK;
}

void bp_scene_info(const BpScene *scene, BpSceneInfo *info) {
    *info = (BpSceneInfo){.title = scene->title,
                          .source = scene->source,
                          .width = scene->camera.width,
                          .height = scene->camera.height,
                          .samples_per_pixel = scene->camera.samples_per_pixel,
                          .max_depth = scene->camera.max_depth,
                          .spheres = scene->sphere_count,
                          .materials = scene->material_count,
                          .transfer = scene->transfer,
                          .triangles = scene->triangle_count,
                          .capsules = scene->capsule_count};
}

void bp_scene_camera(const BpScene *scene, BpCameraInfo *info) {
    const BpCamera *const camera = &scene->camera;
    *info = (BpCameraInfo){
        .vfov = camera->vfov_degrees, .aperture = 2 * camera->lens_radius, .focus_dist = camera->focus_dist};
    memcpy(info->lookfrom, camera->lookfrom, sizeof info->lookfrom);
    memcpy(info->lookat, camera->lookat, sizeof info->lookat);
    memcpy(info->vup, camera->vup, sizeof info->vup);
}
