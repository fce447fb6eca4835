/* fake_icd.c: an OpenCL driver without hardware, for the tests of devices that no test machine has.
 *
 * In:    FAKE_DEVICES in the environment, read at every call: platforms parted by '|', devices by ','. A
 * device is a kind of the table below, optionally with a name and a driver version: "gpu=Big
 * Card@8.1,cpu|old"; "unlistable-hanging" and "unlistable-crashing" do so when devices are listed.
 * FAKE_COMPILE: milliseconds of the processor that a build takes.
 * Out:   two platforms ("Fake One", "Fake Two") through the ICD loader (OCL_ICD_VENDORS names the .icd file).
 * A "build" succeeds unless the source holds #error; its log is then the build options, so that tests see
 * them. A program's binary is its source. */
#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>
#include <CL/cl_icd.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#define PLATFORMS 2
#define DEVICES 8
#define EXPORT __attribute__((visibility("default")))

typedef struct Kind {
    const char *name;
    cl_device_type type;
    const char *version, *profile, *extensions;
    cl_bool little_endian, compiler, available;
    cl_device_fp_config single, full; /* full: of double */
    cl_int context_error;             /* HANGS, CRASHES: what a context ends in */
} Kind;

enum { HANGS = 1, CRASHES = 2 };

#define FLOAT_FULL (CL_FP_INF_NAN | CL_FP_ROUND_TO_NEAREST)
static const Kind kinds[] = {
    {"gpu", CL_DEVICE_TYPE_GPU, "OpenCL 3.0 fake", "FULL_PROFILE", "", 1, 1, 1, FLOAT_FULL, CL_FP_FMA, 0},
    {"cpu", CL_DEVICE_TYPE_CPU, "OpenCL 1.2 fake", "FULL_PROFILE", "", 1, 1, 1, FLOAT_FULL, CL_FP_FMA, 0},
    {"accelerator", CL_DEVICE_TYPE_ACCELERATOR, "OpenCL 2.0", "FULL_PROFILE", "", 1, 1, 1, FLOAT_FULL, 0, 0},
    {"nvidia", CL_DEVICE_TYPE_GPU, "OpenCL 3.0 CUDA", "FULL_PROFILE",
     "cl_khr_fp64 cl_nv_compiler_options cl_nv_x", 1, 1, 1, FLOAT_FULL, CL_FP_FMA, 0},
    {"integrated", CL_DEVICE_TYPE_GPU, "OpenCL 3.0", "FULL_PROFILE", "", 1, 1, 1, FLOAT_FULL, 0, 0},
    {"small", CL_DEVICE_TYPE_GPU, "OpenCL 3.0", "FULL_PROFILE", "", 1, 1, 1, FLOAT_FULL, 0, 0},
    {"large", CL_DEVICE_TYPE_GPU, "OpenCL 3.0", "FULL_PROFILE", "", 1, 1, 1, FLOAT_FULL, 0, 0},
    {"roomy", CL_DEVICE_TYPE_GPU, "OpenCL 3.0", "FULL_PROFILE", "", 1, 1, 1, FLOAT_FULL, 0, 0},
    {"rounding", CL_DEVICE_TYPE_GPU, "OpenCL 1.2", "FULL_PROFILE", "cl_nv_compiler_options", 1, 1, 1,
     FLOAT_FULL | CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT, 0, 0},
    {"almost-nvidia", CL_DEVICE_TYPE_GPU, "OpenCL 3.0", "FULL_PROFILE",
     "x_cl_nv_compiler_options cl_nv_compiler_options2", 1, 1, 1, FLOAT_FULL, 0, 0},
    {"old", CL_DEVICE_TYPE_GPU, "OpenCL 1.1 fake", "FULL_PROFILE", "", 1, 1, 1, FLOAT_FULL, 0, 0},
    {"mute", CL_DEVICE_TYPE_GPU, "", "FULL_PROFILE", "", 1, 1, 1, FLOAT_FULL, 0, 0},
    {"big-endian", CL_DEVICE_TYPE_GPU, "OpenCL 1.2", "FULL_PROFILE", "", 0, 1, 1, FLOAT_FULL, 0, 0},
    {"no-compiler", CL_DEVICE_TYPE_GPU, "OpenCL 1.2", "FULL_PROFILE", "", 1, 0, 1, FLOAT_FULL, 0, 0},
    {"embedded", CL_DEVICE_TYPE_GPU, "OpenCL 1.2", "EMBEDDED_PROFILE", "", 1, 1, 1, FLOAT_FULL, 0, 0},
    {"embedded-long", CL_DEVICE_TYPE_GPU, "OpenCL 1.2", "EMBEDDED_PROFILE", "cles_khr_int64", 1, 1, 1,
     FLOAT_FULL, 0, 0},
    {"truncating", CL_DEVICE_TYPE_GPU, "OpenCL 1.2", "EMBEDDED_PROFILE", "cles_khr_int64", 1, 1, 1,
     CL_FP_INF_NAN, 0, 0},
    {"no-infinity", CL_DEVICE_TYPE_GPU, "OpenCL 1.2", "FULL_PROFILE", "", 1, 1, 1, CL_FP_ROUND_TO_NEAREST, 0,
     0},
    {"away", CL_DEVICE_TYPE_GPU, "OpenCL 1.2", "FULL_PROFILE", "", 1, 1, 0, FLOAT_FULL, 0, 0},
    {"full", CL_DEVICE_TYPE_GPU, "OpenCL 1.2", "FULL_PROFILE", "", 1, 1, 1, FLOAT_FULL, 0,
     CL_OUT_OF_RESOURCES},
    {"hanging", CL_DEVICE_TYPE_GPU, "OpenCL 1.2", "FULL_PROFILE", "", 1, 1, 1, FLOAT_FULL, 0, HANGS},
    {"crashing", CL_DEVICE_TYPE_GPU, "OpenCL 1.2", "FULL_PROFILE", "", 1, 1, 1, FLOAT_FULL, 0, CRASHES},
};

/* What some kinds have of each; the first is everybody else's. */
static const struct Capability {
    const char *name;
    cl_bool shared_memory;
    cl_uint units, mhz;
    cl_ulong gigabytes;
} capabilities[] = {
    {"", 0, 6, 1000, 1},       {"integrated", 1, 96, 2200, 64}, {"small", 0, 24, 2500, 8},
    {"large", 0, 76, 2200, 8}, {"roomy", 0, 60, 1800, 24},
};

/* The loader finds our functions through the first member of every handle. */
static struct _cl_icd_dispatch dispatch;
struct _cl_platform_id {
    struct _cl_icd_dispatch *dispatch;
    int number;
} platforms[PLATFORMS];
struct _cl_device_id {
    struct _cl_icd_dispatch *dispatch;
    int platform, number;
} devices[PLATFORMS][DEVICES];
struct _cl_context {
    struct _cl_icd_dispatch *dispatch;
} context;
struct _cl_command_queue {
    struct _cl_icd_dispatch *dispatch;
} queue;
struct _cl_program {
    struct _cl_icd_dispatch *dispatch;
    char source[512], log[512];
    int compiled; /* it was made from a binary */
} program;

/* The text of device `number` on `platform`, in to[64]; 0 when there is none. */
static int find_device(int platform, int number, char to[64]) {
    const char *at = getenv("FAKE_DEVICES");
    for (int p = 0; at != NULL && p < platform; ++p) {
        at = strchr(at, '|');
        if (at != NULL) ++at;
    }
    for (int d = 0; at != NULL; ++d) {
        const size_t length = strcspn(at, ",|");
        if (length == 0) return 0;
        if (d == number) {
            snprintf(to, 64, "%.*s", (int)length, at);
            return 1;
        }
        at = at[length] == ',' ? at + length + 1 : NULL;
    }
    return 0;
}

static cl_int answer(const void *from, size_t from_size, size_t size, void *to, size_t *size_ret) {
    if (size_ret != NULL) *size_ret = from_size;
    if (to == NULL) return CL_SUCCESS;
    if (size < from_size) return CL_INVALID_VALUE;
    memcpy(to, from, from_size);
    return CL_SUCCESS;
}
static cl_int answer_text(const char *text, size_t size, void *to, size_t *size_ret) {
    return answer(text, strlen(text) + 1, size, to, size_ret);
}
static cl_int answer_ulong(cl_ulong number, size_t size, void *to, size_t *size_ret) {
    return answer(&number, sizeof number, size, to, size_ret);
}
static cl_int answer_uint(cl_uint number, size_t size, void *to, size_t *size_ret) {
    return answer(&number, sizeof number, size, to, size_ret);
}

static cl_int CL_API_CALL get_platform_info(cl_platform_id platform, cl_platform_info what, size_t size,
                                            void *to, size_t *size_ret) {
    switch (what) {
    case CL_PLATFORM_NAME:
        return answer_text(platform->number == 0 ? "Fake One" : "Fake Two", size, to, size_ret);
    case CL_PLATFORM_EXTENSIONS:
        return answer_text("cl_khr_icd", size, to, size_ret);
    case CL_PLATFORM_ICD_SUFFIX_KHR:
        return answer_text("FAKE", size, to, size_ret);
    case CL_PLATFORM_VERSION:
        return answer_text("OpenCL 1.2 fake", size, to, size_ret);
    default:
        return answer_text("FULL_PROFILE", size, to, size_ret);
    }
}

static cl_int CL_API_CALL get_device_ids(cl_platform_id platform, cl_device_type type, cl_uint room,
                                         cl_device_id *ids, cl_uint *count) {
    char text[64];
    cl_uint found = 0;
    (void)type; /* the host asks for all */
    while (found < DEVICES && find_device(platform->number, (int)found, text)) {
        while (strcmp(text, "unlistable-hanging") == 0) sleep(1);
        if (strcmp(text, "unlistable-crashing") == 0) abort();
        if (ids != NULL && found < room) ids[found] = &devices[platform->number][found];
        ++found;
    }
    if (count != NULL) *count = found;
    return found > 0 ? CL_SUCCESS : CL_DEVICE_NOT_FOUND;
}

/* The kind of a device, its name and its driver's version; NULL: there is no such device. */
static const Kind *kind_of(cl_device_id device, char name[64], char driver[64]) {
    char text[64];
    if (!find_device(device->platform, device->number, text)) return NULL;
    char *equals = strchr(text, '=');
    snprintf(name, 64, "%s", equals != NULL ? equals + 1 : text);
    if (equals != NULL) *equals = '\0';
    char *at = strchr(name, '@');
    snprintf(driver, 64, "%s", at != NULL ? at + 1 : "7.5");
    if (at != NULL) *at = '\0';
    for (size_t k = 0; k < sizeof kinds / sizeof kinds[0]; ++k)
        if (strcmp(kinds[k].name, text) == 0) return &kinds[k];
    fprintf(stderr, "fake_icd: no kind of device '%s'\n", text);
    exit(2);
}

static const struct Capability *capability_of(const Kind *kind) {
    for (size_t c = 1; c < sizeof capabilities / sizeof capabilities[0]; ++c)
        if (strcmp(capabilities[c].name, kind->name) == 0) return &capabilities[c];
    return &capabilities[0];
}

static cl_int CL_API_CALL get_device_info(cl_device_id device, cl_device_info what, size_t size, void *to,
                                          size_t *size_ret) {
    char name[64], driver[64], padded[80];
    const Kind *kind = kind_of(device, name, driver);
    if (kind == NULL) return CL_INVALID_DEVICE;
    switch (what) {
    case CL_DEVICE_NAME:
        snprintf(padded, sizeof padded, "   %s  ", name); /* as some drivers do */
        return answer_text(padded, size, to, size_ret);
    case CL_DEVICE_VENDOR:
        return answer_text("Nobody", size, to, size_ret);
    case CL_DEVICE_VERSION:
        return answer_text(kind->version, size, to, size_ret);
    case CL_DRIVER_VERSION:
        return answer_text(driver, size, to, size_ret);
    case CL_DEVICE_PROFILE:
        return answer_text(kind->profile, size, to, size_ret);
    case CL_DEVICE_EXTENSIONS:
        return answer_text(kind->extensions, size, to, size_ret);
    case CL_DEVICE_TYPE:
        return answer_ulong(kind->type, size, to, size_ret);
    case CL_DEVICE_SINGLE_FP_CONFIG:
        return answer_ulong(kind->single, size, to, size_ret);
    case CL_DEVICE_DOUBLE_FP_CONFIG:
        return kind->full == 0 ? CL_INVALID_VALUE : answer_ulong(kind->full, size, to, size_ret);
    case CL_DEVICE_GLOBAL_MEM_SIZE:
        return answer_ulong(capability_of(kind)->gigabytes << 30, size, to, size_ret);
    case CL_DEVICE_MAX_MEM_ALLOC_SIZE:
        return answer_ulong(1u << 28, size, to, size_ret);
    case CL_DEVICE_MAX_COMPUTE_UNITS:
        return answer_uint(capability_of(kind)->units, size, to, size_ret);
    case CL_DEVICE_MAX_CLOCK_FREQUENCY:
        return answer_uint(capability_of(kind)->mhz, size, to, size_ret);
    case CL_DEVICE_HOST_UNIFIED_MEMORY:
        return answer_uint(capability_of(kind)->shared_memory, size, to, size_ret);
    case CL_DEVICE_COMPILER_AVAILABLE:
        return answer_uint(kind->compiler, size, to, size_ret);
    case CL_DEVICE_ENDIAN_LITTLE:
        return answer_uint(kind->little_endian, size, to, size_ret);
    case CL_DEVICE_AVAILABLE:
        return answer_uint(kind->available, size, to, size_ret);
    case CL_DEVICE_PLATFORM: {
        const cl_platform_id platform = &platforms[device->platform];
        return answer(&platform, sizeof platform, size, to, size_ret);
    }
    default:
        return CL_INVALID_VALUE;
    }
}

static cl_context CL_API_CALL create_context(
    const cl_context_properties *properties, cl_uint count, const cl_device_id *ids,
    void(CL_CALLBACK *notify)(const char *, const void *, size_t, void *), void *data, cl_int *code) {
    char name[64], driver[64];
    const Kind *kind = count == 1 ? kind_of(ids[0], name, driver) : NULL;
    (void)properties, (void)notify, (void)data;
    while (kind != NULL && kind->context_error == HANGS) sleep(1);
    if (kind != NULL && kind->context_error == CRASHES) abort(); /* which no mask of signals holds off */
    *code = kind == NULL ? CL_INVALID_VALUE : kind->context_error;
    return *code == CL_SUCCESS ? &context : NULL;
}

static cl_command_queue CL_API_CALL create_queue(cl_context of, cl_device_id id,
                                                 cl_command_queue_properties properties, cl_int *code) {
    (void)of, (void)id, (void)properties;
    *code = CL_SUCCESS;
    return &queue;
}

static cl_program CL_API_CALL create_program(cl_context of, cl_uint count, const char **texts,
                                             const size_t *lengths, cl_int *code) {
    (void)of, (void)count, (void)lengths;
    snprintf(program.source, sizeof program.source, "%s", texts[0]);
    program.compiled = 0;
    *code = CL_SUCCESS;
    return &program;
}

static cl_program CL_API_CALL create_from_binary(cl_context of, cl_uint count, const cl_device_id *ids,
                                                 const size_t *lengths, const unsigned char **binaries,
                                                 cl_int *taken, cl_int *code) {
    (void)of, (void)count, (void)ids;
    snprintf(program.source, sizeof program.source, "%.*s", (int)lengths[0], (const char *)binaries[0]);
    program.compiled = 1;
    *taken = *code = CL_SUCCESS;
    return &program;
}

static cl_int CL_API_CALL get_program_info(cl_program of, cl_program_info what, size_t size, void *to,
                                           size_t *size_ret) {
    const size_t length = strlen(of->source);
    switch (what) {
    case CL_PROGRAM_NUM_DEVICES:
        return answer_uint(1, size, to, size_ret);
    case CL_PROGRAM_KERNEL_NAMES:
        return answer_text("trace;accumulate", size, to, size_ret);
    case CL_PROGRAM_BINARY_SIZES:
        return answer(&length, sizeof length, size, to, size_ret);
    case CL_PROGRAM_BINARIES:
        memcpy(*(unsigned char **)to, of->source, length);
        return CL_SUCCESS;
    default:
        return CL_INVALID_VALUE;
    }
}

/* Keeps the processor busy, as long as a build takes. */
static void compile(void) {
    const char *text = getenv("FAKE_COMPILE");
    struct timespec start, now;
    const long wanted = text != NULL ? atol(text) * 1000000 : 0;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &start);
    do clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    while ((now.tv_sec - start.tv_sec) * 1000000000 + now.tv_nsec - start.tv_nsec < wanted);
}

static cl_int CL_API_CALL build_program(cl_program built, cl_uint count, const cl_device_id *ids,
                                        const char *options, void(CL_CALLBACK *notify)(cl_program, void *),
                                        void *data) {
    (void)count, (void)ids, (void)notify, (void)data;
    if (!built->compiled) compile();
    if (strstr(built->source, "#error") == NULL) {
        snprintf(built->log, sizeof built->log, "options: %s", options);
        return CL_SUCCESS;
    }
    snprintf(
        built->log, sizeof built->log,
        "tree.cl:3:1: warning: unused\nsphere.cl:31:7: error: use of 'x': gone\ntree.cl:9:9: error: later\n");
    return CL_BUILD_PROGRAM_FAILURE;
}

static cl_int CL_API_CALL get_build_info(cl_program of, cl_device_id id, cl_program_build_info what,
                                         size_t size, void *to, size_t *size_ret) {
    (void)id;
    return what == CL_PROGRAM_BUILD_LOG ? answer_text(of->log, size, to, size_ret) : CL_INVALID_VALUE;
}

static cl_int CL_API_CALL retain_program(cl_program retained) {
    return (void)retained, CL_SUCCESS;
}
static cl_int CL_API_CALL release_program(cl_program released) {
    return (void)released, CL_SUCCESS;
}
static cl_int CL_API_CALL release_queue(cl_command_queue released) {
    return (void)released, CL_SUCCESS;
}
static cl_int CL_API_CALL release_context(cl_context released) {
    return (void)released, CL_SUCCESS;
}
static cl_int CL_API_CALL finish(cl_command_queue waited) {
    return (void)waited, CL_SUCCESS;
}

static void connect(void) {
    dispatch.clGetPlatformInfo = get_platform_info;
    dispatch.clGetDeviceIDs = get_device_ids;
    dispatch.clGetDeviceInfo = get_device_info;
    dispatch.clCreateContext = create_context;
    dispatch.clCreateCommandQueue = create_queue;
    dispatch.clCreateProgramWithSource = create_program;
    dispatch.clCreateProgramWithBinary = create_from_binary;
    dispatch.clGetProgramInfo = get_program_info;
    dispatch.clBuildProgram = build_program;
    dispatch.clGetProgramBuildInfo = get_build_info;
    dispatch.clRetainProgram = retain_program;
    dispatch.clReleaseProgram = release_program;
    dispatch.clReleaseCommandQueue = release_queue;
    dispatch.clReleaseContext = release_context;
    dispatch.clFinish = finish;
    context.dispatch = &dispatch;
    queue.dispatch = &dispatch;
    program.dispatch = &dispatch;
    for (int p = 0; p < PLATFORMS; ++p) {
        platforms[p].dispatch = &dispatch;
        platforms[p].number = p;
        for (int d = 0; d < DEVICES; ++d) {
            devices[p][d].dispatch = &dispatch;
            devices[p][d].platform = p;
            devices[p][d].number = d;
        }
    }
}

EXPORT cl_int CL_API_CALL clIcdGetPlatformIDsKHR(cl_uint room, cl_platform_id *ids, cl_uint *count);
cl_int CL_API_CALL clIcdGetPlatformIDsKHR(cl_uint room, cl_platform_id *ids, cl_uint *count) {
    connect();
    for (cl_uint p = 0; ids != NULL && p < PLATFORMS && p < room; ++p) ids[p] = &platforms[p];
    if (count != NULL) *count = PLATFORMS;
    return CL_SUCCESS;
}

EXPORT void *CL_API_CALL clGetExtensionFunctionAddress(const char *name);
void *CL_API_CALL clGetExtensionFunctionAddress(const char *name) {
    return strcmp(name, "clIcdGetPlatformIDsKHR") == 0 ? (void *)(size_t)clIcdGetPlatformIDsKHR : NULL;
}

EXPORT cl_int CL_API_CALL clGetPlatformInfo(cl_platform_id platform, cl_platform_info what, size_t size,
                                            void *to, size_t *size_ret);
cl_int CL_API_CALL clGetPlatformInfo(cl_platform_id platform, cl_platform_info what, size_t size, void *to,
                                     size_t *size_ret) {
    return get_platform_info(platform, what, size, to, size_ret);
}
