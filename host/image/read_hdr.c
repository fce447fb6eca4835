/* read_hdr.c: images as Radiance pictures (.hdr, .pic); see reader.h.
 *
 * Lines of text, an empty one, the size ("-Y 512 +X 1024"), then texels of four bytes, red, green and blue
 * with a common exponent (G. Ward, "Real Pixels", Graphics Gems II, 1991): flat, with runs as the first
 * versions had them, or each component of a row packed by itself. Colours of other primaries (PRIMARIES, or
 * CIE XYZ by FORMAT) are converted to Rec. 709's. EXPOSURE and COLORCORR say by what the numbers were
 * multiplied, and are undone. */
#include "primaries.h"
#include "reader.h"

#include "base/decimal.h"
#include "base/message_text.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LINE_MAX_BYTES = 2048, PACKED_LEAST = 8, PACKED_MOST = 0x7fff };

typedef struct HdrReader {
    const BpImageInput *input;
    double factors[3]; /* to undo what the numbers were multiplied by */
    bool xyz, has_primaries;
    BpPrimaries primaries;
    uint32_t width, height;
    int row_step, column_step; /* 1 or -1: from the top down, from the left to the right */
    bool by_columns;           /* its lines are columns of the image */
    unsigned char last[4];     /* texel before a run of the old kind */
    bool has_last;
} HdrReader;

/* Reads a line without its end; of a long one, which is for people, the beginning. False: there is no end. */
static bool read_line(FILE *stream, char line[LINE_MAX_BYTES]) {
    size_t length = 0;
    int c = fgetc(stream);
    for (; c != '\n' && c != EOF; c = fgetc(stream))
        if (length + 1 < LINE_MAX_BYTES) line[length++] = (char)c;
    while (length > 0 && line[length - 1] == '\r') length--;
    line[length] = '\0';
    return c == '\n';
}

/* As many numbers as `count`, apart by white space. */
static bool read_numbers(const char *text, double *numbers, int count) {
    for (int i = 0; i < count; i++) {
        char word[64];
        text += strspn(text, " \t");
        const size_t length = strcspn(text, " \t");
        if (length == 0 || length >= sizeof word) return false;
        memcpy(word, text, length);
        word[length] = '\0';
        const char *const end = bp_decimal_parse(word, &numbers[i]);
        if (end == NULL || *end != '\0' || !isfinite(numbers[i])) return false;
        text += length;
    }
    return true;
}

static BpStatus fail_line(const HdrReader *reader, const char *line, const char *expected, BpError *err) {
    char shown[64];
    bp_printable(line, shown, sizeof shown);
    return bp_image_fail(reader->input, err, "found the line \"%s\", expected %s", shown, expected);
}

/* What `line` sets, or NULL if it does not set `name`. */
static const char *value_of(const char *line, const char *name) {
    const size_t length = strlen(name);
    return strncmp(line, name, length) == 0 && line[length] == '=' ? line + length + 1 : NULL;
}

static BpStatus read_factors(HdrReader *reader, const char *line, const char *value, int count,
                             BpError *err) {
    double numbers[3];
    if (!read_numbers(value, numbers, count)) return fail_line(reader, line, "numbers above 0", err);
    for (int c = 0; c < 3; c++) {
        const double number = numbers[count == 3 ? c : 0];
        reader->factors[c] /= number;
        if (!(number > 0) || !isfinite(reader->factors[c]))
            return fail_line(reader, line, "numbers above 0", err);
    }
    return BP_OK;
}

/* A line that sets a variable; most are for people. */
static BpStatus read_variable(HdrReader *reader, const char *line, BpError *err) {
    const char *value = NULL;
    if ((value = value_of(line, "FORMAT")) != NULL) {
        value += strspn(value, " ");
        reader->xyz = strcmp(value, "32-bit_rle_xyze") == 0;
        if (!reader->xyz && strcmp(value, "32-bit_rle_rgbe") != 0)
            return fail_line(reader, line, "FORMAT=32-bit_rle_rgbe or 32-bit_rle_xyze", err);
    } else if ((value = value_of(line, "EXPOSURE")) != NULL) {
        return read_factors(reader, line, value, 1, err);
    } else if ((value = value_of(line, "COLORCORR")) != NULL) {
        return read_factors(reader, line, value, 3, err);
    } else if ((value = value_of(line, "PRIMARIES")) != NULL) {
        double p[8];
        if (!read_numbers(value, p, 8)) return fail_line(reader, line, "eight numbers", err);
        reader->primaries = (BpPrimaries){{p[0], p[1]}, {p[2], p[3]}, {p[4], p[5]}, {p[6], p[7]}};
        reader->has_primaries = true;
    }
    return BP_OK;
}

/* One of the two sides: "-Y 512". */
static bool read_side(const char **text, char *axis, int *sign, double *length) {
    const char *c = *text;
    *sign = *c == '-' ? -1 : 1;
    if (*c != '-' && *c != '+') return false;
    *axis = *++c;
    if ((*axis != 'X' && *axis != 'Y') || *++c != ' ') return false;
    const char *const end = bp_decimal_parse(c + strspn(c, " "), length);
    if (end == NULL || !(*length >= 1 && *length <= 1e9) || *length != floor(*length)) return false;
    *text = end + strspn(end, " ");
    return true;
}

/* The order of texels: the first side changes slowly. Rows are counted from below, so "-Y" begins at the top.
 */
static BpStatus read_size(HdrReader *reader, const char *line, BpError *err) {
    const char *c = line;
    char axes[2];
    int signs[2];
    double lengths[2];
    if (!read_side(&c, &axes[0], &signs[0], &lengths[0]) ||
        !read_side(&c, &axes[1], &signs[1], &lengths[1]) || *c != '\0' || axes[0] == axes[1])
        return fail_line(reader, line, "the size, such as -Y 512 +X 1024", err);
    const int y = axes[0] == 'Y' ? 0 : 1;
    reader->by_columns = y == 1;
    reader->row_step = -signs[y];
    reader->column_step = signs[1 - y];
    reader->height = (uint32_t)lengths[y];
    reader->width = (uint32_t)lengths[1 - y];
    return BP_OK;
}

static BpStatus read_header(HdrReader *reader, BpError *err) {
    char line[LINE_MAX_BYTES];
    bool whole = read_line(reader->input->stream, line);
    while (whole && (whole = read_line(reader->input->stream, line)) && line[0] != '\0')
        if (line[0] != '#') BP_TRY(read_variable(reader, line, err));
    if (!whole || !read_line(reader->input->stream, line))
        return bp_image_fail(reader->input, err,
                             "found no end of the header, expected an empty line and the size of the image");
    return read_size(reader, line, err);
}

static BpStatus fail_end(const HdrReader *reader, uint32_t line, BpError *err) {
    return bp_image_fail(reader->input, err, "found the end of the file in line %u of %u, expected more",
                         (unsigned)line, (unsigned)(reader->by_columns ? reader->width : reader->height));
}

static BpStatus fail_run(const HdrReader *reader, uint32_t line, BpError *err) {
    return bp_image_fail(reader->input, err,
                         "found a run that leaves line %u of %u, expected one that fits; the file is damaged",
                         (unsigned)line, (unsigned)(reader->by_columns ? reader->width : reader->height));
}

/* A line whose components are packed one after the other: a byte above 128 is the length of a run and 128,
 * others are numbers of bytes that follow. */
static BpStatus read_packed(const HdrReader *reader, uint32_t line, size_t length, unsigned char *texels,
                            BpError *err) {
    FILE *const stream = reader->input->stream;
    for (size_t c = 0; c < 4; c++)
        for (size_t i = 0; i < length;) {
            const int code = fgetc(stream);
            const bool is_run = code > 128;
            size_t count = is_run ? (size_t)code - 128 : (size_t)(code > 0 ? code : 0);
            if (code == EOF) return fail_end(reader, line, err);
            if (count == 0 || count > length - i) return fail_run(reader, line, err);
            int value = is_run ? fgetc(stream) : 0;
            for (; count > 0; count--) {
                if (!is_run) value = fgetc(stream);
                if (value == EOF) return fail_end(reader, line, err);
                texels[4 * i++ + c] = (unsigned char)value;
            }
        }
    return BP_OK;
}

/* A line of texels as they are, of which the first four bytes are there. Red, green and blue of 1 repeat the
 * texel before them; such runs one after the other are the digits of one length, to base 256. */
static BpStatus read_flat(HdrReader *reader, uint32_t line, size_t length, const unsigned char first[4],
                          unsigned char *texels, BpError *err) {
    unsigned char texel[4];
    unsigned shift = 0;
    memcpy(texel, first, 4);
    for (size_t i = 0; i < length;) {
        if (texel[0] == 1 && texel[1] == 1 && texel[2] == 1) {
            const uint64_t count = shift < 32 ? (uint64_t)texel[3] << shift : UINT64_MAX;
            if (!reader->has_last || count > length - i) return fail_run(reader, line, err);
            for (uint64_t k = 0; k < count; k++) memcpy(texels + 4 * i++, reader->last, 4);
            shift += 8;
        } else {
            memcpy(texels + 4 * i++, texel, 4);
            memcpy(reader->last, texel, 4);
            reader->has_last = true;
            shift = 0;
        }
        if (i < length && fread(texel, 1, 4, reader->input->stream) != 4) return fail_end(reader, line, err);
    }
    return BP_OK;
}

static BpStatus read_one(HdrReader *reader, uint32_t line, size_t length, unsigned char *texels,
                         BpError *err) {
    unsigned char first[4];
    if (fread(first, 1, 4, reader->input->stream) != 4) return fail_end(reader, line, err);
    const bool packed =
        first[0] == 2 && first[1] == 2 && first[2] < 128 && length >= PACKED_LEAST && length <= PACKED_MOST;
    if (!packed) return read_flat(reader, line, length, first, texels, err);
    if (((size_t)first[2] << 8 | first[3]) != length)
        return bp_image_fail(reader->input, err,
                             "found %u texels in line %u, expected %zu; the file is damaged",
                             (unsigned)first[2] << 8 | first[3], (unsigned)line, length);
    return read_packed(reader, line, length, texels, err);
}

/* The place of texel `i` of line `line` in the image. */
static size_t place_of(const HdrReader *reader, uint32_t line, uint32_t i) {
    uint32_t row = reader->by_columns ? i : line, column = reader->by_columns ? line : i;
    if (reader->row_step < 0) row = reader->height - 1 - row;
    if (reader->column_step < 0) column = reader->width - 1 - column;
    return (size_t)row * reader->width + column;
}

/* As most programs have it: a mantissa stands for itself, not for the middle of its step, so that black stays
 * black. */
static void store_line(const HdrReader *reader, uint32_t line, uint32_t length, const unsigned char *texels,
                       BpImage *image) {
    for (uint32_t i = 0; i < length; i++) {
        const unsigned char *const t = texels + 4 * (size_t)i;
        float *const out = image->texels + 3 * place_of(reader, line, i);
        for (int c = 0; c < 3; c++)
            out[c] = t[3] == 0 ? 0 : (float)(ldexp(t[c], (int)t[3] - 136) * reader->factors[c]);
    }
}

static BpStatus read_lines(HdrReader *reader, BpImage *image, BpError *err) {
    const uint32_t lines = reader->by_columns ? reader->width : reader->height;
    const uint32_t length = reader->by_columns ? reader->height : reader->width;
    unsigned char *const texels = malloc(4 * (size_t)length);
    if (texels == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for a row of an image");
    BpStatus status = BP_OK;
    for (uint32_t line = 0; line < lines && status == BP_OK; line++) {
        status = read_one(reader, line, length, texels, err);
        if (status == BP_OK) store_line(reader, line, length, texels, image);
    }
    free(texels);
    return status;
}

static BpStatus convert_colors(const HdrReader *reader, BpImage *image, BpError *err) {
    static const BpPrimaries cie_xyz = {{1, 0}, {0, 1}, {0, 0}, {1 / 3.0, 1 / 3.0}};
    if (reader->xyz) return bp_image_convert(reader->input, &cie_xyz, "its FORMAT is CIE XYZ", image, err);
    if (!reader->has_primaries) return BP_OK;
    return bp_image_convert(reader->input, &reader->primaries, "its PRIMARIES", image, err);
}

BpStatus bp_image_read_hdr(const BpImageInput *input, BpImage **image, BpError *err) {
    HdrReader reader = {.input = input, .factors = {1, 1, 1}};
    BP_TRY(read_header(&reader, err));
    BP_TRY(bp_image_allocate(input, reader.width, reader.height, image, err));
    if (reader.factors[0] != 1 || reader.factors[1] != 1 || reader.factors[2] != 1)
        bp_texels_note(*image,
                       "its EXPOSURE or COLORCORR is undone: values are multiplied by %.4g, %.4g and %.4g",
                       reader.factors[0], reader.factors[1], reader.factors[2]);
    BpStatus status = read_lines(&reader, *image, err);
    if (status == BP_OK) status = convert_colors(&reader, *image, err);
    if (status != BP_OK) bp_texels_destroy(image);
    return status;
}
