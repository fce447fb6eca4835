/* format.h: the numbers of a study as a person reads them.
 *
 * Knows: text.   Does not know: where the numbers come from, where the text goes.
 *
 * Each writes into `text` and returns it. What is not known is a dash. */
#ifndef BP_COST_FORMAT_H
#define BP_COST_FORMAT_H

#include "study.h"

/* "12.3 %", "1.23 %", "0.123 %", "0.0012 %": three digits, or two of what is small. */
const char *bp_study_percent(double fraction, char *text, size_t size);
/* "+0.123 ± 0.004 %": half the interval beside the value, with as many decimals. `plus_minus`: "±" or "+-";
 * `minus`: "−" or "-". */
const char *bp_study_interval(const BpStudyEstimate *estimate, const char *plus_minus, const char *minus,
                              char *text, size_t size);
/* "12 ms", "4.1 s", "3 min 20 s", "5.2 h". */
const char *bp_study_seconds(double seconds, char *text, size_t size);
/* "1.23": three digits; dash for NaN. */
const char *bp_study_ratio(double ratio, char *text, size_t size);

#endif
