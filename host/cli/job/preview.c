/* preview.c: see preview.h. */
#include "preview.h"

#include "base/clock.h"
#include "base/escape.h"
#include "image/image.h"
#include "render/render.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#define SHOW_SECONDS 1.0

BpStatus bp_preview_choose(const BpCommandLine *line, const BpComm *shared, const BpScene *scene,
                           const BpResultFile *file, BpPreview *preview, BpError *err) {
    struct stat info;
    const bool asked = bp_option_given(line, BP_OPTION_PREVIEW);
    *preview = (BpPreview){.line = line,
                           .file = file,
                           .scene = scene,
                           .writes = asked,
                           .shows = line->show,
                           .every = asked ? line->preview_seconds : SHOW_SECONDS,
                           .last = bp_clock_seconds()};
    if (!bp_comm_is_root(shared)) {
        preview->writes = preview->shows = false;
        return BP_OK;
    }
    if (preview->shows && line->comm != NULL && shared == NULL)
        return bp_fail(err, BP_ERR_USAGE,
                       "--show draws one picture at a time, and %" PRIu32
                       " ranks render several at once; --preview rewrites each one's file",
                       bp_comm_size(line->comm));
    if (preview->writes && file->format == BP_FORMAT_BPA)
        return bp_fail(err, BP_ERR_USAGE,
                       "--preview rewrites a picture, and %.400s holds sums; --checkpoint keeps those",
                       bp_result_name(file));
    if (preview->writes &&
        (strcmp(file->path, "-") == 0 || (stat(file->path, &info) == 0 && !S_ISREG(info.st_mode))))
        return bp_fail(err, BP_ERR_USAGE,
                       "--preview rewrites a file, and %.400s is not one: name one with --output",
                       bp_result_name(file));
    if (preview->writes && line->no_clobber)
        return bp_fail(err, BP_ERR_USAGE, "--preview overwrites its own picture, which --no-clobber refuses");
    if (preview->shows && line->quiet)
        return bp_fail(err, BP_ERR_USAGE, "--show draws in the terminal, where --quiet allows only errors");
    return preview->shows ? bp_terminal_picture_begin(&preview->terminal, err) : BP_OK;
}

bool bp_preview_is_due(const BpPreview *preview, double now) {
    return (preview->writes || preview->shows) && now - preview->last >= preview->every;
}

static BpStatus show(BpPreview *preview, const BpFilm *film, BpError *err) {
    BpPicture picture = {0};
    const BpTransfer transfer = bp_option_given(preview->line, BP_OPTION_TRANSFER)
                                    ? preview->line->transfer
                                    : (BpTransfer)film->transfer;
    BpStatus status = bp_film_picture(film, &picture, err);
    if (status == BP_OK) bp_picture_expose(&picture, preview->line->exposure);
    if (status == BP_OK) status = bp_terminal_picture_draw(&preview->terminal, &picture, transfer, err);
    bp_picture_clear(&picture);
    return status;
}

static void warn(BpPreview *preview, BpError *fault) {
    if (preview->warned) return;
    preview->warned = true;
    fputs("ballpark: warning: the preview was not written, and rendering continues: ", stderr);
    bp_error_add_remedy(fault, BP_INTERFACE_COMMAND_LINE);
    bp_print_escaped(fault->message, false, stderr);
    fputc('\n', stderr);
}

BpStatus bp_preview_update(BpPreview *preview, BpRender *render, BpError *err) {
    const BpFilm *film = NULL;
    BpStatus status = BP_OK;
    BP_TRY(bp_render_read_film(render, &film, err)); /* on one of several ranks alone it is whole */
    if (preview->writes) {
        BpError fault = {0};
        if (bp_result_write(preview->line, preview->file, film, false, (BpTransfer)film->transfer,
                            preview->scene, &fault) != BP_OK)
            warn(preview, &fault);
        bp_error_clear(&fault);
    }
    if (preview->shows) status = show(preview, film, err);
    preview->last = bp_clock_seconds();
    return status;
}

BpStatus bp_preview_end(BpPreview *preview, const BpFilm *film, BpError *err) {
    return preview->shows ? show(preview, film, err) : BP_OK;
}
