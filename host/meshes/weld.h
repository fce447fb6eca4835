/* weld.h: vertices at one place.
 *
 * In:    positions.   Out: for each, the first one that is equal to the bit; 0 and -0 are equal.
 * Does not know: which faces have them. */
#ifndef BP_MESHES_WELD_H
#define BP_MESHES_WELD_H

#include "base/status.h"

#include <stdint.h>

/* Which vertices have been met, by place; begins zeroed. */
typedef struct Weld {
    uint32_t *slots; /* a hash table of numbers, each plus 1; 0: free */
    size_t size, used;
} Weld;

/* The vertex of `positions` that was met first at the place of `position`; where there is none, `number`,
 * which is noted, and which positions[] must hold at the next call. */
BpStatus weld_find(Weld *weld, const double (*positions)[3], const double position[3], uint32_t number,
                   uint32_t *found, BpError *err);
void weld_clear(Weld *weld);

/* first[i]: the first vertex at the place of vertex i. */
BpStatus weld_places(const double (*positions)[3], size_t count, uint32_t *first, BpError *err);

#endif
