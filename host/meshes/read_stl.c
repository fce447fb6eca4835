/* read_stl.c: STL files, binary and text; see reader.h.
 *
 * Knows: STL.   Does not know: how equal vertices are found (weld.h).
 *
 * The format has no vertices that faces share, so those at one place become one. Normals are left alone,
 * since the winding has them, and so are a binary triangle's two attribute bytes, whose meaning differs from
 * program to program. */
#include "reader.h"
#include "weld.h"

#include "base/encoding.h"
#include "base/format.h"
#include "base/plural.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

enum { HEADER = 80, BEGINNING = 84, TRIANGLE = 50, LOOKED_AT = 512 };

typedef struct Stl {
    MeshBuilder *builder;
    Input *input;
    Weld weld;
    char *cursor; /* in the line of text that is being read */
} Stl;

/* The file's length when unpacked. */
static uint64_t length_of(Input *input) {
    struct stat state;
    if (!input_is_packed(input) && fstat(fileno(input->stream), &state) == 0) return (uint64_t)state.st_size;
    (void)input_skip(input, UINT64_MAX);
    return input->taken;
}

/* Whether the file's length is that of a binary file; what it is, and what its count demands. */
static bool has_binary_length(Input *input, uint64_t *length, uint64_t *wanted) {
    *wanted = BEGINNING;
    if (input_fill(input, BEGINNING))
        *wanted += TRIANGLE * (uint64_t)mesh_word_at(input->buffer + input->begin + HEADER);
    *length = length_of(input);
    return *length == *wanted && !input->failed;
}

bool mesh_stl_is_binary(Input *input) {
    uint64_t length = 0, wanted = 0;
    return has_binary_length(input, &length, &wanted);
}

static BpStatus add_corner(Stl *stl, const double position[3], bool with_line, BpError *err) {
    const BpMesh *const mesh = stl->builder->mesh;
    const uint32_t number = (uint32_t)mesh->vertex_count;
    uint32_t found = number;
    if (mesh_has_place(position)) /* others are equal to none */
        BP_TRY(weld_find(&stl->weld, (const double(*)[3])mesh->positions, position, number, &found, err));
    if (found == number)
        BP_TRY(mesh_add_vertex(stl->builder, position, with_line, err));
    else
        stl->builder->mesh->welded++;
    return mesh_add_corner(stl->builder, found, err);
}

/* ---- binary ------------------------------------------------------------------------------------------- */

static BpStatus read_binary(Stl *stl, BpError *err) {
    Input *const input = stl->input;
    uint64_t attributes = 0;
    char number[32];
    (void)input_fill(input, BEGINNING);
    const uint32_t count = mesh_word_at(input->buffer + input->begin + HEADER);
    input_take(input, BEGINNING);
    for (uint32_t n = 0; n < count; n++) {
        if (!input_fill(input, TRIANGLE))
            return input_fail(input, false, err,
                              "found the end of the file, expected triangle %" PRIu32 " of %" PRIu32, n,
                              count);
        const unsigned char *const bytes = input->buffer + input->begin;
        for (size_t corner = 0; corner < 3; corner++) {
            const unsigned char *const at = bytes + 12 + 12 * corner;
            BP_TRY(add_corner(
                stl, (const double[3]){mesh_float_at(at), mesh_float_at(at + 4), mesh_float_at(at + 8)},
                false, err));
        }
        attributes += bytes[48] != 0 || bytes[49] != 0;
        input_take(input, TRIANGLE);
        BP_TRY(mesh_end_polygon(stl->builder, BP_MESH_NO_MATERIAL, false, err));
    }
    if (attributes > 0)
        mesh_note(stl->builder->mesh, "attribute bytes of %s triangle%s left out",
                  bp_format_whole(attributes, number, sizeof number), bp_plural(attributes));
    return BP_OK;
}

/* ---- text --------------------------------------------------------------------------------------------- */

static bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r';
}

static char *skip_blanks(char *at) {
    while (is_blank(*at)) at++;
    return at;
}

/* The next word, on this line or a later one; NULL at the end of the file. */
static BpStatus next_word(Stl *stl, char **word, BpError *err) {
    char *at = skip_blanks(stl->cursor);
    *word = NULL;
    while (*at == '\0') {
        BP_TRY(input_line(stl->input, &at, err));
        if (at == NULL) return BP_OK;
        at = skip_blanks(at);
    }
    char *end = at;
    while (*end != '\0' && !is_blank(*end)) end++;
    stl->cursor = *end == '\0' ? end : end + 1;
    *end = '\0';
    *word = at;
    return BP_OK;
}

/* The same; the end of the file is an error. */
static BpStatus need_word(Stl *stl, char **word, const char *expected, BpError *err) {
    BP_TRY(next_word(stl, word, err));
    if (*word != NULL) return BP_OK;
    return input_fail(stl->input, true, err, "found the end of the file, expected %s; the file is truncated",
                      expected);
}

static bool is_word(const char *word, const char *wanted) {
    return strcasecmp(word, wanted) == 0;
}

static BpStatus expect_word(Stl *stl, const char *wanted, BpError *err) {
    char *word = NULL;
    BP_TRY(need_word(stl, &word, wanted, err));
    return is_word(word, wanted) ? BP_OK : input_wrong(stl->input, word, wanted, err);
}

/* From behind the word facet to endfacet. */
static BpStatus read_facet(Stl *stl, BpError *err) {
    char *word = NULL;
    double position[3];
    do BP_TRY(need_word(stl, &word, "\"outer loop\" behind a facet's normal", err));
    while (!is_word(word, "outer"));
    BP_TRY(expect_word(stl, "loop", err));
    for (;;) {
        BP_TRY(need_word(stl, &word, "vertex or endloop", err));
        if (is_word(word, "endloop")) break;
        if (!is_word(word, "vertex")) return input_wrong(stl->input, word, "vertex or endloop", err);
        for (int a = 0; a < 3; a++) {
            BP_TRY(need_word(stl, &word, "three numbers behind vertex", err));
            if (!word_number_or_none(word, &position[a]))
                return input_wrong(stl->input, word, "three numbers behind vertex", err);
        }
        BP_TRY(add_corner(stl, position, true, err));
    }
    BP_TRY(mesh_end_polygon(stl->builder, BP_MESH_NO_MATERIAL, true, err));
    return expect_word(stl, "endfacet", err);
}

static BpStatus read_text(Stl *stl, BpError *err) {
    char *word = NULL;
    bool is_open = false; /* amid a solid */
    stl->cursor = (char[]){""};
    for (;;) {
        BP_TRY(next_word(stl, &word, err));
        if (word == NULL) break;
        const bool begins = is_word(word, "solid"), ends = is_word(word, "endsolid");
        if (begins || ends) {
            is_open = begins;
            stl->cursor += strlen(stl->cursor); /* a name may follow */
        } else if (is_open && is_word(word, "facet")) {
            BP_TRY(read_facet(stl, err));
        } else {
            return input_wrong(stl->input, word, is_open ? "facet or endsolid" : "solid", err);
        }
    }
    if (is_open) mesh_note(stl->builder->mesh, "the last solid has no end: the file may be truncated");
    return BP_OK;
}

/* ---- the whole ---------------------------------------------------------------------------------------- */

static bool begins_as_text(Input *input) {
    (void)input_fill(input, LOOKED_AT);
    const unsigned char *text = input->buffer + input->begin;
    size_t length = input->end - input->begin;
    if (bp_text_wide(text, length) != NULL) return true; /* refused by that name */
    const size_t mark = bp_text_mark(text, length);
    text += mark;
    length -= mark;
    while (length > 0 && strchr(" \t\r\n", *text) != NULL) text++, length--;
    return length >= 5 && strncasecmp((const char *)text, "solid", 5) == 0 &&
           memchr(text, '\0', length) == NULL;
}

static BpStatus read_either(Stl *stl, BpError *err) {
    Input *const input = stl->input;
    uint64_t length = 0, wanted = 0;
    const bool is_binary = has_binary_length(input, &length, &wanted);
    if (input->failed) return input_fail(input, false, err, "%s", "");
    BP_TRY(input_rewind(input, err));
    if (is_binary) return read_binary(stl, err);
    if (begins_as_text(input)) return read_text(stl, err);
    if (length < BEGINNING)
        return input_fail(input, false, err,
                          "found a file of %" PRIu64 " bytes, expected STL: the word solid, or a binary file",
                          length);
    return input_fail(input, false, err,
                      "found %" PRIu64 " bytes, expected %" PRIu64
                      ", the length of a binary STL file with as many triangles as this one counts: %s",
                      length, wanted,
                      length < wanted ? "it is truncated, or no STL file"
                                      : "remove what follows them, or correct their number");
}

BpStatus mesh_read_stl(MeshBuilder *builder, BpError *err) {
    Stl stl = {.builder = builder, .input = builder->input};
    const BpStatus status = read_either(&stl, err);
    weld_clear(&stl.weld);
    return status;
}
