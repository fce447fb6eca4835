/* weld.c: see weld.h. */
#include "weld.h"

#include <stdlib.h>
#include <string.h>

static uint64_t hash_of(const double position[3]) {
    uint64_t hash = 0;
    for (int a = 0; a < 3; a++) {
        const double value = position[a] + 0.0; /* -0 becomes 0 */
        uint64_t bits;
        memcpy(&bits, &value, sizeof bits);
        hash = (hash ^ bits) * UINT64_C(0x9e3779b97f4a7c15);
        hash ^= hash >> 32;
    }
    return hash;
}

/* The slot of that place, or the free one where it would stand. */
static size_t slot_of(const Weld *weld, const double (*positions)[3], const double position[3]) {
    size_t slot = (size_t)hash_of(position) & (weld->size - 1);
    for (; weld->slots[slot] != 0; slot = (slot + 1) & (weld->size - 1)) {
        const double *const other = positions[weld->slots[slot] - 1];
        if (other[0] == position[0] && other[1] == position[1] && other[2] == position[2]) break;
    }
    return slot;
}

static BpStatus grow(Weld *weld, const double (*positions)[3], BpError *err) {
    Weld larger = {.size = weld->size > 0 ? 2 * weld->size : 256, .used = weld->used};
    larger.slots = calloc(larger.size, sizeof *larger.slots);
    if (larger.slots == NULL)
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for the places of %zu vertices", weld->used);
    for (size_t i = 0; i < weld->size; i++)
        if (weld->slots[i] != 0)
            larger.slots[slot_of(&larger, positions, positions[weld->slots[i] - 1])] = weld->slots[i];
    free(weld->slots);
    *weld = larger;
    return BP_OK;
}

BpStatus weld_find(Weld *weld, const double (*positions)[3], const double position[3], uint32_t number,
                   uint32_t *found, BpError *err) {
    if (2 * weld->used >= weld->size) BP_TRY(grow(weld, positions, err));
    const size_t slot = slot_of(weld, positions, position);
    if (weld->slots[slot] == 0) {
        weld->slots[slot] = number + 1;
        weld->used++;
    }
    *found = weld->slots[slot] - 1;
    return BP_OK;
}

void weld_clear(Weld *weld) {
    free(weld->slots);
    *weld = (Weld){0};
}

BpStatus weld_places(const double (*positions)[3], size_t count, uint32_t *first, BpError *err) {
    Weld weld = {0};
    BpStatus status = BP_OK;
    for (size_t i = 0; i < count && status == BP_OK; i++)
        status = weld_find(&weld, positions, positions[i], (uint32_t)i, &first[i], err);
    weld_clear(&weld);
    return status;
}
