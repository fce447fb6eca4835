/* read_dump.c: LAMMPS dump files in text form (dump custom, atom and their like); see reader.h.
 *
 * Knows: wrapped, scaled and unwrapped coordinates; boxes that are orthogonal, triclinic in LAMMPS's own
 * form, and triclinic by three vectors; units. */
#include "column_names.h"
#include "elements.h"
#include "lammps.h"
#include "reader.h"

#include <stdlib.h>
#include <string.h>

enum { WORDS_MAX = BP_PARTICLE_COLUMNS_MAX, BOX_LINE = 64, BOX_WORDS = 8 };

typedef struct Dump {
    double origin[3], edges[3][3];
    bool has_box, periodic[3], scaled, unwrapped;
    char header[4096]; /* the words after ITEM: ATOMS */
    char *columns[WORDS_MAX];
    size_t column_count;
    int position[3], shape[3], color[3], type, element, radius, diameter, mass,
        molecule;        /* places of columns; -1: nowhere */
    size_t known_masses; /* those of elements, in this frame */
    bool united;         /* some stand for a carbon and its hydrogens */
    int block[2];        /* the columns of a superellipsoid's exponents; below 0: none */
    int quaternion[4];   /* the columns of w, x, y, z; the first below 0: there are none */
    const char *order;   /* how those are read that do not say which they are; NULL: they do */
} Dump;

/* What is kept from frame to frame: a dump names its units once. */
typedef struct State {
    const LammpsUnits *units; /* NULL: it names none */
} State;

/* The last three words are the boundaries, two letters each: those of the lower side and of the upper one. An
 * edge repeats if both are p. Old files have no such words. */
static void take_boundaries(const char *flags, bool periodic[3]) {
    char text[BOX_LINE], *words[BOX_WORDS];
    snprintf(text, sizeof text, "%s", flags);
    const size_t count = split_words(text, words, BOX_WORDS);
    for (size_t i = 0; i < 3; i++)
        periodic[i] = count >= 3 && count <= BOX_WORDS && strcmp(words[count - 3 + i], "pp") == 0;
}

static BpStatus take_box(Input *input, const char *flags, Dump *dump, BpError *err) {
    const bool triclinic = strstr(flags, "xy xz yz") != NULL, general = strstr(flags, "abc") != NULL;
    const size_t count = general ? 4 : triclinic ? 3 : 2;
    double value[3][4] = {{0}};
    take_boundaries(flags, dump->periodic);
    for (int i = 0; i < 3; i++) {
        char *line = NULL, *words[4];
        BP_TRY(input_needed_line(input, &line, "three lines of bounds", err));
        if (split_words(line, words, 4) != count)
            return input_fail(input, true, err,
                              "found another number of words, expected %zu numbers of a box", count);
        for (size_t k = 0; k < count; k++)
            if (!word_number(words[k], &value[i][k]))
                return input_wrong(input, words[k], "a finite number", err);
    }
    memset(dump->edges, 0, sizeof dump->edges);
    if (general) {
        for (int i = 0; i < 3; i++) {
            memcpy(dump->edges[i], value[i], sizeof dump->edges[i]);
            dump->origin[i] = value[i][3];
        }
    } else {
        /* The bounds are those of the box around the parallelepiped (LAMMPS manual, "Howto triclinic"). */
        const double xy = value[0][2], xz = value[1][2], yz = value[2][2];
        dump->origin[0] = value[0][0] - fmin(fmin(0, xy), fmin(xz, xy + xz));
        dump->origin[1] = value[1][0] - fmin(0, yz);
        dump->origin[2] = value[2][0];
        dump->edges[0][0] = value[0][1] - fmax(fmax(0, xy), fmax(xz, xy + xz)) - dump->origin[0];
        dump->edges[1][0] = xy;
        dump->edges[1][1] = value[1][1] - fmax(0, yz) - dump->origin[1];
        dump->edges[2][0] = xz;
        dump->edges[2][1] = yz;
        dump->edges[2][2] = value[2][1] - dump->origin[2];
    }
    dump->has_box = true;
    return BP_OK;
}

static int place_of(const Dump *dump, const char *name) {
    for (size_t i = 0; i < dump->column_count; i++)
        if (strcmp(dump->columns[i], name) == 0) return (int)i;
    return -1;
}

/* The columns of an ellipsoid's three diameters, under the name of the attribute or as a compute "shape" or
 * "diameter" has them. */
static void find_shape(Dump *dump) {
    static const char *const sets[3][3] = {{"shapex", "shapey", "shapez"},
                                           {"c_shape[1]", "c_shape[2]", "c_shape[3]"},
                                           {"c_diameter[1]", "c_diameter[2]", "c_diameter[3]"}};
    for (int s = 0; s < 3; s++) {
        for (int i = 0; i < 3; i++) dump->shape[i] = place_of(dump, sets[s][i]);
        if (dump->shape[0] >= 0 && dump->shape[1] >= 0 && dump->shape[2] >= 0) return;
    }
    dump->shape[0] = -1;
}

/* The columns of a quaternion, w first. Computes do not say in which order they have it: "orient" is that of
 * OVITO's manual, whose importer has the scalar last; others go by LAMMPS's own order, as people name them.
 */
static void find_quaternion(Dump *dump) {
    static const struct {
        const char *name[4];
        const char *order;
    } sets[4] = {
        {{"quatw", "quati", "quatj", "quatk"}, NULL},
        {{"c_orient[4]", "c_orient[1]", "c_orient[2]", "c_orient[3]"},
         "c_orient[1] to [4] read as quati, quatj, quatk and quatw"},
        {{"c_q[1]", "c_q[2]", "c_q[3]", "c_q[4]"}, "c_q[1] to [4] read as quatw, quati, quatj and quatk"},
        {{"c_quat[1]", "c_quat[2]", "c_quat[3]", "c_quat[4]"},
         "c_quat[1] to [4] read as quatw, quati, quatj and quatk"}};
    for (int s = 0; s < 4; s++) {
        bool whole = true;
        for (int i = 0; i < 4; i++) {
            dump->quaternion[i] = place_of(dump, sets[s].name[i]);
            whole &= dump->quaternion[i] >= 0;
        }
        dump->order = sets[s].order;
        if (whole) return;
    }
    dump->quaternion[0] = -1;
}

static BpStatus take_columns(Input *input, const char *text, Dump *dump, BpError *err) {
    static const char *const sets[4][3] = {
        {"x", "y", "z"}, {"xs", "ys", "zs"}, {"xu", "yu", "zu"}, {"xsu", "ysu", "zsu"}};
    snprintf(dump->header, sizeof dump->header, "%s", text);
    dump->column_count = split_words(dump->header, dump->columns, WORDS_MAX);
    if (dump->column_count > WORDS_MAX)
        return input_fail(input, true, err, "found %zu columns, expected at most %d", dump->column_count,
                          WORDS_MAX);
    dump->type = place_of(dump, "type");
    if (dump->type < 0) dump->type = place_of(dump, "typelabel");
    dump->element = place_of(dump, "element");
    dump->radius = place_of(dump, "radius");
    dump->diameter = place_of(dump, "diameter");
    dump->mass = place_of(dump, "mass");
    dump->molecule = place_of(dump, "mol");
    find_shape(dump);
    find_quaternion(dump);
    dump->block[0] = place_of(dump, "block1");
    dump->block[1] = place_of(dump, "block2");
    if (!column_find_color((const char *const *)dump->columns, dump->column_count, dump->color))
        dump->color[0] = -1;
    for (int s = 0; s < 4; s++) {
        for (int i = 0; i < 3; i++) dump->position[i] = place_of(dump, sets[s][i]);
        if (dump->position[0] < 0 || dump->position[1] < 0 || dump->position[2] < 0) continue;
        dump->scaled = s % 2 == 1;
        dump->unwrapped = s >= 2;
        if (!dump->scaled || dump->has_box) return BP_OK;
        return input_fail(input, true, err,
                          "found scaled coordinates before the box, expected ITEM: BOX BOUNDS");
    }
    return input_fail(input, true, err,
                      "found no columns of coordinates, expected x y z, xu yu zu, xs ys zs or xsu ysu zsu");
}

/* Elements of masses count for all atoms of the frame or for none, as in data files. */
static void settle_masses(BpParticles *p, const Dump *dump, size_t count) {
    if (p == NULL || dump->element >= 0 || dump->mass < 0) return;
    for (size_t i = 0; i < p->count && dump->known_masses < count; i++) p->tag[i].element = 0;
    p->has_element = p->has_element && dump->known_masses == count;
    if (p->angstrom == 0 && p->has_element) p->angstrom = 1;
    atom_note_masses(p, dump->known_masses, count, "atoms", dump->united);
}

static BpStatus take_shape(const Input *input, const Dump *dump, char *const *words, Particle *particle,
                           BpError *err) {
    if (dump->shape[0] < 0) return BP_OK;
    for (int i = 0; i < 3; i++) {
        if (!word_number(words[dump->shape[i]], &particle->half_axes[i]))
            return input_wrong(input, words[dump->shape[i]], "a diameter", err);
        particle->half_axes[i] /= 2;
    }
    for (int i = 0; i < 2; i++) {
        double exponent = 0;
        if (dump->block[i] < 0) continue;
        particle->super |= word_number(words[dump->block[i]], &exponent) && exponent != 2;
    }
    for (int i = 0; i < 4 && dump->quaternion[0] >= 0; i++)
        if (!word_number(words[dump->quaternion[i]], &particle->orientation[i]))
            return input_wrong(input, words[dump->quaternion[i]], "a number of a quaternion", err);
    return BP_OK;
}

static BpStatus take_atom(BpParticleFile *file, Dump *dump, char *line, BpError *err) {
    char *words[WORDS_MAX];
    double values[WORDS_MAX], place[3];
    Particle particle = PARTICLE_NONE;
    const size_t found = split_words(line, words, WORDS_MAX);
    if (found != dump->column_count)
        return input_fail(&file->input, true, err, "found %zu word%s, expected %zu, as ITEM: ATOMS says",
                          found, found == 1 ? "" : "s", dump->column_count);
    for (int i = 0; i < 3; i++)
        if (!word_number_or_none(words[dump->position[i]], &place[i]))
            return input_wrong(&file->input, words[dump->position[i]], "a coordinate", err);
    for (int i = 0; i < 3; i++) {
        particle.position[i] = dump->scaled ? dump->origin[i] : place[i];
        for (int k = 0; k < 3 && dump->scaled; k++) particle.position[i] += place[k] * dump->edges[k][i];
    }
    if (dump->type >= 0) particle.type = words[dump->type];
    if (dump->element >= 0) {
        particle.element = bp_element_of_species(words[dump->element]);
        if (dump->type < 0) particle.type = words[dump->element];
    } else if (dump->mass >= 0) {
        const State *const state = file->state;
        const double dalton = state->units != NULL ? state->units->dalton : 1;
        bool united = false;
        double mass = 0;
        if (dalton > 0 && word_number(words[dump->mass], &mass))
            particle.element = bp_element_of_mass(mass / dalton, &united);
        dump->known_masses += particle.element != 0;
        dump->united |= united;
    }
    if (dump->radius >= 0 && !word_number(words[dump->radius], &particle.radius))
        return input_wrong(&file->input, words[dump->radius], "a radius", err);
    if (dump->radius < 0 && dump->diameter >= 0) {
        if (!word_number(words[dump->diameter], &particle.radius))
            return input_wrong(&file->input, words[dump->diameter], "a diameter", err);
        particle.radius /= 2;
    }
    for (int i = 0; i < 3 && dump->color[0] >= 0; i++)
        if (!word_number(words[dump->color[i]], &particle.color[i]))
            return input_wrong(&file->input, words[dump->color[i]], "a finite number: a share of a colour",
                               err);
    BP_TRY(take_shape(&file->input, dump, words, &particle, err));
    for (size_t w = 0; w < file->taken_count; w++) {
        const int c = file->wanted_column[w];
        if (!word_number(words[c], &values[c])) values[c] = NAN;
    }
    particle.values = values;
    return frame_add(file, &particle, true, err);
}

static BpStatus take_units(const Input *input, char *line, State *state, BpError *err) {
    char *word = line;
    if (split_words(line, &word, 1) == 1) state->units = lammps_units_find(word);
    if (state->units != NULL) return BP_OK;
    return input_wrong(input, word, "units: " LAMMPS_UNIT_NAMES, err);
}

/* The frame from ITEM: TIMESTEP, which is taken, to its last atom. */
static BpStatus take_frame(BpParticleFile *file, Dump *dump, BpError *err) {
    static const char expected[] = "ITEM: NUMBER OF ATOMS, BOX BOUNDS and ATOMS";
    Input *const input = &file->input;
    char *line = NULL, *words[2];
    uint64_t count = 0;
    bool has_count = false;
    for (;;) {
        BP_TRY(input_needed_line(input, &line, expected, err));
        if (strncmp(line, "ITEM: NUMBER OF ATOMS", 21) == 0) {
            BP_TRY(input_needed_line(input, &line, "the number of atoms", err));
            const size_t found = split_words(line, words, 2);
            BP_TRY(word_count(input, found == 1 ? words[0] : "other words", "atoms", &count, err));
            has_count = true;
        } else if (strncmp(line, "ITEM: BOX BOUNDS", 16) == 0) {
            char flags[BOX_LINE];
            snprintf(flags, sizeof flags, "%s", line + 16);
            BP_TRY(take_box(input, flags, dump, err));
        } else if (strncmp(line, "ITEM: ATOMS", 11) == 0) {
            break;
        } else if (strncmp(line, "ITEM:", 5) == 0) { /* UNITS, TIME: one line each */
            const bool units = strncmp(line, "ITEM: UNITS", 11) == 0;
            BP_TRY(input_needed_line(input, &line, "a line after ITEM", err));
            if (units) BP_TRY(take_units(input, line, file->state, err));
        } else {
            return input_wrong(input, line, expected, err);
        }
    }
    if (!has_count)
        return input_fail(input, true, err, "found ITEM: ATOMS first, expected ITEM: NUMBER OF ATOMS");
    BP_TRY(take_columns(input, line + 11, dump, err));
    BP_TRY(frame_begin(file, (const char *const *)dump->columns, dump->column_count, err));
    file->shapes.has_orientations = dump->quaternion[0] >= 0;
    file->shapes.order = dump->order;
    file->colors.ambiguous = dump->color[0] >= 0;
    if (dump->shape[0] >= 0) file->unread_shape[0] = '\0';
    if (file->out != NULL) {
        file->out->up = 2;
        const State *const state = file->state;
        if (state->units != NULL) file->out->angstrom = state->units->angstrom;
        if (state->units == NULL && dump->element >= 0) file->out->angstrom = 1;
    }
    if (dump->has_box)
        frame_cell(file, dump->origin, (const double(*)[3])dump->edges,
                   dump->unwrapped ? (const bool[3]){false, false, false} : dump->periodic);
    for (uint64_t i = 0; i < count; i++) {
        BP_TRY(input_needed_line(input, &line, "as many atoms as ITEM: NUMBER OF ATOMS says", err));
        BP_TRY(take_atom(file, dump, line, err));
    }
    settle_masses(file->out, dump, file->added);
    return BP_OK;
}

/* Behind the last atom there is nothing, or another frame, of which "ITEM:" may not be written whole yet. */
static BpStatus check_behind(BpParticleFile *file, BpError *err) {
    static const char item[] = "ITEM:";
    char text[1024];
    const char *const line = frame_line_behind(file, text);
    if (line == NULL || strncmp(line, item, strlen(line) < strlen(item) ? strlen(line) : strlen(item)) == 0)
        return BP_OK;
    return frame_fail_behind(file, "ITEM: NUMBER OF ATOMS", err);
}

BpStatus read_dump(BpParticleFile *file, bool *end, BpError *err) {
    Input *const input = &file->input;
    char *line = NULL;
    if (file->state == NULL) file->state = calloc(1, sizeof(State));
    if (file->state == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory");
    BP_TRY(input_full_line(input, &line, err));
    *end = line == NULL && file->frame > 0;
    if (*end) return BP_OK;
    /* UNITS and TIME come before TIMESTEP, each with a line of its own. */
    while (line != NULL && (strncmp(line, "ITEM: UNITS", 11) == 0 || strncmp(line, "ITEM: TIME", 10) == 0)) {
        const bool step = strncmp(line, "ITEM: TIMESTEP", 14) == 0, units = line[6] == 'U';
        BP_TRY(input_needed_line(input, &line, "a line after ITEM", err));
        if (units) BP_TRY(take_units(input, line, file->state, err));
        if (step) {
            Dump *const dump = calloc(1, sizeof *dump);
            if (dump == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory");
            const BpStatus status = take_frame(file, dump, err);
            free(dump);
            return status == BP_OK ? check_behind(file, err) : status;
        }
        BP_TRY(input_full_line(input, &line, err));
    }
    return input_fail(input, true, err, "found %s, expected ITEM: TIMESTEP, as %s begins",
                      line == NULL ? "the end of the file" : "another line",
                      file->frame == 0 ? "a LAMMPS dump" : "each frame");
}
