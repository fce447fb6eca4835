/* select.c: see select.h. */
#include "select.h"

#include "base/message_text.h"
#include "elements.h"
#include "expressions/evaluate.h"
#include "within.h"

#include <stdlib.h>
#include <string.h>

/* ---- words ----------------------------------------------------------------------------------------------
 */

#define TRUTH BP_VALUE_TRUTH, false
#define NUMBER BP_VALUE_NUMBER, false
#define TEXT BP_VALUE_TEXT, false
/* Value, name, type, whether small letters equal capital ones. */
#define WORD_LIST(X)                                                                                         \
    X(WORD_ALL, "all", TRUTH)                                                                                \
    X(WORD_NONE, "none", TRUTH)                                                                              \
    X(WORD_INDEX, "index", NUMBER)                                                                           \
    X(WORD_X, "x", NUMBER)                                                                                   \
    X(WORD_Y, "y", NUMBER)                                                                                   \
    X(WORD_Z, "z", NUMBER)                                                                                   \
    X(WORD_RADIUS, "radius", NUMBER)                                                                         \
    X(WORD_RESID, "resid", NUMBER)                                                                           \
    X(WORD_NAME, "name", TEXT)                                                                               \
    X(WORD_RESNAME, "resname", TEXT)                                                                         \
    X(WORD_CHAIN, "chain", TEXT)                                                                             \
    X(WORD_TYPE, "type", BP_VALUE_LABEL, false)                                                              \
    X(WORD_ELEMENT, "element", BP_VALUE_TEXT, true)                                                          \
    X(WORD_HYDROGEN, "hydrogen", TRUTH)                                                                      \
    X(WORD_WATER, "water", TRUTH)                                                                            \
    X(WORD_ION, "ion", TRUTH)                                                                                \
    X(WORD_SOLVENT, "solvent", TRUTH)                                                                        \
    X(WORD_PROTEIN, "protein", TRUTH)                                                                        \
    X(WORD_NUCLEIC, "nucleic", TRUTH)                                                                        \
    X(WORD_BACKBONE, "backbone", TRUTH)                                                                      \
    X(WORD_LIGAND, "ligand", TRUTH)                                                                          \
    X(WORD_HETERO, "hetero", TRUTH)

#define WORD_VALUE(value, ...) value,
#define WORD_ENTRY(value, ...) [value] = {__VA_ARGS__},
typedef enum Word { WORD_LIST(WORD_VALUE) WORD_COUNT } Word;
static const BpExpressionWord word_list[WORD_COUNT] = {WORD_LIST(WORD_ENTRY)};
static const BpExpressionWords words = {word_list, WORD_COUNT};

static const char resid_column[] = "residue_number";

BpStatus bp_select_parse(const char *text, BpValueType wanted, BpExpression **expression, BpError *err) {
    return bp_expression_parse(text, &words, wanted, expression, err);
}

size_t bp_select_columns(const BpExpression *expression, const char *columns[BP_SELECT_COLUMNS_MAX]) {
    size_t count = 0;
    for (; count < bp_expression_column_count(expression); count++)
        columns[count] = bp_expression_column(expression, count);
    if (bp_expression_uses(expression, WORD_RESID)) columns[count++] = resid_column;
    return count;
}

/* ---- values ---------------------------------------------------------------------------------------------
 */

enum { IS_WATER = 1, IS_ION = 2, IS_PROTEIN = 4, IS_NUCLEIC = 8, IS_BACKBONE = 16 };

typedef struct Source {
    const BpSelectFrame *frame;
    unsigned char *kinds; /* of each name: what it is as a residue's, and whether it is a backbone's atom's */
} Source;

/* NULL: the file has none of that name. */
static const double *column_of(const BpSelectFrame *frame, const char *name) {
    for (size_t w = 0; w < frame->wanted_count; w++)
        if (strcmp(frame->wanted[w], name) == 0) return frame->particles->column[w];
    return NULL;
}

/* The first particles of the file, counted from 0, include those that have no place and are not here. */
static void put_index(const BpParticles *p, size_t first, size_t count, double *out) {
    size_t gone = 0;
    while (gone < p->gone_count && p->gone[gone] <= first + gone) gone++;
    for (size_t i = 0; i < count; i++) {
        while (gone < p->gone_count && p->gone[gone] <= first + i + gone) gone++;
        out[i] = (double)(first + i + gone);
    }
}

static double truth_of(const Source *source, Word word, const BpParticleTag *tag) {
    const unsigned kind = source->kinds[tag->residue];
    switch (word) {
    case WORD_ALL:
        return 1;
    case WORD_HYDROGEN:
        return tag->element == 1;
    case WORD_WATER:
        return (kind & IS_WATER) != 0;
    case WORD_ION:
        return (kind & IS_ION) != 0;
    case WORD_SOLVENT:
        return (kind & (IS_WATER | IS_ION)) != 0;
    case WORD_PROTEIN:
        return (kind & IS_PROTEIN) != 0;
    case WORD_NUCLEIC:
        return (kind & IS_NUCLEIC) != 0;
    case WORD_BACKBONE:
        return (kind & IS_PROTEIN) != 0 && (source->kinds[tag->name] & IS_BACKBONE) != 0;
    case WORD_LIGAND:
        return tag->residue != 0 && (kind & (IS_WATER | IS_ION | IS_PROTEIN | IS_NUCLEIC)) == 0;
    case WORD_HETERO:
        return (tag->flags & BP_PARTICLE_HETERO) != 0;
    default:
        return 0;
    }
}

static void put_column(const void *context, const char *name, size_t first, size_t count, double *out) {
    const Source *const source = context;
    memcpy(out, column_of(source->frame, name) + first, count * sizeof *out);
}

static void put_word(const void *context, size_t word, size_t first, size_t count, double *out) {
    const Source *const source = context;
    const BpParticles *const p = source->frame->particles;
    if (word == WORD_INDEX) {
        put_index(p, first, count, out);
    } else if (word == WORD_RESID) {
        put_column(context, resid_column, first, count, out);
    } else if (word == WORD_RADIUS) {
        for (size_t i = 0; i < count; i++) out[i] = (double)p->radius[first + i];
    } else if (word >= WORD_X && word <= WORD_Z) {
        for (size_t i = 0; i < count; i++) out[i] = p->position[first + i][word - WORD_X];
    } else {
        for (size_t i = 0; i < count; i++) out[i] = truth_of(source, (Word)word, &p->tag[first + i]);
    }
}

static uint32_t code_of(const BpParticleTag *tag, size_t word) {
    switch ((Word)word) {
    case WORD_NAME:
        return tag->name;
    case WORD_RESNAME:
        return tag->residue;
    case WORD_CHAIN:
        return tag->chain;
    case WORD_TYPE:
        return tag->type;
    default:
        return tag->element;
    }
}

static void put_codes(const void *context, size_t word, size_t first, size_t count, uint32_t *out) {
    const Source *const source = context;
    for (size_t i = 0; i < count; i++) out[i] = code_of(&source->frame->particles->tag[first + i], word);
}

static size_t text_count(const void *context, size_t word) {
    const Source *const source = context;
    const size_t names = source->frame->particles->names.count;
    return word == WORD_ELEMENT ? BP_ELEMENT_MAX + 1 : names > 0 ? names : 1;
}

static const char *text_of(const void *context, size_t word, size_t code) {
    const Source *const source = context;
    const BpNames *const names = &source->frame->particles->names;
    return word == WORD_ELEMENT ? bp_elements[code].symbol : names->count > 0 ? names->text[code] : "";
}

static BpStatus find_within(const void *context, double reach, const bool *of, bool *out, BpError *err) {
    const Source *const source = context;
    return bp_particles_within(source->frame->particles, reach, of, out, err);
}

/* ---- what a file lacks ----------------------------------------------------------------------------------
 */

static bool has_names(const BpParticles *p) {
    for (size_t i = 0; i < p->count; i++)
        if (p->tag[i].name != 0) return true;
    return false;
}

/* What a word is about, where the frame has none of it; NULL: it has. */
static const char *lacks(const BpSelectFrame *frame, Word word) {
    const BpParticles *const p = frame->particles;
    switch (word) {
    case WORD_RADIUS:
        return p->radius == NULL ? "radii" : NULL;
    case WORD_RESID:
        return column_of(frame, resid_column) == NULL ? "numbers of residues" : NULL;
    case WORD_NAME:
        return !has_names(p) ? "names of atoms" : NULL;
    case WORD_RESNAME:
    case WORD_WATER:
    case WORD_ION:
    case WORD_SOLVENT:
    case WORD_PROTEIN:
    case WORD_NUCLEIC:
    case WORD_BACKBONE:
    case WORD_LIGAND:
        return !p->has_residue ? "residues" : NULL;
    case WORD_CHAIN:
        return !p->has_chain ? "chains" : NULL;
    case WORD_TYPE:
        return !p->has_type ? "types" : NULL;
    case WORD_ELEMENT:
    case WORD_HYDROGEN:
        return !p->has_element ? "elements" : NULL;
    case WORD_HETERO:
        return !p->has_records ? "records ATOM and HETATM" : NULL;
    default:
        return NULL;
    }
}

/* Adds "A, B, C" to a list, as far as there is room. */
static void add_to_list(char *list, size_t size, const char *text) {
    char shown[48];
    const size_t used = strlen(list);
    bp_printable(text, shown, sizeof shown);
    if (used + strlen(shown) + 8 < size)
        snprintf(list + used, size - used, "%s%s", used > 0 ? ", " : "", shown);
    else if (used + 5 < size && (used < 3 || strcmp(list + used - 3, "...") != 0))
        snprintf(list + used, size - used, ", ...");
}

static BpStatus fail_column(const BpSelectFrame *frame, const BpExpression *expression, size_t column,
                            BpError *err) {
    const BpParticles *const p = frame->particles;
    const char *const name = bp_expression_column(expression, column);
    const char *names[BP_PARTICLE_COLUMNS_MAX + WORD_COUNT];
    char list[256] = "", shown[BP_EXPRESSION_COLUMN_SIZE];
    size_t count = 0;
    for (size_t c = 0; c < p->column_count && c < BP_PARTICLE_COLUMNS_MAX; c++) {
        names[count++] = p->column_names[c];
        add_to_list(list, sizeof list, p->column_names[c]);
    }
    for (size_t w = 0; w < WORD_COUNT; w++) names[count++] = word_list[w].name;
    const char *const nearest = bp_nearest_name(name, names, count);
    bp_printable(name, shown, sizeof shown);
    if (nearest != NULL)
        return bp_expression_fail_column(expression, column, err,
                                         "found no column \"%s\"; did you mean \"%s\"?", shown, nearest);
    return bp_expression_fail_column(expression, column, err,
                                     "found no column \"%s\", expected a word or one of %s", shown,
                                     list[0] != '\0' ? list : "none: this file has no columns of numbers");
}

static BpStatus check(const BpSelectFrame *frame, const BpExpression *expression, BpError *err) {
    for (size_t c = 0; c < bp_expression_column_count(expression); c++)
        if (column_of(frame, bp_expression_column(expression, c)) == NULL && frame->particles->count > 0)
            return fail_column(frame, expression, c, err);
    for (size_t w = 0; w < WORD_COUNT; w++) {
        if (!bp_expression_uses(expression, w)) continue;
        const char *const missing = lacks(frame, (Word)w);
        if (missing == NULL) continue;
        return bp_expression_fail_word(expression, w, err, "found \"%s\", but this file has no %s%s",
                                       word_list[w].name, missing,
                                       w == WORD_TYPE ? "; a column of that name is column(\"type\")" : "");
    }
    return BP_OK;
}

/* ---- evaluation -----------------------------------------------------------------------------------------
 */

static BpStatus begin(Source *source, const BpSelectFrame *frame, const BpExpression *expression,
                      BpExpressionRows *rows, BpError *err) {
    static const char *const backbone[] = {"N", "CA", "C", "O"};
    const BpNames *const names = &frame->particles->names;
    BP_TRY(check(frame, expression, err));
    *source = (Source){frame, calloc(names->count + 1, sizeof *source->kinds)};
    if (source->kinds == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for a selection");
    for (size_t n = 1; n < names->count; n++) {
        const char *const name = names->text[n];
        unsigned kind = 0;
        if (bp_residue_is_water(name)) kind |= IS_WATER;
        if (bp_residue_is_ion(name)) kind |= IS_ION;
        if (bp_residue_is_protein(name)) kind |= IS_PROTEIN;
        if (bp_residue_is_nucleic(name)) kind |= IS_NUCLEIC;
        for (size_t k = 0; k < sizeof backbone / sizeof *backbone; k++)
            if (strcmp(name, backbone[k]) == 0) kind |= IS_BACKBONE;
        source->kinds[n] = (unsigned char)kind;
    }
    *rows = (BpExpressionRows){.count = frame->particles->count,
                               .context = source,
                               .word = put_word,
                               .column = put_column,
                               .codes = put_codes,
                               .text_count = text_count,
                               .text = text_of,
                               .within = find_within};
    return BP_OK;
}

BpStatus bp_select_truths(const BpSelectFrame *frame, const BpExpression *expression, bool *selected,
                          BpError *err) {
    Source source;
    BpExpressionRows rows;
    BP_TRY(begin(&source, frame, expression, &rows, err));
    const BpStatus status = bp_expression_truths(expression, &rows, selected, err);
    free(source.kinds);
    return status;
}

BpStatus bp_select_numbers(const BpSelectFrame *frame, const BpExpression *expression, double *numbers,
                           BpError *err) {
    Source source;
    BpExpressionRows rows;
    BP_TRY(begin(&source, frame, expression, &rows, err));
    const BpStatus status = bp_expression_numbers(expression, &rows, numbers, err);
    free(source.kinds);
    return status;
}

/* ---- nothing selected -----------------------------------------------------------------------------------
 */

static void add_range(char *list, size_t size, const char *name, const double *values, size_t count) {
    double low = INFINITY, high = -INFINITY;
    char text[128], shown[48];
    for (size_t i = 0; i < count; i++) {
        low = values[i] < low ? values[i] : low;
        high = values[i] > high ? values[i] : high;
    }
    bp_printable(name, shown, sizeof shown);
    if (low <= high)
        snprintf(text, sizeof text, "; %s: from %.6g to %.6g", shown, low, high);
    else
        snprintf(text, sizeof text, "; %s: no number", shown);
    if (strlen(list) + strlen(text) < size) strcat(list, text);
}

static int compare_texts(const void *a, const void *b) {
    return strcmp(*(const char *const *)a, *(const char *const *)b);
}

static BpStatus add_texts(const Source *source, size_t word, char *list, size_t size, BpError *err) {
    const BpParticles *const p = source->frame->particles;
    const size_t count = text_count(source, word);
    const char **const texts = calloc(count + 1, sizeof *texts);
    bool *const there = calloc(count + 1, sizeof *there);
    char own[192] = "";
    size_t found = 0;
    if (texts == NULL || there == NULL) {
        free(texts);
        free(there);
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for %zu texts", count);
    }
    for (size_t i = 0; i < p->count; i++) there[code_of(&p->tag[i], word)] = true;
    for (size_t code = 1; code < count; code++)
        if (there[code]) texts[found++] = text_of(source, word, code);
    qsort(texts, found, sizeof *texts, compare_texts);
    for (size_t k = 0; k < found; k++) add_to_list(own, sizeof own, texts[k]);
    const size_t used = strlen(list);
    snprintf(list + used, size - used, "; %s: %s", word_list[word].name, own);
    free(texts);
    free(there);
    return BP_OK;
}

BpStatus bp_select_fail_nothing(const BpSelectFrame *frame, const BpExpression *expression, BpError *err) {
    const BpParticles *const p = frame->particles;
    const Source source = {.frame = frame};
    char list[1200] = "", shown[160];
    double *const values = malloc((p->count + 1) * sizeof *values);
    if (values == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for %zu particles", p->count);
    BpStatus status = BP_OK;
    for (size_t w = 0; w < WORD_COUNT && status == BP_OK; w++) {
        if (!bp_expression_uses(expression, w)) continue;
        if (word_list[w].type == BP_VALUE_TEXT || word_list[w].type == BP_VALUE_LABEL)
            status = add_texts(&source, w, list, sizeof list, err);
        if (word_list[w].type != BP_VALUE_NUMBER) continue;
        put_word(&source, w, 0, p->count, values);
        add_range(list, sizeof list, word_list[w].name, values, p->count);
    }
    for (size_t c = 0; c < bp_expression_column_count(expression) && status == BP_OK; c++) {
        const char *const name = bp_expression_column(expression, c);
        add_range(list, sizeof list, name, column_of(frame, name), p->count);
    }
    free(values);
    BP_TRY(status);
    bp_printable(bp_expression_text(expression), shown, sizeof shown);
    return bp_fail(err, BP_ERR_SCENE, "found no particle for which this holds: %s%s", shown, list);
}
