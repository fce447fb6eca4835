/* status.h: how every fallible function of the host reports failure.
 *
 * In:    nothing.   Out: a status code and, in a BpError, what happened and what helps.
 * Knows: the public error list (ballpark.h).   Does not know: who prints it.
 *
 * Convention: a fallible function returns BpStatus and takes `BpError *err` last. `err` may be NULL.
 * On success `err` is not touched; on failure it holds code, message and, where there are any, place and
 * remedy.
 * A function that forwards a failure returns the code it got and leaves `err` as it is. */
#ifndef BP_BASE_STATUS_H
#define BP_BASE_STATUS_H

#include "ballpark.h"

#include <stddef.h>

#if defined(__GNUC__)
#define BP_PRINTF_LIKE(format_index, first_argument)                                                         \
    __attribute__((format(printf, format_index, first_argument)))
#else
#define BP_PRINTF_LIKE(format_index, first_argument)
#endif

/* Fills `err` (if not NULL) with `code` and the formatted message, and returns `code`, so that a failing
 * function can end with `return bp_fail(err, BP_ERR_..., "...")`. Earlier content of `err` is released. */
BpStatus bp_fail(BpError *err, BpStatus code, const char *format, ...) BP_PRINTF_LIKE(3, 4);

/* Adds the place of the fault to `err`: `file` (copied), `line` and `column` from 1, 0 when unknown. */
void bp_error_at(BpError *err, const char *file, int line, int column);

/* Adds a remedy to `err`, which is worded for the command line, Python or C (remedy.h): the message must not
 * contain it. `value`: what the remedy needs, or "". */
void bp_error_set_remedy(BpError *err, BpRemedy remedy, const char *value);

/* bp_fail() with a remedy that needs no value. */
BpStatus bp_fail_with(BpRemedy remedy, BpError *err, BpStatus code, const char *format, ...)
    BP_PRINTF_LIKE(4, 5);

/* Attaches a long text, such as a build log, which is copied and printed below the message. */
void bp_error_attach(BpError *err, const char *text);

/* Forwards a failure: evaluates `call` once and returns its status from the enclosing function. */
#define BP_TRY(call)                                                                                         \
    do {                                                                                                     \
        const BpStatus bp_try_status_ = (call);                                                              \
        if (bp_try_status_ != BP_OK) return bp_try_status_;                                                  \
    } while (0)

/* The same for functions with a cleanup label: sets `status` and jumps. */
#define BP_TRY_GOTO(status, call, label)                                                                     \
    do {                                                                                                     \
        (status) = (call);                                                                                   \
        if ((status) != BP_OK) goto label;                                                                   \
    } while (0)

#endif
