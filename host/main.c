/* main.c: the program: reads the command line, runs the command, reports errors.
 *
 * In:    argc, argv.   Out: an exit code (BP_STATUS_LIST).
 * Knows: how an error is shown, and by which of several processes.  Does not know: what any command does. */
#include "base/escape.h"
#include "base/json_memory.h"
#include "base/long_call.h"
#include "base/output_file.h"
#include "cli/commands.h"
#include "cli/process/driver_care.h"
#include "cli/process/interrupt.h"
#include "cli/terminal/page.h"
#include "cli/terminal/terminal.h"
#include "cluster/comm.h"
#include "cluster/launch.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Whether `text` contains `word` as a whole word. */
static bool has_word(const char *text, const char *word) {
    const size_t length = strlen(word);
    for (const char *at = strstr(text, word); length > 0 && at != NULL; at = strstr(at + 1, word))
        if ((at == text || at[-1] == ' ') && strchr(" :;,", at[length]) != NULL)
            return true; /* '\0' as well */
    return false;
}

/* "ballpark: file:line:column: message". */
static void print_message(const BpError *err, BpStatus status, FILE *out) {
    /* A message about a file as a whole often names it already. */
    const bool names_file = err->line == 0 && has_word(err->message, err->file);
    /* "ballpark render: missing SCENE" begins with the program already. */
    if (err->file[0] != '\0' || strncmp(err->message, "ballpark ", 9) != 0) fputs("ballpark: ", out);
    if (err->file[0] != '\0' && !names_file) {
        bp_print_escaped(err->file, false, out);
        if (err->line > 0) fprintf(out, ":%d", err->line);
        if (err->line > 0 && err->column > 0) fprintf(out, ":%d", err->column);
        fputs(": ", out);
    }
    bp_print_escaped(err->message[0] != '\0' ? err->message : bp_status_name(status), false, out);
    fputc('\n', out);
}

/* The message, in lines that fit a terminal; programs get it in one. Then the attachment (a build log) as it
 * is. */
static void print_error(BpError *err, BpStatus status, bool wide) {
    bp_error_add_remedy(err, BP_INTERFACE_COMMAND_LINE);
    char *text = NULL;
    size_t size = 0;
    FILE *message = open_memstream(&text, &size);
    if (message == NULL) print_message(err, status, stderr); /* out of memory: printed unwrapped */
    if (message != NULL) {
        print_message(err, status, message);
        const bool wraps = !wide && isatty(STDERR_FILENO);
        if (fclose(message) == 0) bp_page_print(text, wraps ? bp_terminal_columns() : 0, stderr);
        free(text);
    }
    if (err->attachment == NULL) return;
    fputc('\n', stderr);
    bp_print_escaped(err->attachment, true, stderr);
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

/* BP_ERR_FILE unless all output to standard output has been written. `flush_problem`: 0, or the errno of a
 * flush that has failed already. */
static BpStatus finish_standard_output(int flush_problem, BpError *err) {
    /* A write that failed earlier has set the stream's error flag, but errno may be lost. */
    const bool failed_before = ferror(stdout) != 0;
    const bool closed = fclose(stdout) == 0;
    if (closed && !failed_before) return BP_OK;
    const int problem = flush_problem != 0 ? flush_problem : closed ? 0 : errno;
    return bp_fail(err, BP_ERR_FILE, "cannot write to standard output: %s",
                   problem == 0 ? "not all of it was taken" : strerror(problem));
}

/* Whether standard output is a pipe whose reader has left, and there was output for it. */
static bool reader_has_left(void) {
    struct pollfd output = {.fd = STDOUT_FILENO};
    return ferror(stdout) != 0 && poll(&output, 1, 0) == 1 && (output.revents & POLLERR) != 0;
}

/* Ends the program by SIGPIPE without a message, as shells and scripts expect of a program that writes to a
 * pipe without a reader. */
static void end_by_signal(void) {
    sigset_t set;
    bp_output_abandon();
    sigemptyset(&set);
    sigaddset(&set, SIGPIPE);
    signal(SIGPIPE, SIG_DFL);
    sigprocmask(SIG_UNBLOCK, &set, NULL);
    raise(SIGPIPE);
}

/* Joins the other processes of the job, if there are any. `status`: of parsing the command line; a failure
 * occurs on all ranks, and one of them reports it. */
static BpStatus join_ranks(char **argv, BpCommandLine *line, BpStatus status, BpError *err) {
    if (line->command == NULL || !line->command->is_shared || line->help) return status;
    const BpStatus joined = bp_comm_begin(argv, &line->comm, status == BP_OK ? err : NULL);
    return status != BP_OK ? status : joined;
}

/* Returns the common status of all ranks. Does not return if this one failed during common work. */
static BpStatus leave_ranks(const BpCommandLine *line, BpStatus status, BpError *err) {
    if (!bp_comm_is_at_work(line->comm)) return bp_comm_all_ok(line->comm, status, err);
    bp_comm_prefix_rank(line->comm, err);
    print_error(err, status, line->wide);
    bp_output_abandon();
    bp_comm_abort(line->comm, bp_status_exit_code(status));
    return status;
}

int main(int argc, char **argv) {
    BpCommandLine line;
    BpError err = {0};
    open_standard_streams();
    /* A reader that goes away, and a limit on the size of files, are failed writes like any other, and
     * nothing is left half done. Once all files are written, the former ends the program as it ends others.
     */
    signal(SIGPIPE, SIG_IGN);
    signal(SIGXFSZ, SIG_IGN);
    bp_interrupt_install();
    bp_json_memory_watch();
    bp_driver_care_begin(argc, argv);

    BpStatus status = join_ranks(argv, &line, bp_command_line_parse(argc, argv, &line, &err), &err);
    /* With several ranks, only one reports the errors that they share. */
    const bool is_reporter =
        line.comm != NULL ? bp_comm_is_root(line.comm) : status == BP_OK || bp_launch_find().rank == 0;
    if (status == BP_OK) {
        if (line.version)
            printf("ballpark %s\n", bp_version());
        else if (line.help)
            status = bp_help_print(&line, line.command, &err);
        else
            status = bp_command_run(&line, &err);
    }
    if (line.comm != NULL) status = leave_ranks(&line, status, &err);
    const int flush_problem = fflush(stdout) == 0 ? 0 : errno;
    const bool left = reader_has_left();
    /* Other errors are still to be reported. */
    const bool about_output = status == BP_ERR_FILE && err.file[0] == '\0';
    if (left && (status == BP_OK || about_output)) end_by_signal();
    if (status != BP_OK && is_reporter) print_error(&err, status, line.wide);
    bp_error_clear(&err);
    const BpStatus finished = finish_standard_output(flush_problem, &err);
    if (finished != BP_OK && !about_output && is_reporter) print_error(&err, finished, line.wide);
    if (status == BP_OK) status = finished;
    bp_error_clear(&err);
    bp_comm_end(&line.comm);
    if (bp_long_call_hangs()) _exit(bp_status_exit_code(status)); /* with a driver that hangs */
    return bp_status_exit_code(status);
}
