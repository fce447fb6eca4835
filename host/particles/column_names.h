/* column_names.h: what programs call the columns of a table, and which of them are a place or a colour.
 *
 * In:    the names of columns.   Out: which are x, y and z, and red, green and blue; units.
 * Knows: names that are in use.   Does not know: where they stand.
 *
 * Letters count the same in both cases, and what separates words does not count: "Position.X", "pos_x",
 * "Points:0" and "coords[0]" are all understood. A unit may follow: "x (nm)", "x [nm]", "x/nm",
 * "x_nm". */
#ifndef BP_PARTICLES_COLUMN_NAMES_H
#define BP_PARTICLES_COLUMN_NAMES_H

#include <stdbool.h>
#include <stddef.h>

enum { COLUMN_NONE = -1, COLUMN_TWICE = -2, COLUMN_UNIT_SIZE = 24 };

/* The place of the column with a name, given in small letters without separators; without unit first, else
 * with one. COLUMN_NONE: there is none; COLUMN_TWICE: there are several. */
int column_named(const char *const *names, size_t count, const char *wanted);
/* The columns of x, y and z, where `place` has what column_named() gives; z may be missing. Returns how many
 * sets of such columns there are, the first of which is taken. */
size_t column_find_places(const char *const *names, size_t count, int place[3]);
/* The columns of red, green and blue; false unless all three are there and once. */
bool column_find_color(const char *const *names, size_t count, int place[3]);
/* A column that seems to hold colours, but in a form that is not read: a name, a packed number, one channel
 * of three. NULL: none. */
const char *column_single_color(const char *const *names, size_t count);
/* The first of three columns that seem to hold the axes of ellipsoids. NULL: there are none. */
const char *column_unread_shape(const char *const *names, size_t count);
/* The unit behind a name; "": none. */
void column_unit(const char *name, char unit[COLUMN_UNIT_SIZE]);
/* An angstrom in that unit; 0: no unit that is known. */
double column_angstrom(const char *unit);

#endif
