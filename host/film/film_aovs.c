/* film_aovs.c: depth, normal and albedo of a film and of its picture; see film.h. */
#include "film.h"

#include "base/status.h"

#include <stdlib.h>
#include <string.h>

static size_t pixel_count(const BpFilm *film) {
    return (size_t)film->width * film->height;
}

static BpStatus no_memory(size_t pixels, BpError *err) {
    return bp_fail(err, BP_ERR_MEMORY, "out of memory for depth, normals and albedo of %zu pixels", pixels);
}

void bp_film_drop_aovs(BpFilm *film) {
#define DROP(place, member, floats, mean, channels)                                                          \
    free(film->member);                                                                                      \
    film->member = NULL;
    AOV_LIST(DROP)
#undef DROP
}

BpStatus bp_film_add_aovs(BpFilm *film, BpError *err) {
    const size_t pixels = pixel_count(film);
    bool whole = true;
    if (bp_film_has_aovs(film)) return BP_OK;
#define ADD(place, member, floats, mean, channels)                                                           \
    film->member = calloc(pixels, (floats) * sizeof *film->member);                                          \
    whole = whole && film->member != NULL;
    AOV_LIST(ADD)
#undef ADD
    if (whole) return BP_OK;
    bp_film_drop_aovs(film);
    return no_memory(pixels, err);
}

#define COPY(place, member, floats, mean, channels)                                                          \
    memcpy(to->member, from->member, pixel_count(film) * (floats) * sizeof *from->member);

void bp_film_copy_aovs(const BpFilm *from, BpFilm *to) {
    const BpFilm *film = from;
    AOV_LIST(COPY)
}

BpStatus bp_film_take_aovs(BpFilm *film, const BpPicture *from, BpError *err) {
    BP_TRY(bp_film_add_aovs(film, err));
    BpFilm *to = film;
    AOV_LIST(COPY)
    return BP_OK;
}

BpStatus bp_film_give_aovs(const BpFilm *film, BpPicture *to, BpError *err) {
    const size_t pixels = pixel_count(film);
    const BpFilm *from = film;
    bool whole = true;
#define ADD(place, member, floats, mean, channels)                                                           \
    if (to->member == NULL) to->member = malloc(pixels * (floats) * sizeof *to->member);                     \
    whole = whole && to->member != NULL;
    AOV_LIST(ADD)
#undef ADD
    if (!whole) return no_memory(pixels, err); /* the caller clears the picture */
    AOV_LIST(COPY)
    return BP_OK;
}
