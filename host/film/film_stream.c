/* film_stream.c: see film_stream.h. */
#include "film_stream.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define BLOCK 65536u        /* numbers of a block */
#define PACKED_BYTES 65536u /* at a time */
#define WIDTH_MAX 8u
/* Planes of more bits per byte than this are stored: packing them would take most of the time, and gain
 * little. */
#define PACKED_BITS_MAX 6.0

/* ---- numbers as little-endian bytes, in planes ---- */

/* A number of this machine; `width` is 1, 4 or 8. */
static uint64_t load_native(const uint8_t *at, size_t width) {
    uint64_t wide;
    uint32_t narrow;
    if (width == 8) return memcpy(&wide, at, 8), wide;
    if (width == 4) return memcpy(&narrow, at, 4), narrow;
    return *at;
}

static void store_native(uint8_t *at, uint64_t value, size_t width) {
    const uint32_t narrow = (uint32_t)value;
    if (width == 8)
        memcpy(at, &value, 8);
    else if (width == 4)
        memcpy(at, &narrow, 4);
    else
        *at = (uint8_t)value;
}

/* Plane by plane, with a constant width, so that the compiler vectorizes the loop. */
static inline void to_plane(const uint8_t *numbers, size_t width, size_t count, size_t byte, uint8_t *plane) {
    for (size_t i = 0; i < count; i++)
        plane[i] = (uint8_t)(load_native(numbers + width * i, width) >> (8 * byte));
}

static void to_planes(const uint8_t *numbers, size_t width, size_t count, uint8_t *planes) {
    for (size_t byte = 0; byte < width; byte++) {
        uint8_t *plane = planes + byte * count;
        if (width == 8)
            to_plane(numbers, 8, count, byte, plane);
        else if (width == 4)
            to_plane(numbers, 4, count, byte, plane);
        else
            to_plane(numbers, 1, count, byte, plane);
    }
}

static void from_planes(const uint8_t *planes, size_t width, size_t count, uint8_t *numbers) {
    for (size_t i = 0; i < count; i++) {
        uint64_t value = 0;
        for (size_t byte = 0; byte < width; byte++) value |= (uint64_t)planes[byte * count + i] << (8 * byte);
        store_native(numbers + width * i, value, width);
    }
}

/* ---- writing ---- */

BpStatus bp_film_sink_init(FILE *out, BpFilmSink *sink, BpError *err) {
    *sink = (BpFilmSink){.out = out,
                         .checksum = crc32_z(0, NULL, 0),
                         .planes = malloc(WIDTH_MAX * BLOCK),
                         .packed = malloc(PACKED_BYTES)};
    sink->zipping = sink->planes != NULL && sink->packed != NULL &&
                    deflateInit2(&sink->zip, 1, Z_DEFLATED, 15, 9, Z_RLE) == Z_OK;
    return sink->zipping ? BP_OK : bp_fail(err, BP_ERR_MEMORY, "out of memory for writing the .bpa file");
}

void bp_film_sink_clear(BpFilmSink *sink) {
    if (sink->zipping) deflateEnd(&sink->zip);
    free(sink->planes);
    free(sink->packed);
    memset(sink, 0, sizeof *sink);
}

void bp_film_sink_bytes(BpFilmSink *sink, const void *bytes, size_t size) {
    sink->checksum = crc32_z(sink->checksum, bytes, size);
    fwrite(bytes, 1, size, sink->out);
}

/* Packs bytes; `flush` as for deflate(). */
static void pack(BpFilmSink *sink, uint8_t *bytes, size_t size, int flush) {
    sink->zip.next_in = bytes;
    sink->zip.avail_in = (uInt)size;
    do {
        sink->zip.next_out = sink->packed;
        sink->zip.avail_out = PACKED_BYTES;
        deflate(&sink->zip, flush);
        bp_film_sink_bytes(sink, sink->packed, PACKED_BYTES - sink->zip.avail_out);
    } while (sink->zip.avail_out == 0);
}

/* Entropy in bits per byte (Shannon, A Mathematical Theory of Communication, 1948, section 6), of bytes
 * without an order. */
static double entropy(const uint8_t *bytes, size_t count) {
    uint32_t counts[4][256] = {{0}}; /* four: a byte that equals the one before need not wait for it */
    double sum = 0;
    for (size_t i = 0; i < count; i++) ++counts[i & 3][bytes[i]];
    for (size_t value = 0; value < 256; value++) {
        const uint32_t number = counts[0][value] + counts[1][value] + counts[2][value] + counts[3][value];
        if (number > 0) sum += number * log2((double)count / number);
    }
    return sum / (double)count;
}

/* Packs one plane, or stores it. */
static void pack_plane(BpFilmSink *sink, uint8_t *plane, size_t count) {
    const int level = entropy(plane, count) > PACKED_BITS_MAX ? 0 : 1;
    int code = Z_OK;
    sink->zip.next_in = plane;
    sink->zip.avail_in = 0;
    do { /* earlier input is packed with its own parameters, as far as the buffer allows */
        sink->zip.next_out = sink->packed;
        sink->zip.avail_out = PACKED_BYTES;
        code = deflateParams(&sink->zip, level, Z_RLE);
        bp_film_sink_bytes(sink, sink->packed, PACKED_BYTES - sink->zip.avail_out);
    } while (code == Z_BUF_ERROR);
    pack(sink, plane, count, Z_NO_FLUSH);
}

void bp_film_sink_numbers(BpFilmSink *sink, const void *numbers, size_t width, size_t count) {
    for (size_t done = 0; done < count && !ferror(sink->out); done += BLOCK) {
        const size_t block = count - done < BLOCK ? count - done : BLOCK;
        to_planes((const uint8_t *)numbers + width * done, width, block, sink->planes);
        for (size_t byte = 0; byte < width; byte++) pack_plane(sink, sink->planes + byte * block, block);
    }
}

BpStatus bp_film_sink_end(BpFilmSink *sink, BpError *err) {
    uint8_t checksum[BP_FILM_CHECKSUM_BYTES];
    pack(sink, sink->planes, 0, Z_FINISH);
    for (size_t i = 0; i < sizeof checksum; i++) checksum[i] = (uint8_t)(sink->checksum >> (8 * i));
    fwrite(checksum, 1, sizeof checksum, sink->out);
    const int failed_before = ferror(sink->out) ? errno : 0;
    if (fflush(sink->out) == 0 && failed_before == 0) return BP_OK;
    return bp_fail(err, BP_ERR_FILE, "writing the .bpa file failed: %s",
                   strerror(failed_before != 0 ? failed_before : errno));
}

/* ---- reading ---- */

uint64_t bp_film_unpacked_max(uint64_t packed_bytes) {
    return packed_bytes > UINT64_MAX / 1032 ? UINT64_MAX : 1032 * packed_bytes;
}

BpStatus bp_film_source_init(FILE *in, const char *name, uLong checksum, uint64_t left, BpFilmSource *source,
                             BpError *err) {
    *source = (BpFilmSource){.in = in,
                             .name = name,
                             .checksum = checksum,
                             .left = left,
                             .planes = malloc(WIDTH_MAX * BLOCK),
                             .packed = malloc(PACKED_BYTES)};
    source->zipping =
        source->planes != NULL && source->packed != NULL && inflateInit2(&source->zip, 15) == Z_OK;
    return source->zipping ? BP_OK : bp_fail(err, BP_ERR_MEMORY, "out of memory for reading %s", name);
}

void bp_film_source_clear(BpFilmSource *source) {
    if (source->zipping) inflateEnd(&source->zip);
    free(source->planes);
    free(source->packed);
    memset(source, 0, sizeof *source);
}

static BpStatus truncated(const BpFilmSource *source, BpError *err) {
    return bp_fail(err, BP_ERR_FILE, "%s is truncated: it ends before the numbers that its header announces",
                   source->name);
}

static BpStatus read_bytes(BpFilmSource *source, uint8_t *bytes, size_t size, BpError *err) {
    if (size > source->left) return truncated(source, err);
    if (fread(bytes, 1, size, source->in) != size) {
        if (ferror(source->in))
            return bp_fail(err, BP_ERR_FILE, "reading %s failed: %s", source->name, strerror(errno));
        return truncated(source, err);
    }
    source->checksum = crc32_z(source->checksum, bytes, size);
    source->left -= size;
    return BP_OK;
}

static BpStatus damaged(const BpFilmSource *source, BpError *err) {
    return bp_fail(err, BP_ERR_FILE, "%s is damaged: its numbers cannot be unpacked (%s)", source->name,
                   source->zip.msg != NULL ? source->zip.msg : "no reason given");
}

/* Sees to it that zlib has bytes to unpack. */
static BpStatus refill(BpFilmSource *source, BpError *err) {
    if (source->zip.avail_in > 0) return BP_OK;
    const size_t some = source->left < PACKED_BYTES ? (size_t)source->left : PACKED_BYTES;
    if (some == 0) return truncated(source, err);
    BP_TRY(read_bytes(source, source->packed, some, err));
    source->zip.next_in = source->packed;
    source->zip.avail_in = (uInt)some;
    return BP_OK;
}

/* Fills `planes` with `size` bytes of zlib's stream. */
static BpStatus unpack(BpFilmSource *source, size_t size, BpError *err) {
    source->zip.next_out = source->planes;
    source->zip.avail_out = (uInt)size;
    while (source->zip.avail_out > 0) {
        if (source->ended) return truncated(source, err);
        BP_TRY(refill(source, err));
        const int code = inflate(&source->zip, Z_NO_FLUSH);
        source->ended = code == Z_STREAM_END;
        if (code == Z_MEM_ERROR)
            return bp_fail(err, BP_ERR_MEMORY, "out of memory for reading %s", source->name);
        if (code != Z_OK && code != Z_STREAM_END) return damaged(source, err);
    }
    return BP_OK;
}

BpStatus bp_film_source_numbers(BpFilmSource *source, void *numbers, size_t width, size_t count,
                                BpError *err) {
    for (size_t done = 0; done < count; done += BLOCK) {
        const size_t block = count - done < BLOCK ? count - done : BLOCK;
        BP_TRY(unpack(source, width * block, err));
        from_planes(source->planes, width, block, (uint8_t *)numbers + width * done);
    }
    return BP_OK;
}

static BpStatus too_long(const BpFilmSource *source, BpError *err) {
    return bp_fail(err, BP_ERR_FILE, "%s is too long: it holds more numbers than its header announces",
                   source->name);
}

BpStatus bp_film_source_end(BpFilmSource *source, BpError *err) {
    if (!source->ended) {
        /* All numbers are out, but the end of zlib's stream may not have been read. */
        uint8_t more;
        source->zip.next_out = &more;
        source->zip.avail_out = 1;
        int code = Z_OK;
        while (code == Z_OK && source->zip.avail_out == 1) {
            BP_TRY(refill(source, err));
            code = inflate(&source->zip, Z_NO_FLUSH);
        }
        source->ended = code == Z_STREAM_END;
        if (source->zip.avail_out == 0) return too_long(source, err);
        if (!source->ended) return damaged(source, err);
    }
    return source->left > 0 || source->zip.avail_in > 0 ? too_long(source, err) : BP_OK;
}

BpStatus bp_film_source_verify(BpFilmSource *source, BpError *err) {
    uint8_t bytes[BP_FILM_CHECKSUM_BYTES];
    while (source->left > 0) {
        const size_t some = source->left < PACKED_BYTES ? (size_t)source->left : PACKED_BYTES;
        BP_TRY(read_bytes(source, source->packed, some, err));
    }
    uint64_t expected = 0;
    if (fread(bytes, 1, sizeof bytes, source->in) != sizeof bytes) return truncated(source, err);
    for (size_t i = 0; i < sizeof bytes; i++) expected |= (uint64_t)bytes[i] << (8 * i);
    if (expected == source->checksum) return BP_OK;
    return bp_fail(err, BP_ERR_FILE,
                   "%s is truncated or damaged: its checksum is %08" PRIx64 ", but its content has %08" PRIx64
                   "; copy it again, or render its samples again",
                   source->name, expected, (uint64_t)source->checksum);
}
