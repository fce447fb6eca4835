/* status.c: see status.h. */
#include "status.h"

#include "remedy.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *bp_status_name(BpStatus status) {
    switch (status) {
#define BP_STATUS_NAME(name, exit_code, text)                                                                \
    case name:                                                                                               \
        return text;
        BP_STATUS_LIST(BP_STATUS_NAME)
#undef BP_STATUS_NAME
    }
    return "unknown status";
}

int bp_status_exit_code(BpStatus status) {
    switch (status) {
#define BP_STATUS_EXIT(name, exit_code, text)                                                                \
    case name:                                                                                               \
        return exit_code;
        BP_STATUS_LIST(BP_STATUS_EXIT)
#undef BP_STATUS_EXIT
    }
    return 1;
}

/* Within a character of UTF-8. */
static bool is_continuation(char c) {
    return ((unsigned char)c & 0xc0u) == 0x80u;
}

/* A message that is too long usually contains a long path. The fault stands before the path, and reason and
 * remedy behind it, so the middle is left out. */
static void shorten(const char *text, char *out, size_t size) {
    static const char gap[] = "[...]";
    const size_t length = strlen(text);
    if (length < size) {
        memcpy(out, text, length + 1);
        return;
    }
    size_t head = (size - sizeof gap) / 2, tail = length - (size - sizeof gap - head);
    while (head > 0 && is_continuation(text[head])) --head;
    while (tail < length && is_continuation(text[tail])) ++tail;
    memcpy(out, text, head);
    memcpy(out + head, gap, sizeof gap - 1);
    memcpy(out + head + sizeof gap - 1, text + tail, length - tail + 1);
}

void bp_error_clear(BpError *err) {
    if (err == NULL) return;
    free(err->attachment);
    memset(err, 0, sizeof *err);
}

void bp_free(void *memory) {
    free(memory);
}

/* The new message may quote the old one, so it is formatted before the old one is released. */
static void fill(BpError *err, BpStatus code, const char *format, va_list arguments) {
    char message[sizeof err->message];
    va_list again;
    va_copy(again, arguments);
    const int length = vsnprintf(message, sizeof message, format, arguments);
    char *whole = length >= (int)sizeof message ? malloc((size_t)length + 1) : NULL;
    if (whole != NULL) {
        vsnprintf(whole, (size_t)length + 1, format, again);
        shorten(whole, message, sizeof message);
        free(whole);
    }
    va_end(again);
    bp_error_clear(err);
    err->code = code;
    memcpy(err->message, message, sizeof err->message);
}

BpStatus bp_fail(BpError *err, BpStatus code, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    if (err != NULL) fill(err, code, format, arguments);
    va_end(arguments);
    return code;
}

BpStatus bp_fail_with(BpRemedy remedy, BpError *err, BpStatus code, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    if (err != NULL) fill(err, code, format, arguments);
    va_end(arguments);
    bp_error_set_remedy(err, remedy, "");
    return code;
}

void bp_error_at(BpError *err, const char *file, int line, int column) {
    if (err == NULL) return;
    shorten(file != NULL ? file : "", err->file, sizeof err->file);
    err->line = line;
    err->column = column;
}

void bp_error_attach(BpError *err, const char *text) {
    if (err == NULL || text == NULL) return;
    const size_t size = strlen(text) + 1;
    char *copy = malloc(size);
    if (copy == NULL) return; /* the message itself is kept */
    memcpy(copy, text, size);
    free(err->attachment);
    err->attachment = copy;
}

void bp_error_set_remedy(BpError *err, BpRemedy remedy, const char *value) {
    if (err == NULL) return;
    err->remedy = remedy;
    snprintf(err->remedy_value, sizeof err->remedy_value, "%s", value);
}

void bp_error_add_remedy(BpError *err, BpInterface interface) {
    if (err == NULL) return;
    char remedy[BP_REMEDY_SIZE], whole[sizeof err->message + sizeof remedy];
    bp_remedy_text(err->remedy, err->remedy_value, interface, remedy);
    snprintf(whole, sizeof whole, "%s%s", err->message, remedy);
    shorten(whole, err->message, sizeof err->message);
    bp_error_set_remedy(err, BP_REMEDY_NONE, "");
}
