/* scene_faults.h: faults of a scene at their places in its document.
 *
 * In:    a scene, and the document that it was read from.   Out: an error with file:line:column.
 * Knows: from which member each part of a scene comes.   Does not know: what is a fault
 * (scene/scene_validate.c). */
#ifndef BP_FORMATS_SCENE_FAULTS_H
#define BP_FORMATS_SCENE_FAULTS_H

#include "document.h"
#include "scene/scene.h"

/* BP_ERR_SCENE at the member whose value breaks a rule of the scene; BP_OK: none does. */
BpStatus bp_refuse_faults(const BpNode *root, const BpScene *scene, BpError *err);

#endif
