/* evaluate.c: see evaluate.h. Rows are evaluated block by block; only `within` needs all of them, and is
 * found for all rows before what it stands in. */
#include "evaluate.h"

#include "tree.h"

#include "base/decimal.h"

#include <locale.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { BLOCK = 512 };

/* What is found once for all rows, of each node that needs it: for each text whether it matches; a label's
 * numbers; for each row whether it lies within. */
typedef union Prepared {
    bool *match, *within;
    double *number;
} Prepared;

typedef struct Evaluation {
    const BpExpression *e;
    const BpExpressionRows *rows;
    Prepared *prepared; /* of each node */
    double *blocks;     /* need * BLOCK */
    uint32_t *codes;    /* two blocks */
} Evaluation;

static double power(double base, double exponent) {
    if (exponent == 2) return base * base; /* exact, and the most common */
    return pow(base, exponent);
}

/* As in Python: the sign is the divisor's. */
static double modulo(double a, double b) {
    const double rest = fmod(a, b);
    return rest != 0 && (rest < 0) != (b < 0) ? rest + b : rest;
}

/* NaN if either is, unlike fmin(). */
static double least(double a, double b) {
    return isnan(a) || isnan(b) ? NAN : a < b ? a : b;
}

static double most(double a, double b) {
    return isnan(a) || isnan(b) ? NAN : a > b ? a : b;
}

static double of_one(Operation operation, double a) {
    switch (operation) {
    case OP_NEGATE:
        return -a;
    case OP_ABS:
        return fabs(a);
    case OP_SQRT:
        return sqrt(a);
    case OP_EXP:
        return exp(a);
    case OP_LOG:
        return log(a);
    case OP_LOG10:
        return log10(a);
    case OP_SIN:
        return sin(a);
    case OP_COS:
        return cos(a);
    case OP_TAN:
        return tan(a);
    case OP_FLOOR:
        return floor(a);
    case OP_CEIL:
        return ceil(a);
    case OP_ROUND:
        return nearbyint(a); /* halves to the even number */
    case OP_SQUARE:
        return a * a;
    case OP_NOT:
        return a == 0;
    default:
        return NAN;
    }
}

static double of_two(Operation operation, double a, double b) {
    switch (operation) {
    case OP_ADD:
        return a + b;
    case OP_SUBTRACT:
        return a - b;
    case OP_MULTIPLY:
        return a * b;
    case OP_DIVIDE:
        return a / b;
    case OP_MODULO:
        return modulo(a, b);
    case OP_POWER:
        return power(a, b);
    case OP_MIN:
        return least(a, b);
    case OP_MAX:
        return most(a, b);
    case OP_ATAN2:
        return atan2(a, b);
    case OP_LESS:
        return a < b;
    case OP_AT_MOST:
        return a <= b;
    case OP_MORE:
        return a > b;
    case OP_AT_LEAST:
        return a >= b;
    case OP_EQUAL:
        return a == b;
    case OP_UNEQUAL:
        return a != b;
    case OP_AND:
        return a != 0 && b != 0;
    case OP_OR:
        return a != 0 || b != 0;
    default:
        return NAN;
    }
}

static bool is_among(const double *list, size_t count, double value) {
    size_t low = 0, high = count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (list[middle] < value)
            low = middle + 1;
        else
            high = middle;
    }
    return low < count && list[low] == value;
}

static void evaluate_texts(const Evaluation *v, const Node *node, uint32_t number, size_t first, size_t count,
                           double *out) {
    const BpExpressionRows *const rows = v->rows;
    uint32_t *const codes = v->codes, *const others = v->codes + BLOCK;
    rows->codes(rows->context, node->word, first, count, codes);
    if (node->operation == OP_SAME) rows->codes(rows->context, node->other, first, count, others);
    for (size_t i = 0; i < count; i++) {
        if (node->operation == OP_LABEL)
            out[i] = v->prepared[number].number[codes[i]];
        else if (node->operation == OP_MATCH)
            out[i] = v->prepared[number].match[codes[i]];
        else
            out[i] = strcmp(rows->text(rows->context, node->word, codes[i]),
                            rows->text(rows->context, node->other, others[i])) == 0;
    }
}

/* Values of rows first up to first + count into the block `out`, using those behind it. */
static void evaluate(const Evaluation *v, uint32_t number, size_t first, size_t count, double *out) {
    const Node *const node = &v->e->nodes[number];
    const BpExpressionRows *const rows = v->rows;
    switch (node->operation) {
    case OP_NAME:
    case OP_TEXT:
        return;
    case OP_NUMBER:
        for (size_t i = 0; i < count; i++) out[i] = node->number;
        return;
    case OP_WORD:
        rows->word(rows->context, node->word, first, count, out);
        return;
    case OP_COLUMN:
        rows->column(rows->context, v->e->columns[node->word].name, first, count, out);
        return;
    case OP_LABEL:
    case OP_MATCH:
    case OP_SAME:
        evaluate_texts(v, node, number, first, count, out);
        return;
    case OP_WITHIN:
        for (size_t i = 0; i < count; i++) out[i] = v->prepared[number].within[first + i];
        return;
    default:
        break;
    }
    evaluate(v, node->left, first, count, out);
    if (node->operation == OP_AMONG) {
        for (size_t i = 0; i < count; i++)
            out[i] = is_among(v->e->numbers + node->list, node->list_count, out[i]);
    } else if (node->right == 0) {
        for (size_t i = 0; i < count; i++) out[i] = of_one(node->operation, out[i]);
    } else {
        double *const right = out + BLOCK;
        evaluate(v, node->right, first, count, right);
        for (size_t i = 0; i < count; i++) out[i] = of_two(node->operation, out[i], right[i]);
    }
}

static void all_truths(const Evaluation *v, uint32_t number, bool *out) {
    for (size_t first = 0; first < v->rows->count; first += BLOCK) {
        const size_t count = v->rows->count - first < BLOCK ? v->rows->count - first : BLOCK;
        evaluate(v, number, first, count, v->blocks);
        for (size_t i = 0; i < count; i++) out[first + i] = v->blocks[i] != 0;
    }
}

static bool matches(const Evaluation *v, const Node *node, const char *text) {
    const bool any_case = v->e->words->word[node->word].any_case;
    for (size_t k = 0; k < node->list_count; k++) {
        const char *const wanted = v->e->pool + v->e->texts[node->list + k];
        if (any_case ? strcasecmp(wanted, text) == 0 : strcmp(wanted, text) == 0) return true;
    }
    return false;
}

/* The number that a whole label is; NaN: it is none. */
static double number_of(const char *text) {
    double value;
    const char *const end = bp_decimal_parse(text, &value);
    return end != NULL && *end == '\0' ? value : NAN;
}

static BpStatus prepare_texts(const Evaluation *v, uint32_t number, BpError *err) {
    const Node *const node = &v->e->nodes[number];
    const BpExpressionRows *const rows = v->rows;
    const size_t count = rows->text_count(rows->context, node->word);
    const bool label = node->operation == OP_LABEL;
    Prepared *const prepared = &v->prepared[number];
    void *const memory = calloc(count + 1, label ? sizeof *prepared->number : sizeof *prepared->match);
    if (memory == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for %zu texts", count);
    if (label)
        prepared->number = memory;
    else
        prepared->match = memory;
    for (size_t code = 0; code < count; code++) {
        const char *const text = rows->text(rows->context, node->word, code);
        if (label)
            prepared->number[code] = number_of(text);
        else
            prepared->match[code] = matches(v, node, text);
    }
    return BP_OK;
}

static BpStatus prepare_within(const Evaluation *v, uint32_t number, BpError *err) {
    const Node *const node = &v->e->nodes[number];
    bool *const of = malloc(v->rows->count + 1), *const within = calloc(v->rows->count + 1, 1);
    v->prepared[number].within = within;
    BpStatus status = BP_OK;
    if (of == NULL || within == NULL) {
        status = bp_fail(err, BP_ERR_MEMORY, "out of memory for %zu particles", v->rows->count);
    } else {
        all_truths(v, node->left, of);
        status = v->rows->within(v->rows->context, node->number, of, within, err);
    }
    free(of);
    return status;
}

/* Nodes stand behind their operands, so what is inside comes first. */
static BpStatus prepare(const Evaluation *v, BpError *err) {
    for (uint32_t n = 1; n < v->e->node_count; n++) {
        const Operation operation = v->e->nodes[n].operation;
        if (operation == OP_LABEL || operation == OP_MATCH) BP_TRY(prepare_texts(v, n, err));
        if (operation == OP_WITHIN) BP_TRY(prepare_within(v, n, err));
    }
    return BP_OK;
}

static void finish(Evaluation *v) {
    for (uint32_t n = 1; v->prepared != NULL && n < v->e->node_count; n++) {
        const Operation operation = v->e->nodes[n].operation;
        if (operation == OP_LABEL)
            free(v->prepared[n].number);
        else
            free(v->prepared[n].match);
    }
    free(v->prepared);
    free(v->blocks);
    free(v->codes);
}

static BpStatus begin(Evaluation *v, const BpExpression *e, const BpExpressionRows *rows, BpError *err) {
    uint32_t need = 1;
    for (uint32_t n = 1; n < e->node_count; n++) need = e->nodes[n].need > need ? e->nodes[n].need : need;
    *v = (Evaluation){.e = e, .rows = rows};
    v->prepared = calloc(e->node_count, sizeof *v->prepared);
    v->blocks = malloc((size_t)need * BLOCK * sizeof *v->blocks);
    v->codes = malloc(2 * BLOCK * sizeof *v->codes);
    if (v->prepared == NULL || v->blocks == NULL || v->codes == NULL)
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for an expression");
    const locale_t point = newlocale(LC_NUMERIC_MASK, "C", (locale_t)0);
    if (point == (locale_t)0) return bp_fail(err, BP_ERR_MEMORY, "out of memory for a locale");
    const locale_t before = uselocale(point); /* labels are numbers with a point */
    const BpStatus status = prepare(v, err);
    uselocale(before);
    freelocale(point);
    return status;
}

BpStatus bp_expression_truths(const BpExpression *expression, const BpExpressionRows *rows, bool *out,
                              BpError *err) {
    Evaluation v;
    const BpStatus status = begin(&v, expression, rows, err);
    if (status == BP_OK) all_truths(&v, expression->root, out);
    finish(&v);
    return status;
}

BpStatus bp_expression_numbers(const BpExpression *expression, const BpExpressionRows *rows, double *out,
                               BpError *err) {
    Evaluation v;
    const BpStatus status = begin(&v, expression, rows, err);
    for (size_t first = 0; first < rows->count && status == BP_OK; first += BLOCK) {
        const size_t count = rows->count - first < BLOCK ? rows->count - first : BLOCK;
        evaluate(&v, expression->root, first, count, v.blocks);
        memcpy(out + first, v.blocks, count * sizeof *out);
    }
    finish(&v);
    return status;
}
