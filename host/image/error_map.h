/* error_map.h: draws a map of a picture's standard errors.
 *
 * In:    a BpPicture with standard errors.   Out: an 8-bit picture; by ballpark.h, a PNG of it.
 * Knows: colours, the legend.   Does not know: how the errors were estimated.
 *
 * Each pixel shows its relative standard error on a scale that is the same for every picture, 0.1 % to 100 %
 * by logarithm, so that two maps can be compared: dark is certain, bright is uncertain. Lightness rises
 * evenly along the scale, so the order survives grey prints and colour-blind eyes. A pixel whose error is
 * unknown, or that is black without any error (its samples may not have found the light yet), is grey, which
 * is not on the scale. Small pictures are enlarged by a whole factor; a legend stands below, with the median
 * of the pixels that show a sphere, where the picture has depths, else of all. */
#ifndef BP_IMAGE_ERROR_MAP_H
#define BP_IMAGE_ERROR_MAP_H

#include "text.h"

#include "ballpark.h"

#include <stdio.h>

#define BP_ERROR_MAP_LEAST 0.001 /* relative errors at the ends of the scale */
#define BP_ERROR_MAP_MOST 1.0

/* Draws the map; free canvas->rgb with free(). BP_ERR_USAGE when the picture has no errors, BP_ERR_MEMORY. */
BpStatus bp_error_map_draw(const BpPicture *picture, BpCanvas *canvas, BpError *err);

/* Draws it and writes it to an open stream, as a PNG. */
BpStatus bp_error_map_print(const BpPicture *picture, FILE *out, BpError *err);

#endif
