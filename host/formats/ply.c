/* ply.c: the vertices of a PLY file; see ply.h. */
#include "ply.h"

#include "base/format.h"
#include "base/message_text.h"
#include "base/plural.h"
#include "particles/color_range.h"
#include "particles/ply_rows.h"
#include "scene/material.h"
#include "scene/scene_fault.h"

#include <inttypes.h>
#include <limits.h>
#include <locale.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct Reader {
    Input input;
    PlyHeader header;
    const BpPlyOptions *options;
    BpScene *scene;
    uint64_t size;  /* of the file, in bytes */
    BpSphere *next; /* where the next sphere goes */
    float (*next_albedo)[3];
    uint32_t albedo_number; /* of next_albedo */
    ColorRange colors;
    uint64_t left_out; /* points without a place */
    int material;      /* which property it is; -1: none that counts */
} Reader;

/* ---- one point ---------------------------------------------------------------------------------------- */

static BpStatus fail_vertex(const Reader *r, uint64_t number, const char *member, const char *text,
                            BpError *err) {
    return input_fail(&r->input, r->header.form == PLY_ASCII, err, "vertex %" PRIu64 " (from 0): %s%s%s",
                      number, member, member[0] != '\0' ? ": " : "", text);
}

static BpStatus fail_value(const Reader *r, uint64_t number, const char *member, double value,
                           const char *expected, BpError *err) {
    char found[BP_NUMBER_TEXT_SIZE], text[160];
    snprintf(text, sizeof text, "found %s, expected %s", bp_number_text(value, found), expected);
    return fail_vertex(r, number, member, text, err);
}

/* The numbers as they are: what they mean is known after the last. */
static BpStatus store_colour(Reader *r, uint64_t number, const double *values, BpError *err) {
    const int *const place = r->header.color;
    const double color[3] = {values[place[0]], values[place[1]], values[place[2]]};
    const uint64_t line = r->header.form == PLY_ASCII ? r->input.line : 0;
    int channel = 0;
    if (!color_range_take(&r->colors, color, number, line, &channel))
        return fail_value(r, number, bp_color_channels[channel], color[channel],
                          color_range_expected(&r->colors), err);
    for (int i = 0; i < 3; i++) (*r->next_albedo)[i] = (float)color[i];
    return BP_OK;
}

static BpStatus store(Reader *r, uint64_t number, const double *values, BpError *err) {
    static const char *const axes[3] = {"x", "y", "z"};
    const PlyHeader *const header = &r->header;
    BpSphere sphere = {.radius = header->radius >= 0 ? header->radius_scale * values[header->radius]
                                                     : r->options->radius,
                       .material = r->options->material,
                       .albedo = BP_NO_ALBEDO};
    BpFault fault;
    for (int i = 0; i < 3; i++) sphere.center[i] = values[header->place[i]];
    if (isnan(sphere.center[0]) || isnan(sphere.center[1]) || isnan(sphere.center[2])) {
        r->left_out++;
        return BP_OK;
    }
    for (int i = 0; i < 3; i++) {
        if (!isfinite(sphere.center[i]))
            return fail_value(r, number, axes[i], sphere.center[i],
                              "a coordinate: remove or correct the point", err);
    }
    if (bp_sphere_find_fault(&sphere, &fault)) return fail_vertex(r, number, fault.member, fault.text, err);
    if (r->material >= 0) {
        const double m = values[r->material];
        if (!(m >= 0 && m < (double)r->options->material_count && m == floor(m)))
            return fail_value(r, number, "material", m,
                              "a place in the cloud's \"materials\", counted from 0", err);
        sphere.material = r->options->materials[(size_t)m];
    }
    if (header->color[0] >= 0) {
        BP_TRY(store_colour(r, number, values, err));
        if (bp_material_has(r->scene->materials[sphere.material].kind, BP_MEMBER_ALBEDO)) {
            sphere.albedo = r->albedo_number++;
            r->next_albedo++;
        }
    }
    *r->next++ = sphere;
    return BP_OK;
}

/* ---- the whole ---------------------------------------------------------------------------------------- */

/* Room for all points, once their number has been compared with what is left of the file. */
static BpStatus make_room(Reader *r, uint64_t count, BpError *err) {
    BpScene *scene = r->scene;
    const PlyElement *vertex = &r->header.elements[r->header.vertex];
    /* In ASCII a number takes a digit and a blank, but for the last. */
    const uint64_t row_size = r->header.form == PLY_ASCII ? 2 * vertex->property_count : vertex->row_size;
    const uint64_t left = r->size > r->input.taken ? r->size - r->input.taken + 1 : 0;
    if (count > left / row_size)
        return input_fail(&r->input, false, err,
                          "found space for %" PRIu64 " rows of vertices, expected %" PRIu64
                          "; the file is truncated",
                          left / row_size, count);
    if (count > BP_SPHERES_MAX - scene->sphere_count)
        return input_fail(&r->input, false, err,
                          "found %" PRIu64 " point%s more, expected at most %u spheres in a scene", count,
                          bp_plural(count), BP_SPHERES_MAX);
    BpSphere *spheres = realloc(scene->spheres, (scene->sphere_count + (size_t)count + 1) * sizeof *spheres);
    if (spheres == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for %" PRIu64 " points", count);
    scene->spheres = spheres;
    r->next = spheres + scene->sphere_count;
    if (r->header.color[0] < 0) return BP_OK;
    float(*albedos)[3] = realloc(scene->albedos, (scene->albedo_count + (size_t)count + 1) * sizeof *albedos);
    if (albedos == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for %" PRIu64 " colours", count);
    scene->albedos = albedos;
    r->next_albedo = albedos + scene->albedo_count;
    r->albedo_number = (uint32_t)scene->albedo_count;
    return BP_OK;
}

static BpStatus choose(Reader *r, BpError *err) {
    const PlyHeader *const header = &r->header;
    int material = -1;
    BP_TRY(ply_find_property(&r->input, header, "material", &material, err));
    const PlyProperty *const property = material >= 0 ? ply_property(header, material) : NULL;
    if (property != NULL && !ply_is_integer(property->type)) {
        const BpStatus status =
            bp_fail(err, BP_ERR_SCENE, "material: found a type with a fraction, expected an integer type");
        bp_error_at(err, r->input.name, property->line < INT_MAX ? (int)property->line : INT_MAX, 0);
        return status;
    }
    r->material = r->options->material_count > 0 ? material : -1;
    if (header->radius < 0 && r->options->radius == 0)
        return input_fail(
            &r->input, false, err,
            "found no property radius, expected one, or a \"radius\" for all points in the scene's cloud");
    if (r->material < 0 && r->options->material == BP_PLY_NO_MATERIAL)
        return input_fail(&r->input, false, err,
                          "found no property material, expected one, or a \"material\" for all points in the "
                          "scene's cloud");
    if (header->color[0] >= 0) r->colors = ply_color_range(header);
    return BP_OK;
}

/* Makes the colours that were stored linear, and says what was decided. */
static BpStatus finish(Reader *r, char notes[BP_PLY_NOTES_SIZE], BpError *err) {
    BpScene *const scene = r->scene;
    const double scale = color_range_scale(&r->colors);
    if (r->header.color[0] >= 0 && scale == 0)
        return color_range_fail(&r->colors, "vertex", r->input.name, err);
    if (r->header.color[0] >= 0) {
        color_range_make_linear(scale, scene->albedos + scene->albedo_count,
                                r->albedo_number - scene->albedo_count);
        scene->albedo_count = r->albedo_number;
    }
    scene->sphere_count = (size_t)(r->next - scene->spheres);
    if (notes == NULL) return BP_OK;
    const char *const note = r->header.color[0] >= 0 ? color_range_note(&r->colors) : NULL;
    char left_out[80] = "", number[32];
    if (r->left_out > 0)
        snprintf(left_out, sizeof left_out, "%s point%s without a place left out",
                 bp_format_whole(r->left_out, number, sizeof number), bp_plural(r->left_out));
    snprintf(notes, BP_PLY_NOTES_SIZE, "%s%s%s", left_out, left_out[0] != '\0' && note != NULL ? "; " : "",
             note != NULL ? note : "");
    return BP_OK;
}

static BpStatus read_all(Reader *r, char notes[BP_PLY_NOTES_SIZE], BpError *err) {
    double values[PLY_PROPERTIES_MAX];
    if (input_is_packed(&r->input))
        return input_fail(&r->input, false, err,
                          "found a file packed by gzip, expected a PLY file; unpack it first, or name it in "
                          "\"particles\"");
    BP_TRY(ply_read_header(&r->input, &r->header, err));
    BP_TRY(choose(r, err));
    BP_TRY(ply_begin_points(&r->input, &r->header, err));
    const uint64_t count = r->header.elements[r->header.vertex].count;
    BP_TRY(make_room(r, count, err));
    for (uint64_t row = 0; row < count; row++) {
        BP_TRY(ply_take_point(&r->input, &r->header, row, values, err));
        BP_TRY(store(r, row, values, err));
    }
    BP_TRY(ply_end_points(&r->input, &r->header, err));
    return finish(r, notes, err);
}

BpStatus bp_ply_read(FILE *stream, uint64_t size, const char *name, const BpPlyOptions *options,
                     BpScene *scene, char notes[BP_PLY_NOTES_SIZE], BpError *err) {
    Reader *r = calloc(1, sizeof *r);
    /* Numbers have a point, whatever the caller's locale. */
    const locale_t point = newlocale(LC_NUMERIC_MASK, "C", (locale_t)0);
    BpStatus status = BP_OK;
    if (notes != NULL) notes[0] = '\0';
    if (r == NULL || point == (locale_t)0) {
        status = bp_fail(err, BP_ERR_MEMORY, "out of memory for a PLY file");
        goto done;
    }
    r->options = options;
    r->scene = scene;
    r->size = size;
    BP_TRY_GOTO(status, input_init(&r->input, stream, name, err), done);
    const locale_t before = uselocale(point);
    status = read_all(r, notes, err);
    uselocale(before);
done:
    if (point != (locale_t)0) freelocale(point);
    if (r != NULL) input_clear(&r->input);
    free(r);
    return status;
}
