/* style_spheres.h: particles as spheres of a scene.
 *
 * In:    particles whose radii and colours are decided.   Out: spheres, each with a colour of its own.
 * Knows: the scene's arrays, threads.   Does not know: how radii and colours are decided. */
#ifndef BP_PARTICLES_STYLE_SPHERES_H
#define BP_PARTICLES_STYLE_SPHERES_H

#include "style_job.h"

/* All particles that are shown and have a radius; job->shown is false for the others then. BP_ERR_SCENE:
 * none. */
BpStatus bp_style_put_particles(BpStyleJob *job, BpError *err);

/* Room for `count` more spheres and `colors` more colours. */
BpStatus bp_style_make_room(BpStyleJob *job, size_t count, size_t colors, BpError *err);
/* One sphere, after that. */
void bp_style_put_sphere(BpStyleJob *job, const double center[3], double radius, const double color[3]);

#endif
