/* check_junit.c: see check_junit.h. */
#include "check_junit.h"

#include "base/json_text.h"
#include "check_entry.h"

#include <string.h>

json_t *bp_check_junit_suite(const json_t *entry) {
    char title[700];
    return json_pack("{s:o, s:{s:s, s:s, s:s, s:s, s:s}, s:[]}", "name",
                     bp_json_text(bp_check_device_title(entry, title, sizeof title)), "properties", "device",
                     bp_check_device_text(entry, "name"), "platform", bp_check_device_text(entry, "platform"),
                     "driver", bp_check_device_text(entry, "driver"), "version",
                     bp_check_device_text(entry, "version"), "ballpark", bp_version(), "cases");
}

static json_t *case_of(const json_t *scene, const json_t *entry) {
    const char *verdict = bp_check_text(entry, "verdict");
    const char *outcome = json_is_true(json_object_get(entry, "agree")) ? "passed"
                          : strcmp(verdict, "failed") == 0              ? "error"
                                                                        : "failure";
    const json_t *seconds = json_object_get(entry, "seconds");
    const double spent = json_number_value(json_object_get(seconds, "kernel")) +
                         json_number_value(json_object_get(seconds, "reference"));
    char name[BP_CHECK_LABEL_SIZE];
    return json_pack("{s:s, s:s, s:f, s:s, s:s, s:s}", "name", bp_check_label(scene, name, sizeof name),
                     "class", "ballpark.check", "seconds", spent, "outcome", outcome, "type", verdict,
                     "reason", bp_check_text(entry, "reason"));
}

json_t *bp_check_junit(const json_t *scenes, const json_t *broken) {
    json_t *suites = json_array(), *scene, *driver;
    const json_t *first = json_object_get(json_array_get(scenes, 0), "results");
    size_t index;
    int failed = suites == NULL;
    for (size_t d = 0; d < json_array_size(first) && !failed; ++d) {
        json_t *suite = bp_check_junit_suite(json_array_get(first, d));
        json_t *cases = json_object_get(suite, "cases");
        json_array_foreach(scenes, index, scene) {
            const json_t *entry = json_array_get(json_object_get(scene, "results"), d);
            failed |= json_array_append_new(cases, case_of(scene, entry));
        }
        failed |= json_array_append_new(suites, suite);
    }
    json_array_foreach(broken, index, driver) {
        json_t *suite = json_pack("{s:s, s:{s:s, s:s}, s:[{s:s, s:s, s:f, s:s, s:s, s:s}]}", "name",
                                  bp_check_text(driver, "file"), "properties", "library",
                                  bp_check_text(driver, "library"), "ballpark", bp_version(), "cases", "name",
                                  "list devices", "class", "ballpark.check", "seconds", 0.0, "outcome",
                                  "error", "type", "failed", "reason", bp_check_text(driver, "failure"));
        failed |= json_array_append_new(suites, suite);
    }
    if (!failed) return suites;
    json_decref(suites);
    return NULL;
}
