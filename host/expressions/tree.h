/* tree.h: the nodes of an expression, as parse.c makes them and evaluate.c goes through them.
 *
 * In:    nothing.   Out: the struct.   Knows: operations.   Does not know: how they are written. */
#ifndef BP_EXPRESSIONS_TREE_H
#define BP_EXPRESSIONS_TREE_H

#include "expression.h"

/* The operations on numbers of one operand and of two, then those that give truths. */
typedef enum Operation {
    OP_NAME, /* no word, and not known yet whether it is a column or a text; not in a finished tree */
    OP_TEXT, /* written in the expression; only within OP_MATCH */
    OP_NUMBER,
    OP_WORD,   /* of type truth or number; a text only within OP_MATCH and OP_SAME */
    OP_COLUMN, /* number `word` among the columns */
    OP_LABEL,  /* a label as a number */
    OP_NEGATE,
    OP_ABS,
    OP_SQRT,
    OP_EXP,
    OP_LOG,
    OP_LOG10,
    OP_SIN,
    OP_COS,
    OP_TAN,
    OP_FLOOR,
    OP_CEIL,
    OP_ROUND,
    OP_SQUARE,
    OP_ADD,
    OP_SUBTRACT,
    OP_MULTIPLY,
    OP_DIVIDE,
    OP_MODULO,
    OP_POWER,
    OP_MIN,
    OP_MAX,
    OP_ATAN2,
    OP_LESS,
    OP_AT_MOST,
    OP_MORE,
    OP_AT_LEAST,
    OP_EQUAL,
    OP_UNEQUAL,
    OP_AMONG, /* left is one of list_count numbers */
    OP_MATCH, /* text word `word` is one of list_count texts */
    OP_SAME,  /* the text words `word` and `other` say the same */
    OP_NOT,
    OP_AND,
    OP_OR,
    OP_WITHIN /* nearer than `number` to a row of which left is true, or as near */
} Operation;

typedef struct Node {
    Operation operation;
    BpValueType type;
    uint32_t left, right; /* nodes; 0: none */
    uint32_t need;        /* so many blocks of numbers are used at once while it is evaluated */
    bool bare;            /* OP_NAME: not in quotes */
    size_t begin, end;    /* in the text */
    double number;
    size_t word, other;
    size_t list, list_count; /* of OP_AMONG in `numbers`, of OP_MATCH in `texts`, of OP_TEXT its one text */
} Node;

struct BpExpression {
    char *text;
    const BpExpressionWords *words;
    Node *nodes; /* node 0 is none */
    size_t node_count, node_capacity;
    uint32_t root;
    double *numbers; /* those of a list rise */
    size_t number_count, number_capacity;
    size_t *texts; /* offsets into `pool` */
    size_t text_count, text_capacity;
    char *pool;
    size_t pool_used;
    struct {
        char name[BP_EXPRESSION_COLUMN_SIZE];
        size_t begin, end; /* where it is first used */
    } columns[BP_EXPRESSION_COLUMNS_MAX];
    size_t column_count;
};

#endif
