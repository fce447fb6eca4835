/* reference.h: the reference tracer: the book's algorithm, in plain C and double, against which kernels are
 * judged.
 *
 * In:    a validated Scene.   Out: power sums of every pixel's samples.
 * Knows: Scene.               Does not know: OpenCL, packed data. kernels/ is not on its include path.
 *
 * Independent of the kernel on purpose: recursion instead of a loop, every sphere tried instead of a tree,
 * rejection instead of direct maps, another random generator, intersection and camera written on their own.
 * Do not share code with the kernel: a shared mistake would pass every comparison.
 *
 * Light's rules, as the kernel must have them too: radiance = emitted + albedo * radiance of the scattered
 * ray; a path that reaches max_depth segments adds nothing further; a dielectric reflects with a probability
 * of its reflectance and weakens nothing; `normals` and lamps end a path. */
#ifndef BP_REFERENCE_REFERENCE_H
#define BP_REFERENCE_REFERENCE_H

#include "scene/scene.h"
#include "sums.h"

typedef struct BpReferenceOptions {
    uint64_t first_sample, samples; /* of every pixel */
    uint64_t seed;
    uint32_t max_depth; /* ray segments; 0 is black */
    unsigned threads;   /* 0: one a processor */
} BpReferenceOptions;

/* Adds `samples` samples of every pixel to `sums`, which has the scene camera's size. Samples s of two calls
 * with the same seed are the same; the sums depend neither on the number of threads nor on how calls divide
 * the samples. `truncated_paths`: Optional; added to: paths that max_depth ended. BP_ERR_USAGE (sizes
 * differ), BP_ERR_MEMORY (no thread could be started). */
BpStatus bp_reference_render(const BpScene *scene, const BpReferenceOptions *options, BpSums *sums,
                             uint64_t *truncated_paths, BpError *err);

#endif
