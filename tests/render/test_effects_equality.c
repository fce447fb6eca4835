/* test_effects_equality.c: a kernel specialised to a set of effects computes what the general one does.
 *
 * Tried are all scenes of scenes/ and tests/agree/scenes, small, and scenes made for their sets, and a
 * covering array (effects_covering.h): whatever two or three effects do to each other, with a list or with a
 * tree, in one form of the kernel or the other, some case shows. So each set of a scene is tried in one form,
 * and the forms take turns. `both` tries scenes and cases in both forms.
 *
 * On PoCL, bit for bit: radiance, segments and cut of every single pixel sample, as the trace kernel writes
 * them. What sums them (accumulate.cl) has no effects in it (effects_source), so equal samples make equal
 * pictures. Other implementations may round differently in different programs; there the difference is
 * reported, and the pictures must agree within their error.
 *
 * Nearly all of the time is the compiler's, so nothing but the trace kernels is compiled, and the general
 * ones once; and PoCL optimises nothing: what a set leaves out is a matter of the source, and that optimised
 * kernels draw the same bits is shown by recorded pictures (test_cli_bits). With `both` it optimises
 * packets, as users have them.
 *
 * test_effects_equality [both] */
#include "effects_covering.h"
#include "render/render_plan.h"
#include "render/worker_buffers.h"

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FORMS = 2, ACCELERATIONS = 2, LAMPS = 2, WIDTH = 16, SAMPLES_MAX = 8 }; /* of real scenes */

typedef struct Lab {
    BpDevice *device;
    bool exact;                                      /* the same bits are asked for */
    bool optimised;                                  /* packets are compiled as users have them */
    BpProgram *general[FORMS][ACCELERATIONS][LAMPS]; /* each built when first needed */
    unsigned dark;                                   /* pictures without light, which would prove nothing */
    unsigned inexact;
} Lab;

typedef struct Samples {
    float *values; /* 4 each: radiance, segments (and a half where the path was cut) */
    uint32_t count;
} Samples;

static bool failed(const BpError *err, const char *what, uint32_t bits) {
    fprintf(stderr, "set 0x%02x, %s: %s\n%s\n", (unsigned)bits, what, err->message,
            err->attachment != NULL ? err->attachment : "");
    return false;
}

static BpStatus bind_chunk(BpWorker *worker, const Samples *samples, uint32_t per_pixel, BpError *err) {
    const cl_uint numbers[] = {0, 0, per_pixel, samples->count};
    cl_uint index = worker->scene_arguments;
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; ++i)
        CL_TRY(worker, clSetKernelArg(worker->trace, index++, sizeof(cl_uint), &numbers[i]),
               "clSetKernelArg");
    CL_TRY(worker, clSetKernelArg(worker->trace, index++, sizeof(cl_mem), &worker->samples),
           "clSetKernelArg");
    CL_TRY(worker, clSetKernelArg(worker->trace, index, sizeof(cl_mem), &worker->lamp_rays),
           "clSetKernelArg");
    return BP_OK;
}

/* All samples of the picture in one launch, of the size that a render would choose. */
static BpStatus launch(BpWorker *worker, BpKernelForm form, uint32_t per_pixel, Samples *samples,
                       BpError *err) {
    cl_int code = CL_SUCCESS;
    const bool packet = form == BP_KERNEL_PACKET;
    worker->form = form;
    worker->samples_per_item = packet ? BP_PACKET_SAMPLES_PER_ITEM : 1;
    const size_t local = packet ? BP_LOCAL_SIZE_PACKET : BP_LOCAL_SIZE_SAMPLE;
    const size_t items = bp_worker_items(worker, samples->count);
    const size_t global = (items + local - 1) / local * local;
    BP_TRY(bp_worker_upload_scene(worker, err));
    BP_TRY(bp_worker_reserve_samples(worker, samples->count, (uint32_t)items, err));
    worker->trace = clCreateKernel(worker->program->program, "trace", &code);
    CL_TRY(worker, code, "clCreateKernel(trace)");
    BP_TRY(bp_worker_bind_scene(worker, worker->trace, err));
    BP_TRY(bind_chunk(worker, samples, per_pixel, err));
    CL_TRY(
        worker,
        clEnqueueNDRangeKernel(worker->device->queue, worker->trace, 1, NULL, &global, &local, 0, NULL, NULL),
        "clEnqueueNDRangeKernel(trace)");
    return bp_worker_samples(worker, samples->count, samples->values, err);
}

/* What the program makes of the scene. `program` is built if NULL. */
static BpStatus trace(const Lab *lab, const BpScene *scene, const BpRenderOptions *options,
                      BpProgram **program, Samples *samples, BpError *err) {
    BpWorkerSetup setup;
    BpPacked packed = {0};
    BpStatus status = bp_render_plan(scene, options, &lab->device->info, &setup, &packed, err);
    if (status == BP_OK && *program == NULL) {
        const bool optimise = lab->optimised && setup.program.form == BP_KERNEL_PACKET;
        setenv("POCL_EXTRA_BUILD_FLAGS", optimise ? "" : "-cl-opt-disable -DSHORT_CHAINS", 1);
        status = bp_program_build(lab->device, &setup.program, NULL, NULL, program, err);
    }
    if (status != BP_OK) goto done;
    BpWorker *worker = calloc(1, sizeof *worker);
    samples->count = setup.width * setup.height * (uint32_t)options->samples_per_pixel;
    samples->values = malloc(4 * sizeof(float) * samples->count);
    if (worker == NULL || samples->values == NULL) {
        free(worker);
        status = bp_fail(err, BP_ERR_MEMORY, "no memory for %u samples", samples->count);
        goto done;
    }
    worker->device = lab->device;
    worker->program = *program;
    worker->real_size = sizeof(float);
    worker->has_lamps = true; /* the program may count rays to them */
    worker->has_triangles = bp_effects_has(setup.program.effects, BP_EFFECT_TRIANGLES);
    worker->has_normals =
        worker->has_triangles && bp_effects_has(setup.program.effects, BP_EFFECT_SMOOTH_NORMALS);
    worker->has_coordinates = worker->has_triangles &&
                              bp_effects_has(setup.program.effects, BP_EFFECT_TEXTURES) &&
                              bp_effects_has(setup.program.effects, BP_EFFECT_TEXTURE_COORDINATES);
    worker->has_capsules = bp_effects_has(setup.program.effects, BP_EFFECT_CAPSULES);
    worker->first_triangles = packed.tree.first_triangles;
    worker->normal_leaves = packed.tree.normal_leaves;
    worker->coordinate_leaves = packed.tree.coordinate_leaves;
    worker->coloured_slots = packed.coloured_slots;
    worker->width = setup.width;
    worker->pixels = setup.width * setup.height;
    worker->replicates = setup.replicates;
    worker->max_depth = setup.max_depth;
    worker->pixel_center = setup.pixel_center;
    worker->seed_low = (uint32_t)setup.seed;
    worker->seed_high = (uint32_t)(setup.seed >> 32);
    worker->first_leaves = packed.tree.first_leaves;
    worker->leaf_count = packed.tree.leaf_count;
    worker->packed = packed;
    packed = (BpPacked){0};
    worker->samples_limit = samples->count;
    status = launch(worker, setup.program.form, (uint32_t)options->samples_per_pixel, samples, err);
    worker->device = NULL; /* the lab's */
    worker->program = NULL;
    bp_worker_destroy(&worker);
done:
    bp_packed_clear(&packed);
    return status;
}

static bool is_light(const float *sample) {
    for (int c = 0; c < 3; ++c)
        if (!isfinite(sample[c]) || sample[c] < 0) return false;
    return true;
}

/* Whether the means agree within 5 of their joint standard errors, each channel. */
static bool agree(const Samples *a, const Samples *b) {
    for (uint32_t c = 0; c < 3; ++c) {
        double sum[2] = {0}, squares[2] = {0};
        for (uint32_t i = 0; i < a->count; ++i) {
            const double x = (double)a->values[4 * i + c], y = (double)b->values[4 * i + c];
            sum[0] += x, sum[1] += y;
            squares[0] += x * x, squares[1] += y * y;
        }
        const double n = a->count, mean[2] = {sum[0] / n, sum[1] / n};
        const double variance = squares[0] / n - mean[0] * mean[0] + squares[1] / n - mean[1] * mean[1];
        if (fabs(mean[0] - mean[1]) > 5 * sqrt(fmax(variance, 0) / n) + 1e-5 * fabs(mean[0])) return false;
    }
    return true;
}

static void print_set(uint32_t bits) {
    for (int e = 0; e < BP_EFFECT_COUNT; ++e)
        if (bp_effects_has(bits, (BpEffect)e)) fprintf(stderr, " %s", bp_effect_name((BpEffect)e));
    fprintf(stderr, "\n");
}

/* Samples that are the same, counted; what is no light, and a picture without any, counts as wrong. */
static bool compare(Lab *lab, uint32_t bits, const Samples *special, const Samples *general) {
    uint32_t different = 0;
    bool light = true;
    double total = 0;
    for (uint32_t i = 0; i < special->count; ++i) {
        const float *a = special->values + 4 * (size_t)i, *b = general->values + 4 * (size_t)i;
        different += memcmp(a, b, 4 * sizeof(float)) != 0;
        light = light && is_light(a) && is_light(b) && a[3] >= 1;
        total += (double)a[0] + (double)a[1] + (double)a[2];
    }
    if (total <= 0) ++lab->dark;
    if (different > 0) {
        ++lab->inexact;
        fprintf(stderr, "set 0x%02x: %u of %u samples differ:", (unsigned)bits, different, special->count);
        print_set(bits);
    }
    if (!light) fprintf(stderr, "set 0x%02x: samples that are no light\n", (unsigned)bits);
    return light && (lab->exact ? different == 0 : agree(special, general));
}

/* Whether what could be sampled as a lamp is not: an option says so, or it does not pay. */
static bool has_idle_lamps(uint32_t bits) {
    return (bits & EFFECTS_LIGHTS) != 0 && (bits & EFFECTS_LIT) != 0 &&
           !bp_effects_has(bits, BP_EFFECT_LAMPS);
}

/* True when the kernel of its own makes of the scene what the general one makes. `bits`: what it calls for;
 * `lamps_off`: although it has lamps, no rays are sent to them. */
static bool check_scene(Lab *lab, const BpScene *scene, uint32_t bits, bool tree, bool packet,
                        bool lamps_off) {
    BpError err = {0};
    BpRenderOptions options;
    BpProgram *program = NULL;
    Samples special = {0}, general = {0};
    bool right = false;
    bp_render_defaults(scene, &options);
    if (options.samples_per_pixel > SAMPLES_MAX) options.samples_per_pixel = SAMPLES_MAX;
    options.kernel = packet ? BP_KERNEL_PACKET : BP_KERNEL_SAMPLE;
    options.light_sampling = lamps_off ? BP_LIGHT_SAMPLING_OFF : BP_LIGHT_SAMPLING_ON;
    options.roulette = BP_ROULETTE_ON;
    options.seed = 20 + bits + (tree ? BP_EFFECTS_ALL + 1 : 0);
    options.sampler = packet != tree ? BP_SAMPLER_SOBOL : BP_SAMPLER_INDEPENDENT; /* both in either form */
    BpProgram **all = &lab->general[packet][tree][lamps_off];
    if (trace(lab, scene, &options, &program, &special, &err) != BP_OK) {
        failed(&err, "its own kernel", bits);
        goto done;
    }
    options.all_effects = true;
    if (trace(lab, scene, &options, all, &general, &err) != BP_OK) {
        failed(&err, "the general kernel", bits);
        goto done;
    }
    const uint32_t left_out = lamps_off ? EFFECT_BIT(LAMPS) : 0;
    if ((program->key == (*all)->key) != (bits == (BP_EFFECTS_ALL & ~left_out))) {
        fprintf(stderr, "set 0x%02x: specialised and general kernel are the same program\n", (unsigned)bits);
        goto done;
    }
    right = compare(lab, bits, &special, &general);

done:
    free(special.values);
    free(general.values);
    bp_program_destroy(&program);
    bp_error_clear(&err);
    return right;
}

/* True when the case is all right. */
static bool check_case(Lab *lab, uint32_t word) {
    const uint32_t bits = effects_case_bits(word);
    const bool tree = (word & EFFECTS_CASE_TREE) != 0, packet = (word & EFFECTS_CASE_PACKET) != 0;
    static EffectsScene made;
    BpEffects effects;
    BpError err = {0};
    effects_scene(&made, bits, tree);
    if (bp_scene_validate(&made.scene, &err) != BP_OK) return failed(&err, "scene", bits);
    bp_effects_analyse(&made.scene, &effects);
    const bool lamps_off = has_idle_lamps(bits);
    const uint32_t left_out = lamps_off ? EFFECT_BIT(LAMPS) : 0;
    if ((effects.bits & ~left_out) != bits ||
        (bp_acceleration_choose(&made.scene, NULL) == BP_ACCELERATION_TREE) != tree) {
        fprintf(stderr, "set 0x%02x: the scene made for it calls for 0x%02x, or not for a %s\n",
                (unsigned)bits, (unsigned)effects.bits, tree ? "tree" : "list");
        return false;
    }
    return check_scene(lab, &made.scene, bits, tree, packet, lamps_off);
}

/* Whether a set is tried by packets: as where it came up before, else the other form than the last one. A set
 * that is new is appended to the cases. */
static bool takes_packet(uint32_t word, uint32_t cases[COVERING_CASES_MAX], size_t *count) {
    for (size_t i = 0; i < *count; ++i)
        if ((cases[i] & ~EFFECTS_CASE_PACKET) == word) return (cases[i] & EFFECTS_CASE_PACKET) != 0;
    const bool packet = *count % 2 == 0;
    cases[(*count)++] = word | (packet ? EFFECTS_CASE_PACKET : 0);
    return packet;
}

/* Tries the scenes of a folder, and appends their sets, each in one form and once; with `both` tries them in
 * both forms. Returns how many are wrong. */
static unsigned try_scenes(Lab *lab, const char *folder, bool both, uint32_t cases[COVERING_CASES_MAX],
                           size_t *count) {
    struct dirent **entries = NULL;
    const int entry_count = scandir(folder, &entries, NULL, alphasort); /* the same turns everywhere */
    unsigned wrong = 0;
    if (entry_count < 0) {
        fprintf(stderr, "cannot read %s\n", folder);
        return 1;
    }
    for (int e = 0; e < entry_count; ++e) {
        const struct dirent *entry = entries[e];
        const char *end = strstr(entry->d_name, ".json");
        char path[512];
        BpScene *scene = NULL;
        BpError err = {0};
        BpEffects effects;
        if (end == NULL || strcmp(end, ".json") != 0 || strcmp(entry->d_name, "scene.schema.json") == 0)
            continue;
        snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
        if (bp_scene_load(path, &scene, &err) != BP_OK || bp_scene_set_width(scene, WIDTH, &err) != BP_OK) {
            failed(&err, path, 0);
            bp_scene_destroy(&scene);
            ++wrong;
            continue;
        }
        bp_effects_analyse(scene, &effects);
        const bool tree = bp_acceleration_choose(scene, NULL) == BP_ACCELERATION_TREE;
        const bool chosen = takes_packet(effects.bits | (tree ? EFFECTS_CASE_TREE : 0), cases, count);
        for (int packet = 0; packet < FORMS; ++packet)
            if ((both || packet == chosen) &&
                !check_scene(lab, scene, effects.bits, tree, packet, has_idle_lamps(effects.bits))) {
                fprintf(stderr, "%s, %s: wrong\n", entry->d_name,
                        bp_kernel_names[packet ? BP_KERNEL_PACKET : BP_KERNEL_SAMPLE]);
                ++wrong;
            }
        bp_scene_destroy(&scene);
    }
    for (int e = 0; e < entry_count; ++e) free(entries[e]);
    free(entries);
    return wrong;
}

int main(int argc, char **argv) {
    static uint32_t cases[COVERING_CASES_MAX];
    size_t count = 0;
    BpDeviceInfo device;
    BpError err = {0};
    const bool both = argc > 1 && strcmp(argv[1], "both") == 0;
    if (argc > 1 && !both) {
        fprintf(stderr, "usage: test_effects_equality [both]\n");
        return 2;
    }
    if (bp_device_find(getenv("BALLPARK_TEST_DEVICE"), &device, &err) != BP_OK) {
        fprintf(stderr, "skipped: %s\n", err.message);
        return 77;
    }
    Lab lab = {.exact = strcmp(device.platform, "Portable Computing Language") == 0, .optimised = both};
    if (bp_device_open(&device, &lab.device, &err) != BP_OK) {
        fprintf(stderr, "%s\n", err.message);
        return 1;
    }
    unsigned wrong = try_scenes(&lab, SOURCE_DIR "/scenes", both, cases, &count);
    wrong += try_scenes(&lab, SOURCE_DIR "/tests/agree/scenes", both, cases, &count);
    const size_t scenes = count;
    count = effects_covering(cases, count);
    printf("%zu cases of scenes, %zu more for all triples\n", scenes, count - scenes);
    for (size_t i = 0; i < count; ++i)
        for (uint32_t other = 0; other < (both ? FORMS : 1); ++other)
            wrong += !check_case(&lab, cases[i] ^ other * EFFECTS_CASE_PACKET);
    printf("%s: %zu cases, %u wrong, %u not bit for bit, %u without light\n", device.name, count, wrong,
           lab.inexact, lab.dark);
    for (int f = 0; f < FORMS; ++f)
        for (int a = 0; a < ACCELERATIONS; ++a)
            for (int l = 0; l < LAMPS; ++l) bp_program_destroy(&lab.general[f][a][l]);
    bp_device_close(&lab.device);
    return count > 0 && wrong == 0 && lab.dark == 0 ? 0 : 1;
}
