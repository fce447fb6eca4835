/* tree_write.c: see tree_write.h.
 *
 * Nodes are numbered in the order in which a depth-first walk meets them, except that those near the root
 * come first. Subtrees of some thousand spheres are independent jobs: first all are counted, which fixes
 * where each begins, then all are written. */
#define BP_HOST
#include "tree_write.h"

#include "base/pages.h"
#include "reals.h"
#include "scene/scene_side.h"
#include "scene/vector.h"
#include "scene_types.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define JOB_SPHERES 8192u

typedef struct Job {
    const BpBinaryNode *root;
    uint32_t depth; /* of its topmost wide node, from 1 */
    uint32_t nodes, deepest;
    uint32_t first_node, first_leaf;
} Job;

typedef struct Gather {
    const BpTreeWriter *writer;
    uint32_t height_bits; /* log2 of the width */
    Job *jobs;
    uint32_t job_count, job_capacity;
    uint32_t top_nodes;
    uint32_t deepest;
    bool failed; /* out of memory */
} Gather;

/* ---- nodes ----------------------------------------------------------------------------------------- */

static void write_child(BpTree *tree, uint32_t node, uint32_t lane, const BpBounds *box, uint32_t word) {
    const size_t base = (size_t)node * NODE_REALS(tree->width) + lane;
    for (uint32_t a = 0; a < 3; ++a) {
        bp_reals_store_down(tree->node_boxes, tree->single_precision, base + a * tree->width, box->low[a]);
        bp_reals_store_up(tree->node_boxes, tree->single_precision, base + (3 + a) * tree->width,
                          box->high[a]);
    }
    tree->children[(size_t)node * tree->width + lane] = word;
}

/* The box around all lanes of a node. */
static BpBounds node_bounds(const BpTree *tree, uint32_t node) {
    BpBounds box = BP_BOUNDS_EMPTY;
    for (uint32_t lane = 0; lane < tree->width; ++lane) {
        const size_t base = (size_t)node * NODE_REALS(tree->width) + lane;
        BpBounds child;
        for (uint32_t a = 0; a < 3; ++a) {
            child.low[a] = bp_reals_load(tree->node_boxes, tree->single_precision, base + a * tree->width);
            child.high[a] =
                bp_reals_load(tree->node_boxes, tree->single_precision, base + (3 + a) * tree->width);
        }
        bp_bounds_add(&box, &child);
    }
    return box;
}

/* Appends the at most `places` nodes that stand for `node` below a wide node at least cost. */
static void place_node(const BpBinaryNode *node, uint32_t places, const BpBinaryNode **children,
                       uint32_t *count) {
    while (places > 1 && node->left != NULL && node->cost[places] == node->cost[places - 1]) --places;
    if (places == 1 || node->left == NULL) {
        children[(*count)++] = node;
        return;
    }
    const uint32_t left = bp_binary_left_places(node, places);
    place_node(node->left, left, children, count);
    place_node(node->right, places - left, children, count);
}

static void place_levels(const BpBinaryNode *node, uint32_t levels, const BpBinaryNode **children,
                         uint32_t *count) {
    if (levels == 0 || node->left == NULL) {
        children[(*count)++] = node;
        return;
    }
    place_levels(node->left, levels - 1, children, count);
    place_levels(node->right, levels - 1, children, count);
}

/* Chooses the children of the wide node of a binary one, at most `width`: those of least cost, or, if one of
 * them would be too high to end within TREE_DEPTH_MAX, those log2(width) levels down. Every subtree of height
 * at most log2(width) times the levels that remain can be written, and this keeps it so. */
static uint32_t gather_children(const Gather *gather, const BpBinaryNode *node, uint32_t depth,
                                const BpBinaryNode **children) {
    const uint32_t width = gather->writer->tree->width;
    uint32_t count = 0;
    if (node->left == NULL) {
        children[0] = node;
        return 1;
    }
    const uint32_t left = bp_binary_left_places(node, width);
    place_node(node->left, left, children, &count);
    place_node(node->right, width - left, children, &count);
    const uint32_t height_max = (TREE_DEPTH_MAX - depth) * gather->height_bits;
    for (uint32_t i = 0; i < count; ++i)
        if (children[i]->height > height_max) {
            count = 0;
            place_levels(node, gather->height_bits, children, &count);
            break;
        }
    return count;
}

static void count_below(const Gather *gather, const BpBinaryNode *node, uint32_t depth, Job *job) {
    const BpBinaryNode *children[BP_TREE_WIDTH_MAX];
    const uint32_t count = gather_children(gather, node, depth, children);
    ++job->nodes;
    if (depth > job->deepest) job->deepest = depth;
    for (uint32_t i = 0; i < count; ++i)
        if (children[i]->height > 0) count_below(gather, children[i], depth + 1, job);
}

static BpBounds write_binary_leaf(const BpTreeWriter *writer, const BpBinaryNode *node, uint32_t leaf) {
    if (leaf >= writer->tree->first_triangles)
        return bp_tree_write_triangles(writer, leaf, writer->triangle_items + node->first, node->count);
    return bp_tree_write_leaf(writer, leaf, writer->items + node->first, node->count);
}

/* Writes the wide node of a binary one and everything below; returns its box. `next_node` and `next_leaf` are
 * the numbers to give out. */
static BpBounds write_below(const Gather *gather, const BpBinaryNode *node, uint32_t depth,
                            uint32_t *next_node, uint32_t *next_leaf) {
    const BpTreeWriter *writer = gather->writer;
    BpTree *tree = writer->tree;
    const BpBinaryNode *children[BP_TREE_WIDTH_MAX];
    const uint32_t count = gather_children(gather, node, depth, children), number = (*next_node)++;
    BpBounds box = BP_BOUNDS_EMPTY;
    for (uint32_t lane = 0; lane < tree->width; ++lane) {
        BpBounds child_box = BP_BOUNDS_EMPTY;
        uint32_t word = CHILD_LEAF;
        if (lane < count && children[lane]->height == 0) {
            word |= *next_leaf;
            child_box = write_binary_leaf(writer, children[lane], (*next_leaf)++);
        } else if (lane < count) {
            word = *next_node;
            child_box = write_below(gather, children[lane], depth + 1, next_node, next_leaf);
        }
        bp_bounds_add(&box, &child_box);
        write_child(tree, number, lane, &child_box, word);
    }
    return box;
}

/* ---- jobs ------------------------------------------------------------------------------------------ */

static void count_job(void *context, uint32_t piece, unsigned thread) {
    (void)thread;
    const Gather *gather = context;
    Job *job = &gather->jobs[piece];
    count_below(gather, job->root, job->depth, job);
}

static void write_job(void *context, uint32_t piece, unsigned thread) {
    (void)thread;
    const Gather *gather = context;
    const Job *job = &gather->jobs[piece];
    uint32_t next_node = job->first_node, next_leaf = job->first_leaf;
    write_below(gather, job->root, job->depth, &next_node, &next_leaf);
}

/* Counts the nodes near the root and lists the jobs below them, in the order of a depth-first walk. */
static void list_jobs(Gather *gather, const BpBinaryNode *node, uint32_t depth) {
    if (node->count <= JOB_SPHERES) {
        if (gather->job_count == gather->job_capacity) {
            const uint32_t wanted = gather->job_capacity == 0 ? 256 : 2 * gather->job_capacity;
            Job *jobs = realloc(gather->jobs, wanted * sizeof *jobs);
            gather->failed = gather->failed || jobs == NULL;
            if (jobs == NULL) return;
            gather->jobs = jobs;
            gather->job_capacity = wanted;
        }
        gather->jobs[gather->job_count++] = (Job){.root = node, .depth = depth};
        return;
    }
    ++gather->top_nodes;
    if (depth > gather->deepest) gather->deepest = depth;
    const BpBinaryNode *children[BP_TREE_WIDTH_MAX];
    const uint32_t count = gather_children(gather, node, depth, children);
    for (uint32_t i = 0; i < count; ++i)
        if (children[i]->height > 0) list_jobs(gather, children[i], depth + 1);
}

/* Writes the words of a node near the root, and what lies below it but the jobs. Boxes of nodes follow later.
 */
static void write_top(const Gather *gather, const BpBinaryNode *node, uint32_t depth, uint32_t *next_node,
                      uint32_t *next_job, uint32_t *next_leaf) {
    const BpTreeWriter *writer = gather->writer;
    const BpBinaryNode *children[BP_TREE_WIDTH_MAX];
    const uint32_t count = gather_children(gather, node, depth, children), number = (*next_node)++;
    for (uint32_t lane = 0; lane < writer->tree->width; ++lane) {
        BpBounds box = BP_BOUNDS_EMPTY;
        uint32_t word = CHILD_LEAF;
        if (lane < count && children[lane]->height == 0) {
            word |= *next_leaf;
            box = write_binary_leaf(writer, children[lane], (*next_leaf)++);
        } else if (lane < count && children[lane]->count <= JOB_SPHERES) {
            Job *job = &gather->jobs[(*next_job)++];
            job->first_leaf = *next_leaf;
            *next_leaf += job->root->leaves;
            word = job->first_node;
        } else if (lane < count) {
            word = *next_node;
            write_top(gather, children[lane], depth + 1, next_node, next_job, next_leaf);
        }
        write_child(writer->tree, number, lane, &box, word);
    }
}

static BpStatus write_empty_root(const BpTreeWriter *writer, BpError *err) {
    BpTree *tree = writer->tree;
    const BpBounds empty = BP_BOUNDS_EMPTY;
    tree->node_count = tree->depth = 1;
    BP_TRY(bp_tree_allocate(tree, 1, tree->leaf_count, err));
    for (uint32_t lane = 0; lane < tree->width; ++lane) write_child(tree, 0, lane, &empty, CHILD_LEAF);
    return BP_OK;
}

BpStatus bp_tree_write_nodes(const BpTreeWriter *writer, const BpBinaryNode *root, BpThreadPool *pool,
                             BpError *err) {
    BpTree *tree = writer->tree;
    if (root == NULL) return write_empty_root(writer, err);
    BpStatus status = BP_OK;
    Gather gather = {.writer = writer};
    gather.height_bits = bp_tree_width_bits(tree->width);
    list_jobs(&gather, root, 1);
    if (gather.failed) {
        status = bp_fail(err, BP_ERR_MEMORY, "out of memory for a tree of %u leaves", root->leaves);
        goto cleanup;
    }
    bp_parallel_for(pool, count_job, &gather, gather.job_count);
    uint32_t first_leaf = tree->leaf_count, next_node = 0, next_job = 0;
    tree->node_count = gather.top_nodes;
    tree->depth = gather.deepest;
    for (uint32_t j = 0; j < gather.job_count; ++j) {
        gather.jobs[j].first_node = tree->node_count;
        gather.jobs[j].first_leaf = first_leaf; /* right for a lone job; write_top() knows better for many */
        tree->node_count += gather.jobs[j].nodes;
        if (gather.jobs[j].deepest > tree->depth) tree->depth = gather.jobs[j].deepest;
    }
    tree->leaf_count += root->leaves;
    BP_TRY_GOTO(status, bp_tree_allocate(tree, tree->node_count, tree->leaf_count, err), cleanup);
    if (gather.top_nodes > 0) write_top(&gather, root, 1, &next_node, &next_job, &first_leaf);
    bp_parallel_for(pool, write_job, &gather, gather.job_count);
    for (uint32_t node = gather.top_nodes; node-- > 0;)
        for (uint32_t lane = 0; lane < tree->width; ++lane) {
            const uint32_t word = tree->children[(size_t)node * tree->width + lane];
            if ((word & CHILD_LEAF) != 0) continue;
            const BpBounds box = node_bounds(tree, word);
            write_child(tree, node, lane, &box, word);
        }
cleanup:
    free(gather.jobs);
    return status;
}

/* ---- leaves ---- */

/* Within this part of the radius from a surface, rounding to float might move a point to the other side. */
#define NEAR_SURFACE 0x1p-18

static double square_of(const float v[3]) {
    const double x = (double)v[0], y = (double)v[1], z = (double)v[2];
    return x * x + y * y + z * z;
}

/* Whether the sphere's surface may pass through the origin. It costs few operations, and is sometimes true
 * for a surface that is only near. */
static bool near_origin(const BpTreeItem *item) {
    const double square = (double)item->radius * (double)item->radius;
    return fabs(square_of(item->center) - square) <= 2 * NEAR_SURFACE * square;
}

/* The radius in float that leaves the origin where it is in the scene: as nearly on the surface as float
 * allows, or clearly on its side of it. It is a few units in the last place from the rounded radius. */
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
    if (bp_sphere_moves(scene, sphere)) {
        const double *end = bp_sphere_end(scene, sphere);
        double way = 0;
        for (int a = 0; a < 3; ++a) {
            way = hypot(way, end[a] - s->center[a]);
            item.center[a] = (float)((s->center[a] + end[a]) / 2 - origin[a]);
        }
        item.radius = (float)(fabs(s->radius) + way / 2);
    } else if (near_origin(&item))
        item.radius = radius_beside_origin(&item, bp_sphere_side(s, origin));
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

/* Writes the numbers of a sphere that moves, and returns a box around all of its way. The kernel adds the
 * time's share of the motion to where the sphere is at first, all of them rounded, and rounds once more. */
static BpBounds write_moving(const BpTreeWriter *writer, uint32_t sphere, uint32_t leaf, uint32_t lane,
                             double center[3], double *radius) {
    BpTree *tree = writer->tree;
    const BpSphere *s = &writer->scene->spheres[sphere];
    const bool single = tree->single_precision;
    const double unit = single ? 0x1p-24 : 0x1p-53, *end = bp_sphere_end(writer->scene, sphere);
    BpBounds bounds;
    *radius = fmax(fabs(s->radius), (double)FLT_MIN);
    for (uint32_t a = 0; a < 3; ++a) {
        const double motion = end[a] - s->center[a];
        center[a] = s->center[a] - writer->origin[a];
        const double low = fmin(center[a], center[a] + motion), high = fmax(center[a], center[a] + motion);
        const double margin = 8 * unit * (fabs(center[a]) + fabs(motion) + 2 * *radius) + (double)FLT_MIN;
        bounds.low[a] = low - *radius - margin;
        bounds.high[a] = high + *radius + margin;
        bp_reals_store(tree->leaf_motions, single,
                       (size_t)leaf * MOTION_REALS(tree->width) + a * tree->width + lane,
                       motion != 0 ? motion : -0.0);
    }
    return bounds;
}

/* The half sizes of a box around a cube's worth of area. */
static float cube_of(const double half[3]) {
    const float radius = (float)sqrt((half[0] * half[1] + half[1] * half[2] + half[2] * half[0]) / 3);
    return fmaxf(radius, FLT_MIN);
}

BpTreeItem bp_tree_capsule_item(const BpScene *scene, uint32_t shape, const double origin[3]) {
    const BpCapsule *c = bp_shape_capsule(scene, shape);
    BpTreeItem item = {.sphere = shape};
    double half[3];
    for (int a = 0; a < 3; ++a) {
        item.center[a] = (float)((c->ends[0][a] + c->ends[1][a]) / 2 - origin[a]);
        half[a] = fabs(c->ends[1][a] - c->ends[0][a]) / 2 + c->radius;
    }
    item.radius = cube_of(half);
    return item;
}

/* Writes the axis of a capsule, and returns a box around it: as the scene has it and as it is stored, widened
 * like a sphere's box, and by the rounding of the axis, whose place is found to better than a real. */
static BpBounds write_capsule(const BpTreeWriter *writer, const BpCapsule *capsule, uint32_t leaf,
                              uint32_t lane, double center[3], double *radius) {
    BpTree *tree = writer->tree;
    const bool single = tree->single_precision;
    const double unit = single ? 0x1p-24 : 0x1p-53;
    BpBounds bounds;
    const bool long_enough = sqrt(bp_distance2(capsule->ends[0], capsule->ends[1])) >= BP_CAPSULE_LENGTH_MIN;
    *radius = fmax(capsule->radius, (double)FLT_MIN);
    for (uint32_t a = 0; a < 3; ++a) {
        const double axis = long_enough ? capsule->ends[1][a] - capsule->ends[0][a] : 0;
        center[a] = capsule->ends[0][a] - writer->origin[a];
        const double low = fmin(center[a], center[a] + axis), high = fmax(center[a], center[a] + axis);
        const double margin = 8 * unit * (fabs(center[a]) + fabs(axis) + 2 * *radius) + (double)FLT_MIN;
        bounds.low[a] = low - *radius - margin;
        bounds.high[a] = high + *radius + margin;
        bp_reals_store(tree->leaf_axes, single,
                       (size_t)leaf * AXIS_REALS(tree->width) + a * tree->width + lane, axis);
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
        double center[3] = {NAN, NAN, NAN}, radius = -1;
        const bool moves = lane < count && bp_sphere_moves(writer->scene, items[lane].sphere);
        const BpCapsule *capsule = lane < count ? bp_shape_capsule(writer->scene, items[lane].sphere) : NULL;
        for (uint32_t a = 0; a < 3 && tree->has_motions; ++a)
            bp_reals_store(tree->leaf_motions, single, (size_t)leaf * MOTION_REALS(width) + a * width + lane,
                           -0.0);
        for (uint32_t k = 0; k < AXIS_REALS(1) && tree->has_axes; ++k)
            bp_reals_store(tree->leaf_axes, single, (size_t)leaf * AXIS_REALS(width) + k * width + lane, 0);
        if (capsule != NULL) {
            const BpBounds bounds = write_capsule(writer, capsule, leaf, lane, center, &radius);
            bp_bounds_add(&box, &bounds);
            index = items[lane].sphere;
        } else if (moves) {
            const BpBounds bounds = write_moving(writer, items[lane].sphere, leaf, lane, center, &radius);
            bp_bounds_add(&box, &bounds);
            index = items[lane].sphere;
        } else if (lane < count && single) {
            for (int a = 0; a < 3; ++a) center[a] = (double)items[lane].center[a];
            radius = (double)items[lane].radius;
        } else if (lane < count) {
            const BpSphere *sphere = &writer->scene->spheres[items[lane].sphere];
            for (int a = 0; a < 3; ++a) center[a] = sphere->center[a] - writer->origin[a];
            radius = fabs(sphere->radius);
        }
        if (lane < count && !moves && capsule == NULL) {
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

BpTreeItem bp_tree_triangle_item(const BpScene *scene, uint32_t triangle, const double origin[3]) {
    const BpTriangle *t = &scene->triangles[triangle];
    BpTreeItem item = {.sphere = triangle};
    double half[3];
    for (int a = 0; a < 3; ++a) {
        const double x = t->vertices[0][a], y = t->vertices[1][a], z = t->vertices[2][a];
        const double low = fmin(fmin(x, y), z), high = fmax(fmax(x, y), z);
        item.center[a] = (float)((low + high) / 2 - origin[a]);
        half[a] = (high - low) / 2;
    }
    item.radius = cube_of(half);
    return item;
}

/* Writes `count` values of a triangle into its lane of a leaf, which has each for all lanes; NULL: zeros. */
static void write_values(const BpTree *tree, void *values, uint32_t leaf, uint32_t lane,
                         const float *of_triangle, uint32_t count) {
    const size_t first = (size_t)(leaf - tree->first_triangles) * count;
    for (uint32_t k = 0; k < count; ++k)
        bp_reals_store(values, tree->single_precision, (first + k) * tree->width + lane,
                       of_triangle != NULL ? (double)of_triangle[k] : 0);
}

/* Zeros where a triangle is flat. */
static void write_normals(const BpTreeWriter *writer, uint32_t leaf, const BpTreeItem *items,
                          uint32_t count) {
    BpTree *tree = writer->tree;
    for (uint32_t lane = 0; lane < tree->width; ++lane) {
        const float(*const normals)[3] =
            lane < count ? bp_triangle_normals(writer->scene, items[lane].sphere) : NULL;
        write_values(tree, tree->triangle_normals, leaf, lane, normals != NULL ? normals[0] : NULL, 9);
    }
}

/* Zeros where a triangle has none. */
static void write_coordinates(const BpTreeWriter *writer, uint32_t leaf, const BpTreeItem *items,
                              uint32_t count) {
    BpTree *tree = writer->tree;
    for (uint32_t lane = 0; lane < tree->width; ++lane)
        write_values(tree, tree->triangle_coordinates, leaf, lane,
                     lane < count ? bp_triangle_coordinates(writer->scene, items[lane].sphere) : NULL, 6);
}

/* Narrowed first, vertices are exact; a lane without a triangle has NaN. Widened by two units in the last
 * place of a plane, so that a box without thickness has some, and by 8 of the longest side, since a hit may
 * lie that far off in single precision. */
BpBounds bp_tree_write_triangles(const BpTreeWriter *writer, uint32_t leaf, const BpTreeItem *items,
                                 uint32_t count) {
    BpTree *tree = writer->tree;
    const uint32_t width = tree->width;
    const bool single = tree->single_precision;
    const double unit = single ? 0x1p-24 : 0x1p-53;
    const size_t base = (size_t)(leaf - tree->first_triangles) * TRIANGLE_REALS(width);
    BpBounds box = BP_BOUNDS_EMPTY;
    for (uint32_t lane = 0; lane < width; ++lane) {
        const BpTriangle *t = &writer->scene->triangles[items[lane < count ? lane : 0].sphere];
        BpBounds own = BP_BOUNDS_EMPTY;
        double longest = 0;
        for (uint32_t a = 0; a < 3; ++a) {
            for (uint32_t k = 0; k < 3; ++k) {
                const size_t place = base + (3 * k + a) * width + lane;
                bp_reals_store(tree->triangles, single, place,
                               lane < count ? t->vertices[k][a] - writer->origin[a] : NAN);
                const double stored = bp_reals_load(tree->triangles, single, place);
                own.low[a] = fmin(own.low[a], stored);
                own.high[a] = fmax(own.high[a], stored);
            }
            longest = fmax(longest, own.high[a] - own.low[a]);
        }
        for (int a = 0; a < 3; ++a) {
            own.low[a] -= 4 * unit * fabs(own.low[a]) + 8 * unit * longest + (double)FLT_MIN;
            own.high[a] += 4 * unit * fabs(own.high[a]) + 8 * unit * longest + (double)FLT_MIN;
        }
        if (lane < count) bp_bounds_add(&box, &own);
        tree->slot_sphere[(size_t)leaf * width + lane] =
            lane < count ? (uint32_t)writer->scene->sphere_count + items[lane].sphere : NO_SPHERE;
    }
    if (tree->has_normals) write_normals(writer, leaf, items, count);
    if (tree->has_coordinates) write_coordinates(writer, leaf, items, count);
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
    if (leaves > tree->first_triangles &&
        leaves - tree->first_triangles > UINT32_MAX / TRIANGLE_REALS(tree->width))
        return bp_fail(err, BP_ERR_LIMIT,
                       "a tree of %u leaves of triangles; %u wide it may have %u: take fewer triangles",
                       leaves - tree->first_triangles, tree->width, UINT32_MAX / TRIANGLE_REALS(tree->width));
    const size_t real_size = tree->single_precision ? sizeof(float) : sizeof(double);
    const size_t n = nodes > 0 ? nodes : 1, l = leaves > 0 ? leaves : 1, width = tree->width;
    tree->node_boxes = bp_own_pages(n * NODE_REALS(width), real_size);
    tree->children = bp_own_pages(n * width, sizeof *tree->children);
    const size_t spheres = tree->first_triangles < leaves ? tree->first_triangles : leaves,
                 s = spheres > 0 ? spheres : 1;
    tree->triangle_leaves = leaves - (uint32_t)spheres;
    if (tree->triangle_leaves > 0)
        tree->triangles = bp_own_pages(tree->triangle_leaves * (size_t)TRIANGLE_REALS(width), real_size);
    if (tree->has_normals) {
        tree->normal_leaves = tree->triangle_leaves;
        tree->triangle_normals = bp_own_pages(tree->normal_leaves * (size_t)TRIANGLE_REALS(width), real_size);
    }
    if (tree->has_coordinates) {
        tree->coordinate_leaves = tree->triangle_leaves;
        tree->triangle_coordinates =
            bp_own_pages(tree->coordinate_leaves * (size_t)COORDINATE_REALS(width), real_size);
    }
    tree->leaves = bp_own_pages(s * LEAF_REALS(width), real_size);
    tree->slot_sphere = bp_own_pages(l * width, sizeof *tree->slot_sphere);
    if (tree->has_motions) {
        tree->motion_leaves = (uint32_t)spheres;
        tree->leaf_motions = bp_own_pages(s * MOTION_REALS(width), real_size);
    }
    if (tree->has_axes) {
        tree->axis_leaves = (uint32_t)spheres;
        tree->leaf_axes = bp_own_pages(s * AXIS_REALS(width), real_size);
    }
    if (tree->node_boxes != NULL && tree->children != NULL && tree->leaves != NULL &&
        tree->slot_sphere != NULL && (tree->leaf_motions != NULL || !tree->has_motions) &&
        (tree->leaf_axes != NULL || !tree->has_axes) &&
        (tree->triangles != NULL || tree->triangle_leaves == 0) &&
        (tree->triangle_normals != NULL || tree->normal_leaves == 0) &&
        (tree->triangle_coordinates != NULL || tree->coordinate_leaves == 0))
        return BP_OK;
    return bp_fail(err, BP_ERR_MEMORY, "out of memory for a tree of %u leaves and %u nodes", leaves, nodes);
}
