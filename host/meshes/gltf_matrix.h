/* gltf_matrix.h: 4x4 matrices as glTF has them.
 *
 * In:    matrices by columns, translations, unit quaternions, scales.   Out: products; points and normals
 * that were moved. Does not know: files. */
#ifndef BP_MESHES_GLTF_MATRIX_H
#define BP_MESHES_GLTF_MATRIX_H

#include <stdbool.h>

typedef struct Matrix {
    double of[16]; /* column after column; the last row is taken for 0 0 0 1 */
} Matrix;

#define MATRIX_IDENTITY                                                                                      \
    {                                                                                                        \
        { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1 }                                                   \
    }

/* Scaled, then turned by a quaternion (x, y, z, w), then moved. A quaternion need not be of unit length. */
Matrix matrix_of_parts(const double move[3], const double turn[4], const double scale[3]);
/* The matrix that does what b does, then what a does. */
Matrix matrix_product(const Matrix *a, const Matrix *b);
/* Adds a, times a weight, to a sum; multiplies all numbers of a. */
void matrix_add(const Matrix *a, double weight, Matrix *sum);
void matrix_scale(double factor, Matrix *a);
void matrix_point(const Matrix *a, const double point[3], double moved[3]);
/* A normal, not of unit length, of a surface that is moved; it stays on the side where it is. */
void matrix_normal(const Matrix *a, const double normal[3], double moved[3]);
/* Whether it turns a body inside out. */
bool matrix_mirrors(const Matrix *a);

#endif
