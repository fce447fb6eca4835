/* lobes.c: lobes whose value for two directions is computed by definition, and that are drawn by rejection;
 * see trace.h. */
#include "trace.h"

#define PI 3.14159265358979323846

static Vec reflect(Vec direction, Vec normal) {
    return sub(direction, scale(2 * dot(direction, normal), normal));
}

double bp_ref_schlick(double cosine, double ratio) {
    const double root = (1 - ratio) / (1 + ratio), r0 = root * root;
    return r0 + (1 - r0) * pow(1 - cosine, 5);
}

double bp_ref_fresnel(double cosine, double ratio) {
    if (ratio == 1) return 0;
    const double sine2_beyond = ratio * ratio * (1 - cosine) * (1 + cosine);
    if (sine2_beyond >= 1) return 1;
    const double cosine_beyond = sqrt(1 - sine2_beyond);
    const double perpendicular = (ratio * cosine - cosine_beyond) / (ratio * cosine + cosine_beyond);
    const double parallel = (cosine - ratio * cosine_beyond) / (cosine + ratio * cosine_beyond);
    return 0.5 * (perpendicular * perpendicular + parallel * parallel);
}

static double upright(double roughness) {
    return 1 / (1 + (0.5 - 2 / (3 * PI)) * roughness);
}

static double mean_once(double roughness) {
    return upright(roughness) * (1 + roughness * (2.0 / 3 - 28 / (15 * PI)));
}

double bp_ref_oren_nayar_share(double roughness, double cosine) {
    const double a = upright(roughness), b = roughness * a;
    const double angle = acos(fmin(cosine, 1)), sine = sin(angle);
    const double beyond = cosine > 1e-9 ? tan(angle) * (1 - sine * sine * sine) : 0;
    return a + b / PI * (sine * (angle - sine * cosine) + 2.0 / 3 * (beyond - sine));
}

double bp_ref_oren_nayar_once(double roughness, Vec normal, Vec out, Vec in) {
    const double cos_out = dot(out, normal), cos_in = dot(in, normal), s = dot(out, in) - cos_out * cos_in;
    if (cos_out <= 0 || cos_in <= 0) return 0;
    return upright(roughness) / PI * (1 + roughness * (s > 0 ? s / fmax(cos_out, cos_in) : s));
}

double bp_ref_oren_nayar_again(double roughness, Vec normal, Vec out, Vec in) {
    const double cos_out = dot(out, normal), cos_in = dot(in, normal), mean = mean_once(roughness);
    if (cos_out <= 0 || cos_in <= 0 || mean >= 1) return 0;
    return fmax(0, 1 - bp_ref_oren_nayar_share(roughness, cos_out)) *
           fmax(0, 1 - bp_ref_oren_nayar_share(roughness, cos_in)) / (PI * (1 - mean));
}

double bp_ref_oren_nayar_colour(double roughness, double albedo) {
    const double mean = mean_once(roughness);
    return albedo * albedo * mean / (1 - albedo * (1 - mean));
}

/* Which part, by its share of the light; then a direction that is uniform over the hemisphere is taken with a
 * probability proportional to the part's value times the cosine. The value of the first times the cosine is
 * (1 + roughness) upright / pi at most; that of the second over the cosine is largest upright. */
Vec bp_ref_scatter_oren_nayar(double roughness, Vec albedo, Vec normal, Vec incoming, Random *random,
                              Vec *direction) {
    const Vec out = scale(-1, incoming);
    const bool again = random_real(random) >= bp_ref_oren_nayar_share(roughness, dot(out, normal));
    for (;;) {
        const Vec p = random_on_sphere(random);
        const Vec in = dot(p, normal) > 0 ? p : scale(-1, p);
        const double cosine = dot(in, normal);
        double share;
        if (again)
            share = cosine * (1 - bp_ref_oren_nayar_share(roughness, cosine)) / (1 - upright(roughness));
        else
            share = cosine * bp_ref_oren_nayar_once(roughness, normal, out, in) * PI / upright(roughness) /
                    (1 + roughness);
        *direction = in;
        if (random_real(random) < share) break;
    }
    if (!again) return albedo;
    return (Vec){bp_ref_oren_nayar_colour(roughness, albedo.x), bp_ref_oren_nayar_colour(roughness, albedo.y),
                 bp_ref_oren_nayar_colour(roughness, albedo.z)};
}

/* Lambda of Smith's shadowing for GGX. */
static double hidden(double alpha, double cosine) {
    const double tangent2 = (1 - cosine * cosine) / (cosine * cosine);
    return 0.5 * (sqrt(1 + alpha * alpha * tangent2) - 1);
}

double bp_ref_rough_metal(double roughness, Vec normal, Vec out, Vec in) {
    const double cos_out = dot(out, normal), cos_in = dot(in, normal), alpha = roughness * roughness;
    if (cos_out <= 0 || cos_in <= 0) return 0;
    const double cos_h = dot(unit(add(out, in)), normal), cos2 = cos_h * cos_h;
    const double tangent2 = (1 - cos2) / cos2, spread = alpha * (1 + tangent2 / (alpha * alpha));
    const double d = 1 / (PI * spread * spread * cos2 * cos2);
    return d / (1 + hidden(alpha, cos_out) + hidden(alpha, cos_in)) / (4 * cos_out * cos_in);
}

/* The facets that are seen from `out` face as an ellipsoid does, with the half axis alpha along the normal
 * and 1 across, where a beam from there meets its upper half (Walter et al., "The Ellipsoid Normal
 * Distribution Function", 2015): so a ray of such a beam is shot at one, until it meets the upper half. The
 * beam is as wide as the ellipsoid. */
bool bp_ref_scatter_rough_metal(double roughness, Vec normal, Vec incoming, Random *random, Vec *direction,
                                Vec *weight) {
    const double alpha = roughness * roughness, cosine = fmax(-dot(incoming, normal), 1e-12);
    const Vec flat = cross(normal, fabs(normal.x) < 0.5 ? (Vec){1, 0, 0} : (Vec){0, 1, 0});
    Vec aside = cross(incoming, normal);
    aside = length2(aside) > 1e-20 ? unit(aside) : unit(flat);
    const Vec upward = cross(aside, incoming); /* across the beam */
    const double sine2 = fmax(0, 1 - cosine * cosine), height = sqrt(cosine * cosine + alpha * alpha * sine2);
    double up;
    Vec facet;
    do {
        const Vec p = random_in_disk(random);
        const Vec from = add(scale(p.x, aside), scale(p.y * height, upward));
        /* |from + t incoming|^2 = 1 where heights count 1 / alpha times */
        const double stretch = 1 / (alpha * alpha) - 1;
        const double h = dot(from, normal), k = dot(incoming, normal);
        const double a = 1 + stretch * k * k, b = stretch * h * k, c = length2(from) + stretch * h * h - 1;
        const double t = (-b - sqrt(fmax(0, b * b - a * c))) / a;
        const Vec point = add(from, scale(t, incoming));
        up = dot(point, normal);
        facet = unit(add(point, scale(stretch * up, normal)));
    } while (up <= 0);
    *direction = reflect(incoming, facet);
    const double cos_in = dot(*direction, normal);
    if (cos_in <= 0) return false;
    *weight =
        scale((1 + hidden(alpha, cosine)) / (1 + hidden(alpha, cosine) + hidden(alpha, cos_in)), *weight);
    return true;
}

/* The share of light by Lambert's law that a clear body of this index reflects outside: the closed form of J.
 * Walsh (1926), which S. Duntley gave in this form. */
double bp_ref_coat_reflects(double index) {
    if (index - 1 < 1e-4) return 0; /* below 1e-4, and the terms cancel */
    const double n = index, n2 = n * n, n4 = n2 * n2;
    return 0.5 + (n - 1) * (3 * n + 1) / (6 * (n + 1) * (n + 1)) +
           n2 * (n2 - 1) * (n2 - 1) / pow(n2 + 1, 3) * log((n - 1) / (n + 1)) -
           2 * n * n2 * (n2 + 2 * n - 1) / ((n2 + 1) * (n4 - 1)) +
           8 * n4 * (n4 + 1) / ((n2 + 1) * (n4 - 1) * (n4 - 1)) * log(n);
}

/* What a coat reflects: as a facet does, but no more than a smooth coat at either direction's angle. */
static double coat_share(double index, Vec normal, Vec out, Vec in) {
    const double cos_h = fmin(dot(unit(add(out, in)), out), 1);
    return fmin(bp_ref_fresnel(cos_h, 1 / index), fmin(bp_ref_fresnel(fmin(dot(out, normal), 1), 1 / index),
                                                       bp_ref_fresnel(fmin(dot(in, normal), 1), 1 / index)));
}

double bp_ref_glossy_coat(double roughness, double index, Vec normal, Vec out, Vec in) {
    if (dot(out, normal) <= 0 || dot(in, normal) <= 0) return 0;
    return bp_ref_rough_metal(roughness, normal, out, in) * coat_share(index, normal, out, in);
}

/* Of what enters, Lambert's surface sends up `albedo`, of which the coat sends back `back`, of which the
 * surface sends up `albedo`, and so on; what leaves is spread over n^2 times the solid angle. */
double bp_ref_glossy_base(double albedo, double index, Vec normal, Vec out, Vec in) {
    const double cos_out = dot(out, normal), cos_in = dot(in, normal), n2 = index * index;
    if (cos_out <= 0 || cos_in <= 0) return 0;
    const double back = 1 - (1 - bp_ref_coat_reflects(index)) / n2;
    return (1 - bp_ref_fresnel(fmin(cos_in, 1), 1 / index)) *
           (1 - bp_ref_fresnel(fmin(cos_out, 1), 1 / index)) * albedo / (1 - albedo * back) / (PI * n2);
}

/* The part by chance; the coat's direction as metal's, the base's from an even hemisphere by rejection. */
bool bp_ref_scatter_glossy(double roughness, double index, Vec albedo, Vec normal, Vec incoming,
                           Random *random, Vec *direction, Vec *weight) {
    const Vec out = scale(-1, incoming);
    const double reflected = bp_ref_fresnel(fmin(fmax(dot(out, normal), 0), 1), 1 / index);
    if (random_real(random) < reflected) {
        *weight = (Vec){1, 1, 1};
        if (roughness == 0) {
            *direction = reflect(incoming, normal);
            return true;
        }
        if (!bp_ref_scatter_rough_metal(roughness, normal, incoming, random, direction, weight)) return false;
        *weight = scale(coat_share(index, normal, out, *direction) / reflected, *weight);
        return true;
    }
    double cosine;
    do {
        const Vec p = random_on_sphere(random);
        *direction = dot(p, normal) > 0 ? p : scale(-1, p);
        cosine = fmin(dot(*direction, normal), 1);
    } while (random_real(random) >= cosine * (1 - bp_ref_fresnel(cosine, 1 / index)));
    const double out_of = (1 - bp_ref_coat_reflects(index)) / (index * index), back = 1 - out_of;
    *weight = (Vec){albedo.x * out_of / (1 - albedo.x * back), albedo.y * out_of / (1 - albedo.y * back),
                    albedo.z * out_of / (1 - albedo.z * back)};
    return true;
}

/* Which facet leads light from `in` to `out`, on the normal's side; the square of the length of what lies
 * along it. */
static Vec facet_between(double ratio, Vec normal, Vec out, Vec in, double *length2_of) {
    const Vec both = dot(in, normal) > 0 ? add(out, in) : add(scale(ratio, out), in);
    *length2_of = length2(both);
    return unit(dot(both, normal) < 0 ? scale(-1, both) : both);
}

double bp_ref_rough_dielectric(double roughness, double ratio, Vec normal, Vec out, Vec in) {
    const double cos_out = dot(out, normal), cos_in = fabs(dot(in, normal)), alpha = roughness * roughness;
    if (cos_out <= 0 || cos_in <= 0) return 0;
    double both2;
    const Vec facet = facet_between(ratio, normal, out, in, &both2);
    const double from = dot(out, facet), to = dot(in, facet),
                 reflected = bp_ref_fresnel(fmin(from, 1), ratio);
    if (dot(in, normal) > 0) return bp_ref_rough_metal(roughness, normal, out, in) * reflected;
    if (from <= 0 || to >= 0) return 0;
    const double cos_h = dot(facet, normal), cos2 = cos_h * cos_h;
    const double tangent2 = (1 - cos2) / cos2, spread = alpha * (1 + tangent2 / (alpha * alpha));
    const double d = 1 / (PI * spread * spread * cos2 * cos2);
    const double seen = 1 / (1 + hidden(alpha, cos_out)) / (1 + hidden(alpha, cos_in));
    /* Equation 21 has the square of the index on the side of `out`, which is that of `in` for radiance over
     * it. */
    return from * -to / (cos_out * cos_in) * (1 - reflected) * seen * d / both2;
}

/* Where a distribution that rises by z + sin z cos z from -pi / 2 to pi / 2 has reached the share u: Newton's
 * method, kept between bounds. */
static double invert_slope(double u) {
    double low = -PI / 2, high = PI / 2, z = 0, step = 1;
    while (fabs(step) > 1e-14 && high - low > 1e-14) {
        const double excess = (z + sin(z) * cos(z)) / PI + 0.5 - u;
        if (excess > 0) high = z;
        if (excess <= 0) low = z;
        const double next = z - excess * PI / (2 * cos(z) * cos(z) + 1e-300);
        step = (next > low && next < high ? next : 0.5 * (low + high)) - z;
        z += step;
    }
    return z;
}

/* A facet that is seen from `out`, by its slopes along that direction and across it: stretched by 1 / alpha,
 * all are those of alpha 1, of which the one along has a distribution of sines and the other one that is
 * inverted numerically (Heitz and d'Eon, "Importance Sampling Microfacet-Based BSDFs using the Distribution
 * of Visible Normals", 2014, have a fit of it). */
static Vec facet_by_slopes(double alpha, Vec normal, Vec out, Random *random) {
    const double cosine = fmax(dot(out, normal), 1e-12);
    Vec along = sub(out, scale(cosine, normal));
    if (length2(along) < 1e-24) along = cross(normal, fabs(normal.x) < 0.5 ? (Vec){1, 0, 0} : (Vec){0, 1, 0});
    along = unit(along);
    const Vec aside = cross(normal, along);
    const double angle = atan2(alpha * sqrt(fmax(0, 1 - cosine * cosine)), cosine);
    const double u = random_real(random), v = random_real(random);
    const double slope_along = tan(asin(fmax(-1, u * (1 + cos(angle)) - cos(angle))) - angle);
    const double slope_aside = sqrt(1 + slope_along * slope_along) * tan(invert_slope(v));
    return unit(sub(normal, add(scale(alpha * slope_along, along), scale(alpha * slope_aside, aside))));
}

bool bp_ref_scatter_rough_dielectric(double roughness, double ratio, Vec normal, Vec incoming, Random *random,
                                     Vec *direction, Vec *weight) {
    if (ratio == 1) { /* as of smooth glass: there is no surface */
        *direction = incoming;
        return true;
    }
    const double alpha = roughness * roughness;
    const Vec facet = facet_by_slopes(alpha, normal, scale(-1, incoming), random);
    const double cosine = fmin(-dot(incoming, facet), 1), cos_out = fmax(-dot(incoming, normal), 1e-12);
    const bool reflects = random_real(random) < bp_ref_fresnel(cosine, ratio);
    if (reflects) {
        *direction = reflect(incoming, facet);
    } else {
        const Vec along = scale(ratio, add(incoming, scale(cosine, facet)));
        *direction = add(along, scale(-sqrt(fmax(0, 1 - length2(along))), facet));
    }
    const double cos_in = dot(*direction, normal), shadow = 1 + hidden(alpha, fabs(cos_in));
    if (reflects != (cos_in > 0)) return false;
    *weight = scale(reflects ? (1 + hidden(alpha, cos_out)) / (hidden(alpha, cos_out) + shadow) : 1 / shadow,
                    *weight);
    return true;
}
