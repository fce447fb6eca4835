/* pilot_lights.h: where the paths of a pilot begin: at lights, aimed at what may focus their light.
 *
 * In:    a scene.
 * Out:   its lights, its shapes that focus light, and beginnings of paths from the ones to the others.
 * Knows: what a ray to a lamp finds, and what it does not.   Does not know: kernels.
 *
 * A pair is a light and a target: glass, metal too smooth to be lit by rays to lamps, a coat, or what
 * scatters into a narrow lobe that the light may be smaller than. A path of the pair begins on the light and
 * flies at the shape. It counts only if it meets that shape first, so each path belongs to one pair,
 * whichever shapes overlap. */
#ifndef BP_RENDER_PILOT_LIGHTS_H
#define BP_RENDER_PILOT_LIGHTS_H

#include "base/random.h"
#include "scene/scene.h"

#define BP_PILOT_LIGHTS_MAX 256u
#define BP_PILOT_PAIRS_MAX 65536u

typedef struct BpPilotLight {
    bool distant;    /* a disc of the sky or a texel of the image around; else a lamp */
    bool seen;       /* by camera rays that meet it first */
    size_t shape;    /* of a lamp: a sphere or a triangle */
    size_t disc;     /* of a disc of the sky; SIZE_MAX: it is none */
    double place[3]; /* unit, to the middle of a distant light; of a lamp the centre, at half of its way */
    double radius;   /* of a lamp; of a triangle, that of a disk of its area */
    double cap;      /* of a distant light: its solid angle over 2 pi, that is, 1 - cos of its half angle */
    double radiance[3]; /* at most */
    double share;       /* of lights alike for which this one stands, 1 or more */
} BpPilotLight;

typedef struct BpPilotPair {
    uint32_t light, target; /* into lights[] and targets[] */
    double probability;
    double share; /* of pairs alike for which this one stands, 1 or more */
} BpPilotPair;

typedef struct BpPilotAim {
    BpPilotLight *lights;
    size_t light_count;
    uint32_t *targets; /* shapes that scatter into few directions, or nearly */
    size_t target_count;
    BpPilotPair *pairs;
    double *bounds; /* of pairs: the sum of the probabilities before each */
    size_t pair_count;
    double middle[3], reach; /* a ball around all shapes */
} BpPilotAim;

/* A path from a light. */
typedef struct BpPilotStart {
    double origin[3], direction[3]; /* in the scene's space; unit */
    double measure; /* area x solid angle x cosine for which it stands, over the number of paths; 0: none */
    uint32_t pair;
} BpPilotStart;

/* The half angle that a light fills, roughly, as seen from `point`, which may be NULL for distant lights. */
double bp_pilot_half_angle(const BpPilotLight *light, const double point[3]);

/* Whether a ray to the light, sent through focusers, finds it by way of the shape, on which a path has stood
 * so many times and on nothing else: then it is not left to chance. */
bool bp_pilot_is_sampled(const BpScene *scene, const BpPilotLight *light, uint32_t shape, uint32_t vertices);

/* BP_ERR_MEMORY. Without lights or without targets there are no pairs. Free with bp_pilot_aim_clear(). */
BpStatus bp_pilot_aim(const BpScene *scene, BpPilotAim *aim, BpError *err);
void bp_pilot_aim_clear(BpPilotAim *aim);

/* The beginning of one of `count` paths; there is a pair. */
void bp_pilot_start(const BpScene *scene, const BpPilotAim *aim, size_t count, BpRandom *random,
                    BpPilotStart *start);

#endif
