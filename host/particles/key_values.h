/* key_values.h: the pairs of key and value in the second line of an extended XYZ file.
 *
 * In:    the line.   Out: the value of a key, without its quotes or brackets; numbers in it.
 * Knows: the forms that programs write (github.com/libAtoms/extxyz): bare words, "...", '...', {...}, [...]
 * and
 * [[...], [...]].   Does not know: what keys mean. */
#ifndef BP_PARTICLES_KEY_VALUES_H
#define BP_PARTICLES_KEY_VALUES_H

#include <stdbool.h>
#include <stddef.h>

enum { KEY_VALUE_SIZE = 4096 };

typedef enum KeyFound {
    KEY_ABSENT,
    KEY_FOUND,
    KEY_BROKEN /* its quote or bracket is not closed, or its value is longer than KEY_VALUE_SIZE */
} KeyFound;

/* Finds a key, in letters of either case; the first of several. Of brackets the outermost are taken away. */
KeyFound key_find(const char *line, const char *key, char value[KEY_VALUE_SIZE]);
/* Reads numbers between blanks, commas and brackets. Returns how many there are, the first `max` of which are
 * in `numbers`; -1: something else is among them. */
int key_numbers(const char *value, double *numbers, int max);

#endif
