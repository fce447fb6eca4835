/* environment.cl: an image all around the scene: what it shows in a direction, and directions to where it is bright.
 *
 * In:    a direction; random numbers.   Out: radiance; a direction, with the probability of its texel and the texel's cone.
 * Knows: PackedSky and the tables of the image (scene_types.h), image.cl, sphere_map.cl.   Does not know: paths, shadows, lobes.
 *
 * A texel is chosen by the light that its square brings from its part of the sphere: a row, then a texel in it, by
 * bisection. Shares are whole numbers, and so are the numbers that choose, so the probabilities are exact. In the square,
 * directions are uniform. */
#if EFFECT_ENVIRONMENT
static int has_environment(__global const PackedSky *sky) { return sky->columns > 0; }

/* Where a direction meets the image: shares of its width from the left and of its height from the top. */
static void environment_place(__global const PackedSky *sky, Vec3 direction, vreal *u, vreal *v) {
    sphere_map(direction, splat3(sky->axes), splat3(sky->axes + 3), splat3(sky->axes + 6), u, v);
}

static Vec3 environment_radiance(const Scene *scene, Vec3 direction) {
    __global const PackedSky *sky = scene->sky;
    vreal u, v;
    environment_place(sky, direction, &u, &v);
    Image image;
    image.first = splat_uint(0);
    image.width = splat_uint((uint)sky->columns);
    image.height = splat_uint((uint)sky->rows);
    image.columns = splat(sky->columns);
    image.rows = splat(sky->rows);
    image.ring = vbool_all;
#if MAPPED_TRIANGLES
    image.rows_ring = vbool_none;
#endif
    return image_colour(scene, &image, u * sky->columns, v * sky->rows);
}

#if SAMPLES_ENVIRONMENT
/* What stands for a texel's square in the choice. */
typedef struct EnvironmentCell {
    vreal probability;
    vreal cap; /* its solid angle over 2 pi */
} EnvironmentCell;

/* Of the image as a whole, in place of the irradiance over pi: its mean over all directions. */
static vreal environment_importance(const Scene *scene) { return splat(scene->sky->image_power); }

/* The last of `count` lower bounds from `first` on that does not exceed `target`; the first is 0. */
static vuint find_share(__global const uint *bounds, vuint first, uint count, vuint target) {
    vuint found = splat_uint(0);
    for (uint step = 0x80000000u >> clz(count); step > 0u; step >>= 1) {
        const vuint next = found + splat_uint(step);
        const vuint bound = gather_uint(bounds, first + min(next, splat_uint(count - 1u)));
        found = choose_uint(vbool_of_uint((next < splat_uint(count)) & (bound <= target)), next, found);
    }
    return found;
}

/* Of a row: the squared sine of half the angle between the nearer pole and its edge there, and how much more at the other. */
static vreal row_height(const Scene *scene, vuint row, vbool *upper, vreal *more) {
    const uint rows = (uint)scene->sky->rows;
    *upper = vbool_of_uint(row + row < splat_uint(rows));
    const vuint from_pole = choose_uint(*upper, row, splat_uint(rows - 1u) - row);
    const vreal height = gather_real(scene->sky_heights, from_pole);
    *more = gather_real(scene->sky_heights + 1u, from_pole) - height;
    return height;
}

static vreal share_of(vuint low, vuint high) { return uint_to_real(high - low) * R(0x1p-24); }

/* The square in which a direction lies; of a lane whose direction is none, any. */
static EnvironmentCell environment_cell(const Scene *scene, Vec3 direction) {
    __global const PackedSky *sky = scene->sky;
    const uint columns = (uint)sky->columns;
    vreal u, v, more;
    vbool upper;
    environment_place(sky, direction, &u, &v);
    const vuint column = min(to_uint(u * sky->columns), splat_uint(columns - 1u));
    const vuint row = min(to_uint(v * sky->rows), splat_uint((uint)sky->rows - 1u));
    const vuint place = row * (columns + 1u) + column;
    EnvironmentCell cell;
    cell.probability = share_of(gather_uint(scene->sky_rows, row), gather_uint(scene->sky_rows + 1u, row)) *
                       share_of(gather_uint(scene->sky_columns, place), gather_uint(scene->sky_columns + 1u, place));
    row_height(scene, row, &upper, &more);
    cell.cap = divide(splat(2) * more, splat(sky->columns));
    return cell;
}

/* A direction, by two numbers in [0, 1): one for the row, one for the texel in it. What they leave says where in the
 * square. */
static EnvironmentCell sample_environment(const Scene *scene, SampleKey key, vuint bounce, vreal u, vreal v,
                                          Vec3 *direction) {
    __global const PackedSky *sky = scene->sky;
    const uint columns = (uint)sky->columns;
    const vuint down = to_uint(u * R(0x1p24)), across = to_uint(v * R(0x1p24));
    const vuint row = find_share(scene->sky_rows, splat_uint(0), (uint)sky->rows, down);
    const vuint begin = row * (columns + 1u);
    const vuint column = find_share(scene->sky_columns, begin, columns, across);
    const vuint row_low = gather_uint(scene->sky_rows, row), row_high = gather_uint(scene->sky_rows + 1u, row);
    const vuint place = begin + column;
    const vuint low = gather_uint(scene->sky_columns, place), high = gather_uint(scene->sky_columns + 1u, place);
    EnvironmentCell cell;
    cell.probability = share_of(row_low, row_high) * share_of(low, high);
    const vreal below =
        divide(uint_to_real(down - row_low) + uniform(key, bounce + BOUNCE_SKY_ROW), uint_to_real(row_high - row_low));
    const vreal right =
        divide(uint_to_real(across - low) + uniform(key, bounce + BOUNCE_SKY_COLUMN), uint_to_real(high - low));
    vbool upper;
    vreal more, sine, cosine;
    const vreal height = row_height(scene, row, &upper, &more);
    cell.cap = divide(splat(2) * more, splat(sky->columns));
    const vreal away = choose(upper, below, splat(1) - below); /* from the pole */
    const vreal half2 = fma(at_most(at_least(away, splat(0)), splat(1)), more, height);
    const vreal along = fma(splat(-2), half2, splat(1)), aside = splat(2) * square_root(half2 * (splat(1) - half2));
    sin_cos_turn(at_most(divide(uint_to_real(column) + right, splat(sky->columns)), splat(1)), &sine, &cosine);
    const Vec3 out = madd3(cosine * aside, splat3(sky->axes), scale3(sine * aside, splat3(sky->axes + 3)));
    const Vec3 sampled = madd3(choose(upper, -along, along), splat3(sky->axes + 6), out);
    *direction = scale3(fma(dot3(sampled, sampled), splat(R(-0.5)), splat(R(1.5))), sampled);
    return cell;
}
#endif
#endif
