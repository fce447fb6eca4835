/* lanes_wide.cl: from here on, lane code means eight lanes (see lanes_scalar.cl). A mask is 0 or -1 a lane, as
 * wide as a real. */
#undef LANED
#undef reals
#undef masks
#undef uints
#undef uint_masks
#undef refineds
#undef refined_masks
#undef choose
#undef choose_uint
#undef choose_refined
#undef any_lane
#undef not_mask
#undef mask_of_uint
#undef mask_of_refined
#undef to_refined
#undef to_real
#undef splat
#undef splat_uint
#undef splat_refined
#undef load_lanes
#undef store_lanes
#undef uint_to_reals
#undef gather_reals
#undef gather_uints
#undef LANE_COUNT

#define LANE_COUNT 8
#define LANED(name) JOIN(name, _8)
#define reals JOIN(REAL, 8)
#define masks JOIN(REAL_MASK, 8)
#define uints uint8
#define uint_masks int8
#define refineds JOIN(REFINED, 8)
#define refined_masks JOIN(REFINED_MASK, 8)
#define choose(mask, a, b) ((mask) ? (a) : (b))
#define choose_uint(mask, a, b) (convert_int8(mask) ? (a) : (b))
#define choose_refined(mask, a, b) (JOIN(JOIN(convert_, REFINED_MASK), 8)(mask) ? (a) : (b))
#define any_lane(mask) any(mask)
#define not_mask(mask) (~(mask))
#define mask_of_uint(mask) JOIN(JOIN(convert_, REAL_MASK), 8)(mask)
#define mask_of_refined(mask) JOIN(JOIN(convert_, REAL_MASK), 8)(mask)
#define to_refined(x) JOIN(JOIN(convert_, REFINED), 8)(x)
#define to_real(x) JOIN(JOIN(convert_, REAL), 8)(x)
#define splat(x) ((reals)(x))
#define splat_uint(x) ((uint8)(x))
#define splat_refined(x) ((refineds)(x))
#define load_lanes(array) vload8(0, array)
#define store_lanes(x, array) vstore8(x, 0, array)
#define uint_to_reals(x) JOIN(JOIN(convert_, REAL), 8)(x)
#define gather_lanes(type, base, index)                                                                      \
    (type)((base)[(index).s0], (base)[(index).s1], (base)[(index).s2], (base)[(index).s3], (base)[(index).s4],  \
           (base)[(index).s5], (base)[(index).s6], (base)[(index).s7])
#define gather_reals(base, index) gather_lanes(reals, base, index)
#define gather_uints(base, index) gather_lanes(uints, base, index)
