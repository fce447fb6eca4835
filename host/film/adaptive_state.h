/* adaptive_state.h: the state of adaptive sampling between passes; shared by adaptive.c, which decides, and
 * adaptive_save.c, which keeps it in files.
 *
 * Knows: tiles, halves, levels.   Does not know: files, OpenCL. */
#ifndef BP_FILM_ADAPTIVE_STATE_H
#define BP_FILM_ADAPTIVE_STATE_H

#include "adaptive.h"

enum { BP_ADAPTIVE_LEVELS_MAX = 28 };

/* A half of a tile: its pixels of one colour. Halves of a tile are neighbours: 2 * tile + colour. */
struct BpAdaptive {
    uint32_t width, height, tiles_x, tiles_y, halves;
    uint32_t level_max;
    uint32_t *half_pixels;   /* how many each has */
    uint8_t *level, *wanted; /* of each half; level l: BP_ADAPTIVE_FIRST << l samples per pixel */
    bool *passing;           /* halves of the pass under way */
    /* Means over the pixels of each half at each level: squared error, ray segments per sample. NULL: not
     * measured yet. */
    float *errors[BP_ADAPTIVE_LEVELS_MAX], *costs[BP_ADAPTIVE_LEVELS_MAX];
    uint32_t *list;            /* pixels of the pass under way */
    uint64_t pass_samples_max; /* that these will have */
    uint64_t planned;          /* mean samples that `wanted` is for */
};

#endif
