/* lattice.c: see lattice.h. */
#include "lattice.h"
#include "scene/vector.h"

#include <string.h>

/* Rounding neither makes an edge shorter nor an image nearer. */
#define SHORTER (1 - 1e-9)

static void invert(const double m[3][3], double out[3][3]) {
    double determinant = 0;
    for (int i = 0; i < 3; i++)
        determinant +=
            m[0][i] * (m[1][(i + 1) % 3] * m[2][(i + 2) % 3] - m[1][(i + 2) % 3] * m[2][(i + 1) % 3]);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            out[i][k] = (m[(k + 1) % 3][(i + 1) % 3] * m[(k + 2) % 3][(i + 2) % 3] -
                         m[(k + 1) % 3][(i + 2) % 3] * m[(k + 2) % 3][(i + 1) % 3]) /
                        determinant;
}

/* Replaces edge e by edge + x * f + y * g, if that is shorter. */
static bool replace_edge(double edges[3][3], int e, double x, double y) {
    double other[3];
    for (int c = 0; c < 3; c++)
        other[c] = edges[e][c] + x * edges[(e + 1) % 3][c] + y * edges[(e + 2) % 3][c];
    if (!(bp_dot(other, other) < SHORTER * bp_dot(edges[e], edges[e]))) return false;
    memcpy(edges[e], other, sizeof other);
    return true;
}

/* Makes edge e shorter by whole multiples of the others that repeat; false: it is as short as it can be. */
static bool shorten_edge(double edges[3][3], const bool periodic[3], int e) {
    const double *const f = edges[(e + 1) % 3], *const g = edges[(e + 2) % 3];
    const bool by_f = periodic[(e + 1) % 3], by_g = periodic[(e + 2) % 3];
    if (by_f && replace_edge(edges, e, -floor(bp_dot(edges[e], f) / bp_dot(f, f) + 0.5), 0)) return true;
    if (by_g && replace_edge(edges, e, 0, -floor(bp_dot(edges[e], g) / bp_dot(g, g) + 0.5))) return true;
    for (int x = -1; x <= 1 && by_f && by_g; x += 2)
        for (int y = -1; y <= 1; y += 2)
            if (replace_edge(edges, e, x, y)) return true;
    return false;
}

/* The edges that no sum of them with factors of -1, 0 and 1 makes shorter are the shortest of their lattice
 * (Minkowski 1905; up to four dimensions). */
static void shorten(double edges[3][3], const bool periodic[3]) {
    enum { MOST = 4096 }; /* far more than cells that are not flat need */
    bool shorter = true;
    for (int step = 0; step < MOST && shorter; step++) {
        shorter = false;
        for (int e = 0; e < 3; e++) shorter |= periodic[e] && shorten_edge(edges, periodic, e);
    }
}

/* A unit vector at right angles to edge `a` and to `b`, or to `a` alone where `b` is NULL. */
static void unit_across(const double a[3], const double *b, double out[3]) {
    double axis[3] = {0, 0, 0};
    int least = 0;
    for (int c = 1; c < 3; c++) least = fabs(a[c]) < fabs(a[least]) ? c : least;
    axis[least] = 1;
    bp_cross(a, b != NULL ? b : axis, out);
    const double length = sqrt(bp_dot(out, out));
    for (int c = 0; c < 3; c++) out[c] /= length;
}

/* Puts unit vectors in place of the edges that do not repeat. */
static void complete(double edges[3][3], const bool periodic[3]) {
    const int count = periodic[0] + periodic[1] + periodic[2];
    for (int e = 0; e < 3 && count == 2; e++)
        if (!periodic[e]) unit_across(edges[(e + 1) % 3], edges[(e + 2) % 3], edges[e]);
    for (int e = 0; e < 3 && count == 1; e++) {
        if (!periodic[e]) continue;
        unit_across(edges[e], NULL, edges[(e + 1) % 3]);
        unit_across(edges[e], edges[(e + 1) % 3], edges[(e + 2) % 3]);
    }
}

void bp_lattice_init(BpLattice *lattice, const double origin[3], const double edges[3][3],
                     const bool periodic[3]) {
    double own[3][3];
    memcpy(own, edges, sizeof own);
    shorten(own, periodic);
    complete(own, periodic);
    memcpy(lattice->periodic, periodic, sizeof lattice->periodic);
    bp_lattice_scale(lattice, origin, (const double(*)[3])own);
}

void bp_lattice_scale(BpLattice *lattice, const double origin[3], const double edges[3][3]) {
    memcpy(lattice->origin, origin, sizeof lattice->origin);
    memcpy(lattice->edges, edges, sizeof lattice->edges);
    invert(edges, lattice->inverse);
}

void bp_lattice_of(BpLattice *lattice, const BpParticles *particles) {
    static const double origin[3] = {0, 0, 0}, axes[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    static const bool nowhere[3] = {false, false, false};
    if (bp_particles_repeat(particles))
        bp_lattice_init(lattice, particles->cell_origin, (const double(*)[3])particles->cell,
                        particles->periodic);
    else
        bp_lattice_init(lattice, origin, axes, nowhere);
}

bool bp_lattice_repeats(const BpLattice *lattice) {
    return lattice->periodic[0] || lattice->periodic[1] || lattice->periodic[2];
}

void bp_lattice_shares(const BpLattice *lattice, const double place[3], double share[3], int32_t whole[3]) {
    for (int i = 0; i < 3; i++) {
        share[i] = 0;
        for (int k = 0; k < 3; k++) share[i] += (place[k] - lattice->origin[k]) * lattice->inverse[k][i];
        whole[i] = 0;
        if (!lattice->periodic[i]) continue;
        const double floored = floor(share[i]);
        if (fabs(floored) < BP_LATTICE_WHOLE_MAX) whole[i] = (int32_t)floored;
        share[i] -= floored;
    }
}

double bp_lattice_height(const BpLattice *lattice, int e) {
    const double(*const inverse)[3] = lattice->inverse;
    return 1 / sqrt(inverse[0][e] * inverse[0][e] + inverse[1][e] * inverse[1][e] +
                    inverse[2][e] * inverse[2][e]);
}

void bp_lattice_way(const BpLattice *lattice, const double a[3], const double b[3], const int32_t image[3],
                    double out[3]) {
    for (int i = 0; i < 3; i++) out[i] = b[i] - a[i];
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3 && image[i] != 0; k++) out[k] += image[i] * lattice->edges[i][k];
}

static double way_square(const BpLattice *lattice, const double a[3], const double b[3],
                         const int32_t image[3]) {
    double way[3];
    bp_lattice_way(lattice, a, b, image, way);
    return bp_dot(way, way);
}

void bp_lattice_nearest(const BpLattice *lattice, const double a[3], const double b[3], int32_t image[3]) {
    const int32_t here[3] = {0, 0, 0};
    int32_t middle[3] = {0, 0, 0}, least[3], most[3];
    for (int i = 0; i < 3; i++) {
        double share = 0;
        for (int k = 0; k < 3; k++) share += (b[k] - a[k]) * lattice->inverse[k][i];
        const double whole = floor(share + 0.5);
        if (lattice->periodic[i] && fabs(whole) < BP_LATTICE_WHOLE_MAX) middle[i] = -(int32_t)whole;
        least[i] = middle[i] - lattice->periodic[i];
        most[i] = middle[i] + lattice->periodic[i];
    }
    /* With the shortest edges, the nearest image lies in the cells around the one that rounding finds. */
    memcpy(image, here, sizeof here);
    double nearest = SHORTER * way_square(lattice, a, b, here);
    int32_t at[3];
    for (at[0] = least[0]; at[0] <= most[0]; at[0]++)
        for (at[1] = least[1]; at[1] <= most[1]; at[1]++)
            for (at[2] = least[2]; at[2] <= most[2]; at[2]++) {
                const double square = way_square(lattice, a, b, at);
                if (!(square < nearest)) continue;
                nearest = square;
                memcpy(image, at, sizeof at);
            }
}
