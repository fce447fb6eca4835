/* lanes_scalar.cl: from here on, lane code means one lane: `reals` is a real, a mask is 0 or 1.
 *
 * Lane code is written once, for one lane or for many: a mask is made by a comparison, combined with & | and
 * not_mask, asked by any_lane, and spent by choose. `if (any_lane(m)) ...` is a plain branch for one lane and
 * "skip when no lane wants it" for many. LANED(f) is f's name for this number of lanes. */
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
#undef count_lanes
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
#undef FORCE_INLINE

#define LANE_COUNT 1
#define FORCE_INLINE
#define LANED(name) JOIN(name, _1)
#define reals real
#define masks int
#define uints uint
#define uint_masks int
#define refineds refined
#define refined_masks int
#define choose(mask, a, b) ((mask) ? (a) : (b))
#define choose_uint(mask, a, b) ((mask) ? (a) : (b))
#define choose_refined(mask, a, b) ((mask) ? (a) : (b))
#define any_lane(mask) ((mask) != 0)
#define count_lanes(mask) ((mask) != 0)
#define not_mask(mask) (!(mask))
#define mask_of_uint(mask) (mask)
#define mask_of_refined(mask) (mask)
#define to_refined(x) ((refined)(x))
#define to_real(x) ((real)(x))
#define splat(x) ((real)(x))
#define splat_uint(x) ((uint)(x))
#define splat_refined(x) ((refined)(x))
#define load_lanes(array) ((array)[0])
#define store_lanes(x, array) ((array)[0] = (x))
#define uint_to_reals(x) ((real)(x))
#define gather_reals(base, index) ((base)[index])
#define gather_uints(base, index) ((base)[index])
