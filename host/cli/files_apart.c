/* files_apart.c: see files_apart.h. */
#include "files_apart.h"

#include "commands.h"

#include <string.h>
#include <sys/stat.h>

typedef struct Result {
    const char *option, *path;
} Result;

enum { RESULTS = 6 };

bool bp_same_file(const char *a, const char *b) {
    struct stat first, second;
    const bool first_stands = stat(a, &first) == 0, second_stands = stat(b, &second) == 0;
    if (first_stands && !S_ISREG(first.st_mode)) return false;
    if (strcmp(a, b) == 0) return true;
    return first_stands && second_stands && first.st_dev == second.st_dev && first.st_ino == second.st_ino;
}

BpStatus bp_files_check_apart(const BpCommandLine *line, BpError *err) {
    const Result results[RESULTS] = {
        {"--output", line->output}, {"--stats", line->stats}, {"--error-map", line->error_map},
        {"--json", line->json},     {"--csv", line->csv},     {"--map", line->map}};
    const bool merges = strcmp(line->command->name, "merge") == 0;
    for (size_t r = 0; r < RESULTS; ++r) {
        const Result *result = &results[r];
        if (result->path == NULL) continue;
        for (size_t o = 0; o < r; ++o) {
            if (results[o].path == NULL || !bp_same_file(result->path, results[o].path)) continue;
            return bp_fail(err, BP_ERR_USAGE, "%s and %s both name %.400s", result->option, results[o].option,
                           strcmp(result->path, "-") == 0 ? "standard output" : result->path);
        }
        if (strcmp(result->path, "-") == 0 || (merges && r == 0)) continue;
        for (size_t i = 0; i < line->operand_count; ++i)
            if (bp_same_file(result->path, line->operands[i]))
                return bp_fail(err, BP_ERR_USAGE,
                               "%s %.400s would overwrite the file that is to be read; choose another name",
                               result->option, result->path);
    }
    return BP_OK;
}
