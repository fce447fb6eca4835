/* read_gro.c: GRO, the format of GROMACS; lengths are nanometres; see reader.h. */
#include "elements.h"
#include "reader.h"

#include <stdlib.h>
#include <string.h>

/* The width of a coordinate's field: the distance between the first two points (the format's own rule); 0:
 * the line has none. */
static size_t field_width(const char *line) {
    const char *const first = strlen(line) > 20 ? strchr(line + 20, '.') : NULL;
    const char *const second = first != NULL ? strchr(first + 1, '.') : NULL;
    const size_t width = second != NULL ? (size_t)(second - first) : 0;
    return width >= 3 && width <= 24 ? width : 0;
}

static BpStatus take_atom(BpParticleFile *file, const char *line, size_t width, BpError *err) {
    const size_t length = strlen(line);
    char residue[8], name[8];
    double values[4] = {NAN, NAN, NAN, NAN};
    Particle particle = PARTICLE_NONE;
    for (size_t i = 0; i < 6; i++) {
        char text[32];
        const size_t first = 21 + width * i + (i < 3 ? 0 : i - 3);
        const size_t last = first + width - 1 + (i < 3 ? 0 : 1);
        double value = 0;
        const bool good = word_number(fixed_text(line, length, first, last, text, sizeof text), &value);
        if (!good && i < 3) return input_wrong(&file->input, text, "a coordinate in nanometres", err);
        if (i < 3)
            particle.position[i] = value;
        else if (good)
            values[i - 3] = value;
    }
    double number = 0;
    char text[8];
    if (word_number(fixed_text(line, length, 1, 5, text, sizeof text), &number)) values[3] = number;
    particle.residue = fixed_text(line, length, 6, 10, residue, sizeof residue);
    particle.name = fixed_text(line, length, 11, 15, name, sizeof name);
    atom_identify(&particle, "", name, false);
    particle.values = values;
    return frame_add(file, &particle, true, err);
}

/* Three or nine numbers, between blanks or, where they touch, ten columns each. */
static BpStatus take_box(const Input *input, char *line, double box[9], BpError *err) {
    static const char expected[] = "the box: 3 or 9 numbers";
    char text[128], *words[9], field[16];
    snprintf(text, sizeof text, "%s", line);
    const size_t count = split_words(text, words, 9), length = strlen(line);
    if (count == 3 || count == 9) {
        for (size_t i = 0; i < count; i++)
            if (!word_number(words[i], &box[i])) return input_wrong(input, words[i], expected, err);
        return BP_OK;
    }
    if (length < 30 || length > 110) return input_wrong(input, line, expected, err);
    for (size_t i = 0; i < (length < 90 ? 3 : 9); i++)
        if (!word_number(fixed_text(line, length, 10 * i + 1, 10 * i + 10, field, sizeof field), &box[i]))
            return input_wrong(input, line, expected, err);
    return BP_OK;
}

BpStatus read_gro(BpParticleFile *file, bool *end, BpError *err) {
    static const char *const columns[] = {"vx", "vy", "vz", "residue_number"};
    static const double origin[3] = {0, 0, 0};
    Input *const input = &file->input;
    char *line = NULL, *words[2];
    uint64_t count = 0;
    BP_TRY(file->frame > 0 ? input_full_line(input, &line, err)
                           : input_needed_line(input, &line, "the title of a GRO file", err));
    *end = line == NULL;
    if (*end) return BP_OK;
    BP_TRY(input_needed_line(input, &line, "the number of atoms", err));
    const size_t found = split_words(line, words, 2);
    BP_TRY(word_count(input, found == 1 ? words[0] : "other words", "atoms", &count, err));
    BP_TRY(frame_begin(file, columns, 4, err));
    if (file->out != NULL) {
        file->out->angstrom = 0.1;
        file->out->up = 2;
    }
    size_t width = 0;
    for (uint64_t i = 0; i < count; i++) {
        BP_TRY(input_needed_line(input, &line, "as many atoms as the count says", err));
        if (width == 0) width = field_width(line);
        if (width == 0) return input_wrong(input, line, "an atom's line of fixed columns", err);
        BP_TRY(take_atom(file, line, width, err));
    }
    BP_TRY(input_needed_line(input, &line, "the line of the box after the atoms", err));
    double box[9] = {0};
    BP_TRY(take_box(input, line, box, err));
    /* v1x v2y v3z v1y v1z v2x v2z v3x v3y */
    const double edges[3][3] = {{box[0], box[3], box[4]}, {box[5], box[1], box[6]}, {box[7], box[8], box[2]}};
    frame_cell(file, origin, edges, FRAME_PERIODIC);
    return BP_OK;
}
