/* gltf_data.c: see gltf_data.h. Source: Khronos Group, glTF 2.0 Specification, sections 3.6 and 4.4. */
#include "gltf_data.h"

#include "base/encoding.h"
#include "base/input_file.h"
#include "base/json_memory.h"
#include "base/message_text.h"
#include "reader.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { PLACE_SIZE = 96, CHUNK_JSON = 0x4E4F534A, CHUNK_BIN = 0x004E4942 };

BpStatus gltf_fail(const GltfData *data, const char *place, BpError *err, const char *format, ...) {
    char text[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    return input_fail(data->input, false, err, "%s%s%s", place, place[0] != '\0' ? ": " : "", text);
}

BpStatus gltf_fail_memory(BpError *err) {
    return bp_fail(err, BP_ERR_MEMORY, "out of memory for a glTF file");
}

/* ---- the document ------------------------------------------------------------------------------------- */

BpStatus gltf_element(const GltfData *data, const char *list, size_t number, json_t **element, BpError *err) {
    const json_t *const elements = json_object_get(data->root, list);
    *element = json_array_get(elements, number);
    if (json_is_object(*element)) return BP_OK;
    return gltf_fail(data, "", err, "found no object %s[%zu], expected one: the list has %zu", list, number,
                     json_array_size(elements));
}

BpStatus gltf_whole(const GltfData *data, const json_t *object, const char *member, const char *place,
                    bool *found, size_t *value, BpError *err) {
    const json_t *const number = json_object_get(object, member);
    *found = number != NULL;
    if (number == NULL) return BP_OK;
    const double as_real = json_number_value(number);
    if (!json_is_number(number) || as_real < 0 || as_real > 9007199254740992.0 || floor(as_real) != as_real)
        return gltf_fail(data, place, err, "found a \"%s\" that is no whole number from 0", member);
    *value = (size_t)as_real;
    return BP_OK;
}

/* The same of a member that may be left out. */
static BpStatus whole_or(const GltfData *data, const json_t *object, const char *member, const char *place,
                         size_t otherwise, size_t *value, BpError *err) {
    bool found = false;
    BP_TRY(gltf_whole(data, object, member, place, &found, value, err));
    if (!found) *value = otherwise;
    return BP_OK;
}

/* The same of a member that must be there. */
static BpStatus needed_whole(const GltfData *data, const json_t *object, const char *member,
                             const char *place, size_t *value, BpError *err) {
    bool found = false;
    BP_TRY(gltf_whole(data, object, member, place, &found, value, err));
    return found ? BP_OK : gltf_fail(data, place, err, "found no \"%s\", expected a whole number", member);
}

BpStatus gltf_numbers(const GltfData *data, const json_t *object, const char *member, const char *place,
                      double *values, size_t count, BpError *err) {
    const json_t *const list = json_object_get(object, member);
    if (list == NULL) return BP_OK;
    for (size_t i = 0; i < count; i++) {
        const json_t *const number = count == 1 && json_is_number(list) ? list : json_array_get(list, i);
        if (!json_is_number(number) || (count > 1 && json_array_size(list) != count))
            return gltf_fail(data, place, err, "found a \"%s\" that is not %zu number%s", member, count,
                             count == 1 ? "" : "s");
        values[i] = json_number_value(number);
    }
    return BP_OK;
}

/* ---- the file ----------------------------------------------------------------------------------------- */

static BpStatus read_whole(GltfData *data, size_t *length, BpError *err) {
    Input *const input = data->input;
    size_t capacity = 0;
    *length = 0;
    for (;;) {
        (void)input_fill(input, BP_INPUT_BLOCK);
        const size_t more = input->end - input->begin;
        if (more == 0) break;
        if (*length + more > BP_TEXT_BYTES_MAX)
            return gltf_fail(data, "", err,
                             "found more than 512 MB, expected fewer; export it as binary PLY");
        if (*length + more > capacity) {
            capacity = *length + more + *length / 2;
            unsigned char *const grown = realloc(data->file, capacity);
            if (grown == NULL) return gltf_fail_memory(err);
            data->file = grown;
        }
        memcpy(data->file + *length, input->buffer + input->begin, more);
        *length += more;
        input_take(input, more);
    }
    return input->failed ? gltf_fail(data, "", err, "it cannot be read") : BP_OK;
}

/* Finds the document, and the chunk of numbers, in a binary file. */
static BpStatus part_chunks(GltfData *data, size_t length, const unsigned char **text, size_t *text_length,
                            BpError *err) {
    const unsigned char *const file = data->file;
    if (length < 12) return gltf_fail(data, "", err, "found the end of the file within the header");
    const size_t version = mesh_word_at(file + 4), end = mesh_word_at(file + 8);
    if (version != 2)
        return gltf_fail(data, "", err, "found glTF of version %zu, expected 2: export it anew", version);
    if (end > length)
        return gltf_fail(data, "", err,
                         "found %zu bytes, expected the %zu that the header counts: the file is cut off",
                         length, end);
    *text = NULL;
    for (size_t at = 12; at + 8 <= end;) {
        const size_t size = mesh_word_at(file + at), kind = mesh_word_at(file + at + 4);
        if (size > end - at - 8)
            return gltf_fail(data, "", err, "found a chunk of %zu bytes with %zu left, expected fewer", size,
                             end - at - 8);
        if (kind == CHUNK_JSON && *text == NULL) {
            *text = file + at + 8;
            *text_length = size;
        } else if (kind == CHUNK_BIN && data->chunk == NULL) {
            data->chunk = file + at + 8;
            data->chunk_length = size;
        }
        at += 8 + size;
    }
    return *text != NULL ? BP_OK : gltf_fail(data, "", err, "found no chunk of JSON, expected one");
}

static BpStatus parse_document(GltfData *data, const unsigned char *text, size_t length, BpError *err) {
    json_error_t error;
    bool no_memory = false;
    data->root = bp_json_load(length > 0 ? (const char *)text : "", length, 0, &error, &no_memory);
    if (no_memory) return gltf_fail_memory(err);
    if (data->root == NULL) {
        char found[sizeof error.text];
        bp_printable(error.text, found, sizeof found);
        return gltf_fail(data, "", err, "not JSON: line %d: %s", error.line, found);
    }
    const json_t *const asset = json_object_get(data->root, "asset");
    const char *const version = json_string_value(json_object_get(asset, "version"));
    if (version == NULL || strncmp(version, "2", 1) != 0) {
        char found[32];
        bp_printable(version != NULL ? version : "none", found, sizeof found);
        return gltf_fail(data, "", err, "found %s for asset.version, expected glTF 2.0: export it anew",
                         found);
    }
    return BP_OK;
}

/* ---- buffers ------------------------------------------------------------------------------------------ */

static int base64_digit(char c) {
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const char *const at = c != '\0' ? strchr(digits, c) : NULL;
    return at != NULL ? (int)(at - digits) : -1;
}

/* Decodes base64 (RFC 4648, section 4); false if it is none. */
static bool decode(const char *text, unsigned char *out, size_t *length) {
    unsigned held = 0, bits = 0;
    *length = 0;
    for (; *text != '\0' && *text != '='; text++) {
        const int digit = base64_digit(*text);
        if (digit < 0) return false;
        held = (held << 6 | (unsigned)digit) & 0xFFFF;
        bits += 6;
        if (bits < 8) continue;
        bits -= 8;
        out[(*length)++] = (unsigned char)(held >> bits & 0xFF);
    }
    return text[strspn(text, "=")] == '\0';
}

/* Of "data:...;base64,...". */
static BpStatus decode_uri(const GltfData *data, const char *place, const char *uri, unsigned char **own,
                           size_t *length, BpError *err) {
    const char *const comma = strchr(uri, ',');
    if (comma == NULL || comma - uri < 7 || strncmp(comma - 7, ";base64", 7) != 0)
        return gltf_fail(data, place, err, "found data in the document that is not in base64");
    *own = malloc(strlen(comma) + 1);
    if (*own == NULL) return gltf_fail_memory(err);
    if (decode(comma + 1, *own, length)) return BP_OK;
    free(*own);
    *own = NULL;
    return gltf_fail(data, place, err, "found a character that base64 does not have");
}

static int hex_digit(char c) {
    return c >= '0' && c <= '9'   ? c - '0'
           : c >= 'a' && c <= 'f' ? c - 'a' + 10
           : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                  : -1;
}

/* Resolves %20 and its like, in place. */
static void unescape(char *uri) {
    char *out = uri;
    for (; *uri != '\0'; uri++, out++) {
        const int high = *uri == '%' ? hex_digit(uri[1]) : -1, low = high >= 0 ? hex_digit(uri[2]) : -1;
        *out = low > 0 || high > 0 ? (char)(high * 16 + low) : *uri;
        if (low > 0 || high > 0) uri += 2;
    }
    *out = '\0';
}

static BpStatus read_beside(GltfData *data, GltfBuffer *buffer, const char *uri, BpError *err) {
    char *const name = strdup(uri);
    if (name == NULL) return gltf_fail_memory(err);
    unescape(name);
    char *const path = bp_path_beside(data->path, name);
    free(name);
    if (path == NULL) return gltf_fail_memory(err);
    char *bytes = NULL;
    const BpStatus status =
        bp_file_read(path, "a file of numbers that a glTF file names", &bytes, &buffer->length, err);
    free(path);
    buffer->bytes = buffer->own = (unsigned char *)bytes;
    return status;
}

static BpStatus read_buffer(GltfData *data, size_t number, BpError *err) {
    GltfBuffer *const buffer = &data->buffers[number];
    json_t *element = NULL;
    char place[PLACE_SIZE];
    size_t length = 0;
    snprintf(place, sizeof place, "buffers[%zu]", number);
    BP_TRY(gltf_element(data, "buffers", number, &element, err));
    BP_TRY(needed_whole(data, element, "byteLength", place, &length, err));
    const char *const uri = json_string_value(json_object_get(element, "uri"));
    if (uri == NULL) {
        buffer->bytes = number == 0 ? data->chunk : NULL;
        buffer->length = number == 0 ? data->chunk_length : 0;
    } else if (strncmp(uri, "data:", 5) == 0) {
        BP_TRY(decode_uri(data, place, uri, &buffer->own, &buffer->length, err));
        buffer->bytes = buffer->own;
    } else if (strstr(uri, "://") != NULL) {
        return gltf_fail(data, place, err,
                         "found an address of the network, expected a file: download it, and name it there");
    } else {
        BP_TRY(read_beside(data, buffer, uri, err));
    }
    if (buffer->length < length)
        return gltf_fail(data, place, err, "found %zu bytes, expected the %zu that \"byteLength\" counts",
                         buffer->length, length);
    buffer->length = length;
    return BP_OK;
}

BpStatus gltf_read(GltfData *data, Input *input, const char *path, BpError *err) {
    size_t length = 0, text_length = 0;
    const unsigned char *text = NULL;
    *data = (GltfData){.input = input, .path = path};
    BP_TRY(read_whole(data, &length, err));
    if (length >= 4 && memcmp(data->file, "glTF", 4) == 0) {
        BP_TRY(part_chunks(data, length, &text, &text_length, err));
    } else {
        text = data->file;
        text_length = length;
    }
    BP_TRY(parse_document(data, text, text_length, err));
    const size_t count = json_array_size(json_object_get(data->root, "buffers"));
    data->buffers = calloc(count + 1, sizeof *data->buffers);
    if (data->buffers == NULL) return gltf_fail_memory(err);
    data->buffer_count = count;
    for (size_t i = 0; i < count; i++) BP_TRY(read_buffer(data, i, err));
    return BP_OK;
}

void gltf_clear(GltfData *data) {
    for (size_t i = 0; i < data->buffer_count; i++) free(data->buffers[i].own);
    free(data->buffers);
    json_decref(data->root);
    free(data->file);
    *data = (GltfData){0};
}

/* ---- accessors ---------------------------------------------------------------------------------------- */

typedef enum Component { BYTE = 5120, UBYTE, SHORT, USHORT, UINT = 5125, FLOAT } Component;

static size_t size_of(size_t type) {
    return type == BYTE || type == UBYTE     ? 1
           : type == SHORT || type == USHORT ? 2
           : type == UINT || type == FLOAT   ? 4
                                             : 0;
}

/* Section 3.6.2.2: whole numbers may stand for shares from 0, or from -1, to 1. */
static double number_at(const unsigned char *bytes, size_t type, bool normalized) {
    const unsigned word = (unsigned)bytes[0] | (size_of(type) > 1 ? (unsigned)bytes[1] << 8 : 0);
    switch ((Component)type) {
    case BYTE:
        return normalized ? fmax((double)(int8_t)word / 127, -1) : (double)(int8_t)word;
    case UBYTE:
        return normalized ? word / 255.0 : word;
    case SHORT:
        return normalized ? fmax((double)(int16_t)word / 32767, -1) : (double)(int16_t)word;
    case USHORT:
        return normalized ? word / 65535.0 : word;
    case UINT:
        return (double)mesh_word_at(bytes) / (normalized ? 4294967295.0 : 1);
    case FLOAT:
        return mesh_float_at(bytes);
    }
    return 0;
}

/* Bytes of a view, from `offset` on. */
typedef struct View {
    const unsigned char *bytes;
    size_t length, stride; /* stride 0: rows follow each other */
} View;

static BpStatus find_view(const GltfData *data, size_t number, size_t offset, View *view, BpError *err) {
    json_t *element = NULL;
    char place[PLACE_SIZE];
    size_t buffer = 0, begin = 0, length = 0;
    snprintf(place, sizeof place, "bufferViews[%zu]", number);
    BP_TRY(gltf_element(data, "bufferViews", number, &element, err));
    BP_TRY(needed_whole(data, element, "buffer", place, &buffer, err));
    BP_TRY(whole_or(data, element, "byteOffset", place, 0, &begin, err));
    BP_TRY(needed_whole(data, element, "byteLength", place, &length, err));
    BP_TRY(whole_or(data, element, "byteStride", place, 0, &view->stride, err));
    if (buffer >= data->buffer_count)
        return gltf_fail(data, place, err, "found buffer %zu, expected one of %zu", buffer,
                         data->buffer_count);
    const GltfBuffer *const of = &data->buffers[buffer];
    if (begin > of->length || length > of->length - begin)
        return gltf_fail(data, place, err, "found bytes %zu to %zu, expected some of %zu", begin,
                         begin + length, of->length);
    if (offset > length)
        return gltf_fail(data, place, err, "found an accessor that begins at byte %zu, expected one of %zu",
                         offset, length);
    view->bytes = of->bytes + begin + offset;
    view->length = length - offset;
    return BP_OK;
}

BpStatus gltf_image(const GltfData *data, size_t number, GltfImage *image, BpError *err) {
    json_t *element = NULL;
    char place[PLACE_SIZE];
    size_t view_number = 0;
    View view;
    *image = (GltfImage){0};
    snprintf(place, sizeof place, "images[%zu]", number);
    BP_TRY(gltf_element(data, "images", number, &element, err));
    const char *const uri = json_string_value(json_object_get(element, "uri"));
    if (uri == NULL) {
        BP_TRY(needed_whole(data, element, "bufferView", place, &view_number, err));
        BP_TRY(find_view(data, view_number, 0, &view, err));
        image->bytes = view.bytes;
        image->length = view.length;
    } else if (strncmp(uri, "data:", 5) == 0) {
        BP_TRY(decode_uri(data, place, uri, &image->own, &image->length, err));
        image->bytes = image->own;
    } else {
        image->name = strdup(uri);
        if (image->name == NULL) return gltf_fail_memory(err);
        unescape(image->name);
    }
    return BP_OK;
}

/* `count` rows of a view, as numbers. */
static BpStatus read_rows(const GltfData *data, const char *place, View view, size_t type, bool normalized,
                          size_t count, size_t components, double *values, BpError *err) {
    /* The columns of small square matrices begin at multiples of four bytes, which only 4x4 of floats, the
     * one that is read, always does. */
    const size_t row = size_of(type) * components, stride = view.stride > 0 ? view.stride : row;
    if (stride < row) return gltf_fail(data, place, err, "found rows of %zu bytes %zu apart", row, stride);
    if (count > 0 && (view.length < row || (count - 1) > (view.length - row) / stride))
        return gltf_fail(data, place, err,
                         "found %zu rows of %zu bytes, expected as many as its view has, of %zu bytes", count,
                         row, view.length);
    for (size_t i = 0; i < count; i++)
        for (size_t c = 0; c < components; c++)
            values[i * components + c] =
                number_at(view.bytes + i * stride + c * size_of(type), type, normalized);
    return BP_OK;
}

static size_t components_of(const char *type) {
    static const struct {
        const char *name;
        size_t components;
    } types[] = {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT4", 16}};
    for (size_t i = 0; type != NULL && i < sizeof types / sizeof *types; i++)
        if (strcmp(types[i].name, type) == 0) return types[i].components;
    return 0;
}

/* Rows that stand elsewhere, and which rows they replace. */
static BpStatus replace_rows(const GltfData *data, const char *place, const json_t *sparse, size_t type,
                             bool normalized, GltfRows *rows, BpError *err) {
    const json_t *const indices = json_object_get(sparse, "indices"), *const values =
                                                                          json_object_get(sparse, "values");
    size_t count = 0, number = 0, offset = 0, index_type = 0;
    View view;
    BP_TRY(needed_whole(data, sparse, "count", place, &count, err));
    BP_TRY(needed_whole(data, indices, "bufferView", place, &number, err));
    BP_TRY(whole_or(data, indices, "byteOffset", place, 0, &offset, err));
    BP_TRY(needed_whole(data, indices, "componentType", place, &index_type, err));
    BP_TRY(find_view(data, number, offset, &view, err));
    if (size_of(index_type) == 0 || index_type == FLOAT || count > view.length)
        return gltf_fail(data, place, err, "found sparse rows that do not fit their view");
    double *const which = malloc((count + 1) * sizeof *which);
    double *const what = malloc((count * rows->components + 1) * sizeof *what);
    BpStatus status = which != NULL && what != NULL ? BP_OK : gltf_fail_memory(err);
    if (status == BP_OK) status = read_rows(data, place, view, index_type, false, count, 1, which, err);
    if (status == BP_OK) status = needed_whole(data, values, "bufferView", place, &number, err);
    if (status == BP_OK) status = whole_or(data, values, "byteOffset", place, 0, &offset, err);
    if (status == BP_OK) status = find_view(data, number, offset, &view, err);
    if (status == BP_OK)
        status = read_rows(data, place, view, type, normalized, count, rows->components, what, err);
    for (size_t i = 0; i < count && status == BP_OK; i++) {
        if (which[i] < 0 || which[i] >= (double)rows->count)
            status = gltf_fail(data, place, err, "found sparse row %g, expected one of %zu", which[i],
                               rows->count);
        else
            memcpy(&rows->values[(size_t)which[i] * rows->components], &what[i * rows->components],
                   rows->components * sizeof *what);
    }
    free(which);
    free(what);
    return status;
}

BpStatus gltf_rows(const GltfData *data, size_t number, size_t components, size_t or_components,
                   GltfRows *rows, BpError *err) {
    json_t *element = NULL;
    char place[PLACE_SIZE];
    size_t type = 0, offset = 0, view_number = 0, total = 0;
    bool has_view = false;
    View view = {0};
    *rows = (GltfRows){0};
    snprintf(place, sizeof place, "accessors[%zu]", number);
    BP_TRY(gltf_element(data, "accessors", number, &element, err));
    BP_TRY(needed_whole(data, element, "componentType", place, &type, err));
    BP_TRY(needed_whole(data, element, "count", place, &rows->count, err));
    BP_TRY(whole_or(data, element, "byteOffset", place, 0, &offset, err));
    BP_TRY(gltf_whole(data, element, "bufferView", place, &has_view, &view_number, err));
    rows->components = components_of(json_string_value(json_object_get(element, "type")));
    const bool normalized = json_is_true(json_object_get(element, "normalized"));
    const json_t *const sparse = json_object_get(element, "sparse");
    if (size_of(type) == 0)
        return gltf_fail(data, place, err, "found componentType %zu, which there is not", type);
    if (rows->components != components && rows->components != or_components)
        return gltf_fail(data, place, err, "found rows of another type, expected %zu numbers in each",
                         components);
    if (has_view) BP_TRY(find_view(data, view_number, offset, &view, err));
    /* What a count promises is there, or zeros of an accessor without a view are as many as there are bytes.
     */
    for (size_t i = 0; i < data->buffer_count; i++) total += data->buffers[i].length;
    if (rows->count > (has_view ? view.length : total) / (size_of(type) * rows->components))
        return gltf_fail(data, place, err, "found %zu rows, expected no more than there are bytes for",
                         rows->count);
    rows->whole_numbers = type != FLOAT && !normalized;
    rows->values = calloc(rows->count * rows->components + 1, sizeof *rows->values);
    if (rows->values == NULL) return gltf_fail_memory(err);
    BpStatus status = has_view ? read_rows(data, place, view, type, normalized, rows->count, rows->components,
                                           rows->values, err)
                               : BP_OK;
    if (status == BP_OK && json_is_object(sparse))
        status = replace_rows(data, place, sparse, type, normalized, rows, err);
    if (status != BP_OK) {
        free(rows->values);
        *rows = (GltfRows){0};
    }
    return status;
}
