/* configurations.h: the configurations of the renderer that a study compares.
 *
 * In:    a scene, the options of the base.   Out: the configurations, in the order of the tables.
 * Knows: the options of a render, and their names in `ballpark render`.
 * Does not know: how anything is measured. */
#ifndef BP_STUDY_CONFIGURATIONS_H
#define BP_STUDY_CONFIGURATIONS_H

#include "study.h"

/* Fills the configurations of a scene and returns their number: 0 is the base; with `has_double`, 1 is the
 * truth. Configurations that equal the base are omitted. */
size_t bp_study_configurations(const BpScene *scene, const BpRenderOptions *base, bool has_double,
                               BpStudyConfiguration configurations[BP_STUDY_CONFIGURATIONS_MAX]);

#endif
