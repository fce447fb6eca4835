/* read_pdb.c: PDB, the format of fixed columns (wwPDB, version 3.3), as programs of all ages write it, and
 * PQR, which differs in the lines of atoms; see reader.h. */
#include "crystal.h"
#include "pdb_atom.h"
#include "pdb_connect.h"
#include "places.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* How far connections are looked for behind a model. */
#define TAIL_BYTES_MAX ((uint64_t)1 << 30)

enum { CELL_BYTES = 60 };

/* What is kept from frame to frame. */
typedef struct State {
    char cell[64]; /* the line that says it, or "" */
    CrystalFrame crystal;
    bool scale_here; /* `crystal` is of the lines before this frame */
    PdbForm form;
    Places places;        /* of this frame */
    PdbLinks links, tail; /* of this frame; behind the last of several models, for each of them */
    PdbSerials serials;   /* of this frame */
    bool tail_read, more; /* atoms follow behind the frame from which on it was read */
    bool cell_behind;     /* the first frame had no cell before it, so each has its own behind it */
    bool closed;          /* the frame before ended with a record that says so, and had */
    size_t before;        /* so many atoms */
    bool by_end;          /* that record was END */
} State;

/* A number in fixed columns; false when there is none. */
static bool fixed_number(const char *line, size_t first, size_t last, double *value) {
    char text[16];
    return word_number(fixed_text(line, strlen(line), first, last, text, sizeof text), value);
}

static void take_cell(BpParticleFile *file, const State *state) {
    const char *const line = state->cell;
    double lengths[3], angles[3];
    for (size_t i = 0; i < 3; i++) {
        if (!fixed_number(line, 7 + 9 * i, 15 + 9 * i, &lengths[i])) return;
        if (!fixed_number(line, 34 + 7 * i, 40 + 7 * i, &angles[i])) return;
    }
    frame_cell_angles(file, lengths, angles);
    crystal_turn_cell(file, &state->crystal, "SCALE");
}

/* The cell and how it lies are kept for the frames that follow, since many files say them once; but a new
 * cell does not lie as the one before. */
static void take_crystal(State *state, const char *line) {
    if (pdb_is_record(line, "CRYST1") && strncmp(line, state->cell, CELL_BYTES) != 0) {
        snprintf(state->cell, sizeof state->cell, "%.*s", CELL_BYTES, line);
        if (!state->scale_here) state->crystal = (CrystalFrame){0};
    }
    if (!pdb_is_record(line, "SCALE") || line[5] < '1' || line[5] > '3') return;
    if (!state->scale_here) state->crystal = (CrystalFrame){0};
    state->scale_here = true;
    const int i = line[5] - '1';
    double *const row = state->crystal.row[i];
    state->crystal.given[i] = fixed_number(line, 11, 20, &row[0]) && fixed_number(line, 21, 30, &row[1]) &&
                              fixed_number(line, 31, 40, &row[2]);
    if (!fixed_number(line, 46, 55, &row[3])) row[3] = 0;
}

static BpStatus take_atom(BpParticleFile *file, State *state, const char *line, BpError *err) {
    PdbAtom atom;
    if (file->format == BP_PARTICLES_PQR)
        BP_TRY(pqr_read_atom(&file->input, line, &atom, err));
    else
        BP_TRY(pdb_read_atom(&file->input, line, &atom, &state->form, err));
    BP_TRY(frame_add(file, &atom.particle, true, err));
    if (file->out == NULL) return BP_OK;
    BP_TRY(places_take(&state->places, file->out, atom.site, atom.numbered, atom.letter, err));
    return pdb_take_serial(&state->serials, atom.serial, err);
}

void pdb_state_destroy(void *state) {
    State *const pdb = state;
    if (pdb == NULL) return;
    places_clear(&pdb->places);
    free(pdb->links.pair);
    free(pdb->tail.pair);
    free(pdb->serials.key);
    free(pdb);
}

bool pdb_has_more(const void *state, bool text_follows) {
    const State *const pdb = state;
    return pdb->more || (pdb->by_end && text_follows);
}

/* Files of several models list the connections once, after the last of them. Reads on to there, and then
 * returns to where it was. What is wrong in later models is no fault of this one. */
static BpStatus read_tail(Input *input, State *state, BpError *err) {
    const uint64_t taken = input->taken, number = input->line;
    BpStatus status = BP_OK;
    char *line = NULL;
    while (status == BP_OK && input->taken - taken < TAIL_BYTES_MAX &&
           input_line(input, &line, NULL) == BP_OK) {
        if (line == NULL) break;
        if (pdb_is_atom(line)) {
            state->tail.count = state->tail.unreadable = 0; /* those of a model are its own */
            state->more = true;
        }
        if (pdb_is_record(line, "CONECT")) status = pdb_take_links(&state->tail, &state->serials, line, err);
    }
    BP_TRY(status);
    state->tail_read = true;
    return input_return_to(input, taken, number, err);
}

/* After the end of a model: some programs write its cell there. */
static BpStatus take_cell_behind(BpParticleFile *file, State *state, BpError *err) {
    char *line = NULL;
    state->cell_behind |= file->frame == 0 && state->cell[0] == '\0';
    if (!state->cell_behind) return BP_OK;
    BP_TRY(input_line(&file->input, &line, err));
    if (line == NULL) return BP_OK;
    if (pdb_is_record(line, "CRYST1"))
        take_crystal(state, line);
    else
        input_hold(&file->input, line);
    return BP_OK;
}

BpStatus read_pdb(BpParticleFile *file, bool *end, BpError *err) {
    const char *const *const columns = file->format == BP_PARTICLES_PQR ? pqr_columns : pdb_columns;
    Input *const input = &file->input;
    bool has_atoms = false, model = false, closed = false;
    char *line = NULL;
    if (file->state == NULL) file->state = calloc(1, sizeof(State));
    State *const state = file->state;
    if (state == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory");
    state->links.count = state->links.unreadable = 0;
    state->serials.count = state->serials.longest = state->places.count = 0;
    state->scale_here = false;
    for (;;) {
        BP_TRY(input_line(input, &line, err));
        if (line == NULL) break;
        take_crystal(state, line);
        model = pdb_is_record(line, "ENDMDL");
        closed = has_atoms && (model || strcasecmp(line, "END") == 0 || pdb_is_record(line, "END "));
        if (closed) break;
        if (has_atoms && pdb_is_record(line, "MODEL ")) {
            input_hold(input, line);
            state->more = true;
            break;
        }
        if (has_atoms && file->out != NULL && pdb_is_record(line, "CONECT"))
            BP_TRY(pdb_take_links(&state->links, &state->serials, line, err));
        if (!pdb_is_atom(line)) continue;
        if (!has_atoms) BP_TRY(frame_begin(file, columns, PDB_COLUMN_COUNT, err));
        has_atoms = true;
        BP_TRY(take_atom(file, state, line, err));
    }
    *end = !has_atoms && file->frame > 0;
    if (*end) return BP_OK;
    if (!has_atoms)
        return input_fail(input, false, err, "found no line of ATOM or HETATM, expected a PDB file's atoms");
    if (line == NULL && state->closed && file->added < state->before)
        return input_fail(input, true, err,
                          "found the end of the file after %zu atoms, expected ENDMDL or END; it is cut off",
                          file->added);
    state->closed = closed;
    state->by_end = closed && !model;
    state->before = file->added;
    if (file->out == NULL) return model ? take_cell_behind(file, state, err) : BP_OK;
    file->out->angstrom = 1;
    file->out->has_records = true;
    if (model && !state->tail_read) BP_TRY(read_tail(input, state, err));
    if (model) BP_TRY(take_cell_behind(file, state, err));
    if (state->cell[0] != '\0') take_cell(file, state);
    BP_TRY(places_mark(&state->places, file->out, err));
    file->out->bonds_partial = true;
    BP_TRY(pdb_add_bonds(file, &state->links, &state->serials, err));
    return pdb_add_bonds(file, &state->tail, &state->serials, err);
}
