/* lanes_packet.cl: from here on, lane code means PACKET_LANES lanes (see lanes_one.cl). A mask is 0 or -1 a lane, as
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
#undef set_of_lanes
#undef RANK_BITS
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
#undef to_uints
#undef gather_reals
#undef gather_uints
#undef LANE_COUNT
#undef FORCE_INLINE

#define LANE_COUNT PACKET_LANES
#define FORCE_INLINE __attribute__((always_inline))
#define LANED(name) JOIN(JOIN(name, _), PACKET_LANES)
#define reals JOIN(REAL, PACKET_LANES)
#define masks JOIN(REAL_MASK, PACKET_LANES)
#define uints JOIN(uint, PACKET_LANES)
#define uint_masks JOIN(int, PACKET_LANES)
#define refineds JOIN(REFINED, PACKET_LANES)
#define refined_masks JOIN(REFINED_MASK, PACKET_LANES)
#define choose(mask, a, b) ((mask) ? (a) : (b))
#define choose_uint(mask, a, b) (JOIN(convert_int, PACKET_LANES)(mask) ? (a) : (b))
#define choose_refined(mask, a, b) (JOIN(JOIN(convert_, REFINED_MASK), PACKET_LANES)(mask) ? (a) : (b))
#define any_lane(mask) any_of_lanes(mask)
#define set_of_lanes(mask) bits_of_lanes(mask)
#define not_mask(mask) (~(mask))
#define mask_of_uint(mask) JOIN(JOIN(convert_, REAL_MASK), PACKET_LANES)(mask)
#define mask_of_refined(mask) JOIN(JOIN(convert_, REAL_MASK), PACKET_LANES)(mask)
#define to_refined(x) JOIN(JOIN(convert_, REFINED), PACKET_LANES)(x)
#define to_real(x) JOIN(JOIN(convert_, REAL), PACKET_LANES)(x)
#define splat(x) ((reals)(x))
#define splat_uint(x) ((uints)(x))
#define splat_refined(x) ((refineds)(x))
#define load_lanes(array) JOIN(vload, PACKET_LANES)(0, array)
#define store_lanes(x, array) JOIN(vstore, PACKET_LANES)(x, 0, array)
#define to_uints(x) JOIN(convert_uint, PACKET_LANES)(JOIN(convert_int, PACKET_LANES)(x))
#define uint_to_reals(x) JOIN(JOIN(convert_, REAL), PACKET_LANES)(x)
/* Tables have fewer than 2^31 entries, and some processors gather faster with signed offsets. */
#define gather_8(base, index)                                                                                \
    (base)[(int)(index).s0], (base)[(int)(index).s1], (base)[(int)(index).s2], (base)[(int)(index).s3],            \
        (base)[(int)(index).s4], (base)[(int)(index).s5], (base)[(int)(index).s6], (base)[(int)(index).s7]
#if PACKET_LANES == 16
#define gather_lanes(type, base, index) (type)(gather_8(base, (index).lo), gather_8(base, (index).hi))
#else
#define gather_lanes(type, base, index) (type)(gather_8(base, index))
#endif
#define gather_reals(base, index) gather_lanes(reals, base, index)
#define gather_uints(base, index) gather_lanes(uints, base, index)

/* Drivers' own any() may ask lane by lane. */
static int any_of_lanes(masks mask) {
#if PACKET_LANES == 16
    const JOIN(REAL_MASK, 8) eight = mask.lo | mask.hi;
    const JOIN(REAL_MASK, 4) four = eight.lo | eight.hi;
#else
    const JOIN(REAL_MASK, 4) four = mask.lo | mask.hi;
#endif
    const JOIN(REAL_MASK, 2) two = four.lo | four.hi;
    return (two.x | two.y) != 0;
}
/* Bit l: lane l. And for each lane the bits of all lanes below it. */
#if PACKET_LANES == 16
#define LANE_BITS ((uints)(1, 2, 4, 8, 16, 32, 64, 128, 256, 512, 1024, 2048, 4096, 8192, 16384, 32768))
#else
#define LANE_BITS ((uints)(1, 2, 4, 8, 16, 32, 64, 128))
#endif
#define RANK_BITS (LANE_BITS - 1u)
static uint bits_of_lanes(masks mask) {
    const uints bits = choose_uint(mask, LANE_BITS, splat_uint(0));
#if PACKET_LANES == 16
    const uint8 eight = bits.lo | bits.hi;
    const uint4 four = eight.lo | eight.hi;
#else
    const uint4 four = bits.lo | bits.hi;
#endif
    const uint2 two = four.lo | four.hi;
    return two.x | two.y;
}
