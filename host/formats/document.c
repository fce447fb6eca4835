/* document.c: see document.h. */
#include "document.h"

#include "base/encoding.h"
#include "base/json_memory.h"
#include "base/known_file.h"
#include "json_advice.h"

#include <ctype.h>
#include <limits.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { DEPTH_MAX = 16, FOUND_SIZE = 80 };

/* ---- syntax -------------------------------------------------------------------------------------------- */

static BpStatus fail_at_offset(const BpDocument *document, size_t offset, BpError *err, const char *text) {
    int line = 0, column = 0;
    bp_text_position(document->text, document->length, offset, &line, &column);
    const BpStatus status = bp_fail(err, BP_ERR_SCENE, "%s", text);
    bp_error_at(err, document->name, line, column);
    return status;
}

static BpStatus fail_duplicate(const BpDocument *document, const json_error_t *error, BpError *err) {
    size_t end = error->position < 1 ? 1 : (size_t)error->position;
    if (end > document->length) end = document->length;
    size_t start = end - 1; /* at the closing quote; look for the opening one */
    while (start > 0) {
        start--;
        size_t backslashes = 0;
        while (backslashes < start && document->text[start - 1 - backslashes] == '\\') backslashes++;
        if (document->text[start] == '"' && backslashes % 2 == 0) break;
    }
    char raw[FOUND_SIZE] = {0}, name[FOUND_SIZE], text[256];
    if (end > start + 2) {
        const size_t count = end - start - 2 < sizeof raw - 1 ? end - start - 2 : sizeof raw - 1;
        memcpy(raw, document->text + start + 1, count);
    }
    bp_printable(raw, name, sizeof name);
    snprintf(text, sizeof text, "%s: found twice in the same object, expected once; remove one of the two",
             name);
    return fail_at_offset(document, start, err, text);
}

/* The text has no terminator, so functions of the C library for strings would read past its end. */
static bool only_space_before(const char *text, size_t end) {
    for (size_t i = 0; i < end; i++)
        if (text[i] != ' ' && text[i] != '\t' && text[i] != '\r' && text[i] != '\n') return false;
    return true;
}

static BpStatus fail_syntax(const BpDocument *document, const json_error_t *error, BpError *err) {
    const size_t at = bp_json_error_place(document->text, document->length, error);
    const char *const rest = document->text + at;
    const char *hint = "";
    char found[sizeof error->text], text[640], room[BP_JSON_ADVICE_SIZE],
        hinted[BP_JSON_ADVICE_SIZE + 4] = "";
    const char *advice;
    bp_printable(error->text, found, sizeof found);
    switch (json_error_code(error)) {
    case json_error_duplicate_key:
        return fail_duplicate(document, error, err);
    case json_error_stack_overflow:
        return fail_at_offset(document, at, err,
                              "found lists or objects nested too deeply, expected a scene of a few levels");
    case json_error_invalid_utf8:
        hint = "; expected UTF-8: save the file in that encoding";
        break;
    case json_error_premature_end_of_input:
        advice = bp_json_advice(document->text, document->length, document->length, room);
        snprintf(text, sizeof text, "found the end of the text, expected more: %s",
                 advice[0] != '\0' ? advice : "a bracket or quote is not closed, or the file is truncated");
        return fail_at_offset(document, document->length, err, text);
    case json_error_end_of_input_expected:
        hint = "; expected nothing after the closing brace";
        break;
    case json_error_numeric_overflow:
        hint = "; expected a number that double precision holds (up to 1.7e308)";
        break;
    default:
        advice = bp_json_advice(document->text, document->length, at, room);
        if (advice[0] != '\0' && !(only_space_before(document->text, at) && isalnum((unsigned char)rest[0])))
            snprintf(hinted, sizeof hinted, "; %s", advice);
        else if (only_space_before(document->text, at))
            hint =
                "; expected a scene, which begins with \"{\", or a file of particles with the ending of its "
                "format (`ballpark help render` lists them)";
        break;
    }
    if (hint[0] == '\0') hint = hinted;
    snprintf(text, sizeof text, "not JSON: %s%s", found, hint);
    return fail_at_offset(document, at, err, text);
}

/* Whether a file begins with bytes that no text has, trajectories in binary formats for example. */
static bool is_binary(const char *text, size_t length) {
    for (size_t i = 0; i < length && i < 64; i++) {
        const unsigned char byte = (unsigned char)text[i];
        if ((byte < ' ' && strchr("\t\n\v\f\r\x1b", byte) == NULL) || byte == '\0') return true;
    }
    return false;
}

/* Names the remedy for files that are no JSON document at all. */
static BpStatus refuse_other_files(const BpDocument *document, size_t start, BpError *err) {
    BpKnownFile known;
    if (bp_known_file(document->name, document->text, document->length, &known)) {
        char text[320];
        snprintf(text, sizeof text, "found %s, expected a scene%s", known.what, bp_known_file_remedy(&known));
        return fail_at_offset(document, 0, err, text);
    }
    const char *const wide = bp_text_wide(document->text, document->length);
    if (wide != NULL) {
        char text[256];
        snprintf(text, sizeof text, BP_TEXT_WIDE_FORMAT, wide, wide);
        return fail_at_offset(document, 0, err, text);
    }
    if (document->text[start] == '{' || document->text[start] == '[') return BP_OK;
    if (is_binary(document->text, document->length))
        return fail_at_offset(
            document, 0, err,
            "found bytes that are not text, expected a scene (JSON), or a file of particles "
            "in a format of docs/PARTICLES.md; MDAnalysis and ASE convert other formats");
    return BP_OK;
}

BpStatus bp_document_open(const char *text, size_t length, const char *name, BpDocument *document,
                          BpError *err) {
    const size_t mark = bp_text_mark(text, length);
    text += mark;
    length -= mark;
    *document = (BpDocument){.name = name, .text = text, .length = length, .root = NULL};
    size_t start = 0;
    while (start < length && strchr(" \t\r\n", text[start]) != NULL && text[start] != '\0') start++;
    if (start == length)
        return fail_at_offset(
            document, 0, err,
            "found an empty file, expected a scene such as { \"camera\": { \"image_width\": 400 } }");
    if (length > INT_MAX)
        return fail_at_offset(document, 0, err,
                              "found more than 2 GiB of text, expected less: keep many spheres in a PLY file "
                              "and name it in \"clouds\"");
    BP_TRY(refuse_other_files(document, start, err));
    const char *const nul = memchr(text, '\0', length); /* jansson takes it for the end */
    if (nul != NULL)
        return fail_at_offset(document, (size_t)(nul - text), err,
                              "found a byte of value 0, expected text: remove it, and check that the file is "
                              "whole and saved as UTF-8");
    json_error_t error;
    bool no_memory = false;
    document->root = bp_json_load(text, length, JSON_REJECT_DUPLICATES, &error, &no_memory);
    /* An integer of more than 64 bits is read as a number like any other; its member refuses it by its own
     * limits. */
    if (document->root == NULL && !no_memory && json_error_code(&error) == json_error_numeric_overflow)
        document->root =
            bp_json_load(text, length, JSON_REJECT_DUPLICATES | JSON_DECODE_INT_AS_REAL, &error, &no_memory);
    if (no_memory) return bp_fail(err, BP_ERR_MEMORY, "out of memory while reading the scene");
    if (document->root == NULL) return fail_syntax(document, &error, err);
    if (!json_is_object(document->root)) {
        bp_document_close(document);
        return fail_at_offset(document, start, err,
                              "found a list, expected an object: { \"camera\": { ... }, ... }");
    }
    return BP_OK;
}

void bp_document_close(BpDocument *document) {
    json_decref(document->root);
    json_decref(document->written);
    free(document->changes);
    document->root = document->written = NULL;
    document->changes = NULL;
    document->change_count = 0;
}

/* ---- nodes --------------------------------------------------------------------------------------------- */

BpNode bp_node_root(const BpDocument *document) {
    return (BpNode){.document = document, .value = document->root};
}

BpNode bp_node_member(const BpNode *object, const char *name) {
    return (BpNode){.document = object->document,
                    .parent = object,
                    .member = name,
                    .value = json_object_get(object->value, name)};
}

BpNode bp_node_element(const BpNode *list, size_t index) {
    return (BpNode){.document = list->document,
                    .parent = list,
                    .index = index,
                    .value = json_array_get(list->value, index)};
}

/* The place of `name` among the members of `object`, or SIZE_MAX. The members' order in jansson's object is
 * that of the text, so a member is found again by its number. */
static size_t member_number(json_t *object, const char *wanted) {
    size_t number = 0;
    const char *name;
    json_t *value;
    json_object_foreach(object, name, value) {
        if (strcmp(name, wanted) == 0) return number;
        number++;
    }
    return SIZE_MAX;
}

/* Whether the text has the node, be it with another value. */
static bool is_written(const BpNode *node) {
    if (node->parent == NULL || node->document->written == NULL) return true;
    const BpNode *way[DEPTH_MAX];
    size_t depth = 0;
    for (const BpNode *n = node; n->parent != NULL && depth < DEPTH_MAX; n = n->parent) way[depth++] = n;
    const json_t *at = node->document->written;
    while (depth > 0 && at != NULL) {
        const BpNode *n = way[--depth];
        at = n->member != NULL ? json_object_get(at, n->member) : json_array_get(at, n->index);
    }
    return at != NULL;
}

/* The place of the node in the text; of the nearest node around it where the text does not have it. */
static size_t node_offset(const BpNode *node, BpPart part) {
    const BpDocument *document = node->document;
    const BpNode *way[DEPTH_MAX];
    size_t steps[DEPTH_MAX], depth = 0, found = 0;
    for (const BpNode *n = node; n->parent != NULL && depth < DEPTH_MAX; n = n->parent) way[depth++] = n;
    json_t *at = document->written != NULL ? document->written : document->root;
    while (found < depth && at != NULL) {
        const BpNode *n = way[depth - 1 - found];
        json_t *next = n->member != NULL ? json_object_get(at, n->member) : json_array_get(at, n->index);
        if (next == NULL) break;
        steps[found++] = n->member != NULL ? member_number(at, n->member) : n->index;
        at = next;
    }
    return bp_json_locate(document->text, document->length, steps, found,
                          found == depth ? part : BP_PART_VALUE);
}

static void node_path(const BpNode *node, char *out, size_t size) {
    out[0] = '\0';
    if (node->parent == NULL) return;
    node_path(node->parent, out, size);
    const size_t used = strlen(out);
    if (node->member != NULL) {
        char name[48];
        bp_printable(node->member, name, sizeof name);
        snprintf(out + used, size - used, "%s%s", used > 0 ? "." : "", name);
    } else {
        snprintf(out + used, size - used, "[%zu]", node->index);
    }
}

/* Whether `longer` is the path `path`, or one of something in it. */
static bool lies_in(const char *longer, const char *path) {
    const size_t length = strlen(path);
    return strncmp(longer, path, length) == 0 && strchr(".[", longer[length]) != NULL;
}

/* The last change of the node, or of a node around it. If the text does not have the node at all, a change of
 * a node within it counts too. NULL: the node is as the text has it. */
static const BpChange *find_change(const BpNode *node, const char *path) {
    const BpDocument *document = node->document;
    const bool written = is_written(node);
    for (size_t i = document->change_count; i > 0; i--) {
        const BpChange *change = &document->changes[i - 1];
        if (lies_in(path, change->path) || (!written && lies_in(change->path, path))) return change;
    }
    return NULL;
}

BpStatus bp_node_fail(const BpNode *node, BpPart part, BpError *err, const char *format, ...) {
    char path[256], text[768];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    node_path(node, path, sizeof path);
    int line = 0, column = 0;
    const BpChange *change = find_change(node, path);
    if (change != NULL) {
        char printable[FOUND_SIZE + 1];
        bp_printable(change->origin, printable, sizeof printable);
        const BpStatus status = bp_fail(err, BP_ERR_SCENE, "%s: %s (by %s %s)", path, text,
                                        node->document->changed_by, printable);
        bp_error_at(err, node->document->name, 0, 0);
        return status;
    }
    bp_text_position(node->document->text, node->document->length, node_offset(node, part), &line, &column);
    const BpStatus status = bp_fail(err, BP_ERR_SCENE, "%s%s%s", path, path[0] != '\0' ? ": " : "", text);
    bp_error_at(err, node->document->name, line, column);
    return status;
}

void bp_json_describe(const json_t *value, char *out, size_t size) {
    char text[FOUND_SIZE];
    switch (json_typeof(value)) {
    case JSON_OBJECT:
        snprintf(out, size, "an object");
        break;
    case JSON_ARRAY:
        snprintf(out, size, "a list of %zu", json_array_size(value));
        break;
    case JSON_STRING:
        bp_printable(json_string_value(value), text, sizeof text);
        snprintf(out, size, "the text \"%s\"", text);
        break;
    case JSON_INTEGER:
        snprintf(out, size, "%" JSON_INTEGER_FORMAT, json_integer_value(value));
        break;
    case JSON_REAL:
        snprintf(out, size, "%s", bp_number_text(json_real_value(value), text));
        break;
    case JSON_TRUE:
        snprintf(out, size, "true");
        break;
    case JSON_FALSE:
        snprintf(out, size, "false");
        break;
    case JSON_NULL:
        snprintf(out, size, "null");
        break;
    }
}

void bp_missing_name_text(const char *kind, const char *list, const char *const *names, size_t count,
                          const char *name, char out[BP_MISSING_NAME_SIZE]) {
    char printable[64], near_printable[64];
    bp_printable(name, printable, sizeof printable);
    if (count == 0) {
        snprintf(out, BP_MISSING_NAME_SIZE,
                 "found the %s \"%s\", expected a name from \"%s\", which is empty or absent; add it there",
                 kind, printable, list);
        return;
    }
    const char *nearest = bp_nearest_name(name, names, count);
    if (nearest != NULL) {
        bp_printable(nearest, near_printable, sizeof near_printable);
        snprintf(out, BP_MISSING_NAME_SIZE,
                 "found the %s \"%s\", expected a name from \"%s\"; did you mean \"%s\"?", kind, printable,
                 list, near_printable);
        return;
    }
    snprintf(out, BP_MISSING_NAME_SIZE, "found the %s \"%s\", expected a name from \"%s\":", kind, printable,
             list);
    for (size_t i = 0; i < count; i++) {
        const size_t used = strlen(out);
        bp_printable(names[i], near_printable, sizeof near_printable);
        const bool fits = used + strlen(near_printable) + 8 < BP_MISSING_NAME_SIZE;
        snprintf(out + used, BP_MISSING_NAME_SIZE - used, fits ? "%s \"%s\"" : "%s ...", i > 0 ? "," : "",
                 near_printable);
        if (!fits) return;
    }
}

BpStatus bp_find_name(const char *name, const char *kind, const char *list, const void *things, size_t size,
                      size_t count, uint32_t *number, char missing[BP_MISSING_NAME_SIZE], BpError *err) {
    const char **names = malloc((count + 1) * sizeof *names);
    if (names == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory");
    size_t found = count;
    for (size_t i = 0; i < count; i++) {
        names[i] = *(char *const *)((const char *)things + i * size);
        if (found == count && strcmp(names[i], name) == 0) found = i;
    }
    if (found == count) bp_missing_name_text(kind, list, names, count, name, missing);
    free(names);
    *number = found == count ? 0 : (uint32_t)found + 1;
    return BP_OK;
}

BpStatus bp_node_find(const BpNode *node, const char *kind, const char *list, const void *things, size_t size,
                      size_t count, uint32_t *number, BpError *err) {
    const char *name = NULL;
    char missing[BP_MISSING_NAME_SIZE];
    BP_TRY(bp_node_string(node, &name, err));
    BP_TRY(bp_find_name(name, kind, list, things, size, count, number, missing, err));
    return *number > 0 ? BP_OK : bp_node_fail(node, BP_PART_VALUE, err, "%s", missing);
}

BpStatus bp_node_wrong(const BpNode *node, const char *expected, BpError *err) {
    char found[FOUND_SIZE + 16];
    bp_json_describe(node->value, found, sizeof found);
    return bp_node_fail(node, BP_PART_VALUE, err, "found %s, expected %s", found, expected);
}

BpStatus bp_node_require(const BpNode *object, const char *name, const char *expected, BpError *err) {
    if (json_object_get(object->value, name) != NULL) return BP_OK;
    return bp_node_fail(object, BP_PART_VALUE, err, "found no \"%s\", expected %s", name, expected);
}

/* The name that is probably meant. In a text it is none that the object has already; a change may well be of
 * such a one. */
static const char *nearest_member(const BpNode *node, const BpNode *unknown, const char *const *names,
                                  size_t count) {
    const char *const nearest = bp_nearest_name(unknown->member, names, count);
    if (nearest == NULL || (is_written(unknown) && json_object_get(node->value, nearest) != NULL))
        return NULL;
    return nearest;
}

BpStatus bp_node_object(const BpNode *node, const char *const *names, size_t name_count, BpError *err) {
    if (node->value == NULL) return BP_OK;
    if (!json_is_object(node->value)) return bp_node_wrong(node, "an object: { ... }", err);
    const char *name;
    json_t *value;
    json_object_foreach(node->value, name, value) {
        size_t i = 0;
        while (i < name_count && strcmp(name, names[i]) != 0) i++;
        if (i < name_count) continue;
        const BpNode unknown = bp_node_member(node, name);
        const char *nearest = nearest_member(node, &unknown, names, name_count);
        if (nearest != NULL)
            return bp_node_fail(&unknown, BP_PART_NAME, err, "unknown member; did you mean \"%s\"?", nearest);
        char list[384] = "";
        for (size_t k = 0; k < name_count; k++) {
            const size_t used = strlen(list);
            snprintf(list + used, sizeof list - used, "%s%s", k > 0 ? ", " : "", names[k]);
        }
        return bp_node_fail(&unknown, BP_PART_NAME, err, "unknown member; expected one of %s", list);
    }
    return BP_OK;
}

BpStatus bp_node_list(const BpNode *node, const char *expected, BpError *err) {
    if (node->value == NULL || json_is_array(node->value)) return BP_OK;
    return bp_node_wrong(node, expected, err);
}

BpStatus bp_node_number(const BpNode *node, double *value, BpError *err) {
    if (node->value == NULL) return BP_OK;
    if (!json_is_number(node->value)) return bp_node_wrong(node, "a number", err);
    *value = json_number_value(node->value);
    return BP_OK;
}

BpStatus bp_node_integer(const BpNode *node, uint32_t low, uint32_t high, uint32_t *value, BpError *err) {
    if (node->value == NULL) return BP_OK;
    const double number = json_number_value(node->value); /* 0 if it is not a number */
    if (json_is_number(node->value) && number == floor(number) && number >= low && number <= high) {
        *value = (uint32_t)number;
        return BP_OK;
    }
    char expected[64];
    snprintf(expected, sizeof expected, "a whole number from %u to %u", (unsigned)low, (unsigned)high);
    return bp_node_wrong(node, expected, err);
}

BpStatus bp_node_boolean(const BpNode *node, bool *value, BpError *err) {
    if (node->value == NULL) return BP_OK;
    if (!json_is_boolean(node->value)) return bp_node_wrong(node, "true or false", err);
    *value = json_is_true(node->value);
    return BP_OK;
}

BpStatus bp_node_vector(const BpNode *node, double value[3], BpError *err) {
    if (node->value == NULL) return BP_OK;
    if (json_array_size(node->value) != 3) return bp_node_wrong(node, "three numbers: [x, y, z]", err);
    for (size_t i = 0; i < 3; i++) {
        const BpNode element = bp_node_element(node, i);
        BP_TRY(bp_node_number(&element, &value[i], err));
    }
    return BP_OK;
}

BpStatus bp_node_string(const BpNode *node, const char **value, BpError *err) {
    if (node->value == NULL) return BP_OK;
    if (!json_is_string(node->value)) return bp_node_wrong(node, "a text in double quotes", err);
    *value = json_string_value(node->value);
    return BP_OK;
}

BpStatus bp_node_choice(const BpNode *node, const char *const *names, size_t name_count, int *value,
                        BpError *err) {
    if (node->value == NULL) return BP_OK;
    const char *text = json_string_value(node->value); /* NULL if it is not a string */
    char expected[256] = "";
    for (size_t i = 0; i < name_count; i++) {
        if (text != NULL && strcmp(text, names[i]) == 0) {
            *value = (int)i;
            return BP_OK;
        }
        const size_t used = strlen(expected);
        snprintf(expected + used, sizeof expected - used, "%s\"%s\"",
                 i == 0               ? ""
                 : i + 1 < name_count ? ", "
                                      : " or ",
                 names[i]);
    }
    const char *nearest = text != NULL ? bp_nearest_name(text, names, name_count) : NULL;
    if (nearest != NULL) {
        const size_t used = strlen(expected);
        snprintf(expected + used, sizeof expected - used, "; did you mean \"%s\"?", nearest);
    }
    return bp_node_wrong(node, expected, err);
}
