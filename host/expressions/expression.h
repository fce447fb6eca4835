/* expression.h: an expression over the rows of a table, such as `type == 2 and z > 10`.
 *
 * In:    a text, the words that it may use.   Out: a tree of nodes whose types are right; errors that show
 * their place in the text. Knows: grammar, precedence, types.   Does not know: what words mean, where values
 * come from (evaluate.h).
 *
 * From loose to tight, as in Python: or; and; not; comparisons, which may be chained (0 < z < 5), in and not
 * in; + and -; * / %; a sign; ^, also written **, from the right. `&&`, `||` and `!` are and, or and not.
 * `within D of X` binds as not does. A name that is no word is a column of numbers; column("any name") is one
 * whose name is no name here. Beside a text, and in lists beside it, a name that is no word stands for
 * itself: resname in (LIG, HEM). */
#ifndef BP_EXPRESSIONS_EXPRESSION_H
#define BP_EXPRESSIONS_EXPRESSION_H

#include "base/status.h"

#include <stddef.h>
#include <stdint.h>

enum {
    BP_EXPRESSION_BYTES_MAX = 4096,
    BP_EXPRESSION_DEPTH_MAX = 128,  /* of parentheses, signs and whatever else is nested */
    BP_EXPRESSION_COLUMNS_MAX = 16, /* different ones */
    BP_EXPRESSION_COLUMN_SIZE = 64  /* of a column's name */
};

typedef enum BpValueType {
    BP_VALUE_TRUTH,
    BP_VALUE_NUMBER,
    BP_VALUE_TEXT,
    BP_VALUE_LABEL /* a text that often is a number, and is one beside numbers */
} BpValueType;

/* A name that has a meaning. */
typedef struct BpExpressionWord {
    const char *name;
    BpValueType type;
    bool any_case; /* of a text: small letters are equal to capital ones */
} BpExpressionWord;

typedef struct BpExpressionWords {
    const BpExpressionWord *word;
    size_t count;
} BpExpressionWords;

typedef struct BpExpression BpExpression;

/* Parses `text`. `words` must outlive the result. `wanted`: BP_VALUE_TRUTH or BP_VALUE_NUMBER.
 * BP_ERR_SCENE: the message has what was found and where; its attachment is the text with a mark below that
 * place. BP_ERR_MEMORY. Thread-safe. */
BpStatus bp_expression_parse(const char *text, const BpExpressionWords *words, BpValueType wanted,
                             BpExpression **expression, BpError *err);
/* NULL is fine. */
void bp_expression_destroy(BpExpression **expression);

const char *bp_expression_text(const BpExpression *expression);
/* The columns that it names, each once. */
size_t bp_expression_column_count(const BpExpression *expression);
const char *bp_expression_column(const BpExpression *expression, size_t index);
/* Whether it uses a word, by its place in the list. */
bool bp_expression_uses(const BpExpression *expression, size_t word);

/* Fails with BP_ERR_SCENE at the first use of a column or a word; the message is "found ..., expected ...".
 */
BpStatus bp_expression_fail_column(const BpExpression *expression, size_t column, BpError *err,
                                   const char *format, ...) BP_PRINTF_LIKE(4, 5);
BpStatus bp_expression_fail_word(const BpExpression *expression, size_t word, BpError *err,
                                 const char *format, ...) BP_PRINTF_LIKE(4, 5);

#endif
