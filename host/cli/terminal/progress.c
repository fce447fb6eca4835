/* progress.c: see progress.h. */
#include "progress.h"

#include "base/format.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { BAR_COLUMNS_MIN = 8, BAR_COLUMNS_MAX = 40, PART_SIZE = 64 };

/* `cells` columns, of which the share `fraction` is full. UTF-8 blocks come in eighths. */
static size_t format_bar(double fraction, unsigned cells, bool utf8, char *text, size_t size) {
    static const char *const eighths[] = {"▏", "▎", "▍", "▌", "▋", "▊", "▉"};
    const unsigned filled_eighths = (unsigned)(fraction * cells * 8.0);
    size_t used = 0;
    text[0] = '\0';
    for (unsigned c = 0; c < cells && used + 4 < size; ++c) {
        const unsigned full = filled_eighths / 8, rest = filled_eighths % 8;
        const char *cell = utf8 ? "░" : "-";
        if (c < full)
            cell = utf8 ? "█" : "#";
        else if (utf8 && c == full && rest > 0)
            cell = eighths[rest - 1];
        used += (size_t)snprintf(text + used, size - used, "%s", cell);
    }
    return used;
}

enum { SHARE, LEFT, NOISE, RATE, PARTS };

/* The parts of the line, the most important first; "" if not known yet. */
static void format_parts(const BpProgressView *view, char parts[PARTS][PART_SIZE]) {
    char number[PART_SIZE - 16];
    const double fraction = fmin(fmax(view->fraction, 0.0), 1.0);
    snprintf(parts[SHARE], PART_SIZE, "%.0f %%", floor(100.0 * fraction));
    snprintf(parts[LEFT], PART_SIZE, "%s left",
             isfinite(view->seconds_left) ? bp_format_seconds(ceil(view->seconds_left), number, sizeof number)
                                          : "?");
    parts[NOISE][0] = '\0';
    if (isfinite(view->nrmse))
        snprintf(parts[NOISE], PART_SIZE, "noise %s", bp_format_percent(view->nrmse, number, sizeof number));
    snprintf(parts[RATE], PART_SIZE, "%s samples/s",
             bp_format_count(view->samples_per_second, number, sizeof number));
}

const char *bp_progress_sentence(const BpProgressView *view, char *text, size_t size) {
    char parts[PARTS][PART_SIZE];
    size_t used = 0;
    format_parts(view, parts);
    for (size_t p = 0; p < PARTS && used < size; ++p)
        if (parts[p][0] != '\0' && (p != LEFT || isfinite(view->seconds_left)))
            used += (size_t)snprintf(text + used, size - used, "%s%s", p == 0 ? "" : ", ", parts[p]);
    return text;
}

double bp_progress_next(double seconds) {
    double due = 3.0;
    while (due <= seconds) due += fmin(due, 600.0);
    return due;
}

const char *bp_progress_format(const BpProgressView *view, unsigned columns, bool utf8, char *text,
                               size_t size) {
    char known[PARTS][PART_SIZE], parts[PARTS][PART_SIZE + 2];
    const double fraction = fmin(fmax(view->fraction, 0.0), 1.0);
    format_parts(view, known);
    snprintf(parts[SHARE], sizeof parts[SHARE], " %5s", known[SHARE]); /* so that the bar stays where it is */
    for (size_t p = 1; p < PARTS; ++p)
        snprintf(parts[p], sizeof parts[p], "%s%s", known[p][0] != '\0' ? "  " : "", known[p]);

    /* One column stays free: some terminals wrap when the last one is written. */
    const unsigned room = columns > 0 ? columns - 1 : 0;
    if (room < BAR_COLUMNS_MIN + strlen(parts[SHARE])) {
        snprintf(text, size, "%s", strlen(known[SHARE]) <= room ? known[SHARE] : "");
        return text;
    }
    unsigned wanted = BAR_COLUMNS_MIN;
    size_t part_count = 0;
    while (part_count < PARTS && wanted + strlen(parts[part_count]) <= room)
        wanted += (unsigned)strlen(parts[part_count++]);
    unsigned bar = BAR_COLUMNS_MIN + (room - wanted);
    if (bar > BAR_COLUMNS_MAX) bar = BAR_COLUMNS_MAX;
    size_t used = format_bar(fraction, bar, utf8, text, size);
    for (size_t p = 0; p < part_count && used < size; ++p)
        used += (size_t)snprintf(text + used, size - used, "%s", parts[p]);
    return text;
}
