/* pilot_join.c: see pilot_join.h. */
#include "pilot_join.h"

#include "pilot_lobes.h"
#include "pilot_shapes.h"

#include "base/color.h"
#include "base/hash.h"
#include "scene/vector.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846
/* Cosines of grazing light are no smaller, so that no single path outweighs all others. */
#define COSINE_MIN 0.02
/* The cosine between the normals of two triangles or capsules whose points count as neighbours, at least. */
#define ALIKE 0.8

void bp_pilot_add(BpPilotSums *sums, size_t pixel, const double radiance[3], double probability,
                  size_t through) {
    const double y = bp_luminance_of(radiance);
    for (int c = 0; c < 3; ++c) sums->square_of[c] += radiance[c] * radiance[c] * probability;
    sums->mean[pixel] += y * probability;
    sums->square[pixel] += y * y * probability;
    sums->by_way[through] += y * y * probability;
}

/* ---- a grid of ends, in levels of cells of a power of two: an end lies in all cells that its radius touches
 * ---- */

#define NONE UINT32_MAX
enum { LEVELS = 256 };

typedef struct Grid {
    uint32_t *first; /* of each place of the table: an entry, or NONE */
    uint32_t *next;  /* of each entry */
    uint64_t *cells; /* of each entry: the hash of its cell, level and object, which stands for them */
    size_t place_mask;
    double cells_of_unit[LEVELS];
    bool has_level[LEVELS];
} Grid;

/* The level whose cells are at least as wide as the ball. */
static int level_of(const BpPilotEye *eye) {
    const int level = ilogb(2 * eye->radius) + 1 + LEVELS / 2;
    return level < 0 ? 0 : level >= LEVELS ? LEVELS - 1 : level;
}

/* Adds a number to a hash; for every hash, different numbers give different results. */
static uint64_t hash_in(uint64_t hash, uint64_t number) {
    hash = (hash ^ number) * UINT64_C(0x9e3779b97f4a7c15);
    return hash ^ hash >> 29;
}

static uint64_t hash_cell(int level, uint32_t object, const int64_t cell[3]) {
    uint64_t hash = hash_in(BP_HASH_START, (uint64_t)object << 8 | (uint64_t)(uint32_t)level);
    for (int a = 0; a < 3; ++a) hash = hash_in(hash, (uint64_t)cell[a]);
    return hash ^ hash >> 32;
}

static int64_t cell_of(const Grid *grid, double x, int level) {
    const double cell = floor(x * grid->cells_of_unit[level]);
    return fabs(cell) < 0x1p62 ? (int64_t)cell : 0;
}

/* Eight entries an end, of which those whose cell is one of the others' are not used. */
static BpStatus grid_allocate(size_t eye_count, Grid *grid, BpError *err) {
    size_t places = 1024;
    while (places < 8 * eye_count) places *= 2;
    grid->place_mask = places - 1;
    grid->first = malloc(places * sizeof *grid->first);
    grid->next = malloc(8 * eye_count * sizeof *grid->next);
    grid->cells = malloc(8 * eye_count * sizeof *grid->cells);
    if (grid->first == NULL || grid->next == NULL || grid->cells == NULL)
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for a grid of %zu points", eye_count);
    memset(grid->first, 0xff, places * sizeof *grid->first);
    for (int level = 0; level < LEVELS; ++level) grid->cells_of_unit[level] = ldexp(1, LEVELS / 2 - level);
    return BP_OK;
}

static void grid_add(Grid *grid, const BpPilotEye *eye, size_t number) {
    const int level = level_of(eye);
    int64_t low[3], high[3];
    for (int a = 0; a < 3; ++a) {
        low[a] = cell_of(grid, eye->point[a] - eye->radius, level);
        high[a] = cell_of(grid, eye->point[a] + eye->radius, level);
    }
    grid->has_level[level] = true;
    for (unsigned corner = 0; corner < 8; ++corner) {
        int64_t cell[3];
        bool again = false;
        for (int a = 0; a < 3; ++a) {
            const bool upper = (corner >> a & 1) != 0;
            again = again || (upper && high[a] == low[a]);
            cell[a] = upper ? high[a] : low[a];
        }
        if (again) continue;
        const size_t entry = 8 * number + corner;
        grid->cells[entry] = hash_cell(level, eye->object, cell);
        uint32_t *first = &grid->first[grid->cells[entry] & grid->place_mask];
        grid->next[entry] = *first;
        *first = (uint32_t)entry;
    }
}

static void grid_clear(Grid *grid) {
    free(grid->first);
    free(grid->next);
    free(grid->cells);
}

/* The density with which a path that ends there would have gone along `direction`. */
static double density_at(const BpPilotEye *eye, const BpMaterial *material, const double direction[3]) {
    BpPilotTurn turn = {.index = eye->index};
    const bool matte = material->kind != BP_MATERIAL_METAL && material->kind != BP_MATERIAL_ROUGH_METAL &&
                       material->kind != BP_MATERIAL_ROUGH_DIELECTRIC;
    if (matte) return bp_pilot_density(material, eye->normal, direction);
    memcpy(turn.normal, eye->normal, sizeof turn.normal);
    memcpy(turn.leaves, eye->outgoing, sizeof turn.leaves);
    memcpy(turn.to_light, direction, sizeof turn.to_light);
    return bp_pilot_lobe_density(material, &turn);
}

static void join_one(const BpScene *scene, const BpPilotEye *eye, const BpPilotPhoton *photon,
                     uint32_t max_depth, BpPilotSums *sums) {
    double back[3], radiance[3], away2 = 0;
    for (int a = 0; a < 3; ++a) {
        back[a] = -photon->direction[a];
        away2 += (photon->point[a] - eye->point[a]) * (photon->point[a] - eye->point[a]);
        radiance[a] = eye->throughput[a] * photon->radiance[a];
    }
    const BpMaterial *material = bp_pilot_material(scene, eye->shape);
    double cosine = bp_dot(back, eye->normal), alike = bp_dot(eye->normal, photon->normal);
    if (cosine < 0 && material->kind == BP_MATERIAL_ROUGH_DIELECTRIC) { /* from behind */
        cosine = -cosine;
        alike = -alike;
    }
    if (away2 > eye->radius * eye->radius || cosine <= 0 || eye->segments + photon->segments > max_depth)
        return;
    if (!bp_pilot_is_sphere(scene, eye->shape) && alike < ALIKE) return;
    const double density = density_at(eye, material, back) / fmax(cosine, COSINE_MIN);
    const double probability = density * photon->measure / (PI * eye->radius * eye->radius);
    if (probability > 0) bp_pilot_add(sums, eye->pixel, radiance, eye->share * probability, photon->through);
}

/* All ends near which the light of one path comes. */
static void join_photon(const BpScene *scene, const Grid *grid, const BpPilotEye *eyes,
                        const BpPilotPhoton *photon, uint32_t max_depth, BpPilotParts *parts) {
    BpPilotSums *sums = photon->focused ? &parts->focused : &parts->chance;
    for (int level = 0; level < LEVELS; ++level) {
        if (!grid->has_level[level]) continue;
        int64_t cell[3];
        for (int a = 0; a < 3; ++a) cell[a] = cell_of(grid, photon->point[a], level);
        const uint64_t hash = hash_cell(level, photon->object, cell);
        for (uint32_t entry = grid->first[hash & grid->place_mask]; entry != NONE; entry = grid->next[entry])
            if (grid->cells[entry] == hash) join_one(scene, &eyes[entry / 8], photon, max_depth, sums);
    }
}

BpStatus bp_pilot_join(const BpScene *scene, const BpPilotEye *eyes, size_t eye_count,
                       const BpPilotPhoton *photons, size_t photon_count, uint32_t max_depth,
                       BpPilotParts *parts, BpError *err) {
    if (eye_count == 0 || photon_count == 0) return BP_OK;
    Grid grid = {0};
    const BpStatus status = grid_allocate(eye_count, &grid, err);
    for (size_t i = 0; i < eye_count && status == BP_OK; ++i) grid_add(&grid, &eyes[i], i);
    for (size_t i = 0; i < photon_count && status == BP_OK; ++i)
        join_photon(scene, &grid, eyes, &photons[i], max_depth, parts);
    grid_clear(&grid);
    return status;
}
