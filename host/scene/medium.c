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

uint32_t bp_shape_named_interior(const BpScene *scene, size_t shape) {
    const uint32_t *interiors = scene->interiors;
    size_t count = scene->interior_count, place = shape;
    if (shape >= scene->sphere_count + scene->triangle_count) {
        place = shape - scene->sphere_count - scene->triangle_count;
        interiors = scene->capsule_interiors;
        count = scene->capsule_interior_count;
    } else if (shape >= scene->sphere_count) {
        place = shape - scene->sphere_count;
        interiors = scene->triangle_interiors;
        count = scene->triangle_interior_count;
    }
    return place < count ? interiors[place] : 0;
}

uint32_t bp_shape_interior(const BpScene *scene, size_t shape) {
    return unless_clear(scene, bp_shape_named_interior(scene, shape));
}

size_t bp_scene_filled(const BpScene *scene) {
    size_t filled = 0;
    if (scene->interior_count + scene->triangle_interior_count + scene->capsule_interior_count == 0) return 0;
    for (size_t i = 0; i < bp_scene_shapes(scene); i++) filled += bp_shape_interior(scene, i) != 0;
    return filled;
}

size_t bp_scene_interfaces(const BpScene *scene) {
    size_t interfaces = 0, materials = 0;
    for (size_t m = 0; m < scene->material_count; m++)
        materials += scene->materials[m].kind == BP_MATERIAL_INTERFACE;
    for (size_t i = 0; i < bp_scene_shapes(scene) && materials > 0; i++)
        interfaces += scene->materials[bp_shape_material(scene, i)].kind == BP_MATERIAL_INTERFACE;
    return interfaces;
}

bool bp_scene_has_media(const BpScene *scene) {
    return bp_scene_medium(scene) != 0 || bp_scene_filled(scene) > 0 || bp_scene_interfaces(scene) > 0;
}

uint32_t bp_scene_medium(const BpScene *scene) {
    return unless_clear(scene, scene->medium);
}
