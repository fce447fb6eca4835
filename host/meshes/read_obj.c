/* read_obj.c: OBJ files, of Wavefront; see reader.h.
 *
 * Knows: OBJ.   Does not know: what MTL files say (read_mtl.c), how polygons are cut.
 *
 * Lines and points are left out. Free-form curves and surfaces
 * are refused, since a mesh without them would lack parts. */
#include "reader.h"

#include "base/decimal.h"
#include "base/format.h"
#include "base/input_file.h"
#include "base/message_text.h"
#include "base/plural.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

/* The longest line, of all that backslashes join. */
#define JOINED_MAX ((size_t)1 << 26)
enum { NUMBERS_MAX = 8 };

typedef struct Obj {
    MeshBuilder *builder;
    Input *input;
    char *joined; /* lines that backslashes joined */
    size_t joined_capacity;
    uint32_t material;
    BpNames libraries; /* MTL files that were read */
    uint64_t lines, points, unknown, unknown_line;
    bool has_weights;
} Obj;

static bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r';
}

static bool is_end(char c) {
    return c == '\0' || c == '#';
}

static char *skip_blanks(char *at) {
    while (is_blank(*at)) at++;
    return at;
}

char *mesh_name_in(char *rest) {
    rest = skip_blanks(rest);
    size_t length = strlen(rest);
    while (length > 0 && is_blank(rest[length - 1])) length--;
    rest[length] = '\0';
    return rest;
}

/* ---- lines -------------------------------------------------------------------------------------------- */

/* Appends a line to those before, without its backslash. */
static BpStatus join(Obj *obj, const char *line, size_t length, size_t *used, BpError *err) {
    if (*used + length + 1 > JOINED_MAX)
        return input_fail(obj->input, true, err, "found lines joined to over %zu bytes, expected fewer",
                          JOINED_MAX);
    while (*used + length + 1 > obj->joined_capacity)
        BP_TRY(mesh_make_room(obj->input, (void **)&obj->joined, &obj->joined_capacity, obj->joined_capacity,
                              1, "bytes of a line", err));
    memcpy(obj->joined + *used, line, length);
    *used += length;
    obj->joined[*used] = '\0';
    return BP_OK;
}

/* The next line, with those that backslashes join to it; NULL at the end of the file. */
static BpStatus take_line(Obj *obj, char **line, BpError *err) {
    size_t used = 0;
    for (;;) {
        BP_TRY(input_line(obj->input, line, err));
        if (*line == NULL) break;
        const size_t length = strlen(*line);
        const bool goes_on = length > 0 && (*line)[length - 1] == '\\' && *skip_blanks(*line) != '#';
        if (!goes_on && used == 0) return BP_OK;
        BP_TRY(join(obj, *line, goes_on ? length - 1 : length, &used, err));
        if (!goes_on) break;
    }
    if (used > 0) *line = obj->joined;
    return BP_OK;
}

/* ---- vertices ----------------------------------------------------------------------------------------- */

static BpStatus read_vertex(Obj *obj, char *at, BpError *err) {
    double numbers[NUMBERS_MAX];
    size_t count = 0;
    for (at = skip_blanks(at); !is_end(*at); at = skip_blanks(at), count++) {
        const char *const end = bp_table_number_parse(at, &numbers[count < NUMBERS_MAX ? count : 0]);
        if (end == NULL || !(is_blank(*end) || is_end(*end)))
            return input_wrong(obj->input, at, "numbers behind v", err);
        at += end - at;
    }
    if (count != 3 && count != 4 && count != 6 && count != 7)
        return input_fail(
            obj->input, true, err,
            "found %zu numbers behind v, expected x, y and z, with a weight or a colour or without", count);
    BP_TRY(mesh_add_vertex(obj->builder, numbers, true, err));
    obj->has_weights |= count == 4 && numbers[3] != 1;
    return count >= 6 ? mesh_color_vertex(obj->builder, numbers + 3, true, err) : BP_OK;
}

/* ---- faces -------------------------------------------------------------------------------------------- */

static BpStatus fail_corner(const Obj *obj, const char *at, BpError *err) {
    char corner[32];
    snprintf(corner, sizeof corner, "%.*s", (int)(strcspn(at, " \t\r") < 31 ? strcspn(at, " \t\r") : 31), at);
    return input_wrong(obj->input, corner, "a corner such as 1, 1/2, 1//3 or 1/2/3", err);
}

/* The vertex that a file's number names, counted from 0. */
static BpStatus find_vertex(const Obj *obj, int64_t number, uint32_t *vertex, BpError *err) {
    const int64_t count = (int64_t)obj->builder->mesh->vertex_count;
    /* Below 0: back from the last one. A vertex may also follow its face, which is looked at in the end. */
    const int64_t place = number < 0 ? count + number : number - 1;
    if (number != 0 && place >= 0 && place < (int64_t)BP_MESH_COUNT_MAX) {
        *vertex = (uint32_t)place;
        return BP_OK;
    }
    return input_fail(obj->input, true, err,
                      "found vertex %" PRId64 " in a face, expected 1 to %" PRId64 ", or -1 to -%" PRId64
                      ", counted from the last one before the face",
                      number, count, count);
}

/* One that is not three numbers is missing. */
static BpStatus read_normal(Obj *obj, char *at, BpError *err) {
    double normal[3] = {0, 0, 0};
    for (int a = 0; a < 3; a++) {
        at = skip_blanks(at);
        const char *const end = bp_table_number_parse(at, &normal[a]);
        if (end == NULL) return mesh_add_normal(obj->builder, (const double[3]){0, 0, 0}, true, err);
        at += end - at;
    }
    return mesh_add_normal(obj->builder, normal, true, err);
}

/* u, and v, which may be left out and is 0 then; a third is of textures that fill space. */
static BpStatus read_coordinates(Obj *obj, char *at, BpError *err) {
    double uv[2] = {NAN, 0};
    for (int a = 0; a < 2; a++) {
        double value = 0;
        at = skip_blanks(at);
        const char *const end = bp_table_number_parse(at, &value);
        if (end == NULL) break;
        uv[a] = value;
        at += end - at;
    }
    return mesh_add_coordinates(obj->builder, uv[0], uv[1], true, err);
}

/* Takes the numbers of texture coordinates and a normal: "/2", "//3", "/2/3"; what is not there stays 0.
 * NULL: they are not numbers. */
static const char *take_others(const char *at, int64_t others[2]) {
    for (int i = 0; i < 2 && *at == '/'; i++) {
        const char *const end = bp_whole_parse(++at, &others[i]);
        if (end != NULL) at = end;
    }
    return is_blank(*at) || is_end(*at) ? at : NULL;
}

/* What a number stands for where there are `count` so far; one that there is not is missing. */
static uint32_t chosen(int64_t number, size_t count) {
    const int64_t place = number < 0 ? (int64_t)count + number : number - 1;
    return place >= 0 && place < (int64_t)BP_MESH_COUNT_MAX ? (uint32_t)place : MESH_NO_NUMBER;
}

static BpStatus read_face(Obj *obj, char *at, BpError *err) {
    for (at = skip_blanks(at); !is_end(*at); at = skip_blanks(at)) {
        int64_t number = 0, others[2] = {0, 0};
        uint32_t vertex = 0;
        const char *end = bp_whole_parse(at, &number);
        if (end != NULL) end = take_others(end, others);
        if (end == NULL) return fail_corner(obj, at, err);
        BP_TRY(find_vertex(obj, number, &vertex, err));
        BP_TRY(mesh_add_corner(obj->builder, vertex, err));
        if (others[0] != 0)
            BP_TRY(mesh_choose_coordinates(obj->builder, chosen(others[0], obj->builder->coordinate_count),
                                           err));
        if (others[1] != 0)
            BP_TRY(mesh_choose_normal(obj->builder, chosen(others[1], obj->builder->normal_count), err));
        at += end - at;
    }
    return mesh_end_polygon(obj->builder, obj->material, true, err);
}

/* ---- materials ---------------------------------------------------------------------------------------- */

/* Reads an MTL file of that name beside the mesh. *found: it is there. */
static BpStatus try_library(Obj *obj, const char *name, bool *found, BpError *err) {
    FILE *stream = NULL;
    uint64_t size = 0;
    Input input = {0};
    char *const path = bp_path_beside(obj->builder->path, name);
    if (path == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for the path of an MTL file");
    *found = bp_file_open(path, false, "an MTL file", &stream, &size, NULL) == BP_OK;
    BpStatus status = BP_OK;
    if (*found) {
        status = input_init(&input, stream, path, err);
        if (status == BP_OK) status = mesh_read_mtl(obj->builder, &input, err);
        input_clear(&input);
        fclose(stream);
    }
    free(path);
    return status;
}

/* The same, without a folder of another machine where it is not found with it. */
static BpStatus read_library(Obj *obj, const char *name, bool *found, BpError *err) {
    uint16_t ignored = 0;
    const size_t before = obj->libraries.count;
    *found = true;
    const BpStatus status = names_number(&obj->libraries, name, &ignored, err);
    if (status != BP_OK || obj->libraries.count == before) return status; /* it was read before */
    BP_TRY(try_library(obj, name, found, err));
    const char *const slash = strrchr(name, '\\') != NULL ? strrchr(name, '\\') : strrchr(name, '/');
    return *found || slash == NULL ? BP_OK : try_library(obj, slash + 1, found, err);
}

/* `rest`: a name, which may have blanks, or several. */
static BpStatus read_libraries(Obj *obj, char *rest, BpError *err) {
    char *const name = mesh_name_in(rest), shown[64];
    bool found = false;
    if (*name == '\0') return BP_OK;
    bp_printable(name, shown, sizeof shown);
    BP_TRY(read_library(obj, name, &found, err));
    if (!found && strpbrk(name, " \t") != NULL) {
        char *next = name;
        while (*(next = skip_blanks(next)) != '\0') {
            char *const one = next;
            next += strcspn(next, " \t\r");
            if (*next != '\0') *next++ = '\0';
            bool is_there = false;
            BP_TRY(read_library(obj, one, &is_there, err));
            found |= is_there;
        }
    }
    if (!found) mesh_note(obj->builder->mesh, "no file %s, which should describe its materials", shown);
    return BP_OK;
}

/* ---- the whole ---------------------------------------------------------------------------------------- */

static bool is_among(const char *word, size_t length, const char *const *words) {
    for (; *words != NULL; words++)
        if (strlen(*words) == length && memcmp(word, *words, length) == 0) return true;
    return false;
}

static BpStatus read_other(Obj *obj, char *word, size_t length, BpError *err) {
    static const char *const free_form[] = {"cstype", "deg", "bmat", "step", "curv", "curv2", "surf",
                                            "bsp",    "bzp", "cdc",  "cdp",  "res",  NULL};
    static const char *const passed[] = {
        "o",        "g",        "s",          "mg",        "lod",   "bevel", "usemap", "maplib",
        "c_interp", "d_interp", "shadow_obj", "trace_obj", "ctech", "stech", "vp",     NULL};
    if (is_among(word, length, free_form)) {
        word[length] = '\0';
        return input_wrong(obj->input, word,
                           "polygons: free-form curves and surfaces are not read; export them as polygons",
                           err);
    }
    if (!is_among(word, length, passed) && obj->unknown++ == 0) obj->unknown_line = obj->input->line;
    return BP_OK;
}

static BpStatus read_statement(Obj *obj, char *line, BpError *err) {
    char *const word = skip_blanks(line);
    if (is_end(*word)) return BP_OK;
    const size_t length = strcspn(word, " \t\r");
    char *const rest = word + length;
    if (length == 1 && *word == 'v') return read_vertex(obj, rest, err);
    if (length == 1 && *word == 'f') return read_face(obj, rest, err);
    if (length == 2 && memcmp(word, "fo", 2) == 0) return read_face(obj, rest, err); /* f, in older files */
    if (length == 2 && memcmp(word, "vn", 2) == 0) return read_normal(obj, rest, err);
    if (length == 2 && memcmp(word, "vt", 2) == 0) return read_coordinates(obj, rest, err);
    if (length == 1 && *word == 'l')
        obj->lines++;
    else if (length == 1 && *word == 'p')
        obj->points++;
    else if (length == 6 && memcmp(word, "usemtl", 6) == 0)
        return mesh_find_material(obj->builder, mesh_name_in(rest), &obj->material, err);
    else if (length == 6 && memcmp(word, "mtllib", 6) == 0)
        return read_libraries(obj, rest, err);
    else
        return read_other(obj, word, length, err);
    return BP_OK;
}

static void note_count(const Obj *obj, uint64_t count, const char *noun) {
    char number[32];
    if (count > 0)
        mesh_note(obj->builder->mesh, "%s %s%s left out", bp_format_whole(count, number, sizeof number), noun,
                  bp_plural(count));
}

static BpStatus read_all(Obj *obj, BpError *err) {
    char *line = NULL;
    for (;;) {
        BP_TRY(take_line(obj, &line, err));
        if (line == NULL) break;
        BP_TRY(read_statement(obj, line, err));
    }
    if (obj->builder->coordinate_choices.of_corners == NULL) obj->builder->coordinate_count = 0;
    if (obj->builder->polygon_count == 0)
        return input_fail(obj->input, false, err,
                          "found no faces (lines that begin with f), expected a mesh of polygons");
    note_count(obj, obj->lines, "line");
    note_count(obj, obj->points, "point");
    if (obj->has_weights) mesh_note(obj->builder->mesh, "weights of vertices left out");
    if (obj->unknown > 0)
        mesh_note(obj->builder->mesh, "%" PRIu64 " unknown statement%s left out, from line %" PRIu64 " on",
                  obj->unknown, bp_plural(obj->unknown), obj->unknown_line);
    return BP_OK;
}

BpStatus mesh_read_obj(MeshBuilder *builder, BpError *err) {
    Obj obj = {.builder = builder, .input = builder->input, .material = BP_MESH_NO_MATERIAL};
    builder->first_index = 1;
    const BpStatus status = read_all(&obj, err);
    names_clear(&obj.libraries);
    free(obj.joined);
    return status;
}
