/* cmd_scene.c: `ballpark scene`.
 *
 * In:    a scene document or a file of particles.   Out: the document of its scene.
 * Knows: the folder to which paths in the output are relative.   Does not know: how documents are read and
 * written (formats/scene_load.c, formats/scene_write.c). */
#include "commands.h"

#include "cli/job/setup.h"
#include "cli/output/content.h"
#include "cli/output/output.h"
#include "formats/named_file.h"
#include "scene/scene.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static size_t folder_length(const char *path) {
    const char *const slash = strrchr(path, '/');
    return slash != NULL ? (size_t)(slash - path) + 1 : 0;
}

/* Whether `from` and `to` are in the same folder. */
static bool same_folder(const char *from, const char *to) {
    const size_t length = folder_length(from);
    return length == folder_length(to) && strncmp(from, to, length) == 0;
}

/* Makes the paths of images, particles and meshes relative to the folder of `to`: unchanged, below that
 * folder, or absolute. */
static BpStatus move_files(BpScene *scene, const char *from, const char *to, BpError *err) {
    if (same_folder(from, to)) return BP_OK;
    for (size_t i = 0; i < scene->image_count; i++) BP_TRY(bp_image_move(from, to, scene->images[i], err));
    for (size_t i = 0; i < scene->point_file_count; i++) {
        if (scene->point_files[i].entry == NULL) continue;
        BP_TRY(bp_shape_file_move(from, to, &scene->point_files[i], err));
    }
    for (size_t i = 0; i < scene->mesh_file_count; i++)
        if (scene->mesh_files[i].entry != NULL)
            BP_TRY(bp_shape_file_move(from, to, &scene->mesh_files[i], err));
    return BP_OK;
}

BpStatus bp_command_scene(const BpCommandLine *line, BpError *err) {
    const char *const path = line->operands[0];
    const char *const to = line->output != NULL ? line->output : "-";
    BpScene *scene = NULL;
    BP_TRY(bp_line_check_named(line, to, ".json", "a scene is written as a JSON document", err));
    BP_TRY(bp_setup_load(line, path, &scene, err));
    /* A document on standard output will be read relative to the current folder. */
    BpStatus status =
        move_files(scene, strcmp(path, "-") == 0 ? "" : path, strcmp(to, "-") == 0 ? "" : to, err);
    if (status == BP_OK) {
        bp_line_say_overwritten(line, to);
        status = bp_line_write_scene(line, to, scene, err);
    }
    bp_scene_destroy(&scene);
    return status;
}
