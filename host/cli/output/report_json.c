/* report_json.c: see report_json.h. */
#include "report_json.h"

#include "base/names.h"

#include <stdio.h>

json_t *bp_calibration_json(const BpCalibration *calibration) {
    return json_pack("{s:s, s:i, s:i, s:f}", "kernel", bp_kernel_names[calibration->form], "group",
                     (int)calibration->local_size, "samples_per_item", (int)calibration->samples_per_item,
                     "gain", calibration->gain);
}

const char *bp_calibration_text(const BpCalibration *calibration, char text[BP_CALIBRATION_TEXT]) {
    const bool pool = calibration->form == BP_KERNEL_POOL;
    char gain[64] = "";
    if (calibration->gain > 1)
        snprintf(gain, sizeof gain, ", %.2f times as fast as without calibration", calibration->gain);
    if (pool)
        snprintf(text, BP_CALIBRATION_TEXT, "--kernel pool, groups of %u, %u samples a work-item%s",
                 calibration->local_size, calibration->samples_per_item, gain);
    else
        snprintf(text, BP_CALIBRATION_TEXT, "--kernel sample, groups of %u%s", calibration->local_size, gain);
    return text;
}

json_t *bp_report_settings(const BpRenderReport *report) {
    json_t *object = json_pack("{s:s}", "kernel", bp_kernel_names[report->kernel]);
#define SETTING(type, member, option, plural)                                                                \
    if (json_object_set_new(object, #member, json_string(bp_##member##_names[report->member])) != 0)         \
        goto failed;
    BP_SETTING_LIST(SETTING)
#undef SETTING
    return object;

failed:
    json_decref(object);
    return NULL;
}
