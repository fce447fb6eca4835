/* cif_block.c: see cif_block.h. */
#include "cif_block.h"

#include "names.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* Of so many different texts, labels are kept whole: large cells number their atoms in them. */
enum { COLUMNS_MAX = 128, NAME_SIZE = 48, LABELS_MAX = 50000 };
#define LETTERS "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz"

typedef enum Field {
    LABEL,
    SYMBOL,
    SHARE,             /* three */
    PLACE = SHARE + 3, /* three */
    OCCUPANCY = PLACE + 3,
    ASSEMBLY,
    GROUP,
    FLAG,
    U_ISO,
    B_ISO,
    SITE_FIELDS,
    OPERATION = SITE_FIELDS,
    CENTERING,
    GROUP_NAME,
    CELL,                  /* six */
    FIELD_COUNT = CELL + 6 /* no field that is read */
} Field;

/* A dot in a name, as in later dictionaries, stands for the underscore of earlier ones. */
static const struct {
    const char *name;
    int field;
} names[] = {
    {"_atom_site_label", LABEL},
    {"_atom_site_type_symbol", SYMBOL},
    {"_atom_site_fract_x", SHARE},
    {"_atom_site_fract_y", SHARE + 1},
    {"_atom_site_fract_z", SHARE + 2},
    {"_atom_site_cartn_x", PLACE},
    {"_atom_site_cartn_y", PLACE + 1},
    {"_atom_site_cartn_z", PLACE + 2},
    {"_atom_site_occupancy", OCCUPANCY},
    {"_atom_site_disorder_assembly", ASSEMBLY},
    {"_atom_site_disorder_group", GROUP},
    {"_atom_site_calc_flag", FLAG},
    {"_atom_site_u_iso_or_equiv", U_ISO},
    {"_atom_site_b_iso_or_equiv", B_ISO},
    {"_symmetry_equiv_pos_as_xyz", OPERATION},
    {"_space_group_symop_operation_xyz", OPERATION},
    {"_space_group_symop_magn_operation_xyz", OPERATION},
    {"_space_group_symop_magn_centering_xyz", CENTERING},
    {"_symmetry_space_group_name_h-m", GROUP_NAME},
    {"_space_group_name_h-m_alt", GROUP_NAME},
    {"_space_group_name_h-m_full", GROUP_NAME},
    {"_symmetry_space_group_name_hall", GROUP_NAME},
    {"_space_group_name_hall", GROUP_NAME},
    {"_symmetry_int_tables_number", GROUP_NAME},
    {"_space_group_it_number", GROUP_NAME},
    {"_cell_length_a", CELL},
    {"_cell_length_b", CELL + 1},
    {"_cell_length_c", CELL + 2},
    {"_cell_angle_alpha", CELL + 3},
    {"_cell_angle_beta", CELL + 4},
    {"_cell_angle_gamma", CELL + 5},
};

static int field_of(const char *name) {
    char plain[NAME_SIZE];
    size_t length = strlen(name);
    if (length >= sizeof plain) return FIELD_COUNT;
    for (size_t i = 0; i <= length; i++)
        plain[i] = name[i] == '.' ? '_' : (char)tolower((unsigned char)name[i]);
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (strcmp(plain, names[i].name) == 0) return names[i].field;
    return FIELD_COUNT;
}

bool cif_block_has_places(const char *name) {
    const int field = field_of(name);
    return field >= SHARE && field < PLACE + 3;
}

/* What a row, or the items of a block, have said so far. */
typedef struct Row {
    char text[SITE_FIELDS][BP_PARTICLE_NAME_SIZE]; /* "": nothing */
    bool given[SITE_FIELDS];
} Row;

static BpStatus take_operation(const Input *input, Symmetry *symmetry, const char *text, BpError *err) {
    Operation operation;
    if (!symmetry_parse(text, &operation))
        return input_wrong(input, text,
                           "a symmetry operation such as x-y,-y,z+1/3 (in quotes, if it has blanks)", err);
    const BpStatus status = symmetry_add(symmetry, &operation, err);
    if (status != BP_OK) bp_error_at(err, input->name, (int)input->line, 0);
    return status;
}

/* A value of any field, from a row or beside its name. */
static BpStatus take_value(const Input *input, CifBlock *block, Row *row, int field, const char *value,
                           BpError *err) {
    const bool is_known = !cif_is_unknown(value);
    if (field >= FIELD_COUNT) return BP_OK;
    if (field < SITE_FIELDS) {
        if (strlen(value) >= sizeof row->text[0])
            return input_fail(input, true, err,
                              "found a value of %zu bytes in _atom_site, expected at most %zu", strlen(value),
                              sizeof row->text[0] - 1);
        row->given[field] = true;
        snprintf(row->text[field], sizeof row->text[0], "%s", is_known ? value : "");
        return BP_OK;
    }
    if (!is_known) return BP_OK;
    if (field == OPERATION) return take_operation(input, &block->operations, value, err);
    if (field == CENTERING) return take_operation(input, &block->centering, value, err);
    if (field == GROUP_NAME) {
        if (block->group_name[0] != '\0') return BP_OK;
        snprintf(block->group_name, sizeof block->group_name, "%s", value);
        block->group_line = input->line;
        return BP_OK;
    }
    const int i = field - CELL;
    if (!cif_number(value, &block->cell[i]))
        return input_wrong(input, value,
                           i < 3 ? "a length of the cell in angstrom" : "an angle of the cell in degrees",
                           err);
    block->has_cell[i] = true;
    return BP_OK;
}

/* NaN where the file has none. */
static BpStatus take_coordinates(const Input *input, const Row *row, int first, double out[3], BpError *err) {
    for (int i = 0; i < 3; i++) {
        const char *const text = row->text[first + i];
        if (text[0] == '\0')
            out[i] = NAN;
        else if (!cif_number(text, &out[i]) && !word_number_or_none(text, &out[i]))
            return input_wrong(input, text,
                               first == SHARE ? "a share of the cell (_atom_site_fract)"
                                              : "a coordinate in angstrom (_atom_site_Cartn)",
                               err);
    }
    return BP_OK;
}

static double number_or(const char *text, double instead) {
    double value = 0;
    return cif_number(text, &value) ? value : instead;
}

static BpStatus have_room(CifBlock *block, BpError *err) {
    if (block->site_count < block->site_capacity) return BP_OK;
    const size_t capacity = block->site_capacity > 0 ? 2 * block->site_capacity : 64;
    CifSite *const grown =
        block->site_count < BP_PARTICLES_MAX ? realloc(block->site, capacity * sizeof *grown) : NULL;
    if (grown == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for %zu sites", capacity);
    block->site = grown;
    block->site_capacity = capacity;
    return BP_OK;
}

static BpStatus add_site(const Input *input, CifBlock *block, const Row *row, BpError *err) {
    static const double per_u = 8 * 3.14159265358979323846 * 3.14159265358979323846; /* B = 8 pi^2 U */
    CifSite site = {.is_dummy = strcasecmp(row->text[FLAG], "dum") == 0,
                    .occupancy = number_or(row->text[OCCUPANCY], 1),
                    .u_iso = number_or(row->text[U_ISO], number_or(row->text[B_ISO], NAN) / per_u)};
    BP_TRY(take_coordinates(input, row, SHARE, site.share, err));
    BP_TRY(take_coordinates(input, row, PLACE, site.place, err));
    char label[BP_PARTICLE_NAME_SIZE];
    snprintf(label, sizeof label, "%s", row->text[LABEL]);
    if (block->names.count > LABELS_MAX) label[strspn(label, LETTERS)] = '\0';
    const struct {
        const char *text;
        uint16_t *number;
    } texts[] = {{label, &site.label},
                 {row->text[SYMBOL], &site.symbol},
                 {row->text[ASSEMBLY], &site.assembly},
                 {row->text[GROUP], &site.group}};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        const BpStatus status = names_number(&block->names, texts[i].text, texts[i].number, err);
        if (status == BP_ERR_SCENE) bp_error_at(err, input->name, (int)input->line, 0);
        BP_TRY(status);
    }
    block->has_shares |= row->given[SHARE] && row->given[SHARE + 1] && row->given[SHARE + 2];
    block->has_places |= row->given[PLACE] && row->given[PLACE + 1] && row->given[PLACE + 2];
    BP_TRY(have_room(block, err));
    block->site[block->site_count++] = site;
    return BP_OK;
}

/* Whether what was said has coordinates, and so is a site. */
static bool is_site(const Row *row) {
    for (int f = SHARE; f < PLACE + 3; f++)
        if (row->given[f]) return true;
    return false;
}

static BpStatus take_row(CifReading *reading, Input *input, CifBlock *block, Row *row, const int *field,
                         size_t columns, BpError *err) {
    for (size_t c = 0; c < columns; c++) {
        BP_TRY(cif_peek(&reading->tokens, input, err));
        if (!cif_is_value(&reading->tokens))
            return input_fail(
                input, true, err,
                "found %s in a row of a table of %zu columns, expected a value: the file is cut "
                "off, or a value is missing or lacks quotes",
                reading->tokens.token == NULL ? "the end of the file" : "a name", columns);
        BP_TRY(take_value(input, block, row, c < COLUMNS_MAX ? field[c] : FIELD_COUNT, reading->tokens.token,
                          err));
        cif_take(&reading->tokens);
    }
    return is_site(row) ? add_site(input, block, row, err) : BP_OK;
}

static BpStatus take_loop(CifReading *reading, Input *input, CifBlock *block, Row *row, BpError *err) {
    int field[COLUMNS_MAX];
    size_t columns = 0;
    bool is_read = false;
    for (;; columns++) {
        BP_TRY(cif_peek(&reading->tokens, input, err));
        if (!cif_is_name(&reading->tokens)) break;
        const int found = field_of(reading->tokens.token);
        if (found < FIELD_COUNT && columns >= COLUMNS_MAX)
            return input_fail(input, true, err, "found a table of more than %d columns, expected fewer",
                              COLUMNS_MAX);
        if (columns < COLUMNS_MAX) field[columns] = found;
        is_read |= found < FIELD_COUNT;
        cif_take(&reading->tokens);
    }
    for (;;) {
        BP_TRY(cif_peek(&reading->tokens, input, err));
        if (!cif_is_value(&reading->tokens)) return BP_OK;
        if (!is_read) {
            cif_take(&reading->tokens);
            continue;
        }
        for (int f = 0; f < SITE_FIELDS; f++) row->text[f][0] = '\0';
        memset(row->given, 0, sizeof row->given);
        BP_TRY(take_row(reading, input, block, row, field, columns, err));
    }
}

static BpStatus take_item(CifReading *reading, Input *input, CifBlock *block, Row *items, BpError *err) {
    const int field = field_of(reading->tokens.token);
    cif_take(&reading->tokens);
    reading->tokens.lenient = field >= FIELD_COUNT;
    const BpStatus status = cif_peek(&reading->tokens, input, err);
    reading->tokens.lenient = false;
    BP_TRY(status);
    if (!cif_is_value(&reading->tokens)) return BP_OK;
    cif_take(&reading->tokens);
    return take_value(input, block, items, field, reading->tokens.token, err);
}

static BpStatus take_next(CifReading *reading, Input *input, CifBlock *block, Row rows[2], BpError *err) {
    if (cif_opens(&reading->tokens, "save_")) return cif_skip_save_frame(&reading->tokens, input, err);
    if (cif_is_name(&reading->tokens)) return take_item(reading, input, block, &rows[0], err);
    const bool loop = cif_opens(&reading->tokens, "loop_");
    cif_take(&reading->tokens);
    return loop ? take_loop(reading, input, block, &rows[1], err) : BP_OK;
}

static BpStatus take_block(CifReading *reading, Input *input, CifBlock *block, Row rows[2], BpError *err) {
    for (;;) {
        BP_TRY(cif_peek(&reading->tokens, input, err));
        if (reading->tokens.token == NULL || cif_opens(&reading->tokens, "data_")) break;
        BP_TRY(take_next(reading, input, block, rows, err));
    }
    /* A table of one row may be written as items. */
    return is_site(&rows[0]) && block->site_count == 0 ? add_site(input, block, &rows[0], err) : BP_OK;
}

BpStatus cif_block_read(CifReading *reading, Input *input, CifBlock *block, bool *end, BpError *err) {
    cif_block_clear(block);
    BP_TRY(cif_peek(&reading->tokens, input, err));
    *end = reading->tokens.token == NULL;
    if (*end) return BP_OK;
    if (cif_opens(&reading->tokens, "data_")) cif_take(&reading->tokens);
    reading->blocks++;
    Row *const rows = calloc(2, sizeof *rows); /* of items, of tables */
    if (rows == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for a row");
    const BpStatus status = take_block(reading, input, block, rows, err);
    free(rows);
    return status;
}

void cif_block_clear(CifBlock *block) {
    symmetry_clear(&block->operations);
    symmetry_clear(&block->centering);
    names_clear(&block->names);
    free(block->site);
    *block = (CifBlock){0};
}
