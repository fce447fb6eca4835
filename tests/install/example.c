/* example.c: a picture from libballpark, start to end. Usage: example SCENE.json PICTURE.png
 * cc example.c $(pkg-config --cflags --libs ballpark) */
#include <ballpark.h>

#include <stdio.h>

static BpStatus draw(const char *scene_path, const char *picture_path, BpError *err) {
    BpScene *scene = NULL;
    BpRender *render = NULL;
    BpRenderOptions options;
    BpProgress progress = {0};
    BpPicture picture = {0};
    BpStatus status = bp_scene_load(scene_path, &scene, err);
    if (status == BP_OK) status = bp_scene_set_width(scene, 160, err);
    if (status == BP_OK) {
        bp_render_defaults(scene, &options);
        options.samples_per_pixel = 16;
        status = bp_render_create(scene, &options, NULL, 0, &render, err); /* no list: the default device */
    }
    while (status == BP_OK && !progress.finished) {
        status = bp_render_step(render, &progress, err);
        printf("\r%.0f %%", 100.0 * (double)progress.samples_done / (double)progress.samples_total);
    }
    if (status == BP_OK) printf("\n");
    if (status == BP_OK) status = bp_render_read(render, &picture, err);
    if (status == BP_OK)
        status = bp_picture_write(&picture, picture_path, BP_FORMAT_PNG, BP_TRANSFER_GAMMA2, err);
    bp_picture_clear(&picture);
    bp_render_destroy(&render);
    bp_scene_destroy(&scene);
    return status;
}

int main(int argc, char **argv) {
    BpError err = {0};
    if (argc != 3) return fprintf(stderr, "usage: example SCENE.json PICTURE.png\n"), 2;
    const BpStatus status = draw(argv[1], argv[2], &err);
    bp_error_add_remedy(&err, BP_INTERFACE_C);
    if (status != BP_OK)
        fprintf(stderr, "example: %s%s%s\n", err.file, err.file[0] != '\0' ? ": " : "", err.message);
    bp_error_clear(&err);
    return bp_status_exit_code(status);
}
