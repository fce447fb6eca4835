/* shape_rules.h: rules that several kinds of shapes share.
 *
 * In:    a material, how the shapes are called.   Out: the fault, if there is one.
 * Knows: what only spheres have: longitudes.   Does not know: where the scene was read from. */
#ifndef BP_SCENE_SHAPE_RULES_H
#define BP_SCENE_SHAPE_RULES_H

#include "scene_fault.h"

/* Whether a shape has an interior that is none, or one though no light passes in. The material of the shape
 * is in range. `noun`: "sphere". */
bool bp_interior_fault(const BpScene *scene, size_t shape, BpFaultSubject subject, const char *noun,
                       BpFault *fault);

/* Whether the material has a texture that lies on surfaces by longitude and latitude. `noun`: "triangles". */
bool bp_map_without_longitude(const BpScene *scene, const BpMaterial *material, BpFaultSubject subject,
                              const char *noun, BpFault *fault);

/* By x, then y, then z: below 0, 0 or above 0. */
int bp_compare_points(const double a[3], const double b[3]);

#endif
