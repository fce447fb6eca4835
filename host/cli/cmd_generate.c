/* cmd_generate.c: `ballpark generate`.
 *
 * In:    the generator, the size, the seed.   Out: a scene document, or a field of spheres as PLY.
 * Knows: the generators' names.       Does not know: how scenes are generated (formats/cover.c,
 * formats/field.c). */
#include "commands.h"

#include "base/format.h"
#include "base/plural.h"
#include "cli/output/content.h"
#include "cli/output/output.h"
#include "cli/terminal/page.h"
#include "formats/field.h"
#include "scene/scene.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { GRID_DEFAULT = 11, FIELD_COUNT_DEFAULT = 1000000, SEED_DEFAULT = 1 };

static BpStatus refuse(const BpCommandLine *line, BpOption option, const char *name, BpError *err) {
    if (!bp_option_given(line, option)) return BP_OK;
    return bp_fail(err, BP_ERR_USAGE, "ballpark generate: %s does not take %s", line->operands[0], name);
}

/* Where the result goes: --output, otherwise standard output if that is a pipe or a file, otherwise a file of
 * this name in the current folder. */
static const char *choose_path(const BpCommandLine *line, const char *name) {
    struct stat info;
    if (line->output != NULL) return line->output;
    const bool taken = fstat(STDOUT_FILENO, &info) == 0 && (S_ISFIFO(info.st_mode) || S_ISREG(info.st_mode));
    return taken ? "-" : name;
}

static const char *shown_name(const char *path) {
    return strcmp(path, "-") == 0 ? "standard output" : path;
}

static BpStatus generate_cover(const BpCommandLine *line, uint64_t seed, BpError *err) {
    const char *path = choose_path(line, "cover.json");
    const unsigned grid = bp_option_given(line, BP_OPTION_GRID) ? line->grid : GRID_DEFAULT;
    BpScene *scene = NULL;
    BP_TRY(bp_line_check_named(line, path, ".json", "the cover is written as a scene document", err));
    BP_TRY(bp_scene_generate_cover(line->edition != NULL ? line->edition : "4", grid, seed, &scene, err));
    bp_line_say_overwritten(line, path);
    const BpStatus status = bp_line_write_scene(line, path, scene, err);
    if (status == BP_OK) {
        BpSceneInfo info;
        bp_scene_info(scene, &info);
        char count[32];
        bp_say(line, "%s: %s sphere%s, %s", shown_name(path),
               bp_format_whole(info.spheres, count, sizeof count), bp_plural(info.spheres), info.title);
    }
    bp_scene_destroy(&scene);
    return status;
}

typedef struct Field {
    uint64_t count, seed;
} Field;

static BpStatus print_field(const void *what, FILE *out, BpError *err) {
    const Field *field = what;
    return bp_field_print_ply(field->count, field->seed, out, err);
}

static BpStatus generate_field(const BpCommandLine *line, uint64_t seed, BpError *err) {
    char count[32];
    const char *path = choose_path(line, "field.ply");
    const Field field = {bp_option_given(line, BP_OPTION_COUNT) ? line->count : FIELD_COUNT_DEFAULT, seed};
    if (strcmp(path, "-") == 0 && isatty(STDOUT_FILENO))
        return bp_fail(err, BP_ERR_USAGE,
                       "--output -: refusing to write a binary PLY file to the terminal; redirect standard "
                       "output to a file or a pipe");
    BP_TRY(bp_line_check_named(line, path, ".ply", "a field is written as a PLY file", err));
    bp_line_say_overwritten(line, path);
    BP_TRY(bp_line_write(line, path, print_field, &field, err));
    bp_say(line, "%s: %s sphere%s in the cube from -10 to 10", shown_name(path),
           bp_format_whole(field.count, count, sizeof count), bp_plural(field.count));
    return BP_OK;
}

BpStatus bp_command_generate(const BpCommandLine *line, BpError *err) {
    const uint64_t seed = bp_option_given(line, BP_OPTION_SEED) ? line->seed : SEED_DEFAULT;
    if (strcmp(line->operands[0], "cover") == 0) {
        BP_TRY(refuse(line, BP_OPTION_COUNT, "--count", err));
        return generate_cover(line, seed, err);
    }
    if (strcmp(line->operands[0], "field") == 0) {
        BP_TRY(refuse(line, BP_OPTION_GRID, "--grid", err));
        BP_TRY(refuse(line, BP_OPTION_EDITION, "--edition", err));
        return generate_field(line, seed, err);
    }
    return bp_fail(err, BP_ERR_USAGE, "ballpark generate: expected cover or field, found \"%.80s\"",
                   line->operands[0]);
}
