/* style_colors.c: see style_colors.h, and ballpark.h for the tables that are offered to others. */
#include "style_colors.h"

#include "base/color.h"
#include "base/format.h"
#include "base/words.h"
#include "elements.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Soft colours for kinds that have none of their own, 8-bit sRGB. */
static const unsigned char palette[][3] = {{112, 148, 202}, {228, 164, 104}, {128, 186, 130}, {210, 114, 110},
                                           {160, 132, 192}, {164, 134, 116}, {222, 164, 194}, {152, 152, 152},
                                           {192, 186, 114}, {122, 186, 198}};
enum { PALETTE_COUNT = sizeof palette / sizeof *palette, GREY = 7 };

static void look_up(const double linear[256], const unsigned char bytes[3], double color[3]) {
    for (int c = 0; c < 3; c++) color[c] = linear[bytes[c]];
}

void bp_type_color(size_t type, double color[3]) {
    const unsigned char *const bytes = palette[type % PALETTE_COUNT];
    for (int c = 0; c < 3; c++) color[c] = bp_linear_from_srgb(bytes[c] / 255.0);
}

const char *bp_color_map_name(size_t index) {
    return index < BP_MAP_COUNT ? bp_colormap_names[index] : NULL;
}

bool bp_color_map(const char *name, double share, double color[3]) {
    for (int map = 0; map < BP_MAP_COUNT; map++) {
        if (strcmp(name, bp_colormap_names[map]) != 0) continue;
        const BpParticleStyle style = {.map = (BpColormap)map};
        bp_particle_style_map(&style, share, color);
        return true;
    }
    return false;
}

void bp_particle_style_map(const BpParticleStyle *style, double share, double color[3]) {
    bp_colormap_color(style->map, share, color);
    for (int c = 0; c < 3; c++) color[c] *= 0.9; /* albedos near 1 glare */
}

static uint16_t kind_of(const BpStyleJob *job, size_t i) {
    const BpParticleTag *const tag = &job->p->tag[i];
    return job->color_by == BP_COLOR_CHAIN     ? tag->chain
           : job->color_by == BP_COLOR_RESIDUE ? tag->residue
                                               : tag->type;
}

typedef struct Ranked {
    const char *name;
    uint16_t number;
} Ranked;

/* 2 before 10, and otherwise by letters. */
static int compare_ranked(const void *a, const void *b) {
    const char *const one = ((const Ranked *)a)->name, *const other = ((const Ranked *)b)->name;
    const size_t digits[2] = {strspn(one, "0123456789"), strspn(other, "0123456789")};
    if (one[digits[0]] == '\0' && other[digits[1]] == '\0' && digits[0] != digits[1])
        return digits[0] < digits[1] ? -1 : 1;
    return strcmp(one, other);
}

/* The kinds of the particles of `among` that have no rank yet, behind the `before` that have one, in the
 * order of their names. Returns how many have a rank then. */
static size_t rank_kinds(BpStyleJob *job, const bool *among, size_t before, Ranked *kinds) {
    const BpParticles *const p = job->p;
    size_t count = 0;
    for (size_t i = 0; i < p->count; i++) {
        const uint16_t number = kind_of(job, i);
        if (!among[i] || job->rank[number] != 0) continue;
        job->rank[number] = 1;
        kinds[count++] = (Ranked){bp_style_name(p, number), number};
    }
    qsort(kinds, count, sizeof *kinds, compare_ranked);
    for (size_t k = 0; k < count; k++) job->rank[kinds[k].number] = (uint16_t)(before + k + 1);
    return before + count;
}

/* By their names, so that all frames of a trajectory give a kind the same colour, whatever is selected. */
static BpStatus rank_names(BpStyleJob *job, BpError *err) {
    const BpParticles *const p = job->p;
    job->rank = calloc(p->names.count + 1, sizeof *job->rank);
    Ranked *const kinds = malloc((p->names.count + 1) * sizeof *kinds);
    const bool good = job->rank != NULL && kinds != NULL;
    if (good) rank_kinds(job, job->base, rank_kinds(job, job->usual, 0, kinds), kinds);
    free(kinds);
    return good ? BP_OK : bp_fail(err, BP_ERR_MEMORY, "out of memory for colours");
}

/* What colours are by. */
#define COLOR_NAMES(X)                                                                                       \
    X(BP_COLOR_AUTO, "")                                                                                     \
    X(BP_COLOR_CONSTANT, "")                                                                                 \
    X(BP_COLOR_ELEMENT, "elements")                                                                          \
    X(BP_COLOR_CHAIN, "chains")                                                                              \
    X(BP_COLOR_RESIDUE, "residues") X(BP_COLOR_TYPE, "types") X(BP_COLOR_COLUMN, "values")
BP_WORDS(BpColorBy, static const char *const color_names, COLOR_NAMES);

static bool is_without_value(const BpStyleJob *job, size_t i) {
    return isnan(job->color_numbers[i]);
}

static bool is_without_color(const BpStyleJob *job, size_t i) {
    return isnan(job->p->color[i][0]);
}

/* Says how many of the particles shown, that no name gives a colour, have none from the file. */
static void say_missing(BpStyleJob *job, const char *what,
                        bool (*is_missing)(const BpStyleJob *job, size_t i)) {
    const BpParticleStyle *const style = job->style;
    size_t count = 0;
    char number[32];
    for (size_t i = 0; i < job->p->count; i++)
        count += job->shown[i] && is_missing(job, i) &&
                 bp_style_named(style->colors, style->color_count, job->p, &job->p->tag[i]) == NULL;
    if (count > 0)
        bp_style_say(job, "grey for lack of %s: %s", what, bp_format_whole(count, number, sizeof number));
}

BpStatus bp_style_choose_colors(BpStyleJob *job, BpError *err) {
    const BpParticles *const p = job->p;
    const BpParticleStyle *const style = job->style;
    job->color_by = style->color_by;
    if (style->color_by == BP_COLOR_AUTO && p->color == NULL)
        job->color_by = p->has_element ? BP_COLOR_ELEMENT : p->has_type ? BP_COLOR_TYPE : BP_COLOR_CONSTANT;
    const bool lacks = (style->color_by == BP_COLOR_ELEMENT && !p->has_element) ||
                       (style->color_by == BP_COLOR_CHAIN && !p->has_chain) ||
                       (style->color_by == BP_COLOR_RESIDUE && !p->has_residue) ||
                       (style->color_by == BP_COLOR_TYPE && !p->has_type);
    if (lacks)
        return bp_fail(err, BP_ERR_SCENE, "found no %s in the file, expected them for colours",
                       color_names[style->color_by]);
    if (job->color_by == BP_COLOR_CHAIN || job->color_by == BP_COLOR_RESIDUE ||
        job->color_by == BP_COLOR_TYPE)
        return rank_names(job, err);
    if (job->color_by == BP_COLOR_AUTO) say_missing(job, "a colour", is_without_color);
    if (job->color_by != BP_COLOR_COLUMN) return BP_OK;
    BP_TRY(bp_style_numbers(job, style->color_value, style->color_column, "color.value", &job->color_numbers,
                            err));
    const double *const numbers = job->color_numbers;
    job->range[0] = INFINITY;
    job->range[1] = -INFINITY;
    for (size_t i = 0; i < p->count; i++) {
        if (!job->shown[i] || !isfinite(numbers[i])) continue;
        job->range[0] = fmin(job->range[0], numbers[i]);
        job->range[1] = fmax(job->range[1], numbers[i]);
    }
    if (style->has_range) memcpy(job->range, style->range, sizeof job->range);
    if (!(job->range[0] <= job->range[1]))
        return bp_fail(err, BP_ERR_SCENE, "found no number in %s \"%s\", expected some to colour by",
                       style->color_value != NULL ? "the value" : "column", style->color_column);
    bp_style_say(job, "coloured by %s from %.4g to %.4g (%s)", style->color_column, job->range[0],
                 job->range[1], bp_colormap_names[style->map]);
    say_missing(job, "a value", is_without_value);
    return BP_OK;
}

void bp_style_color(const BpStyleJob *job, size_t i, double color[3]) {
    const BpParticles *const p = job->p;
    const BpParticleStyle *const style = job->style;
    const BpParticleTag *const tag = &p->tag[i];
    const BpStyleNamed *const own = bp_style_named(style->colors, style->color_count, p, tag);
    size_t place = 0;
    if (own != NULL) {
        memcpy(color, own->value, 3 * sizeof *color);
        return;
    }
    switch (job->color_by) {
    case BP_COLOR_AUTO:
        if (p->color != NULL && !isnan(p->color[i][0])) {
            for (int c = 0; c < 3; c++) color[c] = (double)p->color[i][c];
            return;
        }
        place = GREY;
        break;
    case BP_COLOR_CONSTANT:
        if (style->color_by == BP_COLOR_CONSTANT) {
            memcpy(color, style->color, sizeof style->color);
            return;
        }
        break;
    case BP_COLOR_ELEMENT:
        look_up(job->linear, bp_elements[tag->element].color, color);
        return;
    case BP_COLOR_COLUMN: {
        const double value = job->color_numbers[i];
        const double width = job->range[1] - job->range[0];
        if (!isnan(value)) {
            bp_particle_style_map(style, width > 0 ? (value - job->range[0]) / width : 0.5, color);
            return;
        }
        place = GREY;
        break;
    }
    case BP_COLOR_CHAIN:
    case BP_COLOR_RESIDUE:
    case BP_COLOR_TYPE:
        place = (size_t)job->rank[kind_of(job, i)] - 1;
        break;
    }
    look_up(job->linear, palette[place % PALETTE_COUNT], color);
}
