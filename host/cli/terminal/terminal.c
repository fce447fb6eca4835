/* terminal.c: see terminal.h. */
#define _DEFAULT_SOURCE /* TIOCGWINSZ */
#include "terminal.h"

#include "base/clock.h"
#include "base/escape.h"

#include <errno.h>
#include <pthread.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/ioctl.h>
#include <unistd.h>

enum { COLUMNS_DEFAULT = 80 };
#define SILENT_SECONDS 0.5
#define REDRAW_SECONDS 0.1

struct BpWaiting {
    pthread_t thread;
    pthread_mutex_t mutex;
    pthread_cond_t ended_changed;
    bool ended;
    double start;
    char text[256];
};

bool bp_terminal_is_live(bool quiet) {
    const char *kind = getenv("TERM");
    return !quiet && isatty(STDERR_FILENO) && !(kind != NULL && strcmp(kind, "dumb") == 0);
}

unsigned bp_terminal_width(int descriptor) {
    struct winsize size;
    if (ioctl(descriptor, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) return size.ws_col;
    const char *told = getenv("COLUMNS");
    const long columns = told != NULL ? strtol(told, NULL, 10) : 0;
    return columns > 0 && columns < 1000000 ? (unsigned)columns : COLUMNS_DEFAULT;
}

unsigned bp_terminal_columns(void) {
    return bp_terminal_width(STDERR_FILENO);
}

bool bp_terminal_has_utf8(void) {
    const char *const names[] = {"LC_ALL", "LC_CTYPE", "LANG"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; ++i) {
        const char *value = getenv(names[i]);
        if (value == NULL || value[0] == '\0') continue;
        const char *dot = strchr(value, '.');
        return dot != NULL && (strncasecmp(dot, ".utf-8", 6) == 0 || strncasecmp(dot, ".utf8", 5) == 0);
    }
    return false;
}

void bp_terminal_show(const char *text) {
    /* Returns to the start of the line, prints the text, and clears the rest of the old line (ECMA-48: EL).
     */
    fprintf(stderr, "\r%s\033[K", text);
    fflush(stderr);
}

static void draw_waiting(const BpWaiting *waiting) {
    static const char *const dots[] = {"   ", ".  ", ".. ", "..."};
    const double seconds = bp_clock_seconds() - waiting->start;
    char line[320];
    const int columns = (int)bp_terminal_columns();
    size_t cut = columns > 14 ? (size_t)columns - 14 : 0;
    if (cut > strlen(waiting->text)) cut = strlen(waiting->text);
    while (cut > 0 && ((unsigned char)waiting->text[cut] & 0xc0u) == 0x80u) --cut; /* whole characters */
    snprintf(line, sizeof line, "%.*s%s %.0f s", (int)cut, waiting->text, dots[(int)(seconds * 4.0) % 4],
             seconds);
    /* One column stays free; there are at least as many bytes as columns. Without room for the dots and the
     * seconds nothing is drawn, since a truncated number would be wrong. */
    if ((size_t)columns <= strlen(line)) line[0] = '\0';
    bp_terminal_show(line);
}

static void *wait_and_draw(void *argument) {
    BpWaiting *waiting = argument;
    bool drawn = false;
    pthread_mutex_lock(&waiting->mutex);
    while (!waiting->ended) {
        struct timespec until;
        clock_gettime(CLOCK_REALTIME, &until);
        const double pause = drawn ? REDRAW_SECONDS : SILENT_SECONDS;
        until.tv_nsec += (long)(pause * 1e9);
        if (until.tv_nsec >= 1000000000L) {
            until.tv_nsec -= 1000000000L;
            ++until.tv_sec;
        }
        if (pthread_cond_timedwait(&waiting->ended_changed, &waiting->mutex, &until) != ETIMEDOUT) continue;
        draw_waiting(waiting);
        drawn = true;
    }
    pthread_mutex_unlock(&waiting->mutex);
    if (drawn) bp_terminal_show("");
    return NULL;
}

BpWaiting *bp_waiting_begin(bool quiet, const char *format, ...) {
    if (!bp_terminal_is_live(quiet)) return NULL;
    BpWaiting *waiting = calloc(1, sizeof *waiting);
    if (waiting == NULL) return NULL;
    va_list arguments;
    va_start(arguments, format);
    char text[sizeof waiting->text];
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    bp_escape(text, waiting->text, sizeof waiting->text);
    waiting->start = bp_clock_seconds();
    pthread_mutex_init(&waiting->mutex, NULL);
    pthread_cond_init(&waiting->ended_changed, NULL);
    if (pthread_create(&waiting->thread, NULL, wait_and_draw, waiting) == 0) return waiting;
    pthread_cond_destroy(&waiting->ended_changed);
    pthread_mutex_destroy(&waiting->mutex);
    free(waiting);
    return NULL;
}

void bp_waiting_end(BpWaiting *waiting) {
    if (waiting == NULL) return;
    pthread_mutex_lock(&waiting->mutex);
    waiting->ended = true;
    pthread_cond_signal(&waiting->ended_changed);
    pthread_mutex_unlock(&waiting->mutex);
    pthread_join(waiting->thread, NULL);
    pthread_cond_destroy(&waiting->ended_changed);
    pthread_mutex_destroy(&waiting->mutex);
    free(waiting);
}
