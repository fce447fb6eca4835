/* cmd_merge.c: `ballpark merge`.
 *
 * In:    .bpa files of disjoint samples.   Out: one picture or .bpa file of all samples.
 * Knows: which samples the files hold, the order in which they are added.   Does not know: how sums are
 * added. */
#include "commands.h"

#include "base/format.h"
#include "base/plural.h"
#include "cli/output/result_file.h"
#include "cli/terminal/page.h"
#include "film/film_file.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* "0 to 499, 1000 to 1499", or "none". */
static void describe_ranges(const BpFilm *film, char *text, size_t size) {
    size_t used = 0;
    text[0] = '\0';
    for (size_t r = 0; r < film->range_count && used < size; ++r)
        used += (size_t)snprintf(text + used, size - used, "%s%" PRIu64 " to %" PRIu64, r > 0 ? ", " : "",
                                 film->ranges[r].first, film->ranges[r].first + film->ranges[r].count - 1);
    if (used == 0) snprintf(text, size, "none");
}

/* ---- which samples the files hold: from their headers, before any sums are read ---- */

typedef struct Part {
    struct BpSampleRange range;
    size_t file; /* of the operands */
} Part;

typedef struct Parts {
    Part *list; /* sorted by their first samples, once all files are in it */
    size_t count, room;
    struct BpSampleRange job; /* of which all files are shares; a count of 0: they are not */
    size_t unfinished;        /* files in which some pixels lack samples */
    size_t an_unfinished;     /* one of them */
} Parts;

static int by_first_sample(const void *a, const void *b) {
    const Part *one = a, *other = b;
    if (one->range.first != other->range.first) return one->range.first < other->range.first ? -1 : 1;
    return one->file < other->file ? -1 : one->file > other->file;
}

static BpStatus add_parts(Parts *parts, const BpFilm *head, size_t file, BpError *err) {
    /* An empty film is merged like one without samples. */
    const size_t more = head->range_count > 0 ? head->range_count : 1;
    if (parts->count + more > parts->room) {
        const size_t room = 2 * parts->room + more;
        Part *grown = realloc(parts->list, room * sizeof *grown);
        if (grown == NULL)
            return bp_fail(err, BP_ERR_MEMORY, "out of memory for the sample ranges of the files");
        parts->list = grown;
        parts->room = room;
    }
    for (size_t r = 0; r < more; ++r) {
        const struct BpSampleRange none = {0, 0};
        parts->list[parts->count++] = (Part){head->range_count > 0 ? head->ranges[r] : none, file};
    }
    if (head->partial && (head->plan == NULL || !head->plan->adaptive)) {
        ++parts->unfinished;
        parts->an_unfinished = file;
    }
    return BP_OK;
}

/* Two files of different pictures. */
static BpStatus check_same(const BpCommandLine *line, const BpFilm *head, size_t file, const BpFilm *first,
                           BpError *err) {
    const BpStatus status = bp_film_check_same(first, head, err);
    if (status == BP_OK) return BP_OK;
    char reason[sizeof err->message];
    bp_error_add_remedy(err, BP_INTERFACE_COMMAND_LINE);
    snprintf(reason, sizeof reason, "%s", err != NULL ? err->message : "");
    return bp_fail(err, status, "cannot merge %s and %s: %.600s", line->operands[file], line->operands[0],
                   reason);
}

enum { NAMED_MAX = 4 }; /* the most pairs of files, or ranges, in a message */

/* Samples in two files would count twice. */
static BpStatus check_double(const BpCommandLine *line, const Parts *parts, BpError *err) {
    char pairs[700] = "";
    size_t used = 0, found = 0, widest = 0;
    for (size_t p = 1; p < parts->count; ++p) {
        const Part *part = &parts->list[p], *before = &parts->list[widest];
        const uint64_t end = before->range.first + before->range.count;
        if (part->range.first < end && part->range.count > 0 && before->range.count > 0 &&
            ++found <= NAMED_MAX && used < sizeof pairs)
            used += (size_t)snprintf(
                pairs + used, sizeof pairs - used,
                "%s%.120s (samples %" PRIu64 " to %" PRIu64 ") and %.120s (%" PRIu64 " to %" PRIu64 ")",
                found > 1 ? "; " : "", line->operands[before->file], before->range.first, end - 1,
                line->operands[part->file], part->range.first, part->range.first + part->range.count - 1);
        if (part->range.first + part->range.count > end) widest = p;
    }
    if (found == 0) return BP_OK;
    char more[60] = "";
    if (found > NAMED_MAX) snprintf(more, sizeof more, "; and %zu more pairs", found - NAMED_MAX);
    return bp_fail(
        err, BP_ERR_USAGE,
        "samples in two files would count twice: %s%s; leave one file of each pair out, or render it with "
        "another --first-sample",
        pairs, more);
}

static BpStatus read_headers(const BpCommandLine *line, Parts *parts, BpError *err) {
    BpStatus status = BP_OK;
    BpFilm *first = NULL, *head = NULL;
    for (size_t f = 0; f < line->operand_count; ++f) {
        BP_TRY_GOTO(status, bp_film_read_header(line->operands[f], &head, err), done);
        if (f > 0) BP_TRY_GOTO(status, check_same(line, head, f, first, err), done);
        BP_TRY_GOTO(status, add_parts(parts, head, f, err), done);
        if (f == 0) {
            parts->job = head->job;
            first = head;
            head = NULL;
        } else if (head->job.first != parts->job.first || head->job.count != parts->job.count) {
            parts->job.count = 0;
        }
        bp_film_destroy(&head);
    }
    qsort(parts->list, parts->count, sizeof *parts->list, by_first_sample);
    status = check_double(line, parts, err);
done:
    bp_film_destroy(&head);
    bp_film_destroy(&first);
    return status;
}

/* Reports the samples that are missing: gaps between the files, and the rest of a job that all files are
 * shares of. */
static void warn_missing(const BpCommandLine *line, const Parts *parts) {
    char text[400] = "";
    size_t used = 0, found = 0;
    uint64_t missing = 0, at = parts->job.count > 0 ? parts->job.first : 0;
    bool begun = parts->job.count > 0;
    for (size_t p = 0; p <= parts->count; ++p) {
        const bool last = p == parts->count;
        if (!last && parts->list[p].range.count == 0) continue;
        const uint64_t next = !last                   ? parts->list[p].range.first
                              : parts->job.count == 0 ? at
                                                      : parts->job.first + parts->job.count;
        if (begun && next > at) {
            missing += next - at;
            if (++found <= NAMED_MAX && used < sizeof text)
                used += (size_t)snprintf(text + used, sizeof text - used, "%s%" PRIu64 " to %" PRIu64,
                                         found > 1 ? ", " : "", at, next - 1);
        }
        if (last) break;
        const uint64_t end = parts->list[p].range.first + parts->list[p].range.count;
        if (!begun || end > at) at = end;
        begun = true;
    }
    if (found > 0)
        bp_say(line, "warning: %" PRIu64 " sample%s per pixel %s missing: %s%s", missing, bp_plural(missing),
               missing == 1 ? "is" : "are", text, found > NAMED_MAX ? ", ..." : "");
    if (parts->unfinished > 0) {
        char others[64] = "";
        if (parts->unfinished > 1)
            snprintf(others, sizeof others, " and %zu other file%s", parts->unfinished - 1,
                     bp_plural(parts->unfinished - 1));
        bp_say(line,
               "warning: some pixels lack samples in %s%s: ballpark render SCENE --resume FILE finishes it",
               line->operands[parts->an_unfinished], others);
    }
}

/* ---- adding, one file after the other ---- */

static BpStatus add_file(const BpCommandLine *line, size_t file, BpFilm **sum, BpError *err) {
    BpFilm *from = NULL;
    BP_TRY(bp_film_read(line->operands[file], &from, err));
    if (*sum == NULL) {
        *sum = from;
        return BP_OK;
    }
    const BpStatus status = bp_film_merge(*sum, from, err);
    bp_film_destroy(&from);
    if (status == BP_OK) return BP_OK;
    char reason[sizeof err->message];
    bp_error_add_remedy(err, BP_INTERFACE_COMMAND_LINE);
    snprintf(reason, sizeof reason, "%s", err != NULL ? err->message : "");
    return bp_fail(err, status, "cannot merge %s: %.600s", line->operands[file], reason);
}

/* In the order of their first samples, so that neighbours become one range; at no time are there more than
 * two films in memory. */
static BpStatus add_files(const BpCommandLine *line, const Parts *parts, BpFilm **sum, BpError *err) {
    bool *done = calloc(line->operand_count, sizeof *done);
    if (done == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for a list of files");
    BpStatus status = BP_OK;
    for (size_t p = 0; p < parts->count && status == BP_OK; ++p) {
        const size_t file = parts->list[p].file;
        if (!done[file]) status = add_file(line, file, sum, err);
        done[file] = true;
    }
    free(done);
    return status;
}

/* Films do not record the backdrop's colours. */
static BpStatus check_cues(const BpCommandLine *line, const BpFilm *sum, BpError *err) {
    if (bp_result_has_cues(line) && !bp_film_has_aovs(sum))
        return bp_fail(err, BP_ERR_USAGE,
                       "--outlines and --depth-fog need the depth, which none of the .bpa files holds");
    if (line->depth_fog > 0 && sum->met == NULL)
        return bp_fail(err, BP_ERR_USAGE,
                       "--depth-fog of sums needs an alpha: render their samples with --set backdrop=none");
    return BP_OK;
}

BpStatus bp_command_merge(const BpCommandLine *line, BpError *err) {
    BpStatus status = BP_OK;
    BpFilm *sum = NULL;
    Parts parts = {NULL, 0, 0, {0, 0}, 0, 0};
    BpResultFile result;
    if (line->output == NULL)
        return bp_fail(err, BP_ERR_USAGE,
                       "ballpark merge: missing --output FILE: a picture, or another .bpa file");
    BP_TRY(bp_result_choose(line, line->operands[0], &result, err));
    BP_TRY_GOTO(status, read_headers(line, &parts, err), done);
    BP_TRY_GOTO(status, add_files(line, &parts, &sum, err), done);
    BP_TRY_GOTO(status, bp_film_check_valid(sum, err), done);
    BP_TRY_GOTO(status, check_cues(line, sum, err), done);
    bp_result_say_overwritten(line, &result);
    BP_TRY_GOTO(status, bp_result_write(line, &result, sum, false, (BpTransfer)sum->transfer, NULL, err),
                done);
    if (result.format == BP_FORMAT_EXR && !bp_film_has_aovs(sum))
        bp_say(line, "depth, normals and albedo omitted: none of the .bpa files holds them");
    char nrmse[32], ranges[120];
    bp_format_percent(bp_film_nrmse(sum), nrmse, sizeof nrmse);
    describe_ranges(sum, ranges, sizeof ranges);
    bp_say(line, "%s: %" PRIu32 "x%" PRIu32 ", %" PRIu64 " sample%s per pixel (%s%s), noise %s",
           bp_result_name(&result), sum->width, sum->height, bp_film_range_total(sum),
           bp_plural(bp_film_range_total(sum)), ranges, sum->partial ? ", incomplete in some pixels" : "",
           nrmse);
    warn_missing(line, &parts);
    bp_result_warn(line, sum);
    char causes[BP_INVALID_TEXT_SIZE];
    if (sum->invalid_samples > 0) /* as in render: the file exists, but its picture is biased */
        status = bp_fail(
            err, BP_ERR_LIMIT,
            "%s lacks %" PRIu64 " sample%s invalid%s; `ballpark check` compares a device with the "
            "reference tracer",
            bp_result_name(&result), sum->invalid_samples,
            sum->invalid_samples == 1 ? " that was" : "s that were", bp_film_invalid_causes(sum, causes));
done:
    free(parts.list);
    bp_film_destroy(&sum);
    return status;
}
