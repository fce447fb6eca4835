/* camera_moves.c: see camera_moves.h. */
#include "camera_moves.h"

#include "vector.h"

#include <math.h>
#include <string.h>

#define PI 3.14159265358979323846
#define LEAST_POLE_DEGREES 1.0

/* Unit vectors: backwards from lookat to lookfrom, right, up; the distance. */
static double frame(const BpCamera *camera, double back[3], double right[3], double up[3]) {
    for (int i = 0; i < 3; ++i) back[i] = camera->lookfrom[i] - camera->lookat[i];
    const double distance = bp_normalize(back);
    bp_cross(camera->vup, back, right);
    bp_normalize(right);
    bp_cross(back, right, up);
    return distance;
}

/* The camera stands where somebody put it by hand. */
static void forget_fit(BpCamera *camera) {
    camera->fit = BP_FIT_NONE;
}

void bp_camera_orbit(BpCamera *camera, double degrees_right, double degrees_up) {
    double back[3], right[3], up[3], pole[3];
    const double distance = frame(camera, back, right, up);
    memcpy(pole, camera->vup, sizeof pole);
    bp_normalize(pole);
    /* In degrees from the pole and around it. */
    const double from_pole = acos(fmax(-1, fmin(1, bp_dot(back, pole)))) * 180 / PI;
    const double wanted = fmax(LEAST_POLE_DEGREES, fmin(180 - LEAST_POLE_DEGREES, from_pole - degrees_up));
    const double along = wanted * PI / 180, around = degrees_right * PI / 180;
    double level[3]; /* away from lookat, at a right angle to the pole */
    bp_cross(right, pole, level);
    bp_normalize(level);
    /* The right of the camera turns with it: level and right span the plane around the pole. */
    for (int i = 0; i < 3; ++i) {
        const double turned = cos(around) * level[i] + sin(around) * right[i];
        camera->lookfrom[i] = camera->lookat[i] + distance * (cos(along) * pole[i] + sin(along) * turned);
    }
    forget_fit(camera);
}

void bp_camera_pan(BpCamera *camera, double right_share, double down_share) {
    double back[3], right[3], up[3];
    const double distance = frame(camera, back, right, up);
    const double height = camera->projection == BP_ORTHOGRAPHIC && camera->view_height > 0
                              ? camera->view_height
                              : 2 * distance * tan(camera->vfov_degrees * PI / 360);
    for (int i = 0; i < 3; ++i) {
        const double by = height * (down_share * up[i] - right_share * right[i]);
        camera->lookfrom[i] += by;
        camera->lookat[i] += by;
    }
    forget_fit(camera);
}

void bp_camera_approach(BpCamera *camera, double factor) {
    double back[3], right[3], up[3];
    const double distance = frame(camera, back, right, up), wanted = distance * factor;
    if (!(wanted > 1e-9 && wanted < 1e12)) return;
    for (int i = 0; i < 3; ++i) camera->lookfrom[i] = camera->lookat[i] + wanted * back[i];
    camera->view_height *= factor; /* of parallel rays, which come no nearer */
    const double focus = camera->focus_dist + wanted - distance;
    if (focus > 0.01 * wanted) bp_camera_focus(camera, focus);
    forget_fit(camera);
}

void bp_camera_focus(BpCamera *camera, double distance) {
    if (!(distance > 1e-9 && distance < 1e12)) return;
    camera->lens_radius *= distance / camera->focus_dist;
    camera->focus_dist = distance;
}

void bp_camera_widen(BpCamera *camera, double factor) {
    const double least = 1e-4 * camera->focus_dist;
    if (camera->lens_radius == 0)
        camera->lens_radius = factor > 1 ? 10 * least : 0;
    else
        camera->lens_radius *= factor;
    if (camera->lens_radius < least) camera->lens_radius = 0;
    if (camera->lens_radius > camera->focus_dist) camera->lens_radius = camera->focus_dist;
}
