/* read_cif.c: mmCIF: the atoms of _atom_site, the cell, and how the cell lies; see reader.h.
 *
 * A crystal's file is handed to read_crystal.c. Each model is a frame, and so is each data block that has
 * atoms. The rows of models may stand in turns: then the table is read once for each model. */
#include "cif_block.h"
#include "crystal.h"
#include "places.h"

#include "base/hash.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { COLUMNS_MAX = 128 };

typedef enum Field {
    MODEL,
    SYMBOL,
    AUTH_NAME,
    LABEL_NAME,
    ALTERNATIVE,
    AUTH_RESIDUE,
    LABEL_RESIDUE,
    AUTH_CHAIN,
    LABEL_CHAIN,
    X,
    Y,
    Z,
    OCCUPANCY,
    B_FACTOR,
    AUTH_SEQUENCE,
    LABEL_SEQUENCE,
    INSERTION,
    RECORD,
    FIELD_COUNT
} Field;

static const char *const field_names[FIELD_COUNT] = {
    "pdbx_PDB_model_num", "type_symbol",    "auth_atom_id",  "label_atom_id",
    "label_alt_id",       "auth_comp_id",   "label_comp_id", "auth_asym_id",
    "label_asym_id",      "Cartn_x",        "Cartn_y",       "Cartn_z",
    "occupancy",          "B_iso_or_equiv", "auth_seq_id",   "label_seq_id",
    "pdbx_PDB_ins_code",  "group_PDB"};

/* The numbers of a block that say what the cell is and how it lies: lengths and angles, then two matrices of
 * three rows, each with its vector behind it. */
enum { LENGTHS = 0, ANGLES = 3, FRACT = 6, CARTN = 18, NUMBER_COUNT = 30 };

typedef struct Cell {
    double number[NUMBER_COUNT];
    bool has[NUMBER_COUNT];
} Cell;

/* A stretch of rows of one model. */
typedef struct Run {
    uint64_t model; /* its number as a text, hashed */
    size_t at;      /* which stretch of the table it is */
} Run;

/* What is kept from frame to frame: the table goes on where the last model ended. */
typedef struct State {
    CifTokens tokens;
    size_t column_count;
    int field_column[FIELD_COUNT]; /* -1: absent */
    Cell cell;
    bool in_table, found; /* its rows follow; some table was found */
    bool single;          /* the block's atoms are one row, written as items */
    bool held;            /* `row` is the first of the next frame */
    size_t table;         /* how many tables of atoms stand before this one */
    bool scanned;         /* `runs` are this table's */
    Run *runs;            /* the first of each model */
    size_t run_count, run_capacity, runs_taken;
    bool in_turns; /* the rows of some model do not stand together; frames are those of runs[runs_taken] on */
    char row[FIELD_COUNT][BP_PARTICLE_NAME_SIZE];
    Places places;
} State;

void cif_state_destroy(void *state) {
    State *const cif = state;
    if (cif == NULL) return;
    places_clear(&cif->places);
    free(cif->runs);
    free(cif);
}

bool cif_has_more(const void *state) {
    const State *const cif = state;
    return cif->held || cif->in_turns;
}

/* ---- the cell ----------------------------------------------------------------------------------------- */

/* The place of "matrix[2][3]" or "vector[2]" among the twelve numbers of a transformation; -1: another name.
 */
static int place_in_transformation(const char *name) {
    for (int place = 0; place < 12; place++) {
        char text[16];
        const int row = place / 4 + 1, column = place % 4 + 1;
        if (column < 4)
            snprintf(text, sizeof text, "matrix[%d][%d]", row, column);
        else
            snprintf(text, sizeof text, "vector[%d]", row);
        if (strcasecmp(name, text) == 0) return place;
    }
    return -1;
}

/* The number that an item gives; -1: none. */
static int number_of_item(const char *name) {
    /* The last three are chemfiles' names of the angles. */
    static const char *const cell[9] = {"length_a",     "length_b",    "length_c",
                                        "angle_alpha",  "angle_beta",  "angle_gamma",
                                        "length_alpha", "length_beta", "length_gamma"};
    if (strncasecmp(name, "_cell.", 6) == 0)
        for (int i = 0; i < 9; i++)
            if (strcasecmp(name + 6, cell[i]) == 0) return i < 6 ? i : i - 3;
    if (strncasecmp(name, "_atom_sites.", 12) != 0) return -1;
    const bool fract = strncasecmp(name + 12, "fract_transf_", 13) == 0;
    if (!fract && strncasecmp(name + 12, "Cartn_transf_", 13) != 0) return -1;
    const int place = place_in_transformation(name + 25);
    return place < 0 ? -1 : (fract ? FRACT : CARTN) + place;
}

static void take_number(Cell *cell, int item, const char *value) {
    if (item >= 0 && cif_number(value, &cell->number[item])) cell->has[item] = true;
}

/* A row counts if its three numbers are there; its vector is 0 where it is not. */
static bool take_row_of(const Cell *cell, int first, double row[4]) {
    for (int i = 0; i < 4; i++) row[i] = cell->has[first + i] ? cell->number[first + i] : 0;
    return cell->has[first] && cell->has[first + 1] && cell->has[first + 2];
}

static void put_cell(BpParticleFile *file, const Cell *cell) {
    CrystalFrame frame = {0};
    double edges[3][4];
    bool by_shares = false, by_edges = true;
    for (int i = 0; i < 3; i++) {
        frame.given[i] = take_row_of(cell, FRACT + 4 * i, frame.row[i]);
        by_shares |= frame.given[i];
        by_edges &= take_row_of(cell, CARTN + 4 * i, edges[i]);
    }
    if (!by_shares && by_edges) crystal_frame_of_edges(&frame, (const double(*)[4])edges);
    frame_cell_angles(file, &cell->number[LENGTHS], &cell->number[ANGLES]);
    crystal_turn_cell(file, &frame, "_atom_sites");
}

/* ---- what stands around the atoms --------------------------------------------------------------------- */

static bool is_of_atoms(const char *name) {
    return strncasecmp(name, "_atom_site.", 11) == 0;
}

/* Notes where a field of _atom_site stands; returns which it is, or FIELD_COUNT. */
static int take_field(State *state, const char *name, size_t column) {
    for (int f = 0; f < FIELD_COUNT && is_of_atoms(name); f++) {
        if (strcasecmp(name + 11, field_names[f]) != 0) continue;
        if (state->field_column[f] < 0) state->field_column[f] = (int)column;
        return f;
    }
    return FIELD_COUNT;
}

/* Whether the atoms have places; those of later blocks may lack them, and are passed over. */
static BpStatus check_fields(const Input *input, const State *state, bool *good, BpError *err) {
    *good = true;
    for (int f = X; f <= Z; f++) {
        if (state->field_column[f] >= 0) continue;
        *good = false;
        if (state->found) return BP_OK;
        return input_fail(input, true, err, "found no _atom_site.%s, expected Cartn_x, Cartn_y and Cartn_z",
                          field_names[f]);
    }
    return BP_OK;
}

static void forget_fields(State *state) {
    for (int f = 0; f < FIELD_COUNT; f++) state->field_column[f] = -1;
}

/* A table: stops at the first value of one of atoms, with state->in_table. Of one that gives the cell, the
 * first row is taken. */
static BpStatus take_loop(Input *input, State *state, BpError *err) {
    int item[COLUMNS_MAX];
    size_t count = 0;
    bool atoms = false;
    for (;; count++) {
        BP_TRY(cif_peek(&state->tokens, input, err));
        if (!cif_is_name(&state->tokens)) break;
        const char *const name = state->tokens.token;
        if (!atoms && is_of_atoms(name)) {
            atoms = true;
            state->single = false;
            forget_fields(state);
        }
        take_field(state, name, count);
        if (count < COLUMNS_MAX) item[count] = number_of_item(name);
        cif_take(&state->tokens);
        if (atoms && count >= COLUMNS_MAX)
            return input_fail(input, true, err, "found a table of more than %d columns, expected fewer",
                              COLUMNS_MAX);
    }
    state->column_count = count;
    if (atoms) return check_fields(input, state, &state->in_table, err);
    for (size_t c = 0; c < count && c < COLUMNS_MAX; c++) {
        BP_TRY(cif_peek(&state->tokens, input, err));
        if (!cif_is_value(&state->tokens)) break;
        take_number(&state->cell, item[c], state->tokens.token);
        cif_take(&state->tokens);
    }
    return BP_OK;
}

static BpStatus keep_value(const Input *input, State *state, int field, const char *value, BpError *err) {
    const size_t room = sizeof state->row[field];
    if (strlen(value) >= room)
        return input_fail(input, true, err,
                          "found a value of %zu bytes in _atom_site.%s, expected at most %zu", strlen(value),
                          field_names[field], room - 1);
    snprintf(state->row[field], room, "%s", value);
    return BP_OK;
}

/* A name and its value. A table of one row may be written so. */
static BpStatus take_item(Input *input, State *state, BpError *err) {
    char name[CIF_TEXT_SIZE];
    snprintf(name, sizeof name, "%s", state->tokens.token);
    cif_take(&state->tokens);
    BP_TRY(cif_peek(&state->tokens, input, err));
    if (!cif_is_value(&state->tokens)) return BP_OK;
    const char *const value = state->tokens.token;
    take_number(&state->cell, number_of_item(name), value);
    if (!state->single && is_of_atoms(name)) {
        state->single = true;
        forget_fields(state);
    }
    const int field = take_field(state, name, 0);
    if (field < FIELD_COUNT) BP_TRY(keep_value(input, state, field, value, err));
    cif_take(&state->tokens);
    return BP_OK;
}

static BpStatus take_next(Input *input, State *state, BpError *err) {
    if (cif_opens(&state->tokens, "save_")) return cif_skip_save_frame(&state->tokens, input, err);
    if (cif_is_name(&state->tokens)) return take_item(input, state, err);
    const bool loop = cif_opens(&state->tokens, "loop_");
    cif_take(&state->tokens);
    return loop ? take_loop(input, state, err) : BP_OK;
}

/* The atoms that a block had as items become the frame's only row. */
static BpStatus end_block(const Input *input, State *state, BpError *err) {
    if (!state->single) return BP_OK;
    state->single = false;
    return check_fields(input, state, &state->held, err);
}

/* Passes over all that stands before the next atoms: then either the token is the first value of a table,
 * with state->in_table, or the only row is held. Neither: there are no further ones. */
static BpStatus find_atoms(Input *input, State *state, BpError *err) {
    for (;;) {
        BP_TRY(cif_peek(&state->tokens, input, err));
        const bool ends = state->tokens.token == NULL || cif_opens(&state->tokens, "data_");
        if (ends) BP_TRY(end_block(input, state, err));
        if (state->held || state->tokens.token == NULL) return BP_OK;
        if (ends) state->cell = (Cell){0};
        BP_TRY(take_next(input, state, err));
        if (!state->in_table) continue;
        BP_TRY(cif_peek(&state->tokens, input, err));
        if (cif_is_value(&state->tokens)) return BP_OK;
        if (!state->found)
            return input_fail(input, true, err, "found a table _atom_site without rows, expected atoms");
        state->in_table = false;
    }
}

/* Passes over what is left of the table at hand. */
static BpStatus skip_table(Input *input, State *state, BpError *err) {
    state->held = false;
    while (state->in_table) {
        BP_TRY(cif_peek(&state->tokens, input, err));
        state->in_table = cif_is_value(&state->tokens);
        if (state->in_table) cif_take(&state->tokens);
    }
    return BP_OK;
}

/* Goes back to the first row of the table at hand. The cell is kept, which may stand behind the table. */
static BpStatus return_to_table(Input *input, State *state, BpError *err) {
    const State now = *state;
    BP_TRY(input_rewind(input, err));
    *state = (State){.places = now.places,
                     .table = now.table,
                     .scanned = now.scanned,
                     .runs = now.runs,
                     .run_count = now.run_count,
                     .run_capacity = now.run_capacity,
                     .runs_taken = now.runs_taken,
                     .in_turns = now.in_turns};
    for (size_t t = 0; t < now.table; t++) {
        BP_TRY(find_atoms(input, state, err));
        BP_TRY(skip_table(input, state, err));
        state->found = true;
    }
    BP_TRY(find_atoms(input, state, err));
    state->cell = now.cell;
    state->found = now.found;
    return BP_OK;
}

/* Categories may stand in any order: where the cell, or how it lies, was not said before the first table of
 * atoms, the block is read to its end for it, and then again up to the table. What is wrong there is no fault
 * of the atoms before. */
static BpStatus find_cell_behind(Input *input, State *state, BpError *err) {
    if (state->cell.has[LENGTHS] && (state->cell.has[FRACT] || state->cell.has[CARTN])) return BP_OK;
    while (cif_peek(&state->tokens, input, NULL) == BP_OK && state->tokens.token != NULL &&
           !cif_opens(&state->tokens, "data_"))
        if (take_next(input, state, NULL) != BP_OK) break;
    return return_to_table(input, state, err);
}

/* ---- atoms -------------------------------------------------------------------------------------------- */

/* One row into state->row. */
static BpStatus take_row(Input *input, State *state, BpError *err) {
    for (size_t c = 0; c < state->column_count; c++) {
        BP_TRY(cif_peek(&state->tokens, input, err));
        if (state->tokens.token == NULL && !input->open_line)
            input->ended = false; /* a value is missing somewhere above */
        if (!cif_is_value(&state->tokens))
            return input_fail(input, true, err,
                              "found %s in a row of _atom_site, expected %zu values: the file is cut off, or "
                              "a value is missing",
                              state->tokens.token == NULL ? "the end of the file" : "a name",
                              state->column_count);
        for (int f = 0; f < FIELD_COUNT; f++) {
            if (state->field_column[f] == (int)c)
                BP_TRY(keep_value(input, state, f, state->tokens.token, err));
        }
        cif_take(&state->tokens);
    }
    return BP_OK;
}

/* The value of a field, or else of the other; "": neither has one. */
static const char *text_of(const State *state, Field field, Field instead) {
    const char *const text = state->field_column[field] >= 0 ? cif_known(state->row[field]) : "";
    return text[0] != '\0' || instead == field ? text : text_of(state, instead, instead);
}

static double number_in(const State *state, Field field, Field instead) {
    double value = 0;
    return cif_number(text_of(state, field, instead), &value) ? value : NAN;
}

static BpStatus add_row(BpParticleFile *file, State *state, BpError *err) {
    Particle particle = PARTICLE_NONE;
    for (Field f = X; f <= Z; f++) {
        double *const place = &particle.position[f - X];
        if (cif_is_unknown(state->row[f]))
            *place = NAN;
        else if (!cif_number(state->row[f], place) && !word_number_or_none(state->row[f], place))
            return input_wrong(&file->input, state->row[f], "a coordinate in _atom_site.Cartn_x, y and z",
                               err);
    }
    particle.name = text_of(state, AUTH_NAME, LABEL_NAME);
    particle.residue = text_of(state, AUTH_RESIDUE, LABEL_RESIDUE);
    particle.chain = text_of(state, AUTH_CHAIN, LABEL_CHAIN);
    atom_identify(&particle, text_of(state, SYMBOL, SYMBOL), particle.name, false);
    if (strcasecmp(text_of(state, RECORD, RECORD), "HETATM") == 0) particle.flags |= BP_PARTICLE_HETERO;
    const double values[3] = {number_in(state, OCCUPANCY, OCCUPANCY), number_in(state, B_FACTOR, B_FACTOR),
                              number_in(state, AUTH_SEQUENCE, LABEL_SEQUENCE)};
    particle.values = values;
    BP_TRY(frame_add(file, &particle, true, err));
    if (file->out == NULL || !particle_has_place(&particle)) return BP_OK;
    char site[3 * CIF_TEXT_SIZE];
    const char *const number = text_of(state, AUTH_SEQUENCE, LABEL_SEQUENCE);
    snprintf(site, sizeof site, "%s/%s/%s", particle.chain, number, text_of(state, INSERTION, INSERTION));
    return places_take(&state->places, file->out, site, number[0] != '\0',
                       text_of(state, ALTERNATIVE, ALTERNATIVE), err);
}

/* The next row of the table, unless one is held. *more: there is one. */
static BpStatus next_row(Input *input, State *state, bool *more, BpError *err) {
    *more = state->held;
    if (state->held || !state->in_table) return BP_OK;
    BP_TRY(cif_peek(&state->tokens, input, err));
    *more = state->in_table = cif_is_value(&state->tokens);
    return *more ? take_row(input, state, err) : BP_OK;
}

static uint64_t model_of_row(const State *state) {
    return bp_hash_text(BP_HASH_START, text_of(state, MODEL, MODEL));
}

/* The rows of one model, up to the first of another, which is held. */
static BpStatus take_model(BpParticleFile *file, State *state, uint64_t *model, size_t *rows, BpError *err) {
    for (*rows = 0;; ++*rows) {
        bool more = false;
        BP_TRY(next_row(&file->input, state, &more, err));
        if (!more) return BP_OK;
        if (*rows == 0) *model = model_of_row(state);
        state->held = model_of_row(state) != *model;
        if (state->held) return BP_OK;
        BP_TRY(add_row(file, state, err));
    }
}

/* ---- models in turns ---------------------------------------------------------------------------------- */

static BpStatus add_run(State *state, uint64_t model, BpError *err) {
    if (state->run_count == state->run_capacity) {
        const size_t capacity = state->run_capacity > 0 ? 2 * state->run_capacity : 64;
        Run *const runs = realloc(state->runs, capacity * sizeof *runs);
        if (runs == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for a list of models");
        state->runs = runs;
        state->run_capacity = capacity;
    }
    state->runs[state->run_count] = (Run){model, state->run_count};
    state->run_count++;
    return BP_OK;
}

static int compare_models(const void *a, const void *b) {
    const Run *const one = a, *const other = b;
    if (one->model != other->model) return one->model < other->model ? -1 : 1;
    return one->at < other->at ? -1 : one->at > other->at;
}

static int compare_places(const void *a, const void *b) {
    const Run *const one = a, *const other = b;
    return one->at < other->at ? -1 : one->at > other->at;
}

/* Keeps the first stretch of each model. */
static void drop_repeated(State *state) {
    size_t kept = 0;
    qsort(state->runs, state->run_count, sizeof *state->runs, compare_models);
    for (size_t i = 0; i < state->run_count; i++)
        if (i == 0 || state->runs[i].model != state->runs[i - 1].model) state->runs[kept++] = state->runs[i];
    state->in_turns = kept < state->run_count;
    state->run_count = kept;
    qsort(state->runs, state->run_count, sizeof *state->runs, compare_places);
}

/* Looks once, where the second model of a table begins, whether one comes back later: then state->in_turns.
 * What is wrong there is no fault of the atoms before. `rows`: of the first model. */
static BpStatus find_turns(Input *input, State *state, uint64_t first, size_t rows, BpError *err) {
    bool more = true;
    state->scanned = true;
    state->run_count = state->runs_taken = 0;
    BP_TRY(add_run(state, first, err));
    while (more) {
        const uint64_t model = model_of_row(state);
        if (model != state->runs[state->run_count - 1].model) BP_TRY(add_run(state, model, err));
        state->held = false;
        if (next_row(input, state, &more, NULL) != BP_OK) break;
    }
    drop_repeated(state);
    BP_TRY(return_to_table(input, state, err));
    for (size_t i = 0; i <= rows && !state->in_turns; i++) BP_TRY(take_row(input, state, err));
    state->held = !state->in_turns;
    return BP_OK;
}

/* The rows of the next model, wherever they stand in the table. */
static BpStatus take_turn(BpParticleFile *file, State *state, BpError *err) {
    const uint64_t model = state->runs[state->runs_taken].model;
    bool more = true;
    if (state->runs_taken > 0) BP_TRY(return_to_table(&file->input, state, err));
    state->runs_taken++;
    state->in_turns = state->runs_taken < state->run_count;
    for (;;) {
        BP_TRY(next_row(&file->input, state, &more, err));
        if (!more) return BP_OK;
        if (model_of_row(state) == model) BP_TRY(add_row(file, state, err));
    }
}

/* ---- the whole ---------------------------------------------------------------------------------------- */

static BpStatus begin_frame(BpParticleFile *file, State *state, BpError *err) {
    static const char *const columns[] = {"occupancy", "bfactor", "residue_number"};
    state->places.count = 0;
    BP_TRY(frame_begin(file, columns, 3, err));
    if (file->out != NULL) {
        file->out->angstrom = 1;
        file->out->has_records = state->field_column[RECORD] >= 0;
    }
    put_cell(file, &state->cell);
    return BP_OK;
}

static BpStatus take_frame(BpParticleFile *file, State *state, BpError *err) {
    uint64_t model = 0;
    size_t rows = 0;
    BP_TRY(begin_frame(file, state, err));
    if (state->in_turns) return take_turn(file, state, err);
    const bool is_first = !state->scanned;
    BP_TRY(take_model(file, state, &model, &rows, err));
    if (!state->held || !is_first) return BP_OK;
    BP_TRY(find_turns(&file->input, state, model, rows, err));
    if (!state->in_turns) return BP_OK;
    BP_TRY(begin_frame(file, state, err));
    return take_turn(file, state, err);
}

/* Looks whether the first atoms are those of a crystal: their table has shares of a cell, or names of the
 * core dictionary, and no _atom_site.Cartn_x. What is wrong before them is reported when the file is read. */
static BpStatus find_kind(Input *input, bool *is_crystal, BpError *err) {
    CifTokens tokens = {.lenient = true};
    *is_crystal = false;
    for (; cif_peek(&tokens, input, NULL) == BP_OK && tokens.token != NULL; cif_take(&tokens)) {
        if (!cif_is_name(&tokens)) {
            if (*is_crystal) break;
            continue;
        }
        const bool is_here = strcasecmp(tokens.token, "_atom_site.Cartn_x") == 0;
        *is_crystal = !is_here && (*is_crystal || cif_block_has_places(tokens.token));
        if (is_here) break;
    }
    return input_rewind(input, err);
}

BpStatus read_cif(BpParticleFile *file, bool *end, BpError *err) {
    Input *const input = &file->input;
    bool is_crystal = false;
    if (file->state == NULL) BP_TRY(find_kind(input, &is_crystal, err));
    if (is_crystal) {
        file->format = BP_PARTICLES_CRYSTAL;
        return read_crystal(file, end, err);
    }
    if (file->state == NULL) file->state = calloc(1, sizeof(State));
    State *const state = file->state;
    if (state == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory");
    if (!state->held && !state->in_table && !state->in_turns) {
        BP_TRY(find_atoms(input, state, err));
        state->table += state->found;
        state->scanned = false;
    }
    *end = !state->held && !state->in_table && !state->in_turns && state->found;
    if (*end) return BP_OK;
    if (!state->held && !state->in_table && !state->in_turns)
        return input_fail(
            input, false, err,
            "found no table _atom_site, expected atoms (loop_ _atom_site.Cartn_x ... of a molecule, "
            "_atom_site_fract_x ... of a crystal)");
    if (!state->found && state->in_table) BP_TRY(find_cell_behind(input, state, err));
    state->found = true;
    BP_TRY(take_frame(file, state, err));
    if (file->out == NULL) return BP_OK;
    if (file->out->count == 0) {
        input->ended = false; /* nothing is missing behind */
        return input_fail(input, true, err,
                          "found no atom with a place, expected numbers in _atom_site.Cartn_x");
    }
    return places_mark(&state->places, file->out, err);
}
