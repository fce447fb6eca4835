/* style_shapes.c: see style_shapes.h. */
#include "style_shapes.h"

#include "style_sizes.h"

#include <math.h>

#define SHORTEST 1.0e-7 /* half an axis: the sides of the finest triangles are at least 1e-9 */
#define FLATTEST 1.0e-4 /* half an axis, of the longest: triangles keep an area in single precision */
#define NEAREST 1.0e-10 /* half an axis, of the distance from the origin: vertices differ */

const BpParticleShape *bp_style_shape(const BpStyleJob *job, size_t i) {
    const uint32_t kind = job->p->body[i].kind;
    return kind >= BP_BODY_SHAPES ? &job->p->shapes[kind - BP_BODY_SHAPES] : NULL;
}

double bp_style_scale(const BpStyleJob *job, size_t i) {
    const float *const axes = job->p->body[i].half_axes;
    const BpParticleShape *const shape = bp_style_shape(job, i);
    const double own =
        shape != NULL ? shape->radius : cbrt((double)axes[0]) * cbrt((double)axes[1]) * cbrt((double)axes[2]);
    return bp_style_radius(job, i) / own;
}

bool bp_style_has_body(const BpStyleJob *job, size_t i) {
    const BpParticles *const p = job->p;
    if (p->body == NULL || p->body[i].kind == BP_BODY_SPHERE || !job->style->shapes) return false;
    const double scale = bp_style_scale(job, i), *const place = p->position[i];
    const float *const axes = p->body[i].half_axes;
    const BpParticleShape *const shape = bp_style_shape(job, i);
    const double longest = shape != NULL ? shape->radius : (double)fmaxf(axes[0], fmaxf(axes[1], axes[2])),
                 shortest = shape != NULL ? shape->radius : (double)fminf(axes[0], fminf(axes[1], axes[2]));
    const double far = fmax(fabs(place[0]), fmax(fabs(place[1]), fabs(place[2])));
    return scale * shortest >= SHORTEST && shortest >= FLATTEST * longest &&
           scale * shortest >= NEAREST * far && far + 2 * scale * longest <= BP_VERTEX_MAX;
}
