/* round.h: a render that several ranks share: rounds of samples, and the sum of their films.
 *
 * In:    a render, its communicator, measured speeds.
 * Out:   this rank's part of a round, traced; in rank 0, the whole film.
 * Knows: who traces what, and when ranks speak to each other.   Does not know: how (cluster/comm.h), files.
 *
 * All ranks have the same schedule and take the same block of it in each round, of about ROUND_SECONDS; each
 * traces its partition. So between rounds the samples that are there are those of a render alone, and films
 * record how to continue, as always. A round costs a few short messages. Sums go to rank 0 only when
 * something is decided or written. */
#ifndef BP_RENDER_ROUND_H
#define BP_RENDER_ROUND_H

#include "cluster/comm.h"
#include "render_state.h"

/* The next round, of a render that has something left to hand out. All ranks. */
BpStatus bp_round_trace(BpRender *render, BpError *err);

/* Adds the films of all ranks on rank 0. All ranks. */
BpStatus bp_round_add_films(BpComm *comm, BpFilm *film, BpError *err);

/* What only rank 0 has of the film from which the render continues, since the others read its header alone:
 * pixel samples, and `bytes` of decisions (whose number all know). *received becomes a copy to be freed on
 * the other ranks, and stays NULL here and where there are none. A rank that fails leaves the others waiting,
 * so it fails amid common work (comm.h). All ranks. */
BpStatus bp_round_share_resumed(BpComm *comm, uint64_t *samples, uint8_t *decisions, size_t bytes,
                                uint8_t **received, BpError *err);

/* Adaptive sampling: rank 0's decisions become everybody's. *more and *pass are rank 0's, elsewhere they are
 * set. All ranks. */
BpStatus bp_round_share_pass(BpRender *render, bool *more, BpAdaptivePass *pass, BpError *err);

#endif
