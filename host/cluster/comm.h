/* comm.h: the communicator: the ranks that work on one job, of which this process is one.
 *
 * In:    data of this rank.   Out: data of the others; decisions that are the same on all ranks.
 * Knows: the module that carries messages, when to load it.   Does not know: MPI, pictures, the command line.
 *
 * A communicator of NULL is this process alone: then every function below does nothing and succeeds. Unless a
 * comment states otherwise, all ranks call the same functions in the same order. A function that fails leaves
 * the others waiting, so the failure of one rank amid common work ends all (bp_comm_abort()); before and
 * after that, ranks agree on how it went (bp_comm_all_ok()). Waiting for others takes next to no processor
 * time. */
#ifndef BP_CLUSTER_COMM_H
#define BP_CLUSTER_COMM_H

#include "base/status.h"

typedef struct BpComm BpComm;

/* *comm stays NULL where this process was started alone, or the environment says BALLPARK_MPI=off. The module
 * is `ballpark_mpi.so` beside the program or in its library folder, or what BALLPARK_MPI names. `arguments`
 * must be the same on all ranks. BP_ERR_USAGE: several were started, but the module is missing, reports
 * another number of ranks, or the ranks were given different arguments. */
BpStatus bp_comm_begin(char *const *arguments, BpComm **comm, BpError *err);
/* Ends all messages. Accepts NULL and the address of NULL. */
void bp_comm_end(BpComm **comm);

/* No exchange: may be called at any time. */
uint32_t bp_comm_rank(const BpComm *comm); /* 0 when alone, and for the rank that decides */
uint32_t bp_comm_size(const BpComm *comm); /* 1 when alone */
uint32_t bp_comm_local_rank(const BpComm *comm);
static inline bool bp_comm_is_root(const BpComm *comm) {
    return bp_comm_rank(comm) == 0;
}
/* Cores of this rank: those it may use, each divided by the ranks of its machine that may use it too; at
 * least 1. 0 when alone: all. */
uint32_t bp_comm_cores(const BpComm *comm);
/* Seconds spent waiting for other ranks, and spent adding. */
void bp_comm_times(const BpComm *comm, double *waiting, double *adding);

/* Broadcasts from rank 0 to all. */
BpStatus bp_comm_broadcast(BpComm *comm, void *bytes, size_t size, BpError *err);
/* Copies `size` bytes of every rank to rank 0, in the order of ranks, to `all`, which elsewhere may be NULL.
 */
BpStatus bp_comm_gather(BpComm *comm, const void *own, size_t size, void *all, BpError *err);
/* The bits that any rank has set. */
BpStatus bp_comm_allreduce_or(BpComm *comm, uint32_t *bits, BpError *err);
/* On rank 0 the sums over all ranks of each of `count` integers; elsewhere they stay as they are. */
BpStatus bp_comm_add_64(BpComm *comm, void *numbers, size_t count, BpError *err);
BpStatus bp_comm_add_32(BpComm *comm, uint32_t *numbers, size_t count, BpError *err);
/* A text of each rank, on rank 0: *texts becomes a list of them, to be freed in one by free(); elsewhere
 * NULL. */
BpStatus bp_comm_gather_texts(BpComm *comm, const char *text, char ***texts, BpError *err);

/* The common status of all ranks: `status` if all succeeded; else, on all of them, the status of the first
 * that failed. Rank 0's `err` then describes the failure and names the rank; the others' need not be
 * displayed. After the first failure, it fails at once and without an exchange. A failed exchange counts as a
 * failure. */
BpStatus bp_comm_all_ok(BpComm *comm, BpStatus status, BpError *err);

/* Between the two, the ranks depend on each other, and a rank that fails cannot agree with the others. No
 * exchange. */
void bp_comm_begin_work(BpComm *comm);
void bp_comm_end_work(BpComm *comm);
bool bp_comm_is_at_work(const BpComm *comm);
/* Puts "rank 3 on node7: " before the message of an error, except for rank 0's. */
void bp_comm_prefix_rank(const BpComm *comm, BpError *err);
/* Ends all ranks' processes at once; does not return when there are other ranks. By one rank alone. */
void bp_comm_abort(BpComm *comm, int exit_code);

/* Between exchanges: notifies all other ranks, once; whether another rank has notified this one. */
void bp_comm_notify(BpComm *comm);
bool bp_comm_was_notified(BpComm *comm);

#endif
