/* read_off.c: OFF files, of Geomview; see reader.h.
 *
 * Knows: OFF, and with colours (C), normals (N), texture coordinates (ST); text.   Does not know: how
 * polygons are cut. */
#include "reader.h"

#include "base/decimal.h"
#include "base/message_text.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { WORDS_MAX = 16 };

typedef struct Off {
    MeshBuilder *builder;
    Input *input;
    bool has_colors, has_normals, has_texture;
    uint64_t vertex_count, face_count;
} Off;

/* The next line with a word, without its comment. NULL: there is none. */
static BpStatus take_line(const Off *off, char **line, BpError *err) {
    do {
        BP_TRY(input_full_line(off->input, line, err));
        if (*line == NULL) return BP_OK;
        (*line)[strcspn(*line, "#")] = '\0';
    } while ((*line)[strspn(*line, " \t\r")] == '\0');
    return BP_OK;
}

static BpStatus need_line(const Off *off, char **line, const char *expected, BpError *err) {
    BP_TRY(take_line(off, line, err));
    if (*line != NULL) return BP_OK;
    return input_fail(off->input, true, err, "found the end of the file, expected %s", expected);
}

/* The letters before OFF; false: the word is none of its keywords. */
static BpStatus parse_keyword(Off *off, const char *word, bool *is_keyword, BpError *err) {
    const size_t length = strlen(word);
    *is_keyword = length >= 3 && strcmp(word + length - 3, "OFF") == 0;
    if (!*is_keyword) return BP_OK;
    const char *at = word;
    off->has_texture = strncmp(at, "ST", 2) == 0;
    if (off->has_texture) at += 2;
    off->has_colors = *at == 'C';
    at += off->has_colors;
    off->has_normals = *at == 'N';
    at += off->has_normals;
    if (at + 3 == word + length) return BP_OK;
    return input_wrong(off->input, word,
                       "OFF, or it with ST, C and N before it (4OFF and nOFF have other dimensions): export "
                       "three dimensions",
                       err);
}

/* Counts of vertices, faces and edges, on one line or more. The last is often missing or wrong. */
static BpStatus parse_counts(Off *off, char **words, size_t count, BpError *err) {
    uint64_t *const counts[2] = {&off->vertex_count, &off->face_count};
    char *line = NULL, *more[WORDS_MAX];
    for (size_t found = 0, at = 0; found < 2; found++, at++) {
        if (at == count) {
            BP_TRY(need_line(off, &line, "the numbers of vertices and faces", err));
            count = split_words(line, more, WORDS_MAX);
            words = more;
            at = 0;
        }
        int64_t value = 0;
        if (!word_whole(words[at], &value) || value < 0)
            return input_wrong(off->input, words[at], "the numbers of vertices, faces and edges", err);
        *counts[found] = (uint64_t)value;
        if (found == 1 && count > at + 2)
            return input_wrong(off->input, words[at + 2], "the end of the line behind three numbers", err);
        if (found == 1 && at + 1 == count) { /* the edges, on a line of their own, if it has one number */
            BP_TRY(take_line(off, &line, err));
            if (line == NULL) return BP_OK;
            const char *const begin = line + strspn(line, " \t");
            const char *const end = bp_whole_parse(begin, &value);
            if (end == NULL || end[strspn(end, " \t\r")] != '\0') input_hold(off->input, line);
        }
    }
    return BP_OK;
}

static BpStatus read_header(Off *off, BpError *err) {
    char *line = NULL, *words[WORDS_MAX];
    bool is_keyword = false;
    BP_TRY(need_line(off, &line, "OFF, the first word of an OFF file", err));
    size_t count = split_words(line, words, WORDS_MAX);
    if (count > WORDS_MAX) count = WORDS_MAX;
    BP_TRY(parse_keyword(off, words[0], &is_keyword, err));
    if (is_keyword && count > 1 && strcmp(words[1], "BINARY") == 0)
        return input_wrong(off->input, words[1],
                           "numbers: OFF files are read as text only; export text, or a binary PLY file",
                           err);
    return parse_counts(off, words + is_keyword, count - is_keyword, err);
}

static BpStatus read_vertex(const Off *off, uint64_t number, BpError *err) {
    char *line = NULL, *words[WORDS_MAX];
    double values[WORDS_MAX];
    const size_t first_color = off->has_normals ? 6 : 3, rest = off->has_texture ? 2 : 0;
    BP_TRY(take_line(off, &line, err));
    if (line == NULL)
        return input_fail(off->input, true, err,
                          "found the end of the file, expected vertex %" PRIu64 " (from 0) of %" PRIu64
                          "; the file is truncated, or its header counts too many",
                          number, off->vertex_count);
    const size_t count = split_words(line, words, WORDS_MAX);
    const size_t least = first_color + rest + (off->has_colors ? 3 : 0);
    const size_t most = least + (off->has_colors ? 1 : 0);
    if (count < least || count > most)
        return input_fail(off->input, true, err,
                          "vertex %" PRIu64
                          " (from 0): found %zu numbers, expected %zu%s; the first word of the "
                          "file tells what vertices have: C is for colours, N for normals, ST for textures",
                          number, count, least, most > least ? " or one more" : "");
    for (size_t i = 0; i < count; i++)
        if (!word_number_or_none(words[i], &values[i]))
            return input_wrong(off->input, words[i], "a number", err);
    BP_TRY(mesh_add_vertex(off->builder, values, true, err));
    return off->has_colors ? mesh_color_vertex(off->builder, values + first_color, true, err) : BP_OK;
}

/* What follows the corners: nothing, the number of a colour, or a colour with opacity or without. */
static BpStatus read_face_color(const Off *off, char *line, BpError *err) {
    char *words[WORDS_MAX];
    double color[3];
    const size_t count = split_words(line, words, WORDS_MAX);
    if (count == 0) return BP_OK;
    if (count == 1) mesh_note(off->builder->mesh, "numbers of colours, which are not in the file, left out");
    if (count == 1) return BP_OK;
    if (count != 3 && count != 4)
        return input_wrong(off->input, words[0], "nothing or a colour of 3 or 4 numbers behind the corners",
                           err);
    for (size_t i = 0; i < 3; i++)
        if (!word_number(words[i], &color[i])) return input_wrong(off->input, words[i], "a number", err);
    return mesh_color_polygon(off->builder, color, true, err);
}

static BpStatus read_face(const Off *off, uint64_t number, BpError *err) {
    char *line = NULL;
    int64_t corners = 0, vertex = 0;
    BP_TRY(take_line(off, &line, err));
    if (line == NULL)
        return input_fail(off->input, true, err,
                          "found the end of the file, expected face %" PRIu64 " (from 0) of %" PRIu64
                          "; the file is truncated, or its header counts too many",
                          number, off->face_count);
    const char *const begin = line + strspn(line, " \t");
    const char *at = bp_whole_parse(begin, &corners);
    if (at == NULL || corners < 0)
        return input_wrong(off->input, begin, "the number of a face's corners", err);
    for (int64_t i = 0; i < corners; i++) {
        at += strspn(at, " \t\r");
        const char *const end = bp_whole_parse(at, &vertex);
        if (end == NULL || vertex < 0 || (uint64_t)vertex >= off->vertex_count ||
            (*end != '\0' && strchr(" \t\r", *end) == NULL))
            return input_fail(off->input, true, err,
                              "face %" PRIu64 " (from 0): expected %" PRId64 " vertices of %" PRIu64
                              ", counted from 0, behind their number",
                              number, corners, off->vertex_count);
        BP_TRY(mesh_add_corner(off->builder, (uint32_t)vertex, err));
        at = end;
    }
    BP_TRY(mesh_end_polygon(off->builder, BP_MESH_NO_MATERIAL, true, err));
    return read_face_color(off, line + (at - line), err);
}

BpStatus mesh_read_off(MeshBuilder *builder, BpError *err) {
    Off off = {.builder = builder, .input = builder->input};
    char *line = NULL;
    BP_TRY(read_header(&off, err));
    for (uint64_t n = 0; n < off.vertex_count; n++) BP_TRY(read_vertex(&off, n, err));
    for (uint64_t n = 0; n < off.face_count; n++) BP_TRY(read_face(&off, n, err));
    BP_TRY(take_line(&off, &line, err));
    if (line == NULL) return BP_OK;
    return input_wrong(off.input, line,
                       "the end of the file after the last face: correct the counts at its beginning", err);
}
