/* list_or_tree.c: up to how many spheres a list is as fast as a tree. Not a test: scripts/effects runs it.
 *
 * For each number of spheres it renders the same scene with a list and with a tree, in rounds of about 0.1 s
 * in turn, and prints one line of JSON: the median of tree time over list time within a round, and the range
 * of the middle half. Time as in effect_costs.h. Two families of scenes: spheres scattered in space, and
 * small ones on a large ground.
 *
 * list_or_tree [auto|sample|packet [DEVICE]] */
#include "base/clock.h"
#include "base/quantile.h"
#include "base/random.h"
#include "render/render.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ROUNDS = 15, SPHERES_MAX = 256 };

static BpRandom random_numbers;

static double uniform(void) {
    return bp_random_next(&random_numbers);
}

static void make_scene(BpScene *scene, BpSphere *spheres, BpMaterial *material, size_t count, bool ground) {
    memset(scene, 0, sizeof *scene);
    random_numbers.state = count;
    *material = (BpMaterial){.name = (char *)"grey", .albedo = {0.5, 0.5, 0.5}, .refraction_index = 1.5};
    scene->camera = (BpCamera){.width = 200,
                               .height = 112,
                               .aspect_ratio = 16.0 / 9.0,
                               .samples_per_pixel = 1,
                               .max_depth = 50,
                               .vfov_degrees = 50,
                               .lookfrom = {0, 1, 6},
                               .lookat = {0, 0, 0},
                               .vup = {0, 1, 0},
                               .focus_dist = 1};
    for (int c = 0; c < 3; ++c) scene->background_bottom[c] = scene->background_top[c] = 1;
    for (size_t i = 0; i < count; ++i) {
        spheres[i] = (BpSphere){.center = {6 * uniform() - 3, 3 * uniform() - 1.5, 6 * uniform() - 3},
                                .radius = 0.4,
                                .albedo = BP_NO_ALBEDO};
        if (ground) spheres[i].center[1] = -0.6;
    }
    if (ground) spheres[0] = (BpSphere){.center = {0, -1001, 0}, .radius = 1000, .albedo = BP_NO_ALBEDO};
    scene->materials = material;
    scene->material_count = 1;
    scene->spheres = spheres;
    scene->sphere_count = count;
}

static bool finish(BpRender *render, uint64_t samples, double *seconds, BpError *err) {
    BpProgress progress = {0};
    BpRenderReport before, after;
    if (bp_render_extend(render, samples, err) != BP_OK) return false;
    bp_render_report(render, &before);
    const double start = bp_processor_seconds();
    do {
        if (bp_render_step(render, &progress, err) != BP_OK) return false;
    } while (!progress.finished);
    bp_render_report(render, &after);
    *seconds = after.device.type == BP_DEVICE_CPU ? bp_processor_seconds() - start
                                                  : after.device_seconds - before.device_seconds;
    return true;
}

static bool measure(const BpDeviceInfo *device, BpKernelForm form, size_t count, bool ground, BpError *err) {
    static BpScene scene;
    static BpSphere spheres[SPHERES_MAX];
    static BpMaterial material;
    BpRender *list = NULL, *tree = NULL;
    BpRenderOptions options;
    double ratios[ROUNDS], list_seconds, tree_seconds;
    bool right = false;
    make_scene(&scene, spheres, &material, count, ground);
    bp_render_defaults(&scene, &options);
    options.kernel = form;
    options.force_list = true;
    if (bp_render_create(&scene, &options, device, 1, &list, err) != BP_OK) goto done;
    options.force_list = false;
    options.force_tree = true;
    if (bp_render_create(&scene, &options, device, 1, &tree, err) != BP_OK) goto done;
    /* Twice: the first launch may still compile. */
    for (uint64_t warm = 1; warm <= 2; ++warm)
        if (!finish(list, warm, &list_seconds, err) || !finish(tree, warm, &tree_seconds, err)) goto done;
    uint64_t samples = 2;
    const uint64_t spp = list_seconds > 0.1 ? 1 : (uint64_t)(0.1 / (list_seconds + 1e-6)) + 1;
    for (int round = 0; round < ROUNDS; ++round) {
        samples += spp;
        if (!finish(list, samples, &list_seconds, err) || !finish(tree, samples, &tree_seconds, err))
            goto done;
        ratios[round] = tree_seconds / list_seconds;
    }
    BpRenderReport report;
    bp_render_report(list, &report);
    bp_sort_doubles(ratios, ROUNDS);
    printf("{\"form\": \"%s\", \"family\": \"%s\", \"spheres\": %zu, \"tree_over_list\": %.4f, \"low\": "
           "%.4f, \"high\": %.4f}\n",
           report.kernel == BP_KERNEL_PACKET ? "packet" : "sample", ground ? "ground" : "scattered", count,
           ratios[ROUNDS / 2], ratios[ROUNDS / 4], ratios[ROUNDS - 1 - ROUNDS / 4]);
    fflush(stdout);
    right = true;

done:
    bp_render_destroy(&list);
    bp_render_destroy(&tree);
    return right;
}

int main(int argc, char **argv) {
    static const size_t counts[] = {1, 2, 4, 8, 12, 16, 20, 24, 32, 48, 64, 128};
    BpDeviceInfo device;
    BpError err = {0};
    BpKernelForm form = BP_KERNEL_AUTO;
    if (argc > 1 && strcmp(argv[1], "sample") == 0) form = BP_KERNEL_SAMPLE;
    if (argc > 1 && strcmp(argv[1], "packet") == 0) form = BP_KERNEL_PACKET;
    if (bp_device_find(argc > 2 ? argv[2] : NULL, &device, &err) != BP_OK) {
        fprintf(stderr, "list_or_tree: %s\n", err.message);
        return 1;
    }
    for (int ground = 0; ground < 2; ++ground)
        for (size_t i = 0; i < sizeof counts / sizeof counts[0]; ++i)
            if (!measure(&device, form, counts[i], ground != 0, &err)) {
                fprintf(stderr, "list_or_tree: %s\n", err.message);
                return 1;
            }
    return 0;
}
