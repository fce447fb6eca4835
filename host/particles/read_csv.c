/* read_csv.c: tables of text: comma, semicolon, tab or blanks between the columns; see reader.h. */
#include "elements.h"
#include "reader.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

typedef enum Role { X, Y, Z, RADIUS, DIAMETER, RED, GREEN, BLUE, TYPE, ELEMENT, ROLE_COUNT } Role;

typedef struct Table {
    char separator; /* ' ': blanks */
    char names_text[8192];
    char *names[BP_PARTICLE_COLUMNS_MAX];
    size_t count;
    int role[ROLE_COUNT];
    bool has_header;
} Table;

/* Splits in place. A field may stand in double quotes, which are taken away. */
static size_t split_fields(char *line, char separator, char **fields, size_t max) {
    if (separator == ' ') return split_words(line, fields, max);
    size_t count = 0;
    for (;;) {
        line += strspn(line, separator == '\t' ? " " : " \t");
        char *const begin = *line == '"' ? line + 1 : line;
        char *end = *line == '"' ? strchr(begin, '"') : NULL;
        char *next = strchr(end != NULL ? end : begin, separator);
        if (end == NULL) {
            end = next != NULL ? next : begin + strlen(begin);
            while (end > begin && (end[-1] == ' ' || end[-1] == '\r')) end--;
        }
        const bool more = next != NULL;
        *end = '\0';
        if (count < max) fields[count] = begin;
        count++;
        if (!more) return count;
        line = next + 1;
    }
}

static char separator_of(const char *line) {
    static const char separators[] = ",;\t";
    for (const char *s = separators; *s != '\0'; s++)
        if (strchr(line, *s) != NULL) return *s;
    return ' ';
}

static Role role_of(const char *name) {
    static const struct {
        const char *name;
        Role role;
    } known[] = {{"x", X},
                 {"y", Y},
                 {"z", Z},
                 {"pos_x", X},
                 {"pos_y", Y},
                 {"pos_z", Z},
                 {"position_x", X},
                 {"position_y", Y},
                 {"position_z", Z},
                 {"points:0", X},
                 {"points:1", Y},
                 {"points:2", Z},
                 {"points_0", X},
                 {"points_1", Y},
                 {"points_2", Z},
                 {"radius", RADIUS},
                 {"r", RADIUS},
                 {"diameter", DIAMETER},
                 {"d", DIAMETER},
                 {"red", RED},
                 {"green", GREEN},
                 {"blue", BLUE},
                 {"type", TYPE},
                 {"species", TYPE},
                 {"element", ELEMENT}};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (strcasecmp(name, known[i].name) == 0) return known[i].role;
    return ROLE_COUNT;
}

/* The names of the columns, from the first line, or none: then they are x, y, z and radius. */
static BpStatus take_header(Input *input, char *line, Table *table, BpError *err) {
    static char *const plain[] = {"x", "y", "z", "radius"};
    while (*line == '#' || *line == ' ') line++;
    table->separator = separator_of(line);
    snprintf(table->names_text, sizeof table->names_text, "%s", line);
    if (strlen(line) >= sizeof table->names_text)
        return input_fail(input, true, err,
                          "found a first line of more than %zu bytes, expected names of columns",
                          sizeof table->names_text - 1);
    table->count = split_fields(table->names_text, table->separator, table->names, BP_PARTICLE_COLUMNS_MAX);
    if (table->count > BP_PARTICLE_COLUMNS_MAX)
        return input_fail(input, true, err, "found %zu columns, expected at most %d", table->count,
                          BP_PARTICLE_COLUMNS_MAX);
    for (int r = 0; r < ROLE_COUNT; r++) table->role[r] = -1;
    size_t numbers = 0;
    double ignored = 0;
    for (size_t i = 0; i < table->count; i++) numbers += word_number(table->names[i], &ignored);
    table->has_header = numbers < table->count;
    if (!table->has_header) {
        if (table->count < 2 || table->count > 4)
            return input_fail(
                input, true, err,
                "found %zu columns without names, expected a first line that names them, such as "
                "x,y,z,radius",
                table->count);
        for (size_t i = 0; i < table->count; i++) table->names[i] = plain[i];
    }
    for (size_t i = 0; i < table->count; i++) {
        const Role role = role_of(table->names[i]);
        if (role == ROLE_COUNT) continue;
        if (table->role[role] >= 0)
            return input_fail(input, true, err, "found %.32s in two columns, expected one", table->names[i]);
        table->role[role] = (int)i;
    }
    if (table->role[X] < 0 || table->role[Y] < 0)
        return input_fail(
            input, true, err,
            "found no columns x and y, expected a first line that names them, such as x,y,z,radius");
    return BP_OK;
}

static BpStatus take_row(BpParticleFile *file, const Table *table, char *line, BpError *err) {
    char *fields[BP_PARTICLE_COLUMNS_MAX];
    double values[BP_PARTICLE_COLUMNS_MAX], number[ROLE_COUNT];
    Particle particle = PARTICLE_NONE;
    const size_t found = split_fields(line, table->separator, fields, BP_PARTICLE_COLUMNS_MAX);
    if (found != table->count)
        return input_fail(&file->input, true, err, "found %zu field%s, expected %zu, as in the first line",
                          found, found == 1 ? "" : "s", table->count);
    for (int r = X; r <= BLUE; r++) {
        number[r] = NAN;
        if (table->role[r] >= 0 && !word_number(fields[table->role[r]], &number[r]))
            return input_wrong(&file->input, fields[table->role[r]], "a finite number", err);
    }
    for (int i = 0; i < 3; i++) {
        particle.position[i] = table->role[i] >= 0 ? number[i] : 0;
        particle.color[i] = number[RED + i];
    }
    const bool color = table->role[RED] >= 0 && table->role[GREEN] >= 0 && table->role[BLUE] >= 0;
    for (int i = 0; i < 3; i++) {
        if (!color) particle.color[i] = NAN;
        if (color && !(particle.color[i] >= 0 && particle.color[i] <= 1))
            return input_wrong(&file->input, fields[table->role[RED + i]],
                               "a share of light from 0 to 1 (linear)", err);
    }
    if (table->role[RADIUS] >= 0) particle.radius = number[RADIUS];
    if (table->role[RADIUS] < 0 && table->role[DIAMETER] >= 0) particle.radius = number[DIAMETER] / 2;
    if (table->role[TYPE] >= 0) particle.type = fields[table->role[TYPE]];
    if (table->role[ELEMENT] >= 0) {
        particle.element = bp_element_of_symbol(fields[table->role[ELEMENT]]);
        if (table->role[TYPE] < 0) particle.type = fields[table->role[ELEMENT]];
    }
    for (size_t w = 0; w < file->taken_count; w++) {
        const int c = file->wanted_column[w];
        if (!word_number(fields[c], &values[c])) values[c] = NAN;
    }
    particle.values = values;
    return frame_add(file, &particle, true, err);
}

static BpStatus take_table(BpParticleFile *file, Table *table, BpError *err) {
    Input *const input = &file->input;
    char *line = NULL, *after = NULL;
    bool named = false;
    /* The names are in the first line that is not a remark, or in a remark just before it. */
    char *const remark = malloc(sizeof table->names_text);
    if (remark == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory");
    remark[0] = '\0';
    BpStatus status = BP_OK;
    for (;;) {
        BP_TRY_GOTO(status, input_full_line(input, &line, err), done);
        if (line == NULL || line[strspn(line, " ")] != '#') break;
        snprintf(remark, sizeof table->names_text, "%s", line);
    }
    if (line != NULL && strncmp(line, "\xef\xbb\xbf", 3) == 0) line += 3;
    if (line == NULL) {
        status = input_fail(input, true, err, "found no line, expected a table with columns x, y and z");
        goto done;
    }
    const char first = line[strspn(line, " \t\"")];
    named = (first >= '0' && first <= '9') || first == '-' || first == '+' || first == '.';
    after = named ? line : NULL;
    if (named && remark[0] != '\0') {
        Table probe = *table;
        BpError ignored = {0};
        if (take_header(input, remark, &probe, &ignored) == BP_OK && probe.has_header) {
            BP_TRY_GOTO(status, take_header(input, remark, table, err), done);
            table->separator = separator_of(line);
        }
        bp_error_clear(&ignored);
    }
    if (table->count == 0) BP_TRY_GOTO(status, take_header(input, line, table, err), done);
    BP_TRY_GOTO(status, frame_begin(file, (const char *const *)table->names, table->count, err), done);
    if (file->out != NULL) {
        file->out->up = 2;
        file->out->flat = table->role[Z] < 0;
        if (table->role[ELEMENT] >= 0) file->out->angstrom = 1;
        if (!table->has_header) bp_particles_note(file->out, "columns without names read as x, y, z, radius");
    }
    if (after != NULL) BP_TRY_GOTO(status, take_row(file, table, after, err), done);
    for (;;) {
        BP_TRY_GOTO(status, input_full_line(input, &line, err), done);
        if (line == NULL) break;
        if (line[strspn(line, " ")] == '#') continue;
        BP_TRY_GOTO(status, take_row(file, table, line, err), done);
    }
    if (file->added == 0)
        status = input_fail(input, true, err, "found a table without rows, expected particles");
done:
    free(remark);
    return status;
}

BpStatus read_csv(BpParticleFile *file, bool *end, BpError *err) {
    *end = file->frame > 0;
    if (*end) return BP_OK;
    Table *const table = calloc(1, sizeof *table);
    if (table == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory");
    const BpStatus status = take_table(file, table, err);
    free(table);
    return status;
}
