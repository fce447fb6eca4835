/* hard.c: the forty tests of numerical stability on one variant of the program.
 *
 *     hard VARIANT            double, float, all-double: every test must pass
 *     hard fast               --math fast: says which tests it fails; that is no failure of this program
 *
 * Exit code 77: the device cannot run the variant. */
#include "suite.h"

#include "base/status.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

BpScene *suite_scene(const char *format, ...) {
    char text[4096];
    BpScene *scene = NULL;
    BpError err = {0};
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    if (bp_scene_parse(text, strlen(text), "test", &scene, &err) != BP_OK)
        fail_msg("%s\n%s", err.message, text);
    return scene;
}

int main(int argc, char **argv) {
    Lab lab;
    if (argc != 2) {
        fprintf(stderr, "usage: hard double|float|all-double|fast\n");
        return 2;
    }
    if (!lab_open(&lab, argv[1])) return 77;
    printf("%s on %s\n", lab.name, lab.info.name);
    const int failed = run_sphere(&lab) + run_departure(&lab) + run_shells(&lab) + run_dielectric(&lab) +
                       run_sampling(&lab) + run_sums(&lab) + run_boxes(&lab);
    const bool report_only = strcmp(lab.name, "fast") == 0;
    lab_close(&lab);
    printf("%d tests failed%s\n", failed, report_only ? " (a report, not a verdict)" : "");
    return failed == 0 || report_only ? 0 : 1;
}
