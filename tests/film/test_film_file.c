/* test_film_file.c: .bpa files read back whole (host/film/film_file.h). */
#include "film/film_file.h"
#include "film_sample.h"

#include <signal.h>
#include <sys/resource.h>

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
    assert_int_equal(a->cut_paths, b->cut_paths);
    assert_int_equal(a->invalid_samples, b->invalid_samples);
    assert_string_equal(a->title, b->title);
    assert_int_equal(a->range_count, b->range_count);
    assert_memory_equal(a->ranges, b->ranges, a->range_count * sizeof *a->ranges);
    const size_t cells = (size_t)a->width * a->height * a->replicates;
    assert_memory_equal(a->sums, b->sums, cells * 24);
    assert_int_equal(a->fine_sums == NULL, b->fine_sums == NULL);
    if (a->fine_sums != NULL) assert_memory_equal(a->fine_sums, b->fine_sums, cells * 24);
    assert_int_equal(a->coarse, b->coarse);
    assert_int_equal(a->unverified, b->unverified);
    assert_memory_equal(a->counts, b->counts, cells * 4);
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

/* The layout, byte by byte: what is documented is what is there. */
static void the_layout_is_as_documented(void **state) {
    (void)state;
    BpFilm *a = make();
    char *bytes = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&bytes, &size);
    assert_int_equal(bp_film_write_stream(a, out, NULL), BP_OK);
    fclose(out);
    assert_memory_equal(bytes, "{\"ballpark_accumulator\": 2, ", 27);
    const uint8_t *line_end = memchr(bytes, '\n', size);
    assert_non_null(line_end);
    assert_int_equal((uint8_t *)bytes + size - (line_end + 1), 60 * 52 + 4);
    for (size_t i = 0; i < 180; i++)
        for (size_t byte = 0; byte < 8; byte++) {
            assert_int_equal(line_end[1 + 8 * i + byte], (uint64_t)a->sums[i] >> (8 * byte) & 255);
            assert_int_equal(line_end[1 + 1440 + 8 * i + byte],
                             (uint64_t)a->fine_sums[i] >> (8 * byte) & 255);
        }
    for (size_t i = 0; i < 60; i++) assert_int_equal(line_end[1 + 2880 + 4 * i], a->counts[i]);
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

/* A file of version 1, written by hand: read, and marked as one that nothing vouches for. */
static void version_1_loads(void **state) {
    (void)state;
    char folder[64], path[512], bytes[1024];
    temp_make(folder);
    const int header = snprintf(
        bytes, sizeof bytes,
        "{\"ballpark_accumulator\": 1, \"byte_order\": \"little\", \"title\": \"old\", \"width\": 1, "
        "\"height\": "
        "1, \"replicates\": 2, \"scale_log2\": 38, \"scene_hash\": \"1f\", \"seed\": \"0\", \"max_depth\": "
        "5, "
        "\"sampler\": \"sobol\", \"precision\": \"single\", \"math\": \"strict\", \"numerics\": \"robust\", "
        "\"transfer\": \"gamma2\", \"ranges\": [[0, 3]], \"partial\": false, \"segments\": 9, "
        "\"cut_paths\": 0, \"invalid_samples\": 0}\n");
    memset(bytes + header, 0, 56);
    bytes[header] = 77;     /* of the first sum */
    bytes[header + 48] = 2; /* samples of replicate 0 */
    bytes[header + 52] = 1; /* and of 1 */
    temp_write(temp_path(path, folder, "old.bpa"), bytes, (size_t)header + 56);
    BpFilm *a = NULL;
    BpError err = {0};
    if (bp_film_read(path, &a, &err) != BP_OK) fail_msg("%s", err.message);
    assert_true(a->unverified);
    assert_false(a->coarse);
    assert_null(a->fine_sums);
    assert_int_equal(a->sums[0], 77);
    assert_int_equal(a->counts[0], 2);
    assert_int_equal(a->segments, 9);
    bp_film_destroy(&a);
    temp_remove(folder);
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
        cmocka_unit_test(the_layout_is_as_documented),
        cmocka_unit_test(version_1_loads),
        cmocka_unit_test(what_is_written_can_be_read),
        cmocka_unit_test(what_cannot_be_read_or_written_is_said),
    };
    return cmocka_run_group_tests_name("film_file", tests, NULL, NULL);
}
