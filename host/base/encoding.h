/* encoding.h: detects the encoding of a text from its first bytes.
 *
 * In:    the beginning of a text.   Out: whether it is UTF-8 with a byte order mark, or is not UTF-8.
 * Knows: the marks, and the bytes of ASCII letters in wider encodings.
 * Does not know: what the text means. */
#ifndef BP_BASE_ENCODING_H
#define BP_BASE_ENCODING_H

#include <stddef.h>

/* The length of a UTF-8 byte order mark at the start of `text`, which belongs to no line: 3, or 0 if there is
 * none. */
size_t bp_text_mark(const void *text, size_t length);

/* "UTF-16" or "UTF-32" if the text begins like one, with or without a mark; otherwise NULL. */
const char *bp_text_wide(const void *text, size_t length);

/* The message about such a text; both %s are its encoding. */
#define BP_TEXT_WIDE_FORMAT                                                                                  \
    "found text in %s, expected UTF-8: save it in that encoding, or convert it with iconv -f %s -t UTF-8"

#endif
