/* command_text.c: see command_text.h. */
#include "command_text.h"

#include "option_table.h"

#include <stdio.h>
#include <string.h>

/* Appends a word, quoted for a shell; false if it does not fit. */
static bool append_word(char *text, size_t size, const char *word) {
    static const char plain[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_./,:=+@%-";
    size_t used = strlen(text);
    const bool quotes = word[0] == '\0' || word[strspn(word, plain)] != '\0';
    if (used + 2 * strlen(word) * 2 + 5 > size) return false;
    if (used > 0) text[used++] = ' ';
    if (quotes) text[used++] = '\'';
    for (; *word != '\0'; ++word) {
        if (*word == '\'') { /* ends the quotes, escapes it, begins them again */
            memcpy(text + used, "'\\''", 4);
            used += 4;
        } else {
            text[used++] = *word;
        }
    }
    if (quotes) text[used++] = '\'';
    text[used] = '\0';
    return true;
}

/* A name that begins with a dash must not be taken for an option. */
static bool append_operand(char *text, size_t size, const char *operand) {
    char value[4200];
    const bool dashed = operand[0] == '-' && operand[1] != '\0';
    snprintf(value, sizeof value, "%s%s", dashed ? "./" : "", operand);
    return append_word(text, size, value);
}

static bool append_option(char *text, size_t size, const BpCommandLine *line, BpOption option,
                          double seconds) {
    char value[4200], name[40];
    if (option == BP_OPTION_SET) {
        for (size_t t = 0; t < line->set.count; ++t)
            if (!append_word(text, size, "--set") || !append_word(text, size, line->set.list[t]))
                return false;
        return true;
    }
    snprintf(name, sizeof name, "--%s", bp_option_name(option));
    if (!append_word(text, size, name)) return false;
    bp_option_show(option, line, value, sizeof value);
    if (option == BP_OPTION_TIME && seconds > 0) snprintf(value, sizeof value, "%.0f", seconds);
    return value[0] == '\0' || append_word(text, size, value);
}

const char *bp_command_text(const BpCommandLine *line, const char *resume, double seconds, char *text,
                            size_t size) {
    text[0] = '\0';
    bool fits = append_word(text, size, "ballpark") && append_word(text, size, line->command->name);
    for (size_t i = 0; i < line->operand_count && fits; ++i)
        fits = append_operand(text, size, line->operands[i]);
    if (resume != NULL) fits = fits && append_word(text, size, "--resume") && append_word(text, size, resume);
    for (int o = 0; o < BP_OPTION_NUMBER && fits; ++o) {
        const BpOption option = (BpOption)o;
        if (!bp_option_given(line, option) || option == BP_OPTION_RESUME) continue;
        /* A continued render replaces the results so far. */
        if (option == BP_OPTION_NO_CLOBBER && resume != NULL) continue;
        fits = append_option(text, size, line, option, seconds);
    }
    if (!fits) text[0] = '\0';
    return text;
}
