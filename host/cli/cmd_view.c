/* cmd_view.c: `ballpark view`.
 *
 * In:    a scene, the module that opens windows.   Out: a window; pictures that its user saves.
 * Knows: which module that is, how saved pictures are named.   Does not know: how windows are opened
 * (view/window.h), what the window shows. */
#include "commands.h"

#include "base/format.h"
#include "base/module.h"
#include "base/plural.h"
#include "cli/job/setup.h"
#include "cli/line/command_text.h"
#include "cli/output/content.h"
#include "cli/output/output.h"
#include "cli/process/interrupt.h"
#include "cli/terminal/page.h"
#include "cli/terminal/terminal.h"
#include "opencl/device.h"
#include "view/viewer.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define TARGET 0.01 /* noise at which it stops, unless --error is given */

/* ---- the module ---------------------------------------------------------------------------------------- */

static BpStatus load_window(const BpWindow **window, BpError *err) {
    static const BpModuleName name = {"ballpark_window.so", "BALLPARK_WINDOW", BP_WINDOW_SYMBOL,
                                      BP_WINDOW_VERSION, false};
    const void *loaded = NULL;
    BpError fault = {0};
    if (bp_module_load(&name, &loaded, &fault) != BP_OK)
        return bp_fail(err, BP_ERR_USAGE,
                       "no window can be opened, since %.650s; install SDL 2 (`apt install libsdl2-dev`) and "
                       "build Ballpark again (`scripts/demo` does), or use `ballpark render --show`, which "
                       "draws in the terminal",
                       fault.message);
    *window = loaded;
    return BP_OK;
}

/* ---- saving ------------------------------------------------------------------------------------------- */

typedef struct Saving {
    const BpCommandLine *line;
    BpTransfer transfer;
    unsigned number; /* of the latest */
} Saving;

/* The scene's name without folder and ending, "scene" for standard input, then the first number that is free.
 */
static BpStatus choose_name(Saving *saving, char *name, size_t size, BpError *err) {
    const char *scene = saving->line->operands[0];
    const char *slash = strrchr(scene, '/'), *base = slash != NULL ? slash + 1 : scene;
    if (strcmp(scene, "-") == 0) base = "scene";
    const char *dot = strrchr(base, '.');
    const int stem = (int)(dot != NULL && dot != base ? (size_t)(dot - base) : strlen(base));
    do {
        if (++saving->number > 99999)
            return bp_fail(err, BP_ERR_FILE, "there are pictures of all numbers up to 99999 in this folder");
        if ((size_t)snprintf(name, size, "%.*s-view-%u.png", stem, base, saving->number) >= size)
            return bp_fail(err, BP_ERR_FILE, "the name of the scene is too long for that of a picture");
    } while (access(name, F_OK) == 0);
    return BP_OK;
}

/* The scene's camera as the value of --set, on one line. Heap; NULL: out of memory. */
static char *camera_text(const BpScene *scene) {
    char *text = NULL;
    size_t length = 0;
    FILE *out = open_memstream(&text, &length);
    if (out == NULL) return NULL;
    bp_scene_print_camera(&scene->camera, out);
    if (fclose(out) != 0) {
        free(text);
        return NULL;
    }
    const char *object = text != NULL ? strchr(text, '{') : NULL;
    if (object == NULL) return text;
    char *to = text; /* text begins with a name before the brace, which is at least as long */
    memcpy(to, "camera=", 7);
    to += 7;
    for (const char *c = object; *c != '\0'; ++c) {
        const bool space = *c == ' ' || *c == '\n';
        if (!space) *to++ = *c;
        if (space && c[1] != ' ' && c[1] != '\n' && c[1] != '\0') *to++ = ' ';
    }
    *to = '\0';
    return text;
}

/* With every option that affects the picture. The camera has those of --width, --fit and --projection. False
 * when there are too many for one command line. */
static bool make_command(const BpCommandLine *line, char *camera, double exposure,
                         char command[BP_COMMAND_TEXT_SIZE]) {
    static const BpOption others[] = {BP_OPTION_ERROR,      BP_OPTION_WIDTH, BP_OPTION_FIT,
                                      BP_OPTION_PROJECTION, BP_OPTION_QUIET, BP_OPTION_WIDE};
    char unnamed[] = "SCENE", *operand = line->operands[0];
    BpCommandLine again = *line;
    if (again.set.count == BP_TEXTS_MAX || bp_command_find("render", &again.command, NULL) != BP_OK)
        return false;
    for (size_t i = 0; i < sizeof others / sizeof others[0]; ++i) again.given[others[i]] = false;
    if (strcmp(operand, "-") == 0) operand = unnamed;
    again.operands = &operand;
    again.given[BP_OPTION_SET] = true;
    again.set.list[again.set.count++] = camera; /* the last one counts */
    again.given[BP_OPTION_EXPOSURE] = exposure != 0;
    again.exposure = exposure;
    return bp_command_text(&again, NULL, 0, command, BP_COMMAND_TEXT_SIZE)[0] != '\0';
}

static BpStatus save(void *context, const BpScene *scene, const BpPicture *picture, double exposure,
                     BpError *err) {
    Saving *saving = context;
    char name[1024], command[BP_COMMAND_TEXT_SIZE];
    BpCommandLine careful = *saving->line;
    careful.no_clobber = true;
    BP_TRY(choose_name(saving, name, sizeof name, err));
    BP_TRY(bp_line_write_picture(&careful, name, picture, BP_FORMAT_PNG, saving->transfer, NULL, err));
    char *camera = camera_text(scene);
    if (camera == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for the camera's text");
    const bool fits = make_command(saving->line, camera, exposure, command);
    bp_say(saving->line,
           fits ? "saved %s; this command renders it with less noise:"
                : "saved %s; the command that renders it with less noise would be too long; its camera:",
           name);
    puts(fits ? command : camera);
    fflush(stdout);
    free(camera);
    return BP_OK;
}

static void tell_keys(void *context) {
    const Saving *saving = context;
    if (!saving->line->quiet) fputs(bp_view_keys, stderr);
}

/* ---- the command -------------------------------------------------------------------------------------- */

static BpStatus open_devices(const BpCommandLine *line, BpDeviceInfo **infos, BpDevice ***devices,
                             size_t *count, BpError *err) {
    BP_TRY(bp_setup_devices(line, infos, count, err));
    BP_TRY(bp_setup_self_test(line, *infos, *count, err));
    *devices = calloc(*count, sizeof **devices);
    if (*devices == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for a list of devices");
    for (size_t d = 0; d < *count; ++d)
        BP_TRY(bp_device_open_part(&(*infos)[d], line->threads, &(*devices)[d], err));
    return BP_OK;
}

BpStatus bp_command_view(const BpCommandLine *line, BpError *err) {
    BpScene *scene = NULL;
    BpDeviceInfo *infos = NULL;
    BpDevice **devices = NULL;
    BpViewPlan plan = {
        .name = line->operands[0], .save = save, .opened = tell_keys, .interrupted = bp_interrupted};
    BpStatus status = BP_OK;
    BpWaiting *waiting = NULL;
    BP_TRY(load_window(&plan.window, err));
    BP_TRY_GOTO(status, bp_view_ready(plan.window, err), done);
    BP_TRY_GOTO(status, bp_setup_scene(line, line->operands[0], &scene, err), done);
    BP_TRY_GOTO(status, bp_setup_options(line, scene, &plan.options, err), done);
    bp_setup_warn(line, scene, plan.options.precision);
    if (!bp_option_given(line, BP_OPTION_SAMPLER)) plan.options.sampler = BP_SAMPLER_SOBOL;
    plan.options.samples_per_pixel = BP_SPP_MAX;
    plan.target = bp_option_given(line, BP_OPTION_ERROR) ? line->error_percent / 100 : TARGET;
    plan.transfer = bp_option_given(line, BP_OPTION_TRANSFER) ? line->transfer : scene->transfer;
    plan.exposure = line->exposure;
    Saving saving = {.line = line, .transfer = plan.transfer};
    plan.context = &saving;
    char spheres[32];
    waiting = bp_waiting_begin(line->quiet, "preparing %s %s%s and the kernel",
                               bp_format_whole(bp_scene_shapes(scene), spheres, sizeof spheres),
                               bp_scene_noun(scene), bp_plural(bp_scene_shapes(scene)));
    BP_TRY_GOTO(status, open_devices(line, &infos, &devices, &plan.device_count, err), done);
    plan.devices = devices;
    bp_waiting_end(waiting);
    waiting = NULL;
    bp_interrupt_catch();
    status = bp_view(&plan, scene, err);
done:
    plan.window->close();
    bp_waiting_end(waiting);
    for (size_t d = 0; d < plan.device_count && devices != NULL; ++d)
        if (devices[d] != NULL) bp_device_close(&devices[d]);
    free(devices);
    free(infos);
    bp_scene_destroy(&scene);
    return status;
}
