/* report_json.h: what a render was set to, as members of a JSON document.
 *
 * In:    a render's report.   Out: an object of words.
 * Knows: the settings and their names.   Does not know: which document they go to. */
#ifndef BP_CLI_REPORT_JSON_H
#define BP_CLI_REPORT_JSON_H

#include "render/render.h"

#include <jansson.h>

/* {"kernel": ..., and the settings of base/names.h}. NULL: out of memory. */
json_t *bp_report_settings(const BpRenderReport *report);

#endif
