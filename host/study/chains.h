/* chains.h: finds the ways by which a lamp's light reaches a matte point through one ball of glass or off one
 * mirror.
 *
 * In:    a scene in which nothing moves, without media; a point; a sphere, a lamp and how light passes the
 *        sphere.
 * Out:   each way: where on the sphere, along which direction, what it brings, what stands in it.
 * Knows: the reference tracer.   Does not know: how kernels find these ways.
 *
 * The kernel solves for one angle with a proof of how many solutions there are (kernels/light/focusers.cl).
 * Here rays are traced through the sphere at many angles; where one passes the lamp on the left and the next
 * on the right, the angle between them is found by false position. */
#ifndef BP_STUDY_CHAINS_H
#define BP_STUDY_CHAINS_H

#include "scene/scene.h"

/* Where light arrives. */
typedef struct BpChainPoint {
    double point[3], normal[3]; /* a unit vector to the side that is lit */
    uint32_t sphere;            /* that the point lies on */
    BpScatter scatter;          /* of its material, a lambertian one */
} BpChainPoint;

typedef struct BpChain {
    uint32_t sphere; /* of glass, or a mirror */
    uint32_t chords; /* inside it: 0 for a reflection off its outside, 2 for one reflection inside */
    bool disc;       /* the lamp is a disc of the sky */
    uint32_t lamp;   /* the number of that disc, or of a sphere */
} BpChain;

typedef struct BpChainWay {
    double direction[3]; /* from the point, a unit vector */
    double at[3];        /* where it meets the sphere */
    double degrees;      /* between it and the sphere's normal there */
    bool to_middle;      /* it leads to the middle of the lamp, else to some part of it */
    double brings[3];    /* radiance that the point would send on if it were white; 0 to 1 of each colour */
    double stopped;      /* the share of its light that other spheres block */
    uint32_t by;         /* where that is not 0: such a sphere */
} BpChainWay;

/* On either side of the line through point and centre, one at which rays pass the lamp from left to right as
 * the angle grows, and one from right to left. */
#define BP_CHAIN_WAYS_MAX 4

/* The ways of one chain, the brightest first; *count is their number. BP_ERR_MEMORY. */
BpStatus bp_chain_ways(const BpScene *scene, const BpChainPoint *point, const BpChain *chain,
                       BpChainWay ways[BP_CHAIN_WAYS_MAX], size_t *count, BpError *err);

#endif
