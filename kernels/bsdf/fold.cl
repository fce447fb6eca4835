/* fold.cl: what a lobe sends to the wrong side of a smooth triangle goes to the right one.
 *
 * In:    surfaces, lobes, directions, as scatter.cl has them.   Out: samples, densities and weights that know the true surface.
 * Knows: scatter.cl.   Does not know: where a smooth triangle's normal comes from (integrator/smooth_surface.cl), how lobes draw.
 *
 * A lobe stands about the normal that a triangle shows, so a part of it lies below the true surface, and of what glass lets through a
 * part above. Such a direction w is mirrored at the surface: w - 2 (w.n) n. So nothing is lost, what a sample weighs stays the
 * lobe's own weight, and a direction on the right side has the density p(w) + p(w - 2 (w.n) n), with the mean of both weights by these. */
#if SMOOTH_TRIANGLES
/* A direction that is mirrored ends at least as far off the surface as rounding might move it. */
#define FOLDED_MIN (R(16.0) * ROUNDOFF)

static BsdfSample scatter_folded(const Surface *surface, SampleKey key, vuint bounce) {
    BsdfSample sample = scatter(surface, key, bounce);
    const Vec3 n = surface->true_normal;
    const vreal side = choose(sample.transmitted, splat(-1), splat(1));
    const vreal height = side * dot3(sample.direction, n);
    const vbool wrong = is_smooth(n) & (height < splat(FOLDED_MIN));
    if (!any_lane(wrong)) return sample;
    const vreal lift = at_least(-height, splat(FOLDED_MIN)) - height;
    sample.direction = choose3(wrong, normalise3(madd3(side * lift, n, sample.direction)), sample.direction);
    return sample;
}

#if SAMPLES_LAMPS
/* Both directions that become one, and the density of each. */
typedef struct Fold {
    Vec3 beyond; /* the other one */
    vreal here, there;
} Fold;

/* What a lobe has of a direction that lies below the surface, or above it: glass both, other lobes nothing below. */
static vreal density_of_side(const Lobe *lobe, Vec3 direction, vbool below, vreal density) {
#if EFFECT_ROUGH_DIELECTRIC
    const vbool glass = is_rough_dielectric(lobe), lies_below = dot3(direction, lobe->axis) < splat(0);
    const vbool other_side = (below & vbool_not(lies_below)) | (lies_below & vbool_not(below));
    return choose((glass & other_side) | (vbool_not(glass) & below), splat(0), density);
#else
    return choose(below, splat(0), density);
#endif
}

static Fold fold_of(const Lobe *lobe, Vec3 direction, vbool smooth, int drawn) {
    Fold fold;
    fold.here = scatter_pdf(lobe, direction, drawn);
    fold.there = splat(0);
    fold.beyond = direction;
    if (!any_lane(smooth)) return fold;
    const vreal height = dot3(direction, lobe->true_normal);
    const vbool below = height < splat(0);
    fold.beyond = choose3(smooth, madd3(splat(-2) * height, lobe->true_normal, direction), direction);
    /* The nearer one is that which metal's cone holds, if it has drawn either (metal.cl). */
    const vreal there = density_of_side(lobe, fold.beyond, below, scatter_pdf(lobe, fold.beyond, 0));
    fold.here = choose(smooth, density_of_side(lobe, direction, below, fold.here), fold.here);
    fold.there = choose(smooth & vbool_not(height == splat(0)), there, splat(0));
    return fold;
}

/* As scatter_pdf. */
static vreal folded_pdf(const Lobe *lobe, Vec3 direction, int drawn) {
    const Fold fold = fold_of(lobe, direction, is_smooth(lobe->true_normal), drawn);
    return fold.here + fold.there;
}

#if WEIGHTED_LOBES
/* As scatter_weight. */
static Vec3 folded_weight(const Lobe *lobe, Vec3 direction) {
    const Vec3 weight = scatter_weight(lobe, direction);
    const vbool smooth = is_smooth(lobe->true_normal);
    if (!any_lane(smooth)) return weight;
    const Fold fold = fold_of(lobe, direction, smooth, 0);
    const vreal both = fold.here + fold.there;
    const vbool mixed = smooth & (both > splat(0));
    const vreal share = divide(fold.there, choose(mixed, both, splat(1)));
    const Vec3 other = scatter_weight(lobe, fold.beyond);
    return choose3(mixed, add3(scale3(splat(1) - share, weight), scale3(share, other)), weight);
}
#endif
#endif
#else
#define scatter_folded scatter
#define folded_pdf scatter_pdf
#define folded_weight scatter_weight
#endif
