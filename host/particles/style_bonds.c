/* style_bonds.c: see style_bonds.h. */
#include "style_bonds.h"

#include "base/format.h"
#include "base/plural.h"
#include "scene/capsule_rules.h"
#include "scene/vector.h"
#include "style_colors.h"
#include "style_shapes.h"
#include "style_sizes.h"
#include "style_spheres.h"

#include <math.h>

#define STICK_ANGSTROM 0.14 /* half the width of a bond */
#define EDGE_SHARE 0.002    /* half the width of the cell's edges, of its longest */

/* Whether light goes into the spheres of a material, so that what they hide could be seen. */
static bool is_seen_through(const BpStyleJob *job) {
    return bp_material_is(job->scene->materials[job->material].kind, BP_HAS_INSIDE);
}

/* What they are drawn as has not every material. */
static BpStatus check_material(const BpStyleJob *job, const char *member, BpError *err) {
    BpFault fault = {0};
    if (!bp_capsule_material_fault(job->scene, job->material, &fault)) return BP_OK;
    return bp_fail(err, BP_ERR_SCENE, "\"%s\" is drawn as capsules: %s; or leave \"%s\" out", member,
                   fault.text, member);
}

/* Says how many bonds there are, and how many of them, `drawn` and `given` of these, are seen. */
static void say_bonds(BpStyleJob *job, size_t drawn, size_t given, size_t across) {
    char number[32], other[32], beside[64] = "";
    if (across > 0)
        snprintf(beside, sizeof beside, ", %s across the cell not drawn",
                 bp_format_whole(across, other, sizeof other));
    bp_format_whole(drawn, number, sizeof number);
    if (given == drawn && job->p->bond_count > 0)
        bp_style_say(job, "%s bond%s%s", number, bp_plural(drawn), beside);
    else if (given == 0)
        bp_style_say(job, "%s bond%s by distance%s", number, bp_plural(drawn), beside);
    else
        bp_style_say(job, "%s bond%s, %s of them given by the file, the others by distance%s", number,
                     bp_plural(drawn), bp_format_whole(given, other, sizeof other), beside);
    if (job->p->bonds_left_out > 0)
        bp_style_say(job, "left out: %s connection%s to atoms that are missing or share their number",
                     bp_format_whole(job->p->bonds_left_out, number, sizeof number),
                     bp_plural(job->p->bonds_left_out));
}

BpStatus bp_style_put_bonds(BpStyleJob *job, BpError *err) {
    const BpParticles *const p = job->p;
    const bool molecules = p->angstrom > 0 && p->has_element;
    const bool clear = is_seen_through(job);
    size_t drawn = 0, given = 0, across = 0;
    BP_TRY(check_material(job, "bonds", err));
    for (size_t i = 0; i < job->bonds.count; i++) {
        const BpBond *const bond = &job->bonds.bond[i];
        const uint32_t a = bond->a, b = bond->b;
        double color[2][3];
        if (!job->shown[a] || !job->shown[b]) continue;
        if (bond->image[0] != 0 || bond->image[1] != 0 || bond->image[2] != 0) {
            across++;
            continue;
        }
        double radius = job->style->bond_radius;
        if (radius == 0)
            radius = molecules ? STICK_ANGSTROM * p->angstrom
                               : 0.4 * fmin(bp_style_radius(job, a), bp_style_radius(job, b));
        const double half = sqrt(bp_distance2(p->position[a], p->position[b])) / 2 + 1.001 * radius;
        const bool round = !bp_style_has_body(job, a) && !bp_style_has_body(job, b);
        const bool hidden =
            !clear && round && half < bp_style_radius(job, a) && half < bp_style_radius(job, b);
        bp_style_color(job, a, color[0]);
        bp_style_color(job, b, color[1]);
        if (!hidden)
            BP_TRY(
                bp_style_put_capsule(job, p->position[a], p->position[b], radius, color[0], color[1], err));
        drawn++;
        given += i < job->bonds.given;
    }
    say_bonds(job, drawn, given, across);
    return BP_OK;
}

BpStatus bp_style_put_box(BpStyleJob *job, BpError *err) {
    static const double color[3] = {0.12, 0.12, 0.12};
    const BpParticles *const p = job->p;
    if (!p->has_cell)
        return bp_fail(err, BP_ERR_SCENE, "found no cell in the file, expected one for \"box\": true");
    BP_TRY(check_material(job, "box", err));
    double longest = 0;
    for (int e = 0; e < 3; e++)
        longest = fmax(longest, sqrt(p->cell[e][0] * p->cell[e][0] + p->cell[e][1] * p->cell[e][1] +
                                     p->cell[e][2] * p->cell[e][2]));
    for (int e = 0; e < 3; e++) {
        for (int corner = 0; corner < 4; corner++) { /* the four edges along edge e */
            double a[3], b[3];
            for (int c = 0; c < 3; c++) {
                a[c] = p->cell_origin[c] + (corner & 1) * p->cell[(e + 1) % 3][c] +
                       (corner >> 1) * p->cell[(e + 2) % 3][c];
                b[c] = a[c] + p->cell[e][c];
            }
            BP_TRY(bp_style_put_capsule(job, a, b, EDGE_SHARE * longest, color, color, err));
        }
    }
    return BP_OK;
}
