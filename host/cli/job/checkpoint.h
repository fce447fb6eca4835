/* checkpoint.h: saves the sums of a render so that another can continue, and formats the command that does.
 *
 * In:    the command line, films.   Out: a .bpa file, each time written as a whole; a command line.
 * Knows: --checkpoint, --resume, when it is time.   Does not know: how the render continues (resume_film.h).
 */
#ifndef BP_CLI_JOB_CHECKPOINT_H
#define BP_CLI_JOB_CHECKPOINT_H

#include "cli/output/result_file.h"
#include "film/film.h"

typedef struct BpCheckpoint {
    char path[4096];                   /* "": nothing is kept */
    bool is_result;                    /* the file is the result itself (-o FILE.bpa) */
    bool new_only;                     /* --no-clobber: no file may be there when the first one is written */
    bool is_shared;                    /* several ranks share the render */
    bool is_elsewhere;                 /* another rank writes the file */
    double every;                      /* seconds; 0: only when the render is interrupted */
    double last;                       /* bp_clock_seconds() of the latest try */
    uint64_t written;                  /* how often */
    double seconds;                    /* for which the render has paused */
    struct BpCheckpointWriter *writer; /* NULL: none is running */
} BpCheckpoint;

/* Chooses the file: FILE.bpa of -o; else the file of --resume; else, with --checkpoint, the picture's path
 * with the ending .bpa. BP_ERR_USAGE: --checkpoint has no place, or would replace a file that a render left
 * there unfinished, or that is not a checkpoint of this render; or another result would replace the
 * checkpoint or the film that --resume names. */
BpStatus bp_checkpoint_choose(const BpCommandLine *line, const BpResultFile *result, BpCheckpoint *checkpoint,
                              BpError *err);

/* The render begins: the first checkpoint is due `every` seconds from now. */
void bp_checkpoint_start(BpCheckpoint *checkpoint);

/* Whether a file from which the render can continue has been written, or is being written. */
bool bp_checkpoint_has_begun(const BpCheckpoint *checkpoint);

/* Whether a checkpoint is due at `now`, by bp_clock_seconds(), and the previous one has been written. */
bool bp_checkpoint_is_due(BpCheckpoint *checkpoint, double now);

/* Writes the film. On failure, prints a warning; the earlier file stays and the render continues. */
void bp_checkpoint_write(BpCheckpoint *checkpoint, const BpFilm *film);

/* When one is due: reads the current film of the render, and writes it in a thread of its own, since packing
 * takes longer than reading: a render on a GPU does not wait for it, one on a CPU gives up a core. Called by
 * all ranks that share a render. Out of memory, there is a warning and no checkpoint; but BP_ERR_MEMORY if
 * ranks share the render. BP_ERR_DEVICE. */
BpStatus bp_checkpoint_begin(BpCheckpoint *checkpoint, BpRender *render, BpError *err);

/* Waits for the write that bp_checkpoint_begin() started. Must be called before the checkpoint goes out of
 * scope. */
void bp_checkpoint_wait(BpCheckpoint *checkpoint);

/* After the picture has been written: removes the checkpoint, if --checkpoint was given and it is not the
 * result. */
void bp_checkpoint_end(const BpCommandLine *line, const BpCheckpoint *checkpoint);

/* The command that continues from the checkpoint: the options as they were given, with `seconds_left` of
 * --time.
 * "" when it does not fit. Returns `text`. */
const char *bp_checkpoint_command(const BpCommandLine *line, const BpCheckpoint *checkpoint,
                                  double seconds_left, char *text, size_t size);

#endif
