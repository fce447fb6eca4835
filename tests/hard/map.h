/* map.h: maps of sizes, which show where forms of an intersection are right.
 *
 * In:    the worst that each form does at each pair of sizes.   Out: a PNG with a field for each form.
 * Knows: lab.h, colours.   Does not know: what was intersected. */
#ifndef TESTS_HARD_MAP_H
#define TESTS_HARD_MAP_H

#include "lab.h"

enum { FORMS = 4, SIDE = 10, SQUARE = 18, EACH = 600, GAP = 30, LEFT = 46, TOP = 62, BOTTOM = 64 };

/* The labs of the forms on the device. */
typedef struct Atlas {
    Lab labs[2], plain;
    const char *folder;
} Atlas;

/* value[form][row][column], row 0 at the bottom; NAN: nothing to judge. */
typedef struct Map {
    const char *file, *title, *across, *up, *worst, *best;
    const char *const *forms; /* NULL: those of spheres */
    int column_low, row_low;  /* exponents of ten of the first column and row */
    double low, high;         /* exponents of ten that are all white and all dark */
    double value[FORMS][SIDE][SIDE];
} Map;

void map_draw(const Atlas *atlas, const Map *map);

/* Writes map-capsule-error.png and map-capsule-wrong.png, and prints what is worst in them. */
void map_capsules(const Atlas *atlas);

#endif
