/* bpa_io.h: films to and from bytes, and how many bytes a file has, for the fuzz targets of .bpa
 * files. */
#ifndef BP_FUZZ_BPA_IO_H
#define BP_FUZZ_BPA_IO_H

#include "film/film_file.h"
#include "fuzz.h"

#include <stdio.h>

/* NULL: refused, with a reason. */
static inline BpFilm *bpa_load(const void *data, size_t size) {
    if (size == 0) return NULL;                                 /* fmemopen has no empty files everywhere */
    FILE *file = fmemopen((void *)(uintptr_t)data, size, "rb"); /* read only, whatever the type says */
    require(file != NULL);
    BpFilm *film = NULL;
    BpError err = {0};
    const BpStatus status = bp_film_read_stream(file, "fuzz", &film, &err);
    require((status == BP_OK) == (film != NULL));
    require(status == BP_OK || (err.code == status && err.message[0] != '\0'));
    bp_error_clear(&err);
    fclose(file);
    return film;
}

/* The file of a film; free() it. NULL: refused, with a reason. */
static inline char *bpa_save(const BpFilm *film, size_t *size) {
    char *bytes = NULL;
    FILE *file = open_memstream(&bytes, size);
    require(file != NULL);
    BpError err = {0};
    const BpStatus status = bp_film_write_stream(film, file, &err);
    require(status == BP_OK || (err.code == status && err.message[0] != '\0'));
    bp_error_clear(&err);
    fclose(file);
    if (status == BP_OK) return bytes;
    free(bytes);
    return NULL;
}

static inline size_t bpa_cells(const BpFilm *film) {
    return (size_t)film->width * film->height * film->replicates;
}

#endif
