/* render_loop.c: see render_loop.h. */
#include "render_loop.h"

#include "base/clock.h"
#include "cli/process/interrupt.h"
#include "cli/terminal/page.h"
#include "cli/terminal/progress.h"
#include "cli/terminal/terminal.h"

#include <stdio.h>

#define REDRAW_SECONDS 0.1

/* A bar on a terminal. The ranks of a job have none, so one of them writes lines, which stay in its log. */
typedef struct Bar {
    bool live, logs;
    double start, drawn; /* when the render began, and when the bar was drawn last */
    char text[512];
} Bar;

static BpStatus draw(const BpCommandLine *line, BpStop *stop, const BpProgress *progress, Bar *bar,
                     BpError *err) {
    const double now = bp_clock_seconds();
    if (!bar->live && !bar->logs) return BP_OK;
    if (now <
        (bar->live ? bar->drawn + REDRAW_SECONDS : bar->start + bp_progress_next(bar->drawn - bar->start)))
        return BP_OK;
    BpStopEstimate estimate;
    BP_TRY(bp_stop_estimate(stop, progress, &estimate, err));
    const BpProgressView view = {.fraction = estimate.fraction,
                                 .samples_per_second = estimate.samples_per_second,
                                 .nrmse = estimate.nrmse,
                                 .seconds_left = estimate.seconds_left};
    if (bar->live)
        bp_terminal_show(bp_progress_format(&view, bp_terminal_columns(), bp_terminal_has_utf8(), bar->text,
                                            sizeof bar->text));
    else
        bp_say(line, "%s", bp_progress_sentence(&view, bar->text, sizeof bar->text));
    bar->drawn = now;
    return BP_OK;
}

/* Prepares the message for the case that other ranks never answer, when it could not be printed otherwise. */
static void prepare_explanation(const BpCommandLine *line, const BpStopRule *rule, double start,
                                const BpCheckpoint *checkpoint) {
    char text[9000], command[8192];
    if (bp_checkpoint_has_begun(checkpoint) || line->resume != NULL)
        snprintf(text, sizeof text,
                 "ballpark: interrupted, but the other ranks do not answer and may be lost; this command "
                 "continues from the last checkpoint:\n\n%s\n",
                 bp_checkpoint_command(line, checkpoint, rule->seconds - (bp_clock_seconds() - start),
                                       command, sizeof command));
    else
        snprintf(text, sizeof text,
                 "ballpark: interrupted, but the other ranks do not answer and may be lost, and there is no "
                 "checkpoint; with --checkpoint SECONDS, another run could continue from one\n");
    bp_interrupt_explain(text);
}

/* Whether a signal has arrived at this process, or at another one while ranks work apart. */
static bool is_interrupted(BpComm *shared, BpComm *all) {
    const bool own = bp_interrupted();
    if (shared != NULL || all == NULL) return own;
    if (own) bp_comm_notify(all);
    return own || bp_comm_was_notified(all);
}

BpStatus bp_render_loop(const BpCommandLine *line, BpComm *shared, BpRender *render, const BpStopRule *rule,
                        BpCheckpoint *checkpoint, BpPreview *preview, BpLoopEnd *end, BpError *err) {
    enum { INTERRUPT = 1, CHECKPOINT = 2, PREVIEW = 4 };
    const bool posts_explanation = shared != NULL && bp_comm_is_root(shared);
    const double start = bp_clock_seconds();
    BpStatus status = BP_OK;
    BpStop *stop = NULL;
    uint32_t requests = 0;
    Bar bar = {.live = bp_terminal_is_live(line->quiet), .start = start, .drawn = start};
    bar.logs = !bar.live && posts_explanation;
    end->reason = BP_STOP_NOT_YET;
    bp_interrupt_catch();
    bp_checkpoint_start(checkpoint);
    BP_TRY_GOTO(status, bp_stop_create(render, rule, &stop, err), done);
    while (end->reason == BP_STOP_NOT_YET) {
        BpProgress progress;
        if (posts_explanation) prepare_explanation(line, rule, start, checkpoint);
        BP_TRY_GOTO(status, bp_render_step(render, &progress, err), done);
        if (!bp_interrupted()) BP_TRY_GOTO(status, draw(line, stop, &progress, &bar, err), done);
        BP_TRY_GOTO(status, bp_stop_check(stop, &progress, &end->reason, err), done);
        requests = is_interrupted(shared, line->comm) ? INTERRUPT : 0;
        if (bp_checkpoint_is_due(checkpoint, bp_clock_seconds())) requests |= CHECKPOINT;
        if (bp_preview_is_due(preview, bp_clock_seconds())) requests |= PREVIEW;
        BP_TRY_GOTO(status, bp_comm_allreduce_or(shared, &requests, err), done); /* any rank may request */
        if (end->reason == BP_STOP_NOT_YET && (requests & (INTERRUPT | CHECKPOINT)) == CHECKPOINT)
            BP_TRY_GOTO(status, bp_checkpoint_begin(checkpoint, render, err), done);
        if (end->reason == BP_STOP_NOT_YET && (requests & (INTERRUPT | PREVIEW)) == PREVIEW)
            BP_TRY_GOTO(status, bp_preview_update(preview, render, err), done);
        if (requests & INTERRUPT) break; /* after a regular stop it is not an interruption */
    }
done:
    if (posts_explanation && status == BP_OK) bp_interrupt_explain("");
    bp_checkpoint_wait(checkpoint);
    bp_stop_destroy(&stop);
    end->seconds = bp_clock_seconds() - start;
    if (bar.live && bar.drawn > start) bp_terminal_show("");
    return status;
}
