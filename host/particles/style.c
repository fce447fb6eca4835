/* style.c: see style.h. */
#include "style.h"

#include "base/color.h"
#include "base/format.h"
#include "base/pages.h"
#include "base/plural.h"
#include "base/team.h"
#include "base/words.h"
#include "bonds.h"
#include "elements.h"
#include "molecules.h"
#include "spacing.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#define BALL_SHARE 0.28     /* of the van der Waals radius, in ball-and-stick */
#define COARSE_ANGSTROM 2.3 /* atoms of molecules have a neighbour nearer than this */
#define STICK_ANGSTROM 0.14 /* half the width of a bond */
#define EDGE_SHARE 0.002    /* half the width of the cell's edges, of its longest */
#define BEADS_MAX 4000      /* in one bond or edge */

/* Soft colours for kinds that have none of their own, 8-bit sRGB. */
static const unsigned char palette[][3] = {{112, 148, 202}, {228, 164, 104}, {128, 186, 130}, {210, 114, 110},
                                           {160, 132, 192}, {164, 134, 116}, {222, 164, 194}, {152, 152, 152},
                                           {192, 186, 114}, {122, 186, 198}};
enum { PALETTE_COUNT = sizeof palette / sizeof *palette };

void bp_particle_style_defaults(BpParticleStyle *style) {
    *style = (BpParticleStyle){.radius = 1, .whole = true};
}

size_t bp_particle_style_columns(const BpParticleStyle *style, const char *columns[BP_PARTICLE_WANTED_MAX]) {
    size_t count = 0;
    if (style->radius_by == BP_RADIUS_COLUMN) columns[count++] = style->radius_column;
    if (style->color_by == BP_COLOR_COLUMN) columns[count++] = style->color_column;
    return count;
}

static void from_bytes(const unsigned char bytes[3], double color[3]) {
    for (int c = 0; c < 3; c++) color[c] = bp_linear_from_srgb(bytes[c] / 255.0);
}

static void look_up(const double linear[256], const unsigned char bytes[3], double color[3]) {
    for (int c = 0; c < 3; c++) color[c] = linear[bytes[c]];
}

void bp_type_color(size_t type, double color[3]) {
    from_bytes(palette[type % PALETTE_COUNT], color);
}

bool bp_element_info(unsigned atomic_number, BpElementInfo *info) {
    if (atomic_number > BP_ELEMENT_MAX) return false;
    const BpElement *const element = &bp_elements[atomic_number];
    *info = (BpElementInfo){.mass = (double)element->mass,
                            .van_der_waals = (double)element->van_der_waals,
                            .covalent = (double)element->covalent};
    memcpy(info->symbol, element->symbol, sizeof element->symbol);
    from_bytes(element->color, info->color);
    return true;
}

unsigned bp_element_of_atom(const char *name, const char *residue) {
    bool dummy;
    return bp_element_of_name(name, residue != NULL ? residue : "", false, &dummy);
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

typedef struct Job {
    BpParticles *p;
    const BpParticleStyle *style;
    BpScene *scene;
    uint32_t material;
    bool *shown;
    size_t shown_count;
    BpBonds bonds;
    double spacing, range[2];
    BpRadiusBy radius_by;
    BpColorBy color_by;
    size_t capacity, albedo_capacity; /* of the scene's arrays */
    uint16_t *rank; /* of a name among the kinds that get colours of the palette, from 0, in the order of the
                       file */
    double linear[256]; /* of each byte of an sRGB colour */
    char *summary;
    size_t size;
} Job;

static void say(Job *job, const char *format, ...) BP_PRINTF_LIKE(2, 3);

static void say(Job *job, const char *format, ...) {
    if (job->summary == NULL) return;
    const size_t used = strlen(job->summary);
    if (used + 4 > job->size) return;
    snprintf(job->summary + used, job->size - used, "%s", used > 0 ? "; " : "");
    const size_t begin = strlen(job->summary);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(job->summary + begin, job->size - begin, format, arguments);
    va_end(arguments);
}

static const char *name_of(const BpParticles *p, uint16_t number) {
    return p->names.count > 0 ? p->names.text[number] : "";
}

/* ---- what is shown ------------------------------------------------------------------------------------ */

static BpStatus choose_shown(Job *job, BpError *err) {
    enum { NOTHING, WATER, ION, DUMMY, ALTERNATIVE, KINDS };
    static const char *const words[KINDS] = {"", "of water", "of ions", "dummy", "in alternative places"};
    BpParticles *const p = job->p;
    size_t counts[KINDS] = {0};
    unsigned char *const kind = calloc(p->count + 1, 1);
    /* Looked up once for each name. */
    unsigned char *const by_residue = calloc(p->names.count + 1, 1);
    job->shown = calloc(p->count + 1, sizeof *job->shown);
    if (kind == NULL || by_residue == NULL || job->shown == NULL) {
        free(kind);
        free(by_residue);
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for %zu particles", p->count);
    }
    for (size_t n = 0; n < p->names.count; n++)
        by_residue[n] = bp_residue_is_water(p->names.text[n]) ? WATER
                        : bp_residue_is_ion(p->names.text[n]) ? ION
                                                              : NOTHING;
    for (size_t i = 0; i < p->count; i++) {
        const BpParticleTag *const tag = &p->tag[i];
        kind[i] = tag->residue != 0 ? by_residue[tag->residue] : NOTHING;
        if ((tag->flags & BP_PARTICLE_ALTERNATIVE) != 0) kind[i] = ALTERNATIVE;
        if ((tag->flags & BP_PARTICLE_DUMMY) != 0) kind[i] = DUMMY;
        counts[kind[i]]++;
    }
    const bool solute = counts[NOTHING] > 0, solvent = job->style->solvent || !solute;
    for (size_t i = 0; i < p->count; i++) {
        const bool show = kind[i] == NOTHING || ((kind[i] == WATER || kind[i] == ION) && solvent) ||
                          (kind[i] != NOTHING && counts[NOTHING] + counts[WATER] + counts[ION] == 0);
        job->shown[i] = show;
        job->shown_count += show;
    }
    char hidden[160] = "", number[32];
    for (int k = WATER; k < KINDS; k++) {
        if (counts[k] == 0 || ((k == WATER || k == ION) && solvent) || job->shown_count == p->count) continue;
        const size_t used = strlen(hidden);
        snprintf(hidden + used, sizeof hidden - used, "%s%s %s", used > 0 ? ", " : "",
                 bp_format_whole(counts[k], number, sizeof number), words[k]);
    }
    if (hidden[0] != '\0') say(job, "hidden: %s", hidden);
    free(kind);
    free(by_residue);
    return BP_OK;
}

/* ---- radii -------------------------------------------------------------------------------------------- */

static const BpStyleNamed *named(const BpStyleNamed *list, size_t count, const BpParticles *p,
                                 const BpParticleTag *tag) {
    for (size_t i = 0; i < count; i++)
        if (strcmp(list[i].name, name_of(p, tag->type)) == 0 ||
            (tag->element != 0 && strcmp(list[i].name, bp_elements[tag->element].symbol) == 0))
            return &list[i];
    return NULL;
}

static BpStatus choose_radii(Job *job, BpError *err) {
    const BpParticleStyle *const style = job->style;
    BpParticles *const p = job->p;
    job->radius_by = style->radius_by;
    if ((style->radius_by == BP_RADIUS_VDW || style->radius_by == BP_RADIUS_COVALENT) && !p->has_element)
        return bp_fail(err, BP_ERR_SCENE,
                       "found no elements, expected them for radii by element; give \"radius\" as a number");
    bool elements = p->has_element && p->angstrom > 0;
    if (style->radius_by == BP_RADIUS_AUTO && p->radius == NULL && elements && p->element_guessed) {
        /* Beads of coarse-grained models have names that look like atoms', but lie further apart than bonds
         * reach. */
        BP_TRY(bp_particles_spacing(p, job->shown, &job->spacing, err));
        elements = job->spacing < COARSE_ANGSTROM * p->angstrom;
    }
    if (style->radius_by == BP_RADIUS_AUTO && p->radius == NULL && elements) job->radius_by = BP_RADIUS_VDW;
    bool spacing_needed = job->radius_by == BP_RADIUS_AUTO && p->radius == NULL;
    for (size_t i = 0; i < p->count && !spacing_needed && job->radius_by == BP_RADIUS_AUTO; i++)
        spacing_needed = job->shown[i] && !(p->radius[i] > 0 && isfinite(p->radius[i]));
    if ((job->radius_by == BP_RADIUS_VDW || job->radius_by == BP_RADIUS_COVALENT) && p->angstrom == 0)
        p->angstrom = 1;
    if (spacing_needed) {
        BP_TRY(bp_particles_spacing(p, job->shown, &job->spacing, err));
        if (job->spacing == 0) job->spacing = 1;
        say(job, "radius %.3g%s: half the median distance of neighbours", job->spacing / 2 * style->radius,
            p->radius != NULL ? " where the file has none" : "");
    } else if (job->radius_by == BP_RADIUS_VDW) {
        say(job, "van der Waals radii%s", style->kind == BP_STYLE_BALL_AND_STICK ? ", scaled" : "");
    }
    return BP_OK;
}

/* NaN for a column that has no number there. */
static double radius_of(const Job *job, size_t i) {
    const BpParticles *const p = job->p;
    const BpParticleStyle *const style = job->style;
    const BpParticleTag *const tag = &p->tag[i];
    const BpStyleNamed *const own = named(style->radii, style->radius_count, p, tag);
    if (own != NULL) return own->value[0];
    const double scale = style->radius * (style->kind == BP_STYLE_BALL_AND_STICK ? BALL_SHARE : 1);
    switch (job->radius_by) {
    case BP_RADIUS_CONSTANT:
        return style->radius;
    case BP_RADIUS_COLUMN:
        return style->radius * (double)p->column[0][i];
    case BP_RADIUS_VDW:
        return scale * p->angstrom * (double)bp_elements[tag->element].van_der_waals;
    case BP_RADIUS_COVALENT:
        return style->radius * p->angstrom * (double)bp_elements[tag->element].covalent;
    case BP_RADIUS_AUTO:
        break;
    }
    const bool has_own = p->radius != NULL && p->radius[i] > 0 && isfinite(p->radius[i]);
    return scale * (has_own ? (double)p->radius[i] : job->spacing / 2);
}

/* ---- colours ------------------------------------------------------------------------------------------ */

static uint16_t kind_of(const Job *job, size_t i) {
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

/* The kinds in the order of their names, so that all frames of a trajectory give a kind the same colour. */
static BpStatus rank_names(Job *job, BpError *err) {
    const BpParticles *const p = job->p;
    size_t count = 0;
    job->rank = calloc(p->names.count + 1, sizeof *job->rank);
    Ranked *const kinds = malloc((p->names.count + 1) * sizeof *kinds);
    if (job->rank == NULL || kinds == NULL) {
        free(kinds);
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for colours");
    }
    for (size_t i = 0; i < p->count; i++) {
        const uint16_t number = kind_of(job, i);
        if (!job->shown[i] || job->rank[number] != 0) continue;
        job->rank[number] = 1;
        kinds[count++] = (Ranked){name_of(p, number), number};
    }
    qsort(kinds, count, sizeof *kinds, compare_ranked);
    for (size_t k = 0; k < count; k++) job->rank[kinds[k].number] = (uint16_t)(k + 1);
    free(kinds);
    return BP_OK;
}

/* What colours are by. */
#define COLOR_WORDS(X)                                                                                       \
    X(BP_COLOR_AUTO, "")                                                                                     \
    X(BP_COLOR_CONSTANT, "")                                                                                 \
    X(BP_COLOR_ELEMENT, "elements")                                                                          \
    X(BP_COLOR_CHAIN, "chains")                                                                              \
    X(BP_COLOR_RESIDUE, "residues") X(BP_COLOR_TYPE, "types") X(BP_COLOR_COLUMN, "values")
BP_WORDS(BpColorBy, static const char *const color_names, COLOR_WORDS);

static BpStatus choose_colors(Job *job, BpError *err) {
    const BpParticles *const p = job->p;
    const BpParticleStyle *const style = job->style;
    job->color_by = style->color_by;
    if (style->color_by == BP_COLOR_AUTO && p->color == NULL)
        job->color_by = p->has_element ? BP_COLOR_ELEMENT : p->has_type ? BP_COLOR_TYPE : BP_COLOR_CONSTANT;
    const bool has = (style->color_by == BP_COLOR_ELEMENT && !p->has_element) ||
                     (style->color_by == BP_COLOR_CHAIN && !p->has_chain) ||
                     (style->color_by == BP_COLOR_RESIDUE && !p->has_residue) ||
                     (style->color_by == BP_COLOR_TYPE && !p->has_type);
    if (has)
        return bp_fail(err, BP_ERR_SCENE, "found no %s in the file, expected them for colours",
                       color_names[style->color_by]);
    if (job->color_by == BP_COLOR_CHAIN || job->color_by == BP_COLOR_RESIDUE ||
        job->color_by == BP_COLOR_TYPE)
        return rank_names(job, err);
    if (job->color_by != BP_COLOR_COLUMN) return BP_OK;
    const float *const column = p->column[style->radius_by == BP_RADIUS_COLUMN];
    job->range[0] = INFINITY;
    job->range[1] = -INFINITY;
    for (size_t i = 0; i < p->count; i++) {
        if (!job->shown[i] || !isfinite(column[i])) continue;
        job->range[0] = fmin(job->range[0], (double)column[i]);
        job->range[1] = fmax(job->range[1], (double)column[i]);
    }
    if (style->has_range) memcpy(job->range, style->range, sizeof job->range);
    if (!(job->range[0] <= job->range[1]))
        return bp_fail(err, BP_ERR_SCENE, "found no number in column \"%s\", expected some to colour by",
                       style->color_column);
    say(job, "coloured by %s from %.4g to %.4g (%s)", style->color_column, job->range[0], job->range[1],
        bp_colormap_names[style->map]);
    return BP_OK;
}

static void color_of(const Job *job, size_t i, double color[3]) {
    const BpParticles *const p = job->p;
    const BpParticleStyle *const style = job->style;
    const BpParticleTag *const tag = &p->tag[i];
    const BpStyleNamed *const own = named(style->colors, style->color_count, p, tag);
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
        const double value = (double)p->column[style->radius_by == BP_RADIUS_COLUMN][i];
        const double width = job->range[1] - job->range[0];
        if (!isnan(value)) {
            bp_particle_style_map(style, width > 0 ? (value - job->range[0]) / width : 0.5, color);
            return;
        }
        place = 7; /* grey: no value */
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

/* ---- spheres ------------------------------------------------------------------------------------------ */

/* Room for `count` more spheres and `colors` more colours. */
static BpStatus make_room(Job *job, size_t count, size_t colors, BpError *err) {
    BpScene *const scene = job->scene;
    if (count > BP_SPHERES_MAX || scene->sphere_count > BP_SPHERES_MAX - count)
        return bp_fail(err, BP_ERR_SCENE, "found more than %u spheres, expected fewer", BP_SPHERES_MAX);
    if (scene->sphere_count + count > job->capacity) {
        size_t capacity = scene->sphere_count + count;
        if (job->capacity > 0 && capacity < job->capacity + job->capacity / 2)
            capacity = job->capacity + job->capacity / 2;
        const size_t bytes = (capacity + 1) * sizeof(BpSphere);
        BpSphere *const spheres = bp_large_pages(realloc(scene->spheres, bytes), bytes);
        if (spheres == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for %zu spheres", capacity);
        scene->spheres = spheres;
        job->capacity = capacity;
    }
    if (scene->albedo_count + colors > job->albedo_capacity) {
        size_t capacity = scene->albedo_count + colors;
        if (job->albedo_capacity > 0 && capacity < job->albedo_capacity + job->albedo_capacity / 2)
            capacity = job->albedo_capacity + job->albedo_capacity / 2;
        const size_t bytes = (capacity + 1) * sizeof *scene->albedos;
        float(*const albedos)[3] = bp_large_pages(realloc(scene->albedos, bytes), bytes);
        if (albedos == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for %zu colours", capacity);
        scene->albedos = albedos;
        job->albedo_capacity = capacity;
    }
    return BP_OK;
}

static bool has_albedos(const Job *job) {
    return bp_material_has(job->scene->materials[job->material].kind, BP_MEMBER_ALBEDO);
}

/* Sphere `place` of those that follow the scene's own, and colour `color_place`; with room for both. NULL:
 * the colour is there already. */
static void fill_sphere(const Job *job, size_t place, const double center[3], double radius,
                        size_t color_place, const double color[3]) {
    const BpScene *const scene = job->scene;
    const size_t albedo = scene->albedo_count + color_place;
    BpSphere *const sphere = &scene->spheres[scene->sphere_count + place];
    *sphere = (BpSphere){.radius = radius, .material = job->material, .albedo = BP_NO_ALBEDO};
    memcpy(sphere->center, center, sizeof sphere->center);
    if (!has_albedos(job)) return;
    for (int c = 0; c < 3 && color != NULL; c++)
        scene->albedos[albedo][c] = color[c] > 0 ? color[c] < 1 ? (float)color[c] : 1.0f : 0.0f;
    sphere->albedo = (uint32_t)albedo;
}

static void count_spheres(Job *job, size_t count, size_t colors) {
    job->scene->sphere_count += count;
    if (has_albedos(job)) job->scene->albedo_count += colors;
}

/* After make_room. */
static void put_sphere(Job *job, const double center[3], double radius, const double color[3]) {
    fill_sphere(job, 0, center, radius, 0, color);
    count_spheres(job, 1, 1);
}

/* Particles become spheres block by block, on all threads: those without a radius are found first, which says
 * where the spheres of each block belong. */
typedef struct Blocks {
    Job *job;
    size_t *places; /* of each block: how many particles are shown, then the place of its first */
    bool one_color; /* of all: then there is one entry for it, which caches hold */
} Blocks;

static void find_radii(void *context, uint32_t block, unsigned worker) {
    (void)worker;
    const Blocks *const blocks = context;
    Job *const job = blocks->job;
    for (size_t i = bp_block_begin(block); i < bp_block_end(block, job->p->count); i++) {
        if (!job->shown[i]) continue;
        const double radius = radius_of(job, i);
        /* As in scenes; NaN, 0 and below: nothing to see. */
        job->shown[i] = radius > 1e-37 && radius <= BP_COORDINATE_MAX;
        blocks->places[block] += job->shown[i];
    }
}

static void fill_spheres(void *context, uint32_t block, unsigned worker) {
    (void)worker;
    const Blocks *const blocks = context;
    const Job *const job = blocks->job;
    size_t place = blocks->places[block];
    for (size_t i = bp_block_begin(block); i < bp_block_end(block, job->p->count); i++) {
        double color[3];
        if (!job->shown[i]) continue;
        if (!blocks->one_color || place == 0) color_of(job, i, color);
        fill_sphere(job, place, job->p->position[i], radius_of(job, i), blocks->one_color ? 0 : place,
                    !blocks->one_color || place == 0 ? color : NULL);
        place++;
    }
}

static BpStatus put_particles(Job *job, BpError *err) {
    const BpParticles *const p = job->p;
    const uint32_t block_count = bp_block_count(p->count);
    size_t put = 0;
    const size_t first = job->scene->sphere_count;
    const bool one_color = job->color_by == BP_COLOR_CONSTANT && job->style->color_count == 0;
    BP_TRY(make_room(job, job->shown_count, one_color ? 1 : job->shown_count, err));
    Blocks blocks = {job, calloc((size_t)block_count + 1, sizeof *blocks.places), one_color};
    BpTeam *team = bp_team_create(block_count > 1 ? 0 : 1);
    if (blocks.places == NULL || team == NULL) {
        free(blocks.places);
        bp_team_destroy(&team);
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for %zu particles", p->count);
    }
    bp_team_run(team, find_radii, &blocks, block_count);
    for (uint32_t b = 0; b < block_count; b++) {
        const size_t here = blocks.places[b];
        blocks.places[b] = put;
        put += here;
    }
    bp_team_run(team, fill_spheres, &blocks, block_count);
    bp_team_destroy(&team);
    free(blocks.places);
    count_spheres(job, put, one_color && put > 0 ? 1 : put);
    const size_t without = job->shown_count - put;
    char number[32];
    if (without > 0)
        say(job, "left out: %s without a radius above 0", bp_format_whole(without, number, sizeof number));
    if (job->scene->sphere_count == first)
        return bp_fail(err, BP_ERR_SCENE, "found no particle to show, expected one at least");
    return BP_OK;
}

/* Whether light goes into the spheres of a material, so that what they hide could be seen. */
static bool is_seen_through(const Job *job) {
    return bp_material_is(job->scene->materials[job->material].kind, BP_HAS_INSIDE);
}

/* A row of beads from a to b, excluding both ends, `spacing` radii apart or less: 1/4 makes an outline that
 * dips by 0.8 %, 1/8 one that dips by 0.2 %. Beads inside of a ball of radius `ball` around `hidden_in`
 * are left out; NULL: there is none. */
static BpStatus put_beads(Job *job, const double a[3], const double b[3], double radius, double spacing,
                          const double color[3], const double *hidden_in, double ball, BpError *err) {
    const double length =
        sqrt((b[0] - a[0]) * (b[0] - a[0]) + (b[1] - a[1]) * (b[1] - a[1]) + (b[2] - a[2]) * (b[2] - a[2]));
    const double wanted = ceil(length / (spacing * radius));
    const size_t count = wanted < BEADS_MAX ? (size_t)fmax(wanted, 1) : BEADS_MAX;
    BP_TRY(make_room(job, count, count, err));
    for (size_t i = 0; i < count; i++) {
        const double t = ((double)i + 0.5) / (double)count;
        double place[3], squared = 0;
        for (int c = 0; c < 3; c++) {
            place[c] = a[c] + t * (b[c] - a[c]);
            if (hidden_in != NULL) squared += (place[c] - hidden_in[c]) * (place[c] - hidden_in[c]);
        }
        if (hidden_in != NULL && sqrt(squared) + 1.001 * radius < ball) continue;
        put_sphere(job, place, radius, color);
    }
    return BP_OK;
}

/* Says how many bonds there are, and how many of them, `drawn` and `given` of these, are seen. */
static void say_bonds(Job *job, size_t drawn, size_t given, size_t across) {
    char number[32], other[32], beside[64] = "";
    if (across > 0)
        snprintf(beside, sizeof beside, ", %s across the cell not drawn",
                 bp_format_whole(across, other, sizeof other));
    bp_format_whole(drawn, number, sizeof number);
    if (given == drawn && job->p->bond_count > 0)
        say(job, "%s bonds%s", number, beside);
    else if (given == 0)
        say(job, "%s bonds by distance%s", number, beside);
    else
        say(job, "%s bonds, %s of them given by the file, the others by distance%s", number,
            bp_format_whole(given, other, sizeof other), beside);
    if (job->p->bonds_left_out > 0)
        say(job, "left out: %s connections to atoms that are missing or share their number",
            bp_format_whole(job->p->bonds_left_out, number, sizeof number));
}

/* Each half in the colour of its end. Bonds across the cell are left out, since their ends lie apart. */
static BpStatus put_bonds(Job *job, BpError *err) {
    const BpParticles *const p = job->p;
    const bool molecules = p->angstrom > 0 && p->has_element;
    const bool clear = is_seen_through(job);
    size_t drawn = 0, given = 0, across = 0;
    for (size_t i = 0; i < job->bonds.count; i++) {
        const BpBond *const bond = &job->bonds.bond[i];
        const uint32_t a = bond->a, b = bond->b;
        double middle[3], color[3];
        if (!job->shown[a] || !job->shown[b]) continue;
        if (bond->image[0] != 0 || bond->image[1] != 0 || bond->image[2] != 0) {
            across++;
            continue;
        }
        for (int c = 0; c < 3; c++) middle[c] = (p->position[a][c] + p->position[b][c]) / 2;
        double radius = job->style->bond_radius;
        if (radius == 0)
            radius =
                molecules ? STICK_ANGSTROM * p->angstrom : 0.4 * fmin(radius_of(job, a), radius_of(job, b));
        for (int side = 0; side < 2; side++) {
            const uint32_t end = side == 0 ? a : b;
            const double *const place = p->position[end];
            color_of(job, end, color);
            BP_TRY(put_beads(job, side == 0 ? place : middle, side == 0 ? middle : place, radius, 0.125,
                             color, clear ? NULL : place, radius_of(job, end), err));
        }
        drawn++;
        given += i < job->bonds.given;
    }
    say_bonds(job, drawn, given, across);
    return BP_OK;
}

static BpStatus put_box(Job *job, BpError *err) {
    static const double color[3] = {0.12, 0.12, 0.12};
    const BpParticles *const p = job->p;
    if (!p->has_cell)
        return bp_fail(err, BP_ERR_SCENE, "found no cell in the file, expected one for \"box\": true");
    double longest = 0;
    for (int e = 0; e < 3; e++)
        longest = fmax(longest, sqrt(p->cell[e][0] * p->cell[e][0] + p->cell[e][1] * p->cell[e][1] +
                                     p->cell[e][2] * p->cell[e][2]));
    for (int e = 0; e < 3; e++) {
        for (int corner = 0; corner < 4; corner++) { /* the four edges along edge e */
            double a[3], b[3];
            for (int c = 0; c < 3; c++) {
                a[c] = p->cell_origin[c] + (corner & 1) * p->cell[(e + 1) % 3][c] +
                       (corner >> 1) * p->cell[(e + 2) % 3][c];
                b[c] = a[c] + p->cell[e][c];
            }
            BP_TRY(put_beads(job, a, b, EDGE_SHARE * longest, 0.25, color, NULL, 0, err));
        }
    }
    for (int corner = 0; corner < 8; corner++) {
        double place[3];
        for (int c = 0; c < 3; c++)
            place[c] = p->cell_origin[c] + (corner & 1) * p->cell[0][c] + (corner >> 1 & 1) * p->cell[1][c] +
                       (corner >> 2) * p->cell[2][c];
        BP_TRY(make_room(job, 1, 1, err));
        put_sphere(job, place, EDGE_SHARE * longest * 1.0001, color);
    }
    return BP_OK;
}

/* Files of three columns hold two dimensions too. */
static void find_flat(Job *job) {
    BpParticles *const p = job->p;
    double low = INFINITY, high = -INFINITY;
    for (size_t i = 0; i < p->count; i++) {
        if (!job->shown[i]) continue;
        low = p->position[i][2] < low ? p->position[i][2] : low;
        high = p->position[i][2] > high ? p->position[i][2] : high;
        if (high > low) break;
    }
    p->flat |= job->shown_count > 2 && high == low;
}

static BpStatus run(Job *job, BpError *err) {
    BpParticles *const p = job->p;
    char all[32], shown[32];
    BP_TRY(choose_shown(job, err));
    if (p->notes[0] != '\0') say(job, "%s", p->notes);
    const bool bonds = job->style->bonds || job->style->kind == BP_STYLE_BALL_AND_STICK;
    const bool whole = job->style->whole && bp_particles_repeat(p) && (p->bond_count > 0 || p->has_element);
    if (bonds || whole) BP_TRY(bp_bonds_find(p, job->shown, &job->bonds, err));
    if (job->bonds.crowded)
        say(job, "no bonds by distance, since atoms lie in each other; is their unit of length right?");
    size_t moved = 0;
    if (whole) BP_TRY(bp_molecules_make_whole(p, job->shown, &job->bonds, &moved, err));
    if (moved > 0)
        say(job, "molecules made whole across the cell: %s moved", bp_format_whole(moved, all, sizeof all));
    find_flat(job);
    BP_TRY(choose_radii(job, err));
    BP_TRY(choose_colors(job, err));
    BP_TRY(put_particles(job, err));
    if (bonds) BP_TRY(put_bonds(job, err));
    if (job->style->box) BP_TRY(put_box(job, err));
    if (job->summary != NULL) { /* the counts come first, and are known last */
        char rest[768];
        snprintf(rest, sizeof rest, "%s", job->summary);
        bp_format_whole(p->count, all, sizeof all);
        bp_format_whole(job->shown_count, shown, sizeof shown);
        if (job->shown_count == p->count)
            snprintf(job->summary, job->size, "%s particle%s%s%s", all, bp_plural(p->count),
                     rest[0] != '\0' ? "; " : "", rest);
        else
            snprintf(job->summary, job->size, "%s of %s particles%s%s", shown, all,
                     rest[0] != '\0' ? "; " : "", rest);
    }
    return BP_OK;
}

BpStatus bp_particles_add_to_scene(BpParticles *particles, const BpParticleStyle *style, uint32_t material,
                                   BpScene *scene, char *summary, size_t size, double range[2],
                                   BpError *err) {
    Job job = {.p = particles,
               .style = style,
               .scene = scene,
               .material = material,
               .summary = summary,
               .size = size};
    if (summary != NULL) summary[0] = '\0';
    bp_linear_of_bytes(job.linear);
    const BpStatus status = run(&job, err);
    if (range != NULL) memcpy(range, job.range, sizeof job.range);
    free(job.shown);
    free(job.rank);
    free(job.bonds.bond);
    return status;
}
