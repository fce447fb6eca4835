/* style.c: see style.h. */
#include "style.h"

void bp_particle_style_defaults(BpParticleStyle *style) {
    *style = (BpParticleStyle){.radius = 1, .whole = true};
}

size_t bp_particle_style_columns(const BpParticleStyle *style, const char *columns[BP_PARTICLE_WANTED_MAX]) {
    size_t count = 0;
    if (style->radius_by == BP_RADIUS_COLUMN) columns[count++] = style->radius_column;
    if (style->color_by == BP_COLOR_COLUMN) columns[count++] = style->color_column;
    return count;
}
