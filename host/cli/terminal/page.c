/* page.c: see page.h. */
#include "page.h"

#include "base/escape.h"
#include "base/wrap.h"
#include "terminal.h"

#include <stdarg.h>
#include <stdlib.h>

void bp_page_begin(BpPage *page, FILE *out) {
    *page = (BpPage){0};
    page->text = open_memstream(&page->bytes, &page->size);
    if (page->text == NULL) page->text = out; /* no memory: better unwrapped than unsaid */
}

size_t bp_page_columns(const BpCommandLine *line, FILE *out) {
    return line->wide ? 0 : bp_terminal_width(fileno(out));
}

void bp_page_print(const char *text, size_t columns, FILE *out) {
    char *wrapped = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&wrapped, &size);
    bp_wrap(text, columns, stream != NULL ? stream : out);
    if (stream == NULL) return;
    if (fclose(stream) == 0) fwrite(wrapped, 1, size, out);
    free(wrapped);
}

void bp_page_end(BpPage *page, const BpCommandLine *line, FILE *out) {
    if (page->text != out) {
        const bool whole = fclose(page->text) == 0;
        if (whole && !line->quiet) bp_page_print(page->bytes, bp_page_columns(line, out), out);
        free(page->bytes);
    }
    *page = (BpPage){0};
}

void bp_say(const BpCommandLine *line, const char *format, ...) {
    char text[2048];
    BpPage page;
    va_list arguments;
    if (line->quiet) return;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    bp_page_begin(&page, stderr);
    bp_print_escaped(text, false, page.text);
    fputc('\n', page.text);
    bp_page_end(&page, line, stderr);
}
