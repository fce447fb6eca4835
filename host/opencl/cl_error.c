/* cl_error.c: OpenCL's error numbers as names and remedies; see cl.h.
 *
 * In:    an error number and the call that returned it.   Out: a message for people.
 * Knows: the error codes of OpenCL 1.2 and of the ICD loader.   Does not know: what the call was for. */
#include "cl.h"

#define ERROR_LIST(X)                                                                                        \
    X(CL_SUCCESS, 0)                                                                                         \
    X(CL_DEVICE_NOT_FOUND, -1)                                                                               \
    X(CL_DEVICE_NOT_AVAILABLE, -2)                                                                           \
    X(CL_COMPILER_NOT_AVAILABLE, -3)                                                                         \
    X(CL_MEM_OBJECT_ALLOCATION_FAILURE, -4)                                                                  \
    X(CL_OUT_OF_RESOURCES, -5)                                                                               \
    X(CL_OUT_OF_HOST_MEMORY, -6)                                                                             \
    X(CL_PROFILING_INFO_NOT_AVAILABLE, -7)                                                                   \
    X(CL_MEM_COPY_OVERLAP, -8)                                                                               \
    X(CL_IMAGE_FORMAT_MISMATCH, -9)                                                                          \
    X(CL_IMAGE_FORMAT_NOT_SUPPORTED, -10)                                                                    \
    X(CL_BUILD_PROGRAM_FAILURE, -11)                                                                         \
    X(CL_MAP_FAILURE, -12)                                                                                   \
    X(CL_MISALIGNED_SUB_BUFFER_OFFSET, -13)                                                                  \
    X(CL_EXEC_STATUS_ERROR_FOR_EVENTS_IN_WAIT_LIST, -14)                                                     \
    X(CL_COMPILE_PROGRAM_FAILURE, -15)                                                                       \
    X(CL_LINKER_NOT_AVAILABLE, -16)                                                                          \
    X(CL_LINK_PROGRAM_FAILURE, -17)                                                                          \
    X(CL_DEVICE_PARTITION_FAILED, -18)                                                                       \
    X(CL_KERNEL_ARG_INFO_NOT_AVAILABLE, -19)                                                                 \
    X(CL_INVALID_VALUE, -30)                                                                                 \
    X(CL_INVALID_DEVICE_TYPE, -31)                                                                           \
    X(CL_INVALID_PLATFORM, -32)                                                                              \
    X(CL_INVALID_DEVICE, -33)                                                                                \
    X(CL_INVALID_CONTEXT, -34)                                                                               \
    X(CL_INVALID_QUEUE_PROPERTIES, -35)                                                                      \
    X(CL_INVALID_COMMAND_QUEUE, -36)                                                                         \
    X(CL_INVALID_HOST_PTR, -37)                                                                              \
    X(CL_INVALID_MEM_OBJECT, -38)                                                                            \
    X(CL_INVALID_IMAGE_FORMAT_DESCRIPTOR, -39)                                                               \
    X(CL_INVALID_IMAGE_SIZE, -40)                                                                            \
    X(CL_INVALID_SAMPLER, -41)                                                                               \
    X(CL_INVALID_BINARY, -42)                                                                                \
    X(CL_INVALID_BUILD_OPTIONS, -43)                                                                         \
    X(CL_INVALID_PROGRAM, -44)                                                                               \
    X(CL_INVALID_PROGRAM_EXECUTABLE, -45)                                                                    \
    X(CL_INVALID_KERNEL_NAME, -46)                                                                           \
    X(CL_INVALID_KERNEL_DEFINITION, -47)                                                                     \
    X(CL_INVALID_KERNEL, -48)                                                                                \
    X(CL_INVALID_ARG_INDEX, -49)                                                                             \
    X(CL_INVALID_ARG_VALUE, -50)                                                                             \
    X(CL_INVALID_ARG_SIZE, -51)                                                                              \
    X(CL_INVALID_KERNEL_ARGS, -52)                                                                           \
    X(CL_INVALID_WORK_DIMENSION, -53)                                                                        \
    X(CL_INVALID_WORK_GROUP_SIZE, -54)                                                                       \
    X(CL_INVALID_WORK_ITEM_SIZE, -55)                                                                        \
    X(CL_INVALID_GLOBAL_OFFSET, -56)                                                                         \
    X(CL_INVALID_EVENT_WAIT_LIST, -57)                                                                       \
    X(CL_INVALID_EVENT, -58)                                                                                 \
    X(CL_INVALID_OPERATION, -59)                                                                             \
    X(CL_INVALID_GL_OBJECT, -60)                                                                             \
    X(CL_INVALID_BUFFER_SIZE, -61)                                                                           \
    X(CL_INVALID_MIP_LEVEL, -62)                                                                             \
    X(CL_INVALID_GLOBAL_WORK_SIZE, -63)                                                                      \
    X(CL_INVALID_PROPERTY, -64)                                                                              \
    X(CL_INVALID_IMAGE_DESCRIPTOR, -65)                                                                      \
    X(CL_INVALID_COMPILER_OPTIONS, -66)                                                                      \
    X(CL_INVALID_LINKER_OPTIONS, -67)                                                                        \
    X(CL_INVALID_DEVICE_PARTITION_COUNT, -68)                                                                \
    X(CL_PLATFORM_NOT_FOUND_KHR, -1001)

const char *bp_cl_error_name(cl_int code) {
    switch (code) {
#define ERROR_NAME(name, number)                                                                             \
    case number:                                                                                             \
        return #name;
        ERROR_LIST(ERROR_NAME)
#undef ERROR_NAME
    default:
        return "an error code that OpenCL 1.2 does not define";
    }
}

/* What is known of an error beside its name. */
typedef struct Known {
    cl_int code;
    BpStatus status;
    const char *meaning; /* with advice for every interface */
    BpRemedy remedy;
} Known;

static const Known known[] = {
    {CL_MEM_OBJECT_ALLOCATION_FAILURE, BP_ERR_MEMORY, "the device's memory is full",
     BP_REMEDY_SMALLER_WIDTH_OR_OTHER_DEVICE},
    {CL_OUT_OF_HOST_MEMORY, BP_ERR_MEMORY, "this computer's memory is full; close other programs",
     BP_REMEDY_OR_SMALLER_WIDTH},
    {CL_OUT_OF_RESOURCES, BP_ERR_MEMORY, "the device ran out of memory or of time for one kernel",
     BP_REMEDY_SMALLER_WIDTH_OR_OTHER_DEVICE},
    {CL_INVALID_BUFFER_SIZE, BP_ERR_LIMIT, "a buffer is larger than the device can hold in one piece",
     BP_REMEDY_SMALLER_WIDTH_OR_OTHER_DEVICE},
    {CL_DEVICE_NOT_AVAILABLE, BP_ERR_DEVICE, "the device is in use or switched off", BP_REMEDY_OTHER_DEVICE},
    {CL_COMPILER_NOT_AVAILABLE, BP_ERR_DEVICE,
     "the driver comes without a compiler; install the vendor's full OpenCL driver",
     BP_REMEDY_OR_OTHER_DEVICE},
    {CL_BUILD_PROGRAM_FAILURE, BP_ERR_BUILD, "", BP_REMEDY_NONE},
    {CL_INVALID_COMMAND_QUEUE, BP_ERR_DEVICE,
     "an earlier command failed, or the driver stopped the device (a watchdog)", BP_REMEDY_OTHER_DEVICE},
    {CL_EXEC_STATUS_ERROR_FOR_EVENTS_IN_WAIT_LIST, BP_ERR_DEVICE,
     "an earlier command failed, or the driver stopped the device (a watchdog)", BP_REMEDY_OTHER_DEVICE},
};

BpStatus bp_cl_fail(BpError *err, cl_int code, const char *call, const BpDevice *device) {
    Known what = {code, BP_ERR_DEVICE, "", BP_REMEDY_NONE};
    for (size_t i = 0; i < sizeof known / sizeof known[0]; ++i)
        if (known[i].code == code) what = known[i];
    return bp_fail_with(what.remedy, err, what.status, "%s failed with %s (%d)%s%s%s%s", call,
                        bp_cl_error_name(code), (int)code, device != NULL ? " on " : "",
                        device != NULL ? device->info.name : "", what.meaning[0] != '\0' ? ": " : "",
                        what.meaning);
}
