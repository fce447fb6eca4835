/* tokens.h: the signs, names, numbers and texts that an expression is written in.
 *
 * In:    the text of an expression.   Out: one token after the other; a drawing of a place in the text.
 * Knows: how each is spelt.   Does not know: what may follow what (parse.c). */
#ifndef BP_EXPRESSIONS_TOKENS_H
#define BP_EXPRESSIONS_TOKENS_H

#include "expression.h"

typedef enum TokenKind {
    TOKEN_END,
    TOKEN_NUMBER,
    TOKEN_TEXT,
    TOKEN_NAME,
    TOKEN_OPEN,
    TOKEN_CLOSE,
    TOKEN_COMMA,
    TOKEN_PLUS,
    TOKEN_MINUS,
    TOKEN_TIMES,
    TOKEN_DIVIDE,
    TOKEN_MODULO,
    TOKEN_POWER,
    TOKEN_LESS,
    TOKEN_AT_MOST,
    TOKEN_MORE,
    TOKEN_AT_LEAST,
    TOKEN_EQUAL,
    TOKEN_UNEQUAL,
    /* Words of the grammar. */
    TOKEN_OR,
    TOKEN_AND,
    TOKEN_NOT,
    TOKEN_IN,
    TOKEN_WITHIN,
    TOKEN_OF
} TokenKind;

typedef struct Token {
    TokenKind kind;
    size_t begin, end; /* bytes of the text */
    double number;
} Token;

/* The token at or behind `at`. BP_ERR_SCENE: there is none. Numbers have a point, in every locale that the
 * caller may have set. */
BpStatus token_read(const char *text, size_t at, Token *token, BpError *err);
/* What a token of kind TOKEN_TEXT or TOKEN_NAME says, without quotes; `out` has room for as many bytes as the
 * token has, and one more. */
void token_text(const char *text, const Token *token, char *out);

/* Fails with "at character N: MESSAGE" and the drawing. */
BpStatus token_fail(const char *text, size_t begin, size_t end, BpError *err, const char *format, ...)
    BP_PRINTF_LIKE(5, 6);

#endif
