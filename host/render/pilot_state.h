/* pilot_state.h: what a pilot knows while it runs; shared by pilot.c, which runs it, by the two files
 * that follow its paths, from the camera and from the lights, and by the one that judges what it found.
 *
 * Knows: lights, rough points, light that comes to them.   Does not know: how paths are traced
 * (pilot_paths.h). */
#ifndef BP_RENDER_PILOT_STATE_H
#define BP_RENDER_PILOT_STATE_H

#include "pilot_join.h"
#include "pilot_lights.h"
#include "pilot_pass.h"
#include "pilot_paths.h"

#define BP_PILOT_PHOTONS 32768u /* paths from lights */
#define BP_PILOT_DEPOSITS 3u    /* rough points on which the light of one path counts */

/* Camera paths: `of_pixel` for each square of side x side pixels. */
typedef struct BpPilotPlan {
    uint32_t width, height; /* of the grid of squares */
    uint32_t side, of_pixel;
    double extent; /* solid angle or area for which a path stands */
} BpPilotPlan;

typedef struct BpPilot {
    const BpScene *scene;
    uint32_t max_depth;
    const BpPilotAim *aim;
    BpPilotPlan plan;
    BpPilotEye *eyes;
    BpPilotRay *rays; /* of camera paths, behind something specular */
    BpPilotPhoton *photons;
    size_t eye_count, ray_count, ray_room, photon_count;
    uint32_t *hits; /* of each of the lights: camera paths that begin by meeting it */
    BpPilotParts parts;
} BpPilot;

/* Of a pixel in the middle, as seen from the camera: solid angle, or for parallel rays area. */
double bp_pilot_pixel_extent(const BpCamera *camera);
BpPilotPlan bp_pilot_plan(const BpCamera *camera);

/* Fill `eyes`, `rays` and the sums of lights seen directly; and `photons`. */
BpStatus bp_pilot_trace_eyes(BpPilot *pilot, BpPilotFlight *flight, BpError *err);
BpStatus bp_pilot_trace_photons(BpPilot *pilot, BpPilotFlight *flight, BpError *err);

/* Whether rays through focusers take away more noise than the time that they cost would. */
bool bp_pilot_focusing_pays(const BpPilot *pilot);

#endif
