/* viewer.c: see viewer.h.
 *
 * While the camera moves, each picture has one sample per pixel and as few pixels as it takes to show several
 * a second. When it has rested for a moment, the picture is rendered at its full size, and its samples double
 * from pass to pass until noise is where the person wants it. A move interrupts that, but not a picture of
 * the camera moving, or else somebody who does not stop would see none. */
#include "viewer.h"

#include "base/clock.h"
#include "base/format.h"
#include "base/status.h"
#include "film/film.h"
#include "image/image.h"
#include "reference/trace.h"
#include "render/render.h"
#include "scene/camera_moves.h"
#include "scene/lighting.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define REST_SECONDS 0.3       /* until a camera that has moved counts as resting */
#define SHOW_SECONDS 0.1       /* between two pictures of the same camera */
#define TITLE_SECONDS 0.5      /* between two titles */
#define FRAME_SECONDS 0.06     /* that a picture of a moving camera should take */
#define LEAST_PIXELS 4000.0    /* of a picture of a moving camera: 84 x 47 */
#define FIRST_PIXELS 57600.0   /* of the first picture, when the speed is not known: 320 x 180 */
#define BLACK_SAMPLES 1024     /* per pixel, after which a picture without light counts as black */
#define DEGREES_A_WINDOW 180.0 /* a drag across the whole height */

const char bp_view_keys[] = "left drag    orbit around the point that the camera looks at\n"
                            "right drag   pan (also: Shift and left drag)\n"
                            "wheel        zoom in and out\n"
                            "left click   focus on what is under the pointer\n"
                            "[ ]          smaller, larger aperture\n"
                            "- +          darker, brighter; 0: neither\n"
                            "s            save the picture, and print the command that renders it\n"
                            "r            go back to the first camera\n"
                            "q, Escape    quit\n";

typedef struct Viewer {
    const BpViewPlan *plan;
    const BpWindow *window;
    BpScene *scene;
    BpCamera first; /* at the beginning */
    BpRender *render;
    uint32_t width;         /* of the picture when the camera rests */
    double window_height;   /* for drags, in pixels */
    double shrink;          /* of pictures while it moves; at least 1 */
    double exposure;        /* in stops */
    bool moved, quit, save; /* since the last step */
    bool shown;             /* the newest samples have been */
    bool moving;            /* the picture at hand is one of a moving camera */
    double moved_at, restarted_at, traced_at, shown_at, titled_at; /* traced_at: its first sample was begun */
    uint64_t samples;                                              /* per pixel, of the pass at hand */
    uint64_t samples_done;                                         /* of all pixels */
    double nrmse;                                                  /* of what has been shown */
    bool rests;                                                    /* nothing is left to do */
    uint8_t *bytes;
    size_t byte_count;
} Viewer;

static BpStatus window_failed(const char *reason, BpError *err) {
    return bp_fail(err, BP_ERR_DEVICE, "the window: %s", reason);
}

static BpStatus not_opened(const char *reason, BpError *err) {
    if (reason == NULL) return BP_OK;
    return bp_fail(err, BP_ERR_DEVICE,
                   "no window can be opened: %s; without one, `ballpark render --show` draws in the terminal",
                   reason);
}

/* ---- what the person does ------------------------------------------------------------------------------ */

/* Focuses on what the pixel at (x, y) shows first, x and y being shares of the picture. A click on the sky
 * does nothing. */
static void focus_at(Viewer *viewer, double x, double y) {
    BpCamera sharp = viewer->scene->camera;
    if (!(x >= 0 && x < 1 && y >= 0 && y < 1)) return;
    sharp.lens_radius = 0; /* the ray through the lens's centre */
    sharp.pixel_sampling = BP_PIXEL_CENTER;
    const Camera camera = bp_ref_camera(&sharp);
    Random random = {0};
    Hit hit;
    double height;
    const Ray ray = bp_ref_camera_ray(&camera, (uint32_t)(x * sharp.width), (uint32_t)(y * sharp.height),
                                      &random, &height);
    if (!bp_ref_hit(viewer->scene, &ray, &hit)) return;
    double view[3], length = 0, depth = 0;
    const double point[3] = {hit.point.x, hit.point.y, hit.point.z};
    for (int i = 0; i < 3; ++i) {
        view[i] = sharp.lookat[i] - sharp.lookfrom[i];
        length += view[i] * view[i];
    }
    for (int i = 0; i < 3; ++i) depth += (point[i] - sharp.lookfrom[i]) * view[i] / sqrt(length);
    bp_camera_focus(&viewer->scene->camera, depth);
    viewer->moved = viewer->scene->camera.lens_radius > 0 || viewer->moved;
}

static void press(Viewer *viewer, char key) {
    BpCamera *camera = &viewer->scene->camera;
    switch (key) {
    case 'q':
    case '\033':
        viewer->quit = true;
        break;
    case 's':
        viewer->save = true;
        break;
    case '+':
    case '=':
    case '-':
    case '0':
        viewer->exposure = key == '0' ? 0 : viewer->exposure + (key == '-' ? -1.0 : 1.0) / 3;
        if (fabs(viewer->exposure) < 1e-9) viewer->exposure = 0; /* three thirds and back */
        viewer->shown = false;
        viewer->shown_at = 0;
        break;
    case '[':
    case ']':
        bp_camera_widen(camera, key == '[' ? 1 / 1.25 : 1.25);
        viewer->moved = true;
        break;
    case 'r':
        *camera = viewer->first;
        viewer->moved = true;
        break;
    default:
        break;
    }
}

static void drag(Viewer *viewer, const BpWindowEvent *event) {
    const double right = event->dx / viewer->window_height, down = event->dy / viewer->window_height;
    if (event->button == BP_BUTTON_RIGHT || event->button == BP_BUTTON_MIDDLE || event->shift)
        bp_camera_pan(&viewer->scene->camera, right, down);
    else
        bp_camera_orbit(&viewer->scene->camera, -DEGREES_A_WINDOW * right, DEGREES_A_WINDOW * down);
    viewer->moved = true;
}

static void resize(Viewer *viewer, uint32_t width, uint32_t height) {
    const double aspect = (double)viewer->scene->camera.width / viewer->scene->camera.height;
    const double fits = fmin(width, height * aspect);
    viewer->width = (uint32_t)fmax(1, fmin(BP_PICTURE_SIDE_MAX, floor(fits + 0.5)));
    viewer->window_height = fmax(1, fits / aspect);
    viewer->moved = true;
}

static void obey(Viewer *viewer, const BpWindowEvent *event) {
    switch (event->action) {
    case BP_WINDOW_QUIT:
        viewer->quit = true;
        break;
    case BP_WINDOW_RESIZE:
        resize(viewer, event->width, event->height);
        break;
    case BP_WINDOW_DRAG:
        drag(viewer, event);
        break;
    case BP_WINDOW_CLICK:
        if (event->button == BP_BUTTON_LEFT) focus_at(viewer, event->x, event->y);
        break;
    case BP_WINDOW_WHEEL:
        bp_camera_approach(&viewer->scene->camera, pow(0.9, event->dy));
        viewer->moved = true;
        break;
    case BP_WINDOW_KEY:
        press(viewer, event->key);
        break;
    case BP_WINDOW_NOTHING:
        break;
    }
}

/* Handles all events that have come; waits for one if there is nothing to render. */
static void listen(Viewer *viewer) {
    BpWindowEvent event;
    const bool idle = viewer->rests && viewer->shown;
    viewer->window->next(idle ? 200 : 0, &event);
    while (event.action != BP_WINDOW_NOTHING && !viewer->quit) {
        obey(viewer, &event);
        viewer->window->next(0, &event);
    }
}

/* ---- rendering ---------------------------------------------------------------------------------------- */

static BpStatus restart(Viewer *viewer, bool moving, BpError *err) {
    const double width = moving ? fmax(1, floor(viewer->width / viewer->shrink + 0.5)) : viewer->width;
    BpRenderOptions options = viewer->plan->options;
    options.samples_per_pixel = 1;
    /* Each place of the camera would be looked at anew, which takes longer than a picture may. */
    if (options.caustics == BP_CAUSTICS_AUTO) options.caustics = BP_CAUSTICS_OFF;
    bp_render_destroy(&viewer->render);
    BP_TRY(bp_scene_set_width(viewer->scene, (uint32_t)width, err));
    bp_lighting_place(viewer->scene); /* lighting by name is the camera's */
    viewer->restarted_at = bp_clock_seconds();
    viewer->samples = 1;
    viewer->samples_done = 0;
    viewer->moved = viewer->rests = viewer->shown = false;
    viewer->moving = moving;
    viewer->nrmse = (double)NAN;
    BP_TRY(bp_render_create_on(viewer->scene, &options, viewer->plan->devices, viewer->plan->device_count,
                               &viewer->render, err));
    viewer->traced_at = bp_clock_seconds();
    return BP_OK;
}

/* Seconds that tracing a picture of a moving camera should take. What comes before, such as building the
 * tree, takes the same time for every size, so there is no use in a size that takes much less than that. */
static double frame_seconds(const Viewer *viewer) {
    const double before = viewer->traced_at - viewer->restarted_at;
    return fmax(FRAME_SECONDS - before, before / 4);
}

static double shrink_to(const Viewer *viewer, double pixels) {
    const double aspect = (double)viewer->scene->camera.width / viewer->scene->camera.height;
    return fmax(1, viewer->width / sqrt(fmax(pixels, LEAST_PIXELS) * aspect));
}

/* The size of pictures while the camera moves, by how long so many samples took, the first of each pixel. It
 * stays while it is about right, since sizes that change at every picture are unpleasant to look at. */
static void adapt_size(Viewer *viewer, uint64_t samples, double seconds) {
    const double wanted = frame_seconds(viewer);
    const bool is_right = viewer->moving && seconds > 0.5 * wanted && seconds < 1.5 * wanted;
    if (!is_right) viewer->shrink = shrink_to(viewer, (double)samples * wanted / fmax(seconds, 1e-6));
}

/* Whether the picture of a moving camera has still to be shown. If it takes far too long, it need not be, and
 * the next one will be smaller. */
static bool must_be_shown(Viewer *viewer, double now) {
    if (!viewer->moving || viewer->samples > 1 || viewer->rests) return false;
    const double seconds = now - viewer->traced_at;
    if (seconds < 3 * frame_seconds(viewer) || viewer->shrink >= shrink_to(viewer, 0)) return true;
    adapt_size(viewer, viewer->samples_done, seconds);
    return false;
}

/* The picture as the window shows it. The caller clears it. */
static BpStatus read_picture(Viewer *viewer, BpPicture *picture, BpError *err) {
    const BpFilm *film = NULL;
    BP_TRY(bp_render_read_film(viewer->render, &film, err));
    viewer->nrmse = bp_film_nrmse(film);
    BP_TRY(bp_film_picture(film, picture, err));
    bp_picture_expose(picture, viewer->exposure);
    return BP_OK;
}

static BpStatus show(Viewer *viewer, BpError *err) {
    BpPicture picture = {0};
    BpStatus status = read_picture(viewer, &picture, err);
    const size_t count = (size_t)picture.width * picture.height * 3;
    if (status == BP_OK && count > viewer->byte_count) {
        free(viewer->bytes);
        viewer->bytes = malloc(count);
        viewer->byte_count = viewer->bytes != NULL ? count : 0;
        if (viewer->bytes == NULL)
            status = bp_fail(err, BP_ERR_MEMORY, "out of memory for the window's picture");
    }
    if (status == BP_OK) {
        for (size_t i = 0; i < count; ++i)
            viewer->bytes[i] = bp_transfer_byte((double)picture.rgb[i], viewer->plan->transfer);
        const char *fault = viewer->window->show(viewer->bytes, picture.width, picture.height);
        if (fault != NULL) status = window_failed(fault, err);
        viewer->shown = true;
        viewer->shown_at = bp_clock_seconds();
    }
    bp_picture_clear(&picture);
    return status;
}

/* "cover.json: 640x360, 64 samples, noise 2.1 %, 1 % in 12 s, +0.33 stops" */
static void set_title(Viewer *viewer) {
    char text[512], noise[32], left[32];
    const BpCamera *camera = &viewer->scene->camera;
    const double spent = bp_clock_seconds() - viewer->restarted_at;
    int used = snprintf(text, sizeof text, "%.200s: %ux%u, %llu sample%s", viewer->plan->name,
                        (unsigned)camera->width, (unsigned)camera->height,
                        (unsigned long long)viewer->samples, viewer->samples == 1 ? "" : "s");
    if (viewer->nrmse > 0) {
        used += snprintf(text + used, sizeof text - (size_t)used, ", noise %s",
                         bp_format_percent(viewer->nrmse, noise, sizeof noise));
        const double ratio = viewer->nrmse / viewer->plan->target;
        if (ratio > 1) /* noise falls with the square root of time */
            used +=
                snprintf(text + used, sizeof text - (size_t)used, ", %g %% in %s", 100 * viewer->plan->target,
                         bp_format_seconds(spent * (ratio * ratio - 1), left, sizeof left));
    }
    if (viewer->exposure != 0)
        snprintf(text + used, sizeof text - (size_t)used, ", %+.2f stops", viewer->exposure);
    viewer->window->title(text);
    viewer->titled_at = bp_clock_seconds();
}

static BpStatus save(Viewer *viewer, BpError *err) {
    BpPicture picture = {0};
    BpStatus status = read_picture(viewer, &picture, err);
    if (status == BP_OK)
        status = viewer->plan->save(viewer->plan->context, viewer->scene, &picture, viewer->exposure, err);
    bp_picture_clear(&picture);
    return status;
}

/* A pass is finished: shows it if it is time, and begins the next. */
static BpStatus finish_pass(Viewer *viewer, BpError *err) {
    const double now = bp_clock_seconds();
    const bool small = viewer->scene->camera.width < viewer->width;
    if (viewer->samples == 1)
        adapt_size(viewer, viewer->scene->camera.width * (uint64_t)viewer->scene->camera.height,
                   now - viewer->traced_at);
    if (viewer->samples == 1 || now - viewer->shown_at >= SHOW_SECONDS) BP_TRY(show(viewer, err));
    const uint64_t most = viewer->plan->options.samples_per_pixel;
    if (small && viewer->samples >= 8) { /* the picture in full size is to come */
        viewer->rests = true;
        return BP_OK;
    }
    const bool black = isnan(viewer->nrmse) && viewer->samples >= BLACK_SAMPLES;
    if (viewer->samples >= most || viewer->nrmse <= viewer->plan->target || black) {
        viewer->rests = true;
        return viewer->shown ? BP_OK : show(viewer, err);
    }
    viewer->samples = viewer->samples > most / 2 ? most : 2 * viewer->samples;
    viewer->shown = false;
    return bp_render_extend(viewer->render, viewer->samples, err);
}

static BpStatus work(Viewer *viewer, BpError *err) {
    const double now = bp_clock_seconds();
    const bool rested = now - viewer->moved_at > REST_SECONDS;
    if (viewer->moved) viewer->moved_at = now;
    if ((viewer->moved || (rested && viewer->scene->camera.width != viewer->width)) &&
        !must_be_shown(viewer, now))
        BP_TRY(restart(viewer, viewer->moved, err));
    if (!viewer->rests) {
        BpProgress progress = {0};
        BP_TRY(bp_render_step_chunk(viewer->render, &progress, err));
        viewer->samples_done = progress.samples_done;
        if (progress.finished) BP_TRY(finish_pass(viewer, err));
    }
    /* A long pass is shown as it grows; the first is not, since it has pixels without a sample. */
    const double later = bp_clock_seconds();
    if (!viewer->shown && (viewer->samples > 1 || viewer->rests) && later - viewer->shown_at >= SHOW_SECONDS)
        BP_TRY(show(viewer, err));
    if (later - viewer->titled_at >= TITLE_SECONDS) set_title(viewer);
    return BP_OK;
}

BpStatus bp_view_ready(const BpWindow *window, BpError *err) {
    return not_opened(window->ready(), err);
}

BpStatus bp_view(const BpViewPlan *plan, BpScene *scene, BpError *err) {
    Viewer viewer = {.plan = plan,
                     .window = plan->window,
                     .scene = scene,
                     .first = scene->camera,
                     .width = scene->camera.width,
                     .window_height = scene->camera.height,
                     .exposure = plan->exposure,
                     .nrmse = (double)NAN};
    BpStatus status = BP_OK;
    const uint32_t height = scene->camera.height;
    BP_TRY_GOTO(status, not_opened(plan->window->open(plan->name, viewer.width, height), err), done);
    plan->opened(plan->context);
    viewer.shrink = shrink_to(&viewer, FIRST_PIXELS);
    viewer.moved_at = bp_clock_seconds();
    BP_TRY_GOTO(status, restart(&viewer, true, err), done);
    while (!viewer.quit) {
        listen(&viewer);
        if (viewer.quit) break;
        if (plan->interrupted()) {
            status = bp_fail(err, BP_ERR_INTERRUPTED, "interrupted: the window was closed");
            break;
        }
        BP_TRY_GOTO(status, work(&viewer, err), done);
        if (viewer.save) BP_TRY_GOTO(status, save(&viewer, err), done);
        viewer.save = false;
    }
done:
    bp_render_destroy(&viewer.render);
    free(viewer.bytes);
    return status;
}
