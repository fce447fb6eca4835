/* scene_fit.c: see scene_fit.h. */
#include "scene_fit.h"

#include "scene/fit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

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

static bool is_corner(const BpTriangle *triangle, const double vertex[3]) {
    for (int k = 0; k < 3; k++) {
        const double *const own = triangle->vertices[k];
        if (own[0] == vertex[0] && own[1] == vertex[1] && own[2] == vertex[2]) return true;
    }
    return false;
}

/* Spheres that move once more, where they end, the vertices of triangles as points, but for those that the
 * triangle before has too, and the ends of capsules. */
static BpStatus copy_balls(const BpScene *scene, bool all, size_t first, BpSphere **made, size_t *count,
                           BpError *err) {
    size_t from = 0, to = scene->triangle_count;
    if (!all) bp_scene_particle_triangles(scene, &from, &to);
    const size_t moving = first < scene->moving_count ? scene->moving_count : first,
                 vertices = 3 * (to - from), bonds = all ? 0 : scene->listed_capsules;
    *count = scene->sphere_count - first + moving - first + vertices + 2 * (scene->capsule_count - bonds);
    BpSphere *next = *made = malloc((*count + 1) * sizeof **made);
    if (next == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for %zu spheres", *count);
    for (size_t i = first; i < scene->sphere_count; i++) *next++ = scene->spheres[i];
    for (size_t i = first; i < moving; i++, next++) {
        *next = scene->spheres[i];
        memcpy(next->center, scene->center_ends[i], sizeof next->center);
    }
    for (size_t i = 0; i < vertices; i++) {
        const BpTriangle *const triangle = &scene->triangles[from + i / 3];
        const double *const vertex = triangle->vertices[i % 3];
        if (i >= 3 && is_corner(triangle - 1, vertex)) continue;
        *next = (BpSphere){.radius = 0};
        memcpy(next->center, vertex, sizeof next->center);
        next++;
    }
    for (size_t i = 2 * bonds; i < 2 * scene->capsule_count; i++, next++) {
        *next = (BpSphere){.radius = scene->capsules[i / 2].radius};
        memcpy(next->center, scene->capsules[i / 2].ends[i % 2], sizeof next->center);
    }
    *count = (size_t)(next - *made);
    return BP_OK;
}

BpStatus bp_scene_fitted(const BpScene *scene, const BpSphere **balls, size_t *count, BpSphere **made,
                         BpError *err) {
    const bool all = scene->camera.fit == BP_FIT_SCENE;
    const size_t first = all ? 0 : scene->particle_first;
    *made = NULL;
    *balls = scene->spheres + first;
    *count = scene->sphere_count - first;
    if (first >= scene->moving_count && scene->capsule_count == 0 && scene->triangle_count == 0) return BP_OK;
    BP_TRY(copy_balls(scene, all, first, made, count, err));
    *balls = *made;
    return BP_OK;
}

BpStatus bp_scene_fit_camera(const BpNode *node, const BpSceneChanges *changes, BpScene *scene,
                             BpError *err) {
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
    double direction[3];
    if (!all && !scene->has_particles)
        return bp_node_fail(&fit, BP_PART_VALUE, err,
                            "found \"particles\", but the scene has none; expected \"scene\", or particles");
    bp_scene_view(scene, direction);
    const BpSphere *spheres;
    BpSphere *made;
    size_t count;
    BP_TRY(bp_scene_fitted(scene, &spheres, &count, &made, err));
    if (count == 0 && changes->film != NULL && changes->film->looking) { /* the other frames tell */
        free(made);
        return BP_OK;
    }
    BpError inner = {0};
    const BpStatus status = changes->turning > 0
                                ? bp_camera_fit_turning(spheres, count, direction, camera->margin,
                                                        changes->turning, camera, &inner)
                                : bp_camera_fit(spheres, count, direction, camera->margin, camera, &inner);
    free(made);
    if (status == BP_OK) return BP_OK;
    bp_node_fail(fit.value != NULL ? &fit : node, BP_PART_VALUE, err, "%s", inner.message);
    bp_error_clear(&inner);
    return status;
}
