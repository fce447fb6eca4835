/* traverse_single.cl: the closest hit of one ray.
 *
 * In:    a ray, the geometry.   Out: the hit of least (distance, sphere index); or whether there is any.
 * Knows: node.cl, hit.cl.   Does not know: materials, what made the ray. */
FORCE_INLINE ON_CHAINS static void intersect_leaf(const Geometry *geometry, const Ray *ray, WITH_SHEAR(const Shear *shear) uint leaf_number,
                                        Hit *best) {
#if EFFECT_TRIANGLES
    if (leaf_number >= geometry->first_triangles) {
        const LeafShear all = leaf_shear(shear);
        const child_mask near = triangle_candidates(geometry, &all, leaf_number, best->bound);
        for (child_mask left = without_known(near, leaf_number, ray->own_slot, best->slot); left != 0;
             left = without_lowest_bit(left)) {
            const uint slot = leaf_number * TREE_WIDTH + lowest_bit(left);
            const Triangle triangle = load_triangle(geometry, slot);
            intersect_triangle(geometry, ray, shear, vbool_all, &triangle, slot, best);
        }
        return;
    }
#endif
#if SPHERES_MET
    const child_mask met = leaf_candidates(geometry, ray, leaf_number, best->bound);
    for (child_mask candidates = without_known(met, leaf_number, ray->own_slot, best->slot); candidates != 0;
         candidates = without_lowest_bit(candidates)) {
        const uint slot = leaf_number * TREE_WIDTH + lowest_bit(candidates);
        const Sphere sphere = sphere_for_ray(geometry, ray, slot);
        intersect_sphere(geometry, ray, vbool_all, &sphere, slot, best);
    }
#endif
}

#if ACCELERATION_TREE
/* The leaves among the children that have been met, at once and in any order: sorting them costs more than it saves. True: a
 * hit has been found, and any will do. */
FORCE_INLINE static int intersect_leaves(const Geometry *geometry, const Ray *ray, WITH_SHEAR(const Shear *shear) uint node,
                                         child_mask leaves, int any,
                                         Hit *best) {
    for (; leaves != 0; leaves = without_lowest_bit(leaves)) {
        const uint child = *place_in(geometry->children, node * TREE_WIDTH + lowest_bit(leaves));
        intersect_leaf(geometry, ray, WITH_SHEAR(shear) child & ~CHILD_LEAF, best);
        if (any && best->slot != NO_SLOT) return 1;
    }
    return 0;
}

#if TREE_WIDTH > 4
/* Processors: each child that is still to be visited is on a stack, with the distance at which it is entered. */
#define STACK_SIZE (TREE_DEPTH_MAX * (TREE_WIDTH - 1) + 1)

FORCE_INLINE static void traverse_tree(const Geometry *geometry, const Ray *ray, WITH_SHEAR(const Shear *shear) int any, Hit *best) {
    const BoxRay box = box_ray(ray);
    uint stack_child[STACK_SIZE];
    real stack_entry[STACK_SIZE];
    LaneReals_node entries;
    uint top = 0;
    uint node = 0;
    for (;;) {
        child_mask met = test_node(geometry, &box, node, best->bound, &entries.all);
        const child_mask leaves = leaf_children(geometry, node);
        if (intersect_leaves(geometry, ray, WITH_SHEAR(shear) node, met & leaves, any, best)) return;
        /* Nodes onto the stack, the nearest on top. */
        met &= ~leaves;
        const uint base = top;
        for (; met != 0; met = without_lowest_bit(met)) {
            const uint lane = lowest_bit(met);
            const real lane_entry = entries.of[lane];
            uint place = top;
            while (place > base && stack_entry[place - 1] < lane_entry) {
                stack_entry[place] = stack_entry[place - 1];
                stack_child[place] = stack_child[place - 1];
                --place;
            }
            stack_entry[place] = lane_entry;
            stack_child[place] = *place_in(geometry->children, node * TREE_WIDTH + lane);
            ++top;
        }
        do {
            if (top == 0) return;
            --top;
        } while (stack_entry[top] > best->bound * SLAB_TOLERANCE);
        node = stack_child[top];
    }
}
#else
/* GPUs, whose nodes are narrow and whose private memory is dear: a node of which children are still to be visited is one
 * number, the node's and in its low bits the children's mask. To test the node's boxes again, against what has been hit
 * meanwhile, costs less there than a longer stack; a processor would be 1.1 to 1.3 times slower. Trees of four children have fewer
 * than 2^28 nodes, since there are fewer spheres than that. */
#define CHILDREN_ALL (((child_mask)1 << TREE_WIDTH) - 1u)

FORCE_INLINE static void traverse_tree(const Geometry *geometry, const Ray *ray, WITH_SHEAR(const Shear *shear) int any, Hit *best) {
    const BoxRay box = box_ray(ray);
    uint levels[TREE_DEPTH_MAX];
    uint top = 0;
    uint node = 0;
    child_mask wanted = CHILDREN_ALL;
    for (;;) {
        vreal_node entry;
        child_mask met = wanted & test_node(geometry, &box, node, best->bound, &entry);
        const child_mask leaves = leaf_children(geometry, node);
        if (intersect_leaves(geometry, ray, WITH_SHEAR(shear) node, met & leaves, any, best)) return;
        met &= ~leaves;
        if (met != 0) {
            real nearest;
            const uint lane = nearest_child(met, entry, &nearest);
            if (nearest <= best->bound * SLAB_TOLERANCE) {
                const child_mask rest = without_bit(met, lane);
                if (rest != 0) levels[top++] = node << TREE_WIDTH | rest;
                node = *place_in(geometry->children, node * TREE_WIDTH + lane);
                wanted = CHILDREN_ALL;
                continue;
            }
        }
        if (top == 0) return;
        --top;
        node = levels[top] >> TREE_WIDTH;
        wanted = (child_mask)levels[top] & CHILDREN_ALL;
    }
}
#endif
#endif

/* Everything but the sphere being left. `best` brings a bound and perhaps a hit along. */
static void traverse_single(const Geometry *geometry, const Ray *ray, int any, Hit *best) {
#if EFFECT_TRIANGLES
    const Shear at_triangles = shear_at_triangles(geometry, ray);
    const Shear *const shear = &at_triangles;
#endif
    for (uint leaf = 0; leaf < geometry->first_leaves; ++leaf) intersect_leaf(geometry, ray, WITH_SHEAR(shear) leaf, best);
#if ACCELERATION_TREE
    traverse_tree(geometry, ray, WITH_SHEAR(shear) any, best);
#endif
}

/* The closest hit of a ray that is `active`, if it is closer than what the ray has hit already. */
FORCE_INLINE ON_CHAINS static Hit intersect_closer(const Geometry *geometry, const Ray *ray, vbool active, Hit best) {
#if SPHERES_MET
    intersect_own_sphere(geometry, ray, active, &best);
#endif
    traverse_single(geometry, ray, 0, &best);
    return best;
}

/* The closest hit of a ray that is `active`. */
FORCE_INLINE ON_CHAINS static Hit intersect_closest(const Geometry *geometry, const Ray *ray, vbool active) {
    return intersect_closer(geometry, ray, active, no_hit(REAL_LARGE));
}

/* Whether anything lies within distance `limit`; which one is left open. */
static int intersect_any(const Geometry *geometry, const Ray *ray, refined limit) {
    Hit best = no_hit(limit);
#if SPHERES_MET
    Hit own = best;
    intersect_own_sphere(geometry, ray, vbool_all, &own);
    if (own.slot != NO_SLOT && own.t < limit) return 1;
#endif
    traverse_single(geometry, ray, 1, &best);
    return best.slot != NO_SLOT;
}
