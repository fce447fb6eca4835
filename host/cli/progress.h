/* progress.h: the progress bar of a render.
 *
 * In:    how far, how fast, how exact.   Out: the terminal's status line, about ten times a second.
 * Knows: what fits into a line.          Does not know: the render. */
#ifndef BP_CLI_PROGRESS_H
#define BP_CLI_PROGRESS_H

#include <stdbool.h>
#include <stddef.h>

typedef struct BpProgressView {
    double fraction;           /* of the way, 0 to 1 */
    double samples_per_second; /* pixel samples */
    double nrmse;              /* a fraction; NaN: not known yet */
    double seconds_left;       /* NaN: not known yet */
} BpProgressView;

/* "███░░░  43 %  12 s left  error 2.1 %  5.2 million samples/s" in less than `columns` columns: what does not
 * fit is left out, from the right; where a bar has no room the share stands alone, or nothing. Returns
 * `text`. */
const char *bp_progress_format(const BpProgressView *view, unsigned columns, bool utf8, char *text,
                               size_t size);

#endif
