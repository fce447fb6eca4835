/* embree_peer.c: the same scenes with Embree's sphere points, or its triangles, tuned as well as we can: the
 * opponent.
 *
 * In:    a scene file.   Out: one line of JSON (peer.h).
 * Knows: Embree 3's C interface.   Does not know: shading (embree_paths.h), ballpark's kernels.
 *
 * --method is a list of words, separated by commas:
 *   1 | 4 | 8 | 16   rays to a call of rtcIntersect (default 1; shading is vectorised for all of them)
 *   1m | np          a whole batch to a call: array of structures, structure of arrays
 *   coherent         camera rays are traced with Embree's coherent flag
 *   robust           RTC_SCENE_FLAG_ROBUST
 *   medium           build quality MEDIUM instead of HIGH
 *   compact          RTC_SCENE_FLAG_COMPACT
 *   huge             huge spheres are met first, in vector code, and bound what Embree has to search */
#include "../host/base/clock.h"
#include "embree_paths.h"

#include <embree3/rtcore.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <xmmintrin.h>

typedef struct Method {
    enum { RAYS_1, RAYS_4, RAYS_8, RAYS_16, RAYS_1M, RAYS_NP } rays;
    bool coherent, robust, medium, compact, huge;
} Method;

/* One thread's own: its batch and buffers for Embree's ray formats. */
typedef struct Worker {
    Batch batch;
    struct RTCRayHit *single; /* lanes */
    float *t_near, *time;     /* lanes each, for np */
    uint32_t *mask, *id, *flag, *geometry, *instance;
    float *u, *v;
} Worker;

typedef struct Job {
    World world;
    RTCScene scene;
    Method method;
    PeerFilm film;
    Worker *workers;
} Job;

static Method parse_method(const char *text) {
    Method method = {0};
    static const char *const rays[] = {"1", "4", "8", "16", "1m", "np"};
    char copy[256];
    snprintf(copy, sizeof copy, "%s", text);
    for (char *word = strtok(copy, ","); word != NULL; word = strtok(NULL, ",")) {
        bool known = false;
        for (size_t r = 0; r < sizeof rays / sizeof *rays; r++) {
            if (strcmp(word, rays[r]) != 0) continue;
            method.rays = r;
            known = true;
        }
        if (strcmp(word, "coherent") == 0) known = method.coherent = true;
        if (strcmp(word, "robust") == 0) known = method.robust = true;
        if (strcmp(word, "medium") == 0) known = method.medium = true;
        if (strcmp(word, "compact") == 0) known = method.compact = true;
        if (strcmp(word, "huge") == 0) known = method.huge = true;
        if (known) continue;
        fprintf(stderr, "unknown method word '%s'\n", word);
        exit(2);
    }
    return method;
}

/* ---- the world for Embree ---- */

static void embree_error(void *user, enum RTCError code, const char *text) {
    (void)user;
    fprintf(stderr, "Embree error %d: %s\n", (int)code, text);
    exit(1);
}

static bool count_memory(void *user, ssize_t bytes, bool post) {
    (void)post;
    __atomic_fetch_add((int64_t *)user, (int64_t)bytes, __ATOMIC_RELAXED);
    return true;
}

static RTCScene build(RTCDevice device, const World *world, const Method *method) {
    RTCScene scene = rtcNewScene(device);
    int flags = RTC_SCENE_FLAG_NONE;
    if (method->robust) flags |= RTC_SCENE_FLAG_ROBUST;
    if (method->compact) flags |= RTC_SCENE_FLAG_COMPACT;
    rtcSetSceneFlags(scene, (enum RTCSceneFlags)flags);
    const enum RTCBuildQuality quality = method->medium ? RTC_BUILD_QUALITY_MEDIUM : RTC_BUILD_QUALITY_HIGH;
    rtcSetSceneBuildQuality(scene, quality);
    if (world->scene->sphere_count > 0) {
        /* Spheres without a radius are left out of the tree. */
        const size_t floats = 4 * world->scene->sphere_count;
        float *points = peer_allocate(floats, sizeof *points);
        memcpy(points, world->points, floats * sizeof *points);
        for (uint32_t h = 0; h < world->huge_count; h++) points[4 * world->huge[h] + 3] = NAN;
        RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, points, 0,
                                   4 * sizeof(float), world->scene->sphere_count);
        rtcSetGeometryBuildQuality(geometry, quality);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene, geometry);
        rtcReleaseGeometry(geometry);
    }
    if (world->scene->triangle_count > 0) {
        /* Vertices that triangles share are written again for each: Embree copies them into its leaves. */
        const size_t count = world->scene->triangle_count;
        RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        uint32_t *corners = peer_allocate(3 * count, sizeof *corners);
        for (size_t i = 0; i < 3 * count; i++) corners[i] = (uint32_t)i;
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, world->vertices, 0,
                                   3 * sizeof(float), 3 * count);
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, corners, 0,
                                   3 * sizeof *corners, count);
        rtcSetGeometryBuildQuality(geometry, quality);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene, geometry);
        rtcReleaseGeometry(geometry);
    }
    rtcCommitScene(scene);
    return scene;
}

static Worker worker_create(uint32_t lanes) {
    Worker worker = {.batch = batch_create(lanes), .single = peer_allocate(lanes, sizeof(struct RTCRayHit))};
    float **floats[] = {&worker.t_near, &worker.time, &worker.u, &worker.v};
    uint32_t **words[] = {&worker.mask, &worker.id, &worker.flag, &worker.geometry, &worker.instance};
    for (size_t a = 0; a < sizeof floats / sizeof *floats; a++)
        *floats[a] = peer_allocate(lanes, sizeof(float));
    for (size_t a = 0; a < sizeof words / sizeof *words; a++)
        *words[a] = peer_allocate(lanes, sizeof(uint32_t));
    for (uint32_t i = 0; i < lanes; i++) {
        worker.mask[i] = UINT32_MAX;
    }
    return worker;
}

/* ---- rays, in every form Embree takes ---- */

/* All rays are written before the first is traced: a call right after the stores would wait for them. */
static void trace_single(const Job *job, Worker *worker, struct RTCIntersectContext *context, uint32_t begin,
                         uint32_t end) {
    Batch *batch = &worker->batch;
    struct RTCRayHit *rays = worker->single;
    for (uint32_t i = begin; i < end; i++) {
        rays[i].ray = (struct RTCRay){.org_x = batch->origin[0][i],
                                      .org_y = batch->origin[1][i],
                                      .org_z = batch->origin[2][i],
                                      .dir_x = batch->direction[0][i],
                                      .dir_y = batch->direction[1][i],
                                      .dir_z = batch->direction[2][i],
                                      .tfar = batch->t[i],
                                      .mask = UINT32_MAX};
        rays[i].hit.primID = rays[i].hit.geomID = rays[i].hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    }
    if (job->method.rays == RAYS_1) {
        for (uint32_t i = begin; i < end; i++) rtcIntersect1(job->scene, context, &rays[i]);
    } else {
        rtcIntersect1M(job->scene, context, rays + begin, end - begin, sizeof *rays);
    }
    for (uint32_t i = begin; i < end; i++) {
        batch->t[i] = rays[i].ray.tfar;
        batch->sphere[i] = rays[i].hit.primID;
        batch->normal[0][i] = rays[i].hit.Ng_x;
        batch->normal[1][i] = rays[i].hit.Ng_y;
        batch->normal[2][i] = rays[i].hit.Ng_z;
    }
}

/* One function for each packet width: lanes are copied in and out in whole vectors; a batch's arrays are
 * padded, so the last packet may read and write past `end`, where lanes are free (never: the first range is
 * followed by the second, which is traced after it). */
#define TRACE_PACKETS(WIDTH)                                                                                 \
    static void trace_packets_##WIDTH(const Job *job, Worker *worker, struct RTCIntersectContext *context,   \
                                      uint32_t begin, uint32_t end) {                                        \
        Batch *batch = &worker->batch;                                                                       \
        struct RTCRayHit##WIDTH packet;                                                                      \
        _Alignas(64) int valid[WIDTH];                                                                       \
        memset(&packet, 0, sizeof packet);                                                                   \
        for (uint32_t l = 0; l < WIDTH; l++) packet.ray.mask[l] = UINT32_MAX;                                \
        for (uint32_t i = begin; i < end; i += WIDTH) {                                                      \
            const uint32_t here = end - i < WIDTH ? end - i : WIDTH;                                         \
            for (uint32_t l = 0; l < WIDTH; l++) {                                                           \
                valid[l] = l < here ? -1 : 0;                                                                \
                packet.ray.org_x[l] = batch->origin[0][i + l];                                               \
                packet.ray.org_y[l] = batch->origin[1][i + l];                                               \
                packet.ray.org_z[l] = batch->origin[2][i + l];                                               \
                packet.ray.dir_x[l] = batch->direction[0][i + l];                                            \
                packet.ray.dir_y[l] = batch->direction[1][i + l];                                            \
                packet.ray.dir_z[l] = batch->direction[2][i + l];                                            \
                packet.ray.tnear[l] = 0;                                                                     \
                packet.ray.tfar[l] = batch->t[i + l];                                                        \
                packet.hit.primID[l] = RTC_INVALID_GEOMETRY_ID;                                              \
                packet.hit.geomID[l] = RTC_INVALID_GEOMETRY_ID;                                              \
                packet.hit.instID[0][l] = RTC_INVALID_GEOMETRY_ID;                                           \
            }                                                                                                \
            rtcIntersect##WIDTH(valid, job->scene, context, &packet);                                        \
            for (uint32_t l = 0; l < here; l++) {                                                            \
                batch->t[i + l] = packet.ray.tfar[l];                                                        \
                batch->sphere[i + l] = packet.hit.primID[l];                                                 \
                batch->normal[0][i + l] = packet.hit.Ng_x[l];                                                \
                batch->normal[1][i + l] = packet.hit.Ng_y[l];                                                \
                batch->normal[2][i + l] = packet.hit.Ng_z[l];                                                \
            }                                                                                                \
        }                                                                                                    \
    }
TRACE_PACKETS(4)
TRACE_PACKETS(8)
TRACE_PACKETS(16)

static void trace_stream(const Job *job, Worker *worker, struct RTCIntersectContext *context, uint32_t begin,
                         uint32_t end) {
    Batch *batch = &worker->batch;
    for (uint32_t i = begin; i < end; i++) {
        batch->sphere[i] = worker->geometry[i] = worker->instance[i] = RTC_INVALID_GEOMETRY_ID;
    }
    struct RTCRayHitNp rays = {.ray = {.org_x = batch->origin[0] + begin,
                                       .org_y = batch->origin[1] + begin,
                                       .org_z = batch->origin[2] + begin,
                                       .tnear = worker->t_near + begin,
                                       .dir_x = batch->direction[0] + begin,
                                       .dir_y = batch->direction[1] + begin,
                                       .dir_z = batch->direction[2] + begin,
                                       .time = worker->time + begin,
                                       .tfar = batch->t + begin,
                                       .mask = worker->mask + begin,
                                       .id = worker->id + begin,
                                       .flags = worker->flag + begin},
                               .hit = {.Ng_x = batch->normal[0] + begin,
                                       .Ng_y = batch->normal[1] + begin,
                                       .Ng_z = batch->normal[2] + begin,
                                       .u = worker->u + begin,
                                       .v = worker->v + begin,
                                       .primID = batch->sphere + begin,
                                       .geomID = worker->geometry + begin,
                                       .instID = {worker->instance + begin}}};
    rtcIntersectNp(job->scene, context, &rays, end - begin);
}

static void trace_range(const Job *job, Worker *worker, bool coherent, uint32_t begin, uint32_t end) {
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    if (coherent) context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    switch (job->method.rays) {
    case RAYS_1:
    case RAYS_1M:
        trace_single(job, worker, &context, begin, end);
        break;
    case RAYS_4:
        trace_packets_4(job, worker, &context, begin, end);
        break;
    case RAYS_8:
        trace_packets_8(job, worker, &context, begin, end);
        break;
    case RAYS_16:
        trace_packets_16(job, worker, &context, begin, end);
        break;
    case RAYS_NP:
        trace_stream(job, worker, &context, begin, end);
        break;
    }
}

static uint64_t trace_row(void *argument, unsigned thread, uint32_t row) {
    Job *job = argument;
    Worker *worker = &job->workers[thread];
    Batch *batch = &worker->batch;
    RowCursor cursor = {.row = row};
    uint64_t rays = 0;
    _mm_setcsr(_mm_getcsr() | 0x8040u); /* flush denormals to zero, as Embree's manual asks */
    if (job->world.max_depth == 0) return 0;
    while (batch_refill(batch, &job->world, &cursor)) {
        rays += batch->active;
        batch_meet_huge(batch, &job->world);
        if (job->method.coherent) {
            trace_range(job, worker, false, 0, batch->fresh);
            trace_range(job, worker, true, batch->fresh, batch->active);
        } else {
            trace_range(job, worker, false, 0, batch->active);
        }
        batch_bounce(batch, &job->world, &cursor, &job->film);
    }
    return rays;
}

int main(int argc, char **argv) {
    PeerOptions options;
    PeerRun run;
    peer_options(argc, argv, "1|4|8|16|1m|np,coherent,robust,medium,compact,huge", &options);
    if (options.method == NULL) options.method = "1";
    if (options.lanes == 0) options.lanes = 64;
    options.lanes = (options.lanes + LANE_BLOCK - 1) / LANE_BLOCK * LANE_BLOCK;
    if (options.lanes > LANES_MAX) options.lanes = LANES_MAX;

    BpScene *scene = peer_load(&options, true, &run);
    const Method method = parse_method(options.method);
    Job job = {.world = world_create(scene, options.seed, method.huge),
               .method = method,
               .film = peer_film(scene),
               .workers = peer_allocate(options.threads, sizeof(Worker))};
    for (uint32_t t = 0; t < options.threads; t++) job.workers[t] = worker_create(options.lanes);

    char config[256];
    snprintf(config, sizeof config, "threads=%u%s%s", options.threads, options.config != NULL ? "," : "",
             options.config != NULL ? options.config : "");
    RTCDevice device = rtcNewDevice(config);
    if (device == NULL) {
        fprintf(stderr, "Embree refuses the device '%s' (error %d)\n", config, (int)rtcGetDeviceError(NULL));
        return 1;
    }
    int64_t bytes = 0;
    rtcSetDeviceErrorFunction(device, embree_error, NULL);
    rtcSetDeviceMemoryMonitorFunction(device, count_memory, &bytes);
    const double start = bp_clock_seconds();
    job.scene = build(device, &job.world, &job.method);
    run.build_seconds = bp_clock_seconds() - start;
    run.structure_bytes = bytes > 0 ? (uint64_t)bytes : 0;

    peer_trace(scene, options.threads, trace_row, &job, &run);
    peer_report("embree", &options, scene, &job.film, &run);
    rtcReleaseScene(job.scene);
    rtcReleaseDevice(device);
    return 0;
}
