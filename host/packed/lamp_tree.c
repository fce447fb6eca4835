/* lamp_tree.c: see lamp_tree.h.
 *
 * From the root down, a run of lamps is cut in two where power times the square of the extent, summed over
 * both parts, is least, and the part for which that is most is cut again, until a node has all its children.
 * A run with more lamps than the levels that remain can hold with such cuts is cut in halves instead. */
#ifndef BP_HOST
#define BP_HOST
#endif
#include "lamp_tree.h"

#include "base/color.h"
#include "base/status.h"
#include "reals.h"
#include "scene/triangle_area.h"
#include "scene_types.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define BINS 16
#define PI 3.14159265358979323846

typedef struct Lamp {
    double center[3], motion[3], radius, power; /* center: when the shutter opens */
    uint32_t slot;
    bool flat; /* a triangle, and the ball around it */
} Lamp;

typedef struct Box {
    double low[3], high[3];
} Box;

typedef struct Builder {
    Lamp *lamps;
    BpLampTree *tree;
    uint32_t capacity; /* nodes for which there is room */
    bool single;
} Builder;

/* A run of lamps. */
typedef struct Run {
    uint32_t first, count;
    double power;
    Box box; /* around the spheres and their ways */
} Run;

size_t bp_enclosing_lamp(const BpScene *scene) {
    /* Only the largest sphere can. */
    size_t largest = 0;
    for (size_t i = 1; i < scene->sphere_count; ++i)
        if (fabs(scene->spheres[i].radius) > fabs(scene->spheres[largest].radius)) largest = i;
    if (scene->sphere_count < 2 || scene->triangle_count + scene->capsule_count > 0 ||
        !bp_shape_emits(scene, largest))
        return SIZE_MAX;
    const BpSphere *shell = &scene->spheres[largest];
    for (size_t i = 0; i < scene->sphere_count; ++i) {
        const BpSphere *sphere = &scene->spheres[i];
        /* Of two that move, the distance is largest when the shutter opens or closes. */
        const double *a = bp_sphere_end(scene, i), *b = bp_sphere_end(scene, largest);
        const double distance =
            fmax(hypot(hypot(sphere->center[0] - shell->center[0], sphere->center[1] - shell->center[1]),
                       sphere->center[2] - shell->center[2]),
                 hypot(hypot(a[0] - b[0], a[1] - b[1]), a[2] - b[2]));
        if (i != largest && !(distance + fabs(sphere->radius) <= fabs(shell->radius))) return SIZE_MAX;
    }
    return largest;
}

bool bp_sphere_is_sampled(const BpScene *scene, size_t i, size_t enclosing) {
    return i != enclosing && bp_shape_emits(scene, i);
}

/* ---- runs ---- */

static void add_to_run(Run *run, const Lamp *lamp) {
    ++run->count;
    run->power += lamp->power;
    for (int a = 0; a < 3; ++a) {
        const double end = lamp->center[a] + lamp->motion[a];
        run->box.low[a] = fmin(run->box.low[a], fmin(lamp->center[a], end) - lamp->radius);
        run->box.high[a] = fmax(run->box.high[a], fmax(lamp->center[a], end) + lamp->radius);
    }
}

static void join_runs(Run *run, const Run *other) {
    run->count += other->count;
    run->power += other->power;
    for (int a = 0; a < 3; ++a) {
        run->box.low[a] = fmin(run->box.low[a], other->box.low[a]);
        run->box.high[a] = fmax(run->box.high[a], other->box.high[a]);
    }
}

static Run empty_run(uint32_t first) {
    return (Run){.first = first, .box = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}}};
}

static Run run_of(const Builder *builder, uint32_t first, uint32_t count) {
    Run run = empty_run(first);
    for (uint32_t i = 0; i < count; ++i) add_to_run(&run, &builder->lamps[first + i]);
    return run;
}

/* How uncertain it is what one ball around the run would bring. */
static double spread(const Run *run) {
    double squares = 0;
    for (int a = 0; a < 3; ++a)
        squares += (run->box.high[a] - run->box.low[a]) * (run->box.high[a] - run->box.low[a]);
    return run->count == 0 ? 0 : run->power * squares;
}

static uint32_t bin_of(double at, double low, double high) {
    const double place = (at - low) / (high - low) * BINS;
    return place >= BINS - 1 ? BINS - 1 : place > 0 ? (uint32_t)place : 0;
}

/* Where a lamp is halfway through its motion. */
static double middle_of(const Lamp *lamp, int axis) {
    return lamp->center[axis] + 0.5 * lamp->motion[axis];
}

/* Cuts a run of two lamps or more in two that are not empty, where the sum of their spreads is least. */
static void cut_run(Builder *builder, const Run *run, bool halves, Run *left, Run *right) {
    Lamp *lamps = builder->lamps + run->first;
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (uint32_t i = 0; i < run->count; ++i)
        for (int a = 0; a < 3; ++a) {
            low[a] = fmin(low[a], middle_of(&lamps[i], a));
            high[a] = fmax(high[a], middle_of(&lamps[i], a));
        }
    int axis = 0;
    for (int a = 1; a < 3; ++a)
        if (high[a] - low[a] > high[axis] - low[axis]) axis = a;
    uint32_t middle = run->count / 2;
    if (!halves && high[axis] > low[axis]) {
        Run bins[BINS], above[BINS];
        for (int b = 0; b < BINS; ++b) bins[b] = empty_run(0);
        for (uint32_t i = 0; i < run->count; ++i)
            add_to_run(&bins[bin_of(middle_of(&lamps[i], axis), low[axis], high[axis])], &lamps[i]);
        above[BINS - 1] = bins[BINS - 1];
        for (int b = BINS - 2; b >= 0; --b) {
            above[b] = above[b + 1];
            join_runs(&above[b], &bins[b]);
        }
        /* The first and the last bin are not empty. */
        Run below = empty_run(0);
        double best = INFINITY;
        uint32_t first_above = 1;
        for (uint32_t b = 1; b < BINS; ++b) {
            join_runs(&below, &bins[b - 1]);
            const double sum = spread(&below) + spread(&above[b]);
            if (sum < best) {
                best = sum;
                first_above = b;
            }
        }
        middle = 0;
        for (uint32_t i = 0; i < run->count; ++i) {
            if (bin_of(middle_of(&lamps[i], axis), low[axis], high[axis]) >= first_above) continue;
            const Lamp lamp = lamps[i];
            lamps[i] = lamps[middle];
            lamps[middle++] = lamp;
        }
    }
    *left = run_of(builder, run->first, middle);
    *right = run_of(builder, run->first + middle, run->count - middle);
}

/* ---- nodes ---- */

static void store(const Builder *builder, uint32_t node, uint32_t row, uint32_t child, double value) {
    bp_reals_store(builder->tree->lamps, builder->single,
                   (size_t)node * LAMP_NODE_REALS + row * LAMP_WIDTH + child, value);
}

/* The ball around a run: its centre is that of the box. Of a lamp's way, one of the ends is farthest from it.
 */
static double ball_around(const Builder *builder, const Run *run, double center[3]) {
    double radius = 0;
    for (int a = 0; a < 3; ++a) center[a] = 0.5 * (run->box.low[a] + run->box.high[a]);
    for (uint32_t i = 0; i < run->count; ++i) {
        const Lamp *lamp = &builder->lamps[run->first + i];
        for (int share = 0; share <= 1; ++share) {
            const double x = lamp->center[0] + share * lamp->motion[0] - center[0],
                         y = lamp->center[1] + share * lamp->motion[1] - center[1],
                         z = lamp->center[2] + share * lamp->motion[2] - center[2];
            radius = fmax(radius, sqrt(x * x + y * y + z * z) + lamp->radius);
        }
    }
    return radius;
}

static bool take_node(Builder *builder, uint32_t *node) {
    BpLampTree *tree = builder->tree;
    if (tree->node_count == builder->capacity) {
        const uint32_t capacity = 2 * builder->capacity + 1;
        const size_t real_size = builder->single ? sizeof(float) : sizeof(double);
        void *lamps = realloc(tree->lamps, (size_t)capacity * LAMP_NODE_REALS * real_size);
        if (lamps != NULL) tree->lamps = lamps;
        uint32_t *children = realloc(tree->lamp_children, (size_t)capacity * LAMP_WIDTH * sizeof *children);
        if (children != NULL) tree->lamp_children = children;
        if (lamps == NULL || children == NULL) return false;
        builder->capacity = capacity;
    }
    *node = tree->node_count++;
    for (uint32_t child = 0; child < LAMP_WIDTH; ++child) {
        for (uint32_t row = 0; row < LAMP_NODE_REALS / LAMP_WIDTH; ++row)
            store(builder, *node, row, child, 0);
        tree->lamp_children[(size_t)*node * LAMP_WIDTH + child] = CHILD_LEAF;
    }
    return true;
}

/* Writes the node of a run and all below it. `level`: of the node, from 0; `trail`: the way to it. */
static bool write_node(Builder *builder, const Run *run, uint32_t level, uint32_t trail) {
    Run parts[LAMP_WIDTH];
    uint32_t node, count = 1;
    if (!take_node(builder, &node)) return false;
    parts[0] = *run;
    /* Below a child there is room for LAMP_WIDTH to the power of the levels that remain. */
    const uint32_t room = 1u << (LAMP_CHILD_BITS * (LAMP_DEPTH_MAX - 1 - level));
    const bool halves = run->count > room;
    while (count < LAMP_WIDTH) {
        uint32_t widest = LAMP_WIDTH;
        for (uint32_t p = 0; p < count; ++p) {
            if (parts[p].count < 2) continue;
            const bool more = widest == LAMP_WIDTH || (halves ? parts[p].count > parts[widest].count
                                                              : spread(&parts[p]) > spread(&parts[widest]));
            if (more) widest = p;
        }
        if (widest == LAMP_WIDTH) break;
        const Run whole = parts[widest];
        cut_run(builder, &whole, halves, &parts[widest], &parts[count++]);
    }
    for (uint32_t p = 0; p < count; ++p) {
        const uint32_t place = trail | p << (LAMP_CHILD_BITS * level);
        const bool leaf = parts[p].count == 1;
        const Lamp *lamp = &builder->lamps[parts[p].first];
        double center[3];
        memcpy(center, lamp->center, sizeof center);
        const double radius = !leaf        ? -ball_around(builder, &parts[p], center)
                              : lamp->flat ? -lamp->radius
                                           : lamp->radius;
        uint32_t word = CHILD_LEAF | lamp->slot;
        if (leaf)
            builder->tree->slot_lamp[lamp->slot] = place;
        else {
            word = builder->tree->node_count;
            if (!write_node(builder, &parts[p], level + 1, place)) return false;
        }
        for (uint32_t a = 0; a < 3; ++a) store(builder, node, a, p, center[a]);
        store(builder, node, 3, p, radius);
        store(builder, node, 4, p, parts[p].power * builder->tree->unit);
        builder->tree->lamp_children[(size_t)node * LAMP_WIDTH + p] = word;
    }
    return true;
}

/* ---- the whole ---- */

/* The ball around the triangle in a slot: its centre is that of the vertices. Its power is what a sphere of
 * as much light in all directions has. */
static void place_triangle(const BpTree *tree, double luminance, Lamp *lamp) {
    const uint32_t lane = lamp->slot % tree->width;
    const size_t place = (size_t)(lamp->slot - lane - tree->first_triangles * tree->width) * 9 + lane;
    BpTriangle triangle;
    for (uint32_t v = 0; v < 3; ++v)
        for (uint32_t a = 0; a < 3; ++a)
            triangle.vertices[v][a] =
                bp_reals_load(tree->triangles, tree->single_precision, place + (3 * v + a) * tree->width);
    double normal[3];
    bp_triangle_area(&triangle, normal);
    for (uint32_t a = 0; a < 3; ++a)
        lamp->center[a] = (triangle.vertices[0][a] + triangle.vertices[1][a] + triangle.vertices[2][a]) / 3;
    for (uint32_t v = 0; v < 3; ++v) {
        double way[3];
        bp_way(lamp->center, triangle.vertices[v], way);
        lamp->radius = fmax(lamp->radius, bp_length(way));
    }
    lamp->power = luminance * bp_length(normal) / (2 * PI);
    lamp->flat = true;
}

/* Whether the device sees the power of a lamp: one without any would end a node's children. */
static bool has_power(const Builder *builder, const Lamp *lamp) {
    const double power = lamp->power * builder->tree->unit;
    return (builder->single ? (double)(float)power : power) > 0;
}

/* In order of the shapes' numbers, as the device has them; returns how many there are. */
static uint32_t collect_lamps(const BpScene *scene, const BpTree *tree, const uint32_t *slot_of,
                              size_t enclosing, Builder *builder) {
    uint32_t count = 0;
    for (size_t i = 0; i < scene->sphere_count; ++i) {
        if (!bp_sphere_is_sampled(scene, i, enclosing)) continue;
        Lamp *lamp = &builder->lamps[count++];
        *lamp = (Lamp){.slot = slot_of[i]};
        const uint32_t lane = lamp->slot % tree->width;
        const size_t place = (size_t)(lamp->slot - lane) * 4 + lane,
                     motion = (size_t)(lamp->slot - lane) * 3 + lane;
        for (uint32_t a = 0; a < 3; ++a) {
            lamp->center[a] = bp_reals_load(tree->leaves, tree->single_precision, place + a * tree->width);
            lamp->motion[a] = tree->has_motions ? bp_reals_load(tree->leaf_motions, tree->single_precision,
                                                                motion + a * tree->width)
                                                : 0;
        }
        lamp->radius = bp_reals_load(tree->leaves, tree->single_precision, place + 3 * tree->width);
        const double *emit = scene->materials[scene->spheres[i].material].emit;
        lamp->power = bp_luminance_of(emit) * lamp->radius * lamp->radius;
    }
    for (size_t t = 0; t < scene->triangle_count; ++t) {
        if (!bp_shape_emits(scene, scene->sphere_count + t)) continue;
        Lamp *lamp = &builder->lamps[count];
        *lamp = (Lamp){.slot = slot_of[scene->sphere_count + t]};
        place_triangle(tree, bp_luminance_of(scene->materials[scene->triangles[t].material].emit), lamp);
        count += has_power(builder, lamp);
    }
    return count;
}

/* Keeps powers and their sums within the range of float, however bright the lamps are. */
static double unit_of_power(const BpScene *scene, size_t enclosing) {
    double brightest = 0;
    for (size_t i = 0; i < scene->sphere_count; ++i)
        if (i != enclosing)
            brightest = fmax(brightest, bp_luminance_of(scene->materials[scene->spheres[i].material].emit));
    for (size_t t = 0; t < scene->triangle_count; ++t)
        brightest = fmax(brightest, bp_luminance_of(scene->materials[scene->triangles[t].material].emit));
    for (size_t i = 0; i < scene->disc_count; ++i)
        brightest = fmax(brightest, bp_luminance_of(scene->discs[i].radiance));
    if (scene->environment != NULL) brightest = fmax(brightest, scene->environment->mean);
    return brightest > 0 ? 1 / brightest : 0;
}

BpStatus bp_lamp_tree_build(const BpScene *scene, const BpTree *tree, BpLampTree *lamps, BpError *err) {
    *lamps = (BpLampTree){0};
    Builder builder = {.tree = lamps, .single = tree->single_precision};
    const size_t enclosing = bp_enclosing_lamp(scene), shapes = bp_scene_shapes(scene);
    const size_t slots = (size_t)tree->leaf_count * tree->width;
    BpStatus status = BP_OK;
    uint32_t *slot_of = NULL;
    for (size_t i = 0; i < scene->sphere_count; ++i)
        lamps->lamp_count += bp_sphere_is_sampled(scene, i, enclosing);
    lamps->lamp_count += (uint32_t)bp_scene_emitting_triangles(scene);
    uint32_t count = lamps->lamp_count;
    lamps->unit = unit_of_power(scene, enclosing);
    bool enough = true;
    if (count > 0 ||
        enclosing != SIZE_MAX) { /* a kernel asks for the lamp in the slot of each that it hits */
        slot_of = malloc(shapes * sizeof *slot_of);
        builder.lamps = malloc((count + 1) * sizeof *builder.lamps);
        lamps->slot_lamp = malloc(slots * sizeof *lamps->slot_lamp);
        enough = slot_of != NULL && builder.lamps != NULL && lamps->slot_lamp != NULL;
    }
    if (enough && slot_of != NULL) {
        for (size_t slot = 0; slot < slots; ++slot) {
            lamps->slot_lamp[slot] = NO_LAMP;
            if (tree->slot_sphere[slot] < shapes) slot_of[tree->slot_sphere[slot]] = (uint32_t)slot;
        }
        lamps->slot_count = (uint32_t)slots;
        count = lamps->lamp_count = collect_lamps(scene, tree, slot_of, enclosing, &builder);
    }
    const Run all = run_of(&builder, 0, enough ? count : 0);
    uint32_t root;
    if (enough) enough = count > 0 ? write_node(&builder, &all, 0, 0) : take_node(&builder, &root);
    if (!enough) status = bp_fail(err, BP_ERR_MEMORY, "out of memory for a tree of %u lamps", count);
    free(slot_of);
    free(builder.lamps);
    if (status != BP_OK) bp_lamp_tree_clear(lamps);
    return status;
}

void bp_lamp_tree_clear(BpLampTree *lamps) {
    free(lamps->lamps);
    free(lamps->lamp_children);
    free(lamps->slot_lamp);
    *lamps = (BpLampTree){0};
}
