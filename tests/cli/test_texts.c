/* test_texts.c: numbers as people read them, the progress bar at every width. */
#include "base/format.h"
#include "cli/line/values.h"
#include "cli/terminal/progress.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

static void percents(void **unused) {
    (void)unused;
    char text[32];
    assert_string_equal(bp_format_percent(0.0, text, sizeof text), "0 %");
    assert_string_equal(bp_format_percent(0.000123, text, sizeof text), "0.012 %");
    assert_string_equal(bp_format_percent(0.0123, text, sizeof text), "1.2 %");
    assert_string_equal(bp_format_percent(0.123, text, sizeof text), "12 %");
    assert_string_equal(bp_format_percent(1.0, text, sizeof text), "100 %");
    assert_string_equal(bp_format_percent(NAN, text, sizeof text), "unknown");
}

static void seconds(void **unused) {
    (void)unused;
    static const struct {
        double value;
        const char *text;
    } cases[] = {{0.0, "0 s"},
                 {0.000123, "0.12 ms"},
                 {0.0034, "3.4 ms"},
                 {0.0123, "12 ms"},
                 {0.0994, "99 ms"},
                 {0.0996, "0.10 s"},
                 {0.5, "0.50 s"},
                 {1.25, "1.2 s"},
                 {3.0, "3 s"},
                 {12.3, "12 s"},
                 {99.4, "99 s"},
                 {100.0, "1 min 40 s"},
                 {3599.0, "59 min 59 s"},
                 {7500.0, "2 h 05 min"},
                 {500000.0, "6 days"},
                 {1e9, "more than 30 years"},
                 {INFINITY, "more than 30 years"},
                 {NAN, "an unknown time"}};
    char text[32];
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i)
        assert_string_equal(bp_format_seconds(cases[i].value, text, sizeof text), cases[i].text);
}

static void counts(void **unused) {
    (void)unused;
    char text[32];
    assert_string_equal(bp_format_count(0.0, text, sizeof text), "0");
    assert_string_equal(bp_format_count(999.0, text, sizeof text), "999");
    assert_string_equal(bp_format_count(999.6, text, sizeof text), "1.00 thousand");
    assert_string_equal(bp_format_count(23456.0, text, sizeof text), "23.5 thousand");
    assert_string_equal(bp_format_count(5760000.0, text, sizeof text), "5.76 million");
    assert_string_equal(bp_format_count(123456789012.0, text, sizeof text), "123 billion");
    assert_string_equal(bp_format_whole(0, text, sizeof text), "0");
    assert_string_equal(bp_format_whole(999, text, sizeof text), "999");
    assert_string_equal(bp_format_whole(480000, text, sizeof text), "480,000");
    assert_string_equal(bp_format_whole(1234567, text, sizeof text), "1,234,567");
}

/* Columns of a text in UTF-8, all of whose characters are one wide. */
static size_t columns_of(const char *text) {
    size_t columns = 0;
    for (; *text != '\0'; ++text) columns += ((unsigned char)*text & 0xc0u) != 0x80u;
    return columns;
}

static void bars(void **unused) {
    (void)unused;
    char text[512];
    BpProgressView view = {.samples_per_second = 5.2e6, .nrmse = 0.021, .seconds_left = 11.5};
    for (int utf8 = 0; utf8 < 2; ++utf8) {
        for (unsigned columns = 1; columns <= 300; ++columns) {
            for (view.fraction = -0.1; view.fraction < 1.2; view.fraction += 0.037) {
                bp_progress_format(&view, columns, utf8 != 0, text, sizeof text);
                assert_true(columns_of(text) < columns);
                assert_true(columns_of(text) >= 8 || columns < 15);
                assert_true(columns < 6 || strchr(text, '%') != NULL);
            }
        }
    }
    view.fraction = 0.5;
    assert_string_equal(bp_progress_format(&view, 70, false, text, sizeof text),
                        "#######--------  50 %  12 s left  noise 2.1 %  5.20 million samples/s");
    assert_string_equal(bp_progress_format(&view, 20, false, text, sizeof text), "######-------  50 %");
    assert_string_equal(bp_progress_sentence(&view, text, sizeof text),
                        "50 %, 12 s left, noise 2.1 %, 5.20 million samples/s");
    view.nrmse = view.seconds_left = NAN;
    bp_progress_format(&view, 60, true, text, sizeof text);
    assert_non_null(strstr(text, "? left"));
    assert_null(strstr(text, "error"));
    assert_string_equal(bp_progress_sentence(&view, text, sizeof text), "50 %, 5.20 million samples/s");
}

/* Lines of a log: soon at first, rare at last. Each is due after the one before, however late that one was.
 */
static void log_lines(void **unused) {
    (void)unused;
    const double due[] = {3, 6, 12, 24, 48, 96, 192, 384, 768, 1368, 1968};
    double before = 0;
    for (size_t i = 0; i < sizeof due / sizeof *due; ++i) {
        assert_true(bp_progress_next(before) == due[i]);
        before = due[i] + 0.25;
    }
    assert_true(bp_progress_next(50) == 96);
}

static void pairs(void **unused) {
    (void)unused;
    uint32_t x = 0, y = 0;
    assert_int_equal(bp_value_pair("--pixel", "3,0", 65534, &x, &y, NULL), BP_OK);
    assert_int_equal(x, 3);
    assert_int_equal(y, 0);
    static const char *const bad[] = {"",
                                      "3",
                                      "3,",
                                      ",3",
                                      "3,4,5",
                                      "3, 4",
                                      "-3,4",
                                      "3.5,4",
                                      "3,65535",
                                      "3x4",
                                      "99999999999999999999999999999999999,1"};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; ++i) {
        BpError err = {0};
        assert_int_equal(bp_value_pair("--pixel", bad[i], 65534, &x, &y, &err), BP_ERR_USAGE);
        assert_non_null(strstr(err.message, "--pixel"));
        bp_error_clear(&err);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(percents), cmocka_unit_test(seconds),   cmocka_unit_test(counts),
        cmocka_unit_test(bars),     cmocka_unit_test(log_lines), cmocka_unit_test(pairs),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
