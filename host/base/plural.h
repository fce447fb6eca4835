/* plural.h: the plural ending of a noun after a number. */
#ifndef BP_BASE_PLURAL_H
#define BP_BASE_PLURAL_H

#include <stdint.h>

/* "s" unless there is one: "1 sample", "0 samples", "2 samples". */
static inline const char *bp_plural(uint64_t count) {
    return count == 1 ? "" : "s";
}

#endif
