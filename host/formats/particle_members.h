/* particle_members.h: how the particles of an entry of "particles" are to look.
 *
 * In:    the node of the entry.   Out: a BpParticleStyle.
 * Knows: "style", "radius", "color", "bonds", "box", "solvent", "whole".   Does not know: what a look makes
 * of particles (particles/style.c). */
#ifndef BP_FORMATS_PARTICLE_MEMBERS_H
#define BP_FORMATS_PARTICLE_MEMBERS_H

#include "document.h"
#include "particles/style.h"

/* What the entry leaves out is as bp_particle_style_defaults() has it. */
BpStatus bp_parse_particle_style(const BpNode *node, BpParticleStyle *style, BpError *err);

#endif
