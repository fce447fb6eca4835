/* ply_header.c: see ply_header.h. */
#include "ply_header.h"

#include "base/words.h"
#include "column_names.h"

#include "base/message_text.h"

#include <limits.h>
#include <string.h>

enum { WORDS_MAX = 6 };

static BpStatus parse_type(const Input *input, const char *word, PlyType *type, BpError *err) {
    char shown[48];
    *type = ply_type_named(word);
    if (*type != PLY_NONE) return BP_OK;
    const char *const nearest = bp_nearest_name(word, ply_type_names, PLY_TYPE_NAMES);
    bp_printable(word, shown, sizeof shown);
    return input_fail(input, true, err,
                      "found the type \"%s\", expected a PLY type such as float, uchar or int%s%s%s", shown,
                      nearest != NULL ? "; did you mean " : "", nearest != NULL ? nearest : "",
                      nearest != NULL ? "?" : "");
}

#define FORM_WORDS(X)                                                                                        \
    X(PLY_ASCII, "ascii")                                                                                    \
    X(PLY_LITTLE_ENDIAN, "binary_little_endian")                                                             \
    X(PLY_BIG_ENDIAN, "binary_big_"                                                                          \
                      "endian")
BP_WORDS(PlyForm, static const char *const form_names, FORM_WORDS);

static BpStatus parse_format(const Input *input, char **words, size_t count, PlyHeader *header,
                             BpError *err) {
    const uint16_t one = 1;
    unsigned char first = 0;
    memcpy(&first, &one, 1);
    for (int i = 0; count == 3 && i < 3; i++) {
        if (strcmp(words[1], form_names[i]) != 0 || strcmp(words[2], "1.0") != 0) continue;
        header->form = (PlyForm)i;
        header->swap = header->form == (first == 1 ? PLY_BIG_ENDIAN : PLY_LITTLE_ENDIAN);
        return BP_OK;
    }
    return input_fail(input, true, err,
                      "found another format, expected \"format\" and ascii, binary_little_endian or "
                      "binary_big_endian, and 1.0");
}

static BpStatus parse_element(const Input *input, char **words, size_t count, PlyHeader *header,
                              BpError *err) {
    int64_t rows = -1;
    if (count != 3 || !word_whole(words[2], &rows) || rows < 0)
        return input_fail(input, true, err,
                          "found an element without a count, expected \"element NAME COUNT\"");
    if (header->element_count == PLY_ELEMENTS_MAX)
        return input_fail(input, true, err, "found more than %d elements, expected fewer", PLY_ELEMENTS_MAX);
    if (strcmp(words[1], "vertex") == 0) {
        if (header->vertex < header->element_count)
            return input_fail(input, true, err, "found the element vertex a second time, expected it once");
        header->vertex = header->element_count;
    } else if (header->vertex == header->element_count) {
        header->vertex++; /* not seen yet: always one past the last */
    }
    const bool strips = strcmp(words[1], "tristrips") == 0;
    header->elements[header->element_count++] = (PlyElement){.count = (uint64_t)rows,
                                                             .first = header->property_count,
                                                             .faces = strips || strcmp(words[1], "face") == 0,
                                                             .strips = strips};
    return BP_OK;
}

static BpStatus parse_property(const Input *input, char **words, size_t count, PlyHeader *header,
                               BpError *err) {
    const bool list = count == 5 && strcmp(words[1], "list") == 0;
    if (!list && count != 3)
        return input_fail(input, true, err,
                          "found a property of another form, expected \"property TYPE NAME\" or "
                          "\"property list TYPE TYPE NAME\"");
    if (header->element_count == 0)
        return input_fail(input, true, err,
                          "found a property before any element, expected \"element NAME COUNT\" first");
    if (header->property_count == PLY_PROPERTIES_MAX)
        return input_fail(input, true, err, "found more than %d properties, expected fewer",
                          PLY_PROPERTIES_MAX);
    PlyElement *const element = &header->elements[header->element_count - 1];
    PlyProperty property = {.line = input->line};
    BP_TRY(parse_type(input, words[list ? 3 : 1], &property.type, err));
    if (list) {
        BP_TRY(parse_type(input, words[2], &property.count_type, err));
        if (!ply_is_integer(property.count_type))
            return input_fail(input, true, err,
                              "found a list whose length has a fraction, expected an integer type");
        element->has_list = true;
    }
    snprintf(property.name, sizeof property.name, "%s", words[count - 1]);
    header->properties[header->property_count++] = property;
    element->property_count++;
    element->row_size += ply_type_size(list ? property.count_type : property.type);
    return BP_OK;
}

static BpStatus fail_property(const Input *input, const PlyProperty *property, const char *text,
                              BpError *err) {
    char shown[PLY_NAME_SIZE];
    bp_printable(property->name, shown, sizeof shown);
    const BpStatus status = bp_fail(err, BP_ERR_SCENE, "%s: %s", shown, text);
    bp_error_at(err, input->name, property->line < INT_MAX ? (int)property->line : INT_MAX, 0);
    return status;
}

BpStatus ply_find_property(const Input *input, const PlyHeader *header, const char *name, int *place,
                           BpError *err) {
    *place = -1;
    for (size_t i = 0; i < header->elements[header->vertex].property_count; i++) {
        const PlyProperty *const property = ply_property(header, (int)i);
        if (strcmp(property->name, name) != 0) continue;
        if (property->count_type != PLY_NONE)
            return fail_property(input, property, "found a list, expected one number", err);
        if (*place >= 0) return fail_property(input, property, "found a second time, expected once", err);
        *place = (int)i;
    }
    return BP_OK;
}

/* The names of the points' properties that are one number, "" for lists; returns how many there are. */
static size_t list_names(const PlyHeader *header, const char *names[PLY_PROPERTIES_MAX]) {
    const size_t count = header->elements[header->vertex].property_count;
    for (size_t i = 0; i < count; i++) {
        const PlyProperty *const property = ply_property(header, (int)i);
        names[i] = property->count_type == PLY_NONE ? property->name : "";
    }
    return count;
}

static BpStatus find_colors(const Input *input, PlyHeader *header, BpError *err) {
    static const char *const words[3] = {"red", "green", "blue"};
    const char *names[PLY_PROPERTIES_MAX];
    const size_t count = list_names(header, names);
    int *const color = header->color, named[3];
    const bool found = column_find_color(names, count, color);
    for (int c = 0; c < 3; c++) {
        BP_TRY(ply_find_property(input, header, words[c], &named[c], err));
        if (!found) color[c] = -1;
    }
    const PlyType type = found ? ply_property(header, color[0])->type : PLY_NONE;
    const bool alike =
        found && type == ply_property(header, color[1])->type && type == ply_property(header, color[2])->type;
    if ((found && !alike) || (!found && (named[0] >= 0 || named[1] >= 0 || named[2] >= 0)))
        return input_fail(input, true, err,
                          "found only some of red, green and blue, or of different types, expected all three "
                          "of one type, or none");
    return BP_OK;
}

ColorRange ply_color_range(const PlyHeader *header) {
    const PlyType type = ply_property(header, header->color[0])->type;
    return (ColorRange){.bytes = type == PLY_UINT8, .ambiguous = ply_is_integer(type)};
}

/* The property of that name, or else the one property that has it in letters of either case. */
static BpStatus find_number(const Input *input, const PlyHeader *header, const char *name, int *place,
                            BpError *err) {
    const char *names[PLY_PROPERTIES_MAX];
    BP_TRY(ply_find_property(input, header, name, place, err));
    if (*place < 0) *place = column_named(names, list_names(header, names), name);
    if (*place == COLUMN_TWICE)
        return input_fail(input, true, err, "found %s in two properties, expected one", name);
    return BP_OK;
}

static BpStatus find_roles(const Input *input, PlyHeader *header, BpError *err) {
    static const char *const axes[3] = {"x", "y", "z"};
    if (header->vertex >= header->element_count)
        return input_fail(input, true, err, "found no element vertex, expected one: the points");
    for (int i = 0; i < 3; i++) BP_TRY(find_number(input, header, axes[i], &header->place[i], err));
    for (int i = 0; i < 3; i++)
        if (header->place[i] < 0)
            return input_fail(input, true, err, "found no property %s of the vertices, expected x, y and z",
                              axes[i]);
    header->radius_scale = 1;
    BP_TRY(find_number(input, header, "radius", &header->radius, err));
    if (header->radius < 0) {
        BP_TRY(find_number(input, header, "diameter", &header->radius, err));
        header->radius_scale = 0.5;
    }
    return find_colors(input, header, err);
}

BpStatus ply_read_header(Input *input, PlyHeader *header, BpError *err) {
    char *line = NULL, *words[WORDS_MAX];
    bool has_format = false;
    memset(header, 0, sizeof *header);
    BP_TRY(input_needed_line(input, &line, "\"ply\", the first line of a PLY file", err));
    if (split_words(line, words, WORDS_MAX) != 1 || strcmp(words[0], "ply") != 0)
        return input_fail(input, true, err,
                          "found another first line, expected \"ply\": this is no PLY file");
    for (;;) {
        BP_TRY(input_needed_line(input, &line, "the header's other lines, to end_header", err));
        const size_t count = split_words(line, words, WORDS_MAX);
        if (count == 0 || strcmp(words[0], "comment") == 0 || strcmp(words[0], "obj_info") == 0) continue;
        if (strcmp(words[0], "end_header") == 0) break;
        if (strcmp(words[0], "format") == 0) {
            BP_TRY(parse_format(input, words, count, header, err));
            has_format = true;
        } else if (strcmp(words[0], "element") == 0) {
            BP_TRY(parse_element(input, words, count, header, err));
        } else if (strcmp(words[0], "property") == 0) {
            BP_TRY(parse_property(input, words, count, header, err));
        } else {
            return input_wrong(input, words[0], "format, comment, element, property or end_header", err);
        }
    }
    if (!has_format)
        return input_fail(input, true, err, "found no format, expected a line such as \"format ascii 1.0\"");
    return find_roles(input, header, err);
}
