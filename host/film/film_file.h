/* film_file.h: films as files (.bpa): one line of JSON, then packed numbers.
 *
 * In and out: BpFilm.
 * Knows: which numbers there are, and what they may be.   Does not know: how they are
 * packed (film_stream.h), how the sums were made.
 *
 * Layout (docs/FILES.md has it byte by byte): a JSON object on one line ended by a
 * newline, then, as film_stream.h packs them, width * height * replicates * 3 sums of 8 bytes (two's
 * complement); as many fine sums, if the header announces them; width * height * replicates counts of 4
 * bytes; depth, normal and albedo, path lengths of pixels, alpha, unseen light, decisions of adaptive
 * sampling, each if the header announces it; and the CRC-32 of everything before it, 4 bytes. Scene hash and
 * seed are strings, since many readers of JSON keep 53 bits of a number. */
#ifndef BP_FILM_FILM_FILE_H
#define BP_FILM_FILM_FILE_H

#include "film.h"

#include <stdio.h>

/* bp_film_write() of ballpark.h to an open stream, flushed at the end. */
BpStatus bp_film_write_stream(const BpFilm *film, FILE *out, BpError *err);

/* Refuses what is truncated, too long, damaged, of another version or not a .bpa file, naming what is
 * wrong (BP_ERR_FILE); allocates nothing before the file has the length that follows from its header. A film
 * that loads has the invariants of film.h: ranges sorted and disjoint, counts within the ranges, sums not
 * negative and without risk of overflow. */
/* bp_film_read() of ballpark.h from a stream that can seek; `name` stands in messages where a path would. */
BpStatus bp_film_read_stream(FILE *in, const char *name, BpFilm **film, BpError *err);

/* The header of the .bpa file at `path`: a film without sums and counts, and a plan without its decisions.
 * Fails as bp_film_read() does; damage behind the header is not detected. */
BpStatus bp_film_read_header(const char *path, BpFilm **film, BpError *err);

#endif
