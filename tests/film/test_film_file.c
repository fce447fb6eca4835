/* test_film_file.c: .bpa files read back whole (host/film/film_file.h). */
#include "film/film_file.h"
#include "film_sample.h"

#include <math.h>
#include <signal.h>
#include <sys/resource.h>
#include <time.h>
#include <zlib.h>

static void assert_same(const BpFilm *a, const BpFilm *b) {
    assert_int_equal(a->width, b->width);
    assert_int_equal(a->height, b->height);
    assert_int_equal(a->replicates, b->replicates);
    assert_int_equal(a->scale_log2, b->scale_log2);
    assert_true(a->scene_hash == b->scene_hash);
    assert_true(a->seed == b->seed);
    assert_int_equal(a->max_depth, b->max_depth);
    assert_int_equal(a->sampler, b->sampler);
    assert_int_equal(a->precision, b->precision);
    assert_int_equal(a->math, b->math);
    assert_int_equal(a->numerics, b->numerics);
    assert_int_equal(a->transfer, b->transfer);
    assert_int_equal(a->partial, b->partial);
    assert_true(a->segments == b->segments);
    assert_int_equal(a->truncated_paths, b->truncated_paths);
    assert_int_equal(a->invalid_samples, b->invalid_samples);
    assert_int_equal(a->not_finite_samples, b->not_finite_samples);
    assert_int_equal(a->negative_samples, b->negative_samples);
    assert_int_equal(a->out_of_range_samples, b->out_of_range_samples);
    assert_true(a->shadow_rays == b->shadow_rays);
    assert_string_equal(a->title, b->title);
    assert_int_equal(a->range_count, b->range_count);
    assert_memory_equal(a->ranges, b->ranges, a->range_count * sizeof *a->ranges);
    const size_t cells = (size_t)a->width * a->height * a->replicates;
    assert_memory_equal(a->sums, b->sums, cells * 24);
    assert_int_equal(a->fine_sums == NULL, b->fine_sums == NULL);
    if (a->fine_sums != NULL) assert_memory_equal(a->fine_sums, b->fine_sums, cells * 24);
    assert_int_equal(a->coarse, b->coarse);
    assert_memory_equal(a->counts, b->counts, cells * 4);
    const size_t pixels = (size_t)a->width * a->height;
    assert_memory_equal(&a->job, &b->job, sizeof a->job);
    assert_int_equal(a->depth == NULL, b->depth == NULL);
    if (a->depth != NULL) {
        assert_memory_equal(a->depth, b->depth, pixels * 4);
        assert_memory_equal(a->normal, b->normal, pixels * 12);
        assert_memory_equal(a->albedo, b->albedo, pixels * 12);
    }
    assert_int_equal(a->pixel_segments == NULL, b->pixel_segments == NULL);
    if (a->pixel_segments != NULL) assert_memory_equal(a->pixel_segments, b->pixel_segments, pixels * 8);
    assert_int_equal(a->met == NULL, b->met == NULL);
    if (a->met != NULL) assert_memory_equal(a->met, b->met, pixels * 8);
    assert_int_equal(a->unseen == NULL, b->unseen == NULL);
    if (a->unseen != NULL) {
        assert_memory_equal(a->unseen->pixels, b->unseen->pixels, pixels * 8);
        assert_memory_equal(a->unseen->tint, b->unseen->tint, 12);
    }
    assert_int_equal(a->plan == NULL, b->plan == NULL);
    if (a->plan == NULL) return;
    assert_int_equal(a->plan->adaptive, b->plan->adaptive);
    assert_int_equal(a->plan->ended, b->plan->ended);
    assert_int_equal(a->plan->first_sample, b->plan->first_sample);
    assert_int_equal(a->plan->target, b->plan->target);
    assert_int_equal(a->plan->done, b->plan->done);
    assert_int_equal(a->plan->pass_samples, b->plan->pass_samples);
    assert_int_equal(a->plan->next_pixel, b->plan->next_pixel);
    assert_int_equal(a->plan->samples_max, b->plan->samples_max);
    assert_true(a->plan->error == b->plan->error);
    assert_int_equal(a->plan->decision_bytes, b->plan->decision_bytes);
    assert_memory_equal(a->plan->decisions, b->plan->decisions, a->plan->decision_bytes);
}

static void what_is_saved_loads(void **state) {
    (void)state;
    char folder[64], path[512];
    temp_make(folder);
    BpFilm *a = make(), *b = NULL;
    BpError err = {0};
    assert_int_equal(bp_film_write(a, temp_path(path, folder, "a.bpa"), &err), BP_OK);
    if (bp_film_read(path, &b, &err) != BP_OK) fail_msg("%s", err.message);
    assert_same(a, b);
    assert_int_equal(temp_count(folder), 1);
    bp_film_destroy(&b);
    temp_remove(folder);
    bp_film_destroy(&a);
}

/* More numbers than are converted at a time; no title, no ranges. */
static void a_large_one_loads(void **state) {
    (void)state;
    char folder[64], path[512];
    temp_make(folder);
    BpFilm *a = NULL, *b = NULL;
    BpError err = {0};
    assert_int_equal(bp_film_create(331, 97, 5, &a, NULL), BP_OK);
    assert_int_equal(bp_film_add_range(a, 0, 500, NULL), BP_OK);
    for (size_t cell = 0; cell < 331 * 97 * 5; cell++) {
        a->counts[cell] = 1 + (uint32_t)(cell % 100);
        for (size_t c = 0; c < 3; c++) a->sums[3 * cell + c] = (int64_t)(data_bits(3 * cell + c) >> 3);
    }
    assert_int_equal(bp_film_write(a, temp_path(path, folder, "a.bpa"), &err), BP_OK);
    if (bp_film_read(path, &b, &err) != BP_OK) fail_msg("%s", err.message);
    free(a->title);
    a->title = strdup("");
    assert_same(a, b);
    bp_film_destroy(&a);
    bp_film_destroy(&b);
    temp_remove(folder);
}

/* A render that was stopped before its first sample. */
static void an_empty_one_loads(void **state) {
    (void)state;
    char folder[64], path[512];
    temp_make(folder);
    BpFilm *a = NULL, *b = NULL;
    BpError err = {0};
    assert_int_equal(bp_film_create(2, 1, 4, &a, NULL), BP_OK);
    assert_int_equal(bp_film_write(a, temp_path(path, folder, "a.bpa"), &err), BP_OK);
    if (bp_film_read(path, &b, &err) != BP_OK) fail_msg("%s", err.message);
    assert_int_equal(b->range_count, 0);
    bp_film_destroy(&a);
    bp_film_destroy(&b);
    temp_remove(folder);
}

/* The numbers of a block, byte by byte: the lowest bytes of all first. */
static const uint8_t *check_planes(const uint8_t *at, const void *numbers, size_t width, size_t count) {
    for (size_t byte = 0; byte < width; byte++)
        for (size_t i = 0; i < count; i++) {
            uint64_t value = 0;
            if (width == 8)
                value = ((const uint64_t *)numbers)[i];
            else if (width == 4)
                value = ((const uint32_t *)numbers)[i];
            else
                value = ((const uint8_t *)numbers)[i];
            assert_int_equal(at[byte * count + i], value >> (8 * byte) & 255);
        }
    return at + width * count;
}

/* Without what not every film has, and with each of it. */
static void parts_may_be_missing(void **state) {
    (void)state;
    BpFilm *a = make();
    for (int left = 3; left >= 0; left--) {
        char *bytes = NULL;
        size_t size = 0;
        FILE *out = open_memstream(&bytes, &size);
        assert_int_equal(bp_film_write_stream(a, out, NULL), BP_OK);
        fclose(out);
        BpFilm *b = NULL;
        BpError err = {0};
        FILE *in = fmemopen(bytes, size, "rb");
        if (bp_film_read_stream(in, "memory", &b, &err) != BP_OK) fail_msg("%s", err.message);
        fclose(in);
        assert_same(a, b);
        bp_film_destroy(&b);
        free(bytes);
        if (left == 3) bp_unseen_destroy(&a->unseen);
        if (left == 2) free(a->met), a->met = NULL;
        if (left == 1) bp_film_drop_aovs(a);
    }
    bp_film_destroy(&a);
}

/* The layout, byte by byte: what is documented is what is there. */
static void the_layout_is_as_documented(void **state) {
    (void)state;
    BpFilm *a = make();
    char *bytes = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&bytes, &size);
    assert_int_equal(bp_film_write_stream(a, out, NULL), BP_OK);
    fclose(out);
    assert_memory_equal(bytes, "{\"ballpark_film\": 1, ", 20);
    const uint8_t *line_end = memchr(bytes, '\n', size);
    assert_non_null(line_end);
    uint8_t numbers[10000];
    uLongf count = sizeof numbers;
    assert_int_equal(
        uncompress(numbers, &count, line_end + 1, (uLong)((uint8_t *)bytes + size - 4 - (line_end + 1))),
        Z_OK);
    const uint8_t *at = check_planes(numbers, a->sums, 8, 180);
    at = check_planes(at, a->fine_sums, 8, 180);
    at = check_planes(at, a->counts, 4, 60);
    at = check_planes(at, a->depth, 4, 15);
    at = check_planes(at, a->normal, 4, 45);
    at = check_planes(at, a->albedo, 4, 45);
    at = check_planes(at, a->pixel_segments, 8, 15);
    at = check_planes(at, a->met, 8, 15);
    at = check_planes(at, a->unseen->pixels, 4, 30);
    at = check_planes(at, a->unseen->tint, 4, 3);
    at = check_planes(at, a->plan->decisions, 1, 50);
    assert_int_equal(at - numbers, count);
    /* The reflected CRC-32 with polynomial 0x04c11db7 (ISO 3309), bit by bit. */
    uint32_t crc = 0xffffffffu;
    for (size_t i = 0; i < 8 * (size - 4); i++) {
        const uint32_t bit = (crc ^ ((uint32_t)(uint8_t)bytes[i / 8] >> (i % 8))) & 1;
        crc = crc >> 1 ^ (bit != 0 ? 0xedb88320u : 0);
    }
    crc = ~crc;
    for (size_t byte = 0; byte < 4; byte++)
        assert_int_equal((uint8_t)bytes[size - 4 + byte], crc >> (8 * byte) & 255);
    free(bytes);
    bp_film_destroy(&a);
}

/* Whatever is written can be read: a title of megabytes, as many ranges as there may be, and no more. */
static void what_is_written_can_be_read(void **state) {
    (void)state;
    char *bytes = NULL;
    size_t size = 0;
    BpFilm *a = NULL, *b = NULL;
    BpError err = {0};
    assert_int_equal(bp_film_create(1, 1, 64, &a, NULL), BP_OK);
    struct BpSampleRange *ranges = malloc((BP_SAMPLE_RANGES_MAX + 1) * sizeof *ranges);
    for (size_t i = 0; i <= BP_SAMPLE_RANGES_MAX; i++) ranges[i] = (struct BpSampleRange){400000 * i, 3};
    assert_int_equal(bp_film_add_ranges(a, ranges, BP_SAMPLE_RANGES_MAX + 1, &err), BP_ERR_LIMIT);
    assert_non_null(strstr(err.message, "10001 separate sample ranges"));
    assert_int_equal(a->range_count, 0);
    assert_int_equal(bp_film_add_ranges(a, ranges, BP_SAMPLE_RANGES_MAX, &err), BP_OK);
    free(ranges);
    /* Control characters take six bytes each, and the cut falls into a character of three bytes. */
    a->title = malloc(3000001);
    memset(a->title, 1, 65534);
    for (size_t i = 65534; i + 2 < 3000000; i += 3) memcpy(a->title + i, "\xe2\x82\xac", 3);
    a->title[65534 + (3000000 - 65534) / 3 * 3] = '\0';
    FILE *out = open_memstream(&bytes, &size);
    assert_int_equal(bp_film_write_stream(a, out, NULL), BP_OK);
    fclose(out);
    FILE *in = fmemopen(bytes, size, "rb");
    if (bp_film_read_stream(in, "memory", &b, &err) != BP_OK) fail_msg("%s", err.message);
    fclose(in);
    assert_int_equal(b->range_count, BP_SAMPLE_RANGES_MAX);
    assert_int_equal(strlen(b->title), 65534);
    assert_memory_equal(a->title, b->title, 65534);
    bp_film_destroy(&a);
    bp_film_destroy(&b);
    free(bytes);
}

/* Seconds of processor time to read a film of so many ranges, and to merge it with one whose ranges lie
 * between. */
static double seconds_of_ranges(size_t count) {
    char *bytes = NULL;
    size_t size = 0;
    BpFilm *a = NULL, *b = NULL;
    BpError err = {0};
    struct BpSampleRange *ranges = malloc(count * sizeof *ranges);
    assert_non_null(ranges);
    assert_int_equal(bp_film_create(1, 1, 64, &a, NULL), BP_OK);
    for (size_t i = 0; i < count; i++) ranges[i] = (struct BpSampleRange){1000 * i, 500};
    assert_int_equal(bp_film_add_ranges(a, ranges, count, &err), BP_OK);
    FILE *out = open_memstream(&bytes, &size);
    assert_int_equal(bp_film_write_stream(a, out, NULL), BP_OK);
    fclose(out);
    bp_film_destroy(&a);
    assert_int_equal(bp_film_create(1, 1, 64, &a, NULL), BP_OK);
    for (size_t i = 0; i < count; i++) ranges[i].first += 500;
    assert_int_equal(bp_film_add_ranges(a, ranges, count, &err), BP_OK);
    free(ranges);
    FILE *in = fmemopen(bytes, size, "rb");
    const clock_t begin = clock();
    if (bp_film_read_stream(in, "memory", &b, &err) != BP_OK) fail_msg("%s", err.message);
    free(b->title);
    b->title = NULL;
    a->scene_hash = b->scene_hash;
    if (bp_film_merge(b, a, &err) != BP_OK) fail_msg("%s", err.message);
    const double seconds = (double)(clock() - begin) / CLOCKS_PER_SEC;
    fclose(in);
    assert_int_equal(b->range_count, 1);
    bp_film_destroy(&a);
    bp_film_destroy(&b);
    free(bytes);
    return seconds;
}

/* Four times as many ranges take about four times as long, and not sixteen times: 10,000 of them, of 64
 * replicates, once took 22 seconds. */
static void ranges_take_their_share_of_time(void **state) {
    (void)state;
    double few = INFINITY, many = INFINITY;
    for (int i = 0; i < 5; i++) {
        few = fmin(few, seconds_of_ranges(BP_SAMPLE_RANGES_MAX / 4));
        many = fmin(many, seconds_of_ranges(BP_SAMPLE_RANGES_MAX));
    }
    assert_true(many < 9 * few);
}

static void what_cannot_be_read_or_written_is_said(void **state) {
    (void)state;
    BpFilm *a = make(), *b = NULL;
    BpError err = {0};
    assert_int_equal(bp_film_read("/tmp/no-such-file.bpa", &b, &err), BP_ERR_FILE);
    assert_non_null(strstr(err.message, "No such file"));
    assert_int_equal(bp_film_read("/tmp", &b, &err), BP_ERR_FILE);
    assert_non_null(strstr(err.message, "/tmp"));
    assert_int_equal(bp_film_read("/dev/null", &b, &err), BP_ERR_FILE);
    assert_int_equal(bp_film_write(a, "/tmp/no-such-folder/a.bpa", &err), BP_ERR_FILE);
    if (access("/dev/full", W_OK) == 0) {
        assert_int_equal(bp_film_write(a, "/dev/full", &err), BP_ERR_FILE);
        assert_non_null(strstr(err.message, "No space left"));
    }
    bp_film_destroy(&a);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_saved_loads),
        cmocka_unit_test(a_large_one_loads),
        cmocka_unit_test(an_empty_one_loads),
        cmocka_unit_test(parts_may_be_missing),
        cmocka_unit_test(the_layout_is_as_documented),
        cmocka_unit_test(what_is_written_can_be_read),
        cmocka_unit_test(ranges_take_their_share_of_time),
        cmocka_unit_test(what_cannot_be_read_or_written_is_said),
    };
    return cmocka_run_group_tests_name("film_file", tests, NULL, NULL);
}
