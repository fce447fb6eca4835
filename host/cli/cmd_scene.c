/* cmd_scene.c: `ballpark scene`.
 *
 * In:    a scene document or a file of particles.   Out: the document of the scene that it stands for.
 * Knows: where relative paths begin in what is written.   Does not know: the grammar. */
#include "commands.h"

#include "base/output_file.h"
#include "formats/scene_parse.h"
#include "scene/scene.h"
#include "setup.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static size_t folder_length(const char *path) {
    const char *const slash = strrchr(path, '/');
    return slash != NULL ? (size_t)(slash - path) + 1 : 0;
}

/* Whether files beside `from` are named alike beside `to`. */
static bool same_folder(const char *from, const char *to) {
    const size_t length = folder_length(from);
    return length == folder_length(to) && strncmp(from, to, length) == 0;
}

/* The names of files of particles as seen from the folder of `to`: unchanged, or absolute. */
static BpStatus move_files(BpScene *scene, const char *from, const char *to, BpError *err) {
    if (same_folder(from, to)) return BP_OK;
    for (size_t i = 0; i < scene->point_file_count; i++) {
        if (scene->point_files[i].particles == NULL) continue;
        BP_TRY(bp_point_file_make_absolute(from, &scene->point_files[i], err));
    }
    return BP_OK;
}

BpStatus bp_command_scene(const BpCommandLine *line, BpError *err) {
    const char *const path = line->operands[0];
    const bool to_stream = line->output == NULL || strcmp(line->output, "-") == 0;
    BpScene *scene = NULL;
    if (!to_stream) BP_TRY(bp_output_check(line->output, err));
    BP_TRY(bp_setup_load(line, path, &scene, err));
    /* What goes to standard output is read again as seen from the current folder. */
    BpStatus status =
        move_files(scene, strcmp(path, "-") == 0 ? "" : path, to_stream ? "" : line->output, err);
    if (status == BP_OK)
        status = to_stream ? bp_scene_print(scene, stdout, err) : bp_scene_write(scene, line->output, err);
    bp_scene_destroy(&scene);
    return status;
}
