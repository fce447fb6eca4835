/* peer.h: what the peers share: command line, camera, threads over rows, the film, one line of JSON.
 *
 * In:    a scene file, read by libballpark.   Out: a timed run's figures on standard output.
 * Knows: the scene's terms, threads, clocks.  Does not know: how a peer traces a ray.
 *
 * A peer is a small program that renders the same scene files as ballpark by another road, so that speeds are
 * compared side by side. Nothing here is linked into ballpark. */
#ifndef BENCH_PEER_H
#define BENCH_PEER_H

#include "scene/scene.h"

typedef struct PeerOptions {
    const char *scene_path, *method, *picture_path, *config;
    uint32_t width, samples, depth, threads; /* 0: the scene's own; threads: every core */
    uint32_t lanes;                          /* paths in flight a thread, where a peer has a choice */
    uint64_t seed;
} PeerOptions;

/* The camera as vectors, relative to lookfrom; rows run downwards. */
typedef struct PeerCamera {
    double origin[3]; /* lookfrom */
    double corner[3], right[3], down[3];
    double lens_right[3], lens_up[3]; /* scaled by the lens radius */
    bool lens, center;                /* has an aperture; one ray through the pixel's centre */
} PeerCamera;

/* Sums of a pixel's even and of its odd samples: two independent halves, from which the error follows. */
typedef struct PeerFilm {
    uint32_t width, height, samples;
    double *half[2]; /* width * height * 3 each */
} PeerFilm;

/* Traces all samples of row `row` into the film and returns the number of ray segments. Rows are taken by
 * `thread` (0 .. threads-1) in rising order; no two calls share a row. */
typedef uint64_t PeerRow(void *job, unsigned thread, uint32_t row);

typedef struct PeerRun {
    uint64_t rays;
    double seconds, cpu_seconds; /* of tracing: by the wall clock; of all threads */
    double load_seconds, build_seconds;
    uint64_t structure_bytes; /* memory of the acceleration structure; 0: unknown */
} PeerRun;

/* Fills `options` from the command line; prints usage and exits with 2 when it is not understood. */
void peer_options(int argc, char **argv, const char *methods, PeerOptions *options);
/* Loads the scene and applies width, samples and depth; prints the error and exits when it cannot.
 * `triangles`: whether the peer draws scenes of triangles alone, beside those of spheres. */
BpScene *peer_load(const PeerOptions *options, bool triangles, PeerRun *run);
void peer_camera(const BpScene *scene, PeerCamera *camera);
/* Exits with 1 when memory runs out, as everything here does. */
void *peer_allocate(size_t count, size_t size);
PeerFilm peer_film(const BpScene *scene);
/* Runs `work` over all rows on `threads` threads and adds rays and both times to `run`. */
void peer_trace(const BpScene *scene, unsigned threads, PeerRow *work, void *job, PeerRun *run);
/* Prints the figures as one line of JSON and writes the picture (PFM) where one was asked for. */
void peer_report(const char *peer, const PeerOptions *options, const BpScene *scene, const PeerFilm *film,
                 const PeerRun *run);

#endif
