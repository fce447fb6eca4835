/* ply_parts.h: what the files of the PLY reader share: its input and the header.
 *
 * In:    a stream.   Out: bytes, lines, the header's elements and properties.
 * Does not know: spheres. */
#ifndef BP_FORMATS_PLY_PARTS_H
#define BP_FORMATS_PLY_PARTS_H

#include "base/status.h"
#include "particles/ply_type.h"

#include <stdio.h>

/* ---- input: a stream, block by block --------------------------------------------------------------------
 */

typedef struct PlyInput {
    FILE *stream;
    const char *name;      /* for messages */
    unsigned char *buffer; /* what was read and not yet taken: buffer[begin .. end) */
    size_t capacity, begin, end;
    uint64_t taken; /* bytes before `begin` */
    uint64_t size;  /* of the whole */
    int line;       /* of the line last taken, from 1 */
} PlyInput;

BpStatus ply_input_init(PlyInput *input, FILE *stream, uint64_t size, const char *name, BpError *err);
void ply_input_clear(PlyInput *input);
/* Reads until `count` bytes, at most the capacity, lie at buffer + begin. False at the end of the file. */
bool ply_input_fill(PlyInput *input, size_t count);
void ply_input_take(PlyInput *input, size_t count);
/* Passes over `count` bytes; false when the file ends before. */
bool ply_input_skip(PlyInput *input, uint64_t count);
/* Takes a line; *line is ended by a NUL in place of its end, and valid until the next call. Fails at the end
 * of the file and on lines longer than the buffer. */
BpStatus ply_input_line(PlyInput *input, char **line, BpError *err);
/* Fails unless nothing is left (but blank lines, where the file has lines). */
BpStatus ply_input_end(PlyInput *input, bool lines, BpError *err);
/* Fails with the input's name and, if with_line, the line last taken. */
BpStatus ply_fail(const PlyInput *input, bool with_line, BpError *err, const char *format, ...)
    BP_PRINTF_LIKE(4, 5);

/* Reads one number of a line, moving *cursor past it. False when there is none. "nan" and "inf" are numbers.
 */
bool ply_parse_number(char **cursor, double *value);

/* ---- header ----------------------------------------------------------------------------------------------
 */

typedef enum PlyFormat { PLY_ASCII, PLY_LITTLE_ENDIAN, PLY_BIG_ENDIAN } PlyFormat;

/* What a property of a vertex means. */
typedef enum PlyRole {
    PLY_X,
    PLY_Y,
    PLY_Z,
    PLY_RADIUS,
    PLY_RED,
    PLY_GREEN,
    PLY_BLUE,
    PLY_MATERIAL,
    PLY_ROLE_COUNT,
    PLY_NO_ROLE = PLY_ROLE_COUNT
} PlyRole;

typedef struct PlyProperty {
    PlyType type, count_type; /* count_type: of a list's length; PLY_NONE for a scalar */
    PlyRole role;
} PlyProperty;

enum { PLY_PROPERTIES_MAX = 256, PLY_ELEMENTS_MAX = 32 };

typedef struct PlyElement {
    uint64_t count;
    size_t first_property, property_count;
    bool has_list;
} PlyElement;

typedef struct PlyHeader {
    PlyFormat format;
    PlyElement elements[PLY_ELEMENTS_MAX];
    PlyProperty properties[PLY_PROPERTIES_MAX];
    size_t element_count, property_count;
    size_t vertex;                     /* which element */
    PlyType role_type[PLY_ROLE_COUNT]; /* PLY_NONE: the file has no such property */
} PlyHeader;

BpStatus ply_read_header(PlyInput *input, PlyHeader *header, BpError *err);
const char *ply_role_name(PlyRole role);
/* Bytes of one row, lists taken as empty. */
size_t ply_row_size(const PlyHeader *header, const PlyElement *element);

#endif
