/* tree_leaf.c: leaves and their boxes; see tree_write.h. */
#define BP_HOST
#include "tree_write.h"

#include "../scene/scene_side.h"
#include "reals.h"
#include "scene_types.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

/* So near to a surface, in its radius, that rounding to float might carry a point across. */
#define NEAR_SURFACE 0x1p-18

static double square_of(const float v[3]) {
    const double x = (double)v[0], y = (double)v[1], z = (double)v[2];
    return x * x + y * y + z * z;
}

/* Whether the sphere's surface may pass through the origin: all but surely not, at the price of few
 * operations. */
static bool near_origin(const BpTreeItem *item) {
    const double square = (double)item->radius * (double)item->radius;
    return fabs(square_of(item->center) - square) <= 2 * NEAR_SURFACE * square;
}

/* The radius in float that leaves the origin where it is in the scene: on the surface, as nearly as float
 * can, or clearly on its side of it. A few units in the last place from the radius that was rounded. */
static float radius_beside_origin(const BpTreeItem *item, BpSide side) {
    const double distance = sqrt(square_of(item->center));
    float radius = item->radius;
    if (side == BP_SIDE_ON) return (float)distance;
    while (side == BP_SIDE_OUTSIDE && (double)radius >= distance * (1 - 0x1p-40))
        radius = nextafterf(radius, 0);
    while (side == BP_SIDE_INSIDE && (double)radius <= distance * (1 + 0x1p-40))
        radius = nextafterf(radius, FLT_MAX);
    return radius;
}

/* A radius too small for float becomes the smallest normal number, so that a lane in use always has a radius
 * above 0. */
BpTreeItem bp_tree_item(const BpScene *scene, uint32_t sphere, const double origin[3]) {
    const BpSphere *s = &scene->spheres[sphere];
    const float radius = (float)fabs(s->radius);
    BpTreeItem item = {.radius = radius, .sphere = sphere};
    for (int a = 0; a < 3; ++a) item.center[a] = (float)(s->center[a] - origin[a]);
    if (near_origin(&item)) item.radius = radius_beside_origin(&item, bp_sphere_side(s, origin));
    if (!(item.radius > FLT_MIN)) item.radius = FLT_MIN;
    return item;
}

/* Widened by what rounding to float may have moved center and radius, at most 2^-24 of each or, below the
 * normal numbers, less than FLT_MIN; by the few 2^-53 that these sums in double, and the subtraction of the
 * origin, may be off; and by 8 * 2^-24 of the radius, since the kernel's intersection in single precision
 * takes for hits what passes the sphere by up to 4 of them, and a radius beside the origin is up to 4 of them
 * off. */
BpBounds bp_tree_item_bounds(const BpTreeItem *item) {
    const double r = (double)item->radius;
    BpBounds bounds;
    for (int a = 0; a < 3; ++a) {
        const double c = (double)item->center[a];
        const double margin = (fabs(c) + r) * (0x1p-24 + 0x1p-46) + r * 0x1p-21 + (double)FLT_MIN;
        bounds.low[a] = c - r - margin;
        bounds.high[a] = c + r + margin;
    }
    return bounds;
}

/* The same from the scene's own numbers, which a tree in double precision stores. Widened by a bound of the
 * rounding of these very sums: three roundings of numbers up to |center| + radius, each at most 2^-53 of it.
 */
static BpBounds sphere_bounds(const double center[3], double radius) {
    BpBounds bounds;
    for (int a = 0; a < 3; ++a) {
        const double margin = (fabs(center[a]) + radius) * 0x1p-51;
        bounds.low[a] = center[a] - radius - margin;
        bounds.high[a] = center[a] + radius + margin;
    }
    return bounds;
}

BpBounds bp_tree_write_leaf(const BpTreeWriter *writer, uint32_t leaf, const BpTreeItem *items,
                            uint32_t count) {
    BpTree *tree = writer->tree;
    const uint32_t width = tree->width;
    const bool single = tree->single_precision;
    const size_t base = (size_t)leaf * LEAF_REALS(width);
    BpBounds box = BP_BOUNDS_EMPTY;
    for (uint32_t lane = 0; lane < width; ++lane) {
        uint32_t index = NO_SPHERE;
        double center[3] = {0, 0, 0}, radius = -1;
        if (lane < count && single) {
            for (int a = 0; a < 3; ++a) center[a] = (double)items[lane].center[a];
            radius = (double)items[lane].radius;
        } else if (lane < count) {
            const BpSphere *sphere = &writer->scene->spheres[items[lane].sphere];
            for (int a = 0; a < 3; ++a) center[a] = sphere->center[a] - writer->origin[a];
            radius = fabs(sphere->radius);
        }
        if (lane < count) {
            const BpBounds bounds =
                single ? bp_tree_item_bounds(&items[lane]) : sphere_bounds(center, radius);
            bp_bounds_add(&box, &bounds);
            index = items[lane].sphere;
            if (near_origin(&items[lane]) &&
                bp_sphere_side(&writer->scene->spheres[index], writer->origin) == BP_SIDE_ON)
                tree->own_slot = leaf * width + lane;
        }
        for (uint32_t a = 0; a < 3; ++a)
            bp_reals_store(tree->leaves, single, base + a * width + lane, center[a]);
        bp_reals_store(tree->leaves, single, base + 3 * width + lane, radius);
        tree->slot_sphere[(size_t)leaf * width + lane] = index;
    }
    return box;
}

BpStatus bp_tree_check_size(uint32_t width, uint64_t nodes, uint64_t leaves, BpError *err) {
    const uint64_t words = (uint64_t)UINT32_MAX + 1;
    const uint64_t nodes_max = words / NODE_REALS(width), leaves_max = words / LEAF_REALS(width);
    if (nodes <= nodes_max && leaves <= leaves_max) return BP_OK;
    return bp_fail(
        err, BP_ERR_LIMIT,
        "a tree of %llu leaves and %llu nodes; %u wide it may have %llu and %llu: take fewer spheres, or a "
        "narrower tree (tree_width)",
        (unsigned long long)leaves, (unsigned long long)nodes, width, (unsigned long long)leaves_max,
        (unsigned long long)nodes_max);
}

BpStatus bp_tree_allocate(BpTree *tree, uint32_t nodes, uint32_t leaves, BpError *err) {
    BP_TRY(bp_tree_check_size(tree->width, nodes, leaves, err));
    const size_t real_size = tree->single_precision ? sizeof(float) : sizeof(double);
    const size_t n = nodes > 0 ? nodes : 1, l = leaves > 0 ? leaves : 1, width = tree->width;
    tree->node_boxes = calloc(n * NODE_REALS(width), real_size);
    tree->children = calloc(n * width, sizeof *tree->children);
    tree->leaves = calloc(l * LEAF_REALS(width), real_size);
    tree->slot_sphere = calloc(l * width, sizeof *tree->slot_sphere);
    if (tree->node_boxes != NULL && tree->children != NULL && tree->leaves != NULL &&
        tree->slot_sphere != NULL)
        return BP_OK;
    return bp_fail(err, BP_ERR_MEMORY, "out of memory for a tree of %u leaves and %u nodes", leaves, nodes);
}
