/* quaternion.c: see quaternion.h. */
#include "quaternion.h"

#include <math.h>
#include <string.h>

bool quaternion_normalize(double q[4]) {
    static const double none[4] = {1, 0, 0, 0};
    const double length = hypot(hypot(q[0], q[1]), hypot(q[2], q[3]));
    if (!(length > 0 && isfinite(length))) {
        memcpy(q, none, sizeof none);
        return false;
    }
    for (int i = 0; i < 4; i++) q[i] /= length;
    return true;
}

void quaternion_rotation(const double q[4], double rows[3][3]) {
    for (int i = 0; i < 3; i++) {
        const int k = (i + 1) % 3, l = (i + 2) % 3;
        rows[i][i] = 1 - 2 * (q[1 + k] * q[1 + k] + q[1 + l] * q[1 + l]);
        rows[i][k] = 2 * (q[1 + i] * q[1 + k] - q[0] * q[1 + l]);
        rows[i][l] = 2 * (q[1 + i] * q[1 + l] + q[0] * q[1 + k]);
    }
}

void quaternion_turn(const double rows[3][3], const double v[3], double out[3]) {
    for (int i = 0; i < 3; i++) out[i] = rows[i][0] * v[0] + rows[i][1] * v[1] + rows[i][2] * v[2];
}
