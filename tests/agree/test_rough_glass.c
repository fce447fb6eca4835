/* test_rough_glass.c: the lobe of rough glass, which has both sides of a surface: what the kernel draws
 * against its own density, and both against the definition of Walter et al. in the reference, which draws by
 * another method; light is the same both ways; what is lost, by integration; closed forms where facets are
 * few or lie flat; the ends of parameters. */
#include "packed/pack.h"
#include "reference/trace.h"
#include "support/probe.h"
#include "support/uniformity.h"

#include <stdio.h>
#include <string.h>

/* Cells are equal in azimuth, and on each side in the root of 1 - cosine, so that lobes around the normal
 * fill several. */
enum { COUNT = 1000000, SIDE = 10, FINE = 20, HIGH = 2 * SIDE, GRID = SIDE * FINE, PAIRS = 200000, ROW = 8 };
enum { CELLS = HIGH * SIDE, POINTS = 2 * GRID * GRID };
static float drawn[COUNT * ROW];
#define PI 3.14159265358979323846
#define LEVEL 1e-5
static const Vec normal = {0.36, 0.48, 0.8}, tangent = {0.8, -0.6, 0}, side = {0.48, 0.64, -0.6};

/* A surface of roughness (which & 255) / 200, seen at the cosine ((which >> 8) & 255) / 250, of the index
 * ((which >> 16) & 1023) / 100 inside, seen from inside where bit 30 is set. */
static const char probe_text[] =
    "static SampleKey probe_key(uint seed, uint i) { return sample_key(seed, 5u, i & 0xfffu, i >> 12, 4u); "
    "}\n"
    "static Vec3 probe_direction(real x, real y, real z) {\n"
    "    const Vec3 n = vec3(0.36f, 0.48f, 0.8f), t = vec3(0.8f, -0.6f, 0), b = vec3(0.48f, 0.64f, -0.6f);\n"
    "    return normalise3(madd3(x, t, madd3(y, b, scale3(z, n))));\n"
    "}\n"
    "static Surface probe_surface(uint which) {\n"
    "    const real c = fmin(((which >> 8) & 255u) / 250.0f, 1.0f);\n"
    "    Surface surface;\n"
    "    surface.normal = probe_direction(0, 0, 1);\n"
    "    surface.incoming = scale3(splat(-1), probe_direction(sqrt((1 - c) * (1 + c)), 0, c));\n"
    "    surface.enters = (which >> 30) == 0u ? vbool_all : vbool_none;\n"
    "    surface.albedo = vec3(1, 1, 1);\n"
    "    surface.roughness = (which & 255u) / 200.0f;\n"
    "    surface.fuzz = surface.lets_in = 0;\n"
    "    surface.refraction_index = ((which >> 16) & 1023u) / 100.0f;\n"
    "    surface.variant = surface.total_reflection = surface.lobe = 0;\n"
    "    surface.kind = KIND_ROUGH_DIELECTRIC;\n"
    "    return surface;\n"
    "}\n"
    "__kernel void draw(uint seed, uint which, __global float *out) {\n"
    "    const uint i = get_global_id(0);\n"
    "    const Surface surface = probe_surface(which);\n"
    "    const BsdfSample s = scatter(&surface, probe_key(seed, i), splat_uint(DIMENSION_BOUNCE));\n"
    "    vstore8((float8)(s.direction.x, s.direction.y, s.direction.z, s.weight.x, s.weight.y,\n"
    "                     s.transmitted ? 1 : 0, s.lobe.kind == (uint)LOBE_ROUGH_DIELECTRIC ? 1 : 0,\n"
    "                     s.scattered ? scatter_pdf(&s.lobe, s.direction, 1) : -1), i, out);\n"
    "}\n"
    /* the density on a grid of cosines and angles */
    "__kernel void grid(uint unused, uint which, __global float *out) {\n"
    "    const uint i = get_global_id(0), side = 200u;\n"
    "    const Surface surface = probe_surface(which);\n"
    "    const BsdfSample s = scatter(&surface, probe_key(1u, 1u), splat_uint(DIMENSION_BOUNCE));\n"
    "    const real step = (i % side) * 0.618034f; /* staggered: the value ends where facets are upright, "
    "all around at one height */\n"
    "    const real v = (i / side + step - floor(step)) / side - 1, a = 1 - fabs(v), turn = (i % side + "
    "0.5f) / side;\n"
    "    real sine, cosine;\n"
    "    sin_cos_turn(turn, &sine, &cosine);\n"
    "    const real r = a * sqrt(2 - a * a), z = v < 0 ? a * a - 1 : 1 - a * a;\n"
    "    const Vec3 d = probe_direction(r * cosine, r * sine, z);\n"
    "    vstore8((float8)(d.x, d.y, d.z, 0, 0, 0, a, scatter_pdf(&s.lobe, d, 0)), i, out);\n"
    "}\n"
    /* for two random directions, the second on either side: both, and the density times the weight, there and
       back */
    "__kernel void both(uint seed, uint which, __global float *out) {\n"
    "    const uint i = get_global_id(0);\n"
    "    const SampleKey key = probe_key(seed, i);\n"
    "    Vec3 d[2];\n"
    "    for (uint k = 0; k < 2; ++k) {\n"
    "        const real u = uniform(key, 2 * k), z = (i & (1u + k)) != 0 ? u * u : u;\n"
    "        real sine, cosine;\n"
    "        sin_cos_turn(uniform(key, 2 * k + 1), &sine, &cosine);\n"
    "        d[k] = probe_direction(sqrt((1 - z) * (1 + z)) * cosine, sqrt((1 - z) * (1 + z)) * sine,\n"
    "                               k == 1u && (i & 4u) != 0 ? -z : z);\n"
    "    }\n"
    "    Surface surface = probe_surface(which);\n"
    "    surface.incoming = scale3(splat(-1), d[0]);\n"
    "    Lobe lobe = scatter(&surface, key, splat_uint(DIMENSION_BOUNCE)).lobe;\n"
    "    const real there = scatter_pdf(&lobe, d[1], 0) * scatter_weight(&lobe, d[1]).y;\n"
    "    if ((i & 4u) != 0) {\n"
    "        surface.enters = surface.enters ? vbool_none : vbool_all;\n"
    "        surface.normal = scale3(splat(-1), surface.normal);\n"
    "    }\n"
    "    surface.incoming = scale3(splat(-1), d[1]);\n"
    "    lobe = scatter(&surface, key, splat_uint(DIMENSION_BOUNCE)).lobe;\n"
    "    const real back = scatter_pdf(&lobe, d[0], 0) * scatter_weight(&lobe, d[0]).y;\n"
    "    vstore8((float8)(d[0].x, d[0].y, d[0].z, d[1].x, d[1].y, d[1].z, there, back), i, out);\n"
    "}\n";

typedef struct GlassCase {
    cl_uint roughness, cosine, index, inside; /* as probe_surface has them */
} GlassCase;

static const GlassCase cases[] = {
    {80, 240, 150, 0}, {80, 240, 150, 1}, {100, 125, 150, 0}, {100, 125, 150, 1},
    {150, 50, 150, 0}, {150, 50, 150, 1}, {200, 250, 300, 0}, {200, 100, 300, 1},
    {120, 150, 50, 0}, {160, 60, 70, 1},  {200, 100, 120, 0}, {60, 200, 200, 1},
};

static cl_uint which_of(const GlassCase *glass) {
    return glass->inside << 30 | glass->index << 16 | glass->cosine << 8 | glass->roughness;
}
static double roughness_of(const GlassCase *glass) {
    return (double)((float)glass->roughness / 200.0f);
}
/* The index on the side of the normal over that of the other. */
static double ratio_of(const GlassCase *glass) {
    return glass->inside ? glass->index / 100.0 : 100.0 / glass->index;
}
static Vec out_at(double cosine) {
    return add(scale(sqrt(fmax(0, 1 - cosine * cosine)), tangent), scale(cosine, normal));
}
static double cosine_of(const GlassCase *glass) {
    return fmin(glass->cosine / 250.0, 1);
}
static void describe(const GlassCase *glass) {
    printf("roughness %.3f, cosine %.3f, index %.2f from %s: ", roughness_of(glass), cosine_of(glass),
           glass->index / 100.0, glass->inside ? "inside " : "outside");
}
static Vec row_direction(const float *row) {
    return (Vec){(double)row[0], (double)row[1], (double)row[2]};
}
/* At a height from -1 to 1; the solid angle of a part of both is 4 pi s of it. */
static Vec grid_direction(double height, double fraction, double *s) {
    *s = 1 - fabs(height);
    const double r = *s * sqrt(2 - *s * *s), angle = 2 * PI * fraction, z = copysign(1 - *s * *s, height);
    return add(scale(r * cos(angle), tangent), add(scale(r * sin(angle), side), scale(z, normal)));
}
static size_t cell_of(Vec d) {
    const double z = fmin(fmax(dot(d, normal), -1), 1), height = copysign(1 - sqrt(1 - fabs(z)), z);
    const double angle = turn(dot(d, side), dot(d, tangent));
    return (size_t)(fmin(height + 1, 2 - 1e-12) * SIDE) * SIDE + (size_t)(fmin(angle, 1 - 1e-12) * SIDE);
}

/* The value by definition, from above, times the cosine. */
static double value(const GlassCase *glass, Vec in) {
    return bp_ref_rough_dielectric(roughness_of(glass), ratio_of(glass), normal, out_at(cosine_of(glass)),
                                   in) *
           fabs(dot(in, normal));
}

/* Light by cell, of what is drawn, against the integral of the value times the cosine. */
typedef struct Tally {
    double sum[CELLS], square[CELLS], all, all_square;
    size_t count;
} Tally;
static void tally_add(Tally *tally, Vec direction, double weight) {
    const size_t cell = cell_of(direction);
    tally->sum[cell] += weight;
    tally->square[cell] += weight * weight;
    tally->all += weight;
    tally->all_square += weight * weight;
}
static double tally_worst(const Tally *tally, const double due[CELLS]) {
    double worst = 0;
    for (size_t cell = 0; cell < CELLS; ++cell) {
        const double n = (double)tally->count, mean = tally->sum[cell] / n;
        double variance = tally->square[cell] / n - mean * mean;
        if (n * due[cell] < 50)
            variance = fmax(variance, due[cell]); /* few may have come: of weights up to 1, at most this */
        const double error = sqrt(fmax(variance, 1e-12) / n);
        worst = fmax(worst, fabs(mean - due[cell]) / (error + 5e-4 * due[cell]));
    }
    return worst;
}

static void tally_kernel(const Probe *probe, const GlassCase *glass, cl_uint seed, size_t count,
                         Tally *tally) {
    *tally = (Tally){.count = count};
    probe_run(probe, "draw", seed, which_of(glass), count, drawn, count * ROW * sizeof *drawn);
    for (size_t i = 0; i < count; ++i)
        if (drawn[i * ROW + 7] >= 0)
            tally_add(tally, row_direction(&drawn[i * ROW]), (double)drawn[i * ROW + 3]);
}
static void tally_reference(const GlassCase *glass, uint32_t seed, size_t count, Tally *tally) {
    Random random = random_stream(9, seed, 0);
    *tally = (Tally){.count = count};
    for (size_t i = 0; i < tally->count; ++i) {
        Vec direction, weight = {1, 1, 1};
        if (bp_ref_scatter_rough_dielectric(roughness_of(glass), ratio_of(glass), normal,
                                            scale(-1, out_at(cosine_of(glass))), &random, &direction,
                                            &weight))
            tally_add(tally, direction, weight.x);
    }
}

static void light(void **state) {
    static Tally kernel, reference;
    for (size_t n = 0; n < sizeof cases / sizeof cases[0]; ++n) {
        const GlassCase *glass = &cases[n];
        double due[CELLS] = {0};
        enum { STEPS = 40 }; /* in each direction of a cell: the value is steep where refraction ends */
        for (size_t cell = 0; cell < CELLS; ++cell)
            for (int k = 0; k < STEPS * STEPS; ++k) {
                const double step = k % STEPS * 0.618034;
                const double x =
                    ((double)(cell / SIDE) + (k / STEPS + step - floor(step)) / STEPS) / SIDE - 1;
                const double y = ((double)(cell % SIDE) + (k % STEPS + 0.5) / STEPS) / SIDE;
                double s;
                const Vec in = grid_direction(x, y, &s);
                due[cell] += value(glass, in) * 4 * PI * s / (SIDE * STEPS * SIDE * STEPS);
            }
        tally_kernel(*state, glass, (cl_uint)(100 + n), COUNT, &kernel);
        tally_reference(glass, (uint32_t)n, 400000, &reference);
        const double worst = tally_worst(&kernel, due), of_reference = tally_worst(&reference, due);
        describe(glass);
        printf("off by %.2f standard errors at most, the reference by %.2f\n", worst, of_reference);
        assert_true(worst < 5.5 && of_reference < 5.5); /* of 24 x 200 values */
    }
}

static void densities(void **state) {
    static float grid[POINTS * ROW];
    for (size_t n = 0; n < sizeof cases / sizeof cases[0]; ++n) {
        const GlassCase *glass = &cases[n];
        double seen[CELLS + 1] = {0}, due[CELLS + 1] = {0}, rest = 1;
        probe_run(*state, "draw", 1, which_of(glass), COUNT, drawn, sizeof drawn);
        for (size_t i = 0; i < COUNT; ++i) {
            assert_true(drawn[i * ROW + 6] == 1); /* rays are sent to lamps from it */
            seen[drawn[i * ROW + 7] < 0 ? CELLS : cell_of(row_direction(&drawn[i * ROW]))] += 1;
        }
        probe_run(*state, "grid", 0, which_of(glass), POINTS, grid, sizeof grid);
        for (size_t i = 0; i < POINTS; ++i) {
            const double part =
                (double)grid[i * ROW + 7] * 4 * PI * (double)grid[i * ROW + 6] / (GRID * GRID);
            due[i / GRID / FINE * SIDE + i % GRID / FINE] += part * COUNT;
            rest -= part;
        }
        due[CELLS] = rest > 1e-3 ? rest * COUNT : 0;
        const double p = chi_square_test(seen, due, CELLS + 1, NULL);
        describe(glass);
        printf("p = %.4f, density sums up to %.5f, %.5f lost\n", p, 1 - rest, seen[CELLS] / COUNT);
        assert_true(rest > -2e-3);
        assert_true(p > LEVEL);
    }
}

/* Density times weight is the value of the definition times the cosine, and the same both ways, over the
 * square of the index. */
static void values(void **state) {
    for (size_t n = 0; n < sizeof cases / sizeof cases[0]; ++n) {
        const GlassCase *glass = &cases[n];
        double worst = 0, apart = 0;
        const double ratio2 = ratio_of(glass) * ratio_of(glass);
        size_t through = 0;
        probe_run(*state, "both", (cl_uint)n, which_of(glass), PAIRS, drawn, PAIRS * ROW * sizeof *drawn);
        for (size_t i = 0; i < PAIRS; ++i) {
            const float *row = &drawn[i * ROW];
            const Vec out = unit(row_direction(row)), in = unit(row_direction(row + 3));
            const double co = dot(out, normal), ci = fabs(dot(in, normal));
            if (co < 2e-3 || ci < 2e-3) continue; /* a float is off by 1e-7 there */
            const double due = bp_ref_rough_dielectric(roughness_of(glass), ratio_of(glass), normal, out, in);
            const double there = (double)row[6] / ci,
                         back = (double)row[7] / co / (dot(in, normal) < 0 ? ratio2 : 1);
            through += dot(in, normal) < 0 && due > 0;
            worst = fmax(worst, fabs(there - due) / (due + 0.02));
            apart = fmax(apart, fabs(there - back) / (due + 0.02));
        }
        describe(glass);
        printf("values off by %.2g, two ways by %.2g, %zu of them through the surface\n", worst, apart,
               through);
        /* Where total reflection begins, the reflectance falls by a root, and so does what a float is off by.
         */
        const double bound = ratio2 > 1 ? 5e-3 : 5e-4;
        assert_true(worst < bound && apart < 2 * bound && through > PAIRS / 50);
    }
}

/* Upright out and in: all that is known of facets is that they lie flat, so D is 1 / (pi alpha^2). */
static void upright(void **state) {
    (void)state;
    for (int r = 1; r <= 4; ++r)
        for (int k = 0; k < 4; ++k) {
            const double index = (double[]){0.5, 0.8, 1.5, 3}[k], alpha2 = pow(r / 4.0, 4);
            const double reflected = pow((index - 1) / (index + 1), 2);
            const double above = reflected / (4 * PI * alpha2);
            const double below = (1 - reflected) * index * index / ((index - 1) * (index - 1) * PI * alpha2);
            assert_true(
                fabs(bp_ref_rough_dielectric(r / 4.0, 1 / index, normal, normal, normal) / above - 1) < 1e-9);
            assert_true(
                fabs(bp_ref_rough_dielectric(r / 4.0, 1 / index, normal, normal, scale(-1, normal)) / below -
                     1) < 1e-9);
        }
}

/* What is left of light in all, by the definition, summed over the facets of a plane of slopes: each reflects
 * a share and refracts the rest, and the other side hides some of either; so no solid angle of directions
 * comes into it. */
static double left_by_facets(double roughness, double ratio, double cosine) {
    enum { STEPS = 400 };
    const double alpha = roughness * roughness;
    const Vec out = out_at(cosine);
    double left = 0, seen = 0;
    for (int i = 0; i < STEPS; ++i) {
        const double tilt = 0.5 * PI * (i + 0.5) / STEPS,
                     slope = alpha * tan(tilt); /* of GGX: sin^2(tilt) is even */
        for (int k = 0; k < STEPS / 2; ++k) {
            const double azimuth = 2 * PI * (k + 0.5) / (STEPS / 2);
            const Vec facet = unit(
                add(normal, add(scale(slope * cos(azimuth), tangent), scale(slope * sin(azimuth), side))));
            const double c = dot(out, facet);
            if (c <= 0) continue;
            const double part = sin(2 * tilt) * c / dot(facet, normal);
            const double f = bp_ref_fresnel(fmin(c, 1), ratio);
            const Vec mirrored = sub(scale(2 * c, facet), out);
            const Vec along = scale(ratio, sub(scale(c, facet), out));
            const Vec bent = sub(along, scale(sqrt(fmax(0, 1 - length2(along))), facet));
            const double up = dot(mirrored, normal), down = -dot(bent, normal);
            const double q0 = sqrt(cosine * cosine + alpha * alpha * (1 - cosine * cosine));
            seen += part;
            if (up > 0) {
                const double q = sqrt(up * up + alpha * alpha * (1 - up * up));
                left += part * f * (cosine + q0) * up / (cosine * q + up * q0);
            }
            if (down > 0 && f < 1)
                left += part * (1 - f) * 2 * down /
                        (down + sqrt(down * down + alpha * alpha * (1 - down * down)));
        }
    }
    return left / seen;
}

/* What a white furnace gets back. The figures of docs/MATERIALS.md are those of index 1.5. */
static void losses(void **state) {
    static const cl_uint indices[] = {50, 150, 300}, roughness[] = {0, 40, 80, 120, 160, 200},
                         cosine[] = {250, 125, 25};
    static Tally kernel, reference;
    for (size_t n = 0; n < 6 * 3 * 3 * 2; ++n) {
        const GlassCase glass = {roughness[n % 6], cosine[n / 6 % 3], indices[n / 18 % 3], (cl_uint)(n / 54)};
        tally_kernel(*state, &glass, (cl_uint)n, COUNT / 4, &kernel);
        tally_reference(&glass, (uint32_t)n, 50000, &reference);
        const double left = kernel.all / (COUNT / 4), of_reference = reference.all / (double)reference.count;
        const double square = kernel.all_square / (COUNT / 4) - left * left,
                     error = sqrt(fmax(square, 0) / (COUNT / 4));
        const double due = glass.roughness == 0
                               ? 1
                               : left_by_facets(roughness_of(&glass), ratio_of(&glass), cosine_of(&glass));
        describe(&glass);
        printf("leaves %.4f, by the reference %.4f, by integration %.4f\n", left, of_reference, due);
        assert_true(fabs(left - due) < 5 * error + 3e-4);
        if (glass.roughness > 0) assert_true(fabs(of_reference - due) < 10 * error + 3e-4);
        assert_true(left < 1 + 1e-6);
    }
}

/* Equal indices: light passes as it is; nearly flat facets reflect as a smooth surface does. */
static void limits(void **state) {
    for (cl_uint k = 0; k < 5; ++k) {
        const cl_uint cosine = (cl_uint[]){250, 200, 125, 60, 25}[k];
        for (cl_uint inside = 0; inside < 2; ++inside) {
            const GlassCase matched = {150, cosine, 100, inside}, flat = {4, cosine, 150, inside};
            probe_run(*state, "draw", 3, which_of(&matched), COUNT, drawn, sizeof drawn);
            for (size_t i = 0; i < COUNT; ++i) {
                const float *row = &drawn[i * ROW];
                assert_true(length2(add(row_direction(row), out_at(cosine_of(&matched)))) < 1e-12);
                assert_true(row[3] == 1 && row[5] == 1 && row[6] == 0 && row[7] >= 0);
            }
            double reflected = 0;
            const double due = bp_ref_fresnel(cosine_of(&flat), ratio_of(&flat));
            probe_run(*state, "draw", 4, which_of(&flat), COUNT, drawn, sizeof drawn);
            for (size_t i = 0; i < COUNT; ++i) reflected += drawn[i * ROW + 5] == 0 ? 1.0 / COUNT : 0;
            describe(&flat);
            printf("reflects %.5f of %.5f\n", reflected, due);
            assert_true(fabs(reflected - due) <= 4.5 * sqrt(due * (1 - due) / COUNT) + 2e-4);
        }
    }
}

/* Upright, grazing, smooth and rough: unit vectors on the side that the sample names, finite densities,
 * weights of 1 at most. */
static void ends(void **state) {
    static const cl_uint roughness[] = {0, 1, 13, 100, 200}, cosine[] = {0, 1, 125, 249, 250},
                         indices[] = {10, 50, 99, 101, 107, 150, 1000};
    for (size_t n = 0; n < 5 * 5 * 7 * 2; ++n) {
        const GlassCase glass = {roughness[n % 5], cosine[n / 5 % 5], indices[n / 25 % 7],
                                 (cl_uint)(n / 175)};
        enum { FEW = 50000 };
        probe_run(*state, "draw", (cl_uint)n, which_of(&glass), FEW, drawn, FEW * ROW * sizeof *drawn);
        for (size_t i = 0; i < FEW; ++i) {
            const float *row = &drawn[i * ROW];
            const Vec d = row_direction(row);
            if (fabs(length2(d) - 1) >= 2e-6) describe(&glass);
            assert_true(fabs(length2(d) - 1) < 2e-6);
            assert_true((row[5] == 1 ? -1 : 1) * dot(d, normal) >= -1e-6); /* as doubles see it */
            if (row[7] < 0) continue;
            assert_true(isfinite(row[7]) && row[3] >= 0 && (double)row[3] <= 1 + 1e-6);
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(light),  cmocka_unit_test(densities),
                                       cmocka_unit_test(values), cmocka_unit_test(upright),
                                       cmocka_unit_test(losses), cmocka_unit_test(limits),
                                       cmocka_unit_test(ends)};
    return probe_run_group(tests, probe_text);
}
