/* test_output_file.c: files appear whole or not at all, whatever the target is (host/base/output_file.h). */
#include "support/output_temp.h"

#include "base/output_file.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>

static void put(const char *path, const char *text) {
    BpOutputFile file;
    BpError err = {0};
    assert_int_equal(bp_output_open(path, &file, &err), BP_OK);
    fputs(text, file.stream);
    assert_int_equal(bp_output_commit(&file, &err), BP_OK);
}

static unsigned mode_of(const char *path) {
    struct stat info;
    assert_int_equal(stat(path, &info), 0);
    return info.st_mode & 07777;
}

static void new_file_gets_the_umask(void **state) {
    (void)state;
    char folder[64], path[512];
    temp_make(folder);
    const mode_t before = umask(027);
    put(temp_path(path, folder, "new.txt"), "hello");
    umask(before);
    temp_assert_text(path, "hello");
    assert_int_equal(mode_of(path), 0640);
    assert_int_equal(temp_count(folder), 1);
    temp_remove(folder);
}

static void replaced_file_keeps_its_mode_and_stays_until_the_commit(void **state) {
    (void)state;
    char folder[64], path[512];
    temp_make(folder);
    temp_write(temp_path(path, folder, "old.txt"), "old", 3);
    assert_int_equal(chmod(path, 0604), 0);
    BpOutputFile file;
    BpError err = {0};
    assert_int_equal(bp_output_open(path, &file, &err), BP_OK);
    fputs("new", file.stream);
    fflush(file.stream);
    temp_assert_text(path, "old");
    assert_int_equal(temp_count(folder), file.unnamed ? 1 : 2);
    assert_int_equal(bp_output_commit(&file, &err), BP_OK);
    temp_assert_text(path, "new");
    assert_int_equal(mode_of(path), 0604);
    assert_int_equal(temp_count(folder), 1);
    temp_remove(folder);
}

static void discard_leaves_nothing_behind(void **state) {
    (void)state;
    char folder[64], path[512];
    temp_make(folder);
    temp_write(temp_path(path, folder, "old.txt"), "old", 3);
    BpOutputFile file;
    BpError err = {0};
    assert_int_equal(bp_output_open(path, &file, &err), BP_OK);
    fputs("half a fi", file.stream);
    bp_output_discard(&file);
    bp_output_discard(&file); /* a second time does no harm */
    temp_assert_text(path, "old");
    assert_int_equal(temp_count(folder), 1);
    temp_remove(folder);
}

static void symbolic_links_are_followed(void **state) {
    (void)state;
    char folder[64], path[512], link_path[512], second[512];
    temp_make(folder);
    temp_path(path, folder, "target.txt");
    temp_path(link_path, folder, "link.txt");
    temp_path(second, folder, "second.txt");
    assert_int_equal(symlink("target.txt", link_path), 0); /* dangling, relative to its own folder */
    assert_int_equal(symlink(link_path, second), 0);       /* absolute, to a link */
    put(second, "one");
    temp_assert_text(path, "one");
    put(link_path, "two");
    temp_assert_text(path, "two");
    struct stat info;
    assert_int_equal(lstat(link_path, &info), 0);
    assert_true(S_ISLNK(info.st_mode));
    assert_int_equal(temp_count(folder), 3);

    assert_int_equal(unlink(link_path), 0);
    assert_int_equal(symlink("second.txt", link_path), 0); /* a ring */
    BpError err = {0};
    assert_int_equal(bp_output_check(link_path, &err), BP_ERR_FILE);
    assert_non_null(strstr(err.message, "symbolic links"));
    temp_remove(folder);
}

static void devices_and_pipes_are_written_directly(void **state) {
    (void)state;
    BpOutputFile file;
    BpError err = {0};
    assert_int_equal(bp_output_open("/dev/null", &file, &err), BP_OK);
    assert_true(file.direct);
    fputs("x", file.stream);
    assert_int_equal(bp_output_commit(&file, &err), BP_OK);

    char folder[64], path[512], text[8] = "";
    temp_make(folder);
    assert_int_equal(mkfifo(temp_path(path, folder, "pipe"), 0600), 0);
    assert_int_equal(bp_output_check(path, &err), BP_OK); /* without waiting for a reader */
    const int reader = open(path, O_RDONLY | O_NONBLOCK);
    assert_true(reader >= 0);
    put(path, "piped");
    assert_int_equal(read(reader, text, sizeof text), 5);
    assert_string_equal(text, "piped");
    close(reader);
    assert_int_equal(temp_count(folder), 1);
    temp_remove(folder);
}

static void a_full_device_is_an_error(void **state) {
    (void)state;
    BpOutputFile file;
    BpError err = {0};
    if (access("/dev/full", W_OK) != 0) {
        printf("skipped: there is no /dev/full here\n");
        skip();
    }
    assert_int_equal(bp_output_open("/dev/full", &file, &err), BP_OK);
    fputs("does not fit", file.stream);
    assert_int_equal(bp_output_commit(&file, &err), BP_ERR_FILE);
    assert_non_null(strstr(err.message, "/dev/full"));
    assert_non_null(strstr(err.message, "No space left"));
    assert_string_equal(err.file, "/dev/full");
}

/* A file that may not grow stands for a disk that is full: the write fails in the middle. */
static void a_failed_write_keeps_the_old_file(void **state) {
    (void)state;
    char folder[64], path[512];
    temp_make(folder);
    temp_write(temp_path(path, folder, "old.txt"), "old", 3);
    struct rlimit before, limit;
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
    limit = before;
    limit.rlim_cur = 4096;
    void (*const handler)(int) = signal(SIGXFSZ, SIG_IGN);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
    BpOutputFile file;
    BpError err = {0};
    const BpStatus opened = bp_output_open(path, &file, &err);
    for (int i = 0; i < 100000; i++) fputc('x', file.stream);
    const BpStatus committed = bp_output_commit(&file, &err);
    setrlimit(RLIMIT_FSIZE, &before);
    signal(SIGXFSZ, handler);
    assert_int_equal(opened, BP_OK);
    assert_int_equal(committed, BP_ERR_FILE);
    temp_assert_text(path, "old");
    assert_int_equal(temp_count(folder), 1);
    temp_remove(folder);
}

static void check_refuses(const char *path, const char *reason) {
    BpError err = {0};
    assert_int_equal(bp_output_check(path, &err), BP_ERR_FILE);
    if (strstr(err.message, reason) == NULL) fail_msg("'%s' does not say '%s'", err.message, reason);
}

static void check_finds_what_cannot_be_written(void **state) {
    (void)state;
    char folder[64], path[512];
    temp_make(folder);
    BpError err = {0};
    check_refuses("", "empty");
    check_refuses(folder, "Is a directory");
    check_refuses(temp_path(path, folder, "missing/a.png"), "create the folder first");
    check_refuses(temp_path(path, folder, "slash/"), "Is a directory");
    temp_write(temp_path(path, folder, "file"), "old", 3);
    assert_int_equal(bp_output_check(path, &err), BP_OK);
    temp_assert_text(path, "old");
    check_refuses(temp_path(path, folder, "file/a.png"), "Not a directory");
    assert_int_equal(bp_output_check(temp_path(path, folder, "new.png"), &err), BP_OK);
    assert_int_equal(temp_count(folder), 1);

    char longest[512] = "";
    snprintf(longest, sizeof longest, "%s/%0255d", folder, 7); /* as long as a name can be */
    assert_int_equal(bp_output_check(longest, &err), BP_OK);
    put(longest, "x");
    temp_assert_text(longest, "x");
    snprintf(longest, sizeof longest, "%s/%0256d", folder, 7);
    check_refuses(longest, "shorter");
    temp_remove(folder);
}

/* Root may write everything, so a child that is not root tries. */
static int in_child_without_rights(const char *protected_file, const char *closed_folder_file) {
    if (geteuid() == 0 && setuid(65534) != 0) return 10;
    BpError err = {0};
    if (bp_output_check(protected_file, &err) != BP_ERR_FILE) return 11;
    if (strstr(err.message, "permissions") == NULL) return 12;
    if (bp_output_check(closed_folder_file, &err) != BP_ERR_FILE) return 13;
    if (strstr(err.message, "permissions") == NULL) return 14;
    return 0;
}

static void permissions_are_respected(void **state) {
    (void)state;
    char folder[64], closed[64], protected_file[512], closed_file[512];
    temp_make(folder);
    temp_make(closed);
    assert_int_equal(chmod(folder, 0777), 0);
    assert_int_equal(chmod(closed, 0555), 0);
    temp_write(temp_path(protected_file, folder, "protected"), "old", 3);
    assert_int_equal(chmod(protected_file, 0444), 0);
    const pid_t child = fork();
    if (child == 0) _exit(in_child_without_rights(protected_file, temp_path(closed_file, closed, "a.png")));
    int result = -1;
    assert_int_equal(waitpid(child, &result, 0), child);
    assert_true(WIFEXITED(result));
    assert_int_equal(WEXITSTATUS(result), 0);
    temp_remove(folder);
    temp_remove(closed);
}

static void set_id_bits_are_not_handed_on(void **state) {
    (void)state;
    char folder[64], path[512];
    temp_make(folder);
    temp_write(temp_path(path, folder, "old.txt"), "old", 3);
    assert_int_equal(chmod(path, 06755), 0);
    put(path, "new");
    assert_int_equal(mode_of(path), 0755);
    temp_remove(folder);
}

/* A folder at the target's name stands for whatever keeps a finished file from its place. */
static void a_finished_file_is_not_lost(void **state) {
    (void)state;
    char folder[64], path[512], *named;
    temp_make(folder);
    BpOutputFile file;
    BpError err = {0};
    assert_int_equal(bp_output_open(temp_path(path, folder, "new.txt"), &file, &err), BP_OK);
    fputs("finished", file.stream);
    assert_int_equal(mkdir(path, 0700), 0);
    assert_int_equal(bp_output_commit(&file, &err), BP_ERR_FILE);
    named = strstr(err.message, "the complete result is in ");
    assert_non_null(named);
    named += strlen("the complete result is in ");
    temp_assert_text(named, "finished");
    assert_int_equal(temp_count(folder), 2);
    assert_int_equal(rmdir(path), 0);
    temp_remove(folder);
}

/* An open file of the process is written where its other writers left it. */
static void open_descriptors_are_written_through(void **state) {
    (void)state;
    char folder[64], path[512], name[64];
    temp_make(folder);
    temp_write(temp_path(path, folder, "shared.txt"), "", 0);
    const int descriptor = open(path, O_WRONLY);
    assert_true(descriptor >= 0);
    assert_int_equal(write(descriptor, "before ", 7), 7);
    snprintf(name, sizeof name, "/dev/fd/%d", descriptor);
    if (access("/dev/fd", X_OK) != 0) skip();
    put(name, "amid");
    assert_int_equal(write(descriptor, " after", 6), 6);
    close(descriptor);
    temp_assert_text(path, "before amid after");
    BpError err = {0};
    assert_int_equal(bp_output_check(name, &err), BP_ERR_FILE); /* closed by now */
    assert_non_null(strstr(err.message, "no file is open"));
    temp_remove(folder);
}

static void names_are_compared_by_what_they_lead_to(void **state) {
    (void)state;
    char folder[64], path[512], other[512], link_path[512];
    temp_make(folder);
    temp_path(path, folder, "a.png");
    snprintf(other, sizeof other, "%s/./a.png", folder);
    assert_true(bp_output_same(path, other, 1)); /* neither is there yet */
    assert_false(bp_output_same(path, temp_path(link_path, folder, "b.png"), 1));
    assert_int_equal(symlink("a.png", link_path), 0);
    assert_true(bp_output_same(path, link_path, 1));
    temp_write(path, "x", 1);
    assert_true(bp_output_same(path, other, 1));
    assert_int_equal(link(path, temp_path(other, folder, "c.png")), 0);
    assert_true(bp_output_same(path, other, 1));
    assert_false(bp_output_same("/dev/null", "/dev/null", 1)); /* may be named twice */
    temp_remove(folder);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(new_file_gets_the_umask),
        cmocka_unit_test(replaced_file_keeps_its_mode_and_stays_until_the_commit),
        cmocka_unit_test(set_id_bits_are_not_handed_on),
        cmocka_unit_test(a_finished_file_is_not_lost),
        cmocka_unit_test(open_descriptors_are_written_through),
        cmocka_unit_test(names_are_compared_by_what_they_lead_to),
        cmocka_unit_test(discard_leaves_nothing_behind),
        cmocka_unit_test(symbolic_links_are_followed),
        cmocka_unit_test(devices_and_pipes_are_written_directly),
        cmocka_unit_test(a_full_device_is_an_error),
        cmocka_unit_test(a_failed_write_keeps_the_old_file),
        cmocka_unit_test(check_finds_what_cannot_be_written),
        cmocka_unit_test(permissions_are_respected),
    };
    return cmocka_run_group_tests_name("output_file", tests, NULL, NULL);
}
