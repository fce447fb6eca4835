/* csv_fields.h: the fields of a row of a table, and the numbers in them.
 *
 * In:    a line.   Out: fields without their quotes, numbers.
 * Knows: separators, quotes, what spreadsheets write for numbers.   Does not know: what columns mean. */
#ifndef BP_PARTICLES_CSV_FIELDS_H
#define BP_PARTICLES_CSV_FIELDS_H

#include "input.h"

/* How the numbers and fields of a table are written. */
typedef struct CsvForm {
    char separator; /* ' ': blanks, any number of them */
    char decimal;   /* the decimal sign, '.' or ','; 0: none was seen yet */
    uint64_t decimal_line;
} CsvForm;

enum { CSV_UNCLOSED = -1 };

/* Splits in place. A field may stand in double quotes, which are taken away, as is one of two within. Returns
 * how many there are, the first `max` of which are in `fields`; *filled: without empty ones at the end.
 * CSV_UNCLOSED: a quote is not closed. */
int csv_split(char *line, char separator, char **fields, int max, int *filled);

/* Whether the field holds words, such as a unit or a name, and no number, infinite or missing ones included.
 */
bool csv_is_text(const char *field);
/* Whether the line is a remark (#, % or //). A field in which a spreadsheet marks a missing number counts as
 * missing. */
bool csv_is_remark(const char *line);
/* Whether no field of the line holds anything. */
bool csv_is_empty(const char *line);

/* The separator with which all fields of the line are numbers; 0: there is none, so the line names columns.
 */
char csv_separator_of_numbers(const char *line);
/* The separator of a line of names. */
char csv_separator_of_names(const char *line);

/* A field as a number; NaN where the table has none: an empty field, NA, null, none, #N/A, nan. A comma may
 * be the decimal sign, if it is in all numbers. Fails on what is not a number, and on separators of
 * thousands.
 */
BpStatus csv_number(const Input *input, CsvForm *form, const char *field, double *value, BpError *err);
/* The same without an error: NaN for what is not a number; truth values are 1 and 0. */
double csv_number_or_none(const CsvForm *form, const char *field);

#endif
