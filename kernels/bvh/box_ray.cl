/* box_ray.cl: what a box test needs of a ray, once a ray.
 *
 * Knows: lanes.cl.   Does not know: nodes. Read for one lane and for a packet.
 *
 * A box plane at x is met at loose_fma(x, inverse, offset). The origin is moved apart for the planes met first and last,
 * by more than the rounding of the products, of the low part left out, and of 1/d (the boxes are padded for the rounding
 * of their own planes), so that no box that the ray meets is missed. A direction component of 0 counts as 1e-24: no
 * NaN, and a deviation far below every margin. */
#if ACCELERATION_TREE
#define BoxAxis LANED(BoxAxis)
#define box_axis LANED(box_axis)

typedef struct BoxAxis {
    vreal inverse, near_offset, far_offset;
} BoxAxis;

static BoxAxis box_axis(vreal origin, vreal direction) {
    const vreal safe = choose(fabs(direction) < splat(R(1e-24)), copysign(splat(R(1e-24)), direction), direction);
    const vreal shift = copysign(origin * (R(8.0) * ROUNDOFF), safe);
    BoxAxis axis;
    axis.inverse = loose_divide(splat(1), safe);
    axis.near_offset = -(origin + shift) * axis.inverse;
    axis.far_offset = -(origin - shift) * axis.inverse;
    return axis;
}
#endif
