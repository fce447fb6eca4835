/* hard.c: the forty tests of numerical stability on one variant of the program.
 *
 *     hard VARIANT [GROUP]    double, float, all-double: every test must pass, or every one of a group
 *     hard fast [GROUP]       --math fast: says which tests it fails; that is no failure of this program
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

static const struct Group {
    const char *name;
    int (*run)(Lab *);
} groups[] = {{"sphere", run_sphere},     {"departure", run_departure},
              {"shells", run_shells},     {"dielectric", run_dielectric},
              {"sampling", run_sampling}, {"sums", run_sums},
              {"boxes", run_boxes}};

int main(int argc, char **argv) {
    Lab lab;
    if (argc != 2 && argc != 3) {
        fprintf(stderr, "usage: hard double|float|all-double|fast [GROUP]\n");
        return 2;
    }
    if (!lab_open(&lab, argv[1])) return 77;
    printf("%s on %s\n", lab.name, lab.info.name);
    int failed = 0, ran = 0;
    for (size_t i = 0; i < sizeof groups / sizeof groups[0]; ++i) {
        if (argc == 3 && strcmp(groups[i].name, argv[2]) != 0) continue;
        failed += groups[i].run(&lab);
        ++ran;
    }
    if (ran == 0) {
        fprintf(stderr, "hard: there is no group %s\n", argv[2]);
        failed = 1;
    }
    const bool report_only = strcmp(lab.name, "fast") == 0;
    lab_close(&lab);
    printf("%d tests failed%s\n", failed, report_only ? " (a report, not a verdict)" : "");
    return failed == 0 || report_only ? 0 : 1;
}
