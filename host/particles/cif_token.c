/* cif_token.c: see cif_token.h. */
#include "cif_token.h"

#include <string.h>
#include <strings.h>

/* A text between semicolons, each at the beginning of a line; the first line is at the cursor. */
static BpStatus take_text(CifTokens *tokens, Input *input, BpError *err) {
    const uint64_t opened = input->line;
    char *line = tokens->cursor + 1;
    tokens->text[0] = '\0';
    do {
        const size_t used = strlen(tokens->text);
        snprintf(tokens->text + used, sizeof tokens->text - used, "%s", line);
        BP_TRY(input_line(input, &line, err));
        if (line == NULL)
            return input_fail(input, true, err,
                              "found the end of the file in the text that line %llu opens, expected a line "
                              "that begins with \";\"",
                              (unsigned long long)opened);
    } while (line[0] != ';');
    tokens->cursor = line + 1;
    tokens->token = tokens->text;
    tokens->quoted = true;
    return BP_OK;
}

/* The quote that ends a value is the one that opened it, before a blank. NULL: there is none. */
static char *end_of_quoted(char *text, char quote) {
    for (; *text != '\0'; text++)
        if (*text == quote && strchr(" \t\r", text[1]) != NULL) return text;
    return NULL;
}

static BpStatus read_token(CifTokens *tokens, Input *input, BpError *err) {
    tokens->quoted = false;
    for (;;) {
        if (tokens->cursor == NULL) {
            BP_TRY(input_line(input, &tokens->cursor, err));
            tokens->token = NULL;
            if (tokens->cursor == NULL) return BP_OK;
            if (tokens->cursor[0] == ';') return take_text(tokens, input, err);
        }
        tokens->token = tokens->cursor + strspn(tokens->cursor, " \t\r");
        if (*tokens->token != '\0' && *tokens->token != '#') break;
        tokens->cursor = NULL;
    }
    char *after = tokens->token + strcspn(tokens->token, " \t\r");
    if (*tokens->token == '\'' || *tokens->token == '"') {
        after = end_of_quoted(tokens->token + 1, *tokens->token);
        if (after == NULL && tokens->lenient) after = tokens->token + strlen(tokens->token);
        if (after == NULL)
            return input_fail(input, true, err, "found a quote that is not closed, expected its end");
        tokens->quoted = true;
        tokens->token++;
    }
    tokens->cursor = *after != '\0' ? after + 1 : NULL;
    *after = '\0';
    return BP_OK;
}

bool cif_is_name(const CifTokens *tokens) {
    return tokens->token != NULL && !tokens->quoted && tokens->token[0] == '_';
}

bool cif_is_keyword(const CifTokens *tokens) {
    const char *const token = tokens->token;
    return token != NULL && !tokens->quoted && token[0] >= 'A' && strchr("DdGgLlSs", token[0]) != NULL &&
           (strcasecmp(token, "loop_") == 0 || strncasecmp(token, "data_", 5) == 0 ||
            strncasecmp(token, "save_", 5) == 0 || strcasecmp(token, "stop_") == 0 ||
            strcasecmp(token, "global_") == 0);
}

bool cif_is_value(const CifTokens *tokens) {
    return tokens->token != NULL && !cif_is_name(tokens) && !cif_is_keyword(tokens);
}

bool cif_number(const char *text, double *value) {
    char number[CIF_TEXT_SIZE];
    const size_t length = strcspn(text, "("),
                 digits = strspn(text + length + (text[length] == '('), "0123456789");
    if (text[length] == '\0') return word_number(text, value);
    if (digits == 0 || strcmp(text + length + 1 + digits, ")") != 0 || length >= sizeof number) return false;
    snprintf(number, sizeof number, "%.*s", (int)length, text);
    return word_number(number, value);
}

bool cif_is_unknown(const char *text) {
    return strcmp(text, ".") == 0 || strcmp(text, "?") == 0;
}

const char *cif_known(const char *text) {
    return cif_is_unknown(text) ? "" : text;
}

BpStatus cif_peek(CifTokens *tokens, Input *input, BpError *err) {
    if (!tokens->pending) BP_TRY(read_token(tokens, input, err));
    tokens->pending = true;
    return BP_OK;
}

bool cif_opens(const CifTokens *tokens, const char *word) {
    return cif_is_keyword(tokens) && strncasecmp(tokens->token, word, strlen(word)) == 0;
}

BpStatus cif_skip_save_frame(CifTokens *tokens, Input *input, BpError *err) {
    const bool opens = tokens->token[strlen("save_")] != '\0';
    do {
        cif_take(tokens);
        BP_TRY(cif_peek(tokens, input, err));
    } while (opens && tokens->token != NULL && !cif_opens(tokens, "save_"));
    if (opens) cif_take(tokens);
    return BP_OK;
}
