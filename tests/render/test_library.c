/* test_library.c: what ballpark.h promises beyond single renders: films, stop rules, studies, wrong use,
 * threads.
 *
 * Only the public header is used, as another program would. */
#include <ballpark.h>

#include <math.h>
#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#define WIDTH 24u

static const char document[] =
    "{ \"title\": \"two balls\", \"camera\": { \"image_width\": 24, \"aspect_ratio\": 1, \"lookfrom\": [0, "
    "1, 4],"
    "  \"lookat\": [0, 0, 0], \"vfov\": 40, \"samples_per_pixel\": 8 },"
    "  \"materials\": { \"m\": { \"type\": \"lambertian\", \"albedo\": [0.7, 0.5, 0.3] },"
    "                   \"g\": { \"type\": \"dielectric\", \"refraction_index\": 1.5 } },"
    "  \"spheres\": [ { \"center\": [0, -100.5, 0], \"radius\": 100, \"material\": \"m\" },"
    "                 { \"center\": [0.4, 0, 0], \"radius\": 0.5, \"material\": \"g\" },"
    "                 { \"center\": [-0.6, 0, 0], \"radius\": 0.5, \"material\": \"m\" } ] }";

static BpError err;

static void must(BpStatus status) {
    if (status != BP_OK) fail_msg("%s", err.message);
}

static BpScene *make_scene(void) {
    BpScene *scene = NULL;
    must(bp_scene_parse(document, strlen(document), "document", &scene, &err));
    return scene;
}

static void run_to_end(BpRender *render) {
    BpProgress progress = {0};
    do must(bp_render_step(render, &progress, &err));
    while (!progress.finished);
}

static BpRender *make_render(const BpScene *scene, uint64_t first, uint64_t samples, uint64_t seed) {
    BpRenderOptions options;
    BpRender *render = NULL;
    bp_render_defaults(scene, &options);
    options.first_sample = first;
    options.samples_per_pixel = samples;
    options.seed = seed;
    options.features = true; /* of one program for all */
    must(bp_render_create(scene, &options, NULL, 0, &render, &err));
    return render;
}

static BpFilm *make_film(const BpScene *scene, uint64_t first, uint64_t samples, uint64_t seed) {
    BpRender *render = make_render(scene, first, samples, seed);
    BpFilm *film = NULL;
    run_to_end(render);
    must(bp_render_film(render, &film, &err));
    bp_render_destroy(&render); /* the film lives on */
    return film;
}

static void assert_same_pictures(const BpPicture *a, const BpPicture *b) {
    const size_t pixels = (size_t)a->width * a->height;
    assert_int_equal(a->width, b->width);
    assert_int_equal(a->height, b->height);
    assert_memory_equal(a->rgb, b->rgb, pixels * 3 * sizeof *a->rgb);
    assert_memory_equal(a->error, b->error, pixels * 3 * sizeof *a->error);
    assert_memory_equal(a->samples, b->samples, pixels * sizeof *a->samples);
}

static void assert_same_films(const BpFilm *a, const BpFilm *b) {
    BpPicture first = {0}, second = {0};
    must(bp_film_picture(a, &first, &err));
    must(bp_film_picture(b, &second, &err));
    assert_same_pictures(&first, &second);
    bp_picture_clear(&first);
    bp_picture_clear(&second);
}

/* ---- films ---- */

static void films_add_up(void **state) {
    (void)state;
    char path[] = "/tmp/ballpark-library-XXXXXX";
    BpScene *scene = make_scene();
    BpFilm *whole = make_film(scene, 0, 8, 1), *sum = make_film(scene, 0, 3, 1);
    BpFilm *rest = make_film(scene, 3, 5, 1), *read = NULL;
    BpFilmInfo info;
    uint64_t first = 9, count = 9;

    bp_film_info(rest, &info);
    assert_string_equal(info.title, "two balls");
    assert_int_equal(info.width, WIDTH);
    assert_int_equal(info.samples_per_pixel, 5);
    assert_int_equal(info.samples_least, 5);
    assert_int_equal(info.samples_most, 5);
    assert_int_equal(info.range_count, 1);
    assert_int_equal(info.seed, 1);
    assert_true(info.segments >= (uint64_t)5 * info.width * info.height);
    assert_false(info.partial);
    assert_true(bp_film_range(rest, 0, &first, &count));
    assert_int_equal(first, 3);
    assert_int_equal(count, 5);
    first = 9;
    assert_false(bp_film_range(rest, 1, &first, &count));
    assert_int_equal(first, 9);

    const int descriptor = mkstemp(path);
    assert_true(descriptor >= 0);
    close(descriptor);
    must(bp_film_write(rest, path, &err));
    must(bp_film_read(path, &read, &err));
    assert_same_films(rest, read);
    must(bp_film_merge(sum, read, &err));
    assert_same_films(sum, whole);
    assert_true(bp_film_nrmse(sum) > 0 && bp_film_nrmse(sum) == bp_film_nrmse(whole));

    assert_int_equal(bp_film_merge(sum, read, NULL), BP_ERR_USAGE); /* the same samples twice */
    assert_int_equal(bp_film_merge(sum, sum, &err), BP_ERR_USAGE);
    assert_same_films(sum, whole);
    bp_film_destroy(&read);
    assert_null(read);
    assert_int_equal(truncate(path, 100), 0);
    assert_int_equal(bp_film_read(path, &read, NULL), BP_ERR_FILE);
    assert_int_equal(bp_film_write(sum, "/nowhere/at/all.bpa", NULL), BP_ERR_FILE);
    assert_null(read);
    unlink(path);
    bp_film_destroy(&whole);
    bp_film_destroy(&sum);
    bp_film_destroy(&rest);
    bp_scene_destroy(&scene);
}

/* A film is its taker's: the render goes on, and gives another one. */
static void film_of_a_render_under_way(void **state) {
    (void)state;
    BpScene *scene = make_scene();
    BpRender *render = make_render(scene, 0, 2, 1);
    BpFilm *early = NULL, *late = NULL, *whole = make_film(scene, 0, 8, 1), *part = make_film(scene, 0, 2, 1);
    run_to_end(render);
    must(bp_render_film(render, &early, &err));
    must(bp_render_extend(render, 8, &err));
    run_to_end(render);
    assert_int_equal(bp_render_samples_done(render), 8);
    must(bp_render_film(render, &late, &err));
    assert_same_films(early, part);
    assert_same_films(late, whole);
    BpPicture picture = {0}, other = {0};
    must(bp_render_read(render, &picture, &err));
    must(bp_film_picture(late, &other, &err));
    assert_same_pictures(&picture, &other);

    must(bp_render_aovs(render, &picture, &err));
    assert_true(picture.depth != NULL && picture.normal != NULL && picture.albedo != NULL);
    /* A film holds them too. */
    const size_t pixels = (size_t)picture.width * picture.height;
    assert_memory_equal(picture.depth, other.depth, pixels * sizeof *picture.depth);
    assert_memory_equal(picture.normal, other.normal, 3 * pixels * sizeof *picture.normal);
    assert_memory_equal(picture.albedo, other.albedo, 3 * pixels * sizeof *picture.albedo);
    other.width++;
    assert_int_equal(bp_render_aovs(render, &other, &err), BP_ERR_USAGE);
    bp_picture_clear(&picture);
    bp_picture_clear(&other);
    bp_film_destroy(&early);
    bp_film_destroy(&late);
    bp_film_destroy(&whole);
    bp_film_destroy(&part);
    bp_render_destroy(&render);
    bp_scene_destroy(&scene);
}

/* ---- stop rules ---- */

static BpStopReason render_until(const BpScene *scene, const BpStopRule *rule, bool look, uint64_t *samples,
                                 double *nrmse) {
    BpRender *render = make_render(scene, 0, 8, 1);
    BpStop *stop = NULL;
    BpStopReason reason = BP_STOP_NOT_YET, again;
    BpProgress progress;
    double seconds = 0;
    must(bp_stop_create(render, rule, &stop, &err));
    while (reason == BP_STOP_NOT_YET) {
        must(bp_render_step(render, &progress, &err));
        if (look) {
            BpStopEstimate estimate;
            must(bp_stop_estimate(stop, &progress, &estimate, &err));
            assert_true(estimate.seconds >= seconds);
            assert_true(estimate.fraction >= 0 && estimate.fraction <= 1);
            assert_true(isnan(estimate.seconds_left) || estimate.seconds_left >= 0);
            assert_true(estimate.samples_per_second > 0);
            seconds = estimate.seconds;
        }
        must(bp_stop_check(stop, &progress, &reason, &err));
    }
    must(bp_stop_check(stop, &progress, &again, &err));
    assert_int_equal(again, reason);
    *samples = bp_render_samples_done(render);
    BpFilm *film = NULL;
    must(bp_render_film(render, &film, &err));
    *nrmse = bp_film_nrmse(film);
    bp_film_destroy(&film);
    bp_stop_destroy(&stop);
    assert_null(stop);
    bp_render_destroy(&render);
    return reason;
}

static void rules_stop(void **state) {
    (void)state;
    BpScene *scene = make_scene();
    BpRenderOptions options;
    BpStopRule rule;
    uint64_t samples = 0, again = 0;
    double nrmse = 0;
    bp_render_defaults(scene, &options);
    bp_stop_rule_defaults(scene, &options, &rule);
    assert_int_equal(rule.samples_max, 8);
    assert_int_equal(rule.samples_min, 116); /* 65536 samples in 576 pixels, rounded up to fours */
    assert_int_equal(render_until(scene, &rule, false, &samples, &nrmse), BP_STOP_SAMPLES);
    assert_int_equal(samples, 8);

    rule.error = 0.005;
    assert_int_equal(render_until(scene, &rule, false, &samples, &nrmse), BP_STOP_SAMPLES);
    assert_int_equal(samples, 8);
    rule.samples_max = 0; /* as many as it takes */
    assert_int_equal(render_until(scene, &rule, false, &samples, &nrmse), BP_STOP_ERROR);
    assert_true(nrmse <= 0.005 && nrmse > 0.003);
    assert_true(samples > rule.samples_min);
    assert_int_equal(render_until(scene, &rule, true, &again, &nrmse), BP_STOP_ERROR);
    assert_int_equal(again, samples); /* and looking changes nothing */

    rule.error = 0;
    rule.seconds = 0.5;
    assert_int_equal(render_until(scene, &rule, true, &samples, &nrmse), BP_STOP_TIME);
    assert_true(samples >= 1);
    assert_string_equal(bp_stop_reason_name(BP_STOP_TIME), "time");
    bp_scene_destroy(&scene);
}

static void bad_rules_are_refused(void **state) {
    (void)state;
    BpScene *scene = make_scene();
    BpRender *render = make_render(scene, 0, 8, 1);
    BpStopRule good = {.error = 0.1, .samples_min = 16}, rule;
    BpStop *stop = NULL;
    const double bad[] = {-1, (double)NAN, (double)INFINITY};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        rule = good;
        rule.error = bad[i];
        assert_int_equal(bp_stop_create(render, &rule, &stop, NULL), BP_ERR_USAGE);
        rule = good;
        rule.seconds = bad[i];
        assert_int_equal(bp_stop_create(render, &rule, &stop, &err), BP_ERR_USAGE);
    }
    rule = good;
    rule.error = 0;
    assert_int_equal(bp_stop_create(render, &rule, &stop, &err), BP_ERR_USAGE);
    assert_non_null(strstr(err.message, "never stop"));
    rule = good;
    rule.adaptive = true;
    assert_int_equal(bp_stop_create(render, &rule, &stop, &err), BP_ERR_USAGE);
    rule = good;
    rule.samples_max = (uint64_t)1 << 31;
    assert_int_equal(bp_stop_create(render, &rule, &stop, &err), BP_ERR_LIMIT);
    assert_null(stop);

    must(bp_render_extend(render, 4, &err)); /* lowers, before the first step */
    run_to_end(render);
    assert_int_equal(bp_render_samples_done(render), 4);
    assert_int_equal(bp_render_extend(render, 3, NULL), BP_ERR_USAGE);
    assert_int_equal(bp_stop_create(render, &good, &stop, &err), BP_ERR_USAGE);
    assert_non_null(strstr(err.message, "first step"));
    bp_render_destroy(&render);
    bp_scene_destroy(&scene);
}

/* ---- studies ---- */

static void studies_give_texts(void **state) {
    (void)state;
    static const char *const marks[] = {[BP_STUDY_TABLE] = "reference:",
                                        [BP_STUDY_JSON] = "\"advice\"",
                                        [BP_STUDY_CSV] = ",",
                                        [BP_STUDY_PAGE] = "</html>"};
    BpScene *scene = make_scene();
    BpStudy *study = NULL;
    BpStudyProgress progress = {0};
    char *text = NULL;
    assert_int_equal(bp_study_create(scene, NULL, NULL, 0, 0, 0, &study, NULL), BP_ERR_USAGE);
    assert_int_equal(bp_study_create(scene, NULL, NULL, 0, 0, (double)NAN, &study, &err), BP_ERR_USAGE);
    assert_null(study);
    must(bp_study_create(scene, NULL, NULL, 0, 0, 0.1, &study, &err));
    must(bp_study_step(study, &progress, &err));
    assert_int_equal(bp_study_text(study, BP_STUDY_JSON, &text, NULL), BP_ERR_USAGE);
    assert_int_equal(bp_study_stop(study, &err), BP_ERR_INTERRUPTED);
    while (!progress.finished) must(bp_study_step(study, &progress, &err));
    for (int format = BP_STUDY_TABLE; format <= BP_STUDY_PAGE; format++) {
        must(bp_study_text(study, (BpStudyFormat)format, &text, &err));
        assert_non_null(strstr(text, marks[format]));
        bp_free(text);
        text = NULL;
    }
    assert_int_equal(bp_study_text(study, (BpStudyFormat)4, &text, &err), BP_ERR_USAGE);
    assert_null(text);
    bp_study_destroy(&study);
    bp_scene_destroy(&scene);
}

/* ---- wrong use, nothing at all ---- */

static void wrong_use_is_refused(void **state) {
    (void)state;
    BpScene *scene = NULL;
    BpRender *render = NULL;
    BpFilm *film = NULL;
    BpStop *stop = NULL;
    BpStudy *study = NULL;
    BpPicture picture = {0};
    uint8_t color[3];
    assert_int_equal(bp_scene_parse("{", 1, "document", &scene, NULL), BP_ERR_SCENE);
    assert_int_equal(bp_scene_load("/nowhere", &scene, NULL), BP_ERR_SCENE);
    assert_null(scene);
    scene = make_scene();
    BpRenderOptions options;
    bp_render_defaults(scene, &options);
    options.samples_per_pixel = 0;
    assert_int_equal(bp_render_create(scene, &options, NULL, 0, &render, NULL), BP_ERR_USAGE);
    assert_null(render);
    assert_int_equal(bp_scene_set_width(scene, 0, NULL), BP_ERR_USAGE);

    float rgb[3] = {1, 1, 1}, error[3] = {0.1f, 0.1f, 0.1f};
    uint64_t samples = 1;
    assert_int_equal(bp_picture_write(&picture, "/tmp/x.png", BP_FORMAT_PNG, BP_TRANSFER_SRGB, NULL),
                     BP_ERR_USAGE);
    assert_int_equal(bp_error_map_write(&picture, "/tmp/x.png", NULL), BP_ERR_USAGE);
    picture = (BpPicture){.width = 1, .height = 1, .rgb = rgb, .samples = &samples};
    assert_int_equal(bp_picture_write(&picture, "/tmp/x.bpa", BP_FORMAT_BPA, BP_TRANSFER_SRGB, &err),
                     BP_ERR_USAGE);
    assert_int_equal(bp_error_map_write(&picture, "/tmp/x.png", &err), BP_ERR_USAGE);
    picture.error = error;
    assert_true(fabs(bp_pixel_relative_error(&picture, 0) - 0.1) < 1e-6);
    assert_int_equal(bp_error_map_write(&picture, "/nowhere/x.png", NULL), BP_ERR_FILE);
    bp_error_color((double)NAN, color);
    assert_int_equal(color[0], color[2]);

    bp_scene_destroy(&scene);
    bp_scene_destroy(&scene); /* it is NULL now */
    bp_render_destroy(&render);
    bp_film_destroy(&film);
    bp_stop_destroy(&stop);
    bp_study_destroy(&study);
    bp_scene_destroy(NULL);
    bp_render_destroy(NULL);
    bp_film_destroy(NULL);
    bp_stop_destroy(NULL);
    bp_study_destroy(NULL);
    bp_picture_clear(NULL);
    bp_error_clear(NULL);
    bp_free(NULL);
    assert_int_equal(bp_api_version(), BP_API_VERSION);
    assert_string_equal(bp_status_name((BpStatus)99), "unknown status");
    assert_int_not_equal(bp_status_exit_code((BpStatus)99), 0);
}

/* ---- threads ---- */

typedef struct Job {
    const BpScene *scene;
    uint64_t seed;
    BpFilm *film;
    BpStatus status;
    BpError err;
} Job;

static void *work(void *argument) {
    Job *job = argument;
    BpRender *render = NULL;
    BpRenderOptions options;
    BpProgress progress = {0};
    bp_render_defaults(job->scene, &options);
    options.samples_per_pixel = 200;
    options.chunk_samples = 4000; /* many small steps, so that the two are between each other */
    options.seed = job->seed;
    job->status = bp_render_create(job->scene, &options, NULL, 0, &render, &job->err);
    while (job->status == BP_OK && !progress.finished)
        job->status = bp_render_step(render, &progress, &job->err);
    if (job->status == BP_OK) job->status = bp_render_film(render, &job->film, &job->err);
    bp_render_destroy(&render);
    return NULL;
}

/* Two threads render one scene at the same time as they would one after the other. */
static void threads_do_not_meet(void **state) {
    (void)state;
    BpScene *scene = make_scene();
    Job jobs[4];
    pthread_t threads[2];
    for (size_t j = 0; j < 4; j++) jobs[j] = (Job){.scene = scene, .seed = 1 + j % 2};
    for (size_t j = 0; j < 2; j++) assert_int_equal(pthread_create(&threads[j], NULL, work, &jobs[j]), 0);
    for (size_t j = 0; j < 2; j++) assert_int_equal(pthread_join(threads[j], NULL), 0);
    for (size_t j = 2; j < 4; j++) work(&jobs[j]);
    for (size_t j = 0; j < 4; j++)
        if (jobs[j].status != BP_OK) fail_msg("%s", jobs[j].err.message);
    assert_same_films(jobs[0].film, jobs[2].film);
    assert_same_films(jobs[1].film, jobs[3].film);
    for (size_t j = 0; j < 4; j++) bp_film_destroy(&jobs[j].film);
    bp_scene_destroy(&scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(films_add_up),        cmocka_unit_test(film_of_a_render_under_way),
        cmocka_unit_test(rules_stop),          cmocka_unit_test(bad_rules_are_refused),
        cmocka_unit_test(studies_give_texts),  cmocka_unit_test(wrong_use_is_refused),
        cmocka_unit_test(threads_do_not_meet),
    };
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    bp_error_clear(&err);
    return failed;
}
