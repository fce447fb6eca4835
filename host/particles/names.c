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

/* Appends a text, with room for it in the arrays. */
static bool append(BpNames *names, const char *text) {
    const size_t size = strlen(text) + 1;
    char *const copy = malloc(size);
    if (copy == NULL) return false;
    memcpy(copy, text, size);
    names->text[names->count++] = copy;
    return true;
}

BpStatus names_number(BpNames *names, const char *text, uint16_t *number, BpError *err) {
    *number = 0;
    if (text == NULL || text[0] == '\0') return BP_OK;
    bool good = (names->count > 0 && names->count < names->capacity) || grow(names);
    if (good && names->count == 0) good = append(names, "");
    size_t at = good ? hash_of(text) % names->slot_count : 0;
    while (good && names->slots[at] != 0 && strcmp(names->text[names->slots[at]], text) != 0)
        at = (at + 1) % names->slot_count;
    if (good && names->slots[at] == 0) {
        if (strlen(text) >= BP_PARTICLE_NAME_SIZE)
            return bp_fail(err, BP_ERR_SCENE, "found a name of %zu bytes, expected at most %d", strlen(text),
                           BP_PARTICLE_NAME_SIZE - 1);
        if (names->count == NAMES_MAX)
            return bp_fail(err, BP_ERR_SCENE, "found more than %d different names, expected fewer",
                           NAMES_MAX - 1);
        good = append(names, text);
        if (good) names->slots[at] = (uint32_t)names->count - 1;
    }
    if (!good) return bp_fail(err, BP_ERR_MEMORY, "out of memory for names of particles");
    *number = (uint16_t)names->slots[at];
    return BP_OK;
}

void names_clear(BpNames *names) {
    for (size_t i = 0; i < names->count; i++) free(names->text[i]);
    free(names->text);
    free(names->slots);
    *names = (BpNames){0};
}
