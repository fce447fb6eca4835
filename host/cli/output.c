/* output.c: see output.h. */
#include "output.h"

#include "base/output_file.h"
#include "page.h"

#include <errno.h>
#include <string.h>

BpStatus bp_line_check_output(const BpCommandLine *line, const char *path, BpError *err) {
    if (strcmp(path, "-") == 0) return BP_OK;
    if (line->no_clobber) return bp_output_check_new(path, err);
    BP_TRY(bp_output_check(path, err));
    if (bp_output_replaces(path)) bp_say(line, "%s exists and will be overwritten", path);
    return BP_OK;
}

static BpStatus print_to_standard_output(BpPrint *print, const void *what, BpError *err) {
    BP_TRY(print(what, stdout, err));
    if (fflush(stdout) == 0 && !ferror(stdout)) return BP_OK;
    return bp_fail(err, BP_ERR_FILE, "cannot write to standard output: %s", strerror(errno));
}

BpStatus bp_line_write(const BpCommandLine *line, const char *path, BpPrint *print, const void *what,
                       BpError *err) {
    BpOutputFile file;
    BpError fault = {0};
    if (strcmp(path, "-") == 0) return print_to_standard_output(print, what, err);
    BP_TRY(line->no_clobber ? bp_output_open_new(path, &file, err) : bp_output_open(path, &file, err));
    const BpStatus status = print(what, file.stream, &fault);
    if (status == BP_OK) return bp_output_commit(&file, err);
    bp_output_discard(&file);
    if (status == BP_ERR_FILE) {
        bp_fail(err, status, "cannot write %s: %s", path, fault.message);
        bp_error_at(err, path, 0, 0);
    } else {
        bp_fail(err, status, "%s", fault.message);
    }
    bp_error_clear(&fault);
    return status;
}
