/* json_file.c: see json_file.h. */
#include "json_file.h"

#include "base/escape.h"
#include "base/json_memory.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

static BpStatus dump(const void *what, FILE *stream, BpError *err) {
    const json_t *root = what;
    char *const text = json_dumps(root, JSON_INDENT(2) | JSON_REAL_PRECISION(12));
    if (text == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for a document");
    errno = 0;
    bp_print_json_escaped(text, stream);
    free(text);
    return bp_print_end(stream, fputc('\n', stream) != EOF, err);
}

BpStatus bp_json_write_as(const BpCommandLine *line, json_t *root, const char *path, BpPrint *print,
                          BpError *err) {
    /* An allocation may also have failed without an error, leaving a list incomplete. */
    const BpStatus status = root == NULL || bp_json_memory_failed()
                                ? bp_fail(err, BP_ERR_MEMORY, "out of memory for the document %s", path)
                                : bp_line_write(line, path, print, root, err);
    json_decref(root);
    return status;
}

BpStatus bp_json_write(const BpCommandLine *line, json_t *root, const char *path, BpError *err) {
    return bp_json_write_as(line, root, path, dump, err);
}

json_t *bp_json_whole(uint64_t number) {
    char text[24];
    if (number <= INT64_MAX) return json_integer((json_int_t)number);
    snprintf(text, sizeof text, "%" PRIu64, number);
    return json_string(text);
}

json_t *bp_json_triple(const double v[3]) {
    return json_pack("[f,f,f]", v[0], v[1], v[2]);
}

json_t *bp_json_join(json_t *root, json_t *part) {
    const bool joined = json_object_update(root, part) == 0; /* fails where one is NULL */
    json_decref(part);
    if (joined) return root;
    json_decref(root);
    return NULL;
}
