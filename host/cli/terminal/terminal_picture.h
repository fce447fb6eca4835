/* terminal_picture.h: draws a picture in the terminal, over the previous one.
 *
 * In:    a picture.   Out: escape sequences on standard error that draw it.
 * Knows: the graphics protocols of terminals.   Does not know: why or how often a picture is shown.
 *
 * The terminal is detected from the environment and its reply to a query of device attributes: kitty's
 * graphics (kitty, Ghostty), inline images of iTerm2 (iTerm2, WezTerm, mintty), sixels (if the reply lists
 * them). All others, and all within tmux or screen, get half blocks: two pixels per character. BALLPARK_SHOW
 * in the environment (kitty, iterm2, sixel, blocks) overrides that. */
#ifndef BP_CLI_TERMINAL_TERMINAL_PICTURE_H
#define BP_CLI_TERMINAL_TERMINAL_PICTURE_H

#include "ballpark.h"

typedef enum BpTerminalGraphics {
    BP_GRAPHICS_BLOCKS,
    BP_GRAPHICS_KITTY,
    BP_GRAPHICS_ITERM2,
    BP_GRAPHICS_SIXEL
} BpTerminalGraphics;

typedef struct BpTerminalPicture {
    BpTerminalGraphics graphics;
    unsigned columns, rows; /* covered by the latest drawing; 0 rows: none */
} BpTerminalPicture;

/* Queries the terminal, for half a second at most. BP_ERR_USAGE: standard error is not a terminal that can
 * draw, or BALLPARK_SHOW has an unknown value. */
BpStatus bp_terminal_picture_begin(BpTerminalPicture *shown, BpError *err);

/* Draws it above the status line, replacing the previous one. BP_ERR_MEMORY; failures of the terminal cannot
 * be detected. */
BpStatus bp_terminal_picture_draw(BpTerminalPicture *shown, const BpPicture *picture, BpTransfer transfer,
                                  BpError *err);

#endif
