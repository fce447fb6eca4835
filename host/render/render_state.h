/* render_state.h: the state of a render while it runs; shared by render.c, which runs it, stop.c, which
 * stops it, and resume.c, which takes it up again.
 *
 * Knows: workers, the schedule, the plan of adaptive sampling, the pilot, the limits of a stop rule that are
 * kept in films.   Does not know: files, when a render is stopped. */
#ifndef BP_RENDER_RENDER_STATE_H
#define BP_RENDER_RENDER_STATE_H

#include "cluster/comm.h"
#include "dispatch.h"
#include "film/adaptive.h"
#include "opencl/calibration.h"
#include "packed/acceleration.h"
#include "pilot.h"

/* A rank's record of the rounds that it shares with others. */
typedef struct BpRounds {
    double samples, seconds; /* this rank's recent throughput */
    uint64_t pixel_samples;  /* of all ranks together, in the rounds that are done */
} BpRounds;

struct BpRender {
    const BpScene *scene;
    BpRenderOptions options;
    BpEffects effects;
    BpAcceleration acceleration;
    BpDispatch dispatch;
    BpAdaptive *adaptive; /* NULL: every pixel gets the same samples */
    bool decides;         /* adaptive: past the samples that every pixel gets */
    BpFilm *film;         /* as last read; NULL before that */
    BpComm *comm;         /* NULL: no other process works on it */
    BpRounds round;
    bool resumed;          /* it continues from a film */
    BpFilm *base;          /* which is this; NULL: nothing, or another rank has it */
    uint64_t base_samples; /* pixel samples in it */
    uint64_t goal_samples; /* where a stop rule ends it; 0: there is no such rule */
    double goal_error;
    bool ended;     /* it has reached that */
    bool has_pilot; /* its programs have one: there may be light that samples find by chance only */
    BpPilotAim aim; /* of the pilot, until it has run */
    bool pilot_done;
    BpUnseen *unseen;    /* what it has found; NULL: nothing */
    BpUnseenLight pilot; /* the same as text */
    BpPicture aovs;      /* its depth, normal and albedo, once computed */
    BpChunk last_chunk;
    double tree_seconds, pack_seconds, trace_seconds;
    BpCalibration calibration; /* of the first device; BP_KERNEL_AUTO: none decided */
    double calibration_seconds;
    uint64_t samples_total;
};

/* Pixel samples of all chunks that are done, those of a resumed film included. */
uint64_t bp_render_pixel_samples(const BpRender *render);

/* The scene, the options and the ranges of samples of the render as it stands, into a film without any. */
BpStatus bp_render_describe(const BpRender *render, BpFilm *film, BpError *err);

/* Hands the pixels of an adaptive pass to all workers, and begins to hand out its samples. */
BpStatus bp_render_begin_pass(BpRender *render, const BpAdaptivePass *pass, BpError *err);

/* Whether the render could be extended to so many samples: BP_ERR_USAGE or BP_ERR_LIMIT as
 * bp_render_extend(). */
BpStatus bp_render_check_samples(const BpRender *render, uint64_t samples_per_pixel, BpError *err);

#endif
