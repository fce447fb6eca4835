/* select.h: expressions over the particles of a frame: which of them are meant, and numbers of each.
 *
 * In:    a text, a frame.   Out: an expression; a truth or a number for each particle.
 * Knows: the words for particles.   Does not know: how particles look (style.h). */
#ifndef BP_PARTICLES_SELECT_H
#define BP_PARTICLES_SELECT_H

#include "expressions/expression.h"
#include "particles.h"

/* Parses a condition (BP_VALUE_TRUTH) or a number of each particle; see bp_expression_parse(). */
BpStatus bp_select_parse(const char *text, BpValueType wanted, BpExpression **expression, BpError *err);
/* The most columns that an expression wants of a file. */
enum { BP_SELECT_COLUMNS_MAX = BP_EXPRESSION_COLUMNS_MAX + 1 };
/* Those, which need not be there: then evaluation fails with their place. */
size_t bp_select_columns(const BpExpression *expression, const char *columns[BP_SELECT_COLUMNS_MAX]);

/* A frame with the names of the columns that were wanted when its file was opened. */
typedef struct BpSelectFrame {
    const BpParticles *particles;
    const char *const *wanted;
    size_t wanted_count;
} BpSelectFrame;

/* `selected`: one for each particle. BP_ERR_SCENE: the file lacks a column or what a word is about; the
 * message has the place in the expression. BP_ERR_MEMORY. */
BpStatus bp_select_truths(const BpSelectFrame *frame, const BpExpression *expression, bool *selected,
                          BpError *err);
BpStatus bp_select_numbers(const BpSelectFrame *frame, const BpExpression *expression, double *numbers,
                           BpError *err);
/* Fails, since it holds for no particle; the message lists what the particles have. */
BpStatus bp_select_fail_nothing(const BpSelectFrame *frame, const BpExpression *expression, BpError *err);

#endif
