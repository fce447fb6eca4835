/* layout.c: see layout.h. */
#define BP_HOST
#include "layout.h"

#include "scene_types.h"

#define STRUCTS 4

BpStatus bp_layout_check(BpDevice *device, cl_program program, bool single_precision, BpError *err) {
    /* Structs of reals shrink with the real; probe_layout.cl lists the same members in the same order. */
    const cl_uint real_size = single_precision ? 4 : 8;
#define OF_REALS(type, member)                                                                               \
    {                                                                                                        \
#type, (cl_uint)(sizeof(type) / sizeof(real)) * real_size,                                           \
            (cl_uint)(offsetof(type, member) / sizeof(real)) * real_size                                     \
    }
#define OF_UINTS(type, member)                                                                               \
    { #type, (cl_uint)sizeof(type), (cl_uint)offsetof(type, member) }
    const struct {
        const char *name;
        cl_uint size, offset;
    } expected[STRUCTS] = {
        OF_REALS(PackedCamera, ahead),
        OF_REALS(PackedSky, catcher_light),
        OF_REALS(PackedMaterial, refraction_index),
        OF_UINTS(PackedMaterialKind, total_reflection),
    };
    cl_uint found[2 * STRUCTS + 2] = {0};
    cl_int code = CL_SUCCESS;
    cl_mem buffer = NULL;
    BpStatus status = BP_OK;
    cl_kernel probe = clCreateKernel(program, "probe_layout", &code);
    if (code != CL_SUCCESS) return bp_cl_fail(err, code, "clCreateKernel(probe_layout)", device);
    buffer = clCreateBuffer(device->context, CL_MEM_WRITE_ONLY, sizeof found, NULL, &code);
    if (code == CL_SUCCESS) code = clSetKernelArg(probe, 0, sizeof(cl_mem), &buffer);
    const size_t one = 1;
    if (code == CL_SUCCESS)
        code = clEnqueueNDRangeKernel(device->queue, probe, 1, NULL, &one, &one, 0, NULL, NULL);
    if (code == CL_SUCCESS)
        code = clEnqueueReadBuffer(device->queue, buffer, CL_TRUE, 0, sizeof found, found, 0, NULL, NULL);
    if (code != CL_SUCCESS) status = bp_cl_fail(err, code, "running probe_layout", device);
    for (size_t i = 0; status == BP_OK && i < STRUCTS; ++i)
        if (found[2 * i] != expected[i].size || found[2 * i + 1] != expected[i].offset)
            status = bp_fail(err, BP_ERR_DEVICE,
                             "%s lays out %s with size %u and an offset of %u, the host with %u and %u: this "
                             "compiler cannot be used; try another --device",
                             device->info.name, expected[i].name, found[2 * i], found[2 * i + 1],
                             expected[i].size, expected[i].offset);
    if (status == BP_OK && found[2 * STRUCTS] != real_size)
        status = bp_fail(err, BP_ERR_DEVICE, "%s takes %u bytes for a real, the host %u", device->info.name,
                         found[2 * STRUCTS], real_size);
    if (buffer != NULL) clReleaseMemObject(buffer);
    clReleaseKernel(probe);
    return status;
}
