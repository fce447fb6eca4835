/* adaptive_save.c: serialises the decisions of adaptive sampling for a .bpa file; see adaptive.h.
 *
 * Layout, little endian: the mean for which the plan was made, 8 bytes; then level, wanted level and whether
 * it is in the pass under way, one byte a half each, all levels first; then for each level up to the highest
 * of any half, the squared errors of all halves and their costs, 4-byte floats. */
#include "adaptive_state.h"

#include "base/status.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PLANNED_BYTES = 8 };

static uint32_t highest_level(const uint8_t *levels, uint32_t halves) {
    uint32_t highest = 0;
    for (uint32_t half = 0; half < halves; ++half)
        if (levels[half] > highest) highest = levels[half];
    return highest;
}

static size_t size_for(const BpAdaptive *adaptive, uint32_t levels) {
    return PLANNED_BYTES + (size_t)adaptive->halves * (3 + 8 * (size_t)levels);
}

static void store_floats(const float *from, size_t count, uint8_t *at) {
    for (size_t i = 0; i < count; ++i) {
        uint32_t bits;
        memcpy(&bits, &from[i], sizeof bits);
        for (size_t byte = 0; byte < 4; ++byte) at[4 * i + byte] = (uint8_t)(bits >> (8 * byte));
    }
}

static bool load_floats(const uint8_t *at, size_t count, float *to) {
    bool good = true;
    for (size_t i = 0; i < count; ++i) {
        uint32_t bits = 0;
        for (size_t byte = 0; byte < 4; ++byte) bits |= (uint32_t)at[4 * i + byte] << (8 * byte);
        memcpy(&to[i], &bits, sizeof bits);
        good = good && isfinite(to[i]) && to[i] >= 0;
    }
    return good;
}

BpStatus bp_adaptive_save(const BpAdaptive *adaptive, uint8_t **bytes, size_t *size, BpError *err) {
    const uint32_t halves = adaptive->halves, levels = highest_level(adaptive->level, halves) + 1;
    *size = size_for(adaptive, levels);
    uint8_t *at = *bytes = malloc(*size);
    if (at == NULL)
        return bp_fail(err, BP_ERR_MEMORY, "no memory to keep the decisions of adaptive sampling");
    for (size_t byte = 0; byte < PLANNED_BYTES; ++byte) *at++ = (uint8_t)(adaptive->planned >> (8 * byte));
    memcpy(at, adaptive->level, halves);
    memcpy(at + halves, adaptive->wanted, halves);
    at += 2 * (size_t)halves;
    for (uint32_t half = 0; half < halves; ++half) *at++ = adaptive->passing[half];
    for (uint32_t level = 0; level < levels; ++level) {
        store_floats(adaptive->errors[level], halves, at);
        store_floats(adaptive->costs[level], halves, at + 4 * (size_t)halves);
        at += 8 * (size_t)halves;
    }
    return BP_OK;
}

/* Whether the state of the halves is valid; a pass raises halves of one level by one. */
static bool halves_fit(const BpAdaptive *adaptive, const uint8_t *level, const uint8_t *wanted,
                       const uint8_t *passing) {
    uint32_t pass_level = BP_ADAPTIVE_LEVELS_MAX;
    for (uint32_t half = 0; half < adaptive->halves; ++half) {
        if (level[half] > wanted[half] || wanted[half] > adaptive->level_max || passing[half] > 1)
            return false;
        if (passing[half] == 0) continue;
        if (level[half] == wanted[half] || (pass_level < BP_ADAPTIVE_LEVELS_MAX && level[half] != pass_level))
            return false;
        pass_level = level[half];
    }
    return true;
}

BpStatus bp_adaptive_restore(BpAdaptive *adaptive, const uint8_t *bytes, size_t size, BpError *err) {
    static const char wrong[] =
        "the decisions of adaptive sampling are not of a picture of this size, or damaged";
    const uint32_t halves = adaptive->halves;
    const uint8_t *level = bytes + PLANNED_BYTES, *wanted = level + halves, *passing = wanted + halves;
    if (size < size_for(adaptive, 1)) return bp_fail(err, BP_ERR_FILE, "%s", wrong);
    const uint32_t levels = highest_level(level, halves) + 1;
    if (!halves_fit(adaptive, level, wanted, passing) || size != size_for(adaptive, levels))
        return bp_fail(err, BP_ERR_FILE, "%s", wrong);
    for (uint32_t l = 0; l < BP_ADAPTIVE_LEVELS_MAX; ++l) {
        free(adaptive->errors[l]);
        free(adaptive->costs[l]);
        adaptive->errors[l] = adaptive->costs[l] = NULL;
    }
    const uint8_t *at = passing + halves;
    for (uint32_t l = 0; l < levels; ++l, at += 8 * (size_t)halves) {
        adaptive->errors[l] = calloc(halves, sizeof *adaptive->errors[l]);
        adaptive->costs[l] = calloc(halves, sizeof *adaptive->costs[l]);
        if (adaptive->errors[l] == NULL || adaptive->costs[l] == NULL)
            return bp_fail(err, BP_ERR_MEMORY, "no memory for the errors of %u tiles", halves / 2);
        if (!load_floats(at, halves, adaptive->errors[l]) ||
            !load_floats(at + 4 * (size_t)halves, halves, adaptive->costs[l]))
            return bp_fail(err, BP_ERR_FILE, "%s", wrong);
    }
    adaptive->planned = 0;
    for (size_t byte = 0; byte < PLANNED_BYTES; ++byte)
        adaptive->planned |= (uint64_t)bytes[byte] << (8 * byte);
    memcpy(adaptive->level, level, halves);
    memcpy(adaptive->wanted, wanted, halves);
    for (uint32_t half = 0; half < halves; ++half) adaptive->passing[half] = passing[half] == 1;
    return BP_OK;
}
