/* file_conflicts.c: see file_conflicts.h. */
#include "file_conflicts.h"

#include "base/input_file.h"
#include "base/output_target.h"
#include "option_table.h"
#include "scene/scene.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef struct Result {
    char option[32];
    const char *path; /* NULL: there is none */
} Result;

enum { RESULTS = BP_OPTION_NUMBER };

static void list_results(const BpCommandLine *line, const char *picture, Result results[RESULTS]) {
    for (int o = 0; o < RESULTS; ++o) {
        snprintf(results[o].option, sizeof results[o].option, "--%s", bp_option_name((BpOption)o));
        results[o].path = bp_option_result((BpOption)o, line);
    }
    if (line->output == NULL) results[BP_OPTION_OUTPUT] = (Result){"the picture", picture};
}

/* Whether the operands are files, not names of generators. */
static bool reads_files(const BpCommandLine *line) {
    return strcmp(line->command->name, "generate") != 0 && strcmp(line->command->name, "help") != 0;
}

static BpStatus refuse(const Result *result, const char *what, BpError *err) {
    return bp_fail(err, BP_ERR_USAGE, "%s %.400s would overwrite %s; choose another name", result->option,
                   strcmp(result->path, "-") == 0 ? "(standard output)" : result->path, what);
}

BpStatus bp_file_conflicts_check(const BpCommandLine *line, const char *picture, BpError *err) {
    Result results[RESULTS];
    list_results(line, picture, results);
    const bool merges = strcmp(line->command->name, "merge") == 0;
    for (size_t r = 0; r < RESULTS; ++r) {
        const Result *result = &results[r];
        if (result->path == NULL) continue;
        for (size_t o = 0; o < r; ++o) {
            if (results[o].path == NULL || !bp_output_same(result->path, results[o].path, STDOUT_FILENO))
                continue;
            return bp_fail(err, BP_ERR_USAGE, "%s and %s both name %.400s", result->option, results[o].option,
                           strcmp(result->path, "-") == 0 ? "standard output" : result->path);
        }
        for (size_t i = 0; i < line->operand_count && reads_files(line) && !(merges && r == BP_OPTION_OUTPUT);
             ++i)
            if (bp_output_same(result->path, line->operands[i], STDIN_FILENO))
                return line->output == NULL && r == BP_OPTION_OUTPUT
                           ? bp_fail(
                                 err, BP_ERR_USAGE,
                                 "%.400s is named like a picture, and the result would overwrite it; give a "
                                 "scene, or another name for the picture with -o",
                                 line->operands[i])
                           : refuse(result, "its own input", err);
        if (line->against != NULL && bp_output_same(result->path, line->against, STDIN_FILENO))
            return refuse(result, "the earlier check that --against names", err);
    }
    return BP_OK;
}

BpStatus bp_file_conflicts_check_scene(const BpCommandLine *line, const char *picture, const BpScene *scene,
                                       BpError *err) {
    Result results[RESULTS];
    BpStatus status = BP_OK;
    list_results(line, picture, results);
    for (size_t c = 0; c < scene->point_file_count + scene->mesh_file_count && status == BP_OK; ++c) {
        const bool is_mesh = c >= scene->point_file_count;
        const BpShapeFile *file =
            is_mesh ? &scene->mesh_files[c - scene->point_file_count] : &scene->point_files[c];
        char *path = bp_path_beside(scene->path, file->file);
        if (path == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for a path");
        for (size_t r = 0; r < RESULTS && status == BP_OK; ++r)
            if (results[r].path != NULL && bp_output_same(results[r].path, path, STDIN_FILENO))
                status = refuse(&results[r], is_mesh ? "a mesh of the scene" : "points of the scene", err);
        free(path);
    }
    return status;
}

BpStatus bp_file_conflicts_check_film(const BpCommandLine *line, const char *film, const char *what,
                                      bool is_output, BpError *err) {
    Result results[RESULTS];
    list_results(line, NULL, results);
    for (size_t r = 0; r < RESULTS; ++r)
        if (results[r].path != NULL && !(is_output && r == BP_OPTION_OUTPUT) &&
            bp_output_same(results[r].path, film, STDIN_FILENO))
            return refuse(&results[r], what, err);
    return BP_OK;
}
