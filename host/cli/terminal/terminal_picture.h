/* terminal_picture.h: a picture drawn in the terminal, over the one before.
 *
 * In:    a picture.   Out: what the terminal on standard error draws it from.
 * Knows: how terminals show pictures.   Does not know: why it is shown, how often.
 *
 * Which terminal it is follows from the environment and from its answer to a query of device attributes:
 * kitty's graphics (kitty, Ghostty), inline images as iTerm2 has them (iTerm2, WezTerm, mintty), sixels
 * (those that answer so when they are asked). All others, and all within tmux or screen, get half blocks: two
 * pixels a character. BALLPARK_SHOW in the environment (kitty, iterm2, sixel, blocks) decides where that is
 * wrong. */
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
    unsigned columns, rows; /* that the latest drawing covers; 0 rows: there is none */
} BpTerminalPicture;

/* Asks the terminal, for half a second at most. BP_ERR_USAGE: standard error is not a terminal that can draw,
 * or BALLPARK_SHOW has an unknown value. */
BpStatus bp_terminal_picture_begin(BpTerminalPicture *shown, BpError *err);

/* Draws it above the status line, in place of the one before. BP_ERR_MEMORY; how the terminal draws it cannot
 * be found out. */
BpStatus bp_terminal_picture_draw(BpTerminalPicture *shown, const BpPicture *picture, BpTransfer transfer,
                                  BpError *err);

#endif
