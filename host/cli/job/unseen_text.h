/* unseen_text.h: in words, what light the samples of a picture find by chance only.
 *
 * In:    what a pilot has found.   Out: sentences, and a JSON object.
 * Knows: names of spheres and materials.   Does not know: how it was found. */
#ifndef BP_CLI_JOB_UNSEEN_TEXT_H
#define BP_CLI_JOB_UNSEEN_TEXT_H

#include "ballpark.h"

#include <jansson.h>
#include <stdio.h>

/* "About 5 % of the light comes by way of spheres[1] (glass), and one sample in 1.1 million finds it." and
 * what helps. `luminance`: the mean of the picture; `caustics`: --caustics auto or on may find some of it. */
void bp_unseen_print(const BpScene *scene, const BpUnseenLight *light, double luminance, bool caustics,
                     FILE *out);

/* null without such light. `luminance` may be NaN: then so is the share. */
json_t *bp_unseen_json(const BpUnseenLight *light, double luminance);

#endif
