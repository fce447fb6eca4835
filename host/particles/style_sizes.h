/* style_sizes.h: which particles are shown, and how large.
 *
 * In:    a frame, a style.   Out: which particles are shown, their radii.
 * Knows: elements, residues, spacing.   Does not know: what is made of them (style_spheres.h). */
#ifndef BP_PARTICLES_STYLE_SIZES_H
#define BP_PARTICLES_STYLE_SIZES_H

#include "style_job.h"

/* Fills job->shown, usual and base, and the counts. BP_ERR_SCENE: nothing is selected, or the file lacks what
 * the expression is about. BP_ERR_MEMORY. */
BpStatus bp_style_choose_shown(BpStyleJob *job, BpError *err);
/* Chooses by what radii are. BP_ERR_SCENE: the file lacks that. */
BpStatus bp_style_choose_radii(BpStyleJob *job, BpError *err);
/* Of particle `i`, after that; NaN for a column that has no number there. */
double bp_style_radius(const BpStyleJob *job, size_t i);

#endif
