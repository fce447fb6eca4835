/* lattice.c: see lattice.h. */
#include "lattice.h"

#include <string.h>

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

void bp_lattice_init(BpLattice *lattice, const double origin[3], const double edges[3][3], bool periodic) {
    lattice->periodic = periodic;
    memcpy(lattice->origin, origin, sizeof lattice->origin);
    memcpy(lattice->edges, edges, sizeof lattice->edges);
    invert(edges, lattice->inverse);
}

void bp_lattice_shares(const BpLattice *lattice, const double place[3], double share[3]) {
    for (int i = 0; i < 3; i++) {
        share[i] = 0;
        for (int k = 0; k < 3; k++) share[i] += (place[k] - lattice->origin[k]) * lattice->inverse[k][i];
        if (lattice->periodic) share[i] -= floor(share[i]);
    }
}

void bp_lattice_way(const BpLattice *lattice, const double a[3], const double b[3], double out[3]) {
    for (int i = 0; i < 3; i++) out[i] = b[i] - a[i];
    if (!lattice->periodic) return;
    double share[3];
    for (int i = 0; i < 3; i++) {
        share[i] = 0;
        for (int k = 0; k < 3; k++) share[i] += out[k] * lattice->inverse[k][i];
    }
    for (int i = 0; i < 3; i++) {
        const double whole = floor(share[i] + 0.5);
        for (int k = 0; k < 3 && whole != 0; k++) out[k] -= whole * lattice->edges[i][k];
    }
}
