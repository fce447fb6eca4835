/* result_file.h: writes a film as the picture or .bpa file that --output, --format and --transfer ask for.
 *
 * In:    the command line, a film.   Out: a file, or bytes on standard output; the error map.
 * Knows: output names and formats.   Does not know: how the sums were made. */
#ifndef BP_CLI_RESULT_FILE_H
#define BP_CLI_RESULT_FILE_H

#include "film/film.h"
#include "options.h"
#include "scene/scene.h"

typedef struct BpResultFile {
    char path[4096]; /* "-": standard output */
    BpFormat format;
} BpResultFile;

/* Where the result goes (and that --error-map and --stats can be written too, to files of their own): -o, or
 * `default_path` with its ending replaced by that of the format, in the current folder; in which format:
 * --format, else by the ending, else PNG. Finds out that it can be written, before any work is done.
 * BP_ERR_USAGE (no format has that ending; binary data to a terminal) or BP_ERR_FILE. */
BpStatus bp_result_choose(const BpCommandLine *line, const char *default_path, BpResultFile *result,
                          BpError *err);

/* Writes it, and the error map if there is to be one. `transfer`: unless --transfer says otherwise.
 * `rendered`: the film is in no file yet, and is kept if the result cannot be written (keep_sums.h).
 * `legend`: Optional; where it is shown, a colour bar is drawn into pictures of 8 bits. */
BpStatus bp_result_write(const BpCommandLine *line, const BpResultFile *result, const BpFilm *film,
                         bool rendered, BpTransfer transfer, const BpLegend *legend, BpError *err);

/* "cover.png", or "standard output". */
const char *bp_result_name(const BpResultFile *result);

/* Warns on standard error of what may be wrong with sums that look right: rounding that shows, since the
 * picture is that dim beside the brightest lamp of its scene, and sums from a file without a checksum. */
void bp_result_warn(const BpFilm *film);

#endif
