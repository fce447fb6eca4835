/* embree_camera.c: camera rays, loop by loop, each a plain loop over lanes (embree_paths.h). */
#include "embree_lanes.h"
#include "embree_paths.h"

#include <string.h>

#define DIMENSION_CAMERA 0x80000000u /* bounces count from 0 */

/* Camera rays for lanes first .. end-1, whose column and sample are set. */
void lanes_start(const Batch *batch, const World *world, uint32_t row, uint32_t first, uint32_t end) {
    const uint32_t count = end - first, seed = world->seed;
    const uint32_t first_pixel = row * world->scene->camera.width;
    const uint32_t *restrict const column = batch->column + first, *restrict const sample =
                                                                       batch->sample + first;
    uint32_t *restrict const depth = batch->depth + first;
    float *restrict const x = batch->next[0] + first, *restrict const y = batch->next[1] + first;
    float *restrict const lens_x = batch->random[0] + first, *restrict const lens_y =
                                                                 batch->random[1] + first;
    float *restrict const scale = batch->t + first;
    EACH_LANE {
        uint32_t a = first_pixel + column[i], b = sample[i], c = DIMENSION_CAMERA + seed;
        hash3(&a, &b, &c);
        x[i] = (float)(int32_t)column[i] + to_uniform(a);
        y[i] = (float)(int32_t)row + to_uniform(b);
        depth[i] = 0;
    }
    if (world->center) {
        EACH_LANE {
            x[i] = (float)(int32_t)column[i] + 0.5f;
            y[i] = (float)(int32_t)row + 0.5f;
        }
    }
    if (world->lens) {
        EACH_LANE {
            uint32_t a = first_pixel + column[i], b = sample[i], c = DIMENSION_CAMERA + 1 + seed;
            hash3(&a, &b, &c);
            float sine, cosine;
            circle(to_uniform(a), &sine, &cosine);
            const float radius = sqrtf(to_uniform(b));
            lens_x[i] = radius * cosine;
            lens_y[i] = radius * sine;
        }
    } else {
        memset(lens_x, 0, count * sizeof *lens_x);
        memset(lens_y, 0, count * sizeof *lens_y);
    }
    EACH_LANE {
        scale[i] = 0;
    }
    for (int k = 0; k < 3; k++) {
        float *restrict const origin = batch->origin[k] + first, *restrict const direction =
                                                                     batch->direction[k] + first;
        float *restrict const throughput = batch->throughput[k] + first, *restrict const radiance =
                                                                             batch->radiance[k] + first;
        const float lens_right = world->lens_right[k], lens_up = world->lens_up[k];
        const float corner = world->corner[k], right = world->right[k], down = world->down[k];
        EACH_LANE {
            const float o = lens_right * lens_x[i] + lens_up * lens_y[i];
            const float d = corner + x[i] * right + y[i] * down - o;
            origin[i] = o;
            direction[i] = d;
            scale[i] += d * d;
            throughput[i] = 1;
            radiance[i] = 0;
        }
    }
    float *restrict const dx = batch->direction[0] + first, *restrict const dy = batch->direction[1] + first;
    float *restrict const dz = batch->direction[2] + first;
    EACH_LANE {
        const float unit = 1 / sqrtf(scale[i]);
        dx[i] *= unit;
        dy[i] *= unit;
        dz[i] *= unit;
    }
}
