/* ply.c: the vertices of a PLY file; see ply.h. */
#include "ply.h"

#include "base/color.h"
#include "base/plural.h"
#include "document.h"
#include "ply_parts.h"
#include "scene/material.h"
#include "scene/scene_fault.h"

#include <inttypes.h>
#include <locale.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct Reader {
    PlyInput input;
    PlyHeader header;
    const BpPlyOptions *options;
    BpScene *scene;
    BpSphere *next; /* where the next sphere goes */
    float (*next_albedo)[3];
    uint32_t albedo_number; /* of next_albedo */
    bool swap;              /* the file's byte order is not this machine's */
    bool has_radius, has_colour, has_material;
    float srgb_to_linear[256];
} Reader;

/* ---- one vertex -----------------------------------------------------------------------------------------
 */

static BpStatus fail_vertex(const Reader *r, uint64_t number, const char *member, const char *text,
                            BpError *err) {
    return ply_fail(&r->input, r->header.format == PLY_ASCII, err, "vertex %" PRIu64 " (from 0): %s%s%s",
                    number, member, member[0] != '\0' ? ": " : "", text);
}

static BpStatus fail_value(const Reader *r, uint64_t number, PlyRole role, double value, const char *expected,
                           BpError *err) {
    char found[BP_NUMBER_TEXT_SIZE], text[160];
    snprintf(text, sizeof text, "found %s, expected %s", bp_number_text(value, found), expected);
    return fail_vertex(r, number, ply_role_name(role), text, err);
}

static BpStatus store_colour(Reader *r, uint64_t number, const double *value, BpError *err) {
    for (int i = 0; i < 3; i++) {
        const double v = value[PLY_RED + i];
        if (r->header.role_type[PLY_RED] == PLY_UINT8) {
            if (!(v >= 0 && v <= 255 && v == floor(v)))
                return fail_value(r, number, (PlyRole)(PLY_RED + i), v, "a whole number from 0 to 255", err);
            (*r->next_albedo)[i] = r->srgb_to_linear[(int)v];
        } else {
            if (!(v >= 0 && v <= 1))
                return fail_value(r, number, (PlyRole)(PLY_RED + i), v, "a linear share of light from 0 to 1",
                                  err);
            (*r->next_albedo)[i] = (float)v;
        }
    }
    return BP_OK;
}

static BpStatus store(Reader *r, uint64_t number, const double value[PLY_ROLE_COUNT], BpError *err) {
    BpSphere sphere = {.center = {value[PLY_X], value[PLY_Y], value[PLY_Z]},
                       .radius = r->has_radius ? value[PLY_RADIUS] : r->options->radius,
                       .material = r->options->material,
                       .albedo = BP_NO_ALBEDO};
    BpFault fault;
    for (int i = PLY_X; i <= PLY_Z; i++) {
        if (!isfinite(value[i]))
            return fail_value(r, number, (PlyRole)i, value[i], "a coordinate: remove or correct the point",
                              err);
    }
    if (bp_sphere_find_fault(&sphere, &fault)) return fail_vertex(r, number, fault.member, fault.text, err);
    if (r->has_material) {
        const double m = value[PLY_MATERIAL];
        if (!(m >= 0 && m < (double)r->options->material_count && m == floor(m)))
            return fail_value(r, number, PLY_MATERIAL, m,
                              "a place in the cloud's \"materials\", counted from 0", err);
        sphere.material = r->options->materials[(size_t)m];
    }
    if (r->has_colour) {
        BP_TRY(store_colour(r, number, value, err));
        if (bp_material_has(r->scene->materials[sphere.material].kind, BP_MEMBER_ALBEDO)) {
            sphere.albedo = r->albedo_number++;
            r->next_albedo++;
        }
    }
    *r->next++ = sphere;
    return BP_OK;
}

/* ---- binary ---------------------------------------------------------------------------------------------
 */

static BpStatus fail_end(const Reader *r, uint64_t row, BpError *err) {
    return ply_fail(&r->input, false, err,
                    "found the end of the file in row %" PRIu64 " of an element, expected all its "
                    "rows; the file is truncated",
                    row);
}

static BpStatus fail_count(const Reader *r, bool with_line, uint64_t row, double number, BpError *err) {
    char found[BP_NUMBER_TEXT_SIZE];
    return ply_fail(&r->input, with_line, err,
                    "row %" PRIu64
                    " (from 0): found %s as the length of a list, expected a whole number of at "
                    "least 0",
                    row, bp_number_text(number, found));
}

/* One row with lists, property by property. `value`: Optional. */
static BpStatus take_row(Reader *r, const PlyElement *element, uint64_t row, double *value, BpError *err) {
    for (size_t i = 0; i < element->property_count; i++) {
        const PlyProperty *p = &r->header.properties[element->first_property + i];
        const PlyType type = p->count_type != PLY_NONE ? p->count_type : p->type;
        const size_t size = ply_type_size(type);
        if (!ply_input_fill(&r->input, size)) return fail_end(r, row, err);
        const double number = ply_decode(r->input.buffer + r->input.begin, type, r->swap);
        ply_input_take(&r->input, size);
        if (p->count_type == PLY_NONE) {
            if (value != NULL && p->role != PLY_NO_ROLE) value[p->role] = number;
        } else if (number < 0) {
            return fail_count(r, false, row, number, err);
        } else if (!ply_input_skip(&r->input, (uint64_t)number * ply_type_size(p->type))) {
            return fail_end(r, row, err);
        }
    }
    return BP_OK;
}

static BpStatus skip_binary(Reader *r, const PlyElement *element, BpError *err) {
    const size_t row_size = ply_row_size(&r->header, element);
    if (row_size == 0) return BP_OK;
    if (element->count > (r->input.size - r->input.taken) / row_size)
        return fail_end(r, (r->input.size - r->input.taken) / row_size, err);
    if (!element->has_list) {
        if (!ply_input_skip(&r->input, element->count * row_size)) return fail_end(r, element->count, err);
        return BP_OK;
    }
    for (uint64_t row = 0; row < element->count; row++) BP_TRY(take_row(r, element, row, NULL, err));
    return BP_OK;
}

static BpStatus read_binary(Reader *r, const PlyElement *element, BpError *err) {
    double value[PLY_ROLE_COUNT] = {0};
    if (element->has_list) {
        for (uint64_t row = 0; row < element->count; row++) {
            BP_TRY(take_row(r, element, row, value, err));
            BP_TRY(store(r, row, value, err));
        }
        return BP_OK;
    }
    struct {
        size_t offset;
        PlyType type;
        PlyRole role;
    } fields[PLY_ROLE_COUNT];
    size_t field_count = 0, row_size = 0;
    for (size_t i = 0; i < element->property_count; i++) {
        const PlyProperty *p = &r->header.properties[element->first_property + i];
        if (p->role != PLY_NO_ROLE) {
            fields[field_count].offset = row_size;
            fields[field_count].type = p->type;
            fields[field_count++].role = p->role;
        }
        row_size += ply_type_size(p->type);
    }
    for (uint64_t row = 0; row < element->count; row++) {
        if (r->input.end - r->input.begin < row_size && !ply_input_fill(&r->input, row_size))
            return fail_end(r, row, err);
        const unsigned char *bytes = r->input.buffer + r->input.begin;
        for (size_t f = 0; f < field_count; f++)
            value[fields[f].role] = ply_decode(bytes + fields[f].offset, fields[f].type, r->swap);
        ply_input_take(&r->input, row_size);
        BP_TRY(store(r, row, value, err));
    }
    return BP_OK;
}

/* ---- ASCII ----------------------------------------------------------------------------------------------
 */

/* Takes a line that is not blank. */
static BpStatus take_line(Reader *r, char **line, BpError *err) {
    do BP_TRY(ply_input_line(&r->input, line, err));
    while ((*line)[strspn(*line, " \t\r")] == '\0');
    return BP_OK;
}

static BpStatus skip_ascii(Reader *r, const PlyElement *element, BpError *err) {
    char *line;
    if (element->property_count == 0) return BP_OK;
    for (uint64_t row = 0; row < element->count; row++) BP_TRY(take_line(r, &line, err));
    return BP_OK;
}

static BpStatus read_ascii(Reader *r, const PlyElement *element, BpError *err) {
    double value[PLY_ROLE_COUNT] = {0};
    for (uint64_t row = 0; row < element->count; row++) {
        char *line;
        BP_TRY(take_line(r, &line, err));
        for (size_t i = 0; i < element->property_count; i++) {
            const PlyProperty *p = &r->header.properties[element->first_property + i];
            double number = 0, ignored = 0;
            bool good = ply_parse_number(&line, &number);
            if (good && p->count_type != PLY_NONE) {
                if (!(number >= 0 && number == floor(number))) return fail_count(r, true, row, number, err);
                for (double k = 0; good && k < number; k++) good = ply_parse_number(&line, &ignored);
            } else if (good && p->role != PLY_NO_ROLE) {
                value[p->role] = number;
            }
            if (!good) {
                char shown[48];
                bp_printable(line + strspn(line, " \t"), shown, sizeof shown);
                return ply_fail(&r->input, true, err,
                                "vertex %" PRIu64 " (from 0): found \"%s\", expected a number for each "
                                "of %zu properties",
                                row, shown, element->property_count);
            }
        }
        if (line[strspn(line, " \t\r")] != '\0')
            return ply_fail(&r->input, true, err,
                            "vertex %" PRIu64 " (from 0): found more than %zu numbers, expected one "
                            "for each property",
                            row, element->property_count);
        BP_TRY(store(r, row, value, err));
    }
    return BP_OK;
}

/* ---- the whole ------------------------------------------------------------------------------------------
 */

/* Room for all vertices, once their number has been compared with what is left of the file. */
static BpStatus make_room(Reader *r, uint64_t count, BpError *err) {
    BpScene *scene = r->scene;
    const PlyElement *vertex = &r->header.elements[r->header.vertex];
    /* In ASCII a number takes a digit and a blank, but for the last. */
    const uint64_t row_size =
        r->header.format == PLY_ASCII ? 2 * vertex->property_count : ply_row_size(&r->header, vertex);
    const uint64_t left = r->input.size > r->input.taken ? r->input.size - r->input.taken + 1 : 0;
    if (count > left / row_size)
        return ply_fail(&r->input, false, err,
                        "found space for %" PRIu64 " rows of vertices, expected %" PRIu64
                        "; the file is truncated",
                        left / row_size, count);
    if (count > BP_SPHERES_MAX - scene->sphere_count)
        return ply_fail(&r->input, false, err,
                        "found %" PRIu64 " point%s more, expected at most %u spheres in a scene", count,
                        bp_plural(count), BP_SPHERES_MAX);
    BpSphere *spheres = realloc(scene->spheres, (scene->sphere_count + (size_t)count + 1) * sizeof *spheres);
    if (spheres == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for %" PRIu64 " points", count);
    scene->spheres = spheres;
    r->next = spheres + scene->sphere_count;
    if (!r->has_colour) return BP_OK;
    float(*albedos)[3] = realloc(scene->albedos, (scene->albedo_count + (size_t)count + 1) * sizeof *albedos);
    if (albedos == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for %" PRIu64 " colours", count);
    scene->albedos = albedos;
    r->next_albedo = albedos + scene->albedo_count;
    r->albedo_number = (uint32_t)scene->albedo_count;
    return BP_OK;
}

static BpStatus choose(Reader *r, BpError *err) {
    const PlyType *type = r->header.role_type;
    r->has_radius = type[PLY_RADIUS] != PLY_NONE;
    r->has_colour = type[PLY_RED] != PLY_NONE;
    r->has_material = type[PLY_MATERIAL] != PLY_NONE && r->options->material_count > 0;
    if (!r->has_radius && r->options->radius == 0)
        return ply_fail(
            &r->input, false, err,
            "found no property radius, expected one, or a \"radius\" for all points in the scene's cloud");
    if (!r->has_material && r->options->material == BP_PLY_NO_MATERIAL)
        return ply_fail(&r->input, false, err,
                        "found no property material, expected one, or a \"material\" for all points in the "
                        "scene's cloud");
    const uint16_t one = 1;
    unsigned char first;
    memcpy(&first, &one, 1);
    r->swap = r->header.format == (first == 1 ? PLY_BIG_ENDIAN : PLY_LITTLE_ENDIAN);
    for (int i = 0; i < 256; i++) r->srgb_to_linear[i] = (float)bp_linear_from_srgb(i / 255.0);
    return BP_OK;
}

static BpStatus read_all(Reader *r, BpError *err) {
    BP_TRY(ply_read_header(&r->input, &r->header, err));
    BP_TRY(choose(r, err));
    const bool ascii = r->header.format == PLY_ASCII;
    for (size_t i = 0; i < r->header.vertex; i++) {
        const PlyElement *element = &r->header.elements[i];
        BP_TRY(ascii ? skip_ascii(r, element, err) : skip_binary(r, element, err));
    }
    const PlyElement *vertex = &r->header.elements[r->header.vertex];
    BP_TRY(make_room(r, vertex->count, err));
    BP_TRY(ascii ? read_ascii(r, vertex, err) : read_binary(r, vertex, err));
    for (size_t i = r->header.vertex + 1; i < r->header.element_count; i++) {
        const PlyElement *element = &r->header.elements[i];
        BP_TRY(ascii ? skip_ascii(r, element, err) : skip_binary(r, element, err));
    }
    BP_TRY(ply_input_end(&r->input, ascii, err));
    r->scene->sphere_count += (size_t)vertex->count;
    if (r->has_colour) r->scene->albedo_count = r->albedo_number;
    return BP_OK;
}

BpStatus bp_ply_read(FILE *stream, uint64_t size, const char *name, const BpPlyOptions *options,
                     BpScene *scene, BpError *err) {
    Reader *r = calloc(1, sizeof *r);
    /* Numbers have a point, whatever the caller's locale. */
    const locale_t point = newlocale(LC_NUMERIC_MASK, "C", (locale_t)0);
    BpStatus status = BP_OK;
    if (r == NULL || point == (locale_t)0) {
        status = bp_fail(err, BP_ERR_MEMORY, "out of memory for a PLY file");
        goto done;
    }
    r->options = options;
    r->scene = scene;
    BP_TRY_GOTO(status, ply_input_init(&r->input, stream, size, name, err), done);
    const locale_t before = uselocale(point);
    status = read_all(r, err);
    uselocale(before);
done:
    if (point != (locale_t)0) freelocale(point);
    if (r != NULL) ply_input_clear(&r->input);
    free(r);
    return status;
}
