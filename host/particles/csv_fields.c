/* csv_fields.c: see csv_fields.h. */
#include "csv_fields.h"

#include "base/message_text.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { NUMBER_SIZE = 64, FIELDS_MAX = 128 };

static const char blanks[] = " \t\r";

/* The end of the field that begins at `c`: its separator, or the end of the line. */
static char *field_end(char *c, char separator) {
    char *const next = separator != ' ' ? strchr(c, separator) : NULL;
    return c + (separator == ' ' ? strcspn(c, blanks) : next != NULL ? (size_t)(next - c) : strlen(c));
}

/* Takes the quotes of a field away, whose text then begins where the first one stood. Returns what follows
 * the last one; NULL: there is none. */
static char *unquote(char *field, char **end) {
    char *from = field + 1, *to = field;
    for (; *from != '\0'; *to++ = *from++) {
        if (*from != '"') continue;
        if (from[1] != '"') break;
        from++;
    }
    *end = to;
    return *from == '"' ? from + 1 : NULL;
}

int csv_split(char *line, char separator, char **fields, int max, int *filled) {
    int count = 0;
    *filled = 0;
    for (;;) {
        line += strspn(line, separator == '\t' ? " " : " \t");
        if (separator == ' ' && line[strspn(line, blanks)] == '\0') return count;
        char *const begin = line, *end = NULL;
        char *next = *line == '"' ? unquote(line, &end) : line;
        if (next == NULL) return CSV_UNCLOSED;
        next = field_end(next, separator);
        if (end == NULL)
            for (end = next; end > begin && strchr(" \r", end[-1]) != NULL;) end--;
        const bool more = *next != '\0';
        *end = '\0';
        if (count < max) fields[count] = begin;
        count++;
        if (*begin != '\0') *filled = count;
        if (!more) return count;
        line = next + 1;
    }
}

static bool is_missing(const char *field) {
    static const char *const words[] = {"",     "NA",      "N/A",   "null",    "none",
                                        "#N/A", "#DIV/0!", "#NUM!", "#VALUE!", "#REF!"};
    double ignored = 0;
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (strcasecmp(field, words[i]) == 0) return true;
    return !word_number(field, &ignored) && word_number_or_none(field, &ignored);
}

bool csv_is_text(const char *field) {
    double number = 0;
    if (is_missing(field) || (word_number_or_none(field, &number), isinf(number))) return false;
    return *field == '(' || *field == '[' || ((*field | 32) >= 'a' && (*field | 32) <= 'z');
}

bool csv_is_remark(const char *line) {
    static const char *const errors[] = {"#N/A", "#DIV/0!", "#NUM!", "#VALUE!", "#REF!"};
    line += strspn(line, " \t");
    for (size_t i = 0; i < sizeof errors / sizeof *errors; i++)
        if (strncmp(line, errors[i], strlen(errors[i])) == 0) return false;
    return *line == '#' || *line == '%' || strncmp(line, "//", 2) == 0;
}

bool csv_is_empty(const char *line) {
    return line[strspn(line, ",;|\" \t\r")] == '\0';
}

/* Whether commas group the digits of a number by threes, as in 1,234 and 1,234.5. */
static bool groups_thousands(const char *field) {
    const char *c = *field == '-' || *field == '+' ? field + 1 : field;
    size_t digits = strspn(c, "0123456789");
    if (digits == 0 || digits > 3 || c[digits] != ',') return false;
    for (c += digits; *c == ','; c += 4)
        if (strspn(c + 1, "0123456789") != 3) return false;
    return *c == '\0' || *c == '.';
}

/* The number of a field with a decimal comma; false: it is none, or the comma may separate thousands. */
static bool comma_number(char separator, const char *field, double *value) {
    char text[NUMBER_SIZE];
    const char *const comma = strchr(field, ',');
    if (comma == NULL || strlen(field) >= NUMBER_SIZE || strchr(field, '.') != NULL) return false;
    if (comma[1] < '0' || comma[1] > '9' || (separator == ',' && groups_thousands(field))) return false;
    snprintf(text, sizeof text, "%s", field);
    text[comma - field] = '.';
    return word_number(text, value);
}

static bool is_number(char separator, const char *field) {
    double ignored = 0;
    return word_number(field, &ignored) || comma_number(separator, field, &ignored);
}

/* Whether the fields are numbers; some may be missing, since the first point may have no place. */
static bool are_numbers(char *line, char separator) {
    char *fields[FIELDS_MAX];
    int filled = 0, numbers = 0;
    if (csv_split(line, separator, fields, FIELDS_MAX, &filled) == CSV_UNCLOSED || filled > FIELDS_MAX)
        return false;
    for (int i = 0; i < filled; i++) {
        const bool number = is_number(separator, fields[i]);
        if (!number && !is_missing(fields[i])) return false;
        numbers += number;
    }
    return numbers > 0 || filled > 1;
}

char csv_separator_of_numbers(const char *line) {
    static const char separators[] = ";\t|, ";
    for (const char *s = separators; *s != '\0'; s++) {
        if (*s != ' ' && strchr(line, *s) == NULL) continue;
        char *const copy = strdup(line);
        const bool good = copy != NULL && are_numbers(copy, *s);
        free(copy);
        if (good) return *s;
    }
    return '\0';
}

char csv_separator_of_names(const char *line) {
    static const char separators[] = ",;\t|";
    size_t most = 0;
    char found = ' ';
    for (const char *s = separators; *s != '\0'; s++) {
        size_t count = 0;
        bool quoted = false;
        for (const char *c = line; *c != '\0'; c++) {
            quoted ^= *c == '"';
            count += !quoted && *c == *s;
        }
        if (count <= most) continue;
        most = count;
        found = *s;
    }
    return found;
}

/* One decimal sign in all numbers: a table that has both would have one of them read wrong. */
static BpStatus keep_decimal(const Input *input, CsvForm *form, const char *field, char sign, BpError *err) {
    char shown[48];
    if (form->decimal == '\0') {
        form->decimal = sign;
        form->decimal_line = input->line;
    }
    if (form->decimal == sign) return BP_OK;
    bp_printable(field, shown, sizeof shown);
    return input_fail(
        input, true, err,
        "found \"%s\" after a number with a decimal %s in line %llu, expected one decimal sign in "
        "all numbers, and none between thousands",
        shown, form->decimal == ',' ? "comma" : "point", (unsigned long long)form->decimal_line);
}

BpStatus csv_number(const Input *input, CsvForm *form, const char *field, double *value, BpError *err) {
    char shown[48];
    if (word_number(field, value))
        return strchr(field, '.') != NULL ? keep_decimal(input, form, field, '.', err) : BP_OK;
    *value = NAN;
    if (is_missing(field)) return BP_OK;
    if (comma_number(form->separator, field, value)) return keep_decimal(input, form, field, ',', err);
    bp_printable(field, shown, sizeof shown);
    const bool grouped = strchr(field, ',') != NULL && field[strspn(field, "+-0123456789.,")] == '\0';
    return input_fail(input, true, err, "found \"%s\", expected a finite number%s", shown,
                      grouped
                          ? " without separators between thousands; with a decimal comma, let semicolons or "
                            "tabs separate the fields"
                          : "");
}

double csv_number_or_none(const CsvForm *form, const char *field) {
    double value = NAN;
    if (word_number(field, &value) || word_logical(field, &value)) return value;
    return comma_number(form->separator, field, &value) ? value : NAN;
}
