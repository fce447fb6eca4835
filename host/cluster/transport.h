/* transport.h: the interface of the loadable module that carries messages between the ranks of a job.
 *
 * In:    bytes, integers.   Out: those of other ranks, or sums over all of them.
 * Knows: nothing.   Does not know: MPI (the modules do), what the bytes mean (comm.h's callers do).
 *
 * A module is a shared object that exports one struct, `bp_transport`. So the program needs no library for
 * messages unless it was started as one of several ranks. All ranks call the same functions in the same
 * order. Functions return NULL, or an error message that is valid until the next call. */
#ifndef BP_CLUSTER_TRANSPORT_H
#define BP_CLUSTER_TRANSPORT_H

#include <stdbool.h>
#include <stdint.h>

#define BP_TRANSPORT_VERSION 1u
#define BP_TRANSPORT_SYMBOL "bp_transport"
#define BP_TRANSPORT_BLOCK ((uint64_t)1 << 22) /* bytes of one call at most */

/* The rank of a process in its job. */
typedef struct BpPlace {
    uint32_t rank, size;             /* of the job */
    uint32_t local_rank, local_size; /* of those on the same machine */
    uint32_t node;                   /* the rank of the first one on this machine */
    char host[64];                   /* the machine's name */
} BpPlace;

typedef struct BpTransport {
    uint32_t version; /* BP_TRANSPORT_VERSION */
    const char *(*start)(BpPlace *place);

    /* Each begins an exchange, which is over when test() returns true; one is under way at a time, and its
     * memory stays in place. At most BP_TRANSPORT_BLOCK bytes. */
    const char *(*broadcast)(void *bytes, uint64_t size); /* from rank 0 to all */
    /* Gathers from all on rank 0: `all` is Optional elsewhere; there rank r's begin at r * size. */
    const char *(*gather)(const void *own, uint64_t size, void *all);
    const char *(*allreduce_or)(uint32_t *bits); /* on all ranks the bits that any rank has set */
    const char *(*test)(bool *done);

    /* Integers of `width` bytes, 4 or 8, become on rank 0 the sums over all ranks; elsewhere they stay.
     * Blocks, and may keep a core busy meanwhile, so synchronise the ranks first. */
    const char *(*add)(void *numbers, uint64_t count, uint32_t width);

    /* Notifies all other ranks, which poll for it. */
    void (*notify)(void);
    bool (*was_notified)(void);

    void (*abort)(int exit_code); /* ends the processes of all ranks */
    void (*end)(void);            /* after the last exchange */
} BpTransport;

#endif
