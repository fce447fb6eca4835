/* symmetry.h: the operations of a space group, as CIF files write them.
 *
 * In:    texts such as "x-y, -y, z+1/3".   Out: operations on shares of a cell; lists of them.
 * Knows: how programs write them.   Does not know: what groups are called, which atoms there are. */
#ifndef BP_PARTICLES_SYMMETRY_H
#define BP_PARTICLES_SYMMETRY_H

#include "base/status.h"

#include <stdbool.h>
#include <stddef.h>

/* The largest group of a usual cell has 192; files in other cells have some more. */
enum { SYMMETRY_MAX = 1024 };

/* Share i of the image: sum of turn[i][k] * share[k], and shift[i]. */
typedef struct Operation {
    double turn[3][3], shift[3];
} Operation;

/* Begins as zero; release with symmetry_clear(). */
typedef struct Symmetry {
    Operation *operation;
    size_t count, capacity;
} Symmetry;

extern const Operation symmetry_identity;

/* Terms may stand in any order, with blanks, capitals, fractions or decimals: 1/2+x, -.5 + Y, x-y. Shifts
 * within 0.0005 of a multiple of 1/24 are that, so that 0.3333 is a third. A fourth value, the +1 or -1 of
 * magnetic groups, is passed over. False: it is no operation, or one that does not keep volumes. */
bool symmetry_parse(const char *text, Operation *operation);
void symmetry_apply(const Operation *operation, const double share[3], double image[3]);
/* Adds an operation unless it is there but for whole shifts. Fails on more than SYMMETRY_MAX. */
BpStatus symmetry_add(Symmetry *symmetry, const Operation *operation, BpError *err);
/* Adds the products of each of `centering` with each that is there. */
BpStatus symmetry_multiply(Symmetry *symmetry, const Symmetry *centering, BpError *err);
void symmetry_clear(Symmetry *symmetry);

#endif
