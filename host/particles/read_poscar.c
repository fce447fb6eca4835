/* read_poscar.c: POSCAR, CONTCAR and XDATCAR, the structures and trajectories of VASP; see reader.h.
 *
 * A head has a title, a scale, the cell's edges, names of species (from version 5 on) and numbers of their
 * atoms. Behind it is one frame, which may have velocities; or, in XDATCAR, many, each below a line with its
 * number and, where the cell changes, below a head of its own. */
#include "base/plural.h"
#include "elements.h"
#include "reader.h"
#include "scene/vector.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { SPECIES_MAX = 256, WORDS_MAX = 8, SPECIES_SIZE = 64 };

typedef struct Species {
    char name[SPECIES_SIZE];
    uint64_t count;
} Species;

/* What a head says; it holds for the frames below it. */
typedef struct State {
    double edges[3][3], scale[3]; /* scale: of Cartesian places along x, y, z */
    Species species[SPECIES_MAX];
    size_t species_count;
    bool named, titled; /* the names are the file's; they stand in its title */
    bool is_trajectory;
    uint64_t atoms;
    double (*velocity)[3]; /* of one frame; NULL: none */
} State;

void poscar_state_destroy(void *state) {
    State *const poscar = state;
    if (poscar == NULL) return;
    free(poscar->velocity);
    free(poscar);
}

static bool is_blank(const char *line) {
    return line[strspn(line, " \t\r")] == '\0';
}

/* The line that stands before the places of each frame of a trajectory. */
static bool is_frame_line(const char *line) {
    return strstr(line, "onfiguration=") != NULL;
}

/* ---- the head ------------------------------------------------------------------------------------------ */

/* One number, which is a volume if it is negative, or one for each of x, y and z. */
static BpStatus take_scale(const Input *input, char *line, double scale[3], double *volume, BpError *err) {
    static const char expected[] = "the scale of the cell: one number other than 0, or three above 0";
    char *words[WORDS_MAX];
    double values[3] = {0};
    size_t count = split_words(line, words, WORDS_MAX), numbers = 0;
    if (count > WORDS_MAX) count = WORDS_MAX;
    while (numbers < count && numbers < 3 && word_number(words[numbers], &values[numbers])) numbers++;
    if (numbers == 0 || values[0] == 0) return input_wrong(input, count > 0 ? words[0] : "", expected, err);
    const bool three = numbers == 3;
    for (int i = 0; i < 3; i++) {
        scale[i] = three ? values[i] : fmax(values[0], 0);
        if (three && !(scale[i] > 0)) return input_wrong(input, words[i], expected, err);
    }
    *volume = !three && values[0] < 0 ? -values[0] : 0;
    return BP_OK;
}

static BpStatus take_vector(const Input *input, char **words, size_t count, const char *expected,
                            double out[3], BpError *err) {
    for (size_t i = 0; i < 3; i++)
        if (i >= count || !word_number(words[i], &out[i]))
            return input_wrong(input, i < count ? words[i] : "the end of the line", expected, err);
    return BP_OK;
}

static BpStatus take_edges(Input *input, State *state, BpError *err) {
    char *line = NULL, *words[WORDS_MAX];
    double volume = 0, cross[3];
    BP_TRY(input_needed_line(input, &line, "the scale of the cell", err));
    BP_TRY(take_scale(input, line, state->scale, &volume, err));
    for (int e = 0; e < 3; e++) {
        BP_TRY(input_needed_line(input, &line, "an edge of the cell", err));
        const size_t count = split_words(line, words, WORDS_MAX);
        BP_TRY(take_vector(input, words, count, "an edge of the cell: three numbers", state->edges[e], err));
    }
    bp_cross(state->edges[0], state->edges[1], cross);
    const double found = fabs(bp_dot(cross, state->edges[2]));
    if (!(found > 0) || !isfinite(found))
        return input_fail(input, true, err,
                          "found edges of the cell that span no volume, expected three that do");
    for (int i = 0; i < 3 && volume > 0; i++) state->scale[i] = cbrt(volume / found);
    for (int e = 0; e < 3; e++)
        for (int i = 0; i < 3; i++) state->edges[e][i] *= state->scale[i];
    return BP_OK;
}

/* The symbol in a species' name, which may have the name of its potential behind it: Fe_pv, Fe/0123abcd,
 * H.75. */
static uint8_t element_of(const char *name) {
    char symbol[SPECIES_SIZE];
    snprintf(symbol, sizeof symbol, "%s", name);
    symbol[strcspn(symbol, "/.")] = '\0';
    return bp_element_of_species(symbol);
}

/* Keeps names of species; false: there are too many or too long ones. */
static bool keep_names(State *state, char *const *words, size_t count) {
    for (size_t i = 0; i < count; i++) {
        if (strlen(words[i]) >= SPECIES_SIZE) return false;
        snprintf(state->species[i].name, SPECIES_SIZE, "%s", words[i]);
    }
    return true;
}

static BpStatus take_counts(const Input *input, State *state, char *const *words, size_t count,
                            BpError *err) {
    state->atoms = 0;
    for (size_t i = 0; i < count; i++) {
        BP_TRY(word_count(input, words[i], "atoms of a species", &state->species[i].count, err));
        state->atoms += state->species[i].count;
    }
    if (state->atoms > 0 && state->atoms <= BP_PARTICLES_MAX) return BP_OK;
    return input_fail(input, true, err, "found numbers of atoms that add up to %llu, expected 1 to %u",
                      (unsigned long long)state->atoms, BP_PARTICLES_MAX);
}

/* Files of VASP 4 have no names of species; their titles often have them. */
static void take_names_of_title(State *state, char *title) {
    char *words[SPECIES_MAX];
    const size_t count = split_words(title, words, SPECIES_MAX);
    if (count != state->species_count) return;
    for (size_t i = 0; i < count; i++)
        if (element_of(words[i]) == 0) return;
    state->titled = keep_names(state, words, count);
}

static BpStatus take_species(Input *input, State *state, char *title, BpError *err) {
    static const char expected[] = "names of species, or the numbers of their atoms";
    char *line = NULL, *words[SPECIES_MAX];
    int64_t whole = 0;
    BP_TRY(input_needed_line(input, &line, expected, err));
    size_t count = split_words(line, words, SPECIES_MAX);
    if (count == 0 || count > SPECIES_MAX)
        return input_fail(input, true, err, "found %zu words, expected %s, at most %d", count, expected,
                          SPECIES_MAX);
    state->named = !word_whole(words[0], &whole);
    state->titled = false;
    const size_t named = count;
    if (state->named) {
        if (!keep_names(state, words, count)) return input_wrong(input, words[0], "names of species", err);
        BP_TRY(input_needed_line(input, &line, "the numbers of atoms of the species", err));
        count = split_words(line, words, SPECIES_MAX);
    }
    size_t numbers = 0; /* remarks may follow */
    while (numbers < count && numbers < SPECIES_MAX && word_whole(words[numbers], &whole)) numbers++;
    if (state->named && numbers != named)
        return input_fail(input, true, err, "found %zu number%s of atoms, expected %zu, one below each name",
                          numbers, bp_plural(numbers), named);
    state->species_count = numbers;
    BP_TRY(take_counts(input, state, words, numbers, err));
    if (!state->named) take_names_of_title(state, title);
    return BP_OK;
}

/* The title was taken already. */
static BpStatus take_head(Input *input, State *state, const char *title, BpError *err) {
    char text[1024];
    snprintf(text, sizeof text, "%s", title);
    BP_TRY(take_edges(input, state, err));
    return take_species(input, state, text, err);
}

/* ---- atoms --------------------------------------------------------------------------------------------- */

/* The line that says what places are: shares of the cell, or Cartesian. */
static BpStatus take_kind(Input *input, State *state, bool *is_cartesian, BpError *err) {
    static const char expected[] = "\"Direct\" or \"Cartesian\", which says what the places are";
    char *line = NULL;
    BP_TRY(input_full_line(input, &line, err));
    if (line != NULL && strchr("sS", line[strspn(line, " \t")]) != NULL)
        BP_TRY(input_full_line(input, &line, err)); /* Selective dynamics */
    if (line == NULL) return input_fail(input, true, err, "found the end of the file, expected %s", expected);
    const char first = line[strspn(line, " \t")];
    *is_cartesian = strchr("cCkK", first) != NULL;
    state->is_trajectory = is_frame_line(line);
    if (*is_cartesian || strchr("dD", first) != NULL) return BP_OK;
    return input_wrong(input, line, expected, err);
}

static void find_place(const State *state, bool is_cartesian, const double given[3], double place[3]) {
    for (int i = 0; i < 3; i++) {
        place[i] = is_cartesian ? given[i] * state->scale[i] : 0;
        for (int e = 0; e < 3 && !is_cartesian; e++) place[i] += given[e] * state->edges[e][i];
    }
}

/* The name of the element behind the numbers, which some programs write. NULL: there is none. */
static const char *name_behind(char *const *words, size_t count) {
    for (size_t i = 3; i < count && i < WORDS_MAX; i++)
        if (strcmp(words[i], "T") != 0 && strcmp(words[i], "F") != 0)
            return element_of(words[i]) != 0 ? words[i] : NULL;
    return NULL;
}

static BpStatus take_atoms(BpParticleFile *file, State *state, bool is_cartesian, BpError *err) {
    Input *const input = &file->input;
    size_t kind = 0, unnamed = 0;
    uint64_t of_kind = 0;
    for (uint64_t i = 0; i < state->atoms; i++) {
        char *line = NULL, *words[WORDS_MAX];
        double given[3];
        Particle particle = PARTICLE_NONE;
        BP_TRY(input_full_line(input, &line, err));
        if (line == NULL)
            return input_fail(input, true, err,
                              "found the end of the file, expected %llu atoms, as the head says",
                              (unsigned long long)state->atoms);
        const size_t count = split_words(line, words, WORDS_MAX);
        BP_TRY(take_vector(input, words, count, "the place of an atom: three numbers", given, err));
        find_place(state, is_cartesian, given, particle.position);
        while (of_kind == state->species[kind].count) {
            kind++;
            of_kind = 0;
        }
        of_kind++;
        char number[24];
        snprintf(number, sizeof number, "%zu", kind + 1);
        const bool has_name = state->named || state->titled;
        const char *const behind = has_name ? NULL : name_behind(words, count);
        const char *const name = has_name ? state->species[kind].name : behind != NULL ? behind : number;
        particle.type = name;
        particle.element = has_name || behind != NULL ? element_of(name) : 0;
        unnamed += !has_name && behind == NULL;
        const double *const velocity = state->velocity != NULL ? state->velocity[i] : NULL;
        const double none[3] = {NAN, NAN, NAN};
        particle.values = velocity != NULL ? velocity : none;
        BP_TRY(frame_add(file, &particle, true, err));
    }
    if (file->out == NULL) return BP_OK;
    if (state->titled) bp_particles_note(file->out, "elements from the title");
    if (unnamed > 0)
        bp_particles_note(file->out,
                          "no elements in the file: write them into a line above the numbers of atoms");
    return BP_OK;
}

/* ---- velocities ---------------------------------------------------------------------------------------- */

/* Passes over velocities of the cell (a line of words, a number, six vectors), if they are there. */
static BpStatus skip_cell_velocities(Input *input, char **line, BpError *err) {
    if (*line == NULL || strchr("lL", (*line)[strspn(*line, " \t")]) == NULL || is_blank(*line)) return BP_OK;
    for (int i = 0; i < 8 && *line != NULL; i++) BP_TRY(input_line(input, line, err));
    return BP_OK;
}

/* The velocities behind the places, if each atom has one. What else is there is of no concern. */
static bool take_velocities(Input *input, State *state, double (*velocity)[3]) {
    char *line = NULL, *words[WORDS_MAX];
    if (input_line(input, &line, NULL) != BP_OK) return false;
    if (skip_cell_velocities(input, &line, NULL) != BP_OK || line == NULL) return false;
    const char first = line[strspn(line, " \t\r")];
    const bool is_direct = first != '\0' && strchr("dD", first) != NULL;
    if (!is_direct && first != '\0' && strchr("cCkK", first) == NULL) return false;
    for (uint64_t i = 0; i < state->atoms; i++) {
        double given[3];
        if (input_line(input, &line, NULL) != BP_OK || line == NULL) return false;
        if (split_words(line, words, WORDS_MAX) != 3) return false;
        for (int k = 0; k < 3; k++)
            if (!word_number(words[k], &given[k])) return false;
        for (int k = 0; k < 3; k++) {
            velocity[i][k] = is_direct ? 0 : given[k];
            for (int e = 0; e < 3 && is_direct; e++) velocity[i][k] += given[e] * state->edges[e][k];
        }
    }
    return true;
}

/* Looks for velocities where a colour or a radius needs them; then goes back to the places. */
static BpStatus find_velocities(BpParticleFile *file, State *state, BpError *err) {
    Input *const input = &file->input;
    const uint64_t taken = input->taken, at = input->line;
    char *line = NULL;
    if (file->out == NULL || file->wanted_count == 0 || state->is_trajectory) return BP_OK;
    for (uint64_t i = 0; i < state->atoms; i++) {
        if (input_full_line(input, &line, NULL) != BP_OK) break;
        if (line == NULL) break;
    }
    /* As many lines as there are places were there, so the number is no empty promise. */
    if (line != NULL) {
        free(state->velocity);
        state->velocity = malloc(state->atoms * sizeof *state->velocity);
        if (state->velocity == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for velocities");
        if (!take_velocities(input, state, state->velocity)) {
            free(state->velocity);
            state->velocity = NULL;
        }
    }
    return input_return_to(input, taken, at, err);
}

/* ---- frames -------------------------------------------------------------------------------------------- */

/* The title of the first head, or what stands before the next frame of a trajectory. */
static BpStatus begin_frame(BpParticleFile *file, State *state, bool *is_cartesian, bool *end, BpError *err) {
    Input *const input = &file->input;
    char *line = NULL;
    if (file->frame == 0)
        BP_TRY(input_line(input, &line, err));
    else
        BP_TRY(input_full_line(input, &line, err));
    *end = line == NULL && file->frame > 0;
    if (*end) return BP_OK;
    if (line == NULL)
        return input_fail(input, true, err, "found the end of the file, expected the title of a POSCAR file");
    if (file->frame > 0 && is_frame_line(line)) {
        *is_cartesian = strchr("cC", line[strspn(line, " \t")]) != NULL;
        return BP_OK;
    }
    BP_TRY(take_head(input, state, line, err));
    return take_kind(input, state, is_cartesian, err);
}

BpStatus read_poscar(BpParticleFile *file, bool *end, BpError *err) {
    static const char *const columns[] = {"vx", "vy", "vz"};
    static const double origin[3] = {0, 0, 0};
    if (file->state == NULL) file->state = calloc(1, sizeof(State));
    State *const state = file->state;
    bool is_cartesian = false;
    if (state == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory");
    if (file->frame > 0 && !state->is_trajectory) {
        *end = true; /* what stands behind the places is no frame */
        return BP_OK;
    }
    BP_TRY(begin_frame(file, state, &is_cartesian, end, err));
    if (*end) return BP_OK;
    BP_TRY(frame_begin(file, columns, 3, err));
    if (file->out != NULL) {
        file->out->angstrom = 1;
        file->out->up = 2;
    }
    frame_cell(file, origin, (const double(*)[3])state->edges, FRAME_PERIODIC);
    BP_TRY(find_velocities(file, state, err));
    return take_atoms(file, state, is_cartesian, err);
}

bool poscar_has_more(const void *state, bool text_follows) {
    return ((const State *)state)->is_trajectory && text_follows;
}
