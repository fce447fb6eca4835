/* test_pages.c: asking for large pages changes no contents, whatever the size, also where an array grows. */
#include "base/pages.h"

#include <errno.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static void contents_stay(void **state) {
    (void)state;
    const size_t sizes[] = {1, 4096, 1 << 20, 8 << 20, (8 << 20) + 1, 40 << 20};
    unsigned char *memory = NULL;
    size_t filled = 0;
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; ++s) {
        unsigned char *const grown = realloc(memory, sizes[s]);
        assert_non_null(grown);
        memory = bp_large_pages(grown, sizes[s]);
        assert_ptr_equal(memory, grown);
        for (size_t i = 0; i < filled; i += 997) assert_int_equal(memory[i], (unsigned char)(i * 31));
        for (; filled < sizes[s]; ++filled) memory[filled] = (unsigned char)(filled * 31);
        assert_ptr_equal(bp_large_pages(memory, sizes[s]), memory);
        assert_int_equal(memory[sizes[s] - 1], (unsigned char)((sizes[s] - 1) * 31));
    }
    free(memory);
}

static void nothing_is_nothing(void **state) {
    (void)state;
    errno = ERANGE;
    assert_null(bp_large_pages(NULL, 0));
    assert_null(bp_large_pages(NULL, SIZE_MAX / 2));
    assert_int_equal(errno, ERANGE);
}

static void own_pages_begin_and_end_alone(void **state) {
    (void)state;
    const size_t sizes[] = {0, 1, 4096, 100001, 8 << 20, (9 << 20) + 1};
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; ++s) {
        unsigned char *const memory = bp_own_pages(sizes[s], 3);
        assert_non_null(memory);
        assert_true(bp_begins_page(memory));
        assert_false(bp_begins_page(memory + 1));
        memset(memory, 7, 3 * sizes[s]);
        free(memory);
    }
    assert_null(bp_own_pages(SIZE_MAX / 2, 3));
    assert_null(bp_own_pages(1, SIZE_MAX));
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(contents_stay), cmocka_unit_test(nothing_is_nothing),
                                       cmocka_unit_test(own_pages_begin_and_end_alone)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
