/* names.c: texts that repeat, each kept once; see names.h. */
#include "names.h"

#include <stdlib.h>
#include <string.h>

enum { NAMES_MAX = 65536 };

static uint32_t hash_of(const char *text) { /* FNV-1a (Fowler, Noll and Vo 1991) */
    uint32_t hash = 2166136261u;
    for (; *text != '\0'; text++) hash = (hash ^ (unsigned char)*text) * 16777619u;
    return hash;
}

static bool grow(BpNames *names) {
    const size_t capacity = names->capacity > 0 ? 2 * names->capacity : 64;
    void *text = realloc(names->text, capacity * sizeof *names->text);
    if (text == NULL) return false;
    names->text = text;
    uint32_t *slots = calloc(2 * capacity, sizeof *slots);
    if (slots == NULL) return false;
    free(names->slots);
    names->slots = slots;
    names->slot_count = 2 * capacity;
    names->capacity = capacity;
    for (size_t i = 1; i < names->count; i++) {
        size_t at = hash_of(names->text[i]) % names->slot_count;
        while (slots[at] != 0) at = (at + 1) % names->slot_count;
        slots[at] = (uint32_t)i;
    }
    return true;
}

BpStatus names_number(BpNames *names, const char *text, uint16_t *number, BpError *err) {
    char cut[BP_PARTICLE_NAME_SIZE];
    *number = 0;
    if (text == NULL || text[0] == '\0') return BP_OK;
    size_t length = strlen(text);
    if (length > sizeof cut - 1) length = sizeof cut - 1;
    memcpy(cut, text, length);
    cut[length] = '\0';
    if (names->count == 0 || names->count == names->capacity) {
        if (!grow(names)) return bp_fail(err, BP_ERR_MEMORY, "out of memory for names of particles");
        if (names->count == 0) names->text[names->count++][0] = '\0';
    }
    size_t at = hash_of(cut) % names->slot_count;
    while (names->slots[at] != 0 && strcmp(names->text[names->slots[at]], cut) != 0)
        at = (at + 1) % names->slot_count;
    if (names->slots[at] == 0) {
        if (names->count == NAMES_MAX)
            return bp_fail(err, BP_ERR_SCENE, "found more than %d different names, expected fewer",
                           NAMES_MAX - 1);
        memcpy(names->text[names->count], cut, length + 1);
        names->slots[at] = (uint32_t)names->count++;
    }
    *number = (uint16_t)names->slots[at];
    return BP_OK;
}

void names_clear(BpNames *names) {
    free(names->text);
    free(names->slots);
    *names = (BpNames){0};
}
