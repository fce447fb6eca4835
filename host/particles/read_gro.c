/* read_gro.c: GRO, the format of GROMACS; lengths are nanometres; see reader.h. */
#include "reader.h"

#include "base/plural.h"

#include <stdlib.h>
#include <string.h>

enum { POSITIONS = 21, USUAL_WIDTH = 8 }; /* the column of the first coordinate, the width of its field */

/* The width of the fields of numbers in a text: the distance of their points (the format's own rule), of
 * which the first three are looked at; 0: these are missing, or their distances differ. */
static size_t field_width(const char *text) {
    const char *const first = strchr(text, '.');
    const char *const second = first != NULL ? strchr(first + 1, '.') : NULL;
    const char *const third = second != NULL ? strchr(second + 1, '.') : NULL;
    const size_t width = third != NULL ? (size_t)(second - first) : 0;
    return width >= 3 && width <= 24 && third == second + width ? width : 0;
}

/* What is found in the lines of a frame. */
typedef struct Frame {
    size_t width;      /* of the coordinates' fields, as in its first line */
    size_t unreadable; /* atoms with something else in place of velocities */
} Frame;

/* Three numbers in fields, or NaN where there is said to be none; returns how many fields from the first on
 * hold one. */
static size_t take_fields(const char *line, size_t first, size_t width, double values[3]) {
    const size_t length = strlen(line);
    for (size_t i = 0; i < 3; i++) {
        char text[32];
        fixed_text(line, length, first + width * i, first + width * (i + 1) - 1, text, sizeof text);
        if (!word_number_or_none(text, &values[i])) return i;
    }
    return 3;
}

/* Whether the line has three coordinates in fields of the usual width, not all of which are numbers: points
 * of others tell the width. */
static bool lacks_place(const char *line) {
    double place[3];
    return take_fields(line, POSITIONS, USUAL_WIDTH, place) == 3 &&
           (isnan(place[0]) || isnan(place[1]) || isnan(place[2]));
}

/* Whether the digits of the last coordinate go on in the field behind it: then a number before was too long,
 * and moved all that follow. Digits of a velocity may touch, of which up to three stand
 * before its point. */
static bool goes_on(const char *line, size_t width) {
    static const char digits[] = "0123456789";
    const size_t end = POSITIONS - 1 + 3 * width;
    if (strlen(line) <= end || strchr(digits, line[end - 1]) == NULL) return false;
    const size_t more = strspn(line + end, digits);
    return more > 0 && (line[end + more] != '.' || more > 3);
}

/* Velocities have one digit more behind the point in fields of the same width; programs of other authors make
 * them wider. */
static void take_velocities(const char *line, Frame *frame, double values[3]) {
    const size_t begin = POSITIONS - 1 + 3 * frame->width;
    double found[3];
    if (strlen(line) <= begin || line[begin + strspn(line + begin, " \t\r")] == '\0') return;
    const size_t width = field_width(line + begin);
    if (take_fields(line, begin + 1, width > 0 ? width : frame->width, found) == 3)
        memcpy(values, found, sizeof found);
    else
        frame->unreadable++;
}

static BpStatus take_atom(BpParticleFile *file, const char *line, Frame *frame, BpError *err) {
    const size_t length = strlen(line);
    char residue[8], name[8];
    double values[4] = {NAN, NAN, NAN, NAN};
    Particle particle = PARTICLE_NONE;
    const size_t good = take_fields(line, POSITIONS, frame->width, particle.position);
    if (good == 3 && goes_on(line, frame->width))
        return input_wrong(&file->input, line + POSITIONS - 1, "coordinates that fit into their columns",
                           err);
    if (good < 3) {
        char found[32];
        fixed_text(line, length, POSITIONS + good * frame->width, POSITIONS + (good + 1) * frame->width - 1,
                   found, sizeof found);
        return input_wrong(&file->input, found, "a coordinate in nanometres", err);
    }
    take_velocities(line, frame, values);
    double number = 0;
    char text[8];
    if (word_number(fixed_text(line, length, 1, 5, text, sizeof text), &number)) values[3] = number;
    particle.residue = fixed_text(line, length, 6, 10, residue, sizeof residue);
    particle.name = fixed_text(line, length, 11, 15, name, sizeof name);
    atom_identify(&particle, "", name, false);
    particle.values = values;
    return frame_add(file, &particle, true, err);
}

static bool is_blank(const char *line) {
    return line[strspn(line, " \t\r")] == '\0';
}

/* Three or nine numbers, between blanks or, where they touch, in fields of one width. */
static BpStatus take_box(const Input *input, const char *line, double box[9], BpError *err) {
    static const char expected[] = "the box: 3 or 9 numbers";
    char text[256], *words[9];
    if (is_blank(line)) return BP_OK; /* as programs write it where there is none */
    snprintf(text, sizeof text, "%s", line);
    const size_t count = split_words(text, words, 9), width = field_width(line);
    if (count == 3 || count == 9) {
        for (size_t i = 0; i < count; i++)
            if (!word_number(words[i], &box[i])) return input_wrong(input, words[i], expected, err);
        return BP_OK;
    }
    const size_t length = strlen(line);
    const bool nine =
        width > 0 && length > 3 * width && line[3 * width + strspn(line + 3 * width, " \t\r")] != '\0';
    for (size_t i = 0; i < (nine ? 9 : 3); i += 3)
        if (width == 0 || take_fields(line, 1 + width * i, width, &box[i]) < 3)
            return input_wrong(input, line, expected, err);
    return BP_OK;
}

static bool is_whole(const char *line) {
    char text[32], *words[2];
    int64_t value = 0;
    snprintf(text, sizeof text, "%s", line);
    return split_words(text, words, 2) == 1 && word_whole(words[0], &value);
}

/* The title and the number of atoms. The title may be empty: the line before the number is the title, and
 * blank lines before that belong to nothing. *end: the file ends before any title. */
static BpStatus take_head(Input *input, bool *end, uint64_t *count, BpError *err) {
    char *line = NULL, *words[2];
    bool blank = true;
    BP_TRY(input_line(input, &line, err));
    *end = line == NULL;
    while (line != NULL && blank) {
        blank = is_blank(line);
        BP_TRY(input_line(input, &line, err));
        *end = blank && line == NULL;
        if (line != NULL && is_whole(line)) break;
    }
    if (*end) return BP_OK;
    if (line == NULL)
        return input_fail(input, true, err, "found the end of the file, expected the number of atoms");
    const size_t found = split_words(line, words, 2);
    return word_count(input, found == 1 ? words[0] : "other words", "atoms", count, err);
}

BpStatus read_gro(BpParticleFile *file, bool *end, BpError *err) {
    static const char *const columns[] = {"vx", "vy", "vz", "residue_number"};
    static const double origin[3] = {0, 0, 0};
    Input *const input = &file->input;
    char *line = NULL;
    uint64_t count = 0;
    BP_TRY(take_head(input, end, &count, err));
    if (*end && file->frame == 0)
        return input_fail(input, true, err, "found the end of the file, expected the title of a GRO file");
    if (*end) return BP_OK;
    BP_TRY(frame_begin(file, columns, 4, err));
    if (file->out != NULL) {
        file->out->angstrom = 0.1;
        file->out->up = 2;
    }
    Frame frame = {0};
    size_t width = 0; /* as the first line with a place has it */
    for (uint64_t i = 0; i < count; i++) {
        BP_TRY(input_needed_line(input, &line, "as many atoms as the count says", err));
        if (width == 0 && strlen(line) >= POSITIONS) width = field_width(line + POSITIONS - 1);
        frame.width = width > 0 ? width : lacks_place(line) ? USUAL_WIDTH : 0;
        if (frame.width == 0)
            return input_wrong(input, line, "an atom's line of fixed columns, with points at equal distances",
                               err);
        BP_TRY(take_atom(file, line, &frame, err));
    }
    if (frame.unreadable > 0 && file->out != NULL)
        bp_particles_note(file->out, "%zu atom%s without readable velocities", frame.unreadable,
                          bp_plural(frame.unreadable));
    BP_TRY(input_needed_line(input, &line, "the line of the box after the atoms", err));
    double box[9] = {0};
    BP_TRY(take_box(input, line, box, err));
    /* v1x v2y v3z v1y v1z v2x v2z v3x v3y */
    const double edges[3][3] = {{box[0], box[3], box[4]}, {box[5], box[1], box[6]}, {box[7], box[8], box[2]}};
    frame_cell(file, origin, edges, FRAME_PERIODIC);
    return BP_OK;
}
