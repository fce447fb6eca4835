/* test_resume.c: a render that is stopped at any moment, kept in a file and taken up again ends with the file
 * that one render without a break writes, bit for bit; what it cannot go on from is refused. */
#include "base/random.h"
#include "film/film_file.h"
#include "render/render.h"
#include "support/unit_test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static BpError err;

static void must(BpStatus status) {
    if (status != BP_OK) fail_msg("%s", err.message);
}

typedef struct Job {
    BpScene *scene;
    BpRenderOptions options;
    BpStopRule rule;
} Job;

static void job_open(Job *job, const char *name, uint32_t width, uint64_t samples) {
    char path[512];
    snprintf(path, sizeof path, "%s/%s", SOURCE_DIR, name);
    must(bp_scene_load(path, &job->scene, &err));
    must(bp_scene_set_width(job->scene, width, &err));
    bp_render_defaults(job->scene, &job->options);
    job->options.sampler = BP_SAMPLER_SOBOL;
    job->options.samples_per_pixel = samples;
    job->options.features = true;
    bp_stop_rule_defaults(job->scene, &job->options, &job->rule);
}

typedef struct Bytes {
    char *data;
    size_t size;
} Bytes;

static Bytes save(BpRender *render) {
    Bytes bytes = {NULL, 0};
    const BpFilm *film = NULL;
    must(bp_render_read_whole_film(render, &film, &err));
    FILE *out = open_memstream(&bytes.data, &bytes.size);
    must(bp_film_write_stream(film, out, &err));
    fclose(out);
    return bytes;
}

static BpFilm *load(Bytes bytes) {
    BpFilm *film = NULL;
    FILE *in = fmemopen(bytes.data, bytes.size, "rb");
    must(bp_film_read_stream(in, "memory", &film, &err));
    fclose(in);
    return film;
}

static BpRender *begin(const Job *job, const Bytes *from, size_t devices) {
    BpRender *render = NULL;
    BpDeviceInfo all[2];
    must(bp_device_find(NULL, &all[0], &err));
    all[1] = all[0];
    must(bp_render_create(job->scene, &job->options, all, devices, &render, &err));
    if (from != NULL) {
        BpFilm *film = load(*from);
        must(bp_render_resume(render, film, &err));
        bp_film_destroy(&film);
    }
    return render;
}

/* To the end that the rule sets. */
static BpStopReason run(BpRender *render, const BpStopRule *rule) {
    BpStop *stop = NULL;
    BpStopReason reason = BP_STOP_NOT_YET;
    must(bp_stop_create(render, rule, &stop, &err));
    while (reason == BP_STOP_NOT_YET) {
        BpProgress progress;
        must(bp_render_step(render, &progress, &err));
        must(bp_stop_check(stop, &progress, &reason, &err));
    }
    bp_stop_destroy(&stop);
    return reason;
}

static void assert_same_bytes(Bytes a, Bytes b) {
    assert_int_equal(a.size, b.size);
    assert_memory_equal(a.data, b.data, a.size);
}

/* Stops `breaks` times after a few chunks each, every time with a file and a new render. */
static void resumed_is_the_same(Job *job, unsigned breaks, size_t devices, uint64_t seed) {
    BpRandom random = {seed};
    job->options.chunk_samples = 0;
    BpRender *render = begin(job, NULL, 1);
    const BpStopReason reason = run(render, &job->rule);
    Bytes whole = save(render), part = {NULL, 0};
    bp_render_destroy(&render);

    unsigned partial = 0;
    job->options.chunk_samples = 700;
    for (unsigned i = 0; i < breaks; ++i) {
        BpStop *stop = NULL;
        render = begin(job, i > 0 ? &part : NULL, devices);
        must(bp_stop_create(render, &job->rule, &stop, &err));
        for (uint64_t chunk = bp_random_bits(&random) % 40; chunk > 0; --chunk) {
            BpProgress progress;
            BpStopReason now;
            must(bp_render_step_chunk(render, &progress, &err));
            must(bp_stop_check(stop, &progress, &now, &err));
        }
        bp_stop_destroy(&stop);
        free(part.data);
        part = save(render);
        bp_render_destroy(&render);
        BpFilm *film = load(part);
        partial += film->plan != NULL && film->plan->pass_samples > 0;
        bp_film_destroy(&film);
    }
    assert_true(partial > 0); /* else no pass was ever broken */
    job->options.chunk_samples = 0;
    render = begin(job, &part, devices);
    assert_int_equal(run(render, &job->rule), reason);
    Bytes end = save(render);
    assert_same_bytes(whole, end);
    free(end.data);
    bp_render_destroy(&render);

    /* What has finished goes on from its end: nothing is left to do. */
    render = begin(job, &whole, 1);
    assert_int_equal(run(render, &job->rule), reason);
    end = save(render);
    assert_same_bytes(whole, end);
    bp_render_destroy(&render);
    free(whole.data);
    free(part.data);
    free(end.data);
}

static void every_pixel_the_same(void **state) {
    (void)state;
    Job job;
    job_open(&job, "scenes/v4-22-defocus.json", 40, 50);
    job.options.first_sample = 3;
    resumed_is_the_same(&job, 6, 1, 1);
    resumed_is_the_same(&job, 4, 2, 2); /* two devices take up what one began */
    bp_scene_destroy(&job.scene);
}

static void until_an_error(void **state) {
    (void)state;
    Job job;
    job_open(&job, "scenes/v4-22-defocus.json", 40, 1);
    job.rule.error = 0.02;
    job.rule.samples_max = 4096;
    job.options.samples_per_pixel = 48; /* 65536 samples of 40 x 22 pixels come later */
    resumed_is_the_same(&job, 8, 1, 3);
    bp_scene_destroy(&job.scene);
}

static void adaptive(void **state) {
    (void)state;
    Job job;
    job_open(&job, "scenes/v4-22-defocus.json", 40, 90);
    job.options.adaptive = job.rule.adaptive = true;
    resumed_is_the_same(&job, 9, 1, 4);
    job.rule.error = 0.03;
    job.rule.samples_max = 2048;
    resumed_is_the_same(&job, 9, 2, 5);
    bp_scene_destroy(&job.scene);
}

/* Sums beside a lamp that is not seen, so that there are fine ones. */
static void fine_sums(void **state) {
    (void)state;
    static const char text[] =
        "{\"camera\": {\"image_width\": 64, \"aspect_ratio\": [4, 3], \"max_depth\": 5},"
        "\"background\": [1e-9, 2e-9, 3e-9],"
        "\"materials\": {\"lamp\": {\"type\": \"diffuse_light\", \"emit\": [1e6, 1e6, 1e6]},"
        "\"grey\": {\"type\": \"lambertian\", \"albedo\": [0.5, 0.5, 0.5]}},"
        "\"spheres\": [{\"center\": [0, 0, -3], \"radius\": 1, \"material\": \"grey\"},"
        "{\"center\": [0, 0, 900], \"radius\": 1, \"material\": \"lamp\"}]}";
    Job job;
    if (bp_scene_parse(text, strlen(text), "dim", &job.scene, &err) != BP_OK) fail_msg("%s", err.message);
    bp_render_defaults(job.scene, &job.options);
    job.options.samples_per_pixel = 70;
    bp_stop_rule_defaults(job.scene, &job.options, &job.rule);
    BpRender *render = begin(&job, NULL, 1);
    const BpFilm *film = NULL;
    run(render, &job.rule);
    must(bp_render_read_film(render, &film, &err));
    assert_non_null(film->fine_sums);
    bp_render_destroy(&render);
    resumed_is_the_same(&job, 5, 1, 6);
    bp_scene_destroy(&job.scene);
}

/* More samples than were asked for at first: as if they had been asked for at once. */
static void more_samples(void **state) {
    (void)state;
    Job job;
    job_open(&job, "scenes/v4-22-defocus.json", 24, 21);
    BpRender *render = begin(&job, NULL, 1);
    run(render, &job.rule);
    Bytes first = save(render);
    bp_render_destroy(&render);
    BpStopRule rule = job.rule;
    rule.samples_max = 57;
    render = begin(&job, &first, 1);
    run(render, &rule);
    Bytes more = save(render);
    bp_render_destroy(&render);
    render = begin(&job, NULL, 1);
    run(render, &rule);
    Bytes whole = save(render);
    assert_same_bytes(whole, more);
    bp_render_destroy(&render);
    free(first.data);
    free(more.data);
    free(whole.data);
    bp_scene_destroy(&job.scene);
}

static void refuse(const Job *job, const BpFilm *film, BpStatus status, const char *says) {
    BpRender *render = NULL;
    must(bp_render_create(job->scene, &job->options, NULL, 0, &render, &err));
    assert_int_equal(bp_render_resume(render, film, &err), status);
    if (strstr(err.message, says) == NULL) fail_msg("\"%s\" does not say \"%s\"", err.message, says);
    bp_render_destroy(&render);
}

static void what_does_not_fit_is_refused(void **state) {
    (void)state;
    Job job, other;
    job_open(&job, "scenes/v4-22-defocus.json", 24, 64);
    job.options.adaptive = job.rule.adaptive = true;
    job.options.chunk_samples = 500;
    BpRender *render = begin(&job, NULL, 1);
    BpStop *stop = NULL;
    must(bp_stop_create(render, &job.rule, &stop, &err));
    BpProgress progress;
    for (int i = 0; i < 30; ++i) must(bp_render_step_chunk(render, &progress, &err));
    BpFilm *film = NULL;
    must(bp_render_film(render, &film, &err));
    assert_int_equal(bp_render_resume(render, film, &err), BP_ERR_USAGE); /* it has begun */
    bp_stop_destroy(&stop);
    bp_render_destroy(&render);
    assert_true(film->plan->decision_bytes > 0);

    other = job;
    other.options.adaptive = false;
    refuse(&other, film, BP_ERR_USAGE, "is of an adaptive render, but the render is not");
    other = job;
    other.options.seed = 1;
    refuse(&other, film, BP_ERR_USAGE, "seeds differ");
    other = job;
    other.options.first_sample = 1;
    refuse(&other, film, BP_ERR_USAGE, "begins with sample 0, but the render with sample 1");
    film->plan->decisions[8] ^= 1; /* the level of a half */
    refuse(&job, film, BP_ERR_FILE, "");
    film->plan->decisions[8] ^= 1;
    film->plan->decision_bytes--;
    refuse(&job, film, BP_ERR_FILE, "decisions");
    film->plan->decision_bytes++;
    film->plan->pass_samples += 1000;
    refuse(&job, film, BP_ERR_FILE, "contradicts its samples");
    bp_film_plan_destroy(&film->plan);
    other = job;
    other.options.adaptive = false;
    refuse(&other, film, BP_ERR_USAGE, "lacks samples in some pixels");
    film->partial = false;
    must(bp_film_add_range(film, 900, 2, &err));
    refuse(&other, film, BP_ERR_USAGE, "not of one range");
    bp_film_destroy(&film);
    bp_scene_destroy(&job.scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_pixel_the_same),
        cmocka_unit_test(until_an_error),
        cmocka_unit_test(adaptive),
        cmocka_unit_test(fine_sums),
        cmocka_unit_test(more_samples),
        cmocka_unit_test(what_does_not_fit_is_refused),
    };
    return cmocka_run_group_tests_name("resume", tests, NULL, NULL);
}
