/* result_file.h: writes a film as the picture or .bpa file that --output, --format and --transfer ask for.
 *
 * In:    the command line, a film.   Out: a file, or bytes on standard output; the error map.
 * Knows: output names and formats.   Does not know: how the sums were made. */
#ifndef BP_CLI_OUTPUT_RESULT_FILE_H
#define BP_CLI_OUTPUT_RESULT_FILE_H

#include "cli/line/options.h"
#include "film/film.h"
#include "scene/scene.h"

typedef struct BpResultFile {
    char path[4096];      /* "-": standard output */
    char error_map[4096]; /* "": none */
    BpFormat format;
    bool is_own; /* the file there is a checkpoint of this run, so --no-clobber does not apply */
} BpResultFile;

/* Chooses the path of the result: -o, or `source` with its ending replaced by that of the format, in the
 * current folder, or for `render` in the folder that -o names; and the format: --format, else by the ending,
 * else PNG. Likewise the error map, NAME-error.png in a folder. With several scenes both must be folders.
 * Checks that both can be written, before any work is done. BP_ERR_USAGE (no format has that ending; binary
 * data to a terminal; one file for several pictures, or for two things) or BP_ERR_FILE. */
BpStatus bp_result_choose(const BpCommandLine *line, const char *source, BpResultFile *result, BpError *err);

/* Whether --output PATH is a folder: one exists there, or it ends with a slash. */
bool bp_result_is_folder(const char *path);

/* Announces, when work begins, which of both files will be overwritten (output.h). */
void bp_result_say_overwritten(const BpCommandLine *line, const BpResultFile *result);

/* Turns --width-mm and --dpi into --width. BP_ERR_USAGE: they do not go together, or give no picture. */
BpStatus bp_result_take_width(BpCommandLine *line, BpError *err);

/* Loads what draws text where the picture will have some (figure.h), and warns of what does not fit beside
 * it. For use before the render. BP_ERR_USAGE: no text can be drawn. */
BpStatus bp_result_check_text(const BpCommandLine *line, const BpResultFile *result, const BpScene *scene,
                              BpError *err);

/* Writes it, and the error map if there is to be one. `transfer`: unless --transfer overrides it. `rendered`:
 * the film is in no file yet, and is kept if the result cannot be written (keep_sums.h). `scene`: Optional;
 * the text of its figure is drawn beside pictures of 8 bits, and --depth-fog fades into its
 * backdrop. A film of a render that has not ended may lack what outlines and fog need; then they are left
 * out. */
BpStatus bp_result_write(const BpCommandLine *line, const BpResultFile *result, const BpFilm *film,
                         bool rendered, BpTransfer transfer, const BpScene *scene, BpError *err);

/* Whether depth decides how the picture looks: --outlines or --depth-fog. */
bool bp_result_has_cues(const BpCommandLine *line);

/* The command line with this result's files named explicitly. */
BpCommandLine bp_result_line(const BpCommandLine *line, const BpResultFile *result);

/* "cover.png", or "standard output". */
const char *bp_result_name(const BpResultFile *result);

/* Warns on standard error, unless --quiet, about visible rounding in a picture that is much dimmer than the
 * brightest lamp of its scene. */
void bp_result_warn(const BpCommandLine *line, const BpFilm *film);

#endif
