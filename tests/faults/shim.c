/* shim.c: loaded before the program (LD_PRELOAD), lets one call of a kind fail, or every one of a kind.
 *
 * In:    FAULT_KIND (a name of `kinds`), FAULT_AT (which call, from 1; 0: none, "all": every one), FAULT_LOG
 *        (a file).
 * Out:   the call fails as it does on a full disk or without memory; the log says how many there were of each
 *        kind.
 * Knows: the C library and where the program's code lies.   Does not know: what the program does.
 *
 * Only calls from the program's own code (libballpark is in it), jansson, libpng, zlib and OpenEXR count: a
 * driver that is refused memory may crash, and that is not what is looked for. Reads and writes cannot be
 * seen from outside the C library, so streams that the program opens, and standard output, get their
 * functions from here. A child process counts on from where its parent was, and the log has the largest
 * number of any.
 *
 * Not for a build that counts lines: gcov is then a part of the program, and crashes at its end
 * (gcov_do_dump) where it is refused memory. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <jansson.h>
#include <link.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

extern void *__libc_malloc(size_t size);
extern void *__libc_calloc(size_t count, size_t size);
extern void *__libc_memalign(size_t alignment, size_t size);
extern void *__libc_realloc(void *old, size_t size);

typedef struct Range {
    uintptr_t begin, end;
} Range;

typedef enum Kind {
    ALLOC,   /* memory for the program's own code */
    JSON,    /* for jansson */
    LIBRARY, /* for libpng, zlib and OpenEXR */
    OPEN,
    UNNAMED,
    STREAM,
    READ,
    WRITE,
    SYNC,
    CLOSE,
    RENAME,
    LINK,
    RESIZE,
    KINDS
} Kind;
static const char *const kinds[KINDS] = {"alloc", "json", "library", "open",   "unnamed", "stream", "read",
                                         "write", "sync", "close",   "rename", "link",    "resize"};

static Range ranges[32];
static size_t range_count, own_count; /* the first ranges are the program's */
static Kind kind = KINDS;
static long fail_at;
static bool fail_all;
static atomic_long calls[KINDS];
static _Thread_local bool in_json;

static int note_code(struct dl_phdr_info *info, size_t size, void *unused) {
    (void)size;
    (void)unused;
    static const char *const counted[] = {"libjansson", "libpng", "libz.", "libOpenEXRCore"};
    const bool own = info->dlpi_name[0] == '\0'; /* it is the first to be told */
    bool counts = own;
    for (size_t i = 0; i < sizeof counted / sizeof counted[0]; i++)
        if (strstr(info->dlpi_name, counted[i]) != NULL) counts = true;
    if (!counts || strstr(info->dlpi_name, "vdso") != NULL) return 0;
    for (size_t p = 0; p < info->dlpi_phnum; p++) {
        const ElfW(Phdr) *part = &info->dlpi_phdr[p];
        if (part->p_type != PT_LOAD || (part->p_flags & PF_X) == 0) continue;
        const uintptr_t begin = info->dlpi_addr + part->p_vaddr;
        if (range_count < sizeof ranges / sizeof ranges[0])
            ranges[range_count++] = (Range){begin, begin + part->p_memsz};
        if (own) own_count = range_count;
    }
    return 0;
}

static bool is_in(const void *caller, size_t first, size_t end) {
    for (size_t i = first; i < end; i++)
        if ((uintptr_t)caller >= ranges[i].begin && (uintptr_t)caller < ranges[i].end) return true;
    return false;
}

static bool is_ours(const void *caller) {
    return is_in(caller, 0, range_count);
}

/* Whether this call of kind `which` is the one to fail. */
static bool fails(Kind which) {
    const long number = ++calls[which];
    return kind == which && (number == fail_at || fail_all);
}

static void *real(const char *name) {
    return dlsym(RTLD_NEXT, name);
}

/* ---- memory
 * ------------------------------------------------------------------------------------------------ */

static Kind memory_of(const void *caller) {
    if (!is_in(caller, 0, own_count)) return LIBRARY;
    return in_json ? JSON : ALLOC;
}

/* The program gives jansson a function of its own: what that allocates is jansson's. */
static json_malloc_t allocate_for_json;

static void *allocate_in_json(size_t size) {
    in_json = true;
    void *bytes = allocate_for_json(size);
    in_json = false;
    return bytes;
}

void json_set_alloc_funcs(json_malloc_t allocate, json_free_t release) {
    void (*const next)(json_malloc_t, json_free_t) =
        (void (*)(json_malloc_t, json_free_t))real("json_set_alloc_funcs");
    allocate_for_json = allocate;
    next(allocate_in_json, release);
}

#define CALLER __builtin_return_address(0)
#define REFUSE_MEMORY()                                                                                      \
    do {                                                                                                     \
        if (is_ours(CALLER) && fails(memory_of(CALLER))) {                                                   \
            errno = ENOMEM;                                                                                  \
            return NULL;                                                                                     \
        }                                                                                                    \
    } while (0)

void *malloc(size_t size) {
    REFUSE_MEMORY();
    return __libc_malloc(size);
}

void *calloc(size_t count, size_t size) {
    REFUSE_MEMORY();
    return __libc_calloc(count, size);
}

void *aligned_alloc(size_t alignment, size_t size) {
    REFUSE_MEMORY();
    return __libc_memalign(alignment, size);
}

void *realloc(void *old, size_t size) {
    REFUSE_MEMORY();
    return __libc_realloc(old, size);
}

static char *copy(const char *text, size_t length) {
    char *made = __libc_malloc(length + 1);
    if (made == NULL) return NULL;
    memcpy(made, text, length);
    made[length] = '\0';
    return made;
}

char *strdup(const char *text) {
    REFUSE_MEMORY();
    return copy(text, strlen(text));
}

char *strndup(const char *text, size_t size) {
    REFUSE_MEMORY();
    return copy(text, strnlen(text, size));
}

FILE *open_memstream(char **bytes, size_t *size) {
    REFUSE_MEMORY();
    FILE *(*const next)(char **, size_t *) = (FILE * (*)(char **, size_t *)) real("open_memstream");
    return next(bytes, size);
}

/* ---- files
 * ------------------------------------------------------------------------------------------------- */

/* Answers -1 with `number` when the caller is the program and this call is to fail. */
#define REFUSE(which, number)                                                                                \
    do {                                                                                                     \
        if (is_ours(CALLER) && fails(which)) {                                                               \
            errno = number;                                                                                  \
            return -1;                                                                                       \
        }                                                                                                    \
    } while (0)

int open(const char *path, int flags, ...) {
    va_list arguments;
    va_start(arguments, flags);
    const mode_t mode = (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(arguments, mode_t) : 0;
    va_end(arguments);
    if ((flags & O_TMPFILE) == O_TMPFILE) REFUSE(UNNAMED, EOPNOTSUPP);
    if ((flags & O_ACCMODE) != O_RDONLY) REFUSE(OPEN, ENOSPC);
    int (*const next)(const char *, int, ...) = (int (*)(const char *, int, ...))real("open");
    return next(path, flags, mode);
}

int fsync(int descriptor) {
    REFUSE(SYNC, EIO);
    int (*const next)(int) = (int (*)(int))real("fsync");
    return next(descriptor);
}

int ftruncate(int descriptor, off_t size) {
    REFUSE(RESIZE, EIO);
    int (*const next)(int, off_t) = (int (*)(int, off_t))real("ftruncate");
    return next(descriptor, size);
}

static int real_close(int descriptor) {
    int (*const next)(int) = (int (*)(int))real("close");
    return next(descriptor);
}

int close(int descriptor) {
    const bool refused = is_ours(CALLER) && fails(CLOSE);
    const int result = real_close(descriptor);
    if (!refused) return result;
    errno = EIO;
    return -1;
}

int rename(const char *from, const char *to) {
    REFUSE(RENAME, EBUSY);
    int (*const next)(const char *, const char *) = (int (*)(const char *, const char *))real("rename");
    return next(from, to);
}

int linkat(int from_folder, const char *from, int to_folder, const char *to, int flags) {
    REFUSE(LINK, EPERM);
    int (*const next)(int, const char *, int, const char *, int) =
        (int (*)(int, const char *, int, const char *, int))real("linkat");
    return next(from_folder, from, to_folder, to, flags);
}

/* Where a file is given its name only if nobody has it. */
int link(const char *from, const char *to) {
    REFUSE(LINK, EPERM);
    int (*const next)(const char *, const char *) = (int (*)(const char *, const char *))real("link");
    return next(from, to);
}

/* ---- streams
 * ----------------------------------------------------------------------------------------------- */

static ssize_t put(void *cookie, const char *bytes, size_t size) {
    if (fails(WRITE)) {
        errno = ENOSPC;
        return 0; /* what a stream of this kind answers for a failure */
    }
    return write((int)(intptr_t)cookie, bytes, size);
}

static int end(void *cookie) {
    const bool refused = fails(CLOSE);
    const int result = real_close((int)(intptr_t)cookie);
    if (!refused) return result;
    errno = EIO;
    return -1;
}

static FILE *open_cookie(int descriptor) {
    const cookie_io_functions_t functions = {.write = put, .close = end};
    return fopencookie((void *)(intptr_t)descriptor, "w", functions);
}

static ssize_t get(void *cookie, char *bytes, size_t size) {
    ssize_t (*const next)(int, void *, size_t) = (ssize_t(*)(int, void *, size_t))real("read");
    if (!fails(READ)) return next((int)(intptr_t)cookie, bytes, size);
    errno = EIO;
    return -1;
}

static int go_to(void *cookie, off64_t *offset, int whence) {
    *offset = lseek64((int)(intptr_t)cookie, *offset, whence);
    return *offset < 0 ? -1 : 0;
}

/* The streams that are read here, for fileno(). */
static struct {
    FILE *stream;
    int descriptor;
} readers[16];

static int end_reading(void *cookie) {
    const int descriptor = (int)(intptr_t)cookie;
    for (size_t i = 0; i < sizeof readers / sizeof readers[0]; i++)
        if (readers[i].stream != NULL && readers[i].descriptor == descriptor) readers[i].stream = NULL;
    return real_close(descriptor);
}

static FILE *open_reader(int descriptor) {
    const cookie_io_functions_t functions = {.read = get, .seek = go_to, .close = end_reading};
    FILE *stream = fopencookie((void *)(intptr_t)descriptor, "r", functions);
    for (size_t i = 0; i < sizeof readers / sizeof readers[0]; i++) {
        if (readers[i].stream != NULL) continue;
        readers[i].stream = stream;
        readers[i].descriptor = descriptor;
        break;
    }
    return stream;
}

int fileno(FILE *stream) {
    for (size_t i = 0; i < sizeof readers / sizeof readers[0]; i++)
        if (readers[i].stream == stream) return readers[i].descriptor;
    int (*const next)(FILE *) = (int (*)(FILE *))real("fileno");
    return next(stream);
}

FILE *fopen(const char *path, const char *mode) {
    FILE *(*const next)(const char *, const char *) = (FILE * (*)(const char *, const char *)) real("fopen");
    if (!is_in(CALLER, 0, own_count) || mode[0] != 'r') return next(path, mode);
    int (*const open_file)(const char *, int, ...) = (int (*)(const char *, int, ...))real("open");
    const int descriptor = open_file(path, O_RDONLY | O_CLOEXEC);
    return descriptor < 0 ? NULL : open_reader(descriptor);
}

/* zlib reads without a stream. */
ssize_t read(int descriptor, void *bytes, size_t size) {
    if (!is_in(CALLER, 0, own_count)) REFUSE(READ, EIO);
    ssize_t (*const next)(int, void *, size_t) = (ssize_t(*)(int, void *, size_t))real("read");
    return next(descriptor, bytes, size);
}

FILE *fdopen(int descriptor, const char *mode) {
    FILE *(*const next)(int, const char *) = (FILE * (*)(int, const char *)) real("fdopen");
    if (is_ours(CALLER) && mode[0] == 'r') return open_reader(descriptor);
    if (!is_ours(CALLER) || mode[0] != 'w') return next(descriptor, mode);
    if (fails(STREAM)) {
        errno = ENOMEM;
        return NULL;
    }
    return open_cookie(descriptor);
}

/* The C library's own standard output can be flushed after it is closed, and C++ libraries of drivers do that
 * when the program ends. So the one from here is closed without being freed. */
static FILE *own_output;

int fclose(FILE *stream) {
    int (*const next)(FILE *) = (int (*)(FILE *))real("fclose");
    if (stream != own_output || own_output == NULL) return next(stream);
    const int flushed = fflush(stream), flush_problem = errno;
    const int ended = end((void *)(intptr_t)1);
    if (flushed == 0) return ended;
    errno = flush_problem;
    return -1;
}

/* ---- beginning and end
 * ------------------------------------------------------------------------------------- */

__attribute__((constructor)) static void begin(void) {
    const char *at = getenv("FAULT_AT"), *which = getenv("FAULT_KIND");
    dl_iterate_phdr(note_code, NULL);
    own_output = open_cookie(1);
    if (own_output != NULL) stdout = own_output;
    fail_all = at != NULL && strcmp(at, "all") == 0;
    fail_at = at != NULL && !fail_all ? atol(at) : 0;
    for (int k = 0; k < KINDS && which != NULL; k++)
        if (strcmp(which, kinds[k]) == 0) kind = (Kind)k;
    /* What the program starts is none of ours. */
    unsetenv("LD_PRELOAD");
}

/* What the log, open as `descriptor`, says so far. */
static void recall(int descriptor, long before[KINDS]) {
    char text[1024] = "", name[16];
    long number;
    ssize_t (*const next)(int, void *, size_t) = (ssize_t(*)(int, void *, size_t))real("read");
    const ssize_t length = next(descriptor, text, sizeof text - 1);
    int taken = 0;
    if (length <= 0) return;
    for (const char *at = text; sscanf(at, "%15s %ld%n", name, &number, &taken) == 2; at += taken)
        for (int k = 0; k < KINDS; k++)
            if (strcmp(name, kinds[k]) == 0) before[k] = number;
}

__attribute__((destructor)) static void tell(void) {
    const char *path = getenv("FAULT_LOG");
    if (path == NULL) return;
    long before[KINDS] = {0};
    int (*const next)(const char *, int, ...) = (int (*)(const char *, int, ...))real("open");
    const int descriptor = next(path, O_RDWR | O_CREAT | O_CLOEXEC, 0600);
    if (descriptor < 0) return;
    recall(descriptor, before);
    lseek(descriptor, 0, SEEK_SET);
    for (int k = 0; k < KINDS; k++) /* numbers only grow, so nothing of the old text is left */
        dprintf(descriptor, "%s %ld\n", kinds[k], before[k] > calls[k] ? before[k] : (long)calls[k]);
}

/* How a child process ends. */
_Noreturn void _exit(int code) {
    void (*const next)(int) = (void (*)(int))real("_exit");
    tell();
    next(code);
    __builtin_unreachable();
}
