/* team.c: see team.h. Threads live as long as the team; a new round of work wakes them. */
#include "team.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdlib.h>
#include <unistd.h>

#define THREADS_MAX 64u /* more would wait for memory and for each other */

typedef struct Member {
    BpTeam *team;
    pthread_t thread;
    unsigned number;
} Member;

struct BpTeam {
    unsigned size; /* with the caller, who is number 0 */
    pthread_mutex_t mutex;
    pthread_cond_t wake, idle;
    uint64_t round;   /* counts calls of bp_team_run */
    unsigned working; /* members that have not finished the round */
    bool leave;
    BpTeamWork *work;
    void *context;
    uint32_t pieces;
    atomic_uint_fast64_t next;
    Member members[THREADS_MAX];
};

static void work_through(BpTeam *team, unsigned worker) {
    for (;;) {
        const uint64_t piece = atomic_fetch_add_explicit(&team->next, 1, memory_order_relaxed);
        if (piece >= team->pieces) return;
        team->work(team->context, (uint32_t)piece, worker);
    }
}

static void *member_main(void *argument) {
    Member *member = argument;
    BpTeam *team = member->team;
    uint64_t seen = 0;
    pthread_mutex_lock(&team->mutex);
    for (;;) {
        while (team->round == seen && !team->leave) pthread_cond_wait(&team->wake, &team->mutex);
        if (team->leave) break;
        seen = team->round;
        pthread_mutex_unlock(&team->mutex);
        work_through(team, member->number);
        pthread_mutex_lock(&team->mutex);
        if (--team->working == 0) pthread_cond_signal(&team->idle);
    }
    pthread_mutex_unlock(&team->mutex);
    return NULL;
}

BpTeam *bp_team_create(unsigned threads) {
    BpTeam *team = calloc(1, sizeof *team);
    if (team == NULL) return NULL;
    pthread_mutex_init(&team->mutex, NULL);
    pthread_cond_init(&team->wake, NULL);
    pthread_cond_init(&team->idle, NULL);
    atomic_init(&team->next, 0);
    if (threads == 0) {
        const long cores = sysconf(_SC_NPROCESSORS_ONLN);
        threads = cores > 0 ? (unsigned)cores : 1;
    }
    if (threads > THREADS_MAX) threads = THREADS_MAX;
    team->size = 1;
    while (team->size < threads) {
        Member *member = &team->members[team->size];
        *member = (Member){.team = team, .number = team->size};
        if (pthread_create(&member->thread, NULL, member_main, member) != 0) break;
        ++team->size;
    }
    return team;
}

void bp_team_destroy(BpTeam **team) {
    if (*team == NULL) return;
    pthread_mutex_lock(&(*team)->mutex);
    (*team)->leave = true;
    pthread_cond_broadcast(&(*team)->wake);
    pthread_mutex_unlock(&(*team)->mutex);
    for (unsigned i = 1; i < (*team)->size; ++i) pthread_join((*team)->members[i].thread, NULL);
    pthread_cond_destroy(&(*team)->wake);
    pthread_cond_destroy(&(*team)->idle);
    pthread_mutex_destroy(&(*team)->mutex);
    free(*team);
    *team = NULL;
}

unsigned bp_team_size(const BpTeam *team) {
    return team->size;
}

void bp_team_run(BpTeam *team, BpTeamWork *work, void *context, uint32_t pieces) {
    if (team->size == 1 || pieces < 2) {
        for (uint32_t piece = 0; piece < pieces; ++piece) work(context, piece, 0);
        return;
    }
    pthread_mutex_lock(&team->mutex);
    team->work = work;
    team->context = context;
    team->pieces = pieces;
    atomic_store_explicit(&team->next, 0, memory_order_relaxed);
    team->working = team->size - 1;
    ++team->round;
    pthread_cond_broadcast(&team->wake);
    pthread_mutex_unlock(&team->mutex);
    work_through(team, 0);
    pthread_mutex_lock(&team->mutex);
    while (team->working > 0) pthread_cond_wait(&team->idle, &team->mutex);
    pthread_mutex_unlock(&team->mutex);
}
