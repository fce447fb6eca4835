/* fit.c: see fit.h. */
#include "fit.h"

#include "vector.h"

#include <math.h>
#include <string.h>

#define PI 3.14159265358979323846

const char *const bp_projection_names[2] = {"perspective", "orthographic"};

const char *const bp_view_names[BP_VIEW_COUNT] = {"",     "three-quarter", "front", "back",
                                                  "left", "right",         "top",   "bottom"};

void bp_view_direction(BpView view, int up, double direction[3]) {
    /* right, up, towards the viewer who stands in front */
    static const double directions[BP_VIEW_COUNT][3] = {
        [BP_VIEW_NONE] = {0, 0, 1},  [BP_VIEW_THREE_QUARTER] = {0.6, 0.45, 1},
        [BP_VIEW_FRONT] = {0, 0, 1}, [BP_VIEW_BACK] = {0, 0, -1},
        [BP_VIEW_LEFT] = {-1, 0, 0}, [BP_VIEW_RIGHT] = {1, 0, 0},
        [BP_VIEW_TOP] = {0, 1, 0},   [BP_VIEW_BOTTOM] = {0, -1, 0}};
    const double *const d = directions[view];
    const double y_up[3] = {d[0], d[1], d[2]}, z_up[3] = {d[0], -d[2], d[1]}, x_up[3] = {d[1], -d[0], d[2]};
    memcpy(direction, up == 2 ? z_up : up == 1 ? y_up : x_up, sizeof y_up);
}

/* False: `v` has no direction to speak of. */
static bool normalize(double v[3]) {
    const double length = bp_normalize(v);
    return length > 1e-30 && isfinite(length);
}

void bp_turn_around(const double axis[3], double degrees, double direction[3]) {
    double along[3] = {axis[0], axis[1], axis[2]}, across[3];
    if (degrees == 0 || !normalize(along)) return;
    /* O. Rodrigues 1840 */
    const double angle = degrees * (PI / 180), share = bp_dot(along, direction) * (1 - cos(angle));
    bp_cross(along, direction, across);
    for (int i = 0; i < 3; i++)
        direction[i] = direction[i] * cos(angle) + across[i] * sin(angle) + along[i] * share;
}

/* The camera's axes: u right, v up, w towards the camera. Replaces a vup along the view. */
static bool basis(const double direction[3], double vup[3], double axes[3][3]) {
    memcpy(axes[2], direction, sizeof axes[2]);
    if (!normalize(axes[2])) return false;
    bp_cross(vup, axes[2], axes[0]);
    const double sine = hypot(hypot(axes[0][0], axes[0][1]), axes[0][2]);
    if (!(sine > 1e-6 * hypot(hypot(vup[0], vup[1]), vup[2]))) {
        /* Seen from above, what lies further back is up in the picture; seen from below, what lies nearer. */
        const double against = vup[2] != 0 ? 1 : -1;
        const double instead[3] = {0, vup[2] != 0 ? 1 : 0, vup[2] != 0 ? 0 : 1};
        const double sign = against * (bp_dot(vup, axes[2]) > 0 ? 1 : -1);
        for (int i = 0; i < 3; i++) vup[i] = sign * instead[i];
        bp_cross(vup, axes[2], axes[0]);
    }
    if (!normalize(axes[0])) return false;
    bp_cross(axes[2], axes[0], axes[1]);
    return true;
}

/* A sphere lies inside a plane through the camera's place e, with the unit normal n pointing inwards, where
 * n.(c - e) >= r. So the least of n.c - r over the spheres says where the plane, and with it e, may lie. The
 * planes at two opposite sides of the picture have the normals (-+cos a, -sin a) across and along the view, a
 * being half the angle between them; together they give the least distance at which both hold, and the place
 * between them. */
static double plane_value(const BpFitting *f, const double place[3], double radius, int axis, int side) {
    const double cosine = 1 / sqrt(1 + f->tangents[axis] * f->tangents[axis]),
                 sine = f->tangents[axis] * cosine;
    return (side == 0 ? -cosine : cosine) * place[axis] - sine * place[2] - radius;
}

BpStatus bp_fitting_begin(const BpCamera *camera, const double direction[3], double margin,
                          BpFitting *fitting, BpError *err) {
    *fitting = (BpFitting){.nearest = -INFINITY, .farthest = INFINITY};
    memcpy(fitting->vup, camera->vup, sizeof fitting->vup);
    if (!basis(direction, fitting->vup, fitting->axes))
        return bp_fail(err, BP_ERR_SCENE, "found no direction, expected one such as [1, 1, 1]");
    fitting->orthographic = camera->projection == BP_ORTHOGRAPHIC;
    fitting->aspect = (double)camera->width / camera->height;
    fitting->room = 1 - 2 * margin;
    /* Parallel rays leave no angle between the sides; their distance is found at the end. */
    const double half = fitting->orthographic ? 0 : tan(camera->vfov_degrees * (PI / 360)) * (1 - 2 * margin);
    fitting->tangents[0] = half * camera->width / camera->height;
    fitting->tangents[1] = half;
    for (int a = 0; a < 2; a++) fitting->least[a][0] = fitting->least[a][1] = INFINITY;
    return BP_OK;
}

void bp_fitting_add(BpFitting *f, const BpSphere *spheres, size_t count) {
    if (count == 0) return;
    if (!f->begun) memcpy(f->origin, spheres[0].center, sizeof f->origin); /* far scenes keep their digits */
    f->begun = true;
    for (size_t i = 0; i < count; i++) {
        double c[3], place[3];
        const double radius = fabs(spheres[i].radius);
        for (int k = 0; k < 3; k++) c[k] = spheres[i].center[k] - f->origin[k];
        for (int k = 0; k < 3; k++) place[k] = bp_dot(f->axes[k], c);
        if (place[2] + radius > f->nearest) f->nearest = place[2] + radius;
        if (place[2] - radius < f->farthest) f->farthest = place[2] - radius;
        for (int a = 0; a < 2; a++)
            for (int side = 0; side < 2; side++) {
                const double value = plane_value(f, place, radius, a, side);
                if (value < f->least[a][side]) f->least[a][side] = value;
            }
    }
}

static BpStatus stand(const double eye[3], const double view[3], double distance, const double vup[3],
                      BpCamera *camera, BpError *err) {
    if (!(distance > 0) || !(distance <= BP_COORDINATE_MAX))
        return bp_fail(err, BP_ERR_SCENE,
                       "found spheres too far apart to fit the camera to, expected another unit of length");
    for (int k = 0; k < 3; k++) {
        camera->lookfrom[k] = eye[k];
        camera->lookat[k] = eye[k] - distance * view[k];
    }
    memcpy(camera->vup, vup, sizeof camera->vup);
    camera->focus_dist = distance;
    return BP_OK;
}

BpStatus bp_fitting_end(const BpFitting *f, BpCamera *camera, BpError *err) {
    double eye[3] = {0, 0, -INFINITY}, place[3];
    if (!f->begun)
        return bp_fail(err, BP_ERR_SCENE, "found no sphere to fit the camera to, expected one at least");
    for (int a = 0; a < 2; a++) {
        const double cosine = 1 / sqrt(1 + f->tangents[a] * f->tangents[a]), sine = f->tangents[a] * cosine;
        eye[a] = (f->least[a][1] - f->least[a][0]) / (2 * cosine);
        if (!f->orthographic) eye[2] = fmax(eye[2], -(f->least[a][0] + f->least[a][1]) / (2 * sine));
    }
    if (f->orthographic) {
        const double width = -(f->least[0][0] + f->least[0][1]), height = -(f->least[1][0] + f->least[1][1]);
        camera->view_height = fmax(height, width / f->aspect) / f->room;
        eye[2] = f->nearest + camera->view_height;
    }
    for (int k = 0; k < 3; k++)
        place[k] = f->origin[k] + eye[0] * f->axes[0][k] + eye[1] * f->axes[1][k] + eye[2] * f->axes[2][k];
    return stand(place, f->axes[2], eye[2] - (f->nearest + f->farthest) / 2, f->vup, camera, err);
}

BpStatus bp_camera_fit(const BpSphere *spheres, size_t count, const double direction[3], double margin,
                       BpCamera *camera, BpError *err) {
    BpFitting fitting;
    BP_TRY(bp_fitting_begin(camera, direction, margin, &fitting, err));
    bp_fitting_add(&fitting, spheres, count);
    return bp_fitting_end(&fitting, camera, err);
}

BpStatus bp_camera_fit_turning(const BpSphere *spheres, size_t count, const double direction[3],
                               double margin, uint32_t steps, BpCamera *camera, BpError *err) {
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY}, middle[3],
           eye[3];
    double distance = 0, height = 0, nearest = 0;
    BpFitting first = {0};
    if (count == 0)
        return bp_fail(err, BP_ERR_SCENE, "found no sphere to fit the camera to, expected one at least");
    for (size_t i = 0; i < count; i++) {
        for (int k = 0; k < 3; k++) {
            low[k] = fmin(low[k], spheres[i].center[k] - fabs(spheres[i].radius));
            high[k] = fmax(high[k], spheres[i].center[k] + fabs(spheres[i].radius));
        }
    }
    for (int k = 0; k < 3; k++) middle[k] = low[k] / 2 + high[k] / 2;
    for (uint32_t s = 0; s < steps; s++) {
        BpFitting f;
        double turned[3] = {direction[0], direction[1], direction[2]}, from_origin[3], place[3];
        bp_turn_around(camera->vup, 360.0 * s / steps, turned);
        BP_TRY(bp_fitting_begin(camera, turned, margin, &f, err));
        bp_fitting_add(&f, spheres, count);
        if (s == 0) first = f;
        for (int k = 0; k < 3; k++) from_origin[k] = middle[k] - f.origin[k];
        for (int k = 0; k < 3; k++) place[k] = bp_dot(f.axes[k], from_origin);
        for (int a = 0; a < 2; a++) {
            const double sine = f.tangents[a] / sqrt(1 + f.tangents[a] * f.tangents[a]);
            for (int side = 0; side < 2; side++)
                if (f.orthographic)
                    height = fmax(height, 2 * (plane_value(&f, place, 0, a, side) - f.least[a][side]) /
                                              (f.room * (a == 0 ? f.aspect : 1)));
                else
                    distance = fmax(distance, (plane_value(&f, place, 0, a, side) - f.least[a][side]) / sine);
        }
        nearest = fmax(nearest, f.nearest - place[2]);
    }
    if (first.orthographic) {
        camera->view_height = height;
        distance = nearest + height;
    }
    for (int k = 0; k < 3; k++) eye[k] = middle[k] + distance * first.axes[2][k];
    return stand(eye, first.axes[2], distance, first.vup, camera, err);
}

void bp_camera_turn(BpCamera *camera, double degrees) {
    double from[3];
    for (int k = 0; k < 3; k++) from[k] = camera->lookfrom[k] - camera->lookat[k];
    bp_turn_around(camera->vup, degrees, from);
    for (int k = 0; k < 3; k++) camera->lookfrom[k] = camera->lookat[k] + from[k];
}
