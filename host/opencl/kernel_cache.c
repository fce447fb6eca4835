/* kernel_cache.c: see kernel_cache.h. */
#include "kernel_cache.h"

#include "base/hash.h"
#include "cache_file.h"
#include "cache_folder.h"
#include "pocl.h"

#include <dirent.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define FOLDER "/kernels"
#define PROGRAM_PREFIX "program-"
#define SLOW_SECONDS 0.1 /* builds that take less are not worth a file */

extern char **environ;

/* A file's bytes: this head, then the parts one after the other. */
enum { PART_IDENTITY, PART_SOURCE, PART_KERNELS, PART_LOG, PART_BINARY, PARTS };
typedef struct Head {
    char magic[16];
    uint64_t checksum; /* of everything behind it */
    uint64_t sizes[PARTS];
} Head;
static const char magic[] = "Ballpark kernel1";

BpStatus bp_kernel_cache_mode(BpKernelCacheMode *mode, BpError *err) {
    const char *wanted = getenv("BALLPARK_KERNEL_CACHE");
    *mode = BP_KERNEL_CACHE_AUTO;
    if (wanted == NULL || wanted[0] == '\0') return BP_OK;
    if (strcmp(wanted, "on") == 0)
        *mode = BP_KERNEL_CACHE_ON;
    else if (strcmp(wanted, "off") == 0)
        *mode = BP_KERNEL_CACHE_OFF;
    else
        return bp_fail(err, BP_ERR_USAGE,
                       "BALLPARK_KERNEL_CACHE is \"%.40s\"; expected on or off, or leave it unset", wanted);
    return BP_OK;
}

/* ---- what a program depends on ------------------------------------------------------------------------ */

/* A hash of the lines that describe the first processor, since machines whose devices have the same name may
 * share a home folder. */
static uint64_t hash_processor(void) {
    static const char *const telling[] = {"model name",      "flags",    "Features",
                                          "CPU implementer", "CPU part", "CPU variant"};
    uint64_t hash = BP_HASH_START;
    char line[8192];
    FILE *file = fopen("/proc/cpuinfo", "r");
    if (file == NULL) return hash;
    while (fgets(line, sizeof line, file) != NULL && line[0] != '\n')
        for (size_t i = 0; i < sizeof telling / sizeof telling[0]; ++i)
            if (strncmp(line, telling[i], strlen(telling[i])) == 0) hash = bp_hash_text(hash, line);
    fclose(file);
    return hash;
}

/* Of the variables that select the target of Intel's CPU runtime. The sum does not depend on their order. */
static uint64_t hash_settings(void) {
    uint64_t hash = 0;
    for (char **variable = environ; variable != NULL && *variable != NULL; ++variable)
        if (strncmp(*variable, "CL_CONFIG_", strlen("CL_CONFIG_")) == 0)
            hash += bp_hash_text(BP_HASH_START, *variable);
    return hash;
}

/* Heap; NULL: out of memory. */
static char *identify(const BpDevice *device, const char *options) {
    const BpDeviceInfo *info = &device->info;
    const size_t size = 2048 + strlen(options);
    char *text = malloc(size);
    if (text == NULL) return NULL;
    snprintf(text, size,
             "platform: %s\ndevice: %s\nversion: %s\ndriver: %s\nlanes: %u\nprocessor: %016llx\n"
             "settings: %016llx\noptions: %s\n",
             info->platform, info->name, info->version, info->driver, info->float_lanes,
             info->type == BP_DEVICE_CPU ? (unsigned long long)hash_processor() : 0,
             (unsigned long long)hash_settings(), options);
    return text;
}

/* The program's file, heap; NULL: the environment names no folder for caches. */
static char *name_program(const char *identity, const char *source, bool make) {
    const uint64_t hash = bp_hash_text(bp_hash_text(BP_HASH_START, identity), source);
    char *folder = bp_cache_folder(FOLDER, make);
    if (folder == NULL) return NULL;
    const size_t size = strlen(folder) + 64;
    char *path = malloc(size);
    if (path != NULL)
        snprintf(path, size, "%s/" PROGRAM_PREFIX "%016llx.bin", folder, (unsigned long long)hash);
    free(folder);
    return path;
}

char *bp_kernel_cache_path(const BpDevice *device, const char *source, const char *options) {
    char *identity = identify(device, options);
    char *path = identity != NULL ? name_program(identity, source, false) : NULL;
    free(identity);
    return path;
}

/* ---- files -------------------------------------------------------------------------------------------- */

static bool is_older(struct timespec x, struct timespec y) {
    return x.tv_sec != y.tv_sec ? x.tv_sec < y.tv_sec : x.tv_nsec < y.tv_nsec;
}

/* Removes the least recently used programs until the rest has at most `bytes_max`. A file that a killed
 * process left half-written counts as one. If another process does the same at this time, more are removed.
 */
static void make_room(uint64_t bytes_max) {
    char *folder = bp_cache_folder(FOLDER, false);
    DIR *open = folder != NULL ? opendir(folder) : NULL;
    for (uint64_t total = UINT64_MAX; open != NULL && total > bytes_max;) {
        char oldest[256] = "";
        struct timespec then = {0};
        total = 0;
        rewinddir(open);
        for (const struct dirent *entry; (entry = readdir(open)) != NULL;) {
            struct stat state;
            if (strncmp(entry->d_name, PROGRAM_PREFIX, strlen(PROGRAM_PREFIX)) != 0 ||
                fstatat(dirfd(open), entry->d_name, &state, AT_SYMLINK_NOFOLLOW) != 0 ||
                !S_ISREG(state.st_mode))
                continue;
            total += (uint64_t)state.st_size;
            if (oldest[0] != '\0' && !is_older(state.st_mtim, then)) continue;
            snprintf(oldest, sizeof oldest, "%s", entry->d_name);
            then = state.st_mtim;
        }
        if (total > bytes_max && unlinkat(dirfd(open), oldest, 0) != 0) break;
    }
    if (open != NULL) closedir(open);
    free(folder);
}

/* ---- programs ----------------------------------------------------------------------------------------- */

/* The names of the program's kernels, heap; "" if the driver does not list them; NULL: out of memory. */
static char *kernel_names(cl_program program) {
    size_t size = 0;
    if (clGetProgramInfo(program, CL_PROGRAM_KERNEL_NAMES, 0, NULL, &size) != CL_SUCCESS) size = 0;
    char *names = calloc(1, size + 1);
    if (names != NULL && size > 0 &&
        clGetProgramInfo(program, CL_PROGRAM_KERNEL_NAMES, size, names, NULL) != CL_SUCCESS)
        names[0] = '\0';
    return names;
}

/* The parts of a file that is complete and has this identity and source. */
static bool take_apart(const char *bytes, size_t size, const char *identity, const char *source,
                       BpCachePart parts[PARTS]) {
    Head head;
    if (size < sizeof head) return false;
    memcpy(&head, bytes, sizeof head);
    const size_t behind = offsetof(Head, sizes);
    if (memcmp(head.magic, magic, sizeof head.magic) != 0 ||
        head.checksum != bp_hash_bytes(BP_HASH_START, bytes + behind, size - behind))
        return false;
    size_t at = sizeof head;
    for (int p = 0; p < PARTS; ++p) {
        if (head.sizes[p] > size - at) return false;
        parts[p].bytes = bytes + at;
        parts[p].size = (size_t)head.sizes[p];
        at += parts[p].size;
    }
    return at == size && parts[PART_IDENTITY].size == strlen(identity) &&
           memcmp(parts[PART_IDENTITY].bytes, identity, strlen(identity)) == 0 &&
           parts[PART_SOURCE].size == strlen(source) &&
           memcmp(parts[PART_SOURCE].bytes, source, strlen(source)) == 0;
}

static char *copy_part(BpCachePart part) {
    char *text = malloc(part.size + 1);
    if (text == NULL) return NULL;
    memcpy(text, part.bytes, part.size);
    text[part.size] = '\0';
    return text;
}

/* NULL: the driver does not accept it, or builds another program from it. */
static cl_program revive(const BpDevice *device, const char *options, const BpCachePart parts[PARTS]) {
    cl_int code = CL_SUCCESS, taken = CL_SUCCESS;
    const unsigned char *binary = parts[PART_BINARY].bytes;
    cl_program program = clCreateProgramWithBinary(device->context, 1, &device->id, &parts[PART_BINARY].size,
                                                   &binary, &taken, &code);
    if (code != CL_SUCCESS || program == NULL) return NULL;
    char *names = NULL;
    bool good = taken == CL_SUCCESS &&
                clBuildProgram(program, 1, &device->id, options, NULL, NULL) == CL_SUCCESS &&
                (names = kernel_names(program)) != NULL && strlen(names) == parts[PART_KERNELS].size &&
                memcmp(names, parts[PART_KERNELS].bytes, parts[PART_KERNELS].size) == 0;
    free(names);
    if (good) return program;
    clReleaseProgram(program);
    return NULL;
}

cl_program bp_kernel_cache_load(const BpDevice *device, const char *source, const char *options, char **log) {
    BpCachePart parts[PARTS];
    size_t size = 0;
    cl_program program = NULL;
    char *identity = identify(device, options);
    char *path = identity != NULL ? name_program(identity, source, false) : NULL;
    char *bytes = path != NULL ? bp_cache_read(path, &size) : NULL;
    if (bytes != NULL) {
        if (take_apart(bytes, size, identity, source, parts)) program = revive(device, options, parts);
        if (program != NULL && log != NULL && (*log = copy_part(parts[PART_LOG])) == NULL) {
            clReleaseProgram(program);
            program = NULL;
        }
        if (program == NULL) unlink(path);
    }
    free(bytes);
    free(path);
    free(identity);
    return program;
}

/* The program's binary for its one device, heap; NULL if the driver offers none. */
static unsigned char *fetch_binary(cl_program program, size_t *size) {
    cl_uint devices = 0;
    *size = 0;
    if (clGetProgramInfo(program, CL_PROGRAM_NUM_DEVICES, sizeof devices, &devices, NULL) != CL_SUCCESS ||
        devices != 1 ||
        clGetProgramInfo(program, CL_PROGRAM_BINARY_SIZES, sizeof *size, size, NULL) != CL_SUCCESS ||
        *size == 0 || *size > BP_CACHE_FILE_BYTES_MAX)
        return NULL;
    unsigned char *binary = malloc(*size);
    if (binary != NULL &&
        clGetProgramInfo(program, CL_PROGRAM_BINARIES, sizeof binary, (void *)&binary, NULL) != CL_SUCCESS) {
        free(binary);
        binary = NULL;
    }
    return binary;
}

void bp_kernel_cache_store(const BpDevice *device, const char *source, const char *options,
                           cl_program program, const char *log, uint64_t bytes_max) {
    Head head = {{0}, BP_HASH_START, {0}};
    size_t binary_size = 0;
    uint64_t size = sizeof head;
    char *identity = identify(device, options), *names = kernel_names(program);
    char *path = identity != NULL ? name_program(identity, source, true) : NULL;
    unsigned char *binary = path != NULL && names != NULL ? fetch_binary(program, &binary_size) : NULL;
    if (binary != NULL) {
        if (log == NULL) log = "";
        const BpCachePart parts[PARTS + 1] = {{&head, sizeof head},     {identity, strlen(identity)},
                                              {source, strlen(source)}, {names, strlen(names)},
                                              {log, strlen(log)},       {binary, binary_size}};
        memcpy(head.magic, magic, sizeof head.magic);
        for (int p = 0; p < PARTS; ++p) {
            head.sizes[p] = parts[p + 1].size;
            size += parts[p + 1].size;
        }
        head.checksum = bp_hash_bytes(BP_HASH_START, head.sizes, sizeof head.sizes);
        for (int p = 0; p < PARTS; ++p)
            head.checksum = bp_hash_bytes(head.checksum, parts[p + 1].bytes, parts[p + 1].size);
        if (size <= BP_CACHE_FILE_BYTES_MAX && size <= bytes_max) {
            bp_cache_write(path, parts, PARTS + 1);
            make_room(bytes_max);
        }
    }
    free(binary);
    free(path);
    free(names);
    free(identity);
}

bool bp_kernel_cache_wants(const BpDevice *device, BpKernelCacheMode mode, double build_seconds) {
    if (mode != BP_KERNEL_CACHE_AUTO) return mode == BP_KERNEL_CACHE_ON;
    /* PoCL caches kernels itself, and compiles most of a program when it runs, after its binary would be
     * read. */
    return build_seconds >= SLOW_SECONDS && strcmp(device->info.platform, BP_POCL_PLATFORM) != 0;
}
