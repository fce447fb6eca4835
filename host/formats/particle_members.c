/* particle_members.c: see particle_members.h. */
#include "particle_members.h"

#include "base/message_text.h"
#include "base/words.h"
#include "scene/scene.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static BpStatus read_above_zero(const BpNode *node, double *value, BpError *err) {
    BP_TRY(bp_node_number(node, value, err));
    if (node->value != NULL && !(*value > 0 && *value <= BP_COORDINATE_MAX))
        return bp_node_wrong(node, "a number above 0", err);
    return BP_OK;
}

static BpStatus read_color(const BpNode *node, double color[3], BpError *err) {
    BP_TRY(bp_node_vector(node, color, err));
    for (int c = 0; c < 3; c++)
        if (!(color[c] >= 0 && color[c] <= 1))
            return bp_node_wrong(node, "shares of light from 0 to 1: [r, g, b]", err);
    return BP_OK;
}

static BpStatus read_column(const BpNode *node, char column[64], BpError *err) {
    const char *text = "";
    BP_TRY(bp_node_string(node, &text, err));
    if (text[0] == '\0' || strlen(text) > 63)
        return bp_node_wrong(node, "the name of a column, at most 63 letters", err);
    memcpy(column, text, strlen(text) + 1);
    return BP_OK;
}

/* An expression; `narrow` (Optional) is another condition that is to hold as well. The error keeps the
 * drawing of the place. */
static BpStatus read_expression(const BpNode *node, BpValueType wanted, const char *narrow,
                                BpExpression **expression, BpError *err) {
    const char *text = "";
    char *both = NULL;
    BpError fault = {0};
    if (node->value == NULL && narrow == NULL) return BP_OK;
    BP_TRY(bp_node_string(node, &text, err));
    BpStatus status = BP_OK;
    if (node->value != NULL) status = bp_select_parse(text, wanted, expression, &fault);
    if (status == BP_OK && narrow != NULL && node->value != NULL) {
        const size_t size = strlen(text) + strlen(narrow) + sizeof "() and ()";
        both = malloc(size);
        if (both == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for an expression");
        snprintf(both, size, "(%s) and (%s)", text, narrow);
        bp_expression_destroy(expression);
    }
    if (status == BP_OK && narrow != NULL)
        status = bp_select_parse(both != NULL ? both : narrow, wanted, expression, &fault);
    free(both);
    if (status == BP_OK) return BP_OK;
    if (status == BP_ERR_MEMORY)
        bp_fail(err, status, "%s", fault.message);
    else
        bp_node_fail(node, BP_PART_VALUE, err, "%s", fault.message);
    bp_error_attach(err, fault.attachment);
    bp_error_clear(&fault);
    return status;
}

/* { "C": ..., "O": ... }: radii (numbers) or colours. */
static BpStatus read_named(const BpNode *node, bool colors, BpStyleNamed *list, size_t *count, BpError *err) {
    const char *name;
    json_t *value;
    if (node->value == NULL) return BP_OK;
    if (!json_is_object(node->value))
        return bp_node_wrong(node, "an object of types or elements: { \"C\": ... }", err);
    json_object_foreach(node->value, name, value) {
        const BpNode child = bp_node_member(node, name);
        if (*count == BP_STYLE_NAMED_MAX)
            return bp_node_fail(&child, BP_PART_NAME, err, "found more than %d types, expected fewer",
                                BP_STYLE_NAMED_MAX);
        BpStyleNamed *const named = &list[*count];
        if (strlen(name) >= sizeof named->name)
            return bp_node_fail(&child, BP_PART_NAME, err,
                                "found a name of more than %zu bytes, expected a shorter one",
                                sizeof named->name - 1);
        memcpy(named->name, name, strlen(name) + 1);
        if (colors)
            BP_TRY(read_color(&child, named->value, err));
        else
            BP_TRY(read_above_zero(&child, named->value, err));
        ++*count;
    }
    return BP_OK;
}

/* The words for which a document may ask, each with its value; the other values have no word. */
#define RADIUS_WORDS(X) X(BP_RADIUS_VDW, "vdw") X(BP_RADIUS_COVALENT, "covalent")
#define COLOR_WORDS(X)                                                                                       \
    X(BP_COLOR_ELEMENT, "element")                                                                           \
    X(BP_COLOR_CHAIN, "chain") X(BP_COLOR_RESIDUE, "residue") X(BP_COLOR_TYPE, "type")
#define WORD(value, word) word,
#define VALUE(value, word) value,
static const char *const radius_words[] = {RADIUS_WORDS(WORD)};
static const BpRadiusBy radius_values[] = {RADIUS_WORDS(VALUE)};
static const char *const color_words[] = {COLOR_WORDS(WORD)};
static const BpColorBy color_values[] = {COLOR_WORDS(VALUE)};

#define EXPECTED_SIZE 256

/* `first`, the words, then `last` if there is one: "a number, \"vdw\" or \"covalent\"". */
static const char *list_words(const char *first, const char *const *words, size_t count, const char *last,
                              char text[EXPECTED_SIZE]) {
    size_t used = (size_t)snprintf(text, EXPECTED_SIZE, "%s", first);
    for (size_t i = 0; i < count && used < EXPECTED_SIZE; i++)
        used += (size_t)snprintf(text + used, EXPECTED_SIZE - used, "%s\"%s\"",
                                 i + 1 == count && last == NULL ? " or " : ", ", words[i]);
    if (last != NULL && used < EXPECTED_SIZE) snprintf(text + used, EXPECTED_SIZE - used, ", or %s", last);
    return text;
}

/* One of `words`. Any other word is probably meant as the name of a column, unless it is nearly one of them.
 * `first`: what may stand here instead of a word. */
static BpStatus read_by(const BpNode *node, const char *const *words, size_t count, const char *first,
                        int *choice, BpError *err) {
    const char *word = json_string_value(node->value);
    char expected[EXPECTED_SIZE], text[EXPECTED_SIZE + 128];
    bool known = bp_nearest_name(word, words, count) != NULL;
    for (size_t i = 0; i < count; i++) known = known || strcmp(word, words[i]) == 0;
    if (known) return bp_node_choice(node, words, count, choice, err);
    snprintf(text, sizeof text, "%s; for a column of the file, { \"column\": \"%s\" }",
             list_words(first, words, count, NULL, expected), strlen(word) <= 64 ? word : "NAME");
    return bp_node_wrong(node, text, err);
}

/* Only one of them says what the numbers are. */
static BpStatus check_alone(const BpNode *by, const BpNode *column, const BpNode *value, BpError *err) {
    const BpNode *const first = by->value != NULL ? by : column;
    const BpNode *const second = column->value != NULL && first != column ? column : value;
    if (first->value == NULL || second->value == NULL) return BP_OK;
    return bp_node_fail(second, BP_PART_NAME, err, "found beside \"%s\", expected one of the two; remove one",
                        first->member);
}

static BpStatus read_radius(const BpNode *node, BpParticleStyle *style, BpError *err) {
    static const char *const names[] = {"by", "column", "value", "scale", "types"};
    static const char object[] = "an object such as { \"by\": \"vdw\", \"scale\": 0.5 }, "
                                 "{ \"column\": \"mass\", \"scale\": 0.1 } or { \"types\": { \"A\": 0.5 } }";
    char expected[EXPECTED_SIZE];
    int choice = 0;
    if (node->value == NULL) return BP_OK;
    if (json_is_number(node->value)) {
        style->radius_by = BP_RADIUS_CONSTANT;
        return read_above_zero(node, &style->radius, err);
    }
    if (json_is_string(node->value)) {
        BP_TRY(read_by(node, radius_words, BP_COUNT(radius_words), "a number", &choice, err));
        style->radius_by = radius_values[choice];
        return BP_OK;
    }
    if (!json_is_object(node->value)) {
        list_words("a number", radius_words, BP_COUNT(radius_words), object, expected);
        return bp_node_wrong(node, expected, err);
    }
    BP_TRY(bp_node_object(node, names, BP_COUNT(names), err));
    const BpNode by = bp_node_member(node, "by"), column = bp_node_member(node, "column");
    const BpNode scale = bp_node_member(node, "scale"), types = bp_node_member(node, "types");
    const BpNode value = bp_node_member(node, "value");
    BP_TRY(check_alone(&by, &column, &value, err));
    if (by.value != NULL) {
        BP_TRY(bp_node_choice(&by, radius_words, BP_COUNT(radius_words), &choice, err));
        style->radius_by = radius_values[choice];
    }
    if (column.value != NULL) {
        style->radius_by = BP_RADIUS_COLUMN;
        BP_TRY(read_column(&column, style->radius_column, err));
    }
    if (value.value != NULL) {
        style->radius_by = BP_RADIUS_COLUMN;
        BP_TRY(read_expression(&value, BP_VALUE_NUMBER, NULL, &style->radius_value, err));
    }
    BP_TRY(read_above_zero(&scale, &style->radius, err));
    return read_named(&types, false, style->radii, &style->radius_count, err);
}

static BpStatus read_range(const BpNode *node, BpParticleStyle *style, BpError *err) {
    if (node->value == NULL) return BP_OK;
    if (json_array_size(node->value) != 2) return bp_node_wrong(node, "two numbers: [least, most]", err);
    for (size_t i = 0; i < 2; i++) {
        const BpNode element = bp_node_element(node, i);
        BP_TRY(bp_node_number(&element, &style->range[i], err));
    }
    if (!(style->range[0] <= style->range[1])) return bp_node_wrong(node, "the lesser number first", err);
    style->has_range = true;
    return BP_OK;
}

/* What is written beside the colour bar. */
static BpStatus read_beside_bar(const BpNode *node, bool has_bar, char *text, size_t size, BpError *err) {
    const char *found = "";
    char expected[64];
    if (node->value == NULL) return BP_OK;
    BP_TRY(bp_node_string(node, &found, err));
    if (!has_bar)
        return bp_node_fail(node, BP_PART_NAME, err,
                            "found without \"bar\": true, which draws the colour bar that it belongs to");
    snprintf(expected, sizeof expected, "a text of 1 to %zu bytes", size - 1);
    if (found[0] == '\0' || strlen(found) >= size) return bp_node_wrong(node, expected, err);
    memcpy(text, found, strlen(found) + 1);
    return BP_OK;
}

static BpStatus read_colors(const BpNode *node, BpParticleStyle *style, BpError *err) {
    static const char *const names[] = {"by",  "column", "value", "map",  "range",
                                        "bar", "label",  "unit",  "types"};
    static const char object[] =
        "an object such as { \"column\": \"charge\", \"map\": \"viridis\", \"range\": [-1, 1] } or "
        "{ \"types\": { \"A\": [0.5, 0.1, 0.1] } }";
    char expected[EXPECTED_SIZE];
    int choice = 0;
    if (node->value == NULL) return BP_OK;
    if (json_is_array(node->value)) {
        style->color_by = BP_COLOR_CONSTANT;
        return read_color(node, style->color, err);
    }
    if (json_is_string(node->value)) {
        BP_TRY(read_by(node, color_words, BP_COUNT(color_words), "[r, g, b]", &choice, err));
        style->color_by = color_values[choice];
        return BP_OK;
    }
    if (!json_is_object(node->value)) {
        list_words("[r, g, b]", color_words, BP_COUNT(color_words), object, expected);
        return bp_node_wrong(node, expected, err);
    }
    BP_TRY(bp_node_object(node, names, BP_COUNT(names), err));
    const BpNode by = bp_node_member(node, "by"), column = bp_node_member(node, "column");
    const BpNode map = bp_node_member(node, "map"), range = bp_node_member(node, "range");
    const BpNode bar = bp_node_member(node, "bar"), types = bp_node_member(node, "types");
    const BpNode value = bp_node_member(node, "value");
    const BpNode label = bp_node_member(node, "label"), unit = bp_node_member(node, "unit");
    BP_TRY(check_alone(&by, &column, &value, err));
    if (column.value == NULL && value.value == NULL &&
        (map.value != NULL || range.value != NULL || bar.value != NULL))
        return bp_node_fail(
            map.value != NULL     ? &map
            : range.value != NULL ? &range
                                  : &bar,
            BP_PART_NAME, err,
            "found without \"column\" or \"value\", expected one of them, whose numbers give the colours");
    if (by.value != NULL) {
        BP_TRY(bp_node_choice(&by, color_words, BP_COUNT(color_words), &choice, err));
        style->color_by = color_values[choice];
    }
    if (column.value != NULL) {
        style->color_by = BP_COLOR_COLUMN;
        BP_TRY(read_column(&column, style->color_column, err));
    }
    if (value.value != NULL) {
        style->color_by = BP_COLOR_COLUMN;
        BP_TRY(read_expression(&value, BP_VALUE_NUMBER, NULL, &style->color_value, err));
        bp_printable(bp_expression_text(style->color_value), style->color_column, sizeof style->color_column);
    }
    choice = BP_MAP_VIRIDIS;
    BP_TRY(bp_node_choice(&map, bp_colormap_names, BP_MAP_COUNT, &choice, err));
    style->map = (BpColormap)choice;
    BP_TRY(read_range(&range, style, err));
    BP_TRY(bp_node_boolean(&bar, &style->bar, err));
    BP_TRY(read_beside_bar(&label, style->bar, style->label, sizeof style->label, err));
    BP_TRY(read_beside_bar(&unit, style->bar, style->unit, sizeof style->unit, err));
    return read_named(&types, true, style->colors, &style->color_count, err);
}

static BpStatus read_bonds(const BpNode *node, BpParticleStyle *style, BpError *err) {
    static const char *const names[] = {"radius"};
    if (json_is_object(node->value)) {
        BP_TRY(bp_node_object(node, names, BP_COUNT(names), err));
        const BpNode radius = bp_node_member(node, "radius");
        style->bonds = true;
        return read_above_zero(&radius, &style->bond_radius, err);
    }
    if (node->value != NULL && !json_is_boolean(node->value))
        return bp_node_wrong(node, "true, false or { \"radius\": 0.1 }", err);
    return bp_node_boolean(node, &style->bonds, err);
}

#define STYLE_WORDS(X) X(BP_STYLE_SPACEFILL, "spacefill") X(BP_STYLE_BALL_AND_STICK, "ball-and-stick")
BP_WORDS(BpStyleKind, static const char *const style_names, STYLE_WORDS);

BpStatus bp_parse_particle_style(const BpNode *node, const char *narrow, BpParticleStyle *style,
                                 BpError *err) {
    const BpNode kind = bp_node_member(node, "style"), radius = bp_node_member(node, "radius");
    const BpNode color = bp_node_member(node, "color"), bonds = bp_node_member(node, "bonds");
    const BpNode box = bp_node_member(node, "box"), solvent = bp_node_member(node, "solvent");
    const BpNode whole = bp_node_member(node, "whole"), select = bp_node_member(node, "select");
    const BpNode shapes = bp_node_member(node, "shapes");
    int choice = 0;
    bp_particle_style_defaults(style);
    BP_TRY(read_expression(&select, BP_VALUE_TRUTH, narrow, &style->select, err));
    if (style->select != NULL && solvent.value != NULL)
        return bp_node_fail(
            &solvent, BP_PART_NAME, err,
            "found beside \"select\", which decides that: write \"... and not solvent\" in it");
    BP_TRY(bp_node_choice(&kind, style_names, BP_COUNT(style_names), &choice, err));
    style->kind = (BpStyleKind)choice;
    BP_TRY(read_radius(&radius, style, err));
    BP_TRY(read_colors(&color, style, err));
    BP_TRY(read_bonds(&bonds, style, err));
    BP_TRY(bp_node_boolean(&box, &style->box, err));
    BP_TRY(bp_node_boolean(&solvent, &style->solvent, err));
    BP_TRY(bp_node_boolean(&whole, &style->whole, err));
    return bp_node_boolean(&shapes, &style->shapes, err);
}
