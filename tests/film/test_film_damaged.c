/* test_film_damaged.c: damaged .bpa files are refused (host/film/film_file.h). */
#include "film/film_file.h"
#include "film_sample.h"

typedef struct Files {
    char folder[64], good[512], bad[512];
    uint8_t *bytes; /* of the good file */
    size_t size, header_size;
} Files;

static void files_make(Files *files) {
    temp_make(files->folder);
    temp_path(files->good, files->folder, "good.bpa");
    temp_path(files->bad, files->folder, "bad.bpa");
    BpFilm *a = make();
    assert_int_equal(bp_film_write(a, files->good, NULL), BP_OK);
    bp_film_destroy(&a);
    files->bytes = temp_read(files->good, &files->size);
    files->header_size = (size_t)((uint8_t *)memchr(files->bytes, '\n', files->size) - files->bytes) + 1;
}

static void files_clear(Files *files) {
    free(files->bytes);
    temp_remove(files->folder);
}

/* Loading the bad file fails, says `reason` and names the file. */
static void refuse(const Files *files, const char *reason) {
    BpFilm *a = NULL;
    BpError err = {0};
    const BpStatus status = bp_film_read(files->bad, &a, &err);
    if (status != BP_ERR_FILE) fail_msg("accepted, or code %d, where it should say '%s'", status, reason);
    assert_null(a);
    if (strstr(err.message, reason) == NULL) fail_msg("'%s' does not say '%s'", err.message, reason);
    assert_non_null(strstr(err.message, "bad.bpa"));
    assert_string_equal(err.file, files->bad);
}

/* The good file with `old` in its header replaced, its length otherwise right. */
static void refuse_header(const Files *files, const char *old, const char *new, const char *reason) {
    char header[4096];
    memcpy(header, files->bytes, files->header_size);
    header[files->header_size] = '\0';
    char *at = strstr(header, old);
    if (at == NULL) fail_msg("no '%s' in the header", old);
    const size_t payload = files->size - files->header_size;
    const size_t before = (size_t)(at - header), after = files->header_size - before - strlen(old);
    const size_t size = before + strlen(new) + after + payload;
    uint8_t *bytes = malloc(size);
    memcpy(bytes, header, before);
    memcpy(bytes + before, new, strlen(new));
    memcpy(bytes + before + strlen(new), at + strlen(old), after);
    memcpy(bytes + size - payload, files->bytes + files->header_size, payload);
    temp_write(files->bad, bytes, size);
    free(bytes);
    refuse(files, reason);
}

static void wrong_members_are_named(void **state) {
    (void)state;
    static const struct {
        const char *old, *new, *reason;
    } cases[] = {
        {"\"ballpark_accumulator\": 2", "\"ballpark_accumulator\": 0", "should be a whole number from 1"},
        {"\"ballpark_accumulator\": 2", "\"ballpark_accumulator\": 3",
         "has version 3 of the format, but this program reads versions 1 to 2: use a newer Ballpark"},
        {"\"fine_sums\": true", "\"fine_sums\": false", "too long"},
        {"\"fine_sums\": true", "\"fine_sums\": 1", "\"fine_sums\" in the header should be true or false"},
        {"\"coarse\": true, ", "", "\"coarse\""},
        {"A \\\"title", "B \\\"title", "is damaged: its checksum is"},
        {"\"segments\": 1", "\"segments\": 2", "is damaged: its checksum is"},
        {"\"ballpark_accumulator\"", "\"other\"", "is missing"},
        {"\"little\"", "\"big\"", "\"byte_order\" in the header should be \"little\""},
        {"\"width\": 5", "\"width\": 0", "\"width\" in the header should be a whole number from 1 to 65535"},
        {"\"width\": 5", "\"width\": 65536", "\"width\""},
        {"\"width\": 5", "\"width\": 5.0", "\"width\""},
        {"\"width\": 5", "\"width\": -5", "\"width\""},
        {"\"width\": 5", "\"width\": 6", "truncated"},
        {"\"width\": 5", "\"width\": 4", "too long"},
        {"\"width\": 5", "\"width\": 99999999999999999999", "not JSON"},
        {"\"width\": 5, \"height\": 3, \"replicates\": 4",
         "\"width\": 65535, \"height\": 65535, \"replicates\": 64",
         "says 14293"}, /* without allocating 7 TiB first */
        {"\"replicates\": 4", "\"replicates\": 65", "\"replicates\""},
        {"\"replicates\": 4", "\"replicates\": null", "\"replicates\""},
        {"\"height\": 3, ", "", "\"height\""},
        {"\"height\": 3", "\"height\": 3, \"height\": 3", "duplicate"},
        {"\"scale_log2\": -20", "\"scale_log2\": -127", "\"scale_log2\""},
        {"\"scale_log2\": -20", "\"scale_log2\": 127", "\"scale_log2\""},
        {"\"fedcba9876543210\"", "\"fedcba98765432100\"", "\"scene_hash\""},
        {"\"fedcba9876543210\"", "\"fedcba987654321g\"", "\"scene_hash\""},
        {"\"fedcba9876543210\"", "\"\"", "\"scene_hash\""},
        {"\"fedcba9876543210\"", "5", "\"scene_hash\""},
        {"\"18446744073709551615\"", "\"18446744073709551616\"", "\"seed\""},
        {"\"18446744073709551615\"", "\"-1\"", "\"seed\""},
        {"\"18446744073709551615\"", "\" 1\"", "\"seed\""},
        {"\"max_depth\": 50", "\"max_depth\": 1000001", "\"max_depth\""},
        {"\"sobol\"", "\"halton\"", "\"sampler\" in the header should be \"independent\" or \"sobol\""},
        {"\"precision\": \"double\"", "\"precision\": \"half\"", "\"precision\""},
        {"\"fast\"", "\"slow\"", "\"math\""},
        {"\"plain\"", "\"fancy\"", "\"numerics\""},
        {"\"srgb\"", "\"gamma3\"", "\"transfer\""},
        {"\"partial\": true", "\"partial\": 1", "\"partial\""},
        {"\"segments\": 1", "\"segments\": -1", "\"segments\""},
        {"\"cut_paths\": 3", "\"cut_paths\": \"3\"", "\"cut_paths\""},
        {"\"invalid_samples\": 1", "\"other\": 1", "\"invalid_samples\""},
        {"\"title\"", "\"name\"", "\"title\""},
        {"[0, 9]", "[0, 0]", "\"ranges\""},
        {"[0, 9]", "[-1, 9]", "\"ranges\""},
        {"[0, 9]", "[0]", "\"ranges\""},
        {"[0, 9]", "5", "\"ranges\""},
        {"[0, 9]", "[0, 4294967295]", "\"ranges\""},
        {"[0, 9]", "[0, 9223372036854775807]", "\"ranges\""},
        {"[0, 9]", "[0, 70000000]", "at most 2^24"},
        {"[0, 9], [4294967294, 2]", "[4294967294, 2], [0, 9]", "sorted"},
        {"[4294967294, 2]", "[4294967294, 3]", "below 2^32"},
        {"[4294967294, 2]", "[8, 2]", "disjoint"},
        {"[[0, 9], [4294967294, 2]]", "{}", "\"ranges\""},
        {"[0, 9]", "[0, 3]", "contradicts its sample ranges"},
        {"{", "[", "not JSON"},
        {"\"title\"", "\"\xff\"", "not JSON"},
    };
    Files files;
    files_make(&files);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
        refuse_header(&files, cases[i].old, cases[i].new, cases[i].reason);
    files_clear(&files);
}

static void wrong_lengths_are_refused(void **state) {
    (void)state;
    Files files;
    files_make(&files);
    temp_write(files.bad, files.bytes, files.size);
    for (size_t size = files.size; size-- > 0;) { /* shortened in place: far faster than written anew */
        assert_int_equal(truncate(files.bad, (off_t)size), 0);
        refuse(&files, size < files.header_size ? "not a .bpa file" : "truncated");
    }
    temp_write(files.bad, files.bytes, files.size + 1); /* the 0 behind the bytes */
    refuse(&files, "too long");
    char *long_line = malloc(2000000);
    memset(long_line, ' ', 2000000);
    temp_write(files.bad, long_line, 2000000);
    refuse(&files, "does not begin with a line of JSON");
    long_line[1] = '\n';
    temp_write(files.bad, long_line, 2000000);
    refuse(&files, "not JSON");
    free(long_line);
    files_clear(&files);
}

static void wrong_numbers_are_refused(void **state) {
    (void)state;
    Files files;
    files_make(&files);
    uint8_t *sums = files.bytes + files.header_size, *fine_sums = sums + 1440, *counts = fine_sums + 1440;
    /* Pixel 8 has its replicates in cells 32 to 35; cell 35 has no samples. */
    sums[8 * 3 * 33 + 7] = 0x80;
    temp_write(files.bad, files.bytes, files.size);
    refuse(&files, "the sum of pixel 8 is negative");
    sums[8 * 3 * 33 + 7] = 0x61;
    temp_write(files.bad, files.bytes, files.size);
    refuse(&files, "the sum of pixel 8 is larger");
    sums[8 * 3 * 33 + 7] = 0x3f;
    sums[8 * 3 * 35] = 1;
    temp_write(files.bad, files.bytes, files.size);
    refuse(&files, "pixel 8 holds 0 samples in replicate 3, which contradicts its sums");
    sums[8 * 3 * 35] = 0;
    fine_sums[8 * 3 * 35] = 1;
    temp_write(files.bad, files.bytes, files.size);
    refuse(&files, "pixel 8 holds 0 samples in replicate 3, which contradicts its sums");
    fine_sums[8 * 3 * 35] = 0;
    fine_sums[8 * 3 * 33 + 7] ^= 0x80;
    temp_write(files.bad, files.bytes, files.size);
    refuse(&files, "the sum of pixel 8 is negative");
    fine_sums[8 * 3 * 33 + 7] ^= 0x80;
    counts[4 * 33] = 3;
    temp_write(files.bad, files.bytes, files.size);
    refuse(&files, "pixel 8 holds 3 samples in replicate 1, which contradicts its sample ranges");
    counts[4 * 33] = 2;
    temp_write(files.bad, files.bytes, files.size);
    refuse(&files, "checksum"); /* the sum that was changed first */
    files_clear(&files);
}

/* Any one bit of the file turned round is noticed. */
static void every_flipped_bit_is_noticed(void **state) {
    (void)state;
    Files files;
    files_make(&files);
    temp_write(files.bad, files.bytes, files.size);
    for (size_t bit = 0; bit < 8 * files.size; bit++) {
        const size_t touched =
            bit % 8 != 0 || bit == 0 ? bit / 8 : bit / 8 - 1; /* the last one is put right */
        files.bytes[bit / 8] ^= (uint8_t)(1u << (bit % 8));
        FILE *file = fopen(files.bad, "r+b");
        assert_non_null(file);
        assert_int_equal(fseek(file, (long)touched, SEEK_SET), 0);
        fwrite(files.bytes + touched, 1, bit / 8 - touched + 1, file);
        fclose(file);
        files.bytes[bit / 8] ^= (uint8_t)(1u << (bit % 8));
        BpFilm *a = NULL;
        if (bp_film_read(files.bad, &a, NULL) == BP_OK) fail_msg("bit %zu was not missed", bit);
    }
    files_clear(&files);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(wrong_members_are_named),
        cmocka_unit_test(wrong_lengths_are_refused),
        cmocka_unit_test(wrong_numbers_are_refused),
        cmocka_unit_test(every_flipped_bit_is_noticed),
    };
    return cmocka_run_group_tests_name("film_damaged", tests, NULL, NULL);
}
