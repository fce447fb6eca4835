/* pilot_paths.c: see pilot_paths.h. */
#include "pilot_paths.h"

#include "opencl/forked.h"
#include "packed/reals.h"
#include "pilot_shapes.h"
#include "scene/vector.h"

#include <stdlib.h>
#include <string.h>

enum {
    ARGUMENT_COUNT,
    ARGUMENT_SEGMENTS,
    ARGUMENT_FROM_CAMERA,
    ARGUMENT_NUMBERS,
    ARGUMENT_STARTS,
    ARGUMENT_RECORDS,
    ARGUMENT_MARKS
};

void bp_pilot_flight_clear(BpPilotFlight *flight) {
    /* After an error, commands may still be under way that read and write the arrays. */
    if (flight->worker != NULL) clFinish(flight->worker->device->queue);
    const cl_mem buffers[] = {flight->numbers, flight->starts, flight->records, flight->marks};
    for (size_t i = 0; i < sizeof buffers / sizeof buffers[0]; ++i)
        if (buffers[i] != NULL) clReleaseMemObject(buffers[i]);
    if (flight->kernel != NULL) clReleaseKernel(flight->kernel);
    free(flight->number_data);
    free(flight->mark_data);
    free(flight->start_data);
    free(flight->record_data);
}

static cl_mem make_buffer(BpWorker *worker, size_t bytes, cl_int *code) {
    return *code != CL_SUCCESS
               ? NULL
               : clCreateBuffer(worker->device->context, CL_MEM_READ_WRITE, bytes, NULL, code);
}

BpStatus bp_pilot_flight_create(BpWorker *worker, const BpScene *scene, BpPilotFlight *flight, BpError *err) {
    const size_t bytes = worker->real_size;
    const size_t path_bytes =
        (size_t)BP_PILOT_SEGMENTS_MAX * PILOT_REALS * bytes; /* the most of all arrays */
    const uint64_t room = worker->device->info.largest_allocation_bytes / path_bytes;
    const uint32_t batch = room < 1 ? 1 : room < BP_PILOT_BATCH ? (uint32_t)room : BP_PILOT_BATCH;
    const size_t record_bytes = batch * path_bytes;
    const size_t mark_bytes = (size_t)batch * BP_PILOT_SEGMENTS_MAX * PILOT_UINTS * sizeof(uint32_t);
    const size_t number_bytes = (size_t)batch * 2 * sizeof(uint32_t);
    const size_t start_bytes = (size_t)batch * PILOT_START_REALS * bytes;
    cl_int code = CL_SUCCESS;
    *flight = (BpPilotFlight){.worker = worker, .local = BP_LOCAL_SIZE_SAMPLE, .batch = batch};
    bp_camera_origin(scene, flight->origin);
    flight->number_data = malloc(number_bytes);
    flight->mark_data = malloc(mark_bytes);
    flight->start_data = malloc(start_bytes);
    flight->record_data = malloc(record_bytes);
    if (flight->number_data == NULL || flight->mark_data == NULL || flight->start_data == NULL ||
        flight->record_data == NULL)
        return bp_fail(err, BP_ERR_MEMORY, "no memory for the paths of a pilot");
    flight->kernel = clCreateKernel(worker->program->program, "pilot", &code);
    flight->numbers = make_buffer(worker, number_bytes, &code);
    flight->starts = make_buffer(worker, start_bytes, &code);
    flight->records = make_buffer(worker, record_bytes, &code);
    flight->marks = make_buffer(worker, mark_bytes, &code);
    size_t most = 0;
    if (code == CL_SUCCESS)
        code = clGetKernelWorkGroupInfo(flight->kernel, worker->device->id, CL_KERNEL_WORK_GROUP_SIZE,
                                        sizeof most, &most, NULL);
    if (code != CL_SUCCESS) return bp_cl_fail(err, code, "preparing a pilot", worker->device);
    if (flight->local > most) flight->local = most;
    return bp_worker_bind_scene(worker, flight->kernel, err);
}

BpStatus bp_pilot_fly(BpPilotFlight *flight, cl_uint count, cl_uint segments, bool from_camera,
                      BpError *err) {
    BpWorker *worker = flight->worker;
    cl_command_queue queue = worker->device->queue;
    const cl_uint camera = from_camera, none = 0;
    const size_t marks = (size_t)count * segments * PILOT_UINTS * sizeof(uint32_t);
    const size_t items = (count + flight->local - 1) / flight->local * flight->local;
    const struct {
        cl_uint place;
        size_t size;
        const void *value;
    } arguments[] = {{ARGUMENT_COUNT, sizeof count, &count},
                     {ARGUMENT_SEGMENTS, sizeof segments, &segments},
                     {ARGUMENT_FROM_CAMERA, sizeof camera, &camera},
                     {ARGUMENT_NUMBERS, sizeof(cl_mem), &flight->numbers},
                     {ARGUMENT_STARTS, sizeof(cl_mem), &flight->starts},
                     {ARGUMENT_RECORDS, sizeof(cl_mem), &flight->records},
                     {ARGUMENT_MARKS, sizeof(cl_mem), &flight->marks}};
    cl_int code = CL_SUCCESS;
    for (size_t i = 0; i < sizeof arguments / sizeof arguments[0] && code == CL_SUCCESS; ++i)
        code = clSetKernelArg(flight->kernel, worker->scene_arguments + arguments[i].place, arguments[i].size,
                              arguments[i].value);
    if (code == CL_SUCCESS)
        code = clEnqueueWriteBuffer(queue, flight->numbers, CL_FALSE, 0, count * 2 * sizeof(uint32_t),
                                    flight->number_data, 0, NULL, NULL);
    if (code == CL_SUCCESS && !from_camera)
        code = clEnqueueWriteBuffer(queue, flight->starts, CL_FALSE, 0,
                                    count * PILOT_START_REALS * worker->real_size, flight->start_data, 0,
                                    NULL, NULL);
    if (code == CL_SUCCESS)
        code = clEnqueueFillBuffer(queue, flight->marks, &none, sizeof none, 0, marks, 0, NULL, NULL);
    if (code == CL_SUCCESS)
        code = clEnqueueNDRangeKernel(queue, flight->kernel, 1, NULL, &items, &flight->local, 0, NULL, NULL);
    if (code == CL_SUCCESS)
        code = clEnqueueReadBuffer(queue, flight->records, CL_FALSE, 0,
                                   (size_t)count * segments * PILOT_REALS * worker->real_size,
                                   flight->record_data, 0, NULL, NULL);
    if (code == CL_SUCCESS)
        code = clEnqueueReadBuffer(queue, flight->marks, CL_TRUE, 0, marks, flight->mark_data, 0, NULL, NULL);
    return code == CL_SUCCESS ? BP_OK : bp_cl_fail(err, code, "tracing a pilot", worker->device);
}

bool bp_pilot_segment(const BpPilotFlight *flight, uint32_t path, uint32_t segments, uint32_t s,
                      BpPilotSegment *segment) {
    const size_t place = (size_t)path * segments + s;
    if (s >= segments) return false;
    segment->flags = flight->mark_data[place * PILOT_UINTS + PILOT_FLAGS];
    segment->shape = flight->mark_data[place * PILOT_UINTS + PILOT_SHAPE];
    if ((segment->flags & PILOT_TRACED) == 0) return false;
    const bool single = flight->worker->real_size == sizeof(float);
#define READ(i) bp_reals_load(flight->record_data, single, place *PILOT_REALS + (size_t)(i))
    segment->odds = READ(PILOT_ODDS);
    for (int a = 0; a < 3; ++a) {
        segment->point[a] = READ(PILOT_POINT + a) + flight->origin[a];
        segment->direction[a] = READ(PILOT_DIRECTION + a);
        segment->throughput[a] = segment->odds > 0 ? READ(PILOT_THROUGHPUT + a) / segment->odds : 0;
    }
    segment->distance = READ(PILOT_DISTANCE);
    segment->time = READ(PILOT_TIME);
#undef READ
    return true;
}

void bp_pilot_normal(const BpScene *scene, const BpPilotSegment *segment, double normal[3]) {
    bp_pilot_outward(scene, segment->shape, segment->point, segment->time, normal);
    if (bp_dot(normal, segment->direction) <= 0) return;
    for (int a = 0; a < 3; ++a) normal[a] = -normal[a];
}

double bp_pilot_index_behind(const BpScene *scene, const BpPilotSegment *segment, const double normal[3]) {
    double outward[3];
    const double inside = bp_pilot_index_inside(scene, segment->shape);
    bp_pilot_outward(scene, segment->shape, segment->point, segment->time, outward);
    return bp_dot(normal, outward) > 0 ? inside : 1 / inside;
}

void bp_pilot_turn_at(const BpScene *scene, const BpPilotSegment *segment, const double leaves[3],
                      BpPilotTurn *turn) {
    bp_pilot_normal(scene, segment, turn->normal);
    const double side = bp_dot(leaves, turn->normal) < 0 ? -1 : 1;
    memcpy(turn->point, segment->point, sizeof turn->point);
    for (int a = 0; a < 3; ++a) {
        turn->normal[a] *= side;
        turn->leaves[a] = leaves[a];
    }
    bp_normalize(turn->leaves); /* in double: fuzz has a pole at the rim of its lobe */
    turn->index = bp_pilot_index_behind(scene, segment, turn->normal);
}

const BpMaterial *bp_pilot_material_at(const BpScene *scene, const BpPilotSegment *segment) {
    return bp_pilot_material(scene, segment->shape);
}

bool bp_pilot_is_surface(const BpScene *scene, const BpPilotSegment *segment) {
    return (segment->flags & PILOT_MET) != 0 &&
           bp_pilot_material_at(scene, segment)->kind != BP_MATERIAL_INTERFACE;
}

bool bp_pilot_is_rough(const BpScene *scene, const BpPilotSegment *segment) {
    return bp_pilot_is_surface(scene, segment) && (segment->flags & PILOT_LIT) != 0;
}

double bp_pilot_carried(const BpPilotFlight *flight, uint32_t path, uint32_t segments, uint32_t s,
                        double t[3]) {
    BpPilotSegment before;
    t[0] = t[1] = t[2] = 1;
    if (s == 0 || !bp_pilot_segment(flight, path, segments, s - 1, &before)) return 1;
    memcpy(t, before.throughput, sizeof before.throughput);
    return before.odds;
}
