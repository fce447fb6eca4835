/* acceleration.h: whether the spheres of a scene are tested one after the other, or through a tree.
 *
 * In:    a validated Scene.   Out: the choice, with a reason in plain words.
 * Knows: up to how many spheres a list is faster.   Does not know: how a tree is built, OpenCL.
 *
 * Both give the same picture, bit for bit, so this is not an effect: it is chosen, not called for. */
#ifndef BP_PACKED_ACCELERATION_H
#define BP_PACKED_ACCELERATION_H

#include "scene/scene.h"

typedef enum BpAcceleration { BP_ACCELERATION_LIST, BP_ACCELERATION_TREE } BpAcceleration;

/* Up to this many spheres a list is at least as fast as a tree (measured: docs/EFFECTS.md). */
#define BP_LIST_SPHERES_MAX 32u

#define BP_ACCELERATION_REASON_SIZE 96

/* "list", "tree" */
const char *bp_acceleration_name(BpAcceleration acceleration);

/* The acceleration of a scene unless another is forced. `reason`: Optional. */
BpAcceleration bp_acceleration_choose(const BpScene *scene, char reason[BP_ACCELERATION_REASON_SIZE]);

#endif
