/* scene.c: the life of a BpScene, and what the public header says of it; see scene.h and ballpark.h. */
#include "scene_file.h"
#include "scene_parse.h"

#include <stdlib.h>
#include <string.h>

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
    BpStatus status = bp_copy_text(path, &result->path, err);
    if (status == BP_OK) status = bp_copy_text("", &result->title, err);
    if (status == BP_OK) status = bp_copy_text("", &result->source, err);
    if (status != BP_OK) {
        bp_scene_destroy(&result);
        return status;
    }
    *scene = result;
    return BP_OK;
}

BpStatus bp_scene_load(const char *path, BpScene **scene, BpError *err) {
    char *text = NULL;
    size_t length = 0;
    *scene = NULL;
    BP_TRY(bp_file_read(path, "a scene document (a JSON file)", &text, &length, err));
    const BpStatus status = bp_scene_parse(text, length, path, scene, err);
    free(text);
    return status;
}

void bp_scene_destroy(BpScene **scene) {
    if (scene == NULL || *scene == NULL) return;
    BpScene *s = *scene;
    for (size_t i = 0; i < s->material_count; i++) free(s->materials[i].name);
    free(s->materials);
    free(s->spheres);
    free(s->albedos);
    for (size_t i = 0; i < s->cloud_count; i++) free(s->clouds[i].file);
    free(s->clouds);
    free(s->path);
    free(s->title);
    free(s->source);
    free(s);
    *scene = NULL;
}

const char *bp_sphere_name(const BpScene *scene, size_t sphere, char text[BP_SPHERE_NAME_SIZE]) {
    const BpCloud *cloud = NULL;
    char file[64];
    for (size_t i = 0; i < scene->cloud_count && scene->clouds[i].first <= sphere; i++)
        cloud = &scene->clouds[i];
    if (cloud == NULL) {
        snprintf(text, BP_SPHERE_NAME_SIZE, "spheres[%zu]", sphere);
    } else {
        bp_printable(cloud->file, file, sizeof file);
        snprintf(text, BP_SPHERE_NAME_SIZE, "vertex %zu (from 0) of %s", sphere - cloud->first, file);
    }
    return text;
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
                          .transfer = scene->transfer};
}
