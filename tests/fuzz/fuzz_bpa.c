/* fuzz_bpa.c: any bytes as a film file (host/film/film_file.h).
 *
 * What loads must be safe to use: it saves and loads again to the same bytes, its picture can be made, and it
 * can be merged with what it does not overlap. */
#include "bpa_io.h"
#include "bpa_mutator.h"

size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t size_max, unsigned seed);

size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t size_max, unsigned seed) {
    return bpa_mutate(data, size, size_max, seed);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    BpFilm *first = bpa_load(data, size);
    if (first == NULL) return 0;
    size_t first_size = 0, second_size = 0;
    char *first_bytes = bpa_save(first, &first_size);
    require(first_bytes != NULL);
    BpFilm *second = bpa_load(first_bytes, first_size);
    require(second != NULL);
    char *second_bytes = bpa_save(second, &second_size);
    require(second_bytes != NULL && first_size == second_size &&
            memcmp(first_bytes, second_bytes, first_size) == 0);

    BpPicture picture;
    if (bp_film_picture(first, &picture, NULL) == BP_OK) bp_picture_clear(&picture);
    /* With itself it overlaps, unless it has no samples; shifted it may not. */
    bp_film_merge(second, first, NULL);
    for (size_t i = 0; i < second->range_count; i++) second->ranges[i].first += first->replicates;
    bp_film_merge(first, second, NULL);

    free(first_bytes);
    free(second_bytes);
    bp_film_destroy(&first);
    bp_film_destroy(&second);
    return 0;
}
