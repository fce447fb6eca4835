/* frame_shapes.c: where readers put what is no sphere; see reader.h. */
#include "reader.h"

#include "base/format.h"
#include "base/message_text.h"
#include "base/plural.h"
#include "quaternion.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define HALF_AXIS_MAX 1.0e12 /* that of a scene */
#define FLAT_SHARE                                                                                           \
    0.05 /* of the longest axis: what an axis of 0 becomes, so that there is something to see */
#define UNIT_ERROR 1.0e-3 /* of the length of a quaternion that was written with few digits */

void particle_shape_clear(BpParticleShape *shape) {
    free(shape->type);
    free(shape->vertices);
    free(shape->corners);
    free(shape->ends);
    free(shape->triangles);
    *shape = (BpParticleShape){0};
}

/* Makes room for bodies: spheres, for the particles so far. */
static BpStatus have_bodies(BpParticles *p, BpError *err) {
    if (p->body != NULL) return BP_OK;
    p->body = calloc(p->capacity > 0 ? p->capacity : 1, sizeof *p->body);
    return p->body != NULL ? BP_OK : bp_fail(err, BP_ERR_MEMORY, "out of memory for shapes of particles");
}

static void put_orientation(BpParticleFile *file, const double orientation[4], BpParticleBody *body) {
    double q[4], square = 0;
    memcpy(q, orientation, sizeof q);
    for (int i = 0; i < 4; i++) square += q[i] * q[i];
    if (!quaternion_normalize(q))
        file->shapes.without++;
    else if (!(fabs(square - 1) <= 2 * UNIT_ERROR))
        file->shapes.scaled++;
    for (int i = 0; i < 4; i++) body->orientation[i] = (float)q[i];
    file->shapes.bodies++;
}

/* An ellipsoid's body, or that of a sphere where all axes are alike, and the radius. */
static BpStatus put_ellipsoid(BpParticleFile *file, const double half_axes[3], const double orientation[4],
                              bool with_line, size_t number, BpParticleBody *body, double *radius,
                              BpError *err) {
    double axes[3], longest = 0, volume = 1;
    char text[BP_NUMBER_TEXT_SIZE];
    bool flat = false;
    for (int i = 0; i < 3; i++) {
        axes[i] = half_axes[i];
        if (!(axes[i] >= 0 && axes[i] <= HALF_AXIS_MAX))
            return input_fail(
                &file->input, with_line, err,
                "particle %zu (from 0): found an ellipsoid with a half-axis of %s, expected numbers "
                "from 0 to 1e12",
                number, bp_number_text(axes[i], text));
        longest = fmax(longest, axes[i]);
    }
    for (int i = 0; i < 3; i++) {
        flat |= axes[i] == 0;
        if (axes[i] == 0) axes[i] = FLAT_SHARE * longest;
        volume *= cbrt(axes[i]);
    }
    *radius = volume;
    if (axes[0] == axes[1] && axes[1] == axes[2]) {
        *radius = axes[0];
        return BP_OK;
    }
    file->shapes.flat += flat;
    body->kind = BP_BODY_ELLIPSOID;
    for (int i = 0; i < 3; i++) body->half_axes[i] = (float)fmax(axes[i], 1e-30);
    put_orientation(file, orientation, body);
    return BP_OK;
}

static bool is_ellipsoid(const double half_axes[3]) {
    return half_axes[0] != 0 || half_axes[1] != 0 || half_axes[2] != 0;
}

BpStatus frame_add_body(BpParticleFile *file, Particle *particle, bool with_line, BpError *err) {
    BpParticles *const p = file->out;
    BpParticleBody body = {.kind = BP_BODY_SPHERE};
    if (is_ellipsoid(particle->half_axes)) {
        BP_TRY(put_ellipsoid(file, particle->half_axes, particle->orientation, with_line, file->added - 1,
                             &body, &particle->radius, err));
        file->shapes.super += particle->super;
    } else if (particle->body != BP_BODY_SPHERE) {
        body.kind = particle->body;
        put_orientation(file, particle->orientation, &body);
        particle->radius = p->shapes[body.kind - BP_BODY_SHAPES].radius;
    }
    if (body.kind != BP_BODY_SPHERE) BP_TRY(have_bodies(p, err));
    if (p->body != NULL) p->body[p->count] = body;
    return BP_OK;
}

BpStatus frame_set_ellipsoid(BpParticleFile *file, uint32_t number, const double half_axes[3],
                             const double orientation[4], BpError *err) {
    BpParticles *const p = file->out;
    BpParticleBody body = {.kind = BP_BODY_SPHERE};
    double radius = 0;
    if (p == NULL || !is_ellipsoid(half_axes)) return BP_OK;
    const uint32_t at = frame_place(file, number);
    if (at >= p->count) return BP_OK;
    BP_TRY(put_ellipsoid(file, half_axes, orientation, true, number, &body, &radius, err));
    BP_TRY(frame_set_radius(file, number, radius, err));
    if (body.kind == BP_BODY_SPHERE) return BP_OK;
    BP_TRY(have_bodies(p, err));
    p->body[at] = body;
    return BP_OK;
}

void frame_note_shapes(BpParticleFile *file, uint64_t count, const char *kind) {
    char number[32];
    if (file->out == NULL || count == 0) return;
    bp_particles_note(file->out, "%s %s%s drawn as %s", bp_format_whole(count, number, sizeof number), kind,
                      bp_plural(count), count == 1 ? "a sphere" : "spheres");
}

void frame_end_shapes(BpParticleFile *file) {
    BpParticles *const p = file->out;
    char number[32];
    if (p != NULL && file->shapes.super > 0)
        bp_particles_note(
            p, "%s superellipsoid%s taken for %s", bp_format_whole(file->shapes.super, number, sizeof number),
            bp_plural(file->shapes.super), file->shapes.super == 1 ? "an ellipsoid" : "ellipsoids");
    if (file->shapes.bodies == 0) return;
    if (!file->shapes.has_orientations) {
        bp_particles_note(p, "no orientations in the file, so no ellipsoid is turned");
    } else if (file->shapes.order != NULL) {
        bp_particles_note(p, "%s", file->shapes.order);
    }
    if (file->shapes.flat > 0)
        bp_particles_note(p, "%s ellipsoid%s with an axis of 0, which became a twentieth of the longest",
                          bp_format_whole(file->shapes.flat, number, sizeof number),
                          bp_plural(file->shapes.flat));
    if (file->shapes.scaled > 0)
        bp_particles_note(p, "%s quaternion%s of another length than 1, scaled to it",
                          bp_format_whole(file->shapes.scaled, number, sizeof number),
                          bp_plural(file->shapes.scaled));
    if (file->shapes.without > 0)
        bp_particles_note(p, "%s quaternion%s without a direction, by which nothing is turned",
                          bp_format_whole(file->shapes.without, number, sizeof number),
                          bp_plural(file->shapes.without));
}
