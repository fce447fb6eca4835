/* document_change.c: see document_change.h. */
#include "document_change.h"

#include "base/escape.h"
#include "base/json_memory.h"
#include "json_advice.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PRINTABLE_SIZE = 96 };

static BpStatus fail(const char *set, BpError *err, const char *text) {
    char printable[PRINTABLE_SIZE];
    bp_printable(set, printable, sizeof printable);
    return bp_fail(err, BP_ERR_USAGE, "%s: %s", printable, text);
}

/* ---- the value ----------------------------------------------------------------------------------------- */

/* A word that nobody would take for JSON: a letter, then letters, digits and "-_.". */
static bool is_word(const char *text) {
    static const char letters[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ";
    static const char others[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_.";
    return strchr(letters, text[0]) != NULL && text[strspn(text, others)] == '\0';
}

static BpStatus read_value(const char *set, const char *text, json_t **value, BpError *err) {
    json_error_t error;
    bool no_memory = false;
    if (text[0] == '\0') return fail(set, err, "found no value, expected one behind the \"=\"");
    for (const char *at = text; *at != '\0'; at += bp_utf8_length(at))
        if (bp_utf8_length(at) == 0)
            return fail(set, err, "found bytes that are not UTF-8; write the value in that encoding");
    *value = bp_json_load(text, strlen(text), JSON_DECODE_ANY | JSON_REJECT_DUPLICATES, &error, &no_memory);
    if (*value == NULL && !no_memory && json_error_code(&error) == json_error_numeric_overflow)
        *value = bp_json_load(text, strlen(text),
                              JSON_DECODE_ANY | JSON_REJECT_DUPLICATES | JSON_DECODE_INT_AS_REAL, &error,
                              &no_memory);
    if (*value == NULL && !no_memory && is_word(text)) *value = json_string(text);
    if (*value != NULL) return BP_OK;
    if (no_memory) return bp_fail(err, BP_ERR_MEMORY, "out of memory while changing the scene");
    char room[BP_JSON_ADVICE_SIZE], message[BP_JSON_ADVICE_SIZE + 40];
    const size_t at = bp_json_error_place(text, strlen(text), &error);
    const char *const advice = bp_json_advice(text, strlen(text), at, room);
    snprintf(message, sizeof message, "the value is not JSON; %s",
             advice[0] != '\0'
                 ? advice
                 : "expected a number, a word, a list such as [0,1,0], or a text in double quotes");
    return fail(set, err, message);
}

/* ---- the member ---------------------------------------------------------------------------------------- */

/* A place in the document: a member of an object, or an element of a list. */
typedef struct Place {
    json_t *parent;
    char name[128]; /* of the member */
    size_t index;   /* of the element */
    bool element;
    json_t *value; /* borrowed; NULL: absent */
} Place;

/* Members of "materials" can have any name, even one with a dot in it. The longest existing name that stands
 * at `text` is meant; if there is none, everything up to the next "." or "[". */
static size_t name_length(json_t *object, const char *text) {
    size_t longest = 0;
    const char *name;
    json_t *value;
    json_object_foreach(object, name, value) {
        const size_t length = strlen(name);
        if (length > longest && strncmp(text, name, length) == 0 && strchr(".[=", text[length]) != NULL)
            longest = length;
    }
    return longest > 0 ? longest : strcspn(text, ".[=");
}

/* Appends to the path that messages write. */
static void note_step(const Place *place, BpChange *change) {
    const size_t used = strlen(change->path);
    char name[48];
    bp_printable(place->name, name, sizeof name);
    if (place->element)
        snprintf(change->path + used, sizeof change->path - used, "[%zu]", place->index);
    else
        snprintf(change->path + used, sizeof change->path - used, "%s%s", used > 0 ? "." : "", name);
}

static BpStatus read_index(const char *set, json_t *list, const char **at, const BpChange *change,
                           Place *place, BpError *err) {
    char text[400], *end = NULL, found[PRINTABLE_SIZE];
    const char *digits = *at + 1;
    const unsigned long long index = strtoull(digits, &end, 10);
    if (digits[0] < '0' || digits[0] > '9' || *end != ']')
        return fail(set, err, "found \"[\" without a number and \"]\", expected an element such as [0]");
    if (!json_is_array(list)) {
        bp_json_describe(list, found, sizeof found);
        snprintf(text, sizeof text, "%s is %s, expected a list before \"[\"", change->path, found);
        return fail(set, err, text);
    }
    const size_t size = json_array_size(list);
    if (index >= size) {
        snprintf(text, sizeof text, "%s has %zu element%s, expected a number below that", change->path, size,
                 size == 1 ? "" : "s");
        return fail(set, err, text);
    }
    *place = (Place){.parent = list,
                     .index = (size_t)index,
                     .element = true,
                     .value = json_array_get(list, (size_t)index)};
    *at = end + 1;
    return BP_OK;
}

static BpStatus read_name(const char *set, json_t *object, const char **at, const BpChange *change,
                          Place *place, BpError *err) {
    char text[700], found[PRINTABLE_SIZE];
    if (!json_is_object(object)) {
        bp_json_describe(object, found, sizeof found);
        if (json_is_array(object) && json_array_size(object) > 0)
            snprintf(text, sizeof text, "%s is %s, expected an element before the member, such as %s[0]",
                     change->path, found, change->path);
        else
            snprintf(text, sizeof text, "%s is %s, which has no members", change->path, found);
        return fail(set, err, text);
    }
    const size_t length = name_length(object, *at);
    *place = (Place){.parent = object};
    if (length == 0 || length >= sizeof place->name)
        return fail(set, err, "expected the name of a member, such as camera.vfov");
    memcpy(place->name, *at, length);
    place->name[length] = '\0';
    place->value = json_object_get(object, place->name);
    *at += length;
    return BP_OK;
}

/* Follows the path before "=", and adds the objects on its way. */
static BpStatus find_place(const char *set, json_t *root, Place *place, const char **value, BpChange *change,
                           BpError *err) {
    const char *at = set;
    json_t *within = root;
    change->path[0] = '\0';
    for (;;) {
        if (*at == '[' && at > set)
            BP_TRY(read_index(set, within, &at, change, place, err));
        else
            BP_TRY(read_name(set, within, &at, change, place, err));
        note_step(place, change);
        if (*at == '=') {
            *value = at + 1;
            return BP_OK;
        }
        if (*at == '\0') return fail(set, err, "found no value, expected MEMBER=VALUE");
        if (*at == '.')
            ++at;
        else if (*at != '[')
            return fail(set, err, "expected \".\", \"[\" or \"=\" behind an element");
        if (place->value == NULL) {
            place->value = json_object();
            if (json_object_set_new(place->parent, place->name, place->value) != 0)
                return bp_json_memory_failed()
                           ? bp_fail(err, BP_ERR_MEMORY, "out of memory while changing the scene")
                           : fail(set, err, "expected names in UTF-8");
        }
        within = place->value;
    }
}

static BpStatus put(const Place *place, const char *set, json_t *value, BpError *err) {
    bool done;
    if (json_is_null(value) && place->element) {
        json_decref(value);
        return fail(set, err, "null removes members of objects only, not elements of lists");
    }
    if (json_is_null(value)) {
        json_decref(value);
        if (place->value != NULL) json_object_del(place->parent, place->name);
        return BP_OK;
    }
    if (place->element)
        done = json_array_set_new(place->parent, place->index, value) == 0;
    else
        done = json_object_set_new(place->parent, place->name, value) == 0;
    if (!done && bp_json_memory_failed())
        return bp_fail(err, BP_ERR_MEMORY, "out of memory while changing the scene");
    return done ? BP_OK : fail(set, err, "expected the member's name in UTF-8");
}

static BpStatus change(BpDocument *document, size_t number, const char *set, BpError *err) {
    Place place;
    const char *text = NULL;
    json_t *value = NULL;
    BpChange *change = &document->changes[number];
    change->origin = set;
    BP_TRY(find_place(set, document->root, &place, &text, change, err));
    document->change_count = number + 1;
    BP_TRY(read_value(set, text, &value, err));
    return put(&place, set, value, err);
}

BpStatus bp_document_change(BpDocument *document, const char *by, const char *const *set, size_t count,
                            BpError *err) {
    if (count == 0) return BP_OK;
    document->changed_by = by;
    document->written = json_deep_copy(document->root);
    document->changes = calloc(count, sizeof *document->changes);
    /* Without memory for a member, jansson leaves it out of the copy and says nothing. */
    if (document->written == NULL || document->changes == NULL ||
        !json_equal(document->written, document->root))
        return bp_fail(err, BP_ERR_MEMORY, "out of memory while changing the scene");
    BpStatus status = BP_OK;
    for (size_t i = 0; i < count && status == BP_OK; i++) status = change(document, i, set[i], err);
    if (status == BP_ERR_USAGE && err != NULL) bp_fail(err, status, "%s %s", by, err->message);
    return status;
}
