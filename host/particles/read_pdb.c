/* read_pdb.c: PDB, the format of fixed columns (wwPDB, version 3.3), as programs of all ages write it; see
 * reader.h. */
#include "elements.h"
#include "reader.h"

#include <stdlib.h>
#include <string.h>

enum { CELL_LINE_SIZE = 64 };

static bool is_record(const char *line, const char *name) {
    return strncmp(line, name, strlen(name)) == 0;
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

BpStatus read_pdb(BpParticleFile *file, bool *end, BpError *err) {
    static const char *const columns[] = {"occupancy", "bfactor", "residue_number"};
    Input *const input = &file->input;
    bool begun = false, has_atoms = false;
    char *line = NULL, alternative = '\0';
    for (;;) {
        BP_TRY(input_line(input, &line, err));
        if (line == NULL) break;
        if (is_record(line, "CRYST1")) {
            /* Kept for the frames that follow, since many files say it once. */
            if (file->state == NULL) file->state = calloc(1, CELL_LINE_SIZE);
            if (file->state == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory");
            snprintf(file->state, CELL_LINE_SIZE, "%.60s", line);
        }
        if (has_atoms && (is_record(line, "ENDMDL") || strcmp(line, "END") == 0 || is_record(line, "END ")))
            break;
        if (has_atoms && is_record(line, "MODEL ")) {
            input_hold(input, line);
            break;
        }
        const bool atom = is_record(line, "ATOM  ") || is_record(line, "HETATM");
        if (!atom) continue;
        if (!begun) BP_TRY(frame_begin(file, columns, 3, err));
        begun = has_atoms = true;
        BP_TRY(take_atom(file, line, &alternative, err));
    }
    *end = !has_atoms && file->frame > 0;
    if (*end) return BP_OK;
    if (!has_atoms)
        return input_fail(input, false, err, "found no line of ATOM or HETATM, expected a PDB file's atoms");
    if (file->out != NULL) file->out->angstrom = 1;
    if (file->state != NULL) take_cell(file, file->state, strlen(file->state));
    return BP_OK;
}
