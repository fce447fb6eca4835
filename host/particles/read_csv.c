/* read_csv.c: tables of text: comma, semicolon, tab or blanks between the columns; see reader.h.
 *
 * Knows: which columns a particle is made of, and which one makes frames.   Does not know: how fields are
 * written (csv_fields.h). */
#include "column_names.h"
#include "csv_fields.h"
#include "elements.h"
#include "reader.h"

#include "base/message_text.h"
#include "base/plural.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

typedef enum Role { X, Y, Z, RADIUS, RED, GREEN, BLUE, TYPE, ELEMENT, ROLE_COUNT } Role;

enum { COLUMNS_MAX = BP_PARTICLE_COLUMNS_MAX, NAMES_SIZE = 8192 };

typedef struct Table {
    CsvForm form;
    char names_text[NAMES_SIZE];
    char *names[COLUMNS_MAX];
    int count;
    int role[ROLE_COUNT]; /* the column; below 0: none */
    size_t place_sets;    /* how many columns could be the places */
    double radius_scale;  /* 1/2 for diameters */
    double angstrom;      /* from the unit behind a name; 0: unknown */
    bool has_header;
    int moment;       /* the column whose values are frames; below 0: there are no frames */
    int moment_noted; /* one whose values are not, as could be expected; below 0: there is none */
    bool moment_rises;
    bool has_more; /* the next row belongs to another frame */
    char remark[NAMES_SIZE];
    char *copy; /* of a row, to look into before it is taken */
    size_t copy_size;
} Table;

/* ---- the names of columns ----------------------------------------------------------------------------- */

static BpStatus fail_twice(const Input *input, const char *name, BpError *err) {
    return input_fail(input, true, err, "found %s in two columns, expected one", name);
}

static BpStatus fail_quote(const Input *input, BpError *err) {
    return input_fail(input, true, err, "found a quote that is not closed, expected its end in this line");
}

/* The first of these names that a column has. */
static BpStatus find_role(const Input *input, Table *table, Role role, const char *const *names, size_t count,
                          BpError *err) {
    for (size_t i = 0; i < count && table->role[role] < 0; i++) {
        table->role[role] = column_named((const char *const *)table->names, (size_t)table->count, names[i]);
        if (table->role[role] == COLUMN_TWICE) return fail_twice(input, names[i], err);
    }
    return BP_OK;
}

/* Long names go before short ones: r is any column where another is the radius, red beside g and b, and a
 * distance beside an angle. */
static BpStatus find_radius(const Input *input, Table *table, BpError *err) {
    static const char *const names[] = {"radius", "diameter", "r", "d"}, *const angles[] = {"theta", "phi"};
    size_t count = 4;
    for (size_t a = 0; a < 2; a++)
        if (column_named((const char *const *)table->names, (size_t)table->count, angles[a]) != COLUMN_NONE)
            count = 2;
    for (size_t i = 0; i < count && table->role[RADIUS] < 0; i++) {
        BP_TRY(find_role(input, table, RADIUS, &names[i], 1, err));
        if (table->role[RADIUS] >= 0 && table->role[RADIUS] == table->role[RED]) table->role[RADIUS] = -1;
        table->radius_scale = i % 2 == 1 ? 0.5 : 1;
    }
    return BP_OK;
}

/* Places and radii must have one unit. */
static BpStatus find_unit(const Input *input, Table *table, BpError *err) {
    char first[COLUMN_UNIT_SIZE] = "", unit[COLUMN_UNIT_SIZE], shown[2][64];
    for (int r = X; r <= RADIUS; r++) {
        if (table->role[r] < 0) continue;
        column_unit(table->names[table->role[r]], unit);
        if (unit[0] == '\0') continue;
        if (first[0] == '\0') memcpy(first, unit, sizeof first);
        const double one = column_angstrom(first), other = column_angstrom(unit);
        if (one > 0 && other > 0 ? one == other : strcasecmp(first, unit) == 0) continue;
        bp_printable(first, shown[0], sizeof shown[0]);
        bp_printable(unit, shown[1], sizeof shown[1]);
        return input_fail(input, true, err,
                          "found lengths in %s and in %s, expected one unit for places and radii", shown[0],
                          shown[1]);
    }
    table->angstrom = column_angstrom(first);
    return BP_OK;
}

static BpStatus find_roles(const Input *input, Table *table, BpError *err) {
    static const char *const axes[] = {"x", "y", "z"}, *const types[] = {"type", "species", "particletype"},
                             *const elements[] = {"element", "symbol", "atomsymbol", "chemicalsymbol"};
    const char *const *const names = (const char *const *)table->names;
    for (int r = 0; r < ROLE_COUNT; r++) table->role[r] = COLUMN_NONE;
    table->place_sets = column_find_places(names, (size_t)table->count, &table->role[X]);
    for (int i = 0; i < 3; i++)
        if (table->role[i] == COLUMN_TWICE) return fail_twice(input, axes[i], err);
    if (table->role[X] < 0 || table->role[Y] < 0)
        return input_fail(
            input, true, err,
            "found no columns x and y, expected a first line that names them, such as x,y,z,radius");
    if (!column_find_color(names, (size_t)table->count, &table->role[RED]))
        table->role[RED] = table->role[GREEN] = table->role[BLUE] = COLUMN_NONE;
    BP_TRY(find_radius(input, table, err));
    BP_TRY(find_role(input, table, TYPE, types, 3, err));
    BP_TRY(find_role(input, table, ELEMENT, elements, 4, err));
    return find_unit(input, table, err);
}

/* Whether the first line is an empty field and 0, 1, 2, ..., which pandas writes as names of an array's
 * columns: numbers of rows stand below the empty one. */
static bool is_counted(const Table *table) {
    char number[16];
    bool counted = table->count > 1 && table->names[0][0] == '\0';
    for (int i = 1; i < table->count && counted; i++) {
        snprintf(number, sizeof number, "%d", i - 1);
        counted = strcmp(table->names[i], number) == 0;
    }
    return counted;
}

/* The names of the columns, from a line of names, or of numbers: then they are x, y, z and radius. */
static BpStatus take_header(const Input *input, const char *line, bool named, Table *table, BpError *err) {
    static char *const plain[] = {"x", "y", "z", "radius"};
    if (named) line += strspn(line, "#%/ \t");
    if (snprintf(table->names_text, NAMES_SIZE, "%s", line) >= NAMES_SIZE)
        return input_fail(input, true, err,
                          "found a first line of more than %d bytes, expected names of columns",
                          NAMES_SIZE - 1);
    if (csv_split(table->names_text, table->form.separator, table->names, COLUMNS_MAX, &table->count) ==
        CSV_UNCLOSED)
        return fail_quote(input, err);
    table->has_header = named;
    if (table->count > COLUMNS_MAX)
        return input_fail(input, true, err, "found %d columns, expected at most %d", table->count,
                          COLUMNS_MAX);
    if (!named && table->count <= COLUMNS_MAX && is_counted(table))
        return input_fail(
            input, true, err,
            "found numbers as names of columns behind one without a name, as pandas writes them, "
            "expected names such as x,y,z,radius");
    if (!named && (table->count < 2 || table->count > 4))
        return input_fail(input, true, err,
                          "found %d columns without names, expected a first line that names them, such as "
                          "x,y,z,radius",
                          table->count);
    for (int i = 0; i < table->count && !named; i++) table->names[i] = plain[i];
    return find_roles(input, table, err);
}

/* The unit in a field below a name: "nm", "(nm)" or "[nm]". */
static double unit_below(const char *field) {
    char unit[COLUMN_UNIT_SIZE];
    field += strspn(field, "([ ");
    snprintf(unit, sizeof unit, "%.*s", (int)strcspn(field, ")] "), field);
    return column_angstrom(unit);
}

/* A line below the names that tells units, or repeats names: texts stand where places should. */
static bool take_texts(Table *table, const char *line) {
    char *const copy = strdup(line), *fields[COLUMNS_MAX];
    int filled = 0;
    bool texts =
        copy != NULL && csv_split(copy, table->form.separator, fields, COLUMNS_MAX, &filled) == table->count;
    double angstrom = 0;
    for (int r = X; r <= RADIUS && texts; r++) {
        if (table->role[r] < 0) continue;
        const double unit = unit_below(fields[table->role[r]]);
        texts = r == RADIUS || csv_is_text(fields[table->role[r]]);
        angstrom = r == X || unit == angstrom ? unit : 0;
    }
    free(copy);
    if (texts && table->angstrom == 0) table->angstrom = angstrom;
    return texts;
}

/* ---- rows --------------------------------------------------------------------------------------------- */

static BpStatus take_row(BpParticleFile *file, Table *table, char *line, BpError *err) {
    Input *const input = &file->input;
    char *fields[COLUMNS_MAX];
    double values[COLUMNS_MAX], number[ROLE_COUNT];
    Particle particle = PARTICLE_NONE;
    int filled = 0;
    const int found = csv_split(line, table->form.separator, fields, COLUMNS_MAX, &filled);
    if (found == CSV_UNCLOSED) return fail_quote(input, err);
    if (filled == 0) return BP_OK; /* spreadsheets add rows of nothing */
    if (found < table->count || filled > table->count)
        return input_fail(input, true, err, "found %d field%s, expected %d, as in the first line", found,
                          found == 1 ? "" : "s", table->count);
    for (int r = X; r <= BLUE; r++) {
        number[r] = NAN;
        if (table->role[r] >= 0)
            BP_TRY(csv_number(input, &table->form, fields[table->role[r]], &number[r], err));
    }
    for (int i = 0; i < 3; i++) {
        particle.position[i] = table->role[i] >= 0 ? number[i] : 0;
        particle.color[i] = number[RED + i];
    }
    particle.radius = number[RADIUS] * table->radius_scale;
    if (table->role[TYPE] >= 0) particle.type = fields[table->role[TYPE]];
    if (table->role[ELEMENT] >= 0) {
        particle.element = bp_element_of_species(fields[table->role[ELEMENT]]);
        if (table->role[TYPE] < 0) particle.type = fields[table->role[ELEMENT]];
    }
    for (size_t w = 0; w < file->taken_count; w++) {
        const int c = file->wanted_column[w];
        values[c] = csv_number_or_none(&table->form, fields[c]);
    }
    particle.values = values;
    return frame_add(file, &particle, true, err);
}

/* ---- the whole ---------------------------------------------------------------------------------------- */

/* The next line that is neither empty nor a remark. `remark`: Optional; gets the last of those before it. */
static BpStatus next_row(Input *input, char **line, char *remark, BpError *err) {
    for (;;) {
        BP_TRY(input_full_line(input, line, err));
        if (*line == NULL) return BP_OK;
        const bool is_remark = csv_is_remark(*line);
        if (is_remark && remark != NULL) snprintf(remark, NAMES_SIZE, "%s", *line);
        if (!is_remark && !csv_is_empty(*line)) return BP_OK;
    }
}

/* The separator that a line such as "sep=;" declares to spreadsheets; 0: the line is another. */
static char separator_line(const char *line) {
    line += *line == '"';
    return strncasecmp(line, "sep=", 4) == 0 ? line[4] : '\0';
}

/* The names are in the first line that is no remark, or in a remark just before it. *line: that line if it
 * holds numbers, else NULL. */
static BpStatus begin_table(Input *input, Table *table, char *remark, char **line, BpError *err) {
    BP_TRY(next_row(input, line, remark, err));
    const char told = *line != NULL ? separator_line(*line) : '\0';
    if (told != '\0') BP_TRY(next_row(input, line, remark, err));
    if (*line == NULL)
        return input_fail(input, true, err, "found no line, expected a table with columns x, y and z");
    const char separator = csv_separator_of_numbers(*line);
    table->form.separator = told != '\0'        ? told
                            : separator != '\0' ? separator
                                                : csv_separator_of_names(*line);
    if (separator == '\0') {
        BP_TRY(take_header(input, *line, true, table, err));
        *line = NULL;
        return BP_OK;
    }
    if (remark[0] != '\0') {
        BpError ignored = {0};
        Table probe = {.form.separator = told != '\0' ? told : csv_separator_of_names(remark)};
        const bool named = take_header(input, remark, true, &probe, &ignored) == BP_OK;
        bp_error_clear(&ignored);
        if (named) {
            table->form.separator = probe.form.separator;
            BP_TRY(take_header(input, remark, true, table, err));
            table->form.separator = told != '\0' ? told : separator;
            return BP_OK;
        }
    }
    return take_header(input, *line, false, table, err);
}

static void note_choices(BpParticles *p, const Table *table) {
    char shown[3][32];
    p->up = 2;
    p->flat = table->role[Z] < 0;
    p->angstrom = table->angstrom;
    if (table->role[ELEMENT] >= 0 && p->angstrom == 0) p->angstrom = 1;
    if (!table->has_header) bp_particles_note(p, "columns without names read as x, y, z, radius");
    if (table->moment_noted >= 0) {
        bp_printable(table->names[table->moment_noted], shown[0], sizeof shown[0]);
        bp_particles_note(p,
                          table->moment_rises ? "each row has another \"%s\": all are drawn at once"
                                              : "rows are not sorted by \"%s\": all are drawn at once",
                          shown[0]);
    }
    if (table->place_sets < 2) return;
    for (int i = 0; i < 3; i++)
        bp_printable(table->role[i] >= 0 ? table->names[table->role[i]] : "", shown[i], sizeof shown[i]);
    bp_particles_note(p, "places from %s, %s%s%s", shown[0], shown[1], shown[2][0] != '\0' ? ", " : "",
                      shown[2]);
}

/* ---- frames ------------------------------------------------------------------------------------------- */

/* *moment: that of a row, which stays as it is; NaN: it has none. */
static BpStatus find_moment(Table *table, const char *line, double *moment, BpError *err) {
    char *fields[COLUMNS_MAX];
    int filled = 0;
    const size_t size = strlen(line) + 1;
    *moment = NAN;
    if (size > table->copy_size) {
        char *const larger = realloc(table->copy, 2 * size);
        if (larger == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for a row");
        table->copy = larger;
        table->copy_size = 2 * size;
    }
    memcpy(table->copy, line, size);
    if (csv_split(table->copy, table->form.separator, fields, COLUMNS_MAX, &filled) == table->count)
        *moment = csv_number_or_none(&table->form, fields[table->moment]);
    return BP_OK;
}

/* The column that numbers the frames of a table, or holds their times. One that is wanted as a value, for
 * colours, does not make frames. */
static int moment_column(const BpParticleFile *file, const Table *table) {
    static const char *const names[] = {"frame", "framenumber", "frameindex", "timestep",
                                        "step",  "snapshot",    "time"};
    int column = COLUMN_NONE;
    for (size_t i = 0; i < sizeof names / sizeof *names && column < 0; i++)
        column = column_named((const char *const *)table->names, (size_t)table->count, names[i]);
    for (size_t w = 0; w < file->wanted_count && column >= 0; w++)
        if (strcmp(file->wanted[w], table->names[column]) == 0) column = COLUMN_NONE;
    return column;
}

/* Reads all rows from `line` on. Their moments make frames if they rise and some rows share one; a table in
 * another order, and the track of one particle, are one frame. */
static BpStatus judge_moments(Input *input, Table *table, char *line, BpError *err) {
    double last = NAN, moment;
    bool rises = true, shared = false, differs = false;
    if (line == NULL) BP_TRY(next_row(input, &line, NULL, err));
    while (line != NULL && rises) {
        BP_TRY(find_moment(table, line, &moment, err));
        if (!isnan(moment) && !isnan(last)) {
            differs = differs || moment != last;
            shared = shared || moment == last;
            rises = moment >= last;
        }
        if (!isnan(moment)) last = moment;
        BP_TRY(next_row(input, &line, NULL, err));
    }
    table->moment_rises = rises;
    if (!rises || (differs && !shared)) table->moment_noted = table->moment;
    if (table->moment_noted >= 0 || !differs) table->moment = COLUMN_NONE;
    return BP_OK;
}

/* Reads the names of the columns, and decides whether the table has frames. *line: that of begin_table(). */
static BpStatus begin_file(BpParticleFile *file, Table *table, char **line, BpError *err) {
    Input *const input = &file->input;
    table->moment_noted = COLUMN_NONE;
    BP_TRY(begin_table(input, table, table->remark, line, err));
    table->moment = moment_column(file, table);
    if (table->moment < 0) return BP_OK;
    BP_TRY(judge_moments(input, table, *line, err));
    BP_TRY(input_rewind(input, err));
    table->remark[0] = '\0';
    return begin_table(input, table, table->remark, line, err);
}

/* Takes the rows of one frame, from `line` on, which may be NULL: behind the names, or in a later frame. */
static BpStatus take_rows(BpParticleFile *file, Table *table, char *line, BpError *err) {
    Input *const input = &file->input;
    double first = NAN, moment = NAN;
    table->has_more = false;
    if (line == NULL) BP_TRY(next_row(input, &line, NULL, err));
    size_t texts = 0;
    for (; file->frame == 0 && table->has_header && line != NULL && take_texts(table, line); texts++)
        BP_TRY(next_row(input, &line, NULL, err));
    if (file->out != NULL) {
        note_choices(file->out, table);
        if (texts > 0)
            bp_particles_note(file->out, "%zu line%s of texts below the names passed over", texts,
                              bp_plural(texts));
    }
    while (line != NULL) {
        if (table->moment >= 0) BP_TRY(find_moment(table, line, &moment, err));
        if (isnan(first)) first = moment;
        if (moment > first) {
            input_hold(input, line);
            table->has_more = true;
            break;
        }
        BP_TRY(take_row(file, table, line, err));
        BP_TRY(next_row(input, &line, NULL, err));
    }
    if (file->added > 0) return BP_OK;
    return input_fail(input, true, err, "found a table without rows, expected particles");
}

BpStatus read_csv(BpParticleFile *file, bool *end, BpError *err) {
    char *line = NULL;
    Table *table = file->state;
    *end = file->frame > 0 && !csv_has_more(table);
    if (*end) return BP_OK;
    if (table == NULL) {
        table = file->state = calloc(1, sizeof *table);
        if (table == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for a table");
        BP_TRY(begin_file(file, table, &line, err));
    }
    BP_TRY(frame_begin(file, (const char *const *)table->names, (size_t)table->count, err));
    file->colors.ambiguous = true;
    return take_rows(file, table, line, err);
}

bool csv_has_more(const void *state) {
    return ((const Table *)state)->has_more;
}

void csv_state_destroy(void *state) {
    if (state != NULL) free(((Table *)state)->copy);
    free(state);
}
