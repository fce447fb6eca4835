/* preview.h: shows the picture while it is rendered.
 *
 * In:    the command line, a render between two steps.   Out: the rewritten result file; a drawing in the
 * terminal.
 * Knows: --preview, --show, when a preview is due.   Does not know: how pictures are written and drawn. */
#ifndef BP_CLI_JOB_PREVIEW_H
#define BP_CLI_JOB_PREVIEW_H

#include "cli/output/result_file.h"
#include "cli/terminal/terminal_picture.h"
#include "cluster/comm.h"

typedef struct BpPreview {
    const BpCommandLine *line;
    const BpResultFile *file;
    const BpScene *scene;
    bool writes, shows;
    double every, last; /* seconds; bp_clock_seconds() of the latest */
    bool warned;
    BpTerminalPicture terminal;
} BpPreview;

/* BP_ERR_USAGE: no file to rewrite, or no terminal to draw in. `scene` and `file` must outlive the preview.
 * `shared`: Optional. The ranks that share the picture, one of which writes and draws. */
BpStatus bp_preview_choose(const BpCommandLine *line, const BpComm *shared, const BpScene *scene,
                           const BpResultFile *file, BpPreview *preview, BpError *err);

/* Whether a preview is due at `now`, by bp_clock_seconds(); on the rank that writes and draws. */
bool bp_preview_is_due(const BpPreview *preview, double now);

/* Writes and draws the current picture; called by all ranks that share it. A file that cannot be written
 * causes one warning, and rendering continues. BP_ERR_DEVICE or BP_ERR_MEMORY: the sums could not be read. */
BpStatus bp_preview_update(BpPreview *preview, BpRender *render, BpError *err);

/* Draws the finished picture, which another module writes. */
BpStatus bp_preview_end(BpPreview *preview, const BpFilm *film, BpError *err);

#endif
