/* embree_paths.h: everything of the Embree peer that is not Embree: paths in flight as structure of arrays.
 *
 * In:    a scene (world_create); hits, filled in by the caller.   Out: rays, and radiance in the film.
 * Knows: camera, materials, random numbers, all in float.   Does not know: Embree, threads.
 *
 * A batch holds up to `lanes` paths. The active ones are always the first `active`, so that every loop is a
 * plain loop over 0 .. active-1, which the compiler turns into vector code of this machine's full width. */
#ifndef BENCH_EMBREE_PATHS_H
#define BENCH_EMBREE_PATHS_H

#include "peer.h"

#define LANE_BLOCK 16u          /* batches hold a multiple of this many lanes */
#define LANES_MAX 4096u
#define NO_HIT 0xffffffffu      /* as Embree's RTC_INVALID_GEOMETRY_ID */

/* What materials the world holds: loops for absent ones are skipped. */
enum {
    HAS_METAL = 1, HAS_GLASS = 2, HAS_EMISSION = 4, HAS_NORMALS = 8, HAS_BALL = 16, HAS_HEMISPHERE = 32,
    HAS_EXACT = 64, HAS_TOTAL_OTHER = 128
};

typedef struct World {
    const BpScene *scene;
    float origin[3], corner[3], right[3], down[3], lens_right[3], lens_up[3]; /* relative to lookfrom */
    float sky_bottom[3], sky_slope[3];
    bool lens, center;
    uint32_t has, max_depth, seed;
    float *points;      /* sphere_count * 4: centre relative to lookfrom, |radius|; for Embree's vertex buffer */
    uint32_t *surface;  /* of a sphere: entry in the tables below */
    float (*values)[8]; /* albedo r g b, fuzz or index, emit r g b, unused */
    uint32_t *flags;    /* kind and variants */
} World;

World world_create(const BpScene *scene, uint64_t seed);

/* One array a member, `lanes` entries each. */
typedef struct Batch {
    uint32_t lanes, active, fresh; /* lanes fresh .. active-1 are camera rays that were added last */
    float *origin[3], *direction[3], *throughput[3], *radiance[3];
    uint32_t *column, *sample, *depth;
    /* Set by the caller for each active lane: */
    float *t, *normal[3]; /* the normal outward, of any length */
    uint32_t *sphere;     /* NO_HIT: none */
    /* Between the loops of a bounce: */
    float *uniform[3], *random[3], *value, *cosine, *offset, *next[3];
    uint32_t *front, *alive, *kind;
} Batch;

Batch batch_create(uint32_t lanes);

/* Where the next camera path of a row comes from. */
typedef struct RowCursor {
    uint32_t row, column, sample;
} RowCursor;

/* Fills free lanes with camera paths of the row; false when nothing is left to trace. */
bool batch_refill(Batch *batch, const World *world, RowCursor *cursor);
/* Turns hits into scattered rays, adds finished paths to the film and closes their gaps. */
void batch_bounce(Batch *batch, const World *world, const RowCursor *cursor, const PeerFilm *film);

#endif
