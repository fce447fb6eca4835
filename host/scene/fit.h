/* fit.h: a camera that shows certain spheres, as large as the picture allows.
 *
 * In:    spheres, a direction.   Out: lookfrom, lookat, focus_dist.
 * Knows: the pinhole camera and parallel rays.   Does not know: where the direction comes from. */
#ifndef BP_SCENE_FIT_H
#define BP_SCENE_FIT_H

#include "base/status.h"
#include "scene.h"

extern const char *const bp_projection_names[2];
/* "three-quarter", "front", ...; "" for BP_VIEW_NONE. */
extern const char *const bp_view_names[BP_VIEW_COUNT];

/* The direction from the middle of the scene to the camera, in a world where the axis `up` (0 to 2) points
 * up: with y up, front is along z; with z up, it is against y. */
void bp_view_direction(BpView view, int up, double direction[3]);

#define BP_FIT_MARGIN 0.05 /* by default */

/* Turns a direction around an axis, seen from its tip against the clock. */
void bp_turn_around(const double axis[3], double degrees, double direction[3]);

/* The constraints of spheres on a camera, gathered from one set after the other. */
typedef struct BpFitting {
    double axes[3][3], vup[3], origin[3], tangents[2], least[2][2], nearest, farthest;
    double aspect, room; /* width over height; the share that the margins leave */
    bool begun, orthographic;
} BpFitting;

/* `direction` points from the spheres to the camera, whose vfov, vup and size of picture are taken; where vup
 * is parallel to the view, it is replaced by another. `margin`: the share of width and height, below 0.5,
 * that stays free at each side. Fails where there is no direction. */
BpStatus bp_fitting_begin(const BpCamera *camera, const double direction[3], double margin,
                          BpFitting *fitting, BpError *err);
void bp_fitting_add(BpFitting *fitting, const BpSphere *spheres, size_t count);
/* Sets lookfrom, lookat, vup, focus_dist and, of an orthographic camera, view_height so that the silhouettes
 * of all spheres lie inside the margins, and touch them at two opposite sides. Fails without spheres, and
 * where the numbers are too large. */
BpStatus bp_fitting_end(const BpFitting *fitting, BpCamera *camera, BpError *err);

/* All three for one set. */
BpStatus bp_camera_fit(const BpSphere *spheres, size_t count, const double direction[3], double margin,
                       BpCamera *camera, BpError *err);

/* A camera for a turntable of `steps` pictures, which starts at `direction`: it looks at the middle of the
 * spheres' bounding box, from a distance at which all of them lie inside the margins in every picture, as
 * near as that goes. */
BpStatus bp_camera_fit_turning(const BpSphere *spheres, size_t count, const double direction[3],
                               double margin, uint32_t steps, BpCamera *camera, BpError *err);
/* Moves the camera around lookat, on a circle around vup. */
void bp_camera_turn(BpCamera *camera, double degrees);

#endif
