/* file_conflicts.h: refuses command lines in which one file would be used for two things.
 *
 * In:    the command line, a scene.   Out: an error if a result would overwrite an input or another result.
 * Knows: which options name files, and which files a scene is read from.
 * Does not know: what is written to them, when two names mean one file (base/output_target.h). */
#ifndef BP_CLI_LINE_FILE_CONFLICTS_H
#define BP_CLI_LINE_FILE_CONFLICTS_H

#include "options.h"

/* BP_ERR_USAGE names the two options, or the option and the operand, that name the same file. `picture`: the
 * result's file without --output, or NULL. `merge` may overwrite one of its .bpa files: all have been read by
 * then, and the file is replaced as a whole. */
BpStatus bp_file_conflicts_check(const BpCommandLine *line, const char *picture, BpError *err);

/* The same for the point files that the scene was read from. */
BpStatus bp_file_conflicts_check_scene(const BpCommandLine *line, const char *picture, const BpScene *scene,
                                       BpError *err);

/* The same for a film that the run reads or keeps: BP_ERR_USAGE if a result would overwrite `film`, which
 * messages call `what`. `is_output`: --output may overwrite it, since its sums replace the film. */
BpStatus bp_file_conflicts_check_film(const BpCommandLine *line, const char *film, const char *what,
                                      bool is_output, BpError *err);

#endif
