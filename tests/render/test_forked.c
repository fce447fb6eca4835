/* test_forked.c: a process that was forked before anything used OpenCL renders; one that was forked later is
 * told why it cannot, and what it inherits does not make it wait.
 *
 * Only the public header is used, as another program would. What a child finds, its exit code says. */
#include <ballpark.h>

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

#define CHILD_SECONDS 120

static const char document[] =
    "{ \"camera\": { \"image_width\": 20, \"lookfrom\": [0, 1, 4], \"lookat\": [0, 0, 0], \"vfov\": 40 }, "
    "\"materials\": { \"blue\": { \"type\": \"lambertian\", \"albedo\": [0.25, 0.5, 0.75] } }, "
    "\"spheres\": [ { \"center\": [0, 0, 0], \"radius\": 0.5, \"material\": \"blue\" } ] }";

/* What a process has at hand when it forks. */
typedef struct Kept {
    BpScene *scene;
    BpRender *begun, *whole;
    BpStop *stop;
    BpFilm *film;
    BpPicture picture;
    BpDeviceInfo device;
    BpProgress progress;
} Kept;

typedef int Child(Kept *kept);

static BpError err;

static void must(BpStatus status) {
    if (status != BP_OK) fail_msg("%s", err.message);
}

static BpRender *begin(const BpScene *scene, uint64_t samples) {
    BpRender *render = NULL;
    BpRenderOptions options;
    bp_render_defaults(scene, &options);
    options.samples_per_pixel = samples;
    options.features = true;
    must(bp_render_create(scene, &options, NULL, 0, &render, &err));
    return render;
}

static void parse(Kept *kept) {
    must(bp_scene_parse(document, strlen(document), "document", &kept->scene, &err));
}

static void prepare(Kept *kept) {
    const BpStopRule rule = {.samples_max = 1u << 20};
    parse(kept);
    must(bp_device_find(NULL, &kept->device, &err));
    kept->begun = begin(kept->scene, 1u << 20);
    must(bp_stop_create(kept->begun, &rule, &kept->stop, &err));
    must(bp_render_step(kept->begun, &kept->progress, &err)); /* chunks are under way now */
    kept->whole = begin(kept->scene, 4);
    BpProgress progress = {0};
    do must(bp_render_step(kept->whole, &progress, &err));
    while (!progress.finished);
    must(bp_render_film(kept->whole, &kept->film, &err));
    must(bp_render_read(kept->whole, &kept->picture, &err));
}

static void destroy(Kept *kept) {
    bp_stop_destroy(&kept->stop);
    bp_render_destroy(&kept->begun);
    bp_render_destroy(&kept->whole);
    bp_film_destroy(&kept->film);
    bp_picture_clear(&kept->picture);
    bp_scene_destroy(&kept->scene);
}

/* The child's answer; a child that waits for ever is ended by SIGALRM. */
static int answer_of(Child *child, Kept *kept) {
    int status = 0;
    fflush(NULL);
    const pid_t process = fork();
    assert_true(process >= 0);
    if (process == 0) {
        alarm(CHILD_SECONDS);
        exit(child(kept)); /* with whatever drivers have registered by atexit() */
    }
    assert_int_equal(waitpid(process, &status, 0), process);
    if (!WIFEXITED(status)) fail_msg("the child ended by signal %d", WTERMSIG(status));
    return WEXITSTATUS(status);
}

static int draws(Kept *kept) {
    BpRender *render = NULL;
    BpPicture picture = {0};
    BpProgress progress = {0};
    BpStatus status = bp_render_create(kept->scene, NULL, NULL, 0, &render, &err);
    while (status == BP_OK && !progress.finished) status = bp_render_step(render, &progress, &err);
    if (status == BP_OK) status = bp_render_read(render, &picture, &err);
    if (status != BP_OK) fprintf(stderr, "%s\n", err.message);
    bp_picture_clear(&picture);
    bp_render_destroy(&render);
    return status == BP_OK ? 0 : 1;
}

static bool refused(BpStatus status) {
    const bool right = status == BP_ERR_DEVICE && err.code == BP_ERR_DEVICE &&
                       strstr(err.message, "forked") != NULL && strstr(err.message, "spawn") != NULL;
    if (!right) fprintf(stderr, "%s: %s\n", bp_status_name(status), err.message);
    bp_error_clear(&err);
    return right;
}

static int is_told_why(Kept *kept) {
    BpDeviceInfo *list = NULL, device;
    size_t count = 0;
    BpRender *render = NULL;
    BpFilm *film = NULL;
    BpPicture picture = {0};
    int answer = 0;
    if (!refused(bp_devices_list(&list, &count, &err))) answer = 2;
    if (!refused(bp_device_find("cpu", &device, &err))) answer = 3;
    if (!refused(bp_render_create(kept->scene, NULL, NULL, 0, &render, &err))) answer = 4;
    if (!refused(bp_render_create(kept->scene, NULL, &kept->device, 1, &render, &err))) answer = 5;
    if (!refused(bp_render_film(kept->begun, &film, &err))) answer = 6;
    if (!refused(bp_render_read(kept->begun, &picture, &err))) answer = 7;
    if (!refused(bp_render_aovs(kept->whole, &kept->picture, &err))) answer = 8;
    if (!refused(bp_render_step(kept->begun, &kept->progress, &err))) answer = 9;
    destroy(kept);
    return answer;
}

/* Pictures and scenes need no driver. */
static int has_its_films(Kept *kept) {
    BpPicture picture = {0};
    BpScene *scene = NULL;
    if (bp_film_picture(kept->film, &picture, &err) != BP_OK || picture.width != 20) return 1;
    if (bp_scene_parse(document, strlen(document), "document", &scene, &err) != BP_OK) return 2;
    bp_picture_clear(&picture);
    bp_scene_destroy(&scene);
    return 0;
}

static int forks_again(Kept *kept) {
    return answer_of(is_told_why, kept);
}

static int forks_after_drawing(Kept *kept) {
    if (draws(kept) != 0) return 1;
    return answer_of(draws, kept) == 1 ? 0 : 2;
}

/* Must come before the others: until here nothing has used OpenCL. */
static void test_fork_before(void **state) {
    (void)state;
    Kept kept = {0};
    parse(&kept);
    assert_int_equal(answer_of(draws, &kept), 0);
    assert_int_equal(answer_of(forks_after_drawing, &kept), 0);
    assert_int_equal(draws(&kept), 0);
    destroy(&kept);
}

static void test_fork_after(void **state) {
    (void)state;
    Kept kept = {0};
    prepare(&kept);
    assert_int_equal(answer_of(is_told_why, &kept), 0);
    assert_int_equal(answer_of(forks_again, &kept), 0);
    assert_int_equal(answer_of(has_its_films, &kept), 0);
    /* The parent notices nothing of it. */
    must(bp_render_step(kept.begun, &kept.progress, &err));
    assert_int_equal(draws(&kept), 0);
    destroy(&kept);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_fork_before), cmocka_unit_test(test_fork_after)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
