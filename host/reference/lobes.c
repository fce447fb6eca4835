/* lobes.c: lobes whose value for two directions is computed by definition, and that are drawn by rejection;
 * see trace.h. */
#include "trace.h"

#define PI 3.14159265358979323846

static Vec reflect(Vec direction, Vec normal) {
    return sub(direction, scale(2 * dot(direction, normal), normal));
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
