/* render.c: see render.h and the rendering part of ballpark.h. */
#include "render.h"

#include "aovs.h"
#include "base/clock.h"
#include "base/status.h"
#include "calibrate.h"
#include "render_options.h"
#include "render_plan.h"
#include "render_state.h"
#include "round.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define STEP_SECONDS 0.15 /* a step starts no chunk after this */

/* Which arrangement a GPU's trial has found best; of the form BP_KERNEL_AUTO: none. `open`: the device, if it
 * is open already; NULL: it is to be opened. */
static BpCalibration calibrate(BpRender *render, const BpDeviceInfo *device, BpDevice *open) {
    BpCalibration calibration = {.form = BP_KERNEL_AUTO};
    double trial = 0;
    if (bp_calibrates(device, &render->options))
        (void)bp_calibrate(device, open, render->options.force, &calibration, &trial);
    render->calibration_seconds += trial;
    return calibration;
}

/* The devices of a render: named, or open already. */
typedef struct Opening {
    const BpDeviceInfo *devices;
    BpDevice *const *open; /* Optional. */
} Opening;

static BpStatus open_worker(BpRender *render, const Opening *opening, size_t index, BpError *err) {
    BpDevice *open = opening->open != NULL ? opening->open[index] : NULL;
    const BpDeviceInfo *device = open != NULL ? &open->info : &opening->devices[index];
    const BpCalibration calibration = calibrate(render, device, open);
    if (index == 0) render->calibration = calibration;
    BpWorkerSetup setup;
    BpPacked packed;
    BpRenderOptions options = render->options;
    char *appended = NULL;
    if (calibration.form != BP_KERNEL_AUTO) {
        options.kernel = calibration.form;
        if (options.local_size == 0) options.local_size = calibration.local_size;
    }
    const double start = bp_clock_seconds();
    BP_TRY(bp_render_plan(render->scene, &options, device, &setup, &packed, err));
    setup.samples_per_item = calibration.samples_per_item;
    render->effects.bits = setup.program.effects;
    render->acceleration = setup.program.tree ? BP_ACCELERATION_TREE : BP_ACCELERATION_LIST;
    render->tree_seconds += packed.tree.build_seconds;
    render->pack_seconds += bp_clock_seconds() - start - packed.tree.build_seconds;
    BpStatus status = BP_OK;
    setup.device = open;
    const char *extra[3]; /* behind the kernels that trace */
    size_t extras = 0;
    if (render->options.features) extra[extras++] = "entry/aovs.cl";
    if (render->has_pilot && !render->pilot_done) {
        extra[extras++] = "pilot_types.h";
        extra[extras++] = "entry/pilot.cl";
        setup.program.pilot = true;
    }
    if (extras > 0) {
        status = bp_kernel_texts(extra, extras, &appended, err);
        setup.extra_name = extra[0];
        setup.extra_text = appended;
    }
    if (status == BP_OK)
        status = bp_worker_create(device, &packed, &setup, &render->dispatch.workers[index], err);
    bp_packed_clear(&packed); /* unless the worker has taken it over */
    free(appended);
    return status;
}

/* Samples that every pixel gets before any decision, of a mean of `samples`. */
static uint64_t samples_for_all(uint64_t samples) {
    return samples < BP_ADAPTIVE_FIRST ? samples : BP_ADAPTIVE_FIRST;
}

/* The first samples go to all pixels: a list that names every one. */
static BpStatus begin_adaptive(BpRender *render, BpError *err) {
    const BpCamera *camera = &render->scene->camera;
    const uint32_t pixels = camera->width * camera->height;
    const uint64_t exact = (uint64_t)BP_REPLICATE_SAMPLES_MAX * render->options.replicates;
    const uint64_t numbers = (uint64_t)UINT32_MAX + 1 - render->options.first_sample;
    BP_TRY(bp_adaptive_create(camera->width, camera->height, exact < numbers ? exact : numbers,
                              &render->adaptive, err));
    uint32_t *list = malloc(pixels * sizeof *list);
    if (list == NULL) return bp_fail(err, BP_ERR_MEMORY, "no memory for a list of %u pixels", pixels);
    for (uint32_t i = 0; i < pixels; ++i) list[i] = i;
    const BpStatus status = bp_dispatch_set_pixels(&render->dispatch, list, pixels, err);
    free(list);
    render->dispatch.schedule.samples = samples_for_all(render->options.samples_per_pixel);
    return status;
}

/* The pilot follows from the scene, so once is enough. */
static BpStatus run_pilot(BpRender *render, BpError *err) {
    if (!render->has_pilot || render->pilot_done) return BP_OK;
    BP_TRY(bp_pilot_run(render->dispatch.workers[0], render->scene, &render->aim, render->options.max_depth,
                        &render->options.caustics, &render->unseen, &render->pilot, err));
    render->pilot_done = true;
    bp_pilot_aim_clear(&render->aim);
    return BP_OK;
}

/* Of BP_CAUSTICS_AUTO makes one of the others, by a pilot on the first device, whose kernels do without rays
 * through focusers. Each rank does it for itself and comes to the same. */
static BpStatus choose_caustics(BpRender *render, const Opening *opening, BpError *err) {
    if (render->options.caustics != BP_CAUSTICS_AUTO) return BP_OK;
    render->options.caustics = BP_CAUSTICS_OFF;
    if (!render->has_pilot) return BP_OK;
    BP_TRY(open_worker(render, opening, 0, err));
    render->options.caustics = BP_CAUSTICS_AUTO;
    BP_TRY(run_pilot(render, err));
    if (render->options.caustics == BP_CAUSTICS_ON) bp_worker_destroy(&render->dispatch.workers[0]);
    return BP_OK;
}

/* `open`: NULL, or the devices, open already. */
static BpStatus create(const BpScene *scene, const BpRenderOptions *options, const BpDeviceInfo *devices,
                       BpDevice *const *open, size_t device_count, BpRender **render, BpError *err) {
    BpRenderOptions defaults;
    bp_render_defaults(scene, &defaults);
    if (options == NULL) options = &defaults;
    BP_TRY(bp_render_options_check(scene, options, err));
    BpDeviceInfo chosen;
    if (device_count == 0) {
        BP_TRY(bp_device_find(NULL, &chosen, err));
        devices = &chosen;
        device_count = 1;
    }
    BpStatus status = BP_OK;
    BpRender *made = calloc(1, sizeof *made);
    if (made == NULL) return bp_fail(err, BP_ERR_MEMORY, "no memory for a render");
    BP_TRY_GOTO(status, bp_dispatch_init(&made->dispatch, device_count, options->chunk_samples, err), failed);
    made->scene = scene;
    made->options = *options;
    if (made->options.replicates == 0) made->options.replicates = BP_REPLICATES_DEFAULT;
    bp_effects_analyse(scene, &made->effects);
    made->options.light_sampling = bp_render_light_sampling_of(&made->effects, options);
    made->options.caustics = bp_render_caustics_of(&made->effects, options);
    made->options.roulette = bp_render_roulette_of(&made->effects, options);
    /* Where nothing is matte, no rays are sent to lights, and all of them are found by chance. */
    if (options->light_sampling == BP_LIGHT_SAMPLING_ON && !options->samples_only) {
        BP_TRY_GOTO(status, bp_pilot_aim(scene, &made->aim, err), failed);
        made->has_pilot = bp_pilot_is_needed(scene, &made->aim);
        if (!made->has_pilot) bp_pilot_aim_clear(&made->aim);
    }
    const Opening opening = {.devices = devices, .open = open};
    BP_TRY_GOTO(status, choose_caustics(made, &opening, err), failed);
    for (size_t i = 0; i < device_count; ++i)
        if (made->dispatch.workers[i] == NULL)
            BP_TRY_GOTO(status, open_worker(made, &opening, i, err), failed);
    const uint32_t pixels = scene->camera.width * scene->camera.height;
    bp_schedule_init(&made->dispatch.schedule, pixels, options->first_sample, options->samples_per_pixel);
    if (options->adaptive) BP_TRY_GOTO(status, begin_adaptive(made, err), failed);
    made->samples_total = (uint64_t)pixels * options->samples_per_pixel;
    *render = made;
    return BP_OK;

failed:
    bp_render_destroy(&made);
    return status;
}

BpStatus bp_render_create(const BpScene *scene, const BpRenderOptions *options, const BpDeviceInfo *devices,
                          size_t device_count, BpRender **render, BpError *err) {
    return create(scene, options, devices, NULL, device_count, render, err);
}

BpStatus bp_render_create_on(const BpScene *scene, const BpRenderOptions *options, BpDevice *const *devices,
                             size_t device_count, BpRender **render, BpError *err) {
    return create(scene, options, NULL, devices, device_count, render, err);
}

BpStatus bp_render_choose_caustics(const BpScene *scene, BpRenderOptions *options, const BpDeviceInfo *device,
                                   BpError *err) {
    if (bp_render_caustics(scene, options) == BP_CAUSTICS_AUTO) {
        BpRender *render = NULL;
        BP_TRY(bp_render_create(scene, options, device, 1, &render, err));
        options->caustics = render->options.caustics;
        bp_render_destroy(&render);
    } else if (options->caustics == BP_CAUSTICS_AUTO) {
        options->caustics = BP_CAUSTICS_OFF;
    }
    return BP_OK;
}

void bp_render_destroy(BpRender **render) {
    if (render == NULL || *render == NULL) return;
    bp_dispatch_clear(&(*render)->dispatch);
    bp_film_destroy(&(*render)->film);
    bp_film_destroy(&(*render)->base);
    bp_picture_clear(&(*render)->aovs);
    bp_pilot_aim_clear(&(*render)->aim);
    bp_unseen_destroy(&(*render)->unseen);
    bp_adaptive_destroy(&(*render)->adaptive);
    free(*render);
    *render = NULL;
}

void bp_render_join(BpRender *render, BpComm *comm) {
    render->comm = comm;
}

uint64_t bp_render_pixel_samples(const BpRender *render) {
    uint64_t done = render->base_samples;
    if (render->comm != NULL) return done + render->round.pixel_samples;
    return done + bp_dispatch_samples_done(&render->dispatch);
}

BpStatus bp_render_begin_pass(BpRender *render, const BpAdaptivePass *pass, BpError *err) {
    BP_TRY(bp_dispatch_set_pixels(&render->dispatch, pass->pixels, pass->pixel_count, err));
    bp_schedule_init(&render->dispatch.schedule, pass->pixel_count,
                     render->options.first_sample + pass->first, pass->count);
    render->dispatch.schedule.before = pass->first;
    return BP_OK;
}

/* Adaptive sampling, when a pass has been handed out whole: waits for it and schedules the next, if there is
 * one. */
static BpStatus begin_next_pass(BpRender *render, BpError *err) {
    if (render->adaptive == NULL || render->options.samples_per_pixel < BP_ADAPTIVE_FIRST) return BP_OK;
    const BpFilm *film = NULL;
    BpAdaptivePass pass;
    bool begun = false;
    bp_film_destroy(&render->film); /* what was read before the latest chunks */
    BP_TRY(bp_render_read_film(render, &film, err));
    render->decides = true;
    if (bp_comm_is_root(render->comm))
        BP_TRY(
            bp_adaptive_next(render->adaptive, film, render->options.samples_per_pixel, &begun, &pass, err));
    BP_TRY(bp_round_share_pass(render, &begun, &pass, err));
    bp_film_destroy(&render->film);
    return begun ? bp_render_begin_pass(render, &pass, err) : BP_OK;
}

/* Whether there is something left to hand out, after a decision of adaptive sampling where that is due. */
static BpStatus find_more(BpRender *render, bool *more, BpError *err) {
    if (!bp_schedule_has_more(&render->dispatch.schedule)) BP_TRY(begin_next_pass(render, err));
    *more = bp_schedule_has_more(&render->dispatch.schedule);
    return BP_OK;
}

/* Starts one chunk; *started is false when all has been handed out. */
static BpStatus start_chunk(BpRender *render, bool *started, BpError *err) {
    BpDispatch *dispatch = &render->dispatch;
    BpWorker *worker = NULL;
    BP_TRY(bp_dispatch_free_worker(dispatch, &worker, err));
    BP_TRY(find_more(render, started, err));
    if (!*started) return BP_OK;
    bp_dispatch_take(dispatch, bp_dispatch_chunk_samples(dispatch, worker), &render->last_chunk);
    return bp_worker_start(worker, &render->last_chunk, err);
}

static void report_progress(const BpRender *render, bool finished, BpProgress *progress) {
    if (progress == NULL) return;
    progress->samples_done = bp_render_pixel_samples(render);
    progress->samples_total = render->samples_total;
    progress->trace_seconds = render->trace_seconds;
    progress->finished = finished;
}

/* Starts chunks until so much time has passed, one at least. */
static BpStatus step(BpRender *render, double seconds, BpProgress *progress, BpError *err) {
    /* Before the first sample, so that what can fail does so before there is something to lose. */
    if (render->options.samples_per_pixel > 1 && bp_comm_is_root(render->comm))
        BP_TRY(run_pilot(render, err));
    const double start = bp_clock_seconds();
    bp_film_destroy(&render->film);
    bool more = true;
    if (render->comm != NULL) {
        BP_TRY(find_more(render, &more, err));
        if (more) BP_TRY(bp_round_trace(render, err));
    } else {
        do {
            BP_TRY(start_chunk(render, &more, err));
        } while (more && bp_clock_seconds() - start < seconds);
    }
    if (!more) BP_TRY(bp_dispatch_wait(&render->dispatch, err));
    render->trace_seconds += bp_clock_seconds() - start;
    report_progress(render, !more, progress);
    return BP_OK;
}

BpStatus bp_render_step(BpRender *render, BpProgress *progress, BpError *err) {
    return step(render, STEP_SECONDS, progress, err);
}

BpStatus bp_render_step_chunk(BpRender *render, BpProgress *progress, BpError *err) {
    return step(render, 0, progress, err);
}

BpStatus bp_render_step_samples(BpRender *render, BpSampleBlock *block, bool *finished, BpError *err) {
    bp_film_destroy(&render->film);
    memset(block, 0, sizeof *block);
    if (render->adaptive != NULL)
        return bp_fail(err, BP_ERR_USAGE, "an adaptive render cannot return single samples");
    bool started = false;
    BP_TRY(start_chunk(render, &started, err));
    *finished = !started;
    if (!started) return BP_OK;
    const BpChunk *chunk = &render->last_chunk;
    const uint32_t count = chunk->pixel_count * chunk->samples;
    float *values = malloc((size_t)count * 4 * sizeof *values);
    if (values == NULL) return bp_fail(err, BP_ERR_MEMORY, "no memory for %u samples", count);
    const BpStatus status = bp_worker_samples(render->dispatch.workers[0], count, values, err);
    if (status != BP_OK) {
        free(values);
        return status;
    }
    for (uint32_t i = 0; i < count; ++i) { /* whether the camera ray met anything stands with the segments */
        float *const segments = &values[4 * (size_t)i + 3];
        if (*segments >= MISSED_MARK) *segments -= MISSED_MARK;
    }
    *block = (BpSampleBlock){.first_pixel = chunk->first_pixel,
                             .pixel_count = chunk->pixel_count,
                             .first_sample = chunk->first_sample,
                             .samples = chunk->samples,
                             .values = values};
    return BP_OK;
}

void bp_sample_block_clear(BpSampleBlock *block) {
    free(block->values);
    memset(block, 0, sizeof *block);
}

bool bp_render_has_begun(const BpRender *render) {
    return render->decides || render->dispatch.schedule.done > 0 ||
           render->dispatch.schedule.pass_samples > 0;
}

BpStatus bp_render_check_samples(const BpRender *render, uint64_t samples_per_pixel, BpError *err) {
    BpRenderOptions wanted = render->options;
    wanted.samples_per_pixel = samples_per_pixel;
    return bp_render_options_check(render->scene, &wanted, err);
}

/* The least that the render can still end with. */
static uint64_t samples_least(const BpRender *render) {
    if (!bp_render_has_begun(render)) return 1;
    if (render->adaptive != NULL) return render->options.samples_per_pixel;
    return render->dispatch.schedule.done + render->dispatch.schedule.pass_samples;
}

BpStatus bp_render_extend(BpRender *render, uint64_t samples_per_pixel, BpError *err) {
    BP_TRY(bp_render_check_samples(render, samples_per_pixel, err));
    if (samples_per_pixel < samples_least(render))
        return bp_fail(err, BP_ERR_USAGE, "a render of %llu samples cannot be extended to %llu",
                       (unsigned long long)samples_least(render), (unsigned long long)samples_per_pixel);
    render->options.samples_per_pixel = samples_per_pixel;
    if (render->adaptive == NULL)
        render->dispatch.schedule.samples = samples_per_pixel;
    else if (!render->decides)
        render->dispatch.schedule.samples = samples_for_all(samples_per_pixel);
    render->samples_total =
        (uint64_t)render->scene->camera.width * render->scene->camera.height * samples_per_pixel;
    return BP_OK;
}

/* ---- what has been reached ---------------------------------------------------------------------------- */

uint64_t bp_render_samples_done(const BpRender *render) {
    if (!render->decides) return render->dispatch.schedule.done;
    const double pixels = (double)render->scene->camera.width * render->scene->camera.height;
    return (uint64_t)llround((double)bp_adaptive_samples(render->adaptive) / pixels);
}

BpStatus bp_render_describe(const BpRender *render, BpFilm *film, BpError *err) {
    const BpRenderOptions *options = &render->options;
    film->scale_log2 = bp_film_scale(render->scene, options->max_depth, options->light_sampling,
                                     options->caustics, options->roulette);
    film->scene_hash = bp_scene_hash(render->scene);
    film->seed = options->seed;
    film->max_depth = options->max_depth;
#define SETTING(type, member, option, plural) film->member = options->member;
    BP_SETTING_LIST(SETTING)
#undef SETTING
    film->transfer = render->scene->transfer;
    film->job = (struct BpSampleRange){options->job_first, options->job_samples};
    if (render->scene->title != NULL) BP_TRY(bp_copy_text(render->scene->title, &film->title, err));
    /* A pass in progress counts as begun: its samples are taken, though not yet by every pixel. */
    uint64_t begun = render->dispatch.schedule.done + render->dispatch.schedule.pass_samples;
    film->partial = render->dispatch.schedule.pass_samples > 0;
    if (render->decides) {
        const uint64_t pixels = (uint64_t)film->width * film->height;
        begun = bp_adaptive_samples_max(render->adaptive);
        film->partial = bp_adaptive_samples(render->adaptive) != pixels * begun;
    }
    if (begun > 0) BP_TRY(bp_film_add_range(film, options->first_sample, begun, err));
    return BP_OK;
}

/* What a resumed render began with. */
static BpStatus add_base(const BpFilm *base, BpFilm *film, BpError *err) {
    const size_t pixels = (size_t)film->width * film->height;
    BP_TRY(bp_film_add_sums(film, base, err));
    if (film->pixel_segments != NULL && base->pixel_segments != NULL)
        for (size_t i = 0; i < pixels; ++i) film->pixel_segments[i] += base->pixel_segments[i];
    return BP_OK;
}

BpStatus bp_render_unseen(BpRender *render, BpUnseenLight *light, BpError *err) {
    BP_TRY(run_pilot(render, err));
    *light = render->pilot;
    return BP_OK;
}

/* Of several ranks, one needs it; and a film of which no error is known needs none. */
static BpStatus add_unseen(BpRender *render, BpFilm *film, BpError *err) {
    if (!bp_comm_is_root(render->comm) || bp_film_range_total(film) < 2) return BP_OK;
    BP_TRY(run_pilot(render, err));
    if (render->unseen == NULL) return BP_OK;
    return bp_unseen_copy(render->unseen, (size_t)film->width * film->height, &film->unseen, err);
}

/* What the devices of this process have added up, in a film that says what the render is. */
static BpStatus read_own(BpRender *render, BpFilm **film, BpError *err) {
    BpFilm *read = NULL;
    BpStatus status = bp_film_create(render->scene->camera.width, render->scene->camera.height,
                                     render->options.replicates, &read, err);
    if (status == BP_OK) status = bp_render_describe(render, read, err);
    if (status == BP_OK && render->adaptive != NULL) {
        const size_t pixels = (size_t)read->width * read->height;
        read->pixel_segments = calloc(pixels, sizeof *read->pixel_segments);
        if (read->pixel_segments == NULL)
            status = bp_fail(err, BP_ERR_MEMORY, "no memory for the path lengths of %zu pixels", pixels);
    }
    if (status == BP_OK && render->scene->backdrop == BP_BACKDROP_NONE) status = bp_film_add_met(read, err);
    for (size_t i = 0; status == BP_OK && i < render->dispatch.worker_count; ++i)
        status = bp_worker_collect(render->dispatch.workers[i], read, err);
    if (status == BP_OK) status = add_unseen(render, read, err);
    if (status == BP_OK)
        *film = read;
    else
        bp_film_destroy(&read);
    return status;
}

BpStatus bp_render_read_own_film(BpRender *render, BpFilm **film, uint64_t *pixel_samples, BpError *err) {
    BP_TRY(read_own(render, film, err));
    *pixel_samples = bp_dispatch_samples_done(&render->dispatch);
    return BP_OK;
}

BpStatus bp_render_read_film(BpRender *render, const BpFilm **film, BpError *err) {
    if (render->film == NULL) {
        BpFilm *read = NULL;
        BP_TRY(read_own(render, &read, err));
        BpStatus status = render->base != NULL ? add_base(render->base, read, err) : BP_OK;
        if (status == BP_OK) status = bp_round_add_films(render->comm, read, err);
        if (status != BP_OK) {
            bp_film_destroy(&read);
            return status;
        }
        render->film = read;
    }
    *film = render->film;
    return BP_OK;
}

BpStatus bp_render_read(BpRender *render, BpPicture *picture, BpError *err) {
    const BpFilm *film = NULL;
    BP_TRY(bp_render_read_film(render, &film, err));
    return bp_film_picture(film, picture, err);
}

BpStatus bp_render_aovs(BpRender *render, BpPicture *picture, BpError *err) {
    const BpRenderOptions *options = &render->options;
    if (!options->features)
        return bp_fail(err, BP_ERR_USAGE,
                       "depth, normals and albedo: the render was created without them (options.features)");
    const BpCamera *camera = &render->scene->camera;
    if (picture->width != camera->width || picture->height != camera->height)
        return bp_fail(err, BP_ERR_USAGE,
                       "depth, normals and albedo of %" PRIu32 " x %" PRIu32
                       " pixels for a picture of %" PRIu32 " x %" PRIu32 ": read the picture first",
                       camera->width, camera->height, picture->width, picture->height);
    return bp_aovs_fill(render->dispatch.workers[0], render->scene, picture, err);
}

void bp_render_report(const BpRender *render, BpRenderReport *report) {
    memset(report, 0, sizeof *report);
    const BpWorker *first = render->dispatch.workers[0];
    report->device = first->device->info;
    report->effects = render->effects;
    report->acceleration = render->acceleration;
    report->calibration = render->calibration;
    report->calibration_seconds = render->calibration_seconds;
    report->self_test_seconds = first->self_test_seconds;
    report->kernel = first->form;
#define SETTING(type, member, option, plural) report->member = render->options.member;
    BP_SETTING_LIST(SETTING)
#undef SETTING
    report->program_key = first->program->key;
    report->build_log = first->program->log;
    cl_ulong private_bytes = 0;
    if (clGetKernelWorkGroupInfo(first->trace, first->device->id, CL_KERNEL_PRIVATE_MEM_SIZE,
                                 sizeof private_bytes, &private_bytes, NULL) == CL_SUCCESS)
        report->private_bytes = private_bytes;
    report->tree_seconds = render->tree_seconds;
    report->pack_seconds = render->pack_seconds;
    report->trace_seconds = render->trace_seconds - first->first_launch_seconds;
    report->first_launch_seconds = first->first_launch_seconds;
    for (size_t i = 0; i < render->dispatch.worker_count; ++i) {
        const BpWorker *worker = render->dispatch.workers[i];
        report->kernel_build_seconds += worker->program->build_seconds;
        report->device_seconds += worker->device_seconds;
        report->accumulate_seconds += worker->accumulate_seconds;
        report->scene_bytes += worker->scene_bytes;
        report->device_bytes += worker->scene_bytes + worker->picture_bytes +
                                (uint64_t)worker->samples_capacity * 4 * worker->real_size;
    }
    report->samples = bp_render_pixel_samples(render);
    report->resumed_samples = render->base_samples;
    if (render->film != NULL) {
        report->segments = render->film->segments;
        report->truncated_paths = render->film->truncated_paths;
        report->invalid_samples = render->film->invalid_samples;
#define GIVE(member, tally, words) report->member = render->film->member;
        BP_INVALID_LIST(GIVE)
#undef GIVE
        report->shadow_rays = render->film->shadow_rays;
    }
}

/* What another render needs to go on from here. If everything that was asked for is there, the film alone is
 * enough. */
static BpStatus add_plan(const BpRender *render, BpFilm *film, BpError *err) {
    const BpSchedule *schedule = &render->dispatch.schedule;
    const bool whole = schedule->pass_samples == 0 && schedule->done == schedule->samples;
    if (film->plan != NULL || (whole && render->adaptive == NULL)) return BP_OK;
    film->plan = calloc(1, sizeof *film->plan);
    if (film->plan == NULL) return bp_fail(err, BP_ERR_MEMORY, "no memory for the plan of a render");
    *film->plan = (BpFilmPlan){.adaptive = render->adaptive != NULL,
                               .first_sample = render->options.first_sample,
                               .target = render->options.samples_per_pixel,
                               .done = schedule->done,
                               .pass_samples = schedule->pass_samples,
                               .next_pixel = schedule->pass_samples > 0 ? schedule->next_pixel : 0,
                               .samples_max = render->goal_samples,
                               .error = render->goal_error,
                               .ended = render->ended};
    if (!render->decides) return BP_OK;
    return bp_adaptive_save(render->adaptive, &film->plan->decisions, &film->plan->decision_bytes, err);
}

/* They depend on no sample of the render, so once is enough. */
static BpStatus fill_aovs(BpRender *render, BpError *err) {
    if (render->aovs.depth != NULL) return BP_OK;
    render->aovs.width = render->scene->camera.width;
    render->aovs.height = render->scene->camera.height;
    return bp_aovs_fill(render->dispatch.workers[0], render->scene, &render->aovs, err);
}

BpStatus bp_render_read_whole_film(BpRender *render, const BpFilm **film, BpError *err) {
    BP_TRY(bp_render_read_film(render, film, err));
    if (!bp_comm_is_root(render->comm)) return BP_OK; /* the others' films are not complete */
    BP_TRY(add_plan(render, render->film, err));
    if (!render->options.features) return BP_OK;
    BP_TRY(fill_aovs(render, err));
    return bp_film_take_aovs(render->film, &render->aovs, err);
}

BpStatus bp_render_film(BpRender *render, BpFilm **film, BpError *err) {
    const BpFilm *read = NULL;
    BP_TRY(bp_render_read_whole_film(render, &read, err));
    *film = render->film;
    render->film = NULL; /* the render reads its sums anew when it is asked again */
    return BP_OK;
}
