/* lammps.c: see lammps.h. Columns are those of the manual of August 2024 ("read_data"), beside which LAMMPS
 * 22 Jul 2025 itself was tried: where it writes other columns than the manual says (dielectric, template),
 * both are known. */
#include "lammps.h"

#include "base/words.h"
#include "input.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

/* CODATA 2018: the dalton in kg, and the bohr in angstrom. */
#define DALTON 1.66053906660e-27
#define BOHR 0.529177210903

const LammpsUnits *lammps_units_find(const char *name) {
    static const LammpsUnits units[] = {{"lj", 0, 0},
                                        {"real", 1, 1},
                                        {"metal", 1, 1},
                                        {"si", 1e-10, DALTON},
                                        {"cgs", 1e-8, DALTON * 1e3},
                                        {"electron", 1 / BOHR, 1},
                                        {"micro", 1e-4, DALTON * 1e15},
                                        {"nano", 0.1, DALTON * 1e21}};
    for (size_t i = 0; i < sizeof units / sizeof *units; i++)
        if (strcmp(name, units[i].name) == 0) return &units[i];
    return NULL;
}

/* The names of columns as the manual has them. USUAL and RARE as in LammpsLayout; BONDED too. OLD: a name of
 * earlier versions. */
enum { USUAL = 1, BONDED = 2, RARE = 4, OPEN = 8, OLD = 16 };

static const struct Style {
    const char *name, *columns;
    unsigned flags;
} styles[] = {
    {"amoeba", "id mol type q x y z", BONDED | RARE},
    {"angle", "id mol type x y z", BONDED | RARE},
    {"atomic", "id type x y z", USUAL},
    {"body", "id type bodyflag mass x y z", 0},
    {"bond", "id mol type x y z", BONDED | RARE},
    {"bpm/sphere", "id mol type diameter density x y z", BONDED},
    {"charge", "id type q x y z", USUAL},
    {"dielectric", "id mol type q x y z mux muy muz area ed em epsilon curvature", BONDED | RARE},
    {"dielectric", "id type q x y z mux muy muz area ed em epsilon curvature", BONDED | RARE},
    {"dipole", "id type q x y z mux muy muz", RARE},
    {"dpd", "id type theta x y z", RARE},
    {"edpd", "id type edpd_temp edpd_cv x y z", RARE},
    {"electron", "id type q espin eradius x y z", 0},
    {"ellipsoid", "id type ellipsoidflag density x y z", 0},
    {"full", "id mol type q x y z", BONDED | USUAL},
    {"line", "id mol type lineflag density x y z", 0},
    {"mdpd", "id type rho x y z", RARE},
    {"meso", "id type rho esph cv x y z", RARE | OLD},
    {"molecular", "id mol type x y z", BONDED | USUAL},
    {"oxdna", "id type x y z", BONDED | RARE},
    {"peri", "id type volume density x y z", RARE},
    {"rheo", "id type status rho x y z", RARE},
    {"rheo/thermal", "id type status rho esph x y z", RARE},
    {"smd", "id type mol volume mass kradius cradius x0 y0 z0 x y z", 0},
    {"sph", "id type rho esph cv x y z", RARE},
    {"sphere", "id type diameter density x y z", USUAL},
    {"spin", "id type x y z spx spy spz sp", 0},
    {"tdpd", "id type x y z", OPEN | RARE},
    {"template", "id mol template-index template-atom type x y z", BONDED | RARE},
    {"template", "id type mol template-index template-atom x y z", BONDED | RARE},
    {"tri", "id mol type triangleflag density x y z", 0},
    {"wavepacket", "id type q espin eradius etag cs_re cs_im x y z", 0},
    {"hybrid", "id type x y z", OPEN | BONDED | RARE},
};
enum { STYLES = sizeof styles / sizeof *styles };

static LammpsWord word_of(const char *column) {
    static const struct {
        const char *column;
        LammpsWord word;
    } words[] = {{"id", LAMMPS_WHOLE},
                 {"mol", LAMMPS_WHOLE},
                 {"type", LAMMPS_TYPE},
                 {"espin", LAMMPS_ELECTRON},
                 {"etag", LAMMPS_WHOLE},
                 {"status", LAMMPS_WHOLE},
                 {"template-index", LAMMPS_WHOLE},
                 {"template-atom", LAMMPS_WHOLE},
                 {"bodyflag", LAMMPS_FLAG},
                 {"ellipsoidflag", LAMMPS_FLAG},
                 {"lineflag", LAMMPS_FLAG},
                 {"triangleflag", LAMMPS_FLAG},
                 {"diameter", LAMMPS_NOT_NEGATIVE},
                 {"eradius", LAMMPS_NOT_NEGATIVE},
                 {"kradius", LAMMPS_NOT_NEGATIVE},
                 {"cradius", LAMMPS_NOT_NEGATIVE},
                 {"sp", LAMMPS_NOT_NEGATIVE},
                 {"density", LAMMPS_POSITIVE},
                 {"mass", LAMMPS_POSITIVE},
                 {"volume", LAMMPS_POSITIVE}};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (strcmp(column, words[i].column) == 0) return words[i].word;
    return LAMMPS_NUMBER;
}

/* The columns of the layout so far, between blanks. */
typedef struct Columns {
    char text[512];
} Columns;

static bool has_column(const Columns *columns, const char *name) {
    char sought[40];
    snprintf(sought, sizeof sought, " %s ", name);
    return strstr(columns->text, sought) != NULL;
}

#define FLAG_WORDS(X)                                                                                        \
    X(LAMMPS_POINT, NULL)                                                                                    \
    X(LAMMPS_ELLIPSOID, "ellipsoidflag")                                                                     \
    X(LAMMPS_LINE, "lineflag")                                                                               \
    X(LAMMPS_TRIANGLE, "triangleflag") X(LAMMPS_BODY, "bodyflag") X(LAMMPS_SHAPE_COUNT, NULL)
BP_WORDS(LammpsShape, static const char *const flags, FLAG_WORDS);

/* Adds the style's columns that are not there yet. */
static void add_columns(LammpsLayout *layout, Columns *columns, const struct Style *style) {
    char text[160], *names[LAMMPS_WORDS_MAX];
    snprintf(text, sizeof text, "%s", style->columns);
    const size_t count = split_words(text, names, LAMMPS_WORDS_MAX);
    for (size_t i = 0; i < count && layout->word_count < LAMMPS_WORDS_MAX; i++) {
        if (has_column(columns, names[i])) continue;
        const int at = (int)layout->word_count++;
        const size_t used = strlen(columns->text);
        snprintf(columns->text + used, sizeof columns->text - used, "%s ", names[i]);
        layout->word[at] = word_of(names[i]);
        if (strcmp(names[i], "type") == 0) layout->type = at;
        if (strcmp(names[i], "mol") == 0) layout->molecule = at;
        if (strcmp(names[i], "q") == 0) layout->charge = at;
        if (strcmp(names[i], "diameter") == 0) layout->diameter = at;
        if (strcmp(names[i], "eradius") == 0 || strcmp(names[i], "cradius") == 0) layout->radius = at;
        if (strcmp(names[i], "x") == 0) layout->x = at;
        if (strcmp(names[i], "spx") == 0) layout->spin = at;
        for (int shape = LAMMPS_ELLIPSOID; shape < LAMMPS_SHAPE_COUNT; shape++)
            if (strcmp(names[i], flags[shape]) == 0) layout->shape = (LammpsShape)shape;
    }
    layout->bonded |= (style->flags & BONDED) != 0;
}

static void set_layout(LammpsLayout *layout, Columns *columns, const struct Style *style) {
    *columns = (Columns){" "};
    *layout = (LammpsLayout){.style = style->name,
                             .usual = (style->flags & USUAL) != 0,
                             .rare = (style->flags & RARE) != 0,
                             .open = (style->flags & OPEN) != 0,
                             .type = -1,
                             .molecule = -1,
                             .charge = -1,
                             .diameter = -1,
                             .radius = -1,
                             .x = -1,
                             .spin = -1};
    add_columns(layout, columns, style);
}

/* Whether the word is the style's name, perhaps with the suffix of an accelerated variant. */
static bool is_style(const char *word, const struct Style *style) {
    static const char *const suffixes[] = {"",     "/kk",  "/kk/host", "/kk/device",
                                           "/omp", "/gpu", "/intel",   "/opt"};
    const size_t length = strlen(style->name);
    if (strncasecmp(word, style->name, length) != 0) return false;
    for (size_t i = 0; i < sizeof suffixes / sizeof *suffixes; i++)
        if (strcasecmp(word + length, suffixes[i]) == 0) return true;
    return false;
}

/* The sub-styles behind "hybrid": if all words are styles of one layout, the columns are known to the last.
 */
static void add_sub_styles(LammpsLayout *layout, Columns *columns, char *const *words, size_t count) {
    LammpsLayout whole = *layout;
    Columns all = *columns;
    bool open = false;
    for (size_t w = 0; w < count; w++) {
        const struct Style *found = NULL;
        for (size_t s = 0; s < STYLES && found == NULL; s++)
            if (is_style(words[w], &styles[s])) found = &styles[s];
        if (found == NULL || strcmp(found->name, "hybrid") == 0) return;
        add_columns(&whole, &all, found);
        open |= (found->flags & OPEN) != 0;
    }
    whole.open = open || count == 0;
    *layout = whole;
    *columns = all;
}

size_t lammps_layouts(const char *comment, LammpsLayout layouts[LAMMPS_LAYOUTS_MAX]) {
    char text[LAMMPS_STYLE_SIZE], *words[8] = {NULL};
    size_t found = 0;
    snprintf(text, sizeof text, "%s", comment != NULL ? comment : "");
    for (char *c = text; *c != '\0'; c++) /* "full: id mol ...", "(full)" */
        if (strchr(":()", *c) != NULL) *c = ' ';
    size_t count = split_words(text, words, 8);
    if (count > 8) count = 8;
    for (size_t s = 0; s < STYLES && found < LAMMPS_LAYOUTS_MAX; s++) {
        Columns columns;
        if (comment != NULL && (count == 0 || !is_style(words[0], &styles[s]))) continue;
        set_layout(&layouts[found], &columns, &styles[s]);
        if (comment != NULL && strcmp(styles[s].name, "hybrid") == 0)
            add_sub_styles(&layouts[found], &columns, words + 1, count - 1);
        found++;
    }
    return found;
}

const char *lammps_style_names(char *out, size_t size) {
    size_t used = 0;
    out[0] = '\0';
    for (size_t s = 0; s < STYLES && used < size; s++) {
        if ((styles[s].flags & OLD) != 0 || (s > 0 && strcmp(styles[s].name, styles[s - 1].name) == 0))
            continue;
        used += (size_t)snprintf(out + used, size - used, "%s%s",
                                 s == 0            ? ""
                                 : s + 1 == STYLES ? " or "
                                                   : ", ",
                                 styles[s].name);
    }
    return out;
}

static bool word_fits(LammpsWord kind, const char *word, int64_t type_count, bool strict) {
    int64_t whole = 0;
    double number = 0;
    if (kind == LAMMPS_TYPE && strchr("0123456789+-", word[0]) == NULL) return true; /* a label */
    if (kind == LAMMPS_TYPE)
        return word_whole(word, &whole) && whole >= 1 && (type_count == 0 || whole <= type_count);
    if (kind == LAMMPS_WHOLE || kind == LAMMPS_ELECTRON || kind == LAMMPS_FLAG) {
        const int64_t low = kind == LAMMPS_FLAG ? 0 : kind == LAMMPS_ELECTRON ? -1 : INT64_MIN;
        const int64_t high = kind == LAMMPS_FLAG ? 1 : kind == LAMMPS_ELECTRON ? 3 : INT64_MAX;
        return word_whole(word, &whole) && whole >= low && whole <= high;
    }
    if (kind == LAMMPS_NUMBER) return word_number_or_none(word, &number);
    if (!word_number(word, &number)) return false;
    return !strict || number > 0 || (kind == LAMMPS_NOT_NEGATIVE && number == 0);
}

/* Spins have a direction of length 1. */
static bool spin_fits(char *const *words) {
    double square = 0;
    for (int i = 0; i < 3; i++) {
        double value = 0;
        if (!word_number(words[i], &value)) return false;
        square += value * value;
    }
    return fabs(square - 1) < 0.01;
}

bool lammps_line_fits(const LammpsLayout *layout, char *const *words, size_t count, int64_t type_count,
                      bool strict, int *wrong) {
    const size_t own = layout->word_count;
    *wrong = -1;
    if (count < own || (!layout->open && count != own && count != own + 3)) return false;
    for (size_t i = 0; i < (layout->open ? own : count); i++) {
        *wrong = (int)i;
        if (!word_fits(i < own ? layout->word[i] : LAMMPS_WHOLE, words[i], type_count, strict)) return false;
    }
    return !strict || layout->spin < 0 || spin_fits(words + layout->spin);
}

#define WORD_NAMES(X)                                                                                        \
    X(LAMMPS_NUMBER, "a finite number")                                                                      \
    X(LAMMPS_NOT_NEGATIVE, "a number not below 0")                                                           \
    X(LAMMPS_POSITIVE, "a number above 0")                                                                   \
    X(LAMMPS_WHOLE, "a whole number")                                                                        \
    X(LAMMPS_ELECTRON, "a spin from -1 to 3") X(LAMMPS_FLAG, "0 or 1") X(LAMMPS_TYPE, "a type")
BP_WORDS(LammpsWord, static const char *const word_names, WORD_NAMES);

const char *lammps_word_name(LammpsWord word) {
    return word_names[word];
}
