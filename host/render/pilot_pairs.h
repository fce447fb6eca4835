/* pilot_pairs.h: whether rays to lamps that go through balls of glass or off mirrors find one chain of light.
 *
 * In:    a scene, a chain by which light has come to a point.
 * Out:   whether kernels find it from that point.
 * Knows: how kernels look for chains (kernels/light/focusers.cl, focuser_pairs.cl).   Does not know: shadows.
 *
 * Through one ball kernels find every chain. Through two they find some and leave the others to chance: those
 * that Newton's method does not come to from where it begins. Here the same is done in double, so the answer
 * is the same for all devices, and another than theirs for few chains only. */
#ifndef BP_RENDER_PILOT_PAIRS_H
#define BP_RENDER_PILOT_PAIRS_H

#include "pilot_lights.h"

/* The spheres and other shapes that a path has met, up to two of them, each in a row. */
typedef struct BpPilotMet {
    uint32_t count;
    uint32_t shapes[2], vertices[2]; /* on each */
    bool others;                     /* or the first one again, behind the second */
} BpPilotMet;

void bp_pilot_meet(BpPilotMet *met, uint32_t shape);
void bp_pilot_met_turn_round(BpPilotMet *met);

/* Whether rays to the light, from `point` through focusers, find the chain that begins along `direction`, a
 * unit vector, and meets these; it need not end at the light, but near it. */
bool bp_pilot_is_found(const BpScene *scene, const BpPilotLight *light, const BpPilotMet *met,
                       const double point[3], const double direction[3]);

#endif
