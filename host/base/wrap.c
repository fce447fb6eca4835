/* wrap.c: see wrap.h. */
#include "wrap.h"

#include <stdbool.h>
#include <string.h>

enum { HANG = 1, PASTE = 2, TEXT_COLUMNS_MIN = 20 };

/* Characters of the `length` bytes of UTF-8 that take a column. */
static size_t width_of(const char *text, size_t length) {
    size_t width = 0;
    for (size_t i = 0; i < length; ++i)
        if (((unsigned char)text[i] & 0xc0u) != 0x80u && text[i] != HANG && text[i] != PASTE) ++width;
    return width;
}

static void put(const char *text, size_t length, FILE *out) {
    for (size_t i = 0; i < length; ++i)
        if (text[i] != HANG && text[i] != PASTE) fputc(text[i], out);
}

/* Bytes up to the next place where `line` may be broken: behind a word, the "%" of a number, or all the text
 * between backticks, so that a command stays whole. */
static size_t word_length(const char *line, size_t length) {
    size_t end = 0;
    bool quoted = false;
    for (; end < length && (line[end] != ' ' || quoted); ++end)
        if (line[end] == '`') quoted = !quoted && memchr(line + end + 1, '`', length - end - 1) != NULL;
    if (end + 1 < length && line[end + 1] == '%')
        for (++end; end < length && line[end] != ' ';) ++end;
    return end;
}

/* Where the text behind the name in a line begins: after the first run of two blanks or more. 0: the line has
 * no name. */
static size_t text_column(const char *line, size_t length, size_t indent) {
    for (size_t i = indent; i + 2 < length; ++i) {
        if (line[i] != ' ' || line[i + 1] != ' ') continue;
        while (i < length && line[i] == ' ') ++i;
        return i < length ? width_of(line, i) : 0;
    }
    return 0;
}

static void wrap_line(const char *line, size_t length, size_t columns, FILE *out) {
    const bool paste = memchr(line, PASTE, length) != NULL;
    const char *mark = memchr(line, HANG, length);
    size_t at = 0, column = 0, indent = 0;
    while (indent < length && (line[indent] == ' ' || line[indent] == PASTE)) ++indent;
    const size_t at_text = indent;
    indent = width_of(line, indent);
    const size_t text = text_column(line, length, at_text);
    size_t hang = mark != NULL ? width_of(line, (size_t)(mark - line)) : text > 0 ? text : indent + 2;
    if (hang + TEXT_COLUMNS_MIN > columns) hang = indent + 2 < columns / 2 ? indent + 2 : 0;
    const size_t limit = paste && columns > 2 ? columns - 2 : columns;
    size_t begun = 0; /* words in this line of the page */
    while (at < length) {
        size_t blanks = 0;
        while (at + blanks < length && line[at + blanks] == ' ') ++blanks;
        const size_t word = word_length(line + at + blanks, length - at - blanks);
        const size_t width = width_of(line + at + blanks, word);
        const bool last = at + blanks + word >= length;
        if (begun > 0 && width > 0 && column + blanks + width > (last ? columns : limit)) {
            fprintf(out, "%s\n%*s", paste ? " \\" : "", (int)hang, "");
            column = hang;
            begun = 0;
        } else if (width > 0) {
            fprintf(out, "%*s", (int)blanks, "");
            column += blanks;
        }
        put(line + at + blanks, word, out);
        column += width;
        begun += width > 0;
        at += blanks + word;
    }
}

void bp_wrap(const char *text, size_t columns, FILE *out) {
    while (*text != '\0') {
        const size_t length = strcspn(text, "\n");
        if (columns == 0 || width_of(text, length) <= columns)
            put(text, length, out);
        else
            wrap_line(text, length, columns, out);
        text += length;
        if (*text == '\n') {
            fputc('\n', out);
            ++text;
        }
    }
}
