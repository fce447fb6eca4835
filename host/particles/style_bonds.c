/* style_bonds.c: see style_bonds.h. */
#include "style_bonds.h"

#include "base/format.h"
#include "style_colors.h"
#include "style_sizes.h"
#include "style_spheres.h"

#include <math.h>
#include <string.h>

#define STICK_ANGSTROM 0.14 /* half the width of a bond */
#define EDGE_SHARE 0.002    /* half the width of the cell's edges, of its longest */
#define BEADS_MAX 4000      /* in one bond or edge */

/* Whether light goes into the spheres of a material, so that what they hide could be seen. */
static bool is_seen_through(const BpStyleJob *job) {
    return bp_material_is(job->scene->materials[job->material].kind, BP_HAS_INSIDE);
}

/* A row of beads from a to b, excluding both ends, `spacing` radii apart or less: 1/4 makes an outline that
 * dips by 0.8 %, 1/8 one that dips by 0.2 %. Beads inside of a ball of radius `ball` around `hidden_in`
 * are left out; NULL: there is none. */
static BpStatus put_beads(BpStyleJob *job, const double a[3], const double b[3], double radius,
                          double spacing, const double color[3], const double *hidden_in, double ball,
                          BpError *err) {
    const double length =
        sqrt((b[0] - a[0]) * (b[0] - a[0]) + (b[1] - a[1]) * (b[1] - a[1]) + (b[2] - a[2]) * (b[2] - a[2]));
    const double wanted = ceil(length / (spacing * radius));
    const size_t count = wanted < BEADS_MAX ? (size_t)fmax(wanted, 1) : BEADS_MAX;
    BP_TRY(bp_style_make_room(job, count, count, err));
    for (size_t i = 0; i < count; i++) {
        const double t = ((double)i + 0.5) / (double)count;
        double place[3], squared = 0;
        for (int c = 0; c < 3; c++) {
            place[c] = a[c] + t * (b[c] - a[c]);
            if (hidden_in != NULL) squared += (place[c] - hidden_in[c]) * (place[c] - hidden_in[c]);
        }
        if (hidden_in != NULL && sqrt(squared) + 1.001 * radius < ball) continue;
        bp_style_put_sphere(job, place, radius, color);
    }
    return BP_OK;
}

/* Says how many bonds there are, and how many of them, `drawn` and `given` of these, are seen. */
static void say_bonds(BpStyleJob *job, size_t drawn, size_t given, size_t across) {
    char number[32], other[32], beside[64] = "";
    if (across > 0)
        snprintf(beside, sizeof beside, ", %s across the cell not drawn",
                 bp_format_whole(across, other, sizeof other));
    bp_format_whole(drawn, number, sizeof number);
    if (given == drawn && job->p->bond_count > 0)
        bp_style_say(job, "%s bonds%s", number, beside);
    else if (given == 0)
        bp_style_say(job, "%s bonds by distance%s", number, beside);
    else
        bp_style_say(job, "%s bonds, %s of them given by the file, the others by distance%s", number,
                     bp_format_whole(given, other, sizeof other), beside);
    if (job->p->bonds_left_out > 0)
        bp_style_say(job, "left out: %s connections to atoms that are missing or share their number",
                     bp_format_whole(job->p->bonds_left_out, number, sizeof number));
}

BpStatus bp_style_put_bonds(BpStyleJob *job, BpError *err) {
    const BpParticles *const p = job->p;
    const bool molecules = p->angstrom > 0 && p->has_element;
    const bool clear = is_seen_through(job);
    size_t drawn = 0, given = 0, across = 0;
    for (size_t i = 0; i < job->bonds.count; i++) {
        const BpBond *const bond = &job->bonds.bond[i];
        const uint32_t a = bond->a, b = bond->b;
        double middle[3], color[3];
        if (!job->shown[a] || !job->shown[b]) continue;
        if (bond->image[0] != 0 || bond->image[1] != 0 || bond->image[2] != 0) {
            across++;
            continue;
        }
        for (int c = 0; c < 3; c++) middle[c] = (p->position[a][c] + p->position[b][c]) / 2;
        double radius = job->style->bond_radius;
        if (radius == 0)
            radius = molecules ? STICK_ANGSTROM * p->angstrom
                               : 0.4 * fmin(bp_style_radius(job, a), bp_style_radius(job, b));
        for (int side = 0; side < 2; side++) {
            const uint32_t end = side == 0 ? a : b;
            const double *const place = p->position[end];
            bp_style_color(job, end, color);
            BP_TRY(put_beads(job, side == 0 ? place : middle, side == 0 ? middle : place, radius, 0.125,
                             color, clear ? NULL : place, bp_style_radius(job, end), err));
        }
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
            BP_TRY(put_beads(job, a, b, EDGE_SHARE * longest, 0.25, color, NULL, 0, err));
        }
    }
    for (int corner = 0; corner < 8; corner++) {
        double place[3];
        for (int c = 0; c < 3; c++)
            place[c] = p->cell_origin[c] + (corner & 1) * p->cell[0][c] + (corner >> 1 & 1) * p->cell[1][c] +
                       (corner >> 2) * p->cell[2][c];
        BP_TRY(bp_style_make_room(job, 1, 1, err));
        bp_style_put_sphere(job, place, EDGE_SHARE * longest * 1.0001, color);
    }
    return BP_OK;
}
