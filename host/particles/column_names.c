/* column_names.c: see column_names.h. */
#include "column_names.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

enum { NAME_SIZE = 48 };
#define COUNT(array) (sizeof(array) / sizeof *(array))

static bool is_separator(char c) {
    return c != '\0' && strchr(" \t._:-", c) != NULL;
}

/* Where the unit behind a name begins, its bracket, its slash, or the blank or underscore before a unit that
 * is known; NULL: it has none. Brackets around a number are an index, "m" and "a" are indices as well, and
 * "cm" is a centre of mass. */
static const char *unit_at(const char *name) {
    const char *at = strpbrk(name, "([/");
    if (at != NULL) return at == name || (at[1] >= '0' && at[1] <= '9') ? NULL : at;
    at = strpbrk(name, "_ ");
    for (const char *next = at; next != NULL; next = strpbrk(next + 1, "_ ")) at = next;
    const bool is_unit = at != NULL && at > name && strlen(at) > 2 && strcasecmp(at + 1, "cm") != 0 &&
                         column_angstrom(at + 1) > 0;
    return is_unit ? at : NULL;
}

/* The name in small letters, without separators and, if so wanted, without its unit. */
static void simplify(const char *name, bool without_unit, char out[NAME_SIZE]) {
    const char *const unit = without_unit ? unit_at(name) : NULL;
    size_t length = 0;
    for (const char *c = name; *c != '\0' && c != unit && length < NAME_SIZE - 1; c++) {
        const bool index = (*c == '[' && c[1] >= '0' && c[1] <= '9') || (*c == ']' && unit_at(name) == NULL);
        if (is_separator(*c) || index) continue;
        out[length++] = *c >= 'A' && *c <= 'Z' ? (char)(*c - 'A' + 'a') : *c;
    }
    out[length] = '\0';
}

int column_named(const char *const *names, size_t count, const char *wanted) {
    char name[NAME_SIZE];
    for (int without_unit = 0; without_unit < 2; without_unit++) {
        int found = COLUMN_NONE;
        for (size_t i = 0; i < count; i++) {
            simplify(names[i], without_unit == 1, name);
            if (strcmp(name, wanted) != 0) continue;
            if (found != COLUMN_NONE) return COLUMN_TWICE;
            found = (int)i;
        }
        if (found != COLUMN_NONE) return found;
    }
    return COLUMN_NONE;
}

/* The columns that are called by a word and each of three endings, or, if `before`, the other way round. */
static void find_set(const char *const *names, size_t count, const char *word, const char *const endings[3],
                     bool before, int place[3]) {
    char wanted[NAME_SIZE];
    for (int c = 0; c < 3; c++) {
        snprintf(wanted, sizeof wanted, "%s%s", before ? endings[c] : word, before ? word : endings[c]);
        place[c] = column_named(names, count, wanted);
    }
}

size_t column_find_places(const char *const *names, size_t count, int place[3]) {
    static const char *const words[] = {"",         "pos",    "position", "positions",  "point",
                                        "points",   "coord",  "coords",   "coordinate", "coordinates",
                                        "location", "center", "centre",   "centroid"};
    static const char *const axes[3] = {"x", "y", "z"}, *const numbers[3] = {"0", "1", "2"};
    size_t sets = 0;
    for (int c = 0; c < 3; c++) place[c] = COLUMN_NONE;
    for (size_t w = 0; w < COUNT(words); w++) {
        for (int form = 0; form < 3 && (w > 0 || form == 0); form++) {
            int found[3];
            find_set(names, count, words[w], form < 2 ? axes : numbers, form == 1, found);
            if (found[0] == COLUMN_NONE || found[1] == COLUMN_NONE) continue;
            if (sets++ == 0) memcpy(place, found, sizeof found);
        }
    }
    return sets;
}

bool column_find_color(const char *const *names, size_t count, int place[3]) {
    static const char *const words[] = {"",     "diffuse", "vertex",  "color",       "colour",      "rgb",
                                        "rgba", "colors",  "colours", "vertexcolor", "diffusecolor"};
    /* Numbers stand behind a word, and CloudCompare's Rf, Gf and Bf alone. */
    static const char *const endings[4][3] = {
        {"red", "green", "blue"}, {"r", "g", "b"}, {"0", "1", "2"}, {"rf", "gf", "bf"}};
    for (size_t w = 0; w < COUNT(words); w++) {
        for (int form = 0; form < 4; form++) {
            if (form == (w > 0 ? 3 : 2)) continue;
            find_set(names, count, words[w], endings[form], false, place);
            if (place[0] >= 0 && place[1] >= 0 && place[2] >= 0) return true;
        }
    }
    return false;
}

const char *column_single_color(const char *const *names, size_t count) {
    /* The last is the first coefficient of a Gaussian splat's colour; those before count where they are not
     * all there. */
    static const char *const words[] = {"color",    "colour", "rgb", "rgba",  "colorhex", "hexcolor",
                                        "colorrgb", "hex",    "red", "green", "blue",     "fdc0"};
    char name[NAME_SIZE];
    for (size_t i = 0; i < count; i++) {
        simplify(names[i], false, name);
        for (size_t w = 0; w < COUNT(words); w++)
            if (strcmp(name, words[w]) == 0) return names[i];
    }
    return NULL;
}

const char *column_unread_shape(const char *const *names, size_t count) {
    /* The last is that of Gaussian splats. */
    static const char *const words[] = {"asphericalshape", "shape",    "radius",   "radii", "diameter",
                                        "semiaxis",        "semiaxes", "halfaxis", "scale"};
    static const char *const endings[3][3] = {{"x", "y", "z"}, {"0", "1", "2"}, {"1", "2", "3"}};
    for (size_t w = 0; w < COUNT(words); w++)
        for (int form = 0; form < 3; form++) {
            int place[3];
            find_set(names, count, words[w], endings[form], false, place);
            if (place[0] >= 0 && place[1] >= 0 && place[2] >= 0) return names[place[0]];
        }
    return NULL;
}

void column_unit(const char *name, char unit[COLUMN_UNIT_SIZE]) {
    const char *at = unit_at(name);
    unit[0] = '\0';
    if (at == NULL) return;
    at += 1 + strspn(at + 1, " ");
    const size_t length = strcspn(at, " )]");
    snprintf(unit, COLUMN_UNIT_SIZE, "%.*s", (int)(length < COLUMN_UNIT_SIZE ? length : COLUMN_UNIT_SIZE - 1),
             at);
}

double column_angstrom(const char *unit) {
    /* In UTF-8: the letter and the sign of the angstrom, the letter and the sign of micro. */
    static const struct {
        const char *unit;
        double angstrom;
    } units[] = {{"A", 1},          {"Ang", 1},          {"Angstrom", 1},     {"Angstroms", 1},
                 {"\xc3\x85", 1},   {"\xe2\x84\xab", 1}, {"nm", 0.1},         {"pm", 100},
                 {"um", 1e-4},      {"\xc2\xb5m", 1e-4}, {"\xce\xbcm", 1e-4}, {"micron", 1e-4},
                 {"microns", 1e-4}, {"mm", 1e-7},        {"cm", 1e-8},        {"m", 1e-10}};
    for (size_t i = 0; i < COUNT(units); i++)
        if (strcasecmp(unit, units[i].unit) == 0) return units[i].angstrom;
    return 0;
}
