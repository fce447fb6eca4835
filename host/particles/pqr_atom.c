/* pqr_atom.c: PQR's line of an atom; see pdb_atom.h. */
#include "elements.h"
#include "pdb_atom.h"

#include <string.h>

const char *const pqr_columns[PDB_COLUMN_COUNT] = {"charge", "radius", "residue_number"};

/* SPARE: for the bytes that are put between numbers, and the end. */
enum { NUMBERS = 5, HEAD_MAX = 6, LINE_BYTES_MAX = 256, SPARE = 16 };

static const char expected[] =
    "an atom of a PQR file: number, name, residue, chain (if any), residue number, "
    "x, y, z, charge, and a radius of 0 or more";

/* The last number of the text, cut off from it: behind a blank, or beginning with a sign that is not that of
 * an exponent. NULL: there is none. */
static const char *cut_number(char *text) {
    size_t end = strlen(text);
    while (end > 0 && (text[end - 1] == ' ' || text[end - 1] == '\t' || text[end - 1] == '\r')) end--;
    text[end] = '\0';
    size_t begin = end;
    while (begin > 0 && text[begin - 1] != ' ' && text[begin - 1] != '\t') {
        begin--;
        const bool is_sign = text[begin] == '-' || text[begin] == '+';
        const bool is_exponent = begin > 0 && (text[begin - 1] == 'e' || text[begin - 1] == 'E');
        if (is_sign && !is_exponent) break;
    }
    if (begin == end) return NULL;
    /* What stays must not grow together with what was cut off, so the number moves one byte further. */
    memmove(text + begin + 1, text + begin, end - begin + 1);
    text[begin] = '\0';
    return text + begin + 1;
}

/* A residue's number, perhaps with its chain in front and an insertion code behind: A52B. */
static void take_residue_number(PdbAtom *atom, const char *word) {
    char digits[16];
    const size_t front = strcspn(word, "-0123456789");
    const size_t length = strspn(word + front, "-0123456789");
    snprintf(digits, sizeof digits, "%.*s", (int)length, word + front);
    if (!word_number(digits, &atom->values[2])) atom->values[2] = NAN;
    if (front > 0 && atom->chain[0] == '\0')
        snprintf(atom->chain, sizeof atom->chain, "%.*s", front < 7 ? (int)front : 7, word);
    snprintf(atom->site, sizeof atom->site, "%s/%.15s", atom->chain, word + front);
    atom->numbered = true;
}

/* What stands before the coordinates; false: other words than expected. */
static bool take_head(PdbAtom *atom, char *text) {
    char *words[HEAD_MAX];
    const size_t count = split_words(text + (pdb_is_record(text, "H") ? 6 : 4), words, HEAD_MAX);
    if (count != 4 && count != 5) return false;
    snprintf(atom->serial, sizeof atom->serial, "%.11s", words[0]);
    snprintf(atom->name, sizeof atom->name, "%.7s", words[1]);
    snprintf(atom->residue, sizeof atom->residue, "%.7s", words[2]);
    if (count == 5) snprintf(atom->chain, sizeof atom->chain, "%.7s", words[3]);
    take_residue_number(atom, words[count - 1]);
    return true;
}

/* Coordinates without a sign may touch as well, in the columns of PDB: blanks are put between these. False:
 * the points are not where these columns have them. */
static bool part_columns(const char *line, char *text, size_t size) {
    const size_t length = strlen(line);
    if (length < 54 || line[34] != '.' || line[42] != '.' || line[50] != '.') return false;
    snprintf(text, size, "%.30s %.8s %.8s %.8s %s", line, line + 30, line + 38, line + 46, line + 54);
    return true;
}

/* False: the text is none of such an atom. *wrong: the word that is none of its numbers, or "". */
static bool take_text(PdbAtom *atom, char *text, const char **wrong) {
    double numbers[NUMBERS];
    char symbol[4] = "";
    const char *word = cut_number(text);
    *wrong = "";
    if (word != NULL && bp_element_of_symbol(word) != 0) {
        snprintf(symbol, sizeof symbol, "%.3s", word);
        word = cut_number(text);
    }
    for (size_t i = NUMBERS; i-- > 0;) {
        if (word == NULL) return false;
        *wrong = word;
        const bool good = i < 3 ? word_number_or_none(word, &numbers[i]) : word_number(word, &numbers[i]);
        if (!good || (i == 4 && numbers[i] < 0)) return false;
        if (i > 0) word = cut_number(text);
    }
    *wrong = "";
    if (!take_head(atom, text)) return false;
    memcpy(atom->particle.position, numbers, sizeof atom->particle.position);
    atom->particle.radius = atom->values[1] = numbers[4];
    atom->values[0] = numbers[3];
    atom->particle.residue = atom->residue;
    atom_identify(&atom->particle, symbol, atom->name, false);
    return true;
}

BpStatus pqr_read_atom(const Input *input, const char *line, PdbAtom *atom, BpError *err) {
    char text[LINE_BYTES_MAX + SPARE], again[LINE_BYTES_MAX + SPARE];
    const char *wrong = "", *other = "";
    *atom = (PdbAtom){.particle = PARTICLE_NONE};
    if (strlen(line) > LINE_BYTES_MAX) return input_wrong(input, line, "a shorter line of an atom", err);
    snprintf(text, sizeof text, "%s", line);
    if (!take_text(atom, text, &wrong) &&
        !(part_columns(line, again, sizeof again) && take_text(atom, again, &other)))
        return input_wrong(input, wrong[0] != '\0' ? wrong : line, expected, err);
    if (pdb_is_record(line, "H")) atom->particle.flags |= BP_PARTICLE_HETERO;
    atom->particle.name = atom->name;
    atom->particle.chain = atom->chain;
    atom->particle.values = atom->values;
    return BP_OK;
}
