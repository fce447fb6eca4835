/* lighting.c: see lighting.h. */
#include "lighting.h"

#include "vector.h"

#include <math.h>
#include <string.h>

const char *const bp_lighting_names[BP_LIGHTING_COUNT] = {"sky", "soft", "studio", "rembrandt", "overhead"};

/* A lamp at infinity; its direction is given to the right of the picture, up in it, and towards the viewer.
 */
typedef struct Lamp {
    double direction[3], half_angle_degrees, radiance;
} Lamp;

#define LAMPS_MAX 2

/* Dome and lamps of one arrangement. What faces the light squarely is as bright as its own colour, more or
 * less: a lamp of the radiance L and the half angle a brings L sin^2 a. */
typedef struct Arrangement {
    double up[3], bottom, top; /* of the dome, in the same frame */
    size_t lamps;
    Lamp lamp[LAMPS_MAX];
} Arrangement;

static const Arrangement arrangements[BP_LIGHTING_COUNT] = {
    /* A wide gradient from the upper left, as under a sheet of cloth: no shadow has an edge. */
    [BP_LIGHTING_SOFT] = {.up = {-0.35, 0.85, 0.4}, .bottom = 0.35, .top = 1.35},
    /* A softbox at the upper left before a grey dome. */
    [BP_LIGHTING_STUDIO] =
        {.up = {0, 1, 0}, .bottom = 0.35, .top = 0.35, .lamps = 1, .lamp = {{{-0.7, 0.8, 0.75}, 45, 1.3}}},
    /* A key light 45 degrees to the right and 20 up, and a faint fill from the left. */
    [BP_LIGHTING_REMBRANDT] = {.up = {0, 1, 0},
                               .bottom = 0.02,
                               .top = 0.02,
                               .lamps = 2,
                               .lamp = {{{0.664463024388675, 0.342020143325669, 0.664463024388675}, 45, 1.6},
                                        {{-1, 0, 0}, 90, 0.12}}},
    /* One lamp above, a little before what is shown: depth from top to bottom, shadows below. */
    [BP_LIGHTING_OVERHEAD] =
        {.up = {0, 1, 0}, .bottom = 0.2, .top = 0.35, .lamps = 1, .lamp = {{{0, 1, 0.25}, 30, 2.6}}},
};

static void into_scene(double axes[3][3], const double direction[3], double out[3]) {
    for (int i = 0; i < 3; i++)
        out[i] = direction[0] * axes[0][i] + direction[1] * axes[1][i] + direction[2] * axes[2][i];
}

void bp_lighting_place(BpScene *scene) {
    const BpCamera *const camera = &scene->camera;
    const Arrangement *const light = &arrangements[scene->lighting];
    double axes[3][3]; /* right, up, towards the viewer */
    if (scene->lighting == BP_LIGHTING_SKY) return;
    for (int i = 0; i < 3; i++) axes[2][i] = camera->lookfrom[i] - camera->lookat[i];
    bp_normalize(axes[2]);
    bp_cross(camera->vup, axes[2], axes[0]);
    bp_normalize(axes[0]);
    bp_cross(axes[2], axes[0], axes[1]);
    scene->environment = NULL;
    into_scene(axes, light->up, scene->background_up);
    for (int c = 0; c < 3; c++) {
        scene->background_bottom[c] = light->bottom;
        scene->background_top[c] = light->top;
    }
    scene->disc_count = light->lamps;
    for (size_t l = 0; l < light->lamps; l++) {
        const Lamp *const lamp = &light->lamp[l];
        scene->discs[l] = (BpDisc){.half_angle_degrees = lamp->half_angle_degrees,
                                   .radiance = {lamp->radiance, lamp->radiance, lamp->radiance}};
        into_scene(axes, lamp->direction, scene->discs[l].direction);
    }
}
