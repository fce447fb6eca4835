/* reference.c: samples of a picture over threads, a row at a time; see reference.h. */
#include "reference.h"

#include "base/status.h"
#include "trace.h"

#include <pthread.h>
#include <stdatomic.h>
#include <unistd.h>

enum { THREADS_MAX = 256 };
/* Generous for one level of bp_ref_color with what it calls, sanitizers included. */
#define STACK_BYTES_PER_SEGMENT 2048u
#define STACK_BYTES_BASE (1u << 20)

typedef struct Job {
    const BpScene *scene;
    const BpReferenceOptions *options;
    BpSums *sums;
    Camera camera;
    atomic_uint next_row;
    atomic_ullong truncated_paths;
} Job;

static void render_pixel(Job *job, uint32_t column, uint32_t row) {
    const BpReferenceOptions *options = job->options;
    const uint64_t pixel = (uint64_t)row * job->sums->width + column;
    for (uint64_t s = 0; s < options->samples; ++s) {
        Random random = random_stream(options->seed, pixel, options->first_sample + s);
        double height;
        Ray ray = bp_ref_camera_ray(&job->camera, column, row, &random, &height);
        if (job->scene->moving_count > 0) ray.time = random_real(&random);
        Path path = {0};
        const Vec color = bp_ref_camera_color(job->scene, &ray, height, options->max_depth, &random, &path);
        bp_pixel_sums_add(&job->sums->pixels[pixel], (double[3]){color.x, color.y, color.z}, path.segments);
        if (path.cut) atomic_fetch_add(&job->truncated_paths, 1);
    }
}

static void *render_rows(void *argument) {
    Job *job = argument;
    for (;;) {
        const uint32_t row = atomic_fetch_add(&job->next_row, 1);
        if (row >= job->sums->height) return NULL;
        for (uint32_t column = 0; column < job->sums->width; ++column) render_pixel(job, column, row);
    }
}

static unsigned thread_count(const BpReferenceOptions *options, uint32_t rows) {
    unsigned count = options->threads;
    if (count == 0) {
        const long processors = sysconf(_SC_NPROCESSORS_ONLN);
        count = processors > 0 ? (unsigned)processors : 1;
    }
    if (count > rows) count = rows;
    return count < THREADS_MAX ? count : THREADS_MAX;
}

BpStatus bp_reference_render(const BpScene *scene, const BpReferenceOptions *options, BpSums *sums,
                             uint64_t *truncated_paths, BpError *err) {
    if (sums->width != scene->camera.width || sums->height != scene->camera.height)
        return bp_fail(err, BP_ERR_USAGE, "reference: sums of %u x %u pixels for a picture of %u x %u",
                       sums->width, sums->height, scene->camera.width, scene->camera.height);
    Job job = {.scene = scene, .options = options, .sums = sums, .camera = bp_ref_camera(&scene->camera)};
    atomic_init(&job.next_row, 0);
    atomic_init(&job.truncated_paths, 0);

    /* The recursion is as deep as the longest path, so every thread gets a stack that holds it. */
    pthread_attr_t attributes;
    pthread_attr_init(&attributes);
    pthread_attr_setstacksize(&attributes,
                              STACK_BYTES_BASE + (size_t)options->max_depth * STACK_BYTES_PER_SEGMENT);
    pthread_t threads[THREADS_MAX];
    unsigned started = 0;
    const unsigned wanted = thread_count(options, sums->height);
    while (started < wanted && pthread_create(&threads[started], &attributes, render_rows, &job) == 0)
        ++started;
    for (unsigned i = 0; i < started; ++i) pthread_join(threads[i], NULL);
    pthread_attr_destroy(&attributes);
    if (started == 0)
        return bp_fail_with(
            BP_REMEDY_SMALLER_DEPTH, err, BP_ERR_MEMORY,
            "the reference tracer could not start a thread, whose stack for paths of %u segments may not fit",
            options->max_depth);
    if (truncated_paths != NULL) *truncated_paths += atomic_load(&job.truncated_paths);
    return BP_OK;
}
