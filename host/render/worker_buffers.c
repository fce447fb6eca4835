/* worker_buffers.c: see worker_buffers.h. */
#include "worker_buffers.h"

#include "base/pages.h"
#include "packed/tree_binary.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool uses_in_place(const BpDeviceInfo *info) {
    return info->type == BP_DEVICE_CPU && info->has_shared_memory;
}

/* What a kernel gets in place of an empty array, which OpenCL does not know. Lanes that met nothing read the
 * first element of an array and do not use it, but by a number in it they may read another array: so there is
 * room for an element of any of them, and all of it is 0. */
static const uint64_t nothing[1152 / sizeof(uint64_t)];
#define HOLDS(numbers)                                                                                       \
    _Static_assert((numbers) * sizeof(double) <= sizeof nothing, "no room for one of " #numbers)
HOLDS(sizeof(PackedTexture) / sizeof(real));
HOLDS(LEAF_REALS(BP_TREE_WIDTH_MAX));
HOLDS(TRIANGLE_REALS(BP_TREE_WIDTH_MAX));
HOLDS(LAMP_NODE_REALS);

/* A buffer of `bytes`, with `data` in it when there is any; without a byte, one of zeros. Where that has
 * pages of its own and the device shares the host's memory, the buffer is that array: nothing is copied, and
 * large pages stay large. */
static BpStatus create_buffer(BpWorker *worker, cl_mem *buffer, uint64_t bytes, const void *data,
                              const char *what, BpError *err) {
    const BpDeviceInfo *info = &worker->device->info;
    if (bytes > info->largest_allocation_bytes)
        return bp_fail_with(BP_REMEDY_OR_OTHER_DEVICE, err, BP_ERR_LIMIT,
                            "%s takes %.1f MiB, but %s allows %.1f MiB in one allocation; "
                            "use a smaller picture or scene",
                            what, (double)bytes / 1048576, info->name,
                            (double)info->largest_allocation_bytes / 1048576);
    cl_int code = CL_SUCCESS;
    const bool in_place = bytes > 0 && uses_in_place(info) && bp_begins_page(data);
    if (bytes == 0) {
        bytes = sizeof nothing;
        data = nothing;
    }
    const cl_mem_flags flags = data == NULL ? CL_MEM_READ_WRITE
                               : in_place   ? CL_MEM_READ_ONLY | CL_MEM_USE_HOST_PTR
                                            : CL_MEM_READ_ONLY | CL_MEM_COPY_HOST_PTR;
    *buffer = clCreateBuffer(worker->device->context, flags, (size_t)bytes, (void *)(uintptr_t)data, &code);
    CL_TRY(worker, code, "clCreateBuffer");
    return BP_OK;
}

/* One of the scene's arrays. */
typedef struct Upload {
    uint64_t count; /* of its numbers */
    size_t size;    /* of a number */
    const void *data;
    const char *what;
    bool split; /* it comes in parts where the others do */
} Upload;

static void list_uploads(const BpWorker *worker, const BpPacked *packed, Upload uploads[BP_SCENE_ARRAYS]) {
    const BpTree *tree = &packed->tree;
    const uint64_t width = tree->width, nodes = tree->node_count, leaf_count = tree->leaf_count;
    const uint64_t slots = leaf_count * width, colours = packed->colour_count,
                   motion_leaves = tree->motion_leaves, axis_leaves = tree->axis_leaves;
    const uint64_t triangle_leaves = tree->triangle_leaves, sphere_leaves = leaf_count - triangle_leaves;
    const uint64_t normal_leaves = tree->normal_leaves, coordinate_leaves = tree->coordinate_leaves;
    const uint64_t lamp_nodes = packed->lamps.node_count, lamp_slots = packed->lamps.slot_count;
    const uint64_t disc_count = packed->disc_count, texture_count = packed->texture_count;
    const uint64_t texel_count = packed->texel_count, sky_row_count = packed->sky_row_count;
    const uint64_t sky_column_count = packed->sky_column_count, sky_height_count = packed->sky_height_count;
    const uint64_t medium_count = packed->medium_count, boundary_uints = packed->boundary_uints;
    const uint64_t focuser_count = packed->focusers.focuser_count,
                   target_count = packed->focusers.target_count;
    const uint64_t material_count = packed->material_count > 0 ? packed->material_count : 1;
#define NUMBERS_REALS(element) sizeof(element) / sizeof(real), worker->real_size
#define NUMBERS_UINTS(element) sizeof(element) / sizeof(packed_uint), sizeof(packed_uint)
#define UPLOAD(count, each, size, data, what, split)                                                         \
    { (count) * (each), size, data, what, split }
#define UPLOAD_OF(...) UPLOAD(__VA_ARGS__)
#define OF_PACK(numbers, element, name, count, what)                                                         \
    UPLOAD_OF(count, NUMBERS_##numbers(element), packed->name, what, false),
#define OF_FOCUSERS(numbers, element, name, count, what)                                                     \
    UPLOAD_OF(count, NUMBERS_##numbers(element), packed->focusers.name, what, false),
#define OF_SLOTS(numbers, element, name, count, what)                                                        \
    UPLOAD_OF(count, NUMBERS_##numbers(element), packed->name, what, true),
#define OF_LAMPS(numbers, element, name, count, what)                                                        \
    UPLOAD_OF(count, NUMBERS_##numbers(element), packed->lamps.name, what, true),
#define OF_TREE(numbers, element, name, count, what)                                                         \
    UPLOAD_OF(count, NUMBERS_##numbers(element), tree->name, what, true),
    const Upload list[BP_SCENE_ARRAYS] = {
        SCENE_ARRAYS_OF_PACK(OF_PACK) SCENE_ARRAYS_OF_FOCUSERS(OF_FOCUSERS) SCENE_ARRAYS_OF_SLOTS(OF_SLOTS)
            SCENE_ARRAYS_OF_LAMPS(OF_LAMPS) SCENE_ARRAYS_OF_TREE(OF_TREE) SCENE_ARRAYS_OF_CAPSULES(OF_TREE)
                SCENE_ARRAYS_OF_TRIANGLES(OF_TREE) SCENE_ARRAYS_OF_NORMALS(OF_TREE)
                    SCENE_ARRAYS_OF_COORDINATES(OF_TREE)};
    memcpy(uploads, list, sizeof list);
}

void bp_worker_choose_parts(BpWorker *worker, const BpPacked *packed, BpProgramOptions *program) {
    Upload uploads[BP_SCENE_ARRAYS];
    uint64_t most = 0, length = worker->device->info.largest_allocation_bytes / worker->real_size;
    bool larger = false;
    list_uploads(worker, packed, uploads);
    for (size_t i = 0; i < BP_SCENE_ARRAYS; ++i) {
        if (!uploads[i].split) continue;
        larger |= uploads[i].count * uploads[i].size > worker->device->info.largest_allocation_bytes;
        if (uploads[i].count > most) most = uploads[i].count;
    }
    worker->part_length = 0;
    if (!larger || length < PART_UNIT) return;
    if (length > INT32_MAX) length = INT32_MAX; /* numbers in the kernel have 32 bits */
    length -= length % PART_UNIT;
    const uint64_t parts = (most + length - 1) / length;
    program->parts = parts < 2 ? 2 : parts < SCENE_PARTS_MAX ? (uint32_t)parts : SCENE_PARTS_MAX;
    program->part_length = worker->part_length = (uint32_t)length;
    worker->parts = program->parts;
}

/* In parts; the last ones may be empty. */
static BpStatus upload_parts(BpWorker *worker, const Upload *upload, BpError *err) {
    const BpDeviceInfo *info = &worker->device->info;
    const uint64_t length = worker->part_length, bytes = upload->count * upload->size;
    if (upload->count > worker->parts * length)
        return bp_fail_with(
            BP_REMEDY_OR_OTHER_DEVICE, err, BP_ERR_LIMIT,
            "%s takes %.1f MiB, but %s allows %.1f MiB in one allocation, and %d are used for it at "
            "most; use a smaller scene",
            upload->what, (double)bytes / 1048576, info->name,
            (double)info->largest_allocation_bytes / 1048576, SCENE_PARTS_MAX);
    for (uint64_t part = 0; part < worker->parts; ++part) {
        const uint64_t first = part * length < upload->count ? part * length : upload->count;
        const uint64_t left = upload->count - first, here = left < length ? left : length;
        const void *data = here > 0 ? (const char *)upload->data + first * upload->size : NULL;
        BP_TRY(create_buffer(worker, &worker->scene_buffers[worker->scene_buffer_count++],
                             here * upload->size, data, upload->what, err));
    }
    return BP_OK;
}

BpStatus bp_worker_upload_scene(BpWorker *worker, BpError *err) {
    Upload uploads[BP_SCENE_ARRAYS];
    list_uploads(worker, &worker->packed, uploads);
    const size_t coordinates = BP_SCENE_ARRAYS - BP_COORDINATE_ARRAYS,
                 normals = coordinates - BP_NORMAL_ARRAYS, triangles = normals - BP_TRIANGLE_ARRAYS,
                 capsules = triangles - BP_CAPSULE_ARRAYS;
    for (size_t i = 0; i < BP_SCENE_ARRAYS; ++i) {
        const Upload *upload = &uploads[i];
        if (i >= coordinates ? !worker->has_coordinates
            : i >= normals   ? !worker->has_normals
            : i >= triangles ? !worker->has_triangles
                             : i >= capsules && !worker->has_capsules)
            continue;
        if (upload->split && worker->part_length > 0)
            BP_TRY(upload_parts(worker, upload, err));
        else
            BP_TRY(create_buffer(worker, &worker->scene_buffers[worker->scene_buffer_count++],
                                 upload->count * upload->size, upload->data, upload->what, err));
        worker->scene_bytes += upload->count * upload->size;
    }
    if (!uses_in_place(&worker->device->info)) bp_packed_clear(&worker->packed);
    return BP_OK;
}

/* For a picture whose sums and scene the device's memory cannot hold. */
static void advise_width(const BpWorker *worker, BpError *err) {
    const uint64_t memory = worker->device->info.memory_bytes, scene = worker->scene_bytes;
    const uint64_t most = memory > scene ? (memory - scene) / (worker->picture_bytes / worker->pixels) : 0;
    /* The height of other widths follows from the aspect ratio, of which this is a lower bound. */
    const double aspect_ratio = worker->width / (worker->pixels / worker->width + 1.0);
    const uint32_t widest = bp_camera_width_of(most, aspect_ratio);
    char value[16];
    snprintf(value, sizeof value, "%" PRIu32, widest);
    if (widest > 0)
        bp_error_set_remedy(err, BP_REMEDY_WIDTH_AT_MOST_OR_OTHER_DEVICE, value);
    else
        bp_error_set_remedy(err, BP_REMEDY_OTHER_DEVICE, "");
}

BpStatus bp_worker_create_picture(BpWorker *worker, BpError *err) {
    const uint64_t pixels = worker->pixels;
    const uint64_t sums = pixels * worker->replicates * 3 * sizeof(cl_long);
    const uint64_t counts = pixels * worker->replicates * sizeof(cl_uint);
    const uint64_t tallies = pixels * TALLIES * sizeof(cl_ulong);
    worker->picture_bytes = 2 * sums + counts + tallies;
    const BpDeviceInfo *info = &worker->device->info;
    if (worker->picture_bytes + worker->scene_bytes > info->memory_bytes) {
        bp_fail(err, BP_ERR_LIMIT, "scene and picture take %.1f GiB, but %s has %.1f GiB",
                (double)(worker->picture_bytes + worker->scene_bytes) / (1 << 30), info->name,
                (double)info->memory_bytes / (1 << 30));
        advise_width(worker, err);
        return BP_ERR_LIMIT;
    }
    BP_TRY(create_buffer(worker, &worker->sums, sums, NULL, "the picture's sums", err));
    BP_TRY(create_buffer(worker, &worker->fine_sums, sums, NULL, "the picture's fine sums", err));
    BP_TRY(create_buffer(worker, &worker->counts, counts, NULL, "the picture's counts", err));
    BP_TRY(create_buffer(worker, &worker->tallies, tallies, NULL, "the picture's tallies", err));
    /* New buffers are not zeroed. The fine sums need not be: a count says whether its cell has any, and
     * memory that most pictures never use stays untouched. */
    const cl_uint zero = 0;
    const struct {
        cl_mem buffer;
        uint64_t bytes;
    } fills[] = {{worker->sums, sums}, {worker->counts, counts}, {worker->tallies, tallies}};
    for (size_t i = 0; i < sizeof fills / sizeof fills[0]; ++i)
        CL_TRY(worker,
               clEnqueueFillBuffer(worker->device->queue, fills[i].buffer, &zero, sizeof zero, 0,
                                   (size_t)fills[i].bytes, 0, NULL, NULL),
               "clEnqueueFillBuffer");
    return BP_OK;
}

BpStatus bp_worker_create_pixel_list(BpWorker *worker, BpError *err) {
    const uint64_t bytes = (uint64_t)worker->pixels * sizeof(cl_uint);
    worker->picture_bytes += bytes;
    return create_buffer(worker, &worker->pixel_list, bytes, NULL, "the list of pixels", err);
}

/* Room for the raw samples of `count` pixel samples, and for what the work-items that trace them count. Only
 * called with nothing under way that uses the old room. */
BpStatus bp_worker_reserve_samples(BpWorker *worker, uint32_t count, uint32_t items, BpError *err) {
    if (count <= worker->samples_capacity) return BP_OK;
    if (worker->samples != NULL) clReleaseMemObject(worker->samples);
    if (worker->lamp_rays != NULL) clReleaseMemObject(worker->lamp_rays);
    worker->samples = worker->lamp_rays = NULL;
    worker->samples_capacity = 0;
    BP_TRY(create_buffer(worker, &worker->lamp_rays,
                         worker->has_lamps ? (uint64_t)items * sizeof(cl_uint) : 0, NULL,
                         "the chunk's rays to lamps", err));
    BP_TRY(create_buffer(worker, &worker->samples, (uint64_t)count * 4 * worker->real_size, NULL,
                         "the chunk's samples", err));
    worker->samples_capacity = count;
    return BP_OK;
}
