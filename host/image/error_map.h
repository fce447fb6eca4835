/* error_map.h: where a picture is uncertain, as a picture.
 *
 * In:    a BpPicture with standard errors.   Out: an 8-bit picture, or a PNG of it.
 * Knows: colours, the legend.   Does not know: how the errors were estimated.
 *
 * Each pixel shows its relative standard error on a scale that is the same for every picture, 0.1 % to 100 %
 * by logarithm, so that two maps can be compared: dark is certain, bright is uncertain. Lightness rises
 * evenly along the scale, so the order survives grey prints and colour-blind eyes. A pixel whose error is not
 * known, or that is black without any error (it may simply not have met the light yet), is grey, which the
 * scale has not. Small pictures are enlarged by a whole factor; a legend stands below. */
#ifndef BP_IMAGE_ERROR_MAP_H
#define BP_IMAGE_ERROR_MAP_H

#include "text.h"

#include "../ballpark.h"

#define BP_ERROR_MAP_LEAST 0.001 /* relative errors at the ends of the scale */
#define BP_ERROR_MAP_MOST 1.0

/* Standard error of a pixel's luminance over its luminance; NaN when unknown, +Inf for black with an error.
 * The error of the luminance is taken as the weighted sum of its channels' (Rec. 709), which holds when the
 * channels err together, as they mostly do, and is too large otherwise. */
double bp_pixel_relative_error(const BpPicture *picture, size_t pixel);

/* The colour of a relative error; grey for NaN. */
void bp_error_color(double relative_error, uint8_t rgb[3]);

/* Draws the map; free canvas->rgb with free(). BP_ERR_USAGE when the picture has no errors, BP_ERR_MEMORY. */
BpStatus bp_error_map_draw(const BpPicture *picture, BpCanvas *canvas, BpError *err);

/* The same as a PNG, written atomically. */
BpStatus bp_error_map_write(const BpPicture *picture, const char *path, BpError *err);

#endif
