/* escape.h: text of foreign origin (names of files, titles of scenes, messages of drivers) escaped for
 * display.
 *
 * In:    any bytes.   Out: the same text; terminal control sequences, and bytes that are not UTF-8, as \x1b.
 * Knows: UTF-8, control characters, characters that change the direction of writing.
 * Does not know: where it is shown.
 *
 * Output to files and pipes is escaped too, since it may be displayed on a terminal later. */
#ifndef BP_BASE_ESCAPE_H
#define BP_BASE_ESCAPE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* The length in bytes of the UTF-8 character at `text`, which must not be the end of the text; 0: invalid
 * UTF-8. */
size_t bp_utf8_length(const char *text);

/* The length in bytes of the control character at `text`, which is stored in *character (0x1b, 0x9b, ...); 0:
 * none. */
size_t bp_control_length(const char *text, uint32_t *character);

/* The buffer size that suffices for any text of `length` bytes. */
#define BP_ESCAPED_SIZE(length) (4 * (length) + 1)
/* Writes the escaped text to `buffer`, truncated at a character boundary if necessary; returns `buffer`. */
const char *bp_escape(const char *text, char *buffer, size_t size);

/* Prints the escaped text to `out`. `lines`: newlines and tabs are kept. */
void bp_print_escaped(const char *text, bool lines, FILE *out);

/* Prints a JSON document to `out`; control characters that JSON permits in strings become \u009b and the
 * like. */
void bp_print_json_escaped(const char *json, FILE *out);

#endif
