/* escape.h: text of foreign origin (names of files, titles of scenes, messages of drivers) escaped for
 * display.
 *
 * In:    any bytes.   Out: the same text; terminal control sequences, and bytes that are not UTF-8, as \x1b.
 * Knows: UTF-8, control characters, and those that turn the direction of writing.
 * Does not know: where it is shown.
 *
 * Done always and not on terminals alone: what a file or a pipe holds is shown on a terminal later. */
#ifndef BP_BASE_ESCAPE_H
#define BP_BASE_ESCAPE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* The length in bytes of the UTF-8 character at `text`, which is not the end of the text; 0: no character
 * begins there. */
size_t bp_utf8_length(const char *text);

/* The length in bytes of the control character at `text`, and which it is: 0x1b, 0x9b, ...; 0: none. */
size_t bp_control_length(const char *text, uint32_t *character);

/* Room for a text of that many bytes, whatever it holds. */
#define BP_ESCAPED_SIZE(length) (4 * (length) + 1)
/* `text` in `buffer`, cut at a whole character where it is too long; returns `buffer`. */
const char *bp_escape(const char *text, char *buffer, size_t size);

/* `text` to `out`. `lines`: the ends of lines and tabs are kept. */
void bp_print_escaped(const char *text, bool lines, FILE *out);

/* A JSON document to `out`, in whose texts the control characters that JSON allows become \u009b and the
 * like. */
void bp_print_json_escaped(const char *json, FILE *out);

#endif
