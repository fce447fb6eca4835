/* medium.h: what fills a shape that light passes through, or all of space: fog, smoke, tinted glass.
 *
 * In:    a scene.   Out: which of its media do anything, and where.
 * Knows: the grammar's terms.   Does not know: how a kernel or the reference traces through it.
 *
 * A medium is homogeneous. Along a way of length s, of each colour exp(-(absorption + scattering) s) is left;
 * where light is scattered, its direction changes by the phase function of Henyey and Greenstein (1941),
 * whose mean cosine is `anisotropy`: 0 scatters evenly, above 0 forwards, below 0 backwards.
 *
 * The rule for media that nest or overlap: a point lies in one medium, that of the boundary around it with
 * the least volume. Boundaries are what light passes through (a dielectric or an interface): spheres, bodies
 * of triangles (bodies.h) and capsules; of equal ones the first counts, in this order. Without an interior a
 * boundary is clear inside. A point outside all of them lies in the scene's medium. */
#ifndef BP_SCENE_MEDIUM_H
#define BP_SCENE_MEDIUM_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct BpScene;

#define BP_MEDIA_MAX 65536u
#define BP_DENSITY_MIN 1.0e-12 /* of a coefficient that is not 0: ratios of two fit a float */
#define BP_DENSITY_MAX 1.0e12
#define BP_ANISOTROPY_MAX 0.999

typedef struct BpMedium {
    char *name;                          /* first: bp_node_find() */
    double absorption[3], scattering[3]; /* per unit of length */
    double anisotropy;
} BpMedium;

/* It neither absorbs nor scatters. */
bool bp_medium_is_clear(const BpMedium *medium);
bool bp_medium_scatters(const BpMedium *medium);
/* Colours scatter differently. */
bool bp_medium_is_coloured(const BpMedium *medium);

/* The number, counted from 1, of the medium inside a shape, clear or not; 0: it names none. */
uint32_t bp_shape_named_interior(const struct BpScene *scene, size_t shape);
/* The same, and 0 where that medium is clear. */
uint32_t bp_shape_interior(const struct BpScene *scene, size_t shape);
/* The same of the medium around all shapes. */
uint32_t bp_scene_medium(const struct BpScene *scene);
/* How many shapes have a medium inside that is not clear, and how many are interfaces. */
size_t bp_scene_filled(const struct BpScene *scene);
size_t bp_scene_interfaces(const struct BpScene *scene);
/* Whether rays have to know which medium they are in: there is one that is not clear, or an interface. */
bool bp_scene_has_media(const struct BpScene *scene);

#endif
