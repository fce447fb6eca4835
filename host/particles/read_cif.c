/* read_cif.c: mmCIF: the table _atom_site and the cell; see reader.h.
 *
 * Knows: CIF's tokens (S. R. Hall, F. H. Allen, I. D. Brown 1991) as far as tables need them. */
#include "elements.h"
#include "reader.h"

#include "base/message_text.h"

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
    SEQUENCE,
    FIELD_COUNT
} Field;

static const char *const field_names[FIELD_COUNT] = {
    "pdbx_PDB_model_num", "type_symbol",    "auth_atom_id",  "label_atom_id", "label_alt_id", "auth_comp_id",
    "label_comp_id",      "auth_asym_id",   "label_asym_id", "Cartn_x",       "Cartn_y",      "Cartn_z",
    "occupancy",          "B_iso_or_equiv", "auth_seq_id"};

/* What is kept from frame to frame: the table goes on where the last model ended. */
typedef struct State {
    char *cursor; /* in the line that is being read; NULL: at the next line */
    size_t column_count;
    int field_column[FIELD_COUNT]; /* -1: absent */
    double lengths[3], angles[3];
    bool in_table;
    char first_alternative;
    /* The first row of the next model. */
    char row[FIELD_COUNT][BP_PARTICLE_NAME_SIZE];
    bool held;
} State;

/* The next token of the file; NULL: its end. *quoted: it stood in quotes or between semicolons, so it is a
 * value whatever it looks like. Texts between semicolons are passed over, and given as "". */
static BpStatus next_token(Input *input, State *state, char **token, bool *quoted, BpError *err) {
    static char empty[1] = "";
    *quoted = false;
    for (;;) {
        if (state->cursor == NULL) {
            BP_TRY(input_line(input, &state->cursor, err));
            *token = NULL;
            if (state->cursor == NULL) return BP_OK;
            if (state->cursor[0] == ';') {
                char *line = NULL;
                const uint64_t opened = input->line;
                do {
                    BP_TRY(input_line(input, &line, err));
                    if (line == NULL)
                        return input_fail(
                            input, true, err,
                            "found the end of the file in the text that line %llu opens, expected "
                            "a line that begins with \";\"",
                            (unsigned long long)opened);
                } while (line[0] != ';');
                state->cursor = line + 1;
                *token = empty;
                *quoted = true;
                return BP_OK;
            }
        }
        char *c = state->cursor + strspn(state->cursor, " \t\r");
        if (*c == '\0' || *c == '#') {
            state->cursor = NULL;
            continue;
        }
        char *after = NULL;
        if (*c == '\'' || *c == '"') { /* ended by the same quote before a blank */
            for (after = c + 1; *after != '\0'; after++)
                if (*after == *c && (after[1] == '\0' || after[1] == ' ' || after[1] == '\t')) break;
            if (*after == '\0')
                return input_fail(input, true, err, "found a quote that is not closed, expected its end");
            *quoted = true;
            c++;
        } else {
            after = c + strcspn(c, " \t\r");
        }
        state->cursor = *after != '\0' ? after + 1 : NULL;
        *after = '\0';
        *token = c;
        return BP_OK;
    }
}

static void take_cell_item(State *state, const char *name, const char *value) {
    static const char *const names[6] = {"_cell.length_a",    "_cell.length_b",   "_cell.length_c",
                                         "_cell.angle_alpha", "_cell.angle_beta", "_cell.angle_gamma"};
    for (int i = 0; i < 6; i++) {
        double number = 0;
        if (strcasecmp(name, names[i]) == 0 && word_number(value, &number))
            *(i < 3 ? &state->lengths[i] : &state->angles[i - 3]) = number;
    }
}

/* After "loop_": takes the names; true in state->in_table when it is the table of atoms. *first: the first
 * value after the names, or NULL. */
static BpStatus take_loop(Input *input, State *state, char **token, bool *quoted, BpError *err) {
    size_t count = 0;
    bool atoms = false, fractions = false;
    for (int f = 0; f < FIELD_COUNT; f++) state->field_column[f] = -1;
    for (;;) {
        BP_TRY(next_token(input, state, token, quoted, err));
        if (*token == NULL || *quoted || (*token)[0] != '_') break;
        if (strncasecmp(*token, "_atom_site.", 11) == 0) {
            atoms = true;
            for (int f = 0; f < FIELD_COUNT; f++)
                if (strcasecmp(*token + 11, field_names[f]) == 0 && state->field_column[f] < 0)
                    state->field_column[f] = (int)count;
        }
        if (strncasecmp(*token, "_atom_site_fract_x", 18) == 0) fractions = true;
        count++;
        if (count > COLUMNS_MAX)
            return input_fail(input, true, err, "found a table of more than %d columns, expected fewer",
                              COLUMNS_MAX);
    }
    if (fractions)
        return input_fail(
            input, true, err,
            "found fractions of a cell (_atom_site_fract_x), as CIF files of crystals have them, "
            "expected _atom_site.Cartn_x; convert the file, to extended XYZ for example");
    state->column_count = count;
    state->in_table = atoms;
    if (!atoms) return BP_OK;
    for (int f = X; f <= Z; f++)
        if (state->field_column[f] < 0)
            return input_fail(input, true, err,
                              "found no _atom_site.%s, expected Cartn_x, Cartn_y and Cartn_z",
                              field_names[f]);
    return BP_OK;
}

static bool is_keyword(const char *token) {
    return strncasecmp(token, "loop_", 6) == 0 || strncasecmp(token, "data_", 5) == 0 ||
           strncasecmp(token, "save_", 5) == 0 || strncasecmp(token, "stop_", 6) == 0;
}

/* Passes over all that stands before the table of atoms; *token is its first value. */
static BpStatus find_table(Input *input, State *state, char **token, bool *quoted, BpError *err) {
    BP_TRY(next_token(input, state, token, quoted, err));
    while (*token != NULL) {
        if (!*quoted && strcasecmp(*token, "loop_") == 0) {
            BP_TRY(take_loop(input, state, token, quoted, err));
            if (state->in_table) return BP_OK;
            continue;
        }
        if (!*quoted && strncasecmp(*token, "_atom_site.Cartn_x", 19) == 0)
            return input_fail(input, true, err,
                              "found _atom_site with one value, expected a table: loop_ and its names");
        if (!*quoted && strncasecmp(*token, "_cell.", 6) == 0) {
            char name[32];
            snprintf(name, sizeof name, "%s", *token);
            BP_TRY(next_token(input, state, token, quoted, err));
            if (*token != NULL) take_cell_item(state, name, *token);
            continue;
        }
        BP_TRY(next_token(input, state, token, quoted, err));
    }
    return input_fail(
        input, false, err,
        "found no table _atom_site, expected an mmCIF file's atoms (loop_ _atom_site.Cartn_x ...)");
}

/* One row into state->row. `token`: its first value. */
static BpStatus take_row(Input *input, State *state, char *token, BpError *err) {
    bool quoted = false;
    for (size_t c = 0; c < state->column_count; c++) {
        if (c > 0) BP_TRY(next_token(input, state, &token, &quoted, err));
        if (token == NULL && !input->open_line) input->ended = false; /* a value is missing somewhere above */
        if (token == NULL || (!quoted && (token[0] == '_' || is_keyword(token))))
            return input_fail(
                input, true, err,
                "found %s in a row of _atom_site, expected %zu values: the file is cut off, or a "
                "value is missing",
                token == NULL ? "the end of the file" : "a name", state->column_count);
        for (int f = 0; f < FIELD_COUNT; f++) {
            if (state->field_column[f] != (int)c) continue;
            if (strlen(token) >= sizeof state->row[f])
                return input_fail(input, true, err,
                                  "found a value of %zu bytes in _atom_site.%s, expected at most %zu",
                                  strlen(token), field_names[f], sizeof state->row[f] - 1);
            snprintf(state->row[f], sizeof state->row[f], "%s", token);
        }
    }
    return BP_OK;
}

/* "" for the values that stand for none. */
static const char *text_of(const State *state, Field field, Field instead) {
    if (state->field_column[field] < 0 && instead != FIELD_COUNT) field = instead;
    const char *const text = state->field_column[field] >= 0 ? state->row[field] : "";
    return strcmp(text, ".") == 0 || strcmp(text, "?") == 0 ? "" : text;
}

static BpStatus add_row(BpParticleFile *file, State *state, BpError *err) {
    Particle particle = PARTICLE_NONE;
    double values[3] = {NAN, NAN, NAN};
    for (int i = 0; i < 3; i++)
        if (!word_number(state->row[X + i], &particle.position[i]))
            return input_wrong(&file->input, state->row[X + i], "a coordinate in _atom_site.Cartn_x, y and z",
                               err);
    particle.name = text_of(state, AUTH_NAME, LABEL_NAME);
    particle.residue = text_of(state, AUTH_RESIDUE, LABEL_RESIDUE);
    particle.chain = text_of(state, AUTH_CHAIN, LABEL_CHAIN);
    atom_identify(&particle, text_of(state, SYMBOL, FIELD_COUNT), particle.name, false);
    atom_mark_place(&particle, text_of(state, ALTERNATIVE, FIELD_COUNT)[0], &state->first_alternative);
    static const Field numbers[3] = {OCCUPANCY, B_FACTOR, SEQUENCE};
    for (int i = 0; i < 3; i++)
        if (!word_number(text_of(state, numbers[i], FIELD_COUNT), &values[i])) values[i] = NAN;
    particle.values = values;
    return frame_add(file, &particle, true, err);
}

BpStatus read_cif(BpParticleFile *file, bool *end, BpError *err) {
    static const char *const columns[] = {"occupancy", "bfactor", "residue_number"};
    Input *const input = &file->input;
    char *token = NULL, model[BP_PARTICLE_NAME_SIZE] = "";
    bool quoted = false, has_rows = false;
    if (file->state == NULL) file->state = calloc(1, sizeof(State));
    State *const state = file->state;
    if (state == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory");
    if (file->frame == 0) {
        *state = (State){0};
        BP_TRY(find_table(input, state, &token, &quoted, err));
    }
    *end = file->frame > 0 && !state->held;
    if (*end) return BP_OK;
    BP_TRY(frame_begin(file, columns, 3, err));
    if (file->out != NULL) file->out->angstrom = 1;
    frame_cell_angles(file, state->lengths, state->angles);
    bool held = state->held;
    state->held = false;
    for (;;) {
        if (!held) {
            if (token == NULL && has_rows) BP_TRY(next_token(input, state, &token, &quoted, err));
            if (token == NULL || (!quoted && (token[0] == '_' || is_keyword(token)))) break;
            BP_TRY(take_row(input, state, token, err));
        }
        held = false;
        token = NULL;
        const char *const here = text_of(state, MODEL, FIELD_COUNT);
        if (has_rows && strcmp(model, here) != 0) {
            state->held = true;
            return BP_OK;
        }
        snprintf(model, sizeof model, "%s", here);
        has_rows = true;
        BP_TRY(add_row(file, state, err));
    }
    if (!has_rows)
        return input_fail(input, true, err, "found a table _atom_site without rows, expected atoms");
    return BP_OK;
}
