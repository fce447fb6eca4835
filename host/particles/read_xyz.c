/* read_xyz.c: XYZ, plain and extended (the key Properties in the second line); see reader.h.
 *
 * Knows: the format.   Does not know: what becomes of the points. */
#include "elements.h"
#include "reader.h"

#include "base/decimal.h"

#include <stdlib.h>
#include <string.h>

enum { WORDS_MAX = 160, KEY_SIZE = 4096 };

typedef enum Role { SPECIES, POSITION, RADIUS, COLOR, NUMBER, SHAPE, ATOM_NAME, RESIDUE, OTHER } Role;

typedef struct Layout {
    struct {
        Role role;
        int words;
    } property[WORDS_MAX];
    size_t property_count, word_count;
    char column[BP_PARTICLE_COLUMNS_MAX][96]; /* longer than any that can be wanted */
    const char *columns[BP_PARTICLE_COLUMNS_MAX];
    int column_word[BP_PARTICLE_COLUMNS_MAX];
    size_t column_count;
    bool extended;
    uint64_t ellipsoids;
} Layout;

/* The value of a key in an extended comment (key=value or key="value"); false: it has none. */
static bool find_key(const char *comment, const char *key, char *value) {
    const size_t length = strlen(key);
    bool quoted = false;
    for (const char *c = comment; *c != '\0'; c++) {
        if (*c == '"') quoted = !quoted;
        if (quoted || strncmp(c, key, length) != 0 || c[length] != '=') continue;
        if (c != comment && c[-1] != ' ' && c[-1] != '\t') continue;
        c += length + 1;
        const bool quote = *c == '"';
        c += quote;
        size_t count = 0;
        while (*c != '\0' && (quote ? *c != '"' : *c != ' ' && *c != '\t') && count < KEY_SIZE - 1)
            value[count++] = *c++;
        value[count] = '\0';
        return true;
    }
    return false;
}

/* Reads up to `max` numbers; returns how many there were before anything else. */
static int numbers_of(const char *text, double *numbers, int max) {
    int count = 0;
    for (;;) {
        while (*text == ' ' || *text == '\t' || *text == ',' || *text == '[' || *text == ']') text++;
        if (*text == '\0' || count == max) return count;
        text = bp_decimal_parse(text, &numbers[count]);
        if (text == NULL || !isfinite(numbers[count])) return count;
        count++;
    }
}

static void add_column(Layout *layout, const char *name, const char *suffix, int word) {
    if (layout->column_count == BP_PARTICLE_COLUMNS_MAX) return;
    const size_t c = layout->column_count++;
    snprintf(layout->column[c], sizeof layout->column[c], "%.79s%s", name, suffix);
    layout->columns[c] = layout->column[c];
    layout->column_word[c] = word;
}

static BpStatus parse_properties(const Input *input, char *text, Layout *layout, BpError *err) {
    static const char *const axes[] = {"_x", "_y", "_z"};
    static const char expected[] = "Properties=NAME:TYPE:COUNT:..., such as species:S:1:pos:R:3";
    bool has_position = false;
    int word = 0;
    char *rest = NULL;
    for (char *name = strtok_r(text, ":", &rest); name != NULL; name = strtok_r(NULL, ":", &rest)) {
        const char *const type = strtok_r(NULL, ":", &rest);
        const char *const count_text = type != NULL ? strtok_r(NULL, ":", &rest) : NULL;
        int64_t count = 0;
        if (count_text == NULL || !word_whole(count_text, &count) || count < 1 || count > 64 ||
            word + count > WORDS_MAX || layout->property_count == WORDS_MAX)
            return input_wrong(input, name, expected, err);
        Role role = OTHER;
        if (type[0] == 'S' && count == 1)
            role = strcmp(name, "species") == 0 || strcmp(name, "element") == 0        ? SPECIES
                   : strcmp(name, "atom_name") == 0 || strcmp(name, "name") == 0       ? ATOM_NAME
                   : strcmp(name, "resname") == 0 || strcmp(name, "residuenames") == 0 ? RESIDUE
                                                                                       : OTHER;
        if (type[0] == 'R' && count == 3)
            role = strcmp(name, "pos") == 0                                              ? POSITION
                   : strcmp(name, "color") == 0 || strcmp(name, "Color") == 0            ? COLOR
                   : strcmp(name, "aspherical_shape") == 0 || strcmp(name, "shape") == 0 ? SHAPE
                                                                                         : OTHER;
        if (type[0] == 'R' && count == 1 && (strcmp(name, "radius") == 0 || strcmp(name, "Radius") == 0))
            role = RADIUS;
        if (type[0] == 'I' && count == 1 && strcmp(name, "Z") == 0) role = NUMBER;
        has_position |= role == POSITION;
        for (int i = 0; type[0] != 'S' && i < count; i++) {
            char suffix[16] = "";
            if (count == 3)
                snprintf(suffix, sizeof suffix, "%s", axes[i]);
            else if (count > 1)
                snprintf(suffix, sizeof suffix, "_%d", i + 1);
            add_column(layout, role == POSITION ? axes[i] + 1 : name, role == POSITION ? "" : suffix,
                       word + i);
        }
        layout->property[layout->property_count].role = role;
        layout->property[layout->property_count++].words = (int)count;
        word += (int)count;
    }
    layout->word_count = (size_t)word;
    if (!has_position) return input_fail(input, true, err, "found no pos:R:3, expected %s", expected);
    return BP_OK;
}

static BpStatus parse_comment(const Input *input, const char *comment, Layout *layout, BpError *err) {
    static char *const plain[] = {"x", "y", "z"};
    char *const value = malloc(KEY_SIZE);
    if (value == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory");
    BpStatus status = BP_OK;
    layout->extended = find_key(comment, "Properties", value);
    if (layout->extended) {
        status = parse_properties(input, value, layout, err);
    } else {
        layout->property[0].role = SPECIES;
        layout->property[0].words = 1;
        layout->property[1].role = POSITION;
        layout->property[1].words = 3;
        layout->property_count = 2;
        layout->word_count = 4;
        for (int i = 0; i < 3; i++) add_column(layout, plain[i], "", 1 + i);
    }
    free(value);
    return status;
}

/* The value of pbc: three words for the three edges, or one for all, in quotes, brackets or braces. False: it
 * is something else. */
static bool parse_periodic(char *text, bool periodic[3]) {
    static const char *const words[2][6] = {{"F", "f", "False", "false", "FALSE", "0"},
                                            {"T", "t", "True", "true", "TRUE", "1"}};
    int count = 0;
    char *rest = NULL;
    for (char *word = strtok_r(text, " \t,;()[]{}\"'", &rest); word != NULL;
         word = strtok_r(NULL, " \t,;()[]{}\"'", &rest)) {
        bool known = false;
        for (int value = 0; value < 2 && count < 3; value++)
            for (int i = 0; i < 6 && !known; i++) {
                known = strcmp(word, words[value][i]) == 0;
                if (known) periodic[count] = value == 1;
            }
        if (!known) return false;
        count++;
    }
    if (count == 1) periodic[1] = periodic[2] = periodic[0];
    return count == 1 || count == 3;
}

static void parse_cell(BpParticleFile *file, const char *comment) {
    double edges[9], origin[3] = {0, 0, 0};
    char *const value = malloc(KEY_SIZE);
    if (value == NULL) return;
    bool periodic[3] = {true, true, true};
    if (find_key(comment, "pbc", value) && !parse_periodic(value, periodic)) {
        periodic[0] = periodic[1] = periodic[2] = true;
        if (file->out != NULL)
            bp_particles_note(file->out, "pbc is not three of T or F, so all edges are taken to repeat");
    }
    if (find_key(comment, "Origin", value) && numbers_of(value, origin, 3) != 3)
        origin[0] = origin[1] = origin[2] = 0;
    if (find_key(comment, "Lattice", value) && numbers_of(value, edges, 9) == 9) {
        const double rows[3][3] = {
            {edges[0], edges[1], edges[2]}, {edges[3], edges[4], edges[5]}, {edges[6], edges[7], edges[8]}};
        frame_cell(file, origin, rows, periodic);
    }
    free(value);
}

/* A symbol may have digits behind it. A number alone is a type: LAMMPS and others write it so. */
static uint8_t element_of(const char *species) {
    char symbol[4] = "";
    for (int i = 0; i < 3 && ((species[i] | 32) >= 'a' && (species[i] | 32) <= 'z'); i++)
        symbol[i] = species[i];
    const size_t letters = strlen(symbol);
    if (species[letters] != '\0' && (species[letters] < '0' || species[letters] > '9')) return 0;
    return bp_element_of_symbol(symbol);
}

static BpStatus take_atom(BpParticleFile *file, Layout *layout, uint64_t number, uint64_t count,
                          BpError *err) {
    Input *const input = &file->input;
    char *line, *words[WORDS_MAX], type[8];
    double values[BP_PARTICLE_COLUMNS_MAX], shape[3] = {0, 0, 0};
    Particle particle = PARTICLE_NONE;
    BP_TRY(input_line(input, &line, err));
    if (line == NULL)
        return input_fail(
            input, true, err,
            "found the end of the file, expected atom %llu (from 0) of %llu; it is cut off, or its "
            "count is wrong",
            (unsigned long long)number, (unsigned long long)count);
    const size_t found = split_words(line, words, WORDS_MAX);
    if (found < layout->word_count || (layout->extended && found > layout->word_count))
        return input_fail(input, true, err, "found %zu word%s, expected %zu: %s", found,
                          found == 1 ? "" : "s", layout->word_count,
                          layout->extended ? "as the Properties of the frame say" : "a species, x, y and z");
    size_t w = 0;
    for (size_t p = 0; p < layout->property_count; p++) {
        const Role role = layout->property[p].role;
        bool good = true;
        double value = 0;
        for (int i = 0; i < 3 && (role == POSITION || role == COLOR || role == SHAPE); i++)
            good = good && word_number(words[w + (size_t)i], role == POSITION ? &particle.position[i]
                                                             : role == COLOR  ? &particle.color[i]
                                                                              : &shape[i]);
        if (!good) return input_wrong(input, words[w], "three finite numbers", err);
        if (role == COLOR)
            for (int i = 0; i < 3; i++)
                if (!(particle.color[i] >= 0 && particle.color[i] <= 1))
                    return input_wrong(input, words[w], "a colour of shares from 0 to 1", err);
        if (role == SPECIES) {
            particle.element = element_of(words[w]);
            particle.type = words[w];
            if (particle.element == 0 && strcmp(words[w], "X") == 0) particle.flags |= BP_PARTICLE_DUMMY;
        }
        if (role == ATOM_NAME) particle.name = words[w];
        if (role == RESIDUE) particle.residue = words[w];
        if (role == RADIUS || role == NUMBER) {
            if (!word_number(words[w], &value)) return input_wrong(input, words[w], "a finite number", err);
            if (role == RADIUS) particle.radius = value;
            if (role == NUMBER && value >= 1 && value <= (double)BP_ELEMENT_MAX) {
                particle.element = (uint8_t)value;
                if (particle.type == NULL) {
                    snprintf(type, sizeof type, "%s", bp_elements[particle.element].symbol);
                    particle.type = type;
                }
            }
        }
        w += (size_t)layout->property[p].words;
    }
    layout->ellipsoids += frame_take_ellipsoid(&particle, shape);
    for (size_t k = 0; k < file->taken_count; k++) {
        const int c = file->wanted_column[k];
        values[c] = NAN;
        const char *const word = words[layout->column_word[c]];
        if (strcmp(word, "T") == 0 || strcmp(word, "F") == 0)
            values[c] = word[0] == 'T';
        else if (!word_number(word, &values[c]))
            values[c] = NAN;
    }
    particle.values = values;
    return frame_add(file, &particle, true, err);
}

BpStatus read_xyz(BpParticleFile *file, bool *end, BpError *err) {
    Input *const input = &file->input;
    char *line = NULL, *words[2];
    uint64_t count = 0;
    BP_TRY(input_full_line(input, &line, err));
    *end = line == NULL && file->frame > 0;
    if (*end) return BP_OK;
    if (line == NULL || split_words(line, words, 2) != 1)
        return input_fail(input, true, err,
                          "found %s, expected the number of atoms alone: an XYZ file's first line",
                          line == NULL ? "an empty file" : "other words");
    BP_TRY(word_count(input, words[0], "atoms", &count, err));
    BP_TRY(input_needed_line(input, &line, "the comment line of an XYZ file", err));
    Layout *const layout = calloc(1, sizeof *layout);
    if (layout == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory");
    BpStatus status = parse_comment(input, line, layout, err);
    if (status == BP_OK) status = frame_begin(file, layout->columns, layout->column_count, err);
    if (status == BP_OK) {
        if (file->out != NULL) file->out->angstrom = 1;
        parse_cell(file, line);
        for (uint64_t i = 0; i < count && status == BP_OK; i++)
            status = take_atom(file, layout, i, count, err);
        frame_note_shapes(file, layout->ellipsoids, "ellipsoid");
    }
    free(layout);
    return status;
}
