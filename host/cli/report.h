/* report.h: numbers as a person reads them.
 *
 * Knows: text.   Does not know: where the numbers come from, where the text goes. */
#ifndef BP_CLI_REPORT_H
#define BP_CLI_REPORT_H

#include <stddef.h>
#include <stdint.h>

/* "1.2 %", or "unknown" for NaN. Returns `text`. */
const char *bp_format_percent(double fraction, char *text, size_t size);

/* "23 ms", "0.45 s", "12 s", "3 min 20 s", "2 h 05 min". */
const char *bp_format_seconds(double seconds, char *text, size_t size);

/* Three digits and a word: "950", "23.4 thousand", "5.76 million", "1.20 billion". */
const char *bp_format_count(double count, char *text, size_t size);

/* "480,000": whole, with commas. */
const char *bp_format_whole(uint64_t number, char *text, size_t size);

#endif
