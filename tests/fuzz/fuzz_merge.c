/* fuzz_merge.c: two film files in one input, merged.
 *
 * The input is the first file's length (4 bytes, little endian), the first file, the second. A merge is
 * refused and changes nothing; or sums, counts and totals are added, whichever comes first, and the result
 * can be saved and loaded. */
#include "bpa_io.h"
#include "bpa_mutator.h"

size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t size_max, unsigned seed);

enum { LENGTH_BYTES = 4 };

static size_t first_length(const uint8_t *data, size_t size) {
    Bytes bytes = {data, LENGTH_BYTES, 0};
    const uint64_t length = take_bits(&bytes, LENGTH_BYTES);
    return length < size - LENGTH_BYTES ? (size_t)length : size - LENGTH_BYTES;
}

static size_t join(uint8_t *data, const uint8_t *first, size_t first_size, const uint8_t *second,
                   size_t second_size) {
    for (size_t i = 0; i < LENGTH_BYTES; i++) data[i] = (uint8_t)(first_size >> (8 * i));
    memcpy(data + LENGTH_BYTES, first, first_size);
    memcpy(data + LENGTH_BYTES + first_size, second, second_size);
    return LENGTH_BYTES + first_size + second_size;
}

/* Changes one of the two files, the other keeps its half of the room. */
size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t size_max, unsigned seed) {
    if (size < LENGTH_BYTES || size_max < LENGTH_BYTES) return 0;
    const size_t room = (size_max - LENGTH_BYTES) / 2, split = first_length(data, size);
    size_t sizes[2] = {split, size - LENGTH_BYTES - split};
    uint8_t *files[2];
    for (size_t f = 0; f < 2; f++) {
        if (sizes[f] > room) sizes[f] = room;
        files[f] = calloc(1, room + 1);
        require(files[f] != NULL);
        memcpy(files[f], data + LENGTH_BYTES + (f == 0 ? 0 : split), sizes[f]);
    }
    const size_t changed = seed % 2;
    sizes[changed] = bpa_mutate(files[changed], sizes[changed], room, seed / 2);
    const size_t result = join(data, files[0], sizes[0], files[1], sizes[1]);
    free(files[0]);
    free(files[1]);
    return result;
}

static bool same_bytes(const BpFilm *film, const char *bytes, size_t size) {
    size_t now = 0;
    char *saved = bpa_save(film, &now);
    require(saved != NULL);
    const bool same = now == size && memcmp(saved, bytes, size) == 0;
    free(saved);
    return same;
}

static int64_t fine_sum(const BpFilm *film, size_t i) {
    return film->fine_sums != NULL ? film->fine_sums[i] : 0;
}

/* `sum` is a + b; both were taken before the merge. */
static void check_sum(const BpFilm *sum, const BpFilm *a, const BpFilm *b) {
    const size_t cells = bpa_cells(a);
    require(bpa_cells(b) == cells && bpa_cells(sum) == cells && a->scene_hash == b->scene_hash &&
            a->seed == b->seed);
    for (size_t i = 0; i < 3 * cells; i++) require(sum->sums[i] == a->sums[i] + b->sums[i]);
    for (size_t i = 0; i < 3 * cells; i++) require(fine_sum(sum, i) == fine_sum(a, i) + fine_sum(b, i));
    for (size_t i = 0; i < cells; i++) require(sum->counts[i] == a->counts[i] + b->counts[i]);
    for (uint32_t k = 0; k < a->replicates; k++)
        require(bp_film_expected(sum, k) == bp_film_expected(a, k) + bp_film_expected(b, k));
    for (size_t i = 1; i < sum->range_count; i++)
        require(sum->ranges[i].first > sum->ranges[i - 1].first + sum->ranges[i - 1].count);
    require(sum->partial == (a->partial || b->partial));
    require(sum->coarse == (a->coarse || b->coarse));
    require(sum->segments == a->segments + b->segments &&
            sum->truncated_paths == a->truncated_paths + b->truncated_paths);
    require(sum->invalid_samples == a->invalid_samples + b->invalid_samples);
    require(sum->invalid_samples ==
            sum->not_finite_samples + sum->negative_samples + sum->out_of_range_samples);
    require(sum->shadow_rays == a->shadow_rays + b->shadow_rays);
}

/* Merges the second file into the first and checks it; the sum, or NULL when it was refused. */
static BpFilm *merge(const uint8_t *first, size_t first_size, const uint8_t *second, size_t second_size) {
    BpFilm *into = bpa_load(first, first_size), *from = bpa_load(second, second_size);
    BpFilm *before = bpa_load(first, first_size);
    if (into == NULL || from == NULL) goto done;
    size_t size = 0;
    char *bytes = bpa_save(into, &size);
    require(bytes != NULL);
    BpError err = {0};
    const BpStatus status = bp_film_merge(into, from, &err);
    if (status != BP_OK) {
        require(err.code == status && err.message[0] != '\0' && same_bytes(into, bytes, size));
        bp_film_destroy(&into);
    } else {
        check_sum(into, before, from);
        size_t saved_size = 0;
        char *saved = bpa_save(into, &saved_size);
        require(saved != NULL);
        BpFilm *again = bpa_load(saved, saved_size);
        require(again != NULL && same_bytes(again, saved, saved_size));
        bp_film_destroy(&again);
        free(saved);
    }
    bp_error_clear(&err);
    free(bytes);
    bp_film_destroy(&from);
    bp_film_destroy(&before);
    return into;
done:
    bp_film_destroy(&into);
    bp_film_destroy(&from);
    bp_film_destroy(&before);
    return NULL;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    if (size < LENGTH_BYTES) return 0;
    const size_t split = first_length(data, size);
    const uint8_t *first = data + LENGTH_BYTES, *second = first + split;
    const size_t second_size = size - LENGTH_BYTES - split;
    BpFilm *forth = merge(first, split, second, second_size);
    BpFilm *back = merge(second, second_size, first, split);
    require((forth == NULL) == (back == NULL));
    if (forth != NULL) {
        const size_t cells = bpa_cells(forth);
        require(memcmp(forth->sums, back->sums, 3 * cells * sizeof *forth->sums) == 0);
        for (size_t i = 0; i < 3 * cells; i++) require(fine_sum(forth, i) == fine_sum(back, i));
        require(memcmp(forth->counts, back->counts, cells * sizeof *forth->counts) == 0);
        require(forth->range_count == back->range_count);
        require(forth->plan == NULL && forth->pixel_segments == NULL &&
                (forth->depth == NULL) == (back->depth == NULL));
        const size_t pixels = (size_t)forth->width * forth->height;
        require(forth->depth == NULL || (memcmp(forth->depth, back->depth, pixels * 4) == 0 &&
                                         memcmp(forth->normal, back->normal, pixels * 12) == 0 &&
                                         memcmp(forth->albedo, back->albedo, pixels * 12) == 0));
        require(forth->job.first == back->job.first && forth->job.count == back->job.count);
        for (size_t i = 0; i < forth->range_count; i++)
            require(forth->ranges[i].first == back->ranges[i].first &&
                    forth->ranges[i].count == back->ranges[i].count);
    }
    bp_film_destroy(&forth);
    bp_film_destroy(&back);
    return 0;
}
