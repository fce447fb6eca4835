/* test_ranks.c: what ranks tell each other arrives: the films that they add, what a film tells that one of
 * them has read, errors, texts. The ranks are this process and its children. */
#include "cluster/comm.h"
#include "fake_ranks.h"
#include "film/film.h"
#include "render/round.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "support/unit_test.h"

enum { RANKS = 3, WIDTH = 5, HEIGHT = 4, LIMIT_SECONDS = 60 };

typedef bool RankBody(BpComm *comm);

/* Says what is wrong and goes on: a child must not go back to the test's runner. */
static bool holds(bool condition, const char *what) {
    if (!condition) fprintf(stderr, "wrong: %s\n", what);
    return condition;
}

static bool work(uint32_t rank, RankBody *body) {
    char text[16], *arguments[] = {"ballpark", NULL};
    BpComm *comm = NULL;
    BpError err = {0};
    snprintf(text, sizeof text, "%u", rank);
    setenv("OMPI_COMM_WORLD_RANK", text, 1);
    bool fine = holds(bp_comm_begin(arguments, &comm, &err) == BP_OK, err.message);
    fine = fine && holds(bp_comm_size(comm) == RANKS && bp_comm_rank(comm) == rank, "who this is");
    fine = fine && body(comm);
    bp_comm_end(&comm);
    return fine;
}

/* All ranks carry out `body`. */
static void with_ranks(RankBody *body) {
    pid_t children[RANKS] = {0};
    char text[16];
    snprintf(text, sizeof text, "%d", RANKS);
    setenv("OMPI_COMM_WORLD_SIZE", text, 1);
    setenv("BALLPARK_MPI", FAKE_RANKS, 1);
    for (uint32_t r = 1; r < RANKS; ++r) {
        int ends[2];
        assert_int_equal(socketpair(AF_UNIX, SOCK_STREAM, 0, ends), 0);
        assert_int_equal(dup2(ends[0], SOCKET_OF_LEADER(r)), SOCKET_OF_LEADER(r));
        assert_int_equal(dup2(ends[1], SOCKET_OF_RANK(r)), SOCKET_OF_RANK(r));
        close(ends[0]);
        close(ends[1]);
    }
    fflush(NULL);
    for (uint32_t r = 1; r < RANKS; ++r) {
        children[r] = fork();
        assert_true(children[r] >= 0);
        if (children[r] > 0) continue;
        alarm(LIMIT_SECONDS);
        for (uint32_t other = 1; other < RANKS; ++other) { /* so that the end of a process shows */
            close(SOCKET_OF_LEADER(other));
            if (other != r) close(SOCKET_OF_RANK(other));
        }
        _exit(work(r, body) ? 0 : 1);
    }
    for (uint32_t r = 1; r < RANKS; ++r) close(SOCKET_OF_RANK(r));
    bool fine = work(0, body);
    for (uint32_t r = 1; r < RANKS; ++r) close(SOCKET_OF_LEADER(r));
    for (uint32_t r = 1; r < RANKS; ++r) {
        int status = 0;
        assert_int_equal(waitpid(children[r], &status, 0), children[r]);
        fine = holds(WIFEXITED(status) && WEXITSTATUS(status) == 0, "another rank") && fine;
    }
    assert_true(fine);
}

/* ---- films --------------------------------------------------------------------------------------------- */

/* Rank 1 alone has fine sums, rank 2 alone a dim sample. */
static BpFilm *own_film(uint32_t rank) {
    BpFilm *film = NULL;
    const size_t pixels = (size_t)WIDTH * HEIGHT;
    if (bp_film_create(WIDTH, HEIGHT, 4, &film, NULL) != BP_OK || bp_film_add_met(film, NULL) != BP_OK ||
        (rank == 1 && bp_film_add_fine_sums(film, NULL) != BP_OK))
        abort();
    film->pixel_segments = calloc(pixels, sizeof *film->pixel_segments);
    film->coarse = rank == 2;
    for (size_t i = 0; i < 4 * pixels; ++i) {
        film->counts[i] = 100 * rank + (uint32_t)i;
        for (size_t c = 3 * i; c < 3 * i + 3; ++c) {
            film->sums[c] = ((int64_t)1 << 40) * (rank + 1) + (int64_t)c;
            if (film->fine_sums != NULL) film->fine_sums[c] = (int64_t)c + 7;
        }
    }
    for (size_t p = 0; p < pixels; ++p) {
        film->met[p] = 10 * rank + p;
        film->pixel_segments[p] = 20 * rank + p;
    }
    film->segments = 1000 + rank;
    film->truncated_paths = 2000 + rank;
    film->invalid_samples = 3000 + rank;
    film->not_finite_samples = 500 + rank;
    film->negative_samples = 600 + rank;
    film->out_of_range_samples = 700 + rank;
    film->shadow_rays = 4000 + rank;
    return film;
}

static bool add_films(BpComm *comm) {
    BpFilm *film = own_film(bp_comm_rank(comm));
    const uint32_t pixels = WIDTH * HEIGHT, sum_of_ranks = RANKS * (RANKS - 1) / 2;
    bool fine = holds(bp_round_add_films(comm, film, NULL) == BP_OK, "adding");
    if (fine && bp_comm_is_root(comm)) {
        bool sums = true, fine_sums = film->fine_sums != NULL, counts = true, met = true, segments = true;
        for (size_t i = 0; i < 4 * pixels; ++i) {
            counts = counts && film->counts[i] == 100 * sum_of_ranks + RANKS * i;
            for (size_t c = 3 * i; c < 3 * i + 3; ++c) {
                sums =
                    sums && film->sums[c] == ((int64_t)1 << 40) * (RANKS + sum_of_ranks) + RANKS * (int64_t)c;
                fine_sums = fine_sums && film->fine_sums[c] == (int64_t)c + 7;
            }
        }
        for (size_t p = 0; p < pixels; ++p) {
            met = met && film->met[p] == 10 * sum_of_ranks + RANKS * p;
            segments = segments && film->pixel_segments[p] == 20 * sum_of_ranks + RANKS * p;
        }
        fine = holds(sums, "sums") && holds(fine_sums, "fine sums") && holds(counts, "counts") &&
               holds(met, "alpha") && holds(segments, "path lengths") && holds(film->coarse, "coarse") &&
               holds(film->segments == 1000 * RANKS + sum_of_ranks, "segments") &&
               holds(film->truncated_paths == 2000 * RANKS + sum_of_ranks, "truncated paths") &&
               holds(film->invalid_samples == 3000 * RANKS + sum_of_ranks, "invalid samples") &&
               holds(film->not_finite_samples == 500 * RANKS + sum_of_ranks, "samples not finite") &&
               holds(film->negative_samples == 600 * RANKS + sum_of_ranks, "negative samples") &&
               holds(film->out_of_range_samples == 700 * RANKS + sum_of_ranks, "samples out of range") &&
               holds(film->shadow_rays == 4000 * RANKS + sum_of_ranks, "rays to lamps");
    }
    bp_film_destroy(&film);
    return fine;
}

static bool share_resumed(BpComm *comm) {
    const bool is_root = bp_comm_is_root(comm);
    char decisions[] = "what has been decided";
    uint8_t *received = NULL;
    uint64_t samples = is_root ? 123456789012345 : 0;
    const BpStatus status = bp_round_share_resumed(comm, &samples, is_root ? (uint8_t *)decisions : NULL,
                                                   sizeof decisions, &received, NULL);
    bool fine = holds(status == BP_OK && samples == 123456789012345, "samples") &&
                holds(!bp_comm_is_at_work(comm), "the end of common work");
    fine = fine &&
           holds(is_root ? received == NULL : received != NULL && strcmp((char *)received, decisions) == 0,
                 "decisions");
    free(received);
    received = NULL;
    samples = is_root ? 5 : 0;
    fine = fine && holds(bp_round_share_resumed(comm, &samples, NULL, 0, &received, NULL) == BP_OK &&
                             samples == 5 && received == NULL,
                         "a film without decisions");
    return fine;
}

/* ---- words --------------------------------------------------------------------------------------------- */

/* Longer than a block of a transport. */
static bool broadcast_much(BpComm *comm) {
    const size_t size = ((size_t)5 << 20) + 3;
    uint8_t *bytes = calloc(1, size);
    for (size_t i = 0; bp_comm_is_root(comm) && i < size; ++i) bytes[i] = (uint8_t)(i * 7 + i / 256);
    bool fine = bytes != NULL && holds(bp_comm_broadcast(comm, bytes, size, NULL) == BP_OK, "a broadcast");
    for (size_t i = 0; fine && i < size; ++i) fine = bytes[i] == (uint8_t)(i * 7 + i / 256);
    free(bytes);
    return holds(fine, "what is broadcast");
}

static bool collect_texts(BpComm *comm) {
    char own[300], **texts = NULL;
    memset(own, 'a' + (int)bp_comm_rank(comm), sizeof own);
    own[100 * bp_comm_rank(comm)] = '\0';
    bool fine = holds(bp_comm_gather_texts(comm, own, &texts, NULL) == BP_OK, "gathering texts");
    for (uint32_t r = 0; fine && bp_comm_is_root(comm) && r < RANKS; ++r)
        fine = holds(strlen(texts[r]) == 100 * r && (r == 0 || texts[r][100 * r - 1] == 'a' + (char)r),
                     "a text");
    free(texts);
    return fine;
}

static bool all_ok(BpComm *comm) {
    BpError err = {0};
    bool fine = holds(bp_comm_all_ok(comm, BP_OK, &err) == BP_OK, "that all went well");
    BpStatus status = BP_OK;
    if (bp_comm_rank(comm) == 1) {
        status = bp_fail(&err, BP_ERR_FILE, "no such thing");
        bp_error_at(&err, "scene.json", 3, 4);
    }
    fine = fine && holds(bp_comm_all_ok(comm, status, &err) == BP_ERR_FILE, "that one failed");
    if (bp_comm_is_root(comm))
        fine = fine && holds(strcmp(err.message, "rank 1 on here: no such thing") == 0 && err.line == 3 &&
                                 err.column == 4 && strcmp(err.file, "scene.json") == 0,
                             err.message);
    fine = fine && holds(bp_comm_all_ok(comm, BP_OK, &err) == BP_ERR_FILE, "that it stays so");
    bp_error_clear(&err);
    return fine;
}

static void test_films(void **state) {
    (void)state;
    with_ranks(add_films);
}

static void test_resumed(void **state) {
    (void)state;
    with_ranks(share_resumed);
}

static void test_much(void **state) {
    (void)state;
    with_ranks(broadcast_much);
}

static void test_texts(void **state) {
    (void)state;
    with_ranks(collect_texts);
}

static void test_all_ok(void **state) {
    (void)state;
    with_ranks(all_ok);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_films), cmocka_unit_test(test_resumed), cmocka_unit_test(test_much),
        cmocka_unit_test(test_texts), cmocka_unit_test(test_all_ok),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
