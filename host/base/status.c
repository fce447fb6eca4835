/* status.c: see status.h. */
#include "status.h"

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

void bp_error_clear(BpError *err) {
    if (err == NULL) return;
    free(err->attachment);
    memset(err, 0, sizeof *err);
}

void bp_free(void *memory) {
    free(memory);
}

BpStatus bp_fail(BpError *err, BpStatus code, const char *format, ...) {
    if (err == NULL) return code;
    /* The new message may quote the old one, so it is formatted before the old one is released. */
    char message[sizeof err->message];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    bp_error_clear(err);
    err->code = code;
    memcpy(err->message, message, sizeof err->message);
    return code;
}

void bp_error_at(BpError *err, const char *file, int line, int column) {
    if (err == NULL) return;
    snprintf(err->file, sizeof err->file, "%s", file != NULL ? file : "");
    err->line = line;
    err->column = column;
}

void bp_error_attach(BpError *err, const char *text) {
    if (err == NULL || text == NULL) return;
    const size_t size = strlen(text) + 1;
    char *copy = malloc(size);
    if (copy == NULL) return; /* the message itself still stands */
    memcpy(copy, text, size);
    free(err->attachment);
    err->attachment = copy;
}
