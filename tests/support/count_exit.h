/* count_exit.h: a process that ends by _exit() counts too; put before every source by the preset `coverage`.
 *
 * Children of a process end so (cli/process/child_process.c), and what they did would be lost: gcov writes
 * its counts down at exit(). Before fork() it has written those of the parent and begins anew in the child.
 * Knows: gcov.   Does not know: what is counted. */
#ifndef TESTS_SUPPORT_COUNT_EXIT_H
#define TESTS_SUPPORT_COUNT_EXIT_H

void __gcov_dump(void);
void _exit(int) __attribute__((noreturn));

static inline void __attribute__((noreturn, unused)) exit_counted(int code) {
    __gcov_dump();
    _exit(code);
}
#define _exit exit_counted

#endif
