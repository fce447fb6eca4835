/* json_memory.h: detects that jansson ran out of memory.
 *
 * In:    the text of a document.   Out: the document; or whether memory ran out.
 * Knows: jansson's allocations.    Does not know: what a document means.
 *
 * jansson reports a lack of memory as a syntax error, and sometimes drops a character without reporting
 * anything. So the program installs allocation functions that record a failure. A program that uses
 * libballpark may have allocation functions of its own; there, errno decides. */
#ifndef BP_BASE_JSON_MEMORY_H
#define BP_BASE_JSON_MEMORY_H

#include <jansson.h>
#include <stdbool.h>

/* Called once by main, before jansson is used. */
void bp_json_memory_watch(void);

/* Whether an allocation of jansson has ever failed: any document made in this process may be incomplete. */
bool bp_json_memory_failed(void);

/* json_loadb() of a text that may begin with a byte order mark; *no_memory: it failed for lack of memory,
 * and `error` is meaningless. */
json_t *bp_json_load(const char *text, size_t length, size_t flags, json_error_t *error, bool *no_memory);

/* `text` in quotes, as a document holds it; heap. NULL: it is not UTF-8, or *no_memory. */
char *bp_json_quote(const char *text, bool *no_memory);

#endif
