/* read_pdb.c: PDB, the format of fixed columns (wwPDB, version 3.3), as programs of all ages write it; see
 * reader.h. */
#include "elements.h"
#include "pdb_connect.h"
#include "reader.h"

#include <stdlib.h>
#include <string.h>

/* How far connections are looked for behind a model. */
#define TAIL_BYTES_MAX ((uint64_t)1 << 30)

/* What is kept from frame to frame. */
typedef struct State {
    char cell[64];        /* the line that says it, or "" */
    PdbLinks links, tail; /* of this frame; behind the last of several models, for each of them */
    PdbSerials serials;   /* of this frame */
    bool tail_read;
} State;

static bool is_record(const char *line, const char *name) {
    return strncmp(line, name, strlen(name)) == 0;
}

static bool is_atom(const char *line) {
    return is_record(line, "ATOM  ") || is_record(line, "HETATM");
}

/* A number in fixed columns; false when there is none. */
static bool fixed_number(const char *line, size_t length, size_t first, size_t last, double *value) {
    char text[16];
    return word_number(fixed_text(line, length, first, last, text, sizeof text), value);
}

static void take_cell(BpParticleFile *file, const char *line, size_t length) {
    double lengths[3], angles[3];
    for (size_t i = 0; i < 3; i++) {
        if (!fixed_number(line, length, 7 + 9 * i, 15 + 9 * i, &lengths[i])) return;
        if (!fixed_number(line, length, 34 + 7 * i, 40 + 7 * i, &angles[i])) return;
    }
    frame_cell_angles(file, lengths, angles);
}

static BpStatus take_atom(BpParticleFile *file, const char *line, char *alternative, BpError *err) {
    Input *const input = &file->input;
    const size_t length = strlen(line);
    char name[8], residue[8], chain[8], symbol[4], padded[5] = "    ";
    double values[3] = {NAN, NAN, NAN}, whole = 0;
    Particle particle = PARTICLE_NONE;
    for (size_t i = 0; i < 3; i++) {
        char text[16];
        if (fixed_number(line, length, 31 + 8 * i, 38 + 8 * i, &particle.position[i])) continue;
        fixed_text(line, length, 31 + 8 * i, 38 + 8 * i, text, sizeof text);
        return input_wrong(input, text, "a coordinate in columns 31-38, 39-46 and 47-54", err);
    }
    for (size_t i = 0; i < 4 && 12 + i < length; i++) padded[i] = line[12 + i];
    particle.name = fixed_text(line, length, 13, 16, name, sizeof name);
    particle.residue = fixed_text(line, length, 18, 21, residue, sizeof residue); /* as TIP3 is written */
    particle.chain = fixed_text(line, length, 22, 22, chain, sizeof chain);
    if (chain[0] == '\0') particle.chain = fixed_text(line, length, 73, 76, chain, sizeof chain);
    fixed_text(line, length, 77, 78, symbol, sizeof symbol);
    atom_identify(&particle, symbol, padded, true);
    const char place = length > 16 ? line[16] : ' ';
    atom_mark_place(&particle, place == ' ' ? '\0' : place, alternative);
    if (!fixed_number(line, length, 55, 60, &values[0])) values[0] = NAN;
    if (!fixed_number(line, length, 61, 66, &values[1])) values[1] = NAN;
    if (fixed_number(line, length, 23, 26, &whole)) values[2] = whole;
    particle.values = values;
    return frame_add(file, &particle, true, err);
}

void pdb_state_destroy(void *state) {
    State *const pdb = state;
    if (pdb == NULL) return;
    free(pdb->links.pair);
    free(pdb->tail.pair);
    free(pdb->serials.key);
    free(pdb);
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
        if (is_atom(line)) state->tail.count = state->tail.unreadable = 0; /* those of a model are its own */
        if (is_record(line, "CONECT")) status = pdb_take_links(&state->tail, line, err);
    }
    BP_TRY(status);
    state->tail_read = true;
    BP_TRY(input_rewind(input, err));
    if (!input_skip(input, taken))
        return input_fail(input, false, err, "found a shorter file than before, expected it unchanged");
    input->line = number;
    return BP_OK;
}

BpStatus read_pdb(BpParticleFile *file, bool *end, BpError *err) {
    static const char *const columns[] = {"occupancy", "bfactor", "residue_number"};
    Input *const input = &file->input;
    bool begun = false, has_atoms = false, model = false;
    char *line = NULL, alternative = '\0';
    if (file->state == NULL) file->state = calloc(1, sizeof(State));
    State *const state = file->state;
    if (state == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory");
    state->links.count = state->links.unreadable = state->serials.count = 0;
    for (;;) {
        BP_TRY(input_line(input, &line, err));
        if (line == NULL) break;
        /* Kept for the frames that follow, since many files say it once. */
        if (is_record(line, "CRYST1")) snprintf(state->cell, sizeof state->cell, "%.60s", line);
        model = is_record(line, "ENDMDL");
        if (has_atoms && (model || strcmp(line, "END") == 0 || is_record(line, "END "))) break;
        if (has_atoms && is_record(line, "MODEL ")) {
            input_hold(input, line);
            break;
        }
        if (has_atoms && file->out != NULL && is_record(line, "CONECT"))
            BP_TRY(pdb_take_links(&state->links, line, err));
        if (!is_atom(line)) continue;
        if (!begun) BP_TRY(frame_begin(file, columns, 3, err));
        begun = has_atoms = true;
        BP_TRY(take_atom(file, line, &alternative, err));
        if (file->out != NULL) BP_TRY(pdb_take_serial(&state->serials, line, err));
    }
    *end = !has_atoms && file->frame > 0;
    if (*end) return BP_OK;
    if (!has_atoms)
        return input_fail(input, false, err, "found no line of ATOM or HETATM, expected a PDB file's atoms");
    if (file->out == NULL) return BP_OK;
    file->out->angstrom = 1;
    if (state->cell[0] != '\0') take_cell(file, state->cell, strlen(state->cell));
    if (model && !state->tail_read) BP_TRY(read_tail(input, state, err));
    file->out->bonds_partial = true;
    BP_TRY(pdb_add_bonds(file, &state->links, &state->serials, err));
    return pdb_add_bonds(file, &state->tail, &state->serials, err);
}
