/* terminal_picture.c: see terminal_picture.h. */
#define _DEFAULT_SOURCE /* TIOCGWINSZ */
#include "terminal_picture.h"

#include "base/clock.h"
#include "base/words.h"
#include "image/image.h"
#include "terminal.h"

#include <fcntl.h>
#include <math.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#define ANSWER_SECONDS 0.5

/* ---- which kind of terminal --------------------------------------------------------------------------- */

static bool variable_is(const char *name, const char *value) {
    const char *found = getenv(name);
    return found != NULL && strcmp(found, value) == 0;
}

static bool variable_has(const char *name, const char *part) {
    const char *found = getenv(name);
    return found != NULL && strstr(found, part) != NULL;
}

/* In the answer to a query of device attributes (DA1: ESC [ ? 62 ; 4 ; ... c), 4 means sixels. */
static bool names_sixels(const char *answer) {
    const char *at = strstr(answer, "\033[?");
    if (at == NULL || strchr(at, 'c') == NULL) return false;
    for (at += 3; *at != 'c' && *at != '\0';) {
        char *end;
        if (strtol(at, &end, 10) == 4 && end != at) return true;
        at = end + (*end == ';');
        if (end == at && *at != 'c') break;
    }
    return false;
}

/* Type-ahead is preserved: nothing is read beyond the last letter of the answer. */
static bool ask_for_sixels(void) {
    struct termios before, raw;
    char answer[128] = "";
    size_t used = 0;
    const int terminal = open("/dev/tty", O_RDWR | O_NOCTTY | O_CLOEXEC);
    if (terminal < 0) return false;
    /* A query would stop a job in the background. */
    if (tcgetpgrp(terminal) != getpgrp() || tcgetattr(terminal, &before) != 0) {
        close(terminal);
        return false;
    }
    raw = before;
    raw.c_lflag &= ~(tcflag_t)(ICANON | ECHO);
    raw.c_cc[VMIN] = 0;
    raw.c_cc[VTIME] = 0;
    if (tcsetattr(terminal, TCSANOW, &raw) == 0 && write(terminal, "\033[c", 3) == 3) {
        const double until = bp_clock_seconds() + ANSWER_SECONDS;
        double left;
        while (used + 1 < sizeof answer && strchr(answer, 'c') == NULL &&
               (left = until - bp_clock_seconds()) > 0) {
            struct pollfd ready = {.fd = terminal, .events = POLLIN};
            if (poll(&ready, 1, (int)(1000 * left) + 1) <= 0) continue;
            if (read(terminal, answer + used, 1) != 1) break;
            answer[++used] = '\0';
        }
    }
    tcsetattr(terminal, TCSANOW, &before);
    close(terminal);
    return names_sixels(answer);
}

static BpTerminalGraphics detect(void) {
    /* By default, they pass on text only. */
    if (getenv("TMUX") != NULL || getenv("STY") != NULL) return BP_GRAPHICS_BLOCKS;
    if (getenv("KITTY_WINDOW_ID") != NULL || variable_has("TERM", "kitty") || variable_has("TERM", "ghostty"))
        return BP_GRAPHICS_KITTY;
    if (variable_is("TERM_PROGRAM", "iTerm.app") || variable_is("LC_TERMINAL", "iTerm2") ||
        variable_is("TERM_PROGRAM", "WezTerm") || variable_is("TERM_PROGRAM", "mintty"))
        return BP_GRAPHICS_ITERM2;
    return ask_for_sixels() ? BP_GRAPHICS_SIXEL : BP_GRAPHICS_BLOCKS;
}

#define GRAPHICS_WORDS(X)                                                                                    \
    X(BP_GRAPHICS_BLOCKS, "blocks")                                                                          \
    X(BP_GRAPHICS_KITTY, "kitty") X(BP_GRAPHICS_ITERM2, "iterm2") X(BP_GRAPHICS_SIXEL, "sixel")
BP_WORDS(BpTerminalGraphics, static const char *const names, GRAPHICS_WORDS);

BpStatus bp_terminal_picture_begin(BpTerminalPicture *shown, BpError *err) {
    const char *wanted = getenv("BALLPARK_SHOW");
    *shown = (BpTerminalPicture){0};
    if (!bp_terminal_is_live(false))
        return bp_fail(err, BP_ERR_USAGE,
                       "--show needs standard error to be a terminal that can draw; "
                       "elsewhere, --preview SECONDS writes the picture as it grows");
    if (wanted == NULL || wanted[0] == '\0') {
        shown->graphics = detect();
        return BP_OK;
    }
    for (size_t i = 0; i < sizeof names / sizeof names[0]; ++i) {
        if (strcmp(wanted, names[i]) != 0) continue;
        shown->graphics = (BpTerminalGraphics)i;
        return BP_OK;
    }
    return bp_fail(err, BP_ERR_USAGE, "BALLPARK_SHOW is \"%.40s\"; expected kitty, iterm2, sixel or blocks",
                   wanted);
}

/* ---- sizes -------------------------------------------------------------------------------------------- */

typedef struct Size {
    unsigned columns, rows; /* of letters */
    unsigned width, height; /* of pixels */
} Size;

/* The largest size that leaves a line for the status and one for the prompt; a pixel takes at most `largest`
 * pixels of the screen. Letters are assumed to be twice as high as wide if the terminal does not report their
 * size. */
static Size choose_size(const BpPicture *picture, unsigned largest) {
    struct winsize window = {0};
    unsigned letter_width = 8, letter_height = 16;
    const unsigned columns = bp_terminal_columns();
    unsigned rows = 24;
    if (ioctl(STDERR_FILENO, TIOCGWINSZ, &window) == 0 && window.ws_row > 0) rows = window.ws_row;
    if (window.ws_xpixel > 0 && window.ws_ypixel > 0 && window.ws_col > 0) {
        letter_width = (unsigned)fmax(1, window.ws_xpixel / window.ws_col);
        letter_height = (unsigned)fmax(1, window.ws_ypixel / rows);
    }
    const double room_x = columns > 1 ? (columns - 1) * letter_width : letter_width;
    const double room_y = rows > 3 ? (rows - 2) * letter_height : letter_height;
    const double scale = fmin(fmin(room_x / picture->width, room_y / picture->height), largest);
    Size size = {.width = (unsigned)fmax(1, floor(scale * picture->width + 1e-9)),
                 .height = (unsigned)fmax(1, floor(scale * picture->height + 1e-9))};
    size.columns = (size.width + letter_width - 1) / letter_width;
    size.rows = (size.height + letter_height - 1) / letter_height;
    return size;
}

/* The mean radiance of the picture's pixels in a part of it, as bytes. The part is at least a pixel. */
static void mean_bytes(const BpPicture *picture, double left, double right, double top, double bottom,
                       BpTransfer transfer, uint8_t bytes[3]) {
    const uint32_t x0 = (uint32_t)left, y0 = (uint32_t)top;
    const uint32_t x1 = (uint32_t)fmin(picture->width, fmax(ceil(right - 1e-9), x0 + 1.0));
    const uint32_t y1 = (uint32_t)fmin(picture->height, fmax(ceil(bottom - 1e-9), y0 + 1.0));
    double sum[3] = {0};
    for (uint32_t y = y0; y < y1; ++y)
        for (uint32_t x = x0; x < x1; ++x)
            for (size_t c = 0; c < 3; ++c)
                sum[c] += (double)picture->rgb[3 * ((size_t)y * picture->width + x) + c];
    for (size_t c = 0; c < 3; ++c)
        bytes[c] = bp_transfer_byte(sum[c] / ((double)(x1 - x0) * (y1 - y0)), transfer);
}

/* `width` x `height` x 3; the caller frees it. NULL: out of memory. */
static uint8_t *resize(const BpPicture *picture, unsigned width, unsigned height, BpTransfer transfer) {
    uint8_t *bytes = malloc((size_t)width * height * 3);
    const double step_x = (double)picture->width / width, step_y = (double)picture->height / height;
    for (unsigned y = 0; bytes != NULL && y < height; ++y)
        for (unsigned x = 0; x < width; ++x)
            mean_bytes(picture, x * step_x, (x + 1) * step_x, y * step_y, (y + 1) * step_y, transfer,
                       bytes + 3 * ((size_t)y * width + x));
    return bytes;
}

/* ---- half blocks -------------------------------------------------------------------------------------- */

/* 16 million colours if the terminal announces them, else the cube of 216. */
static void print_color(FILE *out, bool foreground, const uint8_t color[3]) {
    if (variable_is("COLORTERM", "truecolor") || variable_is("COLORTERM", "24bit")) {
        fprintf(out, "\033[%d;2;%d;%d;%dm", foreground ? 38 : 48, color[0], color[1], color[2]);
        return;
    }
    int step[3];
    for (int c = 0; c < 3; ++c) step[c] = color[c] < 48 ? 0 : color[c] < 115 ? 1 : (color[c] - 35) / 40;
    fprintf(out, "\033[%d;5;%dm", foreground ? 38 : 48, 16 + 36 * step[0] + 6 * step[1] + step[2]);
}

static bool print_blocks(FILE *out, const BpPicture *picture, Size *size, BpTransfer transfer) {
    const bool halves = bp_terminal_has_utf8();
    size->columns = size->columns > picture->width ? picture->width : size->columns;
    const unsigned lines = halves ? 2 * size->rows : size->rows;
    uint8_t *bytes = resize(picture, size->columns, lines, transfer);
    if (bytes == NULL) return false;
    for (unsigned row = 0; row < size->rows; ++row) {
        for (unsigned x = 0; x < size->columns; ++x) {
            const unsigned y = halves ? 2 * row : row;
            const uint8_t *upper = bytes + 3 * ((size_t)y * size->columns + x);
            const uint8_t *lower = halves ? upper + 3 * (size_t)size->columns : upper;
            if (halves) print_color(out, true, upper);
            print_color(out, false, lower);
            fputs(halves ? "\xe2\x96\x80" : " ", out); /* U+2580: the upper half block */
        }
        fputs("\033[0m\033[K", out);
        if (row + 1 < size->rows) fputs("\r\n", out);
    }
    free(bytes);
    return true;
}

/* ---- kitty and iTerm2: a PNG in base64 ---------------------------------------------------------------- */

static bool make_png(const BpPicture *picture, BpTransfer transfer, char **bytes, size_t *size) {
    FILE *memory = open_memstream(bytes, size);
    if (memory == NULL) return false;
    const bool made = bp_picture_write_stream(picture, memory, BP_FORMAT_PNG, transfer, NULL) == BP_OK;
    if (fclose(memory) == 0 && made) return true;
    free(*bytes);
    *bytes = NULL;
    return false;
}

/* In pieces of at most 4096 letters. The number makes a later picture replace the one before; q=2: no
 * answers. */
static bool print_kitty(FILE *out, const BpPicture *picture, const Size *size, BpTransfer transfer) {
    enum { PIECE = 3072 };
    char *bytes = NULL;
    size_t length = 0;
    if (!make_png(picture, transfer, &bytes, &length)) return false;
    for (size_t at = 0; at < length; at += PIECE) {
        const size_t piece = length - at < PIECE ? length - at : PIECE;
        fputs("\033_G", out);
        if (at == 0)
            fprintf(out, "a=T,f=100,q=2,C=1,i=%u,p=1,c=%u,r=%u,", (unsigned)getpid(), size->columns,
                    size->rows);
        fprintf(out, "m=%d;", at + piece < length);
        bp_base64_print(bytes + at, piece, out);
        fputs("\033\\", out);
    }
    free(bytes);
    return true;
}

static bool print_iterm2(FILE *out, const BpPicture *picture, const Size *size, BpTransfer transfer) {
    char *bytes = NULL;
    size_t length = 0;
    if (!make_png(picture, transfer, &bytes, &length)) return false;
    fprintf(out, "\033]1337;File=inline=1;size=%zu;width=%u;height=%u;preserveAspectRatio=1:", length,
            size->columns, size->rows);
    bp_base64_print(bytes, length, out);
    putc('\a', out);
    free(bytes);
    return true;
}

/* ---- sixels: six rows at a time, one colour after the other ------------------------------------------- */

enum { LEVELS = 6, COLORS = LEVELS * LEVELS * LEVELS };

/* One of the cube's colours; the thresholds of an 8 x 8 matrix (B. E. Bayer 1973) dither the values between.
 */
static unsigned dither(const uint8_t color[3], unsigned x, unsigned y) {
    unsigned threshold = 0, number = 0;
    for (unsigned bit = 0; bit < 3; ++bit)
        threshold = threshold << 2 | ((x >> bit ^ y >> bit) & 1u) << 1 | (y >> bit & 1u);
    for (int c = 0; c < 3; ++c)
        number = number * LEVELS + (color[c] * (LEVELS - 1) * 64u + 255u * threshold + 127u) / (255u * 64u);
    return number;
}

/* A run of equal sixels, shortened where that is shorter. */
static void print_run(FILE *out, int letter, unsigned count) {
    if (count > 3)
        fprintf(out, "!%u%c", count, letter);
    else
        while (count-- > 0) putc(letter, out);
}

static void print_band(FILE *out, const uint8_t *numbers, unsigned width, unsigned rows) {
    bool used[COLORS] = {false};
    for (size_t i = 0; i < (size_t)width * rows; ++i) used[numbers[i]] = true;
    for (unsigned color = 0; color < COLORS; ++color) {
        if (!used[color]) continue;
        int last = -1;
        unsigned count = 0;
        fprintf(out, "#%u", color);
        for (unsigned x = 0; x < width; ++x) {
            int bits = 0;
            for (unsigned y = 0; y < rows; ++y) bits |= (numbers[(size_t)y * width + x] == color) << y;
            if (bits != last && count > 0) print_run(out, '?' + last, count);
            count = bits == last ? count + 1 : 1;
            last = bits;
        }
        if (last > 0) print_run(out, '?' + last, count);
        putc('$', out);
    }
    putc('-', out);
}

static bool print_sixels(FILE *out, const BpPicture *picture, const Size *size, BpTransfer transfer) {
    uint8_t *bytes = resize(picture, size->width, size->height, transfer);
    uint8_t *numbers = malloc((size_t)size->width * 6);
    if (bytes != NULL && numbers != NULL) {
        fprintf(out, "\033P0;1q\"1;1;%u;%u", size->width, size->height);
        for (unsigned n = 0; n < COLORS; ++n) /* in percent */
            fprintf(out, "#%u;2;%u;%u;%u", n, n / (LEVELS * LEVELS) * 100 / (LEVELS - 1),
                    n / LEVELS % LEVELS * 100 / (LEVELS - 1), n % LEVELS * 100 / (LEVELS - 1));
        for (unsigned top = 0; top < size->height; top += 6) {
            const unsigned rows = size->height - top < 6 ? size->height - top : 6;
            for (unsigned y = 0; y < rows; ++y)
                for (unsigned x = 0; x < size->width; ++x)
                    numbers[(size_t)y * size->width + x] =
                        (uint8_t)dither(bytes + 3 * ((size_t)(top + y) * size->width + x), x, top + y);
            print_band(out, numbers, size->width, rows);
        }
        fputs("\033\\", out);
    }
    const bool made = bytes != NULL && numbers != NULL;
    free(bytes);
    free(numbers);
    return made;
}

/* ---- drawing ------------------------------------------------------------------------------------------ */

BpStatus bp_terminal_picture_draw(BpTerminalPicture *shown, const BpPicture *picture, BpTransfer transfer,
                                  BpError *err) {
    char *text = NULL;
    size_t length = 0;
    Size size = choose_size(picture, shown->graphics == BP_GRAPHICS_BLOCKS ? 8 : 4);
    bool made = false;
    /* By one write, so that the terminal does not show half of it. */
    FILE *out = open_memstream(&text, &length);
    if (out == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for --show");
    fputs("\r\033[K", out); /* the status line */
    if (shown->rows > 0 && shown->columns > 0) fprintf(out, "\033[%uA", shown->rows);
    /* Lines below are made first, since a terminal may scroll for them. */
    for (unsigned row = 0; row < size.rows; ++row) fputs("\n", out);
    fprintf(out, "\033[%uA\r\0337", size.rows);
    switch (shown->graphics) {
    case BP_GRAPHICS_BLOCKS:
        made = print_blocks(out, picture, &size, transfer);
        break;
    case BP_GRAPHICS_KITTY:
        made = print_kitty(out, picture, &size, transfer);
        break;
    case BP_GRAPHICS_ITERM2:
        made = print_iterm2(out, picture, &size, transfer);
        break;
    case BP_GRAPHICS_SIXEL:
        made = print_sixels(out, picture, &size, transfer);
        break;
    }
    fprintf(out, "\0338\033[%uB\r", size.rows);
    made = fclose(out) == 0 && made;
    if (made) {
        fwrite(text, 1, length, stderr);
        fflush(stderr);
        shown->columns = size.columns;
        shown->rows = size.rows;
    }
    free(text);
    return made ? BP_OK : bp_fail(err, BP_ERR_MEMORY, "out of memory for --show");
}
