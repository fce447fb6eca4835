/* embree_paths.c: batches of paths: filling free lanes, ending paths, closing gaps (embree_paths.h). */
#include "embree_paths.h"

Batch batch_create(uint32_t lanes) {
    Batch batch = {.lanes = lanes};
    float **floats[] = {batch.origin, batch.direction, batch.throughput, batch.radiance,
                        batch.normal, batch.random,    batch.next};
    for (size_t a = 0; a < sizeof floats / sizeof *floats; a++) {
        for (int k = 0; k < 3; k++) floats[a][k] = peer_allocate(lanes, sizeof(float));
    }
    float **single[] = {&batch.t, &batch.value, &batch.offset, &batch.cosine, &batch.uniform};
    for (size_t a = 0; a < sizeof single / sizeof *single; a++)
        *single[a] = peer_allocate(lanes, sizeof(float));
    uint32_t **words[] = {&batch.column, &batch.sample, &batch.depth, &batch.sphere, &batch.front,
                          &batch.alive,  &batch.kind,   &batch.entry, &batch.huge};
    for (size_t a = 0; a < sizeof words / sizeof *words; a++)
        *words[a] = peer_allocate(lanes, sizeof(uint32_t));
    return batch;
}

bool batch_refill(Batch *batch, const World *world, RowCursor *cursor) {
    const BpCamera *camera = &world->scene->camera;
    const uint32_t spp = camera->samples_per_pixel;
    batch->fresh = batch->active;
    /* Few free lanes: wait, so that the loops below run over full vectors. */
    const uint32_t free_lanes = batch->lanes - batch->active;
    if (free_lanes < (batch->lanes < 4 * LANE_BLOCK ? batch->lanes / 2 : LANE_BLOCK)) return true;
    uint32_t end = batch->active;
    while (end < batch->lanes && cursor->column < camera->width) {
        batch->column[end] = cursor->column;
        batch->sample[end++] = cursor->sample;
        if (++cursor->sample == spp) {
            cursor->sample = 0;
            cursor->column++;
        }
    }
    lanes_start(batch, world, cursor->row, batch->active, end);
    batch->active = end;
    return end > 0;
}

static void move_lane(Batch *batch, uint32_t from, uint32_t to, bool emission) {
    for (int k = 0; k < 3; k++) {
        batch->origin[k][to] = batch->origin[k][from];
        batch->direction[k][to] = batch->direction[k][from];
        batch->throughput[k][to] = batch->throughput[k][from];
        batch->radiance[k][to] = emission ? batch->radiance[k][from] : 0;
    }
    batch->column[to] = batch->column[from];
    batch->sample[to] = batch->sample[from];
    batch->depth[to] = batch->depth[from];
}

void batch_bounce(Batch *batch, const World *world, const RowCursor *cursor, const PeerFilm *film) {
    const size_t first_pixel = (size_t)cursor->row * film->width;
    lanes_scatter(batch, world, (uint32_t)first_pixel);

    uint32_t active = batch->active;
    for (uint32_t i = active; i-- > 0;) {
        if (batch->alive[i]) continue;
        double *sum = film->half[batch->sample[i] & 1] + (first_pixel + batch->column[i]) * 3;
        for (int k = 0; k < 3; k++) sum[k] += (double)batch->radiance[k][i];
        if (i != --active) move_lane(batch, active, i, world->has & HAS_EMISSION);
    }
    batch->active = active;
}
