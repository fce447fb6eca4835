/* remedy.c: see remedy.h. */
#include "remedy.h"

#include "words.h"

#include <stdio.h>
#include <string.h>

typedef const char *Words[3]; /* by BpInterface */

/* For C, the command line and Python; "%s" stands for the value. Words that begin with "or" continue the
 * advice at the end of the message. */
#define REMEDY_WORDS(X)                                                                                      \
    X(BP_REMEDY_NONE, BP_BRACED("", "", ""))                                                                 \
    X(BP_REMEDY_SMALLER_WIDTH, BP_BRACED("use a smaller width (bp_scene_set_width())",                       \
                                         "use a smaller --width", "use a smaller 'width'"))                  \
    X(BP_REMEDY_OR_SMALLER_WIDTH, BP_BRACED("or use a smaller width (bp_scene_set_width())",                 \
                                            "or use a smaller --width", "or use a smaller 'width'"))         \
    X(BP_REMEDY_WIDTH_AT_MOST, BP_BRACED("use a width of %s or less (bp_scene_set_width())",                 \
                                         "use --width %s or less", "use width=%s or less"))                  \
    X(BP_REMEDY_SMALLER_WIDTH_OR_OTHER_DEVICE,                                                               \
      BP_BRACED("use a smaller width (bp_scene_set_width()), or another device (bp_devices_list())",         \
                "use a smaller --width, or another --device", "use a smaller 'width', or another 'device'")) \
    X(BP_REMEDY_WIDTH_AT_MOST_OR_OTHER_DEVICE,                                                               \
      BP_BRACED("use a width of %s or less (bp_scene_set_width()), or another device (bp_devices_list())",   \
                "use --width %s or less, or another --device", "use width=%s or less, or another 'device'")) \
    X(BP_REMEDY_OTHER_DEVICE, BP_BRACED("use another device (bp_devices_list() lists them)",                 \
                                        "use another --device (`ballpark devices` lists them)",              \
                                        "use another 'device' (ballpark.devices() lists them)"))             \
    X(BP_REMEDY_OR_OTHER_DEVICE, BP_BRACED("or use another device (bp_devices_list() lists them)",           \
                                           "or use another --device (`ballpark devices` lists them)",        \
                                           "or use another 'device' (ballpark.devices() lists them)"))       \
    X(BP_REMEDY_SINGLE_PRECISION_OR_OTHER_DEVICE,                                                            \
      BP_BRACED(                                                                                             \
          "set BpRenderOptions.precision to BP_PRECISION_SINGLE, or use another device (bp_devices_list())", \
          "leave --precision double out, or use another --device",                                           \
          "use precision='single', or another 'device'"))                                                    \
    X(BP_REMEDY_DOUBLE_PRECISION, BP_BRACED("set BpRenderOptions.precision to BP_PRECISION_DOUBLE",          \
                                            "use --precision double", "use precision='double'"))             \
    X(BP_REMEDY_SMALLER_DEPTH, BP_BRACED("set a smaller BpRenderOptions.max_depth", "use a smaller --depth", \
                                         "use a smaller 'depth'"))                                           \
    X(BP_REMEDY_OTHER_FIRST_SAMPLE,                                                                          \
      BP_BRACED("render with another BpRenderOptions.first_sample", "render with another --first-sample",    \
                "render with another 'first_sample'"))                                                       \
    X(BP_REMEDY_SAME_SEED,                                                                                   \
      BP_BRACED("render both with the same BpRenderOptions.seed and different BpRenderOptions.first_sample", \
                "render both with the same --seed and different --first-sample",                             \
                "render both with the same 'seed' and different 'first_sample'"))                            \
    X(BP_REMEDY_SAME_WIDTH, BP_BRACED("use the same width for both (bp_scene_set_width())",                  \
                                      "use the same --width for both", "use the same 'width' for both"))     \
    X(BP_REMEDY_SAME_DEPTH, BP_BRACED("set the same BpRenderOptions.max_depth for both",                     \
                                      "use the same --depth for both", "use the same 'depth' for both"))     \
    X(BP_REMEDY_SAME_SETTING, BP_BRACED("set the same BpRenderOptions.%s for both",                          \
                                        "use the same --%s for both", "use the same '%s' for both"))         \
    X(BP_REMEDY_WRITABLE_PLACE,                                                                              \
      BP_BRACED("choose a path that can be written", "choose a writable place with -o",                      \
                "choose a 'path' that can be written"))                                                      \
    X(BP_REMEDY_OR_OTHER_PLACE,                                                                              \
      BP_BRACED("or choose another path", "or choose another place with -o", "or choose another 'path'"))    \
    X(BP_REMEDY_OTHER_NAME,                                                                                  \
      BP_BRACED("choose another name", "choose another name, or write without --no-clobber",                 \
                "choose another 'path'"))
BP_WORDS(BpRemedy, static const Words words, REMEDY_WORDS);

void bp_remedy_text(BpRemedy remedy, const char *value, BpInterface interface, char text[BP_REMEDY_SIZE]) {
    text[0] = '\0';
    if (remedy == BP_REMEDY_NONE) return;
    const char *clause = words[remedy][interface], *gap = strstr(clause, "%s");
    const int before = (int)(gap != NULL ? (size_t)(gap - clause) : strlen(clause));
    char name[sizeof((BpError *)0)->remedy_value];
    snprintf(name, sizeof name, "%s", gap != NULL ? value : "");
    /* Options have dashes where members have underscores. */
    for (char *c = name; *c != '\0' && interface == BP_INTERFACE_COMMAND_LINE; ++c)
        if (*c == '_') *c = '-';
    snprintf(text, BP_REMEDY_SIZE, "%s%.*s%s%s", strncmp(clause, "or ", 3) == 0 ? ", " : "; ", before, clause,
             name, gap != NULL ? gap + 2 : "");
}
