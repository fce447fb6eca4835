/* study_text.c: the results of a study as a text in memory; see ballpark.h.
 *
 * In:    a study that has ended.   Out: table, JSON, CSV or page.
 * Knows: which function prints each form.   Does not know: what they print. */
#include "base/escape.h"
#include "base/json_memory.h"
#include "base/status.h"
#include "base/wrap.h"
#include "study.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

enum { TEXT_COLUMNS = 80 };

static bool print_table(const BpStudyResult *result, FILE *out) {
    char *text = NULL;
    size_t size = 0;
    FILE *unwrapped = open_memstream(&text, &size);
    if (unwrapped == NULL) return false;
    bool done = bp_study_print(result, unwrapped);
    if (fclose(unwrapped) != 0) done = false;
    if (done) bp_wrap(text, TEXT_COLUMNS, out);
    free(text);
    return done;
}

static bool print_json(const BpStudyResult *result, FILE *out) {
    json_t *root = bp_study_json(result);
    char *const text = root != NULL && !bp_json_memory_failed()
                           ? json_dumps(root, JSON_INDENT(2) | JSON_REAL_PRECISION(12))
                           : NULL;
    if (text != NULL) bp_print_json_escaped(text, out);
    json_decref(root);
    free(text);
    return text != NULL && fputc('\n', out) != EOF;
}

BpStatus bp_study_text(const BpStudy *study, BpStudyFormat format, char **text, BpError *err) {
    static bool (*const print[])(const BpStudyResult *, FILE *) = {[BP_STUDY_TABLE] = print_table,
                                                                   [BP_STUDY_JSON] = print_json,
                                                                   [BP_STUDY_CSV] = bp_study_print_csv,
                                                                   [BP_STUDY_PAGE] = bp_study_print_page};
    if ((size_t)format >= sizeof print / sizeof print[0])
        return bp_fail(err, BP_ERR_USAGE, "unknown format %d of a study", (int)format);
    if (!bp_study_has_finished(study))
        return bp_fail(err, BP_ERR_USAGE, "the study has not finished: step it to its end, or stop it");
    char *bytes = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&bytes, &size);
    if (out == NULL) return bp_fail(err, BP_ERR_MEMORY, "no memory for the results: %s", strerror(errno));
    const bool printed = print[format](bp_study_result(study), out);
    if (fclose(out) == 0 && printed) {
        *text = bytes;
        return BP_OK;
    }
    free(bytes);
    return bp_fail(err, BP_ERR_MEMORY, "no memory for the results of a study");
}
