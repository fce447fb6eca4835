/* evaluate.h: the values of an expression, row by row.
 *
 * In:    an expression, the rows of a table.   Out: a truth or a number for each row.
 * Knows: how numbers and texts are compared.   Does not know: where values come from, what is near (the rows
 * tell). */
#ifndef BP_EXPRESSIONS_EVALUATE_H
#define BP_EXPRESSIONS_EVALUATE_H

#include "expression.h"

/* Where values come from. Words and columns are given by their places in the lists of the expression. */
typedef struct BpExpressionRows {
    size_t count;
    const void *context;
    /* Of rows first up to first + count: a word of type truth (as 0 or 1) or number; a column. A value that
     * is missing is NaN. */
    void (*word)(const void *context, size_t word, size_t first, size_t count, double *out);
    void (*column)(const void *context, const char *name, size_t first, size_t count, double *out);
    /* A word of type text or label: which of its different texts each row has, and these. */
    void (*codes)(const void *context, size_t word, size_t first, size_t count, uint32_t *out);
    size_t (*text_count)(const void *context, size_t word);
    const char *(*text)(const void *context, size_t word, size_t code);
    /* Which rows lie at most so far from one of those in `of`. */
    BpStatus (*within)(const void *context, double reach, const bool *of, bool *out, BpError *err);
} BpExpressionRows;

/* `out`: rows->count values. A missing number is unequal to all, and neither less nor greater; a missing text
 * is "". */
BpStatus bp_expression_truths(const BpExpression *expression, const BpExpressionRows *rows, bool *out,
                              BpError *err);
/* Numbers are NaN where an operand is missing or an operation has no value. */
BpStatus bp_expression_numbers(const BpExpression *expression, const BpExpressionRows *rows, double *out,
                               BpError *err);

#endif
