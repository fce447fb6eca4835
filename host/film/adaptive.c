/* adaptive.c: see adaptive.h. */
#include "adaptive_state.h"

#include "base/status.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { TILE_SIDE = 8 };

/* With a mean of n samples, every pixel gets n / PILOT_SHARE, and none more than REACH times that. */
#define PILOT_SHARE 4u
#define REACH_LEVELS 6u /* 2^6 */
/* An error below this part of the mean error counts as that part: if the few samples of a pixel agree, it
 * need not have converged. */
#define ERROR_FLOOR 1e-4

static uint64_t level_samples(uint32_t level) {
    return (uint64_t)BP_ADAPTIVE_FIRST << level;
}

/* The last tile of a row or column takes the remainder. */
static uint32_t tile_of(uint32_t place, uint32_t tiles) {
    const uint32_t tile = place / TILE_SIDE;
    return tile < tiles ? tile : tiles - 1;
}

static uint32_t half_of(const BpAdaptive *adaptive, uint32_t x, uint32_t y) {
    const uint32_t tile = tile_of(y, adaptive->tiles_y) * adaptive->tiles_x + tile_of(x, adaptive->tiles_x);
    return 2 * tile + ((x + y) & 1);
}

BpStatus bp_adaptive_create(uint32_t width, uint32_t height, uint64_t samples_max, BpAdaptive **adaptive,
                            BpError *err) {
    BpAdaptive *made = calloc(1, sizeof *made);
    if (made == NULL) return bp_fail(err, BP_ERR_MEMORY, "no memory for adaptive sampling");
    made->width = width;
    made->height = height;
    made->tiles_x = width < TILE_SIDE ? 1 : width / TILE_SIDE;
    made->tiles_y = height < TILE_SIDE ? 1 : height / TILE_SIDE;
    made->halves = 2 * made->tiles_x * made->tiles_y;
    while (made->level_max + 1 < BP_ADAPTIVE_LEVELS_MAX && level_samples(made->level_max + 1) <= samples_max)
        ++made->level_max;
    made->half_pixels = calloc(made->halves, sizeof *made->half_pixels);
    made->level = calloc(made->halves, 1);
    made->wanted = calloc(made->halves, 1);
    made->passing = calloc(made->halves, sizeof *made->passing);
    made->list = malloc((size_t)width * height * sizeof *made->list);
    if (made->half_pixels == NULL || made->level == NULL || made->wanted == NULL || made->passing == NULL ||
        made->list == NULL) {
        bp_adaptive_destroy(&made);
        return bp_fail(err, BP_ERR_MEMORY, "no memory for the sample counts of %u x %u pixels", width,
                       height);
    }
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x) ++made->half_pixels[half_of(made, x, y)];
    *adaptive = made;
    return BP_OK;
}

void bp_adaptive_destroy(BpAdaptive **adaptive) {
    if (adaptive == NULL || *adaptive == NULL) return;
    for (size_t l = 0; l < BP_ADAPTIVE_LEVELS_MAX; ++l) {
        free((*adaptive)->errors[l]);
        free((*adaptive)->costs[l]);
    }
    free((*adaptive)->half_pixels);
    free((*adaptive)->level);
    free((*adaptive)->wanted);
    free((*adaptive)->passing);
    free((*adaptive)->list);
    free(*adaptive);
    *adaptive = NULL;
}

/* ---- errors ---- */

/* Keeps the errors and costs of the halves that have just reached `level`: the halves of this pass, or all of
 * them at first. */
static BpStatus record(BpAdaptive *adaptive, const BpFilm *film, uint32_t level, BpError *err) {
    if (adaptive->errors[level] == NULL) {
        adaptive->errors[level] = calloc(adaptive->halves, sizeof *adaptive->errors[level]);
        adaptive->costs[level] = calloc(adaptive->halves, sizeof *adaptive->costs[level]);
    }
    float *errors = adaptive->errors[level], *costs = adaptive->costs[level];
    if (errors == NULL || costs == NULL)
        return bp_fail(err, BP_ERR_MEMORY, "no memory for the errors of %u tiles", adaptive->halves / 2);
    BpUnseenWeights weights;
    bp_unseen_weigh(film, &weights);
    for (uint32_t y = 0; y < adaptive->height; ++y)
        for (uint32_t x = 0; x < adaptive->width; ++x) {
            const uint32_t half = half_of(adaptive, x, y);
            if (level > 0 && !adaptive->passing[half]) continue;
            const size_t pixel = (size_t)y * adaptive->width + x;
            const double error = bp_film_squared_error(film, &weights, pixel);
            const double share = 1.0 / adaptive->half_pixels[half];
            if (isfinite(error)) errors[half] += (float)(error * share);
            if (film->pixel_segments != NULL)
                costs[half] +=
                    (float)((double)film->pixel_segments[pixel] * share / (double)level_samples(level));
        }
    return BP_OK;
}

/* The value by which `half` is judged: that of the tile's other half, and with half the weight the mean of
 * the halves of the same colour in the neighbouring tiles. All of them had the level of `values` at some
 * time. */
static double deciding(const BpAdaptive *adaptive, uint32_t half, const float *values) {
    const uint32_t tile = half / 2, colour = 1 - half % 2;
    const uint32_t x = tile % adaptive->tiles_x, y = tile / adaptive->tiles_x;
    double around = 0;
    unsigned count = 0;
    if (x > 0) around += (double)values[2 * (tile - 1) + colour], ++count;
    if (y > 0) around += (double)values[2 * (tile - adaptive->tiles_x) + colour], ++count;
    if (x + 1 < adaptive->tiles_x) around += (double)values[2 * (tile + 1) + colour], ++count;
    if (y + 1 < adaptive->tiles_y) around += (double)values[2 * (tile + adaptive->tiles_x) + colour], ++count;
    const double own = (double)values[2 * tile + colour];
    return count == 0 ? own : (2 * own + around / count) / 3;
}

/* ---- the plan ---- */

/* The level to which doubling `half` still gains at least `least` a segment. At n samples the squared error
 * is about s^2 / n, so doubling gains s^2 / (2 n) for n samples of c segments: s^2 / (2 c n^2) each.
 * `values`: s^2 / c. */
static uint32_t level_for(const BpAdaptive *adaptive, uint32_t half, uint32_t pilot, double value,
                          double least) {
    uint32_t level = adaptive->level[half];
    const uint32_t reach =
        pilot + REACH_LEVELS < adaptive->level_max ? pilot + REACH_LEVELS : adaptive->level_max;
    while (level < reach) {
        const double samples = (double)level_samples(level);
        if (value / (2 * samples * samples) < least) break;
        ++level;
    }
    return level;
}

static double samples_for(const BpAdaptive *adaptive, uint32_t colour, uint32_t pilot, const double *values,
                          double least) {
    double total = 0;
    for (uint32_t half = colour; half < adaptive->halves; half += 2)
        total += adaptive->half_pixels[half] *
                 (double)level_samples(level_for(adaptive, half, pilot, values[half], least));
    return total;
}

/* Plans the halves of one colour, so that neither colour's total depends on what its own samples brought. */
static void plan_colour(BpAdaptive *adaptive, uint32_t colour, uint32_t pilot, const double *values,
                        uint64_t samples) {
    double pixels = 0, largest = 0;
    for (uint32_t half = colour; half < adaptive->halves; half += 2) {
        pixels += adaptive->half_pixels[half];
        largest = fmax(largest, values[half]);
    }
    const double budget = pixels * (double)samples;
    /* The least gain for which the budget suffices: above `too_low`, at most `enough`. */
    double enough = largest, too_low = 0;
    for (int i = 0; i < 200; ++i) {
        const double middle = too_low > 0 ? sqrt(too_low * enough) : enough / 1024;
        if (middle <= 0 || middle <= too_low || middle >= enough) break;
        if (samples_for(adaptive, colour, pilot, values, middle) > budget)
            too_low = middle;
        else
            enough = middle;
        if (too_low <= 0 && enough < 1e-60 * largest) break;
    }
    double left = budget - samples_for(adaptive, colour, pilot, values, enough);
    for (uint32_t half = colour; half < adaptive->halves; half += 2) {
        const uint32_t level = level_for(adaptive, half, pilot, values[half], enough);
        const uint32_t next = level_for(adaptive, half, pilot, values[half], too_low);
        const double more = adaptive->half_pixels[half] * (double)level_samples(level);
        /* Equal gains, in order while the budget lasts. */
        const bool takes = next > level && more <= left;
        if (takes) left -= more;
        adaptive->wanted[half] = (uint8_t)(level + takes);
    }
}

static BpStatus plan(BpAdaptive *adaptive, uint32_t pilot, uint64_t samples, BpError *err) {
    double *values = malloc(adaptive->halves * sizeof *values);
    if (values == NULL)
        return bp_fail(err, BP_ERR_MEMORY, "no memory for a plan of %u tiles", adaptive->halves / 2);
    for (uint32_t colour = 0; colour < 2; ++colour) {
        double mean = 0;
        for (uint32_t half = colour; half < adaptive->halves; half += 2) {
            values[half] = deciding(adaptive, half, adaptive->errors[pilot]) * (double)level_samples(pilot);
            mean += values[half] / (adaptive->halves / 2);
        }
        for (uint32_t half = colour; half < adaptive->halves; half += 2) {
            const double cost = deciding(adaptive, half, adaptive->costs[pilot]);
            values[half] = fmax(values[half], ERROR_FLOOR * mean) / (cost > 0 ? cost : 1);
            if (mean <= 0) values[half] = 1; /* nothing to go by: all alike */
        }
        plan_colour(adaptive, colour, pilot, values, samples);
    }
    free(values);
    adaptive->planned = samples;
    return BP_OK;
}

/* ---- passes ---- */

/* The highest level that a quarter of `samples` reaches. */
static uint32_t pilot_level(const BpAdaptive *adaptive, uint64_t samples) {
    uint32_t level = 0;
    while (level < adaptive->level_max && level_samples(level + 1) <= samples / PILOT_SHARE) ++level;
    return level;
}

bool bp_adaptive_pass(BpAdaptive *adaptive, BpAdaptivePass *pass) {
    uint32_t count = 0, level = 0;
    for (uint32_t half = 0; half < adaptive->halves; ++half)
        if (adaptive->passing[half]) level = adaptive->level[half];
    for (uint32_t y = 0; y < adaptive->height; ++y)
        for (uint32_t x = 0; x < adaptive->width; ++x)
            if (adaptive->passing[half_of(adaptive, x, y)]) adaptive->list[count++] = y * adaptive->width + x;
    if (count == 0) return false;
    *pass = (BpAdaptivePass){adaptive->list, count, level_samples(level), level_samples(level)};
    adaptive->pass_samples_max = 2 * level_samples(level);
    return true;
}

/* A pass over the halves of the lowest level that need more samples. */
static bool begin_pass(BpAdaptive *adaptive, BpAdaptivePass *pass) {
    uint32_t lowest = BP_ADAPTIVE_LEVELS_MAX;
    for (uint32_t half = 0; half < adaptive->halves; ++half)
        if (adaptive->level[half] < adaptive->wanted[half] && adaptive->level[half] < lowest)
            lowest = adaptive->level[half];
    if (lowest == BP_ADAPTIVE_LEVELS_MAX) return false;
    for (uint32_t half = 0; half < adaptive->halves; ++half)
        adaptive->passing[half] = adaptive->level[half] == lowest && lowest < adaptive->wanted[half];
    return bp_adaptive_pass(adaptive, pass);
}

/* All halves of the finished pass go up to the same level. */
static BpStatus end_pass(BpAdaptive *adaptive, const BpFilm *film, BpError *err) {
    uint32_t level = 0;
    for (uint32_t half = 0; half < adaptive->halves; ++half)
        if (adaptive->passing[half]) level = ++adaptive->level[half];
    if (level > 0 || adaptive->errors[0] == NULL) BP_TRY(record(adaptive, film, level, err));
    memset(adaptive->passing, 0, adaptive->halves * sizeof *adaptive->passing);
    return BP_OK;
}

BpStatus bp_adaptive_next(BpAdaptive *adaptive, const BpFilm *film, uint64_t samples, bool *more,
                          BpAdaptivePass *pass, BpError *err) {
    BP_TRY(end_pass(adaptive, film, err));
    if (samples != adaptive->planned) {
        const uint32_t pilot = pilot_level(adaptive, samples);
        bool below = false;
        for (uint32_t half = 0; half < adaptive->halves; ++half) {
            below = below || adaptive->level[half] < pilot;
            adaptive->wanted[half] = adaptive->level[half] < pilot ? (uint8_t)pilot : adaptive->level[half];
        }
        if (!below) BP_TRY(plan(adaptive, pilot, samples, err));
    }
    *more = begin_pass(adaptive, pass);
    return BP_OK;
}

uint64_t bp_adaptive_samples(const BpAdaptive *adaptive) {
    uint64_t total = 0;
    for (uint32_t half = 0; half < adaptive->halves; ++half)
        total += adaptive->half_pixels[half] * level_samples(adaptive->level[half]);
    return total;
}

uint64_t bp_adaptive_samples_max(const BpAdaptive *adaptive) {
    uint64_t most = adaptive->pass_samples_max;
    for (uint32_t half = 0; half < adaptive->halves; ++half)
        if (level_samples(adaptive->level[half]) > most) most = level_samples(adaptive->level[half]);
    return most;
}
