/* tree_check.c: see tree_check.h. */
#define BP_HOST
#include "tree_check.h"

#include "packed/pack.h"
#include "packed/reals.h"
#include "scene/scene_side.h"
#include "scene_types.h"

#include <float.h>
#include <math.h>

typedef struct Check {
    const BpScene *scene;
    const BpTree *tree;
    uint8_t *leaf_seen, *node_seen;
    uint32_t deepest;
} Check;

typedef struct Place { /* a lane of a node above */
    uint32_t node, lane;
} Place;

static long double box_value(const BpTree *tree, Place place, uint32_t row) {
    const uint32_t width = tree->width;
    return bp_reals_load(tree->node_boxes, tree->single_precision,
                         (size_t)place.node * NODE_REALS(width) + row * width + place.lane);
}

/* Row 0 to 2: the centre, 3: the radius of the sphere in a slot. */
static double slot_value(const BpTree *tree, size_t slot, size_t row) {
    const size_t width = tree->width;
    return bp_reals_load(tree->leaves, tree->single_precision,
                         slot / width * LEAF_REALS(width) + row * width + slot % width);
}

static double relative(const BpScene *scene, const BpSphere *sphere, int axis) {
    return sphere->center[axis] - scene->camera.lookfrom[axis];
}

static void check_contains(const Check *check, Place place, size_t slot) {
    const BpTree *tree = check->tree;
    const BpSphere *sphere = &check->scene->spheres[tree->slot_sphere[slot]];
    const long double exact_r = fabsl((long double)sphere->radius), stored_r = slot_value(tree, slot, 3);
    /* Of a sphere on whose surface the camera stands, far from the scene's origin, the scene's own radius is
     * less exact than the stored one. */
    const bool on =
        tree->single_precision && bp_sphere_side(sphere, check->scene->camera.lookfrom) == BP_SIDE_ON;
    /* In single precision the kernel may take for a hit what passes by up to 4 * 2^-24 of the radius. */
    const long double wide_r = tree->single_precision ? stored_r * (1 + 4 * 0x1p-24L) : stored_r;
    for (int a = 0; a < 3; ++a) {
        const long double exact =
            (long double)sphere->center[a] - (long double)check->scene->camera.lookfrom[a];
        const long double stored = slot_value(tree, slot, (size_t)a);
        const long double low = box_value(tree, place, (uint32_t)a),
                          high = box_value(tree, place, 3 + (uint32_t)a);
        require(on || (low <= exact - exact_r && exact + exact_r <= high));
        require(low <= stored - wide_r && stored + wide_r <= high);
    }
}

static void walk(Check *check, uint32_t word, uint32_t above, Place path[TREE_DEPTH_MAX]) {
    const BpTree *tree = check->tree;
    if (word & CHILD_LEAF) {
        const uint32_t leaf = word & ~CHILD_LEAF;
        require(leaf >= tree->first_leaves && leaf < tree->leaf_count && check->leaf_seen[leaf]++ == 0);
        for (uint32_t lane = 0; lane < tree->width; ++lane) {
            const size_t slot = (size_t)leaf * tree->width + lane;
            for (uint32_t p = 0; p < above && tree->slot_sphere[slot] != NO_SPHERE; ++p)
                check_contains(check, path[p], slot);
        }
        return;
    }
    require(word < tree->node_count && check->node_seen[word]++ == 0 && above < TREE_DEPTH_MAX);
    if (above + 1 > check->deepest) check->deepest = above + 1;
    for (uint32_t lane = 0; lane < tree->width; ++lane) {
        const Place place = {word, lane};
        const uint32_t child = tree->children[(size_t)word * tree->width + lane];
        bool empty = true, all = true;
        for (uint32_t a = 0; a < 3; ++a) {
            const long double low = box_value(tree, place, a), high = box_value(tree, place, 3 + a);
            require(fabsl(low) <= 3e30L && fabsl(high) <= 3e30L); /* NaN is not */
            empty = empty && low > high;
            all = all && low <= high;
        }
        require(empty || all);
        if (empty) {
            require((child & CHILD_LEAF) != 0);
            continue;
        }
        path[above] = place;
        walk(check, child, above + 1, path);
    }
}

/* The centre and radius of a slot beside those of its sphere. */
static void check_sphere(const BpScene *scene, const BpTree *tree, size_t slot) {
    const BpSphere *sphere = &scene->spheres[tree->slot_sphere[slot]];
    const double radius = slot_value(tree, slot, 3), r = fabs(sphere->radius);
    long double square = 0;
    require(radius > 0);
    for (int a = 0; a < 3; ++a) {
        const double c = relative(scene, sphere, a), stored = slot_value(tree, slot, (size_t)a);
        require(stored == (tree->single_precision ? (double)(float)c : c));
        square += (long double)stored * (long double)stored;
    }
    if (!tree->single_precision) {
        require(radius == r);
        return;
    }
    /* Where the camera is near the surface, the radius moves a few units in the last place; where it stands
     * on it, as far as the scene's own doubles can tell, to the camera. */
    const BpSide side = bp_sphere_side(sphere, scene->camera.lookfrom);
    require(fabs(radius - r) <= (side == BP_SIDE_ON ? 0x1p-18 : 8 * 0x1p-24) * r + (double)FLT_MIN);
    if (side == BP_SIDE_OUTSIDE) require(square > (long double)radius * (long double)radius);
    if (side == BP_SIDE_INSIDE) require(square < (long double)radius * (long double)radius);
}

static void check_slots(const BpScene *scene, const BpPacked *packed) {
    const BpTree *tree = &packed->tree;
    uint8_t *seen = calloc(scene->sphere_count + 1, 1);
    require(seen != NULL);
    for (size_t slot = 0; slot < (size_t)tree->leaf_count * tree->width; ++slot) {
        const uint32_t index = tree->slot_sphere[slot];
        if (index == NO_SPHERE) {
            require(slot_value(tree, slot, 3) == -1);
            continue;
        }
        require(slot % tree->width == 0 ||
                tree->slot_sphere[slot - 1] != NO_SPHERE); /* empty ones come last */
        require(index < scene->sphere_count && seen[index]++ == 0);
        check_sphere(scene, tree, slot);
        require(packed->slot_material[slot] < packed->material_count);
        for (size_t a = 0; a < ALBEDO_REALS; ++a) {
            const double albedo =
                bp_reals_load(packed->slot_albedo, packed->single_precision, ALBEDO_REALS * slot + a);
            require(albedo >= 0 && albedo <= 1);
        }
    }
    for (size_t i = 0; i < scene->sphere_count; ++i) require(seen[i] == 1);
    free(seen);
    if (tree->own_slot == NO_SLOT) return;
    require(tree->own_slot < tree->leaf_count * tree->width &&
            tree->slot_sphere[tree->own_slot] != NO_SPHERE);
    const BpSphere *own = &scene->spheres[tree->slot_sphere[tree->own_slot]];
    require(bp_sphere_side(own, scene->camera.lookfrom) == BP_SIDE_ON);
}

void check_packed(const BpScene *scene, const BpTreeOptions *options) {
    BpPacked packed;
    BpError err = {0};
    require(bp_scene_pack(scene, options, true, true, &packed, &err) == BP_OK);
    const BpTree *tree = &packed.tree;
    check_slots(scene, &packed);
    if (options->list) {
        require(tree->node_count == 0 && tree->first_leaves == tree->leaf_count);
    } else {
        Check check = {scene, tree, calloc(tree->leaf_count + 1u, 1), calloc(tree->node_count + 1u, 1), 0};
        Place path[TREE_DEPTH_MAX];
        require(check.leaf_seen != NULL && check.node_seen != NULL && tree->node_count > 0 &&
                tree->first_leaves <= 1);
        walk(&check, 0, 0, path);
        for (uint32_t i = 0; i < tree->leaf_count; ++i)
            require(check.leaf_seen[i] == (i >= tree->first_leaves));
        for (uint32_t i = 0; i < tree->node_count; ++i) require(check.node_seen[i] == 1);
        require(check.deepest == tree->depth && tree->depth <= TREE_DEPTH_MAX);
        free(check.leaf_seen);
        free(check.node_seen);
    }
    bp_packed_clear(&packed);
    bp_error_clear(&err);
}
