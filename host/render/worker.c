/* worker.c: see worker.h. */
#include "worker.h"

#include "base/clock.h"
#include "opencl/forked.h"
#include "opencl/self_test.h"
#include "worker_buffers.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Raw samples take at most this part of the device's memory. */
#define SAMPLES_MEMORY_SHARE 8u

/* ---- kernels ------------------------------------------------------------------------------------------- */

static BpStatus set_argument(BpWorker *worker, cl_kernel kernel, cl_uint index, size_t size,
                             const void *value, BpError *err) {
    CL_TRY(worker, clSetKernelArg(kernel, index, size, value), "clSetKernelArg");
    return BP_OK;
}

/* Places of the arguments that change with the chunk, of trace after the scene's; TRACE_PARAMETERS and
 * accumulate.cl declare them in this order. */
enum {
    TRACE_FIRST_PIXEL,
    TRACE_FIRST_SAMPLE,
    TRACE_SAMPLES,
    TRACE_COUNT,
    TRACE_OUT,
    TRACE_LAMP_RAYS,
    TRACE_LIST
};
enum {
    ACCUMULATE_IN,
    ACCUMULATE_PIXELS,
    ACCUMULATE_SAMPLES,
    ACCUMULATE_FIRST_PIXEL,
    ACCUMULATE_FIRST_SAMPLE,
    ACCUMULATE_CONSTANTS,
    ACCUMULATE_LAMP_RAYS = ACCUMULATE_CONSTANTS + 6,
    ACCUMULATE_ITEMS,
    ACCUMULATE_LIST
};

BpStatus bp_worker_bind_scene(BpWorker *worker, cl_kernel kernel, BpError *err) {
    cl_uint index = 0;
    for (size_t i = 0; i < worker->scene_buffer_count; ++i)
        BP_TRY(set_argument(worker, kernel, index++, sizeof(cl_mem), &worker->scene_buffers[i], err));
#define NUMBER(name) worker->name,
    const cl_uint numbers[] = {SCENE_NUMBERS(NUMBER)};
#undef NUMBER
    if (worker->has_triangles) {
        BP_TRY(set_argument(worker, kernel, index++, sizeof(cl_uint), &worker->first_triangles, err));
        if (worker->has_normals)
            BP_TRY(set_argument(worker, kernel, index++, sizeof(cl_uint), &worker->normal_leaves, err));
        if (worker->has_coordinates)
            BP_TRY(set_argument(worker, kernel, index++, sizeof(cl_uint), &worker->coordinate_leaves, err));
        BP_TRY(set_argument(worker, kernel, index++, sizeof(cl_uint), &worker->coloured_slots, err));
    }
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; ++i)
        BP_TRY(set_argument(worker, kernel, index++, sizeof(cl_uint), &numbers[i], err));
    worker->scene_arguments = index;
    return BP_OK;
}

static BpStatus create_kernels(BpWorker *worker, const BpWorkerSetup *setup, BpError *err) {
    cl_int code = CL_SUCCESS;
    worker->trace = clCreateKernel(worker->program->program, "trace", &code);
    CL_TRY(worker, code, "clCreateKernel(trace)");
    worker->accumulate = clCreateKernel(worker->program->program, "accumulate", &code);
    CL_TRY(worker, code, "clCreateKernel(accumulate)");
    BP_TRY(bp_worker_bind_scene(worker, worker->trace, err));
    cl_uint index = ACCUMULATE_CONSTANTS;
    BP_TRY(set_argument(worker, worker->accumulate, index++, sizeof(cl_uint), &worker->replicates, err));
    BP_TRY(set_argument(worker, worker->accumulate, index++, sizeof(cl_int), &setup->scale_log2, err));
    const cl_mem sums[] = {worker->sums, worker->fine_sums, worker->counts, worker->tallies};
    for (size_t i = 0; i < sizeof sums / sizeof sums[0]; ++i)
        BP_TRY(set_argument(worker, worker->accumulate, index++, sizeof(cl_mem), &sums[i], err));
    if (setup->program.pixel_list) {
        BP_TRY(bp_worker_create_pixel_list(worker, err));
        BP_TRY(set_argument(worker, worker->accumulate, ACCUMULATE_LIST, sizeof(cl_mem), &worker->pixel_list,
                            err));
        BP_TRY(set_argument(worker, worker->trace, worker->scene_arguments + TRACE_LIST, sizeof(cl_mem),
                            &worker->pixel_list, err));
    }

    worker->form = setup->program.form;
    const bool packet = worker->form == BP_KERNEL_PACKET;
    worker->samples_per_item = packet                           ? BP_PACKET_SAMPLES_PER_ITEM
                               : worker->form != BP_KERNEL_POOL ? 1
                               : setup->samples_per_item != 0   ? setup->samples_per_item
                                                                : BP_POOL_SAMPLES_PER_ITEM;
    worker->local_size = setup->local_size != 0 ? setup->local_size
                         : packet               ? BP_LOCAL_SIZE_PACKET
                                                : BP_LOCAL_SIZE_SAMPLE;
    size_t most = 0;
    if (worker->form == BP_KERNEL_SAMPLE && worker->local_size > BP_SAMPLE_GROUP_MAX)
        worker->local_size = BP_SAMPLE_GROUP_MAX;
    CL_TRY(worker,
           clGetKernelWorkGroupInfo(worker->trace, worker->device->id, CL_KERNEL_WORK_GROUP_SIZE, sizeof most,
                                    &most, NULL),
           "clGetKernelWorkGroupInfo");
    if (worker->local_size > most) worker->local_size = most;
    return BP_OK;
}

/* How many samples take as long as one: the lanes of a packet, or one work-group on each unit of a GPU. */
static uint32_t samples_together(const BpWorker *worker, const BpDeviceInfo *info,
                                 const BpWorkerSetup *setup) {
    if (setup->program.form == BP_KERNEL_PACKET) return setup->program.packet_lanes;
    if (info->type == BP_DEVICE_CPU) return 1;
    return info->compute_units * (uint32_t)worker->local_size;
}

/* A processor's caches hold a few MiB a core. The raw samples of a larger chunk go to memory and back, and
 * the memory is new to the process (a scene of few spheres took 1.25 times as long with 2^22 samples on two
 * cores). */
static uint64_t chunk_samples_max(const BpDeviceInfo *info) {
    if (info->type != BP_DEVICE_CPU) return 1u << 26;
    const uint64_t units = info->compute_units;
    return units < 8 ? (units > 0 ? units : 1) << 19 : 1u << 22;
}

BpStatus bp_worker_create(const BpDeviceInfo *info, BpPacked *given, const BpWorkerSetup *setup,
                          BpWorker **worker, BpError *err) {
    BpWorker *made = calloc(1, sizeof *made);
    if (made == NULL) {
        bp_packed_clear(given);
        return bp_fail(err, BP_ERR_MEMORY, "no memory for a device's bookkeeping");
    }
    BpPacked *const packed = &made->packed;
    *packed = *given;
    *given = (BpPacked){0};
    made->real_size = bp_packed_real_size(packed);
    made->width = setup->width;
    made->pixels = setup->width * setup->height;
    made->replicates = setup->replicates;
    made->max_depth = setup->max_depth;
    made->pixel_center = setup->pixel_center;
    made->seed_low = (uint32_t)setup->seed;
    made->seed_high = (uint32_t)(setup->seed >> 32);
    made->first_leaves = packed->tree.first_leaves;
    made->first_triangles = packed->tree.first_triangles;
    made->normal_leaves = packed->tree.normal_leaves;
    made->coordinate_leaves = packed->tree.coordinate_leaves;
    made->coloured_slots = packed->coloured_slots;
    made->leaf_count = packed->tree.leaf_count;
    made->has_lamps = bp_effects_has(setup->program.effects, BP_EFFECT_LAMPS);
    made->has_triangles = bp_effects_has(setup->program.effects, BP_EFFECT_TRIANGLES);
    made->has_normals =
        made->has_triangles && bp_effects_has(setup->program.effects, BP_EFFECT_SMOOTH_NORMALS);
    made->has_coordinates = made->has_triangles &&
                            bp_effects_has(setup->program.effects, BP_EFFECT_TEXTURES) &&
                            bp_effects_has(setup->program.effects, BP_EFFECT_TEXTURE_COORDINATES);
    made->has_capsules = bp_effects_has(setup->program.effects, BP_EFFECT_CAPSULES);
    BpStatus status = BP_OK;
    made->device = setup->device;
    made->owns_device = setup->device == NULL;
    if (made->owns_device) status = bp_device_open_part(info, setup->threads, &made->device, err);
    if (status != BP_OK) goto failed;
    info = &made->device->info;
    if (!setup->untested) {
        const double start = bp_clock_seconds();
        bool ran = false;
        status = bp_self_test_once(made->device, &ran, err);
        if (status != BP_OK) goto failed;
        if (ran) made->self_test_seconds = bp_clock_seconds() - start;
    }
    BpProgramOptions program = setup->program;
    bp_worker_choose_parts(made, packed, &program);
    char mark[64];
    snprintf(mark, sizeof mark, "typedef uint build_mark_%llu;\n", (unsigned long long)setup->build_mark);
    const bool marked = setup->build_mark != 0 && setup->extra_text == NULL;
    BP_TRY_GOTO(status,
                bp_program_build(made->device, &program, marked ? "mark.cl" : setup->extra_name,
                                 marked ? mark : setup->extra_text, &made->program, err),
                failed);
    BP_TRY_GOTO(status, bp_worker_upload_scene(made, err), failed);
    BP_TRY_GOTO(status, bp_worker_create_picture(made, err), failed);
    BP_TRY_GOTO(status, create_kernels(made, setup, err), failed);

    const uint64_t sample_bytes = 4 * made->real_size;
    uint64_t room = info->memory_bytes / SAMPLES_MEMORY_SHARE;
    if (room > info->largest_allocation_bytes) room = info->largest_allocation_bytes;
    uint64_t limit = room / sample_bytes;
    const uint64_t most = chunk_samples_max(info);
    if (limit > most) limit = most;
    made->samples_limit = limit > 0 ? (uint32_t)limit : 1;
    bp_chunk_sizer_init(&made->sizer, setup->max_depth, samples_together(made, info, setup));
    *worker = made;
    return BP_OK;

failed:
    bp_worker_destroy(&made);
    return status;
}

static void release_flight(struct BpFlight *flight) {
    if (flight->trace_start != NULL) clReleaseEvent(flight->trace_start);
    if (flight->accumulate_end != NULL) clReleaseEvent(flight->accumulate_end);
    *flight = (struct BpFlight){0};
}

static void release_objects(BpWorker *w) {
    if (w->device != NULL) clFinish(w->device->queue);
    for (int i = 0; i < w->flight_count; ++i) release_flight(&w->flights[i]);
    for (size_t i = 0; i < w->scene_buffer_count; ++i)
        if (w->scene_buffers[i] != NULL) clReleaseMemObject(w->scene_buffers[i]);
    const cl_mem buffers[] = {w->sums,    w->fine_sums, w->counts,    w->tallies,
                              w->samples, w->lamp_rays, w->pixel_list};
    for (size_t i = 0; i < sizeof buffers / sizeof buffers[0]; ++i)
        if (buffers[i] != NULL) clReleaseMemObject(buffers[i]);
    if (w->trace != NULL) clReleaseKernel(w->trace);
    if (w->accumulate != NULL) clReleaseKernel(w->accumulate);
}

void bp_worker_destroy(BpWorker **worker) {
    if (worker == NULL || *worker == NULL) return;
    BpWorker *w = *worker;
    if (!bp_drivers_left_behind()) release_objects(w);
    bp_packed_clear(&w->packed);
    bp_program_destroy(&w->program);
    if (w->owns_device) bp_device_close(&w->device);
    free(w);
    *worker = NULL;
}

/* ---- chunks -------------------------------------------------------------------------------------------- */

static size_t round_up(size_t count, size_t multiple) {
    return (count + multiple - 1) / multiple * multiple;
}

static double event_seconds(cl_event from, cl_profiling_info from_what, cl_event to) {
    cl_ulong start_ns = 0, end_ns = 0;
    clGetEventProfilingInfo(from, from_what, sizeof start_ns, &start_ns, NULL);
    clGetEventProfilingInfo(to, CL_PROFILING_COMMAND_END, sizeof end_ns, &end_ns, NULL);
    return end_ns > start_ns ? 1e-9 * (double)(end_ns - start_ns) : 0;
}

BpStatus bp_worker_wait(BpWorker *worker, BpError *err) {
    if (worker->flight_count == 0) return BP_OK;
    BP_TRY(bp_drivers_use(err));
    struct BpFlight *flight = &worker->flights[0];
    CL_TRY(worker, clWaitForEvents(1, &flight->accumulate_end), "clWaitForEvents");
    const double seconds =
        event_seconds(flight->trace_start, CL_PROFILING_COMMAND_START, flight->accumulate_end);
    worker->device_seconds += seconds;
    worker->accumulate_seconds +=
        event_seconds(flight->accumulate_end, CL_PROFILING_COMMAND_START, flight->accumulate_end);
    bp_chunk_sizer_measure(&worker->sizer, flight->samples, seconds);
    worker->samples_done += flight->samples;
    release_flight(flight);
    memmove(worker->flights, worker->flights + 1, sizeof worker->flights[0] * (BP_WORKER_FLIGHT - 1));
    worker->flights[BP_WORKER_FLIGHT - 1] = (struct BpFlight){0};
    --worker->flight_count;
    return BP_OK;
}

BpStatus bp_worker_make_room(BpWorker *worker, BpError *err) {
    return worker->flight_count == BP_WORKER_FLIGHT ? bp_worker_wait(worker, err) : BP_OK;
}

BpStatus bp_worker_oldest_done(BpWorker *worker, bool *done, BpError *err) {
    *done = true;
    if (worker->flight_count == 0) return BP_OK;
    BP_TRY(bp_drivers_use(err));
    cl_int state = CL_QUEUED;
    CL_TRY(worker,
           clGetEventInfo(worker->flights[0].accumulate_end, CL_EVENT_COMMAND_EXECUTION_STATUS, sizeof state,
                          &state, NULL),
           "clGetEventInfo");
    *done = state <= CL_COMPLETE; /* below: an error, which waiting reports */
    return BP_OK;
}

BpStatus bp_worker_wait_for_all(BpWorker *worker, BpError *err) {
    BP_TRY(bp_drivers_use(err)); /* what comes next reads or writes buffers */
    while (worker->flight_count > 0) BP_TRY(bp_worker_wait(worker, err));
    return BP_OK;
}

static BpStatus enqueue(BpWorker *worker, cl_kernel kernel, size_t items, size_t local, cl_event *event,
                        const char *name, BpError *err) {
    const size_t global = round_up(items, local);
    const cl_int code =
        clEnqueueNDRangeKernel(worker->device->queue, kernel, 1, NULL, &global, &local, 0, NULL, event);
    if (code != CL_SUCCESS) return bp_cl_fail(err, code, name, worker->device);
    return BP_OK;
}

uint32_t bp_worker_items(const BpWorker *worker, uint32_t count) {
    const uint64_t items = ((uint64_t)count + worker->samples_per_item - 1) / worker->samples_per_item;
    if (worker->form != BP_KERNEL_POOL) return (uint32_t)items;
    const uint64_t wanted = (uint64_t)worker->device->info.compute_units * BP_POOL_ITEMS_PER_UNIT;
    const uint64_t enough = wanted < count ? wanted : count;
    /* Whole groups, since any work-item of a group may take samples and count rays to lamps. */
    return (uint32_t)round_up(items > enough ? items : enough, worker->local_size);
}

BpStatus bp_worker_start(BpWorker *worker, const BpChunk *chunk, BpError *err) {
    const uint32_t count = chunk->pixel_count * chunk->samples;
    const bool first = worker->samples_done == 0 && worker->flight_count == 0;
    BP_TRY(bp_drivers_use(err));
    BP_TRY(bp_worker_make_room(worker, err));
    const uint32_t items = bp_worker_items(worker, count);
    if (count > worker->samples_capacity) {
        BP_TRY(bp_worker_wait_for_all(worker, err));
        BP_TRY(bp_worker_reserve_samples(worker, count, items, err));
    }
    const cl_uint first_sample = (cl_uint)chunk->first_sample;
    const cl_uint lamp_items = worker->has_lamps ? items : 0;
    const struct {
        cl_kernel kernel;
        cl_uint index;
        size_t size;
        const void *value;
    } arguments[] = {
        {worker->trace, worker->scene_arguments + TRACE_FIRST_PIXEL, sizeof(cl_uint), &chunk->first_pixel},
        {worker->trace, worker->scene_arguments + TRACE_FIRST_SAMPLE, sizeof(cl_uint), &first_sample},
        {worker->trace, worker->scene_arguments + TRACE_SAMPLES, sizeof(cl_uint), &chunk->samples},
        {worker->trace, worker->scene_arguments + TRACE_COUNT, sizeof(cl_uint), &count},
        {worker->trace, worker->scene_arguments + TRACE_OUT, sizeof(cl_mem), &worker->samples},
        {worker->trace, worker->scene_arguments + TRACE_LAMP_RAYS, sizeof(cl_mem), &worker->lamp_rays},
        {worker->accumulate, ACCUMULATE_IN, sizeof(cl_mem), &worker->samples},
        {worker->accumulate, ACCUMULATE_PIXELS, sizeof(cl_uint), &chunk->pixel_count},
        {worker->accumulate, ACCUMULATE_SAMPLES, sizeof(cl_uint), &chunk->samples},
        {worker->accumulate, ACCUMULATE_FIRST_PIXEL, sizeof(cl_uint), &chunk->first_pixel},
        {worker->accumulate, ACCUMULATE_FIRST_SAMPLE, sizeof(cl_uint), &first_sample},
        {worker->accumulate, ACCUMULATE_LAMP_RAYS, sizeof(cl_mem), &worker->lamp_rays},
        {worker->accumulate, ACCUMULATE_ITEMS, sizeof(cl_uint), &lamp_items},
    };
    for (size_t i = 0; i < sizeof arguments / sizeof arguments[0]; ++i)
        BP_TRY(set_argument(worker, arguments[i].kernel, arguments[i].index, arguments[i].size,
                            arguments[i].value, err));

    struct BpFlight *flight = &worker->flights[worker->flight_count++];
    *flight = (struct BpFlight){.samples = count};
    const double start = bp_clock_seconds();
    BP_TRY(enqueue(worker, worker->trace, items, worker->local_size, &flight->trace_start,
                   "clEnqueueNDRangeKernel(trace)", err));
    BP_TRY(enqueue(worker, worker->accumulate, chunk->pixel_count, BP_LOCAL_SIZE_SAMPLE,
                   &flight->accumulate_end, "clEnqueueNDRangeKernel(accumulate)", err));
    CL_TRY(worker, clFlush(worker->device->queue), "clFlush");
    if (first) {
        BP_TRY(bp_worker_wait(worker, err));
        const double overhead = bp_clock_seconds() - start - worker->device_seconds;
        worker->first_launch_seconds = overhead > 0 ? overhead : 0;
    }
    return BP_OK;
}

BpStatus bp_worker_set_pixels(BpWorker *worker, const uint32_t *list, uint32_t count, BpError *err) {
    BP_TRY(bp_worker_wait_for_all(worker, err));
    CL_TRY(worker,
           clEnqueueWriteBuffer(worker->device->queue, worker->pixel_list, CL_TRUE, 0, count * sizeof *list,
                                list, 0, NULL, NULL),
           "clEnqueueWriteBuffer");
    return BP_OK;
}

uint32_t bp_worker_chunk_samples(const BpWorker *worker, double seconds, double slowest) {
    const uint32_t samples = bp_chunk_sizer_samples(&worker->sizer, seconds, slowest);
    return samples > worker->samples_limit ? worker->samples_limit : samples;
}
