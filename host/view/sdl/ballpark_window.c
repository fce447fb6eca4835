/* ballpark_window.c: the module that opens windows by SDL 2; see window.h. */
#include "view/window.h"

#include <SDL.h>

static SDL_Window *window;
static SDL_Renderer *renderer;
static SDL_Texture *texture;
static uint32_t texture_width, texture_height;
static bool moved; /* since a button went down */

/* Where there is no display, SDL falls back on drivers whose windows nobody sees or closes. */
static bool is_invisible(const char *driver) {
    return driver == NULL || SDL_strcmp(driver, "offscreen") == 0 || SDL_strcmp(driver, "dummy") == 0 ||
           SDL_strcmp(driver, "evdev") == 0;
}

static const char *ready(void) {
    /* The terminal stays in charge of Ctrl-C. */
    SDL_SetHint(SDL_HINT_NO_SIGNAL_HANDLERS, "1");
    SDL_SetHint(SDL_HINT_RENDER_SCALE_QUALITY, "linear");
    SDL_SetHint(SDL_HINT_VIDEO_X11_NET_WM_BYPASS_COMPOSITOR, "0");
    /* libwayland complains on standard error where this is not set; below a folder that is not there, it
     * finds no display and is silent. */
    SDL_setenv("XDG_RUNTIME_DIR", "/nonexistent", 0);
    if (SDL_Init(SDL_INIT_VIDEO) != 0) return SDL_GetError();
    if (is_invisible(SDL_GetCurrentVideoDriver()))
        return "there is no display (check DISPLAY or WAYLAND_DISPLAY)";
    return NULL;
}

static const char *open_window(const char *title, uint32_t width, uint32_t height) {
    SDL_Rect room;
    if (SDL_GetDisplayUsableBounds(0, &room) == 0 && room.w > 0 && room.h > 0 &&
        (width > (uint32_t)room.w || height > (uint32_t)room.h)) {
        const double scale = SDL_min((double)room.w / width, (double)room.h / height);
        width = (uint32_t)SDL_max(1, scale * width);
        height = (uint32_t)SDL_max(1, scale * height);
    }
    window = SDL_CreateWindow(title, SDL_WINDOWPOS_UNDEFINED, SDL_WINDOWPOS_UNDEFINED, (int)width,
                              (int)height, SDL_WINDOW_RESIZABLE);
    if (window == NULL) return SDL_GetError();
    renderer = SDL_CreateRenderer(window, -1, 0);
    if (renderer == NULL) renderer = SDL_CreateRenderer(window, -1, SDL_RENDERER_SOFTWARE);
    return renderer == NULL ? SDL_GetError() : NULL;
}

/* The part of the window that the picture fills. */
static SDL_Rect picture_place(void) {
    int width = 1, height = 1;
    SDL_GetRendererOutputSize(renderer, &width, &height);
    if (texture_width == 0 || texture_height == 0) return (SDL_Rect){0, 0, width, height};
    const double scale = SDL_min((double)width / texture_width, (double)height / texture_height);
    SDL_Rect place = {.w = (int)SDL_max(1, scale * texture_width + 0.5),
                      .h = (int)SDL_max(1, scale * texture_height + 0.5)};
    place.x = (width - place.w) / 2;
    place.y = (height - place.h) / 2;
    return place;
}

static void draw(void) {
    const SDL_Rect place = picture_place();
    SDL_SetRenderDrawColor(renderer, 22, 22, 26, 255);
    SDL_RenderClear(renderer);
    if (texture != NULL) SDL_RenderCopy(renderer, texture, NULL, &place);
    SDL_RenderPresent(renderer);
}

static const char *show(const uint8_t *rgb, uint32_t width, uint32_t height) {
    if (texture == NULL || width != texture_width || height != texture_height) {
        if (texture != NULL) SDL_DestroyTexture(texture);
        texture = SDL_CreateTexture(renderer, SDL_PIXELFORMAT_RGB24, SDL_TEXTUREACCESS_STREAMING, (int)width,
                                    (int)height);
        texture_width = width;
        texture_height = height;
        if (texture == NULL) return SDL_GetError();
    }
    if (SDL_UpdateTexture(texture, NULL, rgb, (int)width * 3) != 0) return SDL_GetError();
    draw();
    return NULL;
}

static void set_title(const char *text) {
    SDL_SetWindowTitle(window, text);
}

static void place_of(int x, int y, BpWindowEvent *event) {
    const SDL_Rect place = picture_place();
    int window_width = 1, window_height = 1, width = 1, height = 1;
    SDL_GetWindowSize(window, &window_width, &window_height); /* screens of high density have more pixels */
    SDL_GetRendererOutputSize(renderer, &width, &height);
    const double right = (x + 0.5) * width / SDL_max(window_width, 1),
                 down = (y + 0.5) * height / SDL_max(window_height, 1);
    event->x = (right - place.x) / place.w;
    event->y = (down - place.y) / place.h;
}

static char key_of(const SDL_KeyboardEvent *key) {
    if (key->keysym.sym == SDLK_ESCAPE) return '\033';
    return '\0'; /* letters come as text, by the layout of the keyboard */
}

static bool translate(const SDL_Event *from, BpWindowEvent *event) {
    const SDL_Keymod keys = SDL_GetModState();
    event->shift = (keys & KMOD_SHIFT) != 0;
    switch (from->type) {
    case SDL_QUIT:
        event->action = BP_WINDOW_QUIT;
        return true;
    case SDL_WINDOWEVENT:
        if (from->window.event == SDL_WINDOWEVENT_EXPOSED) draw();
        if (from->window.event != SDL_WINDOWEVENT_SIZE_CHANGED) return false;
        int width = 1, height = 1;
        SDL_GetRendererOutputSize(renderer, &width, &height);
        draw();
        event->action = BP_WINDOW_RESIZE;
        event->width = (uint32_t)SDL_max(width, 1);
        event->height = (uint32_t)SDL_max(height, 1);
        return true;
    case SDL_MOUSEBUTTONDOWN:
        moved = false;
        return false;
    case SDL_MOUSEMOTION:
        if (from->motion.state == 0) return false;
        moved = true;
        event->action = BP_WINDOW_DRAG;
        event->button = (from->motion.state & SDL_BUTTON_LMASK) != 0   ? BP_BUTTON_LEFT
                        : (from->motion.state & SDL_BUTTON_RMASK) != 0 ? BP_BUTTON_RIGHT
                                                                       : BP_BUTTON_MIDDLE;
        event->dx = from->motion.xrel;
        event->dy = from->motion.yrel;
        return true;
    case SDL_MOUSEBUTTONUP:
        if (moved) return false;
        event->action = BP_WINDOW_CLICK;
        event->button = from->button.button == SDL_BUTTON_LEFT    ? BP_BUTTON_LEFT
                        : from->button.button == SDL_BUTTON_RIGHT ? BP_BUTTON_RIGHT
                                                                  : BP_BUTTON_MIDDLE;
        place_of(from->button.x, from->button.y, event);
        return true;
    case SDL_MOUSEWHEEL:
        event->action = BP_WINDOW_WHEEL;
        event->dy = from->wheel.direction == SDL_MOUSEWHEEL_FLIPPED ? -from->wheel.y : from->wheel.y;
        return true;
    case SDL_KEYDOWN:
        event->action = BP_WINDOW_KEY;
        event->key = key_of(&from->key);
        return event->key != '\0';
    case SDL_TEXTINPUT:
        event->action = BP_WINDOW_KEY;
        event->key = from->text.text[0];
        return (unsigned char)event->key < 128;
    default:
        return false;
    }
}

static void next(uint32_t milliseconds, BpWindowEvent *event) {
    const Uint64 until = SDL_GetTicks64() + milliseconds;
    for (;;) {
        SDL_Event from;
        const Uint64 now = SDL_GetTicks64();
        const int left = now < until ? (int)(until - now) : 0;
        *event = (BpWindowEvent){.action = BP_WINDOW_NOTHING};
        if (left > 0 ? !SDL_WaitEventTimeout(&from, left) : !SDL_PollEvent(&from)) return;
        if (translate(&from, event)) return;
    }
}

static void close_window(void) {
    if (texture != NULL) SDL_DestroyTexture(texture);
    if (renderer != NULL) SDL_DestroyRenderer(renderer);
    if (window != NULL) SDL_DestroyWindow(window);
    texture = NULL;
    renderer = NULL;
    window = NULL;
    SDL_Quit();
}

__attribute__((visibility("default"))) const BpWindow bp_window = {
    BP_WINDOW_VERSION, ready, open_window, show, set_title, next, close_window,
};
