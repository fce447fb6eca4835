/* values.h: parses the arguments of options into checked values.
 *
 * In:    an option's name, its argument, the range.   Out: the value, or BP_ERR_USAGE that names all three.
 * Knows: how numbers are written.   Does not know: which options there are. */
#ifndef BP_CLI_LINE_VALUES_H
#define BP_CLI_LINE_VALUES_H

#include "base/status.h"

/* An integer, decimal or 0x hexadecimal, min <= value <= max; without sign, blanks or trailing text. */
BpStatus bp_value_whole(const char *option, const char *text, uint64_t min, uint64_t max, uint64_t *value,
                        BpError *err);

/* A finite number, min < value <= max, in C's decimal notation. */
BpStatus bp_value_real(const char *option, const char *text, double min, double max, double *value,
                       BpError *err);

/* The same in percent: "1", "1%" and "1 %" are the same number. */
BpStatus bp_value_percent(const char *option, const char *text, double min, double max, double *value,
                          BpError *err);

/* The same in seconds: "90", "90s", "1.5m", "2h", "1d", or several of these, "1h30m", the larger units first.
 */
BpStatus bp_value_time(const char *option, const char *text, double min, double max, double *value,
                       BpError *err);

/* One of `count` words; *index is its position. The error lists all words. */
BpStatus bp_value_choice(const char *option, const char *text, const char *const *words, size_t count,
                         unsigned *index, BpError *err);

/* An integer of at most 15 digits, which may be negative. */
BpStatus bp_value_signed(const char *option, const char *text, int64_t *value, BpError *err);

/* "A:B:S", a slice as in Python: each part is optional, A and B may be negative, S is at least 1. *last is
 * INT64_MAX without B. */
BpStatus bp_value_slice(const char *option, const char *text, int64_t *first, int64_t *last, uint64_t *step,
                        BpError *err);

/* "I/N": number I of N shares, 1 <= I <= N <= BP_SHARES_MAX. */
#define BP_SHARES_MAX 1000000u
BpStatus bp_value_share(const char *option, const char *text, uint32_t *number, uint32_t *count,
                        BpError *err);

/* "X,Y", two integers up to `max`. */
BpStatus bp_value_pair(const char *option, const char *text, uint64_t max, uint32_t *x, uint32_t *y,
                       BpError *err);

#endif
