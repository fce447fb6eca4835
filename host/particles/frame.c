/* frame.c: where readers put points; see reader.h and particles.h. */
#include "column_names.h"
#include "reader.h"

#include "base/format.h"
#include "base/message_text.h"
#include "base/pages.h"
#include "base/plural.h"
#include "names.h"
#include "scene/vector.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#define COORDINATE_MAX 1.0e12 /* that of a scene */
#define SHORTEST_EDGE 1.0e-30 /* of a cell */
#define FLATTEST 1.0e-9       /* the volume of a cell, of that which edges at right angles span */
#define PI 3.14159265358979323846

enum { FIRST_CAPACITY = 4096 };

static void free_arrays(BpParticles *p) {
    free(p->position);
    free(p->tag);
    free(p->radius);
    free(p->color);
    free(p->body);
    for (size_t s = 0; s < p->shape_count; s++) particle_shape_clear(&p->shapes[s]);
    free(p->shapes);
    for (int i = 0; i < BP_PARTICLE_WANTED_MAX; i++) free(p->column[i]);
    for (size_t c = 0; c < p->column_count; c++) free(p->column_names[c]);
    free(p->column_names);
    free(p->gone);
    free(p->bonds);
    names_clear(&p->names);
}

void bp_particles_clear(BpParticles *particles) {
    free_arrays(particles);
    *particles = (BpParticles){0};
}

void bp_particles_note(BpParticles *particles, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    bp_notes_add(particles->notes, sizeof particles->notes, format, arguments);
    va_end(arguments);
}

/* Where a wanted column is; below 0: nowhere, if it need not be there. */
static BpStatus find_column(const BpParticleFile *file, const char *const *columns, size_t column_count,
                            size_t wanted, int *place, BpError *err) {
    char list[384] = "", shown[64];
    bp_printable(file->wanted[wanted], shown, sizeof shown);
    for (size_t c = 0; c < column_count; c++) {
        if (strcmp(file->wanted[wanted], columns[c]) != 0) continue;
        if (*place >= 0)
            return input_fail(&file->input, false, err, "found two columns \"%s\", expected one", shown);
        *place = (int)c;
    }
    if (*place >= 0 || wanted >= file->needed) return BP_OK;
    for (size_t c = 0; c < column_count; c++) {
        const size_t used = strlen(list);
        bp_printable(columns[c], shown, sizeof shown);
        snprintf(list + used, sizeof list - used, "%s%s", c > 0 ? ", " : "", shown);
    }
    bp_printable(file->wanted[wanted], shown, sizeof shown);
    return input_fail(&file->input, false, err, "found no column \"%s\", expected one of %s", shown,
                      column_count > 0 ? list : "none: this file has no columns of numbers");
}

static BpStatus keep_names(BpParticles *p, const char *const *columns, size_t count, BpError *err) {
    p->column_names = calloc(count + 1, sizeof *p->column_names);
    while (p->column_names != NULL && p->column_count < count) {
        char *const copy = strdup(columns[p->column_count]);
        if (copy == NULL) break;
        p->column_names[p->column_count++] = copy;
    }
    return p->column_count == count && p->column_names != NULL
               ? BP_OK
               : bp_fail(err, BP_ERR_MEMORY, "out of memory for the names of columns");
}

BpStatus frame_begin(BpParticleFile *file, const char *const *columns, size_t column_count, BpError *err) {
    file->added = 0;
    file->gone_count = 0;
    file->colors = (ColorRange){0};
    memset(&file->shapes, 0, sizeof file->shapes);
    file->taken_count = 0;
    if (file->out == NULL) return BP_OK; /* a frame that is passed over may lack the columns */
    for (size_t w = 0; w < file->wanted_count; w++) {
        int place = -1;
        BP_TRY(find_column(file, columns, column_count, w, &place, err));
        if (place < 0) continue;
        file->wanted_column[file->taken_count] = place;
        file->wanted_place[file->taken_count++] = w;
    }
    BpParticles *const p = file->out;
    free_arrays(p);
    *p = (BpParticles){.up = 1};
    if (file->wanted_count > file->needed) BP_TRY(keep_names(p, columns, column_count, err));
    const char *const unread = column_single_color(columns, column_count);
    bp_printable(unread != NULL ? unread : "", file->unread_color, sizeof file->unread_color);
    const char *const axis = column_unread_shape(columns, column_count);
    bp_printable(axis != NULL ? axis : "", file->unread_shape, sizeof file->unread_shape);
    return BP_OK;
}

static bool resize(void *array, size_t capacity, size_t size) {
    void **const place = array;
    void *const grown = bp_large_pages(realloc(*place, capacity * size), capacity * size);
    if (grown != NULL) *place = grown;
    return grown != NULL;
}

static bool grow(BpParticleFile *file, BpParticles *p) {
    const size_t capacity = p->capacity > 0 ? p->capacity + p->capacity / 2 : FIRST_CAPACITY;
    bool good =
        resize(&p->position, capacity, sizeof *p->position) && resize(&p->tag, capacity, sizeof *p->tag);
    if (p->radius != NULL) good = good && resize(&p->radius, capacity, sizeof *p->radius);
    if (p->color != NULL) good = good && resize(&p->color, capacity, sizeof *p->color);
    if (p->body != NULL) good = good && resize(&p->body, capacity, sizeof *p->body);
    for (size_t k = 0; k < file->taken_count; k++)
        good = good && resize(&p->column[file->wanted_place[k]], capacity, sizeof *p->column[0]);
    if (good) p->capacity = capacity;
    return good;
}

/* Makes room for radii: none, for the particles so far. */
static BpStatus have_radii(BpParticles *p, BpError *err) {
    if (p->radius != NULL) return BP_OK;
    p->radius = malloc(p->capacity * sizeof *p->radius);
    if (p->radius == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for radii");
    for (size_t i = 0; i < p->count; i++) p->radius[i] = NAN;
    return BP_OK;
}

static BpStatus add_radius(BpParticles *p, double radius, BpError *err) {
    if (p->radius == NULL && isnan(radius)) return BP_OK;
    BP_TRY(have_radii(p, err));
    p->radius[p->count] = (float)radius;
    return BP_OK;
}

static BpStatus add_color(BpParticles *p, const double color[3], BpError *err) {
    if (p->color == NULL) {
        if (isnan(color[0])) return BP_OK;
        p->color = malloc(p->capacity * sizeof *p->color);
        if (p->color == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for colours");
        for (size_t i = 0; i < p->count; i++)
            for (int c = 0; c < 3; c++) p->color[i][c] = NAN;
    }
    for (int c = 0; c < 3; c++) p->color[p->count][c] = (float)color[c];
    return BP_OK;
}

static BpStatus add_tag(BpParticles *p, const Particle *particle, BpError *err) {
    BpParticleTag *const tag = &p->tag[p->count];
    *tag = (BpParticleTag){.element = particle->element, .flags = particle->flags};
    BP_TRY(names_number(&p->names, particle->name, &tag->name, err));
    BP_TRY(names_number(&p->names, particle->residue, &tag->residue, err));
    BP_TRY(names_number(&p->names, particle->chain, &tag->chain, err));
    BP_TRY(names_number(&p->names, particle->type, &tag->type, err));
    p->has_residue |= tag->residue != 0;
    p->has_chain |= tag->chain != 0;
    p->has_type |= tag->type != 0;
    p->has_element |= tag->element != 0;
    if ((tag->flags & BP_PARTICLE_ELEMENT_GUESSED) != 0 && !p->element_guessed)
        bp_particles_note(p, "elements from atom names");
    p->element_guessed |= (tag->flags & BP_PARTICLE_ELEMENT_GUESSED) != 0;
    return BP_OK;
}

/* A particle without a place: only its number is kept, by which bonds find that it is gone. */
static BpStatus leave_out(BpParticleFile *file, BpError *err) {
    if (file->gone_count == file->gone_capacity) {
        const size_t capacity = file->gone_capacity > 0 ? 2 * file->gone_capacity : FIRST_CAPACITY;
        if (!resize(&file->gone, capacity, sizeof *file->gone))
            return bp_fail(err, BP_ERR_MEMORY, "out of memory for %zu points without a place", capacity);
        file->gone_capacity = capacity;
    }
    file->gone[file->gone_count++] = (uint32_t)(file->added - 1);
    return BP_OK;
}

static BpStatus take_color(BpParticleFile *file, const double color[3], bool with_line, BpError *err) {
    char text[BP_NUMBER_TEXT_SIZE];
    int channel = 0;
    if (isnan(color[0]) && isnan(color[1]) && isnan(color[2])) return BP_OK;
    if (color_range_take(&file->colors, color, file->added - 1, with_line ? file->input.line : 0, &channel))
        return BP_OK;
    return input_fail(&file->input, with_line, err, "particle %zu (from 0): %s: found %s, expected %s",
                      file->added - 1, bp_color_channels[channel], bp_number_text(color[channel], text),
                      color_range_expected(&file->colors));
}

BpStatus frame_add(BpParticleFile *file, const Particle *particle, bool with_line, BpError *err) {
    BpParticles *const p = file->out;
    const double *const place = particle->position;
    for (int i = 0; i < 3; i++) {
        char text[BP_NUMBER_TEXT_SIZE];
        if (fabs(place[i]) <= COORDINATE_MAX || isnan(place[i])) continue;
        return input_fail(&file->input, with_line, err,
                          "particle %zu (from 0): found %s, expected a coordinate from -1e12 to 1e12",
                          file->added, bp_number_text(particle->position[i], text));
    }
    if (file->added >= BP_PARTICLES_MAX)
        return input_fail(&file->input, with_line, err,
                          "found more particles, expected at most %u in a frame", BP_PARTICLES_MAX);
    file->added++;
    if (p == NULL) return BP_OK;
    if (!particle_has_place(particle)) return leave_out(file, err);
    BP_TRY(take_color(file, particle->color, with_line, err));
    if (p->count == p->capacity && !grow(file, p))
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for more than %zu particles", p->count);
    const BpStatus status = add_tag(p, particle, err);
    if (status == BP_ERR_SCENE) bp_error_at(err, file->input.name, (int)file->input.line, 0);
    BP_TRY(status);
    Particle shaped = *particle;
    BP_TRY(frame_add_body(file, &shaped, with_line, err));
    BP_TRY(add_radius(p, shaped.radius, err));
    BP_TRY(add_color(p, particle->color, err));
    memcpy(p->position[p->count], particle->position, sizeof p->position[0]);
    for (size_t k = 0; k < file->taken_count; k++) {
        double **const column = &p->column[file->wanted_place[k]];
        if (*column == NULL) *column = malloc(p->capacity * sizeof **column);
        if (*column == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for a column");
        (*column)[p->count] = particle->values[file->wanted_column[k]];
    }
    p->count++;
    return BP_OK;
}

uint32_t frame_place(const BpParticleFile *file, uint32_t number) {
    size_t low = 0, high = file->gone_count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (file->gone[middle] < number)
            low = middle + 1;
        else
            high = middle;
    }
    return low < file->gone_count && file->gone[low] == number ? UINT32_MAX : number - (uint32_t)low;
}

BpStatus frame_set_radius(BpParticleFile *file, uint32_t number, double radius, BpError *err) {
    BpParticles *const p = file->out;
    if (p == NULL || !(radius > 0)) return BP_OK;
    const uint32_t at = frame_place(file, number);
    if (at >= p->count) return BP_OK;
    BP_TRY(have_radii(p, err));
    p->radius[at] = (float)radius;
    return BP_OK;
}

BpStatus frame_add_bond(BpParticleFile *file, uint32_t a, uint32_t b, BpError *err) {
    BpParticles *const p = file->out;
    if (p == NULL) return BP_OK;
    a = frame_place(file, a);
    b = frame_place(file, b);
    if (a == UINT32_MAX || b == UINT32_MAX) {
        p->bonds_left_out++;
        return BP_OK;
    }
    if (p->bond_count == p->bond_capacity) {
        const size_t capacity = p->bond_capacity > 0 ? 2 * p->bond_capacity : FIRST_CAPACITY;
        if (!resize(&p->bonds, capacity, sizeof *p->bonds))
            return bp_fail(err, BP_ERR_MEMORY, "out of memory for %zu bonds", capacity);
        p->bond_capacity = capacity;
    }
    p->bonds[p->bond_count][0] = a;
    p->bonds[p->bond_count++][1] = b;
    return BP_OK;
}

BpStatus frame_end(BpParticleFile *file, BpError *err) {
    BpParticles *const p = file->out;
    const ColorRange *const colors = &file->colors;
    char number[32];
    if (p == NULL) return BP_OK;
    if (file->gone_count > 0)
        bp_particles_note(p, "%s point%s without a place left out",
                          bp_format_whole(file->gone_count, number, sizeof number),
                          bp_plural(file->gone_count));
    if (file->gone_count > 0) {
        p->gone = malloc(file->gone_count * sizeof *p->gone);
        if (p->gone == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for points without a place");
        memcpy(p->gone, file->gone, file->gone_count * sizeof *p->gone);
        p->gone_count = file->gone_count;
    }
    frame_end_shapes(file);
    if (file->unread_shape[0] != '\0' && file->needed == 0)
        bp_particles_note(p, "%s particle%s drawn as %s, since axes such as \"%s\" are not read",
                          bp_format_whole(p->count, number, sizeof number), bp_plural(p->count),
                          p->count == 1 ? "a sphere" : "spheres", file->unread_shape);
    if (p->color == NULL && file->unread_color[0] != '\0' && file->needed == 0)
        bp_particles_note(p, "no colours from \"%s\", since red, green and blue must be columns",
                          file->unread_color);
    if (p->color == NULL) return BP_OK;
    const double scale = color_range_scale(colors);
    if (scale == 0) return color_range_fail(colors, "particle", file->input.name, err);
    color_range_make_linear(scale, p->color, p->count);
    const char *const note = color_range_note(colors);
    if (note != NULL) bp_particles_note(p, "%s", note);
    return BP_OK;
}

bool bp_particles_repeat(const BpParticles *particles) {
    return particles->periodic[0] || particles->periodic[1] || particles->periodic[2];
}

/* Whether the edges that repeat lie in as many dimensions as they are, and not nearly in fewer. */
static bool is_spanned(const double edges[3][3], const bool periodic[3]) {
    double unit[3][3] = {{0}}, measure = 1;
    for (int e = 0; e < 3; e++) { /* the parts at right angles to the edges before (Gram, Schmidt) */
        if (!periodic[e]) continue;
        const double length = bp_length(edges[e]);
        for (int i = 0; i < 3; i++) unit[e][i] = edges[e][i] / length;
        for (int f = 0; f < e; f++) {
            double along = 0;
            for (int i = 0; i < 3; i++) along += unit[e][i] * unit[f][i];
            for (int i = 0; i < 3; i++) unit[e][i] -= along * unit[f][i];
        }
        const double rest = bp_length(unit[e]);
        measure *= rest;
        for (int i = 0; i < 3; i++) unit[e][i] /= rest > 0 ? rest : 1;
    }
    return measure > FLATTEST;
}

void frame_cell(BpParticleFile *file, const double origin[3], const double edges[3][3],
                const bool periodic[3]) {
    BpParticles *const p = file->out;
    if (p == NULL) return;
    double longest = 0;
    bool good = true; /* fmax() ignores NaN */
    for (int i = 0; i < 3; i++) {
        const double length = bp_length(edges[i]);
        good &= length <= COORDINATE_MAX && fabs(origin[i]) <= COORDINATE_MAX;
        longest = fmax(longest, length);
    }
    if (good && longest <= SHORTEST_EDGE) return; /* the cell of a file that has none */
    if (!good) {
        bp_particles_note(p, "a cell that is not finite, or larger than 1e12, left out");
        return;
    }
    p->has_cell = true;
    for (int i = 0; i < 3; i++) p->periodic[i] = periodic[i] && bp_length(edges[i]) > SHORTEST_EDGE;
    if (!is_spanned(edges, p->periodic)) {
        for (int i = 0; i < 3; i++) p->periodic[i] = false;
        bp_particles_note(p, "the cell is flat, so nothing repeats");
    }
    memcpy(p->cell_origin, origin, sizeof p->cell_origin);
    memcpy(p->cell, edges, sizeof p->cell);
}

bool frame_edges_of_angles(const double lengths[3], const double angles[3], double edges[3][3]) {
    const double a = lengths[0], b = lengths[1], c = lengths[2];
    double cosine[3];
    for (int i = 0; i < 3; i++)
        cosine[i] = angles[i] == 90 ? 0 : cos(angles[i] * (PI / 180)); /* alpha, beta, gamma */
    const double sine = sqrt(1 - cosine[2] * cosine[2]);
    const double y = (cosine[0] - cosine[1] * cosine[2]) / sine;
    const double z = 1 - cosine[1] * cosine[1] - y * y;
    if (!(a > 0 && b > 0 && c > 0 && sine > 0 && z > 0)) return false;
    const double found[3][3] = {{a, 0, 0}, {b * cosine[2], b * sine, 0}, {c * cosine[1], c * y, c * sqrt(z)}};
    memcpy(edges, found, sizeof found);
    return true;
}

void frame_cell_angles(BpParticleFile *file, const double lengths[3], const double angles[3]) {
    static const double origin[3] = {0, 0, 0};
    double edges[3][3];
    if (lengths[0] > 1 && lengths[1] > 1 && lengths[2] > 1 && frame_edges_of_angles(lengths, angles, edges))
        frame_cell(file, origin, (const double(*)[3])edges, FRAME_PERIODIC);
}

const char *frame_line_behind(BpParticleFile *file, char text[1024]) {
    char *line = NULL;
    BpError later = {0};
    const BpStatus status = input_full_line(&file->input, &line, &later);
    bp_error_clear(&later);
    if (status != BP_OK || line == NULL) return NULL;
    snprintf(text, 1024, "%s", line);
    input_hold(&file->input, line);
    return text;
}

BpStatus frame_fail_behind(BpParticleFile *file, const char *number, BpError *err) {
    file->behind = BEHIND_PARTICLES;
    file->input.line++; /* the line that is held */
    return input_fail(&file->input, true, err,
                      "found more atoms than %s, expected another frame or the end of the file: correct "
                      "that number",
                      number);
}
