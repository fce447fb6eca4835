/* test_lobes.c: lobes that depend on two directions: what the kernel draws against its own densities, and
 * both against the values that the reference has by definition; reciprocity; no light made, none lost; the
 * ends of the parameters. */
#include "packed/pack.h"
#include "reference/trace.h"
#include "scene/material.h"
#include "support/probe.h"
#include "support/uniformity.h"

#include <stdio.h>
#include <string.h>

enum { COUNT = 1000000, SIDE = 10, FINE = 20, GRID = SIDE * FINE, PAIRS = 200000, ROW = 8 };
static float drawn[COUNT * ROW];
#define PI 3.14159265358979323846
#define LEVEL 1e-5
static const Vec normal = {0.36, 0.48, 0.8}, tangent = {0.8, -0.6, 0}, side = {0.48, 0.64, -0.6};
static const double albedo[3] = {0.9, 0.5, 0.2};

/* A surface of roughness (which & 255) / 200, seen at the cosine ((which >> 8) & 255) / 250, of kind which >>
 * 16. Coats have the index 1.5, and let in what Walsh's closed form leaves. */
static const char probe_text[] =
    "static SampleKey probe_key(uint seed, uint i) { return sample_key(seed, 5u, i & 0xfffu, i >> 12, 4u); "
    "}\n"
    "static Vec3 probe_direction(real x, real y, real z) {\n"
    "    const Vec3 n = vec3(0.36f, 0.48f, 0.8f), t = vec3(0.8f, -0.6f, 0), b = vec3(0.48f, 0.64f, -0.6f);\n"
    "    return normalise3(madd3(x, t, madd3(y, b, scale3(z, n))));\n"
    "}\n"
    "static Surface probe_surface(uint which) {\n"
    "    const real c = ((which >> 8) & 255u) / 250.0f;\n"
    "    Surface surface;\n"
    "    surface.normal = probe_direction(0, 0, 1);\n"
    "    surface.incoming = scale3(splat(-1), probe_direction(sqrt((1 - c) * (1 + c)), 0, c));\n"
    "    surface.enters = vbool_all;\n"
    "    surface.albedo = vec3(0.9f, 0.5f, 0.2f);\n"
    "    surface.roughness = (which & 255u) / 200.0f;\n"
    "    surface.fuzz = 0;\n"
    "    surface.refraction_index = 1.5f;\n"
    "    surface.lets_in = 0.9082220f;\n"
    "    surface.variant = surface.total_reflection = 0;\n"
    "    surface.lobe = LOBE_LAMBERTIAN;\n"
    "    surface.kind = which >> 16;\n"
    "    return surface;\n"
    "}\n"
    "__kernel void draw(uint seed, uint which, __global float *out) {\n"
    "    const uint i = get_global_id(0);\n"
    "    const Surface surface = probe_surface(which);\n"
    "    const BsdfSample s = scatter(&surface, probe_key(seed, i), splat_uint(DIMENSION_BOUNCE));\n"
    "    vstore8((float8)(s.direction.x, s.direction.y, s.direction.z, s.weight.x, s.weight.y, s.weight.z,\n"
    "                     (float)s.lobe.kind, s.scattered ? scatter_pdf(&s.lobe, s.direction, 1) : -1), i, "
    "out);\n"
    "}\n"
    /* the density on a grid of cosines and angles, of the lobe that is drawn at sample `first` */
    "__kernel void grid(uint first, uint which, __global float *out) {\n"
    "    const uint i = get_global_id(0), side = 200u;\n"
    "    const Surface surface = probe_surface(which);\n"
    "    const BsdfSample s = scatter(&surface, probe_key(1u, first), splat_uint(DIMENSION_BOUNCE));\n"
    "    const real z = (i / side + 0.5f) / side, turn = (i % side + 0.5f) / side;\n"
    "    real sine, cosine;\n"
    "    sin_cos_turn(turn, &sine, &cosine);\n"
    "    const real r = sqrt((1 - z) * (1 + z));\n"
    "    const Vec3 d = probe_direction(r * cosine, r * sine, z);\n"
    "    vstore8((float8)(d.x, d.y, d.z, 0, 0, 0, (float)s.lobe.kind, scatter_pdf(&s.lobe, d, 0)), i, out);\n"
    "}\n"
    /* for two random directions, every other pair of them grazing: both, and the density of lobe `kind`
       times its weight of green, there and back */
    "__kernel void both(uint kind, uint which, __global float *out) {\n"
    "    const uint i = get_global_id(0);\n"
    "    const SampleKey key = probe_key(7u, i);\n"
    "    Vec3 d[2];\n"
    "    for (uint k = 0; k < 2; ++k) {\n"
    "        const real u = uniform(key, 2 * k), z = (i & (1u + k)) != 0 ? u * u * u * u : u;\n"
    "        real sine, cosine;\n"
    "        sin_cos_turn(uniform(key, 2 * k + 1), &sine, &cosine);\n"
    "        d[k] = probe_direction(sqrt((1 - z) * (1 + z)) * cosine, sqrt((1 - z) * (1 + z)) * sine, z);\n"
    "    }\n"
    "    Surface surface = probe_surface(which);\n"
    "    surface.incoming = scale3(splat(-1), d[0]);\n"
    "    Lobe lobe = bsdf_sample_reflected(&surface, d[1]).lobe;\n"
    "    const real r = surface.roughness;\n"
    "    lobe.fuzz = kind == (uint)LOBE_ROUGH_METAL || kind == (uint)LOBE_GLOSSY_COAT ? r * r : r;\n"
    "    lobe.kind = kind;\n"
    "    const real there = scatter_pdf(&lobe, d[1], 0) * (is_weighted(&lobe) ? scatter_weight(&lobe, "
    "d[1]).y : 0.5f);\n"
    "    lobe.outgoing = d[1];\n"
    "    const real back = scatter_pdf(&lobe, d[0], 0) * (is_weighted(&lobe) ? scatter_weight(&lobe, d[0]).y "
    ": 0.5f);\n"
    "    vstore8((float8)(d[0].x, d[0].y, d[0].z, d[1].x, d[1].y, d[1].z, there, back), i, out);\n"
    "}\n"
    /* LOBE_... of this number, for the test, which does not know the kernel's enumeration */
    "__kernel void kinds(uint unused, uint never, __global float *out) {\n"
    "    out[0] = LOBE_OREN_NAYAR_ONCE; out[1] = LOBE_OREN_NAYAR_AGAIN; out[2] = LOBE_ROUGH_METAL;\n"
    "    out[3] = LOBE_GLOSSY_COAT; out[4] = LOBE_GLOSSY_BASE; out[5] = LOBE_NONE;\n"
    "}\n"
    "__kernel void smooth(uint seed, uint which, __global float *out) {\n"
    "    const uint i = get_global_id(0);\n"
    "    Surface surface = probe_surface(which);\n"
    "    const Vec3 a = oren_nayar_sample(&surface, probe_key(seed, i), "
    "splat_uint(DIMENSION_BOUNCE)).direction;\n"
    "    const Vec3 b = lambertian_sample(&surface, probe_key(seed, i), "
    "splat_uint(DIMENSION_BOUNCE)).direction;\n"
    "    vstore8((float8)(a.x, a.y, a.z, b.x, b.y, b.z, 0, 0), i, out);\n"
    "}\n";

enum { ONCE, AGAIN, METAL, COAT, BASE, NONE, KINDS }; /* as the kernel `kinds` lists them */

typedef struct LobeCase {
    const char *name;
    cl_uint kind, roughness, cosine; /* as probe_surface has them */
} LobeCase;

static const LobeCase cases[] = {
    {"oren_nayar", KIND_OREN_NAYAR, 0, 150},   {"oren_nayar", KIND_OREN_NAYAR, 100, 250},
    {"oren_nayar", KIND_OREN_NAYAR, 100, 125}, {"oren_nayar", KIND_OREN_NAYAR, 200, 240},
    {"oren_nayar", KIND_OREN_NAYAR, 200, 100}, {"oren_nayar", KIND_OREN_NAYAR, 200, 50},
    {"metal", KIND_ROUGH_METAL, 80, 240},      {"metal", KIND_ROUGH_METAL, 100, 125},
    {"metal", KIND_ROUGH_METAL, 150, 50},      {"metal", KIND_ROUGH_METAL, 200, 250},
    {"metal", KIND_ROUGH_METAL, 200, 100},     {"glossy", KIND_GLOSSY, 80, 240},
    {"glossy", KIND_GLOSSY, 120, 50},          {"glossy", KIND_GLOSSY, 200, 125},
    {"glossy", KIND_GLOSSY, 200, 25},
};
#define INDEX 1.5

static cl_uint which_of(const LobeCase *lobe) {
    return lobe->kind << 16 | lobe->cosine << 8 | lobe->roughness;
}
static double roughness_of(const LobeCase *lobe) {
    return (double)((float)lobe->roughness / 200.0f);
}
static Vec out_of(const LobeCase *lobe) {
    const double c = fmin(lobe->cosine / 250.0, 1);
    return add(scale(sqrt(1 - c * c), tangent), scale(c, normal));
}
static void describe(const LobeCase *lobe) {
    printf("%-10s roughness %.3f, cosine %.3f: ", lobe->name, roughness_of(lobe), lobe->cosine / 250.0);
}
static Vec row_direction(const float *row) {
    return (Vec){(double)row[0], (double)row[1], (double)row[2]};
}

/* The value by definition, a channel's. */
static double value(const LobeCase *lobe, Vec out, Vec in, int channel) {
    const double r = roughness_of(lobe);
    if (lobe->kind == KIND_ROUGH_METAL) return albedo[channel] * bp_ref_rough_metal(r, normal, out, in);
    if (lobe->kind == KIND_GLOSSY)
        return bp_ref_glossy_coat(r, INDEX, normal, out, in) +
               bp_ref_glossy_base(albedo[channel], INDEX, normal, out, in);
    return albedo[channel] * bp_ref_oren_nayar_once(r, normal, out, in) +
           bp_ref_oren_nayar_colour(r, albedo[channel]) * bp_ref_oren_nayar_again(r, normal, out, in);
}

static Vec grid_direction(double cosine, double fraction) {
    const double r = sqrt(1 - cosine * cosine), angle = 2 * PI * fraction;
    return add(scale(r * cos(angle), tangent), add(scale(r * sin(angle), side), scale(cosine, normal)));
}

/* Which of SIDE x SIDE cells, equal in cosine and angle, a direction falls into. */
static size_t cell_of(Vec d) {
    const double cosine = fmin(fmax(dot(d, normal), 0), 1 - 1e-12),
                 angle = turn(dot(d, side), dot(d, tangent));
    return (size_t)(cosine * SIDE) * SIDE + (size_t)(fmin(angle, 1 - 1e-12) * SIDE);
}

/* The mean weight of the samples of each cell is the integral of the value times the cosine: light is brought
 * where it belongs. */
static void light(void **state) {
    for (size_t n = 0; n < sizeof cases / sizeof cases[0]; ++n) {
        const LobeCase *lobe = &cases[n];
        double sum[3][SIDE * SIDE] = {{0}}, square[3][SIDE * SIDE] = {{0}}, worst = 0;
        probe_run(*state, "draw", (cl_uint)(100 + n), which_of(lobe), COUNT, drawn, sizeof drawn);
        for (size_t i = 0; i < COUNT; ++i) {
            const float *row = &drawn[i * ROW];
            if (row[7] < 0) continue;
            const size_t cell = cell_of(row_direction(row));
            for (int c = 0; c < 3; ++c) {
                sum[c][cell] += (double)row[3 + c];
                square[c][cell] += (double)row[3 + c] * (double)row[3 + c];
            }
        }
        for (size_t cell = 0; cell < SIDE * SIDE; ++cell)
            for (int c = 0; c < 3; ++c) {
                double due = 0;
                for (int k = 0; k < FINE * FINE; ++k) {
                    const double x = ((double)(cell / SIDE) + (k / FINE + 0.5) / FINE) / SIDE;
                    const double y = ((double)(cell % SIDE) + (k % FINE + 0.5) / FINE) / SIDE;
                    /* value times cosine times the solid angle, which is that of cosine and angle */
                    due += value(lobe, out_of(lobe), grid_direction(x, y), c) * x * 2 * PI / (GRID * GRID);
                }
                const double mean = sum[c][cell] / COUNT;
                const double error = sqrt(fmax(square[c][cell] / COUNT - mean * mean, 1e-9) / COUNT);
                const double z = fabs(mean - due) / (error + 2e-4 * due);
                worst = fmax(worst, z);
            }
        describe(lobe);
        printf("off by %.2f standard errors at most\n", worst);
        assert_true(worst < 5.5); /* of 15 x 300 values: once in 10000 runs */
    }
}

/* Pearson's test of the directions of each part of a lobe against its density, which also has to sum up to 1.
 */
static void densities(void **state) {
    static float grid[GRID * GRID * ROW];
    for (size_t n = 0; n < sizeof cases / sizeof cases[0]; ++n) {
        const LobeCase *lobe = &cases[n];
        probe_run(*state, "draw", 1, which_of(lobe), COUNT, drawn, sizeof drawn);
        for (float kind = 0; kind < 16; ++kind) {
            size_t of_kind = 0, first = 0;
            double seen[SIDE * SIDE + 1] = {0}, due[SIDE * SIDE + 1] = {0}, rest = 1;
            for (size_t i = COUNT; i-- > 0;) {
                if (drawn[i * ROW + 6] != kind) continue;
                ++of_kind;
                first = i;
                seen[drawn[i * ROW + 7] < 0 ? SIDE * SIDE : cell_of(row_direction(&drawn[i * ROW]))] += 1;
            }
            if (of_kind < 1000) continue;
            probe_run(*state, "grid", (cl_uint)first, which_of(lobe), GRID * GRID, grid, sizeof grid);
            for (size_t i = 0; i < GRID * GRID; ++i) {
                const size_t cell = i / GRID / FINE * SIDE + i % GRID / FINE;
                const double part = (double)grid[i * ROW + 7] * 2 * PI / (GRID * GRID);
                due[cell] += part * (double)of_kind;
                rest -= part;
            }
            /* what is absorbed, and not an error of the sum */
            due[SIDE * SIDE] = rest > 1e-3 ? rest * (double)of_kind : 0;
            const double p = chi_square_test(seen, due, SIDE * SIDE + 1, NULL);
            describe(lobe);
            printf("part %.0f of %zu, p = %.4f, density sums up to %.5f\n", (double)kind, of_kind, p,
                   1 - rest);
            assert_true(rest > -1e-3);
            assert_true(p > LEVEL);
        }
    }
}

/* Density times weight times share of each part is the value of the part times the cosine, and both ways the
 * same, at all angles. */
static void values(void **state) {
    enum { PARTS = NONE };
    static const char *const names[PARTS] = {"once", "again", "metal", "coat", "base"};
    static const cl_uint roughness[] = {50, 100, 200};
    float kinds[KINDS];
    probe_run(*state, "kinds", 0, 0, 1, kinds, sizeof kinds);
    for (int n = 0; n < 3 * PARTS; ++n) {
        const int part = n / 3;
        const LobeCase lobe = {names[part], KIND_OREN_NAYAR, roughness[n % 3], 125};
        const double r = roughness_of(&lobe);
        double worst = 0, apart = 0;
        probe_run(*state, "both", (cl_uint)kinds[part], which_of(&lobe), PAIRS, drawn,
                  PAIRS * ROW * sizeof *drawn);
        for (size_t i = 0; i < PAIRS; ++i) {
            const float *row = &drawn[i * ROW];
            const Vec out = unit(row_direction(row)), in = unit(row_direction(row + 3));
            const double co = dot(out, normal), ci = dot(in, normal);
            if (co < 2e-3 || ci < 2e-3) continue; /* a float is off by 1e-7 there */
            double share_out = 1, share_in = 1, due = 0;
            if (part == ONCE || part == AGAIN)
                share_out = bp_ref_oren_nayar_share(r, co), share_in = bp_ref_oren_nayar_share(r, ci);
            if (part == AGAIN) share_out = 1 - share_out, share_in = 1 - share_in;
            if (part == ONCE) due = bp_ref_oren_nayar_once(r, normal, out, in);
            if (part == AGAIN) due = bp_ref_oren_nayar_again(r, normal, out, in);
            if (part == METAL) due = bp_ref_rough_metal(r, normal, out, in);
            if (part == COAT || part == BASE)
                share_out = bp_ref_fresnel(co, 1 / INDEX), share_in = bp_ref_fresnel(ci, 1 / INDEX);
            if (part == COAT) due = bp_ref_glossy_coat(r, INDEX, normal, out, in);
            if (part == BASE) { /* the weight of a white one is 1 */
                share_out = 1 - share_out, share_in = 1 - share_in;
                due = bp_ref_glossy_base(1, INDEX, normal, out, in);
            }
            const double there = share_out * (double)row[6] / ci / albedo[1],
                         back = share_in * (double)row[7] / co / albedo[1];
            worst = fmax(worst, fabs(there - due) / (due + 0.01));
            apart = fmax(apart, fabs(there - back) / (due + 0.01));
        }
        describe(&lobe);
        printf("values off by %.2g, two ways by %.2g\n", worst, apart);
        assert_true(worst < 2e-4 && apart < 2e-4);
    }
}

/* The closed form of what is scattered once, against the integral of the value; with the rest, all light
 * comes back. */
static void furnace(void **state) {
    (void)state;
    for (int r = 0; r <= 4; ++r)
        for (int c = 1; c <= 20; ++c) {
            const double roughness = r / 4.0, cosine = c / 20.0;
            const Vec out = add(scale(sqrt(1 - cosine * cosine), tangent), scale(cosine, normal));
            double once = 0, again = 0;
            enum { STEPS = 400 };
            for (int i = 0; i < STEPS; ++i)
                for (int k = 0; k < STEPS; ++k) {
                    const Vec in = grid_direction((i + 0.5) / STEPS, (k + 0.5) / STEPS);
                    const double part = (i + 0.5) / STEPS * 2 * PI / (STEPS * STEPS);
                    once += bp_ref_oren_nayar_once(roughness, normal, out, in) * part;
                    again += bp_ref_oren_nayar_again(roughness, normal, out, in) * part;
                }
            assert_true(fabs(once - bp_ref_oren_nayar_share(roughness, cosine)) < 2e-4);
            if (roughness > 0) assert_true(fabs(once + again - 1) < 3e-4);
        }
}

/* What rough metal of albedo 1 leaves of light: the kernel by what it draws, the reference by what it draws
 * in another way; upright, of roughness 1, 1 - ln 2. The figures of docs/MATERIALS.md. */
static void losses(void **state) {
    static const cl_uint roughness[] = {40, 80, 120, 160, 200}, cosine[] = {250, 125, 25};
    for (size_t n = 0; n < 15; ++n) {
        const LobeCase lobe = {"metal", KIND_ROUGH_METAL, roughness[n / 3], cosine[n % 3]};
        double left = 0, by_reference = 0, square = 0;
        enum { DRAWN = 400000 };
        Random random = random_stream(3, n, 0);
        probe_run(*state, "draw", 55, which_of(&lobe), COUNT, drawn, sizeof drawn);
        for (size_t i = 0; i < COUNT; ++i)
            left += drawn[i * ROW + 7] < 0 ? 0 : (double)drawn[i * ROW + 3] / albedo[0] / COUNT;
        for (size_t i = 0; i < DRAWN; ++i) {
            Vec direction, weight = {1, 1, 1};
            if (!bp_ref_scatter_rough_metal(roughness_of(&lobe), normal, scale(-1, out_of(&lobe)), &random,
                                            &direction, &weight))
                continue;
            by_reference += weight.x / DRAWN;
            square += weight.x * weight.x / DRAWN;
        }
        const double error = sqrt((square - by_reference * by_reference) * (1.0 / DRAWN + 1.0 / COUNT));
        describe(&lobe);
        printf("leaves %.4f, by the reference %.4f\n", left, by_reference);
        assert_true(fabs(left - by_reference) < 4.5 * error + 1e-6);
        if (lobe.roughness == 200 && lobe.cosine == 250) assert_true(fabs(left - (1 - log(2))) < 4.5 * error);
    }
}

static LobeCase glossy_case(cl_uint roughness, cl_uint cosine) {
    return (LobeCase){"glossy", KIND_GLOSSY, roughness, cosine};
}

/* A coat by closed forms: what enters from all sides, on the host by quadrature; the shares that kernel and
 * reference reflect; upright ((n - 1) / (n + 1))^2; and a white base loses nothing: the definition of the
 * base, summed over all directions, is what the coat does not reflect. */
static void coats(void **state) {
    for (int i = 0; i <= 40; ++i) {
        const double index = 1 + 9 * pow(i / 40.0, 3);
        assert_true(fabs(bp_coat_lets_in(index) + bp_ref_coat_reflects(index) - 1) < 1e-5);
        if (i < 2) continue;
        for (int c = 1; c <= 10; ++c) {
            const double cosine = c / 10.0, r = sqrt(1 - cosine * cosine);
            const Vec out = add(scale(r, tangent), scale(cosine, normal));
            enum { STEPS = 4000 };
            double sum = 0;
            for (int k = 0; k < STEPS; ++k) { /* in the square of the cosine's root, as it is steep at 0 */
                const double s = (k + 0.5) / STEPS, z = s * s;
                sum += bp_ref_glossy_base(1, index, normal, out, grid_direction(z, 0.3)) * z * 2 * PI * 2 *
                       s / STEPS;
            }
            assert_true(fabs(sum + bp_ref_fresnel(cosine, 1 / index) - 1) < 1e-5);
        }
    }
    static const cl_uint cosine[] = {250, 200, 125, 60, 25};
    float kinds[KINDS];
    probe_run(*state, "kinds", 0, 0, 1, kinds, sizeof kinds);
    for (int n = 0; n < 5; ++n) {
        const LobeCase lobe = glossy_case(0, cosine[n]);
        const Vec out = out_of(&lobe), mirrored = sub(scale(2 * dot(out, normal), normal), out);
        double reflected = 0;
        probe_run(*state, "draw", 21, which_of(&lobe), COUNT, drawn, sizeof drawn);
        for (size_t i = 0; i < COUNT; ++i) {
            const float *row = &drawn[i * ROW];
            const bool coat = row[6] == kinds[NONE];
            reflected += coat ? 1.0 / COUNT : 0;
            if (!coat) assert_true(row[6] == kinds[BASE]);
            if (coat) assert_true(length2(sub(row_direction(row), mirrored)) < 1e-11);
            for (int c = 0; c < 3 && coat; ++c) assert_true(fabs((double)row[3 + c] - 1) < 1e-5);
        }
        double due = bp_ref_fresnel(fmin(cosine[n] / 250.0, 1), 1 / INDEX);
        if (n == 0) due = pow((INDEX - 1) / (INDEX + 1), 2);
        describe(&lobe);
        printf("reflects %.5f of %.5f\n", reflected, due);
        assert_true(fabs(reflected - due) < 4.5 * sqrt(due * (1 - due) / COUNT));
    }
}

/* What a white glossy surface leaves of light: the kernel's coat and all that enters, against the sum of the
 * definitions over all directions. The figures of docs/MATERIALS.md. */
static void glossy_losses(void **state) {
    static const cl_uint roughness[] = {0, 60, 100, 150, 200}, cosine[] = {250, 125, 25};
    float kinds[KINDS];
    probe_run(*state, "kinds", 0, 0, 1, kinds, sizeof kinds);
    for (size_t n = 0; n < 15; ++n) {
        const LobeCase lobe = glossy_case(roughness[n / 3], cosine[n % 3]);
        const double c = fmin(lobe.cosine / 250.0, 1), r = roughness_of(&lobe);
        double left = 0, square = 0, by_reference = 0;
        enum { DRAWN = 400000 };
        Random random = random_stream(5, n, 0);
        probe_run(*state, "draw", 33, which_of(&lobe), COUNT, drawn, sizeof drawn);
        for (size_t i = 0; i < COUNT; ++i) {
            const float *row = &drawn[i * ROW];
            const double weight = row[7] < 0 ? 0 : row[6] == kinds[BASE] ? 1 : (double)row[3];
            left += weight / COUNT;
            square += weight * weight / COUNT;
        }
        for (size_t i = 0; i < DRAWN; ++i) {
            Vec direction, weight;
            if (bp_ref_scatter_glossy(r, INDEX, (Vec){1, 1, 1}, normal, scale(-1, out_of(&lobe)), &random,
                                      &direction, &weight))
                by_reference += weight.x / DRAWN;
        }
        const double error = sqrt(fmax(square - left * left, 0) * (1.0 / DRAWN + 1.0 / COUNT));
        describe(&lobe);
        printf("leaves %.4f, by the reference %.4f (reflects %.3f)\n", left, by_reference,
               bp_ref_fresnel(c, 1 / INDEX));
        assert_true(fabs(left - by_reference) < 4.5 * error + 1e-6);
        if (lobe.roughness == 0) assert_true(fabs(left - 1) < 1e-5);
    }
}

/* How often the kernel draws light that is scattered again: by the closed form. */
static void shares(void **state) {
    float kinds[KINDS];
    probe_run(*state, "kinds", 0, 0, 1, kinds, sizeof kinds);
    for (size_t n = 0; n < sizeof cases / sizeof cases[0]; ++n) {
        const LobeCase *lobe = &cases[n];
        double again = 0;
        if (lobe->kind != KIND_OREN_NAYAR) continue;
        probe_run(*state, "draw", 77, which_of(lobe), COUNT, drawn, sizeof drawn);
        for (size_t i = 0; i < COUNT; ++i) again += drawn[i * ROW + 6] == kinds[AGAIN] ? 1.0 / COUNT : 0;
        const double due = 1 - bp_ref_oren_nayar_share(roughness_of(lobe), lobe->cosine / 250.0);
        describe(lobe);
        printf("again %.5f of %.5f\n", again, due);
        assert_true(fabs(again - due) <= 4.5 * sqrt(fmax(due, 0) * (1 - due) / COUNT) + 1e-7);
    }
}

/* Roughness 0 is Lambert's surface, to the bit. */
static void smooth(void **state) {
    const LobeCase lobe = {"oren_nayar", KIND_OREN_NAYAR, 0, 60};
    probe_run(*state, "smooth", 3, which_of(&lobe), COUNT, drawn, sizeof drawn);
    for (size_t i = 0; i < COUNT; ++i)
        assert_memory_equal(&drawn[i * ROW], &drawn[i * ROW + 3], 3 * sizeof *drawn);
}

/* Upright, grazing, smooth and rough: directions are unit vectors above the surface, weights and densities
 * numbers, and no weight exceeds the albedo, or 1 of what a coat reflects. */
static void ends(void **state) {
    static const cl_uint roughness[] = {0, 1, 100, 200}, cosine[] = {0, 1, 125, 249, 250};
    for (size_t n = 0; n < 60; ++n) {
        const cl_uint kind = n < 20 ? KIND_OREN_NAYAR : n < 40 ? KIND_ROUGH_METAL : KIND_GLOSSY;
        const LobeCase lobe = {"", kind, roughness[n % 4], cosine[n / 4 % 5]};
        float kinds[KINDS];
        probe_run(*state, "kinds", 0, 0, 1, kinds, sizeof kinds);
        probe_run(*state, "draw", (cl_uint)n, which_of(&lobe), COUNT, drawn, sizeof drawn);
        for (size_t i = 0; i < COUNT; ++i) {
            const float *row = &drawn[i * ROW];
            const bool coat = kind == KIND_GLOSSY && row[6] != kinds[BASE];
            const Vec d = row_direction(row);
            assert_true(fabs(length2(d) - 1) < 2e-6);
            if (row[7] < 0) continue;
            assert_true(dot(d, normal) >= -1e-6); /* as doubles see it */
            assert_true(isfinite(row[7]));
            for (int c = 0; c < 3; ++c)
                assert_true(row[3 + c] >= 0 && (double)row[3 + c] <= (coat ? 1 : albedo[c]) * (1 + 1e-6));
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(light),         cmocka_unit_test(densities),
                                       cmocka_unit_test(values),        cmocka_unit_test(furnace),
                                       cmocka_unit_test(shares),        cmocka_unit_test(smooth),
                                       cmocka_unit_test(losses),        cmocka_unit_test(coats),
                                       cmocka_unit_test(glossy_losses), cmocka_unit_test(ends)};
    return probe_run_group(tests, probe_text);
}
