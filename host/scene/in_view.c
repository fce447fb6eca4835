/* in_view.c: see in_view.h. */
#include "in_view.h"
#include "vector.h"

#include <math.h>

typedef double Vec[3];

static void unit_cross(const double *a, const double *b, double *out) {
    const Vec c = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    const double length = sqrt(bp_dot(c, c));
    for (int i = 0; i < 3; i++) out[i] = c[i] / length;
}

typedef struct View {
    Vec from, ahead, right, up;
    double half_width, half_height; /* at distance 1, or with parallel rays everywhere */
    double cone; /* radians: half the opening of a cone around all rays of a perspective camera */
    double lens, focus;
    bool orthographic;
} View;

static View find_view(const BpCamera *camera) {
    View view;
    Vec back;
    const double pi = 3.14159265358979323846;
    for (int i = 0; i < 3; i++) {
        view.from[i] = camera->lookfrom[i];
        back[i] = camera->lookfrom[i] - camera->lookat[i];
    }
    const double length = sqrt(bp_dot(back, back));
    for (int i = 0; i < 3; i++) back[i] /= length;
    for (int i = 0; i < 3; i++) view.ahead[i] = -back[i];
    unit_cross(camera->vup, back, view.right);
    unit_cross(back, view.right, view.up);
    /* A pixel's samples lie up to half a pixel around its centre. */
    view.orthographic = camera->projection == BP_ORTHOGRAPHIC;
    view.half_height =
        view.orthographic ? bp_camera_plane_height(camera) / 2 : tan(camera->vfov_degrees * pi / 360);
    view.half_width = view.half_height * camera->width / camera->height;
    view.lens = camera->lens_radius;
    view.focus = camera->focus_dist;
    /* A ray of a lens meets that of the pinhole in the plane in focus, at `focus` or farther. */
    view.cone = atan(hypot(view.half_width, view.half_height)) + atan(view.lens / view.focus);
    return view;
}

/* The ball around a sphere on all of its way: where its centre is from the camera. Returns its radius. */
static double ball_around(const View *view, const BpSphere *sphere, const double end[3], Vec *to) {
    double way = 0;
    for (int i = 0; i < 3; i++) {
        (*to)[i] = (sphere->center[i] + end[i]) / 2 - view->from[i];
        way = hypot(way, end[i] - sphere->center[i]);
    }
    return fabs(sphere->radius) + way / 2;
}

/* Rays leave the lens and spread around those of a pinhole: at distance d by lens * |d / focus - 1|, and by
 * `lens` before the plane in focus. A sphere that moves is taken for the ball around its way. */
static bool reaches_planes(const View *view, const BpSphere *sphere, const double end[3]) {
    Vec to;
    const double radius = ball_around(view, sphere, end, &to), ahead = bp_dot(to, view->ahead);
    if (ahead + radius < 0) return false;
    const double room = radius + view->lens * fmax(1, (ahead + radius) / view->focus - 1);
    const double aside = fabs(bp_dot(to, view->right)), above = fabs(bp_dot(to, view->up));
    if (view->orthographic) return aside - view->half_width <= room && above - view->half_height <= room;
    return (aside - ahead * view->half_width) / sqrt(1 + view->half_width * view->half_width) <= room &&
           (above - ahead * view->half_height) / sqrt(1 + view->half_height * view->half_height) <= room;
}

/* All planes of the edges cut a huge sphere under the camera; a cone around the view need not. */
static bool reaches_cone(const View *view, const BpSphere *sphere, const double end[3]) {
    Vec to;
    const double radius = ball_around(view, sphere, end, &to), distance = sqrt(bp_dot(to, to));
    if (view->orthographic || distance - view->lens <= radius) return true;
    const double angle = acos(fmin(1, fmax(-1, bp_dot(to, view->ahead) / distance)));
    /* From another point of the lens, the centre lies in another direction, too. */
    return angle - asin(fmin(1, view->lens / distance)) - view->cone <=
           asin(radius / (distance - view->lens));
}

static bool reaches_view(const View *view, const BpSphere *sphere, const double end[3]) {
    return reaches_planes(view, sphere, end) && reaches_cone(view, sphere, end);
}

/* The ball around the middle of a triangle that holds it. */
static BpSphere ball_of_triangle(const BpTriangle *triangle) {
    BpSphere ball = {.radius = 0};
    for (int i = 0; i < 3; i++)
        ball.center[i] = (triangle->vertices[0][i] + triangle->vertices[1][i] + triangle->vertices[2][i]) / 3;
    for (int k = 0; k < 3; k++)
        ball.radius = fmax(ball.radius, sqrt(bp_distance2(ball.center, triangle->vertices[k])));
    return ball;
}

static BpSphere ball_of_capsule(const BpCapsule *capsule) {
    BpSphere ball = {.radius = capsule->radius + sqrt(bp_distance2(capsule->ends[0], capsule->ends[1])) / 2};
    for (int i = 0; i < 3; i++) ball.center[i] = (capsule->ends[0][i] + capsule->ends[1][i]) / 2;
    return ball;
}

bool bp_scene_has_shape_in_view(const BpScene *scene) {
    const View view = find_view(&scene->camera);
    for (size_t i = 0; i < scene->sphere_count; i++)
        if (reaches_view(&view, &scene->spheres[i], bp_sphere_end(scene, i))) return true;
    for (size_t i = 0; i < scene->triangle_count; i++) {
        const BpSphere ball = ball_of_triangle(&scene->triangles[i]);
        if (reaches_view(&view, &ball, ball.center)) return true;
    }
    for (size_t i = 0; i < scene->capsule_count; i++) {
        const BpSphere ball = ball_of_capsule(&scene->capsules[i]);
        if (reaches_view(&view, &ball, ball.center)) return true;
    }
    return false;
}

bool bp_scene_always_scatters(const BpScene *scene) {
    if (scene->albedo_count > 0) return false; /* some may be black */
    for (size_t m = 0; m < scene->material_count; m++) {
        const BpMaterial *material = &scene->materials[m];
        if (!bp_material_is(material->kind, BP_SCATTERS) || material->fuzz > 0 ||
            (material->roughness > 0 && material->kind != BP_MATERIAL_OREN_NAYAR) || /* facets hide light */
            material->total_reflection == BP_TOTAL_ABSORB)
            return false;
        if (bp_material_has(material->kind, BP_MEMBER_ALBEDO) && material->texture[BP_MEMBER_ALBEDO] != 0)
            return false; /* it may be black in places */
        if (bp_material_has(material->kind, BP_MEMBER_ALBEDO) &&
            fmax(material->albedo[0], fmax(material->albedo[1], material->albedo[2])) <= 0)
            return false;
    }
    return true;
}
