/* shape_rules.c: see shape_rules.h. */
#include "shape_rules.h"

#include "material.h"

bool bp_interior_fault(const BpScene *scene, size_t shape, BpFaultSubject subject, const char *noun,
                       BpFault *fault) {
    const uint32_t interior = bp_shape_named_interior(scene, shape);
    if (interior == 0) return false;
    if (interior > scene->medium_count)
        return bp_fault_set(fault, subject, "interior", "found number %u, expected one of %zu media",
                            (unsigned)interior, scene->medium_count);
    const BpMaterialKind kind = scene->materials[bp_shape_material(scene, shape)].kind;
    if (bp_material_is(kind, BP_HAS_INSIDE)) return false;
    return bp_fault_set(fault, subject, "interior",
                        "found in a %s whose material is of type \"%s\", expected only where light passes "
                        "through: change the type to \"interface\" or \"dielectric\", or remove it",
                        noun, bp_material_types[kind].name);
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
