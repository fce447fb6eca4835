/* shape_rules.c: see shape_rules.h. */
#include "shape_rules.h"

#include "material.h"

bool bp_glass_beside_media(const BpScene *scene, const BpMaterial *material, BpFaultSubject subject,
                           const char *noun, BpFault *fault) {
    if (!bp_material_is(material->kind, BP_HAS_INSIDE) || scene->medium_count == 0) return false;
    return bp_fault_set(fault, subject, "material",
                        "found glass of %s in a scene with media, expected one or the other: use spheres of "
                        "glass, or remove \"media\"",
                        noun);
}

bool bp_map_without_longitude(const BpScene *scene, const BpMaterial *material, BpFaultSubject subject,
                              const char *noun, BpFault *fault) {
    return bp_material_is_mapped(scene, material) &&
           bp_fault_set(
               fault, subject, "material",
               "found a texture that is laid around spheres, expected one that fills space: %s have no "
               "longitude; change its mapping to \"solid\", or the material",
               noun);
}

int bp_compare_points(const double a[3], const double b[3]) {
    for (int i = 0; i < 3; i++)
        if (a[i] != b[i]) return a[i] < b[i] ? -1 : 1;
    return 0;
}
