/* crop.h: cuts the same small window out of every picture, and maps its true error.
 *
 * In:    pictures.   Out: the window's place, PNGs of it.
 * Knows: pixels, the map.    Does not know: where the pictures came from. */
#ifndef BP_STUDY_CROP_H
#define BP_STUDY_CROP_H

#include "study.h"

#define BP_STUDY_CROP_WIDTH 96u
#define BP_STUDY_CROP_HEIGHT 64u

/* Adds the distance of each pixel of x from y, in units of `brightness`, at most 1. */
void bp_study_interest_add(double *interest, const BpPicture *x, const BpPicture *y, double brightness);
/* The window of a crop's size with the largest sum of `interest`. */
void bp_study_crop_place(const double *interest, uint32_t width, uint32_t height, uint32_t *left,
                         uint32_t *top);
/* Fills the crop; clear it with bp_study_crop_clear() also on failure. */
BpStatus bp_study_crop(const BpPicture *x, const BpPicture *r1, const BpPicture *r2, uint32_t left,
                       uint32_t top, BpTransfer transfer, BpStudyCrop *crop, BpError *err);
void bp_study_crop_clear(BpStudyCrop *crop);

#endif
