/* round.c: see round.h. */
#include "round.h"

#include "base/clock.h"
#include "base/status.h"
#include "partition.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Long against the messages of a round, short for whoever waits for Ctrl-C. */
#define ROUND_SECONDS 0.5
/* What an earlier round counts for the speed of a rank, against the next one. */
#define EARLIER_SHARE 0.5

/* What a rank says before a round. */
typedef struct Throughput {
    double speed;   /* pixel samples a second; 0: not known yet */
    double guess;   /* of that, while it is not known: compute units */
    double samples; /* that it can take without keeping others waiting (chunk_sizer.h) */
} Throughput;

/* What rank 0 answers; the fractions of all ranks follow. */
typedef struct Plan {
    uint64_t wanted; /* pixel samples of all ranks together */
} Plan;

static Throughput own_throughput(const BpRender *render) {
    Throughput throughput = {
        .speed = render->round.seconds > 0 ? render->round.samples / render->round.seconds : 0};
    const double slowest = bp_dispatch_slowest(&render->dispatch);
    for (size_t i = 0; i < render->dispatch.worker_count; ++i) {
        const BpWorker *worker = render->dispatch.workers[i];
        throughput.guess += worker->device->info.compute_units > 0 ? worker->device->info.compute_units : 1;
        throughput.samples += bp_chunk_sizer_samples(&worker->sizer, ROUND_SECONDS, slowest);
    }
    return throughput;
}

/* By rank 0: how many samples the round has, and which part of them each rank gets. */
static void divide(const Throughput *throughputs, uint32_t ranks, double *weights, Plan *plan,
                   uint64_t *fractions) {
    double samples = 0, speed = 0;
    bool known = true;
    for (uint32_t r = 0; r < ranks; ++r) {
        known = known && throughputs[r].speed > 0;
        samples += throughputs[r].samples;
        speed += throughputs[r].speed;
    }
    if (known) samples = fmin(samples, speed * ROUND_SECONDS);
    for (uint32_t r = 0; r < ranks; ++r) weights[r] = known ? throughputs[r].speed : throughputs[r].guess;
    plan->wanted = samples < 1 ? 1 : samples < 1e18 ? (uint64_t)samples : (uint64_t)1000000000 * 1000000000;
    bp_partition_divide(weights, ranks, fractions);
}

/* Agrees on the next round: fills *plan and the fractions. */
static BpStatus plan_round(BpRender *render, Plan *plan, uint64_t fractions[], BpError *err) {
    BpComm *comm = render->comm;
    const uint32_t ranks = bp_comm_size(comm);
    const Throughput own = own_throughput(render);
    Throughput *throughputs = NULL;
    double *weights = NULL;
    BpStatus status = BP_OK;
    if (bp_comm_is_root(comm)) {
        throughputs = malloc(ranks * sizeof *throughputs);
        weights = malloc(ranks * sizeof *weights);
        if (throughputs == NULL || weights == NULL)
            status = bp_fail(err, BP_ERR_MEMORY, "no memory for the throughputs of ranks");
    }
    if (status == BP_OK) status = bp_comm_gather(comm, &own, sizeof own, throughputs, err);
    if (status == BP_OK && bp_comm_is_root(comm)) divide(throughputs, ranks, weights, plan, fractions);
    if (status == BP_OK) status = bp_comm_broadcast(comm, plan, sizeof *plan, err);
    if (status == BP_OK) status = bp_comm_broadcast(comm, fractions, (ranks + 1) * sizeof *fractions, err);
    free(throughputs);
    free(weights);
    return status;
}

/* Traces this rank's part of a block. */
static BpStatus trace_partition(BpRender *render, BpPartition *partition, BpError *err) {
    const double start = bp_clock_seconds();
    BpDispatch *const dispatch = &render->dispatch;
    const uint64_t before = bp_dispatch_samples_done(dispatch);
    double launches = 0;
    BpChunk chunk;
    for (size_t i = 0; i < dispatch->worker_count; ++i)
        launches -= dispatch->workers[i]->first_launch_seconds;
    for (;;) {
        BpWorker *worker = NULL;
        BP_TRY(bp_dispatch_free_worker(dispatch, &worker, err));
        if (!bp_partition_take(partition, bp_dispatch_chunk_samples(dispatch, worker), &chunk)) break;
        BP_TRY(bp_worker_start(worker, &chunk, err));
    }
    BP_TRY(bp_dispatch_wait(dispatch, err));
    for (size_t i = 0; i < dispatch->worker_count; ++i)
        launches += dispatch->workers[i]->first_launch_seconds;
    const uint64_t after = bp_dispatch_samples_done(dispatch);
    if (after == before) return BP_OK;
    BpRounds *round = &render->round;
    round->samples = EARLIER_SHARE * round->samples + (double)(after - before);
    round->seconds = EARLIER_SHARE * round->seconds + fmax(bp_clock_seconds() - start - launches, 1e-9);
    return BP_OK;
}

BpStatus bp_round_trace(BpRender *render, BpError *err) {
    const uint32_t ranks = bp_comm_size(render->comm), rank = bp_comm_rank(render->comm);
    Plan plan = {.wanted = 0};
    BpChunk block;
    BpPartition partition;
    uint64_t *fractions = calloc(ranks + 1, sizeof *fractions);
    if (fractions == NULL) return bp_fail(err, BP_ERR_MEMORY, "no memory for the shares of %u ranks", ranks);
    const BpStatus status = plan_round(render, &plan, fractions, err);
    const uint64_t low = fractions[rank], high = fractions[rank + 1];
    free(fractions);
    BP_TRY(status);
    bp_dispatch_take(&render->dispatch, plan.wanted, &block);
    bp_partition_init(&partition, &block, bp_partition_strips(&block, ranks), low, high);
    BP_TRY(trace_partition(render, &partition, err));
    render->round.pixel_samples += (uint64_t)block.pixel_count * block.samples;
    return BP_OK;
}

BpStatus bp_round_add_films(BpComm *comm, BpFilm *film, BpError *err) {
    enum { FINE = 1, COARSE = 2 };
    const size_t pixels = (size_t)film->width * film->height, cells = pixels * film->replicates;
    uint32_t has = (film->fine_sums != NULL ? FINE : 0) | (film->coarse ? COARSE : 0);
#define TOTAL(member, tally, words) film->member,
    uint64_t totals[] = {film->segments, film->truncated_paths, film->invalid_samples, film->shadow_rays,
                         BP_INVALID_LIST(TOTAL)};
#undef TOTAL
    if (comm == NULL) return BP_OK;
    BP_TRY(bp_comm_allreduce_or(comm, &has, err));
    if (has & FINE) BP_TRY(bp_film_add_fine_sums(film, err));
    BP_TRY(bp_comm_add_64(comm, film->sums, 3 * cells, err));
    if (has & FINE) BP_TRY(bp_comm_add_64(comm, film->fine_sums, 3 * cells, err));
    BP_TRY(bp_comm_add_32(comm, film->counts, cells, err));
    if (film->pixel_segments != NULL) BP_TRY(bp_comm_add_64(comm, film->pixel_segments, pixels, err));
    if (film->met != NULL) BP_TRY(bp_comm_add_64(comm, film->met, pixels, err));
    BP_TRY(bp_comm_add_64(comm, totals, sizeof totals / sizeof totals[0], err));
    film->coarse = (has & COARSE) != 0;
    const uint64_t *total = totals;
    film->segments = *total++;
    film->truncated_paths = *total++;
    film->invalid_samples = *total++;
    film->shadow_rays = *total++;
#define TAKE(member, tally, words) film->member = *total++;
    BP_INVALID_LIST(TAKE)
#undef TAKE
    return BP_OK;
}

BpStatus bp_round_share_pass(BpRender *render, bool *more, BpAdaptivePass *pass, BpError *err) {
    BpComm *comm = render->comm;
    const bool is_root = bp_comm_is_root(comm);
    struct Decisions {
        uint64_t bytes;
        uint32_t more;
    } decisions = {.more = *more};
    uint8_t *bytes = NULL;
    size_t size = 0;
    if (comm == NULL) return BP_OK;
    if (is_root) BP_TRY(bp_adaptive_save(render->adaptive, &bytes, &size, err));
    decisions.bytes = size;
    BpStatus status = bp_comm_broadcast(comm, &decisions, sizeof decisions, err);
    if (status == BP_OK && !is_root) {
        bytes = malloc(decisions.bytes);
        if (bytes == NULL)
            status = bp_fail(err, BP_ERR_MEMORY, "no memory for decisions of adaptive sampling");
    }
    if (status == BP_OK) status = bp_comm_broadcast(comm, bytes, decisions.bytes, err);
    if (status == BP_OK && !is_root) {
        status = bp_adaptive_restore(render->adaptive, bytes, decisions.bytes, err);
        *more = decisions.more != 0;
        if (status == BP_OK && *more && !bp_adaptive_pass(render->adaptive, pass))
            status = bp_fail(err, BP_ERR_FILE, "the decisions of adaptive sampling have no pass");
    }
    free(bytes);
    return status;
}

BpStatus bp_round_share_resumed(BpComm *comm, uint64_t *samples, uint8_t *decisions, size_t bytes,
                                uint8_t **received, BpError *err) {
    if (comm == NULL) return BP_OK;
    bp_comm_begin_work(comm);
    BP_TRY(bp_comm_broadcast(comm, samples, sizeof *samples, err));
    if (bytes > 0 && !bp_comm_is_root(comm)) {
        *received = malloc(bytes);
        if (*received == NULL)
            return bp_fail(err, BP_ERR_MEMORY, "no memory for decisions of adaptive sampling");
        decisions = *received;
    }
    BP_TRY(bp_comm_broadcast(comm, decisions, bytes, err)); /* if it fails, the process ends */
    bp_comm_end_work(comm);
    return BP_OK;
}
