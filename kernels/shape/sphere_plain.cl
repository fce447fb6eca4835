/* sphere_plain.cl: what --numerics plain has in place of sphere_robust.cl: nothing but the book's least distance.
 *
 * A cheap choice that is wrong for spheres that are huge, tiny, far or nested: a path may meet the surface it leaves
 * (acne), pass through a thin shell, or miss a small sphere. docs/NUMERICS.md maps where. It stands here as the
 * yardstick of what robustness costs. */
#define PLAIN_T_MIN R(1e-3)
