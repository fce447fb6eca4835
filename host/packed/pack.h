/* pack.h: turns a Scene into the flat buffers that the kernel reads.
 *
 * In:    a validated Scene (scene.h).     Out: BpPacked, owned by the caller.
 * Knows: kernels/scene_types.h, the tree. Does not know: OpenCL.
 *
 * The camera's position is subtracted in double, before anything becomes float. The elements of arrays do so
 * in reals.h; the few numbers that kernels get as arguments are rounded here. */
#ifndef BP_PACKED_PACK_H
#define BP_PACKED_PACK_H

#include "focusers.h"
#include "lamp_tree.h"
#include "tree.h"

#ifndef BP_HOST
#define BP_HOST
#endif
#include "scene_types.h"

typedef struct BpPacked {
    bool single_precision;
    BpTree tree;
    BpLampTree lamps;    /* empty, unless lamps are to be sampled */
    BpFocusers focusers; /* empty, unless rays are to be sent through them */
    /* The other arrays of scene_types.h: of reals in the device's precision, or of uints.
     */
#define BP_HOLD_REALS void
#define BP_HOLD_UINTS uint32_t
#define BP_HOLD(numbers, element, name, count, what) BP_HOLD_##numbers *name;
    SCENE_ARRAYS_OF_PACK(BP_HOLD)
    SCENE_ARRAYS_OF_SLOTS(BP_HOLD)
#undef BP_HOLD
    uint32_t material_count; /* at least one */
    uint32_t first_body;     /* of materials, that of the first body; there is one for each */
    uint32_t coloured_slots; /* the first so many slots have a colour each, in slot_albedo */
    uint64_t colour_count;   /* these, and one for each material where there are other slots */
    uint32_t texture_count;
    uint64_t texel_count; /* of all images */
    uint32_t sky_row_count, sky_column_count, sky_height_count;
    uint32_t disc_count;
    uint32_t medium_count;   /* at least one */
    uint32_t boundary_uints; /* of the array */
} BpPacked;

/* `sample_lamps`: the kernel is built to. `sample_caustics`: rays are sent to lamps through focusers, if the
 * scene calls for it. */
BpStatus bp_scene_pack(const BpScene *scene, const BpTreeOptions *options, bool sample_lamps,
                       bool sample_caustics, BpPacked *packed, BpError *err);
void bp_packed_clear(BpPacked *packed);
/* Bytes of one real. */
static inline size_t bp_packed_real_size(const BpPacked *packed) {
    return packed->single_precision ? sizeof(float) : sizeof(double);
}

#endif
