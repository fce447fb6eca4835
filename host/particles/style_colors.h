/* style_colors.h: the colours of particles.
 *
 * In:    a frame, a style, which particles are shown.   Out: a linear colour for each.
 * Knows: palettes, colormaps, elements.   Does not know: which material has them, how large particles are. */
#ifndef BP_PARTICLES_STYLE_COLORS_H
#define BP_PARTICLES_STYLE_COLORS_H

#include "style_job.h"

/* Chooses by what colours are, and finds the range of a column. BP_ERR_SCENE: the file lacks that. */
BpStatus bp_style_choose_colors(BpStyleJob *job, BpError *err);
/* Of particle `i`, after that. */
void bp_style_color(const BpStyleJob *job, size_t i, double color[3]);

#endif
