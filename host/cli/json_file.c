/* json_file.c: see json_file.h. */
#include "json_file.h"

#include "base/json_memory.h"
#include "base/output_file.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

static bool dump(const json_t *root, FILE *stream) {
    return json_dumpf(root, stream, JSON_INDENT(2) | JSON_REAL_PRECISION(12)) == 0 &&
           fputc('\n', stream) != EOF && fflush(stream) == 0;
}

BpStatus bp_json_write(json_t *root, const char *path, BpError *err) {
    BpStatus status = BP_OK;
    BpOutputFile file = {0};
    /* An allocation may also have failed without an error, leaving a list incomplete. */
    if (root == NULL || bp_json_memory_failed()) {
        json_decref(root);
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for the document %s", path);
    }
    if (strcmp(path, "-") == 0) {
        if (!dump(root, stdout))
            status = bp_fail(err, BP_ERR_FILE, "cannot write to standard output: %s", strerror(errno));
        goto done;
    }
    BP_TRY_GOTO(status, bp_output_open(path, &file, err), done);
    if (!dump(root, file.stream)) {
        status = bp_output_fail(err, "write", path, errno);
        bp_output_discard(&file);
        goto done;
    }
    status = bp_output_commit(&file, err);
done:
    json_decref(root);
    return status;
}

json_t *bp_json_whole(uint64_t number) {
    char text[24];
    if (number <= INT64_MAX) return json_integer((json_int_t)number);
    snprintf(text, sizeof text, "%" PRIu64, number);
    return json_string(text);
}

BpStatus bp_json_check(const char *path, BpError *err) {
    return strcmp(path, "-") == 0 ? BP_OK : bp_output_check(path, err);
}

json_t *bp_json_join(json_t *root, json_t *part) {
    const bool joined = json_object_update(root, part) == 0; /* fails where one is NULL */
    json_decref(part);
    if (joined) return root;
    json_decref(root);
    return NULL;
}
