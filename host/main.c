/* main.c: the program: read the command line, run the command, say what went wrong.
 *
 * In:    argc, argv.   Out: an exit code (BP_STATUS_LIST).
 * Knows: how an error is shown.   Does not know: what any command does. */
#include "base/json_memory.h"
#include "base/shown.h"
#include "cli/commands.h"
#include "cli/interrupt.h"
#include "cli/standard_streams.h"

#include <signal.h>
#include <stdio.h>
#include <string.h>

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
    fputs("ballpark: ", stderr);
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

int main(int argc, char **argv) {
    BpCommandLine line;
    BpError err = {0};
    bp_streams_open();
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
    const BpStatus finished = bp_streams_finish(&err);
    if (status == BP_OK && finished != BP_OK) print_error(&err, finished);
    if (status == BP_OK) status = finished;
    bp_error_clear(&err);
    return bp_status_exit_code(status);
}
