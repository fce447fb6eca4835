/* medium.c: see medium.h. */
#include "scene.h"

bool bp_medium_is_clear(const BpMedium *medium) {
    for (int c = 0; c < 3; c++)
        if (medium->absorption[c] > 0 || medium->scattering[c] > 0) return false;
    return true;
}

bool bp_medium_scatters(const BpMedium *medium) {
    return medium->scattering[0] > 0 || medium->scattering[1] > 0 || medium->scattering[2] > 0;
}

bool bp_medium_is_coloured(const BpMedium *medium) {
    return medium->scattering[0] != medium->scattering[1] || medium->scattering[0] != medium->scattering[2];
}

static uint32_t unless_clear(const BpScene *scene, uint32_t number) {
    return number == 0 || bp_medium_is_clear(&scene->media[number - 1]) ? 0 : number;
}

uint32_t bp_sphere_interior(const BpScene *scene, size_t sphere) {
    return sphere < scene->interior_count ? unless_clear(scene, scene->interiors[sphere]) : 0;
}

uint32_t bp_scene_medium(const BpScene *scene) {
    return unless_clear(scene, scene->medium);
}
