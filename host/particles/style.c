/* style.c: see style.h. */
#include "style.h"

#include <string.h>

_Static_assert(BP_PARTICLE_WANTED_MAX >= 2 + 3 * BP_SELECT_COLUMNS_MAX, "all columns that a style may want");

void bp_particle_style_defaults(BpParticleStyle *style) {
    *style = (BpParticleStyle){.radius = 1, .whole = true, .shapes = true};
}

void bp_particle_style_clear(BpParticleStyle *style) {
    bp_expression_destroy(&style->select);
    bp_expression_destroy(&style->radius_value);
    bp_expression_destroy(&style->color_value);
}

static void add(BpStyleColumns *columns, const char *name) {
    for (size_t i = 0; i < columns->count; i++)
        if (strcmp(columns->name[i], name) == 0) return;
    columns->name[columns->count++] = name;
}

static void add_wanted(BpStyleColumns *columns, const BpExpression *expression) {
    const char *names[BP_SELECT_COLUMNS_MAX];
    const size_t count = expression != NULL ? bp_select_columns(expression, names) : 0;
    for (size_t i = 0; i < count; i++) add(columns, names[i]);
}

void bp_particle_style_columns(const BpParticleStyle *style, BpStyleColumns *columns) {
    columns->count = 0;
    if (style->radius_by == BP_RADIUS_COLUMN && style->radius_value == NULL)
        add(columns, style->radius_column);
    if (style->color_by == BP_COLOR_COLUMN && style->color_value == NULL) add(columns, style->color_column);
    columns->needed = columns->count;
    add_wanted(columns, style->select);
    add_wanted(columns, style->radius_value);
    add_wanted(columns, style->color_value);
}
