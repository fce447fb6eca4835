/* parse.c: recursive descent, one function for each level of precedence; see expression.h.
 *
 * Each function returns the number of its node in *node. A name that is no word stays undecided until what
 * stands beside it says whether a number or a text is wanted. */
#include "tokens.h"
#include "tree.h"

#include "base/message_text.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct Parser {
    BpExpression *e;
    Token token; /* the next one */
    unsigned depth;
    BpError *err;
} Parser;

static BpStatus parse_or(Parser *p, uint32_t *node);
static BpStatus parse_sum(Parser *p, uint32_t *node);
static BpStatus parse_sign(Parser *p, uint32_t *node);

/* ---- nodes, tokens, errors ------------------------------------------------------------------------------
 */

static BpStatus fail_memory(const Parser *p) {
    return bp_fail(p->err, BP_ERR_MEMORY, "out of memory for an expression");
}

static BpStatus fail_at(const Parser *p, size_t begin, size_t end, const char *format, ...)
    BP_PRINTF_LIKE(4, 5);
static BpStatus fail_at(const Parser *p, size_t begin, size_t end, const char *format, ...) {
    char message[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    return token_fail(p->e->text, begin, end, p->err, "%s", message);
}

/* The part of the text, short enough for a message. */
static const char *part(const Parser *p, size_t begin, size_t end, char out[64]) {
    char whole[BP_EXPRESSION_BYTES_MAX + 1];
    memcpy(whole, p->e->text + begin, end - begin);
    whole[end - begin] = '\0';
    bp_printable(whole, out, 64);
    return out;
}

static BpStatus fail_token(const Parser *p, const char *expected) {
    char found[64];
    if (p->token.kind == TOKEN_END)
        return fail_at(p, p->token.begin, p->token.begin, "found the end, expected %s", expected);
    return fail_at(p, p->token.begin, p->token.end, "found \"%s\", expected %s",
                   part(p, p->token.begin, p->token.end, found), expected);
}

static BpStatus advance(Parser *p) {
    return token_read(p->e->text, p->token.end, &p->token, p->err);
}

static BpStatus take(Parser *p, TokenKind kind, const char *expected) {
    return p->token.kind == kind ? advance(p) : fail_token(p, expected);
}

static BpStatus enter(Parser *p) {
    if (++p->depth <= BP_EXPRESSION_DEPTH_MAX) return BP_OK;
    return fail_at(p, p->token.begin, p->token.end, "found more than %d levels of parentheses and signs",
                   BP_EXPRESSION_DEPTH_MAX);
}

static bool grow(void *array, size_t count, size_t *capacity, size_t size) {
    void **const place = array;
    if (count < *capacity) return true;
    const size_t more = *capacity > 0 ? 2 * *capacity : 16;
    void *const grown = realloc(*place, more * size);
    if (grown == NULL) return false;
    *place = grown;
    *capacity = more;
    return true;
}

static uint32_t larger(uint32_t a, uint32_t b) {
    return a > b ? a : b;
}

static BpStatus add_node(Parser *p, Node made, uint32_t *node) {
    BpExpression *const e = p->e;
    if (!grow(&e->nodes, e->node_count, &e->node_capacity, sizeof *e->nodes)) return fail_memory(p);
    made.need = 1;
    if (made.left != 0) made.need = larger(made.need, e->nodes[made.left].need);
    if (made.right != 0) made.need = larger(made.need, e->nodes[made.right].need + 1);
    e->nodes[e->node_count] = made;
    *node = (uint32_t)e->node_count++;
    return BP_OK;
}

static Node *at(const Parser *p, uint32_t node) {
    return &p->e->nodes[node];
}

/* A node over one or two others, from the beginning of the first to the end of the last. */
static BpStatus join(Parser *p, Operation operation, BpValueType type, uint32_t left, uint32_t right,
                     uint32_t *node) {
    return add_node(p,
                    (Node){.operation = operation,
                           .type = type,
                           .left = left,
                           .right = right,
                           .begin = at(p, left)->begin,
                           .end = at(p, right != 0 ? right : left)->end},
                    node);
}

/* ---- types ----------------------------------------------------------------------------------------------
 */

/* The word nearest to a name, with what leads to it: ", did you mean ...?"; "" where none is near. */
static const char *near_word(const Parser *p, const char *name, char out[128]) {
    const char *names[96];
    size_t count = 0;
    for (size_t i = 0; i < p->e->words->count && count < 96; i++) names[count++] = p->e->words->word[i].name;
    const char *const nearest = bp_nearest_name(name, names, count);
    out[0] = '\0';
    if (nearest != NULL) snprintf(out, 128, "; did you mean \"%s\"?", nearest);
    return out;
}

static const char *name_of(const Parser *p, uint32_t node) {
    return p->e->pool + p->e->texts[at(p, node)->list];
}

static bool is_text_word(const Node *node) {
    return node->operation == OP_WORD && (node->type == BP_VALUE_TEXT || node->type == BP_VALUE_LABEL);
}

/* Whether what is beside it decides what it is. */
static bool is_text_written(const Node *node) {
    return node->operation == OP_TEXT || node->operation == OP_NAME;
}

static BpStatus add_column(Parser *p, uint32_t node) {
    BpExpression *const e = p->e;
    Node *const own = at(p, node);
    const char *const name = name_of(p, node);
    size_t c = 0;
    if (strlen(name) >= BP_EXPRESSION_COLUMN_SIZE)
        return fail_at(p, own->begin, own->end, "found a name of more than %d bytes, expected a column's",
                       BP_EXPRESSION_COLUMN_SIZE - 1);
    while (c < e->column_count && strcmp(e->columns[c].name, name) != 0) c++;
    if (c == BP_EXPRESSION_COLUMNS_MAX)
        return fail_at(p, own->begin, own->end, "found more than %d columns, expected fewer",
                       BP_EXPRESSION_COLUMNS_MAX);
    if (c == e->column_count) {
        memcpy(e->columns[c].name, name, strlen(name) + 1);
        e->columns[c].begin = own->begin;
        e->columns[c].end = own->end;
        e->column_count++;
    }
    own->operation = OP_COLUMN;
    own->type = BP_VALUE_NUMBER;
    own->word = c;
    return BP_OK;
}

static BpStatus need_number(Parser *p, uint32_t node) {
    Node *const own = at(p, node);
    char found[64];
    if (own->operation == OP_NAME) return add_column(p, node);
    if (own->type == BP_VALUE_NUMBER) return BP_OK;
    if (own->type == BP_VALUE_LABEL) {
        own->operation = OP_LABEL;
        own->type = BP_VALUE_NUMBER;
        return BP_OK;
    }
    part(p, own->begin, own->end, found);
    return fail_at(p, own->begin, own->end, "found %s, which is a %s, expected a number", found,
                   own->type == BP_VALUE_TEXT ? "text" : "condition");
}

static BpStatus need_truth(Parser *p, uint32_t node) {
    const Node *const own = at(p, node);
    char near[128], found[64];
    if (own->type == BP_VALUE_TRUTH && own->operation != OP_NAME) return BP_OK;
    part(p, own->begin, own->end, found);
    if (own->operation == OP_NAME && own->bare)
        return fail_at(p, own->begin, own->end,
                       "found \"%s\", expected a condition, such as \"%s > 3\" for a column%s", found, found,
                       near_word(p, name_of(p, node), near));
    return fail_at(p, own->begin, own->end, "found %s, which is a %s, expected a condition such as z > 3",
                   found, own->type == BP_VALUE_NUMBER ? "number" : "text");
}

/* ---- comparisons ----------------------------------------------------------------------------------------
 */

static const char *sign_of(Operation operation) {
    return operation == OP_LESS ? "<" : operation == OP_AT_MOST ? "<=" : operation == OP_MORE ? ">" : ">=";
}

static BpStatus negate(Parser *p, bool negated, uint32_t *node) {
    if (!negated) return BP_OK;
    return join(p, OP_NOT, BP_VALUE_TRUTH, *node, 0, node);
}

/* One of the two is a text. */
static BpStatus compare_texts(Parser *p, Operation operation, uint32_t left, uint32_t right, uint32_t *node) {
    const uint32_t word = is_text_word(at(p, left)) ? left : right, other = word == left ? right : left;
    Node made = {.operation = OP_MATCH, .type = BP_VALUE_TRUTH, .word = at(p, word)->word};
    char found[64], near[128];
    made.begin = at(p, left)->begin;
    made.end = at(p, right)->end;
    if (operation != OP_EQUAL && operation != OP_UNEQUAL)
        return fail_at(p, made.begin, made.end,
                       "found texts compared by %s, expected == or !=, the only two for texts",
                       sign_of(operation));
    if (!is_text_word(at(p, word))) { /* two texts, or a text and what is no word */
        const uint32_t name = at(p, left)->operation == OP_TEXT ? right : left;
        const Node *const own = at(p, name);
        part(p, own->begin, own->end, found);
        if (own->operation != OP_NAME && own->operation != OP_TEXT)
            return fail_at(p, own->begin, own->end, "found %s beside a text, but it is a %s", found,
                           own->type == BP_VALUE_TRUTH ? "condition" : "number");
        if (own->operation == OP_NAME)
            return fail_at(p, own->begin, own->end,
                           "found \"%s\" beside a text, expected a word for texts, such as name, resname, "
                           "chain, type or element%s",
                           found, near_word(p, name_of(p, name), near));
        return fail_at(p, made.begin, made.end,
                       "found two texts, expected a word for texts beside one, such as chain or element");
    }
    if (is_text_word(at(p, other))) {
        made.operation = OP_SAME;
        made.other = at(p, other)->word;
    } else if (is_text_written(at(p, other))) {
        made.list = at(p, other)->list;
        made.list_count = 1;
    } else {
        const Node *const own = at(p, other);
        part(p, own->begin, own->end, found);
        return fail_at(p, own->begin, own->end, "found %s, which is a %s, expected a text, such as \"%s\"",
                       found, own->type == BP_VALUE_TRUTH ? "condition" : "number", found);
    }
    BP_TRY(add_node(p, made, node));
    return negate(p, operation == OP_UNEQUAL, node);
}

static BpStatus compare(Parser *p, Operation operation, uint32_t left, uint32_t right, uint32_t *node) {
    const Node *const a = at(p, left), *const b = at(p, right);
    const bool texts =
        (a->operation == OP_TEXT || b->operation == OP_TEXT) ||
        (a->type == BP_VALUE_TEXT && a->operation == OP_WORD) ||
        (b->type == BP_VALUE_TEXT && b->operation == OP_WORD) ||
        (a->type == BP_VALUE_LABEL && (b->operation == OP_NAME || b->type == BP_VALUE_LABEL)) ||
        (b->type == BP_VALUE_LABEL && a->operation == OP_NAME);
    if (texts) return compare_texts(p, operation, left, right, node);
    BP_TRY(need_number(p, left));
    BP_TRY(need_number(p, right));
    return join(p, operation, BP_VALUE_TRUTH, left, right, node);
}

static BpStatus add_text(Parser *p, const Token *token, size_t *place) {
    BpExpression *const e = p->e;
    if (!grow(&e->texts, e->text_count, &e->text_capacity, sizeof *e->texts)) return fail_memory(p);
    token_text(e->text, token, e->pool + e->pool_used);
    *place = e->text_count;
    e->texts[e->text_count++] = e->pool_used;
    e->pool_used += strlen(e->pool + e->pool_used) + 1;
    return BP_OK;
}

static int compare_numbers(const void *a, const void *b) {
    const double one = *(const double *)a, other = *(const double *)b;
    return one < other ? -1 : one > other;
}

/* An element of a list; all are of one kind, which the first of a label's decides: *numbers is -1 before. */
static BpStatus parse_element(Parser *p, BpValueType type, int *numbers) {
    BpExpression *const e = p->e;
    const size_t begin = p->token.begin;
    double sign = 1;
    if (p->token.kind == TOKEN_MINUS) {
        sign = -1;
        BP_TRY(advance(p));
        if (p->token.kind != TOKEN_NUMBER) return fail_token(p, "a number");
    }
    const bool number = p->token.kind == TOKEN_NUMBER;
    if (*numbers < 0) *numbers = type == BP_VALUE_LABEL ? number : type == BP_VALUE_NUMBER;
    if (*numbers == 0 && (number || (p->token.kind != TOKEN_TEXT && p->token.kind != TOKEN_NAME))) {
        char found[64];
        if (!number) return fail_token(p, "a text");
        return fail_at(p, begin, p->token.end, "found a number, expected a text, such as \"%s\"",
                       part(p, begin, p->token.end, found));
    }
    if (*numbers == 1 && !number) return fail_token(p, "a number");
    if (number) {
        if (!grow(&e->numbers, e->number_count, &e->number_capacity, sizeof *e->numbers))
            return fail_memory(p);
        e->numbers[e->number_count++] = sign * p->token.number;
    } else {
        size_t place;
        BP_TRY(add_text(p, &p->token, &place));
    }
    return advance(p);
}

/* Behind `in`. */
static BpStatus parse_list(Parser *p, uint32_t left, uint32_t *node) {
    BpExpression *const e = p->e;
    int numbers = -1;
    if (is_text_written(at(p, left)) && at(p, left)->operation == OP_TEXT)
        return fail_at(p, at(p, left)->begin, at(p, left)->end,
                       "found a text before \"in\", expected a word or a number, as in chain in (A, B)");
    const BpValueType type = is_text_word(at(p, left)) ? at(p, left)->type : BP_VALUE_NUMBER;
    if (type == BP_VALUE_NUMBER) BP_TRY(need_number(p, left));
    Node made = {.type = BP_VALUE_TRUTH, .begin = at(p, left)->begin, .word = at(p, left)->word};
    const size_t first_number = e->number_count, first_text = e->text_count;
    BP_TRY(take(p, TOKEN_OPEN, "a list in parentheses, as in (A, B)"));
    for (;;) {
        BP_TRY(parse_element(p, type, &numbers));
        if (p->token.kind != TOKEN_COMMA) break;
        BP_TRY(advance(p));
    }
    made.end = p->token.end;
    BP_TRY(take(p, TOKEN_CLOSE, "\",\" or \")\""));
    if (numbers == 1) {
        BP_TRY(need_number(p, left));
        made.operation = OP_AMONG;
        made.left = left;
        made.list = first_number;
        made.list_count = e->number_count - first_number;
        qsort(e->numbers + first_number, made.list_count, sizeof *e->numbers, compare_numbers);
    } else {
        made.operation = OP_MATCH;
        made.list = first_text;
        made.list_count = e->text_count - first_text;
    }
    return add_node(p, made, node);
}

static bool comparison_of(TokenKind kind, Operation *operation) {
    static const struct {
        TokenKind kind;
        Operation operation;
    } signs[] = {{TOKEN_LESS, OP_LESS},         {TOKEN_AT_MOST, OP_AT_MOST}, {TOKEN_MORE, OP_MORE},
                 {TOKEN_AT_LEAST, OP_AT_LEAST}, {TOKEN_EQUAL, OP_EQUAL},     {TOKEN_UNEQUAL, OP_UNEQUAL}};
    for (size_t i = 0; i < sizeof signs / sizeof *signs; i++) {
        *operation = signs[i].operation;
        if (signs[i].kind == kind) return true;
    }
    return false;
}

/* Whether the next token is `not` and the one behind it `in`. */
static bool at_not_in(const Parser *p) {
    Token next;
    BpError ignored = {0};
    const bool is = p->token.kind == TOKEN_NOT &&
                    token_read(p->e->text, p->token.end, &next, &ignored) == BP_OK && next.kind == TOKEN_IN;
    bp_error_clear(&ignored);
    return is;
}

static BpStatus parse_comparison(Parser *p, uint32_t *node) {
    uint32_t left, right, both;
    Operation operation;
    BP_TRY(parse_sum(p, &left));
    *node = left;
    const bool negated = at_not_in(p);
    if (negated) BP_TRY(advance(p));
    if (p->token.kind == TOKEN_IN) {
        BP_TRY(advance(p));
        BP_TRY(parse_list(p, left, node));
        return negate(p, negated, node);
    }
    for (bool first = true; comparison_of(p->token.kind, &operation); first = false) {
        BP_TRY(advance(p));
        BP_TRY(parse_sum(p, &right));
        BP_TRY(compare(p, operation, left, right, &both));
        if (first)
            *node = both;
        else
            BP_TRY(join(p, OP_AND, BP_VALUE_TRUTH, *node, both, node));
        left = right;
    }
    return BP_OK;
}

/* ---- numbers --------------------------------------------------------------------------------------------
 */

static const struct {
    const char *name;
    Operation operation;
    int least, most; /* operands */
} functions[] = {{"abs", OP_ABS, 1, 1},   {"sqrt", OP_SQRT, 1, 1},   {"exp", OP_EXP, 1, 1},
                 {"log", OP_LOG, 1, 1},   {"log10", OP_LOG10, 1, 1}, {"sin", OP_SIN, 1, 1},
                 {"cos", OP_COS, 1, 1},   {"tan", OP_TAN, 1, 1},     {"floor", OP_FLOOR, 1, 1},
                 {"ceil", OP_CEIL, 1, 1}, {"round", OP_ROUND, 1, 1}, {"min", OP_MIN, 2, 99},
                 {"max", OP_MAX, 2, 99},  {"atan2", OP_ATAN2, 2, 2}, {"norm", OP_SQRT, 2, 99}};
enum { FUNCTION_COUNT = sizeof functions / sizeof *functions };

static BpStatus fail_function(Parser *p, const Token *name) {
    const char *names[FUNCTION_COUNT + 1] = {"column"};
    char own[BP_EXPRESSION_BYTES_MAX + 1], found[64];
    token_text(p->e->text, name, own);
    for (size_t i = 0; i < FUNCTION_COUNT; i++) names[i + 1] = functions[i].name;
    const char *const nearest = bp_nearest_name(own, names, FUNCTION_COUNT + 1);
    part(p, name->begin, name->end, found);
    if (nearest != NULL)
        return fail_at(p, name->begin, name->end, "found no function \"%s\"; did you mean \"%s\"?", found,
                       nearest);
    return fail_at(p, name->begin, name->end,
                   "found no function \"%s\", expected abs, sqrt, norm, min, max, exp, log, log10, sin, cos, "
                   "tan, atan2, floor, ceil or round",
                   found);
}

/* column("any name"); the next token is the parenthesis. */
static BpStatus parse_column(Parser *p, const Token *name, uint32_t *node) {
    size_t place;
    BP_TRY(advance(p));
    if (p->token.kind != TOKEN_TEXT) return fail_token(p, "the name of a column in quotes");
    BP_TRY(add_text(p, &p->token, &place));
    BP_TRY(advance(p));
    BP_TRY(add_node(p, (Node){.operation = OP_NAME, .begin = name->begin, .end = p->token.end, .list = place},
                    node));
    BP_TRY(take(p, TOKEN_CLOSE, "\")\""));
    return add_column(p, *node);
}

/* A name and a parenthesis, which is the next token. */
static BpStatus parse_call(Parser *p, const Token *name, uint32_t *node) {
    char own[BP_EXPRESSION_BYTES_MAX + 1];
    token_text(p->e->text, name, own);
    if (strcmp(own, "column") == 0) return parse_column(p, name, node);
    size_t f = 0;
    while (f < FUNCTION_COUNT && strcmp(functions[f].name, own) != 0) f++;
    if (f == FUNCTION_COUNT) return fail_function(p, name);
    const Operation operation = functions[f].operation;
    const bool norm = strcmp(own, "norm") == 0;
    int count = 0;
    do {
        uint32_t operand;
        BP_TRY(advance(p));
        BP_TRY(parse_sum(p, &operand));
        BP_TRY(need_number(p, operand));
        if (norm) BP_TRY(join(p, OP_SQUARE, BP_VALUE_NUMBER, operand, 0, &operand));
        if (count++ == 0)
            *node = operand;
        else
            BP_TRY(join(p, norm ? OP_ADD : operation, BP_VALUE_NUMBER, *node, operand, node));
    } while (p->token.kind == TOKEN_COMMA);
    if (count < functions[f].least || count > functions[f].most)
        return fail_at(p, name->begin, p->token.end, "found %d number%s for %s, expected %s%d", count,
                       count == 1 ? "" : "s", own, functions[f].most > functions[f].least ? "at least " : "",
                       functions[f].least);
    if (functions[f].most == 1 || norm) BP_TRY(join(p, operation, BP_VALUE_NUMBER, *node, 0, node));
    at(p, *node)->begin = name->begin;
    at(p, *node)->end = p->token.end;
    return take(p, TOKEN_CLOSE, "\",\" or \")\"");
}

static BpStatus parse_name(Parser *p, uint32_t *node) {
    const BpExpressionWords *const words = p->e->words;
    const Token name = p->token;
    const size_t length = name.end - name.begin;
    size_t place;
    BP_TRY(advance(p));
    if (p->token.kind == TOKEN_OPEN) return parse_call(p, &name, node);
    for (size_t w = 0; w < words->count; w++)
        if (strlen(words->word[w].name) == length &&
            strncmp(words->word[w].name, p->e->text + name.begin, length) == 0)
            return add_node(p,
                            (Node){.operation = OP_WORD,
                                   .type = words->word[w].type,
                                   .begin = name.begin,
                                   .end = name.end,
                                   .word = w},
                            node);
    BP_TRY(add_text(p, &name, &place));
    return add_node(
        p, (Node){.operation = OP_NAME, .begin = name.begin, .end = name.end, .list = place, .bare = true},
        node);
}

static BpStatus parse_single(Parser *p, uint32_t *node) {
    Node made = {.begin = p->token.begin, .end = p->token.end};
    switch (p->token.kind) {
    case TOKEN_NUMBER:
        made.operation = OP_NUMBER;
        made.type = BP_VALUE_NUMBER;
        made.number = p->token.number;
        BP_TRY(advance(p));
        return add_node(p, made, node);
    case TOKEN_TEXT:
        made.operation = OP_TEXT;
        made.type = BP_VALUE_TEXT;
        BP_TRY(add_text(p, &p->token, &made.list));
        BP_TRY(advance(p));
        return add_node(p, made, node);
    case TOKEN_NAME:
        return parse_name(p, node);
    case TOKEN_OPEN:
        BP_TRY(advance(p));
        BP_TRY(parse_or(p, node));
        return take(p, TOKEN_CLOSE, "\")\"");
    default:
        return fail_token(p, "a number, a text, a name or \"(\"");
    }
}

static BpStatus parse_power(Parser *p, uint32_t *node) {
    uint32_t exponent;
    BP_TRY(parse_single(p, node));
    if (p->token.kind != TOKEN_POWER) return BP_OK;
    BP_TRY(advance(p));
    BP_TRY(need_number(p, *node));
    BP_TRY(parse_sign(p, &exponent));
    BP_TRY(need_number(p, exponent));
    return join(p, OP_POWER, BP_VALUE_NUMBER, *node, exponent, node);
}

static BpStatus parse_sign(Parser *p, uint32_t *node) {
    const Token sign = p->token;
    BP_TRY(enter(p));
    if (sign.kind == TOKEN_MINUS || sign.kind == TOKEN_PLUS) {
        BP_TRY(advance(p));
        BP_TRY(parse_sign(p, node));
        BP_TRY(need_number(p, *node));
        if (sign.kind == TOKEN_MINUS) BP_TRY(join(p, OP_NEGATE, BP_VALUE_NUMBER, *node, 0, node));
        at(p, *node)->begin = sign.begin;
    } else {
        BP_TRY(parse_power(p, node));
    }
    p->depth--;
    return BP_OK;
}

static BpStatus parse_product(Parser *p, uint32_t *node) {
    BP_TRY(parse_sign(p, node));
    for (;;) {
        const TokenKind kind = p->token.kind;
        if (kind != TOKEN_TIMES && kind != TOKEN_DIVIDE && kind != TOKEN_MODULO) return BP_OK;
        uint32_t right;
        BP_TRY(need_number(p, *node));
        BP_TRY(advance(p));
        BP_TRY(parse_sign(p, &right));
        BP_TRY(need_number(p, right));
        const Operation operation = kind == TOKEN_TIMES    ? OP_MULTIPLY
                                    : kind == TOKEN_DIVIDE ? OP_DIVIDE
                                                           : OP_MODULO;
        BP_TRY(join(p, operation, BP_VALUE_NUMBER, *node, right, node));
    }
}

static BpStatus parse_sum(Parser *p, uint32_t *node) {
    BP_TRY(parse_product(p, node));
    for (;;) {
        const TokenKind kind = p->token.kind;
        if (kind != TOKEN_PLUS && kind != TOKEN_MINUS) return BP_OK;
        uint32_t right;
        BP_TRY(need_number(p, *node));
        BP_TRY(advance(p));
        BP_TRY(parse_product(p, &right));
        BP_TRY(need_number(p, right));
        BP_TRY(join(p, kind == TOKEN_PLUS ? OP_ADD : OP_SUBTRACT, BP_VALUE_NUMBER, *node, right, node));
    }
}

/* ---- conditions -----------------------------------------------------------------------------------------
 */

static BpStatus parse_not(Parser *p, uint32_t *node);

/* Behind `within`. */
static BpStatus parse_within(Parser *p, size_t begin, uint32_t *node) {
    const double reach = p->token.number;
    uint32_t operand;
    if (p->token.kind != TOKEN_NUMBER || !(reach > 0))
        return fail_token(p, "a distance above 0, as in \"within 5 of ligand\"");
    BP_TRY(advance(p));
    BP_TRY(take(p, TOKEN_OF, "\"of\", as in \"within 5 of ligand\""));
    BP_TRY(parse_not(p, &operand));
    BP_TRY(need_truth(p, operand));
    BP_TRY(join(p, OP_WITHIN, BP_VALUE_TRUTH, operand, 0, node));
    at(p, *node)->begin = begin;
    at(p, *node)->number = reach;
    return BP_OK;
}

static BpStatus parse_not(Parser *p, uint32_t *node) {
    const Token first = p->token;
    BP_TRY(enter(p));
    if (first.kind == TOKEN_NOT) {
        BP_TRY(advance(p));
        BP_TRY(parse_not(p, node));
        BP_TRY(need_truth(p, *node));
        BP_TRY(join(p, OP_NOT, BP_VALUE_TRUTH, *node, 0, node));
        at(p, *node)->begin = first.begin;
    } else if (first.kind == TOKEN_WITHIN) {
        BP_TRY(advance(p));
        BP_TRY(parse_within(p, first.begin, node));
    } else {
        BP_TRY(parse_comparison(p, node));
    }
    p->depth--;
    return BP_OK;
}

static BpStatus parse_and(Parser *p, uint32_t *node) {
    BP_TRY(parse_not(p, node));
    while (p->token.kind == TOKEN_AND) {
        uint32_t right;
        BP_TRY(need_truth(p, *node));
        BP_TRY(advance(p));
        BP_TRY(parse_not(p, &right));
        BP_TRY(need_truth(p, right));
        BP_TRY(join(p, OP_AND, BP_VALUE_TRUTH, *node, right, node));
    }
    return BP_OK;
}

static BpStatus parse_or(Parser *p, uint32_t *node) {
    BP_TRY(parse_and(p, node));
    while (p->token.kind == TOKEN_OR) {
        uint32_t right;
        BP_TRY(need_truth(p, *node));
        BP_TRY(advance(p));
        BP_TRY(parse_and(p, &right));
        BP_TRY(need_truth(p, right));
        BP_TRY(join(p, OP_OR, BP_VALUE_TRUTH, *node, right, node));
    }
    return BP_OK;
}

/* ---- the whole ------------------------------------------------------------------------------------------
 */

static BpStatus parse_whole(Parser *p, BpValueType wanted) {
    BpExpression *const e = p->e;
    BP_TRY(add_node(p, (Node){0}, &e->root)); /* number 0 is none */
    BP_TRY(advance(p));
    if (p->token.kind == TOKEN_END)
        return fail_token(p, wanted == BP_VALUE_TRUTH ? "a condition, such as z > 3" : "a number");
    BP_TRY(parse_or(p, &e->root));
    BP_TRY(wanted == BP_VALUE_TRUTH ? need_truth(p, e->root) : need_number(p, e->root));
    if (p->token.kind == TOKEN_END) return BP_OK;
    return fail_token(p, wanted == BP_VALUE_TRUTH ? "the end, and, or" : "the end, or + - * / % ^");
}

BpStatus bp_expression_parse(const char *text, const BpExpressionWords *words, BpValueType wanted,
                             BpExpression **expression, BpError *err) {
    const size_t length = strlen(text);
    *expression = NULL;
    if (length > BP_EXPRESSION_BYTES_MAX)
        return bp_fail(err, BP_ERR_SCENE, "found an expression of %zu bytes, expected at most %d", length,
                       BP_EXPRESSION_BYTES_MAX);
    BpExpression *e = calloc(1, sizeof *e);
    Parser parser = {.e = e, .err = err};
    if (e == NULL) return fail_memory(&parser);
    e->words = words;
    e->text = strdup(text);
    e->pool = malloc(2 * length + 2); /* a text of one byte takes two, with its end */
    const BpStatus status =
        e->text != NULL && e->pool != NULL ? parse_whole(&parser, wanted) : fail_memory(&parser);
    if (status != BP_OK) bp_expression_destroy(&e);
    *expression = e;
    return status;
}

void bp_expression_destroy(BpExpression **expression) {
    BpExpression *const e = *expression;
    *expression = NULL;
    if (e == NULL) return;
    free(e->text);
    free(e->nodes);
    free(e->numbers);
    free(e->texts);
    free(e->pool);
    free(e);
}

const char *bp_expression_text(const BpExpression *expression) {
    return expression->text;
}

size_t bp_expression_column_count(const BpExpression *expression) {
    return expression->column_count;
}

const char *bp_expression_column(const BpExpression *expression, size_t index) {
    return expression->columns[index].name;
}

/* The first node that uses a word, in the order of the text; 0: none. */
static uint32_t use_of(const BpExpression *e, size_t word) {
    for (uint32_t n = 1; n < e->node_count; n++) {
        const Node *const node = &e->nodes[n];
        if ((node->operation == OP_WORD || node->operation == OP_LABEL) && node->word == word) return n;
    }
    return 0;
}

bool bp_expression_uses(const BpExpression *expression, size_t word) {
    return use_of(expression, word) != 0;
}

BpStatus bp_expression_fail_column(const BpExpression *expression, size_t column, BpError *err,
                                   const char *format, ...) {
    char message[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    return token_fail(expression->text, expression->columns[column].begin, expression->columns[column].end,
                      err, "%s", message);
}

BpStatus bp_expression_fail_word(const BpExpression *expression, size_t word, BpError *err,
                                 const char *format, ...) {
    char message[512];
    va_list arguments;
    const Node *const node = &expression->nodes[use_of(expression, word)];
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    return token_fail(expression->text, node->begin, node->end, err, "%s", message);
}
