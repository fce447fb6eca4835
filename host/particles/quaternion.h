/* quaternion.h: orientations of particles.
 *
 * In:    quaternions (w, x, y, z).   Out: unit quaternions, rotations, vectors that they turn.
 * Does not know: how a format orders them. */
#ifndef BP_PARTICLES_QUATERNION_H
#define BP_PARTICLES_QUATERNION_H

#include <stdbool.h>

/* Makes it one of length 1, which turns alike. False: it has no direction, and becomes the one that does not
 * turn. */
bool quaternion_normalize(double q[4]);

/* The rotation of a unit quaternion: its rows, by which a vector is multiplied. */
void quaternion_rotation(const double q[4], double rows[3][3]);
void quaternion_turn(const double rows[3][3], const double v[3], double out[3]);

#endif
