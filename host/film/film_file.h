/* film_file.h: films as files (.bpa): one line of JSON, then sums and counts, little endian.
 *
 * In and out: BpFilm.   Knows: the file's layout.   Does not know: how the sums were made.
 *
 * Layout, version 2 (docs/FILES.md has it byte by byte): a JSON object on one line ended by a newline, then
 * width * height * replicates * 3 sums of 8 bytes (two's complement); as many fine sums, if the header says
 * so; width * height * replicates counts of 4 bytes, all in the order of BpFilm; and the CRC-32 of
 * everything before it, 4 bytes. Version 1 has no fine sums and no checksum; it is read and marked
 * `unverified`, and never written. Scene hash and seed are strings, since many readers of JSON keep 53 bits
 * of a number. */
#ifndef BP_FILM_FILM_FILE_H
#define BP_FILM_FILM_FILE_H

#include "film.h"

#include <stdio.h>

/* bp_film_write() of ballpark.h to an open stream ("-o -"), flushed at the end. */
BpStatus bp_film_write_stream(const BpFilm *film, FILE *out, BpError *err);

/* Refuses what is truncated, too long, damaged, of a newer version or not a .bpa file, naming what is
 * wrong (BP_ERR_FILE); allocates nothing before the file is as long as its header says. Whatever loads obeys
 * what film.h says: ranges sorted and disjoint, counts within the ranges, sums not negative and
 * without risk of overflow. */
/* bp_film_read() of ballpark.h from a stream that can seek; `name` stands in messages where a path would. */
BpStatus bp_film_read_stream(FILE *in, const char *name, BpFilm **film, BpError *err);

#endif
