/* input.h: the bytes and lines of a file of particles or of a mesh, unpacked where gzip packed them.
 *
 * In:    a stream.   Out: blocks, lines, words, numbers; errors with file and line.
 * Knows: gzip (zlib), encodings, how programs write numbers.   Does not know: which formats there are. Memory
 * is one block, however long the file. */
#ifndef BP_PARTICLES_INPUT_H
#define BP_PARTICLES_INPUT_H

#include "base/status.h"

#include <stdio.h>

/* What one file may unpack to: past it, reading ends with an error. */
#define BP_INPUT_BYTES_MAX ((uint64_t)1 << 42)
/* The largest block, in bytes, and so the longest line. */
enum { BP_INPUT_BLOCK = 1 << 20 };

typedef struct Input {
    FILE *stream;
    void *gz; /* gzFile */
    const char *name;
    unsigned char *buffer; /* what was read and not yet taken: buffer[begin .. end) */
    size_t capacity, begin, end;
    uint64_t taken; /* bytes before `begin` */
    uint64_t line;  /* of the line last taken, from 1 */
    bool open_line; /* the line last taken had no end: the file ends there */
    char *held;     /* a line that was given back */
    char line_end;  /* the byte that ends lines; 0: no line was read yet */
    bool ended;     /* reading came to the end, or to where packed data is cut off */
    bool failed;    /* reading failed; `failure` says how, in a message's words */
    BpStatus fault; /* BP_ERR_SCENE: the file is damaged; BP_ERR_FILE: it cannot be read; BP_ERR_MEMORY */
    char failure[192];
} Input;

BpStatus input_init(Input *input, FILE *stream, const char *name, BpError *err);
void input_clear(Input *input);
/* Begins again at the file's beginning. */
BpStatus input_rewind(Input *input, BpError *err);
/* Whether gzip packed the file, of which nothing was read yet. */
bool input_is_packed(Input *input);
/* Reads until `count` bytes, at most BP_INPUT_BLOCK, lie at buffer + begin, which may move. False at the
 * end of the file, and where reading failed. */
bool input_fill(Input *input, size_t count);
void input_take(Input *input, size_t count);
/* Passes over `count` bytes; false when the file ends before. */
bool input_skip(Input *input, uint64_t count);

/* Returns to where `taken` bytes and `line` lines were taken. */
BpStatus input_return_to(Input *input, uint64_t taken, uint64_t line, BpError *err);

/* Takes a line; *line is ended by a NUL in place of its end (LF, CR LF, or CR in files that have no other),
 * and valid until the next call; NULL at the end of the file. A byte order mark before it is left away. Fails
 * on lines of BP_INPUT_BLOCK bytes and more, on bytes of value 0, and on text in UTF-16 or UTF-32. */
BpStatus input_line(Input *input, char **line, BpError *err);
/* The same, passing over blank lines. */
BpStatus input_full_line(Input *input, char **line, BpError *err);
/* The same; the end of the file is an error: "found the end of the file, expected `expected`". */
BpStatus input_needed_line(Input *input, char **line, const char *expected, BpError *err);
/* Gives the line last taken back: the next call takes it again. */
void input_hold(Input *input, char *line);

/* Fails with BP_ERR_SCENE and the file's name, and if with_line, the line last taken. Where reading had
 * failed, the message says that instead. */
BpStatus input_fail(const Input *input, bool with_line, BpError *err, const char *format, ...)
    BP_PRINTF_LIKE(4, 5);
/* "found "X", expected `expected`", with the line. */
BpStatus input_wrong(const Input *input, const char *found, const char *expected, BpError *err);

/* Splits at blanks, in place. Returns how many words there are, the first `max` of which are in `words`. */
size_t split_words(char *line, char **words, size_t max);
/* The whole word as a finite number, also with the exponents of bp_table_number_parse(). */
bool word_number(const char *word, double *value);
/* The same where a number may be missing: NaN for what programs write in its place: nan in all spellings, and
 * the stars that Fortran and C leave where a field is too narrow. */
bool word_number_or_none(const char *word, double *value);
/* A truth value as a number: 1 for T, True, true or TRUE, 0 for F and its like. */
bool word_logical(const char *word, double *value);
/* The whole word as a whole number. */
bool word_whole(const char *word, int64_t *value);
/* A count of at most BP_PARTICLES_MAX. */
BpStatus word_count(const Input *input, const char *word, const char *of_what, uint64_t *count, BpError *err);
/* The text in columns first .. last (from 1) of a line of fixed columns, without blanks at both ends. */
const char *fixed_text(const char *line, size_t length, size_t first, size_t last, char *out, size_t size);

#define BP_PARTICLES_MAX 134217728u /* 2^27, as many as a scene may have spheres */

#endif
