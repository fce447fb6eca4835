/* roulette.cl: ends most of the paths that carry little, by chance, so that the few that go on stand for them: Russian roulette.
 *
 * In:    paths that are about to go on by a segment.   Out: the same; some have ended, and those that go on carry more.
 * Knows: path.cl, ROULETTE_SEGMENTS and ROULETTE_LIMIT (roulette_types.h).   Does not know: why a path carries little.
 *
 * A path goes on with a chance of what it carries over ROULETTE_LIMIT, rounded up to a multiple of 2^-24, and then carries
 * the inverse times as much. The mean stays the same, exactly, since a random number of 24 bits has such a chance; and no path
 * carries more than the limit afterwards, however little it carried, since chances are rounded up. All light of the vertex
 * that a path stands at is in its radiance by then: roulette decides about its next segment alone. */
#if EFFECT_ROULETTE
#if EFFECT_MEDIA
/* What a path carries of a colour, without the weight of its flights, which may rise again. Where the colour flies so unlike the
 * path's own that this cannot be told, it counts as much. */
static vreal without_flights(vreal throughput, vreal likelihood) {
    const vbool told = likelihood > splat(R(1e-30));
    return choose(throughput > splat(0), choose(told, divide(throughput, choose(told, likelihood, splat(1))), splat(1)), splat(0));
}

static vreal most_carried(const Path *path) {
    const Vec3 carried = path->throughput, likelihood = path->likelihood;
    return at_least(at_least(without_flights(carried.x, likelihood.x), without_flights(carried.y, likelihood.y)),
                    without_flights(carried.z, likelihood.z));
}
#else
/* Of a colour. */
static vreal most_carried(const Path *path) {
    return at_least(at_least(path->throughput.x, path->throughput.y), path->throughput.z);
}
#endif

/* The chance of a path to go on, in steps of 2^-24, where it is `played` for; else all of them. */
static vuint roulette_chance(const Path *path, vbool *played) {
    const vreal most = most_carried(path);
    *played = *played & (most < splat(ROULETTE_LIMIT));
    return choose_uint(*played, to_uint(choose(*played, most, splat(0)) * (R(0x1p24) / ROULETTE_LIMIT)) + 1u,
                       splat_uint(0x1000000u));
}

/* Those that are about to go on, and may end instead. */
static vbool is_deep(const Path *path) {
    return path_moves(path) & vbool_of_uint(path->depth >= splat_uint(ROULETTE_SEGMENTS));
}

static void play_roulette(Path *path) {
    vbool played = is_deep(path);
    if (!any_lane(played)) return;
    const vuint chance = roulette_chance(path, &played);
    if (!any_lane(played)) return;
    const vuint number = random_bits(path->key, first_dimension(path->depth - 1u) + BOUNCE_ROULETTE) >> 8;
    const vbool ends = vbool_of_uint(number >= chance);
    path->throughput = choose3(played, scale3(divide(splat(R(0x1p24)), uint_to_real(chance)), path->throughput),
                               path->throughput);
    path->alive = path->alive & vbool_not(ends);
}
#else
#define play_roulette(path)
#endif
