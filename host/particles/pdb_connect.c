/* pdb_connect.c: see pdb_connect.h. */
#include "pdb_connect.h"

#include <stdlib.h>
#include <string.h>

enum { FIELD = 5, FIRST_ATOM_COLUMN = 7, FIRST_BOND_COLUMN = 12, BONDS_A_LINE = 4, FIRST_CAPACITY = 1024 };

/* The text in five columns as a number, in which every text has its own; 0: there is none. False: something
 * that is no serial number. */
static bool serial_at(const char *line, size_t length, size_t column, uint64_t *key) {
    char text[FIELD + 1];
    fixed_text(line, length, column, column + FIELD - 1, text, sizeof text);
    const char *rest = text;
    while (rest[0] == '0' && rest[1] != '\0') rest++;
    *key = 0;
    for (; *rest != '\0'; rest++) {
        const unsigned char c = (unsigned char)*rest;
        const bool good =
            (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '-';
        if (!good) return false;
        *key = *key << 8 | c;
    }
    return true;
}

/* Room for one more element; false: out of memory. */
static bool make_room(void *array, size_t count, size_t *capacity, size_t size) {
    void **const place = array;
    if (count < *capacity) return true;
    const size_t wanted = *capacity > 0 ? 2 * *capacity : FIRST_CAPACITY;
    void *const grown = realloc(*place, wanted * size);
    if (grown == NULL) return false;
    *place = grown;
    *capacity = wanted;
    return true;
}

BpStatus pdb_take_serial(PdbSerials *serials, const char *line, BpError *err) {
    uint64_t key = 0;
    if (!serial_at(line, strlen(line), FIRST_ATOM_COLUMN, &key)) key = 0;
    if (!make_room(&serials->key, serials->count, &serials->capacity, sizeof *serials->key))
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for the numbers of %zu atoms", serials->count);
    serials->key[serials->count++] = key;
    return BP_OK;
}

BpStatus pdb_take_links(PdbLinks *links, const char *line, BpError *err) {
    const size_t length = strlen(line);
    uint64_t atom = 0, other = 0;
    if (!serial_at(line, length, FIRST_ATOM_COLUMN, &atom) || atom == 0) {
        links->unreadable++;
        return BP_OK;
    }
    for (size_t i = 0; i < BONDS_A_LINE; i++) { /* columns from 32 on held hydrogen bonds and salt bridges */
        if (!serial_at(line, length, FIRST_BOND_COLUMN + FIELD * i, &other)) {
            links->unreadable++;
            continue;
        }
        if (other == 0) continue;
        if (!make_room(&links->pair, links->count, &links->capacity, sizeof *links->pair))
            return bp_fail(err, BP_ERR_MEMORY, "out of memory for %zu connections", links->count);
        links->pair[links->count][0] = atom;
        links->pair[links->count++][1] = other;
    }
    return BP_OK;
}

typedef struct Numbered {
    uint64_t key;
    uint32_t atom;
} Numbered;

static int compare_numbered(const void *a, const void *b) {
    const Numbered *const one = a, *const other = b;
    if (one->key != other->key) return one->key < other->key ? -1 : 1;
    return one->atom < other->atom ? -1 : one->atom > other->atom;
}

/* The one atom of that number, in a sorted list; UINT32_MAX: there is none, or there are several. */
static uint32_t find_atom(const Numbered *list, size_t count, uint64_t key) {
    size_t low = 0, high = count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (list[middle].key < key)
            low = middle + 1;
        else
            high = middle;
    }
    const bool found = low < count && list[low].key == key;
    const bool several = found && low + 1 < count && list[low + 1].key == key;
    return found && !several ? list[low].atom : UINT32_MAX;
}

BpStatus pdb_add_bonds(BpParticleFile *file, const PdbLinks *links, const PdbSerials *serials, BpError *err) {
    file->out->bonds_left_out += links->unreadable;
    if (links->count == 0) return BP_OK;
    Numbered *const list = malloc((serials->count + 1) * sizeof *list);
    if (list == NULL)
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for the numbers of %zu atoms", serials->count);
    for (size_t i = 0; i < serials->count; i++) list[i] = (Numbered){serials->key[i], (uint32_t)i};
    qsort(list, serials->count, sizeof *list, compare_numbered);
    BpStatus status = BP_OK;
    for (size_t i = 0; i < links->count && status == BP_OK; i++) {
        const uint32_t a = find_atom(list, serials->count, links->pair[i][0]);
        const uint32_t b = find_atom(list, serials->count, links->pair[i][1]);
        if (a == UINT32_MAX || b == UINT32_MAX || a == b)
            file->out->bonds_left_out++;
        else
            status = frame_add_bond(file, a, b, err);
    }
    free(list);
    return status;
}
