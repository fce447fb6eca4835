/* ply_rows.c: see ply_rows.h. */
#include "ply_rows.h"

#include "base/decimal.h"
#include "base/message_text.h"
#include "base/plural.h"

#include <inttypes.h>
#include <math.h>
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

/* ---- binary ------------------------------------------------------------------------------------------- */

/* One row with lists, property by property. `values`: Optional. */
static BpStatus take_row(Input *input, const PlyHeader *header, const PlyElement *element, uint64_t row,
                         double *values, BpError *err) {
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
        if (!input_skip(input, (uint64_t)number * ply_type_size(p->type)))
            return input_fail(input, false, err,
                              "found the end of the file in a list of row %" PRIu64
                              " (from 0); the file is truncated",
                              row);
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
            BP_TRY(take_row(input, header, element, row, NULL, err));
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

static BpStatus take_ascii(Input *input, const PlyHeader *header, const PlyElement *element, uint64_t row,
                           double *values, BpError *err) {
    char *line = NULL, shown[48];
    BP_TRY(input_full_line(input, &line, err));
    if (line == NULL)
        return input_fail(input, true, err,
                          "found the end of the file, expected row %" PRIu64 " of %" PRIu64
                          "; the file is truncated, or its header counts too many",
                          row, element->count);
    for (size_t i = 0; i < element->property_count; i++) {
        const PlyProperty *const p = &header->properties[element->first + i];
        double number = 0, ignored = 0;
        bool good = ply_parse_number(&line, &number);
        if (good && p->count_type != PLY_NONE) {
            if (!(number >= 0 && number == floor(number))) return fail_length(input, true, row, number, err);
            for (double k = 0; good && k < number; k++) good = ply_parse_number(&line, &ignored);
        }
        values[i] = number;
        if (good) continue;
        bp_printable(line + strspn(line, " \t"), shown, sizeof shown);
        return input_fail(input, true, err,
                          "vertex %" PRIu64 " (from 0): found \"%s\", expected a number for each of %zu "
                          "properties",
                          row, shown, element->property_count);
    }
    if (line[strspn(line, " \t\r")] == '\0') return BP_OK;
    return input_fail(input, true, err,
                      "vertex %" PRIu64 " (from 0): found more than %zu numbers, expected one for each "
                      "property",
                      row, element->property_count);
}

/* ---- the whole ---------------------------------------------------------------------------------------- */

static BpStatus skip(Input *input, const PlyHeader *header, size_t element, BpError *err) {
    return header->form == PLY_ASCII ? skip_ascii(input, &header->elements[element], err)
                                     : skip_binary(input, header, &header->elements[element], err);
}

BpStatus ply_begin_points(Input *input, const PlyHeader *header, BpError *err) {
    for (size_t i = 0; i < header->vertex; i++) BP_TRY(skip(input, header, i, err));
    return BP_OK;
}

BpStatus ply_take_point(Input *input, const PlyHeader *header, uint64_t row, double *values, BpError *err) {
    const PlyElement *const element = &header->elements[header->vertex];
    return header->form == PLY_ASCII ? take_ascii(input, header, element, row, values, err)
           : element->has_list       ? take_row(input, header, element, row, values, err)
                                     : take_plain_row(input, header, element, row, values, err);
}

static BpStatus expect_end(Input *input, bool lines, BpError *err) {
    static const char remedy[] =
        "expected the end of the file: correct the counts in its header, or remove what follows";
    const uint64_t here = input->taken;
    if (lines) {
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
    for (size_t i = header->vertex + 1; i < header->element_count; i++) BP_TRY(skip(input, header, i, err));
    return expect_end(input, header->form == PLY_ASCII, err);
}
