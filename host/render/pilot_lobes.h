/* pilot_lobes.h: what narrow lobes do to the light that rays to lamps bring them.
 *
 * In:    a light, a path from it that fuzzy or rough metal, rough glass or a coat has sent on.
 * Out:   how bright that light is for a path of the picture that comes the other way, and how often it comes.
 * Knows: the densities of lobes, how the light is chosen that a ray is sent to.   Does not know: kernels.
 *
 * Where a path of the picture stands on such a surface, a ray is sent to the light, and its own next ray may
 * meet it: both are weighted by the power heuristic. What they bring depends on where on the surface the path
 * stands, and that is left to chance. If the lobe is wider than the light, that is less light from more
 * places than a mirror would give. */
#ifndef BP_RENDER_PILOT_LOBES_H
#define BP_RENDER_PILOT_LOBES_H

#include "pilot_lights.h"

/* The solid angle that a light fills as seen from a point outside of it. */
double bp_pilot_solid_angle(const BpScene *scene, const BpPilotLight *light, const double point[3]);

/* Where light has met a narrow lobe, and how it has left. All directions are unit; the normal is on the side
 * that the light leaves to. */
typedef struct BpPilotTurn {
    double point[3], normal[3];
    double to_light[3], leaves[3];
    double index; /* of refraction, behind the surface over before it, where the normal is */
} BpPilotTurn;

/* The density per steradian with which a path that comes against `leaves` is sent on along `to_light`, given
 * that it has chosen the coat of what has one. */
double bp_pilot_lobe_density(const BpMaterial *material, const BpPilotTurn *turn);

/* The density per steradian with which a matte material or fuzzy metal sends a path along `direction`;
 * `axis`: the normal, or for metal the mirror direction. */
double bp_pilot_density(const BpMaterial *material, const double axis[3], const double direction[3]);

/* What a path of the picture finds where the light has turned, over what a path that meets the light brings:
 * the mean of squares over the mean. *mean: the mean; 0: nothing. `lights`: all from which a ray chooses. */
double bp_pilot_glint(const BpScene *scene, const BpPilotLight *lights, size_t light_count,
                      const BpPilotLight *light, const BpMaterial *material, const BpPilotTurn *turn,
                      double *mean);

/* The same for directions to the light that are spread evenly around turn->to_light, as if the light were
 * small and the directions a mirror's: *mean is the integral over them, times the solid angle. */
double bp_pilot_glint_around(const BpScene *scene, const BpPilotLight *lights, size_t light_count,
                             const BpPilotLight *light, const BpMaterial *material, const BpPilotTurn *turn,
                             double *mean);

/* The direction in which a smooth surface of the material would send a path that comes from along `leaves`:
 * a mirror's or, if `refracts`, that of refraction; `turn` has all but to_light, which it gets. False: all is
 * reflected. */
bool bp_pilot_turn_smooth(bool refracts, BpPilotTurn *turn);

/* What unpolarised light is reflected at the cosine `c`; `index`: behind the surface over before it. */
double bp_pilot_reflectance(double c, double index);

#endif
