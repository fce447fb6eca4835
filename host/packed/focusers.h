/* focusers.h: the balls of glass and the mirrors through which rays are sent to lamps.
 *
 * In:    a validated scene.   Out: whether and why that is done; BpFocusers, in the layout of
 *        kernels/scene_types.h.
 * Knows: which spheres focus light, what counts as a lamp, the packed layout.   Does not know: OpenCL.
 *
 * A focuser is a metal sphere without fuzz, or a dielectric one whose index exceeds that of its outside, that
 * does not emit. Its targets are the lamps and discs that it does not touch. The table depends on the scene
 * alone, not on how its spheres are arranged, since the picture depends on it. */
#ifndef BP_PACKED_FOCUSERS_H
#define BP_PACKED_FOCUSERS_H

#include "tree.h"

/* A scene with more of one of these leaves the light through focusers to chance: every vertex tries all of
 * them. */
#define BP_FOCUSERS_MAX 32
#define BP_FOCUSER_LAMPS_MAX 32

typedef struct BpFocusers {
    uint32_t focuser_count;   /* with the one that ends the table */
    uint32_t target_count;    /* at least one, which may be a dummy */
    void *focusers;           /* focuser_count * FOCUSER_REALS reals, in the precision of the tree */
    uint32_t *focuser_places; /* focuser_count * FOCUSER_UINTS */
    void *targets;            /* target_count * TARGET_REALS reals */
    uint32_t *target_lamps;   /* target_count */
} BpFocusers;

/* Whether rays are sent through focusers, in a scene that has rays to lamps. `reason`: why, as a readable
 * text. */
bool bp_focusers_explain(const BpScene *scene, size_t size, char *reason);

/* Whether a chain is sought from vertices via a sphere to a lamp, or to a disc, where rays are sent
 * through focusers. */
bool bp_focuses_lamp(const BpScene *scene, size_t sphere, size_t lamp);
bool bp_focuses_disc(const BpScene *scene, size_t sphere, size_t disc);
/* Whether chains are sought via one sphere and then a second one, where both focus a lamp or a disc; and
 * whether there are two such spheres. */
bool bp_focuses_pair(const BpScene *scene, size_t first, size_t second);
bool bp_focusers_pair(const BpScene *scene);
/* Whether chains via one sphere are sought from the camera too, which needs a density of directions through a
 * pixel. */
bool bp_focusers_light_camera(const BpCamera *camera);
/* The most spheres' surfaces that such a chain meets at the focuser: 1 for a reflection. */
uint32_t bp_focuser_vertices(const BpScene *scene, size_t sphere);

/* Points are relative to `origin`. `wanted`: else the table is empty. BP_ERR_MEMORY. On failure `focusers` is
 * empty. Free with bp_focusers_clear(). */
BpStatus bp_focusers_build(const BpScene *scene, const double origin[3], const BpTree *tree, bool wanted,
                           BpFocusers *focusers, BpError *err);
void bp_focusers_clear(BpFocusers *focusers);

#endif
