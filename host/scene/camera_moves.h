/* camera_moves.h: how a person moves a camera: around what it looks at, along the picture, nearer and
 * farther.
 *
 * In:    a camera, by how much.   Out: the camera, moved.
 * Knows: the scene's camera.   Does not know: windows, where moves come from.
 *
 * What would make the camera invalid (a distance of 0, a view along vup) is not done. */
#ifndef BP_SCENE_CAMERA_MOVES_H
#define BP_SCENE_CAMERA_MOVES_H

#include "scene.h"

/* Turns the camera around lookat: to the right around vup, and up, to 1 degree before vup at most. */
void bp_camera_orbit(BpCamera *camera, double degrees_right, double degrees_up);

/* Moves lookfrom and lookat alike, so that what is at lookat moves by these shares of the picture's height,
 * to the right and down. */
void bp_camera_pan(BpCamera *camera, double right, double down);

/* Multiplies the distance from lookat, and the height of a view by parallel rays. focus_dist and the lens
 * follow, so that what is sharp stays so. */
void bp_camera_approach(BpCamera *camera, double factor);

/* Sets focus_dist; the angle of the lens's cone stays. */
void bp_camera_focus(BpCamera *camera, double distance);

/* Multiplies the lens's radius; a pinhole becomes a small lens when the factor is above 1, and a very small
 * lens a pinhole. */
void bp_camera_widen(BpCamera *camera, double factor);

#endif
