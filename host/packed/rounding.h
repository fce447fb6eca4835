/* rounding.h: what rounding a scene to single precision does to it, where that can be seen.
 *
 * In:    a validated scene.   Out: warnings, each naming a sphere, a triangle or the lens, a ratio and a
 * remedy; or an error. Knows: that the kernel sees centres relative to the camera, and all in float
 * (docs/NUMERICS.md). Does not know: OpenCL, where the warnings go. */
#ifndef BP_PACKED_ROUNDING_H
#define BP_PACKED_ROUNDING_H

#include "scene/scene.h"

#define BP_ROUNDING_SHIFT 0.01   /* of its own radius that a sphere may lie off its place */
#define BP_ROUNDING_CONTACT 0.02 /* of the smallest radius that a larger sphere's surface may lie off */
#define BP_ROUNDING_WALL 0.01    /* of its thickness that a hollow sphere's wall may be off */

#define BP_ROUNDING_VERTEX 0.01 /* of its triangle's shortest edge that a vertex may lie off its place */

#define BP_ROUNDING_LENS 0.1 /* of a pixel that a ray may meet the plane in focus off its place */

#define BP_ROUNDING_WARNINGS_MAX 5
typedef struct BpRoundingWarnings {
    unsigned count;
    char text[BP_ROUNDING_WARNINGS_MAX][480];  /* one line each, without "warning:" and without a remedy */
    char remedy[BP_ROUNDING_WARNINGS_MAX][48]; /* what helps instead of double precision: "a thicker wall" */
} BpRoundingWarnings;

/* At most one warning of each kind, about the worst sphere or triangle, saying how many more there are, or
 * the lens. Double precision has none: within the grammar's sizes its rounding stays below 1e-3 of a radius
 * of 1e-7 or more. */
void bp_rounding_warnings(const BpScene *scene, BpPrecision precision, BpRoundingWarnings *limits);

/* BP_ERR_SCENE where a sphere's index of refraction is so far from 1 that directions in float are too coarse:
 * a refracted ray errs by 1e-7 of the ratio of the indices. */
#define BP_SINGLE_INDEX_MAX 1.0e4 /* and at least its reciprocal */
BpStatus bp_rounding_check_indices(const BpScene *scene, BpPrecision precision, BpError *err);

#endif
