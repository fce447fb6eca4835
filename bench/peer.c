/* peer.c: see peer.h. */
#include "peer.h"

#include "../host/base/clock.h"

#include <errno.h>
#include <getopt.h>
#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define PI 3.14159265358979323846

static void die(const char *text) {
    fprintf(stderr, "%s\n", text);
    exit(1);
}

void *peer_allocate(size_t count, size_t size) {
    /* A multiple of 64 on a 64-byte border: vector loads may run over the last element. */
    if (size != 0 && count > (SIZE_MAX - 128) / size) die("out of memory");
    const size_t bytes = (count * size + 127) / 64 * 64;
    void *memory = aligned_alloc(64, bytes);
    if (memory == NULL) die("out of memory");
    return memset(memory, 0, bytes);
}

static uint64_t number(const char *text, uint64_t max) {
    char *end = NULL;
    errno = 0;
    const unsigned long long value = strtoull(text, &end, 10);
    if (errno != 0 || end == text || *end != '\0' || *text == '-' || value > max) {
        fprintf(stderr, "'%s' is not a whole number up to %llu\n", text, (unsigned long long)max);
        exit(2);
    }
    return value;
}

void peer_options(int argc, char **argv, const char *methods, PeerOptions *options) {
    static const struct option table[] = {
        {"spp", required_argument, NULL, 's'},     {"width", required_argument, NULL, 'w'},
        {"depth", required_argument, NULL, 'd'},   {"threads", required_argument, NULL, 't'},
        {"seed", required_argument, NULL, 'S'},    {"method", required_argument, NULL, 'm'},
        {"picture", required_argument, NULL, 'p'}, {"config", required_argument, NULL, 'c'},
        {"lanes", required_argument, NULL, 'l'},   {NULL, 0, NULL, 0}};
    *options = (PeerOptions){0};
    int letter;
    while ((letter = getopt_long(argc, argv, "", table, NULL)) != -1) {
        switch (letter) {
        case 's':
            options->samples = (uint32_t)number(optarg, UINT32_MAX);
            break;
        case 'w':
            options->width = (uint32_t)number(optarg, BP_PICTURE_SIDE_MAX);
            break;
        case 'd':
            options->depth = (uint32_t)number(optarg, BP_DEPTH_MAX);
            break;
        case 't':
            options->threads = (uint32_t)number(optarg, 4096);
            break;
        case 'S':
            options->seed = number(optarg, UINT64_MAX);
            break;
        case 'm':
            options->method = optarg;
            break;
        case 'p':
            options->picture_path = optarg;
            break;
        case 'c':
            options->config = optarg;
            break;
        case 'l':
            options->lanes = (uint32_t)number(optarg, 65536);
            break;
        default:
            goto usage;
        }
    }
    if (optind + 1 != argc) goto usage;
    options->scene_path = argv[optind];
    if (options->threads == 0) {
        const long cores = sysconf(_SC_NPROCESSORS_ONLN);
        options->threads = cores > 0 ? (uint32_t)cores : 1;
    }
    return;
usage:
    fprintf(stderr,
            "usage: %s SCENE [--method %s] [--spp N] [--width N] [--depth N] [--threads N] [--seed N]\n"
            "       [--lanes N] [--config TEXT] [--picture FILE.pfm]\n",
            argv[0], methods);
    exit(2);
}

BpScene *peer_load(const PeerOptions *options, bool triangles, PeerRun *run) {
    BpScene *scene = NULL;
    BpError err = {0};
    const double start = bp_clock_seconds();
    BpStatus status = bp_scene_load(options->scene_path, &scene, &err);
    if (status == BP_OK && options->width != 0) status = bp_scene_set_width(scene, options->width, &err);
    if (status != BP_OK) {
        fprintf(stderr, "%s:%d:%d: %s\n", err.file, err.line, err.column, err.message);
        exit(bp_status_exit_code(status));
    }
    if (scene->moving_count > 0 || scene->medium_count > 0) {
        fprintf(stderr, "%s: found media or spheres that move, expected none: peers have neither\n",
                options->scene_path);
        exit(2);
    }
    if (scene->triangle_count > 0 && (!triangles || scene->sphere_count > 0)) {
        fprintf(stderr, "%s: found triangles, expected %s\n", options->scene_path,
                triangles ? "either spheres or triangles" : "spheres: this peer has no triangles");
        exit(2);
    }
    for (size_t m = 0; m < scene->material_count; m++) {
        if (!bp_material_varies(&scene->materials[m])) continue;
        fprintf(stderr, "%s: found textures, expected none: peers draw the same colour everywhere\n",
                options->scene_path);
        exit(2);
    }
    if (scene->environment != NULL) {
        fprintf(stderr, "%s: found an image as background, expected none: peers draw gradients\n",
                options->scene_path);
        exit(2);
    }
    if (options->samples != 0) scene->camera.samples_per_pixel = options->samples;
    if (options->depth != 0) scene->camera.max_depth = options->depth;
    *run = (PeerRun){.load_seconds = bp_clock_seconds() - start};
    return scene;
}

static void cross(const double a[3], const double b[3], double out[3]) {
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static void normalise(double v[3]) {
    const double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int k = 0; k < 3; k++) v[k] /= length;
}

/* The book's camera (Shirley et al., Ray Tracing in One Weekend, 4.0, 2024, section 13). */
void peer_camera(const BpScene *scene, PeerCamera *camera) {
    const BpCamera *from = &scene->camera;
    double back[3], right[3], up[3];
    for (int k = 0; k < 3; k++) back[k] = from->lookfrom[k] - from->lookat[k];
    normalise(back);
    cross(from->vup, back, right);
    normalise(right);
    cross(back, right, up);
    const double height = 2 * tan(from->vfov_degrees * PI / 360) * from->focus_dist;
    const double pixel = height / from->height;
    for (int k = 0; k < 3; k++) {
        camera->origin[k] = from->lookfrom[k];
        camera->right[k] = pixel * right[k];
        camera->down[k] = -pixel * up[k];
        camera->corner[k] = -from->focus_dist * back[k] - 0.5 * from->width * camera->right[k] -
                            0.5 * from->height * camera->down[k];
        camera->lens_right[k] = from->lens_radius * right[k];
        camera->lens_up[k] = from->lens_radius * up[k];
    }
    camera->lens = from->lens_radius > 0;
    camera->center = from->pixel_sampling == BP_PIXEL_CENTER;
}

PeerFilm peer_film(const BpScene *scene) {
    const BpCamera *camera = &scene->camera;
    const size_t count = (size_t)camera->width * camera->height * 3;
    return (PeerFilm){camera->width,
                      camera->height,
                      camera->samples_per_pixel,
                      {peer_allocate(count, sizeof(double)), peer_allocate(count, sizeof(double))}};
}

/* ---- threads over rows ---- */

typedef struct Crew {
    PeerRow *work;
    void *job;
    uint32_t rows;
    atomic_uint next_row;
    atomic_ullong rays;
} Crew;

typedef struct Hand {
    Crew *crew;
    unsigned thread;
} Hand;

static void *hand_main(void *argument) {
    const Hand *hand = argument;
    Crew *crew = hand->crew;
    uint64_t rays = 0;
    for (;;) {
        const uint32_t row = atomic_fetch_add(&crew->next_row, 1);
        if (row >= crew->rows) break;
        rays += crew->work(crew->job, hand->thread, row);
    }
    atomic_fetch_add(&crew->rays, rays);
    return NULL;
}

void peer_trace(const BpScene *scene, unsigned threads, PeerRow *work, void *job, PeerRun *run) {
    Crew crew = {.work = work, .job = job, .rows = scene->camera.height};
    Hand *hands = peer_allocate(threads, sizeof *hands);
    pthread_t *ids = peer_allocate(threads, sizeof *ids);
    const double wall = bp_clock_seconds(), cpu = bp_processor_seconds();
    for (unsigned i = 0; i < threads; i++) {
        hands[i] = (Hand){&crew, i};
        if (pthread_create(&ids[i], NULL, hand_main, &hands[i]) != 0) die("cannot start a thread");
    }
    for (unsigned i = 0; i < threads; i++) pthread_join(ids[i], NULL);
    run->seconds += bp_clock_seconds() - wall;
    run->cpu_seconds += bp_processor_seconds() - cpu;
    run->rays += atomic_load(&crew.rays);
    free(ids);
    free(hands);
}

/* ---- the report ---- */

static void write_picture(const PeerFilm *film, const char *path) {
    FILE *out = fopen(path, "wb");
    if (out == NULL) die("cannot write the picture");
    fprintf(out, "PF\n%u %u\n-1.0\n", film->width, film->height);
    for (uint32_t row = film->height; row-- > 0;) {
        for (size_t i = 0; i < (size_t)film->width * 3; i++) {
            const size_t at = (size_t)row * film->width * 3 + i;
            const float value = (float)((film->half[0][at] + film->half[1][at]) / film->samples);
            fwrite(&value, sizeof value, 1, out);
        }
    }
    if (fclose(out) != 0) die("cannot write the picture");
}

void peer_report(const char *peer, const PeerOptions *options, const BpScene *scene, const PeerFilm *film,
                 const PeerRun *run) {
    const size_t pixels = (size_t)film->width * film->height;
    const double even = (film->samples + 1) / 2, odd = film->samples / 2;
    double mean[3] = {0}, square[3] = {0};
    for (size_t i = 0; i < pixels * 3; i++) {
        const double a = film->half[0][i], b = film->half[1][i];
        mean[i % 3] += (a + b) / film->samples;
        /* E (a/even - b/odd)^2 = variance of a sample * (1/even + 1/odd) */
        const double difference = odd > 0 ? a / even - b / odd : 0;
        square[i % 3] += odd > 0 ? difference * difference / (1 / even + 1 / odd) / film->samples : 0;
    }
    const uint64_t samples = (uint64_t)pixels * film->samples;
    printf("{\"peer\": \"%s\", \"method\": \"%s\", \"width\": %u, \"height\": %u, \"samples_per_pixel\": %u, "
           "\"max_depth\": %u, \"spheres\": %zu, \"triangles\": %zu, \"threads\": %u, \"samples\": %llu, "
           "\"rays\": %llu, "
           "\"seconds\": %.6f, \"cpu_seconds\": %.6f, \"load_seconds\": %.6f, \"build_seconds\": %.6f, "
           "\"structure_bytes\": %llu, \"mean_radiance\": [%.9f, %.9f, %.9f], "
           "\"standard_error\": [%.3e, %.3e, %.3e]}\n",
           peer, options->method, film->width, film->height, film->samples, scene->camera.max_depth,
           scene->sphere_count, scene->triangle_count, options->threads, (unsigned long long)samples,
           (unsigned long long)run->rays, run->seconds, run->cpu_seconds, run->load_seconds,
           run->build_seconds, (unsigned long long)run->structure_bytes, mean[0] / (double)pixels,
           mean[1] / (double)pixels, mean[2] / (double)pixels, sqrt(square[0]) / (double)pixels,
           sqrt(square[1]) / (double)pixels, sqrt(square[2]) / (double)pixels);
    if (options->picture_path != NULL) write_picture(film, options->picture_path);
}
