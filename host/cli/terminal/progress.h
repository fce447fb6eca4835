/* progress.h: formats a render's progress bar, and the lines that replace it in a log.
 *
 * In:    progress, speed, noise, the terminal's width.   Out: one line of text.
 * Knows: how to fill a line.   Does not know: the terminal, what is rendered. */
#ifndef BP_CLI_TERMINAL_PROGRESS_H
#define BP_CLI_TERMINAL_PROGRESS_H

#include <stdbool.h>
#include <stddef.h>

typedef struct BpProgressView {
    double fraction;           /* of the way, 0 to 1 */
    double samples_per_second; /* pixel samples */
    double nrmse;              /* a fraction; NaN: not known yet */
    double seconds_left;       /* NaN: not known yet */
} BpProgressView;

/* "███░░░  43 %  12 s left  noise 2.1 %  5.2 million samples/s" in fewer than `columns` columns: parts
 * that do not fit are omitted, from the right; without room for a bar, only the percentage is shown, or
 * nothing. Returns `text`. */
const char *bp_progress_format(const BpProgressView *view, unsigned columns, bool utf8, char *text,
                               size_t size);

/* "43 %, 12 s left, noise 2.1 %, 5.2 million samples/s": the same for a log, where no line replaces another.
 * Returns `text`. */
const char *bp_progress_sentence(const BpProgressView *view, char *text, size_t size);
/* When the next line of a log is due after one at `seconds` (0: none yet): at 3 s, then twice as late each
 * time, and every ten minutes in the end. In seconds since the render began. */
double bp_progress_next(double seconds);

#endif
