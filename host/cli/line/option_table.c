/* option_table.c: see option_table.h. */
#include "option_table.h"

#include "base/message_text.h"
#include "base/names.h"
#include "scene/scene.h"
#include "values.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

typedef enum ValueKind {
    FLAG,
    WHOLE,
    REAL,
    PERCENT,
    TIME,
    PIXEL,
    PART,
    CHOICE,
    WORD,
    TEXT,
    TEXTS,
    RESULT,
    SIGNED,
    SLICE
} ValueKind;

typedef struct OptionRow {
    const char *name, *help;
    unsigned commands;     /* BP_RENDER ... */
    size_t offset, size;   /* of the member of BpCommandLine */
    const char *shown;     /* the value's name in the help; "": its words */
    uint64_t least, most;  /* of a whole number, of each number of a pixel */
    double above, at_most; /* of a real number */
    const char *const *words;
    unsigned first; /* the enumeration's value that words[0] means */
    ValueKind kind;
    char letter;
} OptionRow;

/* The kinds of values that option_list.h describes. */
#define BP_FLAG .kind = FLAG, .shown = ""
#define BP_WHOLE(name, low, high) .kind = WHOLE, .shown = (name), .least = (low), .most = (high)
#define BP_REAL(name, low, high) .kind = REAL, .shown = (name), .above = (low), .at_most = (high)
#define BP_PERCENT(low, high) .kind = PERCENT, .shown = "PERCENT", .above = (low), .at_most = (high)
#define BP_TIME(low, high) .kind = TIME, .shown = "TIME", .above = (low), .at_most = (high)
#define BP_PIXEL(name, high) .kind = PIXEL, .shown = (name), .most = (high)
#define BP_PART(name) .kind = PART, .shown = (name)
#define BP_CHOICE(name, names, from)                                                                         \
    .kind = CHOICE, .shown = (name), .words = (names) + (from), .first = (from)
#define BP_WORD(...)                                                                                         \
    .kind = WORD, .shown = "", .words = (const char *const[]) {                                              \
        __VA_ARGS__, NULL                                                                                    \
    }
#define BP_SIGNED(name) .kind = SIGNED, .shown = (name)
#define BP_SLICE(name) .kind = SLICE, .shown = (name)
#define BP_TEXT(name) .kind = TEXT, .shown = (name)
#define BP_TEXTS(name) .kind = TEXTS, .shown = (name)
#define BP_RESULT(name) .kind = RESULT, .shown = (name)

static const OptionRow rows[BP_OPTION_NUMBER] = {
#define ROW(number, long_name, short_name, commands_, text, type, member, ...)                               \
    [BP_OPTION_##number] = {.name = (long_name),                                                             \
                            .letter = (short_name),                                                          \
                            .commands = (commands_),                                                         \
                            .help = (text),                                                                  \
                            .offset = offsetof(BpCommandLine, member),                                       \
                            .size = sizeof(type),                                                            \
                            __VA_ARGS__},
    BP_OPTION_LIST(ROW, ROW)
#undef ROW
};

const char *bp_option_name(BpOption option) {
    return rows[option].name;
}
const char *bp_option_help(BpOption option, const BpCommand *command, char *text, size_t size) {
    static const struct {
        BpOption option;
        unsigned commands;
        const char *help, *default_text;
    } notes[] = {
#define NOTE(number, commands_, help, default_) {BP_OPTION_##number, (commands_), (help), (default_)},
        BP_OPTION_NOTES(NOTE)
#undef NOTE
    };
    const char *help = rows[option].help, *default_text = NULL;
    for (size_t n = 0; n < sizeof notes / sizeof notes[0]; ++n) {
        if (notes[n].option != option || (notes[n].commands & command->bit) == 0) continue;
        if (notes[n].help != NULL) help = notes[n].help;
        default_text = notes[n].default_text;
    }
    if (default_text != NULL)
        snprintf(text, size, "%s (default: %s)", help, default_text);
    else
        snprintf(text, size, "%s", help);
    return text;
}
char bp_option_letter(BpOption option) {
    return rows[option].letter;
}

const char *bp_option_metavar(BpOption option, char *text, size_t size) {
    const OptionRow *row = &rows[option];
    size_t used = (size_t)snprintf(text, size, "%s", row->shown);
    for (size_t w = 0; used < size && row->shown[0] == '\0' && row->words != NULL && row->words[w] != NULL;
         ++w)
        used += (size_t)snprintf(text + used, size - used, "%s%s", w == 0 ? "" : "|", row->words[w]);
    return text;
}

const char *const *bp_option_words(BpOption option) {
    return rows[option].words;
}

bool bp_option_taken(BpOption option, const BpCommand *command) {
    return (rows[option].commands & command->bit) != 0;
}

const char *bp_option_result(BpOption option, const BpCommandLine *line) {
    const char *path = NULL;
    if (rows[option].kind == RESULT) memcpy(&path, (const char *)line + rows[option].offset, sizeof path);
    return path;
}

/* A whole number, or the value of an enumeration, in a member of 4 or 8 bytes. */
static void store_whole(uint64_t value, const OptionRow *row, void *member) {
    const uint32_t narrow = (uint32_t)value;
    if (row->size == sizeof value)
        memcpy(member, &value, sizeof value);
    else
        memcpy(member, &narrow, sizeof narrow);
}

BpStatus bp_option_store(BpOption option, const char *text, BpCommandLine *line, BpError *err) {
    const OptionRow *row = &rows[option];
    void *member = (char *)line + row->offset;
    char name[32];
    snprintf(name, sizeof name, "--%s", row->name);
    uint64_t whole = 0;
    unsigned choice = 0;
    size_t word_count = 0;
    while (row->words != NULL && row->words[word_count] != NULL) ++word_count;
    switch (row->kind) {
    case FLAG:
        *(bool *)member = true;
        break;
    case WHOLE:
        BP_TRY(bp_value_whole(name, text, row->least, row->most, &whole, err));
        store_whole(whole, row, member);
        break;
    case REAL:
        BP_TRY(bp_value_real(name, text, row->above, row->at_most, member, err));
        break;
    case PERCENT:
        BP_TRY(bp_value_percent(name, text, row->above, row->at_most, member, err));
        break;
    case TIME:
        BP_TRY(bp_value_time(name, text, row->above, row->at_most, member, err));
        break;
    case PIXEL: {
        BpPixel *pixel = member;
        BP_TRY(bp_value_pair(name, text, row->most, &pixel->x, &pixel->y, err));
        break;
    }
    case SIGNED:
        BP_TRY(bp_value_signed(name, text, member, err));
        break;
    case SLICE: {
        BpSlice *slice = member;
        BP_TRY(bp_value_slice(name, text, &slice->first, &slice->last, &slice->step, err));
        break;
    }
    case PART: {
        BpShare *share = member;
        BP_TRY(bp_value_share(name, text, &share->number, &share->count, err));
        break;
    }
    case CHOICE:
        BP_TRY(bp_value_choice(name, text, row->words, word_count, &choice, err));
        store_whole(row->first + choice, row, member);
        break;
    case WORD:
        BP_TRY(bp_value_choice(name, text, row->words, word_count, &choice, err));
        memcpy(member, &row->words[choice], sizeof(const char *));
        break;
    case TEXTS: {
        BpTexts *texts = member;
        if (texts->count == BP_TEXTS_MAX)
            return bp_fail(err, BP_ERR_USAGE, "%s: found more than %d of them, expected fewer", name,
                           BP_TEXTS_MAX);
        texts->list[texts->count++] = text;
        break;
    }
    case TEXT:
    case RESULT:
        memcpy(member, &text, sizeof text);
        break;
    }
    line->given[option] = true;
    return BP_OK;
}

/* The value as given, or an equivalent one. */
static void show_value(const OptionRow *row, const void *member, char *text, size_t size) {
    uint64_t wide = 0;
    uint32_t narrow = 0;
    double real = 0;
    const char *word = "";
    if (row->size == sizeof wide)
        memcpy(&wide, member, sizeof wide);
    else if (row->size == sizeof narrow)
        memcpy(&narrow, member, sizeof narrow), wide = narrow;
    switch (row->kind) {
    case FLAG:
        text[0] = '\0';
        break;
    case WHOLE:
        snprintf(text, size, "%" PRIu64, wide);
        break;
    case REAL:
    case PERCENT:
    case TIME:
        memcpy(&real, member, sizeof real);
        snprintf(text, size, "%.15g", real);
        break;
    case SIGNED: {
        int64_t number;
        memcpy(&number, member, sizeof number);
        snprintf(text, size, "%" PRId64, number);
        break;
    }
    case SLICE: {
        const BpSlice *slice = member;
        if (slice->last == INT64_MAX)
            snprintf(text, size, "%" PRId64 "::%" PRIu64, slice->first, slice->step);
        else
            snprintf(text, size, "%" PRId64 ":%" PRId64 ":%" PRIu64, slice->first, slice->last, slice->step);
        break;
    }
    case PIXEL: {
        const BpPixel *pixel = member;
        snprintf(text, size, "%" PRIu32 ",%" PRIu32, pixel->x, pixel->y);
        break;
    }
    case PART: {
        const BpShare *share = member;
        snprintf(text, size, "%" PRIu32 "/%" PRIu32, share->number, share->count);
        break;
    }
    case CHOICE:
        snprintf(text, size, "%s", row->words[wide - row->first]);
        break;
    case TEXTS: /* in turn, by the calling command */
        text[0] = '\0';
        break;
    case WORD:
    case TEXT:
    case RESULT:
        memcpy(&word, member, sizeof word);
        snprintf(text, size, "%s", word);
        break;
    }
}

void bp_option_show(BpOption option, const BpCommandLine *line, char *text, size_t size) {
    show_value(&rows[option], (const char *)line + rows[option].offset, text, size);
}

void bp_option_getopt_tables(struct option *long_options, char *letters) {
    size_t used = strlen(letters);
    for (int o = 0; o < BP_OPTION_NUMBER; ++o) {
        const bool has_value = rows[o].kind != FLAG;
        long_options[o] = (struct option){rows[o].name, has_value ? required_argument : no_argument, NULL,
                                          BP_OPTION_LONG + o};
        if (rows[o].letter != 0) {
            letters[used++] = rows[o].letter;
            if (has_value) letters[used++] = ':';
        }
    }
    long_options[BP_OPTION_NUMBER] = (struct option){NULL, 0, NULL, 0};
    letters[used] = '\0';
}

BpOption bp_option_of_result(int getopt_result) {
    if (getopt_result >= BP_OPTION_LONG) return (BpOption)(getopt_result - BP_OPTION_LONG);
    int option = 0;
    while (option < BP_OPTION_NUMBER - 1 && rows[option].letter != (char)getopt_result) ++option;
    return (BpOption)option;
}

const char *bp_option_nearest(const char *written, const BpCommand *command) {
    const char *names[BP_OPTION_NUMBER];
    size_t count = 0;
    for (int o = 0; o < BP_OPTION_NUMBER; ++o)
        if (o == BP_OPTION_HELP || command == NULL || bp_option_taken((BpOption)o, command))
            names[count++] = rows[o].name;
    return bp_nearest_name(written + strspn(written, "-"), names, count);
}
