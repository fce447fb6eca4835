/* test_output_forked.c: files can be written in a process that was forked while another thread was writing
 * one. */
#include "support/output_temp.h"

#include "base/output_file.h"

#include <pthread.h>
#include <stdatomic.h>
#include <sys/wait.h>

#define FORKS 300
#define CHILD_SECONDS 20

static atomic_bool enough;

static int put(const char *path) {
    BpOutputFile file;
    if (bp_output_open(path, &file, NULL) != BP_OK) return 1;
    fputs("text", file.stream);
    return bp_output_commit(&file, NULL) == BP_OK ? 0 : 2;
}

static void *put_all_the_time(void *path) {
    while (!atomic_load(&enough)) put(path);
    return NULL;
}

static int answer_of_child(const char *path) {
    int status = 0;
    const pid_t process = fork();
    assert_true(process >= 0);
    if (process == 0) {
        alarm(CHILD_SECONDS); /* where it waits for a thread that it does not have */
        _exit(put(path));
    }
    assert_int_equal(waitpid(process, &status, 0), process);
    return status;
}

static void a_child_does_not_wait_for_threads_of_its_parent(void **state) {
    (void)state;
    char folder[64], own[512], others[512];
    pthread_t thread;
    temp_make(folder);
    temp_path(own, folder, "own.txt");
    temp_path(others, folder, "others.txt");
    assert_int_equal(pthread_create(&thread, NULL, put_all_the_time, others), 0);
    int status = 0;
    for (int i = 0; i < FORKS && status == 0; i++) status = answer_of_child(own);
    atomic_store(&enough, true);
    assert_int_equal(pthread_join(thread, NULL), 0);
    assert_int_equal(status, 0);
    temp_assert_text(own, "text");
    assert_int_equal(temp_count(folder), 2);
    temp_remove(folder);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_child_does_not_wait_for_threads_of_its_parent)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
