/* window.h: a window on the screen: the interface of a module that the program loads for `ballpark view`.
 *
 * In:    a picture of bytes, a title.   Out: what the person does with mouse and keys.
 * Knows: nothing.   Does not know: SDL (the module does), scenes.
 *
 * A module is a shared object that exports one struct, `bp_window`. So the program needs a library for
 * windows only when a window is opened. All functions are called from one thread, ready() first, then open().
 * Those that return a text return NULL, or what went wrong, valid until the next call. */
#ifndef BP_VIEW_WINDOW_H
#define BP_VIEW_WINDOW_H

#include <stdbool.h>
#include <stdint.h>

#define BP_WINDOW_VERSION 2u
#define BP_WINDOW_SYMBOL "bp_window"

typedef enum BpWindowAction {
    BP_WINDOW_NOTHING,
    BP_WINDOW_QUIT,   /* the window is being closed */
    BP_WINDOW_RESIZE, /* width, height: its new size in pixels */
    BP_WINDOW_DRAG,   /* the mouse moves with a button held: dx, dy in pixels */
    BP_WINDOW_CLICK,  /* a button went down and up again at x, y without a move */
    BP_WINDOW_WHEEL,  /* dy: clicks of the wheel, up is positive */
    BP_WINDOW_KEY,    /* key: what was typed, as ASCII; '\033' for Escape */
} BpWindowAction;

typedef enum BpWindowButton { BP_BUTTON_LEFT = 1, BP_BUTTON_MIDDLE, BP_BUTTON_RIGHT } BpWindowButton;

typedef struct BpWindowEvent {
    BpWindowAction action;
    BpWindowButton button;
    bool shift;
    double x, y;   /* where in the picture: 0 to 1 from its left and its top; outside of it: less or more */
    double dx, dy; /* down is positive for drags */
    uint32_t width, height;
    char key;
} BpWindowEvent;

typedef struct BpWindow {
    uint32_t version; /* BP_WINDOW_VERSION */
    /* Whether windows can be shown here; asked before any work. close() ends what it begins. */
    const char *(*ready)(void);
    /* A window for pictures of this size, or less where the screen is smaller. */
    const char *(*open)(const char *title, uint32_t width, uint32_t height);
    /* Shows `rgb`, three bytes a pixel, as large as the window allows. */
    const char *(*show)(const uint8_t *rgb, uint32_t width, uint32_t height);
    void (*title)(const char *text);
    /* The next event; waits for it up to `milliseconds`. */
    void (*next)(uint32_t milliseconds, BpWindowEvent *event);
    void (*close)(void);
} BpWindow;

#endif
