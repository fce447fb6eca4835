/* fuzz_sums.c: any sums that a render could make, written as a film file: they read back equal.
 *
 * The input is the sizes, the settings, sample ranges, then sums and counts. */
#include "bpa_io.h"

#define SAMPLES_END ((uint64_t)1 << 32)
#define SUM_MAX ((uint64_t)1 << 62)

static char *make_title(Bytes *bytes) {
    const size_t length = take_byte(bytes) % 64;
    char *title = malloc(length + 1);
    require(title != NULL);
    for (size_t i = 0; i < length; i++)
        title[i] = (char)(1 + take_byte(bytes) % 127); /* control characters too */
    title[length] = '\0';
    return title;
}

static BpFilm *make_accumulator(Bytes *bytes) {
    BpFilm *made = NULL;
    const uint32_t width = 1 + take_byte(bytes) % 9, height = 1 + take_byte(bytes) % 9;
    require(bp_film_create(width, height, 1 + take_byte(bytes) % BP_REPLICATES_MAX, &made, NULL) == BP_OK);
    made->scale_log2 = (int32_t)(take_byte(bytes) % 253) - 126;
    made->scene_hash = take_bits(bytes, 8);
    made->seed = take_bits(bytes, 8);
    made->max_depth = (uint32_t)take_bits(bytes, 3) % (BP_DEPTH_MAX + 1);
    const uint8_t words = take_byte(bytes);
    made->sampler = words & 1u;
    made->precision = words >> 1 & 1u;
    made->math = words >> 2 & 1u;
    made->numerics = words >> 3 & 1u;
    made->transfer = (words >> 4 & 3u) % 3u;
    made->partial = words >> 7 != 0;
    made->coarse = (words & 3u) == 3;
    made->segments = take_bits(bytes, 8) >> 1;
    made->truncated_paths = take_bits(bytes, 8) >> 1;
    made->not_finite_samples = take_bits(bytes, 8) >> 3;
    made->negative_samples = take_bits(bytes, 8) >> 3;
    made->out_of_range_samples = take_bits(bytes, 8) >> 3;
    made->invalid_samples = made->not_finite_samples + made->negative_samples + made->out_of_range_samples;
    made->shadow_rays = made->segments ^ made->truncated_paths;
    made->title = make_title(bytes);
    for (unsigned i = take_byte(bytes) % 6; i > 0; i--) {
        const uint64_t first = take_bits(bytes, 4), count = 1 + take_bits(bytes, i % 2 == 0 ? 1 : 3);
        if (first + count <= SAMPLES_END) bp_film_add_range(made, first, count, NULL); /* or refused */
    }
    if (words >> 6 & 1u) require(bp_film_add_fine_sums(made, NULL) == BP_OK);
    for (size_t cell = 0; cell < bpa_cells(made); cell++) {
        const uint64_t most = bp_film_expected(made, (uint32_t)(cell % made->replicates));
        made->counts[cell] = (uint32_t)(take_bits(bytes, 3) % (most + 1));
        for (size_t i = 3 * cell; i < 3 * cell + 3 && made->counts[cell] > 0; i++) {
            made->sums[i] = (int64_t)(take_bits(bytes, 8) % (SUM_MAX + 1));
            if (made->fine_sums != NULL) made->fine_sums[i] = (int64_t)(take_bits(bytes, 8) % (SUM_MAX + 1));
        }
    }
    return made;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    Bytes bytes = {data, size, 0};
    BpFilm *made = make_accumulator(&bytes);
    size_t file_size = 0;
    char *file = bpa_save(made, &file_size);
    require(file != NULL);
    BpFilm *read = bpa_load(file, file_size);
    require(read != NULL);
    require(read->width == made->width && read->height == made->height &&
            read->replicates == made->replicates);
    require(read->scale_log2 == made->scale_log2 && read->scene_hash == made->scene_hash);
    require(read->seed == made->seed && read->max_depth == made->max_depth && read->sampler == made->sampler);
    require(read->precision == made->precision && read->math == made->math &&
            read->numerics == made->numerics);
    require(read->transfer == made->transfer && read->partial == made->partial &&
            read->coarse == made->coarse);
    require(read->segments == made->segments && read->truncated_paths == made->truncated_paths);
    require(read->shadow_rays == made->shadow_rays);
    require(read->invalid_samples == made->invalid_samples && strcmp(read->title, made->title) == 0);
    require(read->not_finite_samples == made->not_finite_samples &&
            read->negative_samples == made->negative_samples &&
            read->out_of_range_samples == made->out_of_range_samples);
    require(read->range_count == made->range_count);
    for (size_t i = 0; i < made->range_count; i++)
        require(read->ranges[i].first == made->ranges[i].first &&
                read->ranges[i].count == made->ranges[i].count);
    require(memcmp(read->sums, made->sums, 3 * bpa_cells(made) * sizeof *made->sums) == 0);
    require((read->fine_sums == NULL) == (made->fine_sums == NULL));
    require(made->fine_sums == NULL ||
            memcmp(read->fine_sums, made->fine_sums, 3 * bpa_cells(made) * sizeof *made->fine_sums) == 0);
    require(memcmp(read->counts, made->counts, bpa_cells(made) * sizeof *made->counts) == 0);
    free(file);
    bp_film_destroy(&read);
    bp_film_destroy(&made);
    return 0;
}
