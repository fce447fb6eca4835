/* file_conflicts.h: every file that a command names plays one part only.
 *
 * In:    the command line, a scene.       Out: whether a result would overwrite what is read, or another
 * result. Knows: which options name files, and which files a scene is read from. Does not know: what is
 * written to them, or when two names are one file (output_target.h). */
#ifndef BP_CLI_FILE_CONFLICTS_H
#define BP_CLI_FILE_CONFLICTS_H

#include "options.h"

/* BP_ERR_USAGE names the two options, or the option and the operand, that lead to one file. `picture`: where
 * the result goes when --output does not say, or NULL. `merge` may write its result over one of the
 * films: they have all been read by then, and the file is replaced as a whole. */
BpStatus bp_file_conflicts_check(const BpCommandLine *line, const char *picture, BpError *err);

/* The same for the files of points that the scene has been read from. */
BpStatus bp_file_conflicts_check_scene(const BpCommandLine *line, const char *picture, const BpScene *scene,
                                       BpError *err);

#endif
