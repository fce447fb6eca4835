/* configurations.h: which configurations of the renderer a study compares.
 *
 * In:    a scene, the options of the base.   Out: the configurations, in the order in which they are shown.
 * Knows: the options of a render, and what `ballpark render` calls them.
 * Does not know: how anything is measured. */
#ifndef BP_STUDY_CONFIGURATIONS_H
#define BP_STUDY_CONFIGURATIONS_H

#include "study.h"

/* Fills the configurations of a scene and returns their number: 0 is the base; with `has_double`, 1 is the
 * truth. Ways that change nothing against the base are left out. */
size_t bp_study_configurations(const BpScene *scene, const BpRenderOptions *base, bool has_double,
                               BpStudyConfiguration configurations[BP_STUDY_CONFIGURATIONS_MAX]);

#endif
