/* comm.c: see comm.h. */
#define _GNU_SOURCE /* sched_getaffinity */
#include "comm.h"

#include "base/clock.h"
#include "base/hash.h"
#include "base/module.h"
#include "launch.h"
#include "transport.h"

#include <inttypes.h>
#include <sched.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* Waiting polls without a pause at first, since answers may be on their way, and then with growing pauses. */
#define TURNS_WITHOUT_PAUSE 100u
#define PAUSE_NS_MIN 20000
#define PAUSE_NS_MAX 2000000

struct BpComm {
    const BpTransport *transport;
    BpPlace place;
    uint32_t cores;
    double waiting, adding; /* seconds */
    BpStatus common_status; /* BP_OK, or the status of the rank that failed */
    bool at_work, has_notified, was_notified;
};

/* ---- exchanges --------------------------------------------------------------------------------------- */

static BpStatus fail_exchange(const char *fault, BpError *err) {
    return bp_fail(err, BP_ERR_DEVICE, "messages between the ranks: %s", fault);
}

/* `fault`: the result of beginning the exchange. */
static BpStatus wait_for(BpComm *comm, const char *fault, BpError *err) {
    const double start = bp_clock_seconds();
    bool done = false;
    struct timespec pause = {.tv_nsec = PAUSE_NS_MIN};
    for (unsigned turn = 0; fault == NULL; ++turn) {
        fault = comm->transport->test(&done);
        if (fault != NULL || done) break;
        if (turn < TURNS_WITHOUT_PAUSE) {
            sched_yield();
            continue;
        }
        nanosleep(&pause, NULL);
        if (pause.tv_nsec < PAUSE_NS_MAX) pause.tv_nsec *= 2;
    }
    comm->waiting += bp_clock_seconds() - start;
    return fault == NULL ? BP_OK : fail_exchange(fault, err);
}

BpStatus bp_comm_broadcast(BpComm *comm, void *bytes, size_t size, BpError *err) {
    if (comm == NULL) return BP_OK;
    for (size_t done = 0; done < size; done += BP_TRANSPORT_BLOCK) {
        const size_t some = size - done < BP_TRANSPORT_BLOCK ? size - done : BP_TRANSPORT_BLOCK;
        BP_TRY(wait_for(comm, comm->transport->broadcast((char *)bytes + done, some), err));
    }
    return BP_OK;
}

BpStatus bp_comm_gather(BpComm *comm, const void *own, size_t size, void *all, BpError *err) {
    if (comm != NULL) return wait_for(comm, comm->transport->gather(own, size, all), err);
    memcpy(all, own, size);
    return BP_OK;
}

BpStatus bp_comm_allreduce_or(BpComm *comm, uint32_t *bits, BpError *err) {
    return comm != NULL ? wait_for(comm, comm->transport->allreduce_or(bits), err) : BP_OK;
}

/* Adding keeps a core busy while it waits, so ranks synchronise first. */
static BpStatus add(BpComm *comm, void *numbers, size_t count, uint32_t width, BpError *err) {
    uint32_t none = 0;
    if (comm == NULL) return BP_OK;
    BP_TRY(bp_comm_allreduce_or(comm, &none, err));
    const double start = bp_clock_seconds();
    const char *fault = comm->transport->add(numbers, count, width);
    comm->adding += bp_clock_seconds() - start;
    return fault == NULL ? BP_OK : fail_exchange(fault, err);
}

BpStatus bp_comm_add_64(BpComm *comm, void *numbers, size_t count, BpError *err) {
    return add(comm, numbers, count, 8, err);
}

BpStatus bp_comm_add_32(BpComm *comm, uint32_t *numbers, size_t count, BpError *err) {
    return add(comm, numbers, count, 4, err);
}

BpStatus bp_comm_gather_texts(BpComm *comm, const char *text, char ***texts, BpError *err) {
    const uint32_t ranks = bp_comm_size(comm);
    const bool is_root = bp_comm_is_root(comm);
    const uint64_t own = strlen(text) + 1;
    uint64_t most = own;
    *texts = NULL;
    uint64_t *sizes = calloc(ranks, sizeof *sizes);
    BpStatus status = sizes != NULL ? bp_comm_gather(comm, &own, sizeof own, sizes, err)
                                    : bp_fail(err, BP_ERR_MEMORY, "out of memory for texts of all ranks");
    for (uint32_t r = 0; status == BP_OK && is_root && r < ranks; ++r)
        if (sizes[r] > most) most = sizes[r];
    free(sizes);
    BP_TRY(status);
    BP_TRY(bp_comm_broadcast(comm, &most, sizeof most, err));
    char *padded = calloc(1, most);
    char **list = is_root ? calloc(1, ranks * (sizeof *list + most)) : NULL;
    if (padded == NULL || (is_root && list == NULL)) {
        free(padded);
        free(list);
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for texts of all ranks");
    }
    memcpy(padded, text, own);
    char *at = is_root ? (char *)(list + ranks) : NULL;
    for (uint32_t r = 0; is_root && r < ranks; ++r) list[r] = at + r * most;
    status = bp_comm_gather(comm, padded, most, at, err);
    free(padded);
    if (status != BP_OK) {
        free(list);
        return status;
    }
    *texts = list;
    return BP_OK;
}

/* ---- how it went --------------------------------------------------------------------------------------- */

typedef struct Story {
    int32_t status, line, column;
    BpRemedy remedy;
    char message[sizeof((BpError *)0)->message], file[sizeof((BpError *)0)->file], host[64];
    char remedy_value[sizeof((BpError *)0)->remedy_value];
} Story;

/* On rank 0: copies the error of the first rank that failed to `err`, unless rank 0 has failed itself. */
static BpStatus tell(const Story *stories, uint32_t ranks, BpError *err) {
    if (stories[0].status != BP_OK) return (BpStatus)stories[0].status;
    for (uint32_t r = 1; r < ranks; ++r) {
        const Story *story = &stories[r];
        if (story->status == BP_OK) continue;
        bp_fail(err, (BpStatus)story->status, "rank %" PRIu32 " on %s: %s", r, story->host, story->message);
        bp_error_at(err, story->file, story->line, story->column);
        bp_error_set_remedy(err, story->remedy, story->remedy_value);
        return (BpStatus)story->status;
    }
    return BP_OK;
}

BpStatus bp_comm_all_ok(BpComm *comm, BpStatus status, BpError *err) {
    uint32_t failed = status != BP_OK;
    if (comm == NULL) return status;
    if (comm->common_status != BP_OK) return comm->common_status;
    BP_TRY(bp_comm_allreduce_or(comm, &failed, err));
    if (!failed) return BP_OK;
    const bool is_root = bp_comm_is_root(comm);
    Story *stories = is_root ? calloc(comm->place.size, sizeof *stories) : NULL;
    if (is_root && stories == NULL)
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for errors of all ranks");
    Story own = {.status = (int32_t)status};
    if (status != BP_OK && err != NULL) {
        own.line = err->line;
        own.column = err->column;
        memcpy(own.message, err->message, sizeof own.message);
        memcpy(own.file, err->file, sizeof own.file);
        own.remedy = err->remedy;
        memcpy(own.remedy_value, err->remedy_value, sizeof own.remedy_value);
    }
    memcpy(own.host, comm->place.host, sizeof own.host);
    int32_t verdict = BP_OK;
    BpStatus exchange = bp_comm_gather(comm, &own, sizeof own, stories, err);
    if (exchange == BP_OK && is_root) verdict = (int32_t)tell(stories, comm->place.size, err);
    free(stories);
    if (exchange == BP_OK) exchange = bp_comm_broadcast(comm, &verdict, sizeof verdict, err);
    comm->common_status = exchange == BP_OK ? (BpStatus)verdict : exchange;
    return comm->common_status;
}

void bp_comm_begin_work(BpComm *comm) {
    if (comm != NULL) comm->at_work = true;
}

void bp_comm_end_work(BpComm *comm) {
    if (comm != NULL) comm->at_work = false;
}

bool bp_comm_is_at_work(const BpComm *comm) {
    return comm != NULL && comm->at_work;
}

void bp_comm_prefix_rank(const BpComm *comm, BpError *err) {
    if (comm == NULL || comm->place.rank == 0) return;
    char message[sizeof err->message];
    const int length = snprintf(message, sizeof message, "rank %" PRIu32 " on %s: %.*s", comm->place.rank,
                                comm->place.host, (int)(sizeof message - 96), err->message);
    if (length > 0) memcpy(err->message, message, sizeof message);
}

void bp_comm_abort(BpComm *comm, int exit_code) {
    if (comm != NULL) comm->transport->abort(exit_code);
}

void bp_comm_notify(BpComm *comm) {
    if (comm == NULL || comm->has_notified) return;
    comm->has_notified = true;
    comm->transport->notify();
}

bool bp_comm_was_notified(BpComm *comm) {
    if (comm == NULL) return false;
    if (!comm->was_notified) comm->was_notified = comm->transport->was_notified();
    return comm->was_notified;
}

/* ---- who and where ----------------------------------------------------------------------------------- */

uint32_t bp_comm_rank(const BpComm *comm) {
    return comm != NULL ? comm->place.rank : 0;
}

uint32_t bp_comm_size(const BpComm *comm) {
    return comm != NULL ? comm->place.size : 1;
}

uint32_t bp_comm_local_rank(const BpComm *comm) {
    return comm != NULL ? comm->place.local_rank : 0;
}

uint32_t bp_comm_cores(const BpComm *comm) {
    return comm != NULL ? comm->cores : 0;
}

void bp_comm_times(const BpComm *comm, double *waiting, double *adding) {
    *waiting = comm != NULL ? comm->waiting : 0;
    *adding = comm != NULL ? comm->adding : 0;
}

/* ---- dividing the cores ------------------------------------------------------------------------------ */

typedef struct Cores {
    uint32_t node;
    cpu_set_t own; /* the cores that the rank may use */
} Cores;

/* Each core counts for a rank by the number of ranks of its machine that may use it: launchers bind ranks to
 * cores of their own, to some that they share, or not at all. `node`: the first rank of the machine. */
static void count_cores(const Cores *all, uint32_t ranks, uint32_t node, uint32_t *counts) {
    uint32_t users[CPU_SETSIZE] = {0};
    for (uint32_t r = node; r < ranks; ++r)
        for (size_t core = 0; core < CPU_SETSIZE && all[r].node == node; ++core)
            users[core] += CPU_ISSET(core, &all[r].own) != 0;
    for (uint32_t r = node; r < ranks; ++r) {
        double sum = 0;
        if (all[r].node != node) continue;
        for (size_t core = 0; core < CPU_SETSIZE; ++core)
            if (CPU_ISSET(core, &all[r].own)) sum += 1.0 / users[core];
        counts[r] = sum >= 1.0 ? (uint32_t)(sum + 1e-6) : 1;
    }
}

static BpStatus divide_cores(BpComm *comm, BpError *err) {
    const uint32_t ranks = comm->place.size;
    Cores own = {.node = comm->place.node};
    if (sched_getaffinity(0, sizeof own.own, &own.own) != 0) CPU_ZERO(&own.own);
    Cores *all = bp_comm_is_root(comm) ? calloc(ranks, sizeof *all) : NULL;
    uint32_t *counts = calloc(ranks, sizeof *counts);
    BpStatus status = counts != NULL && (all != NULL || !bp_comm_is_root(comm))
                          ? bp_comm_gather(comm, &own, sizeof own, all, err)
                          : bp_fail(err, BP_ERR_MEMORY, "out of memory for a list of ranks");
    for (uint32_t r = 0; status == BP_OK && bp_comm_is_root(comm) && r < ranks; ++r)
        if (all[r].node == r) count_cores(all, ranks, r, counts);
    if (status == BP_OK) status = bp_comm_broadcast(comm, counts, ranks * sizeof *counts, err);
    if (status == BP_OK) comm->cores = counts[comm->place.rank];
    free(all);
    free(counts);
    return status;
}

/* ---- beginning and ending ---------------------------------------------------------------------------- */

/* With the ends of the words. */
static uint64_t hash_arguments(char *const *arguments) {
    uint64_t hash = BP_HASH_START;
    for (; *arguments != NULL; ++arguments) hash = bp_hash_bytes(hash, *arguments, strlen(*arguments) + 1);
    return hash;
}

/* Ranks with different arguments cannot share a picture: a script may start a separate render on each. */
static BpStatus check_arguments(BpComm *comm, char *const *arguments, BpError *err) {
    const uint64_t own = hash_arguments(arguments);
    uint64_t first = own;
    BP_TRY(bp_comm_broadcast(comm, &first, sizeof first, err));
    uint32_t differ = first != own;
    BP_TRY(bp_comm_allreduce_or(comm, &differ, err));
    if (!differ) return BP_OK;
    return bp_fail(err, BP_ERR_USAGE,
                   "the %" PRIu32
                   " ranks were given different arguments, so they cannot work on one picture; set "
                   "BALLPARK_MPI=off in the environment for renders that have nothing to do with each other",
                   comm->place.size);
}

static BpStatus open_module(BpComm *comm, const BpLaunch *launch, BpError *err) {
    /* MPI libraries load plugins, which need its symbols. */
    static const BpModuleName name = {"ballpark_mpi.so", "BALLPARK_MPI", BP_TRANSPORT_SYMBOL,
                                      BP_TRANSPORT_VERSION, true};
    const void *transport = NULL;
    BpError fault = {0};
    if (bp_module_load(&name, &transport, &fault) != BP_OK)
        return bp_fail(err, BP_ERR_USAGE,
                       "%s started %" PRIu32 " copies of this program, but they cannot share the work, since "
                       "%.750s; build Ballpark with MPI (libopenmpi-dev), or set BALLPARK_MPI=off in the "
                       "environment if each is to render on its own",
                       launch->launcher, launch->size, fault.message);
    comm->transport = transport;
    return BP_OK;
}

static BpStatus start(BpComm *comm, const BpLaunch *launch, char *const *arguments, BpError *err) {
    BP_TRY(open_module(comm, launch, err));
    const char *fault = comm->transport->start(&comm->place);
    if (fault != NULL) return fail_exchange(fault, err);
    if (comm->place.size != launch->size)
        return bp_fail(
            err, BP_ERR_USAGE,
            "%s started %" PRIu32 " copies of this program, but its MPI reports %" PRIu32
            ": it is not the launcher's MPI; use the launcher of the one that Ballpark was built "
            "with (with srun: --mpi=pmix, or what `srun --mpi=list` names), or set BALLPARK_MPI=off if each "
            "is "
            "to render on its own",
            launch->launcher, launch->size, comm->place.size);
    BP_TRY(check_arguments(comm, arguments, err));
    return divide_cores(comm, err);
}

BpStatus bp_comm_begin(char *const *arguments, BpComm **comm, BpError *err) {
    const BpLaunch launch = bp_launch_find();
    const char *named = getenv("BALLPARK_MPI");
    *comm = NULL;
    if (launch.size <= 1 || (named != NULL && strcmp(named, "off") == 0)) return BP_OK;
    BpComm *made = calloc(1, sizeof *made);
    if (made == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for a communicator");
    const BpStatus status = start(made, &launch, arguments, err);
    if (status == BP_OK)
        *comm = made;
    else
        bp_comm_end(&made);
    return status;
}

void bp_comm_end(BpComm **comm) {
    if (comm == NULL || *comm == NULL) return;
    if ((*comm)->transport != NULL && (*comm)->place.size > 0) (*comm)->transport->end();
    free(*comm);
    *comm = NULL;
}
