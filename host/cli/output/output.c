/* output.c: see output.h. */
#include "output.h"

#include "cli/terminal/page.h"

#include <errno.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

BpStatus bp_line_check_output(const BpCommandLine *line, const char *path, BpError *err) {
    if (strcmp(path, "-") == 0) return BP_OK;
    if (line->no_clobber) return bp_output_check_new(path, err);
    return bp_output_check(path, err);
}

BpStatus bp_line_check_named(const BpCommandLine *line, const char *path, const char *ending,
                             const char *what, BpError *err) {
    struct stat info;
    const size_t length = strlen(path), end = strlen(ending);
    const bool named = strcmp(path, "-") != 0 && (stat(path, &info) != 0 || S_ISREG(info.st_mode)) &&
                       strncmp(path, "/dev/", 5) != 0 && strncmp(path, "/proc/", 6) != 0;
    if (named && (length <= end || strcasecmp(path + length - end, ending) != 0))
        return bp_fail(err, BP_ERR_USAGE, "--output %.400s: %s; use a name that ends in %s", path, what,
                       ending);
    return bp_line_check_output(line, path, err);
}

void bp_line_say_overwritten(const BpCommandLine *line, const char *path) {
    if (path == NULL || strcmp(path, "-") == 0 || line->no_clobber) return;
    if (bp_output_replaces(path)) bp_say(line, "%s exists and will be overwritten", path);
}

BpStatus bp_print_end(FILE *out, bool written, BpError *err) {
    if (written && fflush(out) == 0 && !ferror(out)) return BP_OK;
    const int error_number = errno;
    bp_fail(err, BP_ERR_FILE, "%s%s", out == stdout ? "cannot write to standard output: " : "",
            strerror(error_number));
    bp_output_advise(err, error_number);
    return BP_ERR_FILE;
}

static BpStatus print_to_standard_output(BpPrint *print, const void *what, BpError *err) {
    BP_TRY(print(what, stdout, err));
    return bp_print_end(stdout, true, err);
}

BpStatus bp_line_write(const BpCommandLine *line, const char *path, BpPrint *print, const void *what,
                       BpError *err) {
    if (strcmp(path, "-") == 0) return print_to_standard_output(print, what, err);
    return bp_output_write(path, line->no_clobber, print, what, err);
}
