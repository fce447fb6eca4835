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

#define LANE_BLOCK 16u /* batches hold a multiple of this many lanes */
#define LANES_MAX 4096u
#define SURFACE_VALUES 8u
#define HUGE_MAX 4u
#define NO_HIT 0xffffffffu /* as Embree's RTC_INVALID_GEOMETRY_ID */

/* What materials the world holds: loops for absent ones are skipped. */
enum {
    HAS_METAL = 1,
    HAS_GLASS = 2,
    HAS_EMISSION = 4,
    HAS_NORMALS = 8,
    HAS_BALL = 16,
    HAS_HEMISPHERE = 32,
    HAS_EXACT = 64,
    HAS_ODD_GLASS = 128
};

enum {
    FLAG_KIND = 7,
    FLAG_BALL = 8, /* scatter cosine_cubed, or fuzz_shape ball: a point of the ball */
    FLAG_HEMISPHERE = 16,
    FLAG_EXACT = 32, /* fresnel */
    FLAG_NO_FRESNEL = 64,
    FLAG_ABSORB = 128, /* total reflection */
    FLAG_REFRACT = 256
};

typedef struct World {
    const BpScene *scene;
    float origin[3], corner[3], right[3], down[3], lens_right[3], lens_up[3]; /* relative to lookfrom */
    float sky_middle[3], sky_slope[3];                                        /* at y = 0; a unit of y */
    bool lens, center;
    uint32_t has, max_depth, seed;
    float *points;   /* sphere_count * 4: centre relative to lookfrom, |radius|; for Embree's vertex buffer */
    float *vertices; /* triangle_count * 9, relative to lookfrom */
    size_t shapes;   /* spheres, or, where there are none, triangles */
    uint32_t *surface; /* of a shape: entry in the tables below; one more for the sky */
    float *values;     /* SURFACE_VALUES each: albedo r g b, fuzz or index, emit r g b, unused */
    uint32_t *flags;   /* kind and variants */
    /* Spheres far larger than most, few: met before the tree is entered, and not in it. */
    uint32_t huge_count, huge[HUGE_MAX];
} World;

/* `huge`: whether to take out huge spheres. */
World world_create(const BpScene *scene, uint64_t seed, bool huge);

/* One array a member, `lanes` entries each. */
typedef struct Batch {
    uint32_t lanes, active, fresh; /* lanes fresh .. active-1 are camera rays that were added last */
    float *origin[3], *direction[3], *throughput[3], *radiance[3];
    uint32_t *column, *sample, *depth;
    /* Set by the caller for each active lane: */
    float *t, *normal[3]; /* the normal outward, of any length */
    uint32_t *sphere;     /* or triangle; NO_HIT: none */
    uint32_t *huge; /* the huge sphere met at t before the caller traces: its hits must be nearer than t */
    /* Between the loops of a bounce: */
    float *random[3], *next[3], *uniform, *value, *cosine, *offset;
    uint32_t *front, *alive, *kind, *entry;
} Batch;

Batch batch_create(uint32_t lanes);

/* Where the next camera path of a row comes from. */
typedef struct RowCursor {
    uint32_t row, column, sample;
} RowCursor;

/* Fills free lanes with camera paths of the row; false when nothing is left to trace. */
bool batch_refill(Batch *batch, const World *world, RowCursor *cursor);
/* Sets t and huge of all active lanes: where a ray meets a huge sphere first; infinity and NO_HIT if it meets
 * none. */
void batch_meet_huge(Batch *batch, const World *world);
/* Turns hits into scattered rays, adds finished paths to the film and closes their gaps. */
void batch_bounce(Batch *batch, const World *world, const RowCursor *cursor, const PeerFilm *film);

/* The loops behind them (embree_camera.c, embree_shade.c). Camera rays for lanes first .. end-1, whose column
 * and sample are set: */
void lanes_start(const Batch *batch, const World *world, uint32_t row, uint32_t first, uint32_t end);
/* Radiance found at the hits or in the sky; then the next ray, or `alive` 0: */
void lanes_scatter(const Batch *batch, const World *world, uint32_t first_pixel);

#endif
