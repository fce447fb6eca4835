/* read_data.c: LAMMPS data files; see reader.h.
 *
 * Knows: the header, which sections there are, and of them Atoms in all styles (lammps.h), Masses, Atom Type
 * Labels, Bonds, Velocities and Ellipsoids. Other sections are passed over; a note names those that are not
 * LAMMPS's own. */
#include "base/message_text.h"

#include "base/plural.h"
#include "base/words.h"
#include "elements.h"
#include "lammps.h"
#include "reader.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

/* Types are told apart up to LABELS_FROM; the places above are for labels that the file does not declare. */
enum { WORDS_MAX = 256, TYPES_MAX = 4096, LABELS_FROM = 3072, LABEL_SIZE = 64 };

/* Sections that are read, and others of the format. */
typedef enum Section {
    NO_SECTION = -1,
    ATOMS,
    MASSES,
    LABELS,
    BONDS,
    VELOCITIES,
    ELLIPSOIDS,
    PASSED_OVER,
} Section;

static const char *const section_names[] = {[ATOMS] = "Atoms",
                                            [MASSES] = "Masses",
                                            [LABELS] = "Atom Type Labels",
                                            [BONDS] = "Bonds",
                                            [VELOCITIES] = "Velocities",
                                            [ELLIPSOIDS] = "Ellipsoids",
                                            "Angles",
                                            "Dihedrals",
                                            "Impropers",
                                            "Lines",
                                            "Triangles",
                                            "Bodies"};

/* Columns of numbers, in the order in which an atom's values stand. */
enum { X, CHARGE = 3, MOLECULE, TYPE, VELOCITY, COLUMN_COUNT = VELOCITY + 3 };

typedef struct Place {
    int64_t id;
    uint32_t at;
} Place;

typedef struct Data {
    uint64_t atoms, bonds, types, shapes[LAMMPS_SHAPE_COUNT];
    bool has_bonds;                  /* the header counts bonds, angles or kinds of them */
    double low[3], high[3], tilt[3]; /* xy xz yz */
    double vectors[4][3];            /* avec, bvec, cvec, and the origin */
    bool has_box, general;
    const LammpsUnits *units; /* NULL: the title names none */
    LammpsLayout layout;
    bool has_layout, guessed;
    char label[TYPES_MAX][LABEL_SIZE];
    uint16_t last_label;    /* of those that the file declares */
    double mass[TYPES_MAX]; /* 0: none */
    bool used[TYPES_MAX];
    bool has_masses;
    uint16_t *types_of; /* the places of the atoms' types, and their numbers, in the file's order */
    int64_t *ids;
    size_t id_count, id_capacity;
    Place *places; /* by number, once it is needed */
} Data;

static void cut_comment(char *line) {
    line[strcspn(line, "#")] = '\0';
}

static void data_destroy(Data *data) {
    if (data == NULL) return;
    free(data->types_of);
    free(data->ids);
    free(data->places);
    free(data);
}

/* ---- the header --------------------------------------------------------------------------------------- */

/* "Atoms # full": the section that the line names with nothing but a comment behind it, or NO_SECTION. */
static Section named_section(const char *line) {
    static const char *const endings[] = {" Coeffs", " Type Labels"};
    char text[64] = "", copy[64], *words[4];
    if ((size_t)snprintf(copy, sizeof copy, "%.*s", (int)strcspn(line, "#"), line) >= sizeof copy)
        return NO_SECTION;
    const size_t count = split_words(copy, words, 4);
    for (size_t i = 0; i < count && i < 4; i++) {
        const size_t used = strlen(text);
        snprintf(text + used, sizeof text - used, "%s%s", i > 0 ? " " : "", words[i]);
    }
    if (count == 0 || count > 3) return NO_SECTION;
    for (size_t i = 0; i < sizeof section_names / sizeof *section_names; i++)
        if (strcmp(text, section_names[i]) == 0) return i < PASSED_OVER ? (Section)i : PASSED_OVER;
    for (size_t i = 0; i < sizeof endings / sizeof *endings; i++) {
        const size_t length = strlen(text), size = strlen(endings[i]);
        if (isupper((unsigned char)text[0]) && length > size && strcmp(text + length - size, endings[i]) == 0)
            return PASSED_OVER;
    }
    return NO_SECTION;
}

static BpStatus take_numbers(const Input *input, char **words, size_t count, double *values, BpError *err) {
    for (size_t i = 0; i < count; i++)
        if (!word_number(words[i], &values[i])) return input_wrong(input, words[i], "a finite number", err);
    return BP_OK;
}

static BpStatus take_box(const Input *input, char **words, size_t count, Data *data, BpError *err) {
    static const char *const axes[] = {"xlo", "ylo", "zlo"};
    static const char *const vectors[] = {"avec", "bvec", "cvec", "abc"};
    double bounds[2];
    for (size_t i = 0; i < 3 && count == 4; i++) {
        if (strcmp(words[2], axes[i]) != 0) continue;
        BP_TRY(take_numbers(input, words, 2, bounds, err));
        data->low[i] = bounds[0];
        data->high[i] = bounds[1];
        data->has_box = true;
    }
    for (size_t i = 0; i < 4 && (count == 4 || count == 5); i++) {
        if (strcmp(words[3], vectors[i]) != 0) continue;
        BP_TRY(take_numbers(input, words, 3, data->vectors[i], err));
        data->has_box = data->general = true;
    }
    if (count == 6 && strcmp(words[3], "xy") == 0) BP_TRY(take_numbers(input, words, 3, data->tilt, err));
    return BP_OK;
}

#define SHAPE_WORDS(X)                                                                                       \
    X(LAMMPS_POINT, "")                                                                                      \
    X(LAMMPS_ELLIPSOID, "ellipsoids")                                                                        \
    X(LAMMPS_LINE, "lines")                                                                                  \
    X(LAMMPS_TRIANGLE, "triangles") X(LAMMPS_BODY, "bodies") X(LAMMPS_SHAPE_COUNT, NULL)
BP_WORDS(LammpsShape, static const char *const shapes, SHAPE_WORDS);

static BpStatus take_count(const Input *input, char **words, size_t count, Data *data, BpError *err) {
    static const char *const bonded[] = {"bonds", "angles", "dihedrals", "impropers",
                                         "bond",  "angle",  "dihedral",  "improper"};
    double number = 0;
    if (count == 3 && strcmp(words[2], "types") == 0 && strcmp(words[1], "atom") == 0)
        return word_count(input, words[0], "types", &data->types, err);
    for (size_t i = 0; i < sizeof bonded / sizeof *bonded; i++)
        data->has_bonds |= count == (i < 4 ? 2 : 3) && strcmp(words[1], bonded[i]) == 0 &&
                           word_number(words[0], &number) && number > 0;
    if (count != 2) return BP_OK;
    if (strcmp(words[1], "atoms") == 0) return word_count(input, words[0], "atoms", &data->atoms, err);
    if (strcmp(words[1], "bonds") == 0) return word_count(input, words[0], "bonds", &data->bonds, err);
    for (int s = LAMMPS_ELLIPSOID; s < LAMMPS_SHAPE_COUNT; s++)
        if (strcmp(words[1], shapes[s]) == 0)
            return word_count(input, words[0], shapes[s], &data->shapes[s], err);
    return BP_OK;
}

/* "..., units = real" in the title, as LAMMPS itself writes it. */
static void take_title(const char *title, Data *data) {
    const char *const found = strstr(title, "units = ");
    char name[16];
    if (found == NULL) return;
    snprintf(name, sizeof name, "%.*s", (int)strcspn(found + 8, " ,;\t\r"), found + 8);
    data->units = lammps_units_find(name);
}

/* Up to the first line of the body, which is left in *line. Values come first in lines of the header. */
static BpStatus take_header(Input *input, char **line, Data *data, BpError *err) {
    char *words[WORDS_MAX];
    for (int i = 0; i < 3; i++) {
        data->low[i] = -0.5; /* what LAMMPS has where the file says nothing */
        data->high[i] = 0.5;
        data->vectors[i][i] = 1;
    }
    BP_TRY(input_needed_line(input, line, "a LAMMPS data file's title", err));
    take_title(*line, data);
    for (;;) {
        BP_TRY(input_full_line(input, line, err));
        if (*line == NULL || named_section(*line) != NO_SECTION) return BP_OK;
        const char *const text = *line + strspn(*line, " \t");
        if (isalpha((unsigned char)*text) && data->atoms > 0) return BP_OK; /* a section of a fix */
        cut_comment(*line);
        const size_t count = split_words(*line, words, WORDS_MAX);
        if (count == 0 || count > WORDS_MAX) continue;
        BP_TRY(take_count(input, words, count, data, err));
        BP_TRY(take_box(input, words, count, data, err));
    }
}

static void find_cell(const Data *data, double origin[3], double edges[3][3]) {
    const double sides[3][3] = {{data->high[0] - data->low[0], 0, 0},
                                {data->tilt[0], data->high[1] - data->low[1], 0},
                                {data->tilt[1], data->tilt[2], data->high[2] - data->low[2]}};
    memcpy(origin, data->general ? data->vectors[3] : data->low, sizeof data->low);
    if (data->general)
        memcpy(edges, data->vectors, sizeof sides);
    else
        memcpy(edges, sides, sizeof sides);
}

static void add_cell(BpParticleFile *file, const Data *data) {
    double origin[3], edges[3][3];
    if (!data->has_box) return;
    find_cell(data, origin, edges);
    frame_cell(file, origin, (const double(*)[3])edges, FRAME_PERIODIC);
}

/* ---- types -------------------------------------------------------------------------------------------- */

/* The type that Atom Type Labels gives that label; 0: none. */
static uint16_t declared_type(const Data *data, const char *label) {
    for (uint16_t t = 1; t <= data->last_label; t++)
        if (strcmp(data->label[t], label) == 0) return t;
    return 0;
}

/* The place of the type with that number or label; 0: one of the types for which there is none. */
static uint16_t type_place(Data *data, const char *word) {
    int64_t number = 0;
    if (word_whole(word, &number)) return number > 0 && number < LABELS_FROM ? (uint16_t)number : 0;
    const uint16_t declared = declared_type(data, word);
    if (declared != 0) return declared;
    for (int t = LABELS_FROM; t < TYPES_MAX; t++) {
        if (data->label[t][0] == '\0') snprintf(data->label[t], LABEL_SIZE, "%s", word);
        if (strncmp(data->label[t], word, LABEL_SIZE - 1) == 0) return (uint16_t)t;
    }
    return 0;
}

static BpStatus take_label(const Input *input, Data *data, char **words, size_t count, BpError *err) {
    int64_t type = 0;
    if (count != 2 || !word_whole(words[0], &type) || type < 1)
        return input_wrong(input, words[0], "a type's number and its label", err);
    if (type >= LABELS_FROM) return BP_OK;
    snprintf(data->label[type], LABEL_SIZE, "%s", words[1]);
    if (type > data->last_label) data->last_label = (uint16_t)type;
    return BP_OK;
}

static BpStatus take_mass(const Input *input, Data *data, char **words, size_t count, BpError *err) {
    double mass = 0;
    if (count != 2 || !word_number(words[1], &mass))
        return input_wrong(input, words[count == 2], "a type and its mass", err);
    data->has_masses = true;
    data->mass[type_place(data, words[0])] = mass;
    return BP_OK;
}

/* Elements for all atoms or for none: a mass that no element has belongs to a model of beads, whose other
 * masses mean nothing either. */
static void set_elements(BpParticleFile *file, const Data *data) {
    BpParticles *const p = file->out;
    const double dalton = data->units != NULL ? data->units->dalton : 1;
    uint8_t element[TYPES_MAX] = {0};
    size_t used = 0, known = 0;
    bool united = false;
    if (p == NULL) return;
    if (data->units != NULL) p->angstrom = data->units->angstrom;
    if (!data->has_masses || dalton == 0) return;
    for (size_t t = 0; t < TYPES_MAX; t++) {
        bool group = false;
        if (!data->used[t]) continue;
        element[t] = t > 0 ? bp_element_of_mass(data->mass[t] / dalton, &group) : 0;
        united |= group;
        known += element[t] != 0;
        used++;
    }
    if (known == used) {
        for (uint32_t i = 0; i < data->id_count; i++) {
            const uint32_t at = frame_place(file, i);
            if (at != UINT32_MAX) p->tag[at].element = element[data->types_of[i]];
        }
        p->has_element = used > 0;
        if (data->units == NULL) p->angstrom = 1;
    }
    atom_note_masses(p, known, used, "types", united);
}

/* ---- atoms -------------------------------------------------------------------------------------------- */

/* What is known of a style while the lines are tried that might be written in it. */
typedef struct Candidate {
    LammpsLayout layout;
    double first[3];
    bool begun, spread; /* atoms lie at several places */
} Candidate;

/* Counts of periodic images stand only behind atoms that lie in the cell. */
static bool is_near_cell(const Data *data, const double place[3]) {
    double origin[3], edges[3][3];
    find_cell(data, origin, edges);
    for (int c = 0; c < 3 && data->has_box; c++) {
        double low = origin[c], high = origin[c];
        for (int e = 0; e < 3; e++) *(edges[e][c] < 0 ? &low : &high) += edges[e][c];
        if (place[c] < low - (high - low) || place[c] > high + (high - low)) return false;
    }
    return true;
}

/* `named`: the file names the style, so its lines are only looked at where it has two layouts. */
static bool may_be(const Data *data, Candidate *candidate, bool named, char **words, size_t count) {
    const LammpsLayout *const layout = &candidate->layout;
    double place[3];
    int wrong = 0;
    if (!lammps_line_fits(layout, words, count, (int64_t)data->types, !named, &wrong)) return false;
    const char *const type = words[layout->type];
    int64_t number = 0;
    if (named) return true;
    if (!word_whole(type, &number) && declared_type(data, type) == 0) return false;
    for (int i = 0; i < 3; i++)
        if (!word_number_or_none(words[layout->x + i], &place[i])) return false;
    if (isnan(place[0]) || isnan(place[1]) || isnan(place[2])) return true;
    if (count > layout->word_count && !is_near_cell(data, place)) return false;
    if (!candidate->begun) memcpy(candidate->first, place, sizeof place);
    for (int c = 0; c < 3; c++) candidate->spread |= candidate->first[c] != place[c];
    candidate->begun = true;
    return true;
}

/* Without a name, a line may be in one of the usual styles, and in others that can be told from them; where
 * the header counts bonds or shapes, only in styles that have them. */
static size_t list_candidates(const Data *data, const char *comment, bool named, Candidate *out) {
    LammpsLayout layouts[LAMMPS_LAYOUTS_MAX];
    const size_t count = lammps_layouts(named ? comment : NULL, layouts);
    bool shaped = false;
    for (int s = LAMMPS_ELLIPSOID; s < LAMMPS_SHAPE_COUNT; s++) shaped |= data->shapes[s] > 0;
    size_t listed = 0;
    for (size_t i = 0; i < count; i++) {
        const LammpsLayout *const layout = &layouts[i];
        const bool shape = layout->shape != LAMMPS_POINT;
        if (!named && (layout->rare || (data->has_bonds && !layout->bonded) || shape != shaped ||
                       (shape && data->shapes[layout->shape] == 0)))
            continue;
        out[listed++] = (Candidate){.layout = *layout};
    }
    return listed;
}

/* Reads on to the last atom, or until one candidate is left, and returns to where it was. */
static BpStatus try_lines(Input *input, const Data *data, bool named, Candidate *list, size_t *count,
                          BpError *err) {
    const uint64_t taken = input->taken, number = input->line;
    uint64_t atoms = 0;
    char *line = NULL, *words[WORDS_MAX];
    while (*count > 1 && atoms < data->atoms) {
        BP_TRY(input_full_line(input, &line, err));
        if (line == NULL || named_section(line) != NO_SECTION) break;
        cut_comment(line);
        const size_t found = split_words(line, words, WORDS_MAX);
        if (found == 0) continue;
        size_t left = 0;
        for (size_t i = 0; i < *count; i++)
            if (found <= WORDS_MAX && may_be(data, &list[i], named, words, found)) list[left++] = list[i];
        atoms++;
        *count = left;
    }
    size_t left = 0;
    for (size_t i = 0; i < *count; i++)
        if (*count == 1 || named || atoms < 2 || list[i].spread) list[left++] = list[i];
    *count = left;
    return input_return_to(input, taken, number, err);
}

static BpStatus refuse_styles(const Input *input, const Candidate *list, size_t count, BpError *err) {
    char names[160] = "";
    for (size_t i = 0; i < count; i++) {
        const size_t used = strlen(names);
        snprintf(names + used, sizeof names - used, "%s%s",
                 i == 0           ? ""
                 : i + 1 == count ? " or "
                                  : ", ",
                 list[i].layout.style);
    }
    if (count == 0)
        return input_fail(input, true, err,
                          "found Atoms without a style, and lines that are none of atomic, charge, "
                          "molecular, full or sphere; name the style behind the section: Atoms # dipole");
    return input_fail(input, true, err,
                      "found Atoms without a style, and lines that may be of style %s; name it behind the "
                      "section: Atoms # %s",
                      names, list[0].layout.style);
}

/* The style that the section's comment names. A single word there is a name; several may be a remark, and
 * then the style is the only one that all lines fit. */
static BpStatus choose_layout(BpParticleFile *file, const char *comment, Data *data, BpError *err) {
    Input *const input = &file->input;
    LammpsLayout known[LAMMPS_LAYOUTS_MAX];
    Candidate list[LAMMPS_LAYOUTS_MAX];
    char copy[LAMMPS_STYLE_SIZE], shown[48], names[512], *word = NULL;
    const bool named = lammps_layouts(comment, known) > 0;
    snprintf(copy, sizeof copy, "%s", comment);
    if (!named && split_words(copy, &word, 1) == 1) {
        bp_printable(word, shown, sizeof shown);
        return input_fail(input, true, err, "found atom style \"%s\", expected %s", shown,
                          lammps_style_names(names, sizeof names));
    }
    size_t count = list_candidates(data, comment, named, list);
    const Candidate first = list[0];
    if (count > 1) BP_TRY(try_lines(input, data, named, list, &count, err));
    if (named && count == 0) {
        list[0] = first; /* whose complaint about the lines is the one to make */
        count = 1;
    }
    const bool may_guess = count == 1 && (list[0].layout.usual || list[0].layout.shape != LAMMPS_POINT);
    if (!named && !may_guess) return refuse_styles(input, list, count, err);
    data->layout = list[0].layout;
    data->has_layout = true;
    data->guessed = !named;
    if (file->out == NULL) return BP_OK;
    if (!named)
        bp_particles_note(file->out, "atom style %s, the only one that the lines fit", data->layout.style);
    if (named && count > 1)
        bp_particles_note(file->out, "atom style %s in the order of columns that LAMMPS writes",
                          data->layout.style);
    if (data->layout.open && strcmp(data->layout.style, "hybrid") == 0)
        bp_particles_note(file->out, "atom style hybrid without its parts: columns behind z left out");
    return BP_OK;
}

static BpStatus keep_id(Data *data, const Input *input, const char *word, uint16_t type, BpError *err) {
    if (data->id_count == data->id_capacity) {
        const size_t capacity = data->id_capacity > 0 ? 2 * data->id_capacity : 1024;
        int64_t *const ids = realloc(data->ids, capacity * sizeof *ids);
        if (ids != NULL) data->ids = ids;
        uint16_t *const types = realloc(data->types_of, capacity * sizeof *types);
        if (types != NULL) data->types_of = types;
        if (ids == NULL || types == NULL)
            return bp_fail(err, BP_ERR_MEMORY, "out of memory for the numbers of atoms");
        data->id_capacity = capacity;
    }
    if (!word_whole(word, &data->ids[data->id_count]))
        return input_wrong(input, word, "an atom's number", err);
    data->types_of[data->id_count++] = type;
    data->used[type] = true;
    return BP_OK;
}

/* Why a line is none of the style. */
static BpStatus refuse_line(const Input *input, const Data *data, char **words, size_t count, int wrong,
                            BpError *err) {
    const LammpsLayout *const layout = &data->layout;
    const char *const advice = data->guessed ? ", which the file does not name; name it: Atoms # full" : "";
    char shown[48];
    if (wrong < 0)
        return input_fail(input, true, err, "found %zu word%s, expected %s%zu%s: atom style %s%s", count,
                          bp_plural(count), layout->open ? "at least " : "", layout->word_count,
                          layout->open ? "" : ", or three more for the counts of periodic images",
                          layout->style, advice);
    bp_printable(words[wrong], shown, sizeof shown);
    const LammpsWord kind = (size_t)wrong < layout->word_count ? layout->word[wrong] : LAMMPS_WHOLE;
    if (kind == LAMMPS_TYPE && data->types > 0)
        return input_fail(input, true, err, "found \"%s\", expected a type from 1 to %llu: atom style %s%s",
                          shown, (unsigned long long)data->types, layout->style, advice);
    return input_fail(input, true, err, "found \"%s\", expected %s: atom style %s%s", shown,
                      (size_t)wrong < layout->word_count ? lammps_word_name(kind)
                                                         : "the whole number of a periodic image",
                      layout->style, advice);
}

static BpStatus take_atom(BpParticleFile *file, Data *data, char **words, size_t count, BpError *err) {
    const LammpsLayout *const layout = &data->layout;
    const int places[COLUMN_COUNT] = {
        layout->x, layout->x + 1, layout->x + 2, layout->charge, layout->molecule, layout->type, -1, -1, -1};
    double values[COLUMN_COUNT], size = 0;
    int wrong = 0;
    Particle particle = PARTICLE_NONE;
    if (!lammps_line_fits(layout, words, count, (int64_t)data->types, data->guessed, &wrong))
        return refuse_line(&file->input, data, words, count, wrong, err);
    for (int i = 0; i < COLUMN_COUNT; i++)
        if (places[i] < 0 || !word_number_or_none(words[places[i]], &values[i])) values[i] = NAN;
    memcpy(particle.position, values, sizeof particle.position);
    const int sized = layout->diameter >= 0 ? layout->diameter : layout->radius;
    if (sized >= 0 && word_number(words[sized], &size) && size > 0)
        particle.radius = layout->diameter >= 0 ? size / 2 : size;
    const uint16_t type = type_place(data, words[layout->type]);
    particle.type = data->label[type][0] != '\0' ? data->label[type] : words[layout->type];
    if (isnan(values[TYPE]) && type < LABELS_FROM) values[TYPE] = type;
    particle.values = values;
    BP_TRY(keep_id(data, &file->input, words[0], type, err));
    return frame_add(file, &particle, true, err);
}

/* ---- what refers to atoms by their numbers ------------------------------------------------------------ */

static int compare_places(const void *a, const void *b) {
    const int64_t one = ((const Place *)a)->id, other = ((const Place *)b)->id;
    return one < other ? -1 : one > other;
}

static BpStatus find_place(const Input *input, Data *data, const char *word, uint32_t *at, BpError *err) {
    const size_t count = data->id_count;
    Place key = {0};
    if (data->places == NULL) {
        data->places = malloc((count + 1) * sizeof *data->places);
        if (data->places == NULL)
            return bp_fail(err, BP_ERR_MEMORY, "out of memory for the numbers of atoms");
        for (size_t i = 0; i < count; i++) data->places[i] = (Place){data->ids[i], (uint32_t)i};
        qsort(data->places, count, sizeof *data->places, compare_places);
        for (size_t i = 1; i < count; i++)
            if (data->places[i].id == data->places[i - 1].id)
                return input_fail(input, false, err,
                                  "found two atoms with the number %lld, expected another number for each",
                                  (long long)data->places[i].id);
    }
    if (!word_whole(word, &key.id)) return input_wrong(input, word, "an atom's number", err);
    const Place *const found =
        count > 0 ? bsearch(&key, data->places, count, sizeof *data->places, compare_places) : NULL;
    if (found == NULL) return input_wrong(input, word, "the number of an atom of this file", err);
    *at = found->at;
    return BP_OK;
}

static BpStatus take_bond(BpParticleFile *file, Data *data, char **words, size_t count, BpError *err) {
    uint32_t ends[2];
    if (count < 4)
        return input_fail(&file->input, true, err,
                          "found %zu word%s, expected a bond: number, type, atom, atom", count,
                          bp_plural(count));
    for (int i = 0; i < 2; i++) BP_TRY(find_place(&file->input, data, words[2 + i], &ends[i], err));
    return frame_add_bond(file, ends[0], ends[1], err);
}

static BpStatus take_velocity(BpParticleFile *file, Data *data, char **words, size_t count, BpError *err) {
    double velocity[3];
    uint32_t at = 0;
    if (count < 4)
        return input_fail(&file->input, true, err, "found %zu word%s, expected an atom's number and velocity",
                          count, bp_plural(count));
    BP_TRY(take_numbers(&file->input, words + 1, 3, velocity, err));
    if (file->taken_count == 0) return BP_OK;
    BP_TRY(find_place(&file->input, data, words[0], &at, err));
    at = frame_place(file, at);
    for (size_t k = 0; k < file->taken_count; k++) {
        const int c = file->wanted_column[k] - VELOCITY;
        if (c >= 0 && at != UINT32_MAX) file->out->column[file->wanted_place[k]][at] = velocity[c];
    }
    return BP_OK;
}

/* The file has the three diameters and w, x, y and z of the quaternion. */
static BpStatus take_ellipsoid(BpParticleFile *file, Data *data, char **words, size_t count, BpError *err) {
    double axes[3], orientation[4];
    uint32_t at = 0;
    if (count < 8)
        return input_fail(&file->input, true, err,
                          "found %zu word%s, expected an atom's number, three diameters and a quaternion",
                          count, bp_plural(count));
    BP_TRY(take_numbers(&file->input, words + 1, 3, axes, err));
    BP_TRY(take_numbers(&file->input, words + 4, 4, orientation, err));
    BP_TRY(find_place(&file->input, data, words[0], &at, err));
    for (int i = 0; i < 3; i++) axes[i] /= 2;
    file->shapes.has_orientations = true;
    bool super = false;
    for (size_t i = 8; i < 10 && i < count; i++) { /* a superellipsoid's exponents */
        double exponent = 0;
        super |= word_number(words[i], &exponent) && exponent != 2;
    }
    file->shapes.super += super;
    return frame_set_ellipsoid(file, at, axes, orientation, err);
}

static void note_shapes(BpParticles *p, const Data *data) {
    static const char *const words[LAMMPS_SHAPE_COUNT][2] = {[LAMMPS_LINE] = {"line", "lines"},
                                                             [LAMMPS_TRIANGLE] = {"triangle", "triangles"},
                                                             [LAMMPS_BODY] = {"body", "bodies"}};
    for (int s = 0; s < LAMMPS_SHAPE_COUNT && p != NULL; s++) {
        const unsigned long long count = words[s][0] != NULL ? data->shapes[s] : 0;
        if (count > 0)
            bp_particles_note(p, "%llu %s drawn as %s", count, words[s][count > 1],
                              count > 1 ? "spheres" : "a sphere");
    }
}

/* ---- sections ----------------------------------------------------------------------------------------- */

/* How many lines a section has; 0: the header does not say. */
static uint64_t line_count(const Data *data, Section section) {
    switch (section) {
    case ATOMS:
    case VELOCITIES:
        return data->atoms;
    case MASSES:
    case LABELS:
        return data->types;
    case BONDS:
        return data->bonds;
    case ELLIPSOIDS:
        return data->shapes[LAMMPS_ELLIPSOID];
    case NO_SECTION:
    case PASSED_OVER:
        break;
    }
    return 0;
}

/* Whether a line amid a section, one that begins with a letter, opens another: one with a name that is not
 * LAMMPS's own. Labels stand in front of lines of Masses and of coefficients. */
static bool opens_other(const char *line, Section section, bool is_full) {
    char copy[256], *words[32];
    double number = 0;
    const char first = line[strspn(line, " \t")];
    if (!isalpha((unsigned char)first) && first != '_') return false;
    if (is_full || (section != MASSES && section != PASSED_OVER)) return true;
    snprintf(copy, sizeof copy, "%.*s", (int)strcspn(line, "#"), line);
    const size_t count = split_words(copy, words, 32);
    if (section == MASSES) return count != 2 || !word_number(words[1], &number);
    for (size_t i = 1; i < count && i < 32; i++)
        if (word_number(words[i], &number)) return false;
    return true;
}

static BpStatus take_line(BpParticleFile *file, Section section, Data *data, char *line, BpError *err) {
    Input *const input = &file->input;
    char *words[WORDS_MAX];
    const size_t count = split_words(line, words, WORDS_MAX);
    if (count > WORDS_MAX)
        return input_fail(input, true, err, "found more than %d words, expected fewer", WORDS_MAX);
    switch (section) {
    case ATOMS:
        return take_atom(file, data, words, count, err);
    case MASSES:
        return take_mass(input, data, words, count, err);
    case LABELS:
        return take_label(input, data, words, count, err);
    case BONDS:
        return take_bond(file, data, words, count, err);
    case VELOCITIES:
        return take_velocity(file, data, words, count, err);
    case ELLIPSOIDS:
        return take_ellipsoid(file, data, words, count, err);
    case NO_SECTION:
    case PASSED_OVER:
        break;
    }
    return BP_OK;
}

static BpStatus check_end(const Input *input, Section section, uint64_t lines, const Data *data,
                          BpError *err) {
    static const char *const words[] = {[ATOMS] = "atoms", [BONDS] = "bonds"};
    const uint64_t expected = line_count(data, section);
    if ((section != ATOMS && section != BONDS) || lines == expected || expected == 0) return BP_OK;
    return input_fail(input, false, err,
                      "found %llu line%s of %s, expected %llu, as the header says; the file is cut off, or "
                      "its count is wrong",
                      (unsigned long long)lines, bp_plural(lines), words[section],
                      (unsigned long long)expected);
}

static BpStatus open_section(BpParticleFile *file, char *line, Section section, Data *data, BpError *err) {
    const char *const mark = strchr(line, '#');
    char comment[LAMMPS_STYLE_SIZE];
    if (section == PASSED_OVER && named_section(line) == NO_SECTION && file->out != NULL) {
        char shown[48];
        size_t length = strcspn(line, "#\r");
        while (length > 0 && strchr(" \t", line[length - 1]) != NULL) length--;
        line[length] = '\0';
        bp_printable(line + strspn(line, " \t"), shown, sizeof shown);
        bp_particles_note(file->out, "section %s passed over", shown);
    }
    if (section != ATOMS) return BP_OK;
    if (data->has_layout)
        return input_fail(&file->input, true, err, "found Atoms a second time, expected it once");
    if (data->atoms == 0)
        return input_fail(&file->input, true, err,
                          "found Atoms, expected their number in the header: 100 atoms");
    snprintf(comment, sizeof comment, "%s", mark != NULL ? mark + 1 : "");
    return choose_layout(file, comment, data, err);
}

static BpStatus take_sections(BpParticleFile *file, char *line, Data *data, BpError *err) {
    Input *const input = &file->input;
    Section section = NO_SECTION;
    for (uint64_t lines = 0; line != NULL;) {
        const uint64_t expected = line_count(data, section);
        Section opened = named_section(line);
        if (opened == NO_SECTION && opens_other(line, section, expected > 0 && lines == expected))
            opened = PASSED_OVER;
        if (opened != NO_SECTION) {
            BP_TRY(check_end(input, section, lines, data, err));
            BP_TRY(open_section(file, line, opened, data, err));
            section = opened;
            lines = 0;
        } else {
            cut_comment(line);
            if (line[strspn(line, " \t\r")] != '\0') {
                BP_TRY(take_line(file, section, data, line, err));
                lines++;
            }
        }
        BP_TRY(input_full_line(input, &line, err));
        if (line == NULL) BP_TRY(check_end(input, section, lines, data, err));
    }
    if (!data->has_layout) return input_fail(input, false, err, "found no section Atoms, expected the atoms");
    return BP_OK;
}

BpStatus read_data(BpParticleFile *file, bool *end, BpError *err) {
    static const char *const columns[COLUMN_COUNT] = {
        [X] = "x",         "y",  "z", [CHARGE] = "q", [MOLECULE] = "mol", [TYPE] = "type",
        [VELOCITY] = "vx", "vy", "vz"};
    *end = file->frame > 0;
    if (*end) return BP_OK;
    Data *const data = calloc(1, sizeof *data);
    if (data == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory");
    char *line = NULL;
    BpStatus status = take_header(&file->input, &line, data, err);
    if (status == BP_OK) status = frame_begin(file, columns, COLUMN_COUNT, err);
    if (status == BP_OK) {
        if (file->out != NULL) file->out->up = 2;
        add_cell(file, data);
        status = take_sections(file, line, data, err);
    }
    if (status == BP_OK) {
        set_elements(file, data);
        note_shapes(file->out, data);
    }
    data_destroy(data);
    return status;
}
