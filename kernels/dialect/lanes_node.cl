/* lanes_node.cl: from here on, lane code means the TREE_WIDTH children of a node, or spheres of a leaf. lanes.cl, which
 * follows, gives its words their meaning. */
#undef LANE_COUNT
#undef LANED
#define LANE_COUNT TREE_WIDTH
#define LANED(name) JOIN(name, _node)
