/* cmd_render.c: `ballpark render`.
 *
 * In:    scene files, options.   Out: their pictures, statistics (--stats), summaries.
 * Knows: the order of the steps.   Does not know: how to trace, when a stop rule is met, how pictures are
 * written (cli/output/content.h). */
#include "commands.h"

#include "base/clock.h"
#include "base/escape.h"
#include "base/format.h"
#include "base/output_file.h"
#include "base/plural.h"
#include "cli/job/checkpoint.h"
#include "cli/job/preview.h"
#include "cli/job/ranks.h"
#include "cli/job/render_loop.h"
#include "cli/job/resume_film.h"
#include "cli/job/run_report.h"
#include "cli/job/series.h"
#include "cli/job/setup.h"
#include "cli/line/file_conflicts.h"
#include "cli/output/json_file.h"
#include "cli/output/keep_sums.h"
#include "cli/output/output.h"
#include "cli/output/result_file.h"
#include "cli/terminal/page.h"
#include "cli/terminal/terminal.h"
#include "cluster/comm.h"
#include "film/adaptive.h"
#include "opencl/device.h"
#include "render/render.h"
#include "render/render_plan.h"
#include "render/stop_rule.h"

#include <inttypes.h>
#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static void init_rule(const BpCommandLine *line, const BpScene *scene, const BpRenderOptions *options,
                      BpStopRule *rule) {
    const bool has_error = bp_option_given(line, BP_OPTION_ERROR),
               has_time = bp_option_given(line, BP_OPTION_TIME);
    bp_stop_rule_defaults(scene, options, rule);
    /* --error and --time replace the scene's sample count, but not --spp. */
    if ((has_error || has_time) && !bp_option_given(line, BP_OPTION_SPP)) {
        rule->samples_max = BP_SPP_MAX;
        if (rule->samples_max > BP_SAMPLE_NUMBERS - options->first_sample)
            rule->samples_max = BP_SAMPLE_NUMBERS - options->first_sample;
    }
    if (has_error) rule->error = line->error_percent / 100.0;
    if (has_time) rule->seconds = line->time_seconds;
}

static BpStatus check_adaptive(const BpStopRule *rule, BpError *err) {
    if (!rule->adaptive || rule->samples_max >= BP_ADAPTIVE_MEAN_MIN) return BP_OK;
    return bp_fail(
        err, BP_ERR_USAGE,
        "--adaptive with %" PRIu64 " sample%s per pixel: every pixel gets the first %u, so none are left for "
        "noisy pixels; use --spp %u or more, --error or --time",
        rule->samples_max, rule->samples_max == 1 ? "" : "s", BP_ADAPTIVE_FIRST, BP_ADAPTIVE_MEAN_MIN);
}

/* Picture, statistics (appended to `stats` unless it is NULL) and summary of a render that has stopped. */
static BpStatus write_results(const BpCommandLine *line, BpResultFile *file, const BpStopRule *rule,
                              const BpLoopEnd *end, BpCheckpoint *checkpoint, BpPreview *preview,
                              BpRender *render, BpRunResult *result, json_t *stats, BpError *err) {
    BpStatus status = bp_render_read_whole_film(render, &result->film, err);
    if (status != BP_OK && result->comm == NULL && bp_render_read_film(render, &result->film, NULL) == BP_OK)
        bp_keep_sums(result->film, file->path, err);
    BP_TRY(status);
    bp_comm_end_work(result->comm); /* the others have done their part */
    if (!bp_comm_is_root(result->comm)) return BP_OK;
    bp_render_report(render, &result->report);
    result->samples_per_pixel = bp_render_samples_done(render);
    result->stopped_by = end->reason;
    result->claim = bp_film_claim(result->film);
    BP_TRY(bp_render_unseen(render, &result->unseen, err));
    /* The few samples left would misrepresent the scene, so no picture is written. */
    const uint64_t samples = result->report.samples;
    char causes[BP_INVALID_TEXT_SIZE];
    if (result->report.invalid_samples > samples / 2)
        return bp_fail(err, BP_ERR_LIMIT,
                       "%" PRIu64 " of %" PRIu64
                       " sample%s invalid%s, so %s was not written: the scene's numbers "
                       "may be too large or too small for %s precision; %schoose another unit of length, or "
                       "find the wrong "
                       "pixels with `ballpark check`",
                       result->report.invalid_samples, samples, samples == 1 ? " is" : "s are",
                       bp_film_invalid_causes(result->film, causes), result->output,
                       result->options->precision == BP_PRECISION_DOUBLE ? "double" : "single",
                       result->options->precision == BP_PRECISION_DOUBLE ? "" : "use --precision double, ");
    const double write_start = bp_clock_seconds();
    const bool keeps = end->reason == BP_STOP_NOT_YET && checkpoint->path[0] != '\0';
    if (keeps && !checkpoint->is_result) bp_checkpoint_write(checkpoint, result->film);
    file->is_own = checkpoint->is_result && checkpoint->written > 0;
    const BpStatus written = bp_result_write(line, file, result->film, true,
                                             (BpTransfer)result->film->transfer, result->scene, err);
    result->times.write = bp_clock_seconds() - write_start;
    /* If the picture's reader has left, the statistics are still written. */
    if (written != BP_OK && strcmp(file->path, "-") != 0) return written;
    if (stats != NULL && json_array_append_new(stats, bp_run_stats(result)) != 0)
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for the document %s", line->stats);
    if (written != BP_OK) return written;
    BP_TRY(bp_preview_end(preview, result->film, err));
    bp_run_print_summary(line, result, rule, end);
    if (end->reason == BP_STOP_TIME && result->samples_per_pixel == 0)
        return bp_fail(err, BP_ERR_LIMIT,
                       "--time %g ran out before every pixel had a sample, so parts of %s are black: allow "
                       "more time, or use a smaller --width or --depth",
                       rule->seconds, result->output);
    if (end->reason == BP_STOP_NOT_YET) return bp_run_interrupted(line, rule, end, checkpoint, result, err);
    bp_checkpoint_end(line, checkpoint);
    return BP_OK;
}

/* One scene of the run. */
typedef struct Job {
    const char *path; /* of the scene */
    BpResultFile file;
    BpCheckpoint checkpoint;
    BpScene *own;   /* read for this job */
    BpScene *scene; /* the same, or one of a series */
    double load_seconds;
} Job;

/* What all scenes share. */
typedef struct Run {
    BpCommandLine line;
    BpComm *comm; /* the ranks that share the current picture; NULL: none */
    Job *jobs;
    size_t count;
    BpDeviceInfo *devices;
    BpDevice **open; /* the same, open: kernels are built once where programs are equal */
    size_t device_count;
    json_t *stats; /* an array by the number of the job; NULL: not requested */
    double start;  /* of the current scene, or of the command for the first one */
    bool has_begun;
    size_t pictures, incomplete; /* written by this rank; those of them that lack invalid samples */
    char lack[512];              /* the reason why the first of those cannot render */
} Run;

/* Two scenes may have the same name in different folders. */
static BpStatus check_names_differ(const Run *run, size_t job, BpError *err) {
    const Job *own = &run->jobs[job];
    const bool exists = bp_output_replaces(own->file.path);
    for (size_t o = 0; o < job; ++o) {
        const Job *other = &run->jobs[o];
        if (strcmp(own->file.path, other->file.path) == 0 ||
            (exists && bp_output_same(own->file.path, other->file.path, STDOUT_FILENO)))
            return bp_fail(err, BP_ERR_USAGE,
                           "%.300s and %.300s would both become %.300s; render one of them "
                           "on its own, with another --output",
                           other->path, own->path, own->file.path);
    }
    return BP_OK;
}

/* All scenes are read before the first is rendered, so that a mistake in the last is found at once. */
static BpStatus load(Run *run, size_t number, BpError *err) {
    Job *job = &run->jobs[number];
    const double start = number == 0 ? run->start : bp_clock_seconds();
    job->path = run->line.operands[number];
    if (run->line.comm != NULL && strcmp(job->path, "-") == 0)
        return bp_fail(err, BP_ERR_USAGE,
                       "a scene from standard input reaches only one of %" PRIu32
                       " ranks; save it in a file that all of them can read",
                       bp_comm_size(run->line.comm));
    BP_TRY(bp_result_choose(&run->line, job->path, &job->file, err));
    BP_TRY(check_names_differ(run, number, err));
    BpWaiting *waiting = bp_waiting_begin(run->line.quiet, "reading %s", job->path);
    BpStatus status = bp_setup_scene(&run->line, job->path, &job->own, err);
    bp_waiting_end(waiting);
    if (status != BP_OK) return status;
    job->scene = job->own;
    const BpCommandLine own = bp_result_line(&run->line, &job->file);
    BP_TRY(bp_file_conflicts_check_scene(&own, NULL, job->scene, err));
    BP_TRY(bp_checkpoint_choose(&run->line, &job->file, &job->checkpoint, err));
    job->load_seconds = bp_clock_seconds() - start;
    return BP_OK;
}

/* Chooses, tests and opens the devices. */
static BpStatus find_devices(Run *run, BpError *err) {
    BP_TRY(bp_setup_devices(&run->line, &run->devices, &run->device_count, err));
    BP_TRY(bp_ranks_choose_device(&run->line, &run->devices[0], err));
    run->line.threads = bp_ranks_threads(&run->line, &run->devices[0]);
    return BP_OK;
}

static BpStatus open_devices(Run *run, BpError *err) {
    BP_TRY(bp_setup_self_test(&run->line, run->devices, run->device_count, err));
    run->open = calloc(run->device_count, sizeof *run->open);
    if (run->open == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for a list of devices");
    for (size_t d = 0; d < run->device_count; ++d)
        BP_TRY(bp_device_open_part(&run->devices[d], run->line.threads, &run->open[d], err));
    return BP_OK;
}

/* `resumed`: Optional. The film that the render continues, which determines the samples. */
static BpStatus plan(const BpCommandLine *line, const Job *job, const BpCheckpoint *checkpoint,
                     const BpFilm *resumed, BpRenderOptions *options, BpStopRule *rule, BpError *err) {
    BP_TRY(bp_setup_options(line, job->scene, options, err));
    BP_TRY(bp_setup_share(line, options, err));
    bp_setup_warn(line, job->scene, options->precision);
    /* Less noise in the same time on every scene that was measured: docs/ACCURACY.md. */
    if (!bp_option_given(line, BP_OPTION_SAMPLER)) options->sampler = BP_SAMPLER_SOBOL;
    /* An error map distinguishes spheres from sky by depth. */
    options->features = job->file.format == BP_FORMAT_EXR || job->file.format == BP_FORMAT_BPA ||
                        job->file.error_map[0] != '\0' || checkpoint->path[0] != '\0' ||
                        bp_result_has_cues(line);
    if (bp_option_given(line, BP_OPTION_DEPTH_FOG) && job->scene->backdrop == BP_BACKDROP_SKY)
        return bp_fail(err, BP_ERR_USAGE,
                       "--depth-fog fades into the backdrop, and %.400s has none; add --set "
                       "'backdrop=[1,1,1]', or --set backdrop=none for a picture with alpha",
                       job->path);
    if (resumed != NULL) {
        options->caustics = bp_render_caustics(job->scene, options); /* as films have them */
        options->light_sampling = bp_render_light_sampling(job->scene, options);
        BpRenderOptions as_then = *options;
        as_then.max_depth = resumed->max_depth;
        options->roulette = bp_render_roulette(job->scene, &as_then);
        BP_TRY(bp_resume_options(line, resumed, options, err));
    }
    init_rule(line, job->scene, options, rule);
    if (resumed != NULL) BP_TRY(bp_resume_rule(line, resumed, rule, err));
    BP_TRY(check_adaptive(rule, err));
    options->samples_per_pixel = bp_stop_first(rule);
    return BP_OK;
}

/* A picture on its way. */
typedef struct Work {
    BpRender *render;
    BpRenderOptions options;
    BpStopRule rule;
    BpPreview preview;
    BpFilm *resumed; /* NULL: the picture is a new one */
    BpRunResult result;
} Work;

/* Everything before the first sample; each rank does it for itself. */
static BpStatus prepare(Run *run, const BpCommandLine *line, Job *job, Work *work, BpError *err) {
    BpStatus status = BP_OK;
    BpWaiting *waiting = NULL;
    job->checkpoint.is_shared = run->comm != NULL;
    job->checkpoint.is_elsewhere = !bp_comm_is_root(run->comm);
    BP_TRY(bp_result_check_text(line, &job->file, job->scene, err));
    BP_TRY(bp_preview_choose(line, run->comm, job->scene, &job->file, &work->preview, err));
    BP_TRY_GOTO(status, bp_resume_load(line, run->comm, &work->resumed, err), done);
    if (work->resumed != NULL)
        BP_TRY_GOTO(status, bp_resume_scene(line, work->resumed, job->scene, err), done);
    BP_TRY_GOTO(status, plan(line, job, &job->checkpoint, work->resumed, &work->options, &work->rule, err),
                done);
    if (run->devices == NULL) BP_TRY_GOTO(status, find_devices(run, err), done);
    work->result.device_count = run->device_count;
    char spheres[32];
    waiting = bp_waiting_begin(line->quiet, "preparing %s %s%s and the kernel for %s",
                               bp_format_whole(bp_scene_shapes(job->scene), spheres, sizeof spheres),
                               bp_scene_noun(job->scene), bp_plural(bp_scene_shapes(job->scene)),
                               run->devices[0].name);
    if (run->open == NULL) BP_TRY_GOTO(status, open_devices(run, err), done);
    BP_TRY_GOTO(
        status,
        bp_render_create_on(job->scene, &work->options, run->open, run->device_count, &work->render, err),
        done);
    bp_render_join(work->render, run->comm);
done:
    bp_waiting_end(waiting);
    return status;
}

/* Only the rank that writes a shared picture has a report of it. */
static void count_picture(Run *run, const BpRunResult *result) {
    const BpRenderReport *report = &result->report;
    char causes[BP_INVALID_TEXT_SIZE];
    ++run->pictures;
    if (report->invalid_samples == 0) return;
    if (run->incomplete++ == 0)
        snprintf(run->lack, sizeof run->lack,
                 "%.200s lacks %" PRIu64 " of %" PRIu64 " samples that were invalid%s", result->output,
                 report->invalid_samples, report->samples, bp_film_invalid_causes(result->film, causes));
}

/* Invalid samples bias a picture, so the command fails, although its files have been written. */
static BpStatus check_complete(const Run *run, BpError *err) {
    if (run->incomplete == 0) return BP_OK;
    char others[64] = "";
    if (run->incomplete > 1)
        snprintf(others, sizeof others, ", and so do %zu more of %zu pictures", run->incomplete - 1,
                 run->pictures);
    return bp_fail(err, BP_ERR_LIMIT, "%s%s; `ballpark check` compares the device with the reference tracer",
                   run->lack, others);
}

static BpStatus render_one(Run *run, const BpCommandLine *line, Job *job, BpError *err) {
    BpLoopEnd end;
    Work work = {.render = NULL};
    work.result = (BpRunResult){.scene_path = job->path,
                                .output = bp_result_name(&job->file),
                                .scene = job->scene,
                                .options = &work.options,
                                .times = {.start = run->start, .load = job->load_seconds},
                                .comm = run->comm,
                                .checkpoint = &job->checkpoint};
    BpStatus status = bp_comm_all_ok(run->comm, prepare(run, line, job, &work, err), err);
    if (status == BP_OK && work.resumed != NULL) {
        status = bp_render_resume(work.render, work.resumed, err);
        if (!bp_comm_is_at_work(run->comm)) status = bp_comm_all_ok(run->comm, status, err);
    }
    bp_film_destroy(&work.resumed);
    if (status == BP_OK) {
        if (!run->has_begun) bp_line_say_overwritten(line, line->stats);
        run->has_begun = true;
        bp_result_say_overwritten(line, &job->file);
        bp_comm_begin_work(run->comm);
        status = bp_render_loop(line, run->comm, work.render, &work.rule, &job->checkpoint, &work.preview,
                                &end, err);
    }
    if (status == BP_OK)
        status = write_results(line, &job->file, &work.rule, &end, &job->checkpoint, &work.preview,
                               work.render, &work.result, run->stats, err);
    if (status == BP_OK) count_picture(run, &work.result);
    /* A rank that failed between exchanges cannot report to the others, which wait for another message. */
    if (!bp_comm_is_at_work(run->comm)) status = bp_comm_all_ok(run->comm, status, err);
    bp_render_destroy(&work.render);
    return status;
}

/* {"renders": [...]} of several scenes, the document itself of one. */
static BpStatus write_stats(const Run *run, BpError *err) {
    json_t *root = run->count == 1 ? json_incref(json_array_get(run->stats, 0))
                                   : json_pack("{s:O}", "renders", run->stats);
    return bp_json_write(&run->line, root, run->line.stats, err);
}

static void clear(Run *run) {
    for (size_t j = 0; j < run->count && run->jobs != NULL; ++j) bp_scene_destroy(&run->jobs[j].own);
    for (size_t d = 0; d < run->device_count && run->open != NULL; ++d)
        if (run->open[d] != NULL) bp_device_close(&run->open[d]);
    free(run->open);
    free(run->devices);
    free(run->jobs);
    json_decref(run->stats);
}

/* ---- several pictures -------------------------------------------------------------------------------- */

/* After the pictures of single ranks are finished: reports failures and notes of any rank. The statistics of
 * all go to rank 0, in the order of the scenes. */
static BpStatus gather_results(Run *run, size_t dealt, BpStatus status, BpError *err) {
    BpComm *comm = run->line.comm;
    char **texts = NULL;
    if (dealt == 0) return status;
    status = bp_comm_all_ok(comm, status, err);
    if (status == BP_OK)
        bp_say(&run->line, "%zu picture%s rendered by %" PRIu32 " ranks, each picture by one rank", dealt,
               bp_plural(dealt), bp_comm_size(comm));
    if (status != BP_OK || run->line.stats == NULL) return status;
    char *own = json_dumps(run->stats, JSON_COMPACT);
    status = bp_comm_all_ok(
        comm, own != NULL ? BP_OK : bp_fail(err, BP_ERR_MEMORY, "out of memory for statistics"), err);
    if (status == BP_OK) status = bp_comm_gather_texts(comm, own, &texts, err);
    free(own);
    if (texts == NULL) return status;
    json_t *all = json_array(), *lists = json_array();
    for (uint32_t r = 0; r < bp_comm_size(comm); ++r)
        json_array_append_new(lists, json_loads(texts[r], 0, NULL));
    for (size_t p = 0; p < dealt; ++p)
        json_array_append(
            all, json_array_get(json_array_get(lists, p % bp_comm_size(comm)), p / bp_comm_size(comm)));
    json_decref(lists);
    json_decref(run->stats);
    run->stats = all;
    free(texts);
    return json_array_size(all) == dealt ? BP_OK
                                         : bp_fail(err, BP_ERR_MEMORY, "out of memory for statistics");
}

/* One picture for each frame or each step of a turntable. */
static BpStatus render_series(Run *run, BpError *err) {
    BpSeries series = {0};
    const BpCommandLine *line = &run->line;
    if (run->count > 1)
        return bp_fail(err, BP_ERR_USAGE, "--frames and --turntable take one file, found %zu", run->count);
    BpStatus status = bp_series_begin(line, &series, err);
    const size_t dealt = status == BP_OK ? bp_ranks_dealt(line->comm, (size_t)series.count) : 0;
    while (status == BP_OK && series.next < series.count) {
        BpCommandLine one;
        Job job = {.path = line->operands[0]};
        if (series.next < dealt && !bp_ranks_is_mine(line->comm, (size_t)series.next)) {
            ++series.next;
            if (series.next == dealt) status = gather_results(run, dealt, status, err);
            continue;
        }
        run->start = bp_clock_seconds();
        run->comm = series.next < dealt ? NULL : line->comm;
        const BpScene *shown = NULL;
        status = bp_series_line(&series, &one, err);
        if (status == BP_OK) status = bp_result_choose(&one, job.path, &job.file, err);
        if (status == BP_OK) status = bp_series_scene(&series, &shown, err);
        job.scene = series.scene;
        if (status == BP_OK) {
            const BpCommandLine own = bp_result_line(&one, &job.file);
            status = bp_file_conflicts_check_scene(&own, NULL, job.scene, err);
        }
        if (status == BP_OK) status = bp_checkpoint_choose(&one, &job.file, &job.checkpoint, err);
        job.load_seconds = bp_clock_seconds() - run->start;
        if (status == BP_OK) status = render_one(run, &one, &job, err);
        if (series.next == dealt) status = gather_results(run, dealt, status, err);
    }
    bp_series_end(&series);
    return status;
}

static BpStatus render_scenes(Run *run, BpError *err) {
    BpComm *comm = run->line.comm;
    const size_t dealt = bp_ranks_dealt(comm, run->count);
    BpStatus status = BP_OK;
    if (run->line.stats != NULL) BP_TRY(bp_line_check_output(&run->line, run->line.stats, err));
    for (size_t j = 0; j < run->count && status == BP_OK; ++j) status = load(run, j, err);
    status = bp_comm_all_ok(comm, status, err); /* all ranks have checked before the first file is written */
    for (size_t j = 0; j < run->count && status == BP_OK; ++j) {
        const bool alone = j < dealt;
        if (!alone || bp_ranks_is_mine(comm, j)) {
            BpCommandLine one = run->line; /* of this scene alone, for the command that continues it */
            one.operands += j;
            one.operand_count = 1;
            run->comm = alone ? NULL : comm;
            status = render_one(run, &one, &run->jobs[j], err);
            bp_scene_destroy(&run->jobs[j].own);
            run->start = bp_clock_seconds();
        }
        if (j + 1 == dealt) status = gather_results(run, dealt, status, err);
    }
    if (json_array_size(run->stats) > 0 && bp_comm_is_root(comm)) {
        const BpStatus written = write_stats(run, status == BP_OK ? err : NULL);
        if (status == BP_OK) status = written;
    }
    return status;
}

BpStatus bp_command_render(const BpCommandLine *given, BpError *err) {
    BpStatus status = BP_OK;
    BpCommandLine own = *given;
    BP_TRY(bp_result_take_width(&own, err));
    const BpCommandLine *const line = &own;
    Run run = {.line = *line, .count = line->operand_count, .start = bp_clock_seconds()};
    const bool is_series =
        bp_option_given(line, BP_OPTION_FRAMES) || bp_option_given(line, BP_OPTION_TURNTABLE);
    run.line.quiet = line->quiet || !bp_comm_is_root(line->comm); /* errors alone come from other ranks */
    run.jobs = calloc(run.count, sizeof *run.jobs);
    if (line->stats != NULL) run.stats = json_array();
    const bool to_output = line->output != NULL && strcmp(line->output, "-") == 0;
    if (line->comm != NULL && to_output) /* launchers pass it on as text, from all ranks together */
        status = bp_fail(err, BP_ERR_USAGE,
                         "--output -: the launcher of several ranks passes on their standard output and may "
                         "change it; give the name of a file");
    else if (run.jobs == NULL || (line->stats != NULL && run.stats == NULL))
        status = bp_fail(err, BP_ERR_MEMORY, "out of memory for a list of scenes");
    else if (line->resume != NULL && (run.count > 1 || is_series))
        status = bp_fail(err, BP_ERR_USAGE,
                         "--resume continues one picture, and this command makes several; render the "
                         "unfinished one alone (a single frame with --frame)");
    else
        status = is_series ? render_series(&run, err) : render_scenes(&run, err);
    if (status == BP_OK) status = check_complete(&run, err);
    clear(&run);
    return status;
}
