/* read_xyz.c: XYZ, plain and extended (the key Properties in the second line); see reader.h.
 *
 * Knows: the format.   Does not know: what becomes of the points. */
#include "column_names.h"
#include "elements.h"
#include "key_values.h"
#include "lammps.h"
#include "reader.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { WORDS_MAX = 160 };
#define TINKER "; if it is an XYZ file of Tinker, convert it, with Open Babel for example"

typedef enum Role {
    SPECIES,
    TYPE,
    POSITION,
    RADIUS,
    DIAMETER,
    COLOR,
    NUMBER,
    SHAPE,
    ORIENTATION,
    ROUNDNESS,
    ATOM_NAME,
    RESIDUE,
    OTHER
} Role;

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
    bool extended, whole_colors; /* whole_colors: they are of type I */
    bool has_shape;              /* some property is one */
    int color_word[3];           /* of red, green and blue in columns of their own; below 0: nowhere */
    bool number_seen[BP_ELEMENT_MAX + 1], symbol_seen, name_seen; /* among the species */
} Layout;

static void add_column(Layout *layout, const char *name, const char *suffix, int word) {
    if (layout->column_count == BP_PARTICLE_COLUMNS_MAX) return;
    const size_t c = layout->column_count++;
    snprintf(layout->column[c], sizeof layout->column[c], "%.79s%s", name, suffix);
    layout->columns[c] = layout->column[c];
    layout->column_word[c] = word;
}

/* What a property is by its name, in letters of either case, its type and its number of words. */
static Role role_of(const char *name, char type, int64_t count) {
    static const struct {
        const char *name;
        Role role;
        const char *types;
        int64_t count;
    } known[] = {{"species", SPECIES, "SI", 1},
                 {"element", SPECIES, "S", 1},
                 {"symbol", SPECIES, "S", 1},
                 {"symbols", SPECIES, "S", 1},
                 {"type", TYPE, "SI", 1},
                 {"particle_type", TYPE, "SI", 1},
                 {"pos", POSITION, "RI", 3},
                 {"position", POSITION, "RI", 3},
                 {"positions", POSITION, "RI", 3},
                 {"color", COLOR, "RI", 3},
                 {"color", COLOR, "RI", 4}, /* the fourth is the alpha */
                 {"colour", COLOR, "RI", 3},
                 {"colour", COLOR, "RI", 4},
                 {"radius", RADIUS, "RI", 1},
                 {"diameter", DIAMETER, "RI", 1},
                 {"Z", NUMBER, "I", 1},
                 {"numbers", NUMBER, "I", 1},
                 {"atomic_number", NUMBER, "I", 1},
                 {"atomic_numbers", NUMBER, "I", 1},
                 {"atom_name", ATOM_NAME, "S", 1},
                 {"name", ATOM_NAME, "S", 1},
                 {"resname", RESIDUE, "S", 1},
                 {"residuenames", RESIDUE, "S", 1},
                 {"aspherical_shape", SHAPE, "R", 3},
                 {"shape", SHAPE, "R", 3},
                 {"orientation", ORIENTATION, "R", 4},           /* x, y, z, w, as OVITO has it */
                 {"superquadric_roundness", ROUNDNESS, "R", 2}}; /* 1 and 1 of ellipsoids */
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (strcasecmp(name, known[i].name) == 0 && strchr(known[i].types, type) != NULL &&
            count == known[i].count)
            return known[i].role;
    return OTHER;
}

static void add_columns(Layout *layout, Role role, const char *name, int64_t count, int word) {
    static const char *const axes[] = {"_x", "_y", "_z"};
    for (int i = 0; i < count; i++) {
        char suffix[16] = "";
        if (count == 3)
            snprintf(suffix, sizeof suffix, "%s", axes[i]);
        else if (count > 1)
            snprintf(suffix, sizeof suffix, "_%d", i + 1);
        add_column(layout, role == POSITION ? axes[i] + 1 : name, role == POSITION ? "" : suffix, word + i);
    }
}

/* Properties of one number each may be red, green and blue. */
static void find_color(Layout *layout) {
    int place[3];
    const bool found = column_find_color(layout->columns, layout->column_count, place);
    for (int i = 0; i < 3; i++) layout->color_word[i] = found ? layout->column_word[place[i]] : -1;
}

static BpStatus parse_properties(const Input *input, char *text, Layout *layout, BpError *err) {
    static const char expected[] = "Properties=NAME:TYPE:COUNT:..., such as species:S:1:pos:R:3";
    bool has_position = false;
    int word = 0;
    char *rest = NULL;
    for (char *name = strtok_r(text, ":", &rest); name != NULL; name = strtok_r(NULL, ":", &rest)) {
        const char *const type_text = strtok_r(NULL, ":", &rest);
        const char *const count_text = type_text != NULL ? strtok_r(NULL, ":", &rest) : NULL;
        const char type = type_text != NULL ? (char)toupper((unsigned char)type_text[0]) : '\0';
        int64_t count = 0;
        if (count_text == NULL || type_text[1] != '\0' || strchr("SRIL", type) == NULL ||
            !word_whole(count_text, &count) || count < 1 || count > 64 || word + count > WORDS_MAX ||
            layout->property_count == WORDS_MAX)
            return input_wrong(input, name, expected, err);
        Role role = role_of(name, type, count);
        if (role == POSITION && has_position) role = OTHER;
        has_position |= role == POSITION;
        layout->whole_colors |= role == COLOR && type == 'I';
        layout->has_shape |= role == SHAPE;
        if (type != 'S') add_columns(layout, role, name, count, word);
        layout->property[layout->property_count].role = role;
        layout->property[layout->property_count++].words = (int)count;
        word += (int)count;
    }
    layout->word_count = (size_t)word;
    find_color(layout);
    if (!has_position) return input_fail(input, true, err, "found no pos:R:3, expected %s", expected);
    return BP_OK;
}

static void plain_layout(Layout *layout) {
    static char *const axes[] = {"x", "y", "z"};
    layout->property[0].role = SPECIES;
    layout->property[0].words = 1;
    layout->property[1].role = POSITION;
    layout->property[1].words = 3;
    layout->property_count = 2;
    layout->word_count = 4;
    for (int i = 0; i < 3; i++) {
        add_column(layout, axes[i], "", 1 + i);
        layout->color_word[i] = -1;
    }
}

static BpStatus fail_cell(const Input *input, const char *key, const char *expected, BpError *err) {
    return input_fail(input, true, err, "found %s, which is not understood, expected %s", key, expected);
}

/* The vectors of the cell as rows, from nine numbers or, along the axes, from three. False: there are others.
 */
static bool parse_edges(const char *value, double edges[3][3]) {
    double numbers[9];
    const int count = key_numbers(value, numbers, 9);
    memset(edges, 0, 9 * sizeof(double));
    for (int i = 0; i < 3 && count == 3; i++) edges[i][i] = numbers[i];
    if (count == 9) memcpy(edges, numbers, sizeof numbers);
    return count == 3 || count == 9;
}

/* The value of pbc: three words for the three edges, or one for all. False: it is something else. */
static bool parse_periodic(char *text, bool periodic[3]) {
    static const char *const words[2][4] = {{"F", "False", "0", "no"}, {"T", "True", "1", "yes"}};
    int count = 0;
    char *rest = NULL;
    if (strlen(text) == 3 && strspn(text, "TtFf10") == 3) { /* TTF */
        for (int i = 0; i < 3; i++) periodic[i] = strchr("Tt1", text[i]) != NULL;
        return true;
    }
    for (char *word = strtok_r(text, " \t,;()[]{}\"'", &rest); word != NULL;
         word = strtok_r(NULL, " \t,;()[]{}\"'", &rest)) {
        bool known = false;
        for (int value = 0; value < 2 && count < 3; value++)
            for (int i = 0; i < 4 && !known; i++) {
                known = strcasecmp(word, words[value][i]) == 0;
                if (known) periodic[count] = value == 1;
            }
        if (!known) return false;
        count++;
    }
    if (count == 1) periodic[1] = periodic[2] = periodic[0];
    return count == 1 || count == 3;
}

/* What cannot be read as a cell is an error, since the frame has one; but where the frame is a plain one, its
 * second line may say anything, and then a note says what was passed over. `value`: room for a value. */
static BpStatus parse_cell(BpParticleFile *file, const char *comment, bool extended, char *value,
                           BpError *err) {
    double edges[3][3], origin[3] = {0, 0, 0};
    bool periodic[3] = {true, true, true};
    const KeyFound found = key_find(comment, "Lattice", value);
    if (found == KEY_ABSENT) {
        if (key_find(comment, "cell", value) != KEY_ABSENT && file->out != NULL)
            bp_particles_note(file->out, "cell= passed over, since a cell is called Lattice=");
        return BP_OK;
    }
    if (found == KEY_BROKEN || !parse_edges(value, edges)) {
        if (extended || strstr(comment, "Lattice") != NULL)
            return fail_cell(&file->input, "Lattice",
                             "three vectors, such as Lattice=\"10 0 0 0 10 0 0 0 10\"", err);
        if (file->out != NULL) bp_particles_note(file->out, "lattice= passed over: no three vectors");
        return BP_OK;
    }
    const KeyFound origin_found = key_find(comment, "Origin", value);
    if (origin_found != KEY_ABSENT && (origin_found == KEY_BROKEN || key_numbers(value, origin, 3) != 3))
        return fail_cell(&file->input, "Origin", "a point, such as Origin=\"0 0 0\"", err);
    const KeyFound periodic_found = key_find(comment, "pbc", value);
    if (periodic_found != KEY_ABSENT && (periodic_found == KEY_BROKEN || !parse_periodic(value, periodic))) {
        periodic[0] = periodic[1] = periodic[2] = true;
        if (file->out != NULL)
            bp_particles_note(file->out, "pbc is not three of T or F, so all edges are taken to repeat");
    }
    frame_cell(file, origin, (const double(*)[3])edges, periodic);
    return BP_OK;
}

/* i-PI's second line: "# CELL(abcABC): 9 9 9 90 90 90 ... positions{atomic_unit} cell{atomic_unit}". */
static void take_units(BpParticles *p, const char *comment) {
    static const char key[] = "positions{";
    const char *const unit = strstr(comment, key);
    if (unit == NULL) return;
    const char *const name = unit + sizeof key - 1;
    if (strncmp(name, "atomic_unit}", 12) == 0 || strncmp(name, "bohr}", 5) == 0) {
        p->angstrom = lammps_units_find("electron")->angstrom;
        bp_particles_note(p, "lengths in bohr");
    } else if (strncmp(name, "angstrom}", 9) != 0) {
        bp_particles_note(p, "the unit of positions is not known: read as angstrom");
    }
    if (strstr(comment, "CELL") != NULL)
        bp_particles_note(p, "CELL passed over, since a cell is called Lattice=");
}

static BpStatus begin_frame(BpParticleFile *file, const char *comment, Layout *layout, char *value,
                            BpError *err) {
    const KeyFound found = key_find(comment, "Properties", value);
    if (found == KEY_BROKEN)
        return input_fail(&file->input, true, err,
                          "found Properties without an end, expected a quote or bracket that closes it");
    layout->extended = found == KEY_FOUND;
    if (layout->extended)
        BP_TRY(parse_properties(&file->input, value, layout, err));
    else
        plain_layout(layout);
    BP_TRY(frame_begin(file, layout->columns, layout->column_count, err));
    for (size_t p = 0; p < layout->property_count; p++)
        file->shapes.has_orientations |= layout->property[p].role == ORIENTATION;
    if (file->out != NULL) {
        file->out->angstrom = 1;
        if (!layout->extended) take_units(file->out, comment);
    }
    if (layout->has_shape) file->unread_shape[0] = '\0';
    file->colors.ambiguous = layout->whole_colors || layout->color_word[0] >= 0;
    return parse_cell(file, comment, layout->extended, value, err);
}

/* Whether a species may be the name of an atom as in PDB: CA, CB, OG1, HW2. Some of these are symbols, too.
 */
static bool may_be_name(const char *species) {
    if (strcmp(species, "OH2") == 0) return true;
    return species[0] != '\0' && strchr("CHNOS", species[0]) != NULL && species[1] != '\0' &&
           strchr("ABDEGWXZ", species[1]) != NULL &&
           species[strspn(species, "ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789'*")] == '\0';
}

/* Splits an atom's line. In extended XYZ, texts with blanks stand in quotes; but names of atoms have quotes
 * of their own (O5', H5''), so these count only where the words are too many otherwise. */
static size_t split_atom(char *line, const Layout *layout, char **words) {
    size_t count = 0;
    for (const char *c = line + strspn(line, " \t\r"); *c != '\0'; c += strspn(c, " \t\r"), count++)
        c += strcspn(c, " \t\r");
    if (!layout->extended || strpbrk(line, "\"'") == NULL) return split_words(line, words, WORDS_MAX);
    const bool joined = count > layout->word_count;
    count = 0;
    for (;;) {
        line += strspn(line, " \t\r");
        if (*line == '\0') return count;
        const char quote = *line == '"' || *line == '\'' ? *line : '\0';
        char *end = line + strcspn(line, " \t\r");
        if (quote != '\0' && joined)
            for (char *c = line + 1; *c != '\0'; c++)
                if (*c == quote && (c[1] == '\0' || strchr(" \t\r", c[1]) != NULL)) {
                    end = c + 1;
                    break;
                }
        const bool more = *end != '\0';
        *end = '\0';
        const bool whole = quote != '\0' && end - line >= 3 && end[-1] == quote;
        if (whole) end[-1] = '\0';
        if (count < WORDS_MAX) words[count] = line + whole;
        count++;
        line = end + more;
    }
}

/* Word `w` is no coordinate. Tinker's lines have the atom's number before its name. */
static BpStatus fail_coordinate(const Input *input, const Layout *layout, char *const *words, size_t w,
                                BpError *err) {
    int64_t whole = 0;
    const bool shifted = !layout->extended && w == 1 && word_whole(words[0], &whole);
    return input_wrong(input, words[w],
                       shifted ? "a finite number: a coordinate" TINKER : "a finite number: a coordinate",
                       err);
}

static BpStatus take_atom(BpParticleFile *file, Layout *layout, uint64_t number, uint64_t count,
                          BpError *err) {
    Input *const input = &file->input;
    char *line, *words[WORDS_MAX], type[8];
    double values[BP_PARTICLE_COLUMNS_MAX];
    Particle particle = PARTICLE_NONE;
    BP_TRY(input_line(input, &line, err));
    if (line == NULL)
        return input_fail(
            input, true, err,
            "found the end of the file, expected atom %llu (from 0) of %llu; it is cut off, or its "
            "count is wrong",
            (unsigned long long)number, (unsigned long long)count);
    const size_t found = split_atom(line, layout, words);
    if (found < layout->word_count || (layout->extended && found > layout->word_count))
        return input_fail(input, true, err, "found %zu word%s, expected %zu: %s", found,
                          found == 1 ? "" : "s", layout->word_count,
                          layout->extended ? "as the Properties of the frame say" : "a species, x, y and z");
    size_t w = 0;
    for (size_t p = 0; p < layout->property_count; p++) {
        const Role role = layout->property[p].role;
        double value = 0;
        for (size_t i = 0; i < 3; i++) {
            if (role == POSITION && !word_number_or_none(words[w + i], &particle.position[i]))
                return fail_coordinate(input, layout, words, w + i, err);
            if (role == SHAPE && !word_number(words[w + i], &particle.half_axes[i]))
                return input_wrong(input, words[w + i], "a finite number: half an axis of an ellipsoid", err);
            if (role == COLOR && !word_number(words[w + i], &particle.color[i]))
                return input_wrong(input, words[w + i], "a finite number: a share of a colour", err);
        }
        for (size_t i = 0; role == ORIENTATION && i < 4; i++)
            if (!word_number(words[w + i], &particle.orientation[(i + 1) % 4]))
                return input_wrong(input, words[w + i], "a finite number: x, y, z or w of a quaternion", err);
        for (size_t i = 0; role == ROUNDNESS && i < 2; i++)
            particle.super |= word_number(words[w + i], &value) && value > 0 && value != 1;
        if (role == SPECIES) {
            particle.element = bp_element_of_species(words[w]);
            particle.type = words[w];
            if (particle.element == 0 && strcmp(words[w], "X") == 0) particle.flags |= BP_PARTICLE_DUMMY;
            int64_t whole = 0;
            const bool is_number = word_whole(words[w], &whole) && whole > 0 && whole <= BP_ELEMENT_MAX;
            layout->number_seen[is_number ? whole : 0] = true;
            layout->symbol_seen |= !is_number;
            layout->name_seen |= particle.element == 0 && may_be_name(words[w]);
        }
        if (role == TYPE && particle.type == NULL) {
            particle.type = words[w];
            if (particle.element == 0) particle.element = bp_element_of_species(words[w]);
        }
        if (role == ATOM_NAME) particle.name = words[w];
        if (role == RESIDUE) particle.residue = words[w];
        if (role == RADIUS || role == DIAMETER || role == NUMBER) {
            if (!word_number_or_none(words[w], &value))
                return input_wrong(input, words[w], "a finite number", err);
            if (role == RADIUS) particle.radius = value;
            if (role == DIAMETER && isnan(particle.radius)) particle.radius = value / 2;
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
    for (int i = 0; i < 3 && layout->color_word[i] >= 0 && isnan(particle.color[i]); i++)
        if (!word_number(words[layout->color_word[i]], &particle.color[i]))
            return input_wrong(input, words[layout->color_word[i]], "a finite number: a share of a colour",
                               err);
    for (size_t k = 0; k < file->taken_count; k++) {
        const int c = file->wanted_column[k];
        values[c] = NAN;
        const char *const word = words[layout->column_word[c]];
        if (!word_logical(word, &values[c]) && !word_number(word, &values[c])) values[c] = NAN;
    }
    particle.values = values;
    return frame_add(file, &particle, true, err);
}

/* Where the number of atoms should be, the line `line` was found, of which `words` has the first. NULL: none.
 */
static BpStatus fail_count(const BpParticleFile *file, const char *line, char *const *words, BpError *err) {
    double number = 0;
    if (line == NULL)
        return input_fail(
            &file->input, true, err,
            "found an empty file, expected the number of atoms alone: an XYZ file's first line");
    int64_t whole = 0;
    return input_fail(&file->input, true, err,
                      "found other words, expected the number of atoms alone: an XYZ file's first line%s",
                      !word_number(words[0], &number) ? ""
                      : word_whole(words[0], &whole)
                          ? TINKER "; a table of points is read under a name that ends in .csv"
                          : "; a table of points is read under a name that ends in .csv");
}

/* Whether a line, apart from the type of the atom, could be one of the frame's: it has as many words, and
 * numbers as its place. */
static bool is_like_atom(const Layout *layout, char *text) {
    char *words[WORDS_MAX];
    double number = 0;
    const size_t found = split_atom(text, layout, words);
    if (found < layout->word_count || (layout->extended && found > layout->word_count)) return false;
    size_t w = 0;
    for (size_t p = 0; p < layout->property_count; p++) {
        const Role role = layout->property[p].role;
        for (size_t i = 0; role == POSITION && i < 3; i++)
            if (!word_number_or_none(words[w + i], &number)) return false;
        /* Types may be numbers, but have no fraction. */
        int64_t whole = 0;
        if (role == SPECIES && word_number(words[w], &number) && !word_whole(words[w], &whole)) return false;
        w += (size_t)layout->property[p].words;
    }
    return true;
}

/* Types count from 1; numbers with gaps may be atomic numbers. */
static void note_numbers(BpParticleFile *file, const Layout *layout) {
    int seen = 0, highest = 0;
    for (int n = 1; n <= BP_ELEMENT_MAX; n++) {
        seen += layout->number_seen[n];
        if (layout->number_seen[n]) highest = n;
    }
    if (layout->symbol_seen || highest == seen || file->out == NULL) return;
    bp_particles_note(file->out, "numbers such as %d read as types; elements must be given as symbols",
                      highest);
}

/* Some programs, such as VMD, write the names of atoms as species. Where one of them is no symbol, CA is no
 * calcium either; but TI stays titanium. */
static BpStatus take_names(BpParticles *p, const Layout *layout, BpError *err) {
    enum { UNASKED = UINT8_MAX };
    if (p == NULL || !layout->name_seen) return BP_OK;
    uint8_t *const element = malloc(p->names.count + 1);
    if (element == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for the elements of names");
    memset(element, UNASKED, p->names.count);
    for (size_t i = 0; i < p->count; i++) {
        BpParticleTag *const tag = &p->tag[i];
        const char *const name = p->names.text[tag->type];
        bool dummy = false;
        if (!may_be_name(name) && (tag->element != 0 || strchr("CHNOPS", name[0]) == NULL)) continue;
        if (element[tag->type] == UNASKED || tag->residue != 0)
            element[tag->type] = bp_element_of_name(name, p->names.text[tag->residue], false, &dummy);
        tag->element = element[tag->type];
        if (tag->element != 0) tag->flags |= BP_PARTICLE_ELEMENT_GUESSED;
    }
    free(element);
    p->element_guessed = true;
    bp_particles_note(p, "elements from atom names");
    return BP_OK;
}

/* Behind the last atom there is nothing, or the number of atoms of another frame, or text of other programs,
 * as the frequencies and names of the data set QM9; but no further atom. */
static BpStatus check_behind(BpParticleFile *file, const Layout *layout, BpError *err) {
    char text[1024], copy[1024], *words[2];
    int64_t number = 0;
    if (frame_line_behind(file, text) == NULL) return BP_OK;
    memcpy(copy, text, sizeof copy);
    if (split_words(copy, words, 2) == 1 && word_whole(words[0], &number)) return BP_OK;
    if (is_like_atom(layout, text)) return frame_fail_behind(file, "the number above them", err);
    file->behind = BEHIND_TEXT;
    if (file->out != NULL) bp_particles_note(file->out, "text behind the last frame left out");
    return BP_OK;
}

BpStatus read_xyz(BpParticleFile *file, bool *end, BpError *err) {
    Input *const input = &file->input;
    char *line = NULL, *words[2];
    uint64_t count = 0;
    BP_TRY(input_full_line(input, &line, err));
    *end = line == NULL && file->frame > 0;
    if (*end) return BP_OK;
    if (line == NULL || split_words(line, words, 2) != 1) return fail_count(file, line, words, err);
    BP_TRY(word_count(input, words[0], "atoms", &count, err));
    BP_TRY(input_needed_line(input, &line, "the comment line of an XYZ file", err));
    Layout *const layout = calloc(1, sizeof *layout);
    char *const value = malloc(KEY_VALUE_SIZE);
    BpStatus status = layout != NULL && value != NULL ? begin_frame(file, line, layout, value, err)
                                                      : bp_fail(err, BP_ERR_MEMORY, "out of memory");
    for (uint64_t i = 0; i < count && status == BP_OK; i++) status = take_atom(file, layout, i, count, err);
    if (status == BP_OK) status = check_behind(file, layout, err);
    if (status == BP_OK) note_numbers(file, layout);
    if (status == BP_OK) status = take_names(file->out, layout, err);
    free(value);
    free(layout);
    return status;
}
