/* test_status.c: a message that is too long keeps its beginning and its end, since a path in the middle makes
 * it so. */
#include "base/status.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static char *repeated(const char *part, size_t count) {
    const size_t length = strlen(part);
    char *text = malloc(length * count + 1);
    for (size_t i = 0; i < count; i++) memcpy(text + i * length, part, length);
    text[length * count] = '\0';
    return text;
}

static void what_fits_stays(void **state) {
    (void)state;
    for (size_t length = 0; length < sizeof((BpError *)0)->message; length++) {
        char *text = repeated("x", length);
        BpError err = {0};
        assert_int_equal(bp_fail(&err, BP_ERR_FILE, "%s", text), BP_ERR_FILE);
        assert_string_equal(err.message, text);
        if (length < sizeof err.file) {
            bp_error_at(&err, text, 1, 2);
            assert_string_equal(err.file, text);
        }
        free(text);
    }
}

static void long_paths_keep_the_reason(void **state) {
    (void)state;
    static const size_t counts[] = {200, 255, 256, 257, 1000, 20000};
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
        char *path = repeated("/abc", counts[i]);
        BpError err = {0};
        bp_fail(&err, BP_ERR_FILE, "cannot open %s: No such file; check the path", path);
        assert_int_equal(strncmp(err.message, "cannot open /abc/abc", 20), 0);
        assert_non_null(strstr(err.message, "bc: No such file; check the path"));
        assert_true((strstr(err.message, "[...]") != NULL) == (strlen(path) > 980));
        bp_error_at(&err, path, 3, 4);
        assert_int_equal(strncmp(err.file, "/abc/abc", 8), 0);
        assert_string_equal(err.file + strlen(err.file) - 8, "/abc/abc");
        assert_int_equal(strlen(err.file), sizeof err.file - 1);
        /* The new message may quote the old one. */
        bp_fail(&err, BP_ERR_FILE, "%s, and more", err.message);
        assert_non_null(strstr(err.message, "bc: No such file; check the path, and more"));
        free(path);
    }
}

static bool is_utf8(const char *text) {
    for (const unsigned char *c = (const unsigned char *)text; *c != 0;) {
        const size_t more = *c < 0x80 ? 0 : *c >= 0xf0 ? 3 : *c >= 0xe0 ? 2 : *c >= 0xc0 ? 1 : 9;
        if (more == 9) return false;
        for (size_t i = 1; i <= more; i++)
            if ((c[i] & 0xc0) != 0x80) return false;
        c += 1 + more;
    }
    return true;
}

/* Characters stay whole wherever the gap falls. */
static void characters_stay_whole(void **state) {
    (void)state;
    char *path = repeated("\xf0\x9f\x8e\xb1\xe2\x82\xac\xc3\xa4", 400);
    for (size_t shift = 0; shift < 9; shift++) {
        BpError err = {0};
        bp_fail(&err, BP_ERR_FILE, "%.*s%s: reason", (int)shift, "123456789", path);
        assert_true(is_utf8(err.message));
        assert_non_null(strstr(err.message, ": reason"));
        assert_in_range(strlen(err.message), sizeof err.message - 8, sizeof err.message - 1);
        bp_error_at(&err, path, 0, 0);
        assert_true(is_utf8(err.file));
    }
    free(path);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_fits_stays),
        cmocka_unit_test(long_paths_keep_the_reason),
        cmocka_unit_test(characters_stay_whole),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
