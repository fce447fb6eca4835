/* ballpark_mpi.c: the module ballpark_mpi.so, which carries bytes between ranks by MPI; see transport.h.
 *
 * In and out: as transport.h has it.
 * Knows: MPI 3.   Does not know: what the bytes mean. */
#include "cluster/transport.h"

#include <mpi.h>

#include <stdio.h>
#include <string.h>

enum { TAG_NOTIFY = 1, ADD_NUMBERS = 1 << 20 };

static MPI_Request request = MPI_REQUEST_NULL;
static int own_rank, job_size;
static char problem[MPI_MAX_ERROR_STRING + 64];

static const char *check(int code, const char *what) {
    char text[MPI_MAX_ERROR_STRING] = "unknown error";
    int length = 0;
    if (code == MPI_SUCCESS) return NULL;
    MPI_Error_string(code, text, &length);
    snprintf(problem, sizeof problem, "%s failed: %s", what, text);
    return problem;
}

static const char *start(BpPlace *place) {
    int provided = 0, local_rank = 0, local_size = 0, node = 0, length = 0;
    char name[MPI_MAX_PROCESSOR_NAME] = "";
    MPI_Comm local = MPI_COMM_NULL;
    /* The program has other threads, but one alone calls MPI. */
    const char *fault = check(MPI_Init_thread(NULL, NULL, MPI_THREAD_FUNNELED, &provided), "MPI_Init_thread");
    if (fault != NULL) return fault;
    MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN);
    MPI_Comm_rank(MPI_COMM_WORLD, &own_rank);
    MPI_Comm_size(MPI_COMM_WORLD, &job_size);
    fault = check(MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, own_rank, MPI_INFO_NULL, &local),
                  "MPI_Comm_split_type");
    if (fault != NULL) return fault;
    MPI_Comm_rank(local, &local_rank);
    MPI_Comm_size(local, &local_size);
    node = own_rank;
    fault = check(MPI_Bcast(&node, 1, MPI_INT, 0, local), "MPI_Bcast");
    MPI_Comm_free(&local);
    if (fault != NULL) return fault;
    MPI_Get_processor_name(name, &length);
    *place = (BpPlace){.rank = (uint32_t)own_rank,
                       .size = (uint32_t)job_size,
                       .local_rank = (uint32_t)local_rank,
                       .local_size = (uint32_t)local_size,
                       .node = (uint32_t)node};
    snprintf(place->host, sizeof place->host, "%.63s", name);
    return NULL;
}

static const char *broadcast(void *bytes, uint64_t size) {
    return check(MPI_Ibcast(bytes, (int)size, MPI_BYTE, 0, MPI_COMM_WORLD, &request), "MPI_Ibcast");
}

static const char *gather(const void *own, uint64_t size, void *all) {
    return check(MPI_Igather(own, (int)size, MPI_BYTE, all, (int)size, MPI_BYTE, 0, MPI_COMM_WORLD, &request),
                 "MPI_Igather");
}

static const char *allreduce_or(uint32_t *bits) {
    return check(MPI_Iallreduce(MPI_IN_PLACE, bits, 1, MPI_UINT32_T, MPI_BOR, MPI_COMM_WORLD, &request),
                 "MPI_Iallreduce");
}

static const char *test(bool *done) {
    int flag = 0;
    const char *fault = check(MPI_Test(&request, &flag, MPI_STATUS_IGNORE), "MPI_Test");
    *done = flag != 0;
    return fault;
}

/* In blocks, which limits the memory for the sums of other ranks. */
static const char *add(void *numbers, uint64_t count, uint32_t width) {
    MPI_Datatype type = width == 8 ? MPI_INT64_T : MPI_UINT32_T;
    for (uint64_t done = 0; done < count; done += ADD_NUMBERS) {
        char *at = (char *)numbers + done * width;
        const int some = count - done < ADD_NUMBERS ? (int)(count - done) : ADD_NUMBERS;
        const char *fault =
            check(own_rank == 0 ? MPI_Reduce(MPI_IN_PLACE, at, some, type, MPI_SUM, 0, MPI_COMM_WORLD)
                                : MPI_Reduce(at, NULL, some, type, MPI_SUM, 0, MPI_COMM_WORLD),
                  "MPI_Reduce");
        if (fault != NULL) return fault;
    }
    return NULL;
}

/* Messages without content need no memory that must stay. */
static void notify(void) {
    for (int rank = 0; rank < job_size; ++rank) {
        MPI_Request sending;
        if (rank == own_rank) continue;
        if (MPI_Isend(NULL, 0, MPI_BYTE, rank, TAG_NOTIFY, MPI_COMM_WORLD, &sending) == MPI_SUCCESS)
            MPI_Request_free(&sending);
    }
}

static bool was_notified(void) {
    int flag = 0;
    MPI_Status status;
    if (MPI_Iprobe(MPI_ANY_SOURCE, TAG_NOTIFY, MPI_COMM_WORLD, &flag, &status) != MPI_SUCCESS || flag == 0)
        return false;
    MPI_Recv(NULL, 0, MPI_BYTE, status.MPI_SOURCE, TAG_NOTIFY, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    return true;
}

static void abort_all(int exit_code) {
    MPI_Abort(MPI_COMM_WORLD, exit_code);
}

static void end(void) {
    while (was_notified()) { /* an unread notice */
    }
    MPI_Finalize();
}

extern const BpTransport bp_transport;
__attribute__((visibility("default"))) const BpTransport bp_transport = {
    .version = BP_TRANSPORT_VERSION,
    .start = start,
    .broadcast = broadcast,
    .gather = gather,
    .allreduce_or = allreduce_or,
    .test = test,
    .add = add,
    .notify = notify,
    .was_notified = was_notified,
    .abort = abort_all,
    .end = end,
};
