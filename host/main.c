/* main.c: the program: read the command line, run the command, say what went wrong.
 *
 * In:    argc, argv.   Out: an exit code (BP_STATUS_LIST).
 * Knows: how an error is shown.   Does not know: what any command does. */
#include "base/json_memory.h"
#include "base/shown.h"
#include "cli/commands.h"
#include "cli/interrupt.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

/* Whether `text` has `word` standing by itself. */
static bool has_word(const char *text, const char *word) {
    const size_t length = strlen(word);
    for (const char *at = strstr(text, word); length > 0 && at != NULL; at = strstr(at + 1, word))
        if ((at == text || at[-1] == ' ') && strchr(" :;,", at[length]) != NULL)
            return true; /* '\0' as well */
    return false;
}

/* "ballpark: file:line:column: message", then the attachment (a build log) as it is. */
static void print_error(const BpError *err, BpStatus status) {
    /* A message about a file as a whole often names it already. */
    const bool names_file = err->line == 0 && has_word(err->message, err->file);
    /* "ballpark render: missing SCENE" names the program already. */
    if (err->file[0] != '\0' || strncmp(err->message, "ballpark ", 9) != 0) fputs("ballpark: ", stderr);
    if (err->file[0] != '\0' && !names_file) {
        bp_show(err->file, false, stderr);
        if (err->line > 0) fprintf(stderr, ":%d", err->line);
        if (err->line > 0 && err->column > 0) fprintf(stderr, ":%d", err->column);
        fputs(": ", stderr);
    }
    bp_show(err->message[0] != '\0' ? err->message : bp_status_name(status), false, stderr);
    fputc('\n', stderr);
    if (err->attachment == NULL) return;
    fputc('\n', stderr);
    bp_show(err->attachment, true, stderr);
    fputc('\n', stderr);
}

/* A standard stream that is closed is opened on /dev/null. Otherwise the next file that is opened would take
 * its number, and what is meant for the stream would be written into that file. It is opened in the wrong
 * direction, so that writing to a closed stream fails instead of being lost silently. */
static void open_standard_streams(void) {
    for (int stream = STDIN_FILENO; stream <= STDERR_FILENO; ++stream) {
        if (fcntl(stream, F_GETFD) >= 0 || errno != EBADF) continue;
        /* The lowest free number is taken: that of this stream, as those below are open by now. */
        if (open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY) < 0) (void)!open("/", O_RDONLY);
    }
}

/* BP_ERR_FILE unless everything that was written to standard output has arrived. */
static BpStatus finish_standard_output(BpError *err) {
    /* A write that failed earlier has left its mark, but its reason may be forgotten. */
    const bool failed_before = ferror(stdout) != 0;
    const bool closed = fclose(stdout) == 0;
    if (closed && !failed_before) return BP_OK;
    return bp_fail(err, BP_ERR_FILE, "cannot write to standard output: %s",
                   closed ? "not all of it was taken" : strerror(errno));
}

int main(int argc, char **argv) {
    BpCommandLine line;
    BpError err = {0};
    open_standard_streams();
    /* A reader that goes away, and a limit on the size of files, are failed writes like any other: reported,
     * and nothing is left half done. */
    signal(SIGPIPE, SIG_IGN);
    signal(SIGXFSZ, SIG_IGN);
    bp_interrupt_install();
    bp_json_memory_watch();

    BpStatus status = bp_command_line_parse(argc, argv, &line, &err);
    if (status == BP_OK) {
        if (line.version)
            printf("ballpark %s\n", bp_version());
        else if (line.help)
            status = bp_help_print(line.command, &err);
        else
            status = line.command->run(&line, &err);
    }
    if (status != BP_OK) print_error(&err, status);
    bp_error_clear(&err);
    const BpStatus finished = finish_standard_output(&err);
    if (status == BP_OK && finished != BP_OK) print_error(&err, finished);
    if (status == BP_OK) status = finished;
    bp_error_clear(&err);
    return bp_status_exit_code(status);
}
