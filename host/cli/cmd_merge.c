/* cmd_merge.c: `ballpark merge`.
 *
 * In:    .bpa files of disjoint samples.   Out: one picture or .bpa file of all samples.
 * Knows: files, the order in which they are added.   Does not know: how sums are added. */
#include "commands.h"

#include "base/format.h"
#include "base/plural.h"
#include "base/shown.h"
#include "film/film_file.h"
#include "result_file.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
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

static bool ranges_overlap(const BpFilm *a, const BpFilm *b) {
    for (size_t i = 0; i < a->range_count; ++i)
        for (size_t j = 0; j < b->range_count; ++j)
            if (a->ranges[i].first < b->ranges[j].first + b->ranges[j].count &&
                b->ranges[j].first < a->ranges[i].first + a->ranges[i].count)
                return true;
    return false;
}

/* The file before `at` that already has some of the samples of `from`, or NULL. The merged sums do not tell.
 */
static const char *find_overlap(const BpCommandLine *line, size_t at, const BpFilm *from) {
    for (size_t f = 0; f < at; ++f) {
        BpFilm *other = NULL;
        if (bp_film_read(line->operands[f], &other, NULL) != BP_OK) continue;
        const bool found = ranges_overlap(other, from);
        bp_film_destroy(&other);
        if (found) return line->operands[f];
    }
    return NULL;
}

static BpStatus add_file(const BpCommandLine *line, size_t at, BpFilm *sum, BpError *err) {
    BpFilm *from = NULL;
    BP_TRY(bp_film_read(line->operands[at], &from, err));
    BpStatus status = bp_film_merge(sum, from, err);
    if (status != BP_OK) {
        const char *other = find_overlap(line, at, from);
        char reason[sizeof err->message];
        snprintf(reason, sizeof reason, "%s", err != NULL ? err->message : "");
        bp_fail(err, status, "cannot merge %s and %s: %.600s", line->operands[at],
                other != NULL ? other : line->operands[0], reason);
    }
    bp_film_destroy(&from);
    return status;
}

BpStatus bp_command_merge(const BpCommandLine *line, BpError *err) {
    BpStatus status = BP_OK;
    BpFilm *sum = NULL;
    BpResultFile result;
    if (line->output == NULL)
        return bp_fail(err, BP_ERR_USAGE,
                       "ballpark merge: missing --output FILE: a picture, or another .bpa file");
    BP_TRY(bp_result_choose(line, line->operands[0], &result, err));
    BP_TRY_GOTO(status, bp_film_read(line->operands[0], &sum, err), done);
    for (size_t f = 1; f < line->operand_count; ++f) BP_TRY_GOTO(status, add_file(line, f, sum, err), done);
    BP_TRY_GOTO(status, bp_film_check_finite(sum, err), done);
    BP_TRY_GOTO(status, bp_result_write(line, &result, sum, false, (BpTransfer)sum->transfer, NULL, err), done);
    if (!line->quiet && result.format == BP_FORMAT_EXR && !bp_film_has_aovs(sum))
        fprintf(stderr,
                "depth, normals and albedo omitted: .bpa files of versions 1 and 2 do not hold them\n");
    if (!line->quiet) {
        char nrmse[32], ranges[120];
        bp_format_percent(bp_film_nrmse(sum), nrmse, sizeof nrmse);
        describe_ranges(sum, ranges, sizeof ranges);
        bp_show(bp_result_name(&result), false, stderr);
        fprintf(stderr, ": %" PRIu32 "x%" PRIu32 ", %" PRIu64 " sample%s per pixel (%s%s), noise %s\n",
                sum->width, sum->height, bp_film_range_total(sum), bp_plural(bp_film_range_total(sum)),
                ranges, sum->partial ? ", incomplete in some pixels" : "", nrmse);
    }
    if (!line->quiet) bp_result_warn(sum);
    if (!line->quiet && sum->invalid_samples > 0)
        fprintf(stderr, "warning: %" PRIu64 " sample%s not finite; left out of the picture\n",
                sum->invalid_samples, sum->invalid_samples == 1 ? " was" : "s were");
done:
    bp_film_destroy(&sum);
    return status;
}
