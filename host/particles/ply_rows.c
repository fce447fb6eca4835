/* ply_rows.c: see ply_rows.h. */
#include "ply_rows.h"

#include "base/decimal.h"
#include "base/message_text.h"
#include "base/plural.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static BpStatus fail_end(const Input *input, uint64_t row, const PlyElement *element, BpError *err) {
    return input_fail(input, false, err,
                      "found the end of the file, expected row %" PRIu64 " of %" PRIu64
                      "; the file is truncated, or its header counts too many",
                      row, element->count);
}

static BpStatus fail_length(const Input *input, bool with_line, uint64_t row, double number, BpError *err) {
    char found[BP_NUMBER_TEXT_SIZE];
    return input_fail(input, with_line, err,
                      "row %" PRIu64
                      " (from 0): found %s as the length of a list, expected a whole number of at least 0",
                      row, bp_number_text(number, found));
}

/* Adds an item to a list of which `count` are there. */
static BpStatus add_item(PlyList *list, double item, BpError *err) {
    if (list->count == list->capacity) {
        const size_t capacity = list->capacity > 0 ? 2 * list->capacity : 16;
        double *const items = realloc(list->items, capacity * sizeof *items);
        if (items == NULL)
            return bp_fail(err, BP_ERR_MEMORY, "out of memory for a list of %zu numbers", capacity);
        list->items = items;
        list->capacity = capacity;
    }
    list->items[list->count++] = item;
    return BP_OK;
}

/* ---- binary ------------------------------------------------------------------------------------------- */

static BpStatus fail_list(const Input *input, uint64_t row, BpError *err) {
    return input_fail(
        input, false, err,
        "found the end of the file in a list of row %" PRIu64 " (from 0); the file is truncated", row);
}

static BpStatus take_items(Input *input, PlyType type, bool swap, uint64_t count, uint64_t row, PlyList *list,
                           BpError *err) {
    const size_t size = ply_type_size(type);
    for (uint64_t i = 0; i < count; i++) {
        if (!input_fill(input, size)) return fail_list(input, row, err);
        BP_TRY(add_item(list, ply_decode(input->buffer + input->begin, type, swap), err));
        input_take(input, size);
    }
    return BP_OK;
}

/* That of property `place`, or NULL. */
static PlyList *find_list(PlyList *list, size_t place) {
    while (list != NULL && list->place != place) list = list->next;
    return list;
}

/* One row with lists, property by property. `values`, `list`: Optional. */
static BpStatus take_row(Input *input, const PlyHeader *header, const PlyElement *element, uint64_t row,
                         double *values, PlyList *list, BpError *err) {
    for (size_t i = 0; i < element->property_count; i++) {
        const PlyProperty *const p = &header->properties[element->first + i];
        const PlyType type = p->count_type != PLY_NONE ? p->count_type : p->type;
        const size_t size = ply_type_size(type);
        if (!input_fill(input, size)) return fail_end(input, row, element, err);
        const double number = ply_decode(input->buffer + input->begin, type, header->swap);
        input_take(input, size);
        if (values != NULL) values[i] = number;
        if (p->count_type == PLY_NONE) continue;
        if (number < 0) return fail_length(input, false, row, number, err);
        PlyList *const wanted = find_list(list, i);
        if (wanted != NULL)
            BP_TRY(take_items(input, p->type, header->swap, (uint64_t)number, row, wanted, err));
        else if (!input_skip(input, (uint64_t)number * ply_type_size(p->type)))
            return fail_list(input, row, err);
    }
    return BP_OK;
}

/* The same for rows without lists, of which files have millions. */
static BpStatus take_plain_row(Input *input, const PlyHeader *header, const PlyElement *element, uint64_t row,
                               double *values, BpError *err) {
    if (!input_fill(input, element->row_size)) return fail_end(input, row, element, err);
    const unsigned char *at = input->buffer + input->begin;
    for (size_t i = 0; i < element->property_count; i++) {
        const PlyType type = header->properties[element->first + i].type;
        values[i] = ply_decode(at, type, header->swap);
        at += ply_type_size(type);
    }
    input_take(input, element->row_size);
    return BP_OK;
}

static BpStatus skip_binary(Input *input, const PlyHeader *header, const PlyElement *element, BpError *err) {
    const uint64_t size = element->row_size;
    if (size == 0) return BP_OK;
    if (element->has_list) {
        for (uint64_t row = 0; row < element->count; row++)
            BP_TRY(take_row(input, header, element, row, NULL, NULL, err));
        return BP_OK;
    }
    const uint64_t before = input->taken, most = BP_INPUT_BYTES_MAX / size;
    if (!input_skip(input, (element->count < most ? element->count : most) * size))
        return fail_end(input, (input->taken - before) / size, element, err);
    return BP_OK;
}

/* ---- ASCII -------------------------------------------------------------------------------------------- */

static bool is_space(char c) {
    return c == ' ' || c == '\t' || c == '\r';
}

bool ply_parse_number(char **cursor, double *value) {
    while (is_space(**cursor)) (*cursor)++;
    if (**cursor == '\0') return false;
    const char *const after = bp_table_number_parse(*cursor, value);
    if (after != NULL && (*after == '\0' || is_space(*after))) {
        *cursor += after - *cursor;
        return true;
    }
    char *const end = *cursor + strcspn(*cursor, " \t\r");
    const char behind = *end;
    *end = '\0';
    const bool none = word_number_or_none(*cursor, value);
    *end = behind;
    if (none) *cursor = end;
    return none;
}

static BpStatus skip_ascii(Input *input, const PlyElement *element, BpError *err) {
    for (uint64_t row = 0; row < element->count && element->property_count > 0; row++) {
        char *line = NULL;
        BP_TRY(input_full_line(input, &line, err));
        if (line == NULL) return fail_end(input, row, element, err);
    }
    return BP_OK;
}

/* What its rows are called. */
static const char *noun_of(const PlyHeader *header, const PlyElement *element) {
    return element == &header->elements[header->vertex] ? "vertex" : element->faces ? "face" : "row";
}

/* Reads the items behind a list's length. *good: there are as many. */
static BpStatus parse_items(char **line, double count, PlyList *list, bool *good, BpError *err) {
    double item = 0;
    for (double k = 0; k < count && *good; k++) {
        *good = ply_parse_number(line, &item);
        if (*good && list != NULL) BP_TRY(add_item(list, item, err));
    }
    return BP_OK;
}

static BpStatus take_ascii(Input *input, const PlyHeader *header, const PlyElement *element, uint64_t row,
                           double *values, PlyList *list, BpError *err) {
    char *line = NULL, shown[48];
    BP_TRY(input_full_line(input, &line, err));
    if (line == NULL)
        return input_fail(input, true, err,
                          "found the end of the file, expected row %" PRIu64 " of %" PRIu64
                          "; the file is truncated, or its header counts too many",
                          row, element->count);
    for (size_t i = 0; i < element->property_count; i++) {
        const PlyProperty *const p = &header->properties[element->first + i];
        double number = 0;
        bool good = ply_parse_number(&line, &number);
        if (good && p->count_type != PLY_NONE) {
            if (!(number >= 0 && number == floor(number))) return fail_length(input, true, row, number, err);
            BP_TRY(parse_items(&line, number, find_list(list, i), &good, err));
        }
        values[i] = number;
        if (good) continue;
        bp_printable(line + strspn(line, " \t"), shown, sizeof shown);
        return input_fail(input, true, err,
                          "%s %" PRIu64 " (from 0): found \"%s\", expected a number for each of %zu "
                          "properties",
                          noun_of(header, element), row, shown, element->property_count);
    }
    if (line[strspn(line, " \t\r")] == '\0') return BP_OK;
    return input_fail(input, true, err,
                      "%s %" PRIu64 " (from 0): found more than %zu numbers, expected one for each "
                      "property",
                      noun_of(header, element), row, element->property_count);
}

/* ---- the whole ---------------------------------------------------------------------------------------- */

BpStatus ply_pass_element(Input *input, const PlyHeader *header, size_t element, BpError *err) {
    return header->form == PLY_ASCII ? skip_ascii(input, &header->elements[element], err)
                                     : skip_binary(input, header, &header->elements[element], err);
}

BpStatus ply_begin_points(Input *input, const PlyHeader *header, BpError *err) {
    for (size_t i = 0; i < header->vertex; i++) BP_TRY(ply_pass_element(input, header, i, err));
    return BP_OK;
}

BpStatus ply_take_row(Input *input, const PlyHeader *header, size_t element, uint64_t row, double *values,
                      PlyList *list, BpError *err) {
    const PlyElement *const taken = &header->elements[element];
    for (PlyList *one = list; one != NULL; one = one->next) one->count = 0;
    return header->form == PLY_ASCII ? take_ascii(input, header, taken, row, values, list, err)
           : taken->has_list         ? take_row(input, header, taken, row, values, list, err)
                                     : take_plain_row(input, header, taken, row, values, err);
}

BpStatus ply_take_point(Input *input, const PlyHeader *header, uint64_t row, double *values, BpError *err) {
    return ply_take_row(input, header, header->vertex, row, values, NULL, err);
}

BpStatus ply_expect_end(Input *input, const PlyHeader *header, BpError *err) {
    static const char remedy[] =
        "expected the end of the file: correct the counts in its header, or remove what follows";
    const uint64_t here = input->taken;
    if (header->form == PLY_ASCII) {
        char *line = NULL;
        BP_TRY(input_full_line(input, &line, err));
        return line == NULL
                   ? BP_OK
                   : input_fail(input, true, err, "found another line after the last element, %s", remedy);
    }
    (void)input_skip(input, UINT64_MAX);
    const uint64_t more = input->taken - here;
    if (input->failed) return input_fail(input, false, err, "%s", "");
    if (more == 0) return BP_OK;
    return input_fail(input, false, err,
                      "found %" PRIu64 " byte%s after the last element, from byte %" PRIu64 " on, %s", more,
                      bp_plural(more), here, remedy);
}

BpStatus ply_end_points(Input *input, const PlyHeader *header, BpError *err) {
    for (size_t i = header->vertex + 1; i < header->element_count; i++)
        BP_TRY(ply_pass_element(input, header, i, err));
    return ply_expect_end(input, header, err);
}
