/* test_film_damaged.c: damaged .bpa files are refused (host/film/film_file.h). */
#include "film/film_file.h"
#include "film_sample.h"

#include <zlib.h>

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

/* The checksum of the first `size` - 4 bytes, into the last 4. */
static void put_checksum(uint8_t *bytes, size_t size) {
    const uLong crc = crc32_z(crc32_z(0, NULL, 0), bytes, size - 4);
    for (size_t byte = 0; byte < 4; byte++) bytes[size - 4 + byte] = (uint8_t)(crc >> (8 * byte));
}

/* The good file with `old` in its header replaced; with a true checksum, if `sums_up`. */
static void refuse_header(const Files *files, const char *old, const char *new, bool sums_up,
                          const char *reason) {
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
    if (sums_up) put_checksum(bytes, size);
    temp_write(files->bad, bytes, size);
    free(bytes);
    refuse(files, reason);
}

static void wrong_members_are_named(void **state) {
    (void)state;
    static const struct {
        const char *old, *new, *reason;
    } cases[] = {
        {"\"ballpark_film\": 1", "\"ballpark_film\": 0", "should be a whole number from 1"},
        {"\"ballpark_film\": 1", "\"ballpark_film\": 2",
         "has version 2 of the format, but this program reads version 1: use a newer Ballpark"},
        {"\"ballpark_film\": 1", "\"ballpark_accumulator\": 1", "was made by an unreleased Ballpark"},
        {"\"ballpark_film\": 1", "\"ballpark_accumulator\": 5",
         "was made by an unreleased Ballpark, and this one cannot read it: render its samples again"},
        {", \"unseen\": true", "", "\"unseen\" in the header should be true or false"},
        {", \"alpha\": true", "", "\"alpha\""},
        {"\"light_sampling\"", "\"other\"", "\"light_sampling\""},
        {"\"caustics\"", "\"other\"", "\"caustics\""},
        {"\"roulette\"", "\"other\"", "\"roulette\""},
        {"\"shadow_rays\"", "\"other\"", "\"shadow_rays\""},
        {"\"negative_samples\"", "\"other\"", "\"negative_samples\""},
        {"\"negative_samples\": 300", "\"negative_samples\": 299", "should be the sum of their causes"},
        {"\"unseen\": true", "\"unseen\": false", "too long"},
        {"\"unseen\": true", "\"unseen\": 1", "\"unseen\" in the header should be true or false"},
        {"\"alpha\": true", "\"alpha\": false", "the colour of the unseen light is none"},
        {"\"alpha\": true", "\"alpha\": 1", "\"alpha\""},
        {"\"aovs\": true", "\"aovs\": false", "the alpha of pixel 0 is above 1"},
        {"\"aovs\": true", "\"aovs\": 1", "\"aovs\""},
        {"\"pixel_segments\": true", "\"pixel_segments\": false", "the alpha of pixel 0 is above 1"},
        {"\"pixel_segments\": true", "\"pixel_segments\": null", "\"pixel_segments\""},
        {"\"decision_bytes\": 50", "\"decision_bytes\": 49", "too long"},
        {"\"decision_bytes\": 50", "\"decision_bytes\": 51", "truncated"},
        {"\"decision_bytes\": 50", "\"decision_bytes\": -1", "\"decision_bytes\""},
        {"\"decision_bytes\": 50", "\"decision_bytes\": 2147483647",
         "more than these bytes can be unpacked to"},
        {"\"adaptive\": true", "\"adaptive\": 1", "\"adaptive\""},
        {"\"target\": 1000", "\"target\": 0", "\"target\""},
        {"\"target\": 1000", "\"target\": 4294967295", "\"plan\""},
        {"\"done\": 7", "\"done\": -7", "\"done\""},
        {"\"next_pixel\": 14", "\"next_pixel\": 15", "\"plan\""},
        {"\"pass_samples\": 3", "\"pass_samples\": 0", "\"plan\""},
        {"\"samples_max\": 5000", "\"samples_max\": 4294967297", "\"samples_max\""},
        {"\"error\": 0.125", "\"error\": -0.1", "\"error\""},
        {"\"error\": 0.125", "\"error\": \"0.1\"", "\"error\""},
        {"[0, 4294967296]", "[0, 4294967297]", "\"job\""},
        {"[0, 4294967296]", "[0, 0]", "\"job\""},
        {"[0, 4294967296]", "[0]", "\"job\""},
        {"\"fine_sums\": true", "\"fine_sums\": 1", "\"fine_sums\" in the header should be true or false"},
        {"\"coarse\": true, ", "", "\"coarse\""},
        {"\"ballpark_film\"", "\"other\"", "is missing"},
        {"\"little\"", "\"big\"", "\"byte_order\" in the header should be \"little\""},
        {"\"width\": 5", "\"width\": 0", "\"width\" in the header should be a whole number from 1 to 65535"},
        {"\"width\": 5", "\"width\": 65536", "\"width\""},
        {"\"width\": 5", "\"width\": 5.0", "\"width\""},
        {"\"width\": 5", "\"width\": -5", "\"width\""},
        {"\"width\": 5", "\"width\": 99999999999999999999", "not JSON"},
        {"\"width\": 5, \"height\": 3, \"replicates\": 4",
         "\"width\": 65535, \"height\": 65535, \"replicates\": 64",
         "says 14"}, /* without allocating 7 TiB first */
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
        {"\"invalid_samples\": 4320", "\"other\": 1", "\"invalid_samples\""},
        {"\"not_finite_samples\": 20", "\"not_finite_samples\": 4321", "\"not_finite_samples\""},
        {"\"negative_samples\": 300", "\"negative_samples\": 4301", "\"negative_samples\""},
        {"\"out_of_range_samples\": 4000", "\"out_of_range_samples\": 4001", "\"out_of_range_samples\""},
        {"\"shadow_rays\": 5", "\"shadow_rays\": -5", "\"shadow_rays\""},
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
        refuse_header(&files, cases[i].old, cases[i].new, true, cases[i].reason);
    static const char *const unsaid[][2] = {{"A \\\"title", "B \\\"title"},
                                            {"\"segments\": 1", "\"segments\": 2"},
                                            {"\"width\": 5", "\"width\": 6"},
                                            {"\"error\": 0.125", "\"error\": 0.2"}};
    for (size_t i = 0; i < sizeof unsaid / sizeof unsaid[0]; i++)
        refuse_header(&files, unsaid[i][0], unsaid[i][1], false, "is truncated or damaged: its checksum is");
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
    refuse(&files, "truncated or damaged");
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

/* A film with wrong numbers, in a file whose checksum is right. */
static void refuse_film(const Files *files, const BpFilm *film, const char *reason) {
    assert_int_equal(bp_film_write(film, files->bad, NULL), BP_OK);
    refuse(files, reason);
}

static void wrong_numbers_are_refused(void **state) {
    (void)state;
    Files files;
    files_make(&files);
    BpFilm *film = make();
    /* Pixel 8 has its replicates in cells 32 to 35; cell 35 has no samples. */
    int64_t *sum = &film->sums[3 * 33], *fine = &film->fine_sums[3 * 33], good = *sum;
    *sum = -1;
    refuse_film(&files, film, "the sum of pixel 8 is negative");
    *sum = INT64_C(0x6100000000000000);
    refuse_film(&files, film, "the sum of pixel 8 is larger");
    *sum = good;
    good = *fine;
    *fine = INT64_MIN;
    refuse_film(&files, film, "the sum of pixel 8 is negative");
    *fine = good;
    film->sums[3 * 35] = 1;
    refuse_film(&files, film, "pixel 8 holds 0 samples in replicate 3, which contradicts its sums");
    film->sums[3 * 35] = 0;
    film->fine_sums[3 * 35] = 1;
    refuse_film(&files, film, "pixel 8 holds 0 samples in replicate 3, which contradicts its sums");
    film->fine_sums[3 * 35] = 0;
    film->counts[33] = 4;
    refuse_film(&files, film, "pixel 8 holds 4 samples in replicate 1, which contradicts its sample ranges");
    film->counts[33] = 2;
    film->depth[8] = NAN;
    refuse_film(&files, film, "the depth of pixel 8 is not a number");
    film->depth[8] = INFINITY;
    film->albedo[3 * 8 + 1] = INFINITY;
    refuse_film(&files, film, "the albedo of pixel 8 is not a number");
    film->albedo[3 * 8 + 1] = 0;
    film->met[8] = 5; /* of 4 samples */
    refuse_film(&files, film, "the alpha of pixel 8 is above 1");
    film->met[8] = 4;
    static const float bad[] = {-1, NAN, INFINITY};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        BpUnseenPixel *unseen = &film->unseen->pixels[8];
        const BpUnseenPixel kept = *unseen;
        unseen->mean = bad[i];
        refuse_film(&files, film, "the unseen light of pixel 8 is not a radiance");
        *unseen = (BpUnseenPixel){kept.mean, bad[i]};
        refuse_film(&files, film, "the unseen light of pixel 8 is not a radiance");
        *unseen = kept;
        film->unseen->tint[1] = bad[i];
        refuse_film(&files, film, "the colour of the unseen light is none");
        film->unseen->tint[1] = 1;
    }
    assert_int_equal(bp_film_write(film, files.bad, NULL), BP_OK);
    BpFilm *read = NULL;
    assert_int_equal(bp_film_read(files.bad, &read, NULL), BP_OK);
    bp_film_destroy(&read);
    bp_film_destroy(&film);
    files_clear(&files);
}

/* The numbers of a file packed by somebody else: shorter, longer, and none of zlib's, with a true checksum.
 */
static void wrong_packing_is_refused(void **state) {
    (void)state;
    Files files;
    files_make(&files);
    uint8_t numbers[10000], bytes[20000];
    uLongf count = sizeof numbers - 1;
    const size_t head = files.header_size;
    assert_int_equal(uncompress(numbers, &count, files.bytes + head, (uLong)(files.size - 4 - head)), Z_OK);
    numbers[count] = 0;
    static const struct {
        int more;
        size_t behind;
        const char *reason;
    } cases[] = {
        {-1, 0, "truncated"}, {1, 0, "too long"}, {0, 1, "too long"}, {0, 70000, "too long"}, {0, 0, NULL}};
    memcpy(bytes, files.bytes, head);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        uLongf packed = sizeof bytes - head;
        assert_int_equal(compress(bytes + head, &packed, numbers, (uLong)((long)count + cases[i].more)),
                         Z_OK);
        const size_t size = head + packed + cases[i].behind + 4;
        uint8_t *file = calloc(size, 1);
        memcpy(file, bytes, head + packed);
        put_checksum(file, size);
        temp_write(files.bad, file, size);
        free(file);
        BpFilm *film = NULL;
        if (cases[i].reason != NULL)
            refuse(&files, cases[i].reason);
        else
            assert_int_equal(bp_film_read(files.bad, &film, NULL), BP_OK);
        bp_film_destroy(&film);
    }
    memcpy(bytes, files.bytes, files.size);
    bytes[head] ^= 0xff; /* no header of zlib's */
    put_checksum(bytes, files.size);
    temp_write(files.bad, bytes, files.size);
    refuse(&files, "cannot be unpacked");
    files_clear(&files);
}

/* Any one bit of the file turned round is noticed. With sanitizers, where a file takes ten times as long,
 * every seventh is tried, so that all eight of a byte have their turn. */
#ifdef __SANITIZE_ADDRESS__
#define BIT_STEP 7
#else
#define BIT_STEP 1
#endif
static void every_flipped_bit_is_noticed(void **state) {
    (void)state;
    Files files;
    files_make(&files);
    temp_write(files.bad, files.bytes, files.size);
    for (size_t bit = 0; bit < 8 * files.size; bit += BIT_STEP) {
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
        cmocka_unit_test(wrong_members_are_named),      cmocka_unit_test(wrong_lengths_are_refused),
        cmocka_unit_test(wrong_numbers_are_refused),    cmocka_unit_test(wrong_packing_is_refused),
        cmocka_unit_test(every_flipped_bit_is_noticed),
    };
    return cmocka_run_group_tests_name("film_damaged", tests, NULL, NULL);
}
