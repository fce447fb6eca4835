/* pack.h: turns a Scene into the flat buffers that the kernel reads.
 *
 * In:    a validated Scene (scene.h).     Out: BpPacked, owned by the caller.
 * Knows: kernels/scene_types.h, the tree. Does not know: OpenCL.
 *
 * The camera's position is subtracted in double, and double becomes float, here (and for the tree's arrays in
 * tree.c, by bp_reals_store) and nowhere else. */
#ifndef BP_PACKED_PACK_H
#define BP_PACKED_PACK_H

#include "tree.h"

typedef struct BpPacked {
    bool single_precision;
    BpTree tree;
    /* Arrays of reals in the device's precision. */
    void *camera;      /* one PackedCamera */
    void *sky;         /* one PackedSky */
    void *materials;   /* material_count PackedMaterial, at least one */
    void *slot_albedo; /* ALBEDO_REALS a slot of the tree */
    /* Arrays of uints. */
    uint32_t *material_kinds; /* material_count PackedMaterialKind */
    uint32_t *slot_material;  /* one a slot of the tree */
    uint32_t material_count;
} BpPacked;

BpStatus bp_scene_pack(const BpScene *scene, const BpTreeOptions *options, BpPacked *packed, BpError *err);
void bp_packed_clear(BpPacked *packed);
/* Bytes of one real. */
static inline size_t bp_packed_real_size(const BpPacked *packed) {
    return packed->single_precision ? sizeof(float) : sizeof(double);
}

#endif
