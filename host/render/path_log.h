/* path_log.h: the path of one pixel sample, step by step, as the kernel traced it.
 *
 * In:    scene, options, device, pixel and sample number.   Out: a list of steps.
 * Knows: kernels/entry/path_log.cl, worker.h.   Does not know: how it is printed. */
#ifndef BP_RENDER_PATH_LOG_H
#define BP_RENDER_PATH_LOG_H

#include "scene/scene.h"

/* One ray segment. Points are in the scene's own coordinates. */
typedef struct BpPathStep {
    double origin[3], direction[3]; /* of the segment; the direction is a unit vector */
    bool scattered;                 /* a medium scattered it after `distance`, at `point`, and it continues */
    bool met;                       /* it met a sphere; else it left for the sky, and the path ends */
    bool caught, dark;              /* or it met the shadow catcher, and in shadow; the path ends */
    double distance;                /* where it did; else undefined, as are the next four */
    double point[3];
    uint32_t sphere, material; /* numbers in the scene */
    bool enters;               /* met from outside */
    bool goes_on;              /* the surface sent the path on */
    double chance;             /* roulette then let it go on with this chance, to carry the inverse times as
                                  much; 0: it was not played */
    bool ended;                /* and ended it here */
    bool inward;               /* into (or staying in) the inside of the sphere */
    double throughput[3];      /* product of weights after the meeting */
    double radiance[3];        /* collected so far; that of the last step is the sample's */
    uint32_t discs;            /* where it did not: bit i: disc i of the sky stands there */
    bool to_lamp;              /* a ray was sent to a lamp from here */
    bool to_disc;              /* then: the lamp is a disc of the sky, else a sphere */
    bool to_image;             /* or: it is the image around, which has no number */
    uint32_t lamp;             /* the number of that disc or sphere */
    bool stopped;              /* the ray meets another sphere first */
    uint32_t seen;             /* that sphere */
    double lit[3];             /* radiance that it brought */
    double led[3];             /* and radiance that rays by way of a ball of glass or a mirror brought */
} BpPathStep;

typedef struct BpPathLog {
    BpPathStep *steps;
    size_t count;
    bool cut; /* ended by the depth cap */
    BpDeviceInfo device;
} BpPathLog;

/* Follows sample `sample` (absolute) of pixel (x, y), counted from the top left corner from 0. `device`:
 * Optional. The steps are those of the render with the same options, in its sample form. Free with
 * bp_path_log_clear(). BP_ERR_USAGE when the pixel lies outside the picture. */
BpStatus bp_path_log(const BpScene *scene, const BpRenderOptions *options, const BpDeviceInfo *device,
                     uint32_t x, uint32_t y, uint32_t sample, BpPathLog *path, BpError *err);
void bp_path_log_clear(BpPathLog *path);

#endif
