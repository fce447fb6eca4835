/* one_case.c: runs a single case of a test program.
 *
 * In:    the environment variable BALLPARK_TEST_CASE, a case's name, in which * and ? stand for any letters.
 * Out:   cmocka leaves out the cases of other names.
 * Knows: cmocka.   Does not know: which cases there are. A name that no case has runs none, which passes. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

__attribute__((constructor)) static void choose_case(void) {
    const char *name = getenv("BALLPARK_TEST_CASE");
    if (name != NULL) cmocka_set_test_filter(name);
}
