/* cases.h: rays aimed at spheres, and how well one form of the intersection does on them.
 *
 * In:    a cell: radius, distance, translation, range of impact.   Out: error, false hits and misses.
 * Knows: lab.h, oracle.h.   Does not know: which cells matter. */
#ifndef TESTS_HARD_CASES_H
#define TESTS_HARD_CASES_H

#include "lab.h"

typedef struct Cell {
    double radius, distance;        /* to the surface */
    double translation;             /* of sphere and origin alike */
    double impact_low, impact_high; /* in radii, where the ray is aimed */
} Cell;

/* Rays (RAY_REALS numbers) and spheres (4 numbers), all of them floats. Free with cases_clear(). */
typedef struct Cases {
    size_t count;
    double *rays, *spheres;
    double *hits; /* HIT_REALS an item, filled by cases_run() or a form of the host */
} Cases;

void cases_init(Cases *cases, size_t count);
void cases_clear(Cases *cases);
/* Sets items first .. first + count - 1 to rays of the cell. */
void cases_aim(Cases *cases, size_t first, size_t count, const Cell *cell, uint64_t *random);

/* Intersects on the device, each ray with its sphere alone. `own`: Optional, see probe.cl. */
void cases_run(const Lab *lab, Cases *cases, const uint32_t *own);

/* Published float forms on the host; they fill t and met of the hits. A root counts from t_min on. */
typedef enum HostForm { FORM_BOOK, FORM_GEMS } HostForm;
void cases_host(HostForm form, float t_min, Cases *cases);

typedef struct Score {
    size_t rays, right_hits;
    size_t false_hits, false_misses; /* outside `band` of tangency */
    size_t not_finite;
    size_t filtered;     /* ruled out although the exact test meets it ahead */
    double worst_t;      /* relative error of t, impact below 0.9 r, from 5e-7 r off the surface on */
    double worst_inside; /* the same for rays that start inside */
    double median_t;
    double worst_off;  /* impact from 0.9 r on: distance of o + t d from the sphere, less half an ulp of t, in
                          radii */
    size_t worst_case; /* item of worst_t */
} Score;

/* Judges items first .. first + count - 1. `band`: relative, around impact = r, where hit and miss both count
 * as right. */
Score cases_score(const Cases *cases, size_t first, size_t count, double band);
void score_add(Score *sum, const Score *score); /* the median is not kept */

#endif
