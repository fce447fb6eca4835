/* file_conflicts.c: see file_conflicts.h. */
#include "file_conflicts.h"

#include "base/output_target.h"
#include "commands.h"
#include "formats/input_file.h"
#include "scene/scene.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef struct Result {
    const char *option, *path;
} Result;

enum { RESULTS = 6 };

static void list_results(const BpCommandLine *line, const char *picture, Result results[RESULTS]) {
    results[0] = (Result){line->output != NULL ? "--output" : "the picture",
                          line->output != NULL ? line->output : picture};
    results[1] = (Result){"--stats", line->stats};
    results[2] = (Result){"--error-map", line->error_map};
    results[3] = (Result){"--json", line->json};
    results[4] = (Result){"--csv", line->csv};
    results[5] = (Result){"--map", line->map};
}

/* Whether the operands are files, and not names of something to be made. */
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
        for (size_t i = 0; i < line->operand_count && reads_files(line) && !(merges && r == 0); ++i)
            if (bp_output_same(result->path, line->operands[i], STDIN_FILENO))
                return refuse(result, "its own input", err);
    }
    return BP_OK;
}

BpStatus bp_file_conflicts_check_scene(const BpCommandLine *line, const char *picture, const BpScene *scene,
                                       BpError *err) {
    Result results[RESULTS];
    BpStatus status = BP_OK;
    list_results(line, picture, results);
    for (size_t c = 0; c < scene->point_file_count && status == BP_OK; ++c) {
        char *points = bp_path_beside(scene->path, scene->point_files[c].file);
        if (points == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for a path");
        for (size_t r = 0; r < RESULTS && status == BP_OK; ++r)
            if (results[r].path != NULL && bp_output_same(results[r].path, points, STDIN_FILENO))
                status = refuse(&results[r], "points of the scene", err);
        free(points);
    }
    return status;
}
