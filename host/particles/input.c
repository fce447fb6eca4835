/* input.c: see input.h. */
#include "input.h"

#include "base/decimal.h"
#include "base/encoding.h"
#include "base/message_text.h"

#include <errno.h>
#include <inttypes.h>
#include <limits.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>
#include <zlib.h>

/* A block grows from this to BP_INPUT_BLOCK while there is more to read, since most files are short. */
enum { FIRST_BLOCK = 1 << 10 };
/* The byte that ends texts of DOS. */
enum { DOS_END = 0x1a };
/* From this many bytes on, zlib gets larger buffers. */
enum { LARGE_FILE = 1 << 17 };

BpStatus input_init(Input *input, FILE *stream, const char *name, BpError *err) {
    *input = (Input){.stream = stream, .name = name, .capacity = FIRST_BLOCK};
    input->buffer = malloc(FIRST_BLOCK + 1); /* one more for the NUL after a last line */
    if (input->buffer == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for a block of a file");
    return input_rewind(input, err);
}

void input_clear(Input *input) {
    if (input->gz != NULL) gzclose(input->gz);
    free(input->buffer);
    *input = (Input){0};
}

BpStatus input_rewind(Input *input, BpError *err) {
    if (input->gz != NULL) gzclose(input->gz);
    input->gz = NULL;
    input->begin = input->end = 0;
    input->taken = input->line = 0;
    input->held = NULL;
    input->ended = input->failed = false;
    /* zlib closes what it opens, so it gets a descriptor of its own; they share their place in the file. It
     * passes bytes through unchanged where there is no gzip header. */
    const int descriptor = dup(fileno(input->stream));
    const off_t size = descriptor >= 0 ? lseek(descriptor, 0, SEEK_END) : -1;
    if (size >= 0 && lseek(descriptor, 0, SEEK_SET) == 0) input->gz = gzdopen(descriptor, "rb");
    if (input->gz == NULL) {
        const BpStatus status = bp_fail(err, BP_ERR_FILE, "cannot read it: %s", strerror(errno));
        if (descriptor >= 0) close(descriptor);
        bp_error_at(err, input->name, 0, 0);
        return status;
    }
    gzbuffer(input->gz, size < LARGE_FILE ? 1 << 12 : 1 << 17);
    return BP_OK;
}

bool input_is_packed(Input *input) {
    return !gzdirect(input->gz);
}

/* Doubles the block, or makes it hold `count` bytes, up to the largest. */
static bool grow(Input *input, size_t count) {
    size_t capacity = 2 * input->capacity;
    if (capacity < count) capacity = count;
    if (capacity > BP_INPUT_BLOCK) capacity = BP_INPUT_BLOCK;
    unsigned char *const grown = realloc(input->buffer, capacity + 1);
    if (grown == NULL) {
        input->failed = true;
        input->fault = BP_ERR_MEMORY;
        return false;
    }
    input->buffer = grown;
    input->capacity = capacity;
    return true;
}

bool input_fill(Input *input, size_t count) {
    if (input->end - input->begin >= count) return true;
    if (input->failed) return false;
    memmove(input->buffer, input->buffer + input->begin, input->end - input->begin);
    input->end -= input->begin;
    input->begin = 0;
    /* What was read before filled the block, or `count` does not fit. */
    const bool is_full = input->taken + input->end >= input->capacity || count > input->capacity;
    if (is_full && input->capacity < BP_INPUT_BLOCK && !grow(input, count)) return false;
    while (input->end < count) {
        const int got =
            gzread(input->gz, input->buffer + input->end, (unsigned)(input->capacity - input->end));
        int code = Z_OK;
        const char *const text = gzerror(input->gz, &code);
        const bool is_cut =
            got == 0 && code == Z_BUF_ERROR; /* amid packed data, all of which was handed over */
        if (got < 0 || is_cut) {
            input->failed = true;
            input->fault = code == Z_MEM_ERROR ? BP_ERR_MEMORY : code == Z_ERRNO ? BP_ERR_FILE : BP_ERR_SCENE;
            const char *const what = code == Z_BUF_ERROR ? "its gzip data is cut off" : text;
            if (code == Z_ERRNO)
                snprintf(input->failure, sizeof input->failure, "cannot read it: %s", strerror(errno));
            else
                snprintf(input->failure, sizeof input->failure, "found damage, expected a whole file: %s",
                         what);
        }
        input->ended |= got == 0;
        if (got > 0) input->end += (size_t)got;
        if (got <= 0 || input->failed) break;
        if (input->taken + input->end > BP_INPUT_BYTES_MAX) {
            input->failed = true;
            input->fault = BP_ERR_SCENE;
            snprintf(input->failure, sizeof input->failure,
                     "found more than %" PRIu64 " GiB when unpacked, expected less",
                     BP_INPUT_BYTES_MAX >> 30);
        }
    }
    return input->end >= count;
}

void input_take(Input *input, size_t count) {
    input->begin += count;
    input->taken += count;
}

bool input_skip(Input *input, uint64_t count) {
    while (count > 0) {
        if (!input_fill(input, 1)) return false;
        const size_t here = input->end - input->begin;
        const size_t some = count < here ? (size_t)count : here;
        input_take(input, some);
        count -= some;
    }
    return true;
}

BpStatus input_return_to(Input *input, uint64_t taken, uint64_t line, BpError *err) {
    BP_TRY(input_rewind(input, err));
    if (!input_skip(input, taken))
        return input_fail(input, false, err, "found a shorter file than before, expected it unchanged");
    input->line = line;
    return BP_OK;
}

BpStatus input_fail(const Input *input, bool with_line, BpError *err, const char *format, ...) {
    char text[768];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    const BpStatus status = input->failed ? input->fault : BP_ERR_SCENE;
    if (status == BP_ERR_MEMORY && input->failed)
        snprintf(text, sizeof text, "out of memory for reading it");
    else if (input->failed)
        snprintf(text, sizeof text, "%s", input->failure);
    bp_fail(err, status, "%s", text);
    bp_error_at(err, input->name, !with_line ? 0 : input->line < INT_MAX ? (int)input->line : INT_MAX, 0);
    return status;
}

BpStatus input_wrong(const Input *input, const char *found, const char *expected, BpError *err) {
    char shown[48];
    bp_printable(found, shown, sizeof shown);
    return input_fail(input, true, err, "found \"%s\", expected %s", shown, expected);
}

/* Before the first line: its encoding, and what ends lines. That is LF, or CR LF; where the beginning of a
 * file has more CR than LF, it is CR, as on computers of Apple before 2001. */
static BpStatus begin_lines(Input *input, BpError *err) {
    (void)input_fill(input, 4);
    const unsigned char *const text = input->buffer + input->begin;
    const size_t length = input->end - input->begin;
    const char *const wide = bp_text_wide(text, length);
    if (wide != NULL) return input_fail(input, false, err, BP_TEXT_WIDE_FORMAT, wide, wide);
    size_t feeds = 0, returns = 0;
    for (size_t i = 0; i < length; i++) {
        feeds += text[i] == '\n';
        returns += text[i] == '\r' && i + 1 < length && text[i + 1] != '\n';
    }
    input->line_end = returns > feeds ? '\r' : '\n';
    return BP_OK;
}

BpStatus input_line(Input *input, char **line, BpError *err) {
    if (input->held != NULL) {
        *line = input->held;
        input->held = NULL;
        input->line++;
        return BP_OK;
    }
    size_t seen = 0;
    unsigned char *end = NULL;
    *line = NULL;
    input->line++;
    if (input->line_end == '\0') BP_TRY(begin_lines(input, err));
    for (;;) {
        const size_t here = input->end - input->begin;
        if (here > seen) end = memchr(input->buffer + input->begin + seen, input->line_end, here - seen);
        seen = here;
        if (end != NULL) break;
        if (here == BP_INPUT_BLOCK)
            return input_fail(input, true, err, "found a line of over %zu bytes, expected shorter lines",
                              here);
        if (!input_fill(input, here + 1)) {
            if (input->failed) return input_fail(input, true, err, "%s", "");
            if (here == 0) return BP_OK;
            end = input->buffer + input->end; /* a last line without its end */
            break;
        }
    }
    unsigned char *start = input->buffer + input->begin;
    size_t length = (size_t)(end - start);
    input->open_line = input->begin + length == input->end;
    input_take(input, input->begin + length < input->end ? length + 1 : length);
    if (input->open_line && length == 1 && *start == DOS_END) return BP_OK;
    /* Files that were joined have marks amid them. */
    const size_t mark = bp_text_mark(start, length);
    start += mark;
    length -= mark;
    if (memchr(start, '\0', length) != NULL)
        return input_fail(
            input, true, err,
            "found a byte of value 0, expected text: the file is damaged, or of another format");
    *end = '\0';
    if (length > 0 && start[length - 1] == '\r') start[length - 1] = '\0';
    *line = (char *)start;
    return BP_OK;
}

BpStatus input_full_line(Input *input, char **line, BpError *err) {
    do BP_TRY(input_line(input, line, err));
    while (*line != NULL && (*line)[strspn(*line, " \t\r")] == '\0');
    return BP_OK;
}

BpStatus input_needed_line(Input *input, char **line, const char *expected, BpError *err) {
    BP_TRY(input_line(input, line, err));
    if (*line != NULL) return BP_OK;
    return input_fail(input, true, err, "found the end of the file, expected %s", expected);
}

void input_hold(Input *input, char *line) {
    input->held = line;
    input->line--;
}

size_t split_words(char *line, char **words, size_t max) {
    size_t count = 0;
    for (;;) {
        line += strspn(line, " \t\r");
        if (*line == '\0') return count;
        if (count < max) words[count] = line;
        count++;
        line += strcspn(line, " \t\r");
        if (*line != '\0') *line++ = '\0';
    }
}

bool word_number(const char *word, double *value) {
    const char *const end = bp_table_number_parse(word, value);
    return end != NULL && *end == '\0' && isfinite(*value);
}

bool word_number_or_none(const char *word, double *value) {
    /* Those of IBM's compilers, and of Microsoft's until 2013. */
    static const char *const none[] = {"nanq", "1.#qnan", "1.#ind"};
    const char *const end = bp_table_number_parse(word, value);
    if (end != NULL && *end == '\0') return !isinf(*value);
    const char *const unsigned_word = *word == '-' || *word == '+' ? word + 1 : word;
    bool found = *word == '*' && word[strspn(word, "*")] == '\0';
    for (size_t i = 0; i < sizeof none / sizeof *none && !found; i++) {
        const size_t length = strlen(none[i]);
        found = strncasecmp(unsigned_word, none[i], length) == 0 &&
                unsigned_word[length + strspn(unsigned_word + length, "0")] == '\0';
    }
    if (found) *value = NAN;
    return found;
}

bool word_logical(const char *word, double *value) {
    static const char *const words[] = {"F", "False", "false", "FALSE", "T", "True", "true", "TRUE"};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
        if (strcmp(word, words[i]) != 0) continue;
        *value = i >= 4;
        return true;
    }
    return false;
}

bool word_whole(const char *word, int64_t *value) {
    const char *const end = bp_whole_parse(word, value);
    return end != NULL && *end == '\0';
}

BpStatus word_count(const Input *input, const char *word, const char *of_what, uint64_t *count,
                    BpError *err) {
    int64_t value = 0;
    char shown[48];
    if (word_whole(word, &value) && value >= 0 && value <= (int64_t)BP_PARTICLES_MAX) {
        *count = (uint64_t)value;
        return BP_OK;
    }
    bp_printable(word, shown, sizeof shown);
    return input_fail(input, true, err, "found \"%s\", expected the number of %s, at most %u", shown, of_what,
                      BP_PARTICLES_MAX);
}

const char *fixed_text(const char *line, size_t length, size_t first, size_t last, char *out, size_t size) {
    size_t begin = first - 1 < length ? first - 1 : length, end = last < length ? last : length;
    while (begin < end && (line[begin] == ' ' || line[begin] == '\t')) begin++;
    while (end > begin && (line[end - 1] == ' ' || line[end - 1] == '\t' || line[end - 1] == '\r')) end--;
    size_t count = end - begin;
    if (count > size - 1) count = size - 1;
    memcpy(out, line + begin, count);
    out[count] = '\0';
    return out;
}
