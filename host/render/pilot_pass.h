/* pilot_pass.h: lights that are seen in mirrors and through glass, from camera paths that pass by them.
 *
 * In:    rays behind specular shapes, from camera paths.
 * Out:   for each pixel, how probably a sample meets a light.
 * Knows: densities of directions.   Does not know: kernels, how paths were made.
 *
 * What scatters into a narrow lobe has, for lights that are smaller, a glint where a mirror would show the
 * light.
 *
 * Rays that have come the same way (by the same shapes, reflected or let through alike) spread smoothly over
 * directions, so how many of them pass near a light tells how many meet it. Near means: as near as the
 * COUNT-th of them passes (D. O. Loftsgaarden and C. P. Quesenberry, "A nonparametric estimate of a
 * multivariate density function", 1965). */
#ifndef BP_RENDER_PILOT_PASS_H
#define BP_RENDER_PILOT_PASS_H

#include "pilot_join.h"
#include "pilot_lights.h"
#include "pilot_lobes.h"
#include "pilot_pairs.h"

/* A ray, and where it ends. */
typedef struct BpPilotRay {
    double origin[3], direction[3], length; /* infinite: it meets nothing */
    double carried[3];                      /* of a light that it meets, to the pixel */
    double share;                           /* of the pixel's samples that it stands for */
    uint64_t way;                           /* the same for rays that have come the same way */
    uint32_t pixel, shape;                  /* that it meets, or NO_SPHERE */
    uint32_t through;                       /* the first that its path has met */
    BpPilotMet met;                         /* by its path; none: a narrow lobe too */
    double begins[3];                       /* the direction of its path at the camera */
    uint32_t number;                        /* none has another's */
    bool lobe;                              /* it begins in a narrow lobe, around this direction */
    BpPilotTurn turn;                       /* there */
} BpPilotRay;

/* `focused`: rays to lamps may go through focusers
 * from the camera, too. Sorts the rays. */
void bp_pilot_pass(const BpScene *scene, bool focused, const BpPilotLight *lights, size_t light_count,
                   BpPilotRay *rays, size_t ray_count, BpPilotParts *parts);

#endif
