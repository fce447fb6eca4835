/* read_data.c: LAMMPS data files; see reader.h.
 *
 * Knows: the header, Masses, Atoms in the common styles, Bonds. Other sections are passed over. */
#include "elements.h"
#include "reader.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

enum { WORDS_MAX = 32, TYPES_MAX = 4096 };

enum {
    ATOMIC,
    CHARGE,
    MOLECULAR,
    BOND,
    ANGLE,
    FULL,
    SPHERE,
    DIPOLE,
    ELLIPSOID,
    BPM_SPHERE,
    DPD,
    PERI,
    HYBRID,
    STYLE_COUNT
};

/* Where the words of an atom's line stand, from 0; -1: nowhere. */
static const struct Style {
    const char *name;
    int words, type, molecule, charge, diameter, x;
} styles[STYLE_COUNT] = {
    [ATOMIC] = {"atomic", 5, 1, -1, -1, -1, 2},
    [CHARGE] = {"charge", 6, 1, -1, 2, -1, 3},
    [MOLECULAR] = {"molecular", 6, 2, 1, -1, -1, 3},
    [BOND] = {"bond", 6, 2, 1, -1, -1, 3},
    [ANGLE] = {"angle", 6, 2, 1, -1, -1, 3},
    [FULL] = {"full", 7, 2, 1, 3, -1, 4},
    [SPHERE] = {"sphere", 7, 1, -1, -1, 2, 4},
    [DIPOLE] = {"dipole", 9, 1, -1, 2, -1, 3},
    [ELLIPSOID] = {"ellipsoid", 7, 1, -1, -1, -1, 4},
    [BPM_SPHERE] = {"bpm/sphere", 8, 2, 1, -1, 3, 5},
    [DPD] = {"dpd", 6, 1, -1, -1, -1, 3},
    [PERI] = {"peri", 7, 1, -1, -1, -1, 4},
    [HYBRID] = {"hybrid", 5, 1, -1, -1, -1, 2},
};

typedef struct Data {
    uint64_t atoms, bonds;
    double low[3], high[3], tilt[3]; /* xy xz yz */
    bool has_box[3];
    const struct Style *style;
    uint8_t element[TYPES_MAX];
    bool has_masses, all_masses_known;
    int64_t *ids; /* of the atoms, in the file's order */
    size_t id_count, id_capacity;
} Data;

/* The sections that are read. Other sections of the format are passed over silently. */
enum { ATOMS, MASSES, BONDS };
static const char *const sections[] = {
    [ATOMS] = "Atoms", [MASSES] = "Masses", [BONDS] = "Bonds", "Velocities", "Angles", "Dihedrals",
    "Impropers",       "Ellipsoids",        "Lines",           "Triangles",  "Bodies"};

/* The number of the section that the line opens; -1: it opens none; -2: one that is not in the list. Lines of
 * data begin with a number, those of Masses perhaps with a label. */
static int section_of(const char *line, int section) {
    line += strspn(line, " \t");
    if (!isupper((unsigned char)*line)) return -1;
    for (size_t i = 0; i < sizeof sections / sizeof *sections; i++) {
        const size_t length = strlen(sections[i]);
        const char *const rest = line + length;
        if (strncmp(line, sections[i], length) == 0 &&
            (rest[strspn(rest, " \t\r")] == '\0' || rest[strspn(rest, " \t\r")] == '#'))
            return (int)i;
    }
    const bool label = section == MASSES && strpbrk(line, "0123456789") != NULL;
    return label ? -1 : -2;
}

static void cut_comment(char *line) {
    line[strcspn(line, "#")] = '\0';
}

static BpStatus take_header(Input *input, char **line, Data *data, BpError *err) {
    static const char *const axes[] = {"xlo", "ylo", "zlo"};
    char *words[WORDS_MAX];
    /* The first line is a title, whatever it says. */
    BP_TRY(input_needed_line(input, line, "a LAMMPS data file's title", err));
    for (;;) {
        BP_TRY(input_full_line(input, line, err));
        if (*line == NULL || section_of(*line, -1) != -1) return BP_OK;
        cut_comment(*line);
        const size_t count = split_words(*line, words, WORDS_MAX);
        if (count == 2 && strcmp(words[1], "atoms") == 0)
            BP_TRY(word_count(input, words[0], "atoms", &data->atoms, err));
        if (count == 2 && strcmp(words[1], "bonds") == 0)
            BP_TRY(word_count(input, words[0], "bonds", &data->bonds, err));
        for (int i = 0; i < 3 && count == 4; i++) {
            if (strcmp(words[2], axes[i]) != 0) continue;
            if (!word_number(words[0], &data->low[i]) || !word_number(words[1], &data->high[i]))
                return input_wrong(input, words[0], "two bounds of the box", err);
            data->has_box[i] = true;
        }
        if (count == 6 && strcmp(words[3], "xy") == 0)
            for (int i = 0; i < 3; i++)
                if (!word_number(words[i], &data->tilt[i]))
                    return input_wrong(input, words[i], "a tilt", err);
    }
}

static void add_cell(BpParticleFile *file, const Data *data) {
    if (!data->has_box[0] || !data->has_box[1] || !data->has_box[2]) return;
    const double edges[3][3] = {{data->high[0] - data->low[0], 0, 0},
                                {data->tilt[0], data->high[1] - data->low[1], 0},
                                {data->tilt[1], data->tilt[2], data->high[2] - data->low[2]}};
    frame_cell(file, data->low, edges, FRAME_PERIODIC);
}

static bool looks_whole(const char *word) {
    int64_t value = 0;
    return word_whole(word, &value);
}

/* The style that the section's comment names (Atoms # full). If it names no style known here, the style that
 * the first line fits. */
static BpStatus choose_style(BpParticleFile *file, const char *named, char **words, size_t count, Data *data,
                             BpError *err) {
    for (size_t i = 0; i < STYLE_COUNT; i++)
        if (strcmp(named, styles[i].name) == 0) data->style = &styles[i];
    if (data->style != NULL) return BP_OK;
    int guess = ATOMIC;
    switch (count) { /* three words more are the counts of periodic images */
    case 5:
    case 8:
        guess = ATOMIC;
        break;
    case 6:
    case 9:
        guess = looks_whole(words[2]) ? MOLECULAR : CHARGE;
        break;
    case 7:
    case 10:
        guess = looks_whole(words[1]) && looks_whole(words[2]) ? FULL : SPHERE;
        break;
    default:
        return input_fail(&file->input, true, err,
                          "found %zu words, expected an atom's line; name the style behind the section: "
                          "Atoms # full",
                          count);
    }
    data->style = &styles[guess];
    if (file->out != NULL)
        bp_particles_note(file->out, "atom style %s from the number of words", data->style->name);
    return BP_OK;
}

static BpStatus keep_id(Data *data, const Input *input, const char *word, BpError *err) {
    if (data->id_count == data->id_capacity) {
        const size_t capacity = data->id_capacity > 0 ? 2 * data->id_capacity : 1024;
        int64_t *const ids = realloc(data->ids, capacity * sizeof *ids);
        if (ids == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for the numbers of atoms");
        data->ids = ids;
        data->id_capacity = capacity;
    }
    if (!word_whole(word, &data->ids[data->id_count]))
        return input_wrong(input, word, "an atom's number", err);
    data->id_count++;
    return BP_OK;
}

static BpStatus take_atom(BpParticleFile *file, Data *data, char **words, size_t count, BpError *err) {
    const struct Style *const style = data->style;
    Input *const input = &file->input;
    if (count < (size_t)style->words)
        return input_fail(input, true, err, "found %zu word%s, expected at least %d: atom style %s", count,
                          count == 1 ? "" : "s", style->words, style->name);
    double values[6];
    Particle particle = PARTICLE_NONE;
    for (int i = 0; i < 3; i++) {
        if (!word_number(words[style->x + i], &particle.position[i]))
            return input_wrong(input, words[style->x + i], "a coordinate", err);
        values[i] = particle.position[i];
    }
    const int places[3] = {style->charge, style->molecule, style->type};
    for (int i = 0; i < 3; i++)
        if (places[i] < 0 || !word_number(words[places[i]], &values[3 + i])) values[3 + i] = NAN;
    if (style->diameter >= 0) {
        double diameter = 0;
        if (!word_number(words[style->diameter], &diameter))
            return input_wrong(input, words[style->diameter], "a diameter", err);
        if (diameter > 0) particle.radius = diameter / 2;
    }
    particle.type = words[style->type];
    int64_t type = 0;
    if (data->all_masses_known && word_whole(particle.type, &type) && type > 0 && type < TYPES_MAX)
        particle.element = data->element[type];
    particle.values = values;
    BP_TRY(keep_id(data, input, words[0], err));
    return frame_add(file, &particle, true, err);
}

static BpStatus take_mass(const Input *input, Data *data, char **words, size_t count, BpError *err) {
    double mass = 0;
    int64_t type = 0;
    if (count != 2 || !word_number(words[1], &mass))
        return input_wrong(input, words[0], "a type and its mass", err);
    if (!data->has_masses) data->all_masses_known = true;
    data->has_masses = true;
    const uint8_t element = bp_element_of_mass(mass);
    data->all_masses_known &= element != 0;
    if (word_whole(words[0], &type) && type > 0 && type < TYPES_MAX) data->element[type] = element;
    return BP_OK;
}

typedef struct Place {
    int64_t id;
    uint32_t at;
} Place;

static int compare_places(const void *a, const void *b) {
    const int64_t one = ((const Place *)a)->id, other = ((const Place *)b)->id;
    return one < other ? -1 : one > other;
}

static BpStatus find_place(const Input *input, const Place *places, size_t count, const char *word,
                           uint32_t *at, BpError *err) {
    Place key = {0};
    if (!word_whole(word, &key.id)) return input_wrong(input, word, "an atom's number", err);
    const Place *const found =
        count > 0 ? bsearch(&key, places, count, sizeof *places, compare_places) : NULL;
    if (found == NULL) return input_wrong(input, word, "the number of an atom of this file", err);
    *at = found->at;
    return BP_OK;
}

/* Bonds may stand before the atoms only in files that LAMMPS itself refuses. */
static BpStatus take_bonds(BpParticleFile *file, Data *data, BpError *err) {
    Input *const input = &file->input;
    Place *const places = malloc((data->id_count + 1) * sizeof *places);
    if (places == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for the numbers of atoms");
    for (size_t i = 0; i < data->id_count; i++) places[i] = (Place){data->ids[i], (uint32_t)i};
    qsort(places, data->id_count, sizeof *places, compare_places);
    BpStatus status = BP_OK;
    for (uint64_t i = 0; i < data->bonds && status == BP_OK; i++) {
        char *line = NULL, *words[WORDS_MAX];
        uint32_t a = 0, b = 0;
        do {
            BP_TRY_GOTO(status, input_full_line(input, &line, err), done);
            if (line != NULL) cut_comment(line);
        } while (line != NULL && line[strspn(line, " \t\r")] == '\0');
        if (line == NULL || split_words(line, words, WORDS_MAX) < 4) {
            status = input_fail(input, true, err,
                                "found another line, expected bond %llu of %llu: number, type, "
                                "atom, atom",
                                (unsigned long long)i + 1, (unsigned long long)data->bonds);
            goto done;
        }
        BP_TRY_GOTO(status, find_place(input, places, data->id_count, words[2], &a, err), done);
        BP_TRY_GOTO(status, find_place(input, places, data->id_count, words[3], &b, err), done);
        status = frame_add_bond(file, a, b, err);
    }
done:
    free(places);
    return status;
}

static BpStatus take_sections(BpParticleFile *file, char *line, Data *data, BpError *err) {
    Input *const input = &file->input;
    char *words[WORDS_MAX], named[32] = "";
    int section = -1;
    bool has_atoms = false;
    for (; line != NULL;) {
        const int opened = section_of(line, section);
        if (opened == -2) {
            if (file->out != NULL && strstr(line, "Coeffs") == NULL && strstr(line, "Labels") == NULL)
                bp_particles_note(file->out, "section %.*s passed over", (int)strcspn(line, "#\r"), line);
            section = -2;
        } else if (opened >= 0) {
            section = opened;
            const char *const comment = strchr(line, '#');
            named[0] = '\0';
            if (comment != NULL) {
                const char *const word = comment + 1 + strspn(comment + 1, " \t");
                snprintf(named, sizeof named, "%.*s", (int)strcspn(word, " \t\r"), word);
            }
            if (section == ATOMS && has_atoms)
                return input_fail(input, true, err, "found Atoms a second time, expected it once");
            if (section == ATOMS) {
                has_atoms = true;
                if (file->out != NULL && data->all_masses_known) {
                    file->out->angstrom = 1;
                    bp_particles_note(file->out, "elements from masses");
                }
            }
            if (section == BONDS) BP_TRY(take_bonds(file, data, err));
        } else if (section == ATOMS || section == MASSES) {
            cut_comment(line);
            const size_t count = split_words(line, words, WORDS_MAX);
            if (count > WORDS_MAX)
                return input_fail(input, true, err, "found more than %d words, expected fewer", WORDS_MAX);
            if (section == MASSES && count > 0) BP_TRY(take_mass(input, data, words, count, err));
            if (section == ATOMS && count > 0) {
                if (data->style == NULL) BP_TRY(choose_style(file, named, words, count, data, err));
                BP_TRY(take_atom(file, data, words, count, err));
            }
        }
        BP_TRY(input_full_line(input, &line, err));
    }
    if (!has_atoms) return input_fail(input, false, err, "found no section Atoms, expected the atoms");
    if (data->id_count != data->atoms)
        return input_fail(
            input, false, err,
            "found %zu line%s of atoms, expected %llu, as the header says; the file is cut off, or "
            "its count is wrong",
            data->id_count, data->id_count == 1 ? "" : "s", (unsigned long long)data->atoms);
    return BP_OK;
}

BpStatus read_data(BpParticleFile *file, bool *end, BpError *err) {
    static const char *const columns[] = {"x", "y", "z", "q", "mol", "type"};
    *end = file->frame > 0;
    if (*end) return BP_OK;
    Data *const data = calloc(1, sizeof *data);
    if (data == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory");
    char *line = NULL;
    BpStatus status = take_header(&file->input, &line, data, err);
    if (status == BP_OK) status = frame_begin(file, columns, 6, err);
    if (status == BP_OK) {
        if (file->out != NULL) file->out->up = 2;
        add_cell(file, data);
        status = take_sections(file, line, data, err);
    }
    free(data->ids);
    free(data);
    return status;
}
