/* lanes_packet.cl: from here on, lane code means PACKET_LANES lanes (see lanes_one.cl). A mask is 0 or -1 a lane, as
 * wide as a real. */
#undef LANED
#undef vreal
#undef vbool
#undef vuint
#undef vrefined
#undef choose
#undef choose_uint
#undef choose_refined
#undef any_lane
#undef lane_bits
#undef BITS_BELOW
#undef vbool_not
#undef vbool_of_uint
#undef vbool_of_refined
#undef to_refined
#undef to_real
#undef splat
#undef splat_uint
#undef splat_refined
#undef load_lanes
#undef store_lanes
#undef uint_to_real
#undef to_uint
#undef gather_real
#undef gather_uint
#undef LANE_COUNT
#undef FORCE_INLINE

#define LANE_COUNT PACKET_LANES
#define FORCE_INLINE __attribute__((always_inline))
#define LANED(name) JOIN(name, _packet)
#define vreal JOIN(REAL, PACKET_LANES)
#define vbool JOIN(REAL_MASK, PACKET_LANES)
#define vuint JOIN(uint, PACKET_LANES)
#define vrefined JOIN(REFINED, PACKET_LANES)
#define choose(mask, a, b) ((mask) ? (a) : (b))
#define choose_uint(mask, a, b) (JOIN(convert_int, PACKET_LANES)(mask) ? (a) : (b))
#define choose_refined(mask, a, b) (JOIN(JOIN(convert_, REFINED_MASK), PACKET_LANES)(mask) ? (a) : (b))
#define any_lane(mask) any_of_lanes(mask)
#define lane_bits(mask) bits_of_lanes(mask)
#define vbool_not(mask) (~(mask))
#define vbool_of_uint(mask) JOIN(JOIN(convert_, REAL_MASK), PACKET_LANES)(mask)
#define vbool_of_refined(mask) JOIN(JOIN(convert_, REAL_MASK), PACKET_LANES)(mask)
#define to_refined(x) JOIN(JOIN(convert_, REFINED), PACKET_LANES)(x)
#define to_real(x) JOIN(JOIN(convert_, REAL), PACKET_LANES)(x)
#define splat(x) ((vreal)(x))
#define splat_uint(x) ((vuint)(x))
#define splat_refined(x) ((vrefined)(x))
#define load_lanes(array) JOIN(vload, PACKET_LANES)(0, array)
#define store_lanes(x, array) JOIN(vstore, PACKET_LANES)(x, 0, array)
#define to_uint(x) JOIN(convert_uint, PACKET_LANES)(JOIN(convert_int, PACKET_LANES)(x))
#define uint_to_real(x) JOIN(JOIN(convert_, REAL), PACKET_LANES)(x)
/* Tables have fewer than 2^31 entries, and some processors gather faster with signed offsets. */
#define gather_8(base, index)                                                                                \
    (base)[(int)(index).s0], (base)[(int)(index).s1], (base)[(int)(index).s2], (base)[(int)(index).s3],            \
        (base)[(int)(index).s4], (base)[(int)(index).s5], (base)[(int)(index).s6], (base)[(int)(index).s7]
#if PACKET_LANES == 16
#define gather_lanes(type, base, index) (type)(gather_8(base, (index).lo), gather_8(base, (index).hi))
#else
#define gather_lanes(type, base, index) (type)(gather_8(base, index))
#endif
#define gather_real(base, index) gather_lanes(vreal, base, index)
#define gather_uint(base, index) gather_lanes(vuint, base, index)

/* Drivers' own any() may ask lane by lane. */
static int any_of_lanes(vbool mask) {
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
#define LANE_BITS ((vuint)(1, 2, 4, 8, 16, 32, 64, 128, 256, 512, 1024, 2048, 4096, 8192, 16384, 32768))
#else
#define LANE_BITS ((vuint)(1, 2, 4, 8, 16, 32, 64, 128))
#endif
#define BITS_BELOW (LANE_BITS - 1u)
static uint bits_of_lanes(vbool mask) {
    const vuint bits = choose_uint(mask, LANE_BITS, splat_uint(0));
#if PACKET_LANES == 16
    const uint8 eight = bits.lo | bits.hi;
    const uint4 four = eight.lo | eight.hi;
#else
    const uint4 four = bits.lo | bits.hi;
#endif
    const uint2 two = four.lo | four.hi;
    return two.x | two.y;
}
