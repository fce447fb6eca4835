/* pilot_join.h: brings paths from the camera and paths from lights together, pixel by pixel.
 *
 * In:    where camera paths come to rough surfaces, or pass by lights; where light comes to rough surfaces.
 * Out:   for each pixel, what of that light a sample finds in the mean, and in the mean of squares.
 * Knows: densities of points on surfaces.   Does not know: kernels, how paths were made.
 *
 * A camera path ends at a point with a lobe; had it been drawn on from there, it would have gone along one of
 * the ways of the light with some probability, and brought the light with it. The ways of light are known by
 * samples, so around each point they are counted within a radius, as photon maps do (H. W. Jensen, "Global
 * Illumination using Photon Maps", 1996): the one in which some camera paths of the pixels around end. So the
 * sum over a picture is right, and light is spread over no more than its neighbours. */
#ifndef BP_RENDER_PILOT_JOIN_H
#define BP_RENDER_PILOT_JOIN_H

#include "film/unseen.h"
#include "scene/scene.h"

/* The end of a camera path. */
typedef struct BpPilotEye {
    uint32_t pixel;             /* into the sums; */
    double share;               /* of its samples that this path stands for */
    double point[3], normal[3]; /* the normal is unit, on the side of the path */
    double outgoing[3];         /* unit, to where the path came from */
    double index;               /* of glass: behind the surface over before it */
    double throughput[3];       /* behind the point */
    double radius;              /* within which light counts */
    uint32_t shape, object, segments;
} BpPilotEye;

/* Light that comes to a point. */
typedef struct BpPilotPhoton {
    double point[3], direction[3];
    double normal[3];   /* unit, on the side that it comes from */
    double radiance[3]; /* that a path brings which takes this way back */
    double measure;     /* area x solid angle x cosine for which it stands */
    uint32_t object, segments;
    size_t through; /* by way of what the light comes (bp_pilot_way()) */
    bool focused;   /* rays to lamps that go through focusers find the light of its path */
} BpPilotPhoton;

/* What has been found, in double. */
typedef struct BpPilotSums {
    size_t pixels;
    double *mean, *square; /* luminance; of each pixel */
    double square_of[3];   /* of each channel, over all pixels */
    double *by_way;        /* of `through`: the sum of squares; bp_pilot_ways() */
} BpPilotSums;

/* What is left to chance whatever is sampled, and what rays to lamps find that go through focusers. */
typedef struct BpPilotParts {
    BpPilotSums chance, focused;
} BpPilotParts;

/* Adds light `radiance` that reaches a pixel's sample with a probability. */
void bp_pilot_add(BpPilotSums *sums, size_t pixel, const double radiance[3], double probability,
                  size_t through);

/* All pairs of a point and light that comes to it. Paths of more than `max_depth` segments do not count.
 * BP_ERR_MEMORY. */
BpStatus bp_pilot_join(const BpScene *scene, const BpPilotEye *eyes, size_t eye_count,
                       const BpPilotPhoton *photons, size_t photon_count, uint32_t max_depth,
                       BpPilotParts *parts, BpError *err);

#endif
