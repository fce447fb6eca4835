/* pilot_paths.h: traces the paths of a pilot on a device, and reads them vertex by vertex.
 *
 * In:    pixels and samples, or beginnings on lights.   Out: segments, in the scene's space and in double.
 * Knows: entry/pilot.cl, a worker.   Does not know: what the paths are for. */
#ifndef BP_RENDER_PILOT_PATHS_H
#define BP_RENDER_PILOT_PATHS_H

#include "pilot_lobes.h"
#include "worker.h"

#include "pilot_types.h"

#define BP_PILOT_BATCH 8192u /* paths of one dispatch, at most */
#define BP_PILOT_SEGMENTS_MAX 12u

/* Paths of one dispatch. */
typedef struct BpPilotFlight {
    BpWorker *worker;
    cl_kernel kernel;
    size_t local;
    uint32_t batch; /* paths of one dispatch, at most: BP_PILOT_BATCH, or what the device allocates at once */
    double origin[3]; /* of the space that the device knows, in the scene's */
    cl_mem numbers, starts, records, marks;
    uint32_t *number_data, *mark_data;
    void *start_data, *record_data;
} BpPilotFlight;

typedef struct BpPilotSegment {
    double point[3], direction[3], distance, throughput[3], time;
    double odds; /* how much more often a picture's path would have come this way and left its end so */
    uint32_t shape, flags; /* as the scene counts shapes, or NO_SPHERE */
} BpPilotSegment;

/* Room for a batch, on the device and here. BP_ERR_MEMORY or BP_ERR_DEVICE; clear it in any case. */
BpStatus bp_pilot_flight_create(BpWorker *worker, const BpScene *scene, BpPilotFlight *flight, BpError *err);
void bp_pilot_flight_clear(BpPilotFlight *flight);

/* Traces `count` paths of at most `segments` segments, whose numbers and, if not `from_camera`, starts are
 * set. */
BpStatus bp_pilot_fly(BpPilotFlight *flight, cl_uint count, cl_uint segments, bool from_camera, BpError *err);

/* Of a path of the last batch, which had `segments`. False: the path has no such segment. */
bool bp_pilot_segment(const BpPilotFlight *flight, uint32_t path, uint32_t segments, uint32_t s,
                      BpPilotSegment *segment);
/* What the path carries into it; returns the odds of its coming this way. */
double bp_pilot_carried(const BpPilotFlight *flight, uint32_t path, uint32_t segments, uint32_t s,
                        double carried[3]);

/* The unit normal of the shape that a segment has met, at its end, on the side that it came from. */
void bp_pilot_normal(const BpScene *scene, const BpPilotSegment *segment, double normal[3]);
/* The refraction index behind that surface over the one on the side of `normal`. */
double bp_pilot_index_behind(const BpScene *scene, const BpPilotSegment *segment, const double normal[3]);
/* All of a turn but to_light, where a segment ends; `leaves`: of any length. */
void bp_pilot_turn_at(const BpScene *scene, const BpPilotSegment *segment, const double leaves[3],
                      BpPilotTurn *turn);
const BpMaterial *bp_pilot_material_at(const BpScene *scene, const BpPilotSegment *segment);
/* It ends at a surface that does something to light, be it specular or rough: not at the boundary of a medium
 * alone. */
bool bp_pilot_is_surface(const BpScene *scene, const BpPilotSegment *segment);
/* It ends at a surface that rays to lamps light. */
bool bp_pilot_is_rough(const BpScene *scene, const BpPilotSegment *segment);

#endif
