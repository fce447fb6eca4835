/* until_error.c: renders until an error is reached, and writes an EXR with its layers.
 * Usage: until_error SCENE.json ERROR PICTURE.exr SUMS.bpa; an ERROR of 0.02 is 2 % of the mean brightness.
 * cc until_error.c $(pkg-config --cflags --libs ballpark) */
#include <ballpark.h>

#include <stdio.h>
#include <stdlib.h>

static BpStatus open_render(const BpScene *scene, double error, BpRender **render, BpStop **stop,
                            BpError *err) {
    BpRenderOptions options;
    BpStopRule rule;
    bp_render_defaults(scene, &options);
    options.sampler = BP_SAMPLER_SOBOL; /* less noise in the same time */
    options.features = true;            /* for the layers of depth, normals and albedo */
    bp_stop_rule_defaults(scene, &options, &rule);
    rule.error = error;
    rule.samples_max = 0; /* as many as it takes */
    const BpStatus status = bp_render_create(scene, &options, NULL, 0, render, err);
    return status == BP_OK ? bp_stop_create(*render, &rule, stop, err) : status;
}

static BpStatus run(BpRender *render, BpStop *stop, BpStopReason *reason, BpError *err) {
    BpStatus status = BP_OK;
    BpProgress progress;
    BpStopEstimate estimate;
    while (status == BP_OK && *reason == BP_STOP_NOT_YET) {
        status = bp_render_step(render, &progress, err);
        if (status == BP_OK) status = bp_stop_estimate(stop, &progress, &estimate, err);
        if (status == BP_OK) status = bp_stop_check(stop, &progress, reason, err);
        if (status == BP_OK)
            fprintf(stderr, "\r%3.0f %%, %.1f s left ", 100 * estimate.fraction, estimate.seconds_left);
    }
    fprintf(stderr, "\n");
    return status;
}

/* The picture with every layer, and the sums behind it, to which more samples can be added another day. */
static BpStatus write_results(BpRender *render, const char *picture_path, const char *film_path,
                              BpStopReason reason, BpError *err) {
    BpPicture picture = {0};
    BpFilm *film = NULL;
    BpFilmInfo info;
    BpStatus status = bp_render_film(render, &film, err);
    if (status == BP_OK) status = bp_film_write(film, film_path, err);
    if (status == BP_OK) status = bp_film_picture(film, &picture, err);
    if (status == BP_OK) status = bp_render_aovs(render, &picture, err);
    if (status == BP_OK)
        status = bp_picture_write(&picture, picture_path, BP_FORMAT_EXR, BP_TRANSFER_LINEAR, err);
    if (status == BP_OK) {
        bp_film_info(film, &info);
        printf("stopped by %s: error %.6f after %llu samples per pixel\n", bp_stop_reason_name(reason),
               bp_film_nrmse(film), (unsigned long long)info.samples_per_pixel);
    }
    bp_picture_clear(&picture);
    bp_film_destroy(&film);
    return status;
}

int main(int argc, char **argv) {
    BpError err = {0};
    BpScene *scene = NULL;
    BpRender *render = NULL;
    BpStop *stop = NULL;
    BpStopReason reason = BP_STOP_NOT_YET;
    if (argc != 5) return fprintf(stderr, "usage: until_error SCENE.json ERROR PICTURE.exr SUMS.bpa\n"), 2;
    BpStatus status = bp_scene_load(argv[1], &scene, &err);
    if (status == BP_OK) status = bp_scene_set_width(scene, 96, &err);
    if (status == BP_OK) status = open_render(scene, atof(argv[2]), &render, &stop, &err);
    if (status == BP_OK) status = run(render, stop, &reason, &err);
    if (status == BP_OK) status = write_results(render, argv[3], argv[4], reason, &err);
    bp_stop_destroy(&stop);
    bp_render_destroy(&render);
    bp_scene_destroy(&scene);
    bp_error_add_remedy(&err, BP_INTERFACE_C);
    if (status != BP_OK)
        fprintf(stderr, "until_error: %s%s%s\n", err.file, err.file[0] != '\0' ? ": " : "", err.message);
    bp_error_clear(&err);
    return bp_status_exit_code(status);
}
