/* body_rules.c: see body_rules.h. */
#include "body_rules.h"

#include "bodies.h"
#include "vector.h"

#include <math.h>

/* Where rays begin, in a plane around lookfrom: a disc, or a rectangle. */
typedef struct Opening {
    double place[3], right[3], up[3], back[3]; /* the last three are unit vectors */
    double radius;                             /* of the disc; 0: it is a rectangle */
    double sides[2];                           /* half of them */
} Opening;

static Opening opening_of(const BpScene *scene) {
    const BpCamera *camera = &scene->camera;
    Opening opening = {.radius = camera->lens_radius};
    memcpy(opening.place, camera->lookfrom, sizeof opening.place);
    bp_way(camera->lookat, camera->lookfrom, opening.back);
    bp_normalize(opening.back);
    bp_cross(camera->vup, opening.back, opening.right);
    bp_normalize(opening.right);
    bp_cross(opening.back, opening.right, opening.up);
    if (camera->projection == BP_PERSPECTIVE) return opening;
    const double height = bp_camera_plane_height(camera);
    opening.radius = 0;
    opening.sides[0] = height * camera->width / camera->height / 2 + camera->lens_radius;
    opening.sides[1] = height / 2 + camera->lens_radius;
    return opening;
}

/* Whether a line between two points of the plane meets the rectangle: what is left of it between the sides.
 */
static bool meets_rectangle(const double sides[2], const double a[2], const double b[2]) {
    double from = 0, to = 1;
    for (int i = 0; i < 2; i++) {
        const double way = b[i] - a[i];
        if (way == 0 && fabs(a[i]) > sides[i]) return false;
        if (way == 0) continue;
        const double one = (-sides[i] - a[i]) / way, other = (sides[i] - a[i]) / way;
        from = fmax(from, fmin(one, other));
        to = fmin(to, fmax(one, other));
    }
    return from <= to;
}

static bool meets_disc(double radius, const double a[2], const double b[2]) {
    const double way[2] = {b[0] - a[0], b[1] - a[1]};
    const double length2 = way[0] * way[0] + way[1] * way[1];
    const double share = length2 > 0 ? -(a[0] * way[0] + a[1] * way[1]) / length2 : 0;
    const double t = fmin(1, fmax(0, share));
    return hypot(a[0] + t * way[0], a[1] + t * way[1]) <= radius;
}

static bool meets(const Opening *opening, const double a[2], const double b[2]) {
    return opening->radius > 0 ? meets_disc(opening->radius, a, b) : meets_rectangle(opening->sides, a, b);
}

/* Whether a triangle in the plane has the middle inside. */
static bool holds_middle(double at[3][2]) {
    int signs[3];
    for (int k = 0; k < 3; k++) {
        const double *a = at[k], *b = at[(k + 1) % 3], area = a[0] * b[1] - a[1] * b[0];
        signs[k] = area > 0 ? 1 : area < 0 ? -1 : 0;
    }
    return signs[0] == signs[1] && signs[1] == signs[2];
}

static bool cuts(const Opening *opening, const BpTriangle *triangle) {
    double at[3][2], height[3], crossings[3][2];
    size_t found = 0;
    for (int k = 0; k < 3; k++) {
        double way[3];
        bp_way(opening->place, triangle->vertices[k], way);
        at[k][0] = bp_dot(way, opening->right);
        at[k][1] = bp_dot(way, opening->up);
        height[k] = bp_dot(way, opening->back);
        if (fabs(height[k]) <= 1e-12 * (bp_length(way) + bp_length(opening->place))) height[k] = 0;
    }
    if (height[0] == 0 && height[1] == 0 && height[2] == 0)
        return meets(opening, at[0], at[1]) || meets(opening, at[1], at[2]) || meets(opening, at[2], at[0]) ||
               holds_middle(at);
    for (int k = 0; k < 3; k++) {
        const int next = (k + 1) % 3;
        if (height[k] == 0) {
            memcpy(crossings[found++], at[k], sizeof at[k]);
        } else if (height[next] != 0 && (height[k] < 0) != (height[next] < 0)) {
            const double t = height[k] / (height[k] - height[next]);
            for (int i = 0; i < 2; i++) crossings[found][i] = at[k][i] + t * (at[next][i] - at[k][i]);
            found++;
        }
    }
    return found > 0 && meets(opening, crossings[0], crossings[found - 1]);
}

static void find_fault(const BpScene *scene, const BpBodies *bodies, BpFault *fault) {
    const BpCamera *camera = &scene->camera;
    if (bodies->count > BP_BODIES_MAX) {
        fault->index = bodies->list[BP_BODIES_MAX].first;
        bp_fault_set(fault, BP_FAULT_TRIANGLE, "material",
                     "found %zu boxes, meshes or other bodies that light passes into, in a scene with media, "
                     "expected at most %u: put several into one mesh, whose triangles of one material are "
                     "one body, or use spheres",
                     bodies->count, BP_BODIES_MAX);
        return;
    }
    if (camera->lens_radius == 0 && camera->projection == BP_PERSPECTIVE) return;
    const Opening opening = opening_of(scene);
    for (size_t i = 0; i < scene->triangle_count && bodies->count > 0; i++) {
        if (bodies->of_triangle[i] == BP_NO_BODY || !cuts(&opening, &scene->triangles[i])) continue;
        char name[BP_SPHERE_NAME_SIZE];
        fault->index = i;
        bp_fault_set(
            fault, BP_FAULT_TRIANGLE, "",
            "found %s of the camera cut by %s, the boundary of a medium, expected it inside or outside: "
            "move one of them, or make the %s smaller",
            opening.radius > 0 ? "the lens" : "the plane", bp_triangle_name(scene, i, name),
            opening.radius > 0 ? "lens" : "view");
        return;
    }
}

BpStatus bp_scene_find_body_fault(const BpScene *scene, BpFault *fault, BpError *err) {
    BpBodies bodies;
    BP_TRY(bp_bodies_find(scene, &bodies, err));
    find_fault(scene, &bodies, fault);
    bp_bodies_clear(&bodies);
    return BP_OK;
}
