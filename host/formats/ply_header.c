/* ply_header.c: the header of a PLY file; see ply_parts.h. */
#include "document.h"
#include "ply_parts.h"

#include <stdlib.h>
#include <string.h>

enum { WORDS_MAX = 6 };

static const char *const role_names[PLY_ROLE_COUNT] = {"x",   "y",     "z",    "radius",
                                                       "red", "green", "blue", "material"};

const char *ply_role_name(PlyRole role) {
    return role_names[role];
}

size_t ply_row_size(const PlyHeader *header, const PlyElement *element) {
    size_t size = 0;
    for (size_t i = 0; i < element->property_count; i++) {
        const PlyProperty *property = &header->properties[element->first_property + i];
        size += ply_type_size(property->count_type != PLY_NONE ? property->count_type : property->type);
    }
    return size;
}

static bool is_integer(PlyType type) {
    return type != PLY_NONE && type != PLY_FLOAT32 && type != PLY_FLOAT64;
}
static bool is_real(PlyType type) {
    return type == PLY_FLOAT32 || type == PLY_FLOAT64;
}

/* Splits at blanks; returns how many words there are, of which the first WORDS_MAX are in `words`. */
static size_t split(char *line, char *words[WORDS_MAX]) {
    size_t count = 0;
    char *rest = NULL;
    for (char *word = strtok_r(line, " \t", &rest); word != NULL; word = strtok_r(NULL, " \t", &rest)) {
        if (count < WORDS_MAX) words[count] = word;
        count++;
    }
    return count;
}

static BpStatus parse_type(const PlyInput *input, const char *word, PlyType *type, BpError *err) {
    char shown[48];
    *type = ply_type_named(word);
    if (*type != PLY_NONE) return BP_OK;
    const char *nearest = bp_nearest_name(word, ply_type_names, PLY_TYPE_NAMES);
    bp_printable(word, shown, sizeof shown);
    return ply_fail(input, true, err,
                    "found the type \"%s\", expected a PLY type such as float, uchar or int%s%s%s", shown,
                    nearest != NULL ? "; did you mean " : "", nearest != NULL ? nearest : "",
                    nearest != NULL ? "?" : "");
}

static BpStatus parse_format(const PlyInput *input, char **words, size_t count, PlyHeader *header,
                             BpError *err) {
    static const char *const names[] = {[PLY_ASCII] = "ascii",
                                        [PLY_LITTLE_ENDIAN] = "binary_little_endian",
                                        [PLY_BIG_ENDIAN] = "binary_big_endian"};
    for (size_t i = 0; count == 3 && i < BP_COUNT(names); i++) {
        if (strcmp(words[1], names[i]) != 0 || strcmp(words[2], "1.0") != 0) continue;
        header->format = (PlyFormat)i;
        return BP_OK;
    }
    return ply_fail(input, true, err,
                    "found another format, expected \"format\" and ascii, binary_little_endian or "
                    "binary_big_endian, and 1.0");
}

static BpStatus parse_element(const PlyInput *input, char **words, size_t count, PlyHeader *header,
                              BpError *err) {
    char *end = NULL;
    uint64_t rows = 0;
    if (count == 3 && words[2][0] >= '0' && words[2][0] <= '9') rows = strtoull(words[2], &end, 10);
    if (end == NULL || *end != '\0' || rows > INT64_MAX)
        return ply_fail(input, true, err,
                        "found an element without a count, expected \"element NAME COUNT\"");
    if (header->element_count == PLY_ELEMENTS_MAX)
        return ply_fail(input, true, err, "found more than %d elements, expected fewer", PLY_ELEMENTS_MAX);
    if (strcmp(words[1], "vertex") == 0) {
        if (header->vertex < header->element_count)
            return ply_fail(input, true, err, "found the element vertex a second time, expected it once");
        header->vertex = header->element_count;
    } else if (header->vertex == header->element_count) {
        header->vertex++; /* not seen yet: always one past the last */
    }
    header->elements[header->element_count++] =
        (PlyElement){.count = rows, .first_property = header->property_count};
    return BP_OK;
}

static BpStatus parse_role(const PlyInput *input, const PlyProperty *property, const char *name,
                           PlyHeader *header, PlyRole *role, BpError *err) {
    *role = PLY_NO_ROLE;
    for (size_t i = 0; i < PLY_ROLE_COUNT; i++) {
        if (strcmp(name, role_names[i]) == 0) *role = (PlyRole)i;
    }
    if (*role == PLY_NO_ROLE) return BP_OK;
    if (property->count_type != PLY_NONE)
        return ply_fail(input, true, err, "%s: found a list, expected one number", name);
    if (header->role_type[*role] != PLY_NONE)
        return ply_fail(input, true, err, "%s: found a second time, expected once", name);
    const bool colour = *role == PLY_RED || *role == PLY_GREEN || *role == PLY_BLUE;
    if (colour && !is_real(property->type) && property->type != PLY_UINT8)
        return ply_fail(
            input, true, err,
            "%s: found an integer type other than uchar, expected uchar (8-bit sRGB) or float (linear)",
            name);
    if (*role == PLY_MATERIAL && !is_integer(property->type))
        return ply_fail(input, true, err, "material: found a type with a fraction, expected an integer type");
    header->role_type[*role] = property->type;
    return BP_OK;
}

static BpStatus parse_property(const PlyInput *input, char **words, size_t count, PlyHeader *header,
                               BpError *err) {
    const bool list = count == 5 && strcmp(words[1], "list") == 0;
    if (!list && count != 3)
        return ply_fail(input, true, err,
                        "found a property of another form, expected \"property TYPE NAME\" or "
                        "\"property list TYPE TYPE NAME\"");
    if (header->element_count == 0)
        return ply_fail(input, true, err,
                        "found a property before any element, expected \"element NAME COUNT\" first");
    if (header->property_count == PLY_PROPERTIES_MAX)
        return ply_fail(input, true, err, "found more than %d properties, expected fewer",
                        PLY_PROPERTIES_MAX);
    PlyElement *element = &header->elements[header->element_count - 1];
    PlyProperty property = {.role = PLY_NO_ROLE};
    BP_TRY(parse_type(input, words[list ? 3 : 1], &property.type, err));
    if (list) {
        BP_TRY(parse_type(input, words[2], &property.count_type, err));
        if (!is_integer(property.count_type))
            return ply_fail(input, true, err,
                            "found a list whose length has a fraction, expected an integer type");
        element->has_list = true;
    }
    if (header->vertex == header->element_count - 1)
        BP_TRY(parse_role(input, &property, words[count - 1], header, &property.role, err));
    header->properties[header->property_count++] = property;
    element->property_count++;
    return BP_OK;
}

static BpStatus require_roles(const PlyInput *input, const PlyHeader *header, BpError *err) {
    const PlyType *type = header->role_type;
    if (header->vertex >= header->element_count)
        return ply_fail(input, true, err, "found no element vertex, expected one: the points");
    for (size_t i = PLY_X; i <= PLY_Z; i++) {
        if (type[i] == PLY_NONE)
            return ply_fail(input, true, err, "found no property %s of the vertices, expected x, y and z",
                            role_names[i]);
    }
    if (type[PLY_RED] != type[PLY_GREEN] || type[PLY_RED] != type[PLY_BLUE])
        return ply_fail(input, true, err,
                        "found red, green and blue not all, or not of one type, expected all three alike, "
                        "or none");
    return BP_OK;
}

BpStatus ply_read_header(PlyInput *input, PlyHeader *header, BpError *err) {
    char *line = NULL, *words[WORDS_MAX];
    bool has_format = false;
    memset(header, 0, sizeof *header);
    BP_TRY(ply_input_line(input, &line, err));
    if (strcmp(line, "ply") != 0)
        return ply_fail(input, true, err, "found another first line, expected \"ply\": this is no PLY file");
    for (;;) {
        BP_TRY(ply_input_line(input, &line, err));
        const size_t count = split(line, words);
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
            char shown[48];
            bp_printable(words[0], shown, sizeof shown);
            return ply_fail(input, true, err,
                            "found \"%s\", expected format, comment, element, property or end_header", shown);
        }
    }
    if (!has_format)
        return ply_fail(input, true, err, "found no format, expected a line such as \"format ascii 1.0\"");
    return require_roles(input, header, err);
}
