/* fake_ranks.c: a module like the one for MPI, whose ranks are processes that have inherited sockets. Every
 * exchange is over when it returns. The environment may name one that fails (FAULT_AT: its number, from 0),
 * and another number of ranks than the launcher's (FAKE_SIZE). */
#include "fake_ranks.h"

#include "cluster/transport.h"

#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>

static uint32_t rank, size;
static int calls, fault_at; /* below 0: none fails */

static bool fails(void) {
    return calls++ == fault_at;
}

static bool put(int socket, const void *bytes, uint64_t count) {
    for (uint64_t done = 0; done < count;) {
        const ssize_t some = send(socket, (const char *)bytes + done, count - done, MSG_NOSIGNAL);
        if (some <= 0) return false;
        done += (uint64_t)some;
    }
    return true;
}

static bool get(int socket, void *bytes, uint64_t count) {
    for (uint64_t done = 0; done < count;) {
        const ssize_t some = recv(socket, (char *)bytes + done, count - done, 0);
        if (some <= 0) return false;
        done += (uint64_t)some;
    }
    return true;
}

static const char *told(bool fine) {
    return fine ? NULL : "another rank has gone";
}

static const char *start(BpPlace *place) {
    rank = (uint32_t)atoi(getenv("OMPI_COMM_WORLD_RANK"));
    size = (uint32_t)atoi(getenv(getenv("FAKE_SIZE") != NULL ? "FAKE_SIZE" : "OMPI_COMM_WORLD_SIZE"));
    fault_at = getenv("FAULT_AT") != NULL ? atoi(getenv("FAULT_AT")) : -1;
    calls = 0;
    if (fails()) return "pretended";
    *place = (BpPlace){.rank = rank, .size = size, .local_rank = rank, .local_size = size, .host = "here"};
    return NULL;
}

static const char *broadcast(void *bytes, uint64_t count) {
    bool fine = true;
    if (fails()) return "pretended";
    if (rank > 0) return told(get(SOCKET_OF_RANK(rank), bytes, count));
    for (uint32_t r = 1; r < size; ++r) fine = put(SOCKET_OF_LEADER(r), bytes, count) && fine;
    return told(fine);
}

static const char *gather(const void *own, uint64_t count, void *all) {
    bool fine = true;
    if (fails()) return "pretended";
    if (rank > 0) return told(put(SOCKET_OF_RANK(rank), own, count));
    memcpy(all, own, count);
    for (uint32_t r = 1; r < size; ++r)
        fine = get(SOCKET_OF_LEADER(r), (char *)all + r * count, count) && fine;
    return told(fine);
}

static const char *allreduce_or(uint32_t *bits) {
    uint32_t all[64] = {0};
    const char *fault = gather(bits, sizeof *bits, all);
    for (uint32_t r = 0; rank == 0 && r < size; ++r) *bits |= all[r];
    return fault != NULL ? fault : broadcast(bits, sizeof *bits);
}

static const char *test(bool *done) {
    *done = true;
    return NULL;
}

static const char *add(void *numbers, uint64_t count, uint32_t width) {
    bool fine = true;
    if (fails()) return "pretended";
    if (rank > 0) return told(put(SOCKET_OF_RANK(rank), numbers, count * width));
    void *other = malloc(count * width);
    for (uint32_t r = 1; fine && r < size; ++r) {
        fine = get(SOCKET_OF_LEADER(r), other, count * width);
        for (uint64_t i = 0; fine && i < count; ++i)
            if (width == 8)
                ((uint64_t *)numbers)[i] += ((uint64_t *)other)[i];
            else
                ((uint32_t *)numbers)[i] += ((uint32_t *)other)[i];
    }
    free(other);
    return told(fine);
}

/* A rank hears of itself alone. */
static bool notified;
static void notify(void) {
    notified = true;
}

static bool was_notified(void) {
    return notified;
}

static void end(void) {}

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
    .abort = exit,
    .end = end,
};
