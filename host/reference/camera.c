/* camera.c: the fourth edition's camera; see trace.h. */
#include "trace.h"

Camera bp_ref_camera(const BpCamera *scene_camera) {
    const double pi = 3.14159265358979323846;
    const bool orthographic = scene_camera->projection == BP_ORTHOGRAPHIC;
    const double distance = orthographic
                                ? sqrt(length2(sub(vec(scene_camera->lookat), vec(scene_camera->lookfrom))))
                                : scene_camera->focus_dist;
    double viewport_height = 2 * tan(scene_camera->vfov_degrees * pi / 360) * distance;
    if (orthographic && scene_camera->view_height > 0) viewport_height = scene_camera->view_height;
    const double viewport_width = viewport_height * scene_camera->width / scene_camera->height;
    const Vec from = vec(scene_camera->lookfrom);
    const Vec w = unit(sub(from, vec(scene_camera->lookat)));
    const Vec u = unit(cross(vec(scene_camera->vup), w)), v = cross(w, u);
    const Vec across = scale(viewport_width, u), down = scale(-viewport_height, v);

    Camera camera = {.origin = from,
                     .rows = scene_camera->height,
                     .center = scene_camera->pixel_sampling == BP_PIXEL_CENTER};
    camera.pixel_right = scale(1.0 / scene_camera->width, across);
    camera.pixel_down = scale(1.0 / scene_camera->height, down);
    const Vec corner =
        sub(sub(sub(from, scale(scene_camera->focus_dist, w)), scale(0.5, across)), scale(0.5, down));
    camera.first_pixel = add(corner, scale(0.5, add(camera.pixel_right, camera.pixel_down)));
    camera.orthographic = orthographic;
    camera.ahead = scale(-scene_camera->focus_dist, w);
    camera.lens = scene_camera->lens_radius > 0;
    camera.lens_right = scale(scene_camera->lens_radius, u);
    camera.lens_up = scale(scene_camera->lens_radius, v);
    return camera;
}

Ray bp_ref_camera_ray(const Camera *camera, uint32_t column, uint32_t row, Random *random, double *height) {
    const double x = column + (camera->center ? 0 : random_between(random, -0.5, 0.5));
    const double y = row + (camera->center ? 0 : random_between(random, -0.5, 0.5));
    *height = 1 - (y + 0.5) / camera->rows;
    const Vec target =
        add(add(camera->first_pixel, scale(x, camera->pixel_right)), scale(y, camera->pixel_down));
    Vec origin = camera->orthographic ? sub(target, camera->ahead) : camera->origin;
    if (camera->lens) {
        const Vec p = random_in_disk(random);
        origin = add(add(origin, scale(p.x, camera->lens_right)), scale(p.y, camera->lens_up));
    }
    return (Ray){.origin = origin, .direction = sub(target, origin)};
}
