/* scene_fault.h: the first invariant of a scene that does not hold.
 *
 * In:    a scene.   Out: which part of it is at fault, and what was found and expected.
 * Knows: the invariants of scene.h. Does not know: where the scene was read from; the caller names the place.
 *
 * The rules are written once, here: the reader of documents turns a fault into file:line:column, the reader
 * of clouds into a vertex number, bp_scene_validate into an index. */
#ifndef BP_SCENE_SCENE_FAULT_H
#define BP_SCENE_SCENE_FAULT_H

#include "base/status.h"
#include "scene.h"

typedef enum BpFaultSubject {
    BP_FAULT_NONE,
    BP_FAULT_CAMERA,
    BP_FAULT_BACKGROUND,
    BP_FAULT_DISC, /* index: into discs[] */
    BP_FAULT_BACKDROP,
    BP_FAULT_TEXTURE,   /* index: into textures[] */
    BP_FAULT_MEDIUM,    /* index: into media[] */
    BP_FAULT_MATERIAL,  /* index: into materials[] */
    BP_FAULT_SPHERE,    /* index: into spheres[] */
    BP_FAULT_TRIANGLE,  /* index: into triangles[] */
    BP_FAULT_CAPSULE,   /* index: into capsules[] */
    BP_FAULT_ALBEDO,    /* index: into albedos[] */
    BP_FAULT_COINCIDENT /* index, other: spheres; other < index */
} BpFaultSubject;

typedef struct BpFault {
    BpFaultSubject subject;
    size_t index, other;
    const char *member; /* the name of the member at fault in the grammar; "" when it is the whole */
    char text[512];     /* "found ..., expected ..." */
} BpFault;

/* Sets all but the numbers of what is at fault; true. `member` must outlive the fault. */
bool bp_fault_set(BpFault *fault, BpFaultSubject subject, const char *member, const char *format, ...)
    BP_PRINTF_LIKE(4, 5);
/* Looks for the first fault; fault->subject is BP_FAULT_NONE when there is none. Fails for lack of memory. */
BpStatus bp_scene_find_fault(const BpScene *scene, BpFault *fault, BpError *err);
/* Whether one sphere is at fault (its material's index is not looked at). */
bool bp_sphere_find_fault(const BpSphere *sphere, BpFault *fault);
/* Two dielectrics with the same surface, as the kernel sees it: relative to the camera and in float. */
BpStatus bp_scene_find_coincident(const BpScene *scene, BpFault *fault, BpError *err);

#endif
