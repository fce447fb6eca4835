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

const char *bp_progress_format(const BpProgressView *view, unsigned columns, bool utf8, char *text,
                               size_t size) {
    char parts[4][PART_SIZE], number[PART_SIZE - 16];
    const double fraction = fmin(fmax(view->fraction, 0.0), 1.0);
    snprintf(parts[0], PART_SIZE, " %3.0f %%", floor(100.0 * fraction));
    snprintf(parts[1], PART_SIZE, "  %s left",
             isfinite(view->seconds_left) ? bp_format_seconds(ceil(view->seconds_left), number, sizeof number)
                                          : "?");
    if (isfinite(view->nrmse))
        snprintf(parts[2], PART_SIZE, "  noise %s", bp_format_percent(view->nrmse, number, sizeof number));
    else
        parts[2][0] = '\0';
    snprintf(parts[3], PART_SIZE, "  %s samples/s",
             bp_format_count(view->samples_per_second, number, sizeof number));

    /* One column stays free: some terminals wrap when the last one is written. */
    const unsigned room = columns > 0 ? columns - 1 : 0;
    if (room < BAR_COLUMNS_MIN + strlen(parts[0])) {
        const char *share = parts[0] + strspn(parts[0], " ");
        snprintf(text, size, "%s", strlen(share) <= room ? share : "");
        return text;
    }
    unsigned wanted = BAR_COLUMNS_MIN;
    size_t part_count = 0;
    while (part_count < 4 && wanted + strlen(parts[part_count]) <= room)
        wanted += (unsigned)strlen(parts[part_count++]);
    unsigned bar = BAR_COLUMNS_MIN + (room - wanted);
    if (bar > BAR_COLUMNS_MAX) bar = BAR_COLUMNS_MAX;
    size_t used = format_bar(fraction, bar, utf8, text, size);
    for (size_t p = 0; p < part_count && used < size; ++p)
        used += (size_t)snprintf(text + used, size - used, "%s", parts[p]);
    return text;
}
