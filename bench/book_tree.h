/* book_tree.h: the binary tree of the second book (Shirley, Black and Hollasch, 2024), for book_scalar.c.
 *
 * In:    a scene of one sphere or more.   Out: boxes in boxes, split at the median along the longest axis.
 * Knows: spheres.                         Does not know: rays. */
#ifndef BENCH_BOOK_TREE_H
#define BENCH_BOOK_TREE_H

#include "scene/scene.h"

typedef struct BookBox {
    double low[3], high[3];
} BookBox;

/* An inner node has two children; a leaf has one sphere. */
typedef struct BookNode {
    BookBox box;
    struct BookNode *left, *right;
    const BpSphere *sphere;
} BookNode;

/* The root; all nodes stand in one piece of memory, which lives as long as the process. Nodes point into the
 * scene. */
const BookNode *book_tree_build(const BpScene *scene);

#endif
