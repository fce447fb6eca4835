/* effect_costs.c: see effect_costs.h. */
#include "effect_costs.h"

#include "base/clock.h"
#include "base/quantile.h"
#include "base/status.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define ROUNDS_MAX 101u

/* "Used 96 registers" of the trace kernel in NVIDIA's log; 0 if the log has none. */
static uint64_t find_registers(const char *log) {
    unsigned long long registers = 0;
    const char *at = log != NULL ? strstr(log, "'trace'") : NULL;
    if (at != NULL) at = strstr(at, "Used ");
    return at != NULL && sscanf(at, "Used %llu registers", &registers) == 1 ? registers : 0;
}

/* Waits for everything that was started. *seconds is the time that the device spent on it: for a CPU the
 * processor time of this process, which other load hardly affects; for other devices the time of their own
 * clock. */
static BpStatus finish(BpRender *render, double *seconds, BpError *err) {
    BpProgress progress = {0};
    BpRenderReport before, after;
    bp_render_report(render, &before);
    const double start = bp_processor_seconds();
    do {
        BP_TRY(bp_render_step(render, &progress, err));
    } while (!progress.finished);
    bp_render_report(render, &after);
    *seconds = after.device.type == BP_DEVICE_CPU ? bp_processor_seconds() - start
                                                  : after.device_seconds - before.device_seconds;
    return BP_OK;
}

/* The time until a kernel traces: by the wall clock, and in processor time. */
typedef struct Start {
    double wall, processor;
} Start;

/* Opens the kernel's render and traces two samples per pixel. *start is the time from opening the device to
 * the first sample: building, uploading and launching, without the scene's tree. */
static BpStatus open_render(const BpScene *scene, const BpRenderOptions *options, const BpDeviceInfo *device,
                            BpRender **render, Start *start, BpError *err) {
    BpStatus status;
    double first, second;
    BpRenderReport report;
    const double wall = bp_clock_seconds(), processor = bp_processor_seconds();
    BpRenderOptions plain = *options;
    plain.samples_only = true;
    BP_TRY(bp_render_create(scene, &plain, device, 1, render, err));
    start->wall = bp_clock_seconds() - wall;
    BP_TRY_GOTO(status, finish(*render, &first, err), failed);
    start->processor = bp_processor_seconds() - processor;
    BP_TRY_GOTO(status, bp_render_extend(*render, 2, err), failed);
    BP_TRY_GOTO(status, finish(*render, &second, err), failed);
    bp_render_report(*render, &report);
    start->wall +=
        report.first_launch_seconds - report.tree_seconds - report.pack_seconds - report.calibration_seconds;
    start->processor -= report.tree_seconds + report.pack_seconds;
    /* On a CPU, the processor time up to here includes tracing the first sample, which takes as long as the
     * second. */
    if (report.device.type == BP_DEVICE_CPU) start->processor -= second;
    return BP_OK;

failed:
    bp_render_destroy(render);
    return status;
}

/* Build times of one kernel: once with a mark that no cache has seen, then three times with the same mark. */
static BpStatus measure_builds(const BpScene *scene, const BpRenderOptions *options,
                               const BpDeviceInfo *device, BpKernelCost *kernel, BpError *err) {
    BpRenderOptions marked = *options;
    Start starts[4];
    double wall[3], processor[3];
    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now);
    marked.build_mark = (uint64_t)now.tv_sec * 1000000000u + (uint64_t)now.tv_nsec;
    for (int run = 0; run < 4; ++run) {
        BpRender *render = NULL;
        BP_TRY(open_render(scene, &marked, device, &render, &starts[run], err));
        bp_render_destroy(&render);
    }
    for (int run = 0; run < 3; ++run) {
        wall[run] = starts[run + 1].wall;
        processor[run] = starts[run + 1].processor;
    }
    bp_sort_doubles(wall, 3);
    bp_sort_doubles(processor, 3);
    kernel->cold_seconds = starts[0].wall;
    kernel->cold_processor_seconds = starts[0].processor;
    kernel->warm_seconds = wall[1];
    kernel->warm_processor_seconds = processor[1];
    return BP_OK;
}

/* The kernels to compare: specialised, one for each effect that is out, general. */
static void list_kernels(const BpScene *scene, const BpRenderOptions *options, bool general_only,
                         BpCosts *costs) {
    BpEffects effects;
    bp_effects_analyse(scene, &effects);
    const uint32_t base = effects.bits | (options->extra_effects & BP_EFFECTS_ALL);
    BpKernelCost *kernel = costs->kernels;
    *kernel = (BpKernelCost){.forced = -1, .bits = base};
    snprintf(kernel->name, sizeof kernel->name, "specialised");
    for (int e = 0; e < BP_EFFECT_COUNT; ++e) {
        if (general_only || bp_effects_has(base, (BpEffect)e)) continue;
        *++kernel = (BpKernelCost){.forced = e, .bits = base | 1u << e};
        snprintf(kernel->name, sizeof kernel->name, "with %s", bp_effect_name((BpEffect)e));
    }
    *++kernel = (BpKernelCost){.forced = -1, .bits = BP_EFFECTS_ALL};
    snprintf(kernel->name, sizeof kernel->name, "general");
    costs->kernel_count = (size_t)(kernel - costs->kernels) + 1;
    for (size_t k = 0; k < costs->kernel_count; ++k)
        costs->kernels[k].cold_seconds = costs->kernels[k].cold_processor_seconds =
            costs->kernels[k].warm_seconds = costs->kernels[k].warm_processor_seconds = NAN;
}

/* One round: every kernel traces `spp` more samples per pixel. The order turns from round to round, so that
 * none always follows the same one. */
static BpStatus run_round(BpRender **renders, size_t count, unsigned round, uint64_t samples_before,
                          uint64_t spp, double *seconds, BpError *err) {
    for (size_t i = 0; i < count; ++i) {
        const size_t k = (i + round) % count;
        BP_TRY(bp_render_extend(renders[k], samples_before + spp, err));
        BP_TRY(finish(renders[k], &seconds[k], err));
    }
    return BP_OK;
}

static void summarise(const double *seconds, unsigned rounds, size_t count, uint64_t samples,
                      BpCosts *costs) {
    double ratios[ROUNDS_MAX], rates[ROUNDS_MAX];
    for (size_t k = 0; k < count; ++k) {
        for (unsigned r = 0; r < rounds; ++r) {
            ratios[r] = seconds[r * count + k] / seconds[r * count];
            rates[r] = (double)samples / seconds[r * count + k];
        }
        bp_sort_doubles(ratios, rounds);
        bp_sort_doubles(rates, rounds);
        costs->kernels[k].ratio = bp_quantile(ratios, rounds, 0.5);
        costs->kernels[k].low = bp_quantile(ratios, rounds, 0.25);
        costs->kernels[k].high = bp_quantile(ratios, rounds, 0.75);
        costs->kernels[k].samples_per_second = bp_quantile(rates, rounds, 0.5);
    }
}

static void tell(const BpCostPlan *plan, const char *format, ...) BP_PRINTF_LIKE(2, 3);
static void tell(const BpCostPlan *plan, const char *format, ...) {
    char what[160];
    va_list arguments;
    if (plan->tell == NULL) return;
    va_start(arguments, format);
    vsnprintf(what, sizeof what, format, arguments);
    va_end(arguments);
    plan->tell(what, plan->tell_context);
}

BpStatus bp_costs_measure(const BpScene *scene, const BpRenderOptions *options, const BpDeviceInfo *device,
                          const BpCostPlan *plan, BpCosts *costs, BpError *err) {
    BpStatus status = BP_OK;
    BpRender *renders[BP_KERNELS_MAX] = {NULL};
    double *seconds = NULL;
    BpRenderOptions base = *options;
    const unsigned rounds = plan->rounds;
    if (rounds < 3 || rounds > ROUNDS_MAX)
        return bp_fail(err, BP_ERR_USAGE, "%u rounds: 3 to %u", rounds, ROUNDS_MAX);
    memset(costs, 0, sizeof *costs);
    costs->device = *device;
    costs->rounds = rounds;
    costs->width = scene->camera.width;
    costs->height = scene->camera.height;
    list_kernels(scene, options, plan->general_only, costs);
    const size_t count = costs->kernel_count;
    base.all_effects = false;
    base.samples_per_pixel = 1;
    base.first_sample = 0;
    seconds = calloc((size_t)rounds * count, sizeof *seconds);
    if (seconds == NULL) return bp_fail(err, BP_ERR_MEMORY, "no memory to measure");

    for (size_t k = 0; k < count; ++k) {
        Start ignored;
        BpRenderOptions one = base;
        BpKernelCost *kernel = &costs->kernels[k];
        one.extra_effects = kernel->bits;
        tell(plan, "building kernel %zu of %zu: %s", k + 1, count, kernel->name);
        if (plan->builds && (k == 0 || k == count - 1))
            BP_TRY_GOTO(status, measure_builds(scene, &one, device, kernel, err), done);
        BP_TRY_GOTO(status, open_render(scene, &one, device, &renders[k], &ignored, err), done);
        BpRenderReport report;
        bp_render_report(renders[k], &report);
        kernel->registers = find_registers(report.build_log);
        kernel->private_bytes = report.private_bytes;
        costs->form = report.kernel;
    }

    /* A first round settles clocks and caches, and determines the number of samples that fill a round. */
    BP_TRY_GOTO(status, run_round(renders, count, 0, 2, 1, seconds, err), done);
    double spp_wanted = plan->round_seconds / fmax(seconds[0], 1e-6);
    if (spp_wanted < 1) spp_wanted = 1;
    if (spp_wanted > 4096) spp_wanted = 4096;
    const uint64_t spp = (uint64_t)spp_wanted;
    const uint64_t pixels = (uint64_t)costs->width * costs->height;
    costs->samples = pixels * spp;
    for (unsigned r = 0; r < rounds; ++r) {
        tell(plan, "round %u of %u", r + 1, rounds);
        BP_TRY_GOTO(status, run_round(renders, count, r, 3 + r * spp, spp, seconds + r * count, err), done);
    }
    summarise(seconds, rounds, count, costs->samples, costs);

done:
    for (size_t k = 0; k < count; ++k) bp_render_destroy(&renders[k]);
    free(seconds);
    return status;
}
