/* symmetry.c: see symmetry.h. */
#include "symmetry.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SHIFT_STEPS 24     /* of such parts are the shifts of all groups in their usual cells */
#define SHIFT_ROUND 5.0e-4 /* three decimals of a third, and less than the steps' distance */
#define SAME 1.0e-6

const Operation symmetry_identity = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0, 0, 0}};

static void pass_blanks(const char **text) {
    *text += strspn(*text, " \t");
}

/* Digits with or without a point; false: there are none. Exponents do not occur. */
static bool take_decimal(const char **text, double *value) {
    const char *at = *text;
    double unit = 1;
    bool any = false, behind_point = false;
    for (*value = 0; (*at >= '0' && *at <= '9') || (*at == '.' && !behind_point); at++) {
        if (*at == '.') {
            behind_point = true;
            continue;
        }
        any = true;
        *value = 10 * *value + (*at - '0');
        if (behind_point) unit *= 10;
    }
    *value /= unit;
    *text = at;
    return any && isfinite(*value);
}

/* 1, 0.5, 1/2 */
static bool take_fraction(const char **text, double *value) {
    double below = 1;
    if (!take_decimal(text, value)) return false;
    pass_blanks(text);
    if (**text != '/') return true;
    ++*text;
    pass_blanks(text);
    if (!take_decimal(text, &below) || below == 0) return false;
    *value /= below;
    return true;
}

/* The axis that a letter names; -1: none. */
static int axis_of(char letter) {
    const char small = (char)(letter | 32);
    return small >= 'x' && small <= 'z' ? small - 'x' : -1;
}

/* One term: a sign, which the first may lack; a number, a letter, or both. */
static bool take_term(const char **text, bool first, double turn[3], double *shift) {
    double factor = 1;
    const bool has_sign = **text == '+' || **text == '-';
    const double sign = **text == '-' ? -1 : 1;
    if (!has_sign && !first) return false;
    *text += has_sign;
    pass_blanks(text);
    const bool has_number = axis_of(**text) < 0;
    if (has_number && !take_fraction(text, &factor)) return false;
    pass_blanks(text);
    if (**text == '*') ++*text;
    pass_blanks(text);
    const int axis = axis_of(**text);
    if (axis < 0) {
        *shift += sign * factor;
        return true;
    }
    turn[axis] += sign * factor;
    ++*text;
    return true;
}

/* One of the three values, up to the comma or the end. */
static bool take_value(const char **text, double turn[3], double *shift) {
    bool first = true;
    memset(turn, 0, 3 * sizeof *turn);
    *shift = 0;
    for (pass_blanks(text); **text != '\0' && **text != ','; pass_blanks(text)) {
        if (!take_term(text, first, turn, shift)) return false;
        first = false;
    }
    return !first;
}

static double rounded(double shift) {
    const double step = floor(shift * SHIFT_STEPS + 0.5) / SHIFT_STEPS;
    shift = fabs(shift - step) < SHIFT_ROUND ? step : shift;
    return shift - floor(shift);
}

static double determinant(const double m[3][3]) {
    double sum = 0;
    for (int i = 0; i < 3; i++)
        sum += m[0][i] * (m[1][(i + 1) % 3] * m[2][(i + 2) % 3] - m[1][(i + 2) % 3] * m[2][(i + 1) % 3]);
    return sum;
}

bool symmetry_parse(const char *text, Operation *operation) {
    for (int i = 0; i < 3; i++) {
        if (!take_value(&text, operation->turn[i], &operation->shift[i])) return false;
        operation->shift[i] = rounded(operation->shift[i]);
        if (*text != (i < 2 ? ',' : '\0') && !(i == 2 && *text == ',')) return false;
        text += *text == ',';
    }
    pass_blanks(&text);
    text += *text == '+' || *text == '-';
    text += *text == '1';
    pass_blanks(&text);
    return *text == '\0' && fabs(fabs(determinant((const double(*)[3])operation->turn)) - 1) < SAME;
}

void symmetry_apply(const Operation *operation, const double share[3], double image[3]) {
    for (int i = 0; i < 3; i++) {
        image[i] = operation->shift[i];
        for (int k = 0; k < 3; k++) image[i] += operation->turn[i][k] * share[k];
    }
}

static bool is_same(const Operation *a, const Operation *b) {
    for (int i = 0; i < 3; i++) {
        const double off = a->shift[i] - b->shift[i];
        if (!(fabs(off - floor(off + 0.5)) < SAME)) return false;
        for (int k = 0; k < 3; k++)
            if (!(fabs(a->turn[i][k] - b->turn[i][k]) < SAME)) return false;
    }
    return true;
}

BpStatus symmetry_add(Symmetry *symmetry, const Operation *operation, BpError *err) {
    for (size_t i = 0; i < symmetry->count; i++)
        if (is_same(&symmetry->operation[i], operation)) return BP_OK;
    if (symmetry->count == SYMMETRY_MAX)
        return bp_fail(err, BP_ERR_SCENE, "found more than %d symmetry operations, expected fewer",
                       SYMMETRY_MAX);
    if (symmetry->count == symmetry->capacity) {
        const size_t capacity = symmetry->capacity > 0 ? 2 * symmetry->capacity : 64;
        Operation *const grown = realloc(symmetry->operation, capacity * sizeof *grown);
        if (grown == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for symmetry operations");
        symmetry->operation = grown;
        symmetry->capacity = capacity;
    }
    symmetry->operation[symmetry->count++] = *operation;
    return BP_OK;
}

BpStatus symmetry_multiply(Symmetry *symmetry, const Symmetry *centering, BpError *err) {
    const size_t count = symmetry->count;
    for (size_t c = 0; c < centering->count; c++)
        for (size_t s = 0; s < count; s++) {
            const Operation *const outer = &centering->operation[c], inner = symmetry->operation[s];
            Operation product = {{{0}}, {0}};
            symmetry_apply(outer, inner.shift, product.shift);
            for (int i = 0; i < 3; i++)
                for (int k = 0; k < 3; k++)
                    for (int j = 0; j < 3; j++) product.turn[i][k] += outer->turn[i][j] * inner.turn[j][k];
            for (int i = 0; i < 3; i++) product.shift[i] = rounded(product.shift[i]);
            BP_TRY(symmetry_add(symmetry, &product, err));
        }
    return BP_OK;
}

void symmetry_clear(Symmetry *symmetry) {
    free(symmetry->operation);
    *symmetry = (Symmetry){0};
}
