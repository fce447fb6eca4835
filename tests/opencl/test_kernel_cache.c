/* test_kernel_cache.c: programs that are kept (host/opencl/kernel_cache.h): found again, never wrong ones.
 *
 * test_kernel_cache ROUNDS: eight processes instead, each of which builds so often, while files are damaged.
 * test_kernel_cache worker ROUNDS: one of them. */
#define _GNU_SOURCE /* nftw */
#include "opencl/kernel_cache.h"

#include "base/hash.h"
#include "support/device.h"
#include "support/output_temp.h"
#include "support/unit_test.h"

#include <dirent.h>
#include <fcntl.h>
#include <ftw.h>
#include <signal.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

/* Where the sizes of the parts begin in a file's head, behind the mark and the checksum. */
#define SIZES_AT 24u

static const char *own_path; /* of this test's program */
static const char *options;  /* that every build on this device has */

typedef struct Lab {
    BpDevice *device;
    char folder[64], path[512]; /* the home of caches, the file of source 7 */
    char source[256];
    uint8_t *bytes; /* of that file */
    size_t size;
} Lab;

/* A kernel that writes `number`. */
static void write_source(unsigned number, char source[256]) {
    snprintf(source, 256,
             "#line 1 \"number.cl\"\n__kernel void number(__global uint *out) { out[0] = %uu; }\n", number);
}

static int remove_one(const char *path, const struct stat *state, int kind, struct FTW *place) {
    (void)state, (void)kind, (void)place;
    return remove(path);
}
static void remove_tree(const char *folder) {
    assert_int_equal(nftw(folder, remove_one, 8, FTW_DEPTH | FTW_PHYS), 0);
}

static unsigned run(const BpDevice *device, cl_program program) {
    cl_int code;
    cl_uint number = 0;
    const size_t one = 1;
    cl_kernel kernel = clCreateKernel(program, "number", &code);
    assert_int_equal(code, CL_SUCCESS);
    cl_mem out = clCreateBuffer(device->context, CL_MEM_WRITE_ONLY, sizeof number, NULL, &code);
    assert_int_equal(code, CL_SUCCESS);
    assert_int_equal(clSetKernelArg(kernel, 0, sizeof out, &out), CL_SUCCESS);
    assert_int_equal(clEnqueueNDRangeKernel(device->queue, kernel, 1, NULL, &one, &one, 0, NULL, NULL),
                     CL_SUCCESS);
    assert_int_equal(
        clEnqueueReadBuffer(device->queue, out, CL_TRUE, 0, sizeof number, &number, 0, NULL, NULL),
        CL_SUCCESS);
    clReleaseMemObject(out);
    clReleaseKernel(kernel);
    return number;
}

/* Builds the kernel that writes `number`, as every program is built, and runs it. */
static void expect_number(BpDevice *device, unsigned number) {
    char source[256];
    cl_program program = NULL;
    BpError err = {0};
    write_source(number, source);
    if (bp_device_build(device, source, NULL, &program, NULL, &err) != BP_OK) fail_msg("%s", err.message);
    assert_int_equal(run(device, program), number);
    clReleaseProgram(program);
}

static bool loads(const BpDevice *device, const char *source, const char *with) {
    char *log = NULL;
    cl_program program = bp_kernel_cache_load(device, source, with, &log);
    assert_int_equal(program != NULL, log != NULL);
    if (program != NULL) clReleaseProgram(program);
    free(log);
    return program != NULL;
}

/* Programs in the folder, unfinished ones included. */
static unsigned count_programs(const char *folder) {
    char path[256];
    unsigned count = 0;
    snprintf(path, sizeof path, "%s/ballpark/kernels", folder);
    DIR *open = opendir(path);
    for (const struct dirent *entry; open != NULL && (entry = readdir(open)) != NULL;)
        count += strncmp(entry->d_name, "program-", 8) == 0;
    if (open != NULL) closedir(open);
    return count;
}

static void write_file(const char *path, const void *bytes, size_t size) {
    const int file = open(path, O_WRONLY | O_CREAT | O_TRUNC, 0600);
    assert_true(file >= 0);
    assert_int_equal(write(file, bytes, size), (ssize_t)size);
    close(file);
}

/* A cache with one program, the kernel that writes 7. */
static int lab_make(void **state) {
    Lab *lab = *state;
    temp_make(lab->folder);
    assert_int_equal(setenv("XDG_CACHE_HOME", lab->folder, 1), 0);
    assert_int_equal(setenv("BALLPARK_KERNEL_CACHE", "on", 1), 0);
    write_source(7, lab->source);
    expect_number(lab->device, 7);
    char *path = bp_kernel_cache_path(lab->device, lab->source, options);
    assert_non_null(path);
    snprintf(lab->path, sizeof lab->path, "%s", path);
    free(path);
    lab->bytes = temp_read(lab->path, &lab->size);
    return 0;
}

static int lab_clear(void **state) {
    Lab *lab = *state;
    free(lab->bytes);
    remove_tree(lab->folder);
    return 0;
}

static void is_found_again(void **state) {
    Lab *lab = *state;
    char *log = NULL;
    cl_program program = bp_kernel_cache_load(lab->device, lab->source, options, &log);
    assert_non_null(program);
    assert_non_null(log);
    assert_int_equal(run(lab->device, program), 7);
    clReleaseProgram(program);
    free(log);
    expect_number(lab->device, 7);
    assert_int_equal(count_programs(lab->folder), 1);
    expect_number(lab->device, 8);
    assert_int_equal(count_programs(lab->folder), 2);
}

static void another_is_not_found(void **state) {
    Lab *lab = *state;
    char other[256];
    write_source(9, other);
    assert_false(loads(lab->device, other, options));
    assert_false(loads(lab->device, lab->source, "-w"));
    BpDevice device = *lab->device;
#define WITH(change)                                                                                         \
    do {                                                                                                     \
        device = *lab->device;                                                                               \
        change;                                                                                              \
        assert_false(loads(&device, lab->source, options));                                                  \
    } while (0)
    WITH(strcat(device.info.driver, "1"));
    WITH(strcat(device.info.name, "1"));
    WITH(strcat(device.info.platform, "1"));
    WITH(strcat(device.info.version, "1"));
    WITH(device.info.float_lanes += 1);
    WITH(device.info.type = BP_DEVICE_GPU); /* of which this processor says nothing */
#undef WITH
    setenv("CL_CONFIG_CPU_TARGET_ARCH", "corei7-avx", 1);
    assert_false(loads(lab->device, lab->source, options));
    unsetenv("CL_CONFIG_CPU_TARGET_ARCH");
    assert_true(loads(lab->device, lab->source, options));

    /* A file under the name of another program, as after a collision of hashes. */
    char *path = bp_kernel_cache_path(lab->device, other, options);
    write_file(path, lab->bytes, lab->size);
    assert_false(loads(lab->device, other, options));
    write_file(path, lab->bytes, lab->size);
    expect_number(lab->device, 9);
    free(path);
}

/* What lies in the place of the file is not used, and the program is right all the same. */
static void expect_refused(Lab *lab, const uint8_t *bytes, size_t size, const char *what, size_t at) {
    write_file(lab->path, bytes, size);
    if (loads(lab->device, lab->source, options)) fail_msg("%s %zu: the file is used", what, at);
    assert_int_not_equal(access(lab->path, F_OK), 0);
}

static void a_damaged_one_is_not_used(void **state) {
    Lab *lab = *state;
    uint8_t *bad = malloc(lab->size + 1);
    assert_non_null(bad);
    for (size_t i = 0; i < 64; ++i) {
        const size_t size = i < 32 ? 3 * i : lab->size - 1 - (63 - i) * (lab->size / 40);
        expect_refused(lab, lab->bytes, size, "cut off at", size);
    }
    memcpy(bad, lab->bytes, lab->size);
    bad[lab->size] = 0;
    expect_refused(lab, bad, lab->size + 1, "longer than", lab->size);
    for (size_t i = 0; i < 256; ++i) {
        const size_t at = i < 80 ? i : (i - 80) * (lab->size - 1) / 175;
        bad[at] ^= (uint8_t)(1u << (i % 8));
        expect_refused(lab, bad, lab->size, "another bit in byte", at);
        bad[at] = lab->bytes[at];
    }
    memset(bad, 0, lab->size);
    expect_refused(lab, bad, lab->size, "zeros", lab->size);
    expect_number(lab->device, 7); /* which writes it anew */
    assert_true(loads(lab->device, lab->source, options));
    free(bad);
}

/* With a checksum that fits, as a program with a fault might have written it. */
static void a_strange_one_is_not_used(void **state) {
    Lab *lab = *state;
    uint8_t *bad = malloc(lab->size);
    uint64_t sizes[5], size;
    assert_non_null(bad);
    memcpy(sizes, lab->bytes + SIZES_AT, sizeof sizes);
    const size_t kernels_at = SIZES_AT + sizeof sizes + (size_t)(sizes[0] + sizes[1]);
    const size_t binary_at = kernels_at + (size_t)(sizes[2] + sizes[3]);
    assert_int_equal(binary_at + sizes[4], lab->size);
    assert_memory_equal(lab->bytes + kernels_at, "number", 6);
    for (int fault = 0; fault < 8; ++fault) {
        memcpy(bad, lab->bytes, lab->size);
        if (fault < 5) {
            size = fault % 2 == 0 ? UINT64_MAX - 3 : sizes[fault] - 1;
            memcpy(bad + SIZES_AT + 8 * fault, &size, sizeof size);
        } else if (fault == 5) {
            memcpy(bad + kernels_at, "lumber", 6);
        } else {
            memset(bad + binary_at, fault == 6 ? 0 : 0xa5, (size_t)sizes[4]);
        }
        const uint64_t checksum = bp_hash_bytes(BP_HASH_START, bad + SIZES_AT, lab->size - SIZES_AT);
        memcpy(bad + 16, &checksum, sizeof checksum);
        expect_refused(lab, bad, lab->size, "strange in way", (size_t)fault);
    }
    free(bad);
}

static void what_others_could_have_written_is_not_used(void **state) {
    Lab *lab = *state;
    char moved[600];
    assert_int_equal(chmod(lab->path, 0620), 0);
    assert_false(loads(lab->device, lab->source, options));
    assert_int_equal(chmod(lab->path, 0602), 0);
    assert_false(loads(lab->device, lab->source, options));
    assert_int_equal(chmod(lab->path, 0444), 0);
    assert_true(loads(lab->device, lab->source, options));
    snprintf(moved, sizeof moved, "%s.moved", lab->path);
    assert_int_equal(rename(lab->path, moved), 0);
    assert_int_equal(symlink(moved, lab->path), 0);
    assert_false(loads(lab->device, lab->source, options));
    assert_int_equal(unlink(lab->path), 0);
    assert_int_equal(mkfifo(lab->path, 0600), 0); /* on which reading would wait */
    assert_false(loads(lab->device, lab->source, options));
    assert_int_equal(unlink(lab->path), 0);
    assert_int_equal(mkdir(lab->path, 0700), 0);
    expect_number(lab->device, 7);
    assert_int_equal(rmdir(lab->path), 0);
    if (geteuid() == 0) {
        write_file(lab->path, lab->bytes, lab->size);
        assert_int_equal(chown(lab->path, 1, 1), 0);
        assert_false(loads(lab->device, lab->source, options));
    }
}

static void nothing_can_be_written(void **state) {
    Lab *lab = *state;
    char path[256];
    /* A file in the place of the folder; a folder in which not even root can make one. */
    snprintf(path, sizeof path, "%s/file", lab->folder);
    write_file(path, "x", 1);
    const char *const homes[] = {path, "/proc/self", "/dev/null", "relative"};
    for (size_t h = 0; h < 4; ++h) {
        setenv("XDG_CACHE_HOME", homes[h], 1);
        setenv("HOME", "/proc/self", 1);
        expect_number(lab->device, 7);
        assert_false(loads(lab->device, lab->source, options));
    }
    /* What is kept is still of use in a folder that cannot be written (as root, it can). */
    setenv("XDG_CACHE_HOME", lab->folder, 1);
    snprintf(path, sizeof path, "%s/ballpark/kernels", lab->folder);
    assert_int_equal(chmod(path, 0500), 0);
    assert_true(loads(lab->device, lab->source, options));
    expect_number(lab->device, 8);
    assert_int_equal(chmod(path, 0700), 0);
}

/* A disk that is full in the middle of a file; cmocka cannot be left while the limit holds. */
static void the_disk_is_full(void **state) {
    Lab *lab = *state;
    char source[256];
    cl_int code;
    struct rlimit before;
    write_source(8, source);
    const char *text = source;
    cl_program program = clCreateProgramWithSource(lab->device->context, 1, &text, NULL, &code);
    assert_int_equal(code, CL_SUCCESS);
    assert_int_equal(clBuildProgram(program, 1, &lab->device->id, options, NULL, NULL), CL_SUCCESS);
    /* So that only our own file meets the limit. */
    bp_kernel_cache_store(lab->device, source, options, program, "", BP_KERNEL_CACHE_BYTES_MAX);
    char *path = bp_kernel_cache_path(lab->device, source, options);
    assert_int_equal(unlink(path), 0);
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
    void (*handler)(int) = signal(SIGXFSZ, SIG_IGN);
    for (rlim_t room = 0; room < lab->size; room += lab->size / 5) {
        const struct rlimit limit = {room, before.rlim_max};
        setrlimit(RLIMIT_FSIZE, &limit);
        bp_kernel_cache_store(lab->device, source, options, program, "", BP_KERNEL_CACHE_BYTES_MAX);
        setrlimit(RLIMIT_FSIZE, &before);
        assert_int_equal(count_programs(lab->folder), 1);
        assert_false(loads(lab->device, source, options));
    }
    signal(SIGXFSZ, handler);
    bp_kernel_cache_store(lab->device, source, options, program, "", BP_KERNEL_CACHE_BYTES_MAX);
    assert_true(loads(lab->device, source, options));
    clReleaseProgram(program);
    free(path);
}

static uint64_t size_of(const char *path) {
    struct stat state;
    assert_int_equal(stat(path, &state), 0);
    return (uint64_t)state.st_size;
}

/* Long ago, a second later with each number. */
static void set_age(const char *path, time_t number) {
    const struct timespec times[2] = {{1000000000 + number, 0}, {1000000000 + number, 0}};
    assert_int_equal(utimensat(AT_FDCWD, path, times, 0), 0);
}

static void the_oldest_goes(void **state) {
    Lab *lab = *state;
    char sources[4][256], *paths[4], half[600];
    uint64_t sizes[4];
    for (unsigned i = 0; i < 4; ++i) {
        write_source(i + 7, sources[i]);
        expect_number(lab->device, i + 7);
        paths[i] = bp_kernel_cache_path(lab->device, sources[i], options);
        sizes[i] = size_of(paths[i]);
        set_age(paths[i], (time_t)i);
    }
    assert_int_equal(count_programs(lab->folder), 4);
    assert_true(loads(lab->device, sources[0], options)); /* so it is the youngest now, and 1 the oldest */
    snprintf(half, sizeof half, "%s.abc123", paths[1]);   /* what a killed process leaves */
    write_file(half, lab->bytes, 1000);
    set_age(half, -1);

    const char *text = sources[3];
    cl_program program = clCreateProgramWithSource(lab->device->context, 1, &text, NULL, NULL);
    assert_int_equal(clBuildProgram(program, 1, &lab->device->id, options, NULL, NULL), CL_SUCCESS);
    bp_kernel_cache_store(lab->device, text, options, program, "", BP_KERNEL_CACHE_BYTES_MAX);
    sizes[3] = size_of(paths[3]);
    assert_int_equal(count_programs(lab->folder), 5);
    bp_kernel_cache_store(lab->device, text, options, program, "", sizes[0] + sizes[1] + sizes[2] + sizes[3]);
    assert_int_equal(count_programs(lab->folder), 4); /* without the half one */
    assert_int_not_equal(access(half, F_OK), 0);
    bp_kernel_cache_store(lab->device, text, options, program, "",
                          sizes[0] + sizes[1] + sizes[2] + sizes[3] - 1);
    assert_int_not_equal(access(paths[1], F_OK), 0);
    assert_int_equal(count_programs(lab->folder), 3);
    bp_kernel_cache_store(lab->device, text, options, program, "", sizes[0] + sizes[3]);
    assert_false(loads(lab->device, sources[2], options));
    assert_true(loads(lab->device, sources[0], options));
    assert_true(loads(lab->device, sources[3], options));
    bp_kernel_cache_store(lab->device, text, options, program, "", 100); /* it would not fit alone */
    assert_int_equal(count_programs(lab->folder), 2);
    clReleaseProgram(program);
    for (int i = 0; i < 4; ++i) free(paths[i]);
}

static void what_took_long_is_kept(void **state) {
    Lab *lab = *state;
    BpDevice device = *lab->device;
    snprintf(device.info.platform, sizeof device.info.platform, "A driver");
    assert_true(bp_kernel_cache_wants(&device, BP_KERNEL_CACHE_AUTO, 0.11));
    assert_false(bp_kernel_cache_wants(&device, BP_KERNEL_CACHE_AUTO, 0.09));
    assert_true(bp_kernel_cache_wants(&device, BP_KERNEL_CACHE_ON, 0.0));
    assert_false(bp_kernel_cache_wants(&device, BP_KERNEL_CACHE_OFF, 9.0));
    snprintf(device.info.platform, sizeof device.info.platform, "Portable Computing Language");
    assert_false(bp_kernel_cache_wants(&device, BP_KERNEL_CACHE_AUTO, 9.0));
    assert_true(bp_kernel_cache_wants(&device, BP_KERNEL_CACHE_ON, 0.0));
}

static void the_environment_decides(void **state) {
    Lab *lab = *state;
    BpKernelCacheMode mode;
    BpError err = {0};
    cl_program program = NULL;
    setenv("BALLPARK_KERNEL_CACHE", "off", 1);
    expect_number(lab->device, 8);
    assert_int_equal(count_programs(lab->folder), 1);
    setenv("BALLPARK_KERNEL_CACHE", "", 1);
    assert_int_equal(bp_kernel_cache_mode(&mode, NULL), BP_OK);
    assert_int_equal(mode, BP_KERNEL_CACHE_AUTO);
    expect_number(lab->device, 8); /* which takes no time to speak of */
    assert_int_equal(count_programs(lab->folder), 1);
    setenv("BALLPARK_KERNEL_CACHE", "maybe", 1);
    assert_int_equal(bp_device_build(lab->device, lab->source, NULL, &program, NULL, &err), BP_ERR_USAGE);
    assert_string_equal(err.message,
                        "BALLPARK_KERNEL_CACHE is \"maybe\"; expected on or off, or leave it unset");
    assert_null(program);
    bp_error_clear(&err);
}

/* ---- several processes -------------------------------------------------------------------------------- */

enum { PROCESSES = 8, PROGRAMS = 2 };
static int rounds_wanted;

/* Each has a cache of PoCL's own, so that it is our cache that they share. */
static int work(int rounds) {
    BpDevice *device = NULL;
    char folder[64];
    temp_make(folder);
    setenv("POCL_CACHE_DIR", folder, 1);
    if (test_device_open(&device) != 0) return 1;
    for (int round = 0; round < rounds; ++round) expect_number(device, 7 + (unsigned)(round % PROGRAMS));
    bp_device_close(&device);
    remove_tree(folder);
    return 0;
}

/* They begin with an empty cache, while files in it are cut off, filled with something else, and removed. */
static void processes_share_it(void **state) {
    Lab *lab = *state;
    pid_t workers[PROCESSES];
    char source[256], rounds[16], *paths[PROGRAMS];
    int running = PROCESSES;
    assert_int_equal(unlink(lab->path), 0);
    for (unsigned i = 0; i < PROGRAMS; ++i) {
        write_source(7 + i, source);
        paths[i] = bp_kernel_cache_path(lab->device, source, options);
    }
    snprintf(rounds, sizeof rounds, "%d", rounds_wanted);
    for (int i = 0; i < PROCESSES; ++i) {
        workers[i] = fork();
        assert_true(workers[i] >= 0);
        if (workers[i] == 0) {
            execl(own_path, own_path, "worker", rounds, (char *)NULL);
            _exit(127);
        }
    }
    for (unsigned turn = 0; running > 0; ++turn) {
        const char *path = paths[turn % PROGRAMS];
        const int file = turn % 3 == 0 ? unlink(path) : open(path, O_WRONLY);
        if (turn % 3 == 1 && file >= 0)
            assert_int_equal(ftruncate(file, (off_t)(turn * 1000 % lab->size)), 0);
        if (turn % 3 == 2 && file >= 0)
            assert_true(pwrite(file, "another byte", 12, (off_t)lab->size / 2) > 0);
        if (turn % 3 != 0 && file >= 0) close(file);
        usleep(10000);
        for (int i = 0; i < PROCESSES; ++i) {
            int end = 0;
            if (workers[i] == 0 || waitpid(workers[i], &end, WNOHANG) != workers[i]) continue;
            if (!WIFEXITED(end) || WEXITSTATUS(end) != 0) fail_msg("process %d ended with %d", i, end);
            workers[i] = 0;
            --running;
        }
    }
    for (unsigned i = 0; i < PROGRAMS; ++i) {
        unlink(paths[i]);
        free(paths[i]);
    }
    assert_int_equal(count_programs(lab->folder), 0); /* nor anything unfinished */
    expect_number(lab->device, 7);
    assert_true(loads(lab->device, lab->source, options));
}

int main(int argc, char **argv) {
    static Lab lab;
    if (argc > 2) return work(atoi(argv[2]));
    if (argc > 1) rounds_wanted = atoi(argv[1]);
    own_path = argv[0];
    const int missing = test_device_open(&lab.device);
    if (missing != 0) return missing;
    options = bp_device_rounds_quotients(lab.device->id)
                  ? "-cl-std=CL1.2 -cl-fp32-correctly-rounded-divide-sqrt"
                  : "-cl-std=CL1.2";
#define TEST(name) cmocka_unit_test_prestate_setup_teardown(name, lab_make, lab_clear, &lab)
    const struct CMUnitTest tests[] =
        {
            TEST(is_found_again),
            TEST(another_is_not_found),
            TEST(a_damaged_one_is_not_used),
            TEST(a_strange_one_is_not_used),
            TEST(what_others_could_have_written_is_not_used),
            TEST(nothing_can_be_written),
            TEST(the_disk_is_full),
            TEST(the_oldest_goes),
            TEST(what_took_long_is_kept),
            TEST(the_environment_decides),
        },
                            shared[] = {TEST(processes_share_it)};
    const int failed = rounds_wanted > 0 ? cmocka_run_group_tests(shared, NULL, NULL)
                                         : cmocka_run_group_tests(tests, NULL, NULL);
    bp_device_close(&lab.device);
    return failed;
}
