/* test_sweep.c: spheres of radius 1e-3 to 1e6, from a hundredth to a million radii away, moved by up to a
 * million, at every impact and most of all near the rim: what docs/NUMERICS.md promises of each ray.
 *
 *     hard_sweep double|float RAYS
 *
 * Exit code 1: a promise was broken; the cell is printed. */
#include "cases.h"

#include <stdio.h>
#include <stdlib.h>

enum { CELL_RAYS = 512, BATCH_CELLS = 128 };

static Cell random_cell(uint64_t *random) {
    Cell cell = {.radius = pow(10, -3 + 9 * lab_unit(random))};
    cell.distance = cell.radius * pow(10, -2 + 8 * lab_unit(random));
    if (lab_bits(random) % 3 != 0) cell.translation = pow(10, 6 * lab_unit(random));
    cell.impact_high = 1.2;
    if (lab_bits(random) % 2 == 0) {
        const double width = pow(10, -6 + 5 * lab_unit(random));
        cell.impact_low = 1 - width;
        cell.impact_high = 1 + width;
    }
    return cell;
}

/* From inside, where the far root is the shorter one, float is held to 1e-6: half the chord is known to 9
 * roundoffs of itself at an impact of 0.9, and the root is a difference with it. */
static bool is_right(const Score *score) {
    return score->false_hits == 0 && score->false_misses == 0 && score->not_finite == 0 &&
           score->filtered == 0 && score->worst_t <= 5e-7 && score->worst_inside <= 1e-6 &&
           score->worst_off <= 4e-7;
}

static void print_score(const char *what, const Score *score) {
    printf("%s: %zu rays, %zu hits, false hits %zu, false misses %zu, filtered %zu, t %.2g, off the sphere "
           "%.2g r\n",
           what, score->rays, score->right_hits, score->false_hits, score->false_misses, score->filtered,
           score->worst_t, score->worst_off);
}

int main(int argc, char **argv) {
    Lab lab;
    Score sum = {0};
    bool right = true;
    uint64_t random = 2024;
    if (argc != 3) {
        fprintf(stderr, "usage: hard_sweep double|float RAYS\n");
        return 2;
    }
    if (!lab_open(&lab, argv[1])) return 77;
    const size_t wanted = strtoul(argv[2], NULL, 10);
    Cases cases;
    cases_init(&cases, (size_t)CELL_RAYS * BATCH_CELLS);
    while (sum.rays < wanted) {
        Cell cells[BATCH_CELLS];
        for (size_t c = 0; c < BATCH_CELLS; ++c) {
            cells[c] = random_cell(&random);
            cases_aim(&cases, c * CELL_RAYS, CELL_RAYS, &cells[c], &random);
        }
        cases_run(&lab, &cases, NULL);
        for (size_t c = 0; c < BATCH_CELLS; ++c) {
            const Score score = cases_score(&cases, c * CELL_RAYS, CELL_RAYS, 1e-5);
            score_add(&sum, &score);
            if (is_right(&score)) continue;
            right = false;
            printf("radius %g, distance %g, translation %g, impact %g to %g\n", cells[c].radius,
                   cells[c].distance, cells[c].translation, cells[c].impact_low, cells[c].impact_high);
            print_score("    broken", &score);
        }
    }
    print_score(lab.name, &sum);
    cases_clear(&cases);
    lab_close(&lab);
    return right && sum.right_hits > sum.rays / 4 ? 0 : 1;
}
