/* fake_window.c: a module like the one for SDL, without a screen: it plays a script and notes what it is
 * shown.
 *
 * In:    FAKE_WINDOW_SCRIPT, a file with an event a line.   Out: FAKE_WINDOW_LOG, a line for each call.
 * Knows: host/view/window.h.   Does not know: what events mean.
 *
 * Events: "drag BUTTON DX DY", "click X Y", "wheel N", "key C", "resize W H", "quit"; "frames N" waits for N
 * more pictures, "rest" until the view has waited for events for half a second, "times N" repeats the rest of
 * the line's following event N times, each after a picture; "flood N" repeats it whenever the view asks,
 * until there are N more pictures, like somebody who does not wait for them. */
#include "view/window.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { PAUSE_NANOSECONDS = 10000000, IDLE_CALLS = 60 };

static FILE *script, *notes;
static uint64_t frames, wanted;          /* shown; to wait for */
static unsigned idle_calls, idle_wanted; /* of next(), in a row; to wait for */
static char repeated[128];
static long repetitions;
static bool floods, breathes; /* breathes: the next answer is that nothing has happened */

static double now(void) {
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

/* FAKE_WINDOW_FAILS says where it fails. */
static bool fails(const char *where) {
    const char *chosen = getenv("FAKE_WINDOW_FAILS");
    return chosen != NULL && strcmp(chosen, where) == 0;
}

static const char *ready(void) {
    return fails("ready") ? "there is no screen" : NULL;
}

static const char *open_window(const char *title, uint32_t width, uint32_t height) {
    const char *path = getenv("FAKE_WINDOW_SCRIPT"), *log = getenv("FAKE_WINDOW_LOG");
    if (fails("open")) return "there is no room for it";
    script = fopen(path != NULL ? path : "", "r");
    notes = fopen(log != NULL ? log : "", "w");
    if (script == NULL || notes == NULL) return "no script, or no log";
    fprintf(notes, "open %u %u %s\n", (unsigned)width, (unsigned)height, title);
    return NULL;
}

static const char *show(const uint8_t *rgb, uint32_t width, uint32_t height) {
    uint64_t sum[3] = {0};
    for (size_t i = 0; i < (size_t)width * height; ++i)
        for (size_t c = 0; c < 3; ++c) sum[c] += rgb[3 * i + c];
    const double count = (double)width * height;
    if (fails("show")) return "the screen has gone";
    fprintf(notes, "show %u %u %.3f %.3f %.3f %.4f\n", (unsigned)width, (unsigned)height,
            (double)sum[0] / count, (double)sum[1] / count, (double)sum[2] / count, now());
    fflush(notes);
    ++frames;
    return NULL;
}

static void set_title(const char *text) {
    fprintf(notes, "title %s\n", text);
    fflush(notes);
}

static bool read_event(const char *line, BpWindowEvent *event) {
    unsigned a, b;
    char key;
    if (sscanf(line, "drag %u %lf %lf", &a, &event->dx, &event->dy) == 3) {
        event->action = BP_WINDOW_DRAG;
        event->button = (BpWindowButton)a;
    } else if (sscanf(line, "click %lf %lf", &event->x, &event->y) == 2) {
        event->action = BP_WINDOW_CLICK;
        event->button = BP_BUTTON_LEFT;
    } else if (sscanf(line, "wheel %lf", &event->dy) == 1) {
        event->action = BP_WINDOW_WHEEL;
    } else if (sscanf(line, "key %c", &key) == 1) {
        event->action = BP_WINDOW_KEY;
        event->key = key;
    } else if (sscanf(line, "resize %u %u", &a, &b) == 2) {
        event->action = BP_WINDOW_RESIZE;
        event->width = a;
        event->height = b;
    } else if (strncmp(line, "quit", 4) == 0) {
        event->action = BP_WINDOW_QUIT;
    } else {
        fprintf(notes, "cannot read: %s", line);
        event->action = BP_WINDOW_QUIT;
    }
    return true;
}

static bool play(BpWindowEvent *event) {
    char line[128];
    unsigned long long count;
    long times;
    if (breathes) return breathes = false;
    if (frames < wanted) {
        breathes = floods;
        return floods && read_event(repeated, event);
    }
    floods = false;
    if (idle_calls < idle_wanted) return false;
    if (idle_wanted > 0) fputs("rested\n", notes);
    idle_wanted = 0;
    if (repetitions > 0) {
        --repetitions;
        wanted = frames + 1;
        return read_event(repeated, event);
    }
    if (fgets(line, sizeof line, script) == NULL) strcpy(line, "quit");
    if (sscanf(line, "frames %llu", &count) == 1) {
        wanted = frames + count;
        return false;
    }
    if (strncmp(line, "rest", 4) == 0) {
        idle_calls = 0;
        idle_wanted = IDLE_CALLS;
        return false;
    }
    if (sscanf(line, "times %ld %127[^\n]", &times, repeated) == 2) {
        repetitions = times;
        return false;
    }
    if (sscanf(line, "flood %llu %127[^\n]", &count, repeated) == 2) {
        wanted = frames + count;
        floods = true;
        return false;
    }
    return read_event(line, event);
}

static void next(uint32_t milliseconds, BpWindowEvent *event) {
    *event = (BpWindowEvent){.action = BP_WINDOW_NOTHING};
    idle_calls = milliseconds == 0 ? 0 : idle_calls + 1;
    if (play(event) || milliseconds == 0) return;
    const struct timespec pause = {0, PAUSE_NANOSECONDS};
    nanosleep(&pause, NULL);
}

static void close_window(void) {
    if (notes != NULL) {
        fputs("close\n", notes);
        fclose(notes);
    }
    if (script != NULL) fclose(script);
}

__attribute__((visibility("default"))) const BpWindow bp_window = {
    BP_WINDOW_VERSION, ready, open_window, show, set_title, next, close_window,
};
