/* render_state.h: what a render knows while it runs; shared by render.c, which runs it, and stop.c, which
 * stops it.
 *
 * Knows: workers, the schedule, the plan of adaptive sampling.   Does not know: files, stop rules. */
#ifndef BP_RENDER_RENDER_STATE_H
#define BP_RENDER_RENDER_STATE_H

#include "film/adaptive.h"
#include "render.h"
#include "worker.h"

struct BpRender {
    const BpScene *scene;
    BpRenderOptions options;
    BpEffects effects;
    BpAcceleration acceleration;
    BpWorker **workers;
    size_t worker_count;
    BpSchedule schedule;  /* adaptive: of the pass under way */
    BpAdaptive *adaptive; /* NULL: every pixel gets the same samples */
    bool decides;         /* adaptive: past the samples that every pixel gets */
    BpFilm *film;         /* as last read; NULL before that */
    BpChunk last_chunk;
    double tree_seconds, pack_seconds, trace_seconds;
    uint64_t samples_total;
};

/* Pixel samples of all chunks that are done. */
uint64_t bp_render_pixel_samples(const BpRender *render);

#endif
