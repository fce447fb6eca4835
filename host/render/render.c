/* render.c: see render.h and the rendering part of ballpark.h. */
#include "render.h"

#include "aovs.h"
#include "base/clock.h"
#include "base/status.h"
#include "calibrate.h"
#include "render_plan.h"
#include "render_state.h"
#include "round.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define CHUNK_SECONDS 0.1 /* per dispatch: below the limit of every watchdog, long against its overhead */
#define STEP_SECONDS 0.15 /* a step starts no chunk after this */

void bp_render_defaults(const BpScene *scene, BpRenderOptions *options) {
    memset(options, 0, sizeof *options);
    options->samples_per_pixel = scene->camera.samples_per_pixel;
    options->max_depth = scene->camera.max_depth;
}

static BpStatus check_options(const BpScene *scene, const BpRenderOptions *options, BpError *err) {
    if (options->samples_per_pixel < 1 || options->first_sample > UINT32_MAX ||
        options->samples_per_pixel > (uint64_t)UINT32_MAX + 1 - options->first_sample)
        return bp_fail(err, BP_ERR_USAGE, "samples %llu to %llu: sample numbers go from 0 to 4294967295",
                       (unsigned long long)options->first_sample,
                       (unsigned long long)(options->first_sample + options->samples_per_pixel - 1));
    if (options->max_depth > BP_DEPTH_MAX)
        return bp_fail(err, BP_ERR_USAGE, "depth %u: at most %u", options->max_depth, BP_DEPTH_MAX);
    if (options->replicates > BP_REPLICATES_MAX)
        return bp_fail(err, BP_ERR_USAGE, "%u replicates: at most %u", options->replicates,
                       BP_REPLICATES_MAX);
    const uint32_t replicates = options->replicates != 0 ? options->replicates : BP_REPLICATES_DEFAULT;
    if (options->samples_per_pixel > (uint64_t)BP_REPLICATE_SAMPLES_MAX * replicates)
        return bp_fail(
            err, BP_ERR_LIMIT,
            "%llu samples per pixel: the sums of %u replicates hold %llu; render in parts and merge them",
            (unsigned long long)options->samples_per_pixel, replicates,
            (unsigned long long)BP_REPLICATE_SAMPLES_MAX * replicates);
    const uint64_t pixels = (uint64_t)scene->camera.width * scene->camera.height;
    if (pixels > UINT32_MAX / 4)
        return bp_fail(err, BP_ERR_LIMIT,
                       "a picture of %u x %u has %llu pixels; at most %u: use a smaller --width",
                       scene->camera.width, scene->camera.height, (unsigned long long)pixels, UINT32_MAX / 4);
    if (options->tree_width != 0 && options->tree_width != 2 && options->tree_width != 4 &&
        options->tree_width != 8 && options->tree_width != 16)
        return bp_fail(err, BP_ERR_USAGE, "tree width %u: 2, 4, 8 or 16", options->tree_width);
    if (options->packet_lanes != 0 && options->packet_lanes != 8 && options->packet_lanes != 16)
        return bp_fail(err, BP_ERR_USAGE, "packet lanes %u: 8 or 16", options->packet_lanes);
    return BP_OK;
}

/* `open`: the device, if it is open already; NULL: it is to be opened. */
static BpStatus open_worker(BpRender *render, const BpDeviceInfo *device, BpDevice *open, size_t index,
                            BpError *err) {
    BpWorkerSetup setup;
    BpPacked packed;
    BpRenderOptions options = render->options;
    BpCalibration calibration = {.form = BP_KERNEL_AUTO};
    char *appended = NULL;
    double trial = 0;
    if (bp_calibrates(device, &options) && bp_calibrate(device, open, options.force, &calibration, &trial)) {
        options.kernel = calibration.form;
        if (options.local_size == 0) options.local_size = calibration.local_size;
    }
    if (index == 0) render->calibration = calibration;
    render->calibration_seconds += trial;
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
    if (render->has_pilot) {
        extra[extras++] = "pilot_types.h";
        extra[extras++] = "entry/pilot.cl";
    }
    if (extras > 0) {
        status = bp_kernel_texts(extra, extras, &appended, err);
        setup.extra_name = extra[0];
        setup.extra_text = appended;
    }
    if (status == BP_OK) status = bp_worker_create(device, &packed, &setup, &render->workers[index], err);
    bp_packed_clear(&packed); /* unless the worker has taken it over */
    free(appended);
    return status;
}

/* Samples that every pixel gets before any decision, of a mean of `samples`. */
static uint64_t samples_for_all(uint64_t samples) {
    return samples < BP_ADAPTIVE_FIRST ? samples : BP_ADAPTIVE_FIRST;
}

BpStatus bp_render_create_adaptive(BpRender *render, BpError *err) {
    const BpCamera *camera = &render->scene->camera;
    const uint64_t exact = (uint64_t)BP_REPLICATE_SAMPLES_MAX * render->options.replicates;
    const uint64_t numbers = (uint64_t)UINT32_MAX + 1 - render->options.first_sample;
    return bp_adaptive_create(camera->width, camera->height, exact < numbers ? exact : numbers,
                              &render->adaptive, err);
}

/* The first samples go to all pixels: a list that names every one. */
static BpStatus begin_adaptive(BpRender *render, BpError *err) {
    const uint32_t pixels = render->scene->camera.width * render->scene->camera.height;
    BP_TRY(bp_render_create_adaptive(render, err));
    uint32_t *list = malloc(pixels * sizeof *list);
    if (list == NULL) return bp_fail(err, BP_ERR_MEMORY, "no memory for a list of %u pixels", pixels);
    for (uint32_t i = 0; i < pixels; ++i) list[i] = i;
    BpStatus status = BP_OK;
    for (size_t i = 0; i < render->worker_count && status == BP_OK; ++i)
        status = bp_worker_set_pixels(render->workers[i], list, pixels, err);
    free(list);
    render->schedule.samples = samples_for_all(render->options.samples_per_pixel);
    return status;
}

/* `open`: NULL, or the devices, open already. */
static BpStatus create(const BpScene *scene, const BpRenderOptions *options, const BpDeviceInfo *devices,
                       BpDevice *const *open, size_t device_count, BpRender **render, BpError *err) {
    BpRenderOptions defaults;
    bp_render_defaults(scene, &defaults);
    if (options == NULL) options = &defaults;
    BP_TRY(check_options(scene, options, err));
    BpDeviceInfo chosen;
    if (device_count == 0) {
        BP_TRY(bp_device_find(NULL, &chosen, err));
        devices = &chosen;
        device_count = 1;
    }
    BpStatus status = BP_OK;
    BpRender *made = calloc(1, sizeof *made);
    if (made != NULL) made->workers = calloc(device_count, sizeof(BpWorker *));
    if (made == NULL || made->workers == NULL) {
        status = bp_fail(err, BP_ERR_MEMORY, "no memory for a render");
        goto failed;
    }
    made->scene = scene;
    made->options = *options;
    if (made->options.replicates == 0) made->options.replicates = BP_REPLICATES_DEFAULT;
    made->worker_count = device_count;
    bp_effects_analyse(scene, &made->effects);
    made->options.light_sampling = bp_render_light_sampling_of(&made->effects, options);
    made->options.caustics = bp_render_caustics_of(&made->effects, options);
    if (made->options.light_sampling == BP_LIGHT_SAMPLING_ON && !options->samples_only) {
        BP_TRY_GOTO(status, bp_pilot_aim(scene, &made->aim, err), failed);
        made->has_pilot = bp_pilot_is_needed(scene, &made->aim);
        if (!made->has_pilot) bp_pilot_aim_clear(&made->aim);
    }
    for (size_t i = 0; i < device_count; ++i)
        BP_TRY_GOTO(status,
                    open_worker(made, open != NULL ? &open[i]->info : &devices[i],
                                open != NULL ? open[i] : NULL, i, err),
                    failed);
    const uint32_t pixels = scene->camera.width * scene->camera.height;
    bp_schedule_init(&made->schedule, pixels, options->first_sample, options->samples_per_pixel);
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

void bp_render_destroy(BpRender **render) {
    if (render == NULL || *render == NULL) return;
    for (size_t i = 0; (*render)->workers != NULL && i < (*render)->worker_count; ++i)
        bp_worker_destroy(&(*render)->workers[i]);
    free((*render)->workers);
    bp_film_destroy(&(*render)->film);
    bp_film_destroy(&(*render)->base);
    bp_picture_clear(&(*render)->aovs);
    bp_pilot_aim_clear(&(*render)->aim);
    bp_unseen_destroy(&(*render)->unseen);
    bp_adaptive_destroy(&(*render)->adaptive);
    free(*render);
    *render = NULL;
}

/* A worker with room for a chunk. When all are full, the one whose oldest chunk is done first: devices differ
 * in speed, and waiting for a slow one would keep a fast one idle. */
BpStatus bp_render_free_worker(const BpRender *render, BpWorker **found, BpError *err) {
    BpWorker *best = render->workers[0];
    for (size_t i = 1; i < render->worker_count; ++i)
        if (render->workers[i]->flight_count < best->flight_count) best = render->workers[i];
    const struct timespec pause = {.tv_nsec = 200000};
    while (render->worker_count > 1 && best->flight_count == BP_WORKER_FLIGHT) {
        for (size_t i = 0; i < render->worker_count && best->flight_count == BP_WORKER_FLIGHT; ++i) {
            BpWorker *worker = render->workers[i];
            bool done = false;
            BP_TRY(bp_worker_oldest_done(worker, &done, err));
            if (!done) continue;
            BP_TRY(bp_worker_wait(worker, err));
            best = worker;
        }
        if (best->flight_count == BP_WORKER_FLIGHT) nanosleep(&pause, NULL);
    }
    *found = best;
    return bp_worker_make_room(best, err);
}

void bp_render_join(BpRender *render, BpComm *comm) {
    render->comm = comm;
}

uint64_t bp_render_pixel_samples(const BpRender *render) {
    uint64_t done = render->base_samples;
    if (render->comm != NULL) return done + render->round.pixel_samples;
    for (size_t i = 0; i < render->worker_count; ++i) done += render->workers[i]->samples_done;
    return done;
}

static bool in_flight(const BpRender *render) {
    for (size_t i = 0; i < render->worker_count; ++i)
        if (render->workers[i]->flight_count > 0) return true;
    return false;
}

BpStatus bp_render_begin_pass(BpRender *render, const BpAdaptivePass *pass, BpError *err) {
    for (size_t i = 0; i < render->worker_count; ++i)
        BP_TRY(bp_worker_set_pixels(render->workers[i], pass->pixels, pass->pixel_count, err));
    bp_schedule_init(&render->schedule, pass->pixel_count, render->options.first_sample + pass->first,
                     pass->count);
    render->schedule.before = pass->first;
    return BP_OK;
}

/* Adaptive sampling, when a pass has been handed out whole: waits for it and schedules the next, if there is
 * one. */
static BpStatus begin_next_pass(BpRender *render, bool *begun, BpError *err) {
    *begun = false;
    if (render->adaptive == NULL || render->options.samples_per_pixel < BP_ADAPTIVE_FIRST) return BP_OK;
    const BpFilm *film = NULL;
    BpAdaptivePass pass;
    bp_film_destroy(&render->film); /* what was read before the latest chunks */
    BP_TRY(bp_render_read_film(render, &film, err));
    render->decides = true;
    if (bp_comm_leads(render->comm))
        BP_TRY(
            bp_adaptive_next(render->adaptive, film, render->options.samples_per_pixel, begun, &pass, err));
    BP_TRY(bp_round_share_pass(render, begun, &pass, err));
    bp_film_destroy(&render->film);
    if (!*begun) return BP_OK;
    return bp_render_begin_pass(render, &pass, err);
}

/* Of all devices, since each meets only some parts of the picture. */
static double slowest_samples(const BpRender *render) {
    double slowest = 0;
    for (size_t i = 0; i < render->worker_count; ++i) {
        const double own = bp_pace_slowest(&render->workers[i]->pace);
        if (own > slowest) slowest = own;
    }
    return slowest;
}

uint32_t bp_render_chunk_samples(const BpRender *render, const BpWorker *worker) {
    if (render->options.chunk_samples != 0) return render->options.chunk_samples;
    return bp_worker_chunk_samples(worker, CHUNK_SECONDS, slowest_samples(render));
}

BpStatus bp_render_take(BpRender *render, uint64_t wanted, BpChunk *chunk, bool *more, BpError *err) {
    *more = bp_schedule_take(&render->schedule, wanted, chunk);
    if (*more) return BP_OK;
    BP_TRY(begin_next_pass(render, more, err));
    if (*more) *more = bp_schedule_take(&render->schedule, wanted, chunk);
    return BP_OK;
}

/* Starts one chunk; *started is false when all has been handed out. */
static BpStatus start_chunk(BpRender *render, bool *started, BpError *err) {
    BpWorker *worker = NULL;
    BP_TRY(bp_render_free_worker(render, &worker, err));
    BP_TRY(
        bp_render_take(render, bp_render_chunk_samples(render, worker), &render->last_chunk, started, err));
    if (!*started) return BP_OK;
    if (render->last_chunk.first_pixel == 0)
        for (size_t i = 0; i < render->worker_count; ++i) bp_pace_begin_pass(&render->workers[i]->pace);
    return bp_worker_start(worker, &render->last_chunk, err);
}

static void report_progress(const BpRender *render, bool finished, BpProgress *progress) {
    if (progress == NULL) return;
    progress->samples_done = bp_render_pixel_samples(render);
    progress->samples_total = render->samples_total;
    progress->trace_seconds = render->trace_seconds;
    progress->finished = finished;
}

/* The pilot follows from the scene, so once is enough. */
static BpStatus run_pilot(BpRender *render, BpError *err) {
    if (!render->has_pilot || render->pilot_done) return BP_OK;
    BP_TRY(bp_pilot_run(render->workers[0], render->scene, &render->aim, render->options.max_depth,
                        render->options.caustics == BP_CAUSTICS_ON, &render->unseen, &render->pilot, err));
    render->pilot_done = true;
    bp_pilot_aim_clear(&render->aim);
    return BP_OK;
}

/* Starts chunks until so much time has passed, one at least. */
static BpStatus step(BpRender *render, double seconds, BpProgress *progress, BpError *err) {
    /* Before the first sample, so that what can fail does so before there is something to lose. */
    if (render->options.samples_per_pixel > 1 && bp_comm_leads(render->comm)) BP_TRY(run_pilot(render, err));
    const double start = bp_clock_seconds();
    bp_film_destroy(&render->film);
    bool more = true;
    if (render->comm != NULL) {
        BP_TRY(bp_round_trace(render, &more, err));
    } else {
        do {
            BP_TRY(start_chunk(render, &more, err));
        } while (more && bp_clock_seconds() - start < seconds);
    }
    if (!more)
        for (size_t i = 0; i < render->worker_count; ++i)
            BP_TRY(bp_worker_wait_for_all(render->workers[i], err));
    render->trace_seconds += bp_clock_seconds() - start;
    report_progress(render, !more && !in_flight(render), progress);
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
    const BpStatus status = bp_worker_samples(render->workers[0], count, values, err);
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
    return render->decides || render->schedule.done > 0 || render->schedule.pass_samples > 0;
}

BpStatus bp_render_check_samples(const BpRender *render, uint64_t samples_per_pixel, BpError *err) {
    BpRenderOptions wanted = render->options;
    wanted.samples_per_pixel = samples_per_pixel;
    return check_options(render->scene, &wanted, err);
}

/* The least that the render can still end with. */
static uint64_t samples_least(const BpRender *render) {
    if (!bp_render_has_begun(render)) return 1;
    if (render->adaptive != NULL) return render->options.samples_per_pixel;
    return render->schedule.done + render->schedule.pass_samples;
}

BpStatus bp_render_extend(BpRender *render, uint64_t samples_per_pixel, BpError *err) {
    BP_TRY(bp_render_check_samples(render, samples_per_pixel, err));
    if (samples_per_pixel < samples_least(render))
        return bp_fail(err, BP_ERR_USAGE, "a render of %llu samples cannot be extended to %llu",
                       (unsigned long long)samples_least(render), (unsigned long long)samples_per_pixel);
    render->options.samples_per_pixel = samples_per_pixel;
    if (render->adaptive == NULL)
        render->schedule.samples = samples_per_pixel;
    else if (!render->decides)
        render->schedule.samples = samples_for_all(samples_per_pixel);
    render->samples_total =
        (uint64_t)render->scene->camera.width * render->scene->camera.height * samples_per_pixel;
    return BP_OK;
}

/* ---- what has been reached ---------------------------------------------------------------------------- */

uint64_t bp_render_samples_done(const BpRender *render) {
    if (!render->decides) return render->schedule.done;
    const double pixels = (double)render->scene->camera.width * render->scene->camera.height;
    return (uint64_t)llround((double)bp_adaptive_samples(render->adaptive) / pixels);
}

BpStatus bp_render_describe(const BpRender *render, BpFilm *film, BpError *err) {
    const BpRenderOptions *options = &render->options;
    film->scale_log2 =
        bp_film_scale(render->scene, options->max_depth, options->light_sampling, options->caustics);
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
    uint64_t begun = render->schedule.done + render->schedule.pass_samples;
    film->partial = render->schedule.pass_samples > 0;
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
    if (!bp_comm_leads(render->comm) || bp_film_range_total(film) < 2) return BP_OK;
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
    for (size_t i = 0; status == BP_OK && i < render->worker_count; ++i)
        status = bp_worker_collect(render->workers[i], read, err);
    if (status == BP_OK) status = add_unseen(render, read, err);
    if (status == BP_OK)
        *film = read;
    else
        bp_film_destroy(&read);
    return status;
}

BpStatus bp_render_read_own_film(BpRender *render, BpFilm **film, uint64_t *pixel_samples, BpError *err) {
    BP_TRY(read_own(render, film, err));
    *pixel_samples = 0;
    for (size_t i = 0; i < render->worker_count; ++i) *pixel_samples += render->workers[i]->samples_done;
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
    return bp_aovs_fill(render->workers[0], render->scene, picture, err);
}

void bp_render_report(const BpRender *render, BpRenderReport *report) {
    memset(report, 0, sizeof *report);
    const BpWorker *first = render->workers[0];
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
    for (size_t i = 0; i < render->worker_count; ++i) {
        const BpWorker *worker = render->workers[i];
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
        report->cut_paths = render->film->cut_paths;
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
    const BpSchedule *schedule = &render->schedule;
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
    return bp_aovs_fill(render->workers[0], render->scene, &render->aovs, err);
}

BpStatus bp_render_read_whole_film(BpRender *render, const BpFilm **film, BpError *err) {
    BP_TRY(bp_render_read_film(render, film, err));
    if (!bp_comm_leads(render->comm)) return BP_OK; /* whose film is no use */
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
