/* first_calls.c: several threads, each with work of its own, as the first thing that a process does with the
 * library; for test_first_calls.py.
 *
 * In:    how many threads, the work of each in turn (render, list, find, load), a file of particles, how
 * many it has.   Out: a line for each thread; exit code 0 when all are right, and all pictures the same. */
#include "ballpark.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { THREADS_MAX = 16 };

static const char document[] = "{\"camera\":{\"image_width\":16,\"samples_per_pixel\":4},"
                               "\"materials\":{\"m\":{\"type\":\"metal\",\"albedo\":[0.9,0.9,0.9]}},"
                               "\"spheres\":[{\"center\":[0,0,-1],\"radius\":0.5,\"material\":\"m\"}]}";

typedef struct Work {
    const char *kind, *file;
    size_t particles;
    pthread_barrier_t *begin;
    char said[1200]; /* "done", or what is wrong */
    double light;    /* of the picture's pixels together; 0: no picture */
} Work;

static BpStatus render(Work *work, BpError *err) {
    BpScene *scene = NULL;
    BpRender *rendering = NULL;
    BpProgress progress = {0};
    BpPicture picture = {0};
    BpStatus status = bp_scene_parse(document, strlen(document), "scene", &scene, err);
    if (status == BP_OK) status = bp_render_create(scene, NULL, NULL, 0, &rendering, err);
    while (status == BP_OK && !progress.finished) status = bp_render_step(rendering, &progress, err);
    if (status == BP_OK) status = bp_render_read(rendering, &picture, err);
    for (size_t i = 0; status == BP_OK && i < (size_t)3 * picture.width * picture.height; ++i)
        work->light += (double)picture.rgb[i];
    bp_picture_clear(&picture);
    bp_render_destroy(&rendering);
    bp_scene_destroy(&scene);
    return status;
}

static BpStatus list(Work *work, BpError *err) {
    BpDeviceInfo *devices = NULL;
    size_t count = 0;
    const BpStatus status = bp_devices_list(&devices, &count, err);
    if (status == BP_OK && (count == 0 || devices[0].name[0] == '\0' || devices[0].compute_units == 0))
        snprintf(work->said, sizeof work->said, "%zu devices", count);
    bp_free(devices);
    return status;
}

static BpStatus find(Work *work, BpError *err) {
    BpDeviceInfo device;
    const BpStatus status = bp_device_find(NULL, &device, err);
    if (status == BP_OK && device.name[0] == '\0') snprintf(work->said, sizeof work->said, "no name");
    return status;
}

static BpStatus load(Work *work, BpError *err) {
    BpScene *scene = NULL;
    BpSceneInfo info = {0};
    const BpStatus status = bp_scene_load(work->file, &scene, err);
    if (status == BP_OK) bp_scene_info(scene, &info);
    if (status == BP_OK && info.spheres != work->particles)
        snprintf(work->said, sizeof work->said, "%zu particles", info.spheres);
    bp_scene_destroy(&scene);
    return status;
}

static void *run(void *argument) {
    Work *work = argument;
    BpError err = {0};
    snprintf(work->said, sizeof work->said, "done");
    pthread_barrier_wait(work->begin);
    const BpStatus status = strcmp(work->kind, "render") == 0 ? render(work, &err)
                            : strcmp(work->kind, "list") == 0 ? list(work, &err)
                            : strcmp(work->kind, "find") == 0 ? find(work, &err)
                                                              : load(work, &err);
    if (status != BP_OK) snprintf(work->said, sizeof work->said, "%s", err.message);
    bp_error_clear(&err);
    return NULL;
}

int main(int argc, char **argv) {
    pthread_t threads[THREADS_MAX];
    Work works[THREADS_MAX] = {{0}};
    pthread_barrier_t begin;
    double light = 0;
    int wrong = 0;
    if (argc < 5) return 2;
    const size_t count = strtoul(argv[1], NULL, 10), kinds = (size_t)argc - 4;
    if (count == 0 || count > THREADS_MAX) return 2;
    pthread_barrier_init(&begin, NULL, (unsigned)count);
    for (size_t i = 0; i < count; ++i) {
        works[i] = (Work){.kind = argv[4 + i % kinds],
                          .file = argv[2],
                          .particles = strtoul(argv[3], NULL, 10),
                          .begin = &begin};
        if (pthread_create(&threads[i], NULL, run, &works[i]) != 0) return 2;
    }
    for (size_t i = 0; i < count; ++i) {
        pthread_join(threads[i], NULL);
        printf("%s: %s\n", works[i].kind, works[i].said);
        wrong |= strcmp(works[i].said, "done") != 0;
        const int is_picture = strcmp(works[i].kind, "render") == 0;
        if (is_picture && light == 0) light = works[i].light;
        if (is_picture && (!(works[i].light > 0) || works[i].light != light)) wrong = 1;
    }
    printf("light %.9g\n", light);
    pthread_barrier_destroy(&begin);
    return wrong;
}
