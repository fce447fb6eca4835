/* film_header.h: the line of JSON that a .bpa file begins with.
 *
 * In:    a film, or a parsed header.   Out: the header's text, or the film's settings.
 * Knows: the header's members and their limits.   Does not know: files, how the numbers follow (film_file.h).
 */
#ifndef BP_FILM_FILM_HEADER_H
#define BP_FILM_FILM_HEADER_H

#include "film.h"

#include <jansson.h>

/* Of the files that are written, and the only one that is read. Before the first release, the member that
 * names the version was called "ballpark_accumulator". */
#define BP_FILM_VERSION 1

/* Which numbers follow a header. */
typedef struct BpFilmParts {
    bool fine_sums, aovs, pixel_segments, alpha, unseen;
    uint64_t decision_bytes; /* of the plan */
} BpFilmParts;

/* The header line without its newline; the caller frees it. NULL when out of memory. */
char *bp_film_header_make(const BpFilm *film);

/* Checks version and byte order, and reads what decides how many numbers follow: width, height and replicates
 * into `sizes`, and which parts there are. `name` is the file's, for messages; BP_ERR_FILE names the member
 * that is wrong. */
BpStatus bp_film_header_sizes(const json_t *header, const char *name, BpFilm *sizes, BpFilmParts *parts,
                              BpError *err);

/* Reads everything else into `film`, which has its sizes; a plan without its decisions. BP_ERR_FILE or
 * BP_ERR_MEMORY. */
BpStatus bp_film_header_settings(const json_t *header, const char *name, BpFilm *film, BpError *err);

#endif
