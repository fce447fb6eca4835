/* ply_input.c: see ply_parts.h. */
#include "ply_parts.h"

#include "input_file.h"

#include "base/decimal.h"
#include "base/plural.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

enum { BLOCK = 1 << 20 };

BpStatus ply_input_init(PlyInput *input, FILE *stream, uint64_t size, const char *name, BpError *err) {
    *input = (PlyInput){
        .stream = stream, .name = name, .size = size, .capacity = size < BLOCK ? (size_t)size + 64 : BLOCK};
    input->buffer = malloc(input->capacity + 1); /* one more for the NUL after a last line */
    if (input->buffer == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for a block of a PLY file");
    return BP_OK;
}

void ply_input_clear(PlyInput *input) {
    free(input->buffer);
    input->buffer = NULL;
}

bool ply_input_fill(PlyInput *input, size_t count) {
    if (input->end - input->begin >= count) return true;
    memmove(input->buffer, input->buffer + input->begin, input->end - input->begin);
    input->end -= input->begin;
    input->begin = 0;
    input->end += fread(input->buffer + input->end, 1, input->capacity - input->end, input->stream);
    return input->end >= count;
}

void ply_input_take(PlyInput *input, size_t count) {
    input->begin += count;
    input->taken += count;
}

bool ply_input_skip(PlyInput *input, uint64_t count) {
    while (count > 0) {
        if (!ply_input_fill(input, 1)) return false;
        const size_t here = input->end - input->begin;
        const size_t some = count < here ? (size_t)count : here;
        ply_input_take(input, some);
        count -= some;
    }
    return true;
}

BpStatus ply_fail(const PlyInput *input, bool with_line, BpError *err, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    const BpStatus status =
        bp_stream_fail(input->stream, input->name, with_line ? input->line : 0, err, format, arguments);
    va_end(arguments);
    return status;
}

BpStatus ply_input_line(PlyInput *input, char **line, BpError *err) {
    input->line++;
    size_t seen = 0;
    unsigned char *end = NULL;
    for (;;) {
        const size_t here = input->end - input->begin;
        if (here > seen) end = memchr(input->buffer + input->begin + seen, '\n', here - seen);
        seen = here;
        if (end != NULL) break;
        if (here == input->capacity)
            return ply_fail(input, true, err, "found a line of over %zu bytes, expected a PLY file's lines",
                            here);
        if (!ply_input_fill(input, here + 1)) {
            if (here == 0)
                return ply_fail(input, true, err, "found the end of the file, expected more lines");
            end = input->buffer + input->end; /* a last line without its end */
            break;
        }
    }
    unsigned char *const start = input->buffer + input->begin;
    const size_t length = (size_t)(end - start);
    ply_input_take(input, input->begin + length < input->end ? length + 1 : length);
    if (memchr(start, '\0', length) != NULL)
        return ply_fail(
            input, true, err,
            "found a byte of value 0, expected text: a binary file needs another \"format\", or the "
            "file is damaged");
    *end = '\0';
    if (length > 0 && start[length - 1] == '\r') start[length - 1] = '\0';
    *line = (char *)start;
    return BP_OK;
}

BpStatus ply_input_end(PlyInput *input, bool lines, BpError *err) {
    static const char remedy[] =
        "expected the end of the file: correct the counts in its header, or remove what follows";
    while (ply_input_fill(input, 1)) {
        char *line;
        if (!lines)
            return ply_fail(input, false, err,
                            "found %" PRIu64 " byte%s after the last element, from byte %" PRIu64 " on, %s",
                            input->size - input->taken, bp_plural(input->size - input->taken), input->taken,
                            remedy);
        BP_TRY(ply_input_line(input, &line, err));
        if (line[strspn(line, " \t\r")] != '\0')
            return ply_fail(input, true, err, "found another line after the last element, %s", remedy);
    }
    return BP_OK;
}

static bool is_space(char c) {
    return c == ' ' || c == '\t' || c == '\r';
}
bool ply_parse_number(char **cursor, double *value) {
    while (is_space(**cursor)) (*cursor)++;
    if (**cursor == '\0') return false;
    const char *const after = bp_decimal_parse(*cursor, value);
    if (after == NULL || (*after != '\0' && !is_space(*after))) return false;
    *cursor += after - *cursor;
    return true;
}
