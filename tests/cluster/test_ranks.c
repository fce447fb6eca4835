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

/* As the launcher has it. */
static void be_rank(uint32_t rank) {
    char text[16];
    snprintf(text, sizeof text, "%u", rank);
    setenv("OMPI_COMM_WORLD_RANK", text, 1);
}

static bool work(uint32_t rank, RankBody *body) {
    char *arguments[] = {"ballpark", NULL};
    BpComm *comm = NULL;
    BpError err = {0};
    be_rank(rank);
    bool fine = holds(bp_comm_begin(arguments, &comm, &err) == BP_OK, err.message);
    fine = fine && holds(bp_comm_size(comm) == RANKS && bp_comm_rank(comm) == rank, "who this is");
    fine = fine && body(comm);
    bp_comm_end(&comm);
    return fine;
}

typedef bool RankWork(uint32_t rank, RankBody *body);

/* All ranks carry out `how`. */
static void as_ranks(RankWork *how, RankBody *body) {
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
        _exit(how(r, body) ? 0 : 1);
    }
    for (uint32_t r = 1; r < RANKS; ++r) close(SOCKET_OF_RANK(r));
    bool fine = how(0, body);
    for (uint32_t r = 1; r < RANKS; ++r) close(SOCKET_OF_LEADER(r));
    for (uint32_t r = 1; r < RANKS; ++r) {
        int status = 0;
        assert_int_equal(waitpid(children[r], &status, 0), children[r]);
        fine = holds(WIFEXITED(status) && WEXITSTATUS(status) == 0, "another rank") && fine;
    }
    assert_true(fine);
}

static void with_ranks(RankBody *body) {
    as_ranks(work, body);
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

/* ---- what goes wrong ------------------------------------------------------------------------------------
 */

static bool is_pretended(BpStatus status, const BpError *err) {
    return status == BP_ERR_DEVICE && strcmp(err->message, "messages between the ranks: pretended") == 0;
}

/* Beginning, and one exchange of each kind, of which the one with the number FAULT_AT fails, on all ranks at
 * once. */
static bool meet_the_fault(uint32_t rank, RankBody *body) {
    (void)body;
    char *arguments[] = {"ballpark", NULL}, **texts = NULL;
    uint64_t numbers[2] = {1, 2};
    uint32_t words[2] = {3, 4};
    BpComm *comm = NULL;
    BpError err = {0};
    BpFilm *film = own_film(rank);
    be_rank(rank);
    BpStatus status = bp_comm_begin(arguments, &comm, &err);
    bool fine = holds((comm != NULL) == (status == BP_OK), "a communicator where it begins alone");
    if (status == BP_OK) status = bp_comm_add_64(comm, numbers, 2, &err);
    if (status == BP_OK) status = bp_comm_add_32(comm, words, 2, &err);
    if (status == BP_OK) status = bp_comm_gather_texts(comm, "text", &texts, &err);
    if (status == BP_OK) status = bp_round_add_films(comm, film, &err);
    if (status == BP_OK) status = bp_comm_all_ok(comm, rank == 1 ? BP_ERR_FILE : BP_OK, &err);
    if (status == BP_ERR_FILE && atoi(getenv("FAULT_AT")) >= 0) {
        unsetenv("FAULT_AT"); /* no exchange has this number: this was the last try */
    } else if (status != BP_ERR_FILE) {
        fine = holds(is_pretended(status, &err), err.message) && fine;
    }
    free(texts);
    bp_film_destroy(&film);
    bp_comm_end(&comm);
    bp_error_clear(&err);
    return fine;
}

static void test_each_exchange_fails(void **state) {
    (void)state;
    int faults = 0;
    for (; faults == 0 || getenv("FAULT_AT") != NULL; ++faults) {
        char text[16];
        snprintf(text, sizeof text, "%d", faults);
        setenv("FAULT_AT", text, 1);
        as_ranks(meet_the_fault, NULL);
    }
    assert_in_range(faults, 20, 100); /* as many as there are exchanges, and one */
}

/* Every rank begins alone, with arguments or a module that do not fit, and the errors have the remedy. */
static bool begin_with_others(uint32_t rank, RankBody *body) {
    (void)body;
    char *arguments[] = {rank == 1 ? "ballpark of one" : "ballpark", NULL};
    BpComm *comm = NULL;
    BpError err = {0};
    be_rank(rank);
    bool fine =
        holds(bp_comm_begin(arguments, &comm, &err) == BP_ERR_USAGE && comm == NULL, "other arguments");
    fine = fine && holds(strstr(err.message, "the 3 ranks were given different arguments") != NULL &&
                             strstr(err.message, "BALLPARK_MPI=off") != NULL,
                         err.message);
    bp_error_clear(&err);
    return fine;
}

static void test_beginnings_that_fail(void **state) {
    (void)state;
    char *arguments[] = {"ballpark", NULL};
    BpComm *comm = NULL;
    BpError err = {0};
    as_ranks(begin_with_others, NULL);
    be_rank(0);
    setenv("FAKE_SIZE", "1", 1);
    assert_int_equal(bp_comm_begin(arguments, &comm, &err), BP_ERR_USAGE);
    assert_non_null(strstr(err.message, "started 3 copies of this program, but its MPI reports 1"));
    unsetenv("FAKE_SIZE");
    setenv("BALLPARK_MPI", "/nowhere/ballpark_mpi.so", 1);
    assert_int_equal(bp_comm_begin(arguments, &comm, &err), BP_ERR_USAGE);
    assert_non_null(strstr(err.message, "started 3 copies of this program, but they cannot share the work"));
    assert_non_null(strstr(err.message, "/nowhere/ballpark_mpi.so"));
    assert_null(comm);
    setenv("BALLPARK_MPI", "off", 1);
    assert_int_equal(bp_comm_begin(arguments, &comm, &err), BP_OK);
    assert_null(comm);
    bp_error_clear(&err);
}

/* A process of its own has no communicator, and all of this is for it as for one rank. */
static void test_alone(void **state) {
    (void)state;
    uint64_t number = 5;
    uint32_t bits = 6;
    char **texts = NULL;
    double waiting = 1, adding = 1;
    BpError err = {0};
    assert_int_equal(bp_comm_size(NULL), 1);
    assert_int_equal(bp_comm_rank(NULL), 0);
    assert_int_equal(bp_comm_local_rank(NULL), 0);
    assert_int_equal(bp_comm_cores(NULL), 0);
    assert_true(bp_comm_is_root(NULL));
    assert_int_equal(bp_comm_broadcast(NULL, &number, sizeof number, &err), BP_OK);
    assert_int_equal(bp_comm_add_64(NULL, &number, 1, &err), BP_OK);
    assert_int_equal(bp_comm_add_32(NULL, &bits, 1, &err), BP_OK);
    assert_int_equal(bp_comm_allreduce_or(NULL, &bits, &err), BP_OK);
    assert_true(number == 5 && bits == 6);
    assert_int_equal(bp_comm_gather_texts(NULL, "alone", &texts, &err), BP_OK);
    assert_string_equal(texts[0], "alone");
    free(texts);
    assert_int_equal(bp_comm_all_ok(NULL, BP_ERR_FILE, &err), BP_ERR_FILE);
    bp_comm_begin_work(NULL);
    assert_false(bp_comm_is_at_work(NULL));
    bp_comm_end_work(NULL);
    bp_comm_times(NULL, &waiting, &adding);
    assert_true(waiting == 0 && adding == 0);
    bp_fail(&err, BP_ERR_FILE, "as it is");
    bp_comm_prefix_rank(NULL, &err);
    assert_string_equal(err.message, "as it is");
    bp_comm_notify(NULL);
    assert_false(bp_comm_was_notified(NULL));
    bp_comm_abort(NULL, 1);
    bp_comm_end(NULL);
    bp_error_clear(&err);
}

static bool hear(BpComm *comm) {
    BpError err = {0};
    double waiting = -1, adding = -1;
    char expected[64];
    bool fine = holds(!bp_comm_was_notified(comm), "that nobody has called yet");
    bp_comm_notify(comm);
    bp_comm_notify(comm);
    fine = fine && holds(bp_comm_was_notified(comm) && bp_comm_was_notified(comm), "a call");
    bp_comm_begin_work(comm);
    fine = fine && holds(bp_comm_is_at_work(comm), "work in common");
    bp_comm_end_work(comm);
    fine = fine && holds(!bp_comm_is_at_work(comm), "its end");
    bp_fail(&err, BP_ERR_FILE, "no such thing");
    bp_comm_prefix_rank(comm, &err);
    snprintf(expected, sizeof expected,
             bp_comm_is_root(comm) ? "no such thing" : "rank %u on here: no such thing", bp_comm_rank(comm));
    fine = fine && holds(strcmp(err.message, expected) == 0, err.message);
    bp_comm_times(comm, &waiting, &adding);
    fine = fine && holds(waiting >= 0 && adding == 0, "times");
    fine = fine &&
           holds(bp_comm_cores(comm) >= 1 && bp_comm_local_rank(comm) == bp_comm_rank(comm), "its place");
    bp_error_clear(&err);
    return fine;
}

static void test_calls(void **state) {
    (void)state;
    with_ranks(hear);
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
        cmocka_unit_test(test_films),
        cmocka_unit_test(test_resumed),
        cmocka_unit_test(test_much),
        cmocka_unit_test(test_texts),
        cmocka_unit_test(test_all_ok),
        cmocka_unit_test(test_calls),
        cmocka_unit_test(test_each_exchange_fails),
        cmocka_unit_test(test_beginnings_that_fail),
        cmocka_unit_test(test_alone),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
