/* report_json.h: a render's settings and calibration as members of a JSON document.
 *
 * In:    a render's report.   Out: objects, words.
 * Knows: the settings and their names.   Does not know: which document they belong to. */
#ifndef BP_CLI_OUTPUT_REPORT_JSON_H
#define BP_CLI_OUTPUT_REPORT_JSON_H

#include "render/render.h"

#include <jansson.h>

/* {"kernel", "group", "samples_per_item", "gain"}. NULL: out of memory. */
json_t *bp_calibration_json(const BpCalibration *calibration);

/* The same in words; returns `text`. */
#define BP_CALIBRATION_TEXT 160
const char *bp_calibration_text(const BpCalibration *calibration, char text[BP_CALIBRATION_TEXT]);

/* {"kernel": ..., and the settings of base/names.h}. NULL: out of memory. */
json_t *bp_report_settings(const BpRenderReport *report);

#endif
