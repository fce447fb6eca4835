/* traverse_single.cl: the closest hit of one ray.
 *
 * In:    a ray, the geometry.   Out: the hit of least (distance, sphere index); or whether there is any.
 * Knows: node.cl, hit.cl.   Does not know: materials, what made the ray. */
FORCE_INLINE static void intersect_leaf(const Geometry *geometry, const Ray *ray, uint leaf_number, Hit *best) {
    for (child_mask candidates = leaf_candidates(geometry, ray, leaf_number, best->bound, best->slot); candidates != 0;
         candidates = without_lowest_bit(candidates)) {
        const uint slot = leaf_number * TREE_WIDTH + lowest_bit(candidates);
        const Sphere sphere = sphere_for_ray(geometry, ray, slot);
        intersect_sphere(geometry, ray, vbool_all, &sphere, slot, best);
    }
}

#if ACCELERATION_TREE
/* A node of which children are still to be visited, as one number: the node's, and in its low bits the children's mask.
 * Trees of four children have fewer than 2^28 nodes, since there are fewer spheres than that.
 *
 * GPUs, which have narrow nodes, keep nothing else of a level: to test the node's boxes again, against what has been hit
 * meanwhile, costs them less than a longer stack. A processor keeps where the children are entered. */
#if TREE_WIDTH <= 4
typedef uint Level;
#define KEEPS_ENTRIES 0
#else
typedef ulong Level;
#define KEEPS_ENTRIES 1
#endif
#define CHILDREN_ALL (((child_mask)1 << TREE_WIDTH) - 1u)

FORCE_INLINE static void traverse_tree(const Geometry *geometry, const Ray *ray, int any, Hit *best) {
    const BoxRay box = box_ray(ray);
    Level levels[TREE_DEPTH_MAX];
#if KEEPS_ENTRIES
    vreal_node entries[TREE_DEPTH_MAX];
#endif
    uint top = 0;
    uint node = 0;
    child_mask wanted = CHILDREN_ALL;
    for (;;) {
        vreal_node entry;
        child_mask met = wanted;
#if KEEPS_ENTRIES
        if (wanted != CHILDREN_ALL) {
            entry = entries[top];
        } else
#endif
        {
            met &= test_node(geometry, &box, node, best->bound, &entry);
            /* Leaves are visited at once, in any order: sorting them costs more than it saves. */
            const child_mask leaves = leaf_children(geometry, node);
            for (child_mask now = met & leaves; now != 0; now = without_lowest_bit(now)) {
                const uint child = *place_in(geometry->children, node * TREE_WIDTH + lowest_bit(now));
                intersect_leaf(geometry, ray, child & ~CHILD_LEAF, best);
                if (any && best->slot != NO_SLOT) return;
            }
            met &= ~leaves;
        }
        if (met != 0) {
            real nearest;
            const uint lane = nearest_child(met, entry, &nearest);
            if (nearest <= best->bound * SLAB_TOLERANCE) {
                const child_mask rest = without_bit(met, lane);
                if (rest != 0) {
#if KEEPS_ENTRIES
                    entries[top] = entry;
#endif
                    levels[top++] = (Level)node << TREE_WIDTH | rest;
                }
                node = *place_in(geometry->children, node * TREE_WIDTH + lane);
                wanted = CHILDREN_ALL;
                continue;
            }
        }
        if (top == 0) return;
        --top;
        node = (uint)(levels[top] >> TREE_WIDTH);
        wanted = (child_mask)levels[top] & CHILDREN_ALL;
    }
}
#endif

/* Everything but the sphere being left. `best` brings a bound and perhaps a hit along. */
static void traverse_single(const Geometry *geometry, const Ray *ray, int any, Hit *best) {
    for (uint leaf = 0; leaf < geometry->first_leaves; ++leaf) intersect_leaf(geometry, ray, leaf, best);
#if ACCELERATION_TREE
    traverse_tree(geometry, ray, any, best);
#endif
}

/* The closest hit of a ray that is `active`, if it is closer than what the ray has hit already. */
FORCE_INLINE static Hit intersect_closer(const Geometry *geometry, const Ray *ray, vbool active, Hit best) {
    intersect_own_sphere(geometry, ray, active, &best);
    traverse_single(geometry, ray, 0, &best);
    return best;
}

/* The closest hit of a ray that is `active`. */
FORCE_INLINE static Hit intersect_closest(const Geometry *geometry, const Ray *ray, vbool active) {
    return intersect_closer(geometry, ray, active, no_hit(REAL_LARGE));
}

/* Whether anything lies within distance `limit`; which one is left open. */
static int intersect_any(const Geometry *geometry, const Ray *ray, refined limit) {
    Hit best = no_hit(limit);
    Hit own = best;
    intersect_own_sphere(geometry, ray, vbool_all, &own);
    if (own.slot != NO_SLOT && own.t < limit) return 1;
    traverse_single(geometry, ray, 1, &best);
    return best.slot != NO_SLOT;
}
