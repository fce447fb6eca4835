/* particle_members.h: how the particles of an entry of "particles" are to look.
 *
 * In:    the node of the entry.   Out: a BpParticleStyle.
 * Knows: "style", "radius", "color", "bonds", "box", "solvent", "whole", "select".   Does not know: what a
 * look makes of particles (particles/style.c). */
#ifndef BP_FORMATS_PARTICLE_MEMBERS_H
#define BP_FORMATS_PARTICLE_MEMBERS_H

#include "document.h"
#include "particles/style.h"

/* What the entry leaves out is as bp_particle_style_defaults() has it. `narrow`: Optional; a condition that
 * holds for what is selected as well. Clear the style, also after a failure. */
BpStatus bp_parse_particle_style(const BpNode *node, const char *narrow, BpParticleStyle *style,
                                 BpError *err);

#endif
