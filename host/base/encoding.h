/* encoding.h: in which encoding a text is, by its first bytes.
 *
 * In:    the beginning of a text.   Out: whether it is UTF-8 with a byte order mark, or is not UTF-8.
 * Knows: the marks, and how letters of ASCII look in wider encodings.
 * Does not know: what the text means. */
#ifndef BP_BASE_ENCODING_H
#define BP_BASE_ENCODING_H

#include <stddef.h>

/* The bytes of the byte order mark with which a text in UTF-8 may begin, and which belong to none of its
 * lines: 3, or 0 where there is none. */
size_t bp_text_mark(const void *text, size_t length);

/* "UTF-16" or "UTF-32" where a text begins like one, with a mark or without; NULL where it does not. */
const char *bp_text_wide(const void *text, size_t length);

/* The message about such a text; both %s are its encoding. */
#define BP_TEXT_WIDE_FORMAT                                                                                  \
    "found text in %s, expected UTF-8: save it in that encoding, or convert it with iconv -f %s -t UTF-8"

#endif
