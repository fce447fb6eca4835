/* color_bar.h: draws the legend of a colormap into a picture.
 *
 * In:    a picture, the map's colours and values.   Out: the picture with a bar at its right side.
 * Knows: pixels, round numbers.   Does not know: where the colours come from. */
#ifndef BP_IMAGE_COLOR_BAR_H
#define BP_IMAGE_COLOR_BAR_H

#include "base/status.h"

enum { BP_COLOR_BAR_STOPS = 256 };

/* Draws over the picture's radiance, encoded for 8-bit files through `transfer`. `colors`: linear, from the
 * smallest value to the largest. In a picture with alpha, letters are dark with a white rim, so that they can
 * be read on any page; otherwise they are dark on a light picture and light on a dark one. In `title`,
 * letters that the font lacks are gaps. A picture that is too small stays unchanged. */
BpStatus bp_color_bar_draw(BpPicture *picture, BpTransfer transfer, const float colors[BP_COLOR_BAR_STOPS][3],
                           const double range[2], const char *title, BpError *err);

#endif
