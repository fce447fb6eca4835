/* cif_token.h: the tokens of a CIF file.
 *
 * In:    lines.   Out: names, keywords and values, one after the other; values as numbers.
 * Knows: CIF's syntax (S. R. Hall, F. H. Allen, I. D. Brown 1991).   Does not know: what names mean. */
#ifndef BP_PARTICLES_CIF_TOKEN_H
#define BP_PARTICLES_CIF_TOKEN_H

#include "input.h"

enum { CIF_TEXT_SIZE = 64 };

/* Begins as zero, with an input that is at the beginning of a line. */
typedef struct CifTokens {
    char *cursor; /* in the line that is being read; NULL: at the next line */
    char *token;  /* the token last read, valid until the next; NULL: the end of the file */
    bool pending; /* it is still to be looked at: cif_peek() keeps it */
    bool lenient; /* a quote that is not closed ends with its line, as in texts that nobody reads */
    bool quoted;  /* it stood in quotes or between semicolons, so it is a value whatever it looks like */
    char text[CIF_TEXT_SIZE]; /* of the token, where it is a text of several lines */
} CifTokens;

/* Reads the next token, unless one is pending, which it then is. Of texts between semicolons the first bytes
 * are kept, without ends of lines. */
BpStatus cif_peek(CifTokens *tokens, Input *input, BpError *err);
/* The token was looked at. */
static inline void cif_take(CifTokens *tokens) {
    tokens->pending = false;
}
/* The kind of the token: the name of an item, or a word that opens something ("loop_", "data_...",
 * "save_..."). All else is a value. */
bool cif_is_name(const CifTokens *tokens);
bool cif_is_keyword(const CifTokens *tokens);
bool cif_is_value(const CifTokens *tokens);
/* Whether it is a keyword that begins so: "data_", in any case. */
bool cif_opens(const CifTokens *tokens, const char *word);
/* Passes over a save frame, as dictionaries have them, which begins at the token: it holds no atoms. */
BpStatus cif_skip_save_frame(CifTokens *tokens, Input *input, BpError *err);
/* The value as a number, which may have its standard uncertainty behind it in brackets: 0.12(3). */
bool cif_number(const char *text, double *value);
/* Whether the value stands for none: "." and "?". */
bool cif_is_unknown(const char *text);
/* The text, or "" for such a value. */
const char *cif_known(const char *text);

#endif
