/* shim.c: loaded before the program (LD_PRELOAD), lets one call of a kind fail, or every one of a kind.
 *
 * In:    FAULT_KIND (alloc, open, unnamed, stream, write, sync, close, rename, link, resize), FAULT_AT (which
 *        call, from 1; 0: none, "all": every one), FAULT_LOG (a file).
 * Out:   the call fails as it does on a full disk or without memory; the log says how many there were.
 * Knows: the C library and where the program's code lies.   Does not know: what the program does.
 *
 * Only calls from the program's own code (libballpark is in it), jansson and libpng count: a driver that is
 * refused memory may crash, and that is not what is looked for. Writes cannot be seen from outside the C
 * library, so streams that the program opens on a descriptor, and standard output, get their write function
 * from here. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
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
extern void *__libc_realloc(void *old, size_t size);

typedef struct Range {
    uintptr_t begin, end;
} Range;

static Range ranges[32];
static size_t range_count;
static const char *kind = "";
static long fail_at;
static bool fail_all;
static atomic_long calls;

static int note_code(struct dl_phdr_info *info, size_t size, void *unused) {
    (void)size;
    (void)unused;
    static const char *const counted[] = {"libjansson", "libpng"};
    bool counts = info->dlpi_name[0] == '\0';
    for (size_t i = 0; i < sizeof counted / sizeof counted[0]; i++)
        if (strstr(info->dlpi_name, counted[i]) != NULL) counts = true;
    if (!counts || strstr(info->dlpi_name, "vdso") != NULL) return 0;
    for (size_t p = 0; p < info->dlpi_phnum; p++) {
        const ElfW(Phdr) *part = &info->dlpi_phdr[p];
        if (part->p_type != PT_LOAD || (part->p_flags & PF_X) == 0) continue;
        const uintptr_t begin = info->dlpi_addr + part->p_vaddr;
        if (range_count < sizeof ranges / sizeof ranges[0])
            ranges[range_count++] = (Range){begin, begin + part->p_memsz};
    }
    return 0;
}

static bool is_ours(const void *caller) {
    for (size_t i = 0; i < range_count; i++)
        if ((uintptr_t)caller >= ranges[i].begin && (uintptr_t)caller < ranges[i].end) return true;
    return false;
}

/* Whether this call of kind `which` is the one to fail. */
static bool fails(const char *which) {
    if (strcmp(kind, which) != 0) return false;
    return ++calls == fail_at || fail_all;
}

static void *real(const char *name) {
    return dlsym(RTLD_NEXT, name);
}

/* ---- memory
 * ------------------------------------------------------------------------------------------------ */

#define CALLER __builtin_return_address(0)
#define REFUSE_MEMORY()                                                                                      \
    do {                                                                                                     \
        if (is_ours(CALLER) && fails("alloc")) {                                                             \
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
    if ((flags & O_TMPFILE) == O_TMPFILE) REFUSE("unnamed", EOPNOTSUPP);
    if ((flags & O_ACCMODE) != O_RDONLY) REFUSE("open", ENOSPC);
    int (*const next)(const char *, int, ...) = (int (*)(const char *, int, ...))real("open");
    return next(path, flags, mode);
}

int fsync(int descriptor) {
    REFUSE("sync", EIO);
    int (*const next)(int) = (int (*)(int))real("fsync");
    return next(descriptor);
}

int ftruncate(int descriptor, off_t size) {
    REFUSE("resize", EIO);
    int (*const next)(int, off_t) = (int (*)(int, off_t))real("ftruncate");
    return next(descriptor, size);
}

static int real_close(int descriptor) {
    int (*const next)(int) = (int (*)(int))real("close");
    return next(descriptor);
}

int close(int descriptor) {
    const bool refused = is_ours(CALLER) && fails("close");
    const int result = real_close(descriptor);
    if (!refused) return result;
    errno = EIO;
    return -1;
}

int rename(const char *from, const char *to) {
    REFUSE("rename", EBUSY);
    int (*const next)(const char *, const char *) = (int (*)(const char *, const char *))real("rename");
    return next(from, to);
}

int linkat(int from_folder, const char *from, int to_folder, const char *to, int flags) {
    REFUSE("link", EPERM);
    int (*const next)(int, const char *, int, const char *, int) =
        (int (*)(int, const char *, int, const char *, int))real("linkat");
    return next(from_folder, from, to_folder, to, flags);
}

/* ---- streams
 * ----------------------------------------------------------------------------------------------- */

static ssize_t put(void *cookie, const char *bytes, size_t size) {
    if (fails("write")) {
        errno = ENOSPC;
        return 0; /* what a stream of this kind answers for a failure */
    }
    return write((int)(intptr_t)cookie, bytes, size);
}

static int end(void *cookie) {
    const bool refused = fails("close");
    const int result = real_close((int)(intptr_t)cookie);
    if (!refused) return result;
    errno = EIO;
    return -1;
}

static FILE *open_cookie(int descriptor) {
    const cookie_io_functions_t functions = {.write = put, .close = end};
    return fopencookie((void *)(intptr_t)descriptor, "w", functions);
}

FILE *fdopen(int descriptor, const char *mode) {
    FILE *(*const next)(int, const char *) = (FILE * (*)(int, const char *)) real("fdopen");
    if (!is_ours(CALLER) || mode[0] != 'w') return next(descriptor, mode);
    if (fails("stream")) {
        errno = ENOMEM;
        return NULL;
    }
    return open_cookie(descriptor);
}

/* ---- beginning and end
 * ------------------------------------------------------------------------------------- */

__attribute__((constructor)) static void begin(void) {
    const char *at = getenv("FAULT_AT"), *which = getenv("FAULT_KIND");
    dl_iterate_phdr(note_code, NULL);
    FILE *out = open_cookie(1);
    if (out != NULL) stdout = out;
    fail_all = at != NULL && strcmp(at, "all") == 0;
    fail_at = at != NULL && !fail_all ? atol(at) : 0;
    if (which != NULL) kind = which;
    /* What the program starts is none of ours. */
    unsetenv("LD_PRELOAD");
}

__attribute__((destructor)) static void tell(void) {
    const char *path = getenv("FAULT_LOG");
    char text[32];
    if (path == NULL) return;
    int (*const next)(const char *, int, ...) = (int (*)(const char *, int, ...))real("open");
    const int descriptor = next(path, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    const int length = snprintf(text, sizeof text, "%ld\n", (long)calls);
    if (descriptor >= 0) (void)!write(descriptor, text, (size_t)length);
}
