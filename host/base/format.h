/* format.h: formats numbers for people.
 *
 * Knows: text.   Does not know: where the numbers come from, where the text goes.
 *
 * Each function writes into `text` and returns it. */
#ifndef BP_BASE_FORMAT_H
#define BP_BASE_FORMAT_H

#include <stddef.h>
#include <stdint.h>

/* "1.2 %", or "unknown" for NaN: two digits, for sentences. */
const char *bp_format_percent(double fraction, char *text, size_t size);

/* "12.3 %", "1.23 %", "0.123 %", "0.0012 %", or a dash for NaN: three digits, or two if small, for tables. */
const char *bp_format_percent_cell(double fraction, char *text, size_t size);

/* "+0.123 +- 0.004 %": half of low..high beside the value, with as many decimals; a dash for NaN, "none"
 * where all three are 0. */
const char *bp_format_interval(double value, double low, double high, char *text, size_t size);

/* "1.23": three digits; a dash if not finite. */
const char *bp_format_ratio(double ratio, char *text, size_t size);

/* "23 ms", "0.45 s", "12 s", "3 min 20 s", "2 h 05 min". */
const char *bp_format_seconds(double seconds, char *text, size_t size);

/* Three digits and a word: "950", "23.4 thousand", "5.76 million", "1.20 billion". */
const char *bp_format_count(double count, char *text, size_t size);

/* "480,000": an integer with commas. */
const char *bp_format_whole(uint64_t number, char *text, size_t size);

#endif
