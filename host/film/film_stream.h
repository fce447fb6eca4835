/* film_stream.h: packs and unpacks the arrays of a .bpa file.
 *
 * In and out: arrays of whole numbers of 4 or 8 bytes, and floats by their bits.
 * Knows: byte planes, zlib, the checksum.   Does not know: what the numbers mean (film_file.h does).
 *
 * All numbers are one zlib stream (RFC 1950). Each array is stored in blocks of 65536 numbers, the last one
 * shorter, and each block in byte planes: first the lowest byte of every number, then the next. The high
 * bytes of neighbours are similar and the lowest are often 0, so a block shrinks to a third or less. zlib
 * uses its strategy for runs: others take several times as long and gain next to nothing. Planes that are
 * almost noise are stored uncompressed in the same stream. */
#ifndef BP_FILM_FILM_STREAM_H
#define BP_FILM_FILM_STREAM_H

#include "base/status.h"

#include <stdio.h>
#include <zlib.h>

#define BP_FILM_CHECKSUM_BYTES 4u /* zlib's CRC-32 of all before it, at the end of the file */

/* ---- writing ---- */

typedef struct BpFilmSink {
    FILE *out;
    uLong checksum; /* of what was written */
    z_stream zip;
    bool zipping;
    uint8_t *planes; /* a block in planes */
    uint8_t *packed; /* what zlib made of it */
} BpFilmSink;

/* BP_ERR_MEMORY. End with bp_film_sink_clear() in any case. */
BpStatus bp_film_sink_init(FILE *out, BpFilmSink *sink, BpError *err);
void bp_film_sink_clear(BpFilmSink *sink);
/* Writes bytes unchanged; before any numbers. */
void bp_film_sink_bytes(BpFilmSink *sink, const void *bytes, size_t size);
/* `count` numbers of `width` bytes, 1, 4 or 8. A failed write shows in bp_film_sink_end(). */
void bp_film_sink_numbers(BpFilmSink *sink, const void *numbers, size_t width, size_t count);
/* Ends the numbers, and writes the checksum. BP_ERR_FILE: something could not be written. */
BpStatus bp_film_sink_end(BpFilmSink *sink, BpError *err);

/* ---- reading ---- */

typedef struct BpFilmSource {
    FILE *in;
    const char *name; /* of the file, for messages */
    uLong checksum;   /* of what was read; begin with that of the header */
    uint64_t left;    /* bytes of the file before the checksum */
    bool ended;       /* zlib's stream has */
    z_stream zip;
    bool zipping;
    uint8_t *planes, *packed;
} BpFilmSource;

/* `left`: bytes between here and the checksum. BP_ERR_MEMORY. End with bp_film_source_clear(). */
BpStatus bp_film_source_init(FILE *in, const char *name, uLong checksum, uint64_t left, BpFilmSource *source,
                             BpError *err);
void bp_film_source_clear(BpFilmSource *source);
/* The next `count` numbers of `width` bytes, 1, 4 or 8. BP_ERR_FILE: the file is truncated or damaged. */
BpStatus bp_film_source_numbers(BpFilmSource *source, void *numbers, size_t width, size_t count,
                                BpError *err);
/* Whether the numbers end here. BP_ERR_FILE: there are more. */
BpStatus bp_film_source_end(BpFilmSource *source, BpError *err);
/* Reads what is left, and compares the checksum. BP_ERR_FILE: the file is damaged. */
BpStatus bp_film_source_verify(BpFilmSource *source, BpError *err);

/* An upper bound of the unpacked size of `packed_bytes` bytes of a zlib stream, which limits allocations.
 * Deflate (RFC 1951) makes at most 258 bytes of 2 bits. */
uint64_t bp_film_unpacked_max(uint64_t packed_bytes);

#endif
