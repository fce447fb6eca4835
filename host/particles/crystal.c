/* crystal.c: see crystal.h. */
#include "crystal.h"
#include "scene/vector.h"

#include <string.h>

/* How far lengths of the cell may differ from those of the transformation. */
#define AGREEMENT 0.01

/* The three vectors of which each has the product 1 with its own of the given three, and 0 with the others;
 * false: those lie in a plane. */
static bool find_reciprocal(const double v[3][3], double out[3][3]) {
    for (int i = 0; i < 3; i++) bp_cross(v[(i + 1) % 3], v[(i + 2) % 3], out[i]);
    const double volume = bp_dot(v[0], out[0]);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) {
            out[i][k] /= volume;
            if (!isfinite(out[i][k])) return false;
        }
    return true;
}

bool crystal_frame_of_edges(CrystalFrame *frame, const double edges[3][4]) {
    double vectors[3][3], rows[3][3];
    const double origin[3] = {edges[0][3], edges[1][3], edges[2][3]};
    *frame = (CrystalFrame){0};
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) vectors[i][k] = edges[k][i];
    if (!find_reciprocal((const double(*)[3])vectors, rows)) return false;
    for (int i = 0; i < 3; i++) {
        memcpy(frame->row[i], rows[i], sizeof rows[i]);
        frame->row[i][3] = -bp_dot(rows[i], origin);
        frame->given[i] = true;
    }
    return true;
}

/* Whether the rows that are given are those of the standard frame, as nearly as six decimals tell. */
static bool is_standard(const CrystalFrame *frame, const double edges[3][3]) {
    double longest = 0;
    for (int k = 0; k < 3; k++) longest = fmax(longest, sqrt(bp_dot(edges[k], edges[k])));
    const double rounding = 1e-3 + 1e-6 * longest; /* of the cell's own digits, of those of the rows */
    for (int i = 0; i < 3; i++) {
        if (!frame->given[i]) continue;
        if (!(fabs(frame->row[i][3]) <= rounding)) return false;
        for (int k = 0; k < 3; k++)
            if (!(fabs(bp_dot(frame->row[i], edges[k]) - (i == k)) <= rounding)) return false;
    }
    return true;
}

/* The axes along which the standard frame has a, b in the plane of the first two, and c: unit vectors. */
static void find_axes(const double edges[3][3], double axes[3][3]) {
    const double *const a = edges[0], *const b = edges[1];
    const double length = sqrt(bp_dot(a, a)), along = bp_dot(a, b) / bp_dot(a, a);
    double rest[3];
    for (int k = 0; k < 3; k++) rest[k] = b[k] - along * a[k];
    const double height = sqrt(bp_dot(rest, rest));
    for (int k = 0; k < 3; k++) {
        axes[0][k] = a[k] / length;
        axes[1][k] = rest[k] / height;
    }
    bp_cross(axes[0], axes[1], axes[2]);
    if (bp_dot(axes[2], edges[2]) < 0)
        for (int k = 0; k < 3; k++) axes[2][k] = -axes[2][k];
}

/* The cell with its lengths and angles, as the transformation turns it; false: these contradict it. */
static bool turn(const CrystalFrame *frame, double edges[3][3], double origin[3]) {
    double rows[3][3], rough[3][3], axes[3][3], turned[3][3] = {{0}};
    for (int i = 0; i < 3; i++) {
        if (!frame->given[i]) return false;
        memcpy(rows[i], frame->row[i], sizeof rows[i]);
    }
    if (!find_reciprocal((const double(*)[3])rows, rough)) return false;
    find_axes((const double(*)[3])rough, axes);
    for (int i = 0; i < 3; i++) {
        double off[3];
        for (int k = 0; k < 3; k++) {
            for (int axis = 0; axis < 3; axis++) turned[i][k] += edges[i][axis] * axes[axis][k];
            off[k] = turned[i][k] - rough[i][k];
        }
        if (!(bp_dot(off, off) <= AGREEMENT * AGREEMENT * bp_dot(edges[i], edges[i]))) return false;
    }
    for (int k = 0; k < 3; k++) {
        origin[k] = 0;
        for (int i = 0; i < 3; i++) origin[k] -= frame->row[i][3] * turned[i][k];
    }
    memcpy(edges, turned, sizeof turned);
    return isfinite(bp_dot(origin, origin));
}

void crystal_turn_cell(BpParticleFile *file, const CrystalFrame *frame, const char *named) {
    BpParticles *const p = file->out;
    if (p == NULL || !p->has_cell || is_standard(frame, (const double(*)[3])p->cell)) return;
    double edges[3][3], origin[3];
    memcpy(edges, p->cell, sizeof edges);
    if (turn(frame, edges, origin)) {
        frame_cell(file, origin, (const double(*)[3])edges, FRAME_PERIODIC);
        return;
    }
    memset(&p->periodic, 0, sizeof p->periodic);
    bp_particles_note(p, "%s contradicts the cell, so molecules are not made whole", named);
}
