/* tree_scenes.h: scenes of spheres for the tests of the tree, from fixed seeds. */
#ifndef TESTS_SUPPORT_TREE_SCENES_H
#define TESTS_SUPPORT_TREE_SCENES_H

#include "base/random.h"
#include "scene/scene.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static inline uint64_t random_bits(uint64_t *state) {
    BpRandom random = {*state};
    const uint64_t bits = bp_random_bits(&random);
    *state = random.state;
    return bits;
}
static inline double random_unit(uint64_t *state) {
    return (double)(random_bits(state) >> 11) * 0x1p-53;
}

enum {
    SHAPE_FIELD,
    SHAPE_SAME,
    SHAPE_LINE,
    SHAPE_POWERS,
    SHAPE_CLUSTERS,
    SHAPE_GRID,
    SHAPE_WILD,
    SHAPE_COUNT
};

/* A scene with spheres only; free the spheres. FIELD: evenly in a cube; SAME: all alike; LINE: equal
 * distances on the x axis; POWERS: each twice as far and as large as the last, again and again; CLUSTERS:
 * ever tighter around few points; GRID: many equal coordinates; WILD: radii of both signs from 1e-50 to 1e6
 * and a few huge. */
static inline BpScene make_spheres(int shape, size_t count, uint64_t seed) {
    BpScene scene = {0};
    scene.sphere_count = count;
    scene.spheres = calloc(count + 1, sizeof *scene.spheres);
    uint64_t state = seed * 1000003u + (uint64_t)shape;
    const double side = cbrt((double)count);
    for (size_t i = 0; i < count; ++i) {
        BpSphere *s = &scene.spheres[i];
        s->radius = 0.3;
        s->albedo = BP_NO_ALBEDO;
        const double power = pow(2.0, (double)(i % 39));
        const double tight = pow(random_unit(&state), 8.0);
        for (int a = 0; a < 3; ++a) {
            const double u = random_unit(&state);
            switch (shape) {
            case SHAPE_SAME:
                s->center[a] = 1.25;
                break;
            case SHAPE_LINE:
                s->center[a] = a == 0 ? (double)i : 0;
                break;
            case SHAPE_POWERS:
                s->center[a] = power * (a == 0 ? 1 : 0.25);
                break;
            case SHAPE_CLUSTERS:
                s->center[a] = (double)(i % 5) * 20 * (a + 1) + 20 * (u - 0.5) * tight;
                break;
            case SHAPE_GRID:
                s->center[a] = floor(8 * u);
                break;
            case SHAPE_WILD:
                s->center[a] = 2000 * (u - 0.5);
                break;
            default:
                s->center[a] = side * (u - 0.5);
            }
        }
        if (shape == SHAPE_POWERS) s->radius = 0.1 * power;
        if (shape == SHAPE_CLUSTERS) s->radius = 0.05 * tight + 1e-4;
        if (shape == SHAPE_WILD) {
            s->radius = pow(10.0, 4.0 * random_unit(&state) - 3.0) * (random_unit(&state) < 0.3 ? -1 : 1);
            if (i % 97 == 5) s->radius = 1e-50;
            if (i % 211 == 7) s->radius = 1e4;
            if (i == 40) s->radius = -1e6;
        }
    }
    return scene;
}

#endif
