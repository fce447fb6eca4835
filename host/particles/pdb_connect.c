/* pdb_connect.c: see pdb_connect.h. */
#include "pdb_connect.h"

#include <stdlib.h>
#include <string.h>

enum {
    FIELD = 5,
    FIELD_MAX = 8,
    BEGIN = 6,   /* of the numbers, after the record's name */
    NUMBERS = 5, /* of a line: an atom and what it is bonded to; hydrogen bonds follow in old files */
    FIRST_CAPACITY = 1024
};

/* A serial number as a number, in which every text has its own; 0: "". False: something that is none. */
static bool key_of(const char *text, size_t length, uint64_t *key) {
    size_t i = 0;
    while (i + 1 < length && text[i] == '0') i++;
    *key = 0;
    if (length - i > FIELD_MAX) return false;
    for (; i < length; i++) {
        const unsigned char c = (unsigned char)text[i];
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

BpStatus pdb_take_serial(PdbSerials *serials, const char *text, BpError *err) {
    const size_t length = strlen(text);
    uint64_t key = 0;
    if (!key_of(text, length, &key)) key = 0;
    if (!make_room(&serials->key, serials->count, &serials->capacity, sizeof *serials->key))
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for the numbers of %zu atoms", serials->count);
    serials->key[serials->count++] = key;
    if (key != 0 && length > serials->longest) serials->longest = length;
    return BP_OK;
}

/* What a line gives: numbers as texts, "" where columns are blank. */
typedef struct Fields {
    const char *begin[NUMBERS];
    size_t length[NUMBERS], count;
} Fields;

static bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r';
}

/* Columns of one width, in which numbers are at the right end. False: the line has other columns. */
static bool take_columns(const char *text, size_t length, size_t width, Fields *fields) {
    *fields = (Fields){0};
    for (size_t at = 0; at < length && fields->count < NUMBERS; at += width) {
        size_t begin = at, end = at + width < length ? at + width : length;
        while (begin < end && is_blank(text[begin])) begin++;
        if (begin < end && (end - at < width || is_blank(text[end - 1]))) return false;
        for (size_t i = begin; i < end; i++)
            if (is_blank(text[i])) return false;
        fields->begin[fields->count] = text + begin;
        fields->length[fields->count++] = end - begin;
    }
    /* A number that goes on behind them: they are wider. */
    return fields->count > 0 && (length <= NUMBERS * width || is_blank(text[NUMBERS * width]));
}

static void take_words(const char *text, size_t length, Fields *fields) {
    const char *const end = text + length;
    *fields = (Fields){0};
    while (fields->count < NUMBERS) {
        while (text < end && is_blank(*text)) text++;
        if (text == end) return;
        fields->begin[fields->count] = text;
        while (text < end && !is_blank(*text)) text++;
        fields->length[fields->count] = (size_t)(text - fields->begin[fields->count]);
        fields->count++;
    }
}

BpStatus pdb_take_links(PdbLinks *links, const PdbSerials *serials, const char *line, BpError *err) {
    const size_t width = serials->longest > FIELD ? serials->longest : FIELD;
    const char *const text = line + BEGIN;
    size_t length = strlen(text);
    Fields fields;
    uint64_t atom = 0, other = 0;
    while (length > 0 && is_blank(text[length - 1])) length--;
    const bool by_columns = take_columns(text, length, width, &fields);
    if (!by_columns) take_words(text, length, &fields);
    if (fields.count == 0 || fields.length[0] > width || !key_of(fields.begin[0], fields.length[0], &atom) ||
        atom == 0) {
        links->unreadable++;
        return BP_OK;
    }
    for (size_t i = 1; i < fields.count; i++) {
        if (fields.length[i] > width || !key_of(fields.begin[i], fields.length[i], &other)) {
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
