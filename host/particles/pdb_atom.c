/* pdb_atom.c: PDB's line of an atom (wwPDB, version 3.3), as programs of all ages write it; see pdb_atom.h.
 *
 * Hybrid-36 (R. W. Grosse-Kunstleve 2007) continues numbers that are too large for their columns by letters.
 */
#include "pdb_atom.h"

#include "elements.h"

#include <string.h>
#include <strings.h>

const char *const pdb_columns[PDB_COLUMN_COUNT] = {"occupancy", "bfactor", "residue_number"};

static bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

static bool is_letter(char c) {
    return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
}

bool pdb_is_record(const char *line, const char *name) {
    return strncasecmp(line, name, strlen(name)) == 0;
}

/* Numbers above 99,999 begin before the usual columns in some files, and PQR has words. */
bool pdb_is_atom(const char *line) {
    if (pdb_is_record(line, "HETATM")) return true;
    if (!pdb_is_record(line, "ATOM")) return false;
    return line[4] == '\t' || line[4] == '\0' ||
           ((line[4] == ' ' || is_digit(line[4])) && (line[5] == ' ' || is_digit(line[5])));
}

/* A number in fixed columns; NaN where there is none. */
static double number_at(const char *line, size_t length, size_t first, size_t last) {
    char text[16];
    double value = NAN;
    return word_number(fixed_text(line, length, first, last, text, sizeof text), &value) ? value : NAN;
}

static bool digits_at(const char *line, size_t first, size_t last) {
    for (size_t i = first; i <= last; i++)
        if (!is_digit(line[i - 1])) return false;
    return true;
}

/* A residue's number, which may be hybrid-36: A000 is 10,000, and a000 follows ZZZZ. NaN: none. */
static double residue_number(const char *text) {
    double value = 0, begin = 10000 - 10 * 36.0 * 36 * 36;
    if (word_number(text, &value)) return value;
    if (strlen(text) != 4 || !is_letter(text[0])) return NAN;
    const bool small = text[0] >= 'a';
    if (small) begin += 26 * 36.0 * 36 * 36;
    for (; *text != '\0'; text++) {
        const char first = small ? 'a' : 'A';
        if (!is_digit(*text) && !(*text >= first && *text < first + 26)) return NAN;
        value = 36 * value + (is_digit(*text) ? *text - '0' : *text - first + 10);
    }
    return begin + value;
}

/* How far an overlong number before the coordinates has moved them: their points tell. */
static size_t moved(const char *line, size_t length) {
    for (size_t by = 0; by <= 2 && 50 + by < length; by++)
        if (line[34 + by] == '.' && line[42 + by] == '.' && line[50 + by] == '.') return by;
    return 0;
}

/* Whether the occupancy, or the line's end where there is none, is moved as well: else the numbers have two
 * decimals. */
static bool moves_rest(const char *line, size_t length, size_t by) {
    return length > 57 + by ? line[57 + by] == '.' : length == 54 + by;
}

/* The symbol in columns 77 and 78, without a charge behind it; "" where column 79 shows that they hold none,
 * but a part of an atom's type (PDBQT). */
static void symbol_at(const char *line, size_t length, char symbol[4]) {
    size_t count = 0;
    for (size_t i = 76; i < 78 && i < length; i++) {
        if (is_letter(line[i]))
            symbol[count++] = line[i];
        else if (line[i] != ' ' || count > 0)
            break;
    }
    symbol[length > 78 && is_letter(line[78]) ? 0 : count] = '\0';
}

/* The residue's name has three letters, or four (TIP3, POPC), or the chain's has two, of which the first
 * stands in the same column: a residue that is known by three letters alone tells, then for all that follow.
 */
static void take_names(const char *line, size_t length, PdbAtom *atom, PdbForm *form) {
    char residue[8];
    fixed_text(line, length, 18, 21, atom->residue, sizeof atom->residue);
    fixed_text(line, length, 22, 22, atom->chain, sizeof atom->chain);
    fixed_text(line, length, 18, 20, residue, sizeof residue);
    if (length < 22 || line[20] == ' ' || line[21] == ' ' || residue[0] == '\0') return;
    if (bp_residue_is_common(atom->residue)) return;
    form->wide_chains |= bp_residue_is_common(residue);
    if (!form->wide_chains) return;
    memcpy(atom->residue, residue, sizeof residue);
    fixed_text(line, length, 21, 22, atom->chain, sizeof atom->chain);
}

/* The coordinates, of which the first may reach further: to the left, or, `wide`, so many columns to the
 * right.
 */
static BpStatus take_place(const Input *input, const char *line, size_t length, size_t wide, double place[3],
                           BpError *err) {
    char text[24];
    size_t first = 31;
    while (first > 29 && first <= length && line[first - 2] != ' ') first--;
    for (size_t i = 0; i < 3; i++) {
        const size_t last = 38 + 8 * i + wide;
        fixed_text(line, length, first, last, text, sizeof text);
        first = last + 1;
        if (!word_number_or_none(text, &place[i]))
            return input_wrong(input, text, "a coordinate in columns 31-38, 39-46 and 47-54", err);
    }
    return BP_OK;
}

BpStatus pdb_read_atom(const Input *input, const char *line, PdbAtom *atom, PdbForm *form, BpError *err) {
    size_t length = strlen(line), by = moved(line, length);
    char symbol[4], padded[5] = "    ", number[8], segment[8], text[16];
    *atom = (PdbAtom){.particle = PARTICLE_NONE};
    Particle *const particle = &atom->particle;
    const bool hetero = pdb_is_record(line, "H");
    const bool by_serial = by > 0 && digits_at(line, 7, 11 + by);
    fixed_text(line, length, hetero ? 7 : 5, by_serial ? 11 + by : 11, atom->serial, sizeof atom->serial);
    if (by_serial) { /* all that follows is moved; else only what follows the residue's number */
        line += by;
        length -= by;
    }
    const bool by_residue = !by_serial && digits_at(line, 23, 26 + by);
    const size_t wide = by_serial || by_residue || !moves_rest(line, length, by) ? 0 : by;
    if (!by_residue) by = 0;
    for (size_t i = 0; i < 4 && 12 + i < length; i++) padded[i] = line[12 + i];
    particle->name = fixed_text(line, length, 13, 16, atom->name, sizeof atom->name);
    take_names(line, length, atom, form);
    particle->residue = atom->residue;
    particle->chain = atom->chain;
    fixed_text(line, length, 17, 17, atom->letter, sizeof atom->letter);
    const size_t last = length > 26 && is_digit(line[26]) ? 27 + (by > 1) : 26; /* five digits, six */
    fixed_text(line, length, 23, last, number, sizeof number);
    atom->numbered = number[0] != '\0';
    snprintf(atom->site, sizeof atom->site, "%s/%s", atom->chain,
             fixed_text(line, length, 23, 27 + by, text, sizeof text));
    line += by;
    length -= by;
    BP_TRY(take_place(input, line, length, wide, particle->position, err));
    line += wide;
    length -= wide;
    fixed_text(line, length, 73, 76, segment, sizeof segment);
    snprintf(atom->site + strlen(atom->site), sizeof segment + 1, "/%s", segment);
    if (atom->chain[0] == '\0') snprintf(atom->chain, sizeof atom->chain, "%s", segment);
    symbol_at(line, length, symbol);
    form->names_left |= strspn(padded, "CNOHPS") == 1 && strcmp(padded + 1, "   ") == 0;
    atom_identify(particle, symbol, form->names_left ? atom->name : padded, !form->names_left);
    if (hetero) particle->flags |= BP_PARTICLE_HETERO;
    atom->values[0] = number_at(line, length, 55, 60);
    atom->values[1] = number_at(line, length, 61, 66);
    atom->values[2] = residue_number(number);
    particle->values = atom->values;
    return BP_OK;
}
