/* book_tree.c: see book_tree.h. */
#include "book_tree.h"

#include "peer.h"

#include <math.h>
#include <stdlib.h>

static BookBox sphere_box(const BpSphere *sphere) {
    const double radius = fabs(sphere->radius);
    BookBox box;
    for (int k = 0; k < 3; k++) {
        box.low[k] = sphere->center[k] - radius;
        box.high[k] = sphere->center[k] + radius;
    }
    return box;
}

static double low_end(const void *entry, int axis) {
    const BpSphere *sphere = *(const BpSphere *const *)entry;
    return sphere->center[axis] - fabs(sphere->radius);
}
static int compare(const void *a, const void *b, int axis) {
    const double x = low_end(a, axis), y = low_end(b, axis);
    return (x > y) - (x < y);
}
static int compare_x(const void *a, const void *b) {
    return compare(a, b, 0);
}
static int compare_y(const void *a, const void *b) {
    return compare(a, b, 1);
}
static int compare_z(const void *a, const void *b) {
    return compare(a, b, 2);
}

/* Builds the tree over `spheres` and returns its root; nodes are taken from *next on. */
static BookNode *build(const BpSphere **spheres, size_t count, BookNode **next) {
    BookNode *node = (*next)++;
    node->box = sphere_box(spheres[0]);
    if (count == 1) {
        node->sphere = spheres[0];
        return node;
    }
    for (size_t i = 1; i < count; i++) {
        const BookBox box = sphere_box(spheres[i]);
        for (int k = 0; k < 3; k++) {
            node->box.low[k] = fmin(node->box.low[k], box.low[k]);
            node->box.high[k] = fmax(node->box.high[k], box.high[k]);
        }
    }
    static int (*const compare_by[3])(const void *, const void *) = {compare_x, compare_y, compare_z};
    int axis = 0;
    for (int k = 1; k < 3; k++) {
        if (node->box.high[k] - node->box.low[k] > node->box.high[axis] - node->box.low[axis]) axis = k;
    }
    qsort(spheres, count, sizeof *spheres, compare_by[axis]);
    node->left = build(spheres, count / 2, next);
    node->right = build(spheres + count / 2, count - count / 2, next);
    return node;
}

const BookNode *book_tree_build(const BpScene *scene) {
    const size_t count = scene->sphere_count;
    const BpSphere **order = peer_allocate(count, sizeof(BpSphere *));
    for (size_t i = 0; i < count; i++) order[i] = &scene->spheres[i];
    BookNode *nodes = peer_allocate(2 * count, sizeof *nodes), *next = nodes;
    const BookNode *root = build(order, count, &next);
    free(order);
    return root;
}
