/* cmd_generate.c: `ballpark generate`.
 *
 * In:    what, how large, the seed.   Out: a scene document, or a field of spheres as PLY.
 * Knows: the generators' names.       Does not know: the order of their draws. */
#include "commands.h"

#include "base/output_file.h"
#include "base/plural.h"
#include "base/shown.h"
#include "formats/field.h"
#include "scene/scene.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

enum { GRID_DEFAULT = 11, FIELD_COUNT_DEFAULT = 1000000, SEED_DEFAULT = 1 };

static BpStatus refuse(const BpCommandLine *line, BpOption option, const char *name, BpError *err) {
    if (!bp_option_given(line, option)) return BP_OK;
    return bp_fail(err, BP_ERR_USAGE, "ballpark generate: %s does not take %s", line->operands[0], name);
}

static BpStatus generate_cover(const BpCommandLine *line, uint64_t seed, BpError *err) {
    const char *path = line->output != NULL ? line->output : "cover.json";
    const unsigned grid = bp_option_given(line, BP_OPTION_GRID) ? line->grid : GRID_DEFAULT;
    const bool to_stream = strcmp(path, "-") == 0;
    BpScene *scene = NULL;
    BpStatus status = BP_OK;
    if (!to_stream) BP_TRY(bp_output_check(path, err));
    BP_TRY(bp_scene_generate_cover(line->edition != NULL ? line->edition : "4", grid, seed, &scene, err));
    status = to_stream ? bp_scene_print(scene, stdout, err) : bp_scene_write(scene, path, err);
    if (status == BP_OK && !line->quiet) {
        BpSceneInfo info;
        bp_scene_info(scene, &info);
        bp_show(to_stream ? "standard output" : path, false, stderr);
        fprintf(stderr, ": %zu sphere%s, %s\n", info.spheres, bp_plural(info.spheres), info.title);
    }
    bp_scene_destroy(&scene);
    return status;
}

static BpStatus generate_field(const BpCommandLine *line, uint64_t seed, BpError *err) {
    const char *path = line->output != NULL ? line->output : "field.ply";
    const uint64_t count = bp_option_given(line, BP_OPTION_COUNT) ? line->count : FIELD_COUNT_DEFAULT;
    if (strcmp(path, "-") == 0)
        return bp_fail(
            err, BP_ERR_USAGE,
            "--output -: a field cannot be written to standard output; give a file that ends in .ply");
    BP_TRY(bp_output_check(path, err));
    BP_TRY(bp_field_write_ply(count, seed, path, err));
    if (line->quiet) return BP_OK;
    bp_show(path, false, stderr);
    fprintf(stderr, ": %" PRIu64 " sphere%s in the cube from -10 to 10\n", count, bp_plural(count));
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
