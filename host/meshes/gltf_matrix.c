/* gltf_matrix.c: see gltf_matrix.h. */
#include "gltf_matrix.h"

Matrix matrix_of_parts(const double move[3], const double turn[4], const double scale[3]) {
    Matrix made = MATRIX_IDENTITY;
    const double length = turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2] + turn[3] * turn[3];
    const double s = length > 0 ? 2 / length : 0;
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        const double q[3] = {turn[i], turn[j], turn[k]}, w = turn[3];
        made.of[4 * i + i] = scale[i] * (1 - s * (q[1] * q[1] + q[2] * q[2]));
        made.of[4 * i + j] = scale[i] * s * (q[0] * q[1] + w * q[2]);
        made.of[4 * i + k] = scale[i] * s * (q[0] * q[2] - w * q[1]);
        made.of[12 + i] = move[i];
    }
    return made;
}

Matrix matrix_product(const Matrix *a, const Matrix *b) {
    Matrix made = MATRIX_IDENTITY;
    for (int column = 0; column < 4; column++)
        for (int row = 0; row < 3; row++) {
            double sum = column == 3 ? a->of[12 + row] : 0;
            for (int k = 0; k < 3; k++) sum += a->of[4 * k + row] * b->of[4 * column + k];
            made.of[4 * column + row] = sum;
        }
    return made;
}

void matrix_add(const Matrix *a, double weight, Matrix *sum) {
    for (int i = 0; i < 16; i++) sum->of[i] += weight * a->of[i];
}

void matrix_scale(double factor, Matrix *a) {
    for (int i = 0; i < 16; i++) a->of[i] *= factor;
}

void matrix_point(const Matrix *a, const double point[3], double moved[3]) {
    for (int row = 0; row < 3; row++)
        moved[row] =
            a->of[row] * point[0] + a->of[4 + row] * point[1] + a->of[8 + row] * point[2] + a->of[12 + row];
}

/* By the matrix of cofactors, which is the inverse's transpose times the determinant. So normals of mirrored
 * faces keep to the side of the surface that they were on. */
void matrix_normal(const Matrix *a, const double normal[3], double moved[3]) {
    double determinant = 0;
    for (int row = 0; row < 3; row++) {
        const int r = (row + 1) % 3, q = (row + 2) % 3;
        moved[row] = 0;
        for (int column = 0; column < 3; column++) {
            const int c = (column + 1) % 3, d = (column + 2) % 3;
            const double cofactor = a->of[4 * c + r] * a->of[4 * d + q] - a->of[4 * d + r] * a->of[4 * c + q];
            moved[row] += cofactor * normal[column];
            if (row == 0) determinant += cofactor * a->of[4 * column];
        }
    }
    for (int row = 0; row < 3 && determinant < 0; row++) moved[row] = -moved[row];
}

bool matrix_mirrors(const Matrix *a) {
    const double *const m = a->of;
    return m[0] * (m[5] * m[10] - m[9] * m[6]) - m[4] * (m[1] * m[10] - m[9] * m[2]) +
               m[8] * (m[1] * m[6] - m[5] * m[2]) <
           0;
}
