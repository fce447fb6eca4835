/* references.h: two pictures of the truth, with random numbers of their own.
 *
 * In:    the scene with exact Fresnel, a device.   Out: two pictures, as good as the time allows.
 * Knows: the kernel in double, the reference tracer.   Does not know: what is compared with them.
 *
 * Both are rendered in turns; their samples are doubled as long as there is time for it. */
#ifndef BP_STUDY_REFERENCES_H
#define BP_STUDY_REFERENCES_H

#include "reference/reference.h"
#include "study.h"

typedef struct BpReferences {
    const BpScene *scene;
    bool kernel;         /* the kernel in double; else the reference tracer */
    BpRender *render[2]; /* of the kernel */
    BpSums sums[2];      /* of the tracer */
    uint64_t seed[2], done[2], wanted;
    int turn;
    double start;
    BpPicture pictures[2]; /* once finished */
} BpReferences;

/* Opens them; zero `references` before. Of `base`, only `force` and the seed are used, from which their seeds
 * follow. Clear also on failure. */
BpStatus bp_references_open(BpReferences *references, const BpScene *scene, const BpRenderOptions *base,
                            const BpDeviceInfo *device, BpError *err);
/* About 0.2 s of work (a step of the tracer: one sample of every pixel). *finished: `seconds` from opening
 * leave no time for twice the samples; the pictures are there. */
BpStatus bp_references_step(BpReferences *references, double seconds, bool *finished, BpError *err);
/* Mean luminance of both, and the NRMSE of their mean. */
void bp_references_judge(const BpReferences *references, double *brightness, double *nrmse);
void bp_references_clear(BpReferences *references);

#endif
