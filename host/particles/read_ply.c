/* read_ply.c: the points of a PLY file, ASCII or binary; see reader.h.
 *
 * The clouds of scene documents are read by formats/ply.c, straight into spheres. This reader hands over what
 * that one has no use for: every property by its name, for colours and radii, and gzip. */
#include "reader.h"

#include "base/color.h"
#include "ply_type.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

enum { WORDS_MAX = 6, ELEMENTS_MAX = 32 };

typedef struct Property {
    char name[32];
    PlyType type, count_type; /* count_type: of a list's length; PLY_NONE: one number */
} Property;

typedef struct Element {
    uint64_t count;
    size_t first, property_count;
    bool vertex;
} Element;

typedef enum Form { ASCII, LITTLE, BIG } Form;

typedef struct Ply {
    Form form;
    bool swap;
    Element elements[ELEMENTS_MAX];
    size_t element_count;
    Property properties[BP_PARTICLE_COLUMNS_MAX];
    size_t property_count;
    int x, y, z, radius, red, green, blue; /* among the vertices' properties */
    double linear[256];                    /* of each 8-bit colour */
} Ply;

static BpStatus take_property(const Input *input, char **words, size_t count, Ply *ply, BpError *err) {
    const bool list = count == 5 && strcmp(words[1], "list") == 0;
    if ((!list && count != 3) || ply->element_count == 0)
        return input_fail(
            input, true, err,
            "found a property of another form or before any element, expected \"property TYPE NAME\" "
            "or \"property list TYPE TYPE NAME\"");
    if (ply->property_count == BP_PARTICLE_COLUMNS_MAX)
        return input_fail(input, true, err, "found more than %d properties, expected fewer",
                          BP_PARTICLE_COLUMNS_MAX);
    Property *const property = &ply->properties[ply->property_count];
    *property = (Property){.type = ply_type_named(words[list ? 3 : 1])};
    if (list) property->count_type = ply_type_named(words[2]);
    if (property->type == PLY_NONE ||
        (list && (property->count_type == PLY_NONE || property->count_type >= PLY_FLOAT32)))
        return input_wrong(input, words[list ? 2 : 1], "a PLY type such as float, uchar or int", err);
    snprintf(property->name, sizeof property->name, "%s", words[count - 1]);
    ply->property_count++;
    ply->elements[ply->element_count - 1].property_count++;
    return BP_OK;
}

static BpStatus take_element(const Input *input, char **words, size_t count, Ply *ply, BpError *err) {
    Element element = {.first = ply->property_count};
    if (count != 3 || ply->element_count == ELEMENTS_MAX)
        return input_fail(input, true, err,
                          "found another element, expected \"element NAME COUNT\", at most %d", ELEMENTS_MAX);
    element.vertex = strcmp(words[1], "vertex") == 0;
    BP_TRY(word_count(input, words[2], "rows", &element.count, err));
    ply->elements[ply->element_count++] = element;
    return BP_OK;
}

static BpStatus take_header(Input *input, Ply *ply, BpError *err) {
    static const char *const forms[] = {"ascii", "binary_little_endian", "binary_big_endian"};
    char *line = NULL, *words[WORDS_MAX];
    bool has_form = false;
    BP_TRY(input_needed_line(input, &line, "\"ply\"", err));
    if (strcmp(line, "ply") != 0)
        return input_wrong(input, line, "\"ply\", the first line of a PLY file", err);
    for (;;) {
        BP_TRY(input_needed_line(input, &line, "end_header", err));
        const size_t count = split_words(line, words, WORDS_MAX);
        if (count == 0 || strcmp(words[0], "comment") == 0 || strcmp(words[0], "obj_info") == 0) continue;
        if (strcmp(words[0], "end_header") == 0) break;
        if (strcmp(words[0], "format") == 0 && count == 3) {
            for (int f = 0; f < 3; f++) {
                if (strcmp(words[1], forms[f]) != 0) continue;
                ply->form = (Form)f;
                has_form = true;
            }
        } else if (strcmp(words[0], "element") == 0) {
            BP_TRY(take_element(input, words, count, ply, err));
        } else if (strcmp(words[0], "property") == 0) {
            BP_TRY(take_property(input, words, count, ply, err));
        } else {
            return input_wrong(input, words[0], "format, comment, element, property or end_header", err);
        }
    }
    if (!has_form)
        return input_fail(input, true, err,
                          "found no format that is known, expected ascii, binary_little_endian or "
                          "binary_big_endian, and 1.0");
    const uint16_t one = 1;
    unsigned char first = 0;
    memcpy(&first, &one, 1);
    ply->swap = ply->form == (first == 1 ? BIG : LITTLE);
    return BP_OK;
}

/* The place of a property that is one number; -1: none. */
static int property_named(const Ply *ply, const Element *element, const char *name) {
    for (size_t i = 0; i < element->property_count; i++) {
        const Property *const p = &ply->properties[element->first + i];
        if (strcmp(p->name, name) == 0 && p->count_type == PLY_NONE) return (int)i;
    }
    return -1;
}

/* Reads one row, binary or ASCII; `values` gets its single numbers, by property. */
static BpStatus take_row(Input *input, const Ply *ply, const Element *element, uint64_t row, double *values,
                         BpError *err) {
    char *line = NULL, *word = NULL, *rest = NULL;
    if (element->property_count == 0) return BP_OK;
    if (ply->form == ASCII) {
        BP_TRY(input_full_line(input, &line, err));
        if (line == NULL)
            return input_fail(input, true, err,
                              "found the end of the file, expected row %" PRIu64 " of %" PRIu64, row,
                              element->count);
    }
    for (size_t i = 0; i < element->property_count; i++) {
        const Property *const p = &ply->properties[element->first + i];
        const PlyType type = p->count_type != PLY_NONE ? p->count_type : p->type;
        const size_t size = ply_type_size(type);
        double number = 0;
        if (ply->form == ASCII) {
            word = strtok_r(i == 0 ? line : NULL, " \t\r", &rest);
            if (word == NULL)
                return input_fail(input, true, err, "found too few numbers, expected one for each property");
            if (!word_number(word, &number) && p->count_type != PLY_NONE)
                return input_wrong(input, word, "the length of a list", err);
            if (!word_number(word, &number)) number = NAN;
        } else {
            if (!input_fill(input, size))
                return input_fail(input, false, err,
                                  "found the end of the file in row %" PRIu64 " of %" PRIu64
                                  ", expected all rows",
                                  row, element->count);
            number = ply_decode(input->buffer + input->begin, type, ply->swap);
            input_take(input, size);
        }
        values[i] = number;
        if (p->count_type == PLY_NONE) continue;
        if (!(number >= 0 && number == floor(number)))
            return input_fail(
                input, ply->form == ASCII, err,
                "found another length of a list in row %" PRIu64 ", expected a whole number from 0", row);
        if (ply->form != ASCII) {
            if (!input_skip(input, (uint64_t)number * ply_type_size(p->type)))
                return input_fail(input, false, err, "found the end of the file in a list of row %" PRIu64,
                                  row);
            continue;
        }
        for (double k = 0; k < number; k++)
            if (strtok_r(NULL, " \t\r", &rest) == NULL)
                return input_fail(input, true, err, "found too few numbers, expected a list's");
    }
    return BP_OK;
}

/* The bytes of a binary row without lists; 0: it has one. */
static size_t row_size(const Ply *ply, const Element *element) {
    size_t size = 0;
    for (size_t i = 0; i < element->property_count; i++) {
        const Property *const p = &ply->properties[element->first + i];
        if (p->count_type != PLY_NONE) return 0;
        size += ply_type_size(p->type);
    }
    return size;
}

/* The same as take_row() for a binary row of `size` bytes without lists, of which files have millions. */
static BpStatus take_plain_row(Input *input, const Ply *ply, const Element *element, uint64_t row,
                               size_t size, double *values, BpError *err) {
    if (!input_fill(input, size)) return take_row(input, ply, element, row, values, err); /* says why not */
    const unsigned char *at = input->buffer + input->begin;
    for (size_t i = 0; i < element->property_count; i++) {
        const PlyType type = ply->properties[element->first + i].type;
        values[i] = ply_decode(at, type, ply->swap);
        at += ply_type_size(type);
    }
    input_take(input, size);
    return BP_OK;
}

static BpStatus add_vertex(BpParticleFile *file, const Ply *ply, const Element *element, const double *values,
                           BpError *err) {
    Particle particle = PARTICLE_NONE;
    const int places[3] = {ply->x, ply->y, ply->z}, colors[3] = {ply->red, ply->green, ply->blue};
    const bool with_line = ply->form == ASCII;
    for (int i = 0; i < 3; i++) {
        particle.position[i] = values[places[i]];
        if (colors[i] < 0) continue;
        const double value = values[colors[i]];
        const bool bytes = ply->properties[element->first + (size_t)colors[i]].type == PLY_UINT8;
        particle.color[i] = !bytes               ? value
                            : ply->form == ASCII ? bp_linear_from_srgb(value / 255) /* perhaps no byte */
                                                 : ply->linear[(int)value];
        if (!(particle.color[i] >= 0 && particle.color[i] <= 1))
            return input_fail(
                &file->input, with_line, err,
                "particle %zu (from 0): found a colour outside 0 to 1, expected uchar (8-bit sRGB) or "
                "float (linear)",
                file->added);
    }
    if (ply->radius >= 0) particle.radius = values[ply->radius];
    particle.values = values;
    return frame_add(file, &particle, with_line, err);
}

static BpStatus take_vertices(BpParticleFile *file, Ply *ply, const Element *element, BpError *err) {
    const char *names[BP_PARTICLE_COLUMNS_MAX];
    double values[BP_PARTICLE_COLUMNS_MAX];
    for (size_t i = 0; i < element->property_count; i++) names[i] = ply->properties[element->first + i].name;
    ply->x = property_named(ply, element, "x");
    ply->y = property_named(ply, element, "y");
    ply->z = property_named(ply, element, "z");
    ply->radius = property_named(ply, element, "radius");
    ply->red = property_named(ply, element, "red");
    ply->green = property_named(ply, element, "green");
    ply->blue = property_named(ply, element, "blue");
    if (ply->green < 0 || ply->blue < 0) ply->red = -1;
    if (ply->red < 0) ply->green = ply->blue = -1;
    if (ply->x < 0 || ply->y < 0 || ply->z < 0)
        return input_fail(&file->input, false, err,
                          "found no x, y and z among the vertices, expected all three");
    bp_linear_of_bytes(ply->linear);
    BP_TRY(frame_begin(file, names, element->property_count, err));
    const size_t size = ply->form != ASCII ? row_size(ply, element) : 0;
    for (uint64_t row = 0; row < element->count; row++) {
        if (size > 0)
            BP_TRY(take_plain_row(&file->input, ply, element, row, size, values, err));
        else
            BP_TRY(take_row(&file->input, ply, element, row, values, err));
        BP_TRY(add_vertex(file, ply, element, values, err));
    }
    return BP_OK;
}

static BpStatus take_all(BpParticleFile *file, Ply *ply, BpError *err) {
    double ignored[BP_PARTICLE_COLUMNS_MAX];
    BP_TRY(take_header(&file->input, ply, err));
    for (size_t e = 0; e < ply->element_count; e++) {
        const Element *const element = &ply->elements[e];
        if (element->vertex) return take_vertices(file, ply, element, err);
        for (uint64_t row = 0; row < element->count && element->property_count > 0; row++)
            BP_TRY(take_row(&file->input, ply, element, row, ignored, err));
    }
    return input_fail(&file->input, false, err, "found no element vertex, expected one: the points");
}

BpStatus read_ply(BpParticleFile *file, bool *end, BpError *err) {
    *end = file->frame > 0;
    if (*end) return BP_OK;
    Ply *const ply = calloc(1, sizeof *ply);
    if (ply == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory");
    const BpStatus status = take_all(file, ply, err);
    free(ply);
    return status;
}
