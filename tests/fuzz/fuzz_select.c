/* fuzz_select.c: any text as an expression over a few particles. The first byte says whether a condition or a
 * number is wanted; the rest is the text, up to its first zero byte.
 *
 * What is refused has a message and a drawing of two lines, of which the second marks a place in the first.
 * What is accepted names no more columns than it may; `not` turns a condition round for every particle, and
 * in parentheses it is the same. */
#include "fuzz.h"
#include "particles/select.h"

#include <math.h>

enum { COUNT = 12, NAMES = 8 };

static char *names[NAMES] = {"", "CA", "ALA", "HOH", "A", "B", "2", "LIG"};
static double places[COUNT][3], values[COUNT];
static float radii[COUNT];
static BpParticleTag tags[COUNT];

static void fill(void) {
    for (uint16_t i = 0; i < COUNT; i++) {
        for (int c = 0; c < 3; c++) places[i][c] = (double)((i * (c + 3)) % 7) - 2;
        values[i] = i % 4 == 3 ? NAN : i - 2.5;
        radii[i] = i % 3 == 0 ? NAN : 1;
        tags[i] = (BpParticleTag){.name = i % NAMES,
                                  .residue = (uint16_t)(i / 2 % NAMES),
                                  .chain = 4 + i % 2,
                                  .type = i % NAMES,
                                  .element = (uint8_t)(i % 9),
                                  .flags = i % 2 ? BP_PARTICLE_HETERO : 0};
    }
}

static void check_refused(const BpError *err, const char *text) {
    require(err->code == BP_ERR_SCENE && err->message[0] != '\0');
    if (strlen(text) > BP_EXPRESSION_BYTES_MAX || strstr(err->message, "for which this holds") != NULL)
        return;
    require(strncmp(err->message, "at character ", 13) == 0 && err->attachment != NULL);
    const char *const end = strchr(err->attachment, '\n');
    require(end != NULL && strchr(end + 1, '\n') == NULL);
    const char *const mark = end + 1 + strspn(end + 1, " ");
    require(mark[0] == '^' && mark[strspn(mark, "^")] == '\0');
    require(strlen(err->attachment) < 600);
}

static BpStatus select_by(const char *text, const BpSelectFrame *frame, bool selected[COUNT], BpError *err) {
    BpExpression *expression = NULL;
    BpStatus status = bp_select_parse(text, BP_VALUE_TRUTH, &expression, err);
    if (status == BP_OK) status = bp_select_truths(frame, expression, selected, err);
    if (status == BP_OK) require(bp_select_fail_nothing(frame, expression, NULL) == BP_ERR_SCENE);
    bp_expression_destroy(&expression);
    return status;
}

/* In `form`, such as "not (%s)"; too deep or too long then is no fault. */
static void check_other_form(const char *form, const char *text, const BpSelectFrame *frame,
                             const bool selected[COUNT], bool same) {
    char whole[BP_EXPRESSION_BYTES_MAX + 32];
    bool other[COUNT];
    BpError err = {0};
    snprintf(whole, sizeof whole, form, text);
    if (select_by(whole, frame, other, &err) == BP_OK)
        for (int i = 0; i < COUNT; i++) require((selected[i] == other[i]) == same);
    else
        require(strlen(whole) > BP_EXPRESSION_BYTES_MAX || strstr(err.message, "levels of") != NULL);
    bp_error_clear(&err);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    static const char *const wanted[] = {"q", "residue_number"};
    char *columns[] = {"q", "residue_number"};
    BpParticles particles = {.count = COUNT,
                             .position = places,
                             .tag = tags,
                             .radius = radii,
                             .column = {values, values},
                             .column_names = columns,
                             .column_count = 2,
                             .names = {.text = names, .count = NAMES},
                             .has_residue = true,
                             .has_chain = true,
                             .has_type = true,
                             .has_element = true,
                             .has_records = true,
                             .has_cell = true,
                             .periodic = {true, true, false},
                             .cell = {{5, 0, 0}, {2, 4, 0}, {0, 0, 9}}};
    const BpSelectFrame frame = {&particles, wanted, 2};
    BpError err = {0};
    BpExpression *expression = NULL;
    if (size == 0) return 0;
    fill();
    char *const text = malloc(size);
    require(text != NULL);
    memcpy(text, data + 1, size - 1);
    text[size - 1] = '\0';
    if (data[0] % 2 == 0) {
        bool selected[COUNT] = {false};
        if (select_by(text, &frame, selected, &err) == BP_OK) {
            check_other_form("(%s)", text, &frame, selected, true);
            check_other_form("not (%s)", text, &frame, selected, false);
        } else {
            check_refused(&err, text);
        }
    } else {
        double numbers[COUNT];
        BpStatus status = bp_select_parse(text, BP_VALUE_NUMBER, &expression, &err);
        if (status == BP_OK) {
            const char *named[BP_SELECT_COLUMNS_MAX];
            require(strcmp(bp_expression_text(expression), text) == 0);
            require(bp_select_columns(expression, named) <= BP_SELECT_COLUMNS_MAX);
            status = bp_select_numbers(&frame, expression, numbers, &err);
        }
        if (status != BP_OK) check_refused(&err, text);
        bp_expression_destroy(&expression);
    }
    bp_error_clear(&err);
    free(text);
    return 0;
}
