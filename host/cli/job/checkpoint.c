/* checkpoint.c: see checkpoint.h. */
#include "checkpoint.h"

#include "cli/line/command_text.h"

#include "base/clock.h"
#include "base/escape.h"
#include "base/output_file.h"
#include "cli/line/file_conflicts.h"
#include "cli/line/option_table.h"
#include "cli/output/content.h"
#include "cli/output/output.h"
#include "film/film_file.h"

#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* The picture's name with .bpa in place of its ending. */
static bool name_beside(const char *picture, char *path, size_t size) {
    const char *base = strrchr(picture, '/');
    base = base == NULL ? picture : base + 1;
    const char *dot = strrchr(base, '.');
    const int stem = (int)(dot == NULL || dot == base ? strlen(picture) : (size_t)(dot - picture));
    return (size_t)snprintf(path, size, "%.*s.bpa", stem, picture) < size;
}

/* A file at the checkpoint's path is valuable: it is mostly of a render that was killed. */
static BpStatus check_free(const BpCheckpoint *checkpoint, BpError *err) {
    BpFilm *film = NULL;
    if (access(checkpoint->path, F_OK) != 0) return BP_OK;
    const bool readable = bp_film_read_header(checkpoint->path, &film, NULL) == BP_OK;
    const bool unfinished = readable && film->plan != NULL && !film->plan->ended;
    bp_film_destroy(&film);
    if (unfinished)
        return bp_fail(err, BP_ERR_USAGE,
                       "--checkpoint would replace %.400s, an unfinished render: continue it with --resume "
                       "%.400s, or remove it",
                       checkpoint->path, checkpoint->path);
    if (checkpoint->is_result) return BP_OK; /* a result is replaced, as results are without checkpoints */
    return bp_fail(
        err, BP_ERR_USAGE,
        "--checkpoint would replace %.400s, which already exists beside the picture: move it, or choose "
        "another --output",
        checkpoint->path);
}

BpStatus bp_checkpoint_choose(const BpCommandLine *line, const BpResultFile *result, BpCheckpoint *checkpoint,
                              BpError *err) {
    const bool asked = bp_option_given(line, BP_OPTION_CHECKPOINT);
    struct stat info;
    const bool to_stream =
        strcmp(result->path, "-") == 0 || (stat(result->path, &info) == 0 && !S_ISREG(info.st_mode));
    bool fits = true;
    *checkpoint = (BpCheckpoint){.every = line->checkpoint_seconds};
    checkpoint->is_result = result->format == BP_FORMAT_BPA && !to_stream;
    if (checkpoint->is_result)
        fits = (size_t)snprintf(checkpoint->path, sizeof checkpoint->path, "%s", result->path) <
               sizeof checkpoint->path;
    else if (line->resume != NULL)
        fits = (size_t)snprintf(checkpoint->path, sizeof checkpoint->path, "%s", line->resume) <
               sizeof checkpoint->path;
    else if (!asked)
        return BP_OK;
    else if (to_stream)
        return bp_fail(err, BP_ERR_USAGE,
                       "--checkpoint has no place beside %.400s: give the name of a file with --output",
                       bp_result_name(result));
    else
        fits = name_beside(result->path, checkpoint->path, sizeof checkpoint->path);
    if (!fits)
        return bp_fail(err, BP_ERR_FILE, "the path of the checkpoint beside %.200s is too long",
                       result->path);
    const BpCommandLine outputs = bp_result_line(line, result);
    if (line->resume != NULL)
        BP_TRY(bp_file_conflicts_check_film(&outputs, line->resume, "the film that --resume names",
                                            checkpoint->is_result, err));
    if (!asked) return BP_OK;
    BP_TRY(bp_file_conflicts_check_film(&outputs, checkpoint->path, "the sums that --checkpoint keeps",
                                        checkpoint->is_result, err));
    checkpoint->new_only = checkpoint->is_result && line->no_clobber;
    const bool own = line->resume != NULL && bp_output_same(checkpoint->path, line->resume, STDIN_FILENO);
    if (!own) BP_TRY(check_free(checkpoint, err));
    return bp_output_check(checkpoint->path, err);
}

void bp_checkpoint_start(BpCheckpoint *checkpoint) {
    checkpoint->last = bp_clock_seconds();
}

/* A film on its way to the file. */
typedef struct BpCheckpointWriter {
    pthread_t thread;
    bool threaded; /* else it is done already, since no thread could be created */
    atomic_bool done;
    const char *path;
    bool new_only;
    BpFilm *film; /* owned */
    BpStatus status;
    BpError err;
} Writer;

static void report(BpCheckpoint *checkpoint, BpStatus status, BpError *fault) {
    if (status == BP_OK) {
        ++checkpoint->written;
        checkpoint->new_only = false; /* from now on the file is this render's own */
    } else {
        /* Somebody else's file has taken the place: every further try would leave a file beside it. */
        if (checkpoint->new_only) checkpoint->every = 0;
        fputs("ballpark: warning: the checkpoint was not written, and rendering continues: ", stderr);
        bp_error_add_remedy(fault, BP_INTERFACE_COMMAND_LINE);
        bp_print_escaped(fault->message, false, stderr);
        fputc('\n', stderr);
    }
    bp_error_clear(fault);
}

static BpStatus write_to(const char *path, bool new_only, const BpFilm *film, BpError *err) {
    const BpCommandLine line = {.no_clobber = new_only};
    return bp_line_write_film(&line, path, film, err);
}

void bp_checkpoint_write(BpCheckpoint *checkpoint, const BpFilm *film) {
    BpError fault = {0};
    bp_checkpoint_wait(checkpoint);
    const BpStatus status = write_to(checkpoint->path, checkpoint->new_only, film, &fault);
    report(checkpoint, status, &fault);
}

static void *write_film(void *argument) {
    Writer *writer = argument;
    writer->status = write_to(writer->path, writer->new_only, writer->film, &writer->err);
    bp_film_destroy(&writer->film);
    atomic_store(&writer->done, true);
    return NULL;
}

/* The current film of the render, and a writer for it. */
static BpStatus take_film(const BpCheckpoint *checkpoint, BpRender *render, Writer **taken, BpError *err) {
    Writer *writer = calloc(1, sizeof *writer);
    if (writer == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for a checkpoint");
    writer->path = checkpoint->path;
    writer->new_only = checkpoint->new_only;
    const BpStatus status = bp_render_film(render, &writer->film, err);
    if (status != BP_OK) {
        free(writer);
        return status;
    }
    *taken = writer;
    return BP_OK;
}

bool bp_checkpoint_is_due(BpCheckpoint *checkpoint, double now) {
    if (checkpoint->writer != NULL && !atomic_load(&checkpoint->writer->done)) return false;
    bp_checkpoint_wait(checkpoint); /* if that failed, there may be no next one */
    return checkpoint->every > 0 && !checkpoint->is_elsewhere && now - checkpoint->last >= checkpoint->every;
}

BpStatus bp_checkpoint_begin(BpCheckpoint *checkpoint, BpRender *render, BpError *err) {
    const double start = bp_clock_seconds();
    bp_checkpoint_wait(checkpoint);
    if (checkpoint->is_elsewhere) {
        BpFilm *own = NULL;
        BP_TRY(bp_render_film(render, &own, err));
        bp_film_destroy(&own);
        return BP_OK;
    }
    BpError fault = {0};
    const BpStatus status = take_film(checkpoint, render, &checkpoint->writer, &fault);
    /* Other ranks have begun to send sums that this one cannot hold. */
    const bool bearable = status == BP_ERR_MEMORY && !checkpoint->is_shared;
    if (status == BP_OK) {
        Writer *writer = checkpoint->writer;
        writer->threaded = pthread_create(&writer->thread, NULL, write_film, writer) == 0;
        if (!writer->threaded) write_film(writer);
    } else if (bearable) {
        report(checkpoint, status, &fault); /* the render has the memory that it needs */
    } else if (err != NULL) {
        *err = fault;
    } else {
        bp_error_clear(&fault);
    }
    checkpoint->last = bp_clock_seconds();
    checkpoint->seconds += checkpoint->last - start;
    return bearable ? BP_OK : status;
}

void bp_checkpoint_wait(BpCheckpoint *checkpoint) {
    Writer *writer = checkpoint->writer;
    if (writer == NULL) return;
    const double start = bp_clock_seconds();
    if (writer->threaded) pthread_join(writer->thread, NULL);
    report(checkpoint, writer->status, &writer->err);
    free(writer);
    checkpoint->writer = NULL;
    checkpoint->seconds += bp_clock_seconds() - start;
}

bool bp_checkpoint_has_begun(const BpCheckpoint *checkpoint) {
    return checkpoint->written > 0 || checkpoint->writer != NULL;
}

void bp_checkpoint_end(const BpCommandLine *line, const BpCheckpoint *checkpoint) {
    if (!bp_option_given(line, BP_OPTION_CHECKPOINT) || checkpoint->is_result) return;
    if (checkpoint->written > 0 || line->resume != NULL) unlink(checkpoint->path);
}

const char *bp_checkpoint_command(const BpCommandLine *line, const BpCheckpoint *checkpoint,
                                  double seconds_left, char *text, size_t size) {
    return bp_command_text(line, checkpoint->path, fmax(1, ceil(seconds_left)), text, size);
}
