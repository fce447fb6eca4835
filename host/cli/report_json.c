/* report_json.c: see report_json.h. */
#include "report_json.h"

#include "base/names.h"

json_t *bp_report_settings(const BpRenderReport *report) {
    json_t *object = json_pack("{s:s}", "kernel", bp_kernel_names[report->kernel]);
#define SETTING(type, member, plural)                                                                        \
    if (json_object_set_new(object, #member, json_string(bp_##member##_names[report->member])) != 0)         \
        goto failed;
    BP_SETTING_LIST(SETTING)
#undef SETTING
    return object;

failed:
    json_decref(object);
    return NULL;
}
