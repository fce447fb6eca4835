/* timed_window.c: a module for `ballpark view` that passes every call on to the real one and notes when it
 * came.
 *
 * In:    TIMED_WINDOW_MODULE, the real module.   Out: TIMED_WINDOW_LOG, a line for each picture and event:
 * its name, the time in seconds, the picture's size. Knows: host/view/window.h.   Does not know: SDL, what
 * events mean. */
#include "view/window.h"

#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

static const BpWindow *real;
static FILE *notes;

static double now(void) {
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

static const char *ready(void) {
    const char *module = getenv("TIMED_WINDOW_MODULE"), *log = getenv("TIMED_WINDOW_LOG");
    void *handle = dlopen(module != NULL ? module : "", RTLD_NOW | RTLD_LOCAL);
    if (handle == NULL) return dlerror();
    real = dlsym(handle, BP_WINDOW_SYMBOL);
    if (real == NULL || real->version != BP_WINDOW_VERSION) return "not a window of this version";
    notes = fopen(log != NULL ? log : "", "w");
    if (notes == NULL) return "TIMED_WINDOW_LOG cannot be written";
    setvbuf(notes, NULL, _IOLBF, 0);
    return real->ready();
}

static const char *open_window(const char *title, uint32_t width, uint32_t height) {
    return real->open(title, width, height);
}

static const char *show(const uint8_t *rgb, uint32_t width, uint32_t height) {
    const char *fault = real->show(rgb, width, height);
    fprintf(notes, "show %.6f %u %u\n", now(), (unsigned)width, (unsigned)height);
    return fault;
}

static void set_title(const char *text) {
    real->title(text);
}

static void next(uint32_t milliseconds, BpWindowEvent *event) {
    real->next(milliseconds, event);
    if (event->action == BP_WINDOW_DRAG) fprintf(notes, "drag %.6f\n", now());
}

static void close_window(void) {
    if (real != NULL) real->close();
    if (notes != NULL) fclose(notes);
}

__attribute__((visibility("default"))) const BpWindow bp_window = {
    BP_WINDOW_VERSION, ready, open_window, show, set_title, next, close_window,
};
